//! A compiled shader: operations on slots of numbers, each a scalar of four lanes, with GLSL's structure of branches and calls.

use std::collections::HashMap;

use crate::conformance::model::number::Num;

/// Place of a scalar.
pub type Slot = u32;

/// Scalar types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Void,
    Float,
    Int,
    Bool,
    Sampler(Shape),
    /// By its number.
    Struct(usize),
}

/// Dimensions of a sampler's texture, and whether it compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub coordinates: usize,
    pub compares: bool,
}

/// A type of GLSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shaped {
    pub kind: Kind,
    /// 0: no matrix.
    pub columns: usize,
    pub rows: usize,
    /// 0: no array.
    pub count: usize,
}

impl Shaped {
    pub const VOID: Self = Self::vector(Kind::Void, 1);
    pub const FLOAT: Self = Self::vector(Kind::Float, 1);
    pub const BOOL: Self = Self::vector(Kind::Bool, 1);
    pub const INT: Self = Self::vector(Kind::Int, 1);

    pub const fn vector(kind: Kind, rows: usize) -> Self {
        Self { kind, columns: 0, rows, count: 0 }
    }

    pub fn is_matrix(self) -> bool {
        self.columns > 0 && self.count == 0
    }

    pub fn is_scalar(self) -> bool {
        self.columns == 0 && self.rows == 1 && self.count == 0
    }

    /// Scalars of anything but a struct.
    pub fn scalars(self) -> usize {
        self.columns.max(1) * self.rows * self.count.max(1)
    }
}

/// Level of detail of a lookup.
#[derive(Clone, Debug)]
pub enum Level {
    /// By the neighbours' coordinates.
    Implicit,
    Given(Slot),
    /// Derivatives along x and y.
    Gradient([Slot; 2], [Slot; 2]),
}

/// A lookup of a texture.
#[derive(Clone, Debug)]
pub enum Look {
    Filtered {
        at: Vec<Slot>,
        reference: Option<Slot>,
        level: Level,
    },
    /// A texel by its number at a level.
    Fetch {
        at: Vec<Slot>,
        level: Slot,
    },
    /// Texels a side of level 0, by dimension.
    Size,
}

/// One operation: the first slot is that of the result.
#[derive(Debug)]
pub enum Op {
    /// An assignment, for the lanes that are here.
    Set(Slot, Slot),
    One(fn(Num) -> Num, Slot, Slot),
    Two(fn(Num, Num) -> Num, Slot, Slot, Slot),
    Three(fn(Num, Num, Num) -> Num, Slot, Slot, Slot, Slot),
    /// A sum of products.
    Dot(Slot, Box<[[Slot; 2]]>),
    /// A normalised vector, from as many slots.
    Normalize(Slot, Box<[Slot]>),
    /// The second slot chooses the third, or the fourth.
    Choose(Slot, Slot, Slot, Slot),
    /// dFdx (0) or dFdy (1).
    Along(usize, Slot, Slot),
    /// Sampler, lookup.
    Look(Slot, usize, Box<Look>),
    /// Chooses the group that `index` names, of these slots in groups of `scalars`.
    Pick {
        to: Slot,
        scalars: usize,
        from: Box<[Slot]>,
        index: Slot,
    },
    /// The same as an assignment.
    Put {
        to: Box<[Slot]>,
        index: Slot,
        from: Box<[Slot]>,
    },
    If(Slot, Vec<Op>, Vec<Op>),
    Loop(Box<LoopOp>),
    /// A function's body, which `Return` leaves.
    Call(Vec<Op>),
    Return,
    Discard,
}

/// A loop: its test is made before each round.
#[derive(Debug)]
pub struct LoopOp {
    pub test: Vec<Op>,
    pub holds: Slot,
    pub body: Vec<Op>,
    pub step: Vec<Op>,
}

/// Interpolation of a varying.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varies {
    Smooth,
    NoPerspective,
    Flat,
}

/// A variable that a shader shares with others.
#[derive(Clone, Debug)]
pub struct Shared {
    pub name: String,
    pub slots: Vec<Slot>,
    pub varies: Varies,
}

/// A stage's shader.
#[derive(Debug, Default)]
pub struct Compiled {
    pub slots: usize,
    pub constants: Vec<(Slot, f64)>,
    pub uniforms: HashMap<String, Vec<Slot>>,
    pub samplers: Vec<String>,
    pub inputs: Vec<Shared>,
    pub outputs: Vec<Shared>,
    /// gl_Position or gl_FragCoord.
    pub position: Vec<Slot>,
    pub clip_distances: Vec<Slot>,
    pub depth: Slot,
    pub writes_depth: bool,
    pub discards: bool,
    pub ops: Vec<Op>,
}
