//! Parts of the lit pass's shader variants for each light: chunks, defines, uniforms, textures [LEC, "Advice for Shadowed
//! Illumination Model"]. They depend on how much of the light an item is drawn with. Knows lights and terms; no item's
//! material.

use glam::{DMat4, DVec2, Vec3, Vec4};

use super::Ending;
use super::guarded::{self, Reach};
use crate::lights::drawable::{side_map, upload, upload_values};
use crate::lights::guard::Guard;
use crate::lights::light::{Addition, Gain, ShadeSource};
use crate::lights::{Drawable, LightTerm, Viewer};
use crate::math::texgen;
use crate::pass::{
    Chunk, Define, Filter, FixedFunctionLight, Input, PassList, Projection, Sampler, Shade, Uniform, Wrap, glsl,
};
use crate::scene::{
    DistanceTable, Frustum, ImageFilter, Interpolation, Law, Light, LightKind, LightShape, Spot, TableSteps,
};

/// The picture has the ambient light already.
pub const ADDED: Define = Define::flag("ADDED");

/// Parts of one light in every variant.
pub struct LightParts {
    pub index: usize,
    pub defines: Vec<Define>,
    /// Chunks that define `float shade_@()`.
    pub shade: Vec<Chunk>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
    /// Defines `bool in_reach_@()`.
    pub reach: Chunk,
    /// Defines `void find_side_@(vec4 eye)`, and `float side_@()` of what that found, 0 behind the light.
    pub side: Option<[Chunk; 2]>,
    pub has_coordinates: bool,
    /// Defines `vec3 projected_@()`: image, beam and law of distance.
    pub projected: Option<Chunk>,
    pub meaning: FixedFunctionLight,
    pub has_specular: bool,
    pub has_ambient: bool,
    /// True if the angle to the surface's normal counts.
    pub has_cosine: bool,
    /// True if its direction differs from point to point.
    pub has_position: bool,
    pub has_attenuation: bool,
}

/// One light, as the pieces need it.
pub struct Variants<'a> {
    term: &'a LightTerm,
    /// A light's plane, times a power of two: see [`Reach::Texture`].
    side_plane: Vec4,
    /// Parts in the order of [`Reach::ALL`], each made on first use; `None` within: nothing is left of the light.
    made: [Option<Option<LightParts>>; Reach::ALL.len()],
}

/// The side map's coordinate at the greatest q, as a power of two: a driver's texel coordinates must stay below 2^31, and
/// the texels meet at 1/2, which is closer to q = 0 than f32 resolves.
const SIDE_EXPONENT: f64 = 28.0;

impl<'a> Variants<'a> {
    pub fn new(items: &[Drawable], term: &'a LightTerm, viewer: &Viewer) -> Self {
        let plane = guarded::plane(term, viewer).filter(|_| term.guard == Guard::Texture1d);
        let side_plane = plane.map_or(Vec4::ZERO, |plane| {
            let exponent = SIDE_EXPONENT - plane.extent(items, viewer).max(1e-30).log2().ceil();
            plane.q_from_eye.as_vec4() * exponent.clamp(-100.0, 100.0).exp2() as f32
        });
        Self { term, side_plane, made: Default::default() }
    }

    /// `None` where the light's transform has no inverse.
    pub fn make(&mut self, viewer: &Viewer, reach: Reach, ending: &Ending, list: &mut PassList) -> Option<()> {
        let made = &mut self.made[reach as usize];
        if made.is_none() {
            let mut source = Light::clone(&self.term.source);
            let Gain { ambient, diffuse, specular } = self.term.gain;
            for (color, gain) in
                [(&mut source.ambient, ambient), (&mut source.diffuse, diffuse), (&mut source.specular, specular)]
            {
                *color = color.map(|channel| channel * gain);
            }
            *made = Some(match reach {
                Reach::Nowhere if source.ambient == [0.0; 3] => None,
                Reach::Nowhere => {
                    (source.diffuse, source.specular) = ([0.0; 3], [0.0; 3]);
                    let mut term = self.term.under(ShadeSource::dark());
                    (term.coordinates, term.frustum_from_map, term.dimming) = (None, None, 0.0);
                    Some(light_parts(&source, viewer, &term, reach, ending, list)?)
                }
                _ => Some(light_parts(&source, viewer, self.term, reach, ending, list)?),
            });
            if let (Reach::Texture, Some(Some(parts))) = (reach, made) {
                parts.uniforms.push(Uniform::of_light("side_plane", parts.index, self.side_plane));
            }
        }
        Some(())
    }

