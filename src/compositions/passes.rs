//! Adds the passes that draw a scene's surfaces: the picture and the views beside it.
//!
//! Lights whose shade a shader finds are lit in one pass. Where a light's shadow is counted in the stencil buffer
//! (`stencil_counted`), that pass gives depth and what needs no count, and each such light is added after its count (C9).

use std::borrow::Cow;

use super::projection::CameraProjection;
use crate::lights::cut::Cutter;
use crate::lights::guard::Guard;
use crate::lights::{Drawable, Ending, LightTerm, Notes, Viewer};
use crate::pass::{
    Batch, Chunk, Clear, DepthFormat, DrawPass, DrawState, FixedFunctionDesc, Format, ImageDesc, ImageId, Pass,
    PassList, Redraw, Storage, Target, Uniform, Work, glsl,
};
use crate::plan::compose::PlannedLight;
use crate::plan::{Error, Request, ViewRequest};
use crate::scene::{LightKind, Scene};
use crate::surfaces;
use crate::views::{self, View, frustum_lines};

pub struct Builder<'a> {
    pub scene: &'a Scene,
    pub items: &'a [Drawable],
    /// Objects whose meshes volumes' caps meet, into the scene's: they are drawn as they are.
    pub kept: Vec<usize>,
    /// Volumes are counted in the picture.
    pub counted: bool,
    pub list: &'a mut PassList,
    pub notes: &'a mut Notes,
    pub request: &'a Request,
}

/// Where surfaces are drawn, for whom, and how.
pub struct Onto<'a> {
    pub label: &'a str,
    pub target: Target,
    pub viewport: [u32; 2],
    pub lens: &'a CameraProjection,
    pub clear: Clear,
    pub state: DrawState,
}

