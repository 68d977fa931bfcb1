//! Drivers that are missing, refuse, crash or stop.

use std::fs;

use super::*;

/// Mesa's variables with which every backend fails; OSMesa crashes with the first three.
const VARIABLES: [&str; 4] = [
    "GALLIUM_DRIVER=nonsense",
    "GALLIUM_DRIVER=zink",
    "MESA_GLSL_VERSION_OVERRIDE=120",
    "MESA_GL_VERSION_OVERRIDE=2.1",
];

#[test]
fn a_driver_that_refuses_or_crashes_is_told_with_all_that_was_tried() {
    let folder = work();
    let (mut wrong, mut stuck) = (Vec::new(), Vec::new());
    for (variable, command) in VARIABLES.iter().flat_map(|variable| {
        ["info", "check --core", "render scene.toml", "info --context osmesa", "tune scene.toml"]
            .map(|command| (variable, command))
    }) {
        if stuck.contains(&variable) && !command.contains("osmesa") {
            continue;
        }
        // A machine with Vulkan has zink: nothing to refuse.
        let output = run(
            folder.path(),
            &format!("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent {variable} glumbra {command}"),
        );
        if code(&output) == 0 && variable.ends_with("zink") {
            continue;
        }
        // Mesa 25.0 locks itself up when zink finds no Vulkan: such a run is given up, and one tells it.
        let is_stuck = text(&output.stderr).contains("has done nothing for ");
        if is_stuck && variable.ends_with("zink") {
            assert!(code(&output) != 0 && text(&output.stderr).contains(variable), "{}", text(&output.stderr));
            stuck.push(variable);
            continue;
        }
        let expected = if command.starts_with("check") { 2 } else { 1 };
        wrong.extend(
            refusal(&output, expected, "no OpenGL context can be had")
                .map(|how| format!("{variable} {command}: {how}")),
        );
        let error = text(&output.stderr);
        let backends: &[&str] = if command.contains("osmesa") {
            &["OSMesa"]
        } else {
            &["EGL surfaceless", "EGL device", "EGL pbuffer", "OSMesa"]
        };
        for backend in backends {
            if !error.lines().any(|line| line.trim_start().starts_with(backend)) {
                wrong.push(format!("{variable} {command}: does not name {backend}: {error}"));
            }
        }
        // OSMesa alone is wanted, and not there: the advice to install it is right.
        let is_missing = command.contains("osmesa") && error.contains("libOSMesa.so.8: cannot open");
        if !error.contains(variable) && !is_missing || error.contains("To install it") != is_missing {
            wrong.push(format!("{variable} {command}: wrong advice: {error}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

/// A library of this name that does `body` when it is loaded, in a folder of its own.
fn library(name: &str, body: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("driver.c");
    fs::write(
        &source,
        format!("#include <unistd.h>\n__attribute__((constructor)) static void load(void) {{ {body} }}\n"),
    )
    .unwrap();
    let built = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(folder.path().join(name)).arg(&source).status();
    assert!(built.unwrap().success(), "cc is what cargo links with");
    folder
}

#[test]
fn a_crash_of_the_driver_says_what_was_being_done() {
    let folder = work();
    let libraries = library("libEGL.so.1", "*(volatile int *)0 = 0;");
    for command in ["info", "check", "render scene.toml -o x.png"] {
        let script = format!("LD_LIBRARY_PATH={} glumbra {command}", libraries.path().display());
        let output = run(folder.path(), &script);
        let expected = "error: the OpenGL driver crashed (SIGSEGV) while opening a context by EGL surfaceless";
        // The check tries the driver in a process of its own.
        let status = if command == "check" { 2 } else { 128 + libc::SIGSEGV };
        assert_eq!(refusal(&output, status, expected), None, "{command}");
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[test]
fn a_driver_that_stops_is_given_up() {
    let folder = work();
    let libraries = library("libEGL.so.1", "for (;;) pause();");
    let command = format!("GLUMBRA_PATIENCE=3 LD_LIBRARY_PATH={} glumbra info", libraries.path().display());
    let output = run(folder.path(), &command);
    let expected = "has done nothing for 6 s while opening a context by EGL surfaceless";
    assert_eq!(refusal(&output, 1, expected), None);
}

#[test]
fn a_patience_that_is_no_number_of_seconds_is_told() {
    let folder = work();
    for value in ["0", "-1", "soon", "3601"] {
        let output = run(folder.path(), &format!("GLUMBRA_PATIENCE={value} glumbra plan scene.toml"));
        let warning = format!("warning: GLUMBRA_PATIENCE={value} is no number of seconds from 1 to 3600; 30 is used\n");
        assert!(code(&output) == 0 && text(&output.stderr).contains(&warning), "{value}: {}", text(&output.stderr));
    }
}

/// An OSMesa that never answers disables its backend only; the message still comes.
#[test]
fn a_driver_that_stops_in_the_child_process_is_given_up() {
    let folder = work();
    let libraries = library("libOSMesa.so.8", "for (;;) pause();");
    let libraries = libraries.path().display();
    let script = format!("GLUMBRA_PATIENCE=3 LD_LIBRARY_PATH={libraries} glumbra info --context osmesa");
    let output = run(folder.path(), &script);
    assert_eq!(refusal(&output, 1, "does not answer in 3 s, tried in a child process"), None);
}

/// Each of the three platforms of EGL answers for itself.
#[test]
fn no_egl_is_told_by_platform() {
    let folder = work();
    let libraries = tempfile::tempdir().unwrap();
    for name in ["libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"] {
        fs::write(libraries.path().join(name), "").unwrap();
    }
    let script = format!("LD_LIBRARY_PATH={} glumbra render scene.toml -o x.png", libraries.path().display());
    let output = run(folder.path(), &script);
    assert_eq!(refusal(&output, 1, "apt-get install libegl1"), None);
    for backend in ["EGL surfaceless", "EGL device", "EGL pbuffer", "OSMesa"] {
        let error = text(&output.stderr);
        let line = error.lines().find(|line| line.trim_start().starts_with(backend));
        assert!(line.is_some_and(|line| line.contains("file too short")), "{backend}: {error}");
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}
