//! Images of the model: what each texel holds, with a bound of error.

use std::sync::Arc;

use super::glsl::Unknown;
use crate::conformance::model::number::{Num, ROUNDING, SLACK};
use crate::geometry::normal_cube;
use crate::pass::{CubeFace, DepthFormat, Format, ImageDesc, Storage};

/// One level of one face.
#[derive(Clone, Debug, Default)]
pub struct Plane {
    pub size: [usize; 2],
    /// Red, green, blue, alpha; empty where the format has none.
    pub color: Vec<[Num; 4]>,
    pub depth: Vec<Num>,
    /// The fragment whose depth is stored: those of one number have the same depth to the bit. 0: none.
    pub makers: Vec<u64>,
    pub stencil: Vec<Option<u8>>,
}

impl Plane {
    fn unknown(format: Format, size: [usize; 2]) -> Self {
        let count = size[0] * size[1];
        let mut plane = Self { size, ..Self::default() };
        if format.has_depth() {
            plane.depth = vec![Num::UNKNOWN; count];
            plane.makers = vec![0; count];
            if format == Format::Depth24Stencil8 {
                plane.stencil = vec![None; count];
            }
        } else {
            plane.color = vec![[Num::UNKNOWN; 4]; count];
        }
        plane
    }

    /// The texel as a shader gets it.
    pub fn texel(&self, [x, y]: [usize; 2]) -> [Num; 4] {
        let index = y * self.size[0] + x;
        match self.depth.get(index) {
            Some(depth) => [*depth, Num::exact(0.0), Num::exact(0.0), Num::exact(1.0)],
            None => self.color[index],
        }
    }
}

/// An image: its levels, each with its faces.
#[derive(Clone, Debug)]
pub struct Image {
    pub format: Format,
    pub planes: Vec<Plane>,
    pub faces: usize,
}

impl Image {
    /// The image as the device makes it.
    pub fn new(desc: &ImageDesc) -> Result<Self, Unknown> {
        let size = desc.size.map(|side| side as usize);
        let level_size = |level: usize| size.map(|side| (side >> level).max(1));
        let format = desc.format;
        let (planes, faces) = match &desc.storage {
            Storage::Texture | Storage::Renderbuffer => (vec![Plane::unknown(format, size)], 1),
            Storage::Mipmapped(levels) => {
                ((0..*levels as usize).map(|level| Plane::unknown(format, level_size(level))).collect(), 1)
            }
            Storage::Cube(cube) => {
                let face = |drawn: bool| {
                    let mut plane = Plane::unknown(format, size);
                    if !drawn {
                        plane.depth.fill(stored_depth(format, Num::exact(f64::from(cube.rest))));
                    }
                    plane
                };
                (cube.drawn.map(face).to_vec(), 6)
            }
            Storage::Uploaded(texture) => (mipmapped(size, bytes(&texture.rgba, false)), 1),
            Storage::Levels(levels) => {
                let level = |(level, texels): (usize, &Vec<[u8; 4]>)| {
                    let color = bytes(texels.as_flattened(), levels.is_signed);
                    Plane { size: level_size(level), color, ..Plane::default() }
                };
                (levels.levels.iter().enumerate().map(level).collect(), 1)
            }
            Storage::UnitVectors => {
                let face = |face: CubeFace| {
                    let texels = normal_cube::packed_face(face as usize, desc.size[0]);
                    Plane { size, color: bytes(texels.as_flattened(), false), ..Plane::default() }
                };
                (CubeFace::ALL.map(face).to_vec(), 6)
            }
            Storage::Line(texels) => (line(bytes(texels.as_flattened(), false)), 1),
            Storage::Values(values) => (line(reds(values)), 1),
        };
        Ok(Self { format, planes, faces })
    }

    pub fn levels(&self) -> usize {
        self.planes.len() / self.faces
    }

    pub fn plane(&self, level: usize, face: usize) -> &Plane {
        &self.planes[level * self.faces + face]
    }
}

fn line(color: Vec<[Num; 4]>) -> Vec<Plane> {
    vec![Plane { size: [color.len(), 1], color, ..Plane::default() }]
}

fn reds(values: &Arc<[f32]>) -> Vec<[Num; 4]> {
    let texel = |value: &f32| [Num::exact(f64::from(*value)), Num::exact(0.0), Num::exact(0.0), Num::exact(1.0)];
    values.iter().map(texel).collect()
}

