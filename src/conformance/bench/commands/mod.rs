//! Commands of GL as plain data, and a player that gives them one at a time: each is one call, or one call with the bind that
//! it needs, and all that an earlier command set stays in force.

mod player;
mod programs;
mod sampled;
mod setting;
mod states;
mod transfers;

pub use player::Player;
pub use setting::{Faces, Program, Sampled, Setting};
pub use transfers::UNTOUCHED;

use super::{GlFormat, GlImageDesc};

/// Number of names of each kind of object.
pub const TEXTURES: usize = 6;
pub const RENDERBUFFERS: usize = 3;
pub const FRAMEBUFFERS: usize = 5;
pub const SAMPLERS: usize = 2;
/// Vertex arrays, each with its buffer.
pub const ARRAYS: usize = 3;
/// Rectangles that an array has room for.
pub const CAPACITY: usize = 8;
/// Texture units that are used.
pub const UNITS: u32 = 4;
/// Draw buffers of a framebuffer.
pub const OUTPUTS: usize = 2;

/// An image that can be attached to a framebuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A level of a layer or a face.
    Texture {
        slot: usize,
        level: u32,
        layer: u32,
    },
    Renderbuffer(usize),
}

/// An attachment point; depth formats with stencil are attached as both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Point {
    Color(u32),
    Depth,
}

/// A rectangle of four corners in clip space, drawn as two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Least and greatest x and y of normalised device coordinates: x0, y0, x1, y1.
    pub corners: [f32; 4],
    /// Depth in normalised device coordinates.
    pub z: f32,
    /// w of each corner, powers of two.
    pub w: [f32; 4],
    pub color: [f32; 4],
    /// True if it winds clockwise.
    pub turned: bool,
}

impl Rectangle {
    /// One that covers nothing.
    pub const NOTHING: Self = Self { corners: [2.0; 4], z: 0.0, w: [1.0; 4], color: [0.0; 4], turned: false };

    /// Position and colour of its corners, in the order of a fan.
    pub fn vertices(&self) -> [[f32; 8]; 4] {
        let [x0, y0, x1, y1] = self.corners;
        let mut places = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        if self.turned {
            places.swap(1, 3);
        }
        let [r, g, b, a] = self.color;
        std::array::from_fn(|corner| {
            let ([x, y], w) = (places[corner], self.w[corner]);
            [x * w, y * w, self.z * w, w, r, g, b, a]
        })
    }
}

/// How the rectangles of an array are given to GL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    /// glBufferData of the whole array.
    Whole,
    /// glBufferSubData of the rectangles that change.
    Part,
}

/// The call that draws rectangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawing {
    /// glDrawArrays of a fan for each.
    Fans,
    /// glDrawElements by indices of so many bytes: 1, 2 or 4.
    Elements(u32),
    /// glDrawElementsBaseVertex: indices of the first rectangles, and a base.
    Based,
}

/// Layout of pixels in the client's memory or in a buffer object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packing {
    /// Like GL_RGBA and GL_FLOAT.
    pub layout: [u32; 2],
    pub alignment: u32,
    /// Pixels of a row; 0: the width.
    pub row: u32,
    /// Pixels and rows that are skipped.
    pub skip: [u32; 2],
    /// Lies in a pixel buffer object, after so many bytes.
    pub buffer: Option<u32>,
}

impl Packing {
    /// Components and bytes of a pixel.
    pub fn pixel(&self) -> (usize, usize) {
        let components = match self.layout[0] {
            glow::RGBA | glow::BGRA => 4,
            glow::RGB => 3,
            _ => 1,
        };
        let bytes = match self.layout[1] {
            glow::UNSIGNED_BYTE => 1,
            glow::UNSIGNED_SHORT => 2,
            _ => 4,
        };
        (components, components * bytes)
    }

    /// Bytes from one row to the next.
    pub fn stride(&self, width: u32) -> usize {
        let (components, pixel) = self.pixel();
        let row = if self.row > 0 { self.row } else { width } as usize * pixel;
        // A component that is larger than the alignment has no padding [GL 4.6, 8.4.4.1].
        if pixel / components >= self.alignment as usize { row } else { row.next_multiple_of(self.alignment as usize) }
    }

