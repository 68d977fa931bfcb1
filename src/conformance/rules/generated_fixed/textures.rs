//! Textures of every base format and target, and look-ups in the model.

use glam::DVec4;

use super::environment::{Color, Texel, exact, hull};
use super::state::{FixedState, TextureState};
use crate::conformance::bench::fixed_commands::FixedTexture;
use crate::conformance::random::Random;
use crate::conformance::verify::cube;
use crate::context::compatibility::raw;

/// Target, internal format, and sides.
const SPECS: [(u32, u32, [u32; 3]); 15] = [
    (glow::TEXTURE_2D, glow::RGBA8, [4, 4, 1]),
    (glow::TEXTURE_2D, glow::RGB8, [8, 2, 1]),
    (glow::TEXTURE_2D, raw::ALPHA8, [2, 4, 1]),
    (glow::TEXTURE_2D, raw::LUMINANCE8, [4, 4, 1]),
    (glow::TEXTURE_2D, raw::LUMINANCE8_ALPHA8, [3, 5, 1]),
    (glow::TEXTURE_2D, raw::INTENSITY8, [4, 2, 1]),
    (glow::TEXTURE_2D, glow::RGBA8, [1, 1, 1]),
    (glow::TEXTURE_2D, glow::DEPTH_COMPONENT24, [4, 4, 1]),
    (glow::TEXTURE_2D, glow::DEPTH_COMPONENT16, [2, 3, 1]),
    (glow::TEXTURE_1D, glow::RGBA8, [8, 1, 1]),
    (glow::TEXTURE_1D, raw::LUMINANCE8, [4, 1, 1]),
    (glow::TEXTURE_3D, glow::RGB8, [4, 2, 3]),
    (glow::TEXTURE_3D, raw::LUMINANCE8_ALPHA8, [2, 2, 2]),
    (glow::TEXTURE_CUBE_MAP, glow::RGBA8, [4, 4, 6]),
    (glow::TEXTURE_CUBE_MAP, raw::INTENSITY8, [2, 2, 6]),
];

/// Place in a texel's units that may be off, and the share of the coordinate.
const NEAR: [f64; 2] = [1.0 / 64.0, 1e-5];

fn base(format: u32) -> u32 {
    match format {
        glow::RGBA8 => glow::RGBA,
        glow::RGB8 => glow::RGB,
        raw::ALPHA8 => glow::ALPHA,
        raw::LUMINANCE8 => raw::LUMINANCE,
        raw::LUMINANCE8_ALPHA8 => raw::LUMINANCE_ALPHA,
        raw::INTENSITY8 => raw::INTENSITY,
        _ => glow::DEPTH_COMPONENT,
    }
}

/// All textures, of random texels.
pub fn textures(random: &mut Random) -> Vec<FixedTexture> {
    let mut code = || random.pick(&[0, 255, 64, 128, 191, 100, 200, 30]);
    let of = |(target, format, size): (u32, u32, [u32; 3])| {
        let count = size.iter().product::<u32>();
        let is_depth = base(format) == glow::DEPTH_COMPONENT;
        let texels: Vec<[u8; 4]> = (0..count).map(|_| [(); 4].map(|()| code())).collect();
        let depths =
            if is_depth { texels.iter().map(|texel| f32::from(texel[0]) / 255.0).collect() } else { Vec::new() };
        FixedTexture { target, format, size, texels, depths }
    };
    SPECS.into_iter().map(of).collect()
}

/// A texel as the formats keep it [GL 4.6 compatibility, tables 8.11 and 16.1].
fn kept(base: u32, [red, green, blue, alpha]: [f64; 4]) -> [f64; 4] {
    match base {
        glow::ALPHA => [0.0, 0.0, 0.0, alpha],
        raw::LUMINANCE => [red, red, red, 1.0],
        raw::LUMINANCE_ALPHA => [red, red, red, alpha],
        raw::INTENSITY => [red; 4],
        glow::RGB => [red, green, blue, 1.0],
        _ => [red, green, blue, alpha],
    }
}

/// A look-up's texture and its parameters.
struct Look<'a> {
    texture: &'a FixedTexture,
    state: TextureState,
    /// Depth to compare with.
    reference: f64,
}

impl FixedState {
    /// The texel that a unit finds; `None`: its coordinates have no bound.
    pub fn texel(&self, slot: usize, texture: &FixedTexture, at: DVec4) -> Option<Texel> {
        let state = self.textures[slot];
        let own = base(texture.format);
        // A depth texture is what its mode says; red alone is RGB for the environment.
        let base = match own {
            glow::DEPTH_COMPONENT if state.mode == glow::RED => glow::RGB,
            glow::DEPTH_COMPONENT => state.mode,
            base => base,
        };
        let is_cube = texture.target == glow::TEXTURE_CUBE_MAP;
        // A driver may divide directions by q, too.
        if !at.is_finite() || at.w < 0.1 {
            return None;
        }
        let place = if is_cube { at.truncate() } else { at.truncate() / at.w };
        let look = Look { texture, state, reference: place.z.clamp(0.0, 1.0) };
        if !is_cube {
            return Some(Texel { base, color: look.in_layer(0, place.to_array())? });
        }
        if place.abs().max_element() < 0.05 {
            return None;
        }
        let side = f64::from(texture.size[0]);
        let faces: Vec<usize> = near_faces(place.to_array()).collect();
        let colors = faces.into_iter().flat_map(|face| {
            let [s, t] = cube::on_face(face, place.to_array()).map(|at| at.clamp(0.0, 1.0 - 1e-9));
            look.in_layer(face, [s, t, 0.5 / side])
        });
        Some(Texel { base, color: colors.reduce(either)? })
    }
}

