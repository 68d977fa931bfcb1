//! A photograph that is projected back onto a surface [Segal 1992, 3.1]: it decides the surface's colour where it shows it.
//! Knows photographs and variants; no light.

use super::lights::{image_sampler, texgen_parts};
use super::variant::{EYE_POSITION, EYE_SPACE, Variant};
use crate::lights::drawable::upload;
use crate::lights::guard::{Guard, LightPlane, Side};
use crate::lights::light::ShadeSource;
use crate::lights::photo::PhotoTerm;
use crate::lights::{Drawable, Ending, LightTerm, Viewer};
use crate::math::texgen;
use crate::pass::{Chunk, Define, FixedFunctionDesc, Input, PassList, Uniform, glsl};
use crate::scene::{Hidden, ImageFilter};

/// Parts of one photograph in an item's variant.
pub struct PhotoParts {
    /// True if no part of the item shows its own colour.
    pub covers: bool,
    /// True if it is looked up on the side alone that faces its eye.
    faces: bool,
    defines: Vec<Define>,
    vertex: Option<Chunk>,
    fragment: Vec<Chunk>,
    uniforms: Vec<Uniform>,
    inputs: Vec<Input>,
}

/// Part of a photograph that a pass needs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// Its colour.
    Color,
    /// The points that it decides.
    Place,
}

/// The photograph of `item` in a pass; `adds`: the pass adds light to a picture that has the photograph already. `Some(None)`:
/// it decides no part of the item. `None` where the transform to the photograph has no inverse.
pub fn parts(
    photos: &[Option<PhotoTerm>],
    item: &Drawable,
    viewer: &Viewer,
    ending: &Ending,
    adds: bool,
    list: &mut PassList,
) -> Option<Option<PhotoParts>> {
    let Some(PhotoTerm { term, hidden }) = item.photo.and_then(|photo| photos.get(photo)?.as_ref()) else {
        return Some(None);
    };
    let wanted = match ending {
        Ending::Lit if adds => Wanted::Place,
        // Passes that put the formula together take no photographs.
        Ending::Part(_) | Ending::Surface { .. } | Ending::TangentVector { .. } => return Some(None),
        Ending::Lit => Wanted::Color,
        Ending::Factors(factors) if factors.color => Wanted::Color,
        Ending::Factors(_) => Wanted::Place,
        Ending::Alpha(_) | Ending::View { .. } | Ending::Slice { .. } => return Some(None),
    };
    let plane = LightPlane::of(term.coordinates.as_ref(), true, viewer)?;
    let side = if term.guard == Guard::Fragment { Side::Across } else { plane.side(item, viewer) };
    let covers = *hidden == Hidden::Grey || (*hidden == Hidden::Smear && side == Side::Before);
    if side == Side::Behind && !covers {
        return Some(None);
    }
    let mut parts = PhotoParts {
        covers,
        faces: false,
        defines: Vec::new(),
        vertex: None,
        fragment: Vec::new(),
        uniforms: Vec::new(),
        inputs: Vec::new(),
    };
    let flag = |name| Define::flag(name).of_light(term.index);
    // PHOTO_GREY sets photo to grey, with alpha 1: what is hidden, or, in a pass that needs no colour, the whole item.
    if covers && (*hidden == Hidden::Grey || wanted == Wanted::Place) {
        parts.defines.push(flag("PHOTO_GREY"));
    }
    if side != Side::Behind && (wanted == Wanted::Color || !covers) {
        parts.look_up(term, *hidden, side, wanted, viewer, list)?;
        if *hidden != Hidden::Smear && item.casts_shadow {
            parts.face(term, viewer);
        }
    }
    if adds {
        parts.defines.push(Define::flag("PHOTO_THERE"));
    }
    let at = if parts.faces { "at" } else { "vec3(0.0)" };
    let call = format!("photograph_{}(photo, {at});", term.index);
    parts.defines.push(Define::calls("PHOTOGRAPH", "photo, at", call));
    parts.fragment.push(glsl!("surfaces/photo.frag").for_light(term.index));
    Some(Some(parts))
}

