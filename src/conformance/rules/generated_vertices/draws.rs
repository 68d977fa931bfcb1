//! Changes between draws, and draws of any kind.

use std::rc::Rc;

use super::World;
use super::arrays::{Array, Held, LOCATIONS, VERTICES, current};
use super::formats::{Due, Format, Kind};
use super::programs::CapturingProgram;
use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlCaptured, GlPrimitive, GlRange};
use crate::conformance::random::Random;

/// Bytes of the buffers: every array fits.
const BYTES: usize = 110_000;
/// Bytes of the buffers of indices: a small one, and one with places that 16 bits do not count.
const INDEX_BYTES: [usize; 2] = [4000, 200_000];
const KINDS: [Kind; 6] = [Kind::Float, Kind::Float, Kind::Float, Kind::Float, Kind::Signed, Kind::Unsigned];

/// A draw, and what its vertices are: number, instance and first instance of each.
pub struct Draw {
    pub call: GlCaptured,
    pub vertices: Vec<[usize; 3]>,
}

impl World {
    pub fn new(subject: &DriverUnderTest, dice: &mut Random, pointed: usize) -> Result<Self, Error> {
        let bench = &subject.bench;
        let mut kinds = [Kind::Float; LOCATIONS];
        kinds.iter_mut().skip(1).for_each(|kind| *kind = dice.pick(&KINDS));
        let mut held =
            |sizes: &[usize]| sizes.iter().map(|bytes| Held::new(bench, dice, *bytes)).collect::<Result<Vec<_>, _>>();
        let (buffers, indices) = (held(&[BYTES; 4])?, held(&INDEX_BYTES)?);
        let arrays = (0..3).map(|_| Array::new(bench)).collect::<Result<Vec<_>, _>>()?;
        let programs = [0.0, 0.5, 0.6]
            .map(|left_out| CapturingProgram::new(bench, dice, &kinds, left_out))
            .into_iter()
            .collect::<Result<Vec<_>, _>>()?;
        let symmetric = bench.has((4, 2), "");
        let current = [[Due::Any; 4]; LOCATIONS];
        let mut world =
            Self { kinds, current, buffers, indices, arrays, bound: 0, programs, used: 0, symmetric, pointed };
        for location in 0..LOCATIONS {
            world.set_current(subject, dice, location);
        }
        for array in (0..world.arrays.len()).rev() {
            world.bind(subject, array);
            for location in 0..LOCATIONS {
                world.point(subject, dice, location)?;
                let on = location == 0 || dice.chance(0.8);
                world.enable(subject, location, on);
                if location > 0 && dice.chance(0.35) {
                    world.divide(subject, dice, location);
                }
            }
        }
        Ok(world)
    }

    fn bind(&mut self, subject: &DriverUnderTest, array: usize) {
        self.bound = array;
        subject.bench.bind_feed(&self.arrays[array].name);
    }

    fn set_current(&mut self, subject: &DriverUnderTest, dice: &mut Random, location: usize) {
        let (value, due) = current(dice, self.kinds[location]);
        self.current[location] = due;
        subject.bench.current_feed(location as u32, value);
    }

    fn point(&mut self, subject: &DriverUnderTest, dice: &mut Random, location: usize) -> Result<(), Error> {
        let buffer = self.buffers[dice.below(self.buffers.len())].clone();
        self.pointed += 1;
        let kind = self.kinds[location];
        let format = Format::dealt(self.pointed, kind);
        self.arrays[self.bound].point(&subject.bench, dice, (location, kind, format), &buffer)
    }

    fn enable(&mut self, subject: &DriverUnderTest, location: usize, on: bool) {
        self.arrays[self.bound].attributes[location].enabled = on;
        subject.bench.enable_feed(location as u32, on);
    }

    /// Gives an attribute another divisor. One vertex array has none that is small, and so many instances.
    fn divide(&mut self, subject: &DriverUnderTest, dice: &mut Random, location: usize) {
        let divisors = if self.bound == 2 { [0, 0, 7, 30, 65, 100] } else { [0, 0, 1, 1, 2, 3] };
        let divisor = dice.pick(&divisors);
        self.arrays[self.bound].attributes[location].divisor = divisor;
        subject.bench.divide_feed(location as u32, divisor);
    }

