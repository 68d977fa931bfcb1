//! A surface that waves [HSM, "Advantages and Limitations": geometry that is made or altered where it is drawn; [HSM,
//! "Advantages and Limitations"]: what a scene says of it, the box that holds it, and the moved mesh for techniques that
//! read vertices. The vertex stage has its own arithmetic (`glsl/common/position.vert`), the ray tracer another.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;

use super::derived::{Derived, Most};
use super::mesh::{Mesh, MeshTangents};
use crate::math::Aabb;

/// Moves a vertex p to `p + reach sin(2 pi (vector . p + phase))`, in model space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The way that vertices move, as long as the amplitude.
    pub reach: DVec3,
    /// Along the way from crest to crest, 1 / wavelength long: turns per length.
    pub vector: DVec3,
    /// Phase in turns, in [0, 1).
    pub phase: f64,
}

/// Rounding of f32 arithmetic in a coordinate, relative to the greatest operand.
const SLACK: f64 = 1.0 / (1 << 21) as f64;

/// Number of moved meshes that are kept for one mesh at rest.
const MOST_WAVES: usize = 8;

impl Wave {
    /// The box that holds what moves out of `rest`, wherever the wave stands.
    pub fn bounds(&self, rest: Aabb) -> Aabb {
        if rest.is_empty() {
            return rest;
        }
        let reach = self.reach.abs();
        let reach = reach + SLACK * (reach + rest.min.abs().max(rest.max.abs()));
        Aabb { min: rest.min - reach, max: rest.max + reach }
    }

    /// The same wave for positions that are relative to `origin`.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        Self { phase: (self.phase + self.vector.dot(origin)).rem_euclid(1.0), ..*self }
    }

    /// Tests whether it is so steep along its own way that the surface may fold over and turn inside out: the Jacobian
    /// `I + 2 pi cos(...) reach vector^T` then has a determinant that is not above zero everywhere.
    pub fn folds(&self) -> bool {
        TAU * self.vector.dot(self.reach).abs() >= 1.0
    }

    /// `rest` with its vertices moved, its normals with them. Vertices in one place stay in one place: what is closed stays
    /// closed.
    pub fn moved(&self, rest: &Mesh) -> Mesh {
        let (name, positions) = (format!("{}, waving", rest.name), self.moved_positions(rest));
        let mut mesh = Mesh { name, positions, ..rest.clone() };
        for (normal, position) in mesh.normals.iter_mut().zip(&rest.positions) {
            let cosine = self.angle(*position).cos();
            let old = DVec3::from_array(normal.map(f64::from));
            // The cofactors of the Jacobian: its inverse transpose times its determinant, with no division.
            let slope = TAU * cosine;
            let new = old * (1.0 + slope * self.vector.dot(self.reach)) - slope * self.reach.dot(old) * self.vector;
            *normal = new.try_normalize().unwrap_or(old).as_vec3().to_array();
        }
        if let Some(tangents) = &mut mesh.tangents {
            self.move_tangents(rest, tangents);
        }
        mesh.update_bounds();
        mesh
    }

    /// Turns directions with the triangles, by the same cofactors as normals and as shares of the normal's length, so that a
    /// bumped normal, a sum of the three, is moved as a normal is.
    fn move_tangents(&self, rest: &Mesh, tangents: &mut MeshTangents) {
        let MeshTangents { tangents, bitangents } = tangents;
        for (index, position) in rest.positions.iter().enumerate() {
            let slope = TAU * self.angle(*position).cos();
            let turned = |old: [f32; 3]| {
                let old = DVec3::from_array(old.map(f64::from));
                old * (1.0 + slope * self.vector.dot(self.reach)) - slope * self.reach.dot(old) * self.vector
            };
            let length = turned(rest.normals[index]).length();
            for direction in [&mut tangents[index], &mut bitangents[index]] {
                let share = turned(*direction) / length;
                *direction = if share.is_finite() { share.as_vec3().to_array() } else { *direction };
            }
        }
    }

    /// The positions of [`Wave::moved`] alone.
    pub fn moved_positions(&self, rest: &Mesh) -> Vec<[f32; 3]> {
        let moved = |position: &[f32; 3]| {
            let place = DVec3::from_array(position.map(f64::from));
            (place + self.reach * self.angle(*position).sin()).as_vec3().to_array()
        };
        rest.positions.iter().map(moved).collect()
    }

    /// The mesh of [`Wave::moved`], kept in `derived`.
    pub fn moved_once(&self, rest: &Arc<Mesh>, derived: &Derived) -> Arc<Mesh> {
        derived.get(rest, Most::OfMesh(MOST_WAVES), *self, || Arc::new(self.moved(rest)))
    }

    /// Angle at a vertex, in radians.
    fn angle(&self, position: [f32; 3]) -> f64 {
        TAU * (self.vector.dot(DVec3::from_array(position.map(f64::from))) + self.phase).fract()
    }
}
