//! The floor of bump mapping: one interleaved vertex buffer, a map, and one pass or three over a bump-mapped object and a plain
//! one. The scene's file is read by glumbra; every GL call is here.

use std::path::Path;

use glam::camera::rh::proj::opengl;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use glow::HasContext;
use glumbra::geometry::normal_cube;
use glumbra::scene::Scene;

use super::Result;
use super::bumps::Passes;
use super::floor_gl::{self, Program};

/// Position, normal, tangent, bitangent, (s, t).
const FLOATS: usize = 14;
const WIDTHS: [i32; 5] = [3, 3, 3, 3, 2];

/// Texels a side of the map, and of a face of the cube of unit vectors.
const MAP: i32 = 1024;
const CUBE: i32 = 64;

/// A range of indices and what it looks like.
struct Piece {
    indices: std::ops::Range<i32>,
    world_from_model: Mat4,
    is_bumped: bool,
    diffuse: Vec3,
    specular: Vec3,
}

/// A draw by a program of its own, whose uniforms were set once.
struct FloorDraw {
    program: Program,
    indices: std::ops::Range<i32>,
}

struct FloorPass {
    blend: Option<[u32; 2]>,
    draws: Vec<FloorDraw>,
}

pub struct BumpFloor {
    gl: glow::Context,
    map_draws: Vec<FloorDraw>,
    passes: Vec<FloorPass>,
    map: glow::Framebuffer,
    picture: glow::Framebuffer,
    size: i32,
    background: [f32; 3],
    pixels: Vec<u8>,
}

/// Matrices and colours of the scene.
struct View {
    clip_from_world: Mat4,
    light_from_world: Mat4,
    eye: Vec3,
    light: Vec3,
    ambient: Vec3,
    diffuse: Vec3,
    specular: Vec3,
}

impl BumpFloor {
    pub fn new(scene: &Scene, passes: Passes) -> Result<Self> {
        let (vertices, indices, pieces) = surfaces(scene);
        let view = View::of(scene)?;
        let gl = floor_gl::open()?;
        let size = scene.image.size[0] as i32;
        let picture = floor_gl::picture(&gl, size)?;
        upload(&gl, &vertices, &indices)?;
        let map = textures(&gl, scene)?;
        let (fragment, plain) = (include_str!("bumps.frag"), "#define FLAT\n");
        let draw = |defines: &str, piece: &Piece| -> Result<FloorDraw> {
            let program = Program::new(&gl, defines, include_str!("bumps.vert"), fragment)?;
            view.set(&gl, &program, piece);
            Ok(FloorDraw { program, indices: piece.indices.clone() })
        };
        let pass = |bumped: &str, has_plain: bool, blend: Option<[u32; 2]>| -> Result<FloorPass> {
            let wanted = pieces.iter().filter(|piece| piece.is_bumped || has_plain);
            let draws = wanted.map(|piece| draw(if piece.is_bumped { bumped } else { plain }, piece));
            Ok(FloorPass { blend, draws: draws.collect::<Result<_>>()? })
        };
        let passes = match passes {
            Passes::One => vec![pass("", true, None)?],
            Passes::Three => vec![
                pass("#define LIGHT\n", true, None)?,
                pass("#define DECAL\n", false, Some([glow::DST_COLOR, glow::ZERO]))?,
                pass("#define HIGHLIGHTS\n", false, Some([glow::ONE, glow::ONE]))?,
            ],
        };
        let map_draw = |piece: &Piece| -> Result<FloorDraw> {
            let program = Program::new(&gl, "", include_str!("depth.vert"), include_str!("depth.frag"))?;
            let clip_from_model = view.light_from_world * piece.world_from_model;
            unsafe {
                gl.use_program(Some(program.name));
                let place = program.at(&gl, "clip_from_world");
                gl.uniform_matrix_4_f32_slice(place.as_ref(), false, &clip_from_model.to_cols_array());
            }
            Ok(FloorDraw { program, indices: piece.indices.clone() })
        };
        let map_draws = pieces.iter().map(map_draw).collect::<Result<_>>()?;
        unsafe {
            gl.enable(glow::DEPTH_TEST);
            gl.polygon_offset(1.1, 4.0);
        }
        let (pixels, background) = (vec![0; 4 * (size * size) as usize], scene.image.background);
        Ok(Self { gl, map_draws, passes, map, picture, size, background, pixels })
    }

