//! A projected image through a lens, against closed forms: a point of the image spreads to a disc of the radius R |1 - d/F|
//! on a plane at the distance d; the focal plane stays sharp.

use std::sync::Arc;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::geometry::Texture;
use glumbra::scene::{ImageFilter, Scene};

use super::{draw, spot_of, with_lens};
use crate::support::scene_of;

const SIZE: [usize; 2] = [256, 192];
const FOV: f64 = 40.0;

/// A plane square to the axis at a distance, unlit so that the picture is the image's own, seen and lit from one place.
fn board(distance: f64, image: &[[u8; 3]], width: u32) -> Scene {
    let mut scene = scene_of(&format!(
        "[image]\nsize = [{}, {}]\nbackground = [0, 0, 0]\n[shading]\nambient = [0, 0, 0]\n[camera]\neye = [0, 0, 0]\n\
         target = [0, 0, -1]\nfov_y = {FOV:?}\nnear = {:?}\nfar = {:?}\n[[light]]\nkind = \"spot\"\nshape = \"frustum\"\n\
         position = [0, 0, 0]\ntarget = [0, 0, -1]\ncone = 80.0\nnear = 0.01\nfar = 100.0\n[[object]]\nmesh = \"quad\"\n\
         scale = {:?}\nrotate = {{ axis = [1, 0, 0], angle = 90 }}\ntranslate = [0, 0, {:?}]\nlit = false\n\
         material = {{ diffuse = [1, 1, 1] }}\n",
        SIZE[0],
        SIZE[1],
        0.1 * distance,
        10.0 * distance,
        4.0 * distance,
        -distance
    ));
    let rgba = image.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let height = image.len() as u32 / width;
    let texture = Texture { name: String::from("slide"), width, height, rgba, has_alpha: false };
    let spot = spot_of(&mut scene);
    (spot.image, spot.image_filter) = (Some(Arc::new(texture)), ImageFilter::Nearest);
    scene
}

/// Width of a pixel on the board.
fn pixel(distance: f64) -> f64 {
    2.0 * distance * (0.5 * FOV).to_radians().tan() / SIZE[1] as f64
}

/// Where a row of pixels first reaches a level, in pixels from its left, between two pixels' centres.
fn reaches(row: &[f64], level: f64) -> f64 {
    let at = row.iter().position(|value| *value >= level).unwrap();
    let (before, after) = (row[at - 1], row[at]);
    at as f64 - 0.5 + (level - before) / (after - before)
}

/// The image of a knife's edge, dark left and bright right, on a board: its middle row.
fn ramp(distance: f64, lens: [f64; 2], samples: u32, renderer: &mut Renderer) -> Vec<f64> {
    let scene = with_lens(&board(distance, &[[0; 3], [255; 3]], 2), lens[0], lens[1], samples);
    let (picture, _) = draw(&scene, renderer);
    picture[SIZE[0] * (SIZE[1] / 2)..][..SIZE[0]].iter().map(|pixel| pixel[0]).collect()
}

/// A uniform disc of radius r passes 10 % to 90 % of an edge's light over 1.374 r. N lens points make a stair of N steps:
/// a level is off by no more than about the widest gap of √N points across the disc, 2 r / √N, at each end.
#[test]
fn a_knife_edge_is_as_wide_as_the_lens_makes_it() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let focal = 3.0;
    for (distance, radius) in [(1.5, 0.05), (1.5, 0.2), (2.4, 0.2), (4.5, 0.1), (6.0, 0.15), (12.0, 0.2)] {
        for samples in [64, 257, 1024] {
            let row = ramp(distance, [focal, radius], samples, &mut renderer);
            let measured = (reaches(&row, 0.9) - reaches(&row, 0.1)) * pixel(distance);
            let blur = radius * (1.0 - distance / focal).abs();
            let due = 1.374 * blur;
            let allowed = pixel(distance) + 2.0 * blur / f64::from(samples).sqrt();
            println!(
                "board at {distance}, radius {radius}, {samples} points: {measured:.4} of {due:.4} ± {allowed:.4}"
            );
            assert!((measured - due).abs() < allowed, "{distance} {radius} {samples}: {measured} of {due}");
            // The edge stays where it is: the points' mean is the lens's middle.
            let middle = reaches(&row, 0.5) - SIZE[0] as f64 / 2.0;
            assert!((middle * pixel(distance)).abs() < 0.5 * allowed, "{distance} {radius} {samples}: {middle}");
        }
    }
}

