//! The photographs that surfaces look up, each with the depth map that tells what its eye saw [Segal 1992, 3.1].

use super::{Error, Request, Subject};
use crate::geometry::Derived;
use crate::lights::guard::Guard;
use crate::lights::light::name_of;
use crate::lights::photo::PhotoTerm;
use crate::lights::{CameraView, Drawable, LightTerm, LightView, Notes};
use crate::pass::PassList;
use crate::scene::{Hidden, Photo, Scene};
use crate::techniques::LightShadow;
use crate::views::View;

/// The scene's photographs by their numbers; `None` for one that the picture does not need.
///
/// # Errors
///
/// A photograph whose map was not read by glumbra's techniques.
pub fn describe(
    scene: &Scene,
    items: &[Drawable],
    request: &Request,
    derived: &Derived,
    list: &mut PassList,
    notes: &mut Notes,
) -> Result<Vec<Option<PhotoTerm>>, Error> {
    let photos = scene.photos();
    let mut terms = Vec::with_capacity(photos.len());
    for (number, photo) in photos.into_iter().enumerate() {
        let shown: Vec<Drawable> = items.iter().filter(|item| item.photo == Some(number)).cloned().collect();
        let camera = CameraView::new(scene, &shown);
        let view = LightView {
            scene,
            items,
            camera: &camera,
            derived,
            index: scene.lights.len() + number,
            source: &photo.projector,
            shown_whole: is_seen_from_elsewhere(request),
            keep_all: request.keep_all,
            sampled_warnings: request.sampled_warnings,
        };
        terms.push(photo_term(&view, photo, list, notes)?);
    }
    Ok(terms)
}

/// Tests whether some picture is another viewer's than the camera's.
fn is_seen_from_elsewhere(request: &Request) -> bool {
    request.subject != Subject::Camera || request.views.iter().any(|wanted| wanted.view == View::LightView)
}

fn photo_term(
    view: &LightView<'_>,
    photo: &Photo,
    list: &mut PassList,
    notes: &mut Notes,
) -> Result<Option<PhotoTerm>, Error> {
    if view.camera.visible.is_empty() && !view.shown_whole && !view.keep_all {
        notes.left_out(view.name(), "nothing that has it is seen");
        return Ok(None);
    }
    let hidden = photo.hidden;
    let mut term = if hidden == Hidden::Smear {
        notes.left_out(format!("the map of {}", view.name()), "hidden = \"smear\" tests no depth");
        LightTerm::unshadowed(view.source, view.index)
    } else {
        let unread = || Error::Unread { light: name_of(view.scene, view.index) };
        LightShadow::of(&photo.projector.shadow).ok_or_else(unread)?.describe(view, list, notes)
    };
    if view.keep_all {
        term.guard = Guard::Fragment;
    }
    Ok(Some(PhotoTerm { term, hidden }))
}
