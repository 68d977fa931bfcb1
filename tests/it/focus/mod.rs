//! Light through a lens, by accumulation: focus and soft shadows.

mod rules;
mod slide;
mod soft;

use glam::DVec2;
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Plan, Request};
use glumbra::scene::{Focus, LightKind, Scene, Spot};

use crate::support::random::Random;
use crate::support::scene_of;

/// The picture in floats, row by row from the top, and its plan.
pub fn draw(scene: &Scene, renderer: &mut Renderer) -> (Vec<[f64; 3]>, Plan) {
    let request = Request { float_picture: true, sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request).unwrap();
    renderer.draw(&plan).unwrap();
    let Pixels::RgbaF32 { data, .. } = renderer.read(&plan).unwrap().picture else { panic!("a float picture") };
    (data.chunks_exact(4).map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k]))).collect(), plan)
}

pub fn spot_of(scene: &mut Scene) -> &mut Spot {
    let LightKind::Spot(spot) = &mut scene.lights[0].kind else { panic!("a spotlight") };
    spot
}

/// The same scene with another lens.
pub fn with_lens(scene: &Scene, distance: f64, radius: f64, samples: u32) -> Scene {
    let mut scene = scene.clone();
    spot_of(&mut scene).focus = Some(Focus { distance, radius, samples });
    scene
}

/// Points on the unit disc, at random.
pub fn random_points(random: &mut Random, count: usize) -> Vec<DVec2> {
    let point =
        |random: &mut Random| random.share().sqrt() * DVec2::from_angle(random.within(0.0, std::f64::consts::TAU));
    (0..count).map(|_| point(random)).collect()
}

/// Random boxes and quads, all white, in the light of one spotlight with a lens: no other light.
pub fn random_scene(random: &mut Random, technique: &str, focus: [f64; 2], samples: u32) -> Scene {
    let vector = |random: &mut Random, reach: f64| {
        let at = random.vector() * random.within(0.3, 1.0) * reach;
        format!("[{:?}, {:?}, {:?}]", at.x, at.y, at.z)
    };
    let [distance, radius] = focus;
    let mut text = format!(
        "[image]\nsize = [80, 60]\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n[camera]\neye = {}\ntarget = {}\n\
         fov_y = {:?}\nnear = 0.1\nfar = 30.0\n[[light]]\nkind = \"spot\"\nshape = \"{}\"\nposition = {}\ntarget = {}\n\
         cone = {:?}\nnear = 0.4\nfar = 9.0\ncolor = [0.9, 0.8, 0.7]\nattenuation = [{:?}, {:?}, 0.02]\n\
         focus = {{ distance = {distance:?}, radius = {radius:?}, samples = {samples} }}\nshadow = {{ {technique} }}\n",
        vector(random, 4.0),
        vector(random, 0.5),
        random.within(30.0, 80.0),
        random.pick(&["cone", "frustum"]),
        vector(random, 4.0),
        vector(random, 0.5),
        random.within(20.0, 90.0),
        random.within(0.5, 1.5),
        random.within(0.0, 0.2),
    );
    let closed = technique.contains("second-depth");
    for _ in 0..3 + random.below(4) {
        text += &format!(
            "[[object]]\nmesh = \"{}\"\nscale = [{:?}, {:?}, {:?}]\nrotate = {{ axis = {}, angle = {:?} }}\n\
             translate = {}\nmaterial = {{ diffuse = [1, 1, 1], specular = [0, 0, 0] }}\n",
            random.pick(if closed { &["box", "box"] } else { &["box", "quad"] }),
            random.within(0.1, 0.8),
            random.within(0.1, 0.8),
            random.within(0.1, 0.8),
            vector(random, 1.0),
            random.within(0.0, 180.0),
            vector(random, 1.6)
        );
    }
    scene_of(&text)
}
