//! The measures of the table: names, units, what they mean, and how to read each from a row.

use crate::judge::metrics::{EdgeDistance, Errors};
use crate::report::numbers::fixed;
use crate::report::store::csv::total_fragments;
use crate::report::store::results::Measured;

/// One measure of a row.
pub(super) struct Column {
    /// Index into [`GROUPS`].
    pub group: &'static str,
    pub name: &'static str,
    /// A sentence, for the tip and the list below the table.
    pub meaning: &'static str,
    decimals: usize,
    value: fn(&Measured) -> Option<f64>,
}

/// The groups in order, each with what its columns have in common.
pub(super) const GROUPS: [(&str, &str); 6] = [
    ("wrong pixels, %", "Shares of the pixels compared. False shadow and leak add up to all."),
    ("time, ms", "Medians of several runs, from the first call to the end of glFinish, unless said otherwise."),
    (
        "facing, %",
        "The same over surfaces whose visible side faces the light only: on the others shading leaves no light, so \
         that a shadow's error cannot be seen there. Shares of the facing pixels compared.",
    ),
    (
        "edges, pixels",
        "Distances between shadow edges in the picture and true ones. Both directions are needed: acne has edges far \
         from any true one; a lost shadow has true edges far from any drawn one.",
    ),
    (
        "shade and colour",
        "Of the shade as it is, not only above or below one half; of the picture's colours, where a light has an image, a \
         beam, a law of distance, a lens or dust, or is a slide projector.",
    ),
    ("price", "What a frame with everything drawn takes."),
];

impl Column {
    /// The value as text; a dash if the row has none.
    pub fn text(&self, measured: Option<&Measured>) -> String {
        measured.and_then(self.value).map_or_else(|| "–".to_owned(), |value| fixed(value, self.decimals))
    }
}

const fn column(
    group: usize,
    name: &'static str,
    decimals: usize,
    meaning: &'static str,
    value: fn(&Measured) -> Option<f64>,
) -> Column {
    Column { group: GROUPS[group].0, name, meaning, decimals, value }
}

fn all(measured: &Measured) -> &Errors {
    &measured.metrics.all
}

fn facing(measured: &Measured, of: fn(&Errors) -> f64) -> Option<f64> {
    let errors = &measured.metrics.facing;
    (errors.compared > 0).then(|| of(errors))
}

fn compared(measured: &Measured, of: fn(&Errors) -> f64) -> Option<f64> {
    let errors = all(measured);
    (errors.compared > 0).then(|| of(errors))
}

fn edge(distance: Option<EdgeDistance>, of: fn(&EdgeDistance) -> f64) -> Option<f64> {
    distance.as_ref().map(of)
}

/// The column with error bars.
pub(super) const REDRAWN: &str = "redrawn";

