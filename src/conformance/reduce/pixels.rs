//! Numbers in the memory that the driver answers into.

use super::meaning::Scalar;

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
