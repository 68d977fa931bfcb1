//! The possible silhouette [GDC, "Computing Shadow Volumes For Polygonal Models"]: the boundary of the triangles that
//! count, as directed edges with multiplicity. All buffers are kept from one light or frame to the next.

use super::loops::{self, OutlineEdge};
use super::{Caster, CountedFaces, KeyPlanes, LightSource, PlaneBlend};
use crate::process::work;

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
        self.begin(caster, source);
        for shell in &caster.shells {
            let range = shell.triangles.start as usize..shell.triangles.end as usize;
            self.exact_tests +=
                caster.planes.sides(|triangle| caster.corners(triangle), range, source, &mut self.weights);
        }
        self.count(caster, source);
    }

    /// [`Self::find`] for a caster between two key frames, by its triangles' planes at that `blend`.
    /// [`PlaneBlend::Exact`]: the same triangles count. [`PlaneBlend::Lerped`]: the volume is closed, but triangles near to the
    /// silhouette may be taken for the wrong side.
    pub fn find_between(
        &mut self,
        caster: &Caster,
        planes: &KeyPlanes,
        blend: f64,
        by: PlaneBlend,
        source: LightSource,
    ) {
        self.begin(caster, source);
        planes.sides(blend, by, source, &mut self.weights);
        if by == PlaneBlend::Exact && self.weights.contains(&0) {
            for (triangle, side) in self.weights.iter_mut().enumerate().filter(|(_, side)| **side == 0) {
                *side = caster.planes.exact_side(&caster.corners(triangle), triangle, source);
                self.exact_tests += 1;
            }
        }
        self.count(caster, source);
    }

    /// [`Self::find`] with sides of the triangles that are given: 1 seen counter-clockwise from the light, -1 clockwise, 0
    /// neither. Whatever they are, the volume is closed.
    pub fn find_by_sides(&mut self, caster: &Caster, source: LightSource, sides: &[i8]) {
        self.begin(caster, source);
        self.weights.iter_mut().zip(sides).for_each(|(weight, side)| *weight = side.signum());
        self.count(caster, source);
    }

    fn begin(&mut self, caster: &Caster, source: LightSource) {
        work::count_triangles(3 * caster.triangles.len());
        self.source = Some(source);
        self.weights.clear();
        self.weights.resize(caster.triangles.len(), 0);
        self.countings.clear();
        self.exact_tests = 0;
    }

    /// Finds the counted triangles from sides, and their boundary.
    fn count(&mut self, caster: &Caster, source: LightSource) {
        for shell in &caster.shells {
            let counting = caster.counting(shell, source);
            if counting == CountedFaces::Facing {
                let range = shell.triangles.start as usize..shell.triangles.end as usize;
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
