//! What the captions of `glumbra figures` say, held against pixels of the panels; and the command itself.

use std::process::Command;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::figures::{FIGURES, Figure};
use glumbra::frame::Renderer;
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::techniques::views::View;

fn figure(name: &str) -> &'static Figure {
    FIGURES.iter().find(|figure| figure.name == name).unwrap()
}

/// What a view shows of a point, and whether the point is what is seen there is the caller's to know.
fn at(scene: &Scene, view: View, point: DVec3, renderer: &mut Renderer) -> [f32; 2] {
    let views = vec![ViewRequest { view, light: 0 }];
    let plan = renderer.plan(scene, &Request { views, ..Request::default() }).unwrap();
    renderer.draw(&plan).unwrap();
    let clip = scene.camera.clip_from_view(scene.aspect()) * scene.camera.view_from_world() * point.extend(1.0);
    let [width, height] = scene.image.size.map(f64::from);
    let x = ((0.5 + 0.5 * clip.x / clip.w) * width).floor() as usize;
    let y = ((0.5 - 0.5 * clip.y / clip.w) * height).floor() as usize;
    assert!(x < width as usize && y < height as usize, "{point} is not in the picture");
    let pixel = y * width as usize + x;
    match &renderer.read(&plan).unwrap().views[0] {
        Pixels::RgbaF32 { data, .. } => [data[4 * pixel], data[4 * pixel + 3]],
        Pixels::Stencil { data, .. } => [f32::from(data[pixel]), 1.0],
        other => panic!("{:?}", other.size()),
    }
}
