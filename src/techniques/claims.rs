//! What the documents claim of techniques, as comparisons that a report measures on its scene. Plain data: knows no
//! metric and no pixel.

/// A quantity of one picture against that of another, and which must be the greater.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// The claim as a sentence.
    pub says: &'static str,
    pub quantity: Quantity,
    pub first: Contender,
    pub relation: Relation,
    pub second: Contender,
}

impl Claim {
    /// Of what comes without a polygon offset.
    pub const fn needs_no_offset(who: Contender) -> Self {
        Self {
            says: "needs no offset to leave no more acne than a tuned offset does",
            quantity: Quantity::FalseShadow,
            first: who,
            relation: Relation::AtMost(1.0),
            second: Contender::SlopeScaled,
        }
    }
}

/// Whose picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// A shadow map under the slope-scaled polygon offset that leaves no acne and leaks least on surfaces that face the
    /// light.
    SlopeScaled,
    /// The same map under the least constant offset with no more false shadow, in the edge band and beyond it.
    Constant,
    /// Keys of `[light.shadow]` in TOML; a map's size and format are the scene's.
    Keys(&'static str),
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// False shadow on surfaces that face the light, beyond the edge band.
    FalseShadow,
    /// The same, the band included.
    FalseShadowWithBand,
    /// Light where none belongs.
    Leak,
    /// The same on surfaces that face the light: what shading does not hide.
    LeakFacing,
    /// Wrong pixels on surfaces that face the light.
    WrongFacing,
    /// Wrong pixels on surfaces turned away from the light, of these surfaces' own.
    WrongAway,
    /// How far the polygon offset moves the map's depth, in the median of the lit pixels that face the light.
    Offset,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// The first is at most so many times the second.
    AtMost(f64),
    /// The first is greater than the second.
    Greater,
}