/// Faces that a direction may select.
fn near_faces(direction: [f64; 3]) -> impl Iterator<Item = usize> {
    let most = direction.into_iter().map(f64::abs).fold(0.0, f64::max);
    (0..6).filter(move |face| {
        let along = direction[face / 2] * if face % 2 == 0 { 1.0 } else { -1.0 };
        along >= most * (1.0 - 1e-4)
    })
}

fn either(one: Color, other: Color) -> Color {
    std::array::from_fn(|channel| hull(one[channel], other[channel]))
}

impl Look<'_> {
    fn dimensions(&self) -> usize {
        match self.texture.target {
            glow::TEXTURE_1D => 1,
            glow::TEXTURE_3D => 3,
            _ => 2,
        }
    }

    /// A look-up within a layer of a cube map, or in all of another texture.
    fn in_layer(&self, layer: usize, place: [f64; 3]) -> Option<Color> {
        let count = self.dimensions();
        if place[..count].iter().any(|at| at.abs() > 1e3) {
            return None;
        }
        // Along each axis: indices with the least and greatest weight of the second of them.
        let axes: Vec<([i64; 2], [f64; 2])> = (0..count).map(|axis| self.along(axis, place[axis])).collect();
        let mut result: Option<Color> = None;
        for corner in 0..1_usize << count {
            let weights: Vec<f64> = axes.iter().enumerate().map(|(axis, (_, of))| of[corner >> axis & 1]).collect();
            let mut sum = [exact(0.0); 4];
            for which in 0..1_usize << count {
                let side = |axis: usize| which >> axis & 1;
                let share: f64 =
                    (0..count).map(|axis| if side(axis) == 1 { weights[axis] } else { 1.0 - weights[axis] }).product();
                if share == 0.0 {
                    continue;
                }
                let index = std::array::from_fn(|axis| if axis < count { axes[axis].0[side(axis)] } else { 0 });
                let texel = self.texel(layer, index);
                for (sum, channel) in sum.iter_mut().zip(texel) {
                    *sum = [sum[0] + share * channel[0], sum[1] + share * channel[1]];
                }
            }
            result = Some(result.map_or(sum, |other| either(other, sum)));
        }
        result
    }

    /// Two texels along an axis, -1 or beyond for the border, and the weights that the second may have.
    fn along(&self, axis: usize, place: f64) -> ([i64; 2], [f64; 2]) {
        let wrap = self.state.wrap[axis];
        let size = f64::from(self.texture.size[axis]);
        // GL_CLAMP clamps the coordinate itself [GL 4.6 compatibility, 8.14.2].
        let place = if wrap == raw::CLAMP { place.clamp(0.0, 1.0) } else { place };
        let texels = place * size;
        let near = NEAR[0] + NEAR[1] * texels.abs();
        let wrapped = |index: i64| self.wrapped(axis, index);
        if self.state.linear {
            let low = (texels - 0.5).floor();
            let part = texels - 0.5 - low;
            let weights = [part - near, part + near].map(|weight| weight.clamp(0.0, 1.0));
            let low = low as i64;
            return ([wrapped(low), wrapped(low + 1)], weights);
        }
        let last = size as i64 - 1;
        let ends = [texels - near, texels + near].map(|at| at.floor() as i64);
        let ends = if wrap == raw::CLAMP { ends.map(|end| end.clamp(0, last)) } else { ends };
        (ends.map(wrapped), if ends[0] == ends[1] { [0.0; 2] } else { [0.0, 1.0] })
    }

    fn wrapped(&self, axis: usize, index: i64) -> i64 {
        let size = i64::from(self.texture.size[axis]);
        match self.state.wrap[axis] {
            glow::REPEAT => index.rem_euclid(size),
            glow::MIRRORED_REPEAT => {
                let turned = index.rem_euclid(2 * size);
                if turned < size { turned } else { 2 * size - 1 - turned }
            }
            glow::CLAMP_TO_EDGE => index.clamp(0, size - 1),
            _ if (0..size).contains(&index) => index,
            _ => -1,
        }
    }

    fn texel(&self, layer: usize, [x, y, z]: [i64; 3]) -> Color {
        let [width, height, _] = self.texture.size.map(i64::from);
        let own = base(self.texture.format);
        let is_border = [x, y, z].contains(&-1);
        let index = (((z + layer as i64) * height + y) * width + x).max(0) as usize;
        if own != glow::DEPTH_COMPONENT {
            let stored = if is_border { [0; 4] } else { self.texture.texels[index] };
            return kept(own, stored.map(|code| f64::from(code) / 255.0)).map(exact);
        }
        let depth = if is_border { 0.0 } else { f64::from(self.texture.depths[index]) };
        let mut value = exact(depth);
        if self.state.compares {
            let near = (self.reference - depth).abs() < 1e-4;
            let passes = match self.state.function {
                glow::NEVER => Some(false),
                glow::ALWAYS => Some(true),
                _ if near => None,
                glow::EQUAL => Some(false),
                glow::NOTEQUAL => Some(true),
                glow::LESS | glow::LEQUAL => Some(self.reference < depth),
                _ => Some(self.reference > depth),
            };
            value = passes.map_or([0.0, 1.0], |passes| exact(f64::from(u8::from(passes))));
        }
        let (zero, one) = (exact(0.0), exact(1.0));
        match self.state.mode {
            raw::LUMINANCE => [value, value, value, one],
            raw::INTENSITY => [value; 4],
            glow::ALPHA => [zero, zero, zero, value],
            _ => [value, zero, zero, one],
        }
    }
}
