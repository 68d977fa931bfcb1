//! The pass list that compositions extend, and the passes that draw surfaces.

use std::borrow::Cow;
use std::collections::HashSet;

use super::Error;
use super::projection::CameraProjection;
use crate::geometry::Derived;
use crate::lights::cut::Cutter;
use crate::lights::photo::PhotoTerm;
use crate::lights::{Drawable, Ending, LightTerm, Notes, Viewer};
use crate::pass::{
    Batch, Chunk, Clear, DepthFormat, DrawPass, DrawState, FixedFunctionDesc, Format, ImageDesc, ImageId, Pass,
    PassList, Redraw, Storage, Target, Uniform, Work, glsl,
};
use crate::scene::{Normalize, Scene};

/// The batches that draw surfaces as a viewer sees them, lit by the terms or showing photographs. `None` where the transform
/// of a light or of a photograph has no inverse.
pub type Surfaces = fn(
    &Scene,
    &[Drawable],
    &Viewer,
    &[LightTerm],
    &[Option<PhotoTerm>],
    &Ending,
    &Derived,
    &mut PassList,
) -> Option<Vec<Batch>>;

/// Builder of a frame's passes.
pub struct Passes<'a> {
    pub scene: &'a Scene,
    pub items: &'a [Drawable],
    /// The scene's photographs by their numbers, those that are needed.
    pub photos: &'a [Option<PhotoTerm>],
    /// Facts that earlier plans found from meshes.
    pub derived: &'a Derived,
    /// Indices of objects whose surfaces volumes' caps meet: their meshes are not cut.
    pub kept: HashSet<usize>,
    /// True if volumes are counted in the picture.
    pub counted: bool,
    pub list: &'a mut PassList,
    pub notes: &'a mut Notes,
    /// Function that makes the batches of surfaces.
    pub surface: Surfaces,
    /// Frames to be drawn. Decides whether passes that keep their result are worth it.
    pub frames: u32,
    /// True if things that no picture can show are drawn, too.
    pub keep_all: bool,
    /// True if the picture's format clamps colours to [0, 1] after each pass.
    pub clamps: bool,
}

/// The images of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Buffers {
    pub color: ImageId,
    pub depth: ImageId,
}

impl Buffers {
    /// Both as the target of a pass.
    pub fn target(self) -> Target {
        Target { color: Some(self.color), depth: Some(self.depth), level: 0, face: None }
    }
}

/// Target, viewer and state of a pass that draws surfaces.
pub struct Onto<'a> {
    pub label: &'a str,
    pub target: Target,
    pub viewport: [u32; 2],
    pub lens: &'a CameraProjection,
    pub clear: Clear,
    pub state: DrawState,
}

impl Passes<'_> {
    /// Adds the images of a picture.
    pub fn color_and_depth(&mut self, label: &str, size: [u32; 2], format: Format, stencil: bool) -> Buffers {
        let depth = if stencil { Format::Depth24Stencil8 } else { Format::Depth(DepthFormat::Depth24) };
        let mut image =
            |label: String, format| self.list.image(ImageDesc { label, size, format, storage: Storage::Renderbuffer });
        Buffers { color: image(label.to_owned(), format), depth: image(format!("{label} depth"), depth) }
    }

    /// Tests whether surfaces may look up a photograph.
    pub fn has_photos(&self) -> bool {
        self.photos.iter().any(Option::is_some)
    }

    /// The scene's background colour.
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

    /// Draws the surfaces in the light of `terms`.
    ///
    /// # Errors
    ///
    /// A light whose transform has no inverse.
    pub fn surfaces(&mut self, onto: &Onto<'_>, terms: &[LightTerm], ending: &Ending) -> Result<(), Error> {
        self.surfaces_if(Redraw::Always, onto, terms, ending)
    }

    /// The same, redrawn as `redraw` says.
    ///
    /// # Errors
    ///
    /// As [`Passes::surfaces`].
    pub fn surfaces_if(
        &mut self,
        redraw: Redraw,
        onto: &Onto<'_>,
        terms: &[LightTerm],
        ending: &Ending,
    ) -> Result<(), Error> {
        let items = self.cut_items(onto.lens);
        self.surfaces_of(&items, redraw, onto, terms, ending)
    }

    /// The same with `items` alone, which are the scene's or cut from them.
    ///
    /// # Errors
    ///
    /// As [`Passes::surfaces`].
    pub fn surfaces_of(
        &mut self,
        items: &[Drawable],
        redraw: Redraw,
        onto: &Onto<'_>,
        terms: &[LightTerm],
        ending: &Ending,
    ) -> Result<(), Error> {
        let batches =
            (self.surface)(self.scene, items, &onto.lens.camera, terms, self.photos, ending, self.derived, self.list);
        let mut batches = batches.ok_or_else(|| Self::singular(terms))?;
        self.cut_at_far(onto.lens, &mut batches);
        let Onto { target, viewport, clear, mut state, .. } = *onto;
        state.seamless = !self.keeps_seams(&batches);
        self.push(onto.label, redraw, DrawPass { target, viewport, clear, state, batches });
        Ok(())
    }

    /// Discards fragments beyond the scene's far plane if nothing else clips there and something reaches beyond.
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

    /// Adds a pass.
    pub fn push(&mut self, label: &str, redraw: Redraw, mut pass: DrawPass) {
        CameraProjection::adapt(&pass.state, &mut pass.batches);
        self.list.passes.push(Pass { label: label.to_owned(), redraw, work: Work::Draw(pass) });
    }

    /// Tests whether batches look vectors up whose cube map is to show its seams.
    fn keeps_seams(&self, batches: &[Batch]) -> bool {
        let seams = matches!(self.scene.shading.bumps.normalize, Normalize::Cube { seamless: false, .. });
        let is_of_vectors = |image: ImageId| matches!(self.list.desc(image).storage, Storage::UnitVectors);
        seams && batches.iter().flat_map(|batch| &batch.inputs).any(|input| is_of_vectors(input.image))
    }

    fn singular(terms: &[LightTerm]) -> Error {
        Error::Singular { light: terms.first().map_or(0, |term| term.index) }
    }
}

impl<'a> Passes<'a> {
    /// The items as every pass before this lens draws them.
    pub fn cut_items(&self, lens: &CameraProjection) -> Cow<'a, [Drawable]> {
        let cutter = Cutter::for_eye(self.scene, &lens.camera, self.counted, self.derived);
        cutter.map_or(Cow::Borrowed(self.items), |cutter| cutter.cut_all(self.items, &self.kept))
    }
}
