//! MD2 files: reading, with errors that name a byte offset, and writing.
//!
//! Little-endian. A header of 17 integers has counts and offsets of five sections: skins' names, texture coordinates,
//! triangles, frames, GL commands. A frame has a scale and an offset for its vertices, whose coordinates are bytes.

use std::path::Path;

use super::super::Error;

/// First bytes of every file, and the version behind them.
const MAGIC: [u8; 4] = *b"IDP2";
const VERSION: i32 = 8;
/// Bytes of the header; of a skin's name; of a frame before its vertices.
const HEADER: usize = 68;
const SKIN: usize = 64;
const FRAME: usize = 40;

/// Contents of an MD2 file, as stored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Md2 {
    /// Width and height of the skin in texels, which texture coordinates count in.
    pub skin_size: [i32; 2],
    pub skins: Vec<[u8; SKIN]>,
    /// (s, t) in texels, t downwards.
    pub texcoords: Vec<[i16; 2]>,
    pub triangles: Vec<Triangle>,
    /// One or more, each with as many vertices.
    pub frames: Vec<Frame>,
    /// Strips and fans of the same triangles, which glumbra does not draw; kept for writing.
    pub gl_commands: Vec<i32>,
}

/// Indices of three vertices and of their texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    pub vertices: [u16; 3],
    pub texcoords: [u16; 3],
}

/// A key frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    pub scale: [f32; 3],
    pub translate: [f32; 3],
    pub name: [u8; 16],
    /// Coordinates, to be scaled and moved, and the number of a normal.
    pub vertices: Vec<[u8; 4]>,
}

impl Frame {
    /// The name up to its first zero byte.
    pub fn name(&self) -> String {
        text(&self.name)
    }

    /// A vertex in the file's own space: x forwards, z up.
    pub fn position(&self, vertex: usize) -> [f64; 3] {
        let [x, y, z, _] = self.vertices[vertex];
        let at =
            |axis: usize, code: u8| f64::from(code) * f64::from(self.scale[axis]) + f64::from(self.translate[axis]);
        [at(0, x), at(1, y), at(2, z)]
    }
}

/// The bytes up to the first zero; what is not UTF-8 is replaced.
pub fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// Counts and offsets of the header, in the file's order.
struct Header {
    skin_size: [i32; 2],
    skins: Section,
    texcoords: Section,
    triangles: Section,
    frames: Section,
    gl_commands: Section,
    vertices: usize,
}

/// A run of equal records.
struct Section {
    what: &'static str,
    count: usize,
    offset: usize,
    /// Bytes of a record.
    record: usize,
}

impl Section {
    /// Byte behind its last record.
    fn end(&self) -> Option<usize> {
        self.count.checked_mul(self.record)?.checked_add(self.offset)
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    path: &'a Path,
}

impl Reader<'_> {
    fn error(&self, offset: usize, what: impl Into<String>) -> Error {
        Error::MalformedAt { path: self.path.to_owned(), offset, what: what.into() }
    }

    /// `N` bytes at an offset within the file.
    fn at<const N: usize>(&self, offset: usize) -> Result<[u8; N], Error> {
        let bytes = self.bytes.get(offset..).and_then(|rest| rest.first_chunk::<N>());
        bytes.copied().ok_or_else(|| self.error(offset, format!("the file ends after {} bytes", self.bytes.len())))
    }

    fn integer(&self, offset: usize) -> Result<i32, Error> {
        self.at(offset).map(i32::from_le_bytes)
    }

    fn short(&self, offset: usize) -> Result<u16, Error> {
        self.at(offset).map(u16::from_le_bytes)
    }

    /// A number of the header that must not be negative.
    fn count(&self, index: usize, what: &str) -> Result<usize, Error> {
        let offset = 4 * index;
        let number = self.integer(offset)?;
        usize::try_from(number).map_err(|_| self.error(offset, format!("{what} is {number}")))
    }

