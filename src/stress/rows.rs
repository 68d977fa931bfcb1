//! The settings that every light of a case is drawn with: each technique's default, then one change at a time.

use crate::scene::{LightKind, Scene};
use crate::techniques::{TABLE, Technique};

/// Second-depth maps serve closed casters, and refuse others with their names. A scene with an open caster is drawn with it
/// as it is: then the user's choice is not a default.
const ASSUMED: &str = "closed = \"assume\"";

/// One way to draw a light's shadow.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RowSettings {
    /// Name of the technique, as in a scene file.
    pub technique: String,
    /// Keys of `[light.shadow]` in TOML, ready for an inline table; empty: the technique's defaults.
    pub keys: String,
    /// True if the picture itself is judged, in the light of this lamp alone, and not its shade: the lit pass with its
    /// guard, its cone, and what it leaves out.
    #[serde(default)]
    pub pictured: bool,
}

impl RowSettings {
    /// The inside of an inline table.
    pub fn to_inline(&self) -> String {
        let comma = if self.keys.is_empty() { "" } else { ", " };
        format!("technique = \"{}\"{comma}{}", self.technique, self.keys)
    }

    /// Tests whether these are the settings that a scene without further keys gets.
    pub fn is_default(&self) -> bool {
        self.keys.is_empty() && !self.pictured
    }
}

/// A row from the inside of an inline table that begins with `technique = "…"`.
pub fn row_of(inside: &str) -> RowSettings {
    let rest = inside.strip_prefix("technique = \"").unwrap_or(inside);
    let (technique, keys) = rest.split_once('"').unwrap_or((rest, ""));
    RowSettings {
        technique: technique.to_owned(),
        keys: keys.trim_start_matches([',', ' ']).to_owned(),
        pictured: false,
    }
}

/// Keys of every map.
const MAP: &[&str] = &[
    "filter = \"nearest\"",
    "kernel = \"3x3\"",
    "kernel = \"5x5\"",
    "format = \"depth16\"",
    "format = \"depth32f\"",
    "transfer = \"copy\"",
    "format = \"depth\", transfer = \"copy\"",
    "compare = \"gequal\"",
    "casters = \"texel\"",
    "into = \"stencil\"",
    "size = 256",
];

/// Further keys of maps in one square.
const SQUARE: &[&str] = &[
    "bias = \"receiver-plane\"",
    "bias = \"normal-offset\"",
    "bias = \"adaptive\"",
    "bias = \"normal-offset\", kernel = \"5x5\"",
    "bias = \"adaptive\", filter = \"nearest\"",
    "fit = \"casters\"",
    "fit = \"view\"",
    "fit = \"view\", kernel = \"3x3\"",
    "mipmaps = \"8-tap\"",
    "addressing = \"direct3d\", matrix_bias = 0.0",
    "addressing = \"direct3d-viewport\"",
    "texgen = \"eye\"",
    "texgen = \"light\", texture_matrix = \"projection\"",
];

/// Keys of a spotlight's map only.
const SPOT: &[&str] = &[
    "mipmaps = true",
    "guard = \"spot-cutoff\"",
    "guard = \"texture-1d\"",
    "guard = \"clip-plane\"",
    "guard = \"stencil\"",
    "guard = \"cull\"",
    "guard = \"fragment\"",
];

const MIDPOINT: &[&str] = &[
    "average = \"eye-linear\"",
    "peel = \"compare\"",
    "filter = \"nearest\"",
    "kernel = \"3x3\"",
    "compare = \"gequal\"",
    "format = \"depth32f\"",
];

const SECOND_DEPTH: &[&str] = &["filter = \"nearest\"", "kernel = \"3x3\"", "fit = \"view\""];

const VOLUMES: &[&str] = &[
    "method = \"parity\"",
    "method = \"z-pass\"",
    "method = \"z-pass-two-sided\"",
    "method = \"z-pass-capped\"",
    "method = \"z-pass-capped\", ledge = [0.05, 0.1, 1.0]",
    "method = \"z-fail\"",
    "method = \"z-fail-clamped\"",
    "method = \"z-fail-truncated\"",
    "count = \"saturate\"",
    "passes = \"lit-unlit\"",
];

/// Rows of one light: all that matter, or with `defaults` each technique's own alone.
pub fn rows(scene: &Scene, kind: &LightKind, defaults: bool) -> Vec<RowSettings> {
    let serving = TABLE.iter().filter(|technique| technique.name() != "none" && technique.serves(kind).is_ok());
    serving.flat_map(|technique| rows_of(*technique, scene, kind, defaults)).collect()
}

fn rows_of(technique: &dyn Technique, scene: &Scene, kind: &LightKind, defaults: bool) -> Vec<RowSettings> {
    let name = technique.name();
    let (own, prefix) = match name {
        "shadow-map" => (map_keys(kind), ""),
        "midpoint" => (MIDPOINT.to_vec(), ""),
        "second-depth" if !all_closed(scene) => (SECOND_DEPTH.to_vec(), ASSUMED),
        "second-depth" => (SECOND_DEPTH.to_vec(), ""),
        "shadow-volume" => (VOLUMES.to_vec(), ""),
        _ => (Vec::new(), ""),
    };
    let row = |keys: &str| {
        let comma = if prefix.is_empty() || keys.is_empty() { "" } else { ", " };
        let keys = format!("{prefix}{comma}{keys}");
        // Guards act where light is added, and passes are what adds it: neither is where shade is found.
        let pictured = keys.starts_with("guard") || keys.starts_with("passes");
        RowSettings { technique: name.to_owned(), keys, pictured }
    };
    let mut rows = vec![row(""), RowSettings { pictured: true, ..row("") }];
    if !defaults {
        rows.extend(own.into_iter().map(row));
    }
    rows
}

fn map_keys(kind: &LightKind) -> Vec<&'static str> {
    let more: &[&[&str]] = match kind {
        LightKind::Point(_) => &[],
        LightKind::Directional { .. } => &[SQUARE],
        LightKind::Spot(_) => &[SQUARE, SPOT],
    };
    MAP.iter().chain(more.iter().copied().flatten()).copied().collect()
}

/// Tests whether every caster is closed and looks outwards, as second-depth maps need it.
fn all_closed(scene: &Scene) -> bool {
    let casters = scene.objects.iter().filter(|object| object.casts_shadow);
    { casters }.all(|object| object.wave.is_none() && object.mesh.is_closed() && object.mesh.signed_volume() > 0.0)
}
