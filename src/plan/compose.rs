//! From a scene to its passes: each contributing light's own, then the lit passes, then the views.

use glam::DMat4;

use super::matrices::Matrices;
use super::pictures::{Pictures, PlannedLight};
use super::{Error, Plan, Request, Subject, ViewRequest, lens, photos};
use crate::compositions::passes::Passes;
use crate::geometry::Derived;
use crate::lights::bumps::note_bumps;
use crate::lights::drawable::{items, note_clear, note_skins};
use crate::lights::guard::Guard;
use crate::lights::light::name_of;
use crate::lights::photo;
use crate::lights::projected::note_projected;
use crate::lights::{CameraView, Drawable, LightView, Notes};
use crate::math::frustum::{self, Overlap};
use crate::pass::PassList;
use crate::scene::{Focus, Light, Scene, Spot};
use crate::surfaces;
use crate::techniques::LightShadow;

/// The unpruned plan.
pub fn compose(scene: &Scene, request: &Request, derived: &Derived) -> Result<Plan, Error> {
    let shadows = shadows(scene)?;
    let moved = shadows.iter().any(|shadow| shadow.technique.needs_vertices());
    let items = items(scene, moved.then_some(derived));
    let mut list = PassList::default();
    let mut notes = Notes::default();
    note_clear(scene, &mut notes);
    note_skins(scene, &mut notes);
    note_projected(scene, &mut notes);
    note_bumps(scene, &mut notes);
    for object in scene.objects.iter().filter(|object| moved && object.wave.is_some()) {
        let why = "a technique of this scene needs its vertices: all passes draw the moved mesh";
        notes.chosen(object.name.clone(), "moved before it is drawn", why);
    }
    let camera = CameraView::new(scene, &items);
    let view = |index| LightView {
        scene,
        items: &items,
        camera: &camera,
        derived,
        index,
        source: &scene.lights[index],
        shown_whole: false,
        keep_all: request.keep_all,
        sampled_warnings: request.sampled_warnings,
    };
    let lights: Vec<PlannedLight> = shadows
        .iter()
        .enumerate()
        .map(|(index, shadow)| planned_light(&view(index), shadow, request, &mut list, &mut notes))
        .collect();
    let photos = photos::describe(scene, &items, request, derived, &mut list, &mut notes)?;
    let terms = || lights.iter().filter_map(|light| light.term.as_ref());
    let counts = terms().filter_map(|term| term.counting.as_ref());
    let counted = counts.clone().any(|counting| !counting.volumes.is_empty());
    let kept = counts.flat_map(|counting| counting.casters.iter().copied()).collect();
    let passes = Passes {
        scene,
        items: &items,
        photos: &photos,
        derived,
        kept,
        counted,
        list: &mut list,
        notes: &mut notes,
        surface: surfaces::batches,
        frames: request.frames,
        keep_all: request.keep_all,
        clamps: !request.float_picture,
    };
    let mut pictures = Pictures { passes, request };
    let buffers = match request.subject {
        Subject::Camera => pictures.of_camera(&lights)?,
        Subject::Light(index) => pictures.of_light(index)?,
    };
    let mut views = Vec::new();
    for wanted in &request.views {
        let image = pictures.view(wanted, &lights, buffers)?;
        views.push((*wanted, image));
    }
    let described = || lights.iter().filter_map(PlannedLight::described);
    let maps = described().filter_map(|term| term.map_info).collect();
    let Notes { left_out, chosen, warnings } = notes;
    let of_photos = photos.iter().flatten().map(|photo| &photo.term);
    let matrices = Matrices::new(scene, described().chain(of_photos));
    Ok(Plan { list, picture: buffers.color, views, left_out, chosen, warnings, maps, matrices })
}

/// The lights' shadow settings, in the scene's order.
fn shadows(scene: &Scene) -> Result<Vec<&LightShadow>, Error> {
    let lights = scene.lights.iter().enumerate();
    let unread = |index| Error::Unread { light: name_of(scene, index) };
    lights.map(|(index, source)| LightShadow::of(&source.shadow).ok_or_else(|| unread(index))).collect()
}

