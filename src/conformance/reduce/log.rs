//! Calls of GL as they were made: arguments as values of their own, names of objects by number in the order of their making.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::CStr;
use std::rc::Rc;

use super::meaning::{Kind, Meaning, data_of, meaning, pixels_of};
use super::pixels::{Layout, Scalar};
use crate::conformance::layer::call::{Call, Layer};
use crate::conformance::layer::functions;
use crate::conformance::layer::value::Value;

/// Content of memory that a call reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    pub scalar: Scalar,
    pub bytes: Vec<u8>,
}

/// An argument.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    Number(Value),
    Enum(u32),
    Bits(u32),
    /// An object by its number; 0: none.
    Object(Kind, usize),
    /// Location of a uniform, by the number of the call that asked for it; 0: there is none.
    Location(usize),
    Data(Data),
    Text(String),
    /// A place in the bound buffer.
    Offset(usize),
    /// Memory of so many bytes that the call writes.
    Out(usize),
    Null,
}

impl Argument {
    /// The number; 0 of what is none.
    pub fn number(&self) -> f64 {
        match self {
            Self::Number(value) => value.number(),
            Self::Enum(value) | Self::Bits(value) => f64::from(*value),
            Self::Object(_, number) | Self::Location(number) | Self::Offset(number) => *number as f64,
            _ => 0.0,
        }
    }
}

/// A call that was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    pub name: &'static str,
    pub arguments: Vec<Argument>,
    /// The objects that it made, or the number of the location that it asked for.
    pub made: Vec<(Kind, usize)>,
    /// Number of the read that it is.
    pub read: Option<usize>,
}

impl Recorded {
    /// An argument as an integer.
    pub fn u(&self, index: usize) -> u32 {
        self.arguments.get(index).map_or(0, |argument| argument.number() as i64 as u32)
    }

    /// An argument as a signed integer.
    pub fn i(&self, index: usize) -> i32 {
        self.u(index) as i32
    }

    /// All arguments as numbers, data as its numbers.
    pub fn numbers(&self) -> Vec<f64> {
        let numbers = self.arguments.iter().flat_map(|argument| match argument {
            Argument::Data(data) => data.scalar.numbers(&data.bytes),
            other => vec![other.number()],
        });
        numbers.collect()
    }
}

/// An answer of the driver that a rule may judge: pixels, a query's result, a status.
#[derive(Clone, Debug)]
pub struct Read {
    pub function: &'static str,
    pub layout: Layout,
    pub bytes: Vec<u8>,
}

/// Calls of a run of a rule.
#[derive(Default)]
pub struct Log {
    pub calls: Vec<Recorded>,
    pub reads: Vec<Read>,
    /// A function that cannot be noted, if one was called.
    pub unknown: Option<&'static str>,
    counts: HashMap<Kind, usize>,
    names: HashMap<(Kind, u32), usize>,
    locations: HashMap<(u32, i32), usize>,
    state: HashMap<u32, i32>,
    program: u32,
}

/// Answers that are given in place of the driver's, in order.
#[derive(Default)]
pub struct Playback {
    pub reads: Rc<Vec<Read>>,
    /// Other answers, by the read's number.
    pub changed: HashMap<usize, Vec<u8>>,
    pub next: usize,
}

/// Treatment of calls.
#[derive(Default)]
pub enum Mode {
    #[default]
    Pass,
    Record(Log),
    Play(Playback),
}

/// Functions whose work is left out while answers are given: they make nothing but pixels.
const WORK: &[&str] = &[
    "draw",
    "clear",
    "copy",
    "glDrawElementsBaseVertex",
    "glBegin",
    "glEnd",
    "glVertex4fv",
    "glBlitFramebuffer",
    "glGenerateMipmap",
    "glFinish",
];

/// Answers of the driver that are played back.
const ANSWERS: &[&str] = &[
    "glReadPixels",
    "glGetQueryObjectuiv",
    "glGetQueryObjectui64v",
    "glGetTexGendv",
    "glCheckFramebufferStatus",
    "glGetError",
];

