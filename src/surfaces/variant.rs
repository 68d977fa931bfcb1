//! The shader variant of one item: what its material and the lights need, and nothing else.

use glam::{Vec3, Vec4};

use super::bump::{self, Bumps};
use super::lights::{self, LightParts};
use super::meaning::{self, ShownColors};
use crate::geometry::Material;
use crate::lights::appearance::Appearance;
use crate::lights::drawable::{Cutout, WAVES, cutout};
use crate::lights::ending::FormulaPart;
use crate::lights::{Ending, Factors, Viewer};
use crate::pass::{Attribute, Chunk, Define, FixedFunctionDesc, Input, PassList, Program, Uniform, glsl};
use crate::scene::Scene;

/// The vertex stage needs positions in eye space.
pub const EYE_SPACE: Define = Define::flag("EYE_SPACE");

/// The fragment stage gets positions in eye space.
pub const EYE_POSITION: Define = Define::flag("EYE_POSITION");

/// Colours of the vertices multiply those of the material.
pub const VERTEX_COLORS: Define = Define::flag("VERTEX_COLORS");

/// Features that an item's picture depends on.
#[derive(Clone, Copy)]
struct Needs {
    specular: bool,
    normals: bool,
    per_vertex: bool,
    /// True if the fragment stage needs the point's position.
    position: bool,
    ambient: bool,
    /// True if no normal is seen from behind, so that none must be reversed.
    one_sided: bool,
    /// True if register combiners light its bumps.
    combined: bool,
    /// Ambient light of the scene.
    scene_ambient: [f32; 3],
}

impl Needs {
    /// True if a normal may be seen from behind, which the fragment stage finds out.
    fn is_two_sided(&self) -> bool {
        self.normals && !self.per_vertex && !self.one_sided
    }
}

/// The shader variant of an item, with its uniforms and inputs.
pub struct Variant {
    pub program: Program,
    pub meaning: FixedFunctionDesc,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
}

impl Variant {
    /// The same, cut to half-spaces in eye space.
    pub fn cut(mut self, clip_planes: &[Vec4]) -> Self {
        if !clip_planes.is_empty() {
            let defines = &mut self.program.defines;
            defines.push(Define::number("CLIP_PLANES", clip_planes.len() as u32));
            if !defines.contains(&EYE_SPACE) {
                defines.push(EYE_SPACE);
            }
            self.uniforms.push(Uniform::new("clip_planes", clip_planes.to_vec()));
        }
        self
    }
}

