//! The lit pass: every visible surface once, with the light of every contributing light in one shader variant
//! [lecture, "Advice for Shadowed Illumination Model"; techniques A5–A7, A12, A13 f].

mod variant;

use glam::{DMat4, DVec3, Mat3, Vec3, Vec4};

use super::{Item, LightTerm};
use crate::math::texgen;
use crate::pass::{
    Attribute, Batch, Chunk, Face, Filter, Input, PassList, PointLight, Program, Projection, Sampler, Uniform, Wrap,
};
use crate::scene::{Light, LightKind, LightShape, Scene};
pub use variant::Ending;

/// Whose picture the surfaces are drawn for.
#[derive(Clone, Copy, Debug)]
pub struct Viewer {
    pub clip_from_eye: DMat4,
    pub eye_from_world: DMat4,
}

impl Viewer {
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_eye * self.eye_from_world
    }
}

/// The batches that draw `items` as `viewer` sees them, lit by `terms`; `ending` decides what a fragment shows.
///
/// `None` where a light's transform has no inverse.
pub fn batches(
    scene: &Scene,
    items: &[Item],
    viewer: &Viewer,
    terms: &[LightTerm],
    ending: &Ending,
    list: &mut PassList,
) -> Option<Vec<Batch>> {
    let clip_from_world = viewer.clip_from_world();
    let lights: Vec<LightParts> =
        terms.iter().map(|term| light_parts(scene, viewer, term, ending, list)).collect::<Option<_>>()?;
    let mut batches: Vec<Batch> = Vec::new();
    for item in items {
        let one_sided = shows_no_back_face(item, &(clip_from_world * item.world_from_model));
        let surface = variant::of(scene, item, one_sided, &lights, viewer, ending, list);
        let variant::Variant { program, meaning, uniforms, inputs } = surface;
        let cull = one_sided.then_some(Face::Back);
        let draw = item.draw(&clip_from_world, draw_uniforms(viewer, item, &program));
        let joins =
            |b: &&mut Batch| b.cull == cull && b.inputs == inputs && b.uniforms == uniforms && b.program == program;
        match batches.iter_mut().find(joins) {
            Some(batch) => {
                debug_assert_eq!(batch.meaning, meaning, "the meaning follows from program, uniforms and inputs");
                batch.draws.push(draw);
            }
            None => batches.push(Batch { program, meaning, uniforms, inputs, cull, draws: vec![draw] }),
        }
    }
    Some(batches)
}

/// Whether no back face of the item can be seen: it is declared closed, has no holes by alpha, and all of it lies before
/// the near plane, so that the viewer is outside of it.
fn shows_no_back_face(item: &Item, clip_from_model: &DMat4) -> bool {
    let before_near = |corner: DVec3| {
        let clip = *clip_from_model * corner.extend(1.0);
        clip.z > -clip.w
    };
    item.closed && !item.needs_alpha_test() && item.bounds.corners().into_iter().all(before_near)
}

fn draw_uniforms(viewer: &Viewer, item: &Item, program: &Program) -> Vec<Uniform> {
    let eye_from_model = viewer.eye_from_world * item.world_from_model;
    let mut uniforms = Vec::new();
    if program.defines.iter().any(|(name, _)| name == "EYE_SPACE") {
        uniforms.push(Uniform::new("eye_from_model", eye_from_model.as_mat4()));
    }
    if program.attributes.contains(&Attribute::Normal) {
        let normal = Mat3::from_mat4(eye_from_model.inverse().transpose().as_mat4());
        uniforms.push(Uniform::new("eye_from_model_normal", normal));
    }
    uniforms
}

/// What one light brings to every variant.
pub(super) struct LightParts {
    index: usize,
    defines: Vec<String>,
    shade: Chunk,
    uniforms: Vec<Uniform>,
    inputs: Vec<Input>,
    meaning: PointLight,
    has_specular: bool,
    has_ambient: bool,
}

const SPOT_IMAGE_SAMPLER: Sampler =
    Sampler { filter: Filter::Linear, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };

