//! The settings that every light of a case is drawn with: each technique's default, then one change at a time.

use crate::scene::{LightKind, Scene};
use crate::techniques::{TABLE, Technique};

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

    /// Tests whether the shadow has no texels that a wrong pixel could be explained by.
    pub fn is_exact(&self) -> bool {
        TABLE.iter().any(|technique| technique.name() == self.technique && technique.is_exact())
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

/// Rows of one light: all that matter, or with `defaults` each technique's own alone.
pub fn rows(scene: &Scene, kind: &LightKind, defaults: bool) -> Vec<RowSettings> {
    let serving = TABLE.iter().filter(|technique| technique.draws_shadows() && technique.serves(kind).is_ok());
    serving.flat_map(|technique| rows_of(*technique, scene, kind, defaults)).collect()
}

fn rows_of(technique: &dyn Technique, scene: &Scene, kind: &LightKind, defaults: bool) -> Vec<RowSettings> {
    let needed = technique.needed_keys(&scene.objects);
    let row = |keys: &str, pictured: bool| {
        let comma = if needed.is_empty() || keys.is_empty() { "" } else { ", " };
        RowSettings { technique: technique.name().to_owned(), keys: format!("{needed}{comma}{keys}"), pictured }
    };
    let mut rows = vec![row("", false), row("", true)];
    if !defaults {
        rows.extend(technique.changes(kind).into_iter().map(|change| row(change.keys, change.pictured)));
    }
    rows
}
