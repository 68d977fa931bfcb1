//! Numbers in the memory that the driver answers into.

/// Types of numbers in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    F32,
    F64,
    /// Depth and stencil in one word.
    Depth24Stencil8,
}

impl Scalar {
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 | Self::Depth24Stencil8 => 4,
            Self::U64 | Self::F64 => 8,
        }
    }

    /// GL's name in C.
    pub fn c_type(self) -> &'static str {
        match self {
            Self::U8 => "GLubyte",
            Self::I8 => "GLbyte",
            Self::U16 => "GLushort",
            Self::I16 => "GLshort",
            Self::U32 | Self::Depth24Stencil8 => "GLuint",
            Self::I32 => "GLint",
            Self::U64 => "GLuint64",
            Self::F32 => "GLfloat",
            Self::F64 => "GLdouble",
        }
    }

    pub fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// All numbers in memory; a packed word is one number.
    pub fn numbers(self, bytes: &[u8]) -> Vec<f64> {
        fn each<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
            bytes.chunks_exact(N).map(|chunk| number(chunk.try_into().unwrap_or([0; N]))).collect()
        }
        match self {
            Self::U8 => each(bytes, |b| f64::from(u8::from_ne_bytes(b))),
            Self::I8 => each(bytes, |b| f64::from(i8::from_ne_bytes(b))),
            Self::U16 => each(bytes, |b| f64::from(u16::from_ne_bytes(b))),
            Self::I16 => each(bytes, |b| f64::from(i16::from_ne_bytes(b))),
            Self::U32 | Self::Depth24Stencil8 => each(bytes, |b| f64::from(u32::from_ne_bytes(b))),
            Self::I32 => each(bytes, |b| f64::from(i32::from_ne_bytes(b))),
            Self::U64 => each(bytes, |b| u64::from_ne_bytes(b) as f64),
            Self::F32 => each(bytes, |b| f64::from(f32::from_ne_bytes(b))),
            Self::F64 => each(bytes, f64::from_ne_bytes),
        }
    }

    pub fn encode(self, value: f64) -> Vec<u8> {
        match self {
            Self::U8 => vec![value as u8],
            Self::I8 => (value as i8).to_ne_bytes().to_vec(),
            Self::U16 => (value as u16).to_ne_bytes().to_vec(),
            Self::I16 => (value as i16).to_ne_bytes().to_vec(),
            Self::U32 | Self::Depth24Stencil8 => (value as u32).to_ne_bytes().to_vec(),
            Self::I32 => (value as i32).to_ne_bytes().to_vec(),
            Self::U64 => (value as u64).to_ne_bytes().to_vec(),
            Self::F32 => (value as f32).to_ne_bytes().to_vec(),
            Self::F64 => value.to_ne_bytes().to_vec(),
        }
    }

    /// Least and greatest number.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::U8 => [0.0, 255.0],
            Self::I8 => [-128.0, 127.0],
            Self::U16 => [0.0, 65535.0],
            Self::I16 => [-32768.0, 32767.0],
            Self::U32 | Self::Depth24Stencil8 => [0.0, f64::from(u32::MAX)],
            Self::I32 => [f64::from(i32::MIN), f64::from(i32::MAX)],
            Self::U64 => [0.0, 9e15],
            Self::F32 | Self::F64 => [-1e30, 1e30],
        }
    }
}

/// Places of numbers in an answer: rows of elements, each of some components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub scalar: Scalar,
    pub components: usize,
    pub width: usize,
    pub height: usize,
    /// Bytes from one row to the next.
    pub stride: usize,
}

impl Layout {
    /// A few values, not of pixels: each an element.
    pub fn values(scalar: Scalar, count: usize) -> Self {
        Self { scalar, components: 1, width: count, height: 1, stride: count * scalar.bytes() }
    }

    /// Bytes of an element.
    pub fn element(&self) -> usize {
        match self.scalar {
            // Two components in one word.
            Scalar::Depth24Stencil8 => 4,
            scalar => scalar.bytes() * self.components,
        }
    }

    pub fn bytes(&self) -> usize {
        match self.height {
            0 => 0,
            height => (height - 1) * self.stride + self.width * self.element(),
        }
    }

    /// Number of elements.
    pub fn count(&self) -> usize {
        self.width * self.height
    }

    /// First byte of an element.
    pub fn offset(&self, index: usize) -> usize {
        index / self.width.max(1) * self.stride + index % self.width.max(1) * self.element()
    }

    /// The components of an element.
    pub fn get(&self, bytes: &[u8], index: usize) -> Vec<f64> {
        let at = self.offset(index);
        let element = bytes.get(at..at + self.element()).unwrap_or_default();
        match self.scalar {
            Scalar::Depth24Stencil8 => {
                let word = element.first_chunk().map_or(0, |four| u32::from_ne_bytes(*four));
                vec![f64::from(word >> 8), f64::from(word & 0xFF)]
            }
            scalar => scalar.numbers(element),
        }
    }

    /// Replaces the components of an element.
    pub fn put(&self, bytes: &mut [u8], index: usize, values: &[f64]) {
        let at = self.offset(index);
        let new: Vec<u8> = match (self.scalar, values) {
            (Scalar::Depth24Stencil8, [depth, stencil]) => {
                ((*depth as u32) << 8 | (*stencil as u32) & 0xFF).to_ne_bytes().to_vec()
            }
            _ => values.iter().flat_map(|value| self.scalar.encode(*value)).collect(),
        };
        if let Some(place) = bytes.get_mut(at..at + new.len()) {
            place.copy_from_slice(&new);
        }
    }
}
