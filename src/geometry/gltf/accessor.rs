//! Accessors: arrays of numbers in buffers, of integers or floats, packed or strided, dense or sparse [Khronos, "glTF 2.0
//! Specification", 3.6.2].

use gltf::json::Index;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

use super::super::Error;
use super::file::File;

/// Greatest number of components of an accessor without a buffer: its zeros are in no file.
const MOST_ZEROS: u64 = 1 << 26;

/// Component types that a use allows.
pub(super) const FLOATS: &[ComponentType] = &[ComponentType::F32];
pub(super) const INDICES: &[ComponentType] = &[ComponentType::U8, ComponentType::U16, ComponentType::U32];
/// Those of attributes under KHR_mesh_quantization, and of colours, weights and texture coordinates.
pub(super) const NUMBERS: &[ComponentType] =
    &[ComponentType::F32, ComponentType::I8, ComponentType::U8, ComponentType::I16, ComponentType::U16];

impl File {
    /// The vectors of `N` components of an accessor, integers as their values, or in [0, 1] or [-1, 1] where they are
    /// normalised. All are finite.
    ///
    /// # Errors
    ///
    /// An accessor of another shape or of other components than `allowed`, or that goes beyond its buffer.
    pub fn vectors<const N: usize>(
        &self,
        index: Index<Accessor>,
        place: &str,
        allowed: &[ComponentType],
    ) -> Result<Vec<[f64; N]>, Error> {
        let accessor = self.get(index, place, "accessors")?;
        let own = format!("accessors[{}]", index.value());
        let (kind, component) = self.kinds(accessor, &own)?;
        let has_columns = matches!(kind, Type::Mat2 | Type::Mat3);
        if kind.multiplicity() != N || has_columns || !allowed.contains(&component) {
            let what = format!("is {} of {}, which {place} cannot be", shape(kind), words(component));
            return Err(self.error(own, what));
        }
        let Ok(count) = usize::try_from(accessor.count.0) else {
            return Err(self.error(own, "has too many elements for this machine"));
        };
        let mut values = match accessor.buffer_view {
            None => self.zeros::<N>(accessor, &own)?,
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                let normalized = accessor.normalized;
                self.strided(&Elements { view, offset, count, component, normalized }, &own)?
            }
        };
        self.replace(accessor, component, &mut values, &own)?;
        match values.iter().position(|value| value.iter().any(|number| !number.is_finite())) {
            Some(at) => Err(self.error(own, format!("has a number that is not finite, at element {at}"))),
            None => Ok(values),
        }
    }

    /// The whole numbers of an accessor.
    pub fn whole(&self, index: Index<Accessor>, place: &str) -> Result<Vec<u32>, Error> {
        let values = self.vectors::<1>(index, place, INDICES)?;
        Ok(values.into_iter().map(|[value]| value as u32).collect())
    }

    fn kinds(&self, accessor: &Accessor, own: &str) -> Result<(Type, ComponentType), Error> {
        match (&accessor.type_, &accessor.component_type) {
            (Checked::Valid(kind), Checked::Valid(component)) => Ok((*kind, component.0)),
            (Checked::Invalid, _) => Err(self.error(own, "has a `type` that glTF does not know")),
            (_, Checked::Invalid) => Err(self.error(own, "has a `componentType` that glTF does not know")),
        }
    }

    fn zeros<const N: usize>(&self, accessor: &Accessor, own: &str) -> Result<Vec<[f64; N]>, Error> {
        let count = accessor.count.0;
        if count.saturating_mul(N as u64) > MOST_ZEROS {
            return Err(self.error(own, format!("has {count} elements and no buffer: that many are not read")));
        }
        Ok(vec![[0.0; N]; count as usize])
    }

    fn strided<const N: usize>(&self, elements: &Elements, own: &str) -> Result<Vec<[f64; N]>, Error> {
        let (bytes, stride) = self.view(elements.view, own)?;
        let size = N * elements.component.size();
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(self.error(own, format!("has elements of {size} bytes, {stride} bytes apart")));
        }
        if elements.count == 0 {
            return Ok(Vec::new());
        }
        let needed = (elements.count - 1).checked_mul(stride).and_then(|all| all.checked_add(size));
        let end = needed.and_then(|needed| usize::try_from(elements.offset).ok()?.checked_add(needed));
        let Some(end) = end.filter(|end| *end <= bytes.len()) else {
            let (count, length) = (elements.count, bytes.len());
            let what = format!("has {count} elements, which go beyond the {length} bytes of its view");
            return Err(self.error(own, what));
        };
        self.reading.advance((elements.count * size) as u64);
        let used = &bytes[elements.offset as usize..end];
        Ok(used.chunks(stride).map(|element| elements.vector(&element[..size])).collect())
    }

    /// Puts the values of a sparse accessor in place.
    fn replace<const N: usize>(
        &self,
        accessor: &Accessor,
        component: ComponentType,
        values: &mut [[f64; N]],
        own: &str,
    ) -> Result<(), Error> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let own = format!("{own}.sparse");
        let Checked::Valid(of_index) = &sparse.indices.component_type else {
            return Err(self.error(own, "has indices of a type that glTF does not know"));
        };
        let Ok(count) = usize::try_from(sparse.count.0) else {
            return Err(self.error(own, "has too many elements for this machine"));
        };
        let (view, offset) = (sparse.indices.buffer_view, sparse.indices.byte_offset.0);
        let elements = Elements { view, offset, count, component: of_index.0, normalized: false };
        let places = self.strided::<1>(&elements, &own)?;
        let (view, offset) = (sparse.values.buffer_view, sparse.values.byte_offset.0);
        let elements = Elements { view, offset, count, component, normalized: accessor.normalized };
        let replacements = self.strided::<N>(&elements, &own)?;
        for ([place], replacement) in places.into_iter().zip(replacements) {
            let length = values.len();
            let Some(value) = values.get_mut(place as usize) else {
                return Err(self.error(own, format!("replaces element {place} of {length}")));
            };
            *value = replacement;
        }
        Ok(())
    }
}

/// Elements in a view of a buffer.
struct Elements {
    view: Index<gltf::json::buffer::View>,
    offset: u64,
    count: usize,
    component: ComponentType,
    normalized: bool,
}

impl Elements {
    fn vector<const N: usize>(&self, bytes: &[u8]) -> [f64; N] {
        let size = self.component.size();
        std::array::from_fn(|at| number(&bytes[at * size..(at + 1) * size], self.component, self.normalized))
    }
}

/// A component, little-endian.
fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> f64 {
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    let (value, most) = match component {
        ComponentType::I8 => (f64::from(word[0] as i8), 127.0),
        ComponentType::U8 => (f64::from(word[0]), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes([word[0], word[1]])), 32767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes([word[0], word[1]])), 65535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(word)), f64::from(u32::MAX)),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(word)),
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

fn shape(kind: Type) -> &'static str {
    match kind {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    }
}

fn words(component: ComponentType) -> &'static str {
    match component {
        ComponentType::I8 => "bytes",
        ComponentType::U8 => "unsigned bytes",
        ComponentType::I16 => "shorts",
        ComponentType::U16 => "unsigned shorts",
        ComponentType::U32 => "unsigned integers",
        ComponentType::F32 => "floats",
    }
}
