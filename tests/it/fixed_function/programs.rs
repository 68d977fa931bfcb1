//! `--pipeline` as a person meets it.

use std::process::Command;

use assert_cmd::cargo::CommandCargoExt;

use super::SAMPLE;
use super::pipelines::HANDFUL;

/// The codes of a picture that a command has drawn.
fn picture_of(program: &str, arguments: &[&str]) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let mut command = Command::cargo_bin(program).unwrap();
    let output = command.args(arguments).arg("-o").arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    image::open(&path).unwrap().to_rgb8().into_raw()
}

#[test]
fn both_programs_go_either_road() {
    for (program, arguments) in
        [("glumbra", ["render", SAMPLE]), ("hw_shadowmaps_simple", ["--headless", "--mode=shadowed"])]
    {
        let [first, second] = arguments;
        let shaders = picture_of(program, &[first, second, "--pipeline", "shaders"]);
        let fixed = picture_of(program, &[first, second, "--pipeline", "fixed-function"]);
        let apart = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 1;
        let off = shaders.iter().zip(&fixed).filter(|pair| apart(*pair)).count();
        assert!(off <= 3 * HANDFUL, "{program}: {off} channels");
        // Another pipeline drew it, which does not round the same everywhere.
        assert_ne!(shaders, fixed, "{program}");
    }
}

#[test]
fn a_refused_scene_leaves_no_file_and_a_driver_without_the_pipeline_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let run = |set: &str, version: Option<&str>| {
        let mut command = Command::cargo_bin("glumbra").unwrap();
        command.args(["render", SAMPLE, "--pipeline", "fixed-function", "--set", set, "-o"]).arg(&path);
        version.map(|version| command.env("MESA_GL_VERSION_OVERRIDE", version));
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let error = run("shading.lighting=per-fragment", None);
    assert!(
        error.starts_with("error: the fixed-function pipeline cannot draw this scene:\n  \"lit\", teapot: "),
        "{error}"
    );
    let error = run("image.size=[64, 64]", Some("2.0"));
    assert!(error.starts_with("error: --pipeline fixed-function needs OpenGL's compatibility profile."), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