    /// Draws map and picture, and reads the picture.
    pub fn frame(&mut self) {
        let gl = &self.gl;
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.map));
            gl.viewport(0, 0, MAP, MAP);
            gl.clear(glow::DEPTH_BUFFER_BIT);
            gl.enable(glow::POLYGON_OFFSET_FILL);
            self.map_draws.iter().for_each(|draw| draw.draw(gl));
            gl.disable(glow::POLYGON_OFFSET_FILL);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.picture));
            gl.viewport(0, 0, self.size, self.size);
            let [red, green, blue] = self.background;
            gl.clear_color(red, green, blue, 1.0);
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            for pass in &self.passes {
                if let Some([source, stored]) = pass.blend {
                    gl.enable(glow::BLEND);
                    gl.blend_func(source, stored);
                    gl.depth_func(glow::EQUAL);
                    gl.depth_mask(false);
                }
                pass.draws.iter().for_each(|draw| draw.draw(gl));
            }
            gl.disable(glow::BLEND);
            gl.depth_func(glow::LESS);
            gl.depth_mask(true);
            let pixels = glow::PixelPackData::Slice(Some(&mut self.pixels));
            gl.read_pixels(0, 0, self.size, self.size, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
        }
    }

    pub fn write_png(&self, path: &Path) -> Result<()> {
        super::floor::write_rgb(&self.pixels, self.size, path)
    }
}

impl FloorDraw {
    fn draw(&self, gl: &glow::Context) {
        let count = self.indices.end - self.indices.start;
        unsafe {
            gl.use_program(Some(self.program.name));
            gl.draw_elements(glow::TRIANGLES, count, glow::UNSIGNED_INT, 4 * self.indices.start);
        }
    }
}

impl View {
    fn of(scene: &Scene) -> Result<Self> {
        let camera = &scene.camera;
        let [eye, target] = [camera.eye, camera.target].map(|place| place.as_vec3());
        let fov_y = camera.fov_y_radians as f32;
        let [near, far] = [camera.near, camera.far].map(|plane| plane as f32);
        let source = &scene.lights[0];
        let frustum = source.frustum().ok_or("the light is no spotlight")?;
        let [light, aim] = [frustum.position, frustum.target].map(|place| place.as_vec3());
        let [light_near, light_far] = [frustum.near, frustum.far].map(|plane| plane as f32);
        let cone = frustum.cone_radians as f32;
        Ok(Self {
            clip_from_world: opengl::perspective(fov_y, 1.0, near, far) * look_at_mat4(eye, target, Vec3::Y),
            light_from_world: opengl::perspective(cone, 1.0, light_near, light_far) * look_at_mat4(light, aim, Vec3::Y),
            eye,
            light,
            ambient: Vec3::from(scene.shading.ambient),
            diffuse: Vec3::from(source.diffuse),
            specular: Vec3::from(source.specular),
        })
    }

    /// Sets all uniforms of a program that draws `piece` and nothing else.
    fn set(&self, gl: &glow::Context, program: &Program, piece: &Piece) {
        let half = Mat4::from_translation(Vec3::splat(0.5)) * Mat4::from_scale(Vec3::splat(0.5));
        let world_from_model = piece.world_from_model;
        let matrices = [
            ("clip_from_model", self.clip_from_world * world_from_model),
            ("world_from_model", world_from_model),
            ("texture_from_model", half * self.light_from_world * world_from_model),
        ];
        let vectors = [
            ("eye", self.eye),
            ("light", self.light),
            ("ambient", self.ambient * piece.diffuse),
            ("diffuse", self.diffuse * piece.diffuse),
            ("specular", self.specular * piece.specular),
        ];
        unsafe {
            gl.use_program(Some(program.name));
            for (name, matrix) in matrices {
                gl.uniform_matrix_4_f32_slice(program.at(gl, name).as_ref(), false, &matrix.to_cols_array());
            }
            for (name, Vec3 { x, y, z }) in vectors {
                gl.uniform_3_f32(program.at(gl, name).as_ref(), x, y, z);
            }
            for (unit, name) in (0..).zip(["map", "normal_map", "unit_vectors", "decal"]) {
                gl.uniform_1_i32(program.at(gl, name).as_ref(), unit);
            }
        }
    }
}

