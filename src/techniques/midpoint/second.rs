//! Which casters and which texels of the map may have a second layer: what its passes draw, and are scissored to. From
//! bounding boxes.

use glam::{DMat4, DVec3};

use crate::geometry::volume;
use crate::math::Aabb;
use crate::techniques::projector::Rays;
use crate::techniques::shadow_map::casters::{in_the_map, reach};
use crate::techniques::shadow_map::depth::{self, InParts};
use crate::techniques::shadow_map::settings::Settings;
use crate::techniques::unseen::Unseen;
use crate::techniques::{FrustumView, Item, Notes};

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

/// The casters without those that no texel needs which is looked up: the camera sees nothing that they shadow, and they
/// are the second layer of no caster whose shadow it sees.
///
/// Where such a one is the first layer, nothing that is seen lies behind it, and without it the middle only moves away
/// from what lies before it.
pub fn needed<'a>(
    view: &FrustumView<'_>,
    casters: Vec<&'a Item>,
    settings: &Settings,
    notes: &mut Notes,
) -> Vec<&'a Item> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let unseen = Unseen::new(view, settings.size, reach(settings));
    let (unseen, seen): (Vec<&Item>, Vec<&Item>) = casters.iter().partition(|item| unseen.shadow_of(item));
    let seen: Vec<(&Item, Rectangle)> =
        seen.into_iter().map(|item| (item, covered(item, &clip_from_world, settings))).collect();
    let is_idle = |item: &Item| {
        let own = covered(item, &clip_from_world, settings);
        let may_follow = |(first, covered): &(&Item, Rectangle)| {
            own.within(*covered).area() > 0 && !lies_before(item, first, &view.projector.rays)
        };
        !seen.iter().any(may_follow)
    };
    let idle: Vec<&Item> = unseen.into_iter().filter(|item| is_idle(item)).collect();
    for item in &idle {
        let why = "the camera sees nothing that it shadows, and it is no second layer of what it sees the shadow of";
        notes.left_out(in_the_map(item, view), why);
    }
    casters.into_iter().filter(|item| !idle.iter().any(|other| std::ptr::eq(*other, *item))).collect()
}

fn covered(item: &Item, clip_from_world: &DMat4, settings: &Settings) -> Rectangle {
    let scissor = volume::scissor(&corners(item), clip_from_world, [settings.size; 2]);
    scissor.map_or(Rectangle::NOTHING, |[x, y, width, height]| Rectangle([x, y, x + width, y + height]))
}

fn corners(item: &Item) -> [DVec3; 8] {
    item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner))
}

/// Whether no ray meets `item` behind `other`: by their distances from the light, or by the plane of a flat `other`.
fn lies_before(item: &Item, other: &Item, rays: &Rays) -> bool {
    let (own, others) = (corners(item), corners(other));
    let scale = own.iter().chain(&others).map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    // What f32 transforms may be off by.
    let slack = scale / f64::from(1 << 20);
    let bounds = Aabb::from_points(others);
    let (farthest, nearest) = match rays {
        Rays::From { position, .. } => (
            own.iter().map(|corner| corner.distance(*position)).fold(0.0, f64::max),
            position.distance(position.clamp(bounds.min, bounds.max)),
        ),
        Rays::Along(way) => (
            own.iter().map(|corner| corner.dot(*way)).fold(f64::NEG_INFINITY, f64::max),
            others.iter().map(|corner| corner.dot(*way)).fold(f64::INFINITY, f64::min),
        ),
    };
    if farthest < nearest - slack {
        return true;
    }
    let Some(axis) = other.bounds.flat_axis() else { return false };
    let normal = other.world_from_model.inverse().transpose().transform_vector3(axis).normalize();
    let height = |point: &DVec3| normal.dot(*point - others[0]);
    let of_light = match rays {
        Rays::From { position, .. } => height(position),
        Rays::Along(way) => -normal.dot(*way) * scale,
    };
    of_light.abs() > slack && own.iter().all(|corner| of_light.signum() * height(corner) >= -slack)
}

/// Finds the texels that two layers may share.
///
/// A flat caster is one layer: it shares texels with others alone. (Triangles of one plane that cover one another count
/// as one too: nothing lies between them, and what holds their depths apart is rounding.)
pub fn shared_texels<'a>(view: &FrustumView<'_>, casters: &[&'a Item], settings: &Settings) -> Shared<'a> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let covered: Vec<Rectangle> = casters.iter().map(|item| covered(item, &clip_from_world, settings)).collect();
    let mut shared = Shared { scissor: [0; 4], casters: Vec::new(), in_parts: Vec::new() };
    let mut all = Rectangle::NOTHING;
    for (index, (item, own)) in casters.iter().zip(&covered).enumerate() {
        if item.bounds.flat_axis().is_none() {
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