/// The variant of items of this appearance. `one_sided`: no normal is seen from behind. `has_ambient`: with the scene's
/// ambient light. `in_view`: all of it lies in the eye's view, so that no vertex is made by clipping.
pub fn of(
    scene: &Scene,
    item: &Appearance<'_>,
    [one_sided, has_ambient, in_view]: [bool; 3],
    lights: &[&LightParts],
    viewer: &Viewer,
    ending: &Ending,
    list: &mut PassList,
) -> Variant {
    let lit = ending.is_lit();
    let shows_light = ending.shows_light();
    let shines = !matches!(ending, Ending::Part(FormulaPart::Diffuse));
    let specular =
        shines && lit && item.lit && item.material.specular != [0.0; 3] && lights.iter().any(|l| l.has_specular);
    let has_cosine = |light: &LightParts| item.lit && light.has_cosine;
    let normals = lit && lights.iter().any(|light| has_cosine(light));
    let per_vertex = lit && scene.shading.per_vertex && !lights.is_empty();
    let bumps =
        if normals && !per_vertex { Bumps::of(item, lights, &scene.shading.bumps, ending) } else { Bumps::None };
    // The pass of highlights reads the gloss in alpha.
    let gloss = match ending {
        Ending::Lit => specular,
        Ending::Part(portion) => matches!(portion, FormulaPart::Decal(_)),
        _ => false,
    };
    let (gloss_defines, gloss_inputs) = if gloss { bump::gloss(item, list) } else { Default::default() };
    let decal = shows_decal(ending);
    let others = bumps.any() || !gloss_defines.is_empty();
    let cut = if decal || others || item.needs_alpha_test() {
        cutout(item, [decal, others], list)
    } else {
        Cutout::default()
    };
    let lit_from_near = |light: &LightParts| light.has_position && (has_cosine(light) || light.has_attenuation);
    let two_sided = normals && !one_sided;
    let needs = Needs {
        specular,
        normals,
        per_vertex,
        position: shows_light
            && !per_vertex
            && ((specular && !bumps.are_combined())
                || two_sided
                || lights.iter().any(|light| lit_from_near(light) && (!bumps.are_combined() || light.has_attenuation))),
        ambient: lit && lights.iter().any(|l| l.has_ambient),
        one_sided,
        combined: bumps.are_combined(),
        scene_ambient: if has_ambient { scene.shading.ambient } else { [0.0; 3] },
    };
    let bump_map = item.bump().map(|bump| &**bump);
    let mut inputs = cut.inputs.clone();
    inputs.extend(gloss_inputs);
    inputs.extend(bumps.inputs(bump_map, &scene.shading.bumps, list));
    let mut uniforms = cut.uniforms.clone();
    for light in lights {
        inputs.extend(light.inputs.iter().cloned());
        uniforms.extend(light.uniforms.iter().filter(|u| needs.specular || !is_specular(u)).cloned());
    }
    match ending {
        Ending::Lit | Ending::Part(FormulaPart::Diffuse | FormulaPart::Specular) => {
            uniforms.extend(material_uniforms(item.material, needs, !lights.is_empty()))
        }
        Ending::Factors(factors) => uniforms.extend(factor_uniforms(scene, item.material, factors)),
        _ => {}
    }
    let mut attributes = vec![Attribute::Position];
    if needs.normals {
        attributes.push(Attribute::Normal);
    }
    attributes.extend(cut.attributes.iter().copied());
    if bumps.any() {
        attributes.extend([Attribute::Tangent, Attribute::Bitangent]);
    }
    let colored = decal && item.has_colors();
    if colored {
        attributes.push(Attribute::Color);
    }
    let mut defines = defines(item, lights, ending, needs, &cut, in_view);
    defines.extend(bumps.defines(bump_map, &scene.shading.bumps, lights));
    defines.extend(gloss_defines);
    defines.extend(colored.then_some(VERTEX_COLORS));
    if bumps.are_combined() && bump::are_in_range(&uniforms, lights) {
        defines.push(Define::flag("COLORS_IN_RANGE"));
    }
    if *ending == Ending::Part(FormulaPart::Specular) {
        defines.push(Define::flag("SPECULAR_ALONE"));
    }
    let program = Program {
        label: String::from("surface"),
        defines,
        vertex: vertex(lights, needs, &bumps, &cut),
        fragment: fragment(scene, lights, ending, needs, &bumps, &cut),
        attributes,
    };
    let shown =
        ShownColors { specular, ambient: needs.ambient, scene_ambient: scene_ambient(needs, item.material).to_array() };
    let meaning = if item.waves {
        WAVES
    } else if colored {
        FixedFunctionDesc::Shader("colours of its vertices")
    } else if let Some(map) = bump_map.filter(|_| bumps.any()) {
        match bumps.meaning(map, &scene.shading.bumps, ending, [two_sided, specular]) {
            Ok(map) => meaning::of(scene, item, lights, viewer, ending, shown, (&cut, Some(map))),
            Err(why) => FixedFunctionDesc::Shader(why),
        }
    } else if others && shines && lit {
        FixedFunctionDesc::Shader("highlights by a gloss map")
    } else {
        meaning::of(scene, item, lights, viewer, ending, shown, (&cut, None))
    };
    Variant { program, meaning, uniforms, inputs }
}

fn scene_ambient(needs: Needs, material: &Material) -> Vec3 {
    Vec3::from(needs.scene_ambient) * Vec3::from(material.ambient)
}

fn is_specular(uniform: &Uniform) -> bool {
    uniform.name.starts_with("light_specular_")
}

