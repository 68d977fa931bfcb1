//! The map of a point light: six frusta of 90 degrees, drawn into the faces of a cube map [HSM, "Advantages and
//! Limitations"].
//!
//! A face that holds no caster, or in which the camera sees nothing, is not drawn: it keeps the depth that maps are cleared
//! to, so that lookups in it, or into it across a seam, find light.

use glam::{DMat4, Vec2};

use super::casters::{in_the_map, may_cast};
use super::depth::{self, DepthLayer};
use super::forecast::{self, Stored};
use super::map::map_info;
use super::settings::{Addressing, Bias, Fit, Mipmaps, Settings, Transfer};
use super::term::{sampler, texture_from_light_clip};
use super::{bias, simplified_casters, tag};
use crate::lights::caster_culling::Unseen;
use crate::lights::light::ShadeSource;
use crate::lights::projector::{Projector, Rays, face_frustum};
use crate::lights::{Coordinates, Drawable, FrustumView, LightTerm, LightView, MapInfo, Notes};
use crate::math::frustum::{self, Overlap};
use crate::pass::{
    Clear, Cube, CubeFace, Define, DrawPass, Filter, ImageId, Input, Pass, PassList, Redraw, Shade, Storage, Target,
    Uniform, Work, glsl,
};
use crate::scene::{Frustum, Point, Reader, SettingsError};

/// Distance beyond a face's sides within which a point may look it up across a seam, in texels: a filter's neighbour and
/// rounding.
const SEAM_TEXELS: f64 = 4.0;

/// Refuses keys that a cube map cannot serve.
///
/// # Errors
///
/// The key, and why.
pub fn refuse(settings: &Settings, keys: &Reader<'_>) -> Result<(), SettingsError> {
    let refused = [
        (settings.bias != Bias::Offset, "bias", "reckons with the texels of a square map"),
        (settings.mipmaps != Mipmaps::None, "mipmaps", "are of square maps"),
        (settings.fit != Fit::None, "fit", "moves the texels of a square map"),
        (settings.addressing != Addressing::OpenGl, "addressing", "of Direct3D is of square maps"),
    ];
    match refused.iter().find(|(is_set, ..)| *is_set) {
        Some((_, key, why)) => Err(keys.error(key, format_args!("{why}; a point light's is a cube"))),
        None => Ok(()),
    }
}

/// Adds the passes of the faces that are needed, and returns the light term.
pub fn describe(
    view: &LightView<'_>,
    point: &Point,
    settings: &Settings,
    list: &mut PassList,
    notes: &mut Notes,
) -> LightTerm {
    let casters = casters(view, point, settings, notes);
    let faces: Vec<(CubeFace, FrustumView<'_>, Vec<&Drawable>)> =
        CubeFace::ALL.into_iter().filter_map(|face| needed(view, point, face, &casters, settings, notes)).collect();
    if faces.is_empty() {
        return super::without_casters(view, notes);
    }
    let map = draw(view, &faces, settings, list, notes);
    let forecast = forecast::Map {
        settings,
        offset: bias::offset(settings),
        stored: Stored::Nearest,
        casters: &casters,
        projectors: projectors(point),
    };
    forecast::warn(view, &forecast, notes);
    term(view, point, map, settings)
}

/// The items whose shadow can be seen.
fn casters<'a>(view: &LightView<'a>, point: &Point, settings: &Settings, notes: &mut Notes) -> Vec<&'a Drawable> {
    let any_face = seen_from(view, point, CubeFace::PositiveX);
    let unseen = (!view.shown_whole && !view.keep_all)
        .then(|| Unseen::new(&any_face, settings.size, bias::kernel_reach(settings)));
    let mut casters = Vec::new();
    for item in view.items {
        if !item.casts_shadow {
            notes.left_out(in_the_map(item, view), "casts_shadow = false");
        } else if unseen.as_ref().is_some_and(|unseen| unseen.shadow_of(item)) {
            notes.left_out(in_the_map(item, view), "the camera sees nothing that it shadows");
        } else {
            casters.push(item);
        }
    }
    casters
}

