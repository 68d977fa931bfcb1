//! A light's image: which way up, how filtered, and dark beyond its border.

use glam::DVec3;
use glumbra::views::View;
use image::{Rgb, RgbImage};

use super::{WHITE, draw, draw_view, image_place, load, renderer, seen_points, texel, try_load, unlit_scene};
use crate::support::random::Random;

/// The letter F in six colours on blue, 5 × 7: no turn and no mirror maps it to itself.
fn letter() -> RgbImage {
    const ROWS: [&[u8; 5]; 7] = [b"rrgg.", b"r....", b"w....", b"ycc..", b"y....", b"m....", b"m...k"];
    RgbImage::from_fn(5, 7, |x, y| {
        Rgb(match ROWS[y as usize][x as usize] {
            b'r' => [255, 0, 0],
            b'g' => [0, 255, 0],
            b'w' => [255, 255, 255],
            b'y' => [255, 255, 0],
            b'c' => [0, 255, 255],
            b'm' => [255, 0, 255],
            b'k' => [0, 0, 0],
            _ => [0, 0, 96],
        })
    })
}

fn vector(random: &mut Random, size: f64) -> [f64; 3] {
    (size * random.vector()).to_array()
}

fn spot(random: &mut Random, filter: &str, aspect: f64) -> String {
    let (position, target) = (DVec3::new(0.0, 3.0, 0.0) + 2.0 * random.vector(), 0.4 * random.vector());
    format!(
        "position = {:?}\ntarget = {:?}\nup = {:?}\ncone = {:?}\naspect = {aspect:?}\nshape = \"frustum\"\nnear = 0.1\nfar = 40.0\n\
         image = \"slide.png\"\nfilter = \"{filter}\"",
        position.to_array(),
        target.to_array(),
        vector(random, 1.0),
        random.within(15.0, 100.0)
    )
}

/// A camera at any height over the floor, down to grazing, on either side of it.
fn camera(random: &mut Random) -> String {
    let (turn, height) = (random.within(0.0, std::f64::consts::TAU), random.pick(&[0.05, 0.4, 2.0, 6.0, -0.3, -3.0]));
    let eye = [5.0 * turn.cos(), height, 5.0 * turn.sin()];
    format!("eye = {eye:?}\ntarget = {:?}\nfov_y = 50.0\nnear = 0.05\nfar = 60.0", vector(random, 0.3))
}

/// A floor, a box and a mirrored sphere, askew.
fn objects(random: &mut Random) -> String {
    format!(
        "[[object]]\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\n{WHITE}\
         [[object]]\nmesh = \"box\"\nscale = [-0.5, 0.4, 0.6]\ntranslate = {:?}\nrotate = {{ axis = [1.0, 2.0, 0.5], angle = 40.0 }}\n{WHITE}\
         [[object]]\nmesh = \"sphere\"\nscale = [0.5, -0.5, 0.5]\ntranslate = {:?}\n{WHITE}",
        (DVec3::Y + 0.8 * random.vector()).to_array(),
        (DVec3::Y + 0.8 * random.vector()).to_array()
    )
}

/// Distance of (s, t) from the image's border, in image widths, positive inside.
fn inside(st: glam::DVec2) -> f64 {
    st.min(1.0 - st).min_element()
}

#[test]
fn beyond_its_border_an_image_is_dark_to_the_last_texel_from_any_side_and_at_any_level() {
    let (_context, mut renderer) = renderer();
    let white = RgbImage::from_pixel(13, 7, Rgb([255; 3]));
    let mut random = Random::new(1);
    let (mut lit, mut dark) = (0, 0);
    for round in 0..45 {
        let filter = ["nearest", "linear", "trilinear"][round % 3];
        let aspect = random.pick(&[1.0, 1.5, 0.3, 4.0]);
        let light = spot(&mut random, filter, aspect);
        let text = unlit_scene(&camera(&mut random), &light, &objects(&mut random));
        let scene = load(&text, &[("slide.png", &white)]).scene;
        let source = scene.lights[0].spot().unwrap().clone();
        for (point, found) in seen_points(&scene).into_iter().zip(draw(&scene, &mut renderer)) {
            let Some(point) = point else { continue };
            let (st, depth) = image_place(&source, point);
            // The rounding of a point by a few units of f32, and of a sample by 1/256 pixel: at grazing views a pixel is
            // up to a tenth of the image wide.
            let doubt = 1e-3 + 1e-4 / depth.abs();
            let expected = if depth > 0.0 && inside(st) > doubt {
                lit += 1;
                255
            } else if depth < -1e-3 || inside(st) < -doubt {
                dark += 1;
                0
            } else {
                continue;
            };
            assert_eq!(found, [expected; 3], "round {round}: st {st}, depth {depth}\n{text}");
        }
    }
    assert!(lit > 40_000 && dark > 60_000, "{lit} {dark}");
}

