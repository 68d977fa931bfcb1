//! Answers of the ray tracer, pixel by pixel. Plain values; knows no scene and no ray.

use glam::DVec3;

/// The answers for one light. Row 0 is the top of the picture, as in a PNG.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Truth {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width * height` answers, row by row from the top.
    pub pixels: Vec<Pixel>,
}

/// One pixel's answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Answer over all places where the sample may lie.
    pub answer: Answer,
    /// Answer of the centre ray alone, if the light's shape holds the point. Ambiguous pixels have it too, so that shadow
    /// edges can be located through them. Never count it as truth.
    pub lit_at_center: Option<bool>,
    /// Hit of the centre ray; `None`: nothing between the camera's near and far planes.
    pub hit: Option<Hit>,
}

/// Answer for one pixel and one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Nothing is drawn here.
    Background,
    /// Drawn, but outside the light's cone or frustum (near and far planes included).
    OutsideCone,
    /// The light reaches the visible point.
    Lit,
    /// Something blocks the light.
    Shadowed,
    /// A sample moved by less than the stated error decides otherwise.
    Ambiguous(Reason),
}

/// Reason why a small move of the sample would change the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// The primary ray passes a silhouette or an open edge.
    Silhouette,
    /// Two unconnected surfaces lie at the same depth for the camera, within its depth buffer's error.
    DepthTie,
    /// The surface is seen edge-on.
    GrazingView,
    /// The surface meets the camera's or the light's near or far plane.
    ClipPlane,
    /// The point lies on the light's cone or on a side of its frustum.
    ConeEdge,
    /// The light stands in the surface's plane.
    GrazingLight,
    /// The shadow ray passes a silhouette or an open edge.
    ShadowEdge,
    /// Another, unconnected surface touches the visible point, or a blocker the light.
    Contact,
    /// A texture's alpha is near 0.5 where a ray crosses it.
    AlphaTest,
}

impl Reason {
    /// All nine, in the order of the declaration.
    pub const ALL: [Self; 9] = [
        Self::Silhouette,
        Self::DepthTie,
        Self::GrazingView,
        Self::ClipPlane,
        Self::ConeEdge,
        Self::GrazingLight,
        Self::ShadowEdge,
        Self::Contact,
        Self::AlphaTest,
    ];

    /// A short name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Silhouette => "silhouette",
            Self::DepthTie => "depth tie",
            Self::GrazingView => "grazing view",
            Self::ClipPlane => "clip plane",
            Self::ConeEdge => "cone edge",
            Self::GrazingLight => "grazing light",
            Self::ShadowEdge => "shadow edge",
            Self::Contact => "contact",
            Self::AlphaTest => "alpha test",
        }
    }
}

/// The surface point that the centre ray sees, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Into [`crate::scene::Scene::objects`].
    pub object: u32,
    /// The triangle of that object's mesh: `indices[3 * triangle..]`.
    pub triangle: u32,
    /// From the eye, in world units.
    pub distance: f64,
    /// Position, in world space.
    pub position: DVec3,
    /// The triangle's unit normal on the side that the camera sees.
    pub normal: DVec3,
    /// Cosine between `normal` and the direction to the light; in [-1, 1].
    pub cos_light: f64,
    /// The longest way, in world units, that the point moves on its surface when the sample moves by one pixel.
    pub pixel_size: f64,
    /// Place of the point in a map that holds all of the light, in half sides of the map.
    ///
    /// - Spotlight: (right, up, 0) in its square frustum, each in [-1, 1] inside; measured by angle tangents from the
    ///   light's axis. Infinite behind the light.
    /// - Point light: on the surface of the cube [-1, 1]³ whose faces a cube map's are; across its edges, distances are
    ///   those of space, at most √2 shorter than over the faces.
    /// - Directional light: (right, up, 0) in the square, across the direction, that the ball around the scene's bounds
    ///   fills.
    pub in_map: DVec3,
}

impl Hit {
    /// Tests whether the visible side faces the light.
    pub fn faces_light(&self) -> bool {
        self.cos_light > 0.0
    }
}

impl Truth {
    /// The answer at column `x`, row `y` from the top; `None` outside the picture.
    pub fn at(&self, x: u32, y: u32) -> Option<&Pixel> {
        if x >= self.width || y >= self.height {
            return None;
        }
        self.pixels.get(y as usize * self.width as usize + x as usize)
    }

    /// Number of pixels whose answer is `wanted`.
    pub fn count(&self, wanted: impl Fn(Answer) -> bool) -> usize {
        self.pixels.iter().filter(|pixel| wanted(pixel.answer)).count()
    }

    /// Pixels on which something is drawn, ambiguous ones included.
    pub fn drawn(&self) -> usize {
        self.count(|answer| answer != Answer::Background)
    }

    /// Ambiguous over drawn pixels, in [0, 1]; 0 where nothing is drawn.
    pub fn ambiguous_share(&self) -> f64 {
        let ambiguous = self.count(|answer| matches!(answer, Answer::Ambiguous(_)));
        if ambiguous == 0 { 0.0 } else { ambiguous as f64 / self.drawn() as f64 }
    }

    /// The reasons that occur, each with its pixels.
    pub fn reasons(&self) -> Vec<(Reason, usize)> {
        let with = |reason| (reason, self.count(|answer| answer == Answer::Ambiguous(reason)));
        Reason::ALL.into_iter().map(with).filter(|&(_, count)| count > 0).collect()
    }
}
