//! The pictures of a frame: the camera's or a light's, and the views beside it. The passes in which light becomes a picture
//! are left to the table of [compositions].

use super::{Error, Request, ViewRequest};
use crate::compositions;
use crate::compositions::focus::{self, Focused};
use crate::compositions::passes::{Buffers, Onto, Passes};
use crate::compositions::projection::CameraProjection;
use crate::lights::guard::Guard;
use crate::lights::{Ending, LightTerm, Viewer};
use crate::pass::{Clear, DrawPass, Format, ImageId, Redraw};
use crate::scene::BumpMethod;
use crate::scene::LightKind;
use crate::surfaces;
use crate::views::{self, View, frustum_lines};

/// A light's term, and whether the picture needs it.
pub struct PlannedLight {
    /// `None`: neither the picture nor a view needs the light, which is not described then.
    pub term: Option<LightTerm>,
    pub contributes: bool,
    /// The light through its lens, which the picture needs in place of the term.
    pub focused: Option<Focused>,
}

impl PlannedLight {
    /// The light's term, or that of its first lens point.
    pub fn described(&self) -> Option<&LightTerm> {
        self.term.as_ref().or_else(|| Some(&self.focused.as_ref()?.points.first()?.term))
    }
}

/// The passes of a frame's pictures.
pub struct Pictures<'a> {
    pub passes: Passes<'a>,
    pub request: &'a Request,
}

