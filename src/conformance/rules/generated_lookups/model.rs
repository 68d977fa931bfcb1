//! Textures as the model has them: targets, levels, spans of values that may come out, comparisons.

use std::cmp::Ordering;
use std::rc::Rc;

use super::formats::TexelFormat;
use crate::conformance::bench::{GlCompare, GlSwizzle, Sampling};

/// Target of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    Line,
    Flat,
    Volume,
    Cube,
    Array,
    Rectangle,
}

impl Shape {
    pub const ALL: [Self; 6] = [Self::Line, Self::Flat, Self::Volume, Self::Cube, Self::Array, Self::Rectangle];

    pub fn target(self) -> u32 {
        match self {
            Self::Line => glow::TEXTURE_1D,
            Self::Flat => glow::TEXTURE_2D,
            Self::Volume => glow::TEXTURE_3D,
            Self::Cube => glow::TEXTURE_CUBE_MAP,
            Self::Array => glow::TEXTURE_2D_ARRAY,
            Self::Rectangle => glow::TEXTURE_RECTANGLE,
        }
    }

    /// Axes that are filtered.
    pub fn axes(self) -> usize {
        match self {
            Self::Line => 1,
            Self::Volume => 3,
            _ => 2,
        }
    }
}

/// Texels of a level: columns, rows, layers.
#[derive(Clone, Debug)]
pub struct Level {
    pub size: [usize; 3],
    pub texels: Rc<Vec<[f64; 4]>>,
    /// Error of the stored texels.
    pub slack: f64,
    /// False where the filter of glGenerateMipmap is not known.
    pub known: bool,
}

/// A texture as the model has it.
#[derive(Clone, Debug)]
pub struct Texture {
    pub shape: Shape,
    pub format: &'static TexelFormat,
    pub levels: Vec<Level>,
    pub sampling: Sampling,
    pub name: usize,
}

/// Values that may come out, by channel.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    pub low: [f64; 4],
    pub high: [f64; 4],
    /// The greatest magnitude of a texel, and whether several were blended.
    pub most: f64,
    pub blended: bool,
    pub slack: f64,
}

impl Span {
    pub fn of(texel: [f64; 4], slack: f64) -> Self {
        let most = texel.into_iter().map(f64::abs).fold(0.0, f64::max);
        Self { low: texel, high: texel, most, blended: false, slack }
    }

    /// Distance of a value from the span, less what the format allows; `tier` 0: strictly.
    pub fn distance(&self, value: [f64; 4], format: &TexelFormat, tier: usize, swizzle: [GlSwizzle; 4]) -> f64 {
        let error = format.error(self.most, self.blended)[tier] + self.slack;
        let mut worst = 0.0_f64;
        for channel in 0..4 {
            let [low, high] = match swizzle[channel] {
                GlSwizzle::Zero => [0.0; 2],
                GlSwizzle::One => [1.0; 2],
                from => [self.low[from as usize], self.high[from as usize]],
            };
            let off = (low - value[channel]).max(value[channel] - high);
            if off.is_nan() {
                return f64::INFINITY;
            }
            worst = worst.max(off - error);
        }
        worst
    }

    /// Shares of two spans.
    pub fn blend(&self, other: &Self, shares: [f64; 2]) -> Self {
        let mut span = Self {
            low: [f64::INFINITY; 4],
            high: [f64::NEG_INFINITY; 4],
            most: self.most.max(other.most),
            blended: true,
            slack: self.slack.max(other.slack),
        };
        for channel in 0..4 {
            for share in shares {
                let mix = |a: f64, b: f64| a + (b - a) * share;
                span.low[channel] = span.low[channel].min(mix(self.low[channel], other.low[channel]));
                span.high[channel] = span.high[channel].max(mix(self.high[channel], other.high[channel]));
            }
        }
        span
    }
}

/// A comparison: function, reference, and the difference within which it may go either way.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    pub function: GlCompare,
    pub reference: f64,
    pub tie: f64,
    /// True if no arithmetic came before: the reference can be equal.
    pub exact: bool,
}

impl Level {
    /// The texel of a column, a row and a layer.
    pub fn at(&self, [x, y, z]: [i64; 3]) -> [f64; 4] {
        self.texels[(z as usize * self.size[1] + y as usize) * self.size[0] + x as usize]
    }
}

impl Comparison {
    /// 0 or 1, or both where the reference is too near.
    pub fn passes(&self, stored: f64, slack: f64) -> [Option<f64>; 2] {
        let of = |order: Ordering| f64::from(u8::from(self.function.holds(order)));
        let near = self.tie + slack;
        let is_equal = self.exact && slack == 0.0 && self.reference == stored;
        if !is_equal && (self.reference - stored).abs() <= near && near > 0.0 {
            let all = [Ordering::Less, Ordering::Equal, Ordering::Greater].map(of);
            return if all.iter().all(|one| *one == all[0]) { [Some(all[0]), None] } else { [Some(0.0), Some(1.0)] };
        }
        [Some(of(self.reference.total_cmp(&stored))), None]
    }
}
