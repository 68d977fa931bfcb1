//! The scene's objects as draws: one item for each mesh part and material.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, Vec4};

use super::Notes;
use super::appearance::Appearance;
use super::joined_batches::JoinedBatches;
use crate::geometry::{Derived, Gloss, Material, Placement, Texture, Wave};
use crate::math::Aabb;
use crate::pass::{
    AlphaTest, Attribute, Batch, Chunk, Define, Draw, Filter, FixedFunctionDesc, Format, ImageDesc, IndexOrder, Input,
    MeshRef, PassList, Primitive, Program, Sampler, Storage, Texturing, Uniform, Wrap, glsl,
};
use crate::scene::{ModelSkin, Object, Photo, Scene, photos_of};

/// A range of triangles with one material and one transform.
#[derive(Clone, Debug)]
pub struct Drawable {
    pub label: String,
    /// Index into [`Scene::objects`].
    pub object: usize,
    pub mesh: MeshRef,
    pub indices: std::ops::Range<u32>,
    /// Bounds in model space, with all that its wave can reach.
    pub bounds: Aabb,
    pub material: Arc<Material>,
    pub world_from_model: DMat4,
    /// Wave that moves its vertices in the vertex stage.
    pub wave: Option<Wave>,
    /// Its photograph: index into [`Scene::photos`].
    pub photo: Option<usize>,
    pub lit: bool,
    pub casts_shadow: bool,
    /// See [`crate::scene::Object::closed`]; false for waves, whose triangles may cross.
    pub closed: bool,
}

/// The scene's items: see [`items_of`].
pub fn items(scene: &Scene, moved: Option<&Derived>) -> Vec<Drawable> {
    items_of(&scene.objects, moved)
}

/// The objects' items, in their order. Successive parts of a mesh with one material are one item. Parts that the alpha test
/// would discard completely are left out. With `moved`, which keeps moved meshes, vertices that a wave moves are moved already.
pub fn items_of(objects: &[Object], moved: Option<&Derived>) -> Vec<Drawable> {
    let mut materials = Materials::default();
    let photos = photos_of(objects).into_iter().map(Arc::as_ptr).zip(0..);
    let photos: HashMap<*const Photo, usize> = photos.collect();
    let mut items: Vec<Drawable> = Vec::new();
    for (index, object) in objects.iter().enumerate() {
        let (mesh, wave) = match (object.wave, moved) {
            (Some(wave), Some(derived)) => (wave.moved_once(&object.mesh, derived), None),
            (wave, _) => (object.mesh.clone(), wave),
        };
        let photo = object.photo.as_ref().and_then(|own| photos.get(&Arc::as_ptr(own)).copied());
        let mut last_material: Option<Option<usize>> = None;
        for part in mesh.parts.iter().filter(|part| !part.indices.is_empty()) {
            let bounds = wave.map_or(part.bounds, |wave| wave.bounds(part.bounds));
            let own = if object.material.is_some() { None } else { part.material };
            if let (Some(last), Some(item)) = (last_material, items.last_mut())
                && last == own
                && item.indices.end == part.indices.start
            {
                item.indices.end = part.indices.end;
                item.bounds = item.bounds.union(bounds);
                continue;
            }
            let material = object.material.clone().unwrap_or_else(|| materials.of(&object.mesh, own));
            last_material = Some(own);
            items.push(Drawable {
                label: object.name.clone(),
                object: index,
                mesh: MeshRef(mesh.clone()),
                indices: part.indices.clone(),
                bounds,
                material,
                world_from_model: object.world_from_model,
                wave,
                photo,
                lit: object.lit,
                casts_shadow: object.casts_shadow,
                closed: object.closed && object.wave.is_none(),
            });
        }
    }
    items.retain(|item| item.material.opacity >= OPAQUE);
    items
}

/// Alpha below which the alpha test discards.
const OPAQUE: f32 = 0.5;

