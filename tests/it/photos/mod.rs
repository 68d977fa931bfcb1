//! Photographs that are projected back onto what they show [Segal 1992, 3.1]. No photograph is an asset: the program takes
//! it itself, of generated scenes whose surfaces have decals and no light.

mod compositions;
mod errors;
mod extremes;
mod facade;
mod planes;
mod plans;
mod proof;

use std::path::{Path, PathBuf};
use std::rc::Rc;

use glam::DVec3;
use glumbra::context::{self, Context, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Plan, Request};
use glumbra::scene::{self, Scene};
use glumbra::truth::{self, ColorTruth};
use image::{Rgb, RgbImage};

use crate::support::random::Random;

/// Codes of the grey of what a photograph does not show.
const GREY: [i32; 3] = [128; 3];

/// A camera's place, and the full angle in degrees between the lower and the upper side of what it sees.
#[derive(Clone, Copy, Debug)]
struct Pose {
    eye: DVec3,
    target: DVec3,
    fov_y: f64,
}

impl Pose {
    fn camera(&self) -> String {
        format!("[camera]\neye = {}\ntarget = {}\nfov_y = {:?}\n", vector(self.eye), vector(self.target), self.fov_y)
    }

    /// `photo = { … }` of the picture at `path`, taken from here.
    fn photo(&self, path: &Path, more: &str) -> String {
        let (eye, target) = (vector(self.eye), vector(self.target));
        format!("photo = {{ image = {path:?}, eye = {eye}, target = {target}, fov_y = {:?}, {more} }}", self.fov_y)
    }
}

fn vector(at: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", at.x, at.y, at.z)
}

/// The scene file of `objects`, each with its keys without the end of its material, seen from `pose`; `photo` ends each
/// material.
fn scene_text(size: [u32; 2], pose: &Pose, objects: &[String], photo: &str) -> String {
    let mut text = format!(
        "[image]\nsize = {size:?}\nbackground = [0.0, 0.2, 0.4]\n[shading]\nambient = [1.0, 1.0, 1.0]\n{}",
        pose.camera()
    );
    for object in objects {
        text += &format!("[[object]]\n{object}{photo} }}\n");
    }
    text
}

/// A folder with pictures, and a renderer for scenes in it.
struct Studio {
    folder: tempfile::TempDir,
    renderer: Renderer,
    _context: Rc<dyn Context>,
}

