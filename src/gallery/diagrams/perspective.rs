//! Equal steps on the screen against steps on a surface: why a projected texture is divided at each pixel
//! [Segal 1992, 2 and Figure 2].

use glam::{DVec2, DVec3, dvec2};

use super::Diagram;
use super::section::{Placement, Section};
use super::svg::Svg;
use crate::gallery::draw::DrawnSide;

/// Steps on the screen.
const STEPS: usize = 6;

/// The diagram of a side: the upright plane through the eye along its view, and the first object's surface in it.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let camera = &drawn.scene.camera;
    let section = Section::through(camera.eye, camera.target, camera.eye + DVec3::Y)?;
    let axis = section.flat(camera.target).normalize_or_zero();
    let half = (0.5 * camera.fov_y_radians).tan();
    // The longest line that the plane cuts out of a triangle, as far as it is in view.
    let lines = drawn.scene.objects.iter().flat_map(|object| section.cut(object));
    let [a, b] = lines.filter_map(|line| in_view(line, axis, half)).max_by(|one, other| {
        let length = |line: &[DVec2; 2]| line[0].distance(line[1]);
        length(one).total_cmp(&length(other))
    })?;
    let screen = |point: DVec2| point / point.dot(axis);
    let distance = 0.45 * a.dot(axis).min(b.dot(axis));
    let placement = Placement::around(&[DVec2::ZERO, a, b, distance * screen(a), distance * screen(b)], 26.0, 230.0);
    let at = |point: DVec2| placement.at(point);
    let mut svg = Svg::new(placement.height + 56.0, "Equal steps on the screen, and where they lie on the surface");
    svg.line("", &[at(a), at(b)]);
    svg.line("good", &[at(distance * screen(a)), at(distance * screen(b))]);
    let [depth_a, depth_b] = [a, b].map(|point| point.dot(axis));
    let mut worst = 0.0_f64;
    for step in 0..=STEPS {
        let part = step as f64 / STEPS as f64;
        // Along the surface, by the quotient of what is linear on the screen.
        let share = part / depth_b / ((1.0 - part) / depth_a + part / depth_b);
        let (right, assumed) = (a.lerp(b, share), a.lerp(b, part));
        worst = worst.max((share - part).abs());
        svg.line("ray", &[at(DVec2::ZERO), at(right)]);
        svg.dot("lamp", at(right), 4.0);
        svg.dot("wrong", at(assumed), 3.0);
    }
    svg.dot("sample", at(DVec2::ZERO), 4.0);
    svg.text("words", at(DVec2::ZERO) + dvec2(-10.0, -9.0), "eye");
    let low = placement.height + 8.0;
    for (row, (class, words)) in
        [("lamp", "what a pixel shows"), ("wrong", "what it is given where coordinates are linear on the screen")]
            .iter()
            .enumerate()
    {
        svg.dot(class, dvec2(20.0, low + 16.0 * row as f64), 4.0);
        svg.text("words", dvec2(32.0, low + 4.0 + 16.0 * row as f64), words);
    }
    svg.line("good", &[dvec2(12.0, low + 32.0), dvec2(28.0, low + 32.0)]);
    svg.text("words", dvec2(32.0, low + 36.0), "screen, in equal steps");
    let says = format!(
        "A cut through the eye of this scene. Its depth grows from {depth_a:.1} to {depth_b:.1} along the surface: equal steps on the \
         screen are not equal on the surface. Linear interpolation is off by up to {:.0} % of the triangle.",
        100.0 * worst
    );
    Some(Diagram { svg: svg.finish(), says })
}

/// The part of a line between the lower and upper side of the view; `None`: nothing of it.
fn in_view([mut a, mut b]: [DVec2; 2], axis: DVec2, half: f64) -> Option<[DVec2; 2]> {
    for side in [-1.0, 1.0] {
        let inside = |point: DVec2| half * point.dot(axis) - side * axis.perp_dot(point);
        let (of_a, of_b) = (inside(a), inside(b));
        match (of_a > 0.0, of_b > 0.0) {
            (false, false) => return None,
            (true, true) => {}
            (true, false) => b = a.lerp(b, of_a / (of_a - of_b)),
            (false, true) => a = b.lerp(a, of_b / (of_b - of_a)),
        }
    }
    (a.distance(b) > 1e-6).then_some([a, b])
}