/// Notes what [`items`] leaves out because the alpha test would discard all of it.
pub fn note_clear(scene: &Scene, notes: &mut Notes) {
    for object in &scene.objects {
        let mut names: Vec<(&str, f32)> = Vec::new();
        for part in object.mesh.parts.iter().filter(|part| !part.indices.is_empty()) {
            let own = || object.mesh.materials.get(part.material?);
            let Some(material) = object.material.as_deref().or_else(own) else { continue };
            let named = (material.name.as_str(), material.opacity);
            if material.opacity < OPAQUE && !names.contains(&named) {
                names.push(named);
            }
        }
        for (name, opacity) in names {
            let why = format!("its opacity, {opacity}, is below {OPAQUE}: the alpha test discards all of it");
            notes.left_out(format!("{} where it has material \"{name}\"", object.name), why);
        }
    }
}

/// Notes which objects wear the skins that their models name, and which have none.
pub fn note_skins(scene: &Scene, notes: &mut Notes) {
    for object in &scene.objects {
        match &object.skin {
            None => {}
            Some(ModelSkin::Worn(path)) => {
                let why = "its model names this skin; `decal` of its material replaces it";
                notes.chosen(object.name.clone(), format!("decal {path}"), why);
            }
            Some(ModelSkin::Absent { name, why }) => {
                let why = format!("its model names the skin {name}: {why}; `decal` of its material names another");
                notes.chosen(object.name.clone(), "no decal", why);
            }
        }
    }
}

/// A mesh's materials, each shared by all its items.
#[derive(Default)]
struct Materials {
    shared: HashMap<(usize, Option<usize>), Arc<Material>>,
}

impl Materials {
    fn of(&mut self, mesh: &Arc<crate::geometry::Mesh>, index: Option<usize>) -> Arc<Material> {
        let key = (Arc::as_ptr(mesh) as usize, index);
        let find = || index.and_then(|i| mesh.materials.get(i)).cloned().unwrap_or_default();
        self.shared.entry(key).or_insert_with(|| Arc::new(find())).clone()
    }
}

/// Tests whether front faces wind clockwise under `clip_from_model`. A projection of ours turns right-handed eye space
/// into left-handed clip space, so its own determinant is negative.
pub fn mirrors(clip_from_model: &DMat4) -> bool {
    clip_from_model.determinant() > 0.0
}

impl Drawable {
    /// The draw under `clip_from_world`, with what a pass adds as uniforms.
    pub fn draw(&self, clip_from_world: &DMat4, mut uniforms: Vec<Uniform>) -> Draw {
        if let Some(wave) = &self.wave {
            uniforms.push(Uniform::new("wave_reach", wave.reach.as_vec3()));
            uniforms.push(Uniform::new("wave_vector", wave.vector.extend(wave.phase).as_vec4()));
        }
        Draw {
            label: self.label.clone(),
            mesh: self.mesh.clone(),
            primitive: Primitive::Triangles,
            indices: self.indices.clone(),
            order: IndexOrder::File,
            bounds: self.bounds,
            clip_from_model: *clip_from_world * self.world_from_model,
            eye_from_model: None,
            mirrored: mirrors(&(*clip_from_world * self.world_from_model)),
            uniforms,
        }
    }

    /// All that decides how its fragments look, wherever it is placed.
    pub fn appearance(&self) -> Appearance<'_> {
        let mesh_has = [self.mesh.texcoords.is_some(), self.mesh.tangents.is_some(), self.mesh.colors.is_some()];
        Appearance { material: &self.material, lit: self.lit, waves: self.wave.is_some(), mesh_has }
    }

    /// Tests whether fragments of it may fail the alpha test.
    pub fn needs_alpha_test(&self) -> bool {
        self.appearance().needs_alpha_test()
    }

    /// Tests whether its mesh has, or its material makes, texture coordinates.
    pub fn has_texcoords(&self) -> bool {
        self.appearance().has_texcoords()
    }

    /// The decal, where there are coordinates for it.
    pub fn decal(&self) -> Option<&Arc<Texture>> {
        self.appearance().decal()
    }

    /// The gloss, where there are coordinates for it.
    pub fn gloss(&self) -> Option<&Gloss> {
        self.appearance().gloss()
    }
}

