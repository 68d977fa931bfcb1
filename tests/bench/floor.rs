//! The floor: a scene's frame by the fewest GL calls. One interleaved vertex buffer and one index buffer in the file's
//! order, depth-only passes, a lit pass with a hardware comparison, a read-back. No culling, no heap settings.

use std::path::Path;

use glam::camera::rh::proj::opengl;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use glow::HasContext;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::Result;
use super::floor_dust::Dust;
use super::floor_gl::{self, Program};
use super::floor_lens::Lens;
use super::floor_maps::{self, MapPass};
use super::floor_passes::{self, PicturePass};
use super::kinds::{self, Kind};
use super::numbers::Numbers;

const BACKGROUND: [f32; 4] = [0.30, 0.40, 0.60, 1.0];

/// The floor's GL objects, and what it draws.
pub struct Floor {
    gl: glow::Context,
    kind: Kind,
    lit: Program,
    maps: Vec<MapPass>,
    /// Passes of the picture, where it takes several.
    passes: Vec<PicturePass>,
    picture_target: glow::Framebuffer,
    /// Only for [`Kind::Lens`].
    lens: Option<Lens>,
    /// Only for [`Kind::Dust`].
    dust: Option<Dust>,
    size: i32,
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
    pub fn new(numbers: Numbers, kind: Kind, model: &Path, tuned: bool) -> Result<Self> {
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
        let (defines, shade) = kinds::shade(kind);
        let fragment = include_str!("lit.frag").replace("//SHADE//", &shade);
        let lit = Program::new(&gl, defines, include_str!("lit.vert"), &fragment)?;
        let maps = floor_maps::make(&gl, kind, &numbers)?;
        let picture_target = floor_gl::picture(&gl, numbers.size)?;
        let surfaces = floor_gl::upload(&gl, bytemuck::cast_slice(&vertices), bytemuck::cast_slice(&indices))?;
        let passes = floor_passes::make(&gl, kind)?;
        let programs = [&lit].into_iter().chain(passes.iter().map(|pass| &pass.program));
        programs.for_each(|program| set_uniforms(&gl, kind, &numbers, program));
        let lens = (kind == Kind::Lens).then(|| Lens::new(&gl, &numbers, camera(&numbers))).transpose()?;
        let dust = || {
            let (projection, view) = kinds::light_matrices(kind, &numbers);
            Dust::new(&gl, &numbers, surfaces, camera(&numbers), projection * view)
        };
        let dust = (kind == Kind::Dust).then(dust).transpose()?;
        let layer = lens.as_ref().map(|lens| &lens.layer).or(dust.as_ref().map(|dust| &dust.layer));
        let picture_target = layer.map_or(picture_target, |layer| layer.picture);
        unsafe {
            gl.enable(glow::DEPTH_TEST);
            gl.polygon_offset(1.1, 4.0);
            if kind == Kind::SecondDepth {
                gl.cull_face(glow::FRONT);
            }
        }
        let pixels = vec![0; 4 * (numbers.size * numbers.size) as usize];
        let Numbers { size, models, .. } = numbers;
        Ok(Self { gl, kind, lit, maps, passes, picture_target, lens, dust, size, model_indices, models, pixels })
    }

