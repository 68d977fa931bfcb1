//! Programs that put their attributes out as they are.

use std::fmt::Write;

use super::arrays::LOCATIONS;
use super::formats::Kind;
use crate::conformance::bench::{Bench, Error, GlCapture};
use crate::conformance::random::Random;

/// An attribute of a program.
#[derive(Clone, Copy, Debug)]
pub struct Input {
    pub location: usize,
    /// More than one: a matrix.
    pub columns: usize,
    pub components: usize,
}

pub struct CapturingProgram {
    pub capture: GlCapture,
    pub inputs: Vec<Input>,
}

/// Numbers that are captured of a vertex, at most; what every driver can do.
const MOST: usize = 64;

impl CapturingProgram {
    /// A program of the locations but for a share that is left out, in any order.
    pub fn new(bench: &Bench, dice: &mut Random, kinds: &[Kind; LOCATIONS], left_out: f32) -> Result<Self, Error> {
        let mut inputs = Vec::new();
        let (mut location, mut numbers) = (0, 2);
        while location < LOCATIONS {
            let input = input(dice, kinds, location);
            location += input.columns;
            let is_left_out = input.location > 0 && dice.chance(left_out);
            if is_left_out || numbers + input.columns * input.components > MOST {
                continue;
            }
            numbers += input.columns * input.components;
            inputs.push(input);
        }
        // Declared, and put out, in another order than that of the locations.
        for index in (1..inputs.len()).rev() {
            inputs.swap(index, dice.below(index + 1));
        }
        let mut text = String::from("#version 330\nflat out int vertex;\nflat out int instance;\n");
        let mut body = String::from("vertex = gl_VertexID;\ninstance = gl_InstanceID;\n");
        let mut names = vec!["vertex".to_owned(), "instance".to_owned()];
        for Input { location, columns, components } in &inputs {
            let kind = match (kinds[*location], columns, components) {
                (Kind::Float, 1, 1) => "float".to_owned(),
                (Kind::Float, 1, count) => format!("vec{count}"),
                (Kind::Float, ..) => format!("mat{columns}x{components}"),
                (Kind::Signed, _, 1) => "int".to_owned(),
                (Kind::Signed, _, count) => format!("ivec{count}"),
                (Kind::Unsigned, _, 1) => "uint".to_owned(),
                (Kind::Unsigned, _, count) => format!("uvec{count}"),
            };
            let flat = if kinds[*location] == Kind::Float { "" } else { "flat " };
            let _ =
                writeln!(text, "layout(location = {location}) in {kind} a{location};\n{flat}out {kind} o{location};");
            let _ = writeln!(body, "o{location} = a{location};");
            names.push(format!("o{location}"));
        }
        let text = format!("{text}void main() {{\n{body}gl_Position = vec4(0.0);\n}}\n");
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Ok(Self { capture: bench.capture(&text, &names, 4 * numbers)?, inputs })
    }
}

/// An attribute at a location: a matrix where the next ones are floats too.
fn input(dice: &mut Random, kinds: &[Kind; LOCATIONS], location: usize) -> Input {
    let columns = dice.whole(2, 4) as usize;
    let floats = kinds.iter().skip(location).take(columns).filter(|kind| **kind == Kind::Float).count();
    let is_matrix = floats == columns && dice.chance(0.2);
    let components = if is_matrix { dice.whole(2, 4) as usize } else { dice.pick(&[1, 2, 3, 3, 4, 4, 4]) };
    Input { location, columns: if is_matrix { columns } else { 1 }, components }
}
