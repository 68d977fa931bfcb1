//! The alpha test: `opacity * decal alpha * map_d < 0.5` lets light and sight through. Exact bounds of the product
//! over a small box of texture coordinates, so that an answer near the level is known to be near it.

use std::sync::Arc;

use glam::DVec2;

use crate::geometry::{Material, ObjectLinear, Placement, Texture};

/// GL filters RGBA8 with weights of at least 8 bits and rounds nothing else: 1/256 of the texels' range a direction.
const FILTER_ERROR: f64 = 2.0 / 256.0;
/// A box over more texels a side than this is not looked at: its alpha counts as unknown.
const MOST_CELLS: f64 = 16.0;

/// The least and the greatest alpha over a box, and the alpha in its middle; each in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Alpha {
    pub least: f64,
    pub most: f64,
    pub middle: f64,
}

impl Alpha {
    pub const OPAQUE: Self = Self { least: 1.0, most: 1.0, middle: 1.0 };

    pub fn surely_opaque(self) -> bool {
        self.least >= 0.5
    }

    pub fn surely_clear(self) -> bool {
        self.most < 0.5
    }

    /// GL's rule at the middle.
    pub fn passes_test(self) -> bool {
        self.middle >= 0.5
    }

    fn times(self, other: Self) -> Self {
        Self { least: self.least * other.least, most: self.most * other.most, middle: self.middle * other.middle }
    }
}

/// A material's alpha test.
pub(super) struct AlphaCutout {
    opacity: f64,
    textures: Vec<CutoutTexture>,
    /// Generated coordinates, in place of the mesh's own.
    texgen: Option<ObjectLinear>,
}

/// A texture, the channel of it that counts, and where it lies.
struct CutoutTexture {
    texture: Arc<Texture>,
    channel: usize,
    placement: Placement,
}

impl AlphaCutout {
    /// `None`: no fragment of this material can fail the test. Textures need `has_texcoords`, or planes of the material's.
    pub fn new(material: &Material, has_texcoords: bool) -> Option<Self> {
        let has_texcoords = has_texcoords || material.texgen.is_some();
        let mut textures = Vec::new();
        if let Some(decal) = material.decal.as_ref().filter(|_| has_texcoords && material.decal_joins_alpha_test()) {
            textures.push(CutoutTexture { texture: decal.clone(), channel: 3, placement: material.decal_placement });
        }
        if let Some(alpha) = material.alpha.as_ref().filter(|_| has_texcoords) {
            let channel = if alpha.has_alpha { 3 } else { 0 };
            textures.push(CutoutTexture { texture: alpha.clone(), channel, placement: material.alpha_placement });
        }
        textures.retain(|layer| is_whole(&layer.texture));
        let opacity = f64::from(material.opacity);
        (opacity < 0.5 || !textures.is_empty()).then_some(Self { opacity, textures, texgen: material.texgen })
    }

    /// The coordinates at a vertex, by its place in the mesh before any wave moves it; `None`: the mesh's own.
    pub fn texcoord_at(&self, position: [f32; 3]) -> Option<DVec2> {
        let texgen = self.texgen.as_ref()?;
        let [x, y, z] = position.map(f64::from);
        let on = |plane: [f32; 4]| {
            let [a, b, c, d] = plane.map(f64::from);
            a * x + b * y + c * z + d
        };
        Some(f64::from(texgen.scale) * DVec2::new(on(texgen.s), on(texgen.t)))
    }

    /// Over the box of texture coordinates `middle ± reach`.
    pub fn alpha(&self, middle: DVec2, reach: DVec2) -> Alpha {
        let opacity = Alpha { least: self.opacity, most: self.opacity, middle: self.opacity };
        self.textures.iter().fold(opacity, |alpha, layer| alpha.times(layer.bound(middle, reach)))
    }
}

fn is_whole(texture: &Texture) -> bool {
    let texels = texture.width as usize * texture.height as usize;
    texels > 0 && texture.rgba.len() == 4 * texels
}

impl CutoutTexture {
    /// Between texel centres the filtered value is bilinear, so over a box its extremes lie at the corners of the pieces
    /// that the texel grid cuts the box into: looking there is exact. The coordinates are the surface's.
    fn bound(&self, middle: DVec2, reach: DVec2) -> Alpha {
        let (middle, reach) = self.placed(middle, reach);
        let size = DVec2::new(f64::from(self.texture.width), f64::from(self.texture.height));
        let (low, high) = ((middle - reach) * size - 0.5, (middle + reach) * size - 0.5);
        let unknown = Alpha { least: 0.0, most: 1.0, middle: 0.0 };
        if !(middle.is_finite() && low.is_finite() && high.is_finite()) {
            return unknown;
        }
        let at_middle = self.lookup(middle * size - 0.5);
        // Beyond a clamped texture, values are constant along each axis.
        let (low, high) = match self.placement.clamped {
            true => (low.clamp(DVec2::ZERO, size - 1.0), high.clamp(DVec2::ZERO, size - 1.0)),
            false => (low, high),
        };
        if (high - low).max_element() > MOST_CELLS {
            return Alpha { middle: at_middle, ..unknown };
        }
        let (mut least, mut most) = (at_middle, at_middle);
        for y in stops(low.y, high.y) {
            for x in stops(low.x, high.x) {
                let value = self.lookup(DVec2::new(x, y));
                (least, most) = (least.min(value), most.max(value));
            }
        }
        Alpha { least: (least - FILTER_ERROR).max(0.0), most: (most + FILTER_ERROR).min(1.0), middle: at_middle }
    }

