//! A cut through shadow maps along a row or a column: a graph of depth over position, and the cut's line in the picture.

use glam::{DVec3, DVec4};

use super::graph::{Graph, GraphAxis, Line};
use super::painter::{Painter, Pen, UnitPoint};
use super::{Error, Figure, Panel, measure};
use crate::output::canvas::Color;
use crate::scene::Scene;
use crate::views::View;

/// A cut along a row or a column of a spotlight's map.
#[derive(Clone, Copy, Debug)]
pub struct MapCut {
    /// True for a column.
    pub is_upright: bool,
    /// Place of the row from the map's upper edge, of the column from its left one, in [0, 1].
    pub at: f64,
    /// The part that is shown, from the left or the upper edge, in [0, 1].
    pub part: [f64; 2],
    /// Lines, of the first surface first.
    pub lines: &'static [CutLine],
    /// Line of the map that the first line is compared with: what lies behind it is marked; `None`: no marks.
    pub map: Option<usize>,
    /// Meaning of the marks, for the legend.
    pub behind: &'static str,
}

/// A line of a cut: depths of the panel's map with changes.
#[derive(Clone, Copy, Debug)]
pub struct CutLine {
    pub name: &'static str,
    pub set: &'static [&'static str],
    pub color: Color,
    pub width: f32,
    pub is_dashed: bool,
    /// Drawn as a level piece for each texel.
    pub in_steps: bool,
    /// True: draws twice this line's depths less the first line's, the second of two layers whose mean the map holds.
    pub is_other_layer: bool,
}

/// Distances along the light's axis, one for each texel of the cut; `None`: the far plane.
pub type Distances = Vec<Option<f64>>;

/// Share of the graph's height above which neighbours are no longer one surface.
const JUMP: f64 = 0.06;

/// Depths of a scene's map or of its picture, rows from the top, and their width and height.
pub type Depths<'a> = &'a mut dyn FnMut(&Scene, View) -> Result<([u32; 2], Vec<f32>), Error>;

/// Color of what lies behind the map.
const BEHIND: Color = measure::FALSE_SHADOW;

/// Distance along the light's axis of a window depth; `None` at the far plane.
fn distance([near, far]: [f64; 2], depth: f32) -> Option<f64> {
    (depth < 0.999_999).then(|| near * far / (far - f64::from(depth) * (far - near)))
}

/// The distances of each of a cut's lines.
pub fn lines(figure: &Figure, panel: &Panel, cut: &MapCut, depths: Depths<'_>) -> Result<Vec<Distances>, Error> {
    let mut all: Vec<Distances> = Vec::new();
    for line in cut.lines {
        let more: Vec<String> = line.set.iter().map(|text| (*text).to_owned()).collect();
        let scene = figure.scene_with(panel, &more)?;
        let mut own = row(&scene, cut, depths)?;
        if line.is_other_layer {
            let first = all.first().cloned().unwrap_or_default();
            let other = own.iter().zip(first).map(|(mean, first)| Some(2.0 * (*mean)? - first?));
            own = other.collect();
        }
        all.push(own);
    }
    Ok(all)
}

/// The texels of the part, as columns and rows of a map of this size.
fn texels(cut: &MapCut, [width, height]: [u32; 2]) -> Vec<[u32; 2]> {
    let (along, across) = if cut.is_upright { (height, width) } else { (width, height) };
    let line = ((cut.at * f64::from(across)) as u32).min(across.saturating_sub(1));
    let [start, end] = cut.part.map(|part| (part * f64::from(along)).round() as u32);
    (start..end).map(|place| if cut.is_upright { [line, place] } else { [place, line] }).collect()
}

/// Distances in the part.
fn row(scene: &Scene, cut: &MapCut, depths: Depths<'_>) -> Result<Distances, Error> {
    let (size, depths) = depths(scene, View::LightDepth)?;
    let range = range_of(scene);
    let depth = |[column, row]: [u32; 2]| distance(range, *depths.get((row * size[0] + column) as usize)?);
    Ok(texels(cut, size).into_iter().map(depth).collect())
}

