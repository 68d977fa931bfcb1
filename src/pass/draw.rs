//! Draws: ranges of meshes under matrices.

use std::ops::{Deref, Range};
use std::sync::Arc;

use glam::DMat4;

use super::{DrawState, Face, FixedFunctionDesc, Input, Program, Uniform};
use crate::geometry::Mesh;
use crate::math::Aabb;

/// A shared mesh; equal when it is the same one.
#[derive(Clone, Debug)]
pub struct MeshRef(pub Arc<Mesh>);

impl PartialEq for MeshRef {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Deref for MeshRef {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.0
    }
}

/// Draws that share program, uniforms and inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Shaders of the batch.
    pub program: Program,
    /// The program's computation, for readers without shaders.
    pub meaning: FixedFunctionDesc,
    /// Uniforms that all draws share.
    pub uniforms: Vec<Uniform>,
    /// Images that the shaders sample.
    pub inputs: Vec<Input>,
    /// Faces that are not drawn, in addition to those of the pass's state.
    pub cull: Option<Face>,
    /// Overrides the pass's scissor; must lie inside it.
    pub scissor: Option<[u32; 4]>,
    /// GL_CLIP_DISTANCE0 and following, as many as the vertex stage writes by the uniform `clip_planes`; not in a pass
    /// that clips by a distance of its own.
    pub clip_planes: u8,
    /// Draws in their order.
    pub draws: Vec<Draw>,
}

impl Batch {
    /// State that it is drawn with in a pass of this state.
    pub fn state(&self, pass: &DrawState) -> DrawState {
        DrawState {
            cull: self.cull.or(pass.cull),
            scissor: self.scissor.or(pass.scissor),
            clip_distances: pass.clip_distances.max(self.clip_planes),
            ..*pass
        }
    }
}

/// One glDrawElements.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The object's name, for plans.
    pub label: String,
    /// Mesh whose vertices it reads.
    pub mesh: MeshRef,
    /// Way in which the indices are joined.
    pub primitive: Primitive,
    /// Range of the mesh's indices.
    pub indices: Range<u32>,
    /// Order of the mesh's triangles; `indices` counts in it.
    pub order: IndexOrder,
    /// Bounds of the range, in model space.
    pub bounds: Aabb,
    /// `clip_from_model`: every program of ours has this uniform, and the plan culls by it.
    pub clip_from_model: DMat4,
    /// Modelview matrix of a surface, for readers that transform in two steps; `None`: there is no eye space.
    pub eye_from_model: Option<DMat4>,
    /// True if the transform mirrors, so that front faces wind clockwise.
    pub mirrored: bool,
    /// Uniforms in addition to `clip_from_model`.
    pub uniforms: Vec<Uniform>,
}

impl Draw {
    /// Number of triangles, or of line segments.
    pub fn primitive_count(&self) -> u64 {
        let each = match self.primitive {
            Primitive::Triangles => 3,
            Primitive::Lines => 2,
        };
        u64::from(self.indices.end - self.indices.start) / each
    }
}

/// Primitives that indices are joined to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// GL_TRIANGLES: three indices each.
    Triangles,
    /// GL_LINES: two indices each.
    Lines,
}

/// The order in which a mesh's triangles are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum IndexOrder {
    /// The file's order.
    File,
    /// An order for the post-transform vertex cache.
    VertexCache,
}
