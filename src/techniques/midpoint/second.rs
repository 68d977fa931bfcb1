//! Items drawn into both layers of the map or only into the second, and the texels that may have a second layer, to which
//! the passes are scissored. From bounding boxes.

use std::collections::HashSet;

use glam::{DMat4, DVec3};

use super::texels::{Cells, Rectangle};

use crate::geometry::volume;
use crate::lights::caster_culling::Unseen;
use crate::lights::projector::Rays;
use crate::lights::{Drawable, FrustumView, Notes};
use crate::math::{Aabb, frustum};
use crate::techniques::shadow_map::casters::{in_the_map, is_before_near, may_cast, reach};
use crate::techniques::shadow_map::depth::{self, InParts};
use crate::techniques::shadow_map::settings::Settings;

/// Texels that two layers may share.
pub struct Shared<'a> {
    /// Left, bottom, width and height of all such texels; zeros where there are none.
    pub scissor: [u32; 4],
    pub casters: Drawn<'a>,
    pub receivers: Drawn<'a>,
}

/// Items drawn there.
#[derive(Default)]
pub struct Drawn<'a> {
    /// Items drawn under the scissor of all such texels.
    pub whole: Vec<&'a Drawable>,
    /// Flat items, each under the scissors of the items that it may share texels with: for example a large floor with many
    /// small objects on it.
    pub in_parts: Vec<InParts<'a>>,
}

/// Items of the two layers.
pub struct Layers<'a> {
    /// Items drawn into both layers.
    pub casters: Vec<&'a Drawable>,
    /// Items drawn into the second layer only, before which the middle must lie: items that cast no shadow but may be
    /// shadowed, and items beyond the light's far plane, all at one depth.
    pub receivers: Vec<&'a Drawable>,
    /// Name of an item beyond the far plane, if there is one. Without clipping it is a second layer at depth 1.
    pub beyond_far: Option<String>,
}

/// Sorts the items that the light meets into layers.
pub fn layers<'a>(view: &FrustumView<'a>, notes: &mut Notes) -> Layers<'a> {
    let clip_from_world = view.clip_from_world();
    let (mut casters, mut receivers, mut beyond_far) = (Vec::new(), Vec::new(), None);
    for item in view.items {
        let clip_from_model = clip_from_world * item.world_from_model;
        if item.casts_shadow && (view.keep_all || may_cast(view, item)) {
            casters.push(item);
        } else if view.keep_all || frustum::may_show_clamped(&clip_from_model, &item.bounds) {
            receivers.push(item);
        } else {
            let why = if item.casts_shadow { "outside the light's frustum" } else { "casts_shadow = false" };
            notes.left_out(in_the_map(item, view), why);
            continue;
        }
        let is_beyond = |corner: DVec3| {
            let clip = clip_from_model * corner.extend(1.0);
            clip.z >= clip.w && clip.w > 0.0
        };
        if beyond_far.is_none() && item.bounds.corners().into_iter().any(is_beyond) {
            beyond_far = Some(item.label.clone());
        }
    }
    Layers { casters, receivers, beyond_far }
}

/// Most triangles of an item that is drawn several times to save texels.
const MOST_TRIANGLES: usize = 4096;

/// The casters that some visible texel needs: those whose shadow the camera sees, and those that are the second layer of
/// such a caster.
///
/// If another caster is the first layer, nothing visible lies behind it, and without it the middle only moves away from
/// surfaces before it.
pub fn needed<'a>(
    view: &FrustumView<'_>,
    casters: Vec<&'a Drawable>,
    settings: &Settings,
    notes: &mut Notes,
) -> Vec<&'a Drawable> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let unseen = Unseen::new(view, settings.size, reach(settings));
    let (unseen, seen): (Vec<&Drawable>, Vec<&Drawable>) = casters.iter().partition(|item| unseen.shadow_of(item));
    let places: Vec<Rectangle> = seen.iter().map(|item| covered(view, item, &clip_from_world, settings)).collect();
    let cells = Cells::new(&places, settings.size);
    let is_idle = |item: &Drawable| {
        let own = covered(view, item, &clip_from_world, settings);
        let rays = &view.projector.rays;
        !cells.meeting(&own).into_iter().any(|first| !lies_before(item, seen[first], rays))
    };
    let idle: Vec<&Drawable> = unseen.into_iter().filter(|item| is_idle(item)).collect();
    for item in &idle {
        let why = "the camera sees nothing that it shadows, and it is no second layer of what it sees the shadow of";
        notes.left_out(in_the_map(item, view), why);
    }
    let idle: HashSet<*const Drawable> = idle.into_iter().map(std::ptr::from_ref).collect();
    casters.into_iter().filter(|item| !idle.contains(&std::ptr::from_ref(*item))).collect()
}