fn range_of(scene: &Scene) -> [f64; 2] {
    scene.lights.first().and_then(|light| light.frustum()).map_or([1.0, 2.0], |frustum| [frustum.near, frustum.far])
}

/// Position along the cut in percent of its length. `part`: position within the texel, in [0, 1].
fn across(index: usize, count: usize, part: f64) -> f64 {
    100.0 * (index as f64 + part) / count.max(1) as f64
}

/// The graph of a cut; the light is above it.
pub fn graph<'a>(cut: &'a MapCut, distances: &[Distances]) -> Graph<'a> {
    let ([top, bottom], ticks) = scale_of(distances);
    let mut lines: Vec<Line<'_>> = Vec::new();
    for (line, own) in cut.lines.iter().zip(distances) {
        let shown = |distance: Option<f64>| distance.filter(|distance| (top..=bottom).contains(distance));
        let mut points = Vec::new();
        for (index, distance) in own.iter().enumerate() {
            let parts: &[f64] = if line.in_steps { &[0.0, 1.0] } else { &[0.5] };
            let before = index.checked_sub(1).and_then(|before| own[before]);
            let jumps = before.zip(*distance).is_some_and(|(before, own)| (before - own).abs() > JUMP * (bottom - top));
            if jumps && !line.in_steps {
                points.push(None);
            }
            points.extend(parts.iter().map(|part| Some([across(index, own.len(), *part), shown(*distance)?])));
        }
        let pen = Pen { color: line.color, width: line.width, is_dashed: line.is_dashed };
        lines.push(Line { name: line.name, pen, points, dots: 0.0 });
    }
    if let Some((surface, map)) = distances.first().zip(cut.map.and_then(|map| distances.get(map))) {
        let pen = Pen { color: BEHIND, width: 4.0, is_dashed: false };
        lines.push(Line { name: cut.behind, pen, points: behind(surface, map), dots: 0.0 });
    }
    let axis = |label, range, ticks| GraphAxis { label, range, ticks, is_logarithmic: false };
    let label = match cut.is_upright {
        true => "place along a column of the map, in % of the part that is shown",
        false => "place along a row of the map, in % of the part that is shown",
    };
    let along = axis(label, [0.0, 100.0], vec![0.0, 25.0, 50.0, 75.0, 100.0]);
    Graph { axes: [along, axis("distance from the light", [bottom, top], ticks)], lines }
}

/// Distances at the upper and the lower edge of a graph of all lines, and ticks between them.
fn scale_of(distances: &[Distances]) -> ([f64; 2], Vec<f64>) {
    let all = || distances.iter().flatten().flatten().copied();
    let (least, greatest) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if greatest <= least {
        return ([0.0, 1.0], Vec::new());
    }
    let margin = 0.08 * (greatest - least);
    let (top, bottom) = (least - margin, greatest + margin);
    let steps = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0];
    let step = steps.into_iter().find(|step| (bottom - top) / step <= 6.0).unwrap_or(10.0);
    let ticks = (0..=7).map(|index| step * ((top / step).ceil() + f64::from(index)));
    ([top, bottom], ticks.filter(|tick| *tick <= bottom).collect())
}

/// Points of a surface that lie behind the map.
fn behind(surface: &Distances, map: &Distances) -> Vec<Option<[f64; 2]>> {
    let at = |index: usize| map.get(index * map.len() / surface.len().max(1)).copied().flatten();
    let point = |(index, own): (usize, &Option<f64>)| {
        let own = (*own)?;
        (own > at(index)? + 1e-6 * own).then(|| [across(index, surface.len(), 0.5), own])
    };
    surface.iter().enumerate().map(point).collect()
}

