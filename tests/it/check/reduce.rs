//! `glumbra check --reduce`: the program that it writes is compiled, and shows the fault on the driver that has it alone.

use std::path::PathBuf;

use super::*;

/// A driver that is broken on purpose: GL_LESS of the stencil test holds as GL_GREATER. `dlsym` is how libEGL's own
/// eglGetProcAddress is found, by glumbra and by the program.
const BROKEN: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <string.h>
typedef void *(*Lookup)(const char *);
static Lookup driver;
static void (*separate)(unsigned, unsigned, int, unsigned);
static void (*both)(unsigned, int, unsigned);
static unsigned wrong(unsigned function) { return function == 0x0201 ? 0x0204 : function; }
static void func_separate(unsigned face, unsigned function, int reference, unsigned mask) {
    separate(face, wrong(function), reference, mask);
}
static void func(unsigned function, int reference, unsigned mask) { both(wrong(function), reference, mask); }
static void *lookup(const char *name) {
    void *found = driver(name);
    if (!strcmp(name, "glStencilFuncSeparate")) { *(void **)&separate = found; return (void *)func_separate; }
    if (!strcmp(name, "glStencilFunc")) { *(void **)&both = found; return (void *)func; }
    return found;
}
"#;

fn cc(folder: &Path, arguments: &[&str]) {
    let output = Command::new("cc").current_dir(folder).args(arguments).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "cc: {}", text(&output.stderr));
}

/// Reduces a rule, with a library loaded before the driver; the answer.
fn reduced(folder: &Path, rule: &str, library: Option<&PathBuf>) -> Output {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.current_dir(folder).args(["check", "--context", "egl", "--reduce", rule, "-o", "reduced.c"]);
    library.into_iter().for_each(|library| {
        command.env("LD_PRELOAD", library);
    });
    command.output().unwrap()
}

/// The program's exit status and text.
fn run(folder: &Path, library: Option<&PathBuf>) -> (Option<i32>, String) {
    let mut command = Command::new(folder.join("reduced"));
    library.into_iter().for_each(|library| {
        command.env("LD_PRELOAD", library);
    });
    let output = command.output().unwrap();
    (output.status.code(), text(&output.stdout))
}

/// Number of calls of GL in `main`.
fn calls(program: &str) -> usize {
    let main = program.split("int main(void)").nth(1).unwrap();
    main.lines().filter(|line| line.trim_start().starts_with("gl") || line.contains(" = gl")).count()
}

/// llvmpipe clips by clip distances that are not enabled (GL-R2), and takes one level for textureSize of a whole quad (GL-L4).
#[test]
fn a_rule_that_fails_on_this_driver_becomes_a_program_that_fails() {
    // GL-R2 is one clear and one draw: objects, a program with eight outputs, state and read-back take 54 calls. GL-L4 asks for sizes of five
    // textures of three levels, two of them cube maps: 42 images and 60 parameters.
    for (rule, most) in [("GL-R2", 60), ("GL-L4", 190)] {
        let folder = tempfile::tempdir().unwrap();
        let output = reduced(folder.path(), rule, None);
        if text(&output.stderr).contains("passes on this driver") {
            eprintln!("{rule} passes here: there is nothing to reduce");
            continue;
        }
        assert!(output.status.success(), "{rule}: {}", text(&output.stderr));
        let program = std::fs::read_to_string(folder.path().join("reduced.c")).unwrap();
        assert!(calls(&program) <= most, "{rule}: {} calls", calls(&program));
        cc(folder.path(), &["-std=c99", "-Wall", "-Wextra", "reduced.c", "-o", "reduced", "-ldl"]);
        let (status, says) = run(folder.path(), None);
        assert_eq!(status, Some(1), "{rule}: {says}");
        assert!(says.contains("expected") && says.contains(": wrong") && says.contains("has the fault"), "{says}");
    }
}

#[test]
fn the_program_of_a_broken_driver_fails_there_and_passes_on_a_sound_one() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("broken.c"), format!("{BROKEN}{FOUND_BY_DLSYM}")).unwrap();
    cc(folder.path(), &["-shared", "-fPIC", "broken.c", "-o", "broken.so", "-ldl"]);
    let library = folder.path().join("broken.so");
    let output = reduced(folder.path(), "GL-S1", Some(&library));
    assert!(output.status.success(), "{}", text(&output.stderr));
    cc(folder.path(), &["-std=c99", "-Wall", "-Wextra", "reduced.c", "-o", "reduced", "-ldl"]);
    let (broken, sound) = (run(folder.path(), Some(&library)), run(folder.path(), None));
    assert_eq!((broken.0, sound.0), (Some(1), Some(0)), "{}\n{}", broken.1, sound.1);
    let program = std::fs::read_to_string(folder.path().join("reduced.c")).unwrap();
    // One clear or two and one draw of one triangle under a stencil test, of the rule's 871 calls.
    assert!(calls(&program) <= 65, "{} calls", calls(&program));
    assert!(program.contains("GL_LESS") && program.contains("17.3.3"), "{program}");
}

#[test]
fn a_rule_that_passes_or_is_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (rule, says) in [
        ("GL-C1", "GL-C1 passes on this driver: nothing to reduce"),
        ("GL-C99", "no rule is called `GL-C99`"),
        ("s", "--reduce s: one rule is wanted, and that is GL-S1, "),
    ] {
        let output = reduced(folder.path(), rule, None);
        assert_eq!(output.status.code(), Some(2), "{rule}");
        assert!(text(&output.stderr).contains(says), "{rule}: {}", text(&output.stderr));
        assert!(!folder.path().join("reduced.c").exists(), "{rule}");
    }
}
