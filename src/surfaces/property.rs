//! Shader variants of views that show a property of the surfaces, or a vector in their tangent space.

use glam::{Mat3, Vec3};

use super::bump::{self, normal_map};
use super::lights::LightParts;
use super::variant::{EYE_POSITION, EYE_SPACE, VERTEX_COLORS, Variant};
use crate::geometry::bump::NormalFormat;
use crate::lights::appearance::Appearance;
use crate::lights::drawable::{Cutout, cutout};
use crate::lights::ending::SurfaceProperty;
use crate::lights::{Ending, Viewer};
use crate::pass::{Attribute, Chunk, Define, FixedFunctionDesc, Input, PassList, Program, Uniform, glsl};

const MEANING: FixedFunctionDesc = FixedFunctionDesc::Shader("a view of a surface's property");

/// Shader variant in the making.
#[derive(Default)]
struct Parts {
    cut: Cutout,
    flags: Vec<&'static str>,
    defines: Vec<Define>,
    attributes: Vec<Attribute>,
    vertex: Vec<Chunk>,
    fragment: Vec<Chunk>,
    uniforms: Vec<Uniform>,
    inputs: Vec<Input>,
}

/// The variant of `item` in such a view; `None`: the view is another. `one_sided`: no normal is seen from behind.
pub fn of(
    item: &Appearance<'_>,
    one_sided: bool,
    lights: &[&LightParts],
    viewer: &Viewer,
    ending: &Ending,
    list: &mut PassList,
) -> Option<Variant> {
    match ending {
        Ending::Surface { chunk, shown } => Some(property(item, *shown, one_sided, viewer, list).ended(item, chunk)),
        Ending::TangentVector { chunk, half } => Some(vector(item, *half, lights, chunk, list)),
        _ => None,
    }
}

/// A property of the surface, without light.
fn property(
    item: &Appearance<'_>,
    shown: SurfaceProperty,
    one_sided: bool,
    viewer: &Viewer,
    list: &mut PassList,
) -> Parts {
    let bump = item.bump();
    let (gloss_defines, gloss_inputs) =
        if shown == SurfaceProperty::Gloss { bump::gloss(item, list) } else { Default::default() };
    let decal = shown == SurfaceProperty::Decal || gloss_defines.iter().any(|define| define.name() == "GLOSS_DECAL");
    let reads_map = matches!(shown, SurfaceProperty::Normal | SurfaceProperty::NormalMap) && bump.is_some();
    let others = reads_map || !gloss_defines.is_empty();
    let mut parts = Parts { defines: gloss_defines, inputs: gloss_inputs, ..Parts::default() };
    if decal || others || item.needs_alpha_test() {
        parts.cut = cutout(item, [decal, others], list);
    }
    if decal && item.decal().is_some() {
        parts.flags.push("DECAL");
    }
    if let Some(bump) = bump.filter(|_| reads_map) {
        parts.inputs.push(normal_map(bump, list));
        if bump.format == NormalFormat::Signed {
            parts.flags.push("NORMAL_SIGNED");
        }
    }
    match shown {
        SurfaceProperty::Normal => parts.add_normal(reads_map, one_sided, viewer),
        SurfaceProperty::NormalMap => parts.flags.push(if reads_map { "SHOW_NORMAL_MAP" } else { "SHOW_FLAT" }),
        SurfaceProperty::Decal => {
            parts.flags.push("SHOW_DECAL");
            if item.has_colors() {
                parts.defines.push(VERTEX_COLORS);
                parts.attributes.push(Attribute::Color);
            }
            parts.uniforms.push(Uniform::new("own_color", Vec3::from(item.material.diffuse)));
        }
        SurfaceProperty::Gloss => {}
    }
    parts
}

