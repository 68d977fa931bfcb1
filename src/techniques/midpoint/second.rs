//! Which texels of the map may have a second layer: what the second pass is scissored to. From bounding boxes.

use crate::geometry::volume;
use crate::techniques::shadow_map::depth;
use crate::techniques::shadow_map::settings::Settings;
use crate::techniques::{FrustumView, Item};

/// Left, bottom, right and top, in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rectangle([u32; 4]);

impl Rectangle {
    const NOTHING: Self = Self([u32::MAX, u32::MAX, 0, 0]);

    fn with(self, Self(other): Self) -> Self {
        let [left, bottom, right, top] = self.0;
        Self([left.min(other[0]), bottom.min(other[1]), right.max(other[2]), top.max(other[3])])
    }

    fn within(self, Self(other): Self) -> Self {
        let [left, bottom, right, top] = self.0;
        let both = [left.max(other[0]), bottom.max(other[1]), right.min(other[2]), top.min(other[3])];
        if both[0] < both[2] && both[1] < both[3] { Self(both) } else { Self::NOTHING }
    }
}

/// Left, bottom, width and height of the texels that two layers may share; `None`: no texel.
///
/// A flat caster is one layer: it shares texels with others alone. (Triangles of one plane that cover one another count
/// as one too: nothing lies between them, and what holds their depths apart is rounding.)
pub fn shared_texels(view: &FrustumView<'_>, casters: &[&Item], settings: &Settings) -> Option<[u32; 4]> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let covered = |item: &Item| {
        let corners = item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner));
        let scissor = volume::scissor(&corners, &clip_from_world, [settings.size; 2]);
        scissor.map_or(Rectangle::NOTHING, |[x, y, width, height]| Rectangle([x, y, x + width, y + height]))
    };
    let mut shared = Rectangle::NOTHING;
    let mut flat: Vec<Rectangle> = Vec::new();
    for item in casters {
        let covered = covered(item);
        if (item.bounds.max - item.bounds.min).min_element() > 0.0 {
            shared = shared.with(covered);
        } else {
            shared = flat.iter().fold(shared, |shared, other| shared.with(covered.within(*other)));
            flat.push(covered);
        }
    }
    let Rectangle([left, bottom, right, top]) = shared;
    (left < right && bottom < top).then(|| [left, bottom, right - left, top - bottom])
}
