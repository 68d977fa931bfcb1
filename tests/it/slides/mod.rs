//! Slide projectors against an oracle of their own: hits of the ray tracer, a projection from position, target and angle, a
//! bilinear lookup in f64.

mod left_out;

use std::path::Path;

use glam::{DVec3, dvec3};
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::geometry::Texture;
use glumbra::plan::{Plan, Request};
use glumbra::scene::{FalloffLaw, Light, Scene};
use glumbra::truth::{self, Answer, Hit, Truth};
use image::{Rgba, RgbaImage};

use crate::support::random::Random;

const CODE: f64 = 1.0 / 255.0;

fn renderer() -> Renderer {
    Renderer::new(&context::open(&ContextRequest::default()).unwrap())
}

fn load(text: &str, folder: &Path) -> Scene {
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).unwrap();
    glumbra::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{text}")).scene
}

/// The picture in RGBA, and its plan.
fn draw(scene: &Scene, request: &Request, renderer: &mut Renderer) -> (Vec<f64>, Plan) {
    let plan = renderer.plan(scene, request).unwrap();
    renderer.draw(&plan).unwrap();
    let data = match renderer.read(&plan).unwrap().picture {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f64::from(*code) * CODE).collect(),
        Pixels::RgbaF32 { data, .. } => data.iter().map(|value| f64::from(*value)).collect(),
        other => panic!("{:?}", other.size()),
    };
    (data, plan)
}

fn labels(plan: &Plan) -> Vec<&str> {
    plan.list.passes.iter().map(|pass| pass.label.as_str()).collect()
}

fn is_left_out(plan: &Plan, what: &str, why: &str) -> bool {
    plan.left_out.iter().any(|left| left.what.contains(what) && left.why.contains(why))
}

/// Greatest difference in RGB, in codes.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pixels = a.chunks_exact(4).zip(b.chunks_exact(4));
    pixels.flat_map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).abs() / CODE)).fold(0.0, f64::max)
}

/// Place of a point in a projector's image, (s, t) from its lower left corner, and q; from the light's place and angle alone.
fn place(light: &Light, point: DVec3) -> (f64, f64, f64) {
    let frustum = light.frustum().unwrap();
    let forward = (frustum.target - frustum.position).normalize();
    let right = forward.cross(frustum.up).normalize();
    let up = right.cross(forward);
    let way = point - frustum.position;
    let q = way.dot(forward);
    // `cone` is the upright angle.
    let high = q * (0.5 * frustum.cone_radians).tan();
    (0.5 + 0.5 * way.dot(right) / (high * frustum.aspect), 0.5 + 0.5 * way.dot(up) / high, q)
}

/// Least and greatest factor of a law of planar distance at a distance that may be off by a share of 1e-5.
fn falloff(light: &Light, q: f64) -> [f64; 2] {
    let Some(falloff) = &light.spot().unwrap().falloff else { return [1.0; 2] };
    let frustum = light.frustum().unwrap();
    let at = |q: f64| {
        let q = q.clamp(frustum.near, frustum.far);
        match &falloff.law {
            FalloffLaw::Inverse(full) => f64::min(1.0, full / q),
            FalloffLaw::InverseSquare(full) => f64::min(1.0, (full / q).powi(2)),
            FalloffLaw::Table(pairs) => {
                let next = pairs.iter().position(|[distance, _]| *distance > q);
                match next {
                    Some(0) => pairs[0][1],
                    None => pairs[pairs.len() - 1][1],
                    Some(next) => {
                        let [[from, a], [to, b]] = [pairs[next - 1], pairs[next]];
                        a + (b - a) * (q - from) / (to - from)
                    }
                }
            }
        }
    };
    let [near, far] = [at(0.99999 * q), at(1.00001 * q)];
    [near.min(far), near.max(far)]
}

/// How far s and t may be off: a sample lies where it likes within 1/256 of a pixel, some 3e-4 in these rooms, and positions are
/// rounded.
fn place_error(light: &Light, q: f64) -> [f64; 2] {
    let frustum = light.frustum().unwrap();
    let high = 2.0 * q.abs() * (0.5 * frustum.cone_radians).tan();
    [high * frustum.aspect, high].map(|side| 1e-5 + 3e-4 / side)
}

