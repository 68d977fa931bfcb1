//! Runs a compiled shader on four lanes at once: the pixels of a quad, or four vertices.

use super::ops::{Compiled, Level, Look, Op, Slot};
use crate::conformance::model::number::{Num, ROUNDING, SLACK, sum};
use crate::conformance::model::scalars::inversesqrt;

/// Lane 2 y + x is the pixel (x, y) of the quad.
pub const LANES: usize = 4;

pub type Lanes = [Num; LANES];

/// All lanes, as bits.
const ALL: u8 = 15;

/// Level of detail of a lookup in one lane.
#[derive(Clone, Copy, Debug)]
pub enum Detail {
    /// The texture has one level, or a sampler that keeps to one.
    Any,
    /// Least and most, before the sampler's clamp.
    Range(f64, f64),
    /// Texels change by so much, in coordinates: along x, along y.
    Changes([[Num; 2]; 2]),
    Unknown,
}

/// A lookup in one lane.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    pub at: &'a [Num],
    pub reference: Option<Num>,
    pub detail: Detail,
}

/// Textures of a draw, by the number of the sampler.
pub trait Textures {
    /// Tests whether a lookup depends on the level of detail.
    fn has_levels(&self, sampler: usize) -> bool;
    fn look(&self, sampler: usize, asked: &Asked) -> [Num; 4];
    fn fetch(&self, sampler: usize, at: &[Num], level: Num) -> [Num; 4];
    fn size(&self, sampler: usize) -> [f64; 2];
}

/// No textures: of a vertex stage.
pub struct NoTextures;

impl Textures for NoTextures {
    fn has_levels(&self, _: usize) -> bool {
        false
    }

    fn look(&self, _: usize, _: &Asked) -> [Num; 4] {
        [Num::UNKNOWN; 4]
    }

    fn fetch(&self, _: usize, _: &[Num], _: Num) -> [Num; 4] {
        [Num::UNKNOWN; 4]
    }

    fn size(&self, _: usize) -> [f64; 2] {
        [0.0; 2]
    }
}

/// Slots of a shader, and what became of the lanes.
pub struct Machine {
    pub slots: Vec<Lanes>,
    /// Lanes that ended in `discard`, as bits.
    pub discarded: u8,
    /// Lanes whose way through the shader is not known.
    pub unsure: u8,
}

impl Machine {
    pub fn new(shader: &Compiled) -> Self {
        let mut slots = vec![[Num::UNKNOWN; LANES]; shader.slots];
        for (slot, value) in &shader.constants {
            slots[*slot as usize] = [constant(*value); LANES];
        }
        Self { slots, discarded: 0, unsure: 0 }
    }

    /// Sets a value in all lanes.
    pub fn fill(&mut self, slots: &[Slot], values: impl Iterator<Item = f64>) {
        slots.iter().zip(values).for_each(|(slot, value)| self.slots[*slot as usize] = [Num::exact(value); LANES]);
    }

    pub fn run(&mut self, shader: &Compiled, textures: &dyn Textures) {
        (self.discarded, self.unsure) = (0, 0);
        self.block(&shader.ops, ALL, textures);
    }

    fn get(&self, slot: Slot) -> Lanes {
        self.slots[slot as usize]
    }

