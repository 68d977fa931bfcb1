//! A light's near plane: what is nearer does not cast. A volume counts whole triangles, so that only those are left out
//! that are nearer with all of their shade that matters.

use glam::{DMat4, DVec3};

/// Where a light begins to be shaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightNear {
    /// Of the light, in world space.
    pub position: DVec3,
    /// The spotlight's, of unit length; `None`: distance is measured along the nearest coordinate axis of the world.
    pub axis: Option<DVec3>,
    /// In world units, along `axis`.
    pub near: f64,
}

/// How a triangle lies to the light's near plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nearness {
    /// All of it casts.
    Beyond,
    /// A part of it casts, the greater one.
    Mostly,
    /// A part of it casts, the smaller one.
    Hardly,
    /// None of it casts, or next to none.
    Nearer,
}

/// A light at height h over a triangle sees what is beyond the near plane of it within an angle of h / near to its
/// plane. Here that is a 4096th radian, less than a pixel of a picture of 1000 pixels and a right angle's view.
const TOUCHING: f64 = 1.0 / 4096.0;

/// A light that is nearer to a triangle than this share of the triangle's size sees corners on opposite sides of it, and
/// f32 does not know which way round it lies: 64 roundings of 2⁻²⁴.
const ROUNDED: f64 = 1.0 / (1 << 18) as f64;

impl LightNear {
    /// Of a triangle in model space.
    pub fn nearness(&self, world_from_model: &DMat4, corners: &[DVec3; 3]) -> Nearness {
        let corners = corners.map(|corner| world_from_model.transform_point3(corner) - self.position);
        let distance = nearest_to_origin(&corners).length();
        if distance > self.reach() {
            return Nearness::Beyond;
        }
        if corners.iter().all(|corner| self.depth(*corner) < self.near) {
            return Nearness::Nearer;
        }
        let size = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
        if distance <= (TOUCHING * self.near).max(ROUNDED * size).min(self.near) {
            Nearness::Nearer
        } else if distance <= 0.5 * self.near {
            Nearness::Hardly
        } else if distance < self.near {
            Nearness::Mostly
        } else {
            Nearness::Beyond
        }
    }

    /// The greatest distance of a triangle that may lie before the near plane: a corner of the cube around a point light
    /// is 1.73 times as far away as its faces, a corner of the near square of a spotlight of 100 degrees 1.96 times. What
    /// lies beside or behind a spotlight casts nowhere that it lights.
    pub fn reach(&self) -> f64 {
        2.0 * self.near
    }

    fn depth(&self, from_light: DVec3) -> f64 {
        self.axis.map_or(from_light.abs().max_element(), |axis| axis.dot(from_light))
    }
}

/// The triangle's point nearest to the origin.
fn nearest_to_origin(&[a, b, c]: &[DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let foot = normal * (normal.dot(a) / normal.length_squared());
    let is_inside = |from: DVec3, to: DVec3| (to - from).cross(foot - from).dot(normal) >= 0.0;
    if is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        return foot;
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let way = to - from;
        from + way * (-from.dot(way) / way.length_squared()).clamp(0.0, 1.0)
    };
    let nearest = |p: DVec3, q: DVec3| if p.length_squared() <= q.length_squared() { p } else { q };
    nearest(nearest(on_edge(a, b), on_edge(b, c)), on_edge(c, a))
}