/// Description of a batch that fixed function cannot express.
pub const WAVES: FixedFunctionDesc = FixedFunctionDesc::Shader("a surface that waves in the vertex stage");

/// The part of a shader variant that decides which fragments exist: shared by depth and lit passes.
#[derive(Default)]
pub struct Cutout {
    pub defines: Vec<Define>,
    pub vertex: Vec<Chunk>,
    pub fragment: Vec<Chunk>,
    pub attributes: Vec<Attribute>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
    /// Description of the texturing in the terms of fixed function.
    pub meaning: Texturing,
}

/// A decal repeats and is filtered by mipmaps.
pub const DECAL_SAMPLER: Sampler =
    Sampler { filter: Filter::Trilinear, wrap: Wrap::Repeat, compare: None, lod_halves: None };

/// Sampler of the alpha test: level 0 in every pass. Averages of smaller levels would close or open all small holes at
/// once, at another size for the eye than for the light.
pub const ALPHA_SAMPLER: Sampler =
    Sampler { filter: Filter::Linear, wrap: Wrap::Repeat, compare: None, lod_halves: None };

fn placed_by(placement: &Placement, sampler: Sampler) -> Sampler {
    if placement.clamped { Sampler { wrap: Wrap::ClampToEdge, ..sampler } } else { sampler }
}

/// The alpha test of `item`, and texture coordinates for it and for what the pass looks up: the decal where `decal` is
/// true, other textures where `others` is.
pub fn cutout(item: &Appearance<'_>, [decal, others]: [bool; 2], list: &mut PassList) -> Cutout {
    let material = item.material;
    let mut out = Cutout::default();
    let alpha_map = material.alpha.as_ref().filter(|_| item.has_texcoords());
    let tested = item.needs_alpha_test() && item.has_texcoords();
    let decal = item.decal().filter(|_| decal);
    if !tested && decal.is_none() && !(others && item.has_texcoords()) {
        return out;
    }
    out.vertex.push(glsl!("common/decal.vert"));
    out.meaning = Texturing {
        object_linear: material.texgen,
        alpha_test: tested.then(|| AlphaTest {
            opacity: material.opacity,
            decal: item.decal_alpha(),
            map_in_red: alpha_map.is_some_and(|texture| !texture.has_alpha),
        }),
        decal: decal.is_some(),
        decal_placement: material.decal_placement,
        alpha_placement: material.alpha_placement,
    };
    out.fragment.push(glsl!("common/placement.frag"));
    let decal_alpha = item.decal().filter(|_| tested && item.decal_alpha());
    let placed = [
        ("DECAL_PLACED", "decal_placement", material.decal_placement, decal.is_some() || decal_alpha.is_some()),
        ("ALPHA_PLACED", "alpha_placement", material.alpha_placement, alpha_map.is_some()),
    ];
    for (define, uniform, placement, _) in placed.into_iter().filter(|placed| placed.3 && !placed.2.is_plain()) {
        out.defines.push(Define::flag(define));
        out.uniforms.push(Uniform::new(uniform, Vec4::from(placement.scale_and_offset())));
    }
    if let Some(texgen) = &material.texgen {
        out.defines.push(Define::flag("OBJECT_LINEAR"));
        out.uniforms.push(Uniform::new("object_planes", vec![texgen.s.into(), texgen.t.into()]));
        out.uniforms.push(Uniform::new("texture_scale", texgen.scale));
    } else {
        out.attributes.push(Attribute::Texcoord);
    }
    if tested {
        out.defines.push(Define::flag("ALPHA_TEST"));
        out.fragment.push(glsl!("common/alpha_test.frag"));
        out.uniforms.push(Uniform::new("opacity", material.opacity));
    }
    if let Some(texture) = decal {
        out.inputs.push(upload("decal_map", texture, placed_by(&material.decal_placement, DECAL_SAMPLER), list));
    }
    if let Some(texture) = decal_alpha {
        out.defines.push(Define::flag("DECAL_ALPHA"));
        let sampler = placed_by(&material.decal_placement, ALPHA_SAMPLER);
        out.inputs.push(upload("decal_alpha_map", texture, sampler, list));
    }
    if let Some(texture) = alpha_map {
        out.defines.push(Define::word("ALPHA_MAP", if texture.has_alpha { "a" } else { "r" }));
        out.inputs.push(upload("alpha_map", texture, placed_by(&material.alpha_placement, ALPHA_SAMPLER), list));
    }
    out
}

