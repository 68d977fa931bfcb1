//! Guards against back projection [HSM, "Advantages and Limitations"; LEC, "Careful about Back Projecting Shadow Maps"]: a
//! spotlight's texture coordinates divide by q, and behind the light, where q < 0, the quotients are in the map again. The
//! choice of guards, and the side of the light's plane, q = 0, on which things lie. Knows no shader and no GL.

use glam::{DMat4, DVec3, DVec4};

use super::{Coordinates, Drawable, Viewer};
use crate::math::texgen;
use crate::scene::{Reader, SettingsError};

/// Way to keep q <= 0 dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guard {
    /// Chosen for each item: none if it lies before the light, no light if behind, the fragment's test if across.
    #[default]
    Auto,
    /// GL_SPOT_CUTOFF of 90 degrees: the light times 0 or 1 at each vertex.
    SpotCutoff,
    /// A 1D texture of two texels, 0 behind and 1 before the light.
    Texture1d,
    /// A clip plane at the light: what is cut is drawn twice, with and without it.
    ClipPlane,
    /// A tag in the stencil buffer on everything behind the light.
    Stencil,
    /// Triangles behind the light are drawn without it.
    Cull,
    /// A test in each fragment.
    Fragment,
    /// No guard: surfaces behind the light are lit. For pictures of that mistake.
    None,
}

/// Values of the key `guard`.
const NAMES: [(&str, Guard); 8] = [
    ("auto", Guard::Auto),
    ("spot-cutoff", Guard::SpotCutoff),
    ("texture-1d", Guard::Texture1d),
    ("clip-plane", Guard::ClipPlane),
    ("stencil", Guard::Stencil),
    ("cull", Guard::Cull),
    ("fragment", Guard::Fragment),
    ("none", Guard::None),
];

impl Guard {
    /// Reads `guard`.
    ///
    /// # Errors
    ///
    /// Another name, with its place.
    pub fn read(keys: &mut Reader<'_>) -> Result<Self, SettingsError> {
        Ok(keys.choice("guard", &NAMES)?.unwrap_or_default())
    }

    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, guard)| *guard == self).map_or("", |(name, _)| name)
    }
}

/// Side of the light's plane on which all points of something lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// q > 0, beyond what rounding moves.
    Before,
    /// q < 0, likewise.
    Behind,
    /// On both sides, or too near to the plane to decide.
    Across,
}

/// Error of q, as a share of the sum of its terms: 2^-24 for each of some ten roundings in f32, times what interpolation
/// across a triangle that ends near the eye adds to them. Items closer to the plane than this use the per-fragment test.
const MARGIN: f64 = 1.0 / 16384.0;

/// A spotlight's plane for one viewer.
#[derive(Clone, Copy, Debug)]
pub struct LightPlane {
    /// q of a point in eye space: its product with this.
    pub q_from_eye: DVec4,
    /// The same with the absolute values of all terms.
    sizes: DVec4,
}

impl LightPlane {
    /// The plane of a light; `None` for a light without one, or whose coordinates cannot be generated.
    pub fn of(coordinates: Option<&Coordinates>, bounded: bool, viewer: &Viewer) -> Option<Self> {
        let coordinates = coordinates.filter(|_| bounded)?;
        let texgen = texgen::set_up(&coordinates.spaces(viewer.eye_from_world), coordinates.set_up, coordinates.split)?;
        let sizes = abs(&texgen.texture_matrix) * abs(&texgen.eye_planes);
        Some(Self { q_from_eye: (texgen.texture_matrix * texgen.eye_planes).row(3), sizes: sizes.row(3) })
    }

    pub fn side(&self, item: &Drawable, viewer: &Viewer) -> Side {
        let sides = self.in_model(item, viewer);
        sides.of(&item.bounds.corners())
    }

    /// The plane in an item's model space.
    pub fn in_model(&self, item: &Drawable, viewer: &Viewer) -> ModelPlane {
        let eye_from_model = viewer.eye_from_world * item.world_from_model;
        let q = eye_from_model.transpose() * self.q_from_eye;
        let sizes = abs(&eye_from_model).transpose() * self.sizes;
        let corners = item.bounds.corners().into_iter();
        let size = corners.map(|corner| sizes.dot(corner.abs().extend(1.0))).fold(0.0, f64::max);
        ModelPlane { q, margin: MARGIN * size }
    }

    /// The greatest |q| of `items`.
    pub fn extent(&self, items: &[Drawable], viewer: &Viewer) -> f64 {
        let of = |item: &Drawable| {
            let plane = self.in_model(item, viewer);
            item.bounds.corners().map(|corner| plane.q.dot(corner.extend(1.0)).abs())
        };
        items.iter().flat_map(of).fold(0.0, f64::max)
    }
}

/// [`LightPlane`] in a model's space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelPlane {
    pub q: DVec4,
    pub margin: f64,
}

impl ModelPlane {
    /// The same plane for every eye: rounded so that f64 errors on the way from the eye vanish, far below the margin.
    pub fn rounded(&self) -> Self {
        Self { q: self.q.as_vec4().as_dvec4(), margin: self.margin.log2().ceil().exp2() }
    }

    /// Side on which the hull of `points` lies.
    pub fn of(&self, points: &[DVec3]) -> Side {
        let all = |lies: &dyn Fn(f64) -> bool| points.iter().all(|point| lies(self.q.dot(point.extend(1.0))));
        if all(&|q| q > self.margin) {
            Side::Before
        } else if all(&|q| q < -self.margin) {
            Side::Behind
        } else {
            Side::Across
        }
    }
}

fn abs(matrix: &DMat4) -> DMat4 {
    DMat4::from_cols_array(&matrix.to_cols_array().map(f64::abs))
}
