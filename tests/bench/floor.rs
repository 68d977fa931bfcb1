//! The floor: a scene's frame by the fewest GL calls. One interleaved vertex buffer and one index buffer in the file's
//! order, a depth-only pass, a lit pass with a hardware comparison, a read-back. No culling, no heap settings.

use std::path::Path;

use glam::camera::rh::proj::opengl;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use glow::HasContext;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::floor_gl::{self, Program};
use super::{Result, Scene};

/// The scene's numbers, those of `data/scenes/bench_*.toml`; the bench compares the pictures.
struct Numbers {
    size: i32,
    map_size: i32,
    eye: Vec3,
    target: Vec3,
    fov_y_degrees: f32,
    near_far: [f32; 2],
    light: Vec3,
    light_target: Vec3,
    cone_degrees: f32,
    light_near_far: [f32; 2],
    floor_half: f32,
    models: Vec<Vec3>,
}

const BACKGROUND: [f32; 4] = [0.30, 0.40, 0.60, 1.0];

fn numbers(scene: Scene) -> Numbers {
    match scene {
        Scene::S1 => Numbers {
            size: 512,
            map_size: 1024,
            eye: Vec3::new(3.0, 2.5, 4.0),
            target: Vec3::new(0.0, 0.6, 0.0),
            fov_y_degrees: 40.0,
            near_far: [0.1, 50.0],
            light: Vec3::new(2.0, 4.0, 3.0),
            light_target: Vec3::new(0.0, 0.5, 0.0),
            cone_degrees: 60.0,
            light_near_far: [0.5, 20.0],
            floor_half: 4.0,
            models: vec![Vec3::ZERO],
        },
        Scene::S2 => Numbers {
            size: 1024,
            map_size: 2048,
            eye: Vec3::new(16.0, 14.0, 22.0),
            target: Vec3::new(0.0, 0.0, 1.0),
            fov_y_degrees: 45.0,
            near_far: [0.5, 100.0],
            light: Vec3::new(8.0, 26.0, 12.0),
            light_target: Vec3::new(0.0, 0.0, 0.0),
            cone_degrees: 70.0,
            light_near_far: [5.0, 70.0],
            floor_half: 20.0,
            models: (0..100)
                .map(|k| Vec3::new(3.6 * ((k % 10) as f32 - 4.5), 0.0, 3.6 * ((k / 10) as f32 - 4.5)))
                .collect(),
        },
    }
}

/// The floor's GL objects, and what it draws.
pub struct Floor {
    gl: glow::Context,
    depth: Program,
    lit: Program,
    map_target: glow::Framebuffer,
    picture_target: glow::Framebuffer,
    size: i32,
    map_size: i32,
    /// Indices of the model; those of the quad follow.
    model_indices: i32,
    models: Vec<Vec3>,
    pixels: Vec<u8>,
}

/// Position and normal.
type Vertex = [f32; 6];