    /// Draws the maps.
    pub fn depth_pass(&self) {
        if self.lens.is_some() {
            return; // each map comes before its lens point
        }
        let gl = &self.gl;
        let offset = !matches!(self.kind, Kind::Midpoint | Kind::SecondDepth);
        unsafe {
            if offset {
                gl.enable(glow::POLYGON_OFFSET_FILL);
            }
            if self.kind == Kind::SecondDepth {
                gl.enable(glow::CULL_FACE);
            }
            for map in &self.maps {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(map.target));
                gl.viewport(0, 0, map.size, map.size);
                gl.clear(glow::DEPTH_BUFFER_BIT);
                gl.use_program(Some(map.program.name));
                self.draw(&map.program);
            }
            gl.disable(glow::POLYGON_OFFSET_FILL);
            gl.disable(glow::CULL_FACE);
        }
    }

    /// Draws the picture.
    pub fn lit_pass(&self) {
        let gl = &self.gl;
        if let (Some(lens), [map]) = (&self.lens, self.maps.as_slice()) {
            return lens.draw(gl, self.size, map, &self.lit, |program| unsafe { self.draw(program) });
        }
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.picture_target));
            gl.viewport(0, 0, self.size, self.size);
            let [r, g, b, a] = BACKGROUND;
            gl.clear_color(r, g, b, a);
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            if self.passes.is_empty() {
                gl.use_program(Some(self.lit.name));
                self.draw(&self.lit);
                if let Some(dust) = &self.dust {
                    dust.draw(gl);
                }
                return;
            }
            for (index, pass) in self.passes.iter().enumerate() {
                pass.begin(gl, index == 0);
                self.draw(&pass.program);
            }
        }
        floor_passes::end(gl);
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
        write_rgb(&self.pixels, self.size, path)
    }
}

/// Writes RGBA bytes, rows from the bottom up, without alpha.
pub fn write_rgb(pixels: &[u8], size: i32, path: &Path) -> Result<()> {
    let row = 4 * size as usize;
    let rgb: Vec<u8> =
        pixels.chunks_exact(row).rev().flat_map(|row| row.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]])).collect();
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let side = size as u32;
    PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Up).write_image(
        &rgb,
        side,
        side,
        ExtendedColorType::Rgb8,
    )?;
    Ok(())
}

/// `clip_from_world` of the picture.
fn camera(numbers: &Numbers) -> Mat4 {
    let [near, far] = numbers.near_far;
    opengl::perspective(numbers.fov_y_degrees.to_radians(), 1.0, near, far)
        * look_at_mat4(numbers.eye, numbers.target, Vec3::Y)
}

fn set_uniforms(gl: &glow::Context, kind: Kind, numbers: &Numbers, lit: &Program) {
    let clip_from_world = camera(numbers);
    let (projection, view) = kinds::light_matrices(kind, numbers);
    let half = Mat4::from_translation(Vec3::splat(0.5)) * Mat4::from_scale(Vec3::splat(0.5));
    let [near, far] = numbers.light_near_far;
    let face_depth = [0.5 * (far + near) / (far - near) + 0.5, far * near / (far - near)];
    let towards_light =
        if kind == Kind::Parallel { numbers.light - numbers.light_target } else { kinds::light(kind, numbers) };
    // Of a normal offset: from s and t to x and y over the distance, and how far a filter reaches at a distance of 1.
    let scale = 0.5 * projection.x_axis.x;
    let reach = std::f32::consts::SQRT_2 / (scale * numbers.map_size as f32);
    unsafe {
        let set = |name: &str, matrix: Mat4| {
            gl.uniform_matrix_4_f32_slice(lit.at(gl, name).as_ref(), false, &matrix.to_cols_array());
        };
        gl.use_program(Some(lit.name));
        set("clip_from_world", clip_from_world);
        set("texture_from_world", half * projection * view);
        set("texture_from_light_0", half * projection);
        gl.uniform_3_f32(lit.at(gl, "light").as_ref(), towards_light.x, towards_light.y, towards_light.z);
        gl.uniform_2_f32(lit.at(gl, "face_depth").as_ref(), face_depth[0], face_depth[1]);
        gl.uniform_1_f32(lit.at(gl, "filter_reach_0").as_ref(), 1.0);
        gl.uniform_1_f32(lit.at(gl, "towards_light_0").as_ref(), 1.0);
        gl.uniform_1_f32(lit.at(gl, "offset_radius_0").as_ref(), reach);
        gl.uniform_4_f32(lit.at(gl, "light_from_map_0").as_ref(), 1.0 / scale, 1.0 / scale, 0.5, 0.5);
    }
}
