//! Uniform blocks of the std140 layout, from ranges of buffers [GL 4.6, 7.6.2.2, 7.6.3].

use std::fmt::Write;
use std::rc::Rc;

use super::Judged;
use super::arrays::Held;
use super::types::{Base, DataType, word};
use super::uniforms::{capture, judge};
use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlCapture};
use crate::conformance::random::Random;

const MOST: usize = 60;
const BYTES: usize = 16_384;
const BUFFERS: usize = 3;
const PROGRAMS: usize = 3;
const TURNS: usize = 150;
/// Binding points that are used.
const BINDINGS: usize = 4;

/// A component that is put out, and its place in the block.
struct Leaf {
    offset: usize,
    is_bool: bool,
}

/// A block under construction: rules 1 to 10 of the layout.
#[derive(Default)]
struct Layout {
    at: usize,
    /// The greatest alignment of its members.
    most: usize,
}

impl Layout {
    fn align(&mut self, alignment: usize) {
        self.at = self.at.next_multiple_of(alignment);
        self.most = self.most.max(alignment);
    }

    /// Places a member; offsets of its components by elements, columns and rows.
    fn member(&mut self, of: DataType, length: Option<usize>, row_major: bool) -> Vec<usize> {
        let alignment = |count: usize| 4 * [1_usize, 2, 4, 4][count - 1];
        // A matrix is an array of columns, or of rows.
        let (vectors, components) = match (of.columns, row_major) {
            (1, _) => (1, of.rows),
            (columns, false) => (columns, of.rows),
            (columns, true) => (of.rows, columns),
        };
        let is_array = length.is_some() || of.columns > 1;
        let stride = if is_array { alignment(components).next_multiple_of(16) } else { 4 * components };
        self.align(if is_array { stride } else { alignment(components) });
        let mut offsets = Vec::new();
        for element in 0..length.unwrap_or(1) {
            for column in 0..of.columns {
                for row in 0..of.rows {
                    let (vector, place) = if row_major && of.columns > 1 { (row, column) } else { (column, row) };
                    offsets.push(self.at + (element * vectors + vector) * stride + 4 * place);
                }
            }
        }
        self.at += length.unwrap_or(1) * vectors * stride;
        offsets
    }
}

struct CapturingProgram {
    capture: GlCapture,
    leaves: Vec<Leaf>,
    bytes: usize,
    binding: usize,
}

/// A random member: its type, length, matrix order and declaration; the order is that of the whole structure, if it is in one.
fn member(dice: &mut Random, name: &str, order: Option<bool>) -> (DataType, Option<usize>, bool, String) {
    let of = DataType::any(dice);
    let length = dice.chance(0.3).then(|| dice.whole(1, 3) as usize);
    let row_major = order.unwrap_or(of.columns > 1 && dice.chance(0.4));
    let after = length.map_or(String::new(), |length| format!("[{length}]"));
    let order = if row_major && order.is_none() { "layout(row_major) " } else { "" };
    (of, length, row_major, format!("{order}{} {name}{after};", of.name()))
}

impl CapturingProgram {
    fn new(subject: &DriverUnderTest, dice: &mut Random) -> Result<Self, Error> {
        let (mut structs, mut block) = (String::new(), String::new());
        let (mut words, mut leaves, mut layout) = (Vec::new(), Vec::new(), Layout::default());
        let mut show = |path: &str, of: DataType, length: Option<usize>, offsets: Vec<usize>| {
            let mut expressions = Vec::new();
            for element in 0..length.unwrap_or(1) {
                let place = length.map_or(path.to_owned(), |_| format!("{path}[{element}]"));
                expressions.extend(of.words(&place));
            }
            for (expression, offset) in expressions.into_iter().zip(offsets) {
                if words.len() < MOST {
                    words.push(expression);
                    leaves.push(Leaf { offset, is_bool: of.base == Base::Bool });
                }
            }
        };
        for number in 0..dice.whole(4, 9) {
            let name = format!("m{number}");
            if dice.chance(0.25) {
                // A structure, or an array of two.
                let row_major = dice.chance(0.4);
                let members = [0, 1, 2].map(|index| member(dice, &format!("p{index}"), Some(row_major)));
                let declared: Vec<&str> = members.iter().map(|(.., text)| text.as_str()).collect();
                let _ = writeln!(structs, "struct T{number} {{ {} }};", declared.join(" "));
                let copies = dice.whole(1, 2) as usize;
                let order = if row_major { "layout(row_major) " } else { "" };
                let _ = writeln!(block, "{order}T{number} {name}{};", if copies > 1 { "[2]" } else { "" });
                let mut inner = Layout::default();
                let places: Vec<_> =
                    members.iter().map(|(of, length, row_major, _)| inner.member(*of, *length, *row_major)).collect();
                let alignment = inner.most.next_multiple_of(16);
                let size = inner.at.next_multiple_of(alignment);
                layout.align(alignment);
                for copy in 0..copies {
                    let path = if copies > 1 { format!("{name}[{copy}]") } else { name.clone() };
                    for (index, ((of, length, ..), offsets)) in members.iter().zip(&places).enumerate() {
                        let offsets = offsets.iter().map(|offset| layout.at + copy * size + offset).collect();
                        show(&format!("{path}.p{index}"), *of, *length, offsets);
                    }
                }
                layout.at += copies * size;
            } else {
                let (of, length, row_major, declared) = member(dice, &name, None);
                let _ = writeln!(block, "{declared}");
                let offsets = layout.member(of, length, row_major);
                show(&name, of, length, offsets);
            }
        }
        let declared = format!("{structs}layout(std140) uniform Block {{\n{block}}};\n");
        let capture = capture(subject, &declared, &words)?;
        Ok(Self { capture, leaves, bytes: layout.at.next_multiple_of(16), binding: 0 })
    }
}

