//! Lights in groups that one pass can hold. The first group is drawn as a picture of its own; each further one is added to
//! it, with depth EQUAL [LEC, "Advice for Shadowed Illumination Model"].

use super::Error;
use super::once::ONCE;
use super::passes::{Onto, Passes};
use crate::lights::guard::Guard;
use crate::lights::light::Addition;
use crate::lights::{Ending, LightTerm};
use crate::pass::{Blend, Clear, DrawState};
use crate::scene::{BumpMethod, Scene};

/// Greatest number of lights in one pass: each has four components of texture coordinates, of the 60 that every driver
/// passes from stage to stage [GL 3.3, table 6.40].
const MOST_LIGHTS: usize = 8;

/// Greatest number of textures of the lights in one pass: a fragment shader has at least 16 [GL 3.3, table 6.43], of which
/// the surface takes up to two.
const MOST_TEXTURES: usize = 14;

/// Textures that a surface with a photograph takes beside: the photograph and its depth map.
const TEXTURES_OF_PHOTO: usize = 2;

/// Textures that a bump-mapped surface takes beside: the normal map, the gloss and the cube map that normalises.
const TEXTURES_OF_BUMPS: usize = 3;

/// Room of one pass for lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    lights: usize,
    textures: usize,
}

impl Room {
    /// The room beside the surfaces of a scene. Register combiners light bumps by one light at a time.
    pub fn of(scene: &Scene) -> Self {
        let has_bumps = has_bumps(scene);
        let combined = has_bumps && scene.shading.bumps.method != BumpMethod::Reference;
        let photos = if scene.photos().is_empty() { 0 } else { TEXTURES_OF_PHOTO };
        let bumps = if has_bumps { TEXTURES_OF_BUMPS } else { 0 };
        Self { lights: if combined { 1 } else { MOST_LIGHTS }, textures: MOST_TEXTURES - photos - bumps }
    }
}

/// Tests whether any object is bump-mapped.
pub fn has_bumps(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| object.bases.is_some() && object.lit)
}

/// Tests whether bumps are lit in three passes.
pub fn three_passes(scene: &Scene) -> bool {
    matches!(scene.shading.bumps.method, BumpMethod::ThreePass { .. }) && has_bumps(scene)
}

/// Number of textures that a light takes in the lit pass.
fn textures(term: &LightTerm) -> usize {
    let projected = term.source.spot().map_or(0, |spot| {
        let (image, beam, falloff) = (spot.plain_image().is_some(), spot.beam.is_some(), spot.falloff.is_some());
        usize::from(image) + usize::from(beam) + usize::from(falloff)
    });
    term.shade.inputs.len() + projected + usize::from(term.guard == Guard::Texture1d)
}

/// Number of lights in each group, in order. One group, which may be empty, at least.
pub fn sizes<'t>(terms: impl IntoIterator<Item = &'t LightTerm>, room: Room) -> Vec<usize> {
    let mut sizes = vec![0];
    let (mut size, mut taken) = (0, 0);
    for term in terms {
        let wanted = textures(term);
        if size == room.lights || (size > 0 && taken + wanted > room.textures) {
            sizes.push(0);
            (size, taken) = (0, 0);
        }
        (size, taken) = (size + 1, taken + wanted);
        if let Some(last) = sizes.last_mut() {
            *last = size;
        }
    }
    sizes
}

/// Checks that lights whose passes add up leave depths alone.
///
/// # Errors
///
/// A light that is guarded by a clip plane, beside more lights than one pass holds.
pub fn check(scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error> {
    let groups = sizes(terms.iter().copied(), Room::of(scene)).len();
    let cutting = terms.iter().find(|term| groups > 1 && term.guard == Guard::ClipPlane);
    cutting.map_or(Ok(()), |term| Err(Error::CutGroups { light: term.index, lights: terms.len() }))
}

impl Passes<'_> {
    /// Draws the surfaces in the light of `terms`, in as many passes as they need. `once`: the target has a
    /// stencil buffer that nothing needs afterwards.
    ///
    /// # Errors
    ///
    /// A light whose transform has no inverse.
    pub fn lit(&mut self, onto: &Onto<'_>, terms: &[LightTerm], once: bool) -> Result<(), Error> {
        self.lit_part(onto, terms, once, &Ending::Lit)
    }

    /// The same of a part of the illumination formula.
    ///
    /// # Errors
    ///
    /// A light whose transform has no inverse.
    pub fn lit_part(&mut self, onto: &Onto<'_>, terms: &[LightTerm], once: bool, ending: &Ending) -> Result<(), Error> {
        let room = Room::of(self.scene);
        let sizes = sizes(terms, room);
        let (first, mut rest) = terms.split_at(sizes[0]);
        self.surfaces(onto, first, ending)?;
        if rest.is_empty() {
            return Ok(());
        }
        let why = match room.lights {
            1 => String::from(
                "register combiners light bumps by one light at a time; further lights are added with depth EQUAL",
            ),
            _ => format!(
                "one pass holds {} lights and {} textures of theirs; further lights are added with depth EQUAL",
                room.lights, room.textures
            ),
        };
        self.notes.chosen(onto.label, format!("{} passes for {} lights", sizes.len(), terms.len()), why);
        let stencil = if once { Some(ONCE) } else { onto.state.stencil };
        let state = onto.lens.of_surfaces(DrawState { stencil, blend: Some(Blend::Add), ..DrawState::REPEAT });
        for size in &sizes[1..] {
            let (group, after) = rest.split_at(*size);
            rest = after;
            let numbers: Vec<String> = group.iter().map(|term| term.index.to_string()).collect();
            let label = format!("{}: lights {}", onto.label, numbers.join(", "));
            let group: Vec<LightTerm> =
                group.iter().map(|term| LightTerm { addition: Addition::Light, ..term.clone() }).collect();
            let clear = Clear { stencil: once.then_some(0), ..Clear::default() };
            self.surfaces(&Onto { label: &label, clear, state, ..*onto }, &group, ending)?;
        }
        Ok(())
    }
}