fn material_uniforms(material: &Material, needs: Needs, any_light: bool) -> Vec<Uniform> {
    let ambient = Vec3::from(material.ambient);
    let mut uniforms = vec![Uniform::new("scene_ambient", scene_ambient(needs, material))];
    if needs.ambient {
        uniforms.push(Uniform::new("material_ambient", ambient));
    }
    if any_light {
        uniforms.push(Uniform::new("material_diffuse", Vec3::from(material.diffuse)));
    }
    if needs.specular {
        uniforms.push(Uniform::new("material_specular", Vec3::from(material.specular)));
        uniforms.push(Uniform::new("shininess", material.shininess));
    }
    uniforms
}

fn factor_uniforms(scene: &Scene, material: &Material, factors: &Factors) -> Vec<Uniform> {
    let ambient = factors.ambient.then(|| Uniform::new("scene_ambient", Vec3::from(scene.shading.ambient)));
    let color = factors.color.then(|| Uniform::new("own_color", Vec3::from(material.diffuse)));
    ambient.into_iter().chain(color).collect()
}

/// Tests whether the decal's colour is shown.
fn shows_decal(ending: &Ending) -> bool {
    match ending {
        Ending::Lit | Ending::Part(FormulaPart::Decal(_)) => true,
        Ending::Part(FormulaPart::Diffuse | FormulaPart::Specular) => false,
        Ending::Surface { .. } | Ending::TangentVector { .. } => false,
        Ending::Factors(factors) => factors.color,
        Ending::Alpha(_) | Ending::View { .. } | Ending::Slice { .. } => false,
    }
}

fn defines(
    item: &Appearance<'_>,
    lights: &[&LightParts],
    ending: &Ending,
    needs: Needs,
    cut: &Cutout,
    in_view: bool,
) -> Vec<Define> {
    let (lit, shows_light) = (ending.is_lit(), ending.shows_light());
    let decal = shows_decal(ending) && item.decal().is_some();
    let unlit = !item.lit || (!lights.is_empty() && !needs.normals);
    let factors = if let Ending::Factors(factors) = ending { Some(factors) } else { None };
    let combined = needs.combined;
    let per_fragment = needs.normals && !needs.per_vertex;
    let flags = [
        (Define::flag("WAVE"), item.waves),
        (Define::flag("ANY_LIGHT"), shows_light && !lights.is_empty()),
        (EYE_SPACE, needs.per_vertex || needs.position || combined || lights.iter().any(|light| light.has_coordinates)),
        (EYE_POSITION, needs.position),
        (Define::flag("NORMALS"), needs.normals),
        (Define::flag("EYE_NORMAL"), per_fragment && (!combined || !needs.one_sided)),
        (Define::flag("TWO_SIDED"), needs.is_two_sided()),
        (Define::flag("UNLIT"), lit && unlit),
        (Define::flag("COLORLESS"), factors.is_some()),
        (Define::flag("AMBIENT_FACTOR"), factors.is_some_and(|factors| factors.ambient)),
        (Define::flag("OWN_COLOR"), factors.is_some_and(|factors| factors.color)),
        (Define::flag("SPECULAR"), needs.specular),
        (Define::flag("PER_VERTEX"), needs.per_vertex),
        (Define::flag("MATERIAL_AMBIENT"), needs.ambient),
        (Define::flag("DECAL"), decal),
        (Define::flag("DECAL_COORDINATES"), !cut.vertex.is_empty()),
    ];
    let mut defines: Vec<Define> = cut.defines.clone();
    defines.extend(flags.into_iter().filter(|(_, set)| *set).map(|(define, _)| define));
    // Not every driver clips what is interpolated without perspective as GL has it, and what is divided by w has no meaning
    // at vertices behind the eye.
    let of_light = lights.iter().flat_map(|light| light.defines.iter().cloned());
    defines.extend(of_light.filter(|define| in_view || define.name() != lights::OVER_W));
    let call_of = |light: &LightParts, call: &str| call.replace('@', &light.index.to_string());
    let calls = |call: &str| lights.iter().map(|light| call_of(light, call)).collect::<String>();
    let generated = lights.iter().filter(|light| light.has_coordinates).map(|light| {
        let found = if light.side.is_some() { "find_side_@(eye);" } else { "" };
        call_of(light, &format!("texgen_@(eye);{found}"))
    });
    defines.push(Define::calls("TEXGEN", "eye", generated.collect()));
    if needs.per_vertex {
        defines.push(Define::calls("LIGHT_VERTEX", "surface", calls("light_vertex_@(surface);")));
    }
    if shows_light {
        defines.push(Define::calls("ILLUMINATE", "surface, lit", calls("illuminate_@(surface, lit);")));
    }
    defines
}