/// The batches that draw the depth of `items` alone, with holes where the alpha test makes them.
pub fn depth_batches(items: &[&Drawable], clip_from_world: &DMat4, list: &mut PassList) -> Vec<Batch> {
    let mut joined = JoinedBatches::default();
    // Without an alpha test, all that waves is alike, and all that does not.
    let mut known: HashMap<(bool, Option<Appearance<'_>>), usize> = HashMap::new();
    for item in items {
        let draw = item.draw(clip_from_world, Vec::new());
        let tested = Some(item.appearance()).filter(Appearance::needs_alpha_test);
        let mut add = || joined.place(depth_batch(item.wave.is_some(), tested.as_ref(), list));
        let place = *known.entry((item.wave.is_some(), tested)).or_insert_with(&mut add);
        joined.batches[place].draws.push(draw);
    }
    joined.batches
}

/// The batch of surfaces that wave or do not, and whose fragments `tested` tests, without draws.
fn depth_batch(waves: bool, tested: Option<&Appearance<'_>>, list: &mut PassList) -> Batch {
    let test = tested.map(|tested| cutout(tested, [false; 2], list)).unwrap_or_default();
    let mut vertex = vec![glsl!("common/position.vert")];
    vertex.extend(test.vertex);
    vertex.push(glsl!("common/depth.vert"));
    let mut fragment = test.fragment;
    fragment.push(glsl!("common/depth.frag"));
    let mut attributes = vec![Attribute::Position];
    attributes.extend(test.attributes);
    let mut defines = test.defines;
    if waves {
        defines.push(Define::flag("WAVE"));
    }
    Batch {
        program: Program { label: String::from("depth"), defines, vertex, fragment, attributes },
        meaning: if waves { WAVES } else { FixedFunctionDesc::Depth(test.meaning) },
        uniforms: test.uniforms,
        inputs: test.inputs,
        cull: None,
        scissor: None,
        clip_planes: 0,
        draws: Vec::new(),
    }
}

/// Binds the texture of two texels for a spotlight's sides: 0 behind it, 1 before [LEC, "Careful about Back Projecting
/// Shadow Maps"].
pub fn side_map(name: impl Into<std::borrow::Cow<'static, str>>, list: &mut PassList) -> Input {
    const TEXELS: &[[u8; 4]] = &[[0; 4], [255; 4]];
    let (label, size) = (String::from("sides of a light"), [TEXELS.len() as u32, 1]);
    let image = list.filled_image(ImageDesc { label, size, format: Format::Rgba8, storage: Storage::Line(TEXELS) });
    let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    Input { name: name.into(), image, sampler }
}

/// Binds a spotlight's law of distance.
pub fn upload_values(
    name: impl Into<std::borrow::Cow<'static, str>>,
    label: String,
    values: &Arc<[f32]>,
    list: &mut PassList,
) -> Input {
    let (storage, size) = (Storage::Values(values.clone()), [values.len() as u32, 1]);
    let image = list.filled_image(ImageDesc { label, size, format: Format::R32F, storage });
    let sampler = Sampler { filter: Filter::Linear, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    Input { name: name.into(), image, sampler }
}

/// Binds a texture of the scene; the same one becomes one image however often it is bound.
pub fn upload(
    name: impl Into<std::borrow::Cow<'static, str>>,
    texture: &Arc<Texture>,
    sampler: Sampler,
    list: &mut PassList,
) -> Input {
    let image = list.filled_image(ImageDesc {
        label: texture.name.clone(),
        size: [texture.width, texture.height],
        format: Format::Rgba8,
        storage: Storage::Uploaded(texture.clone()),
    });
    Input { name: name.into(), image, sampler }
}
