//! Uniforms of every type, set one at a time, over several programs with the same names [GL 4.6, 7.6.1].

use std::fmt::Write;

use super::types::{Base, DataType, word};
use super::{Due, Judged};
use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlCapture, GlCaptured, GlPrimitive, GlRange, GlValues};
use crate::conformance::random::Random;

/// Numbers that a program puts out, at most.
const MOST: usize = 60;
const PROGRAMS: usize = 7;
const TURNS: usize = 500;

/// A uniform, or a member of one.
struct Uniform {
    /// Name as GL and GLSL have it, without an element.
    path: String,
    of: DataType,
    /// `None`: no array.
    length: Option<usize>,
    /// Bits of all elements' components.
    words: Vec<u32>,
}

struct CapturingProgram {
    capture: GlCapture,
    uniforms: Vec<Uniform>,
}

/// Draws one vertex, whatever the state.
pub const ONE: GlCaptured = GlCaptured {
    primitive: GlPrimitive::Points,
    range: GlRange::Arrays(0),
    count: 1,
    instances: None,
    first_instance: 0,
};

/// A program that puts words out.
pub fn capture(subject: &DriverUnderTest, declared: &str, words: &[String]) -> Result<GlCapture, Error> {
    let mut text = format!("#version 330\n{declared}");
    let mut body = String::new();
    let names: Vec<String> = (0..words.len()).map(|index| format!("o{index}")).collect();
    for (name, word) in names.iter().zip(words) {
        let _ = writeln!(text, "flat out uint {name};");
        let _ = writeln!(body, "{name} = {word};");
    }
    text += &format!("void main() {{\n{body}gl_Position = vec4(0.0);\n}}\n");
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    subject.bench.capture(&text, &names, 4 * words.len())
}

/// Compares the words of one vertex.
pub fn judge(
    subject: &DriverUnderTest,
    capture: &GlCapture,
    due: &[u32],
    judged: &mut Judged,
    case: impl Fn(usize) -> String,
) -> Result<(), Error> {
    let bytes = subject.bench.captured(capture, &ONE, 1)?;
    for (index, (seen, due)) in bytes.chunks_exact(4).zip(due).enumerate() {
        let seen = u32::from_ne_bytes([seen[0], seen[1], seen[2], seen[3]]);
        judged.add(Due::Bits(*due), seen, || case(index));
    }
    Ok(())
}

impl CapturingProgram {
    fn new(subject: &DriverUnderTest, dice: &mut Random) -> Result<Self, Error> {
        let (mut declared, mut words, mut uniforms) = (String::new(), Vec::new(), Vec::new());
        for number in 0..40 {
            let of = DataType::any(dice);
            let length = dice.chance(0.4).then(|| dice.whole(1, 5) as usize);
            let in_struct = dice.chance(0.2);
            let copies = if in_struct && dice.chance(0.5) { 2 } else { 1 };
            if words.len() + copies * length.unwrap_or(1) * of.numbers() > MOST {
                continue;
            }
            let after = length.map_or(String::new(), |length| format!("[{length}]"));
            let paths = match (in_struct, copies) {
                (false, _) => {
                    let _ = writeln!(declared, "uniform {} u{number}{after};", of.name());
                    vec![format!("u{number}")]
                }
                (true, copies) => {
                    let array = if copies > 1 { "[2]" } else { "" };
                    let _ = writeln!(declared, "struct S{number} {{ float a; {} b{after}; vec2 c; }};", of.name());
                    let _ = writeln!(declared, "uniform S{number} u{number}{array};");
                    match copies {
                        1 => vec![format!("u{number}.b")],
                        _ => vec![format!("u{number}[0].b"), format!("u{number}[1].b")],
                    }
                }
            };
            for path in paths {
                let elements = (0..length.unwrap_or(1)).map(|element| match length {
                    Some(_) => format!("{path}[{element}]"),
                    None => path.clone(),
                });
                words.extend(elements.flat_map(|element| of.words(&element)));
                let count = length.unwrap_or(1) * of.numbers();
                uniforms.push(Uniform { path, of, length, words: vec![0; count] });
            }
        }
        Ok(Self { capture: capture(subject, &declared, &words)?, uniforms })
    }

    fn due(&self) -> Vec<u32> {
        self.uniforms.iter().flat_map(|uniform| uniform.words.iter().copied()).collect()
    }