/// Least, most and bilinear value of a channel around (s, t): of all texels within 0.75 of a texel, and the error of the
/// place, of those that GL may mix.
fn lookup(image: &Texture, channel: usize, [s, t]: [f64; 2], error: [f64; 2]) -> [f64; 3] {
    let size = [f64::from(image.width), f64::from(image.height)];
    let at = [s * size[0] - 0.5, t * size[1] - 0.5];
    let texel = |x: f64, y: f64| {
        let [x, y] = [x.clamp(0.0, size[0] - 1.0) as usize, y.clamp(0.0, size[1] - 1.0) as usize];
        f64::from(image.rgba[4 * (y * image.width as usize + x) + channel]) * CODE
    };
    let [u, v] = at.map(|at| at - at.floor());
    let row = |dy: f64| {
        let y = at[1].floor() + dy;
        texel(at[0].floor(), y) * (1.0 - u) + texel(at[0].floor() + 1.0, y) * u
    };
    let value = row(0.0) * (1.0 - v) + row(1.0) * v;
    let range = |k: usize| {
        let reach = 0.75 + error[k] * size[k];
        ((at[k] - reach).floor() as i64..=(at[k] + reach).floor() as i64 + 1).map(|x| x as f64)
    };
    let around = range(1).flat_map(|y| range(0).map(move |x| (x, y))).map(|(x, y)| texel(x, y));
    let (least, most) = around.fold((value, value), |(low, high), texel| (low.min(texel), high.max(texel)));
    // Smooth: 8 codes a texel, over three of them.
    if most - least < 24.0 * CODE { [value, value, value] } else { [least, most, value] }
}

/// Least and most that a pixel may have in each channel; `None` where rounding decides whether a projector reaches it.
fn expected(scene: &Scene, hit: &Hit, clamps: bool) -> Option<[[f64; 2]; 3]> {
    let object = &scene.objects[hit.object as usize];
    let own = object.material.as_ref().map_or([0.8; 3], |material| material.diffuse);
    let mut bounds = scene.shading.ambient.map(|ambient| [f64::from(ambient); 2]);
    for light in &scene.lights {
        let (s, t, q) = place(light, hit.position);
        let error = place_error(light, q);
        let is_near = |place: f64, error: f64| place.abs().min((1.0 - place).abs()) < error;
        if is_near(s, error[0]) || is_near(t, error[1]) || q.abs() < 1e-4 {
            return None;
        }
        if q < 0.0 || !(0.0..=1.0).contains(&s) || !(0.0..=1.0).contains(&t) {
            continue;
        }
        for (channel, [least, most]) in bounds.iter_mut().enumerate() {
            let image = light.spot().unwrap().image.as_ref();
            let [low, high, _] = image.map_or([1.0; 3], |image| lookup(image, channel, [s, t], error));
            let [fallen, unfallen] = falloff(light, q);
            *least += low * fallen * f64::from(light.diffuse[channel]);
            *most += high * unfallen * f64::from(light.diffuse[channel]);
        }
    }
    let mut channel = 0;
    Some(bounds.map(|bounds| {
        channel += 1;
        bounds.map(|sum| f64::from(own[channel - 1]) * if clamps { sum.min(1.0) } else { sum })
    }))
}

/// Hits of pixels all of whose neighbours show the same object.
fn inner_hits(truth: &Truth) -> Vec<(usize, Hit)> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let object = |x: usize, y: usize| truth.pixels[y * width + x].hit.map(|hit| hit.object);
    let certain = |index: usize| {
        !matches!(
            truth.pixels[index].answer,
            Answer::Ambiguous(truth::Reason::Silhouette | truth::Reason::DepthTie | truth::Reason::GrazingView)
        )
    };
    let mut found = Vec::new();
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let hit = truth.pixels[y * width + x].hit;
            let same = (0..9).all(|k| object(x + k % 3 - 1, y + k / 3 - 1) == hit.map(|hit| hit.object));
            found.extend(hit.filter(|_| same && certain(y * width + x)).map(|hit| (y * width + x, hit)));
        }
    }
    found
}

