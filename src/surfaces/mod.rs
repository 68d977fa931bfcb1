//! The lit pass: every visible surface once, with the light of every contributing light in one shader variant [LEC, "Advice
//! for Shadowed Illumination Model"].

mod bump;
mod explain;
mod guarded;
mod lights;
mod meaning;
mod partition;
mod photo;
mod property;
mod variant;

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use glam::Mat3;

use self::lights::{LightParts, Variants};
use crate::geometry::{Derived, Material};
use crate::lights::appearance::Appearance;
use crate::lights::joined_batches::JoinedBatches;
use crate::lights::light::Addition;
use crate::lights::photo::PhotoTerm;
use crate::lights::{Drawable, Ending, LightTerm, Viewer, sides};
use crate::math::frustum::{self, Overlap};
use crate::pass::{Attribute, Batch, Face, PassList, Uniform};
use crate::scene::Scene;
pub use explain::explain_guards;
pub use guarded::MOST_CLIP_PLANES;

/// The batches that draw `items` as `viewer` sees them, lit by `terms` or showing one of `photos`; `ending` decides what a
/// fragment shows.
///
/// `None` where the transform of a light or of a photograph has no inverse.
#[allow(clippy::too_many_arguments, reason = "a pass knows its scene, viewer, lights and photographs apart")]
pub fn batches(
    scene: &Scene,
    items: &[Drawable],
    viewer: &Viewer,
    terms: &[LightTerm],
    photos: &[Option<PhotoTerm>],
    ending: &Ending,
    derived: &Derived,
    list: &mut PassList,
) -> Option<Vec<Batch>> {
    let clip_from_world = viewer.clip_from_world();
    let pieces = guarded::pieces(items, viewer, terms, ending, derived);
    let adds = terms.iter().any(|term| term.addition != Addition::None);
    let ambient = !terms.iter().any(|term| term.addition == Addition::Light);
    let mut lights: Vec<Variants> = terms.iter().map(|term| Variants::new(items, term, viewer)).collect();
    for piece in &pieces {
        for (variants, reach) in lights.iter_mut().zip(&piece.reaches) {
            variants.make(viewer, *reach, ending, list)?;
        }
    }
    let mut joined = JoinedBatches::default();
    let mut known: HashMap<Kind<'_>, Known> = HashMap::new();
    for piece in &pieces {
        let item = &piece.item;
        let clip_from_model = clip_from_world * item.world_from_model;
        let lights = lights.iter().zip(&piece.reaches).filter_map(|(variants, reach)| variants.of(*reach));
        let photo = photo::parts(photos, item, viewer, ending, adds, list)?;
        let covered = photo.as_ref().is_some_and(|photo| photo.covers);
        // Light falls on none of a covered item's own colour.
        let lights: Vec<&LightParts> = lights.filter(|_| !covered).collect();
        if adds && lights.is_empty() {
            continue;
        }
        let culls = sides::shows_no_back_face(item, &clip_from_model);
        let one_sided = culls || sides::normals_face_eye(item, &(viewer.eye_from_world * item.world_from_model));
        let in_view = frustum::overlap(&clip_from_model, &item.bounds) == Overlap::Inside;
        let appearance = item.appearance();
        let is_plain = photo.is_none() && piece.clip_planes.is_empty();
        let make = || {
            let own = if covered { without_decal(item) } else { Cow::Borrowed(item) };
            let own = own.appearance();
            let surface = match property::of(&own, one_sided, &lights, viewer, ending, list) {
                Some(view) => view,
                None => variant::of(scene, &own, [one_sided, ambient, in_view], &lights, viewer, ending, list),
            };
            let surface = match photo {
                Some(photo) => photo.on(surface),
                None => surface,
            };
            let clip_planes = piece.clip_planes.len() as u8;
            let variant::Variant { program, meaning, uniforms, inputs } = surface.cut(&piece.clip_planes);
            let reads =
                [program.defines.contains(&variant::EYE_SPACE), program.attributes.contains(&Attribute::Normal)];
            let cull = culls.then_some(Face::Back);
            let batch =
                Batch { program, meaning, uniforms, inputs, cull, scissor: None, clip_planes, draws: Vec::new() };
            Known { place: joined.place(batch), reads }
        };
        let Known { place, reads } = match is_plain {
            true => {
                let kind = Kind { appearance, sides: [one_sided, culls], in_view, reaches: &piece.reaches };
                *known.entry(kind).or_insert_with(make)
            }
            false => make(),
        };
        let mut draw = item.draw(&clip_from_world, draw_uniforms(viewer, item, reads));
        draw.eye_from_model = Some(viewer.eye_from_world * item.world_from_model);
        joined.batches[place].draws.push(draw);
    }
    Some(joined.batches)
}

/// All that decides the batch of a piece without a photograph and clip planes.
#[derive(PartialEq, Eq, Hash)]
struct Kind<'p> {
    appearance: Appearance<'p>,
    /// True if no normal is seen from behind, and if back faces are not drawn.
    sides: [bool; 2],
    in_view: bool,
    reaches: &'p [guarded::Reach],
}

/// A batch.
#[derive(Clone, Copy)]
struct Known {
    place: usize,
    /// True if its draws need the matrix into eye space, and that of normals.
    reads: [bool; 2],
}

/// The item without a decal that nothing shows: one without holes.
fn without_decal(item: &Drawable) -> Cow<'_, Drawable> {
    if item.needs_alpha_test() || item.decal().is_none() {
        return Cow::Borrowed(item);
    }
    let material = Arc::new(Material { decal: None, ..Material::clone(&item.material) });
    Cow::Owned(Drawable { material, ..item.clone() })
}

fn draw_uniforms(viewer: &Viewer, item: &Drawable, [eye_space, normals]: [bool; 2]) -> Vec<Uniform> {
    let eye_from_model = viewer.eye_from_world * item.world_from_model;
    let mut uniforms = Vec::new();
    if eye_space {
        uniforms.push(Uniform::new("eye_from_model", eye_from_model.as_mat4()));
    }
    if normals {
        let normal = Mat3::from_mat4(eye_from_model.inverse().transpose().as_mat4());
        uniforms.push(Uniform::new("eye_from_model_normal", normal));
    }
    uniforms
}
