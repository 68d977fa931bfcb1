//! GL-X5: random vertex arrays, current values, draws and uniforms, against what a vertex shader must receive
//! [GL 4.6, 7.6, 10.2 to 10.5].
//!
//! Transform feedback captures every attribute of every vertex in turn. A few calls change something between two draws:
//! pointers, buffers, divisors, vertex arrays, programs. All else stays as it was.

mod arrays;
mod blocks;
mod draws;
mod formats;
mod programs;
mod types;
mod uniforms;

use std::rc::Rc;

use self::arrays::{Array, Held, LOCATIONS};
use self::formats::{Due, Kind};
use self::programs::CapturingProgram;
use crate::conformance::bench::{Error, GlFormat};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings};

const SEQUENCES: u64 = 3;
const DRAWS: usize = 26;

/// Numbers that were compared, and the first that is wrong.
#[derive(Default)]
struct Judged {
    wrong: usize,
    count: usize,
    first: Option<String>,
}

impl Judged {
    fn add(&mut self, due: Due, seen: u32, case: impl Fn() -> String) {
        if due == Due::Any {
            return;
        }
        self.count += 1;
        if !due.holds(seen) {
            self.wrong += 1;
            let text = || format!("{}: {seen:#010x} ({}), not {due:x?}", case(), f32::from_bits(seen));
            self.first.get_or_insert_with(text);
        }
    }

    fn report(self, what: &str, findings: &mut Findings) {
        findings.none_wrong(what, self.wrong, self.count);
        if let Some(first) = self.first {
            findings.note(&first);
        }
    }
}

/// Objects and state of a sequence.
struct World {
    kinds: [Kind; LOCATIONS],
    current: [[Due; 4]; LOCATIONS],
    buffers: Vec<Rc<Held>>,
    /// For indices alone.
    indices: Vec<Rc<Held>>,
    arrays: Vec<Array>,
    bound: usize,
    programs: Vec<CapturingProgram>,
    used: usize,
    /// Signed numbers are normalised as OpenGL 4.2 has it.
    symmetric: bool,
    /// Pointers that were set.
    pointed: usize,
}

/// GL-X5.
pub fn vertices(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut attributes = Judged::default();
    // Draws whose fragments are discarded need a complete framebuffer all the same.
    let surface = subject.bench.surface([4; 2], Some(GlFormat::Rgba8), None)?;
    subject.bench.bind_surface(&surface);
    for number in 0..SEQUENCES {
        findings.part(|_| sequence(subject, number, &mut attributes));
    }
    attributes.report("attributes of captured vertices", findings);
    let (mut uniforms, mut blocks) = (Judged::default(), Judged::default());
    findings.part(|_| uniforms::uniforms(subject, &mut uniforms));
    uniforms.report("uniforms of all types", findings);
    findings.part(|_| blocks::blocks(subject, &mut blocks));
    blocks.report("uniform blocks of the std140 layout", findings);
    Ok(())
}

fn sequence(subject: &DriverUnderTest, number: u64, judged: &mut Judged) -> Result<(), Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(7100 + number);
    let mut world = World::new(subject, &mut dice, number as usize * 64)?;
    for turn in 0..DRAWS {
        for _ in 0..dice.whole(1, 3) {
            world.change(subject, &mut dice)?;
        }
        // Location 0 is always an array's, as some drivers need it.
        world.settle(subject, &mut dice)?;
        for _ in 0..5 {
            let draw = world.draw(subject, &mut dice)?;
            let program = &world.programs[world.used];
            let bytes = bench.captured(&program.capture, &draw.call, draw.vertices.len())?;
            let words: Vec<u32> =
                bytes.chunks_exact(4).map(|four| u32::from_ne_bytes([four[0], four[1], four[2], four[3]])).collect();
            let array = &world.arrays[world.bound];
            for (at, (vertex, seen)) in
                draw.vertices.iter().zip(words.chunks_exact(program.capture.bytes / 4)).enumerate()
            {
                let case = |name: &str| {
                    format!("draw {turn} of sequence {number}, vertex {at} ({vertex:?}), {name}, {:?}", draw.call)
                };
                judged.add(Due::Bits(vertex[0] as u32), seen[0], || case("gl_VertexID"));
                judged.add(Due::Bits(vertex[1] as u32), seen[1], || case("gl_InstanceID"));
                let mut place = 2;
                for input in &program.inputs {
                    for column in 0..input.columns {
                        let location = input.location + column;
                        let kind = world.kinds[location];
                        let due = array.read(location, kind, *vertex, &world.current[location], world.symmetric);
                        for due in due.into_iter().take(input.components) {
                            judged.add(due, seen[place], || {
                                let attribute = &array.attributes[location];
                                let (format, stride, offset, divisor) =
                                    (attribute.format, attribute.stride, attribute.offset, attribute.divisor);
                                let from = match attribute.enabled {
                                    true => format!("{format:?}, stride {stride}, offset {offset}, divisor {divisor}"),
                                    false => "no array".to_owned(),
                                };
                                case(&format!(
                                    "attribute {location}, {} columns of {}, {from}",
                                    input.columns, input.components
                                ))
                            });
                            place += 1;
                        }
                    }
                }
            }
        }
    }
    Ok(())
}
