//! Too little memory, too few descriptors, too few threads.

use super::*;

/// Under every limit either the picture is whole, or there is an error, or a crash of the driver that is named; and
/// nothing else lies there.
fn checked(what: &str, script: &str, wrong: &mut Vec<String>) {
    let folder = work();
    let output = run(folder.path(), script);
    let (code, error) = (code(&output), text(&output.stderr));
    let left = names(folder.path());
    if code == 0 {
        let picture = image::open(folder.path().join("x.png"));
        if picture.is_err() || left != ["scene.toml", "x.png"] {
            wrong.push(format!("{what}: exit 0 with {left:?}"));
        }
        return;
    }
    let told = error.lines().filter(|line| line.starts_with("error: ")).count();
    // A process that the system cannot even start is the shell's to tell, or the loader's.
    let started = code < 126 && !error.contains("error while loading shared libraries");
    let crashed = code > 128 && error.contains("the OpenGL driver crashed");
    if left != ["scene.toml"] || error.contains("panicked") {
        wrong.push(format!("{what}: exit {code}, leaves {left:?}: {error}"));
    } else if (started || code > 128) && (told == 0 || !(code == 1 || crashed)) {
        wrong.push(format!("{what}: exit {code}: {error}"));
    }
}

#[test]
fn too_little_memory_is_told_and_leaves_nothing() {
    let mut wrong = Vec::new();
    for kilobytes in [
        40_000, 120_000, 200_000, 350_000, 360_000, 400_000, 500_000, 600_000, 700_000, 800_000, 860_000, 900_000,
        1_500_000,
    ] {
        let script = format!("ulimit -v {kilobytes}; glumbra render scene.toml -o x.png --size 4000x4000");
        checked(&format!("ulimit -v {kilobytes}"), &script, &mut wrong);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The driver waits for ever for a thread that it could not start.
#[test]
fn too_little_memory_for_threads_is_told() {
    let mut wrong = Vec::new();
    checked("ulimit -v 300000", "ulimit -v 300000; glumbra render scene.toml -o x.png", &mut wrong);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn memory_that_runs_out_is_an_error_with_its_size() {
    // The file is small; what it asks for is not to be had.
    let folder = work();
    let script = "ulimit -v 2000000; glumbra render scene.toml -o x.exr --size 16384x16384";
    let output = run(folder.path(), script);
    assert_ne!(code(&output), 134, "{}", text(&output.stderr));
    assert_eq!(names(folder.path()), ["scene.toml"]);
    let error = text(&output.stderr);
    assert!(error.lines().any(|line| line.starts_with("error: ")) && error.contains("memory"), "{error}");
}

#[test]
fn too_few_descriptors_are_told_and_leave_nothing() {
    let mut wrong = Vec::new();
    for count in 3..16 {
        checked(
            &format!("ulimit -n {count}"),
            &format!("ulimit -n {count}; glumbra render scene.toml -o x.png"),
            &mut wrong,
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
