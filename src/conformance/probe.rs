//! Measured facts of the driver's depth formats: what a specification leaves open, and what drivers do otherwise than it
//! says. Polygon offset by OpenGL 4.6, 14.6.5: one unit is `r`, at least the least resolvable difference.
//!
//! Knows nothing of techniques; draws flat quads on the [`bench`](super::bench), and leaves the context's bindings changed.

use std::rc::Rc;

use serde::Serialize;

pub use super::bench::Error;
use super::bench::{Bench, Encoding, GlDraw, GlFormat, GlOffset, GlState, Surface, full};

/// The formats that are measured.
pub const FORMATS: [GlFormat; 7] = {
    let [a, b, c, d, e, f] = GlFormat::DEPTHS;
    [GlFormat::Depth, a, b, c, d, e, f]
};

/// Measurements of a format on this driver.
#[derive(Clone, Debug, Serialize)]
pub struct DepthFacts {
    /// The requested format, e.g. `DEPTH_COMPONENT24`.
    pub format: &'static str,
    /// `None` where it cannot be drawn to, with `refusal` saying why.
    pub measured: Option<MeasuredDepth>,
    pub refusal: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
pub struct MeasuredDepth {
    /// True bits of depth, which may differ from those requested.
    pub depth_bits: u32,
    pub stencil_bits: u32,
    pub float: bool,
    /// The offset unit near the far plane and nearer; equal in a fixed-point format.
    pub units: [OffsetUnit; 2],
    /// True if glPolygonOffset(0, 1) changes the stored depth at all, as it must.
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
///
/// # Errors
///
/// A driver that cannot even measure.
pub fn depth_formats(gl: &Rc<glow::Context>) -> Result<Vec<DepthFacts>, Error> {
    let bench = Bench::new(gl)?;
    FORMATS.iter().map(|&format| facts(&bench, format)).collect()
}

/// Measures one format. The context must be current.
///
/// # Errors
///
/// A driver that cannot even measure.
pub fn depth_format(gl: &Rc<glow::Context>, format: GlFormat) -> Result<DepthFacts, Error> {
    facts(&Bench::new(gl)?, format)
}

/// Measures one format on a bench.
///
/// # Errors
///
/// A driver that cannot even measure.
pub fn facts(bench: &Bench, format: GlFormat) -> Result<DepthFacts, Error> {
    let (measured, refusal) = match bench.surface([4, 4], None, Some(format)) {
        Ok(surface) => (measure(bench, &surface)?, None),
        Err(Error::Refused { reason, .. }) => (None, Some(reason)),
        Err(error) => return Err(error),
    };
    Ok(DepthFacts { format: format.name(), measured, refusal })
}

fn measure(bench: &Bench, surface: &Surface) -> Result<Option<MeasuredDepth>, Error> {
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(None) };
    let Encoding { bits, stencil_bits, float } = encoding;
    let unit = |at_depth: f64| {
        let difference = stored(bench, surface, at_depth, MANY_UNITS)? - stored(bench, surface, at_depth, 0.0)?;
        let depth = difference / f64::from(MANY_UNITS);
        Ok(OffsetUnit { at_depth, depth, codes: depth / encoding.step(at_depth) })
    };
    let shows = |depth: f64| Ok(stored(bench, surface, depth, 1.0)? != stored(bench, surface, depth, 0.0)?);
    let [far, near] = DEPTHS;
    Ok(Some(MeasuredDepth {
        depth_bits: bits,
        stencil_bits,
        float,
        units: [unit(far)?, unit(near)?],
        one_unit_shows: shows(far)? && shows(near)?,
    }))
}

/// The depth that is stored for a flat quad at window depth `depth` under glPolygonOffset(0, `units`).
///
/// # Errors
///
/// GL's.
pub fn stored(bench: &Bench, surface: &Surface, depth: f64, units: f32) -> Result<f64, Error> {
    // Without units no offset is set at all, so that a driver which adds one of its own is found out.
    let offset = (units != 0.0).then_some(GlOffset { factor: 0.0, units, clamp: 0.0 });
    let state = GlState { offset, color_write: false, ..GlState::WRITE };
    bench.draw(&GlDraw::plain(surface, state, &full((2.0 * depth - 1.0) as f32)))?;
    let [x, y] = surface.size.map(|side| side as i32 / 2);
    Ok(surface.depths_in([x, y, 1, 1]).first().copied().unwrap_or(f64::NAN))
}
