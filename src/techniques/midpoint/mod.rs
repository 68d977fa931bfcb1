//! Woo's midpoint map, in two passes by depth peeling [Woo 1992; HSM, "Advantages and Limitations"].
//!
//! The nearest layer is drawn into one map. The second pass draws all casters again, rejects what that map holds (by the
//! texture unit's comparison as in [HSM, "Advantages and Limitations"], or in the shader: [`settings::Peel`]), and stores
//! the middle between the nearest depth and its own; the nearest fragment that is left is the second layer. A surface's own
//! depth then lies half a caster's thickness before what it is compared with, and no polygon offset is needed.
//!
//! # Pitfalls that the white paper does not mention
//! - A depth is rounded when it is stored, but the compared depth is not [GL 4.6, 8.23.1]: half of a first layer lies
//!   behind itself. So it is moved towards the light by two codes of 16 bits, or four steps of f32 near 1, which no
//!   rounding reaches: nor that by which two triangles in one plane differ.
//! - A texel with one layer alone has no middle: see [`settings::Single`]. The far plane has the least error (measured by
//!   the test layers) and costs nothing. It is right if everything that can be shadowed is a layer. So the second layer has
//!   objects that cast no shadow, too. If something lies beyond the far plane, both are drawn under GL_DEPTH_CLAMP: it is
//!   then a second layer at depth 1. An object that casts nothing is never a first layer: before the nearest caster it is
//!   peeled away with it, and lit.
//! - A caster whose shadow is not seen is left out of a plain map, but may be the second layer of another caster: see
//!   [`second::needed`].

mod second;
mod settings;
mod single;
mod texels;

use self::second::Layers;
use self::settings::{Average, Peel, Settings, Single};
use super::change::Change;
use super::claims::{Claim, Contender, Quantity, Relation};
use super::shadow_map::casters::is_before_near;
use super::shadow_map::depth::{self, DepthEnding, DepthLayer};
use super::shadow_map::settings::{Fit, Mipmaps, Offset, Order, Settings as Map};
use super::shadow_map::{self, bias, term};
use super::{Axis, ShadowSettings, Technique};
use crate::lights::{Drawable, FrustumView, LightTerm, LightView, MapInfo, Notes};
use crate::pass::{
    Compare, Define, DepthFormat, Filter, ImageId, Input, PassList, PolygonOffset, Sampler, Uniform, Wrap, glsl,
};
use crate::scene::{Frustum, LightKind, Reader, SettingsError};
use crate::techniques::shadow_map::forecast::{self, Alone, Stored};

pub struct Midpoint;

const BARE: Contender = Contender::Keys("technique = \"midpoint\"");

/// Claims of [HSM, "Advantages and Limitations"]. The edge band is counted apart, because at a caster's rim its two layers
/// meet.
const CLAIMS: &[Claim] = &[
    Claim::needs_no_offset(BARE),
    Claim {
        says: "needs none to lose no more light at shadow edges, either",
        quantity: Quantity::FalseShadowWithBand,
        first: BARE,
        relation: Relation::AtMost(1.0),
        second: Contender::SlopeScaled,
    },
    Claim {
        says: "leaves at most half of the leak where light falls",
        quantity: Quantity::LeakFacing,
        first: BARE,
        relation: Relation::AtMost(0.5),
        second: Contender::SlopeScaled,
    },
    Claim {
        says: "leaves at most half of the leak, with what is turned away",
        quantity: Quantity::Leak,
        first: BARE,
        relation: Relation::AtMost(0.5),
        second: Contender::SlopeScaled,
    },
];

impl Technique for Midpoint {
    fn name(&self) -> &'static str {
        "midpoint"
    }

    fn summary(&self) -> &'static str {
        "a map of the middle between the nearest and the second layer; no polygon offset"
    }

    fn source(&self) -> &'static str {
        "Hardware Shadow Mapping, on Woo"
    }

    fn serves(&self, kind: &LightKind) -> Result<(), &'static str> {
        shadow_map::has_one_map(kind)
    }

    fn axes(&self) -> &'static [Axis] {
        settings::AXES
    }

    fn changes(&self, _kind: &LightKind) -> Vec<Change> {
        settings::CHANGES.to_vec()
    }

    fn claims(&self) -> &'static [Claim] {
        CLAIMS
    }

    fn check(&self, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
        settings::read(keys).map(|_| ())
    }

    fn read(&self, keys: &mut Reader<'_>, kind: &LightKind) -> Result<Box<dyn ShadowSettings>, SettingsError> {
        let settings = settings::read(keys)?;
        refuse(&settings.map, keys)?;
        shadow_map::refuse(&settings.map, kind, keys)?;
        Ok(Box::new(settings))
    }
}