/// Has every call noted, or answered, as `mode` says.
pub fn hook(layer: &mut Layer, mode: &Rc<RefCell<Mode>>) {
    let own = mode.clone();
    layer.hook(functions::NAMES, move |call| {
        if let Mode::Record(log) = &mut *own.borrow_mut() {
            log.record(call);
        }
    });
    let own = mode.clone();
    layer.hook(WORK, move |call| {
        if matches!(&*own.borrow(), Mode::Play(_)) {
            call.skip();
        }
    });
    let own = mode.clone();
    layer.hook(ANSWERS, move |call| {
        if let Mode::Play(playback) = &mut *own.borrow_mut() {
            playback.answer(call);
        }
    });
}

impl Playback {
    /// Answers in the driver's place; past the last answer, and where the rule now asks for another, the driver is asked.
    fn answer(&mut self, call: &mut Call) {
        let Some(read) = self.reads.get(self.next) else { return };
        let alignment = if call.name == "glReadPixels" { call.get(glow::PACK_ALIGNMENT) } else { 1 };
        if read.function != call.name || read.layout != layout_of(call, alignment.max(0) as usize) {
            return;
        }
        let bytes = self.changed.get(&self.next).unwrap_or(&read.bytes);
        self.next += 1;
        match out_index(call.name) {
            Some(index) => call.write(index, bytes),
            None => call.result = Value::Unsigned(bytes.first_chunk().map_or(0, |four| u32::from_ne_bytes(*four))),
        }
        call.skip();
    }
}

/// Index of the argument that the answer is written to; `None`: the answer is the call's result.
fn out_index(name: &str) -> Option<usize> {
    match name {
        "glReadPixels" => Some(6),
        "glGetQueryObjectuiv" | "glGetQueryObjectui64v" | "glGetTexGendv" => Some(2),
        _ => None,
    }
}

impl Log {
    /// The driver's state by glPixelStorei, as the rule has set it.
    fn stored(&self, name: u32) -> usize {
        let default = if matches!(name, glow::UNPACK_ALIGNMENT | glow::PACK_ALIGNMENT) { 4 } else { 0 };
        self.state.get(&name).copied().unwrap_or(default).max(0) as usize
    }

    /// Makes the call, and notes it.
    fn record(&mut self, call: &mut Call) {
        let Some((parameters, _)) = functions::signature(call.name) else { return };
        // A program makes few objects, and deletes none.
        if call.name == "glDeleteSamplers" {
            return;
        }
        let mut arguments = Vec::new();
        for (index, [name, kind]) in parameters.iter().enumerate() {
            arguments.push(self.argument(call, index, name, kind));
        }
        call.now();
        let mut recorded = Recorded { name: call.name, arguments, made: Vec::new(), read: None };
        match call.name {
            "glPixelStorei" => {
                self.state.insert(call.u(0), call.i(1));
            }
            "glUseProgram" => self.program = call.u(0),
            "glCreateShader" | "glCreateProgram" => {
                let kind = if call.name == "glCreateShader" { Kind::Shader } else { Kind::Program };
                recorded.made.push((kind, self.make(kind, call.result.number() as u32)));
            }
            "glGetUniformLocation" => {
                let location = call.result.number() as i32;
                if location >= 0 {
                    let number = self.make(Kind::Location, 0);
                    self.locations.insert((call.u(0), location), number);
                    recorded.made.push((Kind::Location, number));
                }
            }
            name => {
                if let Some(kind) = Kind::of_maker(name) {
                    for made in call.integers(1, call.i(0).max(0) as usize) {
                        let number = self.make(kind, made as u32);
                        recorded.made.push((kind, number));
                    }
                }
            }
        }
        if ANSWERS.contains(&call.name) {
            let layout = self.layout(call);
            let bytes = match out_index(call.name) {
                Some(index) => call.bytes(index, layout.bytes()),
                None => (call.result.number() as u32).to_ne_bytes().to_vec(),
            };
            recorded.read = Some(self.reads.len());
            self.reads.push(Read { function: call.name, layout, bytes });
        }
        self.calls.push(recorded);
    }

