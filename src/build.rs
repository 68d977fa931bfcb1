//! Cargo's build script: names the commit for `--version`, and writes, from Khronos's registry, the binding of the
//! fixed-function pipeline's entry points, and the names of GL's constants.
//!
//! The entry points are what OpenGL 2.1 has and the 3.3 core profile has not; for the rest there is glow.

use std::process::Command;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=src/build.rs");
    println!("cargo::rustc-env=GLUMBRA_COMMIT={}", commit().map(|commit| format!(" ({commit})")).unwrap_or_default());
    write()
}

/// The commit that is built, and its date, where they are known: of a package from its `.cargo_vcs_info.json`, of a checkout
/// from git. A debug build has none: each commit would build it again.
fn commit() -> Option<String> {
    /// Digits of a commit's name that are shown.
    const DIGITS: usize = 10;
    if let Ok(packed) = fs::read_to_string(".cargo_vcs_info.json") {
        let digits = packed.split("\"sha1\"").nth(1)?.split('"').nth(1)?;
        return Some(digits.get(..DIGITS)?.to_owned());
    }
    if env::var("PROFILE").is_ok_and(|profile| profile == "debug") {
        return None;
    }
    // A folder above that is another project's checkout says nothing of this one.
    let root = env::var_os("CARGO_MANIFEST_DIR")?;
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(root).ok()? {
        return None;
    }
    let built = ["src", "glsl", "data", "Cargo.toml", "Cargo.lock"];
    // Grows by a line with each commit and checkout. A path that is not there would have cargo build again each time.
    let head = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|path| fs::exists(path).unwrap_or(false));
    for path in built.into_iter().chain(head.as_deref()) {
        println!("cargo::rerun-if-changed={path}");
    }
    let name = git(&["log", "-1", "--format=%h %cs", "--abbrev=10"])?;
    let changed = git(&[&["status", "--porcelain", "--"], &built[..]].concat())?;
    Some(if changed.is_empty() { name } else { format!("{name}, with changes") })
}

/// The text that git prints; nothing where it fails or is not there.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

/// Nothing: the feature that needs the binding is off.
#[cfg(not(feature = "fixed-function"))]
fn write() -> io::Result<()> {
    Ok(())
}

#[cfg(feature = "fixed-function")]
fn write() -> io::Result<()> {
    use std::io::Write;
    use std::path::Path;

    use gl_generator::{Api, Fallbacks, Profile, Registry, StructGenerator};

    let mut registry = Registry::new(Api::Gl, (2, 1), Profile::Compatibility, Fallbacks::None, []);
    let core = Registry::new(Api::Gl, (3, 3), Profile::Core, Fallbacks::None, []);
    registry.cmds.retain(|command| !core.cmds.iter().any(|kept| kept.proto.ident == command.proto.ident));
    registry.enums.retain(|value| !core.enums.iter().any(|kept| kept.ident == value.ident));
    let folder = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets no OUT_DIR"))?;
    let mut file = io::BufWriter::new(fs::File::create(Path::new(&folder).join("fixed_function.rs"))?);
    registry.write_bindings(StructGenerator, &mut file)?;
    let mut names = io::BufWriter::new(fs::File::create(Path::new(&folder).join("enum_names.rs"))?);
    let all = Registry::new(Api::Gl, (4, 6), Profile::Compatibility, Fallbacks::None, []);
    writeln!(names, "&[")?;
    for value in all.enums.iter().filter(|value| value.ty.ends_with("GLenum")) {
        writeln!(names, "    (\"GL_{}\", {}),", value.ident, value.value)?;
    }
    writeln!(names, "]")
}
