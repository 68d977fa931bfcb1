//! Kernels, mipmaps and biases on an analytic edge: the shade of every pixel across it, by GL's own weights.
//!
//! The light stands straight above a floor, a square ends at a known texel coordinate of its map, and the camera looks
//! straight down from between the square and the floor: which texels are dark, and where in the map a pixel lies, are
//! products of similar triangles. [GL 4.6, 8.14.3 and 8.23.1]

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::scene::Scene;
use glumbra::techniques;

const SIZE: u32 = 32;
const WIDTH: u32 = 256;
const LIGHT: f64 = 7.0;
const SQUARE: f64 = 5.0;
const CAMERA: f64 = 3.0;

fn half() -> f64 {
    20.0_f64.to_radians().tan()
}

/// The square covers the map up to texel coordinate `edge`. `fov_y` in degrees; the picture is 16 times as wide as high.
fn scene(edge: f64, fov_y: f64, keys: &str) -> Scene {
    let spot = "target = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, -1.0]\ncone = 40.0\nshape = \"frustum\"";
    scene_under(spot, half(), edge, fov_y, keys)
}

/// Under a light whose map ends at the tangent `half`.
fn scene_under(light: &str, half: f64, edge: f64, fov_y: f64, keys: &str) -> Scene {
    let end = (2.0 * edge / f64::from(SIZE) - 1.0) * half * (LIGHT - SQUARE);
    let text = format!(
        "[image]\nsize = [{WIDTH}, 16]\n[camera]\neye = [0.0, {CAMERA:?}, 0.0]\ntarget = [0.0, 0.0, 0.0]\n\
         up = [0.0, 0.0, -1.0]\nfov_y = {fov_y:?}\nnear = 0.1\nfar = 10.0\n\
         [[light]]\nposition = [0.0, {LIGHT:?}, 0.0]\n{light}\nnear = 1.0\nfar = 9.0\n[light.shadow]\ntechnique = \"shadow-map\"\nsize = {SIZE}\n{keys}\n\
         [[object]]\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\n\
         [[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\ntranslate = [{:?}, {SQUARE:?}, 0.0]\n",
        end - 4.0
    );
    scene_of(&text)
}

/// A row of pixels: the floor's x and z that it shows.
fn floor_points(fov_y: f64) -> impl Iterator<Item = (f64, f64)> {
    let pixel = 2.0 * (0.5 * fov_y.to_radians()).tan() * CAMERA / 16.0;
    // Row 7 of 16 from the top, just above the middle: z is half a pixel below 0.
    (0..WIDTH).map(move |x| ((f64::from(x) + 0.5 - 0.5 * f64::from(WIDTH)) * pixel, -0.5 * pixel))
}

/// Tests whether a texel of a level is lit: its centre lies past the edge.
fn lit(texel: f64, edge: f64) -> f64 {
    if texel + 0.5 >= edge { 1.0 } else { 0.0 }
}

/// One tap at texel coordinate `u`; `None` where rounding may choose another texel.
fn tap(u: f64, edge: f64, linear: bool) -> Option<f64> {
    if !linear {
        let near_a_border = (u - u.round()).abs() < 1e-3;
        return (!near_a_border).then(|| lit(u.floor(), edge));
    }
    let first = (u - 0.5).floor();
    let part = u - 0.5 - first;
    Some((1.0 - part) * lit(first, edge) + part * lit(first + 1.0, edge))
}

fn kernel(u: f64, edge: f64, side: u32, linear: bool) -> Option<f64> {
    let taps = (0..side).map(|k| tap(u + f64::from(k) - 0.5 * f64::from(side - 1), edge, linear));
    Some(taps.sum::<Option<f64>>()? / f64::from(side))
}

/// Holds a row of pixels against what `expected` says of a texel coordinate of level 0. Pixels compared, and how many
/// of them are neither lit nor dark.
fn check(
    name: &str,
    edge: f64,
    fov_y: f64,
    keys: &str,
    renderer: &mut Renderer,
    expected: &dyn Fn([f64; 2]) -> Option<f64>,
) {
    let scene = scene(edge, fov_y, keys);
    check_scene(&scene, name, edge, fov_y, renderer, expected);
}

fn check_scene(
    scene: &Scene,
    name: &str,
    edge: f64,
    fov_y: f64,
    renderer: &mut Renderer,
    expected: &dyn Fn([f64; 2]) -> Option<f64>,
) {
    let shade = draw_shade(scene, 0, renderer).unwrap();
    let row = &shade.shade[7 * WIDTH as usize..8 * WIDTH as usize];
    let (mut compared, mut partial, mut worst) = (0, 0, 0.0_f64);
    for (point, found) in floor_points(fov_y).zip(row) {
        let Some(expected) = expected([point.0, point.1]) else { continue };
        let off = (expected - f64::from(*found)).abs();
        assert!(off <= 1.0 / 255.0, "{name}, edge {edge}: {found} at x = {:.4}, not {expected}", point.0);
        (compared, worst) = (compared + 1, worst.max(off));
        partial += usize::from(expected > 0.01 && expected < 0.99);
    }
    println!("{name:<60} edge {edge}: {compared} pixels, {partial} of them partial, off by {worst:.1e} at most");
    assert!(compared > 200, "{name}: {compared}");
}

/// The texel coordinate at which a point at height `y` above the floor is looked up.
fn texel(x: f64, y: f64, size: u32) -> f64 {
    f64::from(size) * (0.5 + 0.5 * x / ((LIGHT - y) * half()))
}