impl Pictures<'_> {
    /// The picture from the camera: the surfaces in the light of all that contribute, then the frusta's lines over them.
    pub fn of_camera(&mut self, lights: &[PlannedLight]) -> Result<Buffers, Error> {
        let terms: Vec<&LightTerm> = lights.iter().filter(|l| l.contributes).filter_map(|l| l.term.as_ref()).collect();
        let counts = terms.iter().filter_map(|term| term.counting.as_ref());
        let lens = CameraProjection::for_counts(self.passes.scene, counts);
        let composition = compositions::chosen(self.passes.scene, &terms)?;
        check_cuts(&terms)?;
        composition.check(self.passes.scene, &terms)?;
        let focused: Vec<&Focused> = lights.iter().filter_map(|light| light.focused.as_ref()).collect();
        focused.iter().try_for_each(|light| focus::check(light, self.passes.scene.shading.per_vertex))?;
        let items = self.passes.cut_items(&lens);
        // A lens point's guards are explained by the first.
        let first = focused.iter().filter_map(|light| Some(&light.points.first()?.term));
        let explained: Vec<&LightTerm> = terms.iter().copied().chain(first).collect();
        surfaces::explain_guards(&items, &lens.camera, &explained, self.passes.derived, self.passes.notes);
        let stencil = composition.needs_stencil(&self.passes, &terms);
        let buffers = self.buffers(stencil || !focused.is_empty());
        let target = buffers.target();
        composition.picture(&mut self.passes, target, &lens, &terms)?;
        self.passes.focused(buffers, &lens, &focused)?;
        self.passes.dust(buffers, &lens, &terms)?;
        if let Some(batch) = frustum_lines::guides(self.passes.scene, self.request.wire, &lens.camera) {
            let state = lens.of_surfaces(frustum_lines::STATE);
            let (viewport, clear) = (self.passes.scene.image.size, Clear::default());
            let pass = DrawPass { target, viewport, clear, state, batches: vec![batch] };
            self.passes.push("guides", Redraw::Always, pass);
        }
        Ok(buffers)
    }

    /// The picture as light `index` sees it.
    pub fn of_light(&mut self, index: usize) -> Result<Buffers, Error> {
        let buffers = self.buffers(false);
        let side = self.passes.scene.image.size[0].min(self.passes.scene.image.size[1]);
        self.seen_by_light("lit", buffers, 1 << side.max(1).ilog2(), index)?;
        Ok(buffers)
    }

    fn buffers(&mut self, stencil: bool) -> Buffers {
        let format = if self.request.float_picture { Format::Rgba32F } else { Format::Rgba8 };
        self.passes.color_and_depth("picture", self.passes.scene.image.size, format, stencil)
    }

    /// The scene as a light sees it, lit by it alone and unshadowed, in a square of `side` pixels.
    fn seen_by_light(&mut self, label: &str, buffers: Buffers, side: u32, index: usize) -> Result<(), Error> {
        let scene = self.passes.scene;
        let Some(source) = scene.lights.get(index) else {
            let view = format!("{}@{index}", View::LightView.name());
            return Err(Error::NoSuchLight { view, count: scene.lights.len() });
        };
        let Some(frustum) = source.frustum() else {
            let (view, why) = (View::LightView.name(), "has no one frustum to look through");
            return Err(Error::NoView { view, light: index, kind: source.kind.name(), why });
        };
        let viewer = Viewer { clip_from_eye: frustum.clip_from_view(), eye_from_world: frustum.view_from_world() };
        let lens = CameraProjection::of_viewer(viewer);
        let term = LightTerm::unshadowed(source, index);
        let first = self.passes.first(label, buffers.target(), &lens, self.passes.background());
        let onto = Onto { viewport: [side; 2], ..first };
        Ok(self.passes.surfaces(&onto, &[term], &Ending::Lit)?)
    }

    /// The image that a requested view ends in.
    pub fn view(&mut self, wanted: &ViewRequest, lights: &[PlannedLight], picture: Buffers) -> Result<ImageId, Error> {
        let (view, name) = (wanted.view, wanted.view.name());
        if view == View::Depth {
            return Ok(picture.depth);
        }
        if let Some(ending) = views::surface_pass(view) {
            let label = format!("view: {name}");
            return self.drawn_view(&label, &[], &ending);
        }
        // A light that a view shows is described.
        let Some(term) = lights.get(wanted.light).and_then(|light| light.term.as_ref()) else {
            return Err(Error::NoSuchLight { view: format!("{name}@{}", wanted.light), count: lights.len() });
        };
        if view.needs_map() && term.map.is_none() {
            let why = "its technique draws none, or no caster lies in its frustum";
            return Err(Error::NoMap { view: name, light: wanted.light, why });
        }
        let kind = &self.passes.scene.lights[wanted.light].kind;
        let why = match (view, kind) {
            (View::LightDistance, LightKind::Point(_)) => Some("has no plane to measure distance from"),
            (View::LightDistance, _) if term.coordinates.is_none() => Some("draws no map to measure distance from"),
            (View::ProjectedMap, LightKind::Point(_)) => Some("looks its map up by direction, not by projection"),
            _ => None,
        };
        if let Some(why) = why {
            return Err(Error::NoView { view: name, light: wanted.light, kind: kind.name(), why });
        }
        if let (View::LightDepth, Some(map)) = (view, term.map) {
            return Ok(map);
        }
        let label = format!("view: {name} of light {}", wanted.light);
        if view == View::LightView {
            return self.light_view(&label, wanted.light);
        }
        if view.depends_on_shade()
            && let Some(image) =
                compositions::chosen(self.passes.scene, &[term])?.view(&mut self.passes, view, &label, term)?
        {
            return Ok(image);
        }
        let three_passes = matches!(self.passes.scene.shading.bumps.method, BumpMethod::ThreePass { .. });
        let Some((ending, term)) = views::camera_pass(view, term, three_passes) else {
            return Err(compositions::Error::NoCount { view: name, light: wanted.light }.into());
        };
        self.drawn_view(&label, &[term], &ending)
    }

    /// One pass of the surfaces, as floats.
    fn drawn_view(&mut self, label: &str, terms: &[LightTerm], ending: &Ending) -> Result<ImageId, Error> {
        let scene = self.passes.scene;
        let lens = CameraProjection::of_scene(scene);
        let buffers = self.passes.color_and_depth(label, scene.image.size, Format::Rgba32F, false);
        let onto = self.passes.first(label, buffers.target(), &lens, [0.0; 4]);
        self.passes.surfaces(&onto, terms, ending)?;
        Ok(buffers.color)
    }

    /// The scene as a light sees it, unshadowed, in the largest square that fits the picture.
    fn light_view(&mut self, label: &str, index: usize) -> Result<ImageId, Error> {
        let side = self.passes.scene.image.size[0].min(self.passes.scene.image.size[1]);
        let buffers = self.passes.color_and_depth(label, [side; 2], Format::Rgba32F, false);
        self.seen_by_light(label, buffers, side, index)?;
        Ok(buffers.color)
    }
}

/// Checks that no more lights cut surfaces at clip planes than there are planes.
fn check_cuts(terms: &[&LightTerm]) -> Result<(), Error> {
    let cutting: Vec<usize> =
        terms.iter().filter(|term| term.guard == Guard::ClipPlane).map(|term| term.index).collect();
    match cutting.len() > surfaces::MOST_CLIP_PLANES {
        true => Err(Error::TooManyCuts { lights: cutting, most: surfaces::MOST_CLIP_PLANES }),
        false => Ok(()),
    }
}