    /// Where a pixel begins.
    pub fn at(&self, width: u32, x: usize, y: usize) -> usize {
        let (_, pixel) = self.pixel();
        let [skip, rows] = self.skip.map(|count| count as usize);
        self.buffer.unwrap_or(0) as usize + (y + rows) * self.stride(width) + (x + skip) * pixel
    }

    /// Bytes of all, from the beginning of the memory to the end of the last row.
    pub fn bytes(&self, [width, height]: [u32; 2]) -> usize {
        self.at(width, 0, height as usize) + self.stride(width)
    }
}

/// A clear, and its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clear {
    /// glClear with the values that are set: colour, depth, stencil.
    Bits([bool; 3]),
    /// glClearBufferfv of a draw buffer.
    Color(u32, [f32; 4]),
    /// glClearBufferfv of depth.
    Depth(f32),
    /// glClearBufferiv of stencil.
    Stencil(i32),
    /// glClearBufferfi.
    Both(f32, i32),
}

/// One command.
#[derive(Clone, Debug)]
pub enum Command {
    /// Makes a texture anew, without content; one that was there is deleted first if `fresh`, else defined again.
    Texture {
        slot: usize,
        desc: GlImageDesc,
        fresh: bool,
    },
    DeleteTexture(usize),
    /// glTexSubImage; or glTexImage of a whole level, which is made `anew`.
    Upload {
        slot: usize,
        level: u32,
        layer: u32,
        area: [u32; 4],
        packing: Packing,
        bytes: Vec<u8>,
        anew: bool,
    },
    /// glGenerateMipmap.
    Levels(usize),
    Renderbuffer {
        slot: usize,
        format: GlFormat,
        size: [u32; 2],
        samples: u32,
    },
    /// Deletes a framebuffer and makes it anew.
    Framebuffer(usize),
    Attach {
        slot: usize,
        point: Point,
        place: Option<Place>,
    },
    /// glDrawBuffers of the framebuffer that is bound for drawing.
    DrawBuffers([Option<u32>; OUTPUTS]),
    /// glReadBuffer of the framebuffer that is bound for reading.
    ReadBuffer(Option<u32>),
    /// glBindFramebuffer for drawing, for reading, or for both by GL_FRAMEBUFFER.
    Bind {
        draw: bool,
        read: bool,
        slot: usize,
    },
    Set(Setting),
    Clear(Clear),
    Fill {
        array: usize,
        first: usize,
        rectangles: Vec<Rectangle>,
        filling: Filling,
    },
    Draw {
        array: usize,
        first: usize,
        count: usize,
        drawing: Drawing,
    },
    /// glBlitFramebuffer: corners x0, y0, x1, y1 of source and destination; colour, depth, stencil.
    Blit {
        from: [i32; 4],
        to: [i32; 4],
        bits: [bool; 3],
    },
    /// glCopyTexSubImage from x, y, width, height.
    Copy {
        from: [i32; 4],
        slot: usize,
        level: u32,
        layer: u32,
        at: [i32; 2],
    },
    /// glReadPixels of x, y, width, height.
    Read {
        area: [i32; 4],
        packing: Packing,
    },
    /// glBeginQuery and glEndQuery of samples that pass.
    BeginQuery,
    EndQuery,
    Flush,
}

impl Command {
    /// Tests whether it may change an image.
    pub fn writes(&self) -> bool {
        matches!(
            self,
            Self::Upload { .. }
                | Self::Levels(_)
                | Self::Clear(_)
                | Self::Draw { .. }
                | Self::Blit { .. }
                | Self::Copy { .. }
        )
    }

    /// The command in a line.
    pub fn in_short(&self) -> String {
        match self {
            Self::Upload { slot, level, layer, area, packing, anew, .. } => {
                format!(
                    "Upload {{ slot: {slot}, level: {level}, layer: {layer}, area: {area:?}, {packing:?}, anew: {anew} }}"
                )
            }
            Self::Fill { array, first, rectangles, filling } => {
                format!("Fill {{ array: {array}, first: {first}, count: {}, {filling:?} }}", rectangles.len())
            }
            other => format!("{other:?}"),
        }
    }
}
