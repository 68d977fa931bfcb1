//! Placement of a texture by MTL's options (-s, -o, -clamp), and the channel that it is read from (-imfchan): against the
//! same texture laid by the mesh's own coordinates, against ray-traced truth, and by fixed function.

use std::fs;
use std::path::Path;

use glumbra::context::{self, ContextRequest, Profile};
use glumbra::device::Pixels;
use glumbra::fixed_function::FixedFunction;
use glumbra::frame::{Renderer, draw_shade};
use glumbra::plan::Request;
use glumbra::scene::Scene;
use glumbra::truth::{self, Answer};

/// Texels of all colours, 8 by 8; green tells a disc off centre from its surroundings.
fn write_picture(folder: &Path) {
    let texel = |x: u32, y: u32| {
        let inside = (f64::from(x) - 2.5).hypot(f64::from(y) - 3.5) < 2.2;
        image::Rgba([(30 * x + 20) as u8, if inside { 255 } else { 0 }, (30 * y) as u8, 255])
    };
    image::RgbaImage::from_fn(8, 8, texel).save(folder.join("a.png")).unwrap();
}

/// A square above a floor, with map options, and with its own coordinates scaled and moved.
fn scene(options: &str, scale: [f64; 2], offset: [f64; 2]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    write_picture(folder.path());
    let st = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[s, t]: [f64; 2]| format!("vt {} {}\n", s * scale[0] + offset[0], t * scale[1] + offset[1]));
    let square = "v -1 1 1\nv 1 1 1\nv 1 1 -1\nv -1 1 -1\n";
    let text = format!("mtllib a.mtl\nusemtl m\n{square}{}f 1/1 2/2 3/3 4/4\n", st.concat());
    fs::write(folder.path().join("a.obj"), text).unwrap();
    fs::write(folder.path().join("a.mtl"), format!("newmtl m\n{options}")).unwrap();
    let text = "[image]\nsize = [160, 120]\n[camera]\neye = [1, 4, 5]\ntarget = [0, 0.4, 0]\n\
                [[light]]\nposition = [1, 5, 0.5]\ntarget = [0, 0, 0]\ncone = 60\nshadow = { technique = \"shadow-map\" }\n\
                [[object]]\nmesh = \"a.obj\"\n[[object]]\nmesh = \"quad\"\nscale = 4.0\n";
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    let loaded = glumbra::load(&path, &[String::from("shading.lighting=per-vertex")]).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded.scene
}

fn codes(pixels: Pixels) -> Vec<u8> {
    match pixels {
        Pixels::Rgba8 { data, .. } => data,
        other => panic!("{other:?}"),
    }
}

fn picture(renderer: &mut Renderer, scene: &Scene) -> Vec<u8> {
    let plan = renderer.plan(scene, &Request::default()).unwrap();
    renderer.draw(&plan).unwrap();
    codes(renderer.read(&plan).unwrap().picture)
}

/// Values that differ by more than two codes.
fn differences(a: &[u8], b: &[u8]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count()
}

const ROWS: [(&str, [f64; 2], [f64; 2]); 4] = [
    ("map_Kd -s 2 3 -o 0.25 -0.5", [2.0, 3.0], [0.25, -0.5]),
    ("map_Kd -o 0.5", [1.0, 1.0], [0.5, 0.0]),
    ("map_d -imfchan g -s -2 1", [-2.0, 1.0], [0.0, 0.0]),
    ("map_d -imfchan g -clamp on -s 3 2 -o -1 0.25", [3.0, 2.0], [-1.0, 0.25]),
];

#[test]
fn a_placed_texture_is_one_whose_coordinates_are_placed() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (options, scale, offset) in ROWS {
        let placed = picture(&mut renderer, &scene(&format!("{options} a.png\n"), [1.0; 2], [0.0; 2]));
        let rest = options.split(" -s").next().unwrap().split(" -o").next().unwrap();
        let baked = picture(&mut renderer, &scene(&format!("{rest} a.png\n"), scale, offset));
        let plain = picture(&mut renderer, &scene(&format!("{rest} a.png\n"), [1.0; 2], [0.0; 2]));
        assert!(differences(&placed, &baked) < 12, "{options}: {}", differences(&placed, &baked));
        assert!(differences(&placed, &plain) > 500, "{options}: {}", differences(&placed, &plain));
    }
}

/// Holes are where the ray tracer has them, for sight and for light.
#[test]
fn holes_are_where_truth_has_them() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (options, ..) in &ROWS[2..] {
        let scene = scene(&format!("{options} a.png\n"), [1.0; 2], [0.0; 2]);
        let truth = truth::trace(&scene, 0, &truth::Options { most_ambiguous: 1.0, ..Default::default() }).unwrap();
        let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
        let (mut compared, mut shadowed, mut wrong) = (0, 0, 0);
        for (pixel, shade) in truth.pixels.iter().zip(&shade.shade) {
            let lit = match pixel.answer {
                Answer::Lit => true,
                Answer::Shadowed => false,
                _ => continue,
            };
            (compared, shadowed) = (compared + 1, shadowed + usize::from(!lit));
            wrong += usize::from((*shade >= 0.5) != lit);
        }
        println!("{options}: {wrong} of {compared} wrong, {shadowed} in shadow");
        assert!(compared > 5000 && shadowed > 100 && 500 * wrong < compared, "{options}: {wrong} of {compared}");
    }
}

#[test]
fn fixed_function_places_them_by_the_texture_matrix() {
    let request = ContextRequest { profile: Profile::Compatibility, ..ContextRequest::default() };
    let context = context::open(&request).unwrap();
    let mut renderer = Renderer::new(&context);
    for (options, ..) in ROWS {
        let scene = scene(&format!("{options} a.png\n"), [1.0; 2], [0.0; 2]);
        let shaders = picture(&mut renderer, &scene);
        let plan = renderer.plan(&scene, &Request::default()).unwrap();
        let mut fixed = FixedFunction::new(&context).unwrap();
        fixed.run(&plan.list).unwrap();
        let fixed = codes(fixed.read(&plan.list, plan.picture).unwrap());
        assert!(differences(&shaders, &fixed) < 12, "{options}: {}", differences(&shaders, &fixed));
    }
}
