//! Wire frames of lights' frusta, as in the sample program hw_shadowmaps_simple, a cube mapped through the inverse light
//! projection; and of an object's triangles. They are drawn over the finished surfaces, hidden by them, and leave their depth
//! as it is.

use std::sync::Arc;

use crate::geometry::{Mesh, Part};
use crate::lights::Viewer;
use crate::math::{Aabb, frustum};
use crate::pass::{
    Attribute, Batch, Draw, DrawState, FixedFunctionDesc, IndexOrder, MeshRef, Primitive, Program, Uniform,
    UniformValue, glsl,
};
use crate::scene::{Frustum, Light, Object, Scene};

/// Depth-tested against the surfaces; writes colour only.
pub const STATE: DrawState = DrawState { depth_write: false, ..DrawState::OPAQUE };

const YELLOW: glam::Vec3 = glam::Vec3::new(1.0, 1.0, 0.0);

/// The edges of a cube whose corners are numbered as [`Aabb::corners`] has them: two are joined where one bit differs.
const EDGES: [[u32; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Share of the depth by which an object's edges come before its surface.
const EDGES_BEFORE: f64 = 1e-4;

/// The batch that draws the frusta of the lights with `frustum = "shown"`, and the triangles' edges of the object of index
/// `wire`; `None` where there is none of them.
pub fn guides(scene: &Scene, wire: Option<usize>, viewer: &Viewer) -> Option<Batch> {
    let shown = |light: &Light| {
        let spot = light.spot().filter(|spot| spot.frustum_shown)?;
        Some(frustum_draw(&light.name, &spot.frustum, viewer))
    };
    let wired = wire.and_then(|index| scene.objects.get(index)).map(|object| edges_draw(object, viewer));
    let draws: Vec<Draw> = scene.lights.iter().filter_map(shown).chain(wired).collect();
    let program = Program {
        label: String::from("guide"),
        defines: Vec::new(),
        vertex: vec![glsl!("common/position.vert"), glsl!("views/frustum_line.vert")],
        fragment: vec![glsl!("views/frustum_line.frag")],
        attributes: vec![Attribute::Position],
    };
    let uniforms = vec![Uniform::new("guide_color", UniformValue::Vec3(YELLOW))];
    let meaning = FixedFunctionDesc::Constant(YELLOW.extend(1.0).to_array());
    (!draws.is_empty()).then_some(Batch {
        program,
        meaning,
        uniforms,
        inputs: Vec::new(),
        cull: None,
        scissor: None,
        clip_planes: 0,
        draws,
    })
}

fn frustum_draw(light: &str, seen: &Frustum, viewer: &Viewer) -> Draw {
    let mesh = frustum_mesh(seen);
    let clip_from_model = viewer.clip_from_world() * seen.view_from_world().inverse();
    Draw {
        label: format!("frustum of {light}"),
        primitive: Primitive::Lines,
        indices: 0..mesh.indices.len() as u32,
        order: IndexOrder::File,
        bounds: mesh.bounds,
        mesh: MeshRef(Arc::new(mesh)),
        clip_from_model,
        eye_from_model: None,
        mirrored: false,
        uniforms: Vec::new(),
    }
}

/// Edges of an object's triangles, each once, as its mesh stands without a wave.
fn edges_draw(object: &Object, viewer: &Viewer) -> Draw {
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(object.mesh.indices.len());
    for [a, b, c] in object.mesh.indices.as_chunks::<3>().0 {
        edges.extend([[a, b], [b, c], [c, a]].map(|[from, to]| [*from.min(to), *from.max(to)]));
    }
    edges.sort_unstable();
    edges.dedup();
    let mesh = Mesh { indices: edges.concat(), parts: Vec::new(), ..(*object.mesh).clone() };
    let mut clip = (viewer.clip_from_world() * object.world_from_model).transpose();
    clip.z_axis -= EDGES_BEFORE * clip.w_axis;
    Draw {
        label: format!("edges of {}", object.name),
        primitive: Primitive::Lines,
        indices: 0..mesh.indices.len() as u32,
        order: IndexOrder::File,
        bounds: mesh.bounds,
        mesh: MeshRef(Arc::new(mesh)),
        clip_from_model: clip.transpose(),
        eye_from_model: None,
        mirrored: false,
        uniforms: Vec::new(),
    }
}

/// The clip cube's edges in the light's own space. The corners are mapped here, in f64, and not by the vertex stage:
/// the plan's culling takes boxes in affine spaces, and a stiff projection's inverse does not fit into f32.
fn frustum_mesh(seen: &Frustum) -> Mesh {
    let corners = frustum::corners(&seen.clip_from_view().inverse());
    let bounds = Aabb::from_points(corners);
    let indices: Vec<u32> = EDGES.into_iter().flatten().collect();
    let part = Part { name: String::from("frustum"), indices: 0..indices.len() as u32, material: None, bounds };
    Mesh {
        name: String::from("wire cube"),
        positions: corners.iter().map(|corner| corner.as_vec3().to_array()).collect(),
        normals: vec![[0.0, 0.0, 1.0]; corners.len()],
        indices,
        parts: vec![part],
        bounds,
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::EDGES;

    #[test]
    fn edges_join_corners_that_differ_in_one_coordinate() {
        assert!(EDGES.iter().all(|[a, b]| a < b && (a ^ b).count_ones() == 1));
        let mut edges = EDGES.to_vec();
        edges.sort_unstable();
        edges.dedup();
        assert_eq!(edges.len(), 12);
    }
}