/// Holds a scene's picture, in floats and in 8 bits, against the oracle. Returns how many pixels a projector lights.
fn judge(scene: &Scene, name: &str, renderer: &mut Renderer) -> usize {
    let truth = truth::trace(scene, 0, &truth::Options { most_ambiguous: 1.0, ..truth::Options::default() }).unwrap();
    let hits = inner_hits(&truth);
    let mut lit = 0;
    for float_picture in [true, false] {
        let (picture, _) = draw(scene, &Request { float_picture, ..Request::default() }, renderer);
        // Weights of a filter have 8 bits: two codes. In 8 bits ambient light, colour, product and each image are rounded.
        let rounded = if float_picture { 0.0 } else { 1.5 + 0.5 * scene.lights.len() as f64 };
        let within = (2.0 + rounded) * CODE;
        let (mut compared, mut wrong) = (0, 0);
        let mut worst = String::new();
        for (index, hit) in &hits {
            let Some(bounds) = expected(scene, hit, !float_picture) else { continue };
            let ambient = scene.shading.ambient;
            lit += usize::from(
                float_picture && bounds.iter().zip(ambient).any(|(bounds, ambient)| bounds[0] > f64::from(ambient)),
            );
            compared += 1;
            for (channel, [least, most]) in bounds.iter().enumerate() {
                let found = picture[4 * index + channel];
                if found < least - within || found > most + within {
                    wrong += 1;
                    worst = format!("pixel {index}, channel {channel}: {found}, not in [{least}, {most}]");
                }
            }
        }
        assert!(compared > 100 && wrong == 0, "{name}, float {float_picture}: {wrong} of {compared}: {worst}");
    }
    lit
}

const ROOM: &str = "[image]\nsize = [96, 72]\nbackground = [0.1, 0.1, 0.1]\n[camera]\neye = [3.2, 2.6, 4.6]\ntarget = [-0.3, 0.7, -0.6]\nfov_y = 46.0\nnear = 0.2\nfar = 40.0\n\
     [[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\nmaterial = { diffuse = [0.8, 0.7, 0.5] }\n\
     [[object]]\nmesh = \"quad\"\ntranslate = [0.0, 1.6, -2.0]\nrotate = { axis = [1, 0, 0], angle = 90.0 }\nscale = [4.0, 1.0, 1.6]\nmaterial = { diffuse = [0.5, 0.9, 1.0] }\n\
     [[object]]\nmesh = \"sphere\"\ntranslate = [0.9, 0.6, -0.4]\nscale = 0.6\nmaterial = { diffuse = [0.9, 0.9, 0.6] }\n\
     [[object]]\nmesh = \"box\"\ntranslate = [-0.8, 0.5, -0.5]\nrotate = { axis = [0, 1, 0], angle = 30.0 }\nscale = [-0.5, 0.5, 0.5]\nmaterial = { diffuse = [1.0, 0.6, 0.7] }\n";

fn projector(position: [f64; 3], target: [f64; 3], cone: f64, more: &str) -> String {
    format!(
        "[[light]]\nposition = {position:?}\ntarget = {target:?}\ncone = {cone:?}\nnear = 0.05\nfar = 60.0\nshape = \"frustum\"\nlaw = \"slide\"\n{more}\n"
    )
}

/// A picture of waves, noise or checks.
fn picture(random: &mut Random, [width, height]: [u32; 2]) -> RgbaImage {
    let kind = random.below(3);
    let waves = [(); 3].map(|()| random.within(1.0, 4.0));
    RgbaImage::from_fn(width, height, |x, y| {
        let [u, v] = [f64::from(x) / f64::from(width), f64::from(y) / f64::from(height)];
        let value = |channel: usize, random: &mut Random| match kind {
            0 => 0.5 + 0.5 * (6.0 * waves[channel] * (u + 0.6 * v)).sin(),
            1 => random.share(),
            _ => f64::from((x / 3 + y / 2 + channel as u32) % 2),
        };
        let [red, green, blue] = [0, 1, 2].map(|channel| (255.0 * value(channel, random)) as u8);
        Rgba([red, green, blue, random.below(256) as u8])
    })
}

