//! Brightness along the middle row of pictures, as a graph.

use super::graph::{Graph, GraphAxis, Line};
use super::painter::Pen;
use crate::output::canvas::{Canvas, Color};

/// A line of a profile.
#[derive(Clone, Copy, Debug)]
pub struct ProfileLine {
    /// Number of the panel, from 0.
    pub panel: usize,
    pub name: &'static str,
    pub color: Color,
}

/// The graph. Columns are in percent of the width; brightness is the green channel's code.
pub fn graph(lines: &[ProfileLine], pictures: &[Canvas]) -> Graph<'static> {
    let rows: Vec<Vec<f64>> = pictures.iter().map(middle_row).collect();
    let all = || rows.iter().flatten().copied();
    let (least, greatest) = (all().fold(255.0, f64::min), all().fold(0.0, f64::max));
    let range = [(least / 20.0).floor() * 20.0, ((greatest + 1.0) / 20.0).ceil() * 20.0];
    let step = if range[1] - range[0] > 120.0 { 40.0 } else { 20.0 };
    let ticks =
        (0..=13).map(|tick| f64::from(tick) * step).filter(|tick| (range[0]..=range[1]).contains(tick)).collect();
    let axis = |label, range, ticks| GraphAxis { label, range, ticks, is_logarithmic: false };
    let x = axis("place along the middle row, in % of the width", [0.0, 100.0], vec![0.0, 25.0, 50.0, 75.0, 100.0]);
    let lines = lines.iter().zip(&rows).map(|(line, row)| {
        let share = |column: usize| 100.0 * column as f64 / row.len().max(1) as f64;
        // A level piece a pixel.
        let step = |(column, code): (usize, &f64)| [Some([share(column), *code]), Some([share(column + 1), *code])];
        let points = row.iter().enumerate().flat_map(step).collect();
        Line { name: line.name, pen: Pen { color: line.color, width: 1.8, is_dashed: false }, points, dots: 0.0 }
    });
    Graph { axes: [x, axis("brightness, in codes of 255", range, ticks)], lines: lines.collect() }
}

fn middle_row(picture: &Canvas) -> Vec<f64> {
    let row = 3 * picture.size()[0] as usize;
    let start = row * (picture.size()[1] / 2) as usize;
    picture.bytes()[start..start + row].as_chunks::<3>().0.iter().map(|[_, green, _]| f64::from(*green)).collect()
}