/// All vertices and indices of the scene, and its objects.
fn surfaces(scene: &Scene) -> (Vec<f32>, Vec<u32>, Vec<Piece>) {
    let (mut vertices, mut indices, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
    for object in &scene.objects {
        let mesh = &object.mesh;
        let (first_vertex, first) = ((vertices.len() / FLOATS) as u32, indices.len() as i32);
        for index in 0..mesh.positions.len() {
            vertices.extend(mesh.positions[index]);
            vertices.extend(mesh.normals[index]);
            let (across, along) = Vec3::from(mesh.normals[index]).any_orthonormal_pair();
            let [across, along] = [across, along].map(|way| way.to_array());
            vertices.extend(mesh.tangents.as_ref().map_or(across, |all| all.tangents[index]));
            vertices.extend(mesh.tangents.as_ref().map_or(along, |all| all.bitangents[index]));
            vertices.extend(mesh.texcoords.as_ref().map_or([0.0; 2], |all| all[index]));
        }
        indices.extend(mesh.indices.iter().map(|index| index + first_vertex));
        let material = object.material.as_deref().cloned().unwrap_or_default();
        pieces.push(Piece {
            indices: first..indices.len() as i32,
            world_from_model: object.world_from_model.as_mat4(),
            is_bumped: material.bump.is_some(),
            diffuse: Vec3::from(material.diffuse),
            specular: Vec3::from(material.specular),
        });
    }
    (vertices, indices, pieces)
}

/// One vertex array over interleaved vertices, left bound.
fn upload(gl: &glow::Context, vertices: &[f32], indices: &[u32]) -> Result<()> {
    unsafe {
        gl.bind_vertex_array(Some(gl.create_vertex_array()?));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(vertices), glow::STATIC_DRAW);
        gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, bytemuck::cast_slice(indices), glow::STATIC_DRAW);
        let mut offset = 0;
        for (location, width) in (0..).zip(WIDTHS) {
            gl.enable_vertex_attrib_array(location);
            gl.vertex_attrib_pointer_f32(location, width, glow::FLOAT, false, 4 * FLOATS as i32, 4 * offset);
            offset += width;
        }
    }
    Ok(())
}

/// Binds map, normal map, unit vectors and decal to units 0 to 3; returns the map's framebuffer.
fn textures(gl: &glow::Context, scene: &Scene) -> Result<glow::Framebuffer> {
    let mut material = scene.objects.iter().filter_map(|object| object.material.as_deref());
    let material = material.find(|material| material.bump.is_some()).ok_or("nothing is bump-mapped")?;
    let bump = material.bump.as_ref().ok_or("no bump map")?;
    let decal = material.decal.as_ref().ok_or("no decal")?;
    let linear = |target: u32| unsafe {
        gl.tex_parameter_i32(target, glow::TEXTURE_MIN_FILTER, glow::LINEAR as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAG_FILTER, glow::LINEAR as i32);
    };
    unsafe {
        gl.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
        gl.active_texture(glow::TEXTURE0);
        let map = gl.create_texture()?;
        gl.bind_texture(glow::TEXTURE_2D, Some(map));
        let (format, none) = (glow::DEPTH_COMPONENT24 as i32, glow::PixelUnpackData::Slice(None));
        let (depth, float) = (glow::DEPTH_COMPONENT, glow::FLOAT);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, format, MAP, MAP, 0, depth, float, none);
        linear(glow::TEXTURE_2D);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE as i32);
        let target = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, glow::TEXTURE_2D, Some(map), 0);
        gl.draw_buffer(glow::NONE);

        gl.active_texture(glow::TEXTURE1);
        gl.bind_texture(glow::TEXTURE_2D, Some(gl.create_texture()?));
        for (level, texels) in bump.map.levels.iter().enumerate() {
            let [width, height] = bump.size().map(|side| (side >> level).max(1) as i32);
            let pixels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(texels)));
            let (format, level) = (glow::RGBA8_SNORM as i32, level as i32);
            gl.tex_image_2d(glow::TEXTURE_2D, level, format, width, height, 0, glow::RGBA, glow::BYTE, pixels);
        }
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR as i32);

        gl.active_texture(glow::TEXTURE2);
        gl.bind_texture(glow::TEXTURE_CUBE_MAP, Some(gl.create_texture()?));
        for face in 0..6 {
            let texels = normal_cube::packed_face(face, CUBE as u32);
            let pixels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(&texels)));
            let (place, format) = (glow::TEXTURE_CUBE_MAP_POSITIVE_X + face as u32, glow::RGBA8 as i32);
            gl.tex_image_2d(place, 0, format, CUBE, CUBE, 0, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
        }
        linear(glow::TEXTURE_CUBE_MAP);

        gl.active_texture(glow::TEXTURE3);
        gl.bind_texture(glow::TEXTURE_2D, Some(gl.create_texture()?));
        let pixels = glow::PixelUnpackData::Slice(Some(&decal.rgba));
        let (width, height) = (decal.width as i32, decal.height as i32);
        let (format, byte) = (glow::RGBA8 as i32, glow::UNSIGNED_BYTE);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, format, width, height, 0, glow::RGBA, byte, pixels);
        gl.generate_mipmap(glow::TEXTURE_2D);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR as i32);
        Ok(target)
    }
}
