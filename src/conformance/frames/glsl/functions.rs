//! GLSL's functions, as operations [GLSL 4.60, 8].

use super::compile::{Compiler, Place, Unknown};
use super::ops::{Kind, Level, Look, Op, Shape, Shaped, Slot};
use crate::conformance::model::number::Num;
use crate::conformance::model::{scalars as s, vectors as v};

pub fn not(a: Num) -> Num {
    Num::boolean(a.truth().map(|a| !a))
}

pub fn below(a: Num, b: Num) -> Num {
    compared(a, b, a.below(b))
}

pub fn above(a: Num, b: Num) -> Num {
    compared(a, b, b.below(a))
}

pub fn at_most(a: Num, b: Num) -> Num {
    not(above(a, b))
}

pub fn at_least(a: Num, b: Num) -> Num {
    not(below(a, b))
}

pub fn same(a: Num, b: Num) -> Num {
    compared(a, b, a.equals(b))
}

/// Nothing of what is unknown.
fn compared(a: Num, b: Num, answer: Option<bool>) -> Num {
    Num::boolean(answer.filter(|_| a.is_known() && b.is_known()))
}

pub fn differ(a: Num, b: Num) -> Num {
    not(same(a, b))
}

pub use v::{both, either};

pub fn quotient(a: Num, b: Num) -> Num {
    Num::integer(a.whole().zip(b.whole()).and_then(|(a, b)| s::quotient(a, b)))
}

/// A float's whole part.
pub fn whole(a: Num) -> Num {
    a.step(f64::trunc)
}

fn floor(a: Num) -> Num {
    a.step(f64::floor)
}

type OfOne = fn(Num) -> Num;
type OfTwo = fn(Num, Num) -> Num;

const ONES: [(&str, OfOne); 13] = [
    ("abs", Num::magnitude),
    ("floor", floor),
    ("fract", s::fract),
    ("sqrt", s::sqrt),
    ("inversesqrt", s::inversesqrt),
    ("exp", s::exp),
    ("exp2", s::exp2),
    ("log2", s::log2),
    ("log", s::log),
    ("sin", s::sin),
    ("cos", s::cos),
    ("sign", s::sign),
    ("not", not),
];

const TWOS: [(&str, OfTwo); 9] = [
    ("min", Num::least),
    ("max", Num::most),
    ("pow", s::pow),
    ("step", s::step),
    ("mod", s::modulus),
    ("greaterThanEqual", at_least),
    ("greaterThan", above),
    ("lessThanEqual", at_most),
    ("lessThan", below),
];

impl<'a> Compiler<'a> {
    /// A call of a function of GLSL; `None`: it has none of this name.
    pub fn built_in_call(&mut self, name: &str, given: &[Place]) -> Result<Option<Place>, Unknown> {
        if let Some((_, function)) = ONES.iter().find(|(known, _)| *known == name) {
            return Ok(Some(self.each(given[0].shaped, &[&given[0]], |to, a| Op::One(*function, to, a[0]))));
        }
        if let Some((_, function)) = TWOS.iter().find(|(known, _)| *known == name) {
            let kind = if name.contains("Than") { Kind::Bool } else { Kind::Float };
            let shaped = Shaped { kind, ..given[0].shaped };
            return Ok(Some(self.two(shaped, &given[0], &given[1], *function)));
        }
        let shaped = given.first().map_or(Shaped::VOID, |place| place.shaped);
        Ok(Some(match name {
            "clamp" => {
                self.each(shaped, &[&given[0], &given[1], &given[2]], |to, a| Op::Three(s::clamp, to, a[0], a[1], a[2]))
            }
            "mix" if given[2].shaped.kind == Kind::Bool => {
                self.each(shaped, &[&given[0], &given[1], &given[2]], |to, a| Op::Choose(to, a[2], a[1], a[0]))
            }
            "mix" => {
                self.each(shaped, &[&given[0], &given[1], &given[2]], |to, a| Op::Three(s::mix, to, a[0], a[1], a[2]))
            }
            "dot" => self.dot(&given[0], &given[1]),
            "length" => self.length(&given[0]),
            "distance" => {
                let apart = self.two(shaped, &given[0], &given[1], Num::minus);
                self.length(&apart)
            }
            "normalize" => {
                let to = self.fresh(given[0].slots.len());
                self.ops.push(Op::Normalize(to[0], given[0].slots.clone().into()));
                Place::new(shaped, to)
            }
            "cross" => self.cross(&given[0], &given[1]),
            "dFdx" => self.each(shaped, &[&given[0]], |to, a| Op::Along(0, to, a[0])),
            "dFdy" => self.each(shaped, &[&given[0]], |to, a| Op::Along(1, to, a[0])),
            "fwidth" => {
                let sizes = [0, 1].map(|axis| {
                    let along = self.each(shaped, &[&given[0]], |to, a| Op::Along(axis, to, a[0]));
                    self.each(shaped, &[&along], |to, a| Op::One(Num::magnitude, to, a[0]))
                });
                self.two(shaped, &sizes[0], &sizes[1], Num::plus)
            }
            _ => return self.texture_call(name, given),
        }))
    }