pub(super) const COLUMNS: [Column; 31] = [
    column(0, "all", 3, "All that is wrong: false shadow and leak, inside the band and outside.", |m| {
        compared(m, |e| e.wrong_percent)
    }),
    column(0, "outside band", 3, "What is wrong outside the band: no map of this size should be.", |m| {
        compared(m, |e| e.wrong_outside_percent)
    }),
    column(0, "false shadow in", 3, "Shadow where light belongs, inside the band: an edge drawn too wide.", |m| {
        compared(m, |e| e.false_shadow.inside_percent)
    }),
    column(0, "false shadow out", 3, "Shadow where light belongs, outside the band: acne, and light lost.", |m| {
        compared(m, |e| e.false_shadow.outside_percent)
    }),
    column(0, "leak in", 3, "Light where shadow belongs, inside the band: an edge drawn too narrow.", |m| {
        compared(m, |e| e.leak.inside_percent)
    }),
    column(
        0,
        "leak out",
        3,
        "Light where shadow belongs, outside the band: an offset too large, a caster lost.",
        |m| compared(m, |e| e.leak.outside_percent),
    ),
    column(
        1,
        REDRAWN,
        3,
        "A frame that draws everything, the maps among it; below it a bar from its least to its greatest run.",
        |m| Some(m.frame_redrawn.median),
    ),
    column(1, "redrawn: least", 3, "The fastest of its runs.", |m| Some(m.frame_redrawn.least)),
    column(1, "redrawn: most", 3, "The slowest of its runs.", |m| Some(m.frame_redrawn.greatest)),
    column(1, "kept", 3, "A frame that keeps the maps that a static scene's first frame drew.", |m| {
        Some(m.frame_kept.median)
    }),
    column(2, "facing: all", 3, "All that is wrong on surfaces that face the light.", |m| {
        facing(m, |e| e.wrong_percent)
    }),
    column(2, "facing: false shadow out", 3, "Acne on surfaces that face the light.", |m| {
        facing(m, |e| e.false_shadow.outside_percent)
    }),
    column(2, "facing: leak", 3, "Leaks on surfaces that face the light, inside the band and outside.", |m| {
        facing(m, |e| e.leak_percent)
    }),
    column(3, "drawn to true: mean", 2, "From each edge in the picture to the nearest true one, on average.", |m| {
        edge(all(m).rendered_to_true, |d| d.mean_pixels)
    }),
    column(3, "drawn to true: 95 %", 2, "95 % of the edges in the picture are no farther from a true one.", |m| {
        edge(all(m).rendered_to_true, |d| d.p95_pixels)
    }),
    column(3, "drawn to true: most", 2, "The edge in the picture that is farthest from any true one.", |m| {
        edge(all(m).rendered_to_true, |d| d.max_pixels)
    }),
    column(3, "true to drawn: mean", 2, "From each true edge to the nearest in the picture, on average.", |m| {
        edge(all(m).true_to_rendered, |d| d.mean_pixels)
    }),
    column(3, "true to drawn: 95 %", 2, "95 % of the true edges are no farther from one in the picture.", |m| {
        edge(all(m).true_to_rendered, |d| d.p95_pixels)
    }),
    column(3, "true to drawn: most", 2, "The true edge that is farthest from any in the picture.", |m| {
        edge(all(m).true_to_rendered, |d| d.max_pixels)
    }),
    column(
        4,
        "RMSE",
        4,
        "Root of the mean squared difference of the shade from 0 or 1: the measure for filtered shade.",
        |m| compared(m, |e| e.rmse),
    ),
    column(
        4,
        "colour: RMSE, codes",
        3,
        "Root of the mean squared difference of the picture from the colours to compare with, in 1/255.",
        |m| m.colors.map(|colors| colors.rmse_codes),
    ),
    column(4, "colour: most, codes", 1, "The pixel that is farthest from its colour.", |m| {
        m.colors.map(|colors| colors.most_codes)
    }),
    column(
        4,
        "colour: beyond, %",
        3,
        "Pixels more than two codes outside of what a sample's own error explains, edges of shadows and texels included.",
        |m| m.colors.map(|colors| colors.beyond_percent),
    ),
    column(
        4,
        "colour: FLIP",
        4,
        "Mean of FLIP, the difference that a viewer sees; pixels whose colour is not known count as equal.",
        |m| m.colors.and_then(|colors| colors.flip),
    ),
    column(5, "images, KiB", 1, "Memory of the plan's images: maps, buffers, textures.", |m| {
        Some(m.image_bytes as f64 / 1024.0)
    }),
    column(5, "draw calls", 0, "Of all passes.", |m| Some(m.draw_calls as f64)),
    column(5, "triangles", 0, "Sent in all passes.", |m| Some(m.triangles as f64)),
    column(5, "fragments", 0, "That passed the depth test in all passes, where the driver counts them.", |m| {
        total_fragments(m).map(|count| count as f64)
    }),
    column(5, "runs", 0, "Runs of a frame, of which the times are the median.", |m| Some(m.frame_redrawn.runs as f64)),
    column(5, "compared", 0, "Pixels that both show and of which the truth is sure. Only these are judged.", |m| {
        Some(all(m).compared as f64)
    }),
    column(
        5,
        "lit in one only",
        0,
        "Pixels where only the picture or only the truth shows a surface in the light's reach; not judged.",
        |m| Some((m.metrics.left_out.not_drawn + m.metrics.left_out.only_drawn) as f64),
    ),
];