/// A face with its casters, if it must be drawn.
fn needed<'a>(
    view: &LightView<'a>,
    point: &Point,
    face: CubeFace,
    casters: &[&'a Drawable],
    settings: &Settings,
    notes: &mut Notes,
) -> Option<(CubeFace, FrustumView<'a>, Vec<&'a Drawable>)> {
    let face_view = seen_from(view, point, face);
    let what = format!("face {} of the map of light {}", face.name(), view.index);
    let holds = |item: &&&Drawable| view.keep_all || may_cast(&face_view, item);
    let inside: Vec<&Drawable> = casters.iter().filter(holds).copied().collect();
    if inside.is_empty() {
        notes.left_out(what, "no caster that matters stands in it");
        return None;
    }
    if !view.keep_all && !view.shown_whole && !is_seen(view, point, face, settings) {
        notes.left_out(what, "the camera sees nothing in it");
        return None;
    }
    Some((face, face_view, inside))
}

/// Tests whether the camera may see something that is looked up in the face.
fn is_seen(view: &LightView<'_>, point: &Point, face: CubeFace, settings: &Settings) -> bool {
    let half_angle = (1.0 + 2.0 * (SEAM_TEXELS + bias::kernel_reach(settings)) / f64::from(settings.size)).atan();
    let frustum = Frustum { cone_radians: 2.0 * half_angle, ..face_frustum(point, face) };
    let face_clip = frustum.unbounded().clip_from_world();
    let camera_clip = view.camera.clip_from_world;
    let corners = |clip: &DMat4| frustum::corners(&clip.inverse());
    let in_face =
        |item: &&Drawable| frustum::overlap(&(face_clip * item.world_from_model), &item.bounds) != Overlap::Outside;
    frustum::may_meet(&face_clip, &corners(&face_clip), &camera_clip, &corners(&camera_clip))
        && view.camera.visible.iter().any(in_face)
}

fn seen_from<'a>(view: &LightView<'a>, point: &Point, face: CubeFace) -> FrustumView<'a> {
    FrustumView { light_view: *view, projector: Projector::of_frustum(&face_frustum(point, face)) }
}

/// The projectors of all faces.
pub fn projectors(point: &Point) -> Vec<Projector> {
    CubeFace::ALL.into_iter().map(|face| Projector::of_frustum(&face_frustum(point, face))).collect()
}

