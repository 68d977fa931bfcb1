//! Warnings of maps that cannot show the shadows that are seen: too few codes of depth, or too few texels.
//!
//! Both are found by sampling: rays of the camera meet the items' bounding boxes, and from there rays to the light meet
//! the boxes of casters. A sample's shadow is lost where the front of its caster lies within the codes that rounding and
//! offset take; it is uncertain where half a texel decides whether it has a caster at all.

use glam::{DMat4, DVec3};

use super::bias;
use super::settings::{Mipmaps, Offset, Settings};
use crate::math::Aabb;
use crate::pass::{DepthFormat, PolygonOffset};
use crate::scene::LightKind;
use crate::techniques::projector::{Projector, Rays};
use crate::techniques::{FrustumView, Item, Notes};

/// Samples across the picture, and down.
const SAMPLES: [u32; 2] = [48, 36];

/// No more tests of a ray with a box than this, a few milliseconds: of many items fewer samples are taken.
const MOST_TESTS: usize = 300_000;

/// Shares of the samples in the light from which on more than 1.5 % of the pixels are wrong. Of 783 random scenes that they
/// were not chosen by, under every kind of light, with near planes down to 10^-5 in 16 bits and cones up to 179 degrees,
/// 6 are warned of and have fewer wrong pixels; 65 of the 78 that have more, for want of codes or texels, are warned of.
const MOST_LOST: f64 = 0.016;
/// The share of lost samples for maps without a slope factor, which have nothing else to lose shadows by.
const MOST_LOST_WITHOUT_FACTOR: f64 = 0.002;
const MOST_BURIED: f64 = 0.02;
const MOST_UNCERTAIN: f64 = 0.1;
/// The share of the lost and the buried samples and a tenth of the uncertain ones together. Measured with `glumbra stress`, of the named cases and
/// 60 random ones of seed 11: 10 of 4885 rows are warned of and have fewer wrong pixels. Shadows that a
/// mesh casts on itself are not sampled: of these nothing is said.
const MOST_IN_ALL: f64 = 0.015;
/// The share of buried samples, where many are uncertain.
const SOME_BURIED: f64 = 0.003;

/// For maps drawn without polygon offset. Layers within four codes are one; boxes are larger than what they hold, and the
/// far side that counts lies nearer to what it shadows than a box's front: as many again.
pub const WITHOUT_OFFSET: Offset = Offset { polygon: PolygonOffset { factor: 0.0, units: 7.0 }, texels: 0.0 };

/// Fewer samples than this prove nothing.
const LEAST: u32 = 4;

/// Says so where too much of what the light reaches and the camera sees is beyond what the map can tell.
pub fn warn(view: &FrustumView<'_>, settings: &Settings, offset: &Offset, notes: &mut Notes) {
    let Some(found) = sample(view, settings, offset) else { return };
    let share = |count: u32| if count < LEAST { 0.0 } else { f64::from(count) / f64::from(found.reached) };
    let (lost, buried, uncertain) = (share(found.lost), share(found.buried), share(found.uncertain));
    let in_all = lost + buried + 0.1 * uncertain > MOST_IN_ALL;
    let most_lost = if offset.polygon.factor == 0.0 { MOST_LOST_WITHOUT_FACTOR } else { MOST_LOST };
    if lost > most_lost || (in_all && lost > buried) {
        notes.warnings.push(format!(
            "light {}: one code of {} is up to {:.2} units wide at {:.2} units from the light, so that about {:.0} % of what \
             it reaches is lit by mistake, as near behind its caster as that: move `near` away, or take a format of more bits",
            view.index,
            name(settings.format),
            found.code,
            found.distance,
            100.0 * lost
        ));
    }
    if buried > MOST_BURIED
        || (in_all && buried >= lost && buried > SOME_BURIED)
        || (uncertain > MOST_UNCERTAIN && buried > SOME_BURIED)
    {
        notes.warnings.push(format!(
            "light {}: a texel of its map covers up to {:.0} pixels of the picture, and its shadows are that coarse: raise \
             `size`, narrow the cone, or move the light nearer",
            view.index, found.texel_pixels,
        ));
    }
}

fn name(format: DepthFormat) -> &'static str {
    match format {
        DepthFormat::Depth16 => "depth16",
        DepthFormat::Depth24 => "depth24",
        DepthFormat::Depth32 => "depth32",
        DepthFormat::Depth32F => "depth32f",
    }
}

/// What the samples say.
#[derive(Default)]
struct Found {
    /// Samples within the light's reach.
    reached: u32,
    /// Samples of these with a caster as near as what rounding takes of a depth.
    lost: u32,
    /// With a caster as near as what the offset takes.
    buried: u32,
    /// With a caster, or without, by half a texel.
    uncertain: u32,
    /// The widest texel of the buried and uncertain ones, in pixels.
    texel_pixels: f64,
    /// The widest code, in world units, of the lost ones, and how far from the light.
    code: f64,
    distance: f64,
}

