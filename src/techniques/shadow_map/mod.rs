//! Shadow maps by the depth comparison of the texture unit [Hardware Shadow Mapping; techniques A1–A10].

mod settings;

use glam::{DMat4, DVec3, Vec4};

use self::settings::{Addressing, Order, Settings, Transfer};
use super::items::depth_batches;
use super::unseen::Unseen;
use super::{Axis, Coordinates, Item, LightTerm, LightView, Notes, Technique};
use crate::math::frustum::{self, Overlap};
use crate::math::texgen::{direct3d_scale_bias, scale_bias};
use crate::pass::{
    Clear, Compare, DepthFormat, DrawPass, DrawState, Format, ImageDesc, ImageId, Input, Pass, PassList, PolygonOffset,
    Sampler, Shade, Storage, Target, Work, Wrap, glsl,
};
use crate::scene::{Frustum, LightKind, Reader, SettingsError};

pub struct ShadowMap;

impl Technique for ShadowMap {
    fn name(&self) -> &'static str {
        "shadow-map"
    }

    fn summary(&self) -> &'static str {
        "depth from the light, compared by the texture unit"
    }

    fn source(&self) -> &'static str {
        "Hardware Shadow Mapping; techniques A1-A10, A12"
    }

    fn serves(&self, kind: &LightKind) -> Result<(), &'static str> {
        match kind {
            LightKind::Spot(_) => Ok(()),
            LightKind::Point(_) => Err("draws one square map, and a point light's six come with the cube map"),
            LightKind::Directional { .. } => {
                Err("draws its map in perspective, and a directional light's comes with the orthographic map")
            }
        }
    }

    fn axes(&self) -> &'static [Axis] {
        settings::AXES
    }

    fn check(&self, settings: &mut Reader<'_>) -> Result<(), SettingsError> {
        settings::read(settings).map(|_| ())
    }

    fn describe(
        &self,
        view: &LightView<'_>,
        keys: &mut Reader<'_>,
        list: &mut PassList,
        notes: &mut Notes,
    ) -> Result<LightTerm, SettingsError> {
        let settings = settings::read(keys)?;
        let frustum = view.light().frustum().ok_or_else(|| keys.error("technique", "draws the map of a frustum"))?;
        let casters = casters(view, frustum, &settings, notes);
        if casters.is_empty() && !view.keep_all {
            notes.left_out(
                format!("the map of light {}", view.index),
                "no caster in the light's frustum shadows what is seen",
            );
            let mut term = LightTerm::unshadowed(view.scene, view.index);
            term.dimming = settings.dimming;
            return Ok(term);
        }
        let map = depth_passes(view, frustum, &casters, &settings, list, notes);
        Ok(term(view, frustum, map, &settings))
    }
}

/// The items that can stand in the light's way inside its frustum and whose shadow can be seen.
fn casters<'a>(view: &LightView<'a>, frustum: &Frustum, settings: &Settings, notes: &mut Notes) -> Vec<&'a Item> {
    let unseen = (!view.shown_whole && !view.keep_all).then(|| Unseen::new(view, frustum, settings.size));
    let clip_from_world = frustum.clip_from_world();
    let mut casters = Vec::new();
    for item in view.items {
        if !item.casts_shadow {
            notes.left_out(format!("{} in the map of light {}", item.label, view.index), "casts_shadow = false");
        } else if !view.keep_all
            && frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) == Overlap::Outside
        {
            notes.left_out(format!("{} in the map of light {}", item.label, view.index), "outside the light's frustum");
        } else if unseen.as_ref().is_some_and(|unseen| unseen.shadow_of(item)) {
            notes.left_out(
                format!("{} in the map of light {}", item.label, view.index),
                "the camera sees nothing that it shadows",
            );
        } else {
            warn_of_near(view, frustum, item, notes);
            casters.push(item);
        }
    }
    casters
}

/// A caster between the light and its near plane casts no shadow from what is cut off: say so.
fn warn_of_near(view: &LightView<'_>, frustum: &Frustum, item: &Item, notes: &mut Notes) {
    let cut_off = Frustum { near: 1e-3 * frustum.near, far: frustum.near, ..frustum.clone() };
    let clip_from_model = cut_off.clip_from_world() * item.world_from_model;
    if frustum::overlap(&clip_from_model, &item.bounds) != Overlap::Outside {
        notes.warnings.push(format!(
            "{} may come nearer to light {} than its near plane at {}: what lies before that plane casts no shadow",
            item.label, view.index, frustum.near
        ));
    }
}

