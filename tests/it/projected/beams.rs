//! Beams and laws of distance against GL's own spotlight, closed forms, and at their extremes.

use glow::HasContext;
use glumbra::context::compatibility::{Binding, raw};
use glumbra::context::{self, Context, ContextRequest, Profile};
use glumbra::plan::Request;
use glumbra::scene::Scene;
use image::{Rgb, RgbImage};

use super::{WHITE, draw, image_place, load, renderer, seen_points, try_load, unlit_scene};

const SIDE: i32 = 512;
const HEIGHT: f64 = 3.0;

/// A plane under a light that stands straight above it, seen from where the light is; lit by its cosine, too.
fn plane(keys: &str, cone: f64) -> String {
    format!(
        "[image]\nsize = [{SIDE}, {SIDE}]\nbackground = [0.0, 0.0, 0.0]\n[camera]\neye = [0.0, {HEIGHT:?}, 0.0]\ntarget = [0.0, 0.0, 0.0]\n\
         up = [0.0, 0.0, -1.0]\nfov_y = {cone:?}\nnear = 0.1\nfar = 10.0\n[shading]\nambient = [0.0, 0.0, 0.0]\n\
         [[light]]\nkind = \"spot\"\nposition = [0.0, {HEIGHT:?}, 0.0]\ntarget = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, -1.0]\ncone = {cone:?}\nnear = 0.5\nfar = 9.0\n\
         {keys}\n[light.shadow]\ntechnique = \"none\"\n[[object]]\nmesh = \"quad\"\nscale = [40.0, 1.0, 40.0]\nmaterial = {{ diffuse = [1.0, 1.0, 1.0] }}\n"
    )
}

/// GL_SPOT_EXPONENT and GL_SPOT_CUTOFF on the same plane, lit at the vertices of a fine grid: red codes, from the top.
fn gl_spotlight(context: &dyn Context, exponent: f64, cone: f64) -> Vec<i32> {
    const CELLS: i32 = 256;
    let fixed = Binding::load(context).unwrap();
    let gl = context.gl();
    let half = (0.5 * cone).to_radians().tan();
    let mut pixels = vec![0_u8; (4 * SIDE * SIDE) as usize];
    // SAFETY: the context is current and of the compatibility profile; every pointer is to values that outlive the call.
    unsafe {
        let buffer = gl.create_renderbuffer().unwrap();
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
        gl.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, SIDE, SIDE);
        let framebuffer = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::RENDERBUFFER, Some(buffer));
        gl.viewport(0, 0, SIDE, SIDE);
        gl.clear_color(0.0, 0.0, 0.0, 1.0);
        gl.clear(glow::COLOR_BUFFER_BIT);
        gl.use_program(None);
        gl.disable(glow::DEPTH_TEST);
        gl.disable(glow::CULL_FACE);
        // Eye space: the eye and the light at the origin, the plane at z = -HEIGHT.
        fixed.MatrixMode(raw::PROJECTION);
        fixed.LoadIdentity();
        fixed.Frustum(-0.1 * half, 0.1 * half, -0.1 * half, 0.1 * half, 0.1, 10.0);
        fixed.MatrixMode(raw::MODELVIEW);
        fixed.LoadIdentity();
        gl.enable(raw::LIGHTING);
        gl.enable(raw::LIGHT0);
        fixed.LightModelfv(raw::LIGHT_MODEL_AMBIENT, [0.0_f32, 0.0, 0.0, 1.0].as_ptr());
        for (name, vector) in [
            (raw::POSITION, [0.0_f32, 0.0, 0.0, 1.0]),
            (raw::AMBIENT, [0.0, 0.0, 0.0, 1.0]),
            (raw::DIFFUSE, [1.0; 4]),
            (raw::SPECULAR, [0.0, 0.0, 0.0, 1.0]),
            (raw::SPOT_DIRECTION, [0.0, 0.0, -1.0, 0.0]),
        ] {
            fixed.Lightfv(raw::LIGHT0, name, vector.as_ptr());
        }
        fixed.Lightf(raw::LIGHT0, raw::SPOT_EXPONENT, exponent as f32);
        // The cutoff's edge is not compared: it would be that of the grid's cells.
        fixed.Lightf(raw::LIGHT0, raw::SPOT_CUTOFF, 90.0);
        fixed.Materialfv(glow::FRONT_AND_BACK, raw::AMBIENT_AND_DIFFUSE, [1.0_f32; 4].as_ptr());
        fixed.Begin(glow::TRIANGLES);
        fixed.Normal3f(0.0, 0.0, 1.0);
        let at = |cell: i32| (2.0 * f64::from(cell) / f64::from(CELLS) - 1.0) * half * HEIGHT;
        for (x, y) in (0..CELLS).flat_map(|y| (0..CELLS).map(move |x| (x, y))) {
            for (i, j) in [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)] {
                fixed.Vertex3f(at(x + i) as f32, at(y + j) as f32, -HEIGHT as f32);
            }
        }
        fixed.End();
        gl.read_pixels(
            0,
            0,
            SIDE,
            SIDE,
            glow::RGBA,
            glow::UNSIGNED_BYTE,
            glow::PixelPackData::Slice(Some(&mut pixels)),
        );
        gl.delete_framebuffer(framebuffer);
        gl.delete_renderbuffer(buffer);
    }
    let row = |y: i32| (0..SIDE).map(move |x| (4 * ((SIDE - 1 - y) * SIDE + x)) as usize);
    (0..SIDE).flat_map(row).map(|place| i32::from(pixels[place])).collect()
}