/// A box that a ray may meet.
struct Boxed<'a> {
    item: &'a Item,
    model_from_world: DMat4,
}

impl Boxed<'_> {
    /// Where the ray `from + t way` enters and leaves the box.
    fn meets(&self, from: DVec3, way: DVec3) -> Option<(f64, f64)> {
        let (from, way) = (self.model_from_world.transform_point3(from), self.model_from_world.transform_vector3(way));
        let Aabb { min, max } = self.item.bounds;
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            if way[axis] == 0.0 {
                if from[axis] < min[axis] || from[axis] > max[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((min[axis] - from[axis]) / way[axis], (max[axis] - from[axis]) / way[axis]);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        (enter <= leave).then_some((enter, leave))
    }
}

impl Boxed<'_> {
    /// The normal of the face that `point` is nearest to, by shares of the box; of either sign.
    fn normal_at(&self, point: DVec3) -> DVec3 {
        let at = self.model_from_world.transform_point3(point);
        let Aabb { min, max } = self.item.bounds;
        let distance = |axis: &usize| {
            let size = max[*axis] - min[*axis];
            if size > 0.0 { (at[*axis] - min[*axis]).abs().min((max[*axis] - at[*axis]).abs()) / size } else { -1.0 }
        };
        let axis = (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(1);
        // A plane's normal goes with the inverse transpose.
        self.model_from_world.transpose().transform_vector3(DVec3::AXES[axis]).normalize_or_zero()
    }
}

fn sample(view: &FrustumView<'_>, settings: &Settings, offset: &Offset) -> Option<Found> {
    let boxes: Vec<Boxed<'_>> = view
        .items
        .iter()
        .map(|item| Boxed { item, model_from_world: item.world_from_model.inverse() })
        .filter(|boxed| boxed.model_from_world.is_finite())
        .collect();
    let camera = &view.scene.camera;
    let world_from_clip = (camera.clip_from_view(view.scene.aspect()) * camera.view_from_world()).inverse();
    let forward = (camera.target - camera.eye).normalize();
    let pixel = 2.0 * (0.5 * camera.fov_y_radians).tan() / f64::from(view.scene.image.size[1]);
    let samples = SAMPLES[0] * SAMPLES[1];
    // Six rays a sample.
    let stride = (6 * samples as usize * boxes.len()).div_ceil(MOST_TESTS).max(1);
    let projectors = projectors(view);
    let sampler = Sampler { settings, offset, boxes: &boxes, projectors: &projectors };
    let mut found = Found::default();
    for index in (0..samples).step_by(stride) {
        let at = [index % SAMPLES[0], index / SAMPLES[0]];
        let [x, y] = [0, 1].map(|k| 2.0 * (f64::from(at[k]) + 0.5) / f64::from(SAMPLES[k]) - 1.0);
        let [near, far] = [-1.0, 1.0].map(|z| world_from_clip.project_point3(DVec3::new(x, y, z)));
        let Some((boxed, point)) = seen(&boxes, near, far - near) else { continue };
        let width = pixel * (point - camera.eye).dot(forward);
        let slant = boxed.normal_at(point).dot((far - near).normalize_or_zero()).abs().max(0.05);
        sampler.examine(boxed.item, point, [width, width / slant], &mut found);
    }
    (found.reached > 0).then_some(found)
}

/// The nearest box and where the ray meets it; from within, where it leaves.
fn seen<'b, 'a>(boxes: &'b [Boxed<'a>], from: DVec3, way: DVec3) -> Option<(&'b Boxed<'a>, DVec3)> {
    let meets = boxes.iter().filter_map(|boxed| {
        let (enter, leave) = boxed.meets(from, way)?;
        let t = if enter >= 0.0 { enter } else { leave };
        (0.0..=1.0).contains(&t).then_some((boxed, t))
    });
    meets.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(boxed, t)| (boxed, from + t * way))
}

/// How one map sees a point: depth in [0, 1], the width of a texel there, and the map's axes across.
struct Place {
    depth: f64,
    texel: f64,
    across: [DVec3; 2],
    /// World units along the axis for one unit of depth.
    length: f64,
    distance: f64,
    /// The tangent of the angle between the light's ray and its axis.
    slant: f64,
}