    /// Runs operations for the lanes of a mask; the lanes that reach the end.
    fn block(&mut self, ops: &[Op], mut mask: u8, textures: &dyn Textures) -> u8 {
        for op in ops {
            match op {
                Op::Set(to, from) => {
                    let from = self.get(*from);
                    self.store(*to, from, mask);
                }
                Op::One(function, to, a) => self.slots[*to as usize] = self.get(*a).map(function),
                Op::Two(function, to, a, b) => {
                    let (a, b) = (self.get(*a), self.get(*b));
                    self.slots[*to as usize] = std::array::from_fn(|lane| function(a[lane], b[lane]));
                }
                Op::Three(function, to, a, b, c) => {
                    let (a, b, c) = (self.get(*a), self.get(*b), self.get(*c));
                    self.slots[*to as usize] = std::array::from_fn(|lane| function(a[lane], b[lane], c[lane]));
                }
                Op::Dot(to, pairs) => self.slots[*to as usize] = self.dot(pairs.iter().copied(), pairs.len()),
                Op::Normalize(to, from) => self.normalize(*to, from),
                Op::Choose(to, choice, a, b) => {
                    let (choice, a, b) = (self.get(*choice), self.get(*a), self.get(*b));
                    self.slots[*to as usize] = std::array::from_fn(|lane| match choice[lane].truth() {
                        Some(true) => a[lane],
                        Some(false) => b[lane],
                        None => either_of(a[lane], b[lane]),
                    });
                }
                Op::Along(axis, to, from) => {
                    let from = self.get(*from);
                    self.slots[*to as usize] = if mask == ALL { along(*axis, from) } else { [Num::UNKNOWN; LANES] };
                }
                Op::Look(to, sampler, look) => self.look(*to, *sampler, look, mask, textures),
                Op::Pick { to, scalars, from, index } => {
                    let index = self.get(*index);
                    for (lane, index) in index.iter().enumerate() {
                        let group = index.whole().filter(|group| *group >= 0).map(|group| group as usize);
                        for part in 0..*scalars {
                            let slot = group.and_then(|group| from.get(group * scalars + part));
                            let value = slot.map_or(Num::UNKNOWN, |slot| self.get(*slot)[lane]);
                            self.slots[*to as usize + part][lane] = value;
                        }
                    }
                }
                Op::Put { to, index, from } => self.put(to, *index, from, mask),
                Op::If(condition, then, other) => {
                    let [yes, no] = self.parted(*condition, mask);
                    let then = if yes == 0 { 0 } else { self.block(then, yes, textures) };
                    let other = if no == 0 { 0 } else { self.block(other, no, textures) };
                    mask = then | other;
                }
                Op::Loop(inner) => {
                    let (mut here, mut left) = (mask, 0);
                    loop {
                        here = self.block(&inner.test, here, textures);
                        let [yes, no] = self.parted(inner.holds, here);
                        left |= no;
                        if yes == 0 {
                            break;
                        }
                        here = self.block(&inner.body, yes, textures);
                        here = self.block(&inner.step, here, textures);
                    }
                    mask = left;
                }
                Op::Call(body) => {
                    self.block(body, mask, textures);
                    mask &= !(self.discarded | self.unsure);
                }
                Op::Return => return 0,
                Op::Discard => {
                    self.discarded |= mask;
                    return 0;
                }
            }
            if mask == 0 {
                return 0;
            }
        }
        mask
    }

    fn store(&mut self, to: Slot, from: Lanes, mask: u8) {
        let slot = &mut self.slots[to as usize];
        if mask == ALL {
            *slot = from;
            return;
        }
        (0..LANES).filter(|lane| mask >> lane & 1 == 1).for_each(|lane| slot[lane] = from[lane]);
    }