#[test]
fn generated_slides_are_where_the_oracle_has_them() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let mut lit = 0;
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let ambient = [(); 3].map(|()| random.within(0.0, 0.4));
        let mut text =
            ROOM.replace("[camera]", &format!("[shading]\npasses = \"slide\"\nambient = {ambient:?}\n[camera]"));
        for index in 0..1 + seed as usize % 3 {
            let size = random.pick(&[[64, 48], [1, 1], [1, 37], [200, 3], [17, 64]]);
            let path = folder.path().join(format!("{seed}-{index}.png"));
            picture(&mut random, size).save(&path).unwrap();
            let position = (random.vector() * dvec3(2.5, 1.0, 1.0) + dvec3(0.0, 1.8, 3.5)).to_array();
            let target = (random.vector() * 0.6 + dvec3(0.0, 0.7, -1.0)).to_array();
            let color = [(); 3].map(|()| random.within(0.2, 1.0));
            let falls = match random.below(4) {
                0 => String::from("falloff = \"inverse\"\n"),
                1 => format!("falloff = {{ law = \"inverse-square\", d0 = {:?} }}\n", random.within(2.0, 5.0)),
                2 => {
                    String::from("falloff = { by = \"z\", table = [[2.0, 1.0], [4.0, 0.7], [4.5, 0.1], [7.0, 0.6]] }\n")
                }
                _ => String::new(),
            };
            // A slide is seldom square; a narrow one needs a wide angle to be seen.
            let aspect: f64 = random.pick(&[1.0, 1.5, 0.2, 0.01, 4.0, 30.0]);
            let cone: f64 = random.within(20.0, 70.0) / aspect.clamp(0.7, 10.0);
            let more = format!("color = {color:?}\nimage = {path:?}\naspect = {aspect:?}\n{falls}");
            text += &projector(position, target, cone, &more);
        }
        lit += judge(&load(&text, folder.path()), &format!("seed {seed}\n{text}"), &mut renderer);
    }
    println!("{lit} pixels lit by a projector");
    assert!(lit > 10_000, "{lit}");
}

/// Extreme set-ups: a projector in the wall's plane, a floor that passes under it to q < 0, the eye behind the slide and in its
/// light, a cone of 178 degrees, none and 16 projectors.
#[test]
fn extreme_slides_are_where_the_oracle_has_them() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let mut random = Random::new(77);
    let path = folder.path().join("slide.png");
    picture(&mut random, [48, 32]).save(&path).unwrap();
    let image = format!("color = [0.5, 0.6, 0.7]\nimage = {path:?}\n");
    let ring = |k: usize| {
        let angle = k as f64 * 2.399_963;
        projector(
            [3.0 * angle.cos(), 2.5, 3.0 * angle.sin()],
            [0.0, 0.3, 0.0],
            40.0,
            &format!("color = [0.06, 0.04, 0.05]\nimage = {path:?}\n"),
        )
    };
    for (name, lights) in [
        ("in the wall's plane", projector([-2.5, 1.0, -2.0], [1.0, 1.1, -2.0], 60.0, &image)),
        ("over a floor that crosses q = 0", projector([0.2, 0.8, 0.4], [0.0, 0.7, -2.0], 80.0, &image)),
        ("with the eye behind it", projector([2.6, 2.3, 3.8], [-0.3, 0.7, -0.6], 40.0, &image)),
        ("with the eye in its light", projector([0.0, 1.0, -1.9], [2.0, 1.8, 3.0], 90.0, &image)),
        ("of 178 degrees", projector([0.0, 1.4, 1.0], [0.0, 0.7, -2.0], 178.0, &image)),
        ("as a slit", projector([0.0, 1.4, 1.0], [0.0, 0.7, -2.0], 150.0, &format!("{image}aspect = 0.001"))),
        ("as a slot", projector([0.0, 1.4, 1.0], [0.0, 0.7, -2.0], 1.1, &format!("{image}aspect = 1000.0"))),
        ("nowhere", String::new()),
        ("sixteen times", (0..16).map(ring).collect()),
    ] {
        let text =
            ROOM.replace("[camera]", "[shading]\npasses = \"slide\"\nambient = [0.1, 0.2, 0.15]\n[camera]") + &lights;
        let mut scene = load(&text, folder.path());
        if scene.lights.is_empty() {
            // The ray tracer needs a light to ask about.
            scene.lights =
                load(&(text + &projector([0.0, 1.0, 90.0], [0.0, 1.0, 99.0], 20.0, "")), folder.path()).lights;
        }
        let lit = judge(&scene, name, &mut renderer);
        println!("{name}: {lit} pixels lit");
    }
}

