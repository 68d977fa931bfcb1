//! Vertices in the model: transformed, lit, with coordinates that are generated [GL 4.6 compatibility, 12.1, 12.2].

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use super::apply::wide;
use super::lighting::Shaded;
use super::start::COORDINATES;
use super::state::{FixedState, PLANES};
use crate::conformance::bench::fixed_commands::{FIXED_UNITS, FixedGiven, FixedVertex};
use crate::context::compatibility::raw;

/// A vertex behind the vertex stages.
#[derive(Clone, Copy, Debug)]
pub struct FixedCorner {
    pub clip: DVec4,
    /// Pixels of the viewport.
    pub window: DVec2,
    /// Front and back.
    pub shaded: [Shaded; 2],
    /// Fog coordinates that GL allows: depth and distance, or the one that is given twice.
    pub fog: [f64; 2],
    /// After the texture matrix.
    pub coordinates: [DVec4; FIXED_UNITS],
    /// Sides of the clip planes that are on; 1 for others.
    pub planes: [f64; PLANES],
    /// False: a term of its lighting is near a jump.
    pub sure: bool,
}

/// Matrices of a draw.
pub struct Transform {
    pub modelview: DMat4,
    pub projection: DMat4,
    normals: DMat3,
    rescale: f64,
}

impl FixedState {
    pub fn transform(&self) -> Transform {
        let modelview = Self::top(&self.modelview);
        let inverse = DMat3::from_mat4(modelview).inverse();
        // The third row of the inverse [GL 4.6 compatibility, 12.1.2].
        let row = inverse.row(2).length();
        Transform {
            modelview,
            projection: Self::top(&self.projection),
            normals: inverse.transpose(),
            rescale: if self.on.has(raw::RESCALE_NORMAL) { 1.0 / row } else { 1.0 },
        }
    }

    /// A vertex through all stages, in a viewport of this size.
    pub fn corner(&self, transform: &Transform, given: FixedGiven, vertex: &FixedVertex, size: DVec2) -> FixedCorner {
        let current = &self.current;
        let color = if given.color { wide(vertex.color) } else { current.color };
        let secondary =
            if given.secondary { DVec3::from_array(vertex.secondary.map(f64::from)) } else { current.secondary };
        let normal = if given.normal { DVec3::from_array(vertex.normal.map(f64::from)) } else { current.normal };
        let object = wide(vertex.position);
        let eye = transform.modelview * object;
        let clip = transform.projection * eye;
        let mut normal = transform.normals * normal * transform.rescale;
        if self.on.has(raw::NORMALIZE) {
            normal = normal.normalize();
        }
        let mut sure = true;
        let shaded = [0, 1].map(|side| {
            if self.on.has(raw::LIGHTING) {
                let (shaded, is_sure) = self.lit(side, color, eye.truncate(), normal);
                sure &= is_sure || side == 1 && !self.two_side;
                shaded
            } else {
                let primary = color.clamp(DVec4::ZERO, DVec4::ONE);
                Shaded { primary, secondary: secondary.clamp(DVec3::ZERO, DVec3::ONE) }
            }
        });
        let fog = match self.fog.source {
            raw::FOG_COORD => [if given.fog { f64::from(vertex.fog) } else { current.fog }; 2],
            _ => [eye.z.abs(), eye.truncate().length()],
        };
        let coordinates = std::array::from_fn(|unit| {
            if self.texture_of(unit).is_none() {
                return DVec4::W;
            }
            let start =
                if given.coordinates[unit] { wide(vertex.coordinates[unit]) } else { current.coordinates[unit] };
            let mut all = start.to_array();
            for (index, [_, switch]) in COORDINATES.into_iter().enumerate() {
                if self.units[unit].on.has(switch) {
                    all[index] = self.generated(unit, index, object, eye, normal);
                }
            }
            Self::top(&self.texture_matrices[unit]) * DVec4::from_array(all)
        });
        let planes = std::array::from_fn(|plane| {
            if self.on.has(raw::CLIP_PLANE0 + plane as u32) { self.planes[plane].dot(eye) } else { 1.0 }
        });
        let window = (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * size;
        FixedCorner { clip, window, shaded, fog, coordinates, planes, sure }
    }

    /// A coordinate that is generated; no number where it has no bound.
    fn generated(&self, unit: usize, index: usize, object: DVec4, eye: DVec4, normal: DVec3) -> f64 {
        let unit = &self.units[unit];
        let u = eye.truncate().normalize();
        let r = u - 2.0 * normal * normal.dot(u);
        match unit.generate[index] {
            raw::OBJECT_LINEAR => unit.object_planes[index].dot(object),
            raw::EYE_LINEAR => unit.eye_planes[index].dot(eye),
            raw::SPHERE_MAP => {
                let m = 2.0 * (r + DVec3::Z).length();
                if m < 0.2 { f64::NAN } else { r[index] / m + 0.5 }
            }
            raw::REFLECTION_MAP => r[index],
            _ => normal[index],
        }
    }
}