fn covered(view: &FrustumView<'_>, item: &Drawable, clip_from_world: &DMat4, settings: &Settings) -> Rectangle {
    // Near the light, a small thing is wide.
    if is_before_near(view, item) {
        return Rectangle::new([0, 0, settings.size, settings.size]);
    }
    let scissor = volume::scissor(&corners(item), clip_from_world, [settings.size; 2]);
    scissor.map_or(Rectangle::NOTHING, |[x, y, width, height]| Rectangle::new([x, y, x + width, y + height]))
}

fn corners(item: &Drawable) -> [DVec3; 8] {
    item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner))
}

/// Tests whether no ray meets `item` behind `other`: by their distances from the light, or by the plane of a flat `other`.
fn lies_before(item: &Drawable, other: &Drawable, rays: &Rays) -> bool {
    let (own, others) = (corners(item), corners(other));
    let scale = own.iter().chain(&others).map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    // Error of f32 transforms.
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
/// A flat caster is one layer: it shares texels only with others. (Overlapping triangles of one plane count as one layer,
/// too: only rounding separates their depths.) An item that casts nothing is never the first of two, and shares texels only
/// with casters.
pub fn shared_texels<'a>(view: &FrustumView<'_>, layers: &Layers<'a>, settings: &Settings) -> Shared<'a> {
    let clip_from_world = depth::map_clip_from_world(view, settings);
    let covered = |items: &[&'a Drawable]| -> Vec<Rectangle> {
        items.iter().map(|item| covered(view, item, &clip_from_world, settings)).collect()
    };
    let (of_casters, of_receivers) = (covered(&layers.casters), covered(&layers.receivers));
    let [cells, receiving] = [&of_casters, &of_receivers].map(|places| Cells::new(places, settings.size));
    let (mut casters, mut receivers) = (Drawn::default(), Drawn::default());
    let mut all = Rectangle::NOTHING;
    for (index, (item, own)) in layers.casters.iter().zip(&of_casters).enumerate() {
        if item.bounds.flat_axis().is_none() {
            all = all.with(*own);
            casters.whole.push(item);
        } else {
            let others = cells.meeting(own).into_iter().filter(|other| *other != index).map(|other| &of_casters[other]);
            let received = receiving.meeting(own).into_iter().map(|other| &of_receivers[other]);
            all = all.with(casters.share(item, own, others.chain(received)));
        }
    }
    for (item, own) in layers.receivers.iter().zip(&of_receivers) {
        let others = cells.meeting(own).into_iter().map(|other| &of_casters[other]);
        all = all.with(receivers.share(item, own, others));
    }
    Shared { scissor: all.scissor(), casters, receivers }
}

impl<'a> Drawn<'a> {
    /// Adds rectangles that cover `own` where it meets `others`; returns a rectangle around all these places.
    fn share<'r>(
        &mut self,
        item: &'a Drawable,
        own: &Rectangle,
        others: impl Iterator<Item = &'r Rectangle>,
    ) -> Rectangle {
        let parts: Vec<Rectangle> = others.map(|other| own.within(*other)).filter(|part| part.area() > 0).collect();
        let together = parts.iter().fold(Rectangle::NOTHING, |sum, part| sum.with(*part));
        let triangles = item.indices.len() / 3 * parts.len();
        if triangles <= MOST_TRIANGLES && parts.iter().map(Rectangle::area).sum::<u64>() < together.area() {
            let scissors = parts.iter().map(Rectangle::scissor).collect();
            self.in_parts.push(InParts { item, scissors });
        } else if together.area() > 0 {
            self.whole.push(item);
        }
        together
    }
}
