//! A picture that is projected onto a surface and seen from elsewhere: where a pixel's point lies on the screen of the eye,
//! and on the picture of the light [Segal 1992, Figures 1 and 2].

use glam::{DVec2, DVec3, dvec2};

use super::Diagram;
use super::section::{Placement, Section};
use super::svg::Svg;
use crate::gallery::draw::DrawnSide;

/// The plane through light, eye and the light's target; `None`: the light is no spotlight, or lies on the eye's axis.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let scene = &drawn.scene;
    let (camera, frustum) = (&scene.camera, &scene.lights.first()?.spot()?.frustum);
    let section = Section::through(frustum.position, frustum.target, camera.eye)?;
    let flat = |point: DVec3| section.flat(point);
    let (light, eye, target) = (flat(frustum.position), flat(camera.eye), flat(frustum.target));
    let light_axis = (target - light).normalize_or_zero();
    let eye_axis = (flat(camera.target) - eye).normalize_or_zero();
    // The longest line that the plane cuts is the surface; its part in the light's beam is looked at.
    let cuts: Vec<[DVec2; 2]> = scene.objects.iter().flat_map(|object| section.cut(object)).collect();
    let surface = cuts.iter().max_by(|one, other| one[0].distance(one[1]).total_cmp(&other[0].distance(other[1])))?;
    let across = (0.5 * frustum.cone_radians).tan();
    let sides = [-1.0, 1.0].map(|side| light_axis + side * across * light_axis.perp());
    let [one, two] = [on_line(light, sides[0], surface)?, on_line(light, sides[1], surface)?];
    let middle = 0.5 * (one + two);
    let picture = 0.28 * (middle - light).dot(light_axis);
    let screen = 0.28 * (middle - eye).dot(eye_axis).abs();
    let placement = Placement::around(&[light, eye, one, two], 30.0, 260.0);
    let at = |point: DVec2| placement.at(point);
    let mut svg =
        Svg::new(placement.height + 44.0, "A projected picture, the surface that it falls on, and the screen");
    svg.area("beam", &[at(light), at(one), at(two)]);
    svg.line("", &surface.map(|end| at(end.clamp(one.min(two) - 0.4, one.max(two) + 0.4))));
    svg.line("stair", &sides.map(|side| at(light + picture * side)));
    let on_screen = |point: DVec2| eye + screen * (point - eye) / (point - eye).dot(eye_axis);
    svg.line("good", &[at(on_screen(one)), at(on_screen(two))]);
    for point in [one, middle, two] {
        svg.line("ray", &[at(light), at(point)]);
        svg.line("thin", &[at(eye), at(point)]);
        svg.dot("sample", at(on_screen(point)), 3.0);
        svg.dot("lamp", at(light + picture * (point - light) / (point - light).dot(light_axis)), 3.5);
    }
    for (place, name) in [(one, "Q₁"), (middle, "Q"), (two, "Q₂")] {
        svg.dot("sample", at(place), 3.0);
        svg.text("words", at(place) + dvec2(-6.0, 16.0), name);
    }
    svg.dot("lamp", at(light), 6.0);
    svg.text("words", at(light) + dvec2(-10.0, -9.0), "light");
    svg.dot("sample", at(eye), 4.0);
    svg.text("words", at(eye) + dvec2(-8.0, -9.0), "eye");
    let low = dvec2(12.0, placement.height + 12.0);
    svg.legend(low, &[("stair", "the light's picture"), ("good", "the eye's screen")]);
    let part = |point: DVec2, origin: DVec2, axis: DVec2| {
        let place = |point: DVec2| axis.perp_dot(point - origin) / (point - origin).dot(axis);
        (place(point) - place(one)) / (place(two) - place(one))
    };
    let (of_screen, of_picture) = (part(middle, eye, eye_axis), part(middle, light, light_axis));
    let says = format!(
        "A cut through the light, the eye and what the light looks at. Q lies halfway between the ends of its surface. On the screen \
         it lies {of_screen:.2} of the way from Q₁ to Q₂, on the light's picture {of_picture:.2}: both are quotients, and each has \
         its own divisor, w for the eye and q for the light."
    );
    Some(Diagram { svg: svg.finish(), says })
}

/// Point at which a ray meets the line through two points; `None`: behind its start, or never.
fn on_line(from: DVec2, way: DVec2, [a, b]: &[DVec2; 2]) -> Option<DVec2> {
    let along = *b - *a;
    let depth = (*a - from).perp_dot(along) / way.perp_dot(along);
    (depth.is_finite() && depth > 0.0).then(|| from + depth * way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_a_line_ahead_of_it_only() {
        let floor = [dvec2(-1.0, 0.0), dvec2(1.0, 0.0)];
        assert_eq!(on_line(dvec2(0.0, 2.0), dvec2(1.0, -1.0), &floor), Some(dvec2(2.0, 0.0)));
        assert_eq!(on_line(dvec2(0.0, 2.0), dvec2(0.0, 1.0), &floor), None);
        assert_eq!(on_line(dvec2(0.0, 2.0), dvec2(1.0, 0.0), &floor), None);
    }
}
