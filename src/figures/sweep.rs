//! Wrong shares over the values of a key, as a graph.

use super::draw::Drawing;
use super::graph::{Axis, Graph, Line};
use super::measure::{FALSE_SHADOW, LEAK, Share};
use super::painter::Pen;
use super::{Error, Panel};

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

/// The shares for each value.
pub fn measure(drawing: &mut Drawing<'_>, panel: &Panel, sweep: &Sweep) -> Result<Vec<Share>, Error> {
    let mut shares = Vec::new();
    for value in sweep.values {
        let scene = drawing.figure.scene_with(panel, &[sweep.set.replace("{}", &format!("{value:?}"))])?;
        shares.push(drawing.wrong_in(panel, &scene)?);
    }
    Ok(shares)
}

/// The graph of both shares, and of their sum.
pub fn graph<'a>(sweep: &'a Sweep, shares: &[Share]) -> Graph<'a> {
    let points = |share: fn(&Share) -> f64| {
        sweep.values.iter().zip(shares).map(|(value, own)| Some([*value, share(own)])).collect::<Vec<_>>()
    };
    let line = |name, color, width, share: fn(&Share) -> f64| {
        let pen = Pen { color, width, is_dashed: false };
        Line { name, pen, points: points(share), dots: width + 1.0 }
    };
    let greatest = shares.iter().map(Share::wrong).fold(0.1, f64::max);
    let step = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0].into_iter().find(|step| greatest / step <= 6.0).unwrap_or(50.0);
    let count = (greatest / step).ceil();
    let ends = [sweep.values.first(), sweep.values.last()].map(|end| end.copied().unwrap_or(1.0));
    let x = Axis { label: sweep.label, range: ends, ticks: sweep.ticks.to_vec(), is_logarithmic: sweep.is_logarithmic };
    let ticks = (0..=count as u32).map(|index| step * f64::from(index)).collect();
    let y = Axis { label: "wrong pixels, in %", range: [0.0, step * count], ticks, is_logarithmic: false };
    let lines = vec![
        Line { dots: 0.0, ..line("both", [120, 124, 134], 1.5, Share::wrong) },
        line("false shadow (acne)", FALSE_SHADOW, 2.0, |share| share.false_shadow),
        line("leak", LEAK, 2.0, |share| share.leak),
    ];
    Graph { axes: [x, y], lines }
}