    fn header(&self) -> Result<Header, Error> {
        let magic = self.at::<4>(0)?;
        if magic != MAGIC {
            let found = magic.escape_ascii();
            return Err(self.error(0, format!("begins with \"{found}\"; an MD2 file begins with \"IDP2\"")));
        }
        let version = self.integer(4)?;
        if version != VERSION {
            return Err(self.error(4, format!("has version {version}; MD2 files have version {VERSION}")));
        }
        let skin_size = [self.integer(8)?, self.integer(12)?];
        for ((offset, side), size) in [(8, "width"), (12, "height")].into_iter().zip(skin_size) {
            if size < 1 {
                return Err(self.error(offset, format!("the skin's {side} is {size} texels")));
            }
        }
        let vertices = self.count(6, "the number of vertices")?;
        let frame_size = self.count(4, "the size of a frame")?;
        if vertices == 0 || vertices > usize::from(u16::MAX) + 1 {
            return Err(self.error(24, format!("has {vertices} vertices; an MD2 model has 1 to 65536")));
        }
        if frame_size != FRAME + 4 * vertices {
            let expected = FRAME + 4 * vertices;
            return Err(
                self.error(16, format!("frames of {vertices} vertices have {expected} bytes, not {frame_size}"))
            );
        }
        let section = |what: &'static str, count: usize, offset: usize, record: usize| {
            let count = self.count(count, &format!("the number of {what}"))?;
            let at = self.count(offset, &format!("the offset of the {what}"))?;
            let section = Section { what, count, offset: at, record };
            match section.end() {
                _ if count == 0 => Ok(section),
                Some(end) if at >= HEADER && end <= self.bytes.len() => Ok(section),
                _ => {
                    let length = self.bytes.len();
                    let what =
                        format!("{count} {what} of {record} bytes from byte {at} on do not fit in {length} bytes");
                    Err(self.error(4 * offset, what))
                }
            }
        };
        let header = Header {
            skin_size,
            vertices,
            skins: section("skins", 5, 11, SKIN)?,
            texcoords: section("texture coordinates", 7, 12, 4)?,
            triangles: section("triangles", 8, 13, 12)?,
            frames: section("frames", 10, 14, frame_size)?,
            gl_commands: section("GL commands", 9, 15, 4)?,
        };
        self.check_apart(&header)?;
        let end = self.count(16, "the offset of the end")?;
        if end > self.bytes.len() {
            let length = self.bytes.len();
            return Err(self.error(64, format!("the file should have {end} bytes, and ends after {length}")));
        }
        if header.frames.count == 0 {
            return Err(self.error(40, "has no frames"));
        }
        if header.triangles.count == 0 {
            return Err(self.error(32, "has no triangles"));
        }
        Ok(header)
    }

    /// An error for two sections with a byte in common.
    fn check_apart(&self, header: &Header) -> Result<(), Error> {
        let Header { skins, texcoords, triangles, frames, gl_commands, .. } = header;
        let mut sections: Vec<&Section> = [skins, texcoords, triangles, frames, gl_commands]
            .into_iter()
            .filter(|section| section.count > 0)
            .collect();
        sections.sort_by_key(|section| section.offset);
        for pair in sections.windows(2) {
            let end = pair[0].end().unwrap_or(usize::MAX);
            if end > pair[1].offset {
                let what = format!("the {} reach to byte {end}, into the {}", pair[0].what, pair[1].what);
                return Err(self.error(pair[1].offset, what));
            }
        }
        Ok(())
    }

    fn triangle(&self, offset: usize, header: &Header) -> Result<Triangle, Error> {
        let index = |number: usize, count: usize, what: &str| {
            let offset = offset + 2 * number;
            let index = self.short(offset)?;
            match usize::from(index) < count {
                true => Ok(index),
                false => Err(self.error(offset, format!("a triangle uses {what} {index} of {count}"))),
            }
        };
        let vertex = |number: usize| index(number, header.vertices, "vertex");
        let texcoord = |number: usize| index(3 + number, header.texcoords.count, "texture coordinate");
        Ok(Triangle {
            vertices: [vertex(0)?, vertex(1)?, vertex(2)?],
            texcoords: [texcoord(0)?, texcoord(1)?, texcoord(2)?],
        })
    }

    fn frame(&self, offset: usize, header: &Header) -> Result<Frame, Error> {
        let number = |index: usize| {
            let offset = offset + 4 * index;
            let number = self.at(offset).map(f32::from_le_bytes)?;
            let what = if index < 3 { "scale" } else { "offset" };
            match number.is_finite() {
                true => Ok(number),
                false => Err(self.error(offset, format!("a frame's {what} is {number}"))),
            }
        };
        let frame = Frame {
            scale: [number(0)?, number(1)?, number(2)?],
            translate: [number(3)?, number(4)?, number(5)?],
            name: self.at(offset + 24)?,
            vertices: (0..header.vertices)
                .map(|vertex| self.at(offset + FRAME + 4 * vertex))
                .collect::<Result<_, _>>()?,
        };
        let reach =
            (0..3).map(|axis| 255.0 * f64::from(frame.scale[axis]).abs() + f64::from(frame.translate[axis]).abs());
        let reach = reach.fold(0.0, f64::max);
        if reach > f64::from(f32::MAX) {
            return Err(self.error(offset, format!("a frame's scale and offset reach out to {reach:e}, beyond f32")));
        }
        let normals = super::normals::COUNT;
        match frame.vertices.iter().position(|[.., normal]| usize::from(*normal) >= normals) {
            None => Ok(frame),
            Some(vertex) => {
                let (offset, normal) = (offset + FRAME + 4 * vertex + 3, frame.vertices[vertex][3]);
                Err(self.error(offset, format!("vertex {vertex} has normal {normal} of {normals}")))
            }
        }
    }
}

