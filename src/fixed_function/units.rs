//! Sets up texture units: textures and their parameters, coordinates by glTexGen and the texture matrix, combiners.
//! Knows layers and GL; no pass.

use glam::DMat4;
use glow::HasContext;

use super::layer::{AlphaSource, Combine, Operand, Unit, UnitCoordinates, UnitImage};
use crate::context::compatibility::{Binding, raw};
use crate::device::{compare_code, filter_codes, wrap_code};
use crate::geometry::Placement;
use crate::pass::{Sampler, Wrap};

/// The four coordinates: their names, and what switches their generation on.
const COORDINATES: [(u32, u32); 4] = [
    (raw::S, raw::TEXTURE_GEN_S),
    (raw::T, raw::TEXTURE_GEN_T),
    (raw::R, raw::TEXTURE_GEN_R),
    (raw::Q, raw::TEXTURE_GEN_Q),
];

/// A texture with what it is sampled by.
#[derive(Clone, Copy, Debug)]
pub struct BoundTexture {
    pub texture: glow::Texture,
    /// `None`: as the texture's own parameters say.
    pub sampler: Option<Sampler>,
    pub alpha: AlphaSource,
}

/// Switches unit `index` on.
pub fn enable(gl: &glow::Context, fixed: &Binding, index: u32, unit: &Unit, bound: BoundTexture) {
    let target = if let UnitImage::Cube(_) = unit.image { glow::TEXTURE_CUBE_MAP } else { glow::TEXTURE_2D };
    // SAFETY: the context is current and of the compatibility profile; every pointer is to values that outlive the
    // call.
    unsafe {
        gl.active_texture(glow::TEXTURE0 + index);
        gl.bind_sampler(index, None);
        gl.bind_texture(target, Some(bound.texture));
        gl.enable(target);
    }
    if let Some(sampler) = bound.sampler {
        set_sampler(gl, target, sampler, bound.alpha);
    }
    set_coordinates(gl, fixed, &unit.coordinates, &unit.placement);
    set_combiners(fixed, unit);
}

/// Switches unit `index` off, and leaves its matrix the identity.
pub fn disable(gl: &glow::Context, fixed: &Binding, index: u32) {
    // SAFETY: as above.
    unsafe {
        gl.active_texture(glow::TEXTURE0 + index);
        for target in [glow::TEXTURE_2D, glow::TEXTURE_CUBE_MAP] {
            gl.disable(target);
            gl.bind_texture(target, None);
        }
        COORDINATES.iter().for_each(|(_, switch)| gl.disable(*switch));
        fixed.MatrixMode(glow::TEXTURE);
        fixed.LoadIdentity();
    }
}

/// Sets the texture's own parameters as the device sets sampler objects; a comparison's result goes to RGB, and to alpha
/// where that is wanted.
fn set_sampler(gl: &glow::Context, target: u32, sampler: Sampler, alpha: AlphaSource) {
    let ([min, mag], wrap) = (filter_codes(sampler.filter), wrap_code(sampler.wrap));
    let (mode, function) = match sampler.compare {
        Some(compare) => (glow::COMPARE_REF_TO_TEXTURE, compare_code(compare)),
        None => (glow::NONE, glow::LEQUAL),
    };
    let parameters = [
        (glow::TEXTURE_MIN_FILTER, min),
        (glow::TEXTURE_MAG_FILTER, mag),
        (glow::TEXTURE_WRAP_S, wrap),
        (glow::TEXTURE_WRAP_T, wrap),
        (glow::TEXTURE_WRAP_R, wrap),
        (glow::TEXTURE_COMPARE_MODE, mode),
        (glow::TEXTURE_COMPARE_FUNC, function),
        (raw::DEPTH_TEXTURE_MODE, if alpha == AlphaSource::Comparison { raw::INTENSITY } else { raw::LUMINANCE }),
        (glow::TEXTURE_SWIZZLE_A, if alpha == AlphaSource::Red { glow::RED } else { glow::ALPHA }),
    ];
    for (name, value) in parameters {
        // SAFETY: as above.
        unsafe { gl.tex_parameter_i32(target, name, value as i32) };
    }
    if let Wrap::ClampToBorder(border) = sampler.wrap {
        // SAFETY: as above; four values are read.
        unsafe { gl.tex_parameter_f32_slice(target, glow::TEXTURE_BORDER_COLOR, &border.color()) };
    }
}

fn set_coordinates(gl: &glow::Context, fixed: &Binding, coordinates: &UnitCoordinates, placement: &Placement) {
    // SAFETY: as above.
    unsafe {
        COORDINATES.iter().for_each(|(_, switch)| gl.disable(*switch));
        fixed.MatrixMode(glow::TEXTURE);
        fixed.LoadIdentity();
        let [scale_s, scale_t, offset_s, offset_t] = placement.scale_and_offset();
        fixed.Translatef(offset_s, offset_t, 0.0);
        fixed.Scalef(scale_s, scale_t, 1.0);
        match coordinates {
            UnitCoordinates::Constant | UnitCoordinates::Mesh | UnitCoordinates::Tangent(_) => {}
            UnitCoordinates::ObjectLinear(generated) => {
                fixed.Scalef(generated.scale, generated.scale, 1.0);
                for ((name, switch), plane) in COORDINATES.iter().zip([generated.s, generated.t]) {
                    fixed.TexGeni(*name, raw::TEXTURE_GEN_MODE, raw::OBJECT_LINEAR as i32);
                    fixed.TexGenfv(*name, raw::OBJECT_PLANE, plane.as_ptr());
                    gl.enable(*switch);
                }
            }
            UnitCoordinates::EyeLinear(eye_linear) => {
                fixed.LoadMatrixf(eye_linear.texture_matrix.as_mat4().to_cols_array().as_ptr());
                set_eye_planes(fixed, &eye_linear.planes, &eye_linear.modelview);
                COORDINATES.iter().for_each(|(_, switch)| gl.enable(*switch));
            }
        }
    }
}

