//! The floor of a light through a lens: for each lens point a map and a pass that adds its share in floats; the sum over the
//! picture. The fewest GL calls: no stencil, nothing left out.

use glam::camera::rh::proj::opengl;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec2, Vec3};
use glow::HasContext;

use super::Result;
use super::floor_gl::Program;
use super::floor_layer::Layer;
use super::floor_maps::MapPass;
use super::kinds::{LENS_DISTANCE, LENS_POINTS, LENS_RADIUS};
use super::numbers::Numbers;

/// Targets, programs and lens points.
pub struct Lens {
    pub layer: Layer,
    ambient: Program,
    points: Vec<Point>,
}

/// One lens point's matrices and place.
struct Point {
    clip_from_world: Mat4,
    place: Vec3,
}

impl Lens {
    pub fn new(gl: &glow::Context, numbers: &Numbers, camera: Mat4) -> Result<Self> {
        let vertex = include_str!("lit.vert");
        let ambient = Program::new(
            gl,
            "",
            vertex,
            "#version 330 core\nuniform float material;\nout vec4 color;\nvoid main() { color = vec4(vec3(material * 0.2), 1.0); }\n",
        )?;
        unsafe {
            gl.use_program(Some(ambient.name));
            let matrix = ambient.at(gl, "clip_from_world");
            gl.uniform_matrix_4_f32_slice(matrix.as_ref(), false, &camera.to_cols_array());
        }
        Ok(Self { layer: Layer::new(gl, numbers.size)?, ambient, points: points(numbers) })
    }

    /// Draws the picture. `draw` draws everything by a program.
    pub fn draw(&self, gl: &glow::Context, size: i32, map: &MapPass, lit: &Program, draw: impl Fn(&Program)) {
        let half = Mat4::from_translation(Vec3::splat(0.5)) * Mat4::from_scale(Vec3::splat(0.5));
        let of_map = map.program.at(gl, "clip_from_world");
        let [texture, light] = ["texture_from_world", "light"].map(|name| lit.at(gl, name));
        unsafe {
            self.layer.clear(gl);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.layer.picture));
            gl.viewport(0, 0, size, size);
            gl.clear_color(0.30, 0.40, 0.60, 1.0);
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            gl.use_program(Some(self.ambient.name));
            draw(&self.ambient);
            gl.blend_func(glow::ONE, glow::ONE);
            for point in &self.points {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(map.target));
                gl.viewport(0, 0, map.size, map.size);
                gl.clear(glow::DEPTH_BUFFER_BIT);
                gl.enable(glow::POLYGON_OFFSET_FILL);
                gl.use_program(Some(map.program.name));
                gl.uniform_matrix_4_f32_slice(of_map.as_ref(), false, &point.clip_from_world.to_cols_array());
                draw(&map.program);
                gl.disable(glow::POLYGON_OFFSET_FILL);
                self.layer.bind(gl);
                gl.viewport(0, 0, size, size);
                gl.depth_func(glow::EQUAL);
                gl.depth_mask(false);
                gl.enable(glow::BLEND);
                gl.use_program(Some(lit.name));
                let matrix = half * point.clip_from_world;
                gl.uniform_matrix_4_f32_slice(texture.as_ref(), false, &matrix.to_cols_array());
                gl.uniform_3_f32(light.as_ref(), point.place.x, point.place.y, point.place.z);
                draw(lit);
                gl.disable(glow::BLEND);
                gl.depth_mask(true);
                gl.depth_func(glow::LESS);
            }
            self.layer.put_over(gl);
        }
    }
}

/// The lens points of glumbra's rule, an even number of them.
fn points(numbers: &Numbers) -> Vec<Point> {
    let [near, far] = numbers.light_near_far;
    let ahead = (numbers.light_target - numbers.light).normalize();
    let right = ahead.cross(Vec3::Y).normalize();
    let up = right.cross(ahead);
    let projection = opengl::perspective(numbers.cone_degrees.to_radians(), 1.0, near, far);
    let point = |index: u32| {
        let (pair, sign) = ((index / 2) as f32, if index.is_multiple_of(2) { 1.0 } else { -1.0 });
        let share = ((2.0 * pair + 1.0) / LENS_POINTS as f32).sqrt();
        let angle = pair * std::f32::consts::PI * 0.5 * (5.0_f32.sqrt() - 1.0);
        let at = sign * LENS_RADIUS * share * Vec2::from_angle(angle);
        let moved = at.x * right + at.y * up;
        let view = look_at_mat4(numbers.light + moved, numbers.light_target + moved, Vec3::Y);
        let mut sheared = projection;
        sheared.z_axis.x = -at.x / LENS_DISTANCE * projection.x_axis.x;
        sheared.z_axis.y = -at.y / LENS_DISTANCE * projection.y_axis.y;
        Point { clip_from_world: sheared * view, place: numbers.light + moved }
    };
    (0..LENS_POINTS).map(point).collect()
}
