//! Between world space and the picture: where a point is seen, and what a pixel looks at. By the camera's matrices, as the
//! renderer has them.

use glam::{DVec2, DVec3};

use super::{Camera, Scene};

impl Camera {
    /// Position of a world-space `point` in a picture of `size` pixels: in pixels from the left and the upper edge; pixel
    /// (0, 0) is the square from 0 to 1. The point may lie beside the picture, or before or beyond the depth range. `None`:
    /// it lies in the eye's plane or behind it.
    ///
    /// ```
    /// use glumbra::prelude::*;
    ///
    /// let floor = ObjectBuilder::mesh("quad");
    /// let scene = Scene::builder().size([200, 100]).camera([0.0, 3.0, 4.0], [0.0; 3], 45.0).object(floor).build()?.scene;
    /// let middle = scene.camera.project(glam::DVec3::ZERO, scene.image.size).ok_or("behind the eye")?;
    /// assert!(middle.distance(glam::DVec2::new(100.0, 50.0)) < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn project(&self, point: DVec3, size: [u32; 2]) -> Option<DVec2> {
        let size = DVec2::from_array(size.map(f64::from));
        let clip = self.clip_from_view(size.x / size.y) * self.view_from_world() * point.extend(1.0);
        let place = DVec2::new(clip.x, -clip.y) / clip.w;
        (clip.w > 0.0).then(|| 0.5 * (place + 1.0) * size)
    }

    /// Ray from the eye through a place in a picture of `size` pixels, measured as [`Camera::project`] has it: the eye, and
    /// the ray's direction, of unit length. The middle of pixel (x, y) is at (x + 0.5, y + 0.5).
    pub fn ray(&self, place: DVec2, size: [u32; 2]) -> [DVec3; 2] {
        let size = DVec2::from_array(size.map(f64::from));
        let world_from_clip = (self.clip_from_view(size.x / size.y) * self.view_from_world()).inverse();
        let device = 2.0 * place / size - 1.0;
        let on_near = world_from_clip.project_point3(DVec3::new(device.x, -device.y, -1.0));
        [self.eye, (on_near - self.eye).normalize_or_zero()]
    }
}

impl Scene {
    /// Column and row, from the upper left, of the pixel that holds a world-space `point`; `None`: the point is not in the
    /// picture. Whether something hides it is not asked.
    pub fn pixel(&self, point: DVec3) -> Option<[u32; 2]> {
        let [width, height] = self.image.size;
        let place = self.camera.project(point, self.image.size)?.floor();
        let inside = |value: f64, end: u32| (0.0..f64::from(end)).contains(&value);
        (inside(place.x, width) && inside(place.y, height)).then_some([place.x as u32, place.y as u32])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points and the pixels that see them undo each other: to 1e-9 of a pixel, far more than f64 loses in two products of
    /// matrices with entries below a hundred.
    #[test]
    fn a_ray_through_a_place_meets_what_is_seen_there() {
        let camera = Camera {
            eye: DVec3::new(2.5, 4.5, 5.0),
            target: DVec3::new(0.2, 0.2, 0.0),
            up: DVec3::Y,
            fov_y_radians: 0.7,
            near: 0.5,
            far: 30.0,
        };
        let size = [320, 180];
        for place in [[0.5, 0.5], [160.0, 90.0], [319.5, 12.25]].map(DVec2::from_array) {
            let [eye, ray] = camera.ray(place, size);
            for depth in [0.1, 7.0, 100.0] {
                let seen = camera.project(eye + depth * ray, size).unwrap();
                assert!(seen.distance(place) < 1e-9, "{place} {seen}");
            }
            assert_eq!(camera.project(eye - ray, size), None);
        }
    }
}