impl ShadowSettings for Settings {
    fn describe(&self, view: &LightView<'_>, list: &mut PassList, notes: &mut Notes) -> LightTerm {
        let settings = self;
        let Some(view) = &shadow_map::one_view(view, &settings.map, notes) else {
            return shadow_map::without_casters(view, notes);
        };
        let mut layers = second::layers(view, notes);
        if !view.shown_whole && !view.keep_all {
            layers.casters = second::needed(view, layers.casters, &settings.map, notes);
        }
        if layers.casters.is_empty() && !view.keep_all {
            return shadow_map::without_casters(view, notes);
        }
        let single = settings.single.unwrap_or(Single::Far);
        let shared = second::shared_texels(view, &layers, &settings.map);
        let clamped = is_clamped(view, &layers);
        note_chosen(view, &layers, notes);
        let mut draw = |name, image, ending: Option<DepthEnding>, offset, shared_alone| {
            let is_second = ending.is_some();
            let receivers: &[&Drawable] = if is_second { &layers.receivers } else { &[] };
            let layer =
                DepthLayer { ending, clamped, receivers, ..DepthLayer::plain(name, image, offset, &layers.casters) };
            let layer = match shared_alone && !view.keep_all {
                true => DepthLayer {
                    scissor: Some(shared.scissor),
                    casters: &shared.casters.whole,
                    in_parts: &shared.casters.in_parts,
                    receivers: if is_second { &shared.receivers.whole } else { &[] },
                    receivers_in_parts: if is_second { &shared.receivers.in_parts } else { &[] },
                    ..layer
                },
                false => layer,
            };
            depth::draw(view, &layer, &settings.map, list, notes)
        };
        // Without a second layer beside it, the nearest one is only stored itself.
        let nearest = draw("nearest layer", "nearest layer", None, NO_OFFSET, single != Single::First);
        let peel = peel(view, nearest, clamped, settings);
        let midpoint = draw("midpoint", "midpoint map", Some(peel), NO_OFFSET, true);
        let first = match single {
            Single::Far => None,
            Single::First => Some(nearest),
            Single::FirstOffset => {
                let offset = bias::offset(&settings.map).polygon;
                Some(draw("offset layer", "offset layer", None, offset, false))
            }
        };
        note_shared(view, shared.scissor, settings.map.size, notes);
        let map = match first {
            Some(first) => single::fill(view, first, midpoint, &settings.map, list),
            None => {
                let what = format!("the nearest layer in texels with one layer alone, {}", view.name());
                notes.left_out(what, "nothing lies behind it that it could shadow");
                midpoint
            }
        };
        forecast::warn(view, &forecast_of(view, settings, single, &layers.casters), notes);
        let mut term = term::term(view, map, &settings.map, 0.0);
        term.map_info = term.map_info.map(|info| MapInfo { middle: true, ..info });
        term
    }

    fn map(&self) -> Option<&Map> {
        Some(&self.map)
    }
}

/// The map that the pictures of both layers are forecast from.
fn forecast_of<'a>(
    view: &FrustumView<'_>,
    settings: &'a Settings,
    single: Single,
    casters: &'a [&'a Drawable],
) -> forecast::Map<'a> {
    let polygon = if single == Single::FirstOffset { bias::offset(&settings.map).polygon } else { NO_OFFSET };
    let stored = Stored::Middle {
        margin: f64::from(margin(settings.map.format)),
        eye_linear: settings.average == Average::EyeLinear,
        alone: if single == Single::Far { Alone::Far } else { Alone::Nearest },
    };
    let offset = Offset { polygon, texels: 0.0 };
    forecast::Map { settings: &settings.map, offset, stored, casters, projectors: vec![view.projector.clone()] }
}

