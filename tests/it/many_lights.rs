//! More lights than one pass holds: the picture is the sum of the lights' own pictures.

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::pass::Work;
use glumbra::plan::{self, Plan, Request};
use glumbra::scene::Scene;
use glumbra::techniques;

/// A ring of spotlights around a box, a sphere and a second box on the very place of the first; `shadow` by number.
fn scene(lights: usize, shadow: impl Fn(usize) -> &'static str) -> Scene {
    let mut text = String::from(
        "[image]\nsize = [96, 72]\nbackground = [0.0, 0.0, 0.0]\n[camera]\neye = [3.0, 4.0, 5.0]\ntarget = [0.0, 0.4, 0.0]\nfov_y = 45.0\n\
         [shading]\nambient = [0.1, 0.05, 0.02]\n\
         [[object]]\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\nmaterial = { diffuse = [0.8, 0.8, 0.7], specular = [0.2, 0.2, 0.2] }\n\
         [[object]]\nmesh = \"sphere\"\nscale = 0.4\ntranslate = [1.3, 0.5, 0.4]\nmaterial = { diffuse = [0.4, 0.7, 0.5] }\n",
    );
    for _ in 0..2 {
        text += "[[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [0.0, 0.5, 0.0]\nmaterial = { diffuse = [0.8, 0.5, 0.3] }\n";
    }
    for index in 0..lights {
        let angle = index as f64 * 2.399_963;
        let color = [0.04, 0.02 + 0.02 * (index % 3) as f64, 0.03];
        text += &format!(
            "[[light]]\nkind = \"spot\"\nposition = [{:?}, {:?}, {:?}]\ntarget = [0.0, 0.2, 0.0]\ncone = 60.0\ndiffuse = {color:?}\n\
             specular = [0.02, 0.02, 0.02]\nambient = [0.001, 0.0, 0.0]\nshadow = {{ {} }}\n",
            4.0 * angle.cos(),
            3.0 + 0.05 * index as f64,
            4.0 * angle.sin(),
            shadow(index)
        );
    }
    scene_of(&text)
}

/// The same without other lights than `kept`, and without ambient light of the scene.
fn alone(scene: &Scene, kept: usize) -> Scene {
    let mut alone = scene.clone();
    alone.shading.ambient = [0.0; 3];
    alone.lights = vec![scene.lights[kept].clone()];
    alone
}

fn draw(scene: &Scene, float_picture: bool, renderer: &mut Renderer) -> (Plan, Vec<f32>) {
    let request = Request { float_picture, ..Request::default() };
    let plan = renderer.plan(scene, &request).unwrap();
    renderer.draw(&plan).unwrap();
    let picture = match renderer.read(&plan).unwrap().picture {
        Pixels::RgbaF32 { data, .. } => data,
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f32::from(*code) / 255.0).collect(),
        other => panic!("{other:?}"),
    };
    (plan, picture)
}

/// Greatest difference of the picture in all lights from the sum of the pictures in each, in red, green and blue.
fn difference(scene: &Scene, float_picture: bool, renderer: &mut Renderer) -> f32 {
    let mut dark = scene.clone();
    dark.lights.truncate(1);
    (dark.lights[0].diffuse, dark.lights[0].specular, dark.lights[0].ambient) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let mut sum = draw(&dark, true, renderer).1;
    for index in 0..scene.lights.len() {
        let one = draw(&alone(scene, index), true, renderer).1;
        sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
    }
    let picture = draw(scene, float_picture, renderer).1;
    assert!(sum.iter().any(|value| *value > 0.3), "the scene is too dark to tell anything");
    let pixels = picture.chunks_exact(4).zip(sum.chunks_exact(4));
    pixels
        .flat_map(|(is, should)| {
            (0..3).map(|k| (is[k] - should[k].min(if float_picture { f32::MAX } else { 1.0 })).abs())
        })
        .fold(0.0, f32::max)
}

#[test]
fn sixty_four_shadowed_lights_are_the_sum_of_each() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = scene(64, |_| "technique = \"shadow-map\", size = 128");
    // In floats: 64 sums, rounded by 2^-24 of at most 4.
    let float = difference(&scene, true, &mut renderer);
    assert!(float < 2e-5, "{float}");
    // In codes of 8 bits: each of 8 groups is rounded once.
    let codes = 255.0 * difference(&scene, false, &mut renderer);
    assert!(codes <= 8.0 * 0.5 + 0.1, "{codes}");
}

#[test]
fn lights_that_are_counted_join_groups_of_others() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let technique = |index: usize| match index % 6 {
        0 => "technique = \"shadow-volume\"",
        1 => "technique = \"shadow-volume\", dimming = 0.3",
        _ => "technique = \"shadow-map\", size = 128",
    };
    let scene = scene(24, technique);
    let float = difference(&scene, true, &mut renderer);
    assert!(float < 2e-5, "{float}");
}

#[test]
fn passes_grow_with_the_lights_and_no_faster() {
    let lit = |lights: usize| {
        let plan =
            plan::make(&scene(lights, |_| "technique = \"shadow-map\", size = 128"), &Request::default()).unwrap();
        let onto_picture = |work: &Work| matches!(work, Work::Draw(pass) if pass.target.color == Some(plan.picture));
        plan.list.passes.iter().filter(|pass| onto_picture(&pass.work)).count()
    };
    assert_eq!([1, 8, 9, 16, 17, 64].map(lit), [1, 1, 2, 2, 3, 8]);
}

#[test]
fn clipped_surfaces_and_groups_exclude_each_other() {
    let scene = scene(9, |_| "technique = \"shadow-map\", guard = \"clip-plane\"");
    let mut few = scene.clone();
    few.lights.truncate(2);
    assert!(plan::make(&few, &Request::default()).is_ok());
    let mut many = scene;
    many.lights.iter_mut().skip(1).for_each(|light| light.shadow = techniques::unshadowed());
    let error = plan::make(&many, &Request::default()).unwrap_err().to_string();
    assert!(error.contains("guard = \"clip-plane\" (light 0) cannot be combined with 9 lights"), "{error}");
}
