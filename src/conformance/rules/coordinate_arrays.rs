//! GL-V2: arrays of texture coordinates, each unit's own, and coordinates without an array [GL 4.6 compatibility, 10.2, 10.3].

use super::fixed::pipeline;
use crate::conformance::bench::arrays::{ArraysDraw, GlUnitCoordinates};
use crate::conformance::bench::fixed_function::FixedBench;
use crate::conformance::bench::{Error, GlFormat, GlImage, GlState, Sampling, Surface, full};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side.
const SIDE: usize = 16;

/// s and t of a unit at a place of the viewport: within [0.3, 0.7], other ones for each unit.
fn coordinates(unit: usize, [x, y]: [f64; 2]) -> [f64; 2] {
    let turn = 0.5 + 0.7 * unit as f64;
    [turn, turn + 1.3].map(|angle| 0.5 + 0.12 * (angle.cos() * x + angle.sin() * y))
}

/// Numbers a vertex of a unit's array; with four the last divides the others.
fn components(unit: usize) -> u32 {
    [3, 2, 4][unit % 3]
}

/// The current coordinate of a unit, for draws without its array.
fn current(unit: usize) -> [f32; 4] {
    let at = 0.35 + 0.04 * unit as f32;
    [2.0 * at, 2.0 * (1.0 - at), 0.0, 2.0]
}

fn array(unit: usize, positions: &[[f32; 4]]) -> Vec<f32> {
    let of_vertex = |[x, y, ..]: &[f32; 4]| {
        let [s, t] = coordinates(unit, [f64::from(*x), f64::from(*y)]).map(|at| at as f32);
        match components(unit) {
            2 => vec![s, t],
            3 => vec![s, t, 0.25],
            _ => vec![3.0 * s, 3.0 * t, 0.5, 3.0],
        }
    };
    positions.iter().flat_map(of_vertex).collect()
}

struct Setup<'a> {
    subject: &'a DriverUnderTest,
    fixed: &'a FixedBench,
    surface: Surface,
    image: GlImage,
    positions: Vec<[f32; 4]>,
    /// The array of each unit: they live until all is drawn.
    arrays: Vec<Vec<f32>>,
}

impl Setup<'_> {
    /// Draws what one unit shows; a unit without an array has its current coordinate.
    fn draw(&self, shown: usize, has_array: &dyn Fn(usize) -> bool, tally: &mut GradeTally) -> Result<(), Error> {
        let units: Vec<_> = self
            .arrays
            .iter()
            .enumerate()
            .map(|(unit, array)| match has_array(unit) {
                true => GlUnitCoordinates::Array(components(unit), array),
                false => GlUnitCoordinates::Current(current(unit)),
            })
            .collect();
        self.fixed.draw_arrays(
            &self.subject.bench,
            &ArraysDraw {
                surface: &self.surface,
                state: GlState { depth: None, ..GlState::WRITE },
                image: &self.image,
                sampling: Sampling::LINEAR,
                positions: &self.positions,
                units: &units,
                shown,
            },
        )?;
        for (pixel, color) in self.surface.floats().into_iter().enumerate() {
            let place = [pixel % SIDE, pixel / SIDE].map(|at| (at as f64 + 0.5) * 2.0 / SIDE as f64 - 1.0);
            let at = match has_array(shown) {
                true => coordinates(shown, place),
                false => [0, 1].map(|axis| f64::from(current(shown)[axis]) / 2.0),
            };
            for (seen, coordinate) in color.into_iter().zip(at) {
                // From the middle of one texel to the middle of the next.
                let off = f64::from(seen) - 2.0 * (coordinate - 0.25);
                tally.add(verify::within(off, 1.0 / 128.0, 1.0 / 16.0), off);
            }
        }
        Ok(())
    }
}

/// GL-V2: each unit reads its own array; without one, its current coordinate.
pub fn arrays(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "glTexCoordPointer") else { return Ok(()) };
    let texel = |s: f32, t: f32| [s, t, 0.5, 1.0];
    let texels = [texel(0.0, 0.0), texel(1.0, 0.0), texel(0.0, 1.0), texel(1.0, 1.0)];
    let image = subject.bench.float_image([2, 2], &texels)?;
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let positions = full(0.0).map(|vertex| vertex.position).to_vec();
    let count = fixed.most_units().min(8);
    let arrays = (0..count).map(|unit| array(unit, &positions)).collect();
    let setup = Setup { subject, fixed, surface, image, positions, arrays };
    let (mut own, mut none) = (GradeTally::default(), GradeTally::default());
    for shown in 0..count {
        setup.draw(shown, &|_| true, &mut own)?;
        // After a draw with all arrays this one must not be read.
        setup.draw(shown, &|unit| unit != shown, &mut none)?;
    }
    findings.tally(format!("arrays of {count} units, of 2 to 4 numbers"), own, "");
    findings.tally(format!("no array for one of {count} units"), none, "");
    let mut first = GradeTally::default();
    for shown in 0..count {
        setup.draw(shown, &|unit| unit == 0, &mut first)?;
    }
    findings.tally("an array for the first unit alone", first, "");
    Ok(())
}