/// Says how much of the map is left out because no two layers can share a texel of it.
fn note_shared(view: &FrustumView<'_>, [_, _, width, height]: [u32; 4], size: u32, notes: &mut Notes) {
    let share = f64::from(width) * f64::from(height) / (f64::from(size) * f64::from(size));
    if share < 1.0 {
        let what = format!("{:.1} % of the texels of {}'s two layers", 100.0 * (1.0 - share), view.name());
        notes.left_out(what, "no texel there can have a second layer");
    }
}

/// Refuses keys that the second pass cannot serve: it reads its own texel in a map of one level, and a fitted map may leave
/// out the second layer.
fn refuse(map: &Map, keys: &Reader<'_>) -> Result<(), SettingsError> {
    let message = "goes with technique = \"shadow-map\" or \"second-depth\", not with \"midpoint\"";
    match (map.mipmaps, map.fit) {
        (Mipmaps::None, Fit::None) => Ok(()),
        (Mipmaps::None, _) => Err(keys.error("fit", message)),
        _ => Err(keys.error("mipmaps", message)),
    }
}

const NO_OFFSET: PolygonOffset = PolygonOffset { factor: 0.0, units: 0.0 };

/// Tests whether both layers are drawn under GL_DEPTH_CLAMP: the same for both, whose depths must be equal to the bit.
fn is_clamped(view: &FrustumView<'_>, layers: &Layers<'_>) -> bool {
    layers.beyond_far.is_some() || layers.casters.iter().any(|item| is_before_near(view, item))
}

/// Notes what is drawn into the second layer in addition to the casters.
fn note_chosen(view: &FrustumView<'_>, layers: &Layers<'_>, notes: &mut Notes) {
    if let Some(name) = &layers.beyond_far {
        let why = format!("{name} reaches beyond the far plane: it is a second layer at depth 1");
        notes.chosen(format!("both layers of {}'s map", view.name()), "GL_DEPTH_CLAMP", why);
    }
    let mut names: Vec<&str> = layers.receivers.iter().map(|item| item.label.as_str()).collect();
    names.dedup();
    if !names.is_empty() {
        let of = format!("the second layer of {}'s map", view.name());
        let why = "they cast nothing, but are shadowed: the middle lies before them";
        notes.chosen(of, format!("with {}", names.join(", ")), why);
    }
}

/// Ending of the second pass's fragments.
fn peel(view: &FrustumView<'_>, nearest: ImageId, clamped: bool, settings: &Settings) -> DepthEnding {
    let (sign, behind) = match settings.map.order {
        Order::LessEqual => (1.0, Compare::Greater),
        Order::GreaterEqual => (-1.0, Compare::Less),
    };
    let input = |name: &'static str, compare| {
        let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare, lod_halves: None };
        Input { name: name.into(), image: nearest, sampler }
    };
    let mut ending = DepthEnding {
        label: "peel",
        fragment: glsl!("midpoint/peel.frag"),
        defines: Vec::new(),
        uniforms: vec![Uniform::new("margin", sign * margin(settings.map.format))],
        inputs: vec![input("nearest", None)],
    };
    if clamped {
        ending.defines.push(Define::flag("CLAMPED"));
    }
    if settings.map.order == Order::GreaterEqual {
        ending.defines.push(Define::flag("REVERSED"));
    }
    if settings.peel == Peel::Compare {
        ending.defines.push(Define::flag("COMPARE"));
        ending.inputs.push(input("nearest_compared", Some(behind)));
    }
    // Under parallel light window depth is linear: the mean of two is that of the middle point.
    if settings.average == Average::EyeLinear
        && let Some(Frustum { near, far, .. }) = view.light().frustum()
    {
        ending.defines.push(Define::flag("EYE_LINEAR"));
        ending.uniforms.push(Uniform::new("near_over_range", (near / (far - near)) as f32));
    }
    ending
}

/// Two codes of 16 bits: one for the rounding when a depth is stored [GL 4.6, 2.3.5.2: either of the two nearest], one for
/// that when it is fetched. With more bits, four steps of the f32 that drivers interpolate depth in: two triangles in one
/// plane, such as a face given in both windings, differ by as many.
fn margin(format: DepthFormat) -> f32 {
    match format {
        DepthFormat::Depth16 => 2.0 / 65535.0,
        DepthFormat::Depth24 | DepthFormat::Depth32 | DepthFormat::Depth32F => 4.0 / 16_777_216.0,
    }
}
