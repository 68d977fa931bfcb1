//! Colours of vertices under each way of lighting: held to the bounds of colours in f64, and noticed where they are lost.

use std::sync::Arc;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::geometry::Mesh;
use glumbra::stress::{self, Verdict};
use serde_json::{Value, json};

use super::glb::{Glb, wedge};
use super::looks::textured;
use super::{START, load};

/// Colours of the wedge's corners.
const COLORS: [[f32; 3]; 5] = [[1.0, 0.2, 0.1], [0.2, 1.0, 0.3], [0.1, 0.3, 1.0], [0.9, 0.8, 0.1], [0.5, 0.1, 0.7]];

fn tinted(mut glb: Glb) -> Glb {
    let colors = glb.floats(&COLORS);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    glb
}

fn plain() -> Glb {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    glb.root(json!({ "mesh": mesh }));
    glb
}

fn bumped() -> Glb {
    let normals = |texture: usize| -> Value {
        json!({ "normalTexture": { "index": texture }, "pbrMetallicRoughness": { "metallicFactor": 0.0 } })
    };
    textured(json!({}), normals)
}

/// A scene with the file `w.glb`. Slides need lights of their own law, and have no shadows.
fn text(shading: &str, object: &str) -> String {
    let law = if shading.contains("slide") { "cone = 60\nlaw = \"slide\"" } else { "cone = 60" };
    let start = START.replace("cone = 60", law);
    let start = if shading.contains("slide") { start.replace("\"shadow-map\", size = 256", "\"none\"") } else { start };
    // White, so that no other surface needs the passes of colours.
    let floor = "material = { diffuse = [1, 1, 1] }\n";
    format!("[shading]\n{shading}\n{start}{floor}[[object]]\nname = \"w\"\nmesh = \"w.glb\"\n{object}")
}

#[test]
fn colours_of_vertices_are_right_however_they_are_lit() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (shading, glb) in [
        ("", plain()),
        ("lighting = \"per-vertex\"", plain()),
        ("passes = \"slide\"", plain()),
        ("passes = \"shadow\"", plain()),
        ("", bumped()),
        ("bump = \"one-pass\"", bumped()),
        ("bump = \"three-pass\"", bumped()),
    ] {
        let folder = tempfile::tempdir().unwrap();
        tinted(glb).write(folder.path(), "w.glb");
        let path = folder.path().join("a.toml");
        std::fs::write(&path, text(shading, "")).unwrap();
        let scene = load(&path, &[]).scene;
        assert!(scene.objects[1].mesh.colors.is_some());
        let (rows, known) = stress::color_rows(&scene, &mut renderer);
        assert!(known > 0.9, "{shading}: {known}");
        assert!(rows.iter().all(|row| row.verdict == Verdict::Right), "{shading}: {rows:?}");
        let mut lost = scene.clone();
        lost.objects[1].mesh = Arc::new(Mesh { colors: None, ..(*scene.objects[1].mesh).clone() });
        let (rows, _) = stress::color_rows_of(&scene, &lost, &mut renderer);
        assert_eq!(rows[0].verdict, Verdict::SilentlyWrong, "{shading}: {rows:?}");
    }
}

/// The plan names the normal maps of a file, as it does those of a scene's own material.
#[test]
fn normal_maps_of_a_file_are_named_in_the_plan() {
    let folder = tempfile::tempdir().unwrap();
    bumped().write(folder.path(), "w.glb");
    let plan = |shading: &str, object: &str| {
        let path = folder.path().join("a.toml");
        std::fs::write(&path, text(shading, object)).unwrap();
        glumbra::plan::make(&load(&path, &[]).scene, &glumbra::plan::Request::default()).unwrap()
    };
    let lit = plan("", "");
    let chosen = lit.chosen.iter().find(|chosen| chosen.of == "bumps of w").unwrap();
    assert!(chosen.choice.contains("4x2 normals"), "{}", chosen.choice);
    assert!(lit.left_out.iter().all(|left| !left.what.contains("bumps")));
    for plan in [plan("", "lit = false\n"), plan("passes = \"slide\"", "")] {
        assert!(plan.left_out.iter().any(|left| left.what == "bumps of w"), "{:?}", plan.left_out);
    }
}
