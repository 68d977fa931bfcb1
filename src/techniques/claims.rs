//! Claims of the techniques' documents, as comparisons that a report measures on its scene. Plain data: knows no metric and
//! no pixel.

/// Comparison of one quantity in two pictures.
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
    /// Claim of a technique that needs no polygon offset.
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

/// A picture that is compared.
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

/// Compared quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// False shadow on surfaces that face the light, beyond the edge band.
    FalseShadow,
    /// False shadow on surfaces that face the light, the band included.
    FalseShadowWithBand,
    /// Light where none belongs.
    Leak,
    /// Leak on surfaces that face the light, where shading does not hide it.
    LeakFacing,
    /// Wrong pixels on surfaces that face the light.
    WrongFacing,
    /// Wrong pixels on surfaces turned away from the light, in percent of these surfaces' pixels.
    WrongAway,
    /// Movement of the map's depth by the polygon offset, in the median of the lit pixels that face the light.
    Offset,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// The first is at most so many times the second.
    AtMost(f64),
    /// The first is greater than the second.
    Greater,
}