/// Two codes: each picture rounds to one, and the map's texels to half of one.
#[test]
fn a_power_of_the_cosine_by_a_map_is_gls_own_spotlight() {
    for (exponent, cone) in [(1.0, 90.0), (8.0, 60.0), (30.0, 50.0), (128.0, 40.0)] {
        // One context at a time is current.
        let theirs = {
            let request = ContextRequest { profile: Profile::Compatibility, ..ContextRequest::default() };
            let context = context::open(&request).unwrap();
            gl_spotlight(&*context, exponent, cone)
        };
        let (_context, mut renderer) = renderer();
        let scene = load(&plane(&format!("beam = {{ exponent = {exponent:?} }}"), cone), &[]).scene;
        let ours = draw(&scene, &mut renderer);
        let tangent = (0.5 * cone).to_radians().tan();
        let (mut compared, mut worst, mut worst_exact) = (0, 0, 0.0_f64);
        for (index, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            let [x, y] = [index as i32 % SIDE, index as i32 / SIDE]
                .map(|at| (f64::from(at) + 0.5) / f64::from(SIDE) * 2.0 - 1.0);
            if x.hypot(y) > 0.995 {
                continue;
            }
            compared += 1;
            worst = worst.max((ours[0] - theirs).abs());
            let cosine = 1.0 / (1.0 + (tangent * x.hypot(y)).powi(2)).sqrt();
            worst_exact = worst_exact.max((f64::from(ours[0]) - 255.0 * cosine.powf(exponent + 1.0)).abs());
        }
        assert!(compared > 200_000, "{compared}");
        assert!(worst <= 2, "cos^{exponent}, cone {cone}: {worst} codes from GL's");
        assert!(worst_exact <= 2.0, "cos^{exponent}, cone {cone}: {worst_exact} codes from the formula");
    }
}

/// Red codes along the middle row, right of the middle, by their place from 0 to 1.
fn middle_row(picture: &[[i32; 3]]) -> Vec<(f64, i32)> {
    let (side, half) = (SIDE as usize, SIDE as usize / 2);
    (half..side).map(|x| ((x as f64 + 0.5) / half as f64 - 1.0, picture[half * side + x][0])).collect()
}

fn unlit(text: &str) -> String {
    text.replace("material =", "lit = false\nmaterial =")
}

#[test]
fn profiles_end_at_the_cones_border_with_their_last_value() {
    let (_context, mut renderer) = renderer();
    let text = unlit(&plane("beam = { profile = [0.2, 1.0, 0.6] }", 70.0));
    for (at, code) in middle_row(&draw(&load(&text, &[]).scene, &mut renderer)) {
        let value = if at < 0.5 { 0.2 + 1.6 * at } else { 1.0 - 0.8 * (at - 0.5) };
        assert!((f64::from(code) - 255.0 * value).abs() <= 2.0, "{at}: {code}, not {}", 255.0 * value);
    }
    // A row that is a pixel's half off the middle still ends inside the circle; a picture wider than the cone is dark beyond.
    let wide = text.replacen("fov_y = 70.0", "fov_y = 90.0", 1);
    let end = 35.0_f64.to_radians().tan();
    for (at, code) in middle_row(&draw(&load(&wide, &[]).scene, &mut renderer)) {
        let is_right = if at < end { code >= 50 } else { code == 0 };
        assert!(is_right || (at - end).abs() < 0.003, "{at}: {code}");
    }
}

