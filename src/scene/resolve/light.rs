//! `[[light]]`: one table, three kinds of light, each with its own keys.

use glam::{DVec2, DVec3};

use super::{beam, falloff};
use crate::scene::assets::Assets;
use crate::scene::ranges::LARGEST;
use crate::scene::settings::{Origin, Reader, Settings, SettingsError};
use crate::scene::{
    Dust, DustBlend, Error, FalloffLaw, Focus, Frustum, ImageFilter, Interpolation, Law, Light, LightKind, LightShape,
    Object, Point, ReadShadow, Spot, camera_framing,
};

/// Greatest colour component of a light.
const BRIGHTEST: f64 = 1e6;

const LAWS: [(&str, Law); 2] = [("lit", Law::Lit), ("slide", Law::Slide)];

const SHAPES: [(&str, LightShape); 2] = [("cone", LightShape::Cone), ("frustum", LightShape::Frustum)];

/// Least and greatest width over height of a frustum.
pub(super) const ASPECTS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

pub(super) const FILTERS: [(&str, ImageFilter); 3] =
    [("nearest", ImageFilter::Nearest), ("linear", ImageFilter::Linear), ("trilinear", ImageFilter::Trilinear)];

const INTERPOLATIONS: [(&str, Interpolation); 3] =
    [("perspective", Interpolation::Perspective), ("affine", Interpolation::Affine), ("segal", Interpolation::Segal)];

/// Keys of light that is projected through a frustum.
const PROJECTED: [&str; 7] = ["aspect", "image", "filter", "beam", "falloff", "interpolate", "frustum"];

/// The value of `kind`.
#[derive(Clone, Copy)]
enum KindKey {
    Spot,
    Point,
    Directional,
}

const KINDS: [(&str, KindKey); 3] =
    [("spot", KindKey::Spot), ("point", KindKey::Point), ("directional", KindKey::Directional)];

/// `[[light]]` as written; values that depend on the objects follow later.
pub(super) struct LightKeys {
    settings: Settings,
    /// The planes of its frustum are not known yet.
    kind: LightKind,
    /// Law of `falloff`, whose table needs the planes.
    falloff: Option<FalloffLaw>,
    near: Option<f64>,
    far: Option<f64>,
    name: String,
    ambient: [f32; 3],
    diffuse: [f32; 3],
    specular: [f32; 3],
    dust: Option<Dust>,
    law: Law,
    shadow: Settings,
}

/// Reads the light at `index`, from 0, and checks it as far as that is possible without the objects.
pub(super) fn read(table: &Settings, index: usize, assets: &mut Assets) -> Result<LightKeys, Error> {
    let mut reader = table.read();
    let kind = reader.choice("kind", &KINDS)?.unwrap_or(KindKey::Spot);
    let [near, far] = reader.near_and_far()?;
    let image = reader.file("image")?;
    let beam = reader.table("beam")?.filter(|_| matches!(kind, KindKey::Spot)).map(beam::read).transpose()?;
    let falloff = falloff::read(&mut reader)?;
    let mut kind = match kind {
        KindKey::Spot => LightKind::Spot(spot(&mut reader)?),
        KindKey::Point => LightKind::Point(point(&mut reader)?),
        KindKey::Directional => LightKind::Directional { direction: direction(&mut reader)? },
    };
    let name = reader.string("name")?.map_or_else(|| format!("light {index}"), str::to_owned);
    let color = reader.colour("color", BRIGHTEST)?.unwrap_or([1.0; 3]);
    let ambient = reader.colour("ambient", BRIGHTEST)?.unwrap_or([0.0; 3]);
    let diffuse = reader.colour("diffuse", BRIGHTEST)?.unwrap_or(color);
    let specular = reader.colour("specular", BRIGHTEST)?.unwrap_or(color);
    let dust = dust(&mut reader, &kind)?;
    let law = law(&mut reader, &kind)?;
    let specular = if law == Law::Slide { [0.0; 3] } else { specular };
    let shadow = shadow(&mut reader)?;
    reader.finish()?;
    if let LightKind::Spot(spot) = &mut kind {
        spot.image = image.map(|(name, origin)| assets.texture(name, origin)).transpose()?;
        spot.beam = beam.map(|keys| beam::bake(keys, spot, &name, assets)).transpose()?;
    }
    let settings = table.clone();
    Ok(LightKeys { settings, kind, falloff, near, far, name, ambient, diffuse, specular, dust, law, shadow })
}

impl LightKeys {
    /// The light, its maps' range around `objects` if that is missing, its shadow settings read by `shadows`.
    pub fn complete(mut self, objects: &[Object], shadows: &dyn ReadShadow) -> Result<Light, SettingsError> {
        self.find_planes(objects)?;
        let Self { kind, name, ambient, diffuse, specular, dust, law, shadow, .. } = self;
        check_law(law, &shadow)?;
        let shadow = shadows.read(shadow, &kind, objects)?;
        Ok(Light { kind, ambient, diffuse, specular, name, dust, law, shadow })
    }

