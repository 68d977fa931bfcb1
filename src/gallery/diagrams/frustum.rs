//! A cut along the light's axis: its frustum, what it falls on, and the mirrored frustum behind it, where q is negative
//! [LEC, "Careful about Back Projecting Shadow Maps"].

use glam::{DVec2, dvec2};

use super::Diagram;
use super::section::{Placement, Section};
use super::svg::Svg;
use crate::gallery::draw::DrawnSide;

/// The diagram of a side; `None`: its first light is no spotlight. `mirrored`: with what lies behind the light.
pub fn draw(drawn: &DrawnSide, mirrored: bool) -> Option<Diagram> {
    let scene = &drawn.scene;
    let frustum = &scene.lights.first()?.spot()?.frustum;
    let section = Section::through(frustum.position, frustum.target, frustum.position + frustum.up)?;
    let axis = section.flat(frustum.target).normalize_or_zero();
    let cuts: Vec<[DVec2; 2]> = scene.objects.iter().flat_map(|object| section.cut(object)).collect();
    let reach = cuts.iter().flatten().map(|point| point.dot(axis)).fold(0.0, f64::max) * 1.03;
    let across = (0.5 * frustum.cone_radians).tan();
    let corners = |depth: f64| [-1.0, 1.0].map(|side| depth * (axis + side * across * axis.perp()));
    let limit = |point: &DVec2| point.length() < 1.6 * reach;
    let shown = cuts.iter().flatten().copied().filter(limit).chain([DVec2::ZERO]);
    let placement = Placement::around(&shown.collect::<Vec<_>>(), 24.0, 250.0);
    let at = |point: DVec2| placement.at(point);
    let mut svg = Svg::new(placement.height + 22.0, "A cut along the light's axis");
    let [low, high] = corners(reach);
    svg.area("beam", &[at(DVec2::ZERO), at(low), at(high)]);
    if mirrored {
        let back = cuts.iter().flatten().map(|point| -point.dot(axis)).fold(0.0, f64::max) * 1.03;
        let [low, high] = corners(-back);
        svg.area("ghost", &[at(DVec2::ZERO), at(low), at(high)]);
    }
    for line in &cuts {
        svg.line("", &line.map(at));
    }
    let on_axis = crossings(&cuts, axis);
    let ahead = on_axis.iter().copied().filter(|depth| *depth > frustum.near).fold(f64::INFINITY, f64::min);
    let behind = on_axis.iter().copied().filter(|depth| *depth < 0.0).fold(f64::INFINITY, f64::min);
    svg.dot("lamp", at(DVec2::ZERO), 6.0);
    let under = dvec2(0.0, placement.height + 12.0);
    let says = if mirrored {
        for (depth, words) in [(ahead, "q > 0"), (behind, "q < 0")] {
            if depth.is_finite() {
                svg.text("count", at(0.5 * depth * axis) + dvec2(0.0, -8.0), words);
            }
        }
        format!(
            "A cut along the lamp's axis. Before it q is the distance along the axis, {ahead:.1} at the wall ahead; behind it, at \
             the other wall, q is {behind:.1}. The quotients s/q and t/q of a point and of its mirror image are equal, so that the \
             picture comes out twice."
        )
    } else {
        for depth in [frustum.near, reach.min(frustum.far)] {
            svg.line("thin", &corners(depth).map(at));
        }
        let map = drawn.plan.maps.first();
        svg.text("words", under.with_x(12.0), "the light's frustum, from its near plane on");
        let texel = map.map_or(0.0, |map| map.texel);
        format!(
            "A cut along the light's axis: a frustum of {:.0} degrees. Its axis meets the scene at {ahead:.1}; a texel of its map is {texel:.4} wide for each unit of depth.",
            frustum.cone_radians.to_degrees()
        )
    };
    Some(Diagram { svg: svg.finish(), says })
}

/// Signed distances from the light at which its axis crosses lines.
fn crossings(cuts: &[[DVec2; 2]], axis: DVec2) -> Vec<f64> {
    let crossing = |[a, b]: &[DVec2; 2]| {
        let [from, to] = [axis.perp_dot(*a), axis.perp_dot(*b)];
        ((from < 0.0) != (to < 0.0)).then(|| a.lerp(*b, from / (from - to)).dot(axis))
    };
    cuts.iter().filter_map(crossing).collect()
}
