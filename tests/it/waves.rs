//! Casters that the vertex stage moves: their shadows against ray-traced truth, which moves vertices by itself, for
//! every technique; depth EQUAL passes to the bit; normals against the surface's own slopes.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::{Renderer, draw_shade};
use glumbra::geometry::{Derived, Wave, primitive};
use glumbra::judge::metrics::{Band, compare};
use glumbra::plan::{self, Request};
use glumbra::scene::{self, Scene};
use glumbra::truth;

use crate::support::rims;

fn try_load(set: &[&str]) -> Result<Scene, scene::Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/shadow-map/wave/scene.toml");
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    Ok(glumbra::load(&path, &set)?.scene)
}

fn load(set: &[&str]) -> Scene {
    try_load(set).unwrap()
}

const POINT: &str = "light.0={ kind = \"point\", position = [-2, 6, 2.5], near = 1, far = 14, shadow = { technique = \"shadow-map\", size = 512 } }";
const SUN: &str =
    "light.0={ kind = \"directional\", direction = [2, -6, -2], shadow = { technique = \"shadow-map\", size = 512 } }";
const FENCE: &str = "object.1.material={ diffuse = [0.8, 0.5, 0.3], alpha = \"data/meshes/fence.png\" }";
const TEAPOT: &str = "object.2={ mesh = \"teapot\", translate = [0.9, 0.3, 0.3], scale = 0.8, wave = { direction = [0, 0, 1], amplitude = 0.15, axis = [0, 1, 0], wavelength = 0.7 } }";

/// Overrides, the texels of the map that the band is measured by.
const TABLE: &[(&[&str], u32)] = &[
    (&[], 512),
    (&["object.1.wave.phase=0.25", "object.2.wave.phase=-3.4"], 512),
    (&["object.1.wave.amplitude=-0.4", "object.2.wave.axis=[1, 0, 0]", "object.2.wave.wavelength=3"], 512),
    (&[FENCE], 512),
    (&[TEAPOT], 512),
    (&["light.shadow.casters=texel", "light.shadow.fit=view"], 512),
    (&["light.shadow.into=stencil"], 512),
    (&["light.shadow.technique=midpoint"], 512),
    (&["light.shadow.technique=second-depth", "object.0.casts_shadow=false", "object.1.casts_shadow=false"], 512),
    (&["light.shadow.technique=shadow-volume"], 4096),
    (&[POINT], 512),
    (&[SUN], 400), // a parallel light's texel may be 1.25 times that of the ball (tests/it/light_maps.rs)
];

#[test]
fn what_waves_casts_its_moved_shadow() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (set, texels) in TABLE {
        let scene = load(set);
        let truth = truth::trace(&scene, 0, &truth::Options::default()).unwrap();
        let mut shade = draw_shade(&scene, 0, &mut renderer).unwrap();
        // Steeper than ten to one no offset helps (tests/it/acne.rs); the side of a sheet that is turned away from the light
        // lies behind itself by nothing, and no map shadows it.
        let is_map = !set.iter().any(|set| set.contains("shadow-volume"));
        for (covered, pixel) in shade.covered.iter_mut().zip(&truth.pixels) {
            *covered &= pixel.hit.is_none_or(|hit| if is_map { hit.cos_light } else { hit.cos_light.abs() } > 0.1);
        }
        let band = Band { texels: 2.0, map_size: [*texels; 2] };
        let found = compare(&truth, &shade, &band).unwrap().all;
        let wrong = (found.false_shadow.outside, found.leak.outside);
        println!("{set:?}: {wrong:?} of {}, in the band {}", found.compared, found.compared_in_band);
        if !set.contains(&SUN) {
            assert_eq!(rims::without_rims(&scene, &truth, &shade, &band), Vec::<String>::new(), "{set:?}");
        }
        assert!(wrong.0 + wrong.1 <= 2, "{set:?}: {found:?}");
        assert!(found.compared > 10_000 && found.compared_in_band > 300, "{set:?}: too little to see: {found:?}");
    }
}

/// The vertex stage and f64 move vertices and normals to the same places.
#[test]
fn the_vertex_stage_moves_as_f64_does() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut draw = |scene: &Scene| {
        let plan = renderer.plan(scene, &Request::default()).unwrap();
        renderer.draw(&plan).unwrap();
        match renderer.read(&plan).unwrap().picture {
            Pixels::Rgba8 { data, .. } => data,
            _ => panic!("no colours"),
        }
    };
    for set in [&[][..], &["shading.lighting=per-vertex", TEAPOT], &["object.1.wave.phase=1e6"]] {
        let waving = load(&[set, &["light.shadow.technique=none"]].concat());
        let mut moved = waving.clone();
        for object in &mut moved.objects {
            if let Some(wave) = object.wave.take() {
                object.mesh = Arc::new(wave.moved(&object.mesh));
            }
        }
        let (waving, moved) = (draw(&waving), draw(&moved));
        let differing = waving.iter().zip(&moved).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        // A pixel at a silhouette may fall to either side.
        assert!(differing < waving.len() / 1000, "{set:?}: {differing} of {}", waving.len());
    }
}

