//! Vertex arrays, buffers and current values as the model keeps them.

use std::cell::RefCell;
use std::rc::Rc;

use super::formats::{Due, Format, Kind};
use crate::conformance::bench::{Bench, Error, GlArray, GlBuffer, GlCurrent, GlPointer, GlWrite};
use crate::conformance::random::Random;

/// Attributes.
pub const LOCATIONS: usize = 16;
/// Vertices that every array has.
pub const VERTICES: usize = 300;

/// A buffer and what it holds. A vertex array keeps a buffer that is deleted while another is bound.
pub struct Held {
    pub name: RefCell<Option<GlBuffer>>,
    pub bytes: RefCell<Vec<u8>>,
}

impl Held {
    pub fn new(bench: &Bench, dice: &mut Random, bytes: usize) -> Result<Rc<Self>, Error> {
        let bytes: Vec<u8> = (0..bytes).map(|_| dice.below(256) as u8).collect();
        let usage = dice.pick(&[glow::STATIC_DRAW, glow::DYNAMIC_DRAW, glow::STREAM_DRAW]);
        let name = RefCell::new(Some(bench.feed_buffer(&bytes, usage)?));
        Ok(Rc::new(Self { name, bytes: RefCell::new(bytes) }))
    }

    /// Writes bytes into the buffer by any of the ways.
    pub fn write(&self, bench: &Bench, dice: &mut Random, at: usize, bytes: &[u8]) -> Result<(), Error> {
        let mut whole = self.bytes.borrow_mut();
        whole[at..at + bytes.len()].copy_from_slice(bytes);
        let how = dice.pick(&[
            GlWrite::SubData,
            GlWrite::SubData,
            GlWrite::Map(false),
            GlWrite::Map(true),
            GlWrite::MapAndFlush,
            GlWrite::Orphan,
        ]);
        match &*self.name.borrow() {
            Some(name) => bench.write_feed(name, &whole, at..at + bytes.len(), how),
            None => Ok(()),
        }
    }
}

/// One attribute of a vertex array.
#[derive(Clone)]
pub struct Attribute {
    pub enabled: bool,
    pub buffer: Option<Rc<Held>>,
    pub format: Format,
    pub stride: usize,
    pub offset: usize,
    pub divisor: u32,
}

/// A vertex array.
pub struct Array {
    pub name: GlArray,
    pub attributes: Vec<Attribute>,
    pub indices: Option<Rc<Held>>,
}

impl Array {
    pub fn new(bench: &Bench) -> Result<Self, Error> {
        let none = Attribute {
            enabled: false,
            buffer: None,
            format: Format { kind: glow::FLOAT, size: 4, normalized: false },
            stride: 16,
            offset: 0,
            divisor: 0,
        };
        Ok(Self { name: bench.feed_array()?, attributes: vec![none; LOCATIONS], indices: None })
    }

    /// Points an attribute of this vertex array, which is bound, to new numbers in a buffer.
    pub fn point(
        &mut self,
        bench: &Bench,
        dice: &mut Random,
        (location, kind, format): (usize, Kind, Format),
        buffer: &Rc<Held>,
    ) -> Result<(), Error> {
        let stride = match dice.below(6) {
            0 => 0,
            1 => format.bytes() + dice.below(9),
            2 => dice.pick(&[32, 48, 64, 100, 128]),
            3 => dice.whole(65, 220) as usize,
            4 => dice.whole(220, 340) as usize,
            _ => format.bytes(),
        }
        .max(if dice.chance(0.2) { 0 } else { format.bytes() });
        let step = if stride == 0 { format.bytes() } else { stride };
        let room = buffer.bytes.borrow().len() - (step * (VERTICES - 1) + format.bytes());
        let offset = match dice.below(3) {
            0 => 0,
            1 => dice.below(room.min(64)),
            _ => dice.below(room),
        };
        let attribute = &mut self.attributes[location];
        *attribute = Attribute { buffer: Some(buffer.clone()), format, stride: step, offset, ..attribute.clone() };
        // Numbers of ordinary sizes, all written at once.
        let mut bytes = buffer.bytes.borrow()[offset..offset + step * (VERTICES - 1) + format.bytes()].to_vec();
        for vertex in 0..VERTICES {
            let sample = format.sample(dice);
            bytes[vertex * step..vertex * step + sample.len()].copy_from_slice(&sample);
        }
        buffer.write(bench, dice, offset, &bytes)?;
        if let Some(name) = &*buffer.name.borrow() {
            let Format { kind: code, size, normalized } = format;
            let (location, stride, offset) = (location as u32, stride as u32, offset as u32);
            let integer = kind != Kind::Float;
            bench.point_feed(name, GlPointer { location, size, kind: code, normalized, integer, stride, offset });
        }
        Ok(())
    }

    /// Value of an attribute for a vertex of an instance.
    pub fn read(
        &self,
        location: usize,
        kind: Kind,
        [vertex, instance, first]: [usize; 3],
        current: &[Due; 4],
        symmetric: bool,
    ) -> [Due; 4] {
        let Attribute { enabled, buffer, format, stride, offset, divisor } = &self.attributes[location];
        let Some(buffer) = buffer.as_ref().filter(|_| *enabled) else { return *current };
        let element = match *divisor {
            0 => vertex,
            divisor => instance / divisor as usize + first,
        };
        let at = offset + element * stride;
        format.read(&buffer.bytes.borrow()[at..at + format.bytes()], kind, symmetric)
    }

    /// Forgets a buffer that is deleted while this vertex array is bound.
    pub fn forget(&mut self, buffer: &Rc<Held>) {
        for attribute in &mut self.attributes {
            attribute.buffer = attribute.buffer.take().filter(|held| !Rc::ptr_eq(held, buffer));
        }
        self.indices = self.indices.take().filter(|held| !Rc::ptr_eq(held, buffer));
    }
}

/// A new current value, and what a shader gets of it.
pub fn current(dice: &mut Random, kind: Kind) -> (GlCurrent, [Due; 4]) {
    let mut word = || (dice.below(1 << 16) as u32) << 16 | dice.below(1 << 16) as u32;
    let words = [(); 4].map(|()| word());
    match kind {
        Kind::Signed => (GlCurrent::Signed(words.map(|word| word as i32)), words.map(Due::Bits)),
        Kind::Unsigned => (GlCurrent::Unsigned(words), words.map(Due::Bits)),
        Kind::Float => {
            let floats = [(); 4].map(|()| dice.between(-9.0, 9.0));
            let count = dice.whole(1, 4) as u32;
            let full = [0, 1, 2, 3].map(|index: usize| {
                Due::float(if index < count as usize { floats[index] } else { [0.0, 0.0, 0.0, 1.0][index] })
            });
            (GlCurrent::Floats(floats, count), full)
        }
    }
}