fn vertex(lights: &[&LightParts], needs: Needs, bumps: &Bumps, cut: &Cutout) -> Vec<Chunk> {
    let mut chunks = vec![glsl!("common/position.vert")];
    chunks.extend(cut.vertex.iter().cloned());
    if needs.per_vertex {
        chunks.push(glsl!("surfaces/material.glsl"));
    }
    for light in lights {
        if light.has_coordinates {
            chunks.push(glsl!("surfaces/texgen.vert").for_light(light.index));
        }
        chunks.extend(light.side.iter().map(|[vertex, _]| vertex.clone()));
        if bumps.are_combined() {
            chunks.push(glsl!("surfaces/tangent_vectors.vert").for_light(light.index));
        }
        if needs.per_vertex {
            chunks.push(glsl!("surfaces/lighting.glsl").for_light(light.index));
            chunks.push(glsl!("surfaces/per_vertex.vert").for_light(light.index));
        }
    }
    chunks.push(glsl!("surfaces/surface.vert"));
    chunks
}

fn fragment(
    scene: &Scene,
    lights: &[&LightParts],
    ending: &Ending,
    needs: Needs,
    bumps: &Bumps,
    cut: &Cutout,
) -> Vec<Chunk> {
    let mut chunks = cut.fragment.clone();
    let of_one_light = match ending {
        Ending::Part(FormulaPart::Decal(chunk)) => {
            chunks.push(chunk.clone());
            return chunks;
        }
        Ending::Surface { .. } | Ending::TangentVector { .. } => return chunks,
        Ending::Lit | Ending::Part(_) | Ending::Factors(_) => None,
        Ending::View { chunk, shade } => Some((chunk, *shade, None)),
        Ending::Alpha(chunk) => Some((chunk, true, None)),
        Ending::Slice { chunk, place } => Some((chunk, true, place.as_ref())),
    };
    if let Some((chunk, has_shade, place)) = of_one_light {
        for light in lights {
            chunks.extend(coordinates(light));
            chunks.extend(place.map(|place| place.for_light(light.index)));
            chunks.push(light.reach.clone());
            chunks.extend(light.projected.clone());
            if has_shade {
                chunks.extend(light.shade.iter().cloned());
            }
            chunks.push(chunk.for_light(light.index));
        }
        return chunks;
    }
    chunks.push(glsl!("surfaces/material.glsl"));
    if bumps.are_computed() {
        chunks.push(glsl!("surfaces/bump.frag"));
    }
    if needs.is_two_sided() {
        chunks.push(glsl!("surfaces/two_sided.frag"));
    }
    for light in lights {
        chunks.extend(coordinates(light));
        chunks.push(light.reach.clone());
        chunks.extend(light.projected.clone());
        chunks.extend(light.shade.iter().cloned());
        chunks.push(if needs.per_vertex {
            glsl!("surfaces/per_vertex.frag").for_light(light.index)
        } else {
            glsl!("surfaces/lighting.glsl").for_light(light.index)
        });
        chunks.extend(light.side.iter().map(|[_, fragment]| fragment.clone()));
        chunks.push(glsl!("surfaces/illuminate.frag").for_light(light.index));
    }
    if let Some(combined) = bumps.combiner_chunks(scene.shading.bumps.precision, lights) {
        chunks.extend(combined);
        return chunks;
    }
    if !matches!(ending, Ending::Factors(_)) {
        chunks.push(glsl!("surfaces/point.frag"));
    }
    chunks.push(match ending {
        Ending::Factors(factors) => factors.chunk.clone(),
        _ => glsl!("surfaces/surface.frag"),
    });
    chunks
}

/// The light's texture coordinates, where it has any.
fn coordinates(light: &LightParts) -> Option<Chunk> {
    light.has_coordinates.then(|| glsl!("surfaces/texgen.frag").for_light(light.index))
}