    pub fn of(&self, reach: Reach) -> Option<&LightParts> {
        self.made[reach as usize].as_ref()?.as_ref()
    }
}

/// Sampler of a light's image. Nothing beyond the image's border is read: outside of it there is no light, by the test of
/// reach, at every mipmap level.
pub fn image_sampler(filter: ImageFilter) -> Sampler {
    let filter = match filter {
        ImageFilter::Nearest => Filter::Nearest,
        ImageFilter::Linear => Filter::Linear,
        ImageFilter::Trilinear => Filter::Trilinear,
    };
    Sampler { filter, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None }
}

fn light_parts(
    source: &Light,
    viewer: &Viewer,
    term: &LightTerm,
    reach: Reach,
    ending: &Ending,
    list: &mut PassList,
) -> Option<LightParts> {
    let index = term.index;
    let spot = source.spot().filter(|_| reach != Reach::Nowhere);
    let cone = spot.is_some_and(|spot| spot.shape == LightShape::Cone);
    let projection = match &term.coordinates {
        Some(coordinates) => {
            let spaces = coordinates.spaces(viewer.eye_from_world);
            let texgen = texgen::set_up(&spaces, coordinates.set_up, coordinates.split)?;
            let bounded = spot.is_some();
            Some(Projection { light: index, texgen, frustum_from_map: term.frustum_from_map, bounded, cone })
        }
        None => None,
    };
    let in_reach = match spot {
        Some(_) => glsl!("surfaces/reach.frag"),
        None if reach == Reach::Nowhere => glsl!("surfaces/nowhere.frag"),
        None => glsl!("surfaces/everywhere.frag"),
    };
    let ShadeSource { chunks, defines, uniforms, inputs, .. } = term.shade.clone();
    let mut parts = LightParts {
        index,
        defines,
        shade: chunks.iter().map(|chunk| chunk.for_light(index)).collect(),
        uniforms,
        inputs,
        reach: in_reach.for_light(index),
        side: None,
        projected: None,
        has_coordinates: projection.is_some(),
        meaning: meaning(source, spot, viewer, term, projection.clone()),
        has_position: source.position().is_some(),
        has_attenuation: source.attenuation() != [1.0, 0.0, 0.0],
        has_specular: source.specular != [0.0; 3],
        has_ambient: source.ambient != [0.0; 3],
        has_cosine: source.law == Law::Lit,
    };
    if let Some(projection) = &projection {
        add_texgen(&mut parts, &projection.texgen);
        let interpolation = source.spot().map_or(Interpolation::Perspective, |spot| spot.interpolation);
        let define = match interpolation {
            Interpolation::Perspective => None,
            Interpolation::Affine => Some("AFFINE"),
            Interpolation::Segal => Some(OVER_W),
        };
        parts.defines.extend(define.map(|define| Define::flag(define).of_light(index)));
    }
    if cone {
        parts.defines.push(Define::flag("CONE").of_light(index));
    }
    if let Some(spot) = spot {
        add_guard(&mut parts, reach, list);
        if term.guard == Guard::None {
            parts.meaning.shade = Shade::Shader("light behind a light, which guard = \"none\" asks for");
        }
        if let Some(why) = beyond_fixed_function(spot, ending) {
            parts.meaning.shade = Shade::Shader(why);
        }
    }
    if let Some(frustum_from_map) = term.frustum_from_map {
        parts.defines.push(Define::flag("MAP_ADDRESSING").of_light(index));
        parts.uniforms.push(Uniform::of_light("frustum_from_map", index, frustum_from_map));
    }
    if term.addition == Addition::Clamped {
        parts.defines.push(ADDED);
    }
    if ending.shows_light() || matches!(ending, Ending::TangentVector { .. }) {
        add_lighting(&mut parts, source, spot, viewer, term, list);
    } else if let Ending::Slice { .. } = ending {
        add_beam(&mut parts, source, spot, viewer, list);
    }
    Some(parts)
}

/// Divides the light's coordinates by w, for items that allow it.
pub const OVER_W: &str = "OVER_W";