/// All lens points agree in the focal plane: the picture of one. A sum of N shares is off by N roundings of 2^-24.
#[test]
fn the_focal_plane_is_sharp_for_every_number_of_lens_points() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let colors: Vec<[u8; 3]> = (0..64_u32).map(|k| [k * 4, 255 - k * 3, k * 37 % 256].map(|c| c as u8)).collect();
    for (focal, radius) in [(3.0, 0.2), (0.7, 0.02), (40.0, 4.0)] {
        let plain = board(focal, &colors, 8);
        let sharp = draw(&plain, &mut renderer).0;
        for samples in [2, 3, 16, 255, 4096] {
            let picture = draw(&with_lens(&plain, focal, radius, samples), &mut renderer).0;
            let errors =
                picture.iter().zip(&sharp).map(|(is, due)| (0..3).map(|k| (is[k] - due[k]).abs()).fold(0.0, f64::max));
            let allowed = f64::from(samples) * 2.0_f64.powi(-24) + 1e-6;
            // A pixel on the border of two texels may take either.
            let off = errors.clone().filter(|error| *error > allowed).count();
            println!("focal plane at {focal}, {samples} points: {off} pixels off by more than {allowed:.1e}");
            assert!(off <= sharp.len() / 500, "{focal} {samples}: {off}");
        }
    }
}

/// A bright texel in the dark spreads to a disc: nothing is lit beyond R |1 - d/F|, and something is lit as far out as the
/// outermost lens points lie, √(1 - 1/N) of the radius.
#[test]
fn a_point_spreads_to_a_disc() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let side = 129_usize;
    let mut texels = vec![[0; 3]; side * side];
    texels[side * (side / 2) + side / 2] = [255; 3];
    for (distance, focal, radius, samples) in
        [(2.0, 4.0, 0.2, 200), (8.0, 4.0, 0.1, 333), (1.0, 1e9, 0.1, 100), (1.0, 0.25, 0.05, 100), (1.0, 0.5, 0.2, 128)]
    {
        let scene = with_lens(&board(distance, &texels, side as u32), focal, radius, samples);
        let (picture, _) = draw(&scene, &mut renderer);
        let blur = radius * (1.0 - distance / focal).abs();
        let texel = distance * 40_f64.to_radians().tan() / side as f64 * std::f64::consts::SQRT_2;
        let away = |index: usize| {
            let [x, y] = [index % SIZE[0], index / SIZE[0]].map(|at| at as f64 + 0.5);
            (x - SIZE[0] as f64 / 2.0).hypot(y - SIZE[1] as f64 / 2.0) * pixel(distance)
        };
        let lit = (0..picture.len()).filter(|index| picture[*index][0] > 1e-4);
        let farthest = lit.map(away).fold(0.0, f64::max);
        let least = blur * (1.0 - 1.0 / f64::from(samples)).sqrt() - pixel(distance);
        println!("{distance} of {focal}: lit up to {farthest:.4}, disc of {blur:.4}, texel of {texel:.4}");
        assert!(farthest <= blur + texel + pixel(distance) && farthest >= least, "{farthest} {blur} {texel}");
        let sum: f64 = picture.iter().map(|pixel| pixel[0]).sum::<f64>() * pixel(distance).powi(2);
        // No light is lost: the disc is as bright as the texel, but for pixels at rims.
        let due = (2.0 * distance * 40_f64.to_radians().tan() / side as f64).powi(2);
        assert!((sum / due - 1.0).abs() < 0.1, "{sum} of {due}");
    }
}