    /// Changes one thing.
    pub fn change(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<(), Error> {
        let location = dice.below(LOCATIONS);
        match dice.below(18) {
            0..=1 | 14..=15 => {
                for _ in 0..dice.whole(1, 5) {
                    let location = dice.below(LOCATIONS);
                    self.point(subject, dice, location)?;
                }
            }
            2 if location > 0 => {
                let on = !self.arrays[self.bound].attributes[location].enabled;
                self.enable(subject, location, on);
            }
            3 | 4 => self.set_current(subject, dice, location),
            5 | 6 if location > 0 => {
                self.divide(subject, dice, location);
            }
            7 | 8 => {
                let buffer = self.buffers[dice.below(self.buffers.len())].clone();
                let at = dice.below(BYTES - 900);
                let bytes: Vec<u8> = (0..dice.whole(1, 900)).map(|_| dice.below(256) as u8).collect();
                buffer.write(&subject.bench, dice, at, &bytes)?;
            }
            9 => self.copy(subject, dice)?,
            10 => self.make_anew(subject, dice)?,
            11..=13 => {
                let array = dice.below(self.arrays.len());
                self.bind(subject, array);
            }
            _ => self.used = dice.below(self.programs.len()),
        }
        Ok(())
    }

    fn copy(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<(), Error> {
        let from = dice.below(self.buffers.len());
        let to = (from + 1 + dice.below(self.buffers.len() - 1)) % self.buffers.len();
        let (from, to) = (self.buffers[from].clone(), self.buffers[to].clone());
        let bytes = dice.whole(1, 5000) as usize;
        let [read, write] = [(); 2].map(|()| dice.below(BYTES - bytes));
        let (Some(source), Some(target)) = (&*from.name.borrow(), &*to.name.borrow()) else { return Ok(()) };
        let part = from.bytes.borrow()[read..read + bytes].to_vec();
        to.bytes.borrow_mut()[write..write + bytes].copy_from_slice(&part);
        subject.bench.copy_feed(source, target, [read, write], bytes)
    }

    /// Deletes a buffer and makes another. The bound vertex array loses it; others keep it.
    fn make_anew(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<(), Error> {
        let slot = dice.below(self.buffers.len());
        let old = self.buffers[slot].clone();
        old.name.borrow_mut().take();
        self.arrays[self.bound].forget(&old);
        self.buffers[slot] = Held::new(&subject.bench, dice, BYTES)?;
        Ok(())
    }

    /// Gives arrays that have lost their buffer another.
    pub fn settle(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<(), Error> {
        for location in 0..LOCATIONS {
            let attribute = &self.arrays[self.bound].attributes[location];
            if !attribute.enabled || attribute.buffer.is_some() {
                continue;
            }
            if location > 0 && dice.chance(0.5) {
                self.enable(subject, location, false);
            } else {
                self.point(subject, dice, location)?;
            }
        }
        Ok(())
    }

    /// A draw of few vertices, or of few vertices of many instances.
    pub fn draw(&mut self, subject: &DriverUnderTest, dice: &mut Random) -> Result<Draw, Error> {
        let primitive = dice.pick(&[
            GlPrimitive::Points,
            GlPrimitive::Points,
            GlPrimitive::Lines,
            GlPrimitive::LineStrip,
            GlPrimitive::LineLoop,
            GlPrimitive::Triangles,
        ]);
        let is_many = self.bound == 2 && dice.chance(0.4);
        let count = if is_many { dice.pick(&[1, 3]) } else { dice.pick(&[1, 3, 7, 12, 30, 40]) };
        let divisors = self.arrays[self.bound].attributes.iter().filter(|attribute| attribute.enabled);
        let least = divisors.map(|attribute| attribute.divisor).filter(|divisor| *divisor > 0).min();
        let first_instance = match subject.bench.has((4, 2), "GL_ARB_base_instance") && dice.chance(0.3) {
            true => dice.below(20),
            false => 0,
        };
        // No array ends before the last instance.
        let most: usize = least.map_or(usize::MAX, |divisor| (VERTICES - first_instance) * divisor as usize);
        let instances = match dice.below(4) {
            _ if is_many => Some(dice.whole(250, 900 / count as i32) as usize),
            0 | 1 => None,
            2 => Some(dice.whole(1, 5) as usize),
            _ => Some(dice.pick(&[20, 90, 400, 900]).min(1200 / count)),
        };
        let instances = instances.map(|number: usize| number.min(most));
        let first_instance = if instances.is_some() { first_instance } else { 0 };
        let (range, order) = self.range(subject, dice, count)?;
        let mut vertices = Vec::new();
        for instance in 0..instances.unwrap_or(1) {
            vertices.extend(assembled(primitive, &order).into_iter().map(|vertex| [vertex, instance, first_instance]));
        }
        let call = GlCaptured {
            primitive,
            range,
            count: count as u32,
            instances: instances.map(|number| number as u32),
            first_instance: first_instance as u32,
        };
        Ok(Draw { call, vertices })
    }

    /// Vertices in turn, or by indices, which are written into one of the index buffers.
    fn range(
        &mut self,
        subject: &DriverUnderTest,
        dice: &mut Random,
        count: usize,
    ) -> Result<(GlRange, Vec<usize>), Error> {
        if dice.chance(0.4) {
            let first = dice.below(VERTICES - count + 1);
            return Ok((GlRange::Arrays(first as u32), (first..first + count).collect()));
        }
        // Indices of a byte reach no further than 255.
        let reach = dice.pick(&[64, VERTICES]);
        let mut order: Vec<usize> = (0..count).map(|_| dice.below(reach)).collect();
        // One after another, some agree in their low byte.
        for at in 1..count {
            if reach == VERTICES && dice.chance(0.3) {
                order[at] = (order[at - 1] + 256) % 512;
                order[at] = if order[at] < VERTICES { order[at] } else { order[at - 1] };
            }
        }
        let base = dice.pick(&[0, 0, 7, 1000, -60, -100_000]);
        let kind = match base {
            -100_000 => glow::UNSIGNED_INT,
            -60 => dice.pick(&[glow::UNSIGNED_BYTE, glow::UNSIGNED_SHORT, glow::UNSIGNED_INT]),
            _ => dice.pick(&[glow::UNSIGNED_BYTE, glow::UNSIGNED_SHORT, glow::UNSIGNED_INT]),
        };
        let least = order.iter().min().copied().unwrap_or(0) as i32;
        // No index is below 0.
        let base = base.min(least);
        let most = order.iter().max().copied().unwrap_or(0) as i32;
        let is_byte = kind == glow::UNSIGNED_BYTE && most - base > 255;
        let kind = if is_byte { glow::UNSIGNED_SHORT } else { kind };
        let size = match kind {
            glow::UNSIGNED_BYTE => 1,
            glow::UNSIGNED_SHORT => 2,
            _ => 4,
        };
        let bytes: Vec<u8> =
            order.iter().flat_map(|vertex| (*vertex as i32 - base).to_le_bytes().into_iter().take(size)).collect();
        let held = match &self.arrays[self.bound].indices {
            Some(held) if dice.chance(0.7) => held.clone(),
            _ => {
                let held = self.indices[dice.below(self.indices.len())].clone();
                if let Some(name) = &*held.name.borrow() {
                    subject.bench.index_feed(name);
                }
                held
            }
        };
        let room = held.bytes.borrow().len() - bytes.len();
        let offset = size * dice.below(room / size);
        held.write(&subject.bench, dice, offset, &bytes)?;
        self.arrays[self.bound].indices = Some(Rc::clone(&held));
        Ok((GlRange::Elements { kind, offset: offset as u32, base }, order))
    }
}

/// Vertices of all primitives in turn.
fn assembled(primitive: GlPrimitive, order: &[usize]) -> Vec<usize> {
    let pairs = |closed: bool| {
        let mut pairs: Vec<usize> = order.windows(2).flatten().copied().collect();
        if closed && order.len() > 1 {
            pairs.extend([order[order.len() - 1], order[0]]);
        }
        pairs
    };
    match primitive {
        GlPrimitive::Lines => order[..order.len() / 2 * 2].to_vec(),
        GlPrimitive::Triangles => order[..order.len() / 3 * 3].to_vec(),
        GlPrimitive::LineStrip => pairs(false),
        GlPrimitive::LineLoop => pairs(true),
        _ => order.to_vec(),
    }
}
