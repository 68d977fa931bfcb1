//! A judge's answer on a picture: a class for each pixel, and their counts.

use super::bound::MOST_WRONG;
use super::metrics::FEWEST_COMPARED;

/// Tells whether a wrong pixel is explained.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Explanation {
    /// The bound explains it.
    Explained,
    /// Nothing explains it.
    Beyond,
}

/// One pixel's class. The first five are not compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PixelClass {
    /// Neither the truth nor the picture shows a surface.
    Background,
    /// The ray tracer is not certain.
    Unknown,
    /// Outside the light's cone or frustum, where a shade has no meaning.
    OutsideLight,
    /// A surface turned away from the light, which shading keeps dark. Bounds without a map compare it.
    TurnedAway,
    /// The picture has no shade here: not a number.
    NoShade,
    /// Picture and truth agree.
    Right,
    /// Shadow where light belongs: acne, and light lost.
    FalseShadow(Explanation),
    /// Light where shadow belongs.
    Leak(Explanation),
    /// Only the truth, or only the picture, shows a surface.
    Surface(Explanation),
    /// Light beside a spotlight's cone or frustum, in a picture that shows light and not shade.
    LightOutside,
}

impl PixelClass {
    /// Tests whether the pixel was compared.
    pub fn is_compared(self) -> bool {
        self == Self::Right || self.is_wrong()
    }

    /// Tests whether picture and truth differ.
    pub fn is_wrong(self) -> bool {
        matches!(self, Self::FalseShadow(_) | Self::Leak(_) | Self::Surface(_) | Self::LightOutside)
    }

    /// Tests whether the pixel is wrong, and nothing explains it.
    pub fn is_beyond(self) -> bool {
        matches!(
            self,
            Self::FalseShadow(Explanation::Beyond)
                | Self::Leak(Explanation::Beyond)
                | Self::Surface(Explanation::Beyond)
                | Self::LightOutside
        )
    }
}

/// Judgement of one picture: counts of pixels, and each pixel's class.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Judgement {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `width * height` classes, row by row from the top.
    pub classes: Vec<PixelClass>,
    /// Pixels compared.
    pub compared: usize,
    /// Compared pixels with shadow where light belongs.
    pub false_shadow: usize,
    /// Compared pixels with light where shadow belongs.
    pub leak: usize,
    /// Compared pixels where only the truth, or only the picture, shows a surface.
    pub surface: usize,
    /// Compared pixels with light beside a spotlight's cone or frustum.
    pub light_outside: usize,
    /// Wrong pixels, of any kind, that nothing explains.
    pub outside_band: usize,
    /// Pixels that the ray tracer is not certain of.
    pub unknown: usize,
    /// Pixels on which the truth or the picture shows a surface, unknown ones included.
    pub drawn: usize,
}

impl Judgement {
    /// Counts `classes`.
    pub(super) fn of(size: [u32; 2], classes: Vec<PixelClass>) -> Self {
        let mut found = Self { size, ..Self::default() };
        for class in &classes {
            found.compared += usize::from(class.is_compared());
            found.outside_band += usize::from(class.is_beyond());
            found.drawn += usize::from(*class != PixelClass::Background);
            match class {
                PixelClass::FalseShadow(_) => found.false_shadow += 1,
                PixelClass::Leak(_) => found.leak += 1,
                PixelClass::Surface(_) => found.surface += 1,
                PixelClass::LightOutside => found.light_outside += 1,
                PixelClass::Unknown => found.unknown += 1,
                _ => {}
            }
        }
        Self { classes, ..found }
    }

    /// The same, in which a wrong pixel that `other` explains is explained: of a picture that shows two lights, each with its
    /// own shadow edges. Both are of one picture.
    #[must_use]
    pub fn explained_by(self, other: &Self) -> Self {
        let is_explained = |class: &PixelClass| class.is_wrong() && !class.is_beyond();
        let classes = self.classes.iter().zip(&other.classes).map(|(class, other)| match class {
            PixelClass::FalseShadow(_) if is_explained(other) => PixelClass::FalseShadow(Explanation::Explained),
            PixelClass::Leak(_) if is_explained(other) => PixelClass::Leak(Explanation::Explained),
            PixelClass::Surface(_) if is_explained(other) => PixelClass::Surface(Explanation::Explained),
            same => *same,
        });
        Self::of(self.size, classes.collect())
    }

    /// Pixels that are wrong in any way.
    pub fn wrong(&self) -> usize {
        self.false_shadow + self.leak + self.surface + self.light_outside
    }

    /// `count` over the pixels compared, in [0, 1]; 0 where nothing was compared.
    pub fn share(&self, count: usize) -> f64 {
        count as f64 / self.compared.max(1) as f64
    }

    /// [`unknown`](Self::unknown) over [`drawn`](Self::drawn), in [0, 1].
    pub fn unknown_share(&self) -> f64 {
        self.unknown as f64 / self.drawn.max(1) as f64
    }

    /// Indices of the wrong pixels that nothing explains, in rows from the top.
    pub fn beyond(&self) -> Vec<usize> {
        let beyond = self.classes.iter().enumerate().filter(|(_, class)| class.is_beyond());
        beyond.map(|(index, _)| index).collect()
    }

    /// Tests whether so many pixels are wrong, though each may be explained, that the map is too coarse for the picture: more
    /// than [`MOST_WRONG`] of at least [`FEWEST_COMPARED`].
    pub fn is_coarse(&self) -> bool {
        self.compared >= FEWEST_COMPARED && self.wrong() as f64 > MOST_WRONG * self.compared as f64
    }
}