impl Builder<'_> {
    /// The picture from the camera: the surfaces in the light of all that contribute, then the guides over them.
    pub fn camera_picture(&mut self, lights: &[PlannedLight]) -> Result<Target, Error> {
        let terms: Vec<&LightTerm> = lights.iter().filter(|l| l.contributes).map(|l| &l.term).collect();
        let counts = terms.iter().filter_map(|term| term.counting.as_ref());
        let lens = CameraProjection::for_counts(self.scene, counts.clone());
        check_cuts(&terms)?;
        check_ledges(&terms)?;
        surfaces::explain_guards(self.scene, &self.cut_items(&lens), &lens.camera, &terms, self.notes);
        let target = self.picture_target(counts.clone().next().is_some());
        if counts.clone().next().is_some() {
            self.counted_picture(target, &lens, &terms)?;
        } else {
            self.notes.left_out("stencil buffer", "no technique of this scene counts in it");
            let terms: Vec<LightTerm> = terms.into_iter().cloned().collect();
            self.surfaces(self.scene, &self.first("lit", target, &lens, self.background()), &terms, &Ending::Lit)?;
        }
        if let Some(batch) = frustum_lines::frusta(self.scene, &lens.camera) {
            let state = lens.of_surfaces(frustum_lines::STATE);
            let (viewport, clear) = (self.scene.image.size, Clear::default());
            self.push("guides", Redraw::Always, DrawPass { target, viewport, clear, state, batches: vec![batch] });
        }
        Ok(target)
    }

    /// The picture as light `index` sees it.
    pub fn light_picture(&mut self, index: usize) -> Result<Target, Error> {
        let target = self.picture_target(false);
        let side = self.scene.image.size[0].min(self.scene.image.size[1]);
        self.seen_by_light("lit", target, 1 << side.max(1).ilog2(), index)?;
        Ok(target)
    }

    fn picture_target(&mut self, counts: bool) -> Target {
        let format = if self.request.float_picture { Format::Rgba32F } else { Format::Rgba8 };
        self.color_and_depth("picture", self.scene.image.size, format, counts)
    }

    pub fn color_and_depth(&mut self, label: &str, size: [u32; 2], format: Format, stencil: bool) -> Target {
        let depth = if stencil { Format::Depth24Stencil8 } else { Format::Depth(DepthFormat::Depth24) };
        let mut image =
            |label: String, format| self.list.image(ImageDesc { label, size, format, storage: Storage::Renderbuffer });
        Target {
            color: Some(image(label.to_owned(), format)),
            depth: Some(image(format!("{label} depth"), depth)),
            level: 0,
            face: None,
        }
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
        let lens = CameraProjection::of_viewer(viewer);
        let term = LightTerm::unshadowed(self.scene, index);
        let onto = Onto { viewport: [side; 2], ..self.first(label, target, &lens, self.background()) };
        self.surfaces(self.scene, &onto, &[term], &Ending::Lit)
    }

    pub fn background(&self) -> [f32; 4] {
        let [r, g, b] = self.scene.image.background;
        [r, g, b, 1.0]
    }

    /// The first pass into a target, which it clears.
    pub fn first<'b>(
        &self,
        label: &'b str,
        target: Target,
        lens: &'b CameraProjection,
        background: [f32; 4],
    ) -> Onto<'b> {
        Onto {
            label,
            target,
            viewport: self.scene.image.size,
            lens,
            clear: Clear { color: Some(background), depth: Some(1.0), stencil: None },
            state: lens.of_surfaces(DrawState::OPAQUE),
        }
    }

    pub fn surfaces(
        &mut self,
        scene: &Scene,
        onto: &Onto<'_>,
        terms: &[LightTerm],
        ending: &Ending,
    ) -> Result<(), Error> {
        self.surfaces_if(Redraw::Always, scene, onto, terms, ending)
    }

    pub fn surfaces_if(
        &mut self,
        redraw: Redraw,
        scene: &Scene,
        onto: &Onto<'_>,
        terms: &[LightTerm],
        ending: &Ending,
    ) -> Result<(), Error> {
        let items = self.cut_items(onto.lens);
        let batches = surfaces::batches(scene, &items, &onto.lens.camera, terms, ending, self.list);
        let mut batches = batches.ok_or_else(|| Self::singular(terms))?;
        self.cut_at_far(onto.lens, &mut batches);
        let Onto { target, viewport, clear, state, .. } = *onto;
        self.push(onto.label, redraw, DrawPass { target, viewport, clear, state, batches });
        Ok(())
    }

    /// Where nothing clips at the scene's far plane and something reaches beyond it, fragments there are discarded.
    pub fn cut_at_far(&self, lens: &CameraProjection, batches: &mut [Batch]) {
        let camera = &self.scene.camera;
        let reaches_beyond = |item: &Drawable| {
            let eye_from_model = lens.camera.eye_from_world * item.world_from_model;
            item.bounds.corners().iter().any(|corner| -eye_from_model.transform_point3(*corner).z > 0.999 * camera.far)
        };
        if !lens.has_no_far_plane() || !self.items.iter().any(reaches_beyond) {
            return;
        }
        let rename = Chunk { name: "main, renamed".into(), text: "#define main main_before_far\n".into() };
        for batch in batches {
            batch.program.fragment.insert(0, rename.clone());
            batch.program.fragment.push(glsl!("common/before_far.frag"));
            batch.uniforms.push(Uniform::new("view_far", camera.far as f32));
            batch.meaning = FixedFunctionDesc::Shader("a far plane that cuts fragments where the projection has none");
        }
    }

    pub fn push(&mut self, label: &str, redraw: Redraw, mut pass: DrawPass) {
        CameraProjection::adapt(&pass.state, &mut pass.batches);
        self.list.passes.push(Pass { label: label.to_owned(), redraw, work: Work::Draw(pass) });
    }

    fn singular(terms: &[LightTerm]) -> Error {
        Error::Singular { light: terms.first().map_or(0, |term| term.index) }
    }

    /// The image that a requested view ends in.
    pub fn view(&mut self, wanted: &ViewRequest, lights: &[PlannedLight], picture: Target) -> Result<ImageId, Error> {
        let name = wanted.view.name();
        if wanted.view == View::Depth {
            return Ok(picture.depth.unwrap_or(ImageId(0)));
        }
        let Some(PlannedLight { term, .. }) = lights.get(wanted.light) else {
            return Err(Error::NoSuchLight { view: format!("{name}@{}", wanted.light), count: lights.len() });
        };
        if wanted.view.needs_map() && term.map.is_none() {
            let why = "its technique draws none, or no caster lies in its frustum";
            return Err(Error::NoMap { view: name, light: wanted.light, why });
        }
        let kind = &self.scene.lights[wanted.light].kind;
        let why = match (wanted.view, kind) {
            (View::LightDistance, LightKind::Point(_)) => Some("has no plane to measure distance from"),
            (View::LightDistance, _) if term.coordinates.is_none() => Some("draws no map to measure distance from"),
            (View::ProjectedMap, LightKind::Point(_)) => Some("looks its map up by direction, not by projection"),
            _ => None,
        };
        if let Some(why) = why {
            return Err(Error::NoView { view: name, light: wanted.light, kind: kind.name(), why });
        }
        let label = format!("view: {name} of light {}", wanted.light);
        if wanted.view == View::LightView {
            return self.light_view(&label, wanted.light);
        }
        if let Some(counting) = &term.counting
            && wanted.view.depends_on_shade()
        {
            return self.counted_view(wanted.view, &label, term, counting);
        }
        if wanted.view.needs_count() {
            return Err(Error::NoCount { view: name, light: wanted.light });
        }
        let Some((ending, term)) = views::camera_pass(wanted.view, term) else {
            return Ok(term.map.unwrap_or(ImageId(0)));
        };
        let lens = CameraProjection::of_scene(self.scene);
        let target = self.color_and_depth(&label, self.scene.image.size, Format::Rgba32F, false);
        self.surfaces(self.scene, &self.first(&label, target, &lens, [0.0; 4]), &[term], &ending)?;
        Ok(target.color.unwrap_or(ImageId(0)))
    }

    /// The scene as a light sees it, unshadowed, in the largest square that fits the picture.
    fn light_view(&mut self, label: &str, index: usize) -> Result<ImageId, Error> {
        let side = self.scene.image.size[0].min(self.scene.image.size[1]);
        let target = self.color_and_depth(label, [side; 2], Format::Rgba32F, false);
        self.seen_by_light(label, target, side, index)?;
        Ok(target.color.unwrap_or(ImageId(0)))
    }
}