/// Places where the nearest surface along a cut is seen, in units of the picture; `None`: hidden.
pub fn trace(
    figure: &Figure,
    panel: &Panel,
    cut: &MapCut,
    depths: Depths<'_>,
) -> Result<Vec<Option<UnitPoint>>, Error> {
    let more: Vec<String> = cut.lines.first().iter().flat_map(|line| line.set).map(|text| (*text).to_owned()).collect();
    let scene = figure.scene_with(panel, &more)?;
    let Some(frustum) = scene.lights.first().and_then(|light| light.frustum()) else { return Ok(Vec::new()) };
    let (size, seen) = depths(&scene, View::Depth)?;
    let (map, depths) = depths(&scene, View::LightDepth)?;
    let world_from_map = frustum.clip_from_world().inverse();
    let clip_from_world = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world();
    let [width, height] = map.map(f64::from);
    let place = |[column, row]: [u32; 2]| {
        let depth = *depths.get((row * map[0] + column) as usize)?;
        let [s, t] = [column, row].map(|place| f64::from(place) + 0.5);
        let ndc = DVec3::new(2.0 * s / width - 1.0, 1.0 - 2.0 * t / height, 2.0 * f64::from(depth) - 1.0);
        let clip: DVec4 = clip_from_world * world_from_map.project_point3(ndc).extend(1.0);
        let [x, y] = [0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w];
        let is_inside = depth < 1.0 && clip.w > 0.0 && (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y);
        let [x, y] = [x * f64::from(size[0]), y * f64::from(size[1])];
        let nearest = *seen.get((y as u32 * size[0] + x as u32) as usize).filter(|_| is_inside)?;
        // Half a percent of the distance from the eye.
        let range = [scene.camera.near, scene.camera.far];
        let (own, nearest) = (distance(range, (0.5 + 0.5 * clip.z / clip.w) as f32)?, distance(range, nearest)?);
        (own < 1.005 * nearest).then_some([x as f32, y as f32])
    };
    Ok(texels(cut, map).into_iter().map(place).collect())
}

/// Draws a trace over the picture.
pub fn draw_trace(painter: &mut Painter<'_>, trace: &[Option<UnitPoint>]) {
    const FARTHEST: f32 = 12.0;
    for pen in [
        Pen { color: [255, 255, 255], width: 4.0, is_dashed: false },
        Pen { color: [200, 30, 30], width: 2.0, is_dashed: false },
    ] {
        for pair in trace.windows(2) {
            if let [Some(from), Some(to)] = pair
                && (from[0] - to[0]).hypot(from[1] - to[1]) < FARTHEST
            {
                painter.line(&[*from, *to], pen);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPRIGHT: MapCut = MapCut { is_upright: true, at: 0.5, part: [0.25, 0.75], lines: &[], map: None, behind: "" };

    #[test]
    fn window_depths_become_distances() {
        // A perspective depth is (1 / near - 1 / d) / (1 / near - 1 / far).
        for expected in [2.5, 3.0, 7.0, 10.9] {
            let depth = (1.0 / 2.5 - 1.0 / expected) / (1.0 / 2.5 - 1.0 / 11.0);
            let found = distance([2.5, 11.0], depth as f32).unwrap();
            assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
        }
        assert_eq!(distance([2.5, 11.0], 1.0), None);
    }

    #[test]
    fn a_cut_runs_along_its_row_or_column() {
        assert_eq!(texels(&UPRIGHT, [4, 8]), [[2, 2], [2, 3], [2, 4], [2, 5]]);
        assert_eq!(texels(&MapCut { is_upright: false, ..UPRIGHT }, [4, 8]), [[1, 4], [2, 4]]);
    }

    #[test]
    fn what_is_farther_than_its_texel_lies_behind_the_map() {
        let surface: Distances = [4.9, 5.1, 5.9, 6.1].map(Some).to_vec();
        let marked: Vec<bool> = behind(&surface, &vec![Some(5.0), Some(6.0)]).iter().map(Option::is_some).collect();
        assert_eq!(marked, [false, true, false, true]);
        assert!(behind(&surface, &vec![None, None]).iter().all(Option::is_none));
    }
}
