//! A surface that waves [HSM, "Advantages and Limitations": geometry that is made or altered where it is drawn; [HSM,
//! "Advantages and Limitations"]: what a scene says of it, the box that holds it, and the moved mesh for techniques that
//! read vertices. The vertex stage has its own arithmetic (`glsl/common/position.vert`), the ray tracer another.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::DVec3;

use super::Mesh;
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

    /// `rest` with its vertices moved, its normals with them, kept as long as somebody draws it: a plan is made for every
    /// frame. Vertices in one place stay in one place: what is closed stays closed.
    pub fn moved(&self, rest: &Arc<Mesh>) -> Arc<Mesh> {
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|entry| entry.moved.strong_count() > 0);
        let is_it = |entry: &&Known| std::ptr::eq(entry.rest.as_ptr(), Arc::as_ptr(rest)) && entry.wave == *self;
        if let Some(moved) = known.iter().find(is_it).and_then(|entry| entry.moved.upgrade()) {
            return moved;
        }
        let moved = Arc::new(self.mesh(rest));
        known.push(Known { rest: Arc::downgrade(rest), wave: *self, moved: Arc::downgrade(&moved) });
        moved
    }

    fn mesh(&self, rest: &Mesh) -> Mesh {
        let mut mesh = Mesh { name: format!("{}, waving", rest.name), ..rest.clone() };
        for (index, position) in mesh.positions.iter_mut().enumerate() {
            let place = DVec3::from_array(position.map(f64::from));
            let (sine, cosine) = (TAU * (self.vector.dot(place) + self.phase).fract()).sin_cos();
            *position = (place + self.reach * sine).as_vec3().to_array();
            let Some(normal) = mesh.normals.get_mut(index) else { continue };
            let old = DVec3::from_array(normal.map(f64::from));
            // The cofactors of the Jacobian: its inverse transpose times its determinant, with no division.
            let slope = TAU * cosine;
            let new = old * (1.0 + slope * self.vector.dot(self.reach)) - slope * self.reach.dot(old) * self.vector;
            *normal = new.try_normalize().unwrap_or(old).as_vec3().to_array();
        }
        mesh.update_bounds();
        mesh
    }
}

struct Known {
    rest: Weak<Mesh>,
    wave: Wave,
    moved: Weak<Mesh>,
}

static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());
