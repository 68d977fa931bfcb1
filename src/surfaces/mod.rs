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
use std::sync::Arc;

use glam::Mat3;

use self::lights::{LightParts, Variants};
use crate::geometry::{Derived, Material};
use crate::lights::light::Addition;
use crate::lights::photo::PhotoTerm;
use crate::lights::{Drawable, Ending, LightTerm, Viewer, sides};
use crate::pass::{Attribute, Batch, Face, PassList, Program, Uniform};
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
    let mut batches: Vec<Batch> = Vec::new();
    for piece in &pieces {
        let item = &piece.item;
        let lights = lights.iter().zip(&piece.reaches).filter_map(|(variants, reach)| variants.of(*reach));
        let photo = photo::parts(photos, item, viewer, ending, adds, list)?;
        let covered = photo.as_ref().is_some_and(|photo| photo.covers);
        // Light falls on none of a covered item's own colour.
        let lights: Vec<&LightParts> = lights.filter(|_| !covered).collect();
        if adds && lights.is_empty() {
            continue;
        }
        let culls = sides::shows_no_back_face(item, &(clip_from_world * item.world_from_model));
        let one_sided = culls || sides::normals_face_eye(item, &(viewer.eye_from_world * item.world_from_model));
        let own = if covered { without_decal(item) } else { Cow::Borrowed(item) };
        let surface = match property::of(&own, one_sided, &lights, viewer, ending, list) {
            Some(view) => view,
            None => variant::of(scene, &own, [one_sided, ambient], &lights, viewer, ending, list),
        };
        let surface = match photo {
            Some(photo) => photo.on(surface),
            None => surface,
        };
        let clip_planes = piece.clip_planes.len() as u8;
        let variant::Variant { program, meaning, uniforms, inputs } = surface.cut(&piece.clip_planes);
        let cull = culls.then_some(Face::Back);
        let mut draw = item.draw(&clip_from_world, draw_uniforms(viewer, item, &program));
        draw.eye_from_model = Some(viewer.eye_from_world * item.world_from_model);
        let joins =
            |b: &&mut Batch| b.cull == cull && b.inputs == inputs && b.uniforms == uniforms && b.program == program;
        match batches.iter_mut().find(joins) {
            Some(batch) => {
                debug_assert_eq!(batch.meaning, meaning, "the meaning follows from program, uniforms and inputs");
                batch.draws.push(draw);
            }
            None => batches.push(Batch {
                program,
                meaning,
                uniforms,
                inputs,
                cull,
                scissor: None,
                clip_planes,
                draws: vec![draw],
            }),
        }
    }
    Some(batches)
}

/// The item without a decal that nothing shows: one without holes.
fn without_decal(item: &Drawable) -> Cow<'_, Drawable> {
    if item.needs_alpha_test() || item.decal().is_none() {
        return Cow::Borrowed(item);
    }
    let material = Arc::new(Material { decal: None, ..Material::clone(&item.material) });
    Cow::Owned(Drawable { material, ..item.clone() })
}

fn draw_uniforms(viewer: &Viewer, item: &Drawable, program: &Program) -> Vec<Uniform> {
    let eye_from_model = viewer.eye_from_world * item.world_from_model;
    let mut uniforms = Vec::new();
    if program.defines.contains(&variant::EYE_SPACE) {
        uniforms.push(Uniform::new("eye_from_model", eye_from_model.as_mat4()));
    }
    if program.attributes.contains(&Attribute::Normal) {
        let normal = Mat3::from_mat4(eye_from_model.inverse().transpose().as_mat4());
        uniforms.push(Uniform::new("eye_from_model_normal", normal));
    }
    uniforms
}