/// Feature of a spotlight that fixed function lacks, in words.
fn beyond_fixed_function(spot: &Spot, ending: &Ending) -> Option<&'static str> {
    if spot.interpolation == Interpolation::Affine {
        return Some("coordinates interpolated without perspective, which interpolate = \"affine\" asks for");
    }
    (ending.is_lit() && spot.falloff.is_some()).then_some("a law of planar distance, in a table of floats")
}

/// Adds the guard that replaces the fragment's test of q.
fn add_guard(parts: &mut LightParts, reach: Reach, list: &mut PassList) {
    let index = parts.index;
    if reach != Reach::Fragment {
        parts.defines.push(Define::flag("UNGUARDED").of_light(index));
    }
    parts.side = match reach {
        Reach::Texture => Some([glsl!("surfaces/side_map.vert"), glsl!("surfaces/side_map.frag")]),
        Reach::Cutoff => Some([glsl!("surfaces/spot_cutoff.vert"), glsl!("surfaces/spot_cutoff.frag")]),
        Reach::Free | Reach::Fragment | Reach::Nowhere => None,
    }
    .map(|chunks| chunks.map(|chunk| chunk.for_light(index)));
    if parts.side.is_some() {
        parts.defines.push(Define::flag("SIDE").of_light(index));
    }
    if reach == Reach::Texture {
        parts.inputs.push(side_map(format!("side_map_{index}"), list));
    }
}

/// The light in the terms of fixed function, which guards by a texture of its own.
fn meaning(
    source: &Light,
    spot: Option<&Spot>,
    viewer: &Viewer,
    term: &LightTerm,
    projection: Option<Projection>,
) -> FixedFunctionLight {
    let image = spot.and_then(|spot| spot.plain_image()).map(|_| format!("spot_image_{}", term.index).into());
    let map = spot.and_then(|spot| spot.beam.as_ref()).map(|_| format!("beam_map_{}", term.index).into());
    FixedFunctionLight {
        index: term.index,
        cosine: source.law == Law::Lit,
        position: eye_position(source, viewer).to_array(),
        ambient: source.ambient,
        diffuse: source.diffuse,
        specular: source.specular,
        attenuation: source.attenuation(),
        beams: image.into_iter().chain(map).collect(),
        dimming: term.dimming,
        diffuse_weight: term.diffuse_weight,
        projection,
        shade: term.shade.meaning.clone(),
    }
}

/// Homogeneous position; for an infinitely far light, the unit vector to it, and w = 0.
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
    let (defines, uniforms) = texgen_parts(parts.index, generated);
    parts.defines.extend(defines);
    parts.uniforms.extend(uniforms);
}

