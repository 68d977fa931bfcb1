//! Projected light against formulas in f64: images, beams, laws of distance, interpolation.

mod beams;
mod colors;
mod everything;
mod images;
mod swimming;

use std::path::Path;
use std::rc::Rc;

use glam::{DVec2, DVec3};
use glumbra::context::{self, Context, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::{self, Loaded, Scene, Spot};
use glumbra::truth;
use image::RgbImage;

/// Loads a scene's text in a folder that has these pictures.
fn load(text: &str, pictures: &[(&str, &RgbImage)]) -> Loaded {
    try_load(text, pictures).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn try_load(text: &str, pictures: &[(&str, &RgbImage)]) -> Result<Loaded, scene::Error> {
    let folder = tempfile::tempdir().unwrap();
    for (name, picture) in pictures {
        picture.save(folder.path().join(name)).unwrap();
    }
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    glumbra::load(Path::new(&path), &[])
}

fn renderer() -> (Rc<dyn Context>, Renderer) {
    let context = context::open(&ContextRequest::default()).unwrap();
    let renderer = Renderer::new(&context);
    (context, renderer)
}

fn codes_of(pixels: Pixels) -> Vec<[i32; 3]> {
    let codes: Vec<i32> = match pixels {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| i32::from(*code)).collect(),
        Pixels::RgbaF32 { data, .. } => data.iter().map(|value| (255.0 * value).round() as i32).collect(),
        _ => panic!("a picture of another format"),
    };
    codes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

/// The picture's pixels, row by row from the top.
fn draw(scene: &Scene, renderer: &mut Renderer) -> Vec<[i32; 3]> {
    let plan = renderer.plan(scene, &Request::default()).unwrap();
    renderer.draw(&plan).unwrap();
    codes_of(renderer.read(&plan).unwrap().picture)
}

/// A view of light 0.
fn draw_view(scene: &Scene, view: glumbra::views::View, renderer: &mut Renderer) -> Vec<[i32; 3]> {
    let request = Request { views: vec![ViewRequest { view, light: 0 }], ..Request::default() };
    let plan = renderer.plan(scene, &request).unwrap();
    renderer.draw(&plan).unwrap();
    codes_of(renderer.read(&plan).unwrap().views.remove(0))
}

/// Visible points, pixel by pixel; `None` for the background and where the view itself is in doubt.
fn seen_points(scene: &Scene) -> Vec<Option<DVec3>> {
    use glumbra::truth::{Answer, Reason};
    let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
    let truth = truth::trace(scene, 0, &options).unwrap();
    let is_clear = |answer: Answer| {
        use Reason::{DepthTie, GrazingView, Silhouette};
        !matches!(answer, Answer::Ambiguous(Silhouette | DepthTie | GrazingView))
    };
    truth.pixels.iter().map(|pixel| Some(pixel.hit.filter(|_| is_clear(pixel.answer))?.position)).collect()
}

/// (s, t) of a point in a spotlight's image, t from below; and the distance along its axis, at most 0 behind it.
fn image_place(spot: &Spot, point: DVec3) -> (DVec2, f64) {
    let frustum = &spot.frustum;
    let ahead = (frustum.target - frustum.position).normalize();
    let right = ahead.cross(frustum.up).normalize();
    let up = right.cross(ahead);
    let away = point - frustum.position;
    let depth = away.dot(ahead);
    let half = (0.5 * frustum.cone_radians).tan();
    let across = DVec2::new(away.dot(right) / frustum.aspect, away.dot(up)) / (depth * half);
    (0.5 + 0.5 * across, depth)
}

/// A texel's codes; row 0 is the lowest.
fn texel(picture: &RgbImage, x: i64, y: i64) -> [f64; 3] {
    let (width, height) = (i64::from(picture.width()), i64::from(picture.height()));
    let (x, y) = (x.clamp(0, width - 1), y.clamp(0, height - 1));
    picture.get_pixel(x as u32, (height - 1 - y) as u32).0.map(f64::from)
}

/// A scene of `objects` under one light that shows its image as it is: unlit white surfaces, no ambient light.
fn unlit_scene(camera: &str, light: &str, objects: &str) -> String {
    format!(
        "[image]\nsize = [120, 90]\nbackground = [0.0, 0.0, 0.0]\n[camera]\n{camera}\n[shading]\nambient = [0.0, 0.0, 0.0]\n\
         [[light]]\nkind = \"spot\"\n{light}\n[light.shadow]\ntechnique = \"none\"\n{objects}"
    )
}

const WHITE: &str = "lit = false\nmaterial = { diffuse = [1.0, 1.0, 1.0] }\n";