#[test]
fn an_image_is_the_right_way_up_on_every_surface_and_from_every_side() {
    let (_context, mut renderer) = renderer();
    let letter = letter();
    let mut random = Random::new(2);
    let mut compared = 0;
    for round in 0..16 {
        let aspect = random.pick(&[5.0 / 7.0, 1.0, 2.0]);
        let light = spot(&mut random, "nearest", aspect);
        let text = unlit_scene(&camera(&mut random), &light, &objects(&mut random));
        let scene = load(&text, &[("slide.png", &letter)]).scene;
        let source = scene.lights[0].spot().unwrap().clone();
        for (point, found) in seen_points(&scene).into_iter().zip(draw(&scene, &mut renderer)) {
            let Some((st, depth)) = point.map(|point| image_place(&source, point)) else { continue };
            let at = st * glam::DVec2::new(5.0, 7.0);
            if depth <= 0.0 || inside(st) < 1e-3 || (at - at.round()).abs().min_element() < 1e-2 {
                continue;
            }
            compared += 1;
            let expected = texel(&letter, at.x.floor() as i64, at.y.floor() as i64).map(|code| code as i32);
            assert_eq!(found, expected, "round {round}: st {st}\n{text}");
        }
    }
    assert!(compared > 10_000, "{compared}");
}

/// A light before a wall that is larger than its frustum.
fn wall(keys: &str) -> String {
    let light = format!(
        "position = [0.3, 0.2, 4.0]\ntarget = [0.3, 0.2, 0.0]\nup = [0.0, 1.0, 0.0]\ncone = 40.0\nnear = 0.5\nfar = 9.0\nshape = \"frustum\"\n\
         image = \"slide.png\"\n{keys}"
    );
    let wall = format!(
        "[[object]]\nmesh = \"quad\"\nscale = [8.0, 1.0, 8.0]\nrotate = {{ axis = [1.0, 0.0, 0.0], angle = 90.0 }}\n{WHITE}"
    );
    unlit_scene("eye = [0.0, 0.0, 6.0]\ntarget = [0.0, 0.0, 0.0]", &light, &wall)
}

/// The light's own view is the image itself, upright and unmirrored: its square shows all of the frustum.
#[test]
fn the_lights_own_view_is_its_image() {
    let (_context, mut renderer) = renderer();
    let letter = letter();
    for aspect in ["0.7", "1.0", "3.0"] {
        let scene = load(&wall(&format!("filter = \"nearest\"\naspect = {aspect}")), &[("slide.png", &letter)]).scene;
        let view = draw_view(&scene, View::LightView, &mut renderer);
        let side = 90;
        assert_eq!(view.len(), side * side);
        for (index, found) in view.iter().enumerate() {
            let (x, y) = (index % side, index / side);
            let pixel = letter.get_pixel((5 * x / side) as u32, (7 * y / side) as u32).0.map(i32::from);
            let on_border = (5 * (x + 1) / side != 5 * x / side) || (7 * (y + 1) / side != 7 * y / side);
            assert!(on_border || *found == pixel, "{aspect}: {x} {y}: {found:?}, not {pixel:?}");
        }
    }
}

/// Where a pixel shows exactly two by two texels, level 1 is theirs alone, and its texel their mean.
#[test]
fn trilinear_images_are_averages_of_what_a_pixel_shows() {
    let (_context, mut renderer) = renderer();
    let mut random = Random::new(3);
    let noise = RgbImage::from_fn(180, 180, |_, _| Rgb([(); 3].map(|()| random.below(256) as u8)));
    let scene = |filter: &str| load(&wall(&format!("filter = \"{filter}\"")), &[("slide.png", &noise)]).scene;
    let view = draw_view(&scene("trilinear"), View::LightView, &mut renderer);
    let off = |view: &[[i32; 3]]| {
        let differences = view.iter().enumerate().map(|(index, found)| {
            let (x, y) = ((index % 90) as u32, (index / 90) as u32);
            let texels = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| noise.get_pixel(2 * x + i, 2 * y + j).0);
            let mean = |k: usize| texels.iter().map(|texel| f64::from(texel[k])).sum::<f64>() / 4.0;
            (0..3).map(|k| (f64::from(found[k]) - mean(k)).abs()).fold(0.0, f64::max)
        });
        differences.fold(0.0, f64::max)
    };
    // Weights of 8 bits between texels and between levels, of texels as different as can be.
    assert!(off(&view) < 4.0, "{}", off(&view));
    // Samples between texels without mipmaps: the same four, by chance of this placement alone; so from twice as far.
    let nearest = draw_view(&scene("nearest"), View::LightView, &mut renderer);
    assert!(off(&nearest) > 50.0);
}