/// Reads a file's bytes. `path`: for messages.
///
/// # Errors
///
/// [`Error::MalformedAt`]: wrong magic or version, counts or sections beyond the file, sections in each other, indices beyond
/// what they index, frames of another size, numbers that are not finite, no frames, no triangles.
pub fn read(bytes: &[u8], path: &Path) -> Result<Md2, Error> {
    let reader = Reader { bytes, path };
    let header = reader.header()?;
    fn records<'h, T>(
        section: &'h Section,
        read: impl Fn(usize) -> Result<T, Error> + 'h,
    ) -> impl Iterator<Item = Result<T, Error>> + 'h {
        (0..section.count).map(move |index| read(section.offset + index * section.record))
    }
    let texcoord = |offset: usize| {
        let [s, t] = [reader.short(offset)?, reader.short(offset + 2)?];
        Ok([s.cast_signed(), t.cast_signed()])
    };
    Ok(Md2 {
        skin_size: header.skin_size,
        skins: records(&header.skins, |offset| reader.at(offset)).collect::<Result<_, _>>()?,
        texcoords: records(&header.texcoords, texcoord).collect::<Result<_, _>>()?,
        triangles: records(&header.triangles, |offset| reader.triangle(offset, &header)).collect::<Result<_, _>>()?,
        frames: records(&header.frames, |offset| reader.frame(offset, &header)).collect::<Result<_, _>>()?,
        gl_commands: records(&header.gl_commands, |offset| reader.integer(offset)).collect::<Result<_, _>>()?,
    })
}

/// The file's bytes: header, skins, texture coordinates, triangles, frames, GL commands, one behind the other.
pub fn write(model: &Md2) -> Vec<u8> {
    let vertices = model.frames.first().map_or(0, |frame| frame.vertices.len());
    let frame_size = FRAME + 4 * vertices;
    let counts =
        [model.skins.len(), model.texcoords.len(), model.triangles.len(), model.frames.len(), model.gl_commands.len()];
    let sizes = [SKIN, 4, 12, frame_size, 4];
    let mut offsets = [HEADER; 6];
    for section in 0..5 {
        offsets[section + 1] = offsets[section] + counts[section] * sizes[section];
    }
    let [skins, texcoords, triangles, frames, gl_commands] = counts;
    let [at_skins, at_texcoords, at_triangles, at_frames, at_gl_commands, end] = offsets;
    let mut bytes = Vec::with_capacity(end);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(model.skin_size.iter().flat_map(|size| size.to_le_bytes()));
    let rest = [
        frame_size,
        skins,
        vertices,
        texcoords,
        triangles,
        gl_commands,
        frames,
        at_skins,
        at_texcoords,
        at_triangles,
        at_frames,
        at_gl_commands,
        end,
    ];
    bytes.extend(rest.iter().flat_map(|number| (*number as i32).to_le_bytes()));
    bytes.extend(model.skins.iter().flatten());
    bytes.extend(model.texcoords.iter().flatten().flat_map(|number| number.to_le_bytes()));
    for triangle in &model.triangles {
        bytes.extend(triangle.vertices.iter().chain(&triangle.texcoords).flat_map(|index| index.to_le_bytes()));
    }
    for frame in &model.frames {
        bytes.extend(frame.scale.iter().chain(&frame.translate).flat_map(|number| number.to_le_bytes()));
        bytes.extend(frame.name);
        bytes.extend(frame.vertices.iter().flatten());
    }
    bytes.extend(model.gl_commands.iter().flat_map(|command| command.to_le_bytes()));
    bytes
}