impl Floor {
    /// Loads the model, opens a context and uploads.
    ///
    /// `tuned`: the triangles in vertex-cache order, and the heap kept.
    pub fn new(scene: Scene, model: &Path, tuned: bool) -> Result<Self> {
        let numbers = numbers(scene);
        let (mut mesh, _) = glumbra::geometry::load_obj(model)?;
        if tuned {
            mesh = mesh.cache_optimized();
            floor_gl::keep_heap();
        }
        let mut vertices: Vec<Vertex> =
            mesh.positions.iter().zip(&mesh.normals).map(|([x, y, z], [a, b, c])| [*x, *y, *z, *a, *b, *c]).collect();
        let mut indices = mesh.indices;
        let model_indices = i32::try_from(indices.len())?;
        let first = u32::try_from(vertices.len())?;
        let half = numbers.floor_half;
        let corners = [[-half, -half], [-half, half], [half, half], [half, -half]];
        vertices.extend(corners.map(|[x, z]| [x, 0.0, z, 0.0, 1.0, 0.0]));
        indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));

        let gl = floor_gl::open()?;
        let lit = Program::new(&gl, include_str!("lit.vert"), include_str!("lit.frag"))?;
        let depth = Program::new(&gl, include_str!("depth.vert"), include_str!("depth.frag"))?;
        let (map, map_target) = floor_gl::map(&gl, numbers.map_size)?;
        let picture_target = floor_gl::picture(&gl, numbers.size)?;
        floor_gl::upload(&gl, bytemuck::cast_slice(&vertices), bytemuck::cast_slice(&indices))?;
        set_uniforms(&gl, &numbers, &depth, &lit);
        unsafe {
            gl.bind_texture(glow::TEXTURE_2D, Some(map));
            gl.enable(glow::DEPTH_TEST);
            gl.polygon_offset(1.1, 4.0);
        }
        let pixels = vec![0; 4 * (numbers.size * numbers.size) as usize];
        let Numbers { size, map_size, models, .. } = numbers;
        Ok(Self { gl, depth, lit, map_target, picture_target, size, map_size, model_indices, models, pixels })
    }

    /// Draws the map.
    pub fn depth_pass(&self) {
        let gl = &self.gl;
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.map_target));
            gl.viewport(0, 0, self.map_size, self.map_size);
            gl.clear(glow::DEPTH_BUFFER_BIT);
            gl.enable(glow::POLYGON_OFFSET_FILL);
            gl.use_program(Some(self.depth.name));
            self.draw(&self.depth);
            gl.disable(glow::POLYGON_OFFSET_FILL);
        }
    }

    /// Draws the picture.
    pub fn lit_pass(&self) {
        let gl = &self.gl;
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.picture_target));
            gl.viewport(0, 0, self.size, self.size);
            let [r, g, b, a] = BACKGROUND;
            gl.clear_color(r, g, b, a);
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            gl.use_program(Some(self.lit.name));
            self.draw(&self.lit);
        }
    }

    unsafe fn draw(&self, program: &Program) {
        let gl = &self.gl;
        let (offset, material) = (&program.offset, &program.material);
        unsafe {
            gl.uniform_1_f32(material.as_ref(), 0.8);
            for model in &self.models {
                gl.uniform_3_f32(offset.as_ref(), model.x, model.y, model.z);
                gl.draw_elements(glow::TRIANGLES, self.model_indices, glow::UNSIGNED_INT, 0);
            }
            gl.uniform_1_f32(material.as_ref(), 0.7);
            gl.uniform_3_f32(offset.as_ref(), 0.0, 0.0, 0.0);
            gl.draw_elements(glow::TRIANGLES, 6, glow::UNSIGNED_INT, 4 * self.model_indices);
        }
    }

    /// Reads the picture, rows from the bottom up.
    pub fn read(&mut self) {
        let pixels = glow::PixelPackData::Slice(Some(&mut self.pixels));
        unsafe { self.gl.read_pixels(0, 0, self.size, self.size, glow::RGBA, glow::UNSIGNED_BYTE, pixels) };
    }

    /// Waits for all that was drawn.
    pub fn finish(&self) {
        unsafe { self.gl.finish() };
    }

    /// Writes what was read last.
    pub fn write_png(&self, path: &Path) -> Result<()> {
        let row = 4 * self.size as usize;
        let rgb: Vec<u8> = self
            .pixels
            .chunks_exact(row)
            .rev()
            .flat_map(|row| row.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]))
            .collect();
        let file = std::io::BufWriter::new(std::fs::File::create(path)?);
        let side = self.size as u32;
        PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Up).write_image(
            &rgb,
            side,
            side,
            ExtendedColorType::Rgb8,
        )?;
        Ok(())
    }
}

fn set_uniforms(gl: &glow::Context, numbers: &Numbers, depth: &Program, lit: &Program) {
    let [near, far] = numbers.near_far;
    let clip_from_world = opengl::perspective(numbers.fov_y_degrees.to_radians(), 1.0, near, far)
        * look_at_mat4(numbers.eye, numbers.target, Vec3::Y);
    let [near, far] = numbers.light_near_far;
    let light_clip_from_world = opengl::perspective(numbers.cone_degrees.to_radians(), 1.0, near, far)
        * look_at_mat4(numbers.light, numbers.light_target, Vec3::Y);
    let half = Mat4::from_translation(Vec3::splat(0.5)) * Mat4::from_scale(Vec3::splat(0.5));
    let light = numbers.light;
    unsafe {
        let set = |program: &Program, name: &str, matrix: Mat4| {
            gl.uniform_matrix_4_f32_slice(program.at(gl, name).as_ref(), false, &matrix.to_cols_array());
        };
        gl.use_program(Some(depth.name));
        set(depth, "clip_from_world", light_clip_from_world);
        gl.use_program(Some(lit.name));
        set(lit, "clip_from_world", clip_from_world);
        set(lit, "texture_from_world", half * light_clip_from_world);
        gl.uniform_3_f32(lit.at(gl, "light").as_ref(), light.x, light.y, light.z);
    }
}
