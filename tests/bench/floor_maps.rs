//! The maps that the floor draws: textures, framebuffers, and the shader of each pass. The texture that the lit pass reads
//! is left bound to unit 0, the nearest layer of a midpoint map to unit 1.

use glam::Mat4;
use glow::HasContext;

use super::Result;
use super::floor_gl::Program;
use super::kinds::{self, Kind};
use super::numbers::Numbers;

/// One pass of depth over all that there is.
pub struct MapPass {
    pub target: glow::Framebuffer,
    /// Texels a side.
    pub size: i32,
    pub program: Program,
}

/// The passes of `kind`, in order.
pub fn make(gl: &glow::Context, kind: Kind, numbers: &Numbers) -> Result<Vec<MapPass>> {
    let size = numbers.map_size;
    let (projection, view) = kinds::light_matrices(kind, numbers);
    let pass = |target, size, clip_from_world: Mat4, fragment: &str| -> Result<MapPass> {
        let program = Program::new(gl, "", include_str!("depth.vert"), fragment)?;
        let matrix = program.at(gl, "clip_from_world");
        unsafe {
            gl.use_program(Some(program.name));
            gl.uniform_matrix_4_f32_slice(matrix.as_ref(), false, &clip_from_world.to_cols_array());
            gl.uniform_1_i32(program.at(gl, "nearest").as_ref(), 1);
        }
        Ok(MapPass { target, size, program })
    };
    let plain = include_str!("depth.frag");
    let clip_from_world = projection * view;
    match kind {
        Kind::Cube | Kind::Face => {
            let cube = texture(gl, glow::TEXTURE_CUBE_MAP, size, 1, true)?;
            kinds::faces(kind)
                .map(|index| {
                    let place = glow::TEXTURE_CUBE_MAP_POSITIVE_X + index as u32;
                    pass(target(gl, place, cube, 0)?, size, kinds::face(index, kind, numbers), plain)
                })
                .collect()
        }
        Kind::Midpoint => {
            unsafe { gl.active_texture(glow::TEXTURE1) };
            let nearest = texture(gl, glow::TEXTURE_2D, size, 1, false)?;
            unsafe { gl.active_texture(glow::TEXTURE0) };
            let map = texture(gl, glow::TEXTURE_2D, size, 1, true)?;
            let first = target(gl, glow::TEXTURE_2D, nearest, 0)?;
            let second = target(gl, glow::TEXTURE_2D, map, 0)?;
            let peel = include_str!("peel.frag");
            Ok(vec![pass(first, size, clip_from_world, plain)?, pass(second, size, clip_from_world, peel)?])
        }
        Kind::Slide => Ok(Vec::new()),
        _ => {
            let levels = if kind == Kind::EightTaps { 2 } else { 1 };
            let map = texture(gl, glow::TEXTURE_2D, size, levels, true)?;
            (0..levels)
                .map(|level| pass(target(gl, glow::TEXTURE_2D, map, level)?, size >> level, clip_from_world, plain))
                .collect()
        }
    }
}

/// A depth texture, bound to the active unit: with a linear comparison, or to be fetched from.
fn texture(gl: &glow::Context, binding: u32, size: i32, levels: i32, compared: bool) -> Result<glow::Texture> {
    unsafe {
        let texture = gl.create_texture()?;
        gl.bind_texture(binding, Some(texture));
        let faces = if binding == glow::TEXTURE_CUBE_MAP {
            glow::TEXTURE_CUBE_MAP_POSITIVE_X..glow::TEXTURE_CUBE_MAP_NEGATIVE_Z + 1
        } else {
            binding..binding + 1
        };
        for (face, level) in faces.flat_map(|face| (0..levels).map(move |level| (face, level))) {
            gl.tex_image_2d(
                face,
                level,
                glow::DEPTH_COMPONENT24 as i32,
                size >> level,
                size >> level,
                0,
                glow::DEPTH_COMPONENT,
                glow::UNSIGNED_INT,
                glow::PixelUnpackData::Slice(None),
            );
        }
        let (filter, compare) = match (compared, levels) {
            (false, _) => (glow::NEAREST, glow::NONE),
            (true, 1) => (glow::LINEAR, glow::COMPARE_REF_TO_TEXTURE),
            (true, _) => (glow::LINEAR_MIPMAP_LINEAR, glow::COMPARE_REF_TO_TEXTURE),
        };
        for (name, value) in [
            (glow::TEXTURE_MIN_FILTER, filter),
            (glow::TEXTURE_MAG_FILTER, if compared { glow::LINEAR } else { filter }),
            (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
            (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
            (glow::TEXTURE_COMPARE_MODE, compare),
            (glow::TEXTURE_COMPARE_FUNC, glow::LEQUAL),
            (glow::TEXTURE_MAX_LEVEL, levels as u32 - 1),
        ] {
            gl.tex_parameter_i32(binding, name, value as i32);
        }
        if levels > 1 {
            // Halfway between both, everywhere.
            gl.tex_parameter_f32(binding, glow::TEXTURE_MIN_LOD, 0.5);
            gl.tex_parameter_f32(binding, glow::TEXTURE_MAX_LOD, 0.5);
        }
        if binding == glow::TEXTURE_CUBE_MAP {
            gl.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
        }
        Ok(texture)
    }
}

/// The framebuffer that draws one face or level; what is not drawn of a cube is cleared once.
fn target(gl: &glow::Context, place: u32, texture: glow::Texture, level: i32) -> Result<glow::Framebuffer> {
    unsafe {
        let target = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
        let attach = |place| {
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, place, Some(texture), level);
        };
        gl.draw_buffers(&[glow::NONE]);
        gl.read_buffer(glow::NONE);
        if place != glow::TEXTURE_2D {
            for face in glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z {
                attach(face);
                gl.clear(glow::DEPTH_BUFFER_BIT);
            }
        }
        attach(place);
        Ok(target)
    }
}