fn light_parts(
    scene: &Scene,
    viewer: &Viewer,
    term: &LightTerm,
    ending: &Ending,
    list: &mut PassList,
) -> Option<LightParts> {
    let source = &scene.lights[term.index];
    let index = term.index;
    let cone = matches!(source.kind, LightKind::Spot { shape: LightShape::Cone, .. });
    let texgen = texgen(source, viewer, term)?;
    let projection = Projection { light: index, texgen, frustum_from_map: term.frustum_from_map, cone };
    let mut parts = LightParts {
        index,
        defines: term.defines.clone(),
        shade: term.shade.for_light(index),
        uniforms: term.uniforms.clone(),
        inputs: term.inputs.clone(),
        meaning: meaning(source, viewer, term, projection),
        has_specular: source.specular != [0.0; 3],
        has_ambient: source.ambient != [0.0; 3],
    };
    add_texgen(&mut parts, &texgen);
    if cone {
        parts.defines.push(format!("CONE_{index}"));
    }
    if let Some(frustum_from_map) = term.frustum_from_map {
        parts.defines.push(format!("MAP_ADDRESSING_{index}"));
        parts.uniforms.push(Uniform::of_light("frustum_from_map", index, frustum_from_map));
    }
    if let Ending::Lit = ending {
        add_lighting(&mut parts, source, viewer, term, list);
    }
    Some(parts)
}

/// The light in the terms of fixed function.
fn meaning(source: &Light, viewer: &Viewer, term: &LightTerm, projection: Projection) -> PointLight {
    PointLight {
        position: eye_position(source, viewer).to_array(),
        ambient: source.ambient,
        diffuse: source.diffuse,
        specular: source.specular,
        attenuation: source.attenuation,
        beam: source.image.as_ref().map(|_| format!("spot_image_{}", term.index).into()),
        dimming: term.dimming,
        projection,
        shade: term.meaning.clone(),
    }
}

fn eye_position(source: &Light, viewer: &Viewer) -> Vec3 {
    viewer.eye_from_world.transform_point3(source.position).as_vec3()
}

fn texgen(source: &Light, viewer: &Viewer, term: &LightTerm) -> Option<texgen::Texgen> {
    let spaces = texgen::Spaces {
        texture_from_light_clip: term.texture_from_light_clip * term.receiver_bias,
        light_clip_from_light: source.clip_from_view(),
        light_from_world: source.view_from_world(),
        eye_from_world: viewer.eye_from_world,
    };
    texgen::set_up(&spaces, term.set_up, term.split)
}

fn add_texgen(parts: &mut LightParts, generated: &texgen::Texgen) {
    let rows = generated.eye_planes.as_mat4().transpose();
    let planes: Vec<Vec4> = vec![rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
    parts.uniforms.push(Uniform::of_light("eye_planes", parts.index, planes));
    if generated.texture_matrix != DMat4::IDENTITY {
        parts.defines.push(format!("TEXTURE_MATRIX_{}", parts.index));
        parts.uniforms.push(Uniform::of_light("texture_matrix", parts.index, generated.texture_matrix.as_mat4()));
    }
}

fn add_lighting(parts: &mut LightParts, source: &Light, viewer: &Viewer, term: &LightTerm, list: &mut PassList) {
    let index = parts.index;
    parts.uniforms.push(Uniform::of_light("light_position", index, eye_position(source, viewer)));
    parts.uniforms.push(Uniform::of_light("light_diffuse", index, Vec3::from(source.diffuse)));
    if parts.has_ambient {
        parts.defines.push(format!("LIGHT_AMBIENT_{index}"));
        parts.uniforms.push(Uniform::of_light("light_ambient", index, Vec3::from(source.ambient)));
    }
    if source.attenuation != [1.0, 0.0, 0.0] {
        parts.defines.push(format!("ATTENUATION_{index}"));
        parts.uniforms.push(Uniform::of_light("attenuation", index, Vec3::from(source.attenuation)));
    }
    if term.dimming > 0.0 {
        parts.defines.push(format!("DIMMING_{index}"));
        parts.uniforms.push(Uniform::of_light("dimming", index, term.dimming));
    }
    if let Some(image) = &source.image {
        parts.defines.push(format!("SPOT_IMAGE_{index}"));
        parts.inputs.push(super::items::upload(format!("spot_image_{index}"), image, SPOT_IMAGE_SAMPLER, list));
    }
    parts.uniforms.push(Uniform::of_light("light_specular", index, Vec3::from(source.specular)));
}
