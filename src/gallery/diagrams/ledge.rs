//! The two depth ranges of the ledge, as curves of window depth over distance [GDC, "Building a "Ledge" at the Front of the
//! Depth Buffer"].

use glam::{DVec2, dvec2};

use super::Diagram;
use super::svg::{Svg, WIDTH};
use crate::gallery::draw::DrawnSide;
use crate::math::ledge::Ledge;

/// Depths of the talk: where volumes and scene begin, and where both end.
const RANGES: [f64; 3] = [0.05, 0.1, 1.0];

/// The diagram of a side's camera, with the talk's ranges.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let scene = &drawn.scene;
    let camera = &scene.camera;
    let ledge = Ledge::with_ranges(camera.fov_y_radians, scene.aspect(), camera.near, camera.far, RANGES);
    let farthest = 4.0 * camera.near;
    let depth = |near: f64, [from, to]: [f64; 2], distance: f64| {
        from + (to - from) * camera.far * (distance - near) / (distance * (camera.far - near))
    };
    let place = |distance: f64, depth: f64| dvec2(44.0 + (WIDTH - 60.0) * distance / farthest, 210.0 - 190.0 * depth);
    let curve = |near: f64, range: [f64; 2]| -> Vec<DVec2> {
        let at = |step: u32| near + (farthest - near) * f64::from(step) / 80.0;
        (0..=80).map(|step| place(at(step), depth(near, range, at(step)))).collect()
    };
    let mut svg = Svg::new(262.0, "Window depth over distance, of the scene and of its shadow volumes");
    let floor = place(0.0, 0.0);
    let [ledge_top, right] = [place(0.0, RANGES[1]), place(farthest, RANGES[0])];
    let [low, high] = [right.y, ledge_top.y];
    svg.area("beam", &[dvec2(floor.x, low), dvec2(right.x, low), dvec2(right.x, high), dvec2(floor.x, high)]);
    svg.line("thin", &[place(0.0, 1.0), floor, place(farthest, 0.0)]);
    svg.line("bad", &curve(ledge.volume_near, ledge.volume_range));
    svg.line("good", &curve(camera.near, ledge.scene_range));
    svg.text("words", dvec2(4.0, high + 2.0), "0.1");
    svg.text("words", dvec2(4.0, low + 10.0), "0.05");
    svg.text("words", dvec2(4.0, 18.0), "depth");
    svg.text("words", dvec2(WIDTH - 90.0, 224.0), "distance");
    let near = place(camera.near, 0.0);
    svg.line("thin", &[near, near - dvec2(0.0, 40.0)]);
    svg.text("words", near + dvec2(-20.0, 14.0), "near plane");
    svg.legend(
        dvec2(12.0, 238.0),
        &[("good", "the scene"), ("bad", "sides of volumes, which begin nearer, on the ledge")],
    );
    let says = format!(
        "Window depth over distance with this scene's near plane at {}. The scene keeps to [0.1, 1]. Volumes are drawn with [0.05, 1] \
         and a near plane at N′ = {:.4}, for which both curves agree from there on: what lies between the two planes, and the caps, \
         has a place on the ledge and is not clipped.",
        camera.near, ledge.volume_near
    );
    Some(Diagram { svg: svg.finish(), says })
}