#[test]
fn kernels_weigh_as_gl_does() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for edge in [13.37, 18.6, 16.0] {
        for (filter, linear) in [("nearest", false), ("linear", true)] {
            for (name, side) in [
                ("1", 1),
                ("\"2x2\"", 2),
                ("\"3x3\"", 3),
                ("\"4x4\"", 4),
                ("\"5x5\"", 5),
                ("\"6x6\"", 6),
                ("\"7x7\"", 7),
            ] {
                // The floor lies square to the light: its plane is level, so that these biases move no reference.
                for bias in ["offset", "receiver-plane", "adaptive"] {
                    let keys = format!("kernel = {name}\nfilter = \"{filter}\"\nbias = \"{bias}\"");
                    let expected = |[x, _]: [f64; 2]| kernel(texel(x, 0.0, SIZE), edge, side, linear);
                    check(&keys.replace('\n', ", "), edge, 5.0, &keys, &mut renderer, &expected);
                }
            }
        }
    }
}

/// A cube's kernel on the face below the light, whose columns run along x: the same weights.
#[test]
fn a_cube_s_kernels_weigh_as_gl_does() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (filter, linear) in [("nearest", false), ("linear", true)] {
        for side in [1, 2, 3, 5, 7] {
            for edge in [14.37, 16.0] {
                let keys = format!("kernel = {side}\nfilter = \"{filter}\"");
                let scene = scene_under("kind = \"point\"", 1.0, edge, 5.0, &keys);
                let texel = |x: f64| f64::from(SIZE) * (0.5 + 0.5 * x / LIGHT);
                let name = format!("a cube, {}", keys.replace('\n', ", "));
                let expected = |[x, _]: [f64; 2]| kernel(texel(x), edge, side, linear);
                check_scene(&scene, &name, edge, 5.0, &mut renderer, &expected);
            }
        }
    }
}

/// The floor lies square to the light's axis: none of its texels lies before another, and the point that is looked up is
/// moved nowhere, however far off the axis it lies. Slanted planes: `tests/it/planes.rs`.
#[test]
fn a_normal_offset_moves_nothing_on_what_is_square_to_the_map() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (name, side) in [("1", 1), ("\"3x3\"", 3)] {
        let keys = format!("kernel = {name}\nbias = \"normal-offset\"");
        let expected = |[x, _]: [f64; 2]| kernel(texel(x, 0.0, SIZE), 13.37, side, true);
        check(&keys.replace('\n', ", "), 13.37, 5.0, &keys, &mut renderer, &expected);
    }
}

/// Eight taps: half of level 0, half of level 1, whose texels are drawn and not averaged, whatever the pixel's size.
#[test]
fn eight_taps_are_two_levels_half_and_half() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for edge in [13.37, 15.2, 18.6] {
        for fov_y in [5.0, 6.0] {
            let expected = |[x, _]: [f64; 2]| {
                let fine = tap(texel(x, 0.0, SIZE), edge, true)?;
                let coarse = tap(texel(x, 0.0, SIZE / 2), 0.5 * edge, true)?;
                Some(0.5 * fine + 0.5 * coarse)
            };
            check("mipmaps = 8-tap", edge, fov_y, "mipmaps = \"8-tap\"", &mut renderer, &expected);
        }
        // Magnified, all of mipmaps is level 0.
        let fine = |[x, _]: [f64; 2]| tap(texel(x, 0.0, SIZE), edge, true);
        check("mipmaps = true, magnified", edge, 5.0, "mipmaps = true", &mut renderer, &fine);
    }
}

/// A pixel that is as wide as `2^level` texels reads that level. GL leaves the level's last bits open [GL 4.6, 8.14.1], so
/// the value must lie between those of both neighbours.
#[test]
fn minified_maps_meet_the_level_of_their_pixels() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (fov_y, edge) = (5.0, 13.37);
    for size in [1024_u32, 4096] {
        let pixel = 2.0 * (0.5 * f64::to_radians(fov_y)).tan() * CAMERA / 16.0;
        let level = (pixel * f64::from(size) / (2.0 * LIGHT * half())).log2();
        let keys = format!("technique = \"shadow-map\", size = {size}, mipmaps = true");
        let scene = techniques::with_keys(&scene(edge, fov_y, ""), 0, &keys).unwrap();
        let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
        let scaled = edge * f64::from(size) / f64::from(SIZE);
        let at = |x: f64, level: u32| {
            let shrink = f64::from(1_u32 << level);
            tap(texel(x, 0.0, size) / shrink, scaled / shrink, true).unwrap()
        };
        assert!(level > 0.5, "{level}");
        let (low, high) = (level.floor(), level.floor() + 1.0);
        for (point, found) in floor_points(fov_y).zip(&shade.shade[7 * WIDTH as usize..8 * WIDTH as usize]) {
            let (fine, coarse) = (at(point.0, low as u32), at(point.0, high as u32));
            let expected = fine + (coarse - fine) * (level - low);
            // 2^-4 of a level: the least that dEQP asks of a driver.
            let within = 1.0 / 255.0 + (coarse - fine).abs() / 16.0;
            assert!((expected - f64::from(*found)).abs() <= within, "{size}: {found} at {}, not {expected}", point.0);
        }
        println!("map {size}: level {level:.3}");
    }
}
