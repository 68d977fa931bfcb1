//! `glumbra plan` with --shaders, --matrices and --gl: what it prints is true, and its C compiles.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;
use glam::{DMat4, DVec3, DVec4};

use crate::support::gl_headers;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Runs `glumbra plan`.
fn plan(scene: &str, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.arg("plan").arg(root().join(scene)).args(arguments).output().unwrap()
}

fn printed(scene: &str, arguments: &[&str]) -> String {
    let output = plan(scene, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{scene} {arguments:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

const BOX: &str = "data/cases/scenes/box.toml";
const MAIN: &str = "data/scenes/main.toml";

#[test]
fn shaders_are_printed_for_the_passes_that_are_named() {
    let all = printed(BOX, &["--shaders"]);
    assert!(
        all.starts_with("// ==== program 1 of 3, \"depth\": vertex shader\n// passes: \"light 0: depth\""),
        "{all}"
    );
    let count = |text: &str, part: &str| text.matches(part).count();
    assert_eq!((count(&all, "#version 330 core\n"), count(&all, "// ==== program 2 of 3, \"surface\"")), (6, 2));
    let lit = printed(BOX, &["--shaders", "lit"]);
    assert_eq!((count(&lit, "#version 330 core\n"), count(&lit, "\"light 0: depth\"")), (4, 0));
    for mark in
        ["\n#line 1 3\n", "\n// file 1: surfaces/material.glsl\n#line 1 1\n", "#define CONE_0\n", "float shade_0()"]
    {
        assert!(lit.contains(mark), "{mark} is missing in {lit}");
    }
    let copies = printed(BOX, &["--set", "light.shadow.transfer=\"copy\"", "--shaders", "copied"]);
    assert_eq!(copies, "// no shader: the pass only copies\n");
}

#[test]
fn a_pass_that_is_not_there_is_refused_with_the_names_of_all() {
    let output = plan(BOX, &["--shaders", "lamp"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    assert_eq!(
        error,
        "error: --shaders lamp: no pass has that in its name; the passes are \"light 0: depth\", \"lit\"\n"
    );
    let both = plan(BOX, &["--shaders", "--matrices"]);
    assert_eq!((both.status.code(), both.stdout.len()), (Some(2), 0));
}

/// The four rows of numbers below a line that begins so, from `from` on.
fn matrix(text: &str, title: &str) -> DMat4 {
    let mut lines = text.lines().skip_while(|line| !line.trim_start().starts_with(title)).skip(1);
    let mut row = || {
        let line = lines.next().unwrap();
        let numbers: Vec<f64> = line.split_whitespace().map(|number| number.parse().unwrap()).collect();
        DVec4::from_slice(&numbers)
    };
    DMat4::from_cols(row(), row(), row(), row()).transpose()
}

#[test]
fn matrices_are_those_of_the_document() {
    let text = printed(BOX, &["--matrices"]);
    let (s, p_light) = (matrix(&text, "S, "), matrix(&text, "P_light, "));
    let (light_from_world, world_from_eye) = (matrix(&text, "L^-1, "), matrix(&text, "V, "));
    let close = |a: DMat4, b: DMat4, what: &str| assert!(a.abs_diff_eq(b, 2e-6), "{what}: {a} is not {b}\n{text}");
    let halves = DMat4::from_translation(DVec3::splat(0.5)) * DMat4::from_scale(DVec3::splat(0.5));
    close(s, halves, "S");
    // A cone of 50 degrees, from 1 to 12.
    let cot = 1.0 / 25.0_f64.to_radians().tan();
    let expected = DMat4::from_cols(
        DVec4::X * cot,
        DVec4::Y * cot,
        DVec4::new(0.0, 0.0, -13.0 / 11.0, -1.0),
        DVec4::new(0.0, 0.0, -24.0 / 11.0, 0.0),
    );
    close(p_light, expected, "P_light");
    // The light looks at the origin from (-2, 5, 1.5); the camera stands at (2.5, 4.5, 5).
    let target = light_from_world * DVec4::W;
    let distance = DVec3::new(-2.0, 5.0, 1.5).length();
    assert!(target.abs_diff_eq(DVec4::new(0.0, 0.0, -distance, 1.0), 2e-6), "{target}");
    assert!((world_from_eye * DVec4::W).abs_diff_eq(DVec4::new(2.5, 4.5, 5.0, 1.0), 2e-6));
    close(matrix(&text, "V^-1, "), world_from_eye.inverse(), "V^-1");
    let parts: Vec<&str> = text.split("  Set-up ").skip(1).collect();
    assert_eq!(parts.len(), 4);
    let texture_from_eye = s * matrix(&text, "B, ") * p_light * light_from_world * world_from_eye;
    for (part, planes) in parts.iter().zip(["S B P_light L^-1 V", "S B P_light L^-1", "S B P_light", "I"]) {
        let title = part.lines().nth(1).unwrap();
        assert!(title.contains(&format!("E_po = {planes}: rows")), "{title}");
    }
    for part in parts {
        let block = part.split_once("  E_po\n").unwrap().1;
        let e_po = matrix(&format!("E_po\n{block}"), "E_po");
        let (modelview, e_e) = (matrix(block, "modelview_po"), matrix(block, "E_e = "));
        assert!((e_po * modelview.inverse()).abs_diff_eq(e_e, 1e-4), "E_e of {part}");
        assert!(e_e.abs_diff_eq(texture_from_eye, 1e-5), "{e_e} is not {texture_from_eye}");
        close(matrix(block, "T = "), DMat4::IDENTITY, "T");
    }
    assert_eq!(text.matches("which this scene uses").count(), 1);
    assert!(text.contains("Set-up (ii), texgen = \"world\", which this scene uses"), "{text}");
}

/// The place of a direction in its face is that of [GL 4.6, table 8.19].
#[test]
fn matrices_of_a_cubes_faces_are_the_tables() {
    let text = printed("data/cases/scenes/room.toml", &["--matrices"]);
    let faces: Vec<&str> = text.split("\n  Face ").skip(1).collect();
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    // The major axis, and those of sc and tc.
    let table = [
        ("+x", x, -z, -y),
        ("-x", -x, z, -y),
        ("+y", y, x, z),
        ("-y", -y, x, -z),
        ("+z", z, x, -y),
        ("-z", -z, -x, -y),
    ];
    assert_eq!(faces.len(), table.len(), "{text}");
    let light = DVec3::new(0.1, 0.2, -0.1);
    for ((name, major, s, t), text) in table.into_iter().zip(faces) {
        assert!(text.starts_with(&format!("{name}\n")), "{name}: {text}");
        let clip_from_face = matrix(text, &format!("P_light of {name}, "));
        let clip_from_world = clip_from_face * matrix(text, &format!("L^-1 of {name}, "));
        for way in [DVec3::new(1.0, 0.3, -0.2), DVec3::new(0.1, 0.9, 0.4), DVec3::new(0.2, -0.6, 0.8)] {
            let clip = clip_from_world * (light + way).extend(1.0);
            let expected = DVec3::new(s.dot(way), t.dot(way), major.dot(way));
            let found = DVec3::new(clip.x, clip.y, clip.w);
            // The numbers have eight digits.
            assert!(found.abs_diff_eq(expected, 1e-6), "{name} {way}: {found} is not {expected}");
        }
    }
    assert!(!printed(BOX, &["--matrices"]).contains("Face "));
}

#[test]
fn planes_beside_the_lights_own_are_printed() {
    let sample = printed("data/scenes/hw_shadowmaps_simple.toml", &["--matrices"]);
    assert!(sample.contains("Object planes of floor\n  GL_OBJECT_LINEAR for s and t"), "{sample}");
    assert!(sample.contains("  T scales s and t by 4\n"), "{sample}");
    let guards =
        printed("data/cases/scenes/guards.toml", &["--matrices", "--set", "light.shadow.guard=\"texture-1d\""]);
    assert!(guards.contains("Plane of guard = \"texture-1d\" of light 0\n  GL_EYE_LINEAR for s"), "{guards}");
    let sun =
        printed("data/stress/scenes/sun.toml", &["--matrices", "--set", "light.shadow.technique=\"shadow-volume\""]);
    assert!(sun.contains("no texture coordinates"), "{sun}");
}

/// Compiles a listing with every warning as an error: against the registry, and against the machine's own headers if it has
/// them.
fn compile(folder: &Path, name: &str, text: &str) {
    let path: PathBuf = folder.join("listing.c");
    std::fs::write(&path, text).unwrap();
    let cc = || {
        let mut cc = Command::new("cc");
        cc.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-c", "-o", "/dev/null"]).arg(&path);
        cc
    };
    let has_headers = Path::new("/usr/include/GL/glext.h").exists();
    let own = has_headers.then(&cc);
    for mut cc in own.into_iter().chain([{
        let mut with = cc();
        with.arg("-I").arg(folder);
        with
    }]) {
        let output = cc.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {error}");
    }
}

/// Scene, what is set, and what its listing must hold.
const LISTINGS: &[(&str, &[&str], &[&str])] = &[
    (
        BOX,
        &[],
        &[
            "glPolygonOffset(",
            "glTexGeni(GL_S, GL_TEXTURE_GEN_MODE, GL_EYE_LINEAR);",
            "glTexGenfv(GL_Q, GL_EYE_PLANE,",
            "use_eye_planes(programs[1], \"eye_planes_0\");",
            "glSamplerParameteri(samplers[0], GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);",
            "its lighting is found for each fragment",
        ],
    ),
    (BOX, &["light.shadow.transfer=\"copy\""], &["glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, 256, 256);"]),
    (
        BOX,
        &["shading.lighting=\"per-vertex\""],
        &[
            "Drawn by the fixed-function pipeline.",
            "glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);",
            "glTexParameteri(GL_TEXTURE_2D, GL_DEPTH_TEXTURE_MODE, GL_LUMINANCE);",
            "glLightfv(GL_LIGHT0, GL_POSITION,",
            "glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_MODULATE);",
            "glDepthFunc(GL_EQUAL);",
        ],
    ),
    ("data/scenes/hw_shadowmaps_simple.toml", &[], &["glTexGenfv(GL_S, GL_"]),
    (
        BOX,
        &["light.shadow.technique=\"shadow-volume\"", "light.shadow.method=\"z-pass-two-sided\""],
        &[
            "glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);",
            "glClearStencil(0);",
            "glStencilFunc(GL_EQUAL, 0,",
        ],
    ),
    (
        BOX,
        &["light.shadow.technique=\"shadow-volume\"", "light.shadow.method=\"z-fail-clamped\""],
        &["glEnable(GL_DEPTH_CLAMP);"],
    ),
    (BOX, &["light.shadow.technique=\"midpoint\"", "light.shadow.single=\"first\""], &["glBindSampler("]),
    (BOX, &["light.shadow.mipmaps=true"], &["GL_TEXTURE_MAX_LEVEL, 8"]),
    (
        "data/stress/scenes/point.toml",
        &["light.shadow.technique=\"shadow-map\""],
        &["GL_TEXTURE_CUBE_MAP_NEGATIVE_Y", "glDeleteFramebuffers(1, &cleared);"],
    ),
    ("data/stress/scenes/sun.toml", &["light.shadow.technique=\"shadow-map\""], &["GL_TEXTURE_BORDER_COLOR"]),
    ("data/cases/scenes/guards.toml", &["light.shadow.guard=\"texture-1d\""], &["glTexImage1D(GL_TEXTURE_1D"]),
    ("data/cases/scenes/guards.toml", &["light.shadow.guard=\"clip-plane\""], &["glEnable(GL_CLIP_DISTANCE0);"]),
    ("data/cases/shadow-map/alpha-test/scene.toml", &["shading.lighting=\"per-vertex\""], &["texels("]),
    ("data/cases/shadow-map/alpha-test/scene.toml", &[], &["texels("]),
    (MAIN, &[], &["void frame(void)"]),
];

#[test]
fn listings_are_c_that_compiles() {
    let folder = tempfile::tempdir().unwrap();
    gl_headers::write(folder.path(), false);
    for (scene, set, expected) in LISTINGS {
        let mut arguments = vec!["--gl"];
        set.iter().for_each(|set| arguments.extend(["--set", set]));
        let text = printed(scene, &arguments);
        let name = format!("{scene} {set:?}");
        for part in *expected {
            assert!(text.contains(part), "{name} lacks {part}:\n{text}");
        }
        compile(folder.path(), &name, &text);
    }
}

/// Names of a scene stand in comments, and cannot end them.
#[test]
fn names_of_a_scene_stay_in_their_comments() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(root().join(BOX)).unwrap();
    let named = text.replace("name = \"box\"", "name = \"*/ int main(void) { /* ??/\\n#error\"");
    assert_ne!(named, text);
    std::fs::write(&path, named).unwrap();
    gl_headers::write(folder.path(), false);
    for lighting in ["per-fragment", "per-vertex"] {
        let set = format!("shading.lighting=\"{lighting}\"");
        let c = printed(path.to_str().unwrap(), &["--gl", "--set", &set]);
        assert!(c.contains("* / int main(void) { / * ? ?/ #error"), "{c}");
        compile(folder.path(), lighting, &c);
    }
    let glsl = printed(path.to_str().unwrap(), &["--shaders"]);
    assert!(glsl.lines().all(|line| !line.starts_with("#error")), "{glsl}");
}
