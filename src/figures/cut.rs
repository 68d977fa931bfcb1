//! A cut through shadow maps along one of their rows: depth against place, as a graph, and where it runs in the picture.

use glam::{DVec3, DVec4};

use super::draw::Drawing;
use super::graph::{Axis, Graph, Line};
use super::painter::{Painter, Pen, Place};
use super::{Error, Panel, measure};
use crate::output::canvas::Color;
use crate::scene::Scene;
use crate::views::View;

/// A cut along a row of a spotlight's map.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// Place of the row from the map's upper edge, in [0, 1].
    pub row: f64,
    /// The part of the row, from its left end, in [0, 1].
    pub columns: [f64; 2],
    /// Distances from the light along its axis at the upper and the lower edge of the graph, in world units.
    pub distances: [f64; 2],
    pub ticks: &'static [f64],
    pub lines: &'static [CutLine],
    /// Line of the map that the first line is compared with: what lies behind it is marked; `None`: no marks.
    pub map: Option<usize>,
    /// What the marks mean, for the legend.
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
    /// Twice this line less the first: the layer that a mean of both was made from.
    pub is_other_layer: bool,
}

/// A line's distances, one a texel of the part of the row; `None`: nothing there.
pub type Distances = Vec<Option<f64>>;

/// Color of what lies behind the map.
const BEHIND: Color = measure::FALSE_SHADOW;

/// Distance along the light's axis of a window depth; `None` at the far plane.
fn distance([near, far]: [f64; 2], depth: f32) -> Option<f64> {
    (depth < 0.999_999).then(|| near * far / (far - f64::from(depth) * (far - near)))
}

/// The distances of each of a cut's lines.
pub fn lines(drawing: &mut Drawing<'_>, panel: &Panel, cut: &Cut) -> Result<Vec<Distances>, Error> {
    let mut all: Vec<Distances> = Vec::new();
    for line in cut.lines {
        let more: Vec<String> = line.set.iter().map(|text| (*text).to_owned()).collect();
        let scene = drawing.figure.scene_with(panel, &more)?;
        let mut own = row(drawing, &scene, cut)?;
        if line.is_other_layer {
            let first = all.first().cloned().unwrap_or_default();
            let other = own.iter().zip(first).map(|(mean, first)| Some(2.0 * (*mean)? - first?));
            own = other.collect();
        }
        all.push(own);
    }
    Ok(all)
}

/// The part of the map's row.
fn row(drawing: &mut Drawing<'_>, scene: &Scene, cut: &Cut) -> Result<Distances, Error> {
    let ([width, height], depths) = drawing.depths(scene, View::LightDepth)?;
    let range = range_of(scene);
    let first = ((cut.row * f64::from(height)) as u32).min(height.saturating_sub(1)) * width;
    let [start, end] = cut.columns.map(|part| (part * f64::from(width)).round() as u32);
    Ok((start..end).map(|column| distance(range, *depths.get((first + column) as usize)?)).collect())
}

fn range_of(scene: &Scene) -> [f64; 2] {
    scene.lights.first().and_then(|light| light.frustum()).map_or([1.0, 2.0], |frustum| [frustum.near, frustum.far])
}

/// Places of texels in hundredths of the part of the row.
fn across(index: usize, count: usize, part: f64) -> f64 {
    100.0 * (index as f64 + part) / count.max(1) as f64
}

/// The graph of a cut; the light is above it.
pub fn graph<'a>(cut: &'a Cut, distances: &[Distances]) -> Graph<'a> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for (line, own) in cut.lines.iter().zip(distances) {
        let [top, bottom] = cut.distances;
        let shown = |distance: &Option<f64>| distance.filter(|distance| (top..=bottom).contains(distance));
        let points = own.iter().enumerate().flat_map(|(index, distance)| {
            let parts: &[f64] = if line.in_steps { &[0.0, 1.0] } else { &[0.5] };
            let at = |part: &f64| shown(distance).map(|distance| [across(index, own.len(), *part), distance]);
            parts.iter().map(at).collect::<Vec<_>>()
        });
        let pen = Pen { color: line.color, width: line.width, is_dashed: line.is_dashed };
        lines.push(Line { name: line.name, pen, points: points.collect(), dots: 0.0 });
    }
    if let Some((surface, map)) = distances.first().zip(cut.map.and_then(|map| distances.get(map))) {
        let pen = Pen { color: BEHIND, width: 4.0, is_dashed: false };
        lines.push(Line { name: cut.behind, pen, points: behind(surface, map), dots: 0.0 });
    }
    let axis = |label, range, ticks| Axis { label, range, ticks, is_logarithmic: false };
    let columns = axis("place along a row of the map, in % of the part that is shown", [0.0, 100.0], vec![0.0, 25.0, 50.0, 75.0, 100.0]);
    let [top, bottom] = cut.distances;
    Graph { axes: [columns, axis("distance from the light", [bottom, top], cut.ticks.to_vec())], lines }
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

/// Where the nearest surface along a cut is seen, in units of the picture; `None`: hidden.
pub fn trace(drawing: &mut Drawing<'_>, panel: &Panel, cut: &Cut) -> Result<Vec<Option<Place>>, Error> {
    let more: Vec<String> = cut.lines.first().iter().flat_map(|line| line.set).map(|text| (*text).to_owned()).collect();
    let scene = drawing.figure.scene_with(panel, &more)?;
    let Some(frustum) = scene.lights.first().and_then(|light| light.frustum()) else { return Ok(Vec::new()) };
    let ([width, height], depths) = drawing.depths(&scene, View::LightDepth)?;
    let (size, seen) = drawing.depths(&scene, View::Depth)?;
    let world_from_map = frustum.clip_from_world().inverse();
    let clip_from_world = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world();
    let row = ((cut.row * f64::from(height)) as u32).min(height.saturating_sub(1));
    let [start, end] = cut.columns.map(|part| (part * f64::from(width)).round() as u32);
    let place = |column: u32| {
        let depth = *depths.get((row * width + column) as usize)?;
        let [s, t] = [f64::from(column) + 0.5, f64::from(row) + 0.5];
        let ndc = DVec3::new(2.0 * s / f64::from(width) - 1.0, 1.0 - 2.0 * t / f64::from(height), 2.0 * f64::from(depth) - 1.0);
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
    Ok((start..end).map(place).collect())
}

/// Draws a trace over the picture.
pub fn draw_trace(painter: &mut Painter<'_>, trace: &[Option<Place>]) {
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
