//! The camera as an eye, three directions and an angle: rays through pixel centres, without a matrix.

use glam::DVec3;

use crate::scene::Scene;

pub(super) struct Eye {
    pub position: DVec3,
    ahead: DVec3,
    /// One pixel to the right and one up, in the plane at distance 1.
    pub right: DVec3,
    pub up: DVec3,
    half_size: [f64; 2],
    pub near: f64,
    pub far: f64,
}

impl Eye {
    pub fn new(scene: &Scene) -> Self {
        let camera = &scene.camera;
        let [width, height] = scene.image.size.map(f64::from);
        let ahead = (camera.target - camera.eye).normalize();
        let right = ahead.cross(camera.up).normalize();
        // Pixels are square: the horizontal angle follows from the image's aspect.
        let pixel = 2.0 * (0.5 * camera.fov_y_radians).tan() / height;
        Self {
            position: camera.eye,
            ahead,
            right: right * pixel,
            up: right.cross(ahead) * pixel,
            half_size: [0.5 * width, 0.5 * height],
            near: camera.near,
            far: camera.far,
        }
    }

    pub fn is_finite(&self) -> bool {
        [self.position, self.ahead, self.right, self.up].iter().all(|vector| vector.is_finite())
            && 0.0 < self.near
            && self.near < self.far
            && self.far.is_finite()
    }

    /// Ray through the centre of the pixel in column `x` and row `y` from the top. Its length is chosen so that the ray's
    /// parameter is the depth along the view axis, which near and far are measured by.
    pub fn direction(&self, x: u32, y: u32) -> DVec3 {
        let across = f64::from(x) + 0.5 - self.half_size[0];
        let above = self.half_size[1] - f64::from(y) - 0.5;
        self.ahead + across * self.right + above * self.up
    }

    /// Planes that bound the view: unit normals that look inwards, and the eye's distance inside of each.
    pub fn sides(&self) -> [(DVec3, f64); 6] {
        let [width, height] = self.half_size;
        let (right, up) = (self.right * width, self.up * height);
        // Across a side: from the axis towards the eye's own half width.
        let side = |way: DVec3| ((self.ahead * way.length_squared() - way).normalize(), 0.0);
        [side(right), side(-right), side(up), side(-up), (self.ahead, -self.near), (-self.ahead, self.far)]
    }

    /// Greatest difference that a depth buffer of 24 bits may make between two surfaces at the same depth: 2⁻²² of the
    /// range in window space, as measured on llvmpipe (rule GL-T3 of `glumbra check`), in world units along the axis.
    pub fn depth_error(&self, depth: f64, rise_per_pixel: f64) -> f64 {
        (self.window(depth, self.far) + self.slope(rise_per_pixel)) / f64::from(1 << 22)
    }

    /// The same for a depth buffer of `bits` bits, whose far plane may be at infinity: four of its codes.
    pub fn infinite_depth_error(&self, bits: u32, depth: f64, rise_per_pixel: f64) -> f64 {
        (self.window(depth, f64::INFINITY) + self.slope(rise_per_pixel)) * (2.0 - f64::from(bits)).exp2()
    }

    /// Length of the whole depth range in world units, if it were everywhere as fine as at `depth`.
    fn window(&self, depth: f64, far: f64) -> f64 {
        depth * depth * (1.0 / self.near - 1.0 / far)
    }

    fn slope(&self, rise_per_pixel: f64) -> f64 {
        rise_per_pixel * 2.0 * (self.half_size[0] + self.half_size[1])
    }

    pub fn depth_of(&self, vector: DVec3) -> f64 {
        self.ahead.dot(vector)
    }
}
