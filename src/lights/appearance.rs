//! Appearance of items: all that decides how their fragments look, wherever they are placed. Items of one appearance share
//! their shaders.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::geometry::{Bump, Gloss, Material, Texture};

/// Material of an item and the data that its mesh has for it. Equal where the material is the same one.
#[derive(Clone, Copy, Debug)]
pub struct Appearance<'a> {
    pub material: &'a Arc<Material>,
    /// See [`crate::scene::Object::lit`].
    pub lit: bool,
    /// True if a wave moves its vertices in the vertex stage.
    pub waves: bool,
    /// True if its mesh has texture coordinates, tangents and bitangents, or colours of its vertices.
    pub mesh_has: [bool; 3],
}

impl<'a> Appearance<'a> {
    /// Tests whether fragments of it may fail the alpha test.
    pub fn needs_alpha_test(&self) -> bool {
        self.material.alpha.is_some() || self.decal_alpha()
    }

    /// Tests whether its mesh has, or its material makes, texture coordinates.
    pub fn has_texcoords(&self) -> bool {
        self.mesh_has[0] || self.material.texgen.is_some()
    }

    /// Tests whether its mesh has tangents and bitangents.
    pub fn has_bases(&self) -> bool {
        self.mesh_has[1]
    }

    /// Tests whether colours of its vertices multiply those of its material.
    pub fn has_colors(&self) -> bool {
        self.mesh_has[2]
    }

    /// The decal, where there are coordinates for it.
    pub fn decal(&self) -> Option<&'a Arc<Texture>> {
        self.material.decal.as_ref().filter(|_| self.has_texcoords())
    }

    /// The bump map, where it has coordinates and bases.
    pub fn bump(&self) -> Option<&'a Arc<Bump>> {
        self.material.bump.as_ref().filter(|_| self.has_texcoords() && self.has_bases())
    }

    /// The gloss, where there are coordinates for it.
    pub fn gloss(&self) -> Option<&'a Gloss> {
        self.material.gloss.as_ref().filter(|_| self.has_texcoords())
    }

    /// Tests whether the alpha test reads the decal.
    pub fn decal_alpha(&self) -> bool {
        self.decal().is_some() && self.material.decal_joins_alpha_test()
    }

    fn key(&self) -> (*const Material, [bool; 5]) {
        let [texcoords, bases, colors] = self.mesh_has;
        (Arc::as_ptr(self.material), [self.lit, self.waves, texcoords, bases, colors])
    }
}

impl PartialEq for Appearance<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Appearance<'_> {}

impl Hash for Appearance<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}
