//! Error of normal maps by their resolution: differences of texels against a slope that is known, as a graph.

use std::f64::consts::TAU;

use glam::DVec3;

use super::graph::{Graph, GraphAxis, Line};
use super::painter::Pen;
use crate::geometry::normal_map::{Difference, HeightField, HeightWrap};

/// Texels a side.
const SIZES: [u32; 4] = [32, 64, 128, 256];
/// Heights are A sin(2 π n s).
const AMPLITUDE: f64 = 0.01;
const WAVES: f64 = 3.0;

/// Names of the two differences.
pub const NAMES: [&str; 2] = ["forward differences", "central differences"];

/// Greatest angles in degrees, for each size: by forward and by central differences.
pub fn measure() -> [[f64; 4]; 2] {
    [Difference::Forward, Difference::Central].map(|difference| SIZES.map(|size| worst(size, difference)))
}

fn worst(size: u32, difference: Difference) -> f64 {
    let place = |texel: u32| (f64::from(texel) + 0.5) / f64::from(size);
    let height = |texel: u32| (0.5 + AMPLITUDE * (WAVES * TAU * place(texel)).sin()) as f32;
    let heights = (0..size).map(height).collect();
    let field = HeightField { name: String::from("a wave"), width: size, height: 1, heights };
    let normals = field.normals(f64::from(size), difference, HeightWrap::Repeat);
    let angle = |(texel, normal): (u32, &DVec3)| {
        let slope = AMPLITUDE * WAVES * TAU * (WAVES * TAU * place(texel)).cos();
        normal.angle_between(DVec3::new(-slope, 0.0, 1.0)).to_degrees()
    };
    (0..).zip(&normals.means).map(angle).fold(0.0, f64::max)
}

/// The angles in words.
pub fn in_words([forward, central]: &[[f64; 4]; 2]) -> String {
    let words = |errors: &[f64; 4]| errors.map(|error| format!("{}°", two_digits(error))).join(", ");
    format!("greatest angle at 32, 64, 128, 256 texels: forward {}; central {}", words(forward), words(central))
}

fn two_digits(value: f64) -> String {
    let places = (1.0 - value.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.places$}")
}

/// The graph, both axes logarithmic.
pub fn graph(errors: &[[f64; 4]; 2]) -> Graph<'static> {
    let axis = |label, range, ticks| GraphAxis { label, range, ticks, is_logarithmic: true };
    let x = axis("texels a side", [32.0, 256.0], SIZES.map(f64::from).to_vec());
    let y = axis("greatest angle off, in degrees", [0.005, 10.0], vec![0.01, 0.1, 1.0, 10.0]);
    let lines = errors.iter().zip(NAMES).zip([[213, 94, 0], [0, 114, 178]]).map(|((errors, name), color)| {
        let points = SIZES.iter().zip(errors).map(|(size, error)| Some([f64::from(*size), *error])).collect();
        Line { name, pen: Pen { color, width: 2.2, is_dashed: false }, points, dots: 4.0 }
    });
    Graph { axes: [x, y], lines: lines.collect() }
}