/// Draws the casters' depth and, by the copy road, copies it. Returns the depth texture.
fn depth_passes(
    view: &LightView<'_>,
    frustum: &Frustum,
    casters: &[&Item],
    settings: &Settings,
    list: &mut PassList,
    notes: &mut Notes,
) -> ImageId {
    let index = view.index;
    let desc = |label: String, storage| ImageDesc {
        label,
        size: [settings.size; 2],
        format: Format::Depth(settings.format),
        storage,
    };
    let map = list.image(desc(format!("light {index} map"), Storage::Texture));
    let drawn = match settings.transfer {
        Transfer::Fbo => map,
        Transfer::Copy => list.image(desc(format!("light {index} depth buffer"), Storage::Renderbuffer)),
    };
    let clip_from_world = raster_from_clip(settings) * frustum.clip_from_world();
    let batches = depth_batches(casters, &clip_from_world, list);
    let label = format!("light {index}: depth");
    notes.left_out(format!("colour attachment and colour writes of \"{label}\""), "only its depth is read");
    let (state, cleared) = depth_state(settings);
    list.passes.push(Pass {
        label,
        redraw: settings.redraw,
        work: Work::Draw(DrawPass {
            target: Target { color: None, depth: Some(drawn) },
            viewport: [settings.size; 2],
            clear: Clear { color: None, depth: Some(cleared), stencil: None },
            state,
            batches,
        }),
    });
    if settings.transfer == Transfer::Copy {
        list.passes.push(Pass {
            label: format!("light {index}: copy"),
            redraw: settings.redraw,
            work: Work::CopyDepth { from: drawn, to: map },
        });
    }
    map
}

/// Draw state and cleared depth; reversed depth range, test and offset for GEQUAL.
fn depth_state(settings: &Settings) -> (DrawState, f32) {
    let PolygonOffset { factor, units } = settings.offset;
    let offset = |sign: f32| {
        (factor != 0.0 || units != 0.0).then_some(PolygonOffset { factor: sign * factor, units: sign * units })
    };
    let plain = DrawState { cull: settings.cull, ..DrawState::DEPTH_ONLY };
    match settings.order {
        Order::LessEqual => (DrawState { polygon_offset: offset(1.0), ..plain }, 1.0),
        Order::GreaterEqual => {
            let reversed = DrawState {
                depth_test: Some(Compare::Greater),
                depth_range: [1.0, 0.0],
                polygon_offset: offset(-1.0),
                ..plain
            };
            (reversed, 0.0)
        }
    }
}

/// Direct3D's raster on GL's: half a pixel right and down, rows from the top. Identity for OpenGL addressing.
fn raster_from_clip(settings: &Settings) -> DMat4 {
    match settings.addressing {
        Addressing::OpenGl => DMat4::IDENTITY,
        Addressing::Direct3d => {
            let half_pixel = 1.0 / f64::from(settings.size);
            DMat4::from_translation(DVec3::new(half_pixel, half_pixel, 0.0))
                * DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0))
        }
    }
}

/// How the lit pass compares against `map`.
fn term(view: &LightView<'_>, frustum: &Frustum, map: ImageId, settings: &Settings) -> LightTerm {
    let index = view.index;
    let name = format!("shadow_map_{index}");
    let clamped = settings.format == DepthFormat::Depth32F;
    let mut term = LightTerm::new(view.scene, index, glsl!("shadow_map/shade.frag"));
    term.meaning = Shade::Texture { input: name.clone().into(), clamped };
    let compare = match settings.order {
        Order::LessEqual => Compare::LessEqual,
        Order::GreaterEqual => Compare::GreaterEqual,
    };
    term.inputs.push(Input {
        name: name.into(),
        image: map,
        sampler: Sampler { filter: settings.filter, wrap: Wrap::ClampToEdge, compare: Some(compare) },
    });
    if clamped {
        term.defines.push(format!("CLAMP_REFERENCE_{index}"));
    }
    term.coordinates = Some(Coordinates {
        texture_from_light_clip: texture_from_light_clip(settings),
        set_up: settings.set_up,
        split: settings.split,
        ..Coordinates::of_frustum(frustum)
    });
    if settings.addressing == Addressing::Direct3d {
        let half_texel = 0.5 / settings.size as f32;
        term.frustum_from_map = Some(Vec4::new(1.0, -1.0, -half_texel, 1.0 + half_texel));
    }
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
