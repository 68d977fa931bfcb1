//! From a scene to its passes: each contributing light's own, then the lit pass, then the views.

use glam::DMat4;

use super::{Error, Plan, Request, Subject, ViewRequest};
use crate::math::frustum::{self, Overlap};
use crate::pass::{
    Clear, DepthFormat, DrawPass, DrawState, Format, ImageDesc, ImageId, Pass, PassList, Redraw, Storage, Target, Work,
};
use crate::scene::{Frustum, Light, Scene};
use crate::techniques::guides;
use crate::techniques::items::items;
use crate::techniques::surface::{self, Ending, Viewer};
use crate::techniques::views::{self, View};
use crate::techniques::{self, Item, LightTerm, LightView, Notes};

/// The unpruned plan.
pub fn compose(scene: &Scene, request: &Request) -> Result<Plan, Error> {
    let items = items(scene);
    let mut list = PassList::default();
    let mut notes = Notes::default();
    let camera = camera(scene);
    let terms = light_terms(scene, &items, &camera, request, &mut list, &mut notes)?;
    let size = scene.image.size;
    let format = if request.float_picture { Format::Rgba32F } else { Format::Rgba8 };
    let target = color_and_depth("picture", size, format, &mut list);
    let mut builder = Builder { scene, items: &items, list: &mut list };
    match request.subject {
        Subject::Camera => builder.camera_picture(target, &camera, &terms)?,
        Subject::Light(index) => builder.light_picture(target, index)?,
    }
    let mut views = Vec::new();
    for wanted in &request.views {
        let image = builder.view(wanted, &camera, &terms, target)?;
        views.push((*wanted, image));
    }
    notes.left_out("stencil buffer", "no technique of this scene counts in it");
    let picture = target.color.unwrap_or(ImageId(0));
    Ok(Plan { list, picture, views, left_out: notes.left_out, warnings: notes.warnings })
}

/// The scene's camera as a viewer.
fn camera(scene: &Scene) -> Viewer {
    Viewer {
        clip_from_eye: scene.camera.clip_from_view(scene.aspect()),
        eye_from_world: scene.camera.view_from_world(),
    }
}

/// A light's term, and whether the picture needs it.
struct PlannedLight {
    term: LightTerm,
    contributes: bool,
}

/// Describes every light that reaches something visible or that a view shows. Every light's keys are read, so that
/// errors do not depend on where the camera looks.
fn light_terms(
    scene: &Scene,
    items: &[Item],
    camera: &Viewer,
    request: &Request,
    list: &mut PassList,
    notes: &mut Notes,
) -> Result<Vec<PlannedLight>, Error> {
    let visible = visible(items, camera);
    let mut planned = Vec::new();
    for (index, source) in scene.lights.iter().enumerate() {
        let of_this = |v: &&ViewRequest| v.view.of_light() && v.light == index;
        let shown = request.views.iter().any(|v| of_this(&v));
        let shown_whole = request.views.iter().filter(of_this).any(|v| v.view.needs_map());
        // What is out of the camera's sight may be in another viewer's.
        let shown_whole = shown_whole || request.subject != Subject::Camera;
        let keep_all = request.keep_all;
        let view = LightView { scene, items, index, shown_whole, keep_all };
        let absent = why_absent(&view, camera, &visible).filter(|_| !keep_all);
        let mut keys = source.shadow.read();
        let technique = techniques::chosen(&source.kind, &mut keys)?;
        let (mut spare_list, mut spare_notes) = (PassList::default(), Notes::default());
        let term = if absent.is_none() || shown {
            technique.describe(&view, &mut keys, list, notes)?
        } else {
            technique.describe(&view, &mut keys, &mut spare_list, &mut spare_notes)?
        };
        keys.finish()?;
        if let Some(why) = absent {
            notes.left_out(format!("light {index}"), why);
        }
        planned.push(PlannedLight { term, contributes: absent.is_none() });
    }
    Ok(planned)
}