#[test]
fn shields_of_one_texel_and_of_one_column_modulate_the_beam() {
    let (_context, mut renderer) = renderer();
    let grey = RgbImage::from_pixel(1, 1, Rgb([128, 64, 255]));
    let text = unlit(&plane("shape = \"frustum\"\nbeam = { shield = \"shield.png\" }", 50.0));
    let picture = draw(&load(&text, &[("shield.png", &grey)]).scene, &mut renderer);
    assert!(picture.iter().all(|codes| *codes == [128, 64, 255]));
    // One texel wide and seven high: the same in every column, texel centres at (k + 1/2) / 7 from the top.
    let column = RgbImage::from_fn(1, 7, |_, y| Rgb([36 * y as u8, 0, 0]));
    let picture = draw(&load(&text, &[("shield.png", &column)]).scene, &mut renderer);
    for (index, codes) in picture.iter().enumerate() {
        let at = ((index / SIDE as usize) as f64 + 0.5) / f64::from(SIDE) * 7.0 - 0.5;
        let expected = 36.0 * at.clamp(0.0, 6.0);
        assert!((f64::from(codes[0]) - expected).abs() <= 1.5, "{index}: {codes:?}, not {expected}");
    }
}

/// A lens moves what the image shows: r (1 + k r²) of the image at r.
#[test]
fn a_lens_bends_the_image() {
    let (_context, mut renderer) = renderer();
    let ring = RgbImage::from_fn(256, 256, |x, y| {
        let at = |x: u32| (f64::from(x) + 0.5) / 128.0 - 1.0;
        Rgb([(200.0 * at(x).hypot(at(y)).min(1.0)) as u8; 3])
    });
    for k in [-0.2, 0.25] {
        let keys = format!("shape = \"frustum\"\nimage = \"slide.png\"\nbeam = {{ lens = {k:?} }}");
        let scene = load(&unlit(&plane(&keys, 50.0)), &[("slide.png", &ring)]).scene;
        for (at, code) in middle_row(&draw(&scene, &mut renderer)) {
            let source = at * (1.0 + k * at * at);
            let expected = if source > 1.0 { 0.0 } else { 200.0 * source };
            let near_end = (source - 1.0).abs() < 0.02;
            assert!(near_end || (f64::from(code) - expected).abs() <= 2.5, "k = {k}, {at}: {code}, not {expected}");
        }
    }
}

#[test]
fn beams_too_steep_for_a_map_are_warned_of_with_the_error() {
    let (_context, mut renderer) = renderer();
    let warnings = |keys: &str, cone: f64, renderer: &mut glumbra::frame::Renderer| {
        let scene = load(&plane(keys, cone), &[]).scene;
        let error = scene.lights[0].spot().unwrap().beam.as_ref().unwrap().map_error_codes;
        (error, renderer.plan(&scene, &Request::default()).unwrap().warnings)
    };
    let (error, fine) = warnings("beam = { exponent = 8 }", 60.0, &mut renderer);
    assert!(error < 0.5 && fine.is_empty(), "{error} {fine:?}");
    let (error, steep) = warnings("beam = { exponent = 64 }", 178.0, &mut renderer);
    assert!(error > 0.5 && steep.len() == 1, "{error} {steep:?}");
    assert!(steep[0].contains(&format!("off by up to {error:.1} codes")) && steep[0].contains("cone 178"), "{steep:?}");
}

/// A floor under a light that looks askance at it, all in its frustum.
fn lit_floor(keys: &str) -> Scene {
    let light =
        format!("position = [0.0, 2.0, 4.0]\ntarget = [0.0, 0.0, 0.5]\ncone = 80.0\nshape = \"frustum\"\n{keys}");
    let floor = format!("[[object]]\nmesh = \"quad\"\nscale = [8.0, 1.0, 8.0]\n{WHITE}");
    load(&unlit_scene("eye = [0.0, 6.0, 6.0]\ntarget = [0.0, 0.0, 0.0]\nnear = 0.1\nfar = 60.0", &light, &floor), &[])
        .scene
}

