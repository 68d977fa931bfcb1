//! Lookup of a map in the lit pass: its sampler, its texture matrix, and the place of the light's frustum in it.

use glam::{DMat4, DVec3, Vec4};

use super::map::map_info;
use super::settings::{Addressing, Bias, HalfTexel, Mipmaps, Order, Settings};
use super::{bias, tag};
use crate::lights::light::ShadeSource;
use crate::lights::projector::Rays;
use crate::lights::{Coordinates, Crop, FrustumView, LightTerm};
use crate::math::texgen::{direct3d_scale_bias, scale_bias};
use crate::pass::{
    Border, Chunk, Compare, Define, DepthFormat, Filter, ImageId, Input, Sampler, Shade, Uniform, Wrap, glsl,
};

/// Light term that compares against `map`, with receivers moved towards the light by `texels`.
pub fn term(view: &FrustumView<'_>, map: ImageId, settings: &Settings, texels: f64) -> LightTerm {
    let index = view.index;
    let name = format!("shadow_map_{index}");
    let clamped = settings.format == DepthFormat::Depth32F;
    let shade = ShadeSource {
        chunks: chunks(settings),
        meaning: Shade::Texture { input: name.clone().into(), clamped },
        defines: Vec::new(),
        uniforms: Vec::new(),
        inputs: vec![Input { name: name.into(), image: map, sampler: sampler(view.projector.rays, settings) }],
    };
    let mut term = LightTerm::new(view.light(), index, shade);
    // A floating-point map does not clamp the compared depth to [0, 1]: the shader must. A normal offset can move that depth
    // out of range in any format. The other biases clamp at every tap.
    if clamped && settings.bias == Bias::Offset || settings.bias == Bias::NormalOffset {
        term.shade.defines.push(Define::flag("CLAMP_REFERENCE").of_light(index));
    }
    let mut coordinates = Coordinates {
        texture_from_light_clip: texture_from_light_clip(settings) * view.projector.crop.map_clip_from_light_clip(),
        receiver_bias: DMat4::IDENTITY,
        light_clip_from_light: view.projector.clip_from_light,
        light_from_world: view.projector.light_from_world,
        set_up: settings.set_up,
        split: settings.split,
    };
    if texels > 0.0 {
        coordinates.receiver_bias = bias::moved_to_light(&view.projector, texels, settings);
    }
    // Parallel light reaches everywhere: no frustum bounds it.
    if let Rays::From { .. } = view.projector.rays {
        term.frustum_from_map = frustum_from_map(view.projector.crop, settings);
    }
    term.counting = tag::counting(view, settings);
    term.map = Some(map);
    term.map_info = Some(map_info(view, settings, texels));
    look_up(&mut term, &coordinates, view, settings);
    term.coordinates = Some(coordinates);
    term
}

/// Scale and offset from (s, t) of the map to those of the light's whole frustum, where they differ.
fn frustum_from_map(covered: Crop, settings: &Settings) -> Option<Vec4> {
    let crop = covered.frustum_from_map();
    match settings.addressing {
        Addressing::Direct3d(way) => {
            let half_texel = matrix_half_texel(way, settings) as f32;
            let [x, y] = [-half_texel, 1.0 + half_texel];
            Some(Vec4::new(crop.x, -crop.y, crop.x * x + crop.z, crop.y * y + crop.w))
        }
        Addressing::OpenGl => (covered != Crop::WHOLE).then_some(crop),
    }
}

/// Sampler of a map with such rays. Beyond the box of parallel light nothing is shadowed, whatever its outermost texels
/// hold: the border has the depth that the map is cleared to. Beyond a frustum no light falls, and the nearest texel is the
/// best guess.
pub fn sampler(rays: Rays, settings: &Settings) -> Sampler {
    let (compare, farthest) = match settings.order {
        Order::LessEqual => (Compare::LessEqual, Border::One),
        Order::GreaterEqual => (Compare::GreaterEqual, Border::Zero),
    };
    let wrap = match rays {
        Rays::From { .. } => Wrap::ClampToEdge,
        Rays::Along(_) => Wrap::ClampToBorder(farthest),
    };
    // If the shader weighs the texels itself, it reads them one by one.
    let filter = if settings.bias == Bias::Adaptive { Filter::Nearest } else { settings.filter };
    let plain = Sampler { filter, wrap, compare: Some(compare), lod_halves: None };
    match settings.mipmaps {
        Mipmaps::None => plain,
        Mipmaps::All => Sampler { filter: Filter::Trilinear, ..plain },
        Mipmaps::EightTaps => Sampler { filter: Filter::Trilinear, lod_halves: Some(1), ..plain },
    }
}

