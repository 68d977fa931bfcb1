//! Segments and tubes against the boxes of a hierarchy.

use glam::DVec3;
use parry3d_f64::partitioning::BvhNode;

use super::tube::Tube;

/// A piece of a ray: `origin + t * direction` for t in [start, end].
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub origin: DVec3,
    pub direction: DVec3,
    pub start: f64,
    pub end: f64,
}

/// The slab test of a segment against boxes grown by a margin. The margin always holds the test's own rounding, so
/// that no box is missed that the segment touches.
pub(super) struct Slab {
    origin: DVec3,
    inverse: DVec3,
    start: f64,
    pad: f64,
    tube: Tube,
}

/// A tube is taken to be so many times as wide: its beam's taper is known to 1 %.
const WIDER: f64 = 1.02;

impl Slab {
    pub(super) fn new(segment: &Segment, pad: f64) -> Self {
        let far = segment.origin + segment.direction * segment.end;
        let size = segment.origin.abs().max(far.abs()).max_element();
        let pad = pad * (1.0 + 1e-6) + size * f64::EPSILON * 16.0;
        let (origin, inverse) = (segment.origin, segment.direction.recip());
        Self { origin, inverse, start: segment.start, pad, tube: Tube::LINE }
    }

    pub(super) fn around(self, tube: Tube) -> Self {
        Self { tube, ..self }
    }

    /// Tests whether the tube may meet the node's box before `end`.
    ///
    /// Where it tapers it is no wider, at the box, than where it leaves the box grown by its greatest width: that bound is
    /// applied again and again while it makes the tube much thinner. A far or huge surface, which f32 may move by more
    /// than a near mesh is large, so does not make its beams as wide at that mesh.
    pub(super) fn meets(&self, node: &BvhNode, end: f64) -> bool {
        if !self.tube.tapers {
            return self.span(node, end, self.pad + WIDER * self.tube.radius).is_some();
        }
        let mut end = end;
        loop {
            let Some((_, leave)) = self.span(node, end, self.pad + WIDER * self.tube.radius * end) else {
                return false;
            };
            if leave >= 0.5 * end {
                return true;
            }
            end = leave;
        }
    }

    /// The parameter where the segment enters the node's box; `f64::MAX` where it misses it before `end`.
    pub(super) fn enter(&self, node: &BvhNode, end: f64) -> f64 {
        self.span(node, end, self.pad).map_or(f64::MAX, |(enter, _)| enter)
    }

    /// Parameters at which the segment enters and leaves the node's box grown by `pad`, before `end`.
    fn span(&self, node: &BvhNode, end: f64, pad: f64) -> Option<(f64, f64)> {
        let min = (DVec3::from_array(node.mins().to_array()) - pad - self.origin) * self.inverse;
        let max = (DVec3::from_array(node.maxs().to_array()) + pad - self.origin) * self.inverse;
        // f64::min and max leave out a NaN (0 * infinity: on a padded face, which no triangle reaches).
        let near = min.x.min(max.x).max(min.y.min(max.y)).max(min.z.min(max.z)).max(self.start);
        let far = min.x.max(max.x).min(min.y.max(max.y)).min(min.z.max(max.z)).min(end);
        // Relative slack for the rounding of parameters far along the ray.
        (near <= far * (1.0 + 1e-12)).then_some((near * (1.0 - 1e-12), far * (1.0 + 1e-12)))
    }
}