/// Compares a picture of the floor with a factor by planar and radial distance.
fn assert_floor(scene: &Scene, renderer: &mut glumbra::frame::Renderer, factor: impl Fn(f64, f64) -> f64) {
    let spot = scene.lights[0].spot().unwrap().clone();
    let mut compared = 0;
    for (point, codes) in seen_points(scene).into_iter().zip(draw(scene, renderer)) {
        let Some(point) = point else { continue };
        let (st, depth) = image_place(&spot, point);
        if depth < 0.01 || st.min(1.0 - st).min_element() < 0.01 {
            continue;
        }
        compared += 1;
        let expected = 255.0 * factor(depth, point.distance(spot.frustum.position)).min(1.0);
        assert!((f64::from(codes[0]) - expected).abs() <= 2.0, "at {point}, d = {depth}: {codes:?}, not {expected}");
    }
    assert!(compared > 2000, "{compared}");
}

/// Surfaces of equal light are planes for `falloff`, spheres for `attenuation`: apart by the square of the angle's cosine.
#[test]
fn falloff_is_planar_and_attenuation_radial() {
    let (_context, mut renderer) = renderer();
    let planar = lit_floor("near = 0.5\nfar = 20.0\nfalloff = { law = \"inverse-square\", d0 = 2.5 }");
    assert_floor(&planar, &mut renderer, |depth, _| (2.5 / depth).powi(2));
    let radial = lit_floor("near = 0.5\nfar = 20.0\nattenuation = [0.0, 0.0, 0.16]");
    assert_floor(&radial, &mut renderer, |_, distance| (2.5 / distance).powi(2));
    let table =
        lit_floor("near = 0.5\nfar = 20.0\nfalloff = { by = \"z\", table = [[1.0, 0.9], [3.0, 0.4], [6.0, 0.1]] }");
    assert_floor(&table, &mut renderer, |depth, _| {
        let depth = depth.clamp(1.0, 6.0);
        if depth < 3.0 { 0.9 - 0.25 * (depth - 1.0) } else { 0.4 - 0.1 * (depth - 3.0) }
    });
}

#[test]
fn falloff_holds_at_ratios_of_near_to_far_down_to_a_millionth() {
    let (_context, mut renderer) = renderer();
    for near in ["1.0", "0.03", "0.019", "2e-3", "2e-5"] {
        let planes = format!("near = {near}\nfar = 20.0\n");
        for (keys, law) in [
            ("falloff = { law = \"inverse-square\", d0 = 2.5 }", (|d| (2.5 / d) * (2.5 / d)) as fn(f64) -> f64),
            ("falloff = { law = \"inverse\", d0 = 2.0 }", |d| 2.0 / d),
            ("falloff = { by = \"z\", table = [[2.0, 1.0], [5.0, 0.0]] }", |d| ((5.0 - d) / 3.0).clamp(0.0, 1.0)),
        ] {
            let scene = lit_floor(&format!("{planes}{keys}"));
            let warnings = renderer.plan(&scene, &Request::default()).unwrap().warnings;
            assert!(warnings.is_empty(), "{near} {keys}: {warnings:?}");
            assert_floor(&scene, &mut renderer, |depth, _| law(depth));
        }
    }
    // All of it happens within the first of even steps.
    let hard = lit_floor("near = 2e-5\nfar = 20.0\nfalloff = { law = \"inverse-square\", d0 = 1e-3 }");
    assert!(hard.lights[0].spot().unwrap().falloff.as_ref().unwrap().table.error_codes < 0.5);
    assert!(renderer.plan(&hard, &Request::default()).unwrap().warnings.is_empty());
    // Before the near plane and beyond the far plane the law stands still.
    let short = lit_floor("near = 3.0\nfar = 4.0\nfalloff = { law = \"inverse\", d0 = 2.0 }");
    assert_floor(&short, &mut renderer, |depth, _| 2.0 / depth.clamp(3.0, 4.0));
}

