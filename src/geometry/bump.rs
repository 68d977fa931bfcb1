//! Bump maps of materials: where the normals come from, their texels for GL, and the gloss.

use std::sync::Arc;

use super::normal_map::{Difference, HeightField, HeightWrap, MipColors, NormalLevel};
use super::{Texture, normal_map};

/// Bumps of a surface, in its tangent space.
#[derive(Clone, Debug)]
pub struct Bump {
    /// Origin of the normals.
    pub source: BumpSource,
    /// Format of `map`.
    pub format: NormalFormat,
    /// Colours of levels below the first.
    pub colors: MipColors,
    /// Texels beyond [0, 1], of the map as of its heights.
    pub border: HeightWrap,
    /// Fit of the triangles' tangent bases to the vertices' normals.
    pub fit: BasisFit,
    /// All levels as GL takes them.
    pub map: Arc<TexelLevels>,
}

/// Origin of a bump map's normals.
#[derive(Clone, Debug, PartialEq)]
pub enum BumpSource {
    /// Slopes of a height field. `scale`: height of 1, in texels.
    Heights { field: HeightField, scale: f64, difference: Difference },
    /// A normal map, made of a picture's colours.
    Normals { name: String, normals: NormalLevel },
}

/// Format of a normal map's texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalFormat {
    /// GL_RGBA8_SNORM: 0 is exact, and so is the normal of a flat surface.
    #[default]
    Signed,
    /// GL_RGBA8, x as (x + 1) / 2: a flat surface is tilted by a third of a degree.
    Unsigned,
}

/// A texture with all its levels, four bytes a texel, rows from the bottom up.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelLevels {
    /// The file's path, for messages.
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// True if a byte is two's complement.
    pub is_signed: bool,
    /// Level 0 first, down to 1 × 1.
    pub levels: Vec<Vec<[u8; 4]>>,
}

/// Fit of a triangle's basis to the normals of its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BasisFit {
    /// None: the triangle's own normal. Facets show.
    PerPolygon,
    /// N is the vertex's normal; T is moved into its plane; B is at right angles to both.
    #[default]
    Orthogonal,
    /// N is the vertex's normal; T and B are each moved into its plane, and keep their angle nearly.
    Skewed,
}

/// Share of the specular light that a surface reflects, from place to place.
#[derive(Clone, Debug, PartialEq)]
pub enum Gloss {
    /// The decal's alpha. It joins no alpha test then.
    DecalAlpha,
    /// A picture: its alpha where it has one, else its red channel.
    Map(Arc<Texture>),
}

impl BumpSource {
    /// The normals in a picture's colours. `green_down`: y points down, as in Direct3D's maps.
    pub fn normals(texture: &Texture, green_down: bool) -> Self {
        let normals = NormalLevel::from_colors(texture.width, texture.height, &texture.rgba, green_down);
        Self::Normals { name: texture.name.clone(), normals }
    }
}

impl PartialEq for Bump {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.map, &other.map) && self.fit == other.fit
    }
}

impl Bump {
    /// Makes the map of `source`.
    pub fn new(source: BumpSource, format: NormalFormat, colors: MipColors, border: HeightWrap, fit: BasisFit) -> Self {
        let (name, normals) = match &source {
            BumpSource::Heights { field, scale, difference } => {
                (field.name.clone(), field.normals(*scale, *difference, border))
            }
            BumpSource::Normals { name, normals } => (name.clone(), normals.clone()),
        };
        let map = Arc::new(TexelLevels::of_normals(name, normals, format, colors));
        Self { source, format, colors, border, fit, map }
    }

    /// The size in texels of level 0.
    pub fn size(&self) -> [u32; 2] {
        [self.map.width, self.map.height]
    }
}

impl TexelLevels {
    fn of_normals(name: String, normals: NormalLevel, format: NormalFormat, colors: MipColors) -> Self {
        let (width, height) = (normals.width, normals.height);
        let packed = |level: &normal_map::NormalLevel| match format {
            NormalFormat::Unsigned => level.unsigned(colors),
            NormalFormat::Signed => bytemuck::cast_vec(level.signed(colors)),
        };
        let levels = normals.levels().iter().map(packed).collect();
        Self { name, width, height, is_signed: format == NormalFormat::Signed, levels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_one_texel_and_flat_is_exact_when_signed() {
        let field = HeightField { name: String::from("flat"), width: 5, height: 3, heights: vec![0.25; 15] };
        for (format, up) in [(NormalFormat::Signed, [0, 0, 127, 127]), (NormalFormat::Unsigned, [128, 128, 255, 255])] {
            let source = BumpSource::Heights { field: field.clone(), scale: 5.0, difference: Difference::Central };
            let bump = Bump::new(source, format, MipColors::default(), HeightWrap::Repeat, BasisFit::default());
            let sizes: Vec<usize> = bump.map.levels.iter().map(Vec::len).collect();
            assert_eq!(sizes, [15, 2, 1]);
            assert!(bump.map.levels.iter().flatten().all(|texel| *texel == up));
        }
    }
}
