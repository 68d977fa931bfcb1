//! The keys of `[light.shadow]` that shadow maps read.

pub use crate::lights::map::Bias;
use crate::math::texgen::{SetUp, Split};
use crate::pass::{DepthFormat, Face, Filter, PolygonOffset};
use crate::scene::{Reader, SettingsError, Value};
use crate::techniques::Axis;

/// Way in which the depth texture gets its texels [HSM, "Why Is Polygon Offset Needed?"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// The texture is drawn into directly.
    Fbo,
    /// glCopyTexSubImage2D from a framebuffer of the map's size.
    Copy,
}

/// Direction in which depth grows [LEC, "shadow API Usage"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// LEQUAL against a map of nearest depths.
    LessEqual,
    /// GEQUAL against a map drawn with its depth reversed.
    GreaterEqual,
}

/// Conventions by which the map is drawn and addressed [HSM, "Direct3D API Details"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Addressing {
    OpenGl,
    /// Pixel centres at integers, rows from the top, depth in integer units. Texel centres lie at halves there, so that
    /// half a texel must be compensated.
    Direct3d(HalfTexel),
}

/// Compensation for Direct3D's half texel [HSM, "Direct3D API Details"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HalfTexel {
    /// Half a texel in the texture matrix, when the map is addressed.
    Matrix,
    /// Half a texel in the viewport, when the map is drawn.
    Viewport,
}

/// Levels of a map, and their use [LEC, "Mipmapping for Depth Textures"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mipmaps {
    /// One level.
    None,
    /// Every level; the size of a pixel decides which two are used.
    All,
    /// Two levels, and halfway between them everywhere: eight taps.
    EightTaps,
}

/// Part of the light's frustum that the map covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// All of it.
    None,
    /// The part that holds casters.
    Casters,
    /// The part that holds casters and is lit and seen: the map then follows the camera.
    View,
}

/// `offset`, as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Polygon offset while the map is drawn.
    pub polygon: PolygonOffset,
    /// Movement of the receiver towards the light when it is compared, in widths of a texel at the receiver.
    pub texels: f64,
}

/// Destination of the comparison's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The lit pass looks the shade up.
    Shade,
    /// The stencil buffer: a tag that the light's own pass tests.
    Tag,
}

/// Texels a side of a map whose `size` is not written.
pub const DEFAULT_SIZE: u32 = 1024;

/// Settings of a map: how it is drawn and compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Texels a side.
    pub size: u32,
    pub format: DepthFormat,
    /// True if the texture is unsized, so that the driver chooses its bits: `format` is then that of the picture's depth
    /// buffer [LEC, "New Depth Texture Internal Texture Formats"].
    pub is_unsized: bool,
    pub transfer: Transfer,
    pub filter: Filter,
    pub order: Order,
    /// The offset as written; `None`: the default of `bias.rs`.
    pub offset: Option<Offset>,
    pub bias: Bias,
    /// Comparisons a side, 1..=7.
    pub kernel: u32,
    pub mipmaps: Mipmaps,
    pub fit: Fit,
    /// True if casters are drawn with no more triangles than the map's texels show.
    pub simplified: bool,
    pub cull: Option<Face>,
    pub set_up: SetUp,
    pub split: Split,
    /// Scale and bias of r in `S`.
    pub r_scale: f64,
    pub r_bias: f64,
    pub addressing: Addressing,
    /// Added to r after the projection: in [0, 1] depth for OpenGL addressing, in the map's codes for Direct3D's.
    pub matrix_bias: f64,
    pub into: Outcome,
}

impl Settings {
    /// The key and the value for which the shadow is counted in the stencil buffer, if it is.
    pub fn counts_by(&self) -> Option<&'static str> {
        (self.into == Outcome::Tag).then_some("into = \"stencil\"")
    }
}

/// Keys that decide the error: resolution, bits, filter, offset.
pub const AXES: &[Axis] = &[
    Axis { key: "size", values: &["256", "512", "1024", "2048", "4096"], quick: &["512", "1024"] },
    Axis { key: "format", values: &["\"depth16\"", "\"depth24\"", "\"depth32f\""], quick: &["\"depth24\""] },
    Axis { key: "filter", values: &["\"nearest\"", "\"linear\""], quick: &["\"nearest\"", "\"linear\""] },
    Axis {
        key: "offset",
        values: &[
            "{ factor = 0.0, units = 0.0 }",
            "{ factor = 1.1, units = 4.0 }",
            "{ factor = 2.0, units = 4.0 }",
            "{ factor = 4.0, units = 16.0 }",
        ],
        quick: &["{ factor = 1.1, units = 4.0 }", "{ factor = 2.0, units = 4.0 }"],
    },
];