    fn make(&mut self, kind: Kind, name: u32) -> usize {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        self.names.insert((kind, name), *count);
        *count
    }

    fn layout(&self, call: &Call) -> Layout {
        layout_of(call, self.stored(glow::PACK_ALIGNMENT))
    }

    fn argument(&mut self, call: &Call, index: usize, name: &str, kind: &str) -> Argument {
        let value = call.arguments()[index];
        match meaning(call.name, name, kind, value) {
            Meaning::Number => Argument::Number(value),
            Meaning::Enum => Argument::Enum(call.u(index)),
            Meaning::Bits => Argument::Bits(call.u(index)),
            Meaning::Object(kind) => {
                let number = if call.u(index) == 0 { Some(&0) } else { self.names.get(&(kind, call.u(index))) };
                Argument::Object(kind, number.copied().unwrap_or(0))
            }
            Meaning::Location => {
                let number = self.locations.get(&(self.program, call.i(index)));
                Argument::Location(number.copied().unwrap_or(0))
            }
            Meaning::Offset => Argument::Offset(call.pointer(index) as usize),
            Meaning::Out if out_index(call.name) == Some(index) => Argument::Out(self.layout(call).bytes()),
            Meaning::Out => Argument::Out(64 + 4 * call.u(0) as usize),
            Meaning::Name if call.pointer(index).is_null() => Argument::Null,
            // SAFETY: the caller's string ends by a zero byte, as GL asks.
            Meaning::Name => {
                Argument::Text(unsafe { CStr::from_ptr(call.pointer(index).cast()) }.to_string_lossy().into_owned())
            }
            Meaning::Sources => Argument::Text(sources(call)),
            Meaning::Lengths => Argument::Null,
            Meaning::Data if call.pointer(index).is_null() => Argument::Null,
            Meaning::Data => {
                let unpack = [glow::UNPACK_ALIGNMENT, glow::UNPACK_ROW_LENGTH].map(|name| self.stored(name));
                match data_of(call, unpack) {
                    Some((scalar, bytes)) => Argument::Data(Data { scalar, bytes: call.bytes(index, bytes) }),
                    None => {
                        self.unknown = Some(call.name);
                        Argument::Null
                    }
                }
            }
        }
    }
}

/// Layout of a call's answer under PACK_ALIGNMENT.
fn layout_of(call: &Call, alignment: usize) -> Layout {
    match call.name {
        "glReadPixels" => {
            let size = [call.i(2), call.i(3)].map(|side| side.max(0) as usize);
            pixels_of(call.u(4), call.u(5), size, alignment, 0)
        }
        "glGetQueryObjectui64v" => Layout::values(Scalar::U64, 1),
        "glGetTexGendv" => Layout::values(Scalar::F64, 4),
        _ => Layout::values(Scalar::U32, 1),
    }
}

/// The text of glShaderSource.
fn sources(call: &Call) -> String {
    let count = call.i(1).max(0) as usize;
    let words = size_of::<usize>() / size_of::<u8>();
    let pointers = call.bytes(2, count * words);
    let lengths = call.integers(3, count);
    let pointers = pointers
        .chunks_exact(words)
        .map(|word| usize::from_ne_bytes(word.try_into().unwrap_or_default()) as *const std::ffi::c_char);
    let mut text = String::new();
    for (index, pointer) in pointers.enumerate().filter(|(_, pointer)| !pointer.is_null()) {
        let length = lengths.get(index).copied().filter(|length| *length >= 0);
        // SAFETY: the caller gives so many characters, or a string that ends by a zero byte.
        let bytes = unsafe {
            match length {
                Some(length) => std::slice::from_raw_parts(pointer.cast::<u8>(), length as usize),
                None => CStr::from_ptr(pointer).to_bytes(),
            }
        };
        text += &String::from_utf8_lossy(bytes);
    }
    text
}
