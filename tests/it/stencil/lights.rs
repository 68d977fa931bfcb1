//! Several lights in one stencil buffer: each is added by its own count.

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Plan, Request};
use glumbra::scene::{Light, Scene};
use glumbra::techniques;

use crate::oracle::scenes::{floor, frustum_of, light, mesh, object, scene, square, sun};

/// The square's height over the floor, in world units.
const HEIGHT: f64 = 0.75;

/// A square that floats over a floor which casts nothing.
fn lit_by(lights: Vec<Light>) -> Scene {
    let mut ground = floor();
    ground.casts_shadow = false;
    let mut scene = scene(vec![ground, object("square", mesh(&square(0.8, HEIGHT)))], lights[0].clone());
    scene.shading.ambient = [0.0; 3];
    scene.lights = lights;
    for light in &mut scene.lights {
        (light.ambient, light.specular, light.diffuse) = ([0.0; 3], [0.0; 3], [0.25; 3]);
        light.shadow = techniques::read_text("technique = \"shadow-volume\"", &light.kind, &scene.objects).unwrap();
    }
    scene
}

/// The red channel of the picture.
fn picture(renderer: &mut Renderer, scene: &Scene) -> (Plan, Vec<f32>) {
    let plan = renderer.plan(scene, &Request { float_picture: true, ..Request::default() }).unwrap();
    renderer.draw(&plan).unwrap();
    let Pixels::RgbaF32 { data, .. } = renderer.read(&plan).unwrap().picture else { panic!("no floats") };
    (plan, data.chunks_exact(4).map(|pixel| pixel[0]).collect())
}

#[test]
fn a_light_whose_volumes_are_all_left_out_does_not_see_the_count_of_another() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let above = [DVec3::new(1.0, 2.0, 0.5), DVec3::new(-1.5, 2.0, 1.0)].map(sun);
    // In the square's plane: none of its triangles counts. And beneath it, on the floor where the others' shadows are.
    let level = light(DVec3::new(0.0, HEIGHT, 2.0), DVec3::ZERO);
    let mut beneath = light(DVec3::new(0.0, 0.5, 0.0), DVec3::ZERO);
    frustum_of(&mut beneath).cone_radians = 1.0;
    for empty in [level, beneath] {
        let alone: Vec<(Plan, Vec<f32>)> = [&above[0], &empty, &above[1]]
            .map(|light| picture(&mut renderer, &lit_by(vec![light.clone()])))
            .into_iter()
            .collect();
        let sum: Vec<f32> = (0..alone[0].1.len()).map(|k| alone.iter().map(|(_, one)| one[k]).sum()).collect();
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1]] {
            let lights = [&above[0], &empty, &above[1]];
            let together = lit_by(order.map(|k| lights[k].clone()).to_vec());
            let (_, found) = picture(&mut renderer, &together);
            let wrong = found.iter().zip(&sum).filter(|(found, sum)| (*found - *sum).abs() > 1e-3).count();
            assert_eq!(wrong, 0, "{order:?}");
        }
        // The others do shadow what it lights.
        let dark = |of: usize| alone[of].1.iter().zip(&alone[1].1).filter(|(one, lit)| **one == 0.0 && **lit > 0.005);
        assert!(dark(0).count() > 40 && dark(2).count() > 40, "{} {}", dark(0).count(), dark(2).count());
    }
}