/// Steps, bends and a far end that are steeper than any even steps: exact between the law's own entries, without a warning.
#[test]
fn falloff_holds_where_it_bends_sharply() {
    let (_context, mut renderer) = renderer();
    for near in [0.5, 2e-5] {
        for fall in [1e-2, 1e-4, 1e-9] {
            let table = [[3.0, 1.0], [3.0 + fall, 0.3], [4.0, 0.3], [4.0 + 5.0 * fall, 0.9], [6.0, 0.2]];
            let scene =
                lit_floor(&format!("near = {near:?}\nfar = 20.0\nfalloff = {{ by = \"z\", table = {table:?} }}"));
            let plan = renderer.plan(&scene, &Request::default()).unwrap();
            assert!(plan.warnings.is_empty(), "{near} {fall}: {:?}", plan.warnings);
            assert!(plan.chosen.iter().any(|chosen| chosen.choice.contains("its own 5 entries")), "{:?}", plan.chosen);
            assert_floor(&scene, &mut renderer, |depth, _| {
                let between = |from: usize| {
                    let [[a, low], [b, high]] = [table[from], table[from + 1]];
                    low + (high - low) * ((depth - a) / (b - a)).clamp(0.0, 1.0)
                };
                between(table.iter().rposition(|[at, _]| *at <= depth).unwrap_or(0).min(3))
            });
        }
    }
}

#[test]
fn wrong_beams_and_laws_are_refused_with_their_place() {
    let spot = "position = [0.0, 3.0, 0.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 40.0\n";
    let floor = format!("[[object]]\nmesh = \"quad\"\n{WHITE}");
    for (keys, expected) in [
        ("beam = { profile = [1.0] }", "`light.beam.profile` must be 2 to 4096 numbers in [0, 1]"),
        ("beam = { profile = [1.0, 1.5] }", "`light.beam.profile` must be 2 to 4096 numbers in [0, 1]"),
        ("beam = { profile = [1, 0], exponent = 2 }", "`light.beam.exponent` cannot stand beside `profile`"),
        ("beam = { exponent = -1 }", "`light.beam.exponent` must be in [0, 1000], not -1"),
        ("beam = { lens = 2.0 }", "`light.beam.lens` must be in [-1, 1], not 2"),
        ("beam = { shield = \"missing.png\" }", "missing.png"),
        ("beam = { shade = 1 }", "unknown key `shade` in [light.beam]"),
        ("falloff = \"cubic\"", "`light.falloff` cannot be \"cubic\""),
        ("falloff = 3", "`light.falloff` must be \"inverse\""),
        ("falloff = { by = \"r\", law = \"inverse\" }", "`light.falloff.by` cannot be \"r\""),
        ("falloff = { by = \"z\" }", "`light.falloff.table` is missing"),
        (
            "falloff = { table = [[2.0, 1.0], [1.0, 0.5]] }",
            "`light.falloff.table` must have each distance above the one before",
        ),
        ("falloff = { table = [[2.0, 1.5]] }", "`light.falloff.table` must have factors in [0, 1]"),
        ("falloff = { table = [[1.0, 1.0]], d0 = 2.0 }", "`light.falloff.d0` is of a `law`"),
        ("interpolate = \"linear\"", "`light.interpolate` cannot be \"linear\""),
    ] {
        let text = unlit_scene("eye = [3.0, 3.0, 3.0]\ntarget = [0.0, 0.0, 0.0]", &format!("{spot}{keys}"), &floor);
        let error = try_load(&text, &[]).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("scene.toml:"), "{keys}: {error}");
    }
    for (kind, keys) in [
        ("point", "beam = { exponent = 2 }"),
        ("point", "falloff = \"inverse\""),
        ("directional", "interpolate = \"affine\""),
    ] {
        let place = if kind == "point" { "position = [0.0, 3.0, 0.0]" } else { "direction = [0.0, -1.0, 0.0]" };
        let text = unlit_scene("eye = [3.0, 3.0, 3.0]\ntarget = [0.0, 0.0, 0.0]", &format!("{place}\n{keys}"), &floor);
        let error =
            try_load(&text.replace("\"spot\"", &format!("\"{kind}\"")), &[]).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(&format!("is no key of a {kind} light")), "{kind} {keys}: {error}");
    }
}
