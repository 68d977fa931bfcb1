//! Reads GL images back as pixels.

use glow::HasContext;

use super::{Device, Error};
use crate::pass::{Cube, CubeFace, Format, ImageId, PassList, Storage, Target};

/// An image's texels, rows from the top down.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Red, green, blue, alpha.
    Rgba8 {
        /// Width and height.
        size: [u32; 2],
        /// Four bytes a texel.
        data: Vec<u8>,
    },
    /// Red, green, blue, alpha.
    RgbaF32 {
        /// Width and height.
        size: [u32; 2],
        /// Four numbers a texel.
        data: Vec<f32>,
    },
    /// Window-space depth in [0, 1].
    Depth {
        /// Width and height.
        size: [u32; 2],
        /// One number a texel.
        data: Vec<f32>,
    },
    /// Stencil values.
    Stencil {
        /// Width and height.
        size: [u32; 2],
        /// One byte a texel.
        data: Vec<u8>,
    },
}

impl Pixels {
    /// The same size with alpha as grey and alpha 1; depths and counts as they are.
    #[must_use]
    pub fn alpha_as_gray(self) -> Self {
        match self {
            Self::Rgba8 { size, data } => {
                let data = data.chunks_exact(4).flat_map(|p| [p[3], p[3], p[3], u8::MAX]).collect();
                Self::Rgba8 { size, data }
            }
            Self::RgbaF32 { size, data } => {
                let data = data.chunks_exact(4).flat_map(|p| [p[3], p[3], p[3], 1.0]).collect();
                Self::RgbaF32 { size, data }
            }
            other => other,
        }
    }

    /// The texel in column `x` and row `y` from the upper left: red, green, blue and alpha, colours of 8 bits as [0, 1]. A
    /// depth or a count stands in all of the first three. `None`: outside.
    pub fn at(&self, [x, y]: [u32; 2]) -> Option<[f32; 4]> {
        let [width, height] = self.size();
        if x >= width || y >= height {
            return None;
        }
        let index = y as usize * width as usize + x as usize;
        match self {
            Self::Rgba8 { data, .. } => {
                data.as_chunks::<4>().0.get(index).map(|t| t.map(|code| f32::from(code) / 255.0))
            }
            Self::RgbaF32 { data, .. } => data.as_chunks::<4>().0.get(index).copied(),
            Self::Depth { data, .. } => data.get(index).map(|depth| [*depth, *depth, *depth, 1.0]),
            Self::Stencil { data, .. } => data.get(index).map(|count| f32::from(*count)).map(|c| [c, c, c, 1.0]),
        }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Rgba8 { size, .. }
            | Self::RgbaF32 { size, .. }
            | Self::Depth { size, .. }
            | Self::Stencil { size, .. } => *size,
        }
    }
}

impl Device {
    /// Reads an image of the list that was run last. Waits until it is drawn.
    ///
    /// # Errors
    ///
    /// GL errors, and images that the driver cannot read.
    pub fn read(&mut self, list: &PassList, image: ImageId) -> Result<Pixels, Error> {
        self.make_current()?;
        let desc = list.desc(image);
        if let Storage::Cube(cube) = desc.storage {
            return self.read_cross(list, image, cube);
        }
        let label = format!("reading {}", desc.label);
        let target = if desc.format.has_depth() {
            Target { color: None, depth: Some(image), level: 0, face: None }
        } else {
            Target { color: Some(image), depth: None, level: 0, face: None }
        };
        self.bind_target(list, &label, target)?;
        let [width, height] = desc.size;
        let count = width as usize * height as usize;
        let pixels = match desc.format {
            Format::Rgba8 => {
                let mut data = vec![0; 4 * count];
                self.read_into(desc.size, glow::RGBA, glow::UNSIGNED_BYTE, &mut data);
                flip_rows(&mut data, 4 * width as usize);
                Pixels::Rgba8 { size: desc.size, data }
            }
            Format::Rgba32F | Format::R32F | Format::Rgba8Signed => {
                let mut data = vec![0.0_f32; 4 * count];
                self.read_into(desc.size, glow::RGBA, glow::FLOAT, bytemuck::cast_slice_mut(&mut data));
                flip_rows(&mut data, 4 * width as usize);
                Pixels::RgbaF32 { size: desc.size, data }
            }
            Format::Depth(_) | Format::UnsizedDepth | Format::Depth24Stencil8 => {
                let mut data = vec![0.0_f32; count];
                self.read_into(desc.size, glow::DEPTH_COMPONENT, glow::FLOAT, bytemuck::cast_slice_mut(&mut data));
                flip_rows(&mut data, width as usize);
                Pixels::Depth { size: desc.size, data }
            }
        };
        self.check(&label)?;
        Ok(pixels)
    }

    /// The faces of a cube map as the cross that they unfold to, each as GL has its first row on top:
    ///
    /// ```text
    ///    +y
    /// -x +z +x -z
    ///    -y
    /// ```
    fn read_cross(&mut self, list: &PassList, image: ImageId, cube: Cube) -> Result<Pixels, Error> {
        const PLACES: [[usize; 2]; 6] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
        let desc = list.desc(image);
        let label = format!("reading {}", desc.label);
        let side = desc.size[0] as usize;
        let mut cross = vec![cube.rest; 4 * side * 3 * side];
        let mut data = vec![0.0_f32; side * side];
        for (face, [column, row]) in CubeFace::ALL.into_iter().zip(PLACES) {
            self.bind_target(list, &label, Target { color: None, depth: Some(image), level: 0, face: Some(face) })?;
            self.read_into(desc.size, glow::DEPTH_COMPONENT, glow::FLOAT, bytemuck::cast_slice_mut(&mut data));
            for (y, texels) in data.chunks_exact(side).enumerate() {
                cross[(row * side + y) * 4 * side + column * side..][..side].copy_from_slice(texels);
            }
        }
        self.check(&label)?;
        Ok(Pixels::Depth { size: [4 * desc.size[0], 3 * desc.size[0]], data: cross })
    }

    /// Reads the stencil values of an image of the list that was run last. Waits until it is drawn.
    ///
    /// # Errors
    ///
    /// GL errors, and images without stencil.
    pub fn read_stencil(&mut self, list: &PassList, image: ImageId) -> Result<Pixels, Error> {
        self.make_current()?;
        let desc = list.desc(image);
        let label = format!("reading the stencil of {}", desc.label);
        self.bind_target(list, &label, Target { color: None, depth: Some(image), level: 0, face: None })?;
        let mut data = vec![0; desc.size[0] as usize * desc.size[1] as usize];
        self.read_into(desc.size, glow::STENCIL_INDEX, glow::UNSIGNED_BYTE, &mut data);
        flip_rows(&mut data, desc.size[0] as usize);
        self.check(&label)?;
        Ok(Pixels::Stencil { size: desc.size, data })
    }

    pub(super) fn read_into(&self, size: [u32; 2], format: u32, kind: u32, bytes: &mut [u8]) {
        let [width, height] = size.map(|side| side as i32);
        unsafe {
            self.gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            let target = glow::PixelPackData::Slice(Some(bytes));
            self.gl.read_pixels(0, 0, width, height, format, kind, target);
        }
    }
}

/// GL's first row is the lowest.
pub(super) fn flip_rows<T>(data: &mut [T], row: usize) {
    let rows = data.len() / row.max(1);
    for low in 0..rows / 2 {
        let (top, bottom) = data.split_at_mut((rows - 1 - low) * row);
        top[low * row..][..row].swap_with_slice(&mut bottom[..row]);
    }
}