/// Sets the active unit's eye planes, the rows of `planes`, while `modelview` is the modelview: GL multiplies them by
/// its inverse [GL 4.6 compatibility, 12.1.3]. Leaves the modelview the identity.
pub fn set_eye_planes(fixed: &Binding, planes: &DMat4, modelview: &DMat4) {
    let rows = planes.as_mat4().transpose();
    // SAFETY: as above.
    unsafe {
        fixed.MatrixMode(raw::MODELVIEW);
        fixed.LoadMatrixf(modelview.as_mat4().to_cols_array().as_ptr());
        for ((name, _), row) in COORDINATES.iter().zip([rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]) {
            fixed.TexGeni(*name, raw::TEXTURE_GEN_MODE, raw::EYE_LINEAR as i32);
            fixed.TexGenfv(*name, raw::EYE_PLANE, row.to_array().as_ptr());
        }
        fixed.LoadIdentity();
    }
}

/// The active unit's eye planes as GL keeps them: s, t, r, q.
pub fn eye_planes(fixed: &Binding) -> [[f32; 4]; 4] {
    COORDINATES.map(|(name, _)| {
        let mut plane = [0.0; 4];
        // SAFETY: as above; four values are written.
        unsafe { fixed.GetTexGenfv(name, raw::EYE_PLANE, plane.as_mut_ptr()) };
        plane
    })
}

fn set_combiners(fixed: &Binding, unit: &Unit) {
    // SAFETY: as above.
    unsafe {
        fixed.TexEnvi(raw::TEXTURE_ENV, raw::TEXTURE_ENV_MODE, raw::COMBINE as i32);
        fixed.TexEnvfv(raw::TEXTURE_ENV, raw::TEXTURE_ENV_COLOR, unit.constant.as_ptr());
        fixed.TexEnvf(raw::TEXTURE_ENV, raw::RGB_SCALE, unit.rgb_scale);
        fixed.TexEnvf(raw::TEXTURE_ENV, raw::ALPHA_SCALE, unit.alpha_scale);
    }
    set_combiner(fixed, raw::COMBINE_RGB, [raw::SRC0_RGB, raw::SRC1_RGB, raw::SRC2_RGB], raw::OPERAND0_RGB, unit.rgb);
    let sources = [raw::SRC0_ALPHA, glow::SRC1_ALPHA, raw::SRC2_ALPHA];
    set_combiner(fixed, raw::COMBINE_ALPHA, sources, raw::OPERAND0_ALPHA, unit.alpha);
}

/// `first_operand` + n is what the operand of source n is set by.
fn set_combiner(fixed: &Binding, combiner: u32, sources: [u32; 3], first_operand: u32, combine: Combine) {
    let (function, operands) = match combine {
        Combine::Replace(a) => (glow::REPLACE, vec![a]),
        Combine::Modulate(a, b) => (raw::MODULATE, vec![a, b]),
        Combine::Subtract(a, b) => (raw::SUBTRACT, vec![a, b]),
        Combine::Interpolate(a, b, by) => (raw::INTERPOLATE, vec![a, b, by]),
        Combine::Dot3Rgba(a, b) => (raw::DOT3_RGBA, vec![a, b]),
        Combine::Dot3Rgb(a, b) => (raw::DOT3_RGB, vec![a, b]),
    };
    // SAFETY: as above.
    unsafe {
        fixed.TexEnvi(raw::TEXTURE_ENV, combiner, function as i32);
        for ((source, number), operand) in sources.into_iter().zip(0..).zip(operands) {
            let alpha = combiner == raw::COMBINE_ALPHA || operand.is_alpha();
            let taken = if alpha { glow::SRC_ALPHA } else { glow::SRC_COLOR };
            fixed.TexEnvi(raw::TEXTURE_ENV, source, operand_code(operand) as i32);
            fixed.TexEnvi(raw::TEXTURE_ENV, first_operand + number, taken as i32);
        }
    }
}

fn operand_code(operand: Operand) -> u32 {
    match operand {
        Operand::Texture => glow::TEXTURE,
        Operand::Constant | Operand::ConstantAlpha => raw::CONSTANT,
        Operand::Primary => raw::PRIMARY_COLOR,
        Operand::Previous | Operand::PreviousAlpha => raw::PREVIOUS,
        Operand::Other(unit) | Operand::OtherAlpha(unit) => glow::TEXTURE0 + unit,
    }
}