    fn put(&mut self, to: &[Slot], index: Slot, from: &[Slot], mask: u8) {
        let index = self.get(index);
        for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
            let group = index[lane].whole().filter(|group| *group >= 0);
            for (part, slot) in from.iter().enumerate() {
                let value = self.get(*slot)[lane];
                if let Some(slot) = group.and_then(|group| to.get(group as usize * from.len() + part)) {
                    self.slots[*slot as usize][lane] = value;
                }
            }
        }
    }

    /// Lanes for which a condition holds, and those for which it does not. Lanes that do not know it end.
    fn parted(&mut self, condition: Slot, mask: u8) -> [u8; 2] {
        let condition = self.get(condition);
        let mut parted = [0, 0];
        for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
            match condition[lane].truth() {
                Some(holds) => parted[usize::from(!holds)] |= 1 << lane,
                None => self.unsure |= 1 << lane,
            }
        }
        parted
    }

    fn dot(&self, pairs: impl Iterator<Item = [Slot; 2]> + Clone, count: usize) -> Lanes {
        std::array::from_fn(|lane| {
            let mut terms = [Num::exact(0.0); 4];
            for (term, [a, b]) in terms.iter_mut().zip(pairs.clone()) {
                *term = self.get(a)[lane].times(self.get(b)[lane]);
            }
            sum(&terms[..count.min(4)])
        })
    }

    fn normalize(&mut self, to: Slot, from: &[Slot]) {
        let squared = self.dot(from.iter().map(|slot| [*slot, *slot]), from.len());
        let scale = squared.map(inversesqrt);
        for (part, from) in from.iter().enumerate() {
            let from = self.get(*from);
            self.slots[to as usize + part] = std::array::from_fn(|lane| {
                let x = from[lane].times(scale[lane]);
                // A division by the length instead.
                Num::off(x.value, x.error + 8.0 * ROUNDING * x.value.abs())
            });
        }
    }

    fn look(&mut self, to: Slot, sampler: usize, look: &Look, mask: u8, textures: &dyn Textures) {
        let gather = |slots: &[Slot], lane: usize| {
            let mut numbers = [Num::UNKNOWN; 3];
            numbers.iter_mut().zip(slots).for_each(|(number, slot)| *number = self.get(*slot)[lane]);
            numbers
        };
        let mut results = [[Num::UNKNOWN; 4]; LANES];
        for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
            results[lane] = match look {
                Look::Size => {
                    let [x, y] = textures.size(sampler).map(Num::exact);
                    [x, y, Num::UNKNOWN, Num::UNKNOWN]
                }
                Look::Fetch { at, level } => {
                    textures.fetch(sampler, &gather(at, lane)[..at.len()], self.get(*level)[lane])
                }
                Look::Filtered { at, reference, level } => {
                    let detail = match level {
                        _ if !textures.has_levels(sampler) => Detail::Any,
                        Level::Implicit if mask != ALL => Detail::Unknown,
                        Level::Implicit => {
                            let along = |axis| {
                                [0, 1].map(|part: usize| along(axis, self.get(at[part.min(at.len() - 1)]))[lane])
                            };
                            Detail::Changes([along(0), along(1)])
                        }
                        Level::Given(slot) => {
                            let level = self.get(*slot)[lane];
                            let reach = SLACK * level.error;
                            Detail::Range(level.value - reach, level.value + reach)
                        }
                        Level::Gradient(x, y) => {
                            Detail::Changes([x, y].map(|pair| pair.map(|slot| self.get(slot)[lane])))
                        }
                    };
                    let reference = reference.map(|slot| self.get(slot)[lane]);
                    textures.look(sampler, &Asked { at: &gather(at, lane)[..at.len()], reference, detail })
                }
            };
        }
        for part in 0..4 {
            self.slots[to as usize + part] = results.map(|result| result[part]);
        }
    }
}

/// A constant as f32 has it.
fn constant(value: f64) -> Num {
    if value.is_nan() { Num::UNKNOWN } else { Num::exact(f64::from(value as f32)) }
}

/// A number that may be either of two.
pub fn either_of(a: Num, b: Num) -> Num {
    if !a.is_known() || !b.is_known() {
        return Num::UNKNOWN;
    }
    if a == b {
        return a;
    }
    let low = (a.value - SLACK * a.error).min(b.value - SLACK * b.error);
    let high = (a.value + SLACK * a.error).max(b.value + SLACK * b.error);
    // A little more, so that both ends are within it whatever was rounded here.
    Num { value: (low + high) / 2.0, error: (high - low) / (2.0 * SLACK) * (1.0 + 1e-9) + 1e-300 }
}

/// The change to the next pixel, in this row or column of the quad or in the other one.
fn along(axis: usize, [a, b, c, d]: Lanes) -> Lanes {
    let [first, second] = if axis == 0 { [b.minus(a), d.minus(c)] } else { [c.minus(a), d.minus(b)] };
    [either_of(first, second); LANES]
}