/// Extra sweeps, all with the scene's own offset: `transfer`, which must not change any texel; one-bit stencil tags; kernel
/// sizes; other biases; mipmaps; fits; and for spotlights, last, guards against back projection.
pub const MORE_AXES: &[&[Axis]] = &[
    &[
        Axis { key: "size", values: &["256", "512", "1024", "2048", "4096"], quick: &["1024"] },
        Axis { key: "transfer", values: &["\"fbo\"", "\"copy\""], quick: &["\"copy\""] },
    ],
    &[
        Axis { key: "size", values: &["256", "512", "1024", "2048", "4096"], quick: &["1024"] },
        Axis { key: "into", values: &["\"stencil\""], quick: &["\"stencil\""] },
        Axis { key: "filter", values: &["\"nearest\"", "\"linear\""], quick: &["\"nearest\"", "\"linear\""] },
    ],
    &[
        Axis { key: "size", values: &["512", "1024", "2048"], quick: &["1024"] },
        Axis { key: "kernel", values: &["1", "\"3x3\"", "\"5x5\""], quick: &["1", "\"3x3\""] },
    ],
    &[
        Axis { key: "size", values: &["1024"], quick: &["1024"] },
        Axis {
            key: "bias",
            values: &["\"receiver-plane\"", "\"normal-offset\"", "\"adaptive\""],
            quick: &["\"receiver-plane\"", "\"normal-offset\"", "\"adaptive\""],
        },
    ],
    &[
        Axis { key: "size", values: &["1024"], quick: &["1024"] },
        Axis { key: "mipmaps", values: &["true", "\"8-tap\""], quick: &["\"8-tap\""] },
    ],
    &[
        Axis { key: "size", values: &["1024"], quick: &["1024"] },
        Axis { key: "fit", values: &["\"casters\"", "\"view\""], quick: &["\"view\""] },
        Axis { key: "casters", values: &["\"full\"", "\"texel\""], quick: &["\"texel\""] },
    ],
    &[
        Axis { key: "size", values: &["1024"], quick: &["1024"] },
        Axis {
            key: "guard",
            values: &["\"spot-cutoff\"", "\"texture-1d\"", "\"clip-plane\"", "\"stencil\"", "\"cull\"", "\"fragment\""],
            quick: &["\"fragment\"", "\"stencil\""],
        },
    ],
];

/// Reads the keys, each with its default.
///
/// # Errors
///
/// A value of the wrong type or out of its range, with its place.
pub fn read(keys: &mut Reader<'_>) -> Result<Settings, SettingsError> {
    let formats = [
        ("depth", (DepthFormat::Depth24, true)),
        ("depth16", (DepthFormat::Depth16, false)),
        ("depth24", (DepthFormat::Depth24, false)),
        ("depth32", (DepthFormat::Depth32, false)),
        ("depth32f", (DepthFormat::Depth32F, false)),
    ];
    let set_ups =
        [("eye", SetUp::Eye), ("world", SetUp::World), ("light", SetUp::Light), ("identity", SetUp::Identity)];
    let splits = [("identity", Split::Planes), ("scale-bias", Split::ScaleBias), ("projection", Split::Projection)];
    let orders = [("lequal", Order::LessEqual), ("gequal", Order::GreaterEqual)];
    let addressings = [
        ("opengl", Addressing::OpenGl),
        ("direct3d", Addressing::Direct3d(HalfTexel::Matrix)),
        ("direct3d-viewport", Addressing::Direct3d(HalfTexel::Viewport)),
    ];
    let biases = [
        ("offset", Bias::Offset),
        ("receiver-plane", Bias::ReceiverPlane),
        ("normal-offset", Bias::NormalOffset),
        ("adaptive", Bias::Adaptive),
    ];
    let (r_scale, r_bias) = read_r(keys)?;
    let (format, is_unsized) = keys.choice("format", &formats)?.unwrap_or((DepthFormat::Depth24, false));
    let settings = Settings {
        size: keys.integer("size", 1..=16384)?.map_or(DEFAULT_SIZE, |size| size as u32),
        format,
        is_unsized,
        transfer: keys
            .choice("transfer", &[("fbo", Transfer::Fbo), ("copy", Transfer::Copy)])?
            .unwrap_or(Transfer::Fbo),
        filter: keys
            .choice("filter", &[("linear", Filter::Linear), ("nearest", Filter::Nearest)])?
            .unwrap_or(Filter::Linear),
        order: keys.choice("compare", &orders)?.unwrap_or(Order::LessEqual),
        offset: read_offset(keys)?,
        bias: keys.choice("bias", &biases)?.unwrap_or(Bias::Offset),
        kernel: read_kernel(keys)?,
        mipmaps: read_mipmaps(keys)?,
        fit: keys
            .choice("fit", &[("none", Fit::None), ("casters", Fit::Casters), ("view", Fit::View)])?
            .unwrap_or(Fit::None),
        simplified: keys.choice("casters", &[("full", false), ("texel", true)])?.unwrap_or(false),
        cull: keys
            .choice("cull", &[("none", None), ("back", Some(Face::Back)), ("front", Some(Face::Front))])?
            .unwrap_or(None),
        set_up: keys.choice("texgen", &set_ups)?.unwrap_or(SetUp::World),
        split: keys.choice("texture_matrix", &splits)?.unwrap_or(Split::Planes),
        r_scale,
        r_bias,
        addressing: keys.choice("addressing", &addressings)?.unwrap_or(Addressing::OpenGl),
        matrix_bias: keys.number("matrix_bias", -1e10..=1e10)?.unwrap_or(0.0),
        into: keys.choice("into", &[("shader", Outcome::Shade), ("stencil", Outcome::Tag)])?.unwrap_or(Outcome::Shade),
    };
    check_mipmaps(&settings, keys)?;
    Ok(settings)
}

