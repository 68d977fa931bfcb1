//! Which texels of the map may have a second layer: what its passes are scissored to. From bounding boxes.

use crate::geometry::volume;
use crate::techniques::shadow_map::depth::{self, InParts};
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

    fn scissor(&self) -> [u32; 4] {
        let [left, bottom, right, top] = self.0;
        if self.area() == 0 { [0; 4] } else { [left, bottom, right - left, top - bottom] }
    }

    fn area(&self) -> u64 {
        let [left, bottom, right, top] = self.0;
        u64::from(right.saturating_sub(left)) * u64::from(top.saturating_sub(bottom))
    }
}

/// Where two layers may meet.
pub struct Shared<'a> {
    /// Left, bottom, width and height of all such texels; zeros where there are none.
    pub scissor: [u32; 4],
    /// Casters that are drawn under it.
    pub casters: Vec<&'a Item>,
    /// Flat ones, each under the scissors of the other casters: the large floor that many small things stand on.
    pub in_parts: Vec<InParts<'a>>,
}

/// More triangles are not drawn again and again to spare texels.
const MOST_TRIANGLES: usize = 4096;

/// Finds the texels that two layers may share.
///
/// A flat caster is one layer: it shares texels with others alone. (Triangles of one plane that cover one another count
/// as one too: nothing lies between them, and what holds their depths apart is rounding.)
pub fn shared_texels<'a>(view: &FrustumView<'_>, casters: &[&'a Item], settings: &Settings) -> Shared<'a> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let covered = |item: &Item| {
        let corners = item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner));
        let scissor = volume::scissor(&corners, &clip_from_world, [settings.size; 2]);
        scissor.map_or(Rectangle::NOTHING, |[x, y, width, height]| Rectangle([x, y, x + width, y + height]))
    };
    let covered: Vec<Rectangle> = casters.iter().map(|item| covered(item)).collect();
    let is_flat = |item: &Item| (item.bounds.max - item.bounds.min).min_element() == 0.0;
    let mut shared = Shared { scissor: [0; 4], casters: Vec::new(), in_parts: Vec::new() };
    let mut all = Rectangle::NOTHING;
    for (index, (item, own)) in casters.iter().zip(&covered).enumerate() {
        if !is_flat(item) {
            all = all.with(*own);
            shared.casters.push(item);
            continue;
        }
        let others = covered.iter().enumerate().filter(|(other, _)| *other != index);
        let parts: Vec<Rectangle> =
            others.map(|(_, other)| own.within(*other)).filter(|part| part.area() > 0).collect();
        let together = parts.iter().fold(Rectangle::NOTHING, |sum, part| sum.with(*part));
        all = all.with(together);
        let triangles = item.indices.len() / 3 * parts.len();
        if triangles <= MOST_TRIANGLES && parts.iter().map(Rectangle::area).sum::<u64>() < together.area() {
            let scissors = parts.iter().map(Rectangle::scissor).collect();
            shared.in_parts.push(InParts { item, scissors });
        } else if together.area() > 0 {
            shared.casters.push(item);
        }
    }
    shared.scissor = all.scissor();
    shared
}