    fn find_planes(&mut self, objects: &[Object]) -> Result<(), SettingsError> {
        let (found, near, far) = match &mut self.kind {
            LightKind::Point(point) => {
                (camera_framing::cube_range(point.position, objects), &mut point.near, &mut point.far)
            }
            LightKind::Spot(spot) => {
                let found = camera_framing::spot_range(spot, objects);
                let frustum = &mut spot.frustum;
                (found, &mut frustum.near, &mut frustum.far)
            }
            LightKind::Directional { .. } => return Ok(()),
        };
        *near = self.near.unwrap_or_else(|| self.far.map_or(found[0], |far| found[0].min(far / 2.0)));
        *far = self.far.unwrap_or_else(|| found[1].max(2.0 * *near));
        self.settings.read().check_far(*near, *far)?;
        if let LightKind::Spot(spot) = &mut self.kind {
            spot.falloff = self.falloff.take().map(|law| falloff::tabulate(law, &spot.frustum));
        }
        Ok(())
    }
}

fn spot(reader: &mut Reader<'_>) -> Result<Spot, SettingsError> {
    reader.refuse(&["direction"], "is no key of a spotlight, which has a `target`")?;
    let cone_radians = reader
        .angle_between("cone", 1.0, 179.0)?
        .ok_or_else(|| reader.missing("cone", "the full angle of the light's frustum, in degrees"))?;
    let shape = reader.choice("shape", &SHAPES)?.unwrap_or(LightShape::Cone);
    let aspect = aspect(reader, shape)?;
    let position = position(reader)?;
    let target = reader.vector("target")?.ok_or_else(|| reader.missing("target", "what the light points at"))?;
    let up = reader.up(["position", "target"], position, target)?;
    let frustum = Frustum { position, target, up, cone_radians, aspect, near: 0.0, far: 0.0, lean: DVec2::ZERO };
    let attenuation = attenuation(reader)?;
    let frustum_shown = reader.choice("frustum", &[("hidden", false), ("shown", true)])?.unwrap_or(false);
    let image_filter = reader.choice("filter", &FILTERS)?;
    if image_filter.is_some() && reader.string("image")?.is_none() {
        return Err(reader.error("filter", "is of the light's `image`, which is missing"));
    }
    let image_filter = image_filter.unwrap_or(ImageFilter::Linear);
    let focus = focus(reader)?;
    let interpolation = reader.choice("interpolate", &INTERPOLATIONS)?.unwrap_or(Interpolation::Perspective);
    let (image, beam, falloff) = (None, None, None);
    Ok(Spot { frustum, shape, attenuation, image, image_filter, beam, falloff, interpolation, frustum_shown, focus })
}

/// Width over height of a light's frustum; only of one that ends at its sides.
fn aspect(reader: &mut Reader<'_>, shape: LightShape) -> Result<f64, SettingsError> {
    let Some(aspect) = reader.number("aspect", ASPECTS)? else { return Ok(1.0) };
    if shape == LightShape::Cone && aspect != 1.0 {
        return Err(reader.error("aspect", "is of a light with shape = \"frustum\": a cone is round"));
    }
    Ok(aspect)
}

fn point(reader: &mut Reader<'_>) -> Result<Point, SettingsError> {
    let others = ["cone", "shape", "target", "up", "focus", "direction"];
    reader.refuse(&[&others[..], &PROJECTED].concat(), "is no key of a point light, which shines every way alike")?;
    Ok(Point { position: position(reader)?, near: 0.0, far: 0.0, attenuation: attenuation(reader)? })
}

/// `direction`, or the direction from `position` to `target`.
fn direction(reader: &mut Reader<'_>) -> Result<DVec3, SettingsError> {
    let others = ["cone", "shape", "up", "near", "far", "focus", "attenuation"];
    reader.refuse(
        &[&others[..], &PROJECTED].concat(),
        "is no key of a directional light, whose rays are parallel and come from infinitely far",
    )?;
    let (position, target) = (reader.vector("position")?, reader.vector("target")?);
    if let Some(direction) = reader.vector("direction")? {
        reader.refuse(&["position", "target"], "cannot stand beside `direction`: write the one or the others")?;
        return direction.try_normalize().ok_or_else(|| reader.error("direction", "must not be of zero length"));
    }
    match (position, target) {
        (Some(position), Some(target)) => (target - position)
            .try_normalize()
            .ok_or_else(|| reader.error("target", "must differ from `position`: it is the way that the light travels")),
        (Some(_), None) => Err(reader.missing("target", "where the light travels to from `position`")),
        (None, Some(_)) => Err(reader.missing("position", "where the light travels from, to `target`")),
        (None, None) => Err(reader.missing("direction", "the way that the light travels, [x, y, z]")),
    }
}