impl PhotoParts {
    /// Adds the lookup of the photograph, or of its depth map alone.
    fn look_up(
        &mut self,
        term: &LightTerm,
        hidden: Hidden,
        side: Side,
        wanted: Wanted,
        viewer: &Viewer,
        list: &mut PassList,
    ) -> Option<()> {
        let index = term.index;
        let coordinates = term.coordinates.as_ref()?;
        let spaces = coordinates.spaces(viewer.eye_from_world);
        let generated = texgen::set_up(&spaces, coordinates.set_up, coordinates.split)?;
        let (defines, uniforms) = texgen_parts(index, &generated);
        self.defines.extend(defines);
        self.uniforms.extend(uniforms);
        self.vertex = Some(glsl!("surfaces/texgen.vert").for_light(index));
        self.defines.push(Define::calls("PHOTO_TEXGEN", "eye", format!("texgen_{index}(eye);")));
        self.fragment.extend([glsl!("surfaces/texgen.frag"), glsl!("surfaces/reach.frag")]);
        let mut flags = vec!["PHOTO_LOOKED_UP"];
        if side == Side::Before {
            flags.push("UNGUARDED");
        }
        if let Some(frustum_from_map) = term.frustum_from_map {
            flags.push("MAP_ADDRESSING");
            self.uniforms.push(Uniform::of_light("frustum_from_map", index, frustum_from_map));
        }
        if hidden == Hidden::Smear {
            flags.push("PHOTO_SMEARED");
        } else {
            let ShadeSource { chunks, defines, uniforms, inputs, .. } = term.shade.clone();
            self.fragment.extend(chunks);
            self.defines.extend(defines);
            self.uniforms.extend(uniforms);
            self.inputs.extend(inputs);
        }
        let spot = term.source.spot()?;
        if let Some(image) = spot.image.as_ref().filter(|_| wanted == Wanted::Color) {
            flags.extend(["PHOTO_COLOR", "SPOT_IMAGE"]);
            if spot.image_filter == ImageFilter::Trilinear {
                flags.push("IMAGE_GRADIENT");
            }
            self.fragment.push(glsl!("surfaces/projected.frag"));
            self.inputs.push(upload(format!("spot_image_{index}"), image, image_sampler(spot.image_filter), list));
        }
        self.fragment.iter_mut().for_each(|chunk| *chunk = chunk.for_light(index));
        self.defines.extend(flags.into_iter().map(|flag| Define::flag(flag).of_light(index)));
        Some(())
    }

    /// Leaves out the side that is turned away from the photograph's eye, as the depth map alone cannot where a surface is
    /// thin. What casts no shadow hides nothing, its own other side included.
    fn face(&mut self, term: &LightTerm, viewer: &Viewer) {
        let Some(eye) = term.source.position() else { return };
        let eye = viewer.eye_from_world.transform_point3(eye).as_vec3();
        self.uniforms.push(Uniform::of_light("photo_eye", term.index, eye));
        self.defines.push(Define::flag("PHOTO_FACING").of_light(term.index));
        self.faces = true;
    }

    /// The variant of an item, with its photograph.
    pub fn on(self, mut surface: Variant) -> Variant {
        let Self { faces, defines, vertex, fragment, uniforms, inputs, .. } = self;
        let program = &mut surface.program;
        for (define, needed) in [(EYE_SPACE, vertex.is_some()), (EYE_POSITION, faces)] {
            if needed && !program.defines.contains(&define) {
                program.defines.push(define);
            }
        }
        program.defines.extend(defines);
        // Before the chunk that ends the stage.
        insert_before_last(&mut program.vertex, vertex);
        insert_before_last(&mut program.fragment, fragment);
        surface.uniforms.extend(uniforms);
        surface.inputs.extend(inputs);
        surface.meaning = FixedFunctionDesc::Shader("a photograph that is projected back onto a surface");
        surface
    }
}

fn insert_before_last(stage: &mut Vec<Chunk>, chunks: impl IntoIterator<Item = Chunk>) {
    let last = stage.len().saturating_sub(1);
    stage.splice(last..last, chunks);
}
