//! Extreme scenes as the camera sees them, moved, scaled and with given planes: each pixel shows the object that the ray
//! tracer sees, or a warning says why not.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::geometry::{self, Material};
use glumbra::plan::Request;
use glumbra::scene::Scene;
use glumbra::truth::{self, Answer, Reason, Truth};

use crate::support::random::Random;

/// A mesh as an OBJ file whose own coordinates are scaled and moved.
fn obj(mesh: &str, size: f64, at: [f64; 3]) -> String {
    let mesh = geometry::primitive(mesh).unwrap();
    let mut text = String::new();
    for place in &mesh.positions {
        let [x, y, z] = std::array::from_fn(|k| f64::from(place[k]) * size + at[k]);
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
    }
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|index| index + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text
}

/// Writes a scene into `folder`; whether its camera's planes are left out.
fn write_scene(random: &mut Random, folder: &Path) -> bool {
    let in_file = random.share() < 0.5;
    let shift = random.pick(&[0.0, 1e4, 1e6, 1e9]);
    let scale = if shift > 0.0 { 1.0 } else { random.pick(&[1.0, 1e-12, 1e-6, 1e-3, 1e3, 1e6, 1e12]) };
    let ratio = random.pick(&[0.0, 0.0, 0.0, 1e2, 1e4, 1e6, 1e8, 1e10]);
    let moved = |p: [f64; 3]| [p[0] * scale + shift, p[1] * scale - 0.7 * shift, p[2] * scale + 0.3 * shift];
    let mut place =
        |height: f64| [random.within(-3.0, 3.0), height * random.within(0.3, 1.0), random.within(-3.0, 3.0)];
    let (eye, target, lamp) = (moved(place(4.0)), moved(place(0.5)), moved(place(5.0)));
    let places = [[0.0; 3], place(1.5), place(1.5), place(1.5)];
    let mut text = format!("[image]\nsize = [80, 64]\n[camera]\neye = {eye:?}\ntarget = {target:?}\n");
    if ratio > 0.0 && 40.0 * scale / ratio > 1e-18 {
        write!(text, "near = {:?}\nfar = {:?}\n", 40.0 * scale / ratio, 40.0 * scale).unwrap();
    }
    let is_automatic = !text.contains("near");
    write!(text, "[[light]]\nkind = \"point\"\nposition = {lamp:?}\n").unwrap();
    for (k, at) in places.into_iter().enumerate() {
        let (mesh, size) = match k {
            0 => ("quad", random.pick(&[4.0, 100.0, 3000.0])),
            _ => (random.pick(&["box", "sphere", "torus"]), random.within(0.1, 0.5)),
        };
        let (at, size) = (moved(at), size * scale);
        if in_file {
            std::fs::write(folder.join(format!("{k}.obj")), obj(mesh, size, at)).unwrap();
            write!(text, "[[object]]\nmesh = \"{k}.obj\"\n").unwrap();
        } else {
            write!(text, "[[object]]\nmesh = \"{mesh}\"\ntranslate = {at:?}\nscale = {size:?}\n").unwrap();
        }
        if k == 1 {
            let [reach, length] = [0.1, 0.4].map(|part| if in_file { part * scale } else { part });
            let ways = "direction = [0, 1, 0], axis = [1, 0, 0]";
            writeln!(text, "wave = {{ {ways}, amplitude = {reach:?}, wavelength = {length:?} }}").unwrap();
        }
    }
    std::fs::write(folder.join("a.toml"), text).unwrap();
    is_automatic
}

/// The object in each pixel, from 0; -1: none.
fn drawn(scene: &Scene, renderer: &mut Renderer) -> Vec<i64> {
    const STEP: u8 = 40;
    let mut plain = scene.clone();
    plain.lights.clear();
    plain.shading.ambient = [1.0; 3];
    plain.image.background = [0.0; 3];
    for (object, index) in plain.objects.iter_mut().zip(1_u8..) {
        let grey = [f32::from(STEP * index) / 255.0; 3];
        object.material = Some(Arc::new(Material { ambient: grey, diffuse: [0.0; 3], ..Material::default() }));
    }
    let plan = renderer.plan(&plain, &Request::default()).unwrap();
    renderer.draw(&plan).unwrap();
    match renderer.read(&plan).unwrap().picture {
        Pixels::Rgba8 { data, .. } => data.chunks_exact(4).map(|texel| i64::from(texel[0] / STEP) - 1).collect(),
        other => panic!("{other:?}"),
    }
}

/// Pixels whose object is certain to the ray tracer, and is another in the picture.
fn count_wrong(truth: &Truth, drawn: &[i64]) -> usize {
    let of_view = [Reason::Silhouette, Reason::DepthTie, Reason::GrazingView, Reason::ClipPlane].map(Answer::Ambiguous);
    let is_wrong = |(pixel, drawn): &(&truth::Pixel, &i64)| {
        !of_view.contains(&pixel.answer) && pixel.hit.map_or(-1, |hit| i64::from(hit.object)) != **drawn
    };
    truth.pixels.iter().zip(drawn).filter(is_wrong).count()
}

#[test]
fn every_pixel_shows_what_a_ray_meets_or_a_warning_says_why_not() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut random = Random::new(11);
    let [mut warned, mut right_with_automatic_planes] = [0; 2];
    for round in 0..70 {
        let folder = tempfile::tempdir().unwrap();
        let is_automatic = write_scene(&mut random, folder.path());
        let path = folder.path().join("a.toml");
        let text = || std::fs::read_to_string(&path).unwrap();
        let loaded = glumbra::load(&path, &[]).unwrap_or_else(|error| panic!("{round}: {error}\n{}", text()));
        let most_ambiguous = if is_automatic { 0.03 } else { 1.0 };
        let options = truth::Options { most_ambiguous, ..truth::Options::default() };
        let truth =
            truth::trace(&loaded.scene, 0, &options).unwrap_or_else(|error| panic!("{round}: {error}\n{}", text()));
        let wrong = count_wrong(&truth, &drawn(&loaded.scene, &mut renderer));
        let warnings = &loaded.warnings;
        assert!(wrong == 0 || !warnings.is_empty(), "{round}: {wrong} pixels are wrong\n{}", text());
        assert!(warnings.is_empty() || !is_automatic, "{round}: {warnings:?}\n{}", text());
        warned += usize::from(wrong > 0);
        right_with_automatic_planes += usize::from(is_automatic);
    }
    assert!(warned > 5 && right_with_automatic_planes > 15, "{warned} {right_with_automatic_planes}");
}