impl Studio {
    fn new() -> Self {
        let context = context::open(&ContextRequest::default()).unwrap();
        let renderer = Renderer::new(&context);
        Self { folder: tempfile::tempdir().unwrap(), renderer, _context: context }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn try_load(&self, text: &str) -> Result<Scene, scene::Error> {
        let path = self.path("scene.toml");
        std::fs::write(&path, text).unwrap();
        Ok(glumbra::load(&path, &[])?.scene)
    }

    fn load(&self, text: &str) -> Scene {
        self.try_load(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    fn plan(&mut self, scene: &Scene, request: &Request) -> Plan {
        self.renderer.plan(scene, request).unwrap()
    }

    /// The picture's pixels, row by row from the top.
    fn draw(&mut self, scene: &Scene) -> Vec<[i32; 3]> {
        self.draw_as(scene, &Request::default())
    }

    fn draw_as(&mut self, scene: &Scene, request: &Request) -> Vec<[i32; 3]> {
        let plan = self.plan(scene, request);
        self.renderer.draw(&plan).unwrap();
        let Pixels::Rgba8 { data, .. } = self.renderer.read(&plan).unwrap().picture else { panic!("no RGBA8") };
        data.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b].map(i32::from)).collect()
    }

    /// Takes a photograph: draws the scene and saves it.
    fn take(&mut self, scene: &Scene, name: &str) -> (PathBuf, Vec<[i32; 3]>) {
        let pixels = self.draw(scene);
        let [width, height] = scene.image.size;
        let picture =
            RgbImage::from_fn(width, height, |x, y| Rgb(pixels[(y * width + x) as usize].map(|code| code as u8)));
        let path = self.path(name);
        picture.save(&path).unwrap();
        (path, pixels)
    }
}

/// A decal without fine detail: sums of waves, one to three over its sides, which tile.
fn smooth_decal(random: &mut Random) -> RgbImage {
    let waves: Vec<[f64; 4]> = (0..3)
        .map(|_| [random.within(1.0, 3.9).floor(), random.within(0.0, 2.9).floor(), random.share(), random.share()])
        .collect();
    RgbImage::from_fn(64, 64, |x, y| {
        let (s, t) = (f64::from(x) / 64.0, f64::from(y) / 64.0);
        Rgb([0, 1, 2].map(|k: usize| {
            let [across, up, phase, depth] = waves[k];
            let wave = (std::f64::consts::TAU * (across * s + up * t + phase)).sin();
            (110.0 + 40.0 * depth * wave + 30.0 * wave) as u8
        }))
    })
}

/// A floor and some boxes, balls and sheets on it, in colours and decals; each text lacks the end of its material.
fn generated_objects(studio: &Studio, random: &mut Random) -> Vec<String> {
    let decal = studio.path("decal.png");
    smooth_decal(random).save(&decal).unwrap();
    let color = |random: &mut Random| {
        let [r, g, b] = [(); 3].map(|()| random.within(0.3, 1.0));
        format!("diffuse = [{r:.3}, {g:.3}, {b:.3}], ")
    };
    let decal = format!("decal = {decal:?}, ");
    let mut objects =
        vec![format!("mesh = \"quad\"\nlit = false\nscale = [4.0, 1.0, 4.0]\nmaterial = {{ {}{decal}", color(random))];
    for _ in 0..4 {
        let mesh = random.pick(&["box", "sphere", "quad", "torus", "box"]);
        let size = random.within(0.4, 0.9);
        let mirror = random.pick(&[1.0, -1.0]);
        let at = random.vector() * DVec3::new(2.0, 0.0, 2.0) + DVec3::Y * (size + random.within(0.01, 0.6));
        let axis = random.vector();
        let own = if random.share() < 0.6 { &*decal } else { "" };
        objects.push(format!(
            "mesh = \"{mesh}\"\nlit = false\ntranslate = {}\nrotate = {{ axis = {}, angle = {:.2} }}\n\
             scale = [{:.3}, {:.3}, {:.3}]\nmaterial = {{ {}{own}",
            vector(at),
            vector(axis),
            random.within(0.0, 360.0),
            mirror * size,
            size * random.within(0.5, 1.0),
            size,
            color(random)
        ));
    }
    objects
}

/// A pose above the floor that looks at the scene's middle.
fn generated_pose(random: &mut Random) -> Pose {
    let angle = random.within(0.0, std::f64::consts::TAU);
    let (distance, height) = (random.within(4.0, 7.0), random.within(0.8, 4.0));
    Pose {
        eye: DVec3::new(distance * angle.cos(), height, distance * angle.sin()),
        target: random.vector() * 0.4 + DVec3::Y * 0.5,
        fov_y: random.within(35.0, 60.0),
    }
}

/// The colours of a scene without lights' shadows; `texels`: the size of its photographs' maps.
fn colors(scene: &Scene, texels: Option<u32>) -> ColorTruth {
    let options = truth::Options { photo_map_size: texels, ..truth::Options::default() };
    // Rays to a photograph's eye need no light, but the ray tracer needs one.
    let mut scene = scene.clone();
    if scene.lights.is_empty() {
        let text = "[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\ncolor = [0, 0, 0]\n[[object]]\nmesh = \"quad\"\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("light.toml");
        std::fs::write(&path, text).unwrap();
        scene.lights = glumbra::load(&path, &[]).unwrap().scene.lights;
    }
    truth::color(&scene, &vec![None; scene.lights.len()], &options).unwrap()
}

/// Known pixels, and of these the ones that are more than `codes` beyond their bounds.
fn beyond(truth: &ColorTruth, picture: &[[i32; 3]], codes: f64) -> (usize, Vec<usize>) {
    let known = truth.pixels.iter().enumerate().filter(|(_, pixel)| pixel.is_known);
    let (mut count, mut wrong) = (0, Vec::new());
    for (index, pixel) in known {
        count += 1;
        if pixel.excess_codes(picture[index].map(f64::from)) > codes {
            wrong.push(index);
        }
    }
    (count, wrong)
}