/// Normals are at right angles to the moved surface, and look to the side that its triangles do, also where it folds over.
#[test]
fn normals_follow_the_slopes() {
    let rest = Arc::new(primitive("sphere").unwrap());
    let vector = |array: [f32; 3]| DVec3::from_array(array.map(f64::from));
    // Of the triangles, how many may bend more than 18 degrees between their vertices.
    for (reach, wave_vector, most) in [
        (DVec3::new(0.0, 0.3, 0.0), DVec3::new(1.0, 0.0, 0.2), 0.005),
        (DVec3::new(0.2, 0.1, -0.1), DVec3::new(0.4, -0.3, 0.2), 0.005),
        (DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.6, 0.0, 0.0), 0.05), // folds over
    ] {
        let wave = Wave { reach, vector: wave_vector, phase: 0.3 };
        let derived = Derived::default();
        let mesh = wave.moved_once(&rest, &derived);
        assert!(Arc::ptr_eq(&mesh, &wave.moved_once(&rest, &derived)), "kept as long as the mesh at rest");
        let inside = |index: &u32| {
            let [grown, place] = [wave.bounds(rest.bounds), mesh.bounds];
            grown.min.cmple(place.min).all() && grown.max.cmpge(place.max).all() && *index < mesh.positions.len() as u32
        };
        assert!(mesh.indices.iter().all(inside));
        let (mut compared, mut steep) = (0, 0usize);
        for triangle in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| vector(mesh.positions[triangle[k] as usize]));
            let facet = (b - a).cross(c - a);
            if facet.length() < 1e-5 {
                continue;
            }
            let normals = [0, 1, 2].map(|k| vector(mesh.normals[triangle[k] as usize]));
            let cosine = facet.normalize().dot((normals[0] + normals[1] + normals[2]).normalize_or_zero());
            compared += 1;
            steep += usize::from(cosine < 0.95);
        }
        assert!(compared > 5000 && (steep as f64) < most * f64::from(compared), "{reach}: {steep} of {compared}");
    }
}

#[test]
fn a_wave_of_no_amplitude_is_none() {
    let scene = load(&["object.1.wave.amplitude=0", "object.2.wave.amplitude=0.0"]);
    let plan = plan::make(&scene, &Request::default()).unwrap();
    let mut programs = plan.list.passes.iter().flat_map(|pass| match &pass.work {
        glumbra::pass::Work::Draw(draw) => draw.batches.iter().map(|batch| batch.program.clone()).collect(),
        glumbra::pass::Work::CopyDepth { .. } => Vec::new(),
    });
    assert!(programs.all(|program| program.defines.iter().all(|define| define.name() != "WAVE")));
}

/// A surface that folds over has no inside by which a far side could be told.
#[test]
fn second_depth_refuses_what_folds_over() {
    let set = ["light.shadow.technique=second-depth", "object.0.casts_shadow=false", "object.1.casts_shadow=false"];
    assert!(plan::make(&load(&set), &Request::default()).is_ok());
    let folded = [&set[..], &["object.2.wave.axis=[1, 0, 0]"]].concat();
    let error = try_load(&folded).map(drop).unwrap_err().to_string();
    assert!(error.contains("open: ball"), "{error}");
}

/// The greatest difference of two pictures, in codes of one channel.
fn apart(a: &Pixels, b: &Pixels) -> u8 {
    let (Pixels::Rgba8 { data: a, .. }, Pixels::Rgba8 { data: b, .. }) = (a, b) else { return u8::MAX };
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(u8::MAX)
}

#[test]
fn nothing_is_left_out_that_a_wave_brings() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (technique, amplitude, stays) in [
        ("shadow-map", 20.3, true),
        ("shadow-volume", 20.3, true),
        ("shadow-map", 5.0, false),
        ("midpoint", 20.3, true),
    ] {
        let far = "object.2.translate=[-19.4, 0.9, 0.3]";
        let wave = format!(
            "object.2.wave={{ direction = [1, 0, 0], amplitude = {}, axis = [0, 1, 0], wavelength = 100, phase = 0.25 }}",
            amplitude / 0.6
        );
        let scene = load(&[far, &wave, &format!("light.shadow.technique={technique}")]);
        let mut draw = |keep_all: bool| {
            let plan = renderer.plan(&scene, &Request { keep_all, ..Request::default() }).unwrap();
            renderer.draw(&plan).unwrap();
            let left_out = plan.left_out.iter().any(|left| left.what.starts_with("ball in"));
            (renderer.read(&plan).unwrap().picture, left_out)
        };
        let ((pruned, left_out), (whole, _)) = (draw(false), draw(true));
        // A floor whose volume is left out is cut to what is seen, and interpolated between other vertices than the whole.
        let most = u8::from(technique == "shadow-volume");
        assert!(apart(&pruned, &whole) <= most, "{technique} {amplitude}: {}", apart(&pruned, &whole));
        assert_eq!(left_out, !stays, "{technique} {amplitude}");
    }
}

/// Waves as long as the world and as short as a bit keep every number finite: something is drawn, and no error is.
#[test]
fn extreme_waves_are_drawn() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for wave in [
        "amplitude = 1e17, axis = [1, 0, 0], wavelength = 1e-18",
        "amplitude = 1e-17, axis = [1, 0, 0], wavelength = 1e18",
        "amplitude = 3.0, axis = [0, 1, 0], wavelength = 1e-3, phase = 1e18",
    ] {
        for technique in ["shadow-map", "shadow-volume"] {
            let wave = format!("object.2.wave={{ direction = [0, 1, 0], {wave} }}");
            let scene = load(&[&wave, &format!("light.shadow.technique={technique}")]);
            let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
            assert!(shade.shade.iter().all(|shade| shade.is_finite()), "{wave}");
            assert!(shade.covered.iter().filter(|covered| **covered).count() > 10_000, "{wave}");
        }
    }
}