/// The items that the camera may see.
fn visible<'a>(items: &'a [Item], camera: &Viewer) -> Vec<&'a Item> {
    let clip_from_world = camera.clip_from_world();
    let seen =
        |item: &&Item| frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) != Overlap::Outside;
    items.iter().filter(seen).collect()
}

/// Why a light adds nothing to the picture, if so.
fn why_absent(view: &LightView<'_>, camera: &Viewer, visible: &[&Item]) -> Option<&'static str> {
    let source = view.light();
    if [source.ambient, source.diffuse, source.specular].iter().all(|color| *color == [0.0; 3]) {
        return Some("its colours are black");
    }
    if source.ambient != [0.0; 3] {
        return None; // ambient light is not bound by the cone
    }
    let Some(light_clip) = reach(source) else {
        return visible.is_empty().then_some("nothing that is seen is there for it to light");
    };
    let camera_clip = camera.clip_from_world();
    let corners = |clip: &DMat4| frustum::corners(&clip.inverse());
    if !frustum::may_meet(&light_clip, &corners(&light_clip), &camera_clip, &corners(&camera_clip)) {
        return Some("its cone and the camera's frustum do not meet");
    }
    let touched =
        |item: &&Item| frustum::overlap(&(light_clip * item.world_from_model), &item.bounds) != Overlap::Outside;
    if visible.iter().any(touched) { None } else { Some("its cone reaches nothing visible") }
}

/// `clip_from_world` of what the light can light: its cone's pyramid from its very position on. Its near plane bounds
/// casters and its far plane the map's depths; neither ends the light. `None`: nothing bounds it.
fn reach(source: &Light) -> Option<DMat4> {
    let frustum = source.frustum()?;
    let unbounded = Frustum { near: 1e-3 * frustum.near, far: 1e3 * frustum.far, ..frustum.clone() };
    Some(unbounded.clip_from_world())
}

fn color_and_depth(label: &str, size: [u32; 2], format: Format, list: &mut PassList) -> Target {
    let mut image =
        |label: String, format| list.image(ImageDesc { label, size, format, storage: Storage::Renderbuffer });
    Target {
        color: Some(image(label.to_owned(), format)),
        depth: Some(image(format!("{label} depth"), Format::Depth(DepthFormat::Depth24))),
    }
}

/// Adds passes that draw the scene's surfaces.
struct Builder<'a> {
    scene: &'a Scene,
    items: &'a [Item],
    list: &'a mut PassList,
}

/// Where surfaces are drawn, and for whom.
struct Onto<'a> {
    label: &'a str,
    target: Target,
    viewport: [u32; 2],
    viewer: &'a Viewer,
    background: [f32; 4],
}