    /// Sets some elements of one uniform; what was called.
    fn set(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<String, Error> {
        let index = dice.below(self.uniforms.len());
        let Uniform { path, of, length, words } = &mut self.uniforms[index];
        let whole = length.unwrap_or(1);
        let first = if dice.chance(0.6) { 0 } else { dice.below(whole) };
        // Elements behind the end are ignored.
        let count = match length {
            Some(_) => dice.whole(1, (whole - first) as i32) as usize + usize::from(dice.chance(0.1)),
            None => 1,
        };
        let name = match length {
            Some(_) if first > 0 || dice.chance(0.5) => format!("{path}[{first}]"),
            _ => path.clone(),
        };
        let new: Vec<u32> = (0..count * of.numbers()).map(|_| word(dice)).collect();
        let rows = of.rows as u32;
        let (mut by_rows, mut kept) = (false, new.clone());
        let values = match of.base {
            Base::Float if of.columns > 1 => {
                by_rows = dice.chance(0.5);
                let mut list = new.clone();
                if by_rows {
                    let size = of.numbers();
                    for (at, word) in new.iter().enumerate() {
                        let (element, place) = (at / size, at % size);
                        let (column, row) = (place / of.rows, place % of.rows);
                        list[element * size + row * of.columns + column] = *word;
                    }
                }
                let list = list.into_iter().map(f32::from_bits).collect();
                GlValues::Matrices([of.columns as u32, rows], by_rows, list)
            }
            Base::Float => GlValues::Floats(rows, new.iter().map(|word| f32::from_bits(*word)).collect()),
            Base::Signed => GlValues::Signed(rows, new.iter().map(|word| *word as i32).collect()),
            Base::Unsigned => GlValues::Unsigned(rows, new),
            Base::Bool => {
                // Of any type: what is not 0 is true.
                let floats: Vec<f32> = new.iter().map(|word| f32::from_bits(*word)).collect();
                kept = floats.iter().map(|number| u32::from(*number != 0.0)).collect();
                match dice.below(3) {
                    0 => GlValues::Floats(rows, floats),
                    1 => {
                        kept = new.iter().map(|word| u32::from(*word != 0)).collect();
                        GlValues::Signed(rows, new.iter().map(|word| *word as i32).collect())
                    }
                    _ => {
                        kept = new.iter().map(|word| u32::from(*word != 0)).collect();
                        GlValues::Unsigned(rows, new)
                    }
                }
            }
        };
        let at = first * of.numbers();
        let end = words.len().min(at + kept.len());
        words[at..end].copy_from_slice(&kept[..end - at]);
        let single = count == 1 && dice.chance(0.5);
        let turned = if by_rows { " by rows" } else { "" };
        let called = format!("{name}, {count} of {}{turned}", of.name());
        subject.bench.set_values(&self.capture, &name, &values, single)?;
        Ok(called)
    }
}

/// Programs whose uniforms are set and drawn in any order, linked again, deleted and made anew.
pub fn uniforms(subject: &DriverUnderTest, judged: &mut Judged) -> Result<(), Error> {
    let mut dice = Random::new(7300);
    let mut programs =
        (0..PROGRAMS).map(|_| CapturingProgram::new(subject, &mut dice)).collect::<Result<Vec<_>, _>>()?;
    let array = subject.bench.feed_array()?;
    subject.bench.bind_feed(&array);
    let mut last = String::new();
    for turn in 0..TURNS {
        let which = dice.below(PROGRAMS);
        match dice.below(60) {
            0 => {
                subject.bench.link_again(&programs[which].capture)?;
                programs[which].uniforms.iter_mut().for_each(|uniform| uniform.words.fill(0));
                last = format!("program {which} linked again");
            }
            1 => {
                programs[which] = CapturingProgram::new(subject, &mut dice)?;
                last = format!("program {which} made anew");
            }
            _ => {
                for _ in 0..dice.whole(1, 5) {
                    last = format!("program {which}: {}", programs[which].set(subject, &mut dice)?);
                }
            }
        }
        let shown = if dice.chance(0.7) { which } else { dice.below(PROGRAMS) };
        let program = &programs[shown];
        judge(subject, &program.capture, &program.due(), judged, |index| {
            let mut before = 0;
            let names = program.uniforms.iter().map(|uniform| {
                before += uniform.words.len();
                (before, &uniform.path)
            });
            let name = names.into_iter().find(|(end, _)| *end > index).map_or("", |(_, path)| path);
            format!("turn {turn}, word {index} of program {shown}, in {name}, after {last}")
        })?;
    }
    Ok(())
}
