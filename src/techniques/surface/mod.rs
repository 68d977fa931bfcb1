//! The lit pass: every visible surface once, with the light of every contributing light in one shader variant
//! [lecture, "Advice for Shadowed Illumination Model"; techniques A5–A7, A12, A13 f].

pub(crate) mod sides;
mod variant;

use glam::{DMat4, Mat3, Vec3, Vec4};

use super::{Item, LightTerm};
use crate::math::texgen;
use crate::pass::{
    Attribute, Batch, Chunk, Face, Filter, Input, LightMeaning, PassList, Program, Projection, Sampler, Uniform, Wrap,
    glsl,
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
        let culls = sides::shows_no_back_face(item, &(clip_from_world * item.world_from_model));
        let one_sided = culls || sides::normals_face_eye(item, &(viewer.eye_from_world * item.world_from_model));
        let surface = variant::of(scene, item, one_sided, &lights, viewer, ending, list);
        let variant::Variant { program, meaning, uniforms, inputs } = surface;
        let cull = culls.then_some(Face::Back);
        let draw = item.draw(&clip_from_world, draw_uniforms(viewer, item, &program));
        let joins =
            |b: &&mut Batch| b.cull == cull && b.inputs == inputs && b.uniforms == uniforms && b.program == program;
        match batches.iter_mut().find(joins) {
            Some(batch) => {
                debug_assert_eq!(batch.meaning, meaning, "the meaning follows from program, uniforms and inputs");
                batch.draws.push(draw);
            }
            None => batches.push(Batch { program, meaning, uniforms, inputs, cull, scissor: None, draws: vec![draw] }),
        }
    }
    Some(batches)
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
    /// Defines `bool in_reach_@()`.
    reach: Chunk,
    has_coordinates: bool,
    meaning: LightMeaning,
    has_specular: bool,
    has_ambient: bool,
    /// Whether its direction differs from point to point.
    has_position: bool,
    has_attenuation: bool,
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
    let bounded = source.spot().is_some();
    let cone = source.spot().is_some_and(|spot| spot.shape == LightShape::Cone);
    let projection = match &term.coordinates {
        Some(coordinates) => {
            let spaces = coordinates.spaces(viewer.eye_from_world);
            let texgen = texgen::set_up(&spaces, coordinates.set_up, coordinates.split)?;
            Some(Projection { light: index, texgen, frustum_from_map: term.frustum_from_map, bounded, cone })
        }
        None => None,
    };
    let mut parts = LightParts {
        index,
        defines: term.defines.clone(),
        shade: term.shade.for_light(index),
        uniforms: term.uniforms.clone(),
        inputs: term.inputs.clone(),
        reach: if source.spot().is_some() { glsl!("light/reach.frag") } else { glsl!("light/everywhere.frag") }
            .for_light(index),
        has_coordinates: projection.is_some(),
        meaning: meaning(source, viewer, term, projection.clone()),
        has_position: source.position().is_some(),
        has_attenuation: source.attenuation() != [1.0, 0.0, 0.0],
        has_specular: source.specular != [0.0; 3],
        has_ambient: source.ambient != [0.0; 3],
    };
    if let Some(projection) = &projection {
        add_texgen(&mut parts, &projection.texgen);
    }
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
fn meaning(source: &Light, viewer: &Viewer, term: &LightTerm, projection: Option<Projection>) -> LightMeaning {
    let has_image = source.spot().is_some_and(|spot| spot.image.is_some());
    LightMeaning {
        index: term.index,
        position: eye_position(source, viewer).to_array(),
        ambient: source.ambient,
        diffuse: source.diffuse,
        specular: source.specular,
        attenuation: source.attenuation(),
        beam: has_image.then(|| format!("spot_image_{}", term.index).into()),
        dimming: term.dimming,
        projection,
        shade: term.meaning.clone(),
    }
}

/// Homogeneous: of an infinitely far light, the unit vector to it, and w = 0.
fn eye_position(source: &Light, viewer: &Viewer) -> Vec4 {
    let position = match &source.kind {
        LightKind::Spot(spot) => spot.frustum.position,
        LightKind::Point(point) => point.position,
        LightKind::Directional { direction } => {
            return viewer.eye_from_world.transform_vector3(-*direction).as_vec3().extend(0.0);
        }
    };
    viewer.eye_from_world.transform_point3(position).as_vec3().extend(1.0)
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
    let position = eye_position(source, viewer);
    if parts.has_position {
        parts.uniforms.push(Uniform::of_light("light_position", index, position.truncate()));
    } else {
        parts.defines.push(format!("DIRECTIONAL_{index}"));
        parts.uniforms.push(Uniform::of_light("light_direction", index, position.truncate()));
    }
    parts.uniforms.push(Uniform::of_light("light_diffuse", index, Vec3::from(source.diffuse)));
    if parts.has_ambient {
        parts.defines.push(format!("LIGHT_AMBIENT_{index}"));
        parts.uniforms.push(Uniform::of_light("light_ambient", index, Vec3::from(source.ambient)));
    }
    if parts.has_attenuation {
        parts.defines.push(format!("ATTENUATION_{index}"));
        parts.uniforms.push(Uniform::of_light("attenuation", index, Vec3::from(source.attenuation())));
    }
    if term.dimming > 0.0 {
        parts.defines.push(format!("DIMMING_{index}"));
        parts.uniforms.push(Uniform::of_light("dimming", index, term.dimming));
    }
    if let Some(image) = source.spot().and_then(|spot| spot.image.as_ref()) {
        parts.defines.push(format!("SPOT_IMAGE_{index}"));
        parts.inputs.push(super::items::upload(format!("spot_image_{index}"), image, SPOT_IMAGE_SAMPLER, list));
    }
    parts.uniforms.push(Uniform::of_light("light_specular", index, Vec3::from(source.specular)));
}