impl<'a> Builder<'a> {
    /// The items as every pass before this lens draws them.
    pub fn cut_items(&self, lens: &CameraProjection) -> Cow<'a, [Drawable]> {
        let cutter = Cutter::for_eye(self.scene, &lens.camera, self.counted);
        cutter.map_or(Cow::Borrowed(self.items), |cutter| cutter.cut_all(self.items, &self.kept))
    }
}

/// Volumes of several lights are counted in one depth buffer, before one ledge.
fn check_ledges(terms: &[&LightTerm]) -> Result<(), Error> {
    let ledge =
        |term: &&LightTerm| term.counting.as_ref().and_then(|counting| counting.ledge).map(|ledge| (term.index, ledge));
    let mut ledges = terms.iter().filter_map(ledge);
    let Some((first, depths)) = ledges.next() else { return Ok(()) };
    let other = ledges.find(|(_, other)| *other != depths);
    other.map_or(Ok(()), |(second, _)| Err(Error::TwoLedges { first, second }))
}

/// What clip planes at lights do not go with: more of them than a few, and passes that must meet the depths again.
fn check_cuts(terms: &[&LightTerm]) -> Result<(), Error> {
    let cutting: Vec<usize> =
        terms.iter().filter(|term| term.guard == Guard::ClipPlane).map(|term| term.index).collect();
    if cutting.len() > surfaces::MOST_CLIP_PLANES {
        return Err(Error::TooManyCuts { lights: cutting, most: surfaces::MOST_CLIP_PLANES });
    }
    let counted = terms.iter().find(|term| term.counting.is_some());
    match (cutting.first(), counted) {
        (Some(light), Some(counted)) => Err(Error::CutDepths { light: *light, counted: counted.index }),
        _ => Ok(()),
    }
}
