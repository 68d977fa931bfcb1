//! A draw that covers every pixel of a target.

use std::sync::{Arc, OnceLock};

use glam::{DMat4, DVec4};

use crate::geometry::{Mesh, primitive};
use crate::pass::{Draw, IndexOrder, MeshRef, Primitive};

/// The square of side 2 in x and z, stood up in clip space. One mesh for all, so that it is uploaded once.
pub fn whole_target(label: &str) -> Draw {
    static SQUARE: OnceLock<Arc<Mesh>> = OnceLock::new();
    let mesh = SQUARE.get_or_init(|| Arc::new(primitive("quad").unwrap_or_default())).clone();
    Draw {
        label: label.to_owned(),
        primitive: Primitive::Triangles,
        indices: 0..mesh.indices.len() as u32,
        order: IndexOrder::File,
        bounds: mesh.bounds,
        mesh: MeshRef(mesh),
        clip_from_model: DMat4::from_cols(DVec4::X, DVec4::Z, DVec4::Y, DVec4::W),
        eye_from_model: None,
        mirrored: false,
        uniforms: Vec::new(),
    }
}
