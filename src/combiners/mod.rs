//! Register combiners as data: the fragment arithmetic of NVIDIA's GeForce 256 to GeForce 4 [NV_register_combiners,
//! NV_register_combiners2], which the GDC talk's bump mapping is written for.
//!
//! A program has up to eight general stages, each with a portion for RGB and one for alpha, and a final combiner. A portion
//! maps four inputs, A to D, multiplies A by B and C by D, adds, scales, clamps to [-1, 1], and writes registers. All reads of
//! a stage see the values from before it.
//!
//! `parse` reads a program from text, `check` raises what the extension would, `run` is the CPU's interpreter, `fragment`
//! makes GLSL.

mod check;
mod glsl;
mod interpret;
mod parse;
mod print;
mod ranges;

pub use check::{MOST_STAGES, check};
pub use glsl::{fragment, unread};
pub use interpret::{Registers, run};
pub use parse::{Error, parse};

/// A register, each with RGB and alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Register {
    Zero,
    /// GL_CONSTANT_COLOR0_NV and 1: read only.
    Constant0,
    Constant1,
    /// The fog colour; its alpha, the fog factor, is readable in the final combiner only.
    Fog,
    /// GL_PRIMARY_COLOR_NV.
    Color0,
    /// GL_SECONDARY_COLOR_NV.
    Color1,
    /// The colour that texture unit 0 to 3 has fetched.
    Texture(u8),
    Spare0,
    Spare1,
    /// The product E × F, in the final combiner's A to D only.
    Product,
    /// Spare0 plus the secondary colour, in the final combiner's A to D only.
    ColorSum,
}

/// Mapping of an input; e is the register's value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mapping {
    /// max(0, e)
    Unsigned,
    /// 1 - clamp(e, 0, 1)
    UnsignedInvert,
    /// 2 max(0, e) - 1
    Expand,
    /// 1 - 2 max(0, e)
    ExpandNegate,
    /// max(0, e) - 1/2
    HalfBias,
    /// 1/2 - max(0, e)
    HalfBiasNegate,
    /// e
    #[default]
    Signed,
    /// -e
    SignedNegate,
}

impl Mapping {
    pub const ALL: [Self; 8] = [
        Self::Unsigned,
        Self::UnsignedInvert,
        Self::Expand,
        Self::ExpandNegate,
        Self::HalfBias,
        Self::HalfBiasNegate,
        Self::Signed,
        Self::SignedNegate,
    ];
}

/// Part of a register that an input reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Component {
    /// RGB portions only.
    Rgb,
    /// Alpha portions, and the final combiner's G, only.
    Blue,
    /// In an RGB portion in all three channels.
    Alpha,
}

/// An input of a portion or of the final combiner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variable {
    pub register: Register,
    pub mapping: Mapping,
    pub component: Component,
}

/// Factor after the sum and the bias.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scale {
    Half,
    #[default]
    One,
    Two,
    Four,
}

impl Scale {
    pub fn factor(self) -> f32 {
        match self {
            Self::Half => 0.5,
            Self::One => 1.0,
            Self::Two => 2.0,
            Self::Four => 4.0,
        }
    }
}

/// A portion of a stage. Registers that are not written are discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Portion {
    /// A, B, C, D.
    pub inputs: [Variable; 4],
    /// Registers for A B, for C D, and for their sum.
    pub outputs: [Option<Register>; 3],
    /// True if A B, or C D, is a dot product, written to all three channels. RGB only, and without a sum.
    pub dots: [bool; 2],
    /// True if 1/2 is taken from each result before it is scaled.
    pub biased: bool,
    pub scale: Scale,
}

/// A general stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeneralStage {
    pub rgb: Option<Portion>,
    pub alpha: Option<Portion>,
    /// The stage's own constants 0 and 1, as NV_register_combiners2 has them; else the program's.
    pub constants: [Option<[f32; 4]>; 2],
}

/// The final combiner: RGB is A B + (1 - A) C + D, alpha is G.
#[derive(Clone, Debug, PartialEq)]
pub struct Final {
    /// A to G. Only the mappings unsigned and unsigned-invert.
    pub inputs: [Variable; 7],
    /// True if spare0 plus the secondary colour is clamped to 1: GL_COLOR_SUM_CLAMP_NV.
    pub clamps_sum: bool,
}

/// A program.
#[derive(Clone, Debug, PartialEq)]
pub struct CombinerProgram {
    /// Constants 0 and 1, where the program has them; else the renderer sets them.
    pub constants: [Option<[f32; 4]>; 2],
    pub stages: Vec<GeneralStage>,
    pub last: Final,
}

/// Accuracy of registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Precision {
    #[default]
    Float,
    /// Each result rounded to a multiple of 1/255, as nine bits with a sign hold it.
    NineBits,
}

const ZERO: Variable = Variable { register: Register::Zero, mapping: Mapping::Unsigned, component: Component::Rgb };
