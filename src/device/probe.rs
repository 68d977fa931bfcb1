//! Measured facts of the driver's depth formats: what a specification leaves open, and what drivers do otherwise than
//! it says. Polygon offset by OpenGL 4.6, 14.6.5: one unit is `r`, at least the least difference that can be told.
//!
//! Knows nothing of techniques; draws flat quads with a shader of its own, and leaves the context's bindings changed.

mod scratch;

use glow::HasContext;
use serde::Serialize;

pub use scratch::Error;
use scratch::{DepthTarget, Program};

/// A depth format as asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    pub name: &'static str,
    /// The sized internal format.
    pub internal: u32,
    /// GL_DEPTH_COMPONENT or GL_DEPTH_STENCIL, and a type that goes with it.
    pub upload: (u32, u32),
    pub has_stencil: bool,
}

/// The formats that are measured.
pub const FORMATS: [Format; 6] = [
    depth("DEPTH_COMPONENT16", glow::DEPTH_COMPONENT16),
    depth("DEPTH_COMPONENT24", glow::DEPTH_COMPONENT24),
    depth("DEPTH_COMPONENT32", DEPTH_COMPONENT32),
    depth("DEPTH_COMPONENT32F", glow::DEPTH_COMPONENT32F),
    depth_stencil("DEPTH24_STENCIL8", glow::DEPTH24_STENCIL8, glow::UNSIGNED_INT_24_8),
    depth_stencil("DEPTH32F_STENCIL8", glow::DEPTH32F_STENCIL8, glow::FLOAT_32_UNSIGNED_INT_24_8_REV),
];

/// GL_DEPTH_COMPONENT32, which OpenGL ES and so glow do not know.
pub const DEPTH_COMPONENT32: u32 = 0x81A7;

const fn depth(name: &'static str, internal: u32) -> Format {
    Format { name, internal, upload: (glow::DEPTH_COMPONENT, glow::FLOAT), has_stencil: false }
}

const fn depth_stencil(name: &'static str, internal: u32, kind: u32) -> Format {
    Format { name, internal, upload: (glow::DEPTH_STENCIL, kind), has_stencil: true }
}

/// What a format is on this driver.
#[derive(Clone, Debug, Serialize)]
pub struct DepthFacts {
    /// The format asked for, e.g. `DEPTH_COMPONENT24`.
    pub format: &'static str,
    /// `None` where it cannot be drawn to, with `refusal` saying why.
    pub measured: Option<Measured>,
    pub refusal: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// True bits of depth, which may differ from those asked for.
    pub depth_bits: u32,
    pub stencil_bits: u32,
    pub float: bool,
    /// The offset unit near the far plane and nearer; equal in a fixed-point format.
    pub units: [OffsetUnit; 2],
    /// Whether glPolygonOffset(0, 1) changes the stored depth at all, as it must.
    pub one_unit_shows: bool,
}

/// The size of one unit of glPolygonOffset.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OffsetUnit {
    /// The window depth of the quad that was drawn.
    pub at_depth: f64,
    /// One unit, as a difference of depths: the mean over 1024 of them.
    pub depth: f64,
    /// The same in codes of a fixed-point format, or in steps of a float at `at_depth`.
    pub codes: f64,
}

impl DepthFacts {
    /// One line: whether the format is honoured, and what a unit of polygon offset does.
    pub fn in_words(&self) -> String {
        let Some(measured) = &self.measured else {
            return format!(
                "{}: refused by the driver ({})",
                self.format,
                self.refusal.as_deref().unwrap_or("no reason given")
            );
        };
        let kind = if measured.float { "float" } else { "unsigned" };
        let unit = if measured.one_unit_shows {
            format!("one unit of polygon offset is {:.3e}", measured.units[0].depth)
        } else {
            format!(
                "one unit of polygon offset ({:.1e}) does not change what it stores, against GL 4.6, 14.6.5: \
                 use a slope factor, or depth24",
                measured.units[0].depth
            )
        };
        format!("{}: the driver stores {} bits, {kind}; {unit}", self.format, measured.depth_bits)
    }
}

/// The window depths at which units are measured: of different exponents, exact in every format's floats.
const DEPTHS: [f64; 2] = [0.75, 0.1875];

/// Enough units that rounding to codes does not matter, few enough to stay within [0, 1].
const MANY_UNITS: f32 = 1024.0;

/// Measures every format. The context must be current.
pub fn depth_formats(gl: &glow::Context) -> Result<Vec<DepthFacts>, Error> {
    let program = Program::new(gl)?;
    FORMATS.iter().map(|format| facts(&program, format)).collect()
}

/// Measures one format. The context must be current.
pub fn depth_format(gl: &glow::Context, format: &Format) -> Result<DepthFacts, Error> {
    facts(&Program::new(gl)?, format)
}

fn facts(program: &Program, format: &Format) -> Result<DepthFacts, Error> {
    let (measured, refusal) = match DepthTarget::new(program.gl(), format)? {
        Ok(target) => (Some(measure(program, &target, format)), None),
        Err(refusal) => (None, Some(refusal)),
    };
    Ok(DepthFacts { format: format.name, measured, refusal })
}

fn measure(program: &Program, target: &DepthTarget, format: &Format) -> Measured {
    let gl = program.gl();
    // SAFETY: the target's texture is bound; level 0 exists.
    let level = |name| unsafe { gl.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, name) };
    let depth_bits = level(glow::TEXTURE_DEPTH_SIZE).max(0) as u32;
    let stencil_bits = if format.has_stencil { level(glow::TEXTURE_STENCIL_SIZE).max(0) as u32 } else { 0 };
    let float = level(glow::TEXTURE_DEPTH_TYPE) == glow::FLOAT as i32;
    let stored = |depth, units| target.stored(program, depth, units, depth_bits, float);
    let unit = |at_depth: f64| {
        let depth = (stored(at_depth, MANY_UNITS) - stored(at_depth, 0.0)) / f64::from(MANY_UNITS);
        OffsetUnit { at_depth, depth, codes: depth / step(at_depth, depth_bits, float) }
    };
    Measured {
        depth_bits,
        stencil_bits,
        float,
        units: DEPTHS.map(unit),
        one_unit_shows: DEPTHS.iter().all(|&depth| stored(depth, 1.0) != stored(depth, 0.0)),
    }
}

/// The least difference of stored depths: of a fixed-point format, or of a float's at `depth` in (0, 1).
fn step(depth: f64, bits: u32, float: bool) -> f64 {
    if float { (depth.log2().floor() - 23.0).exp2() } else { 1.0 / (f64::from(bits).exp2() - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::step;

    #[test]
    fn steps_of_formats() {
        assert_eq!(step(0.75, 32, true), 2f64.powi(-24));
        assert_eq!(step(0.1875, 32, true), 2f64.powi(-26));
        assert_eq!(step(0.75, 16, false), 1.0 / 65535.0);
    }
}