/// A range that is bound: a buffer, and where it begins.
type Bound = (Rc<Held>, usize);

/// Buffers that are written, bound in part and made anew, and programs that read them.
pub fn blocks(subject: &DriverUnderTest, judged: &mut Judged) -> Result<(), Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(7400);
    let alignment = bench.block_alignment();
    let mut buffers = (0..BUFFERS).map(|_| held(subject, &mut dice)).collect::<Result<Vec<_>, _>>()?;
    let mut programs =
        (0..PROGRAMS).map(|_| CapturingProgram::new(subject, &mut dice)).collect::<Result<Vec<_>, _>>()?;
    let mut bound: [Option<Bound>; BINDINGS] = [const { None }; BINDINGS];
    let array = bench.feed_array()?;
    bench.bind_feed(&array);
    for turn in 0..TURNS {
        let which = dice.below(PROGRAMS);
        match dice.below(10) {
            0..=3 => {
                let count = dice.whole(1, 200) as usize;
                let at = 4 * dice.below(BYTES / 4 - count);
                let bytes: Vec<u8> = (0..count).flat_map(|_| word(&mut dice).to_ne_bytes()).collect();
                buffers[dice.below(BUFFERS)].write(bench, &mut dice, at, &bytes)?;
            }
            4 | 5 => {
                let binding = dice.below(BINDINGS);
                bound[binding] = None;
            }
            6 | 7 => {
                programs[which].binding = dice.below(BINDINGS);
                bench.bind_block(&programs[which].capture, "Block", programs[which].binding as u32);
            }
            8 if dice.chance(0.3) => {
                let slot = dice.below(BUFFERS);
                let old = buffers[slot].clone();
                // What is bound is not read after that.
                for place in &mut bound {
                    *place = place.take().filter(|(held, _)| !Rc::ptr_eq(held, &old));
                }
                old.name.borrow_mut().take();
                buffers[slot] = held(subject, &mut dice)?;
            }
            8 if dice.chance(0.2) => programs[which] = CapturingProgram::new(subject, &mut dice)?,
            _ => {}
        }
        let program = &programs[which];
        let is_bound = bound[program.binding].is_some();
        if !is_bound {
            let held = buffers[dice.below(BUFFERS)].clone();
            // As much as any program of these reads.
            let bytes = programs.iter().map(|program| program.bytes).max().unwrap_or(0).max(4096);
            let offset = alignment * dice.below((BYTES - bytes) / alignment + 1);
            if let Some(name) = &*held.name.borrow() {
                bench.block_feed(program.binding as u32, name, offset, bytes);
            }
            bound[program.binding] = Some((held.clone(), offset));
        }
        let Some((held, offset)) = &bound[program.binding] else { continue };
        let due: Vec<u32> = {
            let bytes = held.bytes.borrow();
            let words = program.leaves.iter().map(|leaf| {
                let at = offset + leaf.offset;
                let word = u32::from_ne_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
                if leaf.is_bool { u32::from(word != 0) } else { word }
            });
            words.collect()
        };
        judge(subject, &program.capture, &due, judged, |index| {
            let place = program.leaves[index].offset;
            format!("turn {turn}, program {which}, byte {place} of its block at {offset}")
        })?;
    }
    Ok(())
}

/// A buffer of ordinary floats.
fn held(subject: &DriverUnderTest, dice: &mut Random) -> Result<Rc<Held>, Error> {
    let held = Held::new(&subject.bench, dice, BYTES)?;
    let bytes: Vec<u8> = (0..BYTES / 4).flat_map(|_| word(dice).to_ne_bytes()).collect();
    held.write(&subject.bench, dice, 0, &bytes)?;
    Ok(held)
}
