//! `bump` and `gloss` of a material, and the keys of [shading] that say how bumps are lit.

use std::sync::Arc;

use crate::combiners::{self, CombinerProgram, Precision};
use crate::geometry::bump::{Bump, BumpSource, Gloss, NormalFormat};
use crate::geometry::normal_map::{Difference, HeightWrap, MipColors};
use crate::geometry::tangents::BasisFit;
use crate::geometry::{Texture, read_text};
use crate::scene::assets::{Assets, BumpKey};
use crate::scene::settings::{Origin, Reader, Settings, SettingsError, Value};
use crate::scene::{BumpMethod, BumpShading, Error, Normalize};

/// Greatest height in texels that a height of 1 stands for.
const MOST_SCALE: f64 = 1e6;

/// Greatest side of a normalisation cube map.
const MOST_CUBE: i64 = 1024;

/// `bump = { height = FILE, scale, difference }` or `bump = { normal_map = FILE, green }`, each with `format`, `mipmaps`,
/// `border` and `basis`.
pub(super) fn read(table: &Settings, assets: &mut Assets) -> Result<Arc<Bump>, Error> {
    let mut reader = table.read();
    let (height, normal_map) = (reader.file("height")?, reader.file("normal_map")?);
    let scale = reader.number("scale", -MOST_SCALE..=MOST_SCALE)?;
    let difference =
        reader.choice("difference", &[("forward", Difference::Forward), ("central", Difference::Central)])?;
    let green = reader.choice("green", &[("up", false), ("down", true)])?;
    let format = reader.choice("format", &[("snorm8", NormalFormat::Signed), ("unorm8", NormalFormat::Unsigned)])?;
    let colors = [("unit-and-length", MipColors::UnitAndLength), ("mean", MipColors::Mean)];
    let colors = reader.choice("mipmaps", &colors)?.unwrap_or_default();
    let border = [("repeat", HeightWrap::Repeat), ("clamp", HeightWrap::Clamp)];
    let border = reader.choice("border", &border)?.unwrap_or_default();
    let fits =
        [("orthogonal", BasisFit::Orthogonal), ("skewed", BasisFit::Skewed), ("per-polygon", BasisFit::PerPolygon)];
    let fit = reader.choice("basis", &fits)?.unwrap_or_default();
    let (format, is_height) = (format.unwrap_or_default(), height.is_some());
    let (scale_bits, difference) = (scale.map(f64::to_bits), difference);
    let file = height.or(normal_map).map(|(name, origin)| crate::scene::assets::file(name, origin));
    let key = BumpKey { file, is_height, scale_bits, difference, green, format, colors, border, fit };
    let source = match (height, normal_map) {
        (Some((name, origin)), None) => {
            reader.refuse(&["green"], "is read with `normal_map`, not with `height`")?;
            reader.finish()?;
            if let Some(known) = assets.bumps.get(&key) {
                return Ok(known.clone());
            }
            let field = assets.heights(name, origin)?;
            let (scale, difference) = (scale.unwrap_or(1.0), difference.unwrap_or_default());
            BumpSource::Heights { field, scale, difference }
        }
        (None, Some((name, origin))) => {
            reader.refuse(&["scale", "difference"], "is read with `height`, not with `normal_map`")?;
            reader.finish()?;
            if let Some(known) = assets.bumps.get(&key) {
                return Ok(known.clone());
            }
            let texture = assets.texture(name, origin)?;
            warn_of_no_normals(&texture, origin, assets);
            BumpSource::normals(&texture, green.unwrap_or(false))
        }
        (Some(_), Some(_)) => {
            return Err(reader.error("height", "and `normal_map` exclude each other: write one of them").into());
        }
        (None, None) => {
            let what = "a picture of heights, or `normal_map`, one of normals";
            return Err(reader.missing("height", what).into());
        }
    };
    let bump = Arc::new(Bump::new(source, format, colors, border, fit));
    assets.bumps.insert(key, bump.clone());
    Ok(bump)
}

/// Warns of a picture that looks like no normal map.
fn warn_of_no_normals(texture: &Texture, origin: &Origin, assets: &mut Assets) {
    let texels = texture.rgba.as_chunks::<4>().0;
    let part = |code: u8| f64::from(code) / 127.5 - 1.0;
    let is_off = |[red, green, blue, _]: &&[u8; 4]| {
        let length = part(*red).hypot(part(*green)).hypot(part(*blue));
        !(0.5..=1.5).contains(&length) || *blue < 127
    };
    let off = texels.iter().filter(is_off).count();
    if 10 * off > texels.len() {
        let (share, name) = (100.0 * off as f64 / texels.len() as f64, &texture.name);
        assets.warn(format!(
            "{origin}: {share:.0} % of the texels of {name} are no outward unit normals: is it a height field? Then name it as `height`."
        ));
    }
}

/// `gloss` as written.
#[derive(Clone, Copy)]
pub(super) enum WrittenGloss<'a> {
    DecalAlpha,
    File(&'a str, &'a Origin),
}

/// `gloss = "decal-alpha"` or `gloss = FILE`.
pub(super) fn gloss<'a>(reader: &mut Reader<'a>) -> Result<Option<WrittenGloss<'a>>, SettingsError> {
    let written = reader.file("gloss")?;
    Ok(written.map(|(name, origin)| match name {
        "decal-alpha" => WrittenGloss::DecalAlpha,
        name => WrittenGloss::File(name, origin),
    }))
}