/// Draws the faces and, with `transfer = "copy"`, copies each from one depth buffer. Returns the cube.
fn draw(
    view: &LightView<'_>,
    faces: &[(CubeFace, FrustumView<'_>, Vec<&Drawable>)],
    settings: &Settings,
    list: &mut PassList,
    notes: &mut Notes,
) -> ImageId {
    let index = view.index;
    let offset = bias::offset(settings).polygon;
    let (_, cleared) = depth::state(settings, offset, false);
    let drawn = CubeFace::ALL.map(|face| faces.iter().any(|(other, ..)| *other == face));
    let map = list.image(depth::desc(view, "map", settings, Storage::Cube(Cube { drawn, rest: cleared })));
    let buffer = (settings.transfer == Transfer::Copy)
        .then(|| list.image(depth::desc(view, "map: depth buffer", settings, Storage::Renderbuffer)));
    notes.left_out(format!("colour attachments and colour writes of light {index}'s depth"), "only its depth is read");
    for (face, face_view, casters) in faces {
        let fewer = if settings.simplified {
            simplified_casters::simplified(face_view, casters, settings, notes)
        } else {
            Vec::new()
        };
        let fewer: Vec<&Drawable> = fewer.iter().collect();
        let casters = if settings.simplified { &fewer } else { casters };
        let layer = DepthLayer::plain("depth", "map", offset, casters);
        let clamped = depth::is_clamped(face_view, &layer, &format!("face {}", face.name()), notes);
        let (state, _) = depth::state(settings, offset, clamped);
        let batches = depth::batches(face_view, &layer, settings, list);
        let label = format!("light {index}: depth, face {}", face.name());
        let target = Target {
            color: None,
            depth: Some(buffer.unwrap_or(map)),
            level: 0,
            face: buffer.is_none().then_some(*face),
        };
        list.passes.push(Pass {
            label: label.clone(),
            redraw: Redraw::WhenChanged,
            work: Work::Draw(DrawPass {
                target,
                viewport: [settings.size; 2],
                clear: Clear { depth: Some(cleared), ..Clear::default() },
                state,
                batches,
            }),
        });
        if let Some(from) = buffer {
            list.passes.push(Pass {
                label: format!("{label}, copied"),
                redraw: Redraw::WhenChanged,
                work: Work::CopyDepth { from, to: map, face: Some(*face) },
            });
        }
    }
    map
}

/// Light term of the cube.
fn term(view: &LightView<'_>, point: &Point, map: ImageId, settings: &Settings) -> LightTerm {
    let index = view.index;
    let meaning = Shade::Shader("a shade that is looked up in a cube map");
    let shade = ShadeSource::of(glsl!("shadow_map/cube.frag"), meaning);
    let mut term = LightTerm::new(view.light(), index, shade);
    term.coordinates = Some(Coordinates {
        texture_from_light_clip: DMat4::IDENTITY,
        receiver_bias: DMat4::IDENTITY,
        light_clip_from_light: DMat4::IDENTITY,
        light_from_world: DMat4::from_translation(-point.position),
        set_up: settings.set_up,
        split: settings.split,
    });
    let rays = Rays::From { position: point.position, near: point.near };
    let sampler = sampler(rays, settings);
    term.shade.inputs.push(Input { name: format!("shadow_map_{index}").into(), image: map, sampler });
    term.shade.uniforms.push(Uniform::of_light("face_depth", index, face_depth(point, settings)));
    term.shade.defines.push(Define::flag("CUBE").of_light(index));
    term.shade.chunks.insert(0, glsl!("shadow_map/map.glsl"));
    if settings.kernel > 1 {
        term.shade.chunks.insert(1, glsl!("shadow_map/percentage_closer.glsl"));
        term.shade.defines.push(Define::number("KERNEL", settings.kernel).of_light(index));
    }
    let reach = bias::kernel_reach(settings) + if settings.filter == Filter::Linear { 0.5 } else { 0.0 };
    if reach > 0.0 {
        term.shade.defines.push(Define::flag("SEAMS").of_light(index));
        // Width of the seam, for a face of side 2; rounding may bring a lookup nearer.
        let seam = (1.0 - (2.0 * reach + 0.01) / f64::from(settings.size)).max(0.0);
        term.shade.uniforms.push(Uniform::of_light("seam", index, seam as f32));
    }
    term.counting = tag::counting(view, settings);
    term.map = Some(map);
    let offset = bias::offset(settings);
    let info = map_info(&seen_from(view, point, CubeFace::PositiveX), settings, offset.texels);
    term.map_info = Some(MapInfo { polygon: offset.polygon, ..info });
    term
}

/// `r = x - y / depth`, by every face's projection `z / w = a - b / depth`, with receivers moved towards the light (see
/// [`bias::moved_to_light`]), and by `S`.
fn face_depth(point: &Point, settings: &Settings) -> Vec2 {
    let Point { near, far, .. } = *point;
    let (a, b) = ((far + near) / (far - near), 2.0 * far * near / (far - near));
    let any_face = Projector::of_frustum(&face_frustum(point, CubeFace::PositiveX));
    let moved = bias::offset(settings).texels * bias::texel_at_one(&any_face, settings);
    let texture = texture_from_light_clip(settings);
    let (scale, offset) = (texture.z_axis.z, texture.w_axis.z);
    Vec2::new((scale * a + offset) as f32, (scale * b * (1.0 + bias::growth(moved))) as f32)
}