/// Texels of four bytes each.
fn bytes(bytes: &[u8], is_signed: bool) -> Vec<[Num; 4]> {
    let number = |byte: u8| {
        // -128 stands for -1, too.
        let value = if is_signed { f64::from((byte as i8).max(-127)) / 127.0 } else { f64::from(byte) / 255.0 };
        if value.fract() == 0.0 { Num::exact(value) } else { Num::off(value, ROUNDING * value.abs()) }
    };
    bytes.as_chunks::<4>().0.iter().map(|texel| texel.map(number)).collect()
}

/// Levels as glGenerateMipmap makes them: no filter is required [GL 4.6, 8.14.4], but a mean of the texels below is
/// recommended. A result anywhere between those that it lies over is taken as right.
fn mipmapped(size: [usize; 2], color: Vec<[Num; 4]>) -> Vec<Plane> {
    let mut planes = vec![Plane { size, color, ..Plane::default() }];
    while let Some(last) = planes.last()
        && last.size != [1, 1]
    {
        let size = last.size.map(|side| (side / 2).max(1));
        let mut color = Vec::new();
        for index in 0..size[0] * size[1] {
            let at = [index % size[0], index / size[0]];
            let ends = [0, 1].map(|part: usize| {
                let step = if last.size[part] > 1 { 2 } else { 1 };
                [at[part] * step, (at[part] * step + step).min(last.size[part] - 1)]
            });
            let odd = [0, 1].map(|part: usize| last.size[part] % 2 == 1 && last.size[part] > 1);
            let mut texel = [Num::UNKNOWN; 4];
            for (channel, number) in texel.iter_mut().enumerate() {
                let (mut low, mut high, mut total, mut count) = (f64::MAX, f64::MIN, 0.0, 0.0);
                for y in ends[1][0]..=(if odd[1] { ends[1][1] } else { (ends[1][0] + 1).min(ends[1][1]) }) {
                    for x in ends[0][0]..=(if odd[0] { ends[0][1] } else { (ends[0][0] + 1).min(ends[0][1]) }) {
                        let value = last.color[y * last.size[0] + x][channel];
                        low = low.min(value.value - SLACK * value.error);
                        high = high.max(value.value + SLACK * value.error);
                        (total, count) = (total + value.value, count + 1.0);
                    }
                }
                let mean: f64 = total / count;
                let reach = (high - mean).max(mean - low) + if high > low { 1.0 / 255.0 } else { 0.0 };
                *number = Num { value: mean, error: reach / SLACK };
            }
            color.push(texel);
        }
        planes.push(Plane { size, color, ..Plane::default() });
    }
    planes
}

/// Step between the depths that a format holds; 0 for floats. An unsized one has 16 bits at least.
pub fn depth_step(format: Format) -> f64 {
    let bits = match format {
        Format::Depth(DepthFormat::Depth32F) => return 0.0,
        Format::Depth(DepthFormat::Depth16) | Format::UnsizedDepth => 16,
        // Drivers may store less of 32 bits.
        Format::Depth(DepthFormat::Depth24 | DepthFormat::Depth32) | Format::Depth24Stencil8 => 24,
        _ => return 0.0,
    };
    1.0 / ((1u64 << bits) - 1) as f64
}

/// A depth as it is stored: clamped to [0, 1], rounded to the format's steps.
pub fn stored_depth(format: Format, depth: Num) -> Num {
    if !depth.is_known() {
        return Num::UNKNOWN;
    }
    let depth = depth.most(Num::exact(0.0)).least(Num::exact(1.0));
    if depth.error == 0.0 && (depth.value == 0.0 || depth.value == 1.0) {
        return depth;
    }
    Num { value: depth.value, error: depth.error + 0.75 * depth_step(format) / SLACK + ROUNDING / 4.0 }
}

/// A colour as it is stored. `codes`: steps of 8 bits that it may be off.
pub fn stored_color(format: Format, color: Num, codes: f64) -> Num {
    if !color.is_known() {
        return Num::UNKNOWN;
    }
    let (low, steps) = match format {
        Format::Rgba8 => (0.0, 255.0),
        Format::Rgba8Signed => (-1.0, 127.0),
        _ => return color,
    };
    let color = color.most(Num::exact(low)).least(Num::exact(1.0));
    if color.error == 0.0 && (color.value * steps).fract() == 0.0 {
        return color;
    }
    Num { value: color.value, error: color.error + codes / steps / SLACK }
}