impl WrittenGloss<'_> {
    pub fn load(self, assets: &mut Assets) -> Result<Gloss, Error> {
        Ok(match self {
            Self::DecalAlpha => Gloss::DecalAlpha,
            Self::File(name, origin) => Gloss::Map(assets.texture(name, origin)?),
        })
    }
}

/// `bump`, `self_shadow`, `normalize`, `precision`, `combiners` and `two_units` of [shading].
pub(super) fn shading(reader: &mut Reader<'_>) -> Result<BumpShading, Error> {
    let methods = [("reference", 0), ("one-pass", 1), ("three-pass", 3)];
    let passes = reader.choice("bump", &methods)?.unwrap_or(0);
    let self_shadow = reader.boolean("self_shadow")?.unwrap_or(true);
    let normalize = normalize(reader)?;
    let precision = reader.choice("precision", &[("float", Precision::Float), ("9-bit", Precision::NineBits)])?;
    let combiners = reader.file("combiners")?;
    let two_units = reader.boolean("two_units")?;
    if passes == 0 {
        let message = "belongs to register combiners: choose bump = \"one-pass\" or \"three-pass\"";
        reader.refuse(&["normalize", "precision"], message)?;
    }
    if passes != 1 {
        reader.refuse(&["combiners"], "replaces the program of bump = \"one-pass\"")?;
    }
    if passes != 3 {
        reader.refuse(&["two_units"], "belongs to bump = \"three-pass\"")?;
    }
    if passes != 0 {
        let message = "belongs to bump = \"reference\": programs of register combiners have the factor or not";
        reader.refuse(&["self_shadow"], message)?;
    }
    let has_own_program = combiners.is_some();
    let method = match (passes, combiners) {
        (1, Some((name, origin))) => BumpMethod::OnePass(load_combiners(name, origin)?),
        (1, None) => BumpMethod::OnePass(built_in(ONE_PASS)?),
        (3, _) => {
            let specular = if two_units == Some(true) { SPECULAR_TWO_UNITS } else { SPECULAR };
            BumpMethod::ThreePass { diffuse: built_in(DIFFUSE)?, specular: built_in(specular)? }
        }
        _ => BumpMethod::Reference,
    };
    let (normalize, precision) = (normalize.unwrap_or_default(), precision.unwrap_or_default());
    Ok(BumpShading { method, self_shadow, normalize, precision, has_own_program })
}

/// A program of glumbra's own: its name and text.
type BuiltIn = (&'static str, &'static str);

const ONE_PASS: BuiltIn = ("gdc2001.rc", include_str!("../../../data/combiners/gdc2001.rc"));
const DIFFUSE: BuiltIn = ("gdc2001-diffuse.rc", include_str!("../../../data/combiners/gdc2001-diffuse.rc"));
const SPECULAR: BuiltIn = ("gdc2001-specular.rc", include_str!("../../../data/combiners/gdc2001-specular.rc"));
const SPECULAR_TWO_UNITS: BuiltIn =
    ("gdc2001-specular-two-units.rc", include_str!("../../../data/combiners/gdc2001-specular-two-units.rc"));

fn built_in((name, text): BuiltIn) -> Result<Arc<CombinerProgram>, SettingsError> {
    read_program(name, text).map_err(|message| SettingsError::new(&Origin::BuiltIn, message))
}

/// `normalize = "exact"` or `{ cube, seamless }`.
fn normalize(reader: &mut Reader<'_>) -> Result<Option<Normalize>, SettingsError> {
    let what = "must be \"exact\" or { cube = SIZE, seamless = true or false }";
    let table = match reader.entry("normalize").map(|entry| &entry.value) {
        None => return Ok(None),
        Some(Value::String(word)) if word == "exact" => return Ok(Some(Normalize::Exact)),
        Some(Value::Table(table)) => table,
        Some(_) => return Err(reader.error("normalize", what)),
    };
    let mut keys = table.read();
    let size = keys.integer("cube", 1..=MOST_CUBE)?.ok_or_else(|| keys.missing("cube", "texels a side"))? as u32;
    if !size.is_power_of_two() {
        return Err(keys.error("cube", format_args!("must be a power of two, not {size}")));
    }
    let seamless = keys.boolean("seamless")?.unwrap_or(true);
    keys.finish()?;
    Ok(Some(Normalize::Cube { size, seamless }))
}

/// Reads a program of register combiners.
fn load_combiners(name: &str, origin: &Origin) -> Result<Arc<CombinerProgram>, SettingsError> {
    let path = crate::scene::assets::file(name, origin);
    let text = read_text(&path).map_err(|error| SettingsError::new(origin, error.to_string()))?;
    read_program(&path.display().to_string(), &text).map_err(|message| SettingsError::new(origin, message))
}

fn read_program(name: &str, text: &str) -> Result<Arc<CombinerProgram>, String> {
    let program = combiners::parse(text).map_err(|error| format!("{name}:{error}"))?;
    combiners::check(&program, combiners::MOST_STAGES).map_err(|error| format!("{name}: {error}"))?;
    Ok(Arc::new(program))
}