/// Defines and uniforms of texture coordinate generation for light `index`.
pub fn texgen_parts(index: usize, generated: &texgen::Texgen) -> (Vec<Define>, Vec<Uniform>) {
    let rows = generated.eye_planes.as_mat4().transpose();
    let planes: Vec<Vec4> = vec![rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
    let mut uniforms = vec![Uniform::of_light("eye_planes", index, planes)];
    if generated.texture_matrix == DMat4::IDENTITY {
        return (Vec::new(), uniforms);
    }
    uniforms.push(Uniform::of_light("texture_matrix", index, generated.texture_matrix.as_mat4()));
    (vec![Define::flag("TEXTURE_MATRIX").of_light(index)], uniforms)
}

/// Adds the light's colour, attenuation and what is projected through its frustum, without a surface that they fall on.
fn add_beam(parts: &mut LightParts, source: &Light, spot: Option<&Spot>, viewer: &Viewer, list: &mut PassList) {
    let index = parts.index;
    parts.uniforms.push(Uniform::of_light("light_diffuse", index, Vec3::from(source.diffuse)));
    if let Some(spot) = spot {
        add_projected(parts, spot, list);
    }
    if parts.has_attenuation {
        parts.defines.push(Define::flag("ATTENUATION").of_light(index));
        parts.uniforms.push(Uniform::of_light("attenuation", index, Vec3::from(source.attenuation())));
        parts.uniforms.push(Uniform::of_light("light_position", index, eye_position(source, viewer).truncate()));
    }
}

/// Adds what modulates a spotlight's diffuse and specular light: its image, its beam, its law of distance.
fn add_projected(parts: &mut LightParts, spot: &Spot, list: &mut PassList) {
    let index = parts.index;
    if spot.plain_image().is_some() || spot.beam.is_some() || spot.falloff.is_some() {
        parts.defines.push(Define::flag("PROJECTED").of_light(index));
        parts.projected = Some(glsl!("surfaces/projected.frag").for_light(index));
    }
    if let Some(image) = spot.plain_image() {
        parts.defines.push(Define::flag("SPOT_IMAGE").of_light(index));
        if spot.image_filter == ImageFilter::Trilinear {
            parts.defines.push(Define::flag("IMAGE_GRADIENT").of_light(index));
        }
        parts.inputs.push(upload(format!("spot_image_{index}"), image, image_sampler(spot.image_filter), list));
    }
    if let Some(beam) = &spot.beam {
        parts.defines.push(Define::flag("BEAM_MAP").of_light(index));
        parts.inputs.push(upload(format!("beam_map_{index}"), &beam.map, image_sampler(ImageFilter::Linear), list));
    }
    if let Some(falloff) = &spot.falloff {
        parts.defines.push(Define::flag("FALLOFF").of_light(index));
        let steps = match falloff.table.steps {
            TableSteps::Distance => None,
            TableSteps::Depth => Some("FALLOFF_DEPTH"),
            TableSteps::Logarithm => Some("FALLOFF_LOGARITHM"),
            TableSteps::Entries => Some("FALLOFF_ENTRIES"),
        };
        parts.defines.extend(steps.map(|steps| Define::flag(steps).of_light(index)));
        let place = falloff_place(&falloff.table, &spot.frustum).as_vec2();
        parts.uniforms.push(Uniform::of_light("falloff_place", index, place));
        let label = format!("distances of light {index}");
        parts.inputs.push(upload_values(format!("falloff_{index}"), label, &falloff.table.values, list));
    }
}

/// Scale and offset that make a distance, its inverse or its binary logarithm a texture coordinate at the centres of the first and the last
/// texel for the near and far planes; of entries, the planes' distances. The inverse stands for the depth in window space, z_t = (f - n f / d) / (f - n).
fn falloff_place(table: &DistanceTable, frustum: &Frustum) -> DVec2 {
    let (near, far) = (frustum.near, frustum.far);
    let range = far - near;
    let share = match table.steps {
        TableSteps::Distance => DVec2::new(1.0, -near) / range,
        TableSteps::Depth => DVec2::new(-near * far, far) / range,
        TableSteps::Logarithm => DVec2::new(1.0, -near.log2()) / (far / near).log2(),
        TableSteps::Entries => return DVec2::new(near, far),
    };
    let count = table.values.len() as f64;
    (share * (count - 1.0) + DVec2::new(0.0, 0.5)) / count
}

fn add_lighting(
    parts: &mut LightParts,
    source: &Light,
    spot: Option<&Spot>,
    viewer: &Viewer,
    term: &LightTerm,
    list: &mut PassList,
) {
    let index = parts.index;
    let position = eye_position(source, viewer);
    if parts.has_position {
        parts.uniforms.push(Uniform::of_light("light_position", index, position.truncate()));
    } else {
        parts.defines.push(Define::flag("DIRECTIONAL").of_light(index));
        parts.uniforms.push(Uniform::of_light("light_direction", index, position.truncate()));
    }
    parts.uniforms.push(Uniform::of_light("light_diffuse", index, Vec3::from(source.diffuse)));
    if parts.has_ambient {
        parts.defines.push(Define::flag("LIGHT_AMBIENT").of_light(index));
        parts.uniforms.push(Uniform::of_light("light_ambient", index, Vec3::from(source.ambient)));
    }
    if parts.has_attenuation {
        parts.defines.push(Define::flag("ATTENUATION").of_light(index));
        parts.uniforms.push(Uniform::of_light("attenuation", index, Vec3::from(source.attenuation())));
    }
    if !parts.has_cosine {
        parts.defines.push(Define::flag("NO_COSINE").of_light(index));
    }
    if term.dimming > 0.0 {
        parts.defines.push(Define::flag("DIMMING").of_light(index));
        parts.uniforms.push(Uniform::of_light("dimming", index, term.dimming));
    }
    if term.diffuse_weight < 1.0 {
        parts.defines.push(Define::flag("DIFFUSE_WEIGHT").of_light(index));
        parts.uniforms.push(Uniform::of_light("diffuse_weight", index, term.diffuse_weight));
    }
    if let Some(spot) = spot {
        add_projected(parts, spot, list);
    }
    parts.uniforms.push(Uniform::of_light("light_specular", index, Vec3::from(source.specular)));
}
