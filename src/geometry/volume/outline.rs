//! The possible silhouette [GDC 2001; C1]: the boundary of the triangles that count, as directed edges with
//! multiplicity. All buffers are kept from one light or frame to the next.

use std::ops::Range;

use glam::DMat4;

use super::light_near::{LightNear, Nearness};
use super::{Caster, Counting, Source, loops};

/// Which triangles of a caster count under one light, and the boundary of their sum.
///
/// Keep one and call [`Outline::find`] again: nothing is allocated once the buffers are large enough.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Of each triangle of the caster: 1 where it counts as it runs, -1 where it counts turned over, else 0.
    weights: Vec<i8>,
    edges: Vec<OutlineEdge>,
    countings: Vec<Counting>,
    source: Option<Source>,
    exact_tests: usize,
    partly_near: usize,
}

/// An edge of the outline. Seen from the light, the counted triangle lies on the left of `from` to `to`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutlineEdge {
    /// Places of the caster.
    pub from: u32,
    pub to: u32,
    /// How often it is part of the boundary; at least 1.
    pub multiplicity: u32,
}

impl Outline {
    /// Finds the counted triangles of `caster` and their boundary, for a light in the caster's model space.
    pub fn find(&mut self, caster: &Caster, source: Source) {
        self.find_beyond(caster, source, None);
    }

    /// The same for a light with a near plane, and the way from the caster's model space to the world's. A shell that
    /// comes nearer than the near plane counts by all triangles but the nearer ones.
    pub fn find_beyond(&mut self, caster: &Caster, source: Source, near: Option<(&LightNear, &DMat4)>) {
        self.source = Some(source);
        self.partly_near = 0;
        self.weights.resize(caster.triangles.len(), 0);
        self.countings.clear();
        self.exact_tests = 0;
        for shell in &caster.shells {
            let range = shell.triangles.start as usize..shell.triangles.end as usize;
            self.exact_tests += caster.planes.sides(caster, range.clone(), source, &mut self.weights);
            let mut counting = caster.counting(shell, source);
            if let Some((near, world_from_model)) = near
                && self.leave_out_near(caster, range.clone(), near, world_from_model, counting)
            {
                counting = Counting::All;
            }
            if counting == Counting::Facing {
                self.weights[range].iter_mut().for_each(|weight| *weight = (*weight).max(0));
            }
            self.countings.push(counting);
        }
        self.collect_edges(caster);
    }

    /// Takes out of a shell's triangles those that are nearer than the light's near plane; whether any comes so near.
    fn leave_out_near(
        &mut self,
        caster: &Caster,
        range: Range<usize>,
        near: &LightNear,
        world_from_model: &DMat4,
        counting: Counting,
    ) -> bool {
        let (mut comes_near, mut turned_is_near) = (false, counting == Counting::All);
        let (mut facing, mut turned) = (0, 0);
        for (triangle, weight) in range.clone().zip(&mut self.weights[range]) {
            let nearness = near.nearness(world_from_model, &caster.corners(triangle));
            if nearness == Nearness::Beyond {
                continue;
            }
            comes_near = true;
            turned_is_near |= *weight < 0;
            if nearness != Nearness::Nearer {
                facing += usize::from(*weight > 0);
                turned += usize::from(*weight < 0);
            }
            if nearness != Nearness::Mostly {
                *weight = 0;
            }
        }
        // Out of a closed shell every ray has a way that is farther than its way in: that one may be left out or not, if
        // all ways out are beyond the near plane.
        self.partly_near += if turned_is_near { facing + turned } else { 0 };
        comes_near
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

    /// Of each of [`Caster::triangles`]: 1 counted as it runs, -1 counted turned over, 0 not counted.
    pub fn weights(&self) -> &[i8] {
        &self.weights
    }

    /// How each of [`Caster::shells`] counts.
    pub fn countings(&self) -> &[Counting] {
        &self.countings
    }

    /// The light that it was found for; `None` before the first [`Outline::find`].
    pub fn source(&self) -> Option<Source> {
        self.source
    }

    /// How many triangles were too near the light's side to be told without exact arithmetic.
    pub fn exact_tests(&self) -> usize {
        self.exact_tests
    }

    /// Triangles that count whole or not at all, although a part of each is nearer than the light's near plane.
    pub fn partly_near(&self) -> usize {
        self.partly_near
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
