//! From a scene to its passes: each contributing light's own, then the lit passes, then the views.

use glam::DMat4;

use super::matrices::Matrices;
use super::pictures::{Pictures, PlannedLight};
use super::{Error, Plan, Request, Subject, ViewRequest};
use crate::compositions::passes::Passes;
use crate::lights::drawable::{items, note_clear};
use crate::lights::guard::Guard;
use crate::lights::projected::note_projected;
use crate::lights::{CameraView, Drawable, LightView, Notes};
use crate::math::frustum::{self, Overlap};
use crate::pass::PassList;
use crate::scene::{Light, Scene};
use crate::surfaces;
use crate::techniques::{self, LightShadow};

/// The unpruned plan.
pub fn compose(scene: &Scene, request: &Request) -> Result<Plan, Error> {
    let shadows = techniques::read(scene)?;
    let moved = shadows.iter().any(|shadow| shadow.technique.needs_vertices());
    let items = items(scene, moved);
    let mut list = PassList::default();
    let mut notes = Notes::default();
    note_clear(scene, &mut notes);
    note_projected(scene, &mut notes);
    for object in scene.objects.iter().filter(|object| moved && object.wave.is_some()) {
        let why = "a technique of this scene needs its vertices: all passes draw the moved mesh";
        notes.chosen(object.name.clone(), "moved before it is drawn", why);
    }
    let camera = CameraView::new(scene, &items);
    let terms = light_terms(&shadows, scene, &items, &camera, request, &mut list, &mut notes)?;
    let counts = terms.iter().filter_map(|light| light.term.counting.as_ref());
    let counted = counts.clone().any(|counting| !counting.volumes.is_empty());
    let kept = counts.flat_map(|counting| counting.casters.iter().copied()).collect();
    let passes = Passes {
        scene,
        items: &items,
        kept,
        counted,
        list: &mut list,
        notes: &mut notes,
        surface: surfaces::batches,
        frames: request.frames,
        keep_all: request.keep_all,
    };
    let mut pictures = Pictures { passes, request };
    let buffers = match request.subject {
        Subject::Camera => pictures.of_camera(&terms)?,
        Subject::Light(index) => pictures.of_light(index)?,
    };
    let mut views = Vec::new();
    for wanted in &request.views {
        let image = pictures.view(wanted, &terms, buffers)?;
        views.push((*wanted, image));
    }
    let maps = terms.iter().filter(|light| light.is_drawn).filter_map(|light| light.term.map_info).collect();
    let Notes { left_out, chosen, warnings } = notes;
    let matrices = Matrices::new(scene, &terms);
    Ok(Plan { list, picture: buffers.color, views, left_out, chosen, warnings, maps, matrices })
}

/// Describes every light that reaches something visible or that a view shows. Every light's keys are read, so that
/// errors do not depend on where the camera looks.
fn light_terms(
    shadows: &[LightShadow],
    scene: &Scene,
    items: &[Drawable],
    camera: &CameraView<'_>,
    request: &Request,
    list: &mut PassList,
    notes: &mut Notes,
) -> Result<Vec<PlannedLight>, Error> {
    let mut planned = Vec::new();
    for (index, shadow) in shadows.iter().enumerate() {
        let of_this = |v: &&ViewRequest| v.view.of_light() && v.light == index;
        let shown = request.views.iter().any(|v| of_this(&v));
        let shown_whole = request.views.iter().filter(of_this).any(|v| v.view.needs_map());
        // Things outside the camera's view may be in another viewer's.
        let shown_whole = shown_whole || request.subject != Subject::Camera;
        let keep_all = request.keep_all;
        let sampled_warnings = request.sampled_warnings;
        let view = LightView { scene, items, camera, index, shown_whole, keep_all, sampled_warnings };
        let absent = why_absent(&view).filter(|_| !keep_all);
        let (mut spare_list, mut spare_notes) = (PassList::default(), Notes::default());
        let mut term = if absent.is_none() || shown {
            shadow.settings.describe(&view, list, notes)?
        } else {
            shadow.settings.describe(&view, &mut spare_list, &mut spare_notes)?
        };
        if keep_all && term.guard == Guard::Auto {
            term.guard = Guard::Fragment;
        }
        if let Some(why) = absent {
            notes.left_out(format!("light {index}"), why);
        }
        planned.push(PlannedLight { term, contributes: absent.is_none(), is_drawn: absent.is_none() || shown });
    }
    Ok(planned)
}

/// Reason why a light adds nothing to the picture, if there is one.
fn why_absent(view: &LightView<'_>) -> Option<&'static str> {
    let source = view.light();
    if [source.ambient, source.diffuse, source.specular].iter().all(|color| *color == [0.0; 3]) {
        return Some("its colours are black");
    }
    if source.ambient != [0.0; 3] {
        return None; // ambient light is not bound by the cone
    }
    let Some(light_clip) = reach(source) else {
        return view.camera.visible.is_empty().then_some("nothing that is seen is there for it to light");
    };
    let camera_clip = view.camera.clip_from_world;
    let corners = |clip: &DMat4| frustum::corners(&clip.inverse());
    if !frustum::may_meet(&light_clip, &corners(&light_clip), &camera_clip, &corners(&camera_clip)) {
        return Some("its cone and the camera's frustum do not meet");
    }
    let touched =
        |item: &&Drawable| frustum::overlap(&(light_clip * item.world_from_model), &item.bounds) != Overlap::Outside;
    if view.camera.visible.iter().any(touched) { None } else { Some("its cone reaches nothing visible") }
}

/// `clip_from_world` of the region that the light can reach: its cone's pyramid, from its position. Near and far bound the
/// map's depths, not the light. `None`: nothing bounds it.
fn reach(source: &Light) -> Option<DMat4> {
    source.frustum().map(|frustum| frustum.unbounded().clip_from_world())
}