fn position(reader: &mut Reader<'_>) -> Result<DVec3, SettingsError> {
    reader.vector("position")?.ok_or_else(|| reader.missing("position", "where the light stands"))
}

fn attenuation(reader: &mut Reader<'_>) -> Result<[f32; 3], SettingsError> {
    let factors: [f64; 3] = reader.numbers("attenuation", 0.0..=LARGEST)?.unwrap_or([1.0, 0.0, 0.0]);
    let factors = factors.map(|factor| factor as f32);
    if factors.iter().all(|factor| *factor == 0.0) {
        return Err(reader.error("attenuation", "must not be all zero: light is divided by it"));
    }
    Ok(factors)
}

/// Greatest number of lens points.
const MOST_LENS_POINTS: i64 = 4096;

/// `focus`.
fn focus(reader: &mut Reader<'_>) -> Result<Option<Focus>, SettingsError> {
    let Some(table) = reader.table("focus")? else { return Ok(None) };
    let mut keys = table.read();
    let distance = keys
        .length("distance")?
        .ok_or_else(|| keys.missing("distance", "where the focal plane lies along the light's axis"))?;
    let radius = keys
        .number("radius", 0.0..=LARGEST)?
        .ok_or_else(|| keys.missing("radius", "of the lens that the light comes through, in world units"))?;
    let samples = keys.integer("samples", 1..=MOST_LENS_POINTS)?.unwrap_or(64) as u32;
    keys.finish()?;
    Ok(Some(Focus { distance, radius, samples }))
}

/// Greatest number of slices of a beam.
const MOST_SLICES: i64 = 4096;

/// `[light.dust]`.
fn dust(reader: &mut Reader<'_>, kind: &LightKind) -> Result<Option<Dust>, SettingsError> {
    let Some(table) = reader.table("dust")? else { return Ok(None) };
    if !matches!(kind, LightKind::Spot(_)) {
        let kind = kind.name();
        let message = format!("needs a spotlight, whose beam slices can fill, and this is a {kind} light");
        return Err(reader.error("dust", message));
    }
    if matches!(kind, LightKind::Spot(Spot { focus: Some(_), .. })) {
        return Err(reader.error("dust", "cannot stand beside `focus`: slices show a beam from one point alone"));
    }
    let mut keys = table.read();
    let density = keys
        .number("density", 0.0..=LARGEST)?
        .ok_or_else(|| keys.missing("density", "the share of light that dust takes in a world unit, as an exponent"))?;
    let slices = keys.integer("slices", 1..=MOST_SLICES)?.unwrap_or(64) as u32;
    let blend = keys.choice("blend", &[("over", DustBlend::Over), ("add", DustBlend::Add)])?.unwrap_or(DustBlend::Over);
    let hides_in_shadow = keys.choice("extinct", &[("lit", false), ("all", true)])?.unwrap_or(false);
    let thickness_along_ray = keys.choice("thickness", &[("ray", true), ("axis", false)])?.unwrap_or(true);
    let jitter = keys.boolean("jitter")?.unwrap_or(false);
    keys.finish()?;
    Ok(Some(Dust { density, slices, blend, hides_in_shadow, thickness_along_ray, jitter }))
}

/// Refuses a shadow of a light that nothing occludes.
fn check_law(law: Law, shadow: &Settings) -> Result<(), SettingsError> {
    const NONE: &str = "none";
    let mut keys = shadow.read();
    let name = keys.string("technique")?.unwrap_or(NONE);
    if law == Law::Lit || name == NONE {
        return Ok(());
    }
    let message = format!(
        "cannot be \"{name}\" for a light of law = \"slide\", which passes through everything: choose \"{NONE}\", or law = \"lit\""
    );
    Err(keys.error("technique", message))
}

/// `law`: a projector is a spotlight, and all of its light is in its image.
fn law(reader: &mut Reader<'_>, kind: &LightKind) -> Result<Law, SettingsError> {
    let law = reader.choice("law", &LAWS)?.unwrap_or_default();
    if law == Law::Slide {
        if !matches!(kind, LightKind::Spot(_)) {
            let kind = kind.name();
            return Err(
                reader.error("law", format_args!("= \"slide\" is no law of a {kind} light: choose kind = \"spot\""))
            );
        }
        let why = "has no meaning beside law = \"slide\": a projector has one colour, `color`, and [shading] has the ambient light";
        reader.refuse(&["ambient", "specular"], why)?;
    }
    Ok(law)
}

/// `[light.shadow]` as written; empty, at the light's place, where it is absent.
fn shadow(reader: &mut Reader<'_>) -> Result<Settings, SettingsError> {
    let origin: Origin = reader.origin().clone();
    let absent = || Settings { path: String::from("light.shadow"), origin, entries: Vec::new() };
    Ok(reader.table("shadow")?.cloned().unwrap_or_else(absent))
}
