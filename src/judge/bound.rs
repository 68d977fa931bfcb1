//! The bound between right and wrong of each kind of renderer, and how a shadow map's own numbers explain a wrong pixel.

use crate::lights::map::Bias;
use crate::lights::{MapInfo, MapShape};
use crate::pass::{DepthFormat, Face};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::techniques::LightShadow;
use crate::truth::{Around, Blocker, Nearer};

/// The greatest part of the pixels compared that may be wrong although each is explained. A map whose band is wider is too
/// coarse for its picture.
pub const MOST_WRONG: f64 = 0.015;

/// The bound between right and wrong of one renderer. The module's documentation says what each explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// No pixel may be wrong, whichever way its surface faces: shadow volumes, ray tracing.
    Exact,
    /// A shadow map that glumbra's plan describes.
    Map(MapInfo),
    /// A technique with a map, which the plan left out because it would stay empty: no wrong pixel is explained, and only
    /// surfaces that face the light count.
    NoMap,
    /// A renderer of which no more is known.
    Band {
        /// Width of the band on each side of a true shadow edge, in pixels from the pixel's centre; not below 0.
        pixels: f64,
    },
}

impl Bound {
    /// The bound of light number `light` in glumbra's own picture of `scene` by `plan`.
    pub fn of_plan(scene: &Scene, plan: &Plan, light: usize) -> Self {
        let shadow = scene.lights.get(light).and_then(|light| LightShadow::of(&light.shadow));
        if shadow.is_some_and(|shadow| shadow.technique.is_exact()) {
            return Self::Exact;
        }
        plan.maps.iter().find(|map| map.light == light).map_or(Self::NoMap, |map| Self::Map(*map))
    }

    /// Tests whether surfaces that are turned away from the light count.
    pub(super) fn counts_turned_away(&self) -> bool {
        *self == Self::Exact
    }
}

/// Reach of one lookup of a map, one texel more, for positions round to a texel's neighbour: in lengths on the plane at
/// distance 1 along the light's axis, or in world units for parallel light.
pub(super) fn reach(map: &MapInfo) -> f64 {
    (map.reach_texels + 1.0) * map.texel * f64::from(1_u32 << (map.levels - 1).min(16))
}

/// Tests whether a map's own texels explain a wrong pixel. `middle`: by how much the middle between two layers is nearer to
/// the light than the point, where layers within the given distance are one; in world units.
pub(super) fn explains(map: &MapInfo, around: &Around, should_be_lit: bool, middle: impl Fn(f64) -> f64) -> bool {
    if around.edge {
        return true;
    }
    if map.middle && should_be_lit {
        // A depth is off by a code where it is stored, and by one where it is compared; layers within these are one.
        let codes = 2.0 * code(map, around.scale);
        return middle(codes) > -codes;
    }
    if should_be_lit {
        return around.rise > 0.0
            || (map.bias == Bias::Offset && around.nearer.iter().any(|near| shades(map, around, near)));
    }
    if map.middle && around.own_edge {
        return true;
    }
    let mut held = around.blockers.iter().filter(|blocker| holds(map, blocker)).peekable();
    held.peek().is_some() && held.all(|blocker| blocker.gap <= bias_reach(map, around, blocker))
}

/// Tests whether a surface beside a point shades it in spite of its own polygon offset. GL's slope is the greater of the
/// two along the map's axes, each for a step of one texel: at least 1/√2 of the slope itself, for the texel's shorter side.
fn shades(map: &MapInfo, around: &Around, near: &Nearer) -> bool {
    let factor = f64::from(map.polygon.factor) * std::f64::consts::FRAC_1_SQRT_2;
    near.by > around.scale * (map.texel_short * factor * near.slope + map.texel * map.texels)
}

/// Tests whether the map is drawn from a blocker's side.
fn holds(map: &MapInfo, blocker: &Blocker) -> bool {
    match map.cull {
        None => true,
        Some(Face::Front) => blocker.is_far_side,
        Some(Face::Back) => !blocker.is_far_side,
    }
}

/// Greatest distance before a point of a surface whose shadow the bias removes, in world units along the ray.
fn bias_reach(map: &MapInfo, around: &Around, blocker: &Blocker) -> f64 {
    let texel = map.texel * around.scale;
    // GL's slope is the steeper of both axes', of a texel's width; the caster's depth is stored a reach aside, and the
    // receiver is compared a reach aside.
    let caster = (f64::from(map.polygon.factor.abs()) + map.reach_texels) * blocker.slope;
    let receiver = match map.bias {
        Bias::Offset => map.reach_texels * around.slope,
        Bias::ReceiverPlane | Bias::NormalOffset | Bias::Adaptive => 2.0 * map.reach_texels * around.slope,
    };
    // Drivers take two codes for one unit: of 24 bits they are one `code`.
    let unit = if map.format == DepthFormat::Depth16 { 2.0 } else { 1.0 };
    let codes = (unit * f64::from(map.polygon.units.abs()) + 2.0) * code(map, around.scale);
    // Depths are differences along the axis, gaps along the ray.
    around.ray * (texel * (caster + receiver + map.texels + 1.0) + codes)
}

/// Length of one code of the map's depth along the light's axis at distance `depth`, in world units.
fn code(map: &MapInfo, depth: f64) -> f64 {
    let code = match map.format {
        DepthFormat::Depth16 => 2.0_f64.powi(-16),
        _ => 2.0_f64.powi(-23),
    };
    match map.shape {
        MapShape::Spot { near, far } | MapShape::Cube { near, far } => {
            code * depth * depth * (far - near) / (near * far)
        }
        MapShape::Parallel { depth } => code * depth,
    }
}
