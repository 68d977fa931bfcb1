//! Materials, in the terms of fixed-function GL and of MTL.

use std::sync::Arc;

use glam::DVec3;

use super::{Bump, Gloss, Texture};

/// Colours are linear and as written (no colour management), each channel in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    /// Ka; multiplies the scene's and each light's ambient light.
    pub ambient: [f32; 3],
    /// Kd.
    pub diffuse: [f32; 3],
    /// Ks; black: the specular term is left out.
    pub specular: [f32; 3],
    /// Ns, the specular exponent, in [0, 1000].
    pub shininess: f32,
    /// d in [0, 1]; fragments with `opacity * decal alpha * map_d < 0.5` fail the alpha test.
    pub opacity: f32,
    /// map_Kd, modulates ambient and diffuse. Its alpha joins the alpha test.
    pub decal: Option<Arc<Texture>>,
    /// map_d: its red channel (its alpha where it has one) joins the alpha test.
    pub alpha: Option<Arc<Texture>>,
    /// Generates the decal's coordinates in place of the mesh's own.
    pub texgen: Option<ObjectLinear>,
    /// Placement of the decal on its coordinates.
    pub decal_placement: Placement,
    /// Placement of map_d on the same coordinates.
    pub alpha_placement: Placement,
    /// Bumps of the surface, in its tangent space.
    pub bump: Option<Arc<Bump>>,
    /// Share of the specular light from place to place; `None`: all of it.
    pub gloss: Option<Gloss>,
    /// Line that sets `opacity`, for messages: `file:line: statement`; empty: nowhere.
    pub opacity_origin: String,
}

impl Material {
    /// The greatest alpha that the alpha test may meet; below 0.5 it discards all.
    pub fn most_alpha(&self, has_texcoords: bool) -> f32 {
        let most = |texture: &Option<Arc<Texture>>, channel: usize| match texture {
            Some(texture) if has_texcoords || self.texgen.is_some() => texture.most(channel),
            _ => 1.0,
        };
        let map_channel = self.alpha.as_ref().map_or(0, |alpha| alpha.alpha_channel());
        let decal = if self.decal_joins_alpha_test() { most(&self.decal, 3) } else { 1.0 };
        self.opacity * decal * most(&self.alpha, map_channel)
    }

    /// Tests whether the alpha test reads the decal's alpha: unless that is a gloss map.
    pub fn decal_joins_alpha_test(&self) -> bool {
        self.gloss != Some(Gloss::DecalAlpha) && self.decal.as_ref().is_some_and(|decal| decal.has_alpha)
    }
}

/// Placement of a texture on a surface, and whether it repeats (MTL's -s, -o and -clamp).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Multiplies (s, t).
    pub scale: [f32; 2],
    /// Offset, added after the scale.
    pub offset: [f32; 2],
    /// True if the texture's edge continues beyond [0, 1], instead of repeats.
    pub clamped: bool,
}

impl Default for Placement {
    fn default() -> Self {
        Self { scale: [1.0; 2], offset: [0.0; 2], clamped: false }
    }
}

impl Placement {
    /// Tests whether the coordinates are looked up as they are.
    pub fn is_plain(&self) -> bool {
        self.scale == [1.0; 2] && self.offset == [0.0; 2]
    }

    /// Scale and offset, as shaders take them.
    pub fn scale_and_offset(&self) -> [f32; 4] {
        let ([sx, sy], [ox, oy]) = (self.scale, self.offset);
        [sx, sy, ox, oy]
    }
}

/// glTexGen GL_OBJECT_LINEAR for s and t, and a texture matrix that scales both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectLinear {
    /// Plane of s, in model space.
    pub s: [f32; 4],
    /// Plane of t, in model space.
    pub t: [f32; 4],
    pub scale: f32,
}

impl ObjectLinear {
    /// (s, t) of a position in model space.
    pub fn texcoord(&self, position: [f32; 3]) -> [f64; 2] {
        let [x, y, z] = position.map(f64::from);
        [self.s, self.t].map(|plane| {
            let [a, b, c, d] = plane.map(f64::from);
            f64::from(self.scale) * (a * x + b * y + c * z + d)
        })
    }

    /// The same coordinates for positions that are relative to `origin`, except for whole repeats of a texture.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        let scale = f64::from(self.scale);
        let moved = |plane: [f32; 4]| {
            let [x, y, z, w] = plane.map(f64::from);
            let w = w + DVec3::new(x, y, z).dot(origin);
            let w = if scale == 0.0 { w } else { (w * scale).rem_euclid(1.0) / scale };
            [plane[0], plane[1], plane[2], w as f32]
        };
        if origin == DVec3::ZERO { *self } else { Self { s: moved(self.s), t: moved(self.t), scale: self.scale } }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::from("default"),
            ambient: [0.8; 3],
            diffuse: [0.8; 3],
            specular: [0.0; 3],
            shininess: 32.0,
            opacity: 1.0,
            decal: None,
            alpha: None,
            texgen: None,
            decal_placement: Placement::default(),
            alpha_placement: Placement::default(),
            bump: None,
            gloss: None,
            opacity_origin: String::new(),
        }
    }
}