/// `None` outside the map.
fn place(projector: &Projector, settings: &Settings, point: DVec3) -> Option<Place> {
    let clip = projector.clip_from_world() * point.extend(1.0);
    let inside = clip.w > 0.0 && clip.truncate().abs().max_element() <= clip.w;
    let rows = projector.light_from_world.transpose();
    let texel = bias::texel_at_one(projector, settings) * clip.w;
    // z = A w - B: depth is (1 + A - B / w) / 2. Of parallel light w is 1, and z linear.
    let length = match projector.rays {
        Rays::From { .. } => 2.0 * clip.w * clip.w / projector.clip_from_light.w_axis.z.abs(),
        Rays::Along(_) => 2.0 / projector.clip_from_light.z_axis.z.abs(),
    };
    let slant = match projector.rays {
        Rays::From { .. } => {
            let light = projector.light_from_world.transform_point3(point);
            light.truncate().length() / light.z.abs()
        }
        Rays::Along(_) => 0.0,
    };
    inside.then(|| Place {
        depth: 0.5 + 0.5 * clip.z / clip.w,
        texel,
        across: [rows.x_axis.truncate(), rows.y_axis.truncate()],
        length,
        distance: clip.w,
        slant,
    })
}

/// What every sample is held against.
struct Sampler<'a> {
    settings: &'a Settings,
    offset: &'a Offset,
    boxes: &'a [Boxed<'a>],
    projectors: &'a [Projector],
}

impl Sampler<'_> {
    /// A point of `item` where a pixel is `pixel` wide, and `longer` along the surface.
    fn examine(&self, item: &Item, point: DVec3, [pixel, longer]: [f64; 2], found: &mut Found) {
        let Self { settings, offset, boxes, projectors } = *self;
        let seen = |projector| Some((projector, place(projector, settings, point)?));
        let Some((projector, here)) = projectors.iter().find_map(seen) else { return };
        found.reached += 1;
        let front = |from: DVec3| front(boxes, item, from, projector.rays);
        // A lookup meets the two levels whose texels are about as wide as a pixel.
        let texel = match settings.mipmaps {
            Mipmaps::None => here.texel,
            Mipmaps::EightTaps => 2.0 * here.texel,
            Mipmaps::All => here.texel.max(2.0 * longer),
        };
        let caster = front(point);
        if let Some(caster) = caster {
            let step = code(settings.format);
            let before = place(projector, settings, caster).map_or(0.0, |place| place.depth);
            // Rounded when it is stored and when it is compared, and moved by the offset's units.
            if here.depth - before < (2.0 + f64::from(offset.polygon.units)) * step {
                found.lost += 1;
                if step * here.length > found.code {
                    (found.code, found.distance) = (step * here.length, here.distance);
                }
            }
            // The offset follows slopes: that of a plane across the light's ray, and 45 degrees more.
            let sloped = texel * f64::from(offset.polygon.factor).max(1.5) * (1.0 + here.slant);
            let taken = here.texel * offset.texels + sloped;
            if (caster - point).length() / (1.0 + here.slant * here.slant).sqrt() < taken {
                found.buried += 1;
                found.texel_pixels = found.texel_pixels.max(texel / pixel);
            }
        }
        let half = 0.5 * texel;
        let moves = here.across.into_iter().flat_map(|axis| [half * axis, -half * axis]);
        if moves.into_iter().any(|way| front(point + way).is_some() != caster.is_some()) {
            found.uncertain += 1;
            found.texel_pixels = found.texel_pixels.max(texel / pixel);
        }
    }
}

/// The point nearest to the light of the casters between a point of `own` and the light.
fn front(boxes: &[Boxed<'_>], own: &Item, from: DVec3, rays: Rays) -> Option<DVec3> {
    let (way, end) = match rays {
        Rays::From { position, .. } => (position - from, 1.0),
        Rays::Along(direction) => (-direction, f64::INFINITY),
    };
    let others = boxes.iter().filter(|boxed| boxed.item.casts_shadow && !std::ptr::eq(boxed.item, own));
    let leaves = others.filter_map(|boxed| boxed.meets(from, way)).filter(|(_, leave)| *leave > 1e-6 && *leave < end);
    leaves.map(|(_, leave)| leave).max_by(f64::total_cmp).map(|leave| from + leave * way)
}

/// The maps of a light: one, or a cube's six.
fn projectors(view: &FrustumView<'_>) -> Vec<Projector> {
    match &view.light().kind {
        LightKind::Point(point) => super::cube::projectors(point),
        _ => vec![view.projector.clone()],
    }
}

/// The least step of depth that is told apart: the format's, and no less than what the comparison's f32 is off by, half a
/// step of 2^-24 in the quotient and as much in each of its two terms and in the stored depth.
fn code(format: DepthFormat) -> f64 {
    match format {
        DepthFormat::Depth16 => 1.0 / 65535.0,
        _ => 2.0_f64.powi(-23),
    }
}
