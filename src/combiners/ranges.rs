//! Ranges of registers through a program: which values a clamp can meet. Sums and products of ends bound those of values
//! between them, also as they are rounded: rounding keeps their order.

use std::collections::BTreeMap;

use super::{Component, Mapping, Portion, Register, Variable};

/// Values from `least` to `most`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub least: f32,
    pub most: f32,
}

impl Range {
    pub const ZERO: Self = Self { least: 0.0, most: 0.0 };
    pub const ONE: Self = Self { least: 1.0, most: 1.0 };
    const UNIT: Self = Self { least: 0.0, most: 1.0 };
    /// No bound: a register of which nothing is known.
    const ANY: Self = Self { least: f32::NEG_INFINITY, most: f32::INFINITY };

    /// GLSL of `value`, which lies in this range, within the limits `least` and `most`: clamped only where it may lie outside.
    pub fn clamped(self, value: String, least: f32, most: f32) -> String {
        match (self.least < least, self.most > most) {
            (true, true) => format!("clamp({value}, {least:?}, {most:?})"),
            (true, false) => format!("max({value}, {least:?})"),
            (false, true) => format!("min({value}, {most:?})"),
            (false, false) => value,
        }
    }

    pub fn map(self, function: impl Fn(f32) -> f32) -> Self {
        let [a, b] = [self.least, self.most].map(function);
        Self { least: a.min(b), most: a.max(b) }
    }

    fn times(self, other: Self) -> Self {
        let ends = [self.least, self.most].map(|x| [x * other.least, x * other.most]);
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for end in ends.into_iter().flatten() {
            // Infinity times 0.
            let (low, high) = if end.is_nan() { (f32::NEG_INFINITY, f32::INFINITY) } else { (end, end) };
            (least, most) = (least.min(low), most.max(high));
        }
        Self { least, most }
    }

    fn plus(self, other: Self) -> Self {
        Self { least: self.least + other.least, most: self.most + other.most }
    }
}

/// Ranges of registers, each with its RGB and its alpha.
#[derive(Clone)]
pub struct Ranges(BTreeMap<(Register, bool), Range>);

impl Ranges {
    /// Those before the first stage, of arguments in [0, 1] and the program's own constants.
    pub fn new(constants: &[Option<[f32; 4]>; 2]) -> Self {
        let mut ranges = Self(BTreeMap::new());
        let textures = (0..4).map(Register::Texture);
        let arguments = [Register::Constant0, Register::Constant1, Register::Fog, Register::Color0, Register::Color1];
        for register in arguments.into_iter().chain(textures) {
            ranges.set(register, [Range::UNIT; 2]);
        }
        for register in [Register::Zero, Register::Spare0, Register::Spare1] {
            ranges.set(register, [Range::ZERO; 2]);
        }
        ranges.within(constants)
    }

    fn set(&mut self, register: Register, [rgb, alpha]: [Range; 2]) {
        self.0.insert((register, true), rgb);
        self.0.insert((register, false), alpha);
    }

    /// The same where these constants hold.
    pub fn within(&self, constants: &[Option<[f32; 4]>; 2]) -> Self {
        let mut ranges = self.clone();
        for (register, value) in [Register::Constant0, Register::Constant1].into_iter().zip(constants) {
            if let Some([red, green, blue, alpha]) = value {
                let rgb = Range { least: red.min(*green).min(*blue), most: red.max(*green).max(*blue) };
                ranges.set(register, [rgb, Range { least: *alpha, most: *alpha }]);
            }
        }
        ranges
    }

    /// Range of an input's register.
    pub fn before_mapping(&self, input: Variable) -> Range {
        let part = (input.register, input.component != Component::Alpha);
        self.0.get(&part).copied().unwrap_or(Range::ANY)
    }

    /// Range of an input.
    pub fn of(&self, input: Variable) -> Range {
        let range = self.before_mapping(input);
        let positive = range.map(|e| e.max(0.0));
        match input.mapping {
            Mapping::Unsigned => positive,
            Mapping::UnsignedInvert => range.map(|e| 1.0 - e.clamp(0.0, 1.0)),
            Mapping::Expand => positive.map(|e| 2.0 * e - 1.0),
            Mapping::ExpandNegate => positive.map(|e| 1.0 - 2.0 * e),
            Mapping::HalfBias => positive.map(|e| e - 0.5),
            Mapping::HalfBiasNegate => positive.map(|e| 0.5 - e),
            Mapping::Signed => range,
            Mapping::SignedNegate => range.map(|e| -e),
        }
    }

    /// Ranges of A B, C D and their sum, biased and scaled, before they are clamped.
    pub fn results(&self, portion: &Portion) -> [Range; 3] {
        let [a, b, c, d] = portion.inputs.map(|input| self.of(input));
        let product = |x: Range, y: Range, dot: bool, is_square: bool| {
            let each = x.times(y);
            let each = if is_square { Self::square(each) } else { each };
            if dot { each.plus(each).plus(each) } else { each }
        };
        let [ab_is_square, cd_is_square] = [0, 2].map(|first| portion.inputs[first] == portion.inputs[first + 1]);
        let ab = product(a, b, portion.dots[0], ab_is_square);
        let cd = product(c, d, portion.dots[1], cd_is_square);
        let bias = if portion.biased { 0.5 } else { 0.0 };
        [ab, cd, ab.plus(cd)].map(|range| range.map(|value| (value - bias) * portion.scale.factor()))
    }

    fn square(product: Range) -> Range {
        Range { least: product.least.max(0.0), most: product.most }
    }

    /// Records the range of RGB of the final combiner's own registers.
    pub fn write_final(&mut self, register: Register, rgb: Range) {
        self.0.insert((register, true), rgb);
    }

    /// Range of the product E F of the final combiner.
    pub fn final_product(&self, e: Variable, f: Variable) -> Range {
        let product = self.of(e).times(self.of(f));
        if e == f { Self::square(product) } else { product }
    }

    /// Range of spare0 + colour 1, before it is clamped.
    pub fn color_sum(&self) -> Range {
        let of = |register| self.0.get(&(register, true)).copied().unwrap_or(Range::ANY);
        of(Register::Spare0).plus(of(Register::Color1))
    }

    /// Range of A B + (1 - A) C + D of the final combiner, before it is clamped.
    pub fn mixed(&self, [a, b, c, d]: [Variable; 4]) -> Range {
        let rest = self.of(a).map(|e| 1.0 - e).times(self.of(c));
        self.of(a).times(self.of(b)).plus(rest).plus(self.of(d))
    }

    /// Records the ranges of a portion's results. `before`: the ranges that it reads.
    pub fn write(&mut self, portion: &Portion, is_rgb: bool, before: &Self) {
        for (output, range) in portion.outputs.into_iter().zip(before.results(portion)) {
            if let Some(register) = output {
                self.0.insert((register, is_rgb), range.map(|value| value.clamp(-1.0, 1.0)));
            }
        }
    }
}
