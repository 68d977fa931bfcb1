//! Wrong shares over the values of a key, as a graph.

use super::graph::{Graph, GraphAxis, Line};
use super::measure::{FALSE_SHADOW, LEAK, Share};
use super::painter::Pen;
use super::{Error, Figure, Panel};
use crate::scene::Scene;

/// Values of a key, and the graph of what they do.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// An override with `{}` in place of the value.
    pub set: &'static str,
    pub values: &'static [f64],
    pub label: &'static str,
    pub ticks: &'static [f64],
    pub is_logarithmic: bool,
}

/// The shares for each value, by `wrong` of a scene.
pub fn measure(
    figure: &Figure,
    panel: &Panel,
    sweep: &Sweep,
    mut wrong: impl FnMut(&Scene) -> Result<Share, Error>,
) -> Result<Vec<Share>, Error> {
    let mut shares = Vec::new();
    for value in sweep.values {
        shares.push(wrong(&figure.scene_with(panel, &[sweep.set.replace("{}", &format!("{value:?}"))])?)?);
    }
    Ok(shares)
}

/// The graph of both shares, and of their sum; no wrong pixel at all is drawn at the lower edge.
pub fn graph<'a>(sweep: &'a Sweep, shares: &[Share]) -> Graph<'a> {
    let points = |share: fn(&Share) -> f64| {
        sweep.values.iter().zip(shares).map(|(value, own)| Some([*value, share(own)])).collect::<Vec<_>>()
    };
    let line = |name, color, width, share: fn(&Share) -> f64| {
        let pen = Pen { color, width, is_dashed: false };
        Line { name, pen, points: points(share), dots: width + 1.0 }
    };
    let all = || shares.iter().flat_map(|share| [share.false_shadow, share.leak]).filter(|share| *share > 0.0);
    let (least, greatest) = (all().fold(1.0, f64::min), shares.iter().map(Share::wrong).fold(1.0, f64::max));
    let powers = least.log10().floor() as i32..=greatest.log10().ceil() as i32;
    let ticks: Vec<f64> = powers.map(|power| 10_f64.powi(power)).collect();
    let ends = [sweep.values.first(), sweep.values.last()].map(|end| end.copied().unwrap_or(1.0));
    let x = GraphAxis {
        label: sweep.label,
        range: ends,
        ticks: sweep.ticks.to_vec(),
        is_logarithmic: sweep.is_logarithmic,
    };
    let range = [ticks.first(), ticks.last()].map(|end| end.copied().unwrap_or(1.0));
    let y = GraphAxis { label: "wrong, in % of what faces the light", range, ticks, is_logarithmic: true };
    let lines = vec![
        Line { dots: 0.0, ..line("both", [120, 124, 134], 1.5, Share::wrong) },
        line("false shadow (acne)", FALSE_SHADOW, 2.0, |share| share.false_shadow),
        line("leak", LEAK, 2.0, |share| share.leak),
    ];
    Graph { axes: [x, y], lines }
}