/// Adds the defines and uniforms that a kernel or a bias needs, and marks the shade as impossible for fixed function. A single
/// comparison with a polygon offset needs none.
fn look_up(term: &mut LightTerm, coordinates: &Coordinates, view: &FrustumView<'_>, settings: &Settings) {
    let index = term.index;
    if settings.mipmaps != Mipmaps::None {
        term.shade.meaning = Shade::Shader("a shade of more comparisons than one: of two levels");
    }
    if settings.kernel == 1 && settings.bias == Bias::Offset {
        return;
    }
    term.shade.meaning =
        Shade::Shader("a shade of more comparisons than one, or of a reference that is worked out for each");
    term.shade.defines.push(Define::number("KERNEL", settings.kernel).of_light(index));
    let of_light = |name, value: f32| Uniform::of_light(name, index, value);
    if let Rays::Along(_) = view.projector.rays {
        term.shade.defines.push(Define::flag("PARALLEL").of_light(index));
    }
    let towards_light = if settings.order == Order::LessEqual { 1.0 } else { -1.0 };
    match settings.bias {
        Bias::Offset => {}
        Bias::ReceiverPlane => {
            term.shade.uniforms.push(of_light("filter_reach", bias::filter_reach(settings) as f32));
            term.shade.uniforms.push(of_light("towards_light", towards_light));
        }
        Bias::Adaptive => {
            term.shade.uniforms.push(of_light("towards_light", towards_light));
        }
        Bias::NormalOffset => {
            term.shade.defines.push(Define::flag("NORMAL_OFFSET").of_light(index));
            let texture = coordinates.texture_from_light_clip * coordinates.receiver_bias;
            let light_clip = coordinates.light_clip_from_light;
            let texture_from_light = texture * light_clip;
            if let Rays::Along(_) = view.projector.rays {
                let light_from_texture = texture_from_light.inverse().as_mat4();
                term.shade.uniforms.push(Uniform::of_light("light_from_texture", index, light_from_texture));
            } else {
                let scale = [texture.x_axis.x * light_clip.x_axis.x, texture.y_axis.y * light_clip.y_axis.y];
                // w is -z.
                let ahead = -texture_from_light.z_axis;
                let from_map = [1.0 / scale[0], 1.0 / scale[1], ahead.x, ahead.y];
                term.shade.uniforms.push(Uniform::of_light(
                    "light_from_map",
                    index,
                    Vec4::from(from_map.map(|x| x as f32)),
                ));
            }
            let reach = bias::reach_texels(settings) * bias::texel_sides_at_one(&view.projector, settings);
            term.shade.uniforms.push(Uniform::of_light("texture_from_light", index, texture_from_light.as_mat4()));
            term.shade.uniforms.push(Uniform::of_light("offset_reach", index, reach.as_vec2()));
        }
    }
    if settings.bias != Bias::Offset {
        term.shade.defines.push(Define::flag("DERIVATIVES").of_light(index));
    }
}

/// The chunks that find the shade: of one comparison, of a kernel, or of a bias that the comparison itself brings.
fn chunks(settings: &Settings) -> Vec<Chunk> {
    let [map, closer] = [glsl!("shadow_map/map.glsl"), glsl!("shadow_map/percentage_closer.glsl")];
    match (settings.bias, settings.filter) {
        (Bias::Offset, _) if settings.kernel == 1 => vec![map, glsl!("shadow_map/shade.frag")],
        (Bias::Offset, _) => vec![map, closer, glsl!("shadow_map/kernel.frag")],
        (Bias::ReceiverPlane, _) => {
            vec![map, closer, glsl!("shadow_map/slope.glsl"), glsl!("shadow_map/receiver_plane.frag")]
        }
        (Bias::Adaptive, Filter::Linear) => vec![
            map,
            glsl!("shadow_map/slope.glsl"),
            glsl!("shadow_map/adaptive.glsl"),
            glsl!("shadow_map/adaptive_linear.frag"),
        ],
        (Bias::Adaptive, _) => vec![
            map,
            closer,
            glsl!("shadow_map/slope.glsl"),
            glsl!("shadow_map/adaptive.glsl"),
            glsl!("shadow_map/adaptive_nearest.frag"),
        ],
        (Bias::NormalOffset, _) => {
            vec![map, closer, glsl!("shadow_map/normal_offset.frag"), glsl!("shadow_map/kernel.frag")]
        }
    }
}

/// The matrix `S`, from clip space to [0, 1], in OpenGL's or Direct3D's convention, with the keys for scale and bias of the r
/// coordinate. For GEQUAL, depth is 1 - r.
pub fn texture_from_light_clip(settings: &Settings) -> DMat4 {
    let mirrored = match settings.order {
        Order::LessEqual => DMat4::IDENTITY,
        Order::GreaterEqual => DMat4::from_translation(DVec3::Z) * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)),
    };
    let ordinary = scale_bias(settings.r_scale, settings.r_bias);
    let texture = match settings.addressing {
        Addressing::OpenGl => DMat4::from_translation(DVec3::new(0.0, 0.0, settings.matrix_bias)) * ordinary,
        Addressing::Direct3d(way) => {
            // Direct3D's clip z is in [0, w]. Its depth here is an integer code, 0 to 2^bits - 1; GL's texture unit compares in
            // [0, 1].
            let direct3d_from_gl = DMat4::from_translation(DVec3::new(0.0, 0.0, settings.r_bias))
                * DMat4::from_scale(DVec3::new(1.0, 1.0, settings.r_scale));
            let (bits, half_texel) = (settings.format.bits(), matrix_half_texel(way, settings));
            let depth_from_codes = DMat4::from_scale(DVec3::new(1.0, 1.0, 1.0 / (2.0_f64.powi(bits as i32) - 1.0)));
            depth_from_codes * direct3d_scale_bias(half_texel, bits, settings.matrix_bias) * direct3d_from_gl
        }
    };
    mirrored * texture
}

/// Half a texel in the texture matrix, as a share of [0, 1].
fn matrix_half_texel(way: HalfTexel, settings: &Settings) -> f64 {
    match way {
        HalfTexel::Matrix => 0.5 / f64::from(settings.size),
        HalfTexel::Viewport => 0.0,
    }
}

/// Direct3D's raster on GL's: half a pixel right and down, rows from the top. A viewport that is moved by half a texel the other
/// way takes that back. Identity for OpenGL addressing.
pub fn raster_from_clip(settings: &Settings) -> DMat4 {
    let Addressing::Direct3d(way) = settings.addressing else { return DMat4::IDENTITY };
    let half_pixel = 1.0 / f64::from(settings.size);
    let moved = match way {
        HalfTexel::Matrix => 0.0,
        HalfTexel::Viewport => -half_pixel,
    };
    let [x, y] = [half_pixel + moved; 2];
    DMat4::from_translation(DVec3::new(x, y, 0.0)) * DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0))
}
