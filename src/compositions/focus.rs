//! Light through a lens, by accumulation [SEG, 3.2; Haeberli and Akeley 1990]: each lens point is a light of its own, with a
//! share of the light and, if it has a shadow, a map of its own. All of them are added up in an image of floats, on the
//! surfaces that the picture shows, and the sum is added to the picture. 8 bits would round each share.
//!
//! Lens points come one after the other: map, light, next map. So all maps are drawn into the same images, and memory does
//! not grow with the number of lens points.

use super::Error;
use super::passes::{Buffers, Passes};
use super::projection::CameraProjection;
use crate::lights::guard::Guard;
use crate::lights::light::{Addition, Gain};
use crate::lights::{Drawable, Ending, LightTerm};
use crate::math::frustum::{self, Overlap};
use crate::pass::{Batch, Blend, Clear, Compare, DrawPass, DrawState, Pass, Redraw, Stencil, StencilOp, StencilOps};

/// A light that comes through a lens.
#[derive(Clone, Debug)]
pub struct Focused {
    /// Index into [`crate::scene::Scene::lights`].
    pub index: usize,
    /// One for each lens point; two or more.
    pub points: Vec<LensPoint>,
}

/// Light from one point of a lens.
#[derive(Clone, Debug)]
pub struct LensPoint {
    /// The whole light's term, from this point.
    pub term: LightTerm,
    /// Passes that draw its map.
    pub passes: Vec<Pass>,
}

/// Number of lens points that are told apart by one bit each of the stencil buffer, from clear to clear.
const BITS: usize = 8;

/// Stencil state that draws each pixel once for lens point `number`: surfaces that coincide are lit once.
fn once(number: usize) -> Stencil {
    let bit = 1 << (number % BITS);
    let ops = StencilOps { pass: StencilOp::Replace, ..StencilOps::KEEP };
    Stencil { test: Compare::NotEqual, reference: 0xFF, read_mask: bit, write_mask: bit, front: ops, back: ops }
}

/// Label of a pass of lens point `number`, from 0.
pub fn label(pass: &str, number: usize, count: usize) -> String {
    format!("{pass}{MARK}{} of {count}", number + 1)
}

const MARK: &str = ", lens point ";

/// Tests whether something about a pass of this label is known from the first lens point's.
pub fn repeats(text: &str) -> bool {
    text.split_once(MARK).is_some_and(|(_, number)| !number.starts_with("1 "))
}

/// Checks that a light can be added lens point by lens point.
///
/// # Errors
///
/// A light that is counted in the stencil buffer or guarded by a clip plane; lighting per vertex.
pub fn check(light: &Focused, per_vertex: bool) -> Result<(), Error> {
    let index = light.index;
    if per_vertex {
        return Err(Error::FocusPerVertex { light: index });
    }
    let why = |point: &LensPoint| match (&point.term.counting, point.term.guard) {
        (Some(_), _) => Some("counts in the picture's stencil buffer"),
        (None, Guard::ClipPlane) => Some("changes depth values by clip planes"),
        _ => None,
    };
    light.points.iter().find_map(why).map_or(Ok(()), |why| Err(Error::FocusCounted { light: index, why }))
}

impl Passes<'_> {
    /// Adds the light of all lens points to the finished surfaces of the picture.
    ///
    /// # Errors
    ///
    /// A light whose transform has no inverse.
    pub fn focused(&mut self, buffers: Buffers, lens: &CameraProjection, lights: &[&Focused]) -> Result<(), Error> {
        let mut layer = None;
        // Passes that are drawn, of all lights.
        let mut drawn = 0;
        for light in lights {
            let items = self.within_reach(lens, light);
            let count = light.points.len();
            for (number, point) in light.points.iter().enumerate() {
                let batches = self.share_of_light(&items, lens, point, 1.0 / count as f32)?;
                if batches.is_empty() && !self.keep_all {
                    continue;
                }
                self.list.passes.extend(point.passes.iter().cloned());
                let layer = *layer.get_or_insert_with(|| self.layer("light through lenses"));
                let label = label(&format!("light {}: added", light.index), number, count);
                let clear = Clear {
                    color: (drawn == 0).then_some([0.0; 4]),
                    depth: None,
                    stencil: (drawn % BITS == 0).then_some(0),
                };
                let state = DrawState { stencil: Some(once(drawn)), blend: Some(Blend::Add), ..DrawState::REPEAT };
                let target = Buffers { color: layer, ..buffers }.target();
                let (viewport, state) = (self.scene.image.size, lens.of_surfaces(state));
                self.push(&label, Redraw::Always, DrawPass { target, viewport, clear, state, batches });
                drawn += 1;
            }
        }
        if let Some(layer) = layer {
            self.put_over(
                "light through lenses, added to the picture",
                layer,
                buffers,
                Blend::Add,
                "the sum of lens points",
            );
        }
        Ok(())
    }

    /// The surfaces that the light may reach from some lens point, as the picture draws them.
    fn within_reach(&mut self, lens: &CameraProjection, light: &Focused) -> Vec<Drawable> {
        let mut items = self.cut_items(lens).into_owned();
        let source = &self.scene.lights[light.index];
        // Ambient light is not bound by the frustum.
        let Some(spot) = source.spot().filter(|_| source.ambient == [0.0; 3] && !self.keep_all) else { return items };
        let reach = spot.reach().unbounded().clip_from_world();
        items.retain(|item| {
            let is_reached = frustum::overlap(&(reach * item.world_from_model), &item.bounds) != Overlap::Outside;
            if !is_reached {
                let why = "no lens point's frustum reaches it";
                self.notes.left_out(format!("{} in the passes that add light {}", item.label, light.index), why);
            }
            is_reached
        });
        items
    }

    /// The batches that add one lens point's share, without draws that the camera does not see.
    fn share_of_light(
        &mut self,
        items: &[Drawable],
        lens: &CameraProjection,
        point: &LensPoint,
        share: f32,
    ) -> Result<Vec<Batch>, Error> {
        let gain = Gain { ambient: share, diffuse: share, specular: share };
        let term = LightTerm { gain, addition: Addition::Light, ..point.term.clone() };
        let terms = std::slice::from_ref(&term);
        let batches =
            (self.surface)(self.scene, items, &lens.camera, terms, self.photos, &Ending::Lit, self.derived, self.list);
        let mut batches = batches.ok_or(Error::Singular { light: term.index })?;
        self.cut_at_far(lens, &mut batches);
        Ok(batches)
    }
}