/// A vector to one light, of an item with bases; others stay black.
fn vector(item: &Appearance<'_>, half: bool, lights: &[&LightParts], chunk: &Chunk, list: &mut PassList) -> Variant {
    let mut parts = Parts::default();
    if item.needs_alpha_test() {
        parts.cut = cutout(item, [false; 2], list);
    }
    let Some(light) = lights.first().filter(|_| item.has_bases()) else {
        parts.flags.push("NO_BASES");
        return parts.ended(item, chunk);
    };
    parts.flags.extend(["NORMALS", "COMBINED"]);
    parts.flags.extend(half.then_some("SPECULAR"));
    parts.defines.push(EYE_SPACE);
    parts.attributes.extend([Attribute::Normal, Attribute::Tangent, Attribute::Bitangent]);
    let call = format!("set_tangent_vectors_{}(eye, basis);", light.index);
    parts.defines.push(Define::calls("TANGENT_VECTORS", "eye, basis", call));
    parts.defines.extend(light.defines.iter().filter(|define| define.name() == "DIRECTIONAL").cloned());
    let names = [format!("light_position_{}", light.index), format!("light_direction_{}", light.index)];
    let is_place = |uniform: &&Uniform| names.iter().any(|name| *name == uniform.name);
    parts.uniforms.extend(light.uniforms.iter().filter(is_place).cloned());
    parts.vertex.push(glsl!("surfaces/tangent_vectors.vert").for_light(light.index));
    parts.ended(item, &chunk.for_light(light.index))
}

impl Parts {
    /// Adds the normal that light counts with.
    fn add_normal(&mut self, bumped: bool, one_sided: bool, viewer: &Viewer) {
        self.flags.extend(["SHOW_NORMAL", "NORMALS", "EYE_NORMAL"]);
        self.defines.push(EYE_SPACE);
        self.attributes.push(Attribute::Normal);
        self.fragment.push(glsl!("surfaces/material.glsl"));
        if bumped {
            self.flags.push("BUMP");
            self.attributes.extend([Attribute::Tangent, Attribute::Bitangent]);
            self.fragment.push(glsl!("surfaces/bump.frag"));
        }
        if !one_sided {
            self.flags.push("TWO_SIDED");
            self.defines.push(EYE_POSITION);
            self.fragment.push(glsl!("surfaces/two_sided.frag"));
        }
        self.fragment.push(glsl!("surfaces/point.frag"));
        let world_from_eye = Mat3::from_mat4(viewer.eye_from_world.inverse().as_mat4());
        self.uniforms.push(Uniform::new("world_from_eye", world_from_eye));
    }

    /// The variant, with the chunk that ends its fragment stage.
    fn ended(self, item: &Appearance<'_>, chunk: &Chunk) -> Variant {
        let Self { cut, flags, mut defines, attributes: others, vertex: own, fragment: inner, uniforms, inputs } = self;
        let Cutout { defines: cut_defines, vertex: cut_vertex, fragment: cut_fragment, .. } = cut;
        defines.extend(cut_defines);
        defines.extend(flags.into_iter().map(Define::flag));
        if item.waves {
            defines.push(Define::flag("WAVE"));
        }
        if !cut_vertex.is_empty() {
            defines.push(Define::flag("DECAL_COORDINATES"));
        }
        defines.push(Define::calls("TEXGEN", "eye", String::new()));
        let mut vertex = vec![glsl!("common/position.vert")];
        vertex.extend(cut_vertex);
        vertex.extend(own);
        vertex.push(glsl!("surfaces/surface.vert"));
        let fragment: Vec<Chunk> = cut_fragment.into_iter().chain(inner).chain([chunk.clone()]).collect();
        let mut attributes = vec![Attribute::Position];
        attributes.extend(others);
        attributes.extend(cut.attributes);
        let program = Program { label: String::from("surface"), defines, vertex, fragment, attributes };
        let uniforms = cut.uniforms.into_iter().chain(uniforms).collect();
        let inputs = cut.inputs.into_iter().chain(inputs).collect();
        Variant { program, meaning: MEANING, uniforms, inputs }
    }
}
