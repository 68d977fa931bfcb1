//! Numbers that `glumbra repack` prints of a skin before and after.

use std::path::PathBuf;

use serde::Serialize;

use super::path_text::{PathBytes, path_text};
use crate::geometry::skin::{CLASS_ENDS, Discontinuity, Repacked, Skin};

/// Numbers of both skins.
#[derive(Serialize)]
pub(super) struct Report {
    islands: usize,
    /// Groups of islands that share texels.
    pieces: usize,
    /// Pieces turned by other than quarter turns.
    turned: usize,
    scale: f64,
    /// Triangles that rounding has left without an area or turned over.
    flattened: usize,
    before: SkinReport,
    after: SkinReport,
    files: Vec<String>,
    /// The paths above that are not UTF-8.
    #[serde(skip_serializing_if = "PathBytes::is_empty")]
    path_bytes: PathBytes,
}

/// Numbers of one skin.
#[derive(Serialize)]
struct SkinReport {
    size: [u32; 2],
    texels_per_unit: f64,
    mirrored_triangles: usize,
    across_edges: Discontinuity,
}

impl SkinReport {
    fn new(skin: &Skin) -> Self {
        Self {
            size: skin.size(),
            texels_per_unit: skin.density(),
            mirrored_triangles: skin.mirrored(),
            across_edges: skin.discontinuity(),
        }
    }
}

impl Report {
    /// Measures both skins. `files`: those that were written.
    pub fn new(old: &Skin, new: &Repacked, files: &[PathBuf]) -> Self {
        let mut path_bytes = PathBytes::new();
        Self {
            islands: new.islands,
            pieces: new.pieces,
            turned: new.turned,
            scale: new.scale,
            flattened: new.flattened,
            before: SkinReport::new(old),
            after: SkinReport::new(&new.skin),
            files: files.iter().map(|file| path_text(file, &mut path_bytes)).collect(),
            path_bytes,
        }
    }
}

/// Warns where the new skin is worse than the old one.
pub(super) fn warn(report: &Report) {
    if report.flattened > 0 {
        let count = report.flattened;
        super::say(format_args!(
            "warning: {count} triangles are so small that rounding leaves them no area on the skin, or turns them over; \
             --steps rounds less"
        ));
    }
    let [before, after] = [&report.before, &report.after].map(|skin| skin.across_edges.mean_degrees);
    if after > before + GROWTH_DEGREES {
        super::say(format_args!(
            "warning: the mean angle grew from {before:.3} to {after:.3} degrees; --steps or a larger --size rounds less"
        ));
    }
}

/// Growth of the mean angle in degrees below which it is that of f32 texture coordinates.
const GROWTH_DEGREES: f64 = 1e-3;

/// The table of before and after.
pub(super) fn print(report: &Report) -> String {
    let Report { islands, pieces, turned, scale, before, after, files, .. } = report;
    let row =
        |what: &str, of: &dyn Fn(&SkinReport) -> String| format!("{what:<28}{:>16}{:>16}\n", of(before), of(after));
    let edges = |count: usize, share: f64| format!("{count} {:>6.2} %", 100.0 * share);
    let mut text =
        format!("# {islands} islands in {pieces} pieces, {turned} of them turned by other than quarter turns\n");
    text += &format!("# scale {scale:.4}\n{:<28}{:>16}{:>16}\n", "", "before", "after");
    text += &row("size in texels", &|skin| format!("{}x{}", skin.size[0], skin.size[1]));
    text += &row("texels a unit of length", &|skin| format!("{:.3}", skin.texels_per_unit));
    text += &row("mirrored triangles", &|skin| skin.mirrored_triangles.to_string());
    text += "# Edges by the angle between the t axes of their triangles: their number, and their share of the length\n";
    let mut low = 0.0;
    for (index, high) in CLASS_ENDS.iter().enumerate() {
        let class = |skin: &SkinReport| {
            let class = skin.across_edges.classes[index];
            edges(class.edges, class.share)
        };
        text += &row(&format!("{low} to {high} degrees"), &class);
        low = *high;
    }
    let mirrored = |skin: &SkinReport| edges(skin.across_edges.mirrored_pairs, skin.across_edges.mirrored_share);
    text += &row("mirrored against each other", &mirrored);
    text += &row("without a basis", &|skin| skin.across_edges.without.to_string());
    text += &row("mean angle in degrees", &|skin| format!("{:.3}", skin.across_edges.mean_degrees));
    text += &row("largest angle in degrees", &|skin| format!("{:.3}", skin.across_edges.largest_degrees));
    for file in files {
        text += &format!("# {file}\n");
    }
    text
}