#[test]
fn keys_of_images_and_frusta_are_checked() {
    let white = RgbImage::from_pixel(1, 1, Rgb([255; 3]));
    let spot = "position = [0.0, 3.0, 0.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 40.0\n";
    let floor = format!("[[object]]\nmesh = \"quad\"\n{WHITE}");
    let error = |keys: &str| {
        let text = unlit_scene("eye = [3.0, 3.0, 3.0]\ntarget = [0.0, 0.0, 0.0]", &format!("{spot}{keys}"), &floor);
        try_load(&text, &[("slide.png", &white)]).map(|_| ()).unwrap_err().to_string()
    };
    for (keys, expected) in [
        ("aspect = 1.5", "`light.aspect` is of a light with shape = \"frustum\": a cone is round"),
        ("aspect = 0.0", "`light.aspect` must be in [0.001, 1000], not 0"),
        ("shape = \"frustum\"\naspect = 1e4", "`light.aspect` must be in [0.001, 1000], not 10000"),
        ("filter = \"linear\"", "`light.filter` is of the light's `image`, which is missing"),
        ("image = \"slide.png\"\nfilter = \"cubic\"", "`light.filter` cannot be \"cubic\""),
    ] {
        let found = error(keys);
        assert!(found.contains(expected) && found.contains("scene.toml:"), "{keys}: {found}");
    }
}

/// Shadows under frusta that are not square, by every technique, against the ray tracer.
#[test]
fn shadows_fall_alike_in_frusta_of_any_aspect() {
    use glumbra::judge::metrics::{Band, compare};
    use glumbra::{frame::draw_shade, techniques, truth};

    const TECHNIQUES: [&str; 8] = [
        "technique = \"shadow-map\"",
        "technique = \"shadow-map\", fit = \"view\"",
        "technique = \"shadow-map\", fit = \"casters\", bias = \"receiver-plane\"",
        "technique = \"shadow-map\", bias = \"normal-offset\", kernel = 3",
        "technique = \"shadow-map\", bias = \"adaptive\", guard = \"clip-plane\"",
        "technique = \"shadow-map\", guard = \"stencil\", casters = \"texel\"",
        "technique = \"midpoint\"",
        "technique = \"shadow-volume\"",
    ];
    let (_context, mut renderer) = renderer();
    let mut random = Random::new(4);
    let mut compared = 0;
    for round in 0..16 {
        let aspect = random.pick(&[0.25, 0.6, 1.7, 4.0]);
        let light = spot(&mut random, "linear", aspect).replace("near = 0.1", "near = 0.5");
        let objects = objects(&mut random);
        let text = unlit_scene(&camera(&mut random), &light, &objects);
        let scene = load(&text, &[("slide.png", &letter())]).scene;
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let truth = truth::trace(&scene, 0, &options).unwrap();
        let keys = TECHNIQUES[round % TECHNIQUES.len()];
        let shadowed = techniques::with_keys(&scene, 0, keys).unwrap();
        let shade = draw_shade(&shadowed, 0, &mut renderer).unwrap();
        // A texel is up to four times as wide as high.
        let band = Band { texels: 3.0, map_size: [1024; 2] };
        let found = compare(&truth, &shade, &band).unwrap();
        let wrong = found.facing.false_shadow.outside + found.facing.leak.outside;
        compared += found.facing.compared;
        // As in `generated`: two pixels, or 0.3 %.
        let most = (0.003 * found.facing.compared as f64).max(2.0);
        assert!(wrong as f64 <= most, "{keys}: {wrong} wrong of {}\n{text}", found.facing.compared);
    }
    assert!(compared > 4_000, "{compared}");
}