    fn dot(&mut self, a: &Place, b: &Place) -> Place {
        let pairs: Vec<[Slot; 2]> = a.slots.iter().zip(&b.slots).map(|(a, b)| [*a, *b]).collect();
        let to = self.fresh(1);
        self.ops.push(Op::Dot(to[0], pairs.into()));
        Place::new(Shaped::FLOAT, to)
    }

    fn length(&mut self, a: &Place) -> Place {
        let squared = self.dot(a, a);
        self.each(Shaped::FLOAT, &[&squared], |to, a| Op::One(s::sqrt, to, a[0]))
    }

    fn cross(&mut self, a: &Place, b: &Place) -> Place {
        let less = self.each(b.shaped, &[b], |to, b| Op::One(Num::negative, to, b[0]));
        let to = self.fresh(3);
        for (to, [i, j]) in to.iter().zip([[1, 2], [2, 0], [0, 1]]) {
            let pairs = [[a.slots[i], b.slots[j]], [a.slots[j], less.slots[i]]];
            self.ops.push(Op::Dot(*to, pairs.into()));
        }
        Place::new(a.shaped, to)
    }

    fn texture_call(&mut self, name: &str, given: &[Place]) -> Result<Option<Place>, Unknown> {
        let Some((sampler, Kind::Sampler(shape))) =
            given.first().and_then(|place| Some((place.sampler?, place.shaped.kind)))
        else {
            return Ok(None);
        };
        let Shape { coordinates, compares } = shape;
        let look = match name {
            "textureSize" => {
                let to = self.fresh(4);
                self.ops.push(Op::Look(to[0], sampler, Box::new(Look::Size)));
                let sides = coordinates.min(2);
                return Ok(Some(Place::new(Shaped::vector(Kind::Int, sides), to[..sides].to_vec())));
            }
            "texelFetch" => Look::Fetch { at: given[1].slots.clone(), level: given[2].slots[0] },
            "texture" | "textureLod" | "textureGrad" => {
                let at = given[1].slots[..coordinates].to_vec();
                let level = match name {
                    "texture" => Level::Implicit,
                    "textureLod" => Level::Given(given[2].slots[0]),
                    _ => {
                        let pair = |place: &Place| [place.slots[0], place.slots[1]];
                        Level::Gradient(pair(&given[2]), pair(&given[3]))
                    }
                };
                let reference = compares.then(|| given[1].slots[coordinates.max(2)]);
                Look::Filtered { at, reference, level }
            }
            "textureProj" => {
                let all = &given[1].slots;
                let last = Place::variable(Shaped::FLOAT, vec![all[all.len() - 1]]);
                let count = coordinates + usize::from(compares);
                let over = Place::variable(Shaped::vector(Kind::Float, count), all[..count].to_vec());
                let over = self.two(over.shaped, &over, &last, Num::over).slots;
                let reference = compares.then(|| over[coordinates]);
                Look::Filtered { at: over[..coordinates].to_vec(), reference, level: Level::Implicit }
            }
            _ => return Ok(None),
        };
        let to = self.fresh(4);
        self.ops.push(Op::Look(to[0], sampler, Box::new(look)));
        let count = if compares { 1 } else { 4 };
        let result = Place::new(Shaped::vector(Kind::Float, count), to[..count].to_vec());
        Ok(Some(result))
    }
}
