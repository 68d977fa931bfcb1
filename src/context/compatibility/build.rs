//! Cargo's build script: writes, from Khronos's registry, the binding of the fixed-function pipeline's entry points, and the
//! names of GL's constants.
//!
//! The entry points are what OpenGL 2.1 has and the 3.3 core profile has not; for the rest there is glow.

use std::io;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=src/context/compatibility/build.rs");
    write()
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
    use std::{env, fs};

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