/// `kernel = 1` or `"1x1"` to `"7x7"`.
fn read_kernel(keys: &mut Reader<'_>) -> Result<u32, SettingsError> {
    if let Some(Value::Integer(_)) = keys.entry("kernel").map(|entry| &entry.value) {
        return Ok(keys.integer("kernel", 1..=7)?.map_or(1, |side| side as u32));
    }
    let names = [("1x1", 1), ("2x2", 2), ("3x3", 3), ("4x4", 4), ("5x5", 5), ("6x6", 6), ("7x7", 7)];
    Ok(keys.choice("kernel", &names)?.unwrap_or(1))
}

/// `mipmaps = true`, `false` or `"8-tap"`.
fn read_mipmaps(keys: &mut Reader<'_>) -> Result<Mipmaps, SettingsError> {
    if let Some(Value::String(_)) = keys.entry("mipmaps").map(|entry| &entry.value) {
        return Ok(keys.choice("mipmaps", &[("8-tap", Mipmaps::EightTaps)])?.unwrap_or(Mipmaps::None));
    }
    Ok(if keys.boolean("mipmaps")? == Some(true) { Mipmaps::All } else { Mipmaps::None })
}

/// Refuses keys that do not go with mipmaps.
fn check_mipmaps(settings: &Settings, keys: &Reader<'_>) -> Result<(), SettingsError> {
    if settings.mipmaps == Mipmaps::None {
        return Ok(());
    }
    let why = if settings.filter != Filter::Linear {
        "need filter = \"linear\""
    } else if settings.transfer != Transfer::Fbo {
        "need transfer = \"fbo\": each level is drawn into"
    } else if settings.addressing == Addressing::Direct3d(HalfTexel::Matrix) {
        "need addressing = \"opengl\" or \"direct3d-viewport\": half a texel in the matrix is another length at every level"
    } else if settings.bias != Bias::Offset {
        "need bias = \"offset\": the others reckon with the texels of one level"
    } else if settings.mipmaps == Mipmaps::All && settings.fit != Fit::None {
        "need fit = \"none\", or \"8-tap\": of the smallest level one texel reaches across the map"
    } else {
        return Ok(());
    };
    Err(keys.error("mipmaps", why))
}

/// `offset = { factor, units, texels }`; 0 for a key that the table leaves out.
fn read_offset(keys: &mut Reader<'_>) -> Result<Option<Offset>, SettingsError> {
    let Some(table) = keys.table("offset")? else { return Ok(None) };
    let mut offset = table.read();
    let factor = offset.number("factor", -1e6..=1e6)?.unwrap_or(0.0) as f32;
    let units = offset.number("units", -1e9..=1e9)?.unwrap_or(0.0) as f32;
    let texels = offset.number("texels", 0.0..=1e3)?.unwrap_or(0.0);
    offset.finish()?;
    Ok(Some(Offset { polygon: PolygonOffset { factor, units }, texels }))
}

/// `r = { scale, bias }`; one half each if absent [HSM, "Computing Transformations for Shadow Mapping"].
fn read_r(keys: &mut Reader<'_>) -> Result<(f64, f64), SettingsError> {
    let Some(table) = keys.table("r")? else { return Ok((0.5, 0.5)) };
    let mut r = table.read();
    let scale = r.number("scale", -16.0..=16.0)?.unwrap_or(0.5);
    let bias = r.number("bias", -16.0..=16.0)?.unwrap_or(0.5);
    r.finish()?;
    Ok((scale, bias))
}
