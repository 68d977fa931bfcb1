//! The floor of dusty air: the light's beam cut by planes across the view, all slices in one draw, blended from back to
//! front into a layer of floats, which is blended over the picture [LEC, "Combining Shadows with Atmospherics"].

use glam::{Mat4, Vec3, Vec4};
use glow::HasContext;

use super::Result;
use super::floor_gl::Program;
use super::floor_layer::Layer;
use super::kinds::{DUST_DENSITY, DUST_SLICES};
use super::numbers::Numbers;

/// The slices and what draws them.
pub struct Dust {
    pub layer: Layer,
    program: Program,
    slices: glow::VertexArray,
    corners: i32,
    surfaces: glow::VertexArray,
}

impl Dust {
    /// `surfaces`: the vertex array to bind again. `camera`, `light`: clip space from world space.
    pub fn new(
        gl: &glow::Context,
        numbers: &Numbers,
        surfaces: glow::VertexArray,
        camera: Mat4,
        light: Mat4,
    ) -> Result<Self> {
        let (triangles, spacing) = slices(camera, light);
        let program = Program::new(gl, "", include_str!("lit.vert"), include_str!("dust.frag"))?;
        let height = (0.5 * numbers.fov_y_degrees.to_radians()).tan();
        let step = 2.0 * height / numbers.size as f32;
        let half = Mat4::from_translation(Vec3::splat(0.5)) * Mat4::from_scale(Vec3::splat(0.5));
        let slices = unsafe {
            gl.use_program(Some(program.name));
            let set = |name: &str, matrix: Mat4| {
                gl.uniform_matrix_4_f32_slice(program.at(gl, name).as_ref(), false, &matrix.to_cols_array());
            };
            set("clip_from_world", camera);
            set("texture_from_world", half * light);
            gl.uniform_2_f32(program.at(gl, "ray_from_pixel").as_ref(), step, -height);
            gl.uniform_1_f32(program.at(gl, "optical_depth").as_ref(), DUST_DENSITY * spacing);
            let slices = gl.create_vertex_array()?;
            gl.bind_vertex_array(Some(slices));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(&triangles), glow::STATIC_DRAW);
            gl.enable_vertex_attrib_array(0);
            gl.vertex_attrib_pointer_f32(0, 3, glow::FLOAT, false, 12, 0);
            gl.bind_vertex_array(Some(surfaces));
            slices
        };
        let corners = i32::try_from(triangles.len())?;
        Ok(Self { layer: Layer::new(gl, numbers.size)?, program, slices, corners, surfaces })
    }

    /// Draws the dust over the picture, which has been drawn.
    pub fn draw(&self, gl: &glow::Context) {
        self.layer.clear(gl);
        unsafe {
            gl.depth_func(glow::LEQUAL);
            gl.depth_mask(false);
            gl.enable(glow::BLEND);
            gl.blend_func(glow::ONE, glow::ONE_MINUS_SRC_ALPHA);
            gl.use_program(Some(self.program.name));
            gl.bind_vertex_array(Some(self.slices));
            gl.draw_arrays(glow::TRIANGLES, 0, self.corners);
            gl.bind_vertex_array(Some(self.surfaces));
            gl.depth_mask(true);
            gl.depth_func(glow::LESS);
        }
        self.layer.put_over(gl);
    }
}

/// Triangles in world space, farthest slice first, and the distance of two slices. The beam's depths are those of its part
/// in sight; slices reach to the light's sides, and GL clips them at the camera's.
fn slices(camera: Mat4, light: Mat4) -> (Vec<[f32; 3]>, f32) {
    let (world_from_clip, world_from_light) = (camera.inverse(), light.inverse());
    let mut seen = sides(world_from_clip).map(|side| clipped(side, light)).concat();
    seen.extend(sides(world_from_light).map(|side| clipped(side, camera)).concat());
    let depth = |point: &Vec3| camera.row(3).dot(point.extend(1.0));
    let near = seen.iter().map(depth).fold(f32::INFINITY, f32::min);
    let far = seen.iter().map(depth).fold(f32::NEG_INFINITY, f32::max);
    let spacing = (far - near) / DUST_SLICES as f32;
    let mut triangles = Vec::new();
    for number in 0..DUST_SLICES {
        let depth = far - (number as f32 + 0.5) * spacing;
        // In clip space w is the depth; z follows from it, as points have a w of 1 in world space.
        let z = (1.0 - world_from_clip.w_axis.w * depth) / world_from_clip.z_axis.w;
        let corner = |x: f32, y: f32| (world_from_clip * Vec4::new(x * depth, y * depth, z, depth)).truncate();
        let square = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let polygon = clipped(square, light);
        for at in 2..polygon.len() {
            triangles.extend([polygon[0], polygon[at - 1], polygon[at]].map(|corner| corner.to_array()));
        }
    }
    (triangles, spacing)
}

/// The six sides of a frustum in world space.
fn sides(world_from_clip: Mat4) -> [Vec<Vec3>; 6] {
    let corner = |x: f32, y: f32, z: f32| world_from_clip.project_point3(Vec3::new(x, y, z));
    let around = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let side = |at: usize, way: f32| {
        let place = |[a, b]: [f32; 2]| match at {
            0 => corner(way, a, b),
            1 => corner(a, way, b),
            _ => corner(a, b, way),
        };
        around.map(place).to_vec()
    };
    [side(0, -1.0), side(0, 1.0), side(1, -1.0), side(1, 1.0), side(2, -1.0), side(2, 1.0)]
}

/// Part of a convex polygon within a clip space.
fn clipped(polygon: Vec<Vec3>, clip_from_world: Mat4) -> Vec<Vec3> {
    let rows = [0, 1, 2].map(|row| clip_from_world.row(row));
    let w = clip_from_world.row(3);
    let planes = rows.iter().flat_map(|row| [w + *row, w - *row]);
    planes.fold(polygon, |polygon, plane| {
        let distance = |point: Vec3| plane.dot(point.extend(1.0));
        let mut within = Vec::new();
        for (at, &here) in polygon.iter().enumerate() {
            let next = polygon[(at + 1) % polygon.len()];
            let (a, b) = (distance(here), distance(next));
            if a >= 0.0 {
                within.push(here);
            }
            if (a >= 0.0) != (b >= 0.0) {
                within.push(here + (next - here) * (a / (a - b)));
            }
        }
        within
    })
}
