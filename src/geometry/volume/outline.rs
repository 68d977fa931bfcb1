//! The possible silhouette [GDC, "Computing Shadow Volumes For Polygonal Models"]: the boundary of the triangles that
//! count, as directed edges with multiplicity. All buffers are kept from one light or frame to the next.

use super::loops::{self, OutlineEdge};
use super::{Caster, CountedFaces, LightSource};

/// Triangles of a caster that count under one light, and the boundary of their sum.
///
/// Keep one and call [`Outline::find`] again: nothing is allocated once the buffers are large enough.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Per triangle of the caster: 1 if it counts, -1 if it counts with reversed winding, else 0.
    weights: Vec<i8>,
    edges: Vec<OutlineEdge>,
    countings: Vec<CountedFaces>,
    source: Option<LightSource>,
    exact_tests: usize,
}

impl Outline {
    /// Finds the counted triangles of `caster` and their boundary, for a light in the caster's model space.
    pub fn find(&mut self, caster: &Caster, source: LightSource) {
        self.source = Some(source);
        self.weights.resize(caster.triangles.len(), 0);
        self.countings.clear();
        self.exact_tests = 0;
        for shell in &caster.shells {
            let range = shell.triangles.start as usize..shell.triangles.end as usize;
            self.exact_tests +=
                caster.planes.sides(|triangle| caster.corners(triangle), range.clone(), source, &mut self.weights);
            let counting = caster.counting(shell, source);
            if counting == CountedFaces::Facing {
                self.weights[range].iter_mut().for_each(|weight| *weight = (*weight).max(0));
            }
            self.countings.push(counting);
        }
        self.collect_edges(caster);
    }

    fn collect_edges(&mut self, caster: &Caster) {
        self.edges.clear();
        let weights = &self.weights[..];
        let plain = &caster.plain;
        for ([from, to], [first, second]) in plain.places.iter().zip(&plain.triangles) {
            let (first, second) = (weights[*first as usize], weights[*second as usize]);
            if first != second {
                self.edges.extend(directed([*from, *to], i32::from(first) - i32::from(second)));
            }
        }
        for (places, uses) in caster.other.iter() {
            let of_use = |(triangle, way): &(u32, i8)| i32::from(weights[*triangle as usize]) * i32::from(*way);
            self.edges.extend(directed(places, uses.iter().map(of_use).sum()));
        }
    }

    /// Each edge once, in no particular order.
    pub fn edges(&self) -> &[OutlineEdge] {
        &self.edges
    }

    /// Per triangle of [`Caster::triangles`]: 1 counted, -1 counted with reversed winding, 0 unused.
    pub fn weights(&self) -> &[i8] {
        &self.weights
    }

    /// Way in which each of [`Caster::shells`] counts.
    pub fn countings(&self) -> &[CountedFaces] {
        &self.countings
    }

    /// The light that it was found for; `None` before the first [`Outline::find`].
    pub fn source(&self) -> Option<LightSource> {
        self.source
    }

    /// Number of triangles whose side needed exact arithmetic.
    pub fn exact_tests(&self) -> usize {
        self.exact_tests
    }

    /// The outline as closed loops of places, each edge as often as its multiplicity; the counted triangles lie on the
    /// left seen from the light. For pictures: it allocates.
    pub fn loops(&self) -> Vec<Vec<u32>> {
        loops::closed_walks(&self.edges)
    }
}

fn directed([from, to]: [u32; 2], multiplicity: i32) -> Option<OutlineEdge> {
    let edge = OutlineEdge { from, to, multiplicity: multiplicity.unsigned_abs() };
    match multiplicity {
        0 => None,
        1.. => Some(edge),
        _ => Some(OutlineEdge { from: to, to: from, ..edge }),
    }
}
