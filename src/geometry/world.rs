//! The scene of a model's file: meshes that nodes place, cameras and lights.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::Mesh;
use crate::math::Aabb;

/// A mesh where a node places it.
#[derive(Clone, Debug)]
pub struct PlacedMesh {
    /// The node's name, or `node 3` by its number.
    pub name: String,
    /// Shared by the nodes that have it.
    pub mesh: Arc<Mesh>,
    pub world_from_model: DMat4,
    /// Its node's place in the order of [`ModelWorld::nodes`].
    pub(super) place: usize,
}

/// The scene of a file.
#[derive(Clone, Debug, Default)]
pub struct ModelWorld {
    /// In the order of the nodes, parents first; those without triangles are left out.
    pub meshes: Vec<PlacedMesh>,
    pub cameras: Vec<PlacedCamera>,
    pub lights: Vec<PlacedLight>,
    /// Length of the file's first animation: the time of its last key. 0: there is none.
    pub seconds: f64,
    /// Names of the scene's nodes, each followed by those below it: their places in this list, its own first.
    pub(super) nodes: Vec<(String, Range<usize>)>,
    /// Names of the meshes that the scene's nodes have.
    pub(super) own: Vec<(String, Arc<Mesh>)>,
}

/// A time of an animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Seconds from the animation's start, at least 0. Before its first key and after its last one it stands still.
    pub seconds: f64,
    /// Name of the animation; `None`: the file's first.
    pub animation: Option<String>,
}

/// Meaning of a name in a file.
#[derive(Clone, Debug)]
pub enum Named {
    /// A node, with all below it, placed as the file places it; and the number of other nodes of that name.
    Node(Vec<PlacedMesh>, usize),
    /// A mesh in its own space.
    Mesh(PlacedMesh),
    /// Nothing: the names that there are.
    Unknown(Vec<String>),
}

/// A perspective camera in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedCamera {
    /// Name of its node, or of the camera, or its number.
    pub name: String,
    pub eye: DVec3,
    /// Unit vector.
    pub forward: DVec3,
    /// Unit vector.
    pub up: DVec3,
    /// Full vertical angle, in degrees.
    pub fov_y_degrees: f64,
    pub near: f64,
    /// `None`: infinitely far.
    pub far: Option<f64>,
    /// Width over height of the picture; `None`: any.
    pub aspect: Option<f64>,
}

/// A light in world space.
///
/// Colour is the file's, times its intensity, over pi: a white surface of glTF reflects its irradiance over pi, and here its
/// light's colour. So a directional light of intensity pi lights a white surface to 1, and a spot or point light of pi candela
/// does so at a distance of 1, from where it falls off with the square. There is no exposure.
///
/// A range, which ends a light's reach smoothly, and the inner angle of a cone, from which it fades to the outer one, are
/// no part of a scene's lights: their file is warned of.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLight {
    /// Name of its node, or of the light, or its number.
    pub name: String,
    /// RGB, each at least 0.
    pub color: [f64; 3],
    pub shape: PlacedShape,
}

/// Place and reach of a light in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlacedShape {
    /// `cone_degrees`: the full angle of the cone at which it ends.
    Spot {
        position: DVec3,
        direction: DVec3,
        cone_degrees: f64,
    },
    Point {
        position: DVec3,
    },
    Directional {
        direction: DVec3,
    },
}

impl ModelWorld {
    /// Bounds of all meshes in the world.
    pub fn bounds(&self) -> Aabb {
        let corners = |placed: &PlacedMesh| {
            let (world_from_file, origin) = (placed.world_from_model, placed.mesh.origin);
            placed.mesh.bounds.corners().map(|corner| world_from_file.transform_point3(corner + origin))
        };
        Aabb::from_points(self.meshes.iter().flat_map(corners))
    }

    /// Finds the node or the mesh of a name.
    pub fn named(&self, wanted: &str) -> Named {
        let mut nodes = self.nodes.iter().filter(|(name, _)| name == wanted);
        if let Some((_, places)) = nodes.next() {
            let below = self.meshes.iter().filter(|placed| places.contains(&placed.place)).cloned();
            return Named::Node(below.collect(), nodes.count());
        }
        match self.own.iter().find(|(name, _)| name == wanted) {
            Some((name, mesh)) => {
                let (name, mesh) = (name.clone(), mesh.clone());
                Named::Mesh(PlacedMesh { name, mesh, world_from_model: DMat4::IDENTITY, place: 0 })
            }
            None => {
                let names = self.nodes.iter().map(|(name, _)| name).chain(self.own.iter().map(|(name, _)| name));
                Named::Unknown(names.cloned().collect())
            }
        }
    }
}