/// A plane square to the axis shows the slide magnified by the distance times the tangent of half the angle: corners of a
/// checker, where their edges cross half of the brightness, to half a pixel.
#[test]
fn corners_of_a_checker_are_magnified_by_distance_and_angle() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let path = folder.path().join("checker.png");
    let (cells, each) = (8_u32, 8_u32);
    RgbaImage::from_fn(cells * each, cells * each, |x, y| Rgba([255 * ((x / each + y / each) % 2) as u8; 4]))
        .save(&path)
        .unwrap();
    for (distance, cone) in [(2.0, 40.0), (5.0, 30.0), (1.0, 100.0)] {
        let half = distance * (0.5_f64 * cone).to_radians().tan();
        // The picture is 1.1 times the slide; its aspect is 1.
        let fov_y = 2.0 * (1.1 * half / 6.0).atan().to_degrees();
        let text = format!(
            "[image]\nsize = [300, 300]\n[camera]\neye = [0.0, 0.0, 6.0]\ntarget = [0.0, 0.0, 0.0]\nfov_y = {fov_y:?}\nnear = 1.0\nfar = 9.0\n\
             [shading]\npasses = \"slide\"\nambient = [0.0, 0.0, 0.0]\n\
             [[object]]\nmesh = \"quad\"\nrotate = {{ axis = [1, 0, 0], angle = 90.0 }}\nscale = 40.0\nmaterial = {{ diffuse = [1.0, 1.0, 1.0] }}\n"
        ) + &projector([0.0, 0.0, distance], [0.0, 0.0, 0.0], cone, &format!("image = {path:?}"));
        let (picture, _) = draw(&load(&text, folder.path()), &Request::default(), &mut renderer);
        let value = |x: usize, y: usize| picture[4 * (300 * y + x)];
        let pixel = |share: f64| 150.0 + 150.0 * (2.0 * share - 1.0) / 1.1;
        let mut worst: f64 = 0.0;
        for edge in 1..cells {
            for cell in 0..cells {
                let share = f64::from(edge) / f64::from(cells);
                let middle = pixel((f64::from(cell) + 0.5) / f64::from(cells)) as usize;
                for down in [false, true] {
                    let along = |k: usize| if down { value(middle, k) } else { value(k, middle) };
                    // Between centres of pixels, at k + 0.5.
                    let start = pixel(share).floor() as usize - 8;
                    let crossed =
                        (start..start + 16).find(|k| (along(*k) - 0.5) * (along(k + 1) - 0.5) <= 0.0).unwrap();
                    let (a, b) = (along(crossed), along(crossed + 1));
                    let found = crossed as f64 + 0.5 + (a - 0.5) / (a - b);
                    worst = worst.max((found - pixel(share)).abs());
                }
            }
        }
        println!("distance {distance}, {cone} degrees: corners at most {worst:.3} pixels off");
        assert!(worst < 0.5, "distance {distance}, {cone} degrees: {worst}");
    }
}

/// A slide of 4096 x 4096 texels, filtered by each filter: where the oracle has it, in the memory that its texels and its
/// mipmaps take, in seconds.
#[test]
fn a_slide_of_sixteen_million_texels_is_drawn() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let path = folder.path().join("large.bmp");
    let side = 4096_u32;
    // Bands of 64 texels, each a smooth wave.
    image::RgbImage::from_fn(side, side, |x, y| {
        let wave = |at: u32| (127.5 + 127.5 * (f64::from(at) / 64.0).sin()) as u8;
        image::Rgb([wave(x), wave(y), wave(x + y)])
    })
    .save(&path)
    .unwrap();
    let start = std::time::Instant::now();
    for filter in ["linear", "trilinear"] {
        let more = format!("color = [0.9, 0.8, 0.7]\nimage = {path:?}\nfilter = \"{filter}\"\naspect = 1.2\n");
        let light = projector([0.3, 1.2, -0.9], [0.0, 1.1, -2.0], 60.0, &more);
        let text = ROOM.replace("[camera]", "[shading]\npasses = \"slide\"\nambient = [0.1, 0.2, 0.15]\n[camera]");
        let text = text
            .replace("eye = [3.2, 2.6, 4.6]", "eye = [0.2, 1.4, -0.2]")
            .replace("target = [-0.3, 0.7, -0.6]", "target = [0.2, 1.1, -2.0]");
        let scene = load(&(text + &light), folder.path());
        if filter == "linear" {
            let lit = judge(&scene, "4096 texels a side", &mut renderer);
            assert!(lit > 2000, "{lit}");
        }
        let plan = renderer.plan(&scene, &Request::default()).unwrap();
        let bytes = plan.summary().image_bytes;
        let texels = 4 * u64::from(side) * u64::from(side);
        let most = if filter == "linear" { texels } else { texels / 3 * 4 + 64 };
        println!("{filter}: {bytes} bytes of images after {:.1} s", start.elapsed().as_secs_f64());
        assert!((texels..=most + (1 << 20)).contains(&bytes), "{filter}: {bytes} bytes");
        renderer.draw(&plan).unwrap();
    }
    // A debug build on a busy machine.
    assert!(start.elapsed().as_secs() < 120, "{:?}", start.elapsed());
}
