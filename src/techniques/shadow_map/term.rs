//! How the lit pass looks a map up: its sampler, its texture matrix, and where in it the light's frustum lies.

use glam::{DMat4, DVec3, Vec4};

use super::settings::{Addressing, Order, Settings};
use crate::math::texgen::{direct3d_scale_bias, scale_bias};
use crate::pass::{Compare, DepthFormat, ImageId, Input, Sampler, Wrap, glsl};
use crate::techniques::LightTerm;

/// How the lit pass compares against `map`.
pub fn term(index: usize, map: ImageId, settings: &Settings) -> LightTerm {
    let mut term = LightTerm::new(index, glsl!("shadow_map/shade.frag"));
    let compare = match settings.order {
        Order::LessEqual => Compare::LessEqual,
        Order::GreaterEqual => Compare::GreaterEqual,
    };
    term.inputs.push(Input {
        name: format!("shadow_map_{index}").into(),
        image: map,
        sampler: Sampler { filter: settings.filter, wrap: Wrap::ClampToEdge, compare: Some(compare) },
    });
    if settings.format == DepthFormat::Depth32F {
        term.defines.push(format!("CLAMP_REFERENCE_{index}"));
    }
    term.texture_from_light_clip = texture_from_light_clip(settings);
    if settings.addressing == Addressing::Direct3d {
        let half_texel = 0.5 / settings.size as f32;
        term.frustum_from_map = Some(Vec4::new(1.0, -1.0, -half_texel, 1.0 + half_texel));
    }
    term.set_up = settings.set_up;
    term.split = settings.split;
    term.dimming = settings.dimming;
    term.map = Some(map);
    term
}

/// `S`, by the rules of the addressing, with r's tweaks and bias; mirrored in r for GEQUAL.
fn texture_from_light_clip(settings: &Settings) -> DMat4 {
    let mirrored = match settings.order {
        Order::LessEqual => DMat4::IDENTITY,
        Order::GreaterEqual => DMat4::from_translation(DVec3::Z) * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)),
    };
    let ordinary = scale_bias(settings.r_scale, settings.r_bias);
    let texture = match settings.addressing {
        Addressing::OpenGl => DMat4::from_translation(DVec3::new(0.0, 0.0, settings.matrix_bias)) * ordinary,
        Addressing::Direct3d => {
            // Direct3D's clip z is in [0, w]; its depth counts codes, GL's texture unit compares in [0, 1].
            let direct3d_from_gl = DMat4::from_translation(DVec3::new(0.0, 0.0, settings.r_bias))
                * DMat4::from_scale(DVec3::new(1.0, 1.0, settings.r_scale));
            let bits = settings.format.bits();
            let depth_from_codes = DMat4::from_scale(DVec3::new(1.0, 1.0, 1.0 / (2.0_f64.powi(bits as i32) - 1.0)));
            depth_from_codes * direct3d_scale_bias(settings.size, bits, settings.matrix_bias) * direct3d_from_gl
        }
    };
    mirrored * texture
}

/// Direct3D's raster on GL's: half a pixel right and down, rows from the top. Identity for OpenGL addressing.
pub fn raster_from_clip(settings: &Settings) -> DMat4 {
    match settings.addressing {
        Addressing::OpenGl => DMat4::IDENTITY,
        Addressing::Direct3d => {
            let half_pixel = 1.0 / f64::from(settings.size);
            DMat4::from_translation(DVec3::new(half_pixel, half_pixel, 0.0))
                * DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0))
        }
    }
}
