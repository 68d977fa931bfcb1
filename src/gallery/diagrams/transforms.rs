//! The chain of transformations from a point of the world to its shadow-map coordinates, with the numbers of one point
//! [HSM, "Computing Transformations for Shadow Mapping", Equation 1, Figures 7 and 8].

use glam::{DVec3, DVec4, dvec2};

use super::Diagram;
use super::svg::{Svg, WIDTH};
use crate::gallery::draw::DrawnSide;
use crate::lights::projector::Projector;
use crate::math::texgen::scale_bias;

/// The chain for the point that the light looks at; `None`: the first light is no spotlight.
pub fn draw(drawn: &DrawnSide) -> Option<Diagram> {
    let scene = &drawn.scene;
    let frustum = &scene.lights.first()?.spot()?.frustum;
    let projector = Projector::of_frustum(frustum);
    let world = scene.objects.get(1)?.world_from_model.transform_point3(DVec3::ZERO);
    let eye = scene.camera.view_from_world().transform_point3(world);
    let light = projector.light_from_world.transform_point3(world);
    let clip = projector.clip_from_light * light.extend(1.0);
    let [s, t, r, q] = (scale_bias(0.5, 0.5) * clip).to_array();
    let three = |point: DVec3| format!("({:.2}, {:.2}, {:.2})", point.x, point.y, point.z);
    let four = |point: DVec4| format!("({:.2}, {:.2}, {:.2}, {:.2})", point.x, point.y, point.z, point.w);
    let left = [("world space", three(world)), ("the eye's space", three(eye))];
    let chain = [
        ("the light's space", three(light), "L⁻¹"),
        ("the light's clip space", four(clip), "P"),
        ("texture coordinates s, t, r, q", four(DVec4::new(s, t, r, q)), "S"),
        ("in the map: s/q, t/q; depth r/q", three(DVec3::new(s, t, r) / q), "divide by q"),
    ];
    let mut svg = Svg::new(300.0, "The chain of matrices from the world to the shadow map");
    let mut put = |at: [f64; 2], width: f64, name: &str, numbers: &str| {
        let corner = dvec2(at[0], at[1]);
        let size = dvec2(width, 38.0);
        svg.area("solid", &[corner, corner + size.with_y(0.0), corner + size, corner + size.with_x(0.0)]);
        svg.text("words", corner + dvec2(8.0, 16.0), name);
        svg.text("words", corner + dvec2(8.0, 31.0), numbers);
    };
    put([8.0, 8.0], 160.0, left[0].0, &left[0].1);
    put([WIDTH - 168.0, 8.0], 160.0, left[1].0, &left[1].1);
    for (index, (name, numbers, _)) in chain.iter().enumerate() {
        put([8.0, 76.0 + 60.0 * index as f64 - 0.0], 230.0, name, numbers);
    }
    svg.arrow("", dvec2(168.0, 20.0), dvec2(WIDTH - 168.0, 20.0));
    svg.text("words", dvec2(178.0, 15.0), "V⁻¹");
    svg.arrow("good", dvec2(WIDTH - 168.0, 38.0), dvec2(168.0, 38.0));
    svg.text("words", dvec2(178.0, 54.0), "V, by eye planes");
    for (index, (_, _, matrix)) in chain.iter().enumerate() {
        let below = 46.0 + if index == 0 { 0.0 } else { 8.0 } + 60.0 * index as f64;
        let to = 76.0 + 60.0 * index as f64;
        svg.arrow("", dvec2(60.0, below), dvec2(60.0, to));
        svg.text("words", dvec2(70.0, to - 5.0), matrix);
    }
    let name = &scene.objects.get(1)?.name;
    let says = format!(
        "The middle of {name} on its way to the shadow map. GL has surfaces in the eye's space: planes that are given under the \
         view lead back to the world (V), from there to the light (L⁻¹), through its projection (P), and from [-1, 1] to [0, 1] (S)."
    );
    Some(Diagram { svg: svg.finish(), says })
}