impl Builder<'_> {
    /// The picture from the camera: the surfaces in the light of all that contribute, then the guides over them.
    fn camera_picture(&mut self, target: Target, camera: &Viewer, lights: &[PlannedLight]) -> Result<(), Error> {
        let contributing: Vec<LightTerm> =
            lights.iter().filter(|light| light.contributes).map(|light| light.term.clone()).collect();
        let (viewport, background) = (self.scene.image.size, self.background());
        let onto = Onto { label: "lit", target, viewport, viewer: camera, background };
        self.surfaces(&onto, &contributing, &Ending::Lit)?;
        if let Some(batch) = guides::frusta(self.scene, camera) {
            let (clear, state) = (Clear::default(), guides::STATE);
            self.push("guides", DrawPass { target, viewport, clear, state, batches: vec![batch] });
        }
        Ok(())
    }

    /// The picture as light `index` sees it.
    fn light_picture(&mut self, target: Target, index: usize) -> Result<(), Error> {
        let side = self.scene.image.size[0].min(self.scene.image.size[1]);
        self.seen_by_light("lit", target, 1 << side.max(1).ilog2(), index)
    }

    /// The scene as a light sees it, lit by it alone and unshadowed, in a square of `side` pixels.
    fn seen_by_light(&mut self, label: &str, target: Target, side: u32, index: usize) -> Result<(), Error> {
        let Some(source) = self.scene.lights.get(index) else {
            let view = format!("{}@{index}", View::LightView.name());
            return Err(Error::NoSuchLight { view, count: self.scene.lights.len() });
        };
        let Some(frustum) = source.frustum() else {
            let (view, why) = (View::LightView.name(), "has no one frustum to look through");
            return Err(Error::NoView { view, light: index, kind: source.kind.name(), why });
        };
        let viewer = Viewer { clip_from_eye: frustum.clip_from_view(), eye_from_world: frustum.view_from_world() };
        let term = LightTerm::new(self.scene, index, crate::pass::glsl!("light/unshadowed.frag"));
        let onto = Onto { label, target, viewport: [side; 2], viewer: &viewer, background: self.background() };
        self.surfaces(&onto, &[term], &Ending::Lit)
    }

    fn background(&self) -> [f32; 4] {
        let [r, g, b] = self.scene.image.background;
        [r, g, b, 1.0]
    }

    fn surfaces(&mut self, onto: &Onto<'_>, terms: &[LightTerm], ending: &Ending) -> Result<(), Error> {
        let batches = surface::batches(self.scene, self.items, onto.viewer, terms, ending, self.list);
        let batches = batches.ok_or_else(|| Self::singular(terms))?;
        let clear = Clear { color: Some(onto.background), depth: Some(1.0) };
        let Onto { target, viewport, .. } = *onto;
        self.push(onto.label, DrawPass { target, viewport, clear, state: DrawState::OPAQUE, batches });
        Ok(())
    }

    fn push(&mut self, label: &str, pass: DrawPass) {
        let label = label.to_owned();
        self.list.passes.push(Pass { label, redraw: Redraw::Always, work: Work::Draw(pass) });
    }

    fn singular(terms: &[LightTerm]) -> Error {
        let light = terms.first().map_or(0, |term| term.index);
        Error::Singular { light }
    }

    /// The image that a requested view ends in.
    fn view(
        &mut self,
        wanted: &ViewRequest,
        camera: &Viewer,
        terms: &[PlannedLight],
        picture: Target,
    ) -> Result<ImageId, Error> {
        let name = wanted.view.name();
        if wanted.view == View::Depth {
            return Ok(picture.depth.unwrap_or(ImageId(0)));
        }
        let Some(PlannedLight { term, .. }) = terms.get(wanted.light) else {
            return Err(Error::NoSuchLight { view: format!("{name}@{}", wanted.light), count: terms.len() });
        };
        if wanted.view.needs_map() && term.map.is_none() {
            let why = "its technique draws none, or no caster lies in its frustum";
            return Err(Error::NoMap { view: name, light: wanted.light, why });
        }
        if wanted.view == View::LightDistance && term.coordinates.is_none() {
            let (kind, why) = (self.scene.lights[wanted.light].kind.name(), "has no plane to measure distance from");
            return Err(Error::NoView { view: name, light: wanted.light, kind, why });
        }
        let label = format!("view: {name} of light {}", wanted.light);
        if wanted.view == View::LightView {
            return self.light_view(&label, wanted.light);
        }
        let Some((ending, term)) = views::camera_pass(wanted.view, term) else {
            return Ok(term.map.unwrap_or(ImageId(0)));
        };
        let target = color_and_depth(&label, self.scene.image.size, Format::Rgba32F, self.list);
        let viewport = self.scene.image.size;
        let onto = Onto { label: &label, target, viewport, viewer: camera, background: [0.0; 4] };
        self.surfaces(&onto, &[term], &ending)?;
        Ok(target.color.unwrap_or(ImageId(0)))
    }

    /// The scene as a light sees it, unshadowed, in the largest square that fits the picture.
    fn light_view(&mut self, label: &str, index: usize) -> Result<ImageId, Error> {
        let side = self.scene.image.size[0].min(self.scene.image.size[1]);
        let target = color_and_depth(label, [side; 2], Format::Rgba32F, self.list);
        self.seen_by_light(label, target, side, index)?;
        Ok(target.color.unwrap_or(ImageId(0)))
    }
}