    /// A box of the surface's coordinates as one of the texture's, with what f32 rounds on the way.
    fn placed(&self, middle: DVec2, reach: DVec2) -> (DVec2, DVec2) {
        if self.placement.is_plain() {
            return (middle, reach);
        }
        let pair = |pair: [f32; 2]| DVec2::from_array(pair.map(f64::from));
        let (scale, offset) = (pair(self.placement.scale), pair(self.placement.offset));
        let rounded = (scale * middle).abs() + offset.abs();
        (scale * middle + offset, scale.abs() * reach + 2.0 * f64::from(f32::EPSILON) * rounded)
    }

    /// GL's LINEAR; `texel` in texels, whole numbers at the centres.
    fn lookup(&self, texel: DVec2) -> f64 {
        let texture = &self.texture;
        let corner = texel.floor();
        let weight = texel - corner;
        let wrap = |value: f64, size: u32| match self.placement.clamped {
            true => value.clamp(0.0, f64::from(size) - 1.0) as usize,
            false => value.rem_euclid(f64::from(size)) as usize % size as usize,
        };
        let fetch = |dx: f64, dy: f64| {
            let x = wrap(corner.x + dx, texture.width);
            let y = wrap(corner.y + dy, texture.height);
            let byte = texture.rgba.get(4 * (y * texture.width as usize + x) + self.channel).copied();
            f64::from(byte.unwrap_or(0)) / 255.0
        };
        let bottom = fetch(0.0, 0.0) * (1.0 - weight.x) + fetch(1.0, 0.0) * weight.x;
        let top = fetch(0.0, 1.0) * (1.0 - weight.x) + fetch(1.0, 1.0) * weight.x;
        bottom * (1.0 - weight.y) + top * weight.y
    }
}

/// Both ends and each whole number between them.
fn stops(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let between = (high.floor() - low.ceil() + 1.0).max(0.0) as u32;
    [low, high].into_iter().chain((0..between).map(move |i| low.ceil() + f64::from(i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checker(placement: Placement) -> CutoutTexture {
        let rgba = [0u8, 255, 255, 0].iter().flat_map(|&a| [255, 255, 255, a]).collect();
        let texture = Texture { name: String::from("checker"), width: 2, height: 2, rgba, has_alpha: true };
        CutoutTexture { texture: Arc::new(texture), channel: 3, placement }
    }

    #[test]
    fn lookup_at_centers_edges_and_wrapped() {
        let checker = checker(Placement::default());
        for (s, t, expected) in
            [(0.25, 0.25, 0.0), (0.75, 0.25, 1.0), (0.5, 0.25, 0.5), (0.0, 0.25, 0.5), (1.75, -0.75, 1.0)]
        {
            let value = checker.lookup(DVec2::new(s, t) * 2.0 - 0.5);
            assert!((value - expected).abs() < 1e-12, "({s}, {t}): {value}");
        }
    }

    #[test]
    fn placed_textures_are_scaled_moved_and_clamped() {
        let checker = checker(Placement { scale: [2.0, -1.0], offset: [0.5, 1.0], clamped: true });
        for (s, t, expected) in [(-0.125, 0.75, 0.0), (0.125, 0.75, 1.0), (9.0, 9.0, 1.0), (-9.0, 9.0, 0.0)] {
            let found = checker.bound(DVec2::new(s, t), DVec2::splat(1e-3));
            assert!((found.middle - expected).abs() < 1e-6, "({s}, {t}): {found:?}");
            assert!(found.least <= expected && expected <= found.most, "({s}, {t}): {found:?}");
        }
    }

    #[test]
    fn bounds_hold_every_value_of_the_box() {
        let placed = Placement { scale: [1.5, 0.75], offset: [-0.25, 0.125], clamped: false };
        for placement in [Placement::default(), placed, Placement { clamped: true, ..placed }] {
            let checker = checker(placement);
            let (middle, reach) = (DVec2::new(0.4, 0.6), DVec2::new(0.3, 0.2));
            let bound = checker.bound(middle, reach);
            for (i, j) in (0..=100).flat_map(|i| (0..=100).map(move |j| (i, j))) {
                let at = middle + reach * (DVec2::new(f64::from(i), f64::from(j)) / 50.0 - 1.0);
                let value = checker.lookup(checker.placed(at, DVec2::ZERO).0 * 2.0 - 0.5);
                assert!(bound.least <= value && value <= bound.most);
            }
        }
    }

    #[test]
    fn plain_materials_have_no_test_and_faint_ones_always_fail() {
        assert!(AlphaCutout::new(&Material::default(), true).is_none());
        let faint = AlphaCutout::new(&Material { opacity: 0.4, ..Material::default() }, false);
        assert!(faint.is_some_and(|cutout| cutout.alpha(DVec2::ZERO, DVec2::ZERO).surely_clear()));
    }
}