/// Describes a light if it reaches something visible or a view shows it.
fn planned_light(
    view: &LightView<'_>,
    shadow: &LightShadow,
    request: &Request,
    list: &mut PassList,
    notes: &mut Notes,
) -> PlannedLight {
    let (index, keep_all) = (view.index, view.keep_all);
    let of_this = |v: &&ViewRequest| v.view.of_light() && v.light == index;
    let shown = request.views.iter().any(|v| of_this(&v));
    let shown_whole = request.views.iter().filter(of_this).any(|v| v.view.needs_map());
    // Things outside the camera's view may be in another viewer's.
    let shown_whole = shown_whole || request.subject != Subject::Camera;
    // Shadows are seen in the air, too, and of a light without a guard behind it.
    let is_unguarded = shadow.common.guard == Guard::None;
    let shown_whole = shown_whole || view.light().dust.is_some() || is_unguarded;
    let view = LightView { shown_whole, ..*view };
    let absent = why_absent(&view, is_unguarded).filter(|_| !keep_all);
    if let Some(why) = absent {
        notes.left_out(format!("light {index}"), why);
    }
    let describe = |view: &LightView<'_>, list: &mut PassList, notes: &mut Notes| {
        let mut term = shadow.describe(view, list, notes);
        if keep_all && term.guard == Guard::Auto {
            term.guard = Guard::Fragment;
        }
        term
    };
    let lens = view.light().spot().and_then(|spot| lens_in_use(spot, index, notes)).filter(|_| absent.is_none());
    let focused = lens.map(|lens| lens::focused(&view, &lens, list, notes, &describe));
    let contributes = absent.is_none() && focused.is_none();
    // Views show the light from the middle of its lens, about which the picture has no more to say.
    let mut unheard = Notes::default();
    let notes = if focused.is_some() { &mut unheard } else { notes };
    let term = (contributes || shown).then(|| describe(&view, list, notes));
    PlannedLight { term, contributes, focused }
}

/// The spotlight's lens, where it changes the picture; notes why not.
fn lens_in_use(spot: &Spot, index: usize, notes: &mut Notes) -> Option<Focus> {
    let focus = spot.focus?;
    if spot.lens().is_none() {
        let why = if focus.samples == 1 {
            "one lens point is its middle"
        } else {
            "all points of a lens of radius 0 are one"
        };
        notes.left_out(format!("focus of light {index}"), why);
    }
    spot.lens()
}

/// Reason why a light adds nothing to the picture, if there is one.
fn why_absent(view: &LightView<'_>, is_unguarded: bool) -> Option<&'static str> {
    let source = view.light();
    if [source.ambient, source.diffuse, source.specular].iter().all(|color| *color == [0.0; 3]) {
        return Some("its colours are black");
    }
    if source.ambient != [0.0; 3] {
        return None; // ambient light is not bound by the cone
    }
    let photos = view.scene.photos();
    let is_covered = |item: &Drawable| {
        let photo = item.photo.and_then(|photo| photos.get(photo));
        photo.is_some_and(|photo| photo::covers(photo, item, &view.camera.viewer))
    };
    let Some(light_clip) = reach(source).filter(|_| !is_unguarded) else {
        if view.camera.visible.is_empty() {
            return Some("nothing that is seen is there for it to light");
        }
        let covered = view.camera.visible.iter().all(|item| is_covered(item));
        return covered.then_some("all that is seen shows photographs alone");
    };
    let camera_clip = view.camera.clip_from_world;
    let corners = |clip: &DMat4| frustum::corners(&clip.inverse());
    if !frustum::may_meet(&light_clip, &corners(&light_clip), &camera_clip, &corners(&camera_clip)) {
        return Some("its cone and the camera's frustum do not meet");
    }
    if source.dust.is_some() {
        return None; // the air between is seen
    }
    let touched =
        |item: &&&Drawable| frustum::overlap(&(light_clip * item.world_from_model), &item.bounds) != Overlap::Outside;
    let mut touched = view.camera.visible.iter().filter(touched).peekable();
    if touched.peek().is_none() {
        return Some("its cone reaches nothing visible");
    }
    touched.all(|item| is_covered(item)).then_some("what its cone reaches shows photographs alone")
}

/// `clip_from_world` of the region that the light can reach: its cone's pyramid, from its position or its lens. Near and far bound the
/// map's depths, not the light. `None`: nothing bounds it.
fn reach(source: &Light) -> Option<DMat4> {
    source.spot().map(|spot| spot.reach().unbounded().clip_from_world())
}
