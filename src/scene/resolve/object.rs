//! `[[object]]`: a mesh, its placement and its material.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::instances::{self, Instance};
use super::photo::PhotoKeys;
use super::pose::WrittenPose;
use super::{material, placement};
use crate::geometry::md2::{NormalSource, Pose};
use crate::geometry::tangents::BasisCounts;
use crate::geometry::{Gloss, Material, Mesh, Moment, PlacedMesh, Texture, Wave};
use crate::scene::assets::Assets;
use crate::scene::ranges::LARGEST;
use crate::scene::settings::{Origin, Plain, Reader, Settings, SettingsError};
use crate::scene::{Error, ModelSkin, Object, Shading};

/// Resolves one object, each of its instances as an object of its own, and reads its photograph.
///
/// `shading`: how its surface will be lit.
pub(in crate::scene) fn read(
    table: &Settings,
    shading: &Shading,
    assets: &mut Assets,
) -> Result<(Vec<Object>, Option<PhotoKeys>), Error> {
    let mut reader = table.read();
    let (mesh, mesh_origin) = reader.file("mesh")?.ok_or_else(|| {
        reader.missing("mesh", "a built-in mesh, or a file that ends in .obj, .md2, .gltf, .glb, .ply or .stl")
    })?;
    let name = reader.string("name")?.unwrap_or(mesh).to_owned();
    let world_from_file = placement::read(&mut reader)?;
    let instances = instances::read(&mut reader)?;
    let pose = WrittenPose::read(&mut reader, table.read())?;
    let moment = moment(&mut reader)?;
    let wave = reader.table("wave")?.map(wave).transpose()?.flatten();
    let lit = reader.boolean("lit")?.unwrap_or(true);
    let casts_shadow = reader.boolean("casts_shadow")?.unwrap_or(true);
    let closed = reader.boolean("closed")?.unwrap_or(false);
    let material = reader.table("material")?;
    reader.finish()?;
    let (material, photo) = material.map(|table| material::read(table, &name, assets)).transpose()?.unzip();
    let photo = photo.flatten();
    let keys = ObjectKeys { name, world_from_file, wave, material, lit, casts_shadow, closed };
    let found = match assets.placed(mesh, mesh_origin, moment.as_ref())? {
        Some(placed) => {
            pose.refuse()?;
            let is_single = placed.len() == 1;
            placed.into_iter().map(|placed| keys.found(placed, is_single)).collect()
        }
        None => {
            table.read().refuse(&["at", "animation"], "belongs to animated models, .gltf or .glb")?;
            let (posed, pose) = assets.mesh(mesh, mesh_origin, &pose)?;
            let skin = || assets.skin(mesh, mesh_origin);
            let (material, skin) = with_skin(keys.material.clone(), &keys.name, skin);
            vec![Found { name: keys.name.clone(), mesh: posed, file_from_mesh: None, pose, material, skin }]
        }
    };
    let mut objects = Vec::with_capacity(found.len());
    for found in found {
        let file_from_mesh = found.file_from_mesh;
        let object = keys.object(found, table, shading)?;
        warn_of_clear(&object, table, assets);
        match &instances {
            None => {
                check_reach(&object, &table.origin)?;
                objects.push(object);
            }
            Some(instances) => objects.extend(placed(&object, &world_from_file, file_from_mesh, instances)?),
        }
    }
    Ok((objects, photo))
}

/// `at` and `animation`: a time of an animation of the object's file.
pub(in crate::scene) fn moment(reader: &mut Reader<'_>) -> Result<Option<Moment>, SettingsError> {
    let seconds = reader.number("at", 0.0..=LARGEST)?;
    let animation = reader.string("animation")?.map(str::to_owned);
    match (seconds, &animation) {
        (None, Some(_)) => Err(reader.error("animation", "needs `at`: its time in seconds")),
        (seconds, _) => Ok(seconds.map(|seconds| Moment { seconds, animation })),
    }
}

/// Keys of an object, which all meshes of its file share.
struct ObjectKeys {
    name: String,
    world_from_file: DMat4,
    wave: Option<Wave>,
    material: Option<Arc<Material>>,
    lit: bool,
    casts_shadow: bool,
    closed: bool,
}

/// A mesh of an object's file.
struct Found {
    name: String,
    mesh: Arc<Mesh>,
    /// Its place in the file; `None`: the file places nothing.
    file_from_mesh: Option<DMat4>,
    pose: Option<(Pose, NormalSource)>,
    material: Option<Arc<Material>>,
    skin: Option<ModelSkin>,
}

impl ObjectKeys {
    /// A mesh that a file places. One of several is called by its node, too.
    fn found(&self, placed: PlacedMesh, is_single: bool) -> Found {
        let name = if is_single { self.name.clone() } else { format!("{}/{}", self.name, placed.name) };
        let (material, file_from_mesh) = (self.material.clone(), Some(placed.world_from_model));
        Found { name, mesh: placed.mesh, file_from_mesh, pose: None, material, skin: None }
    }

    fn object(&self, found: Found, table: &Settings, shading: &Shading) -> Result<Object, SettingsError> {
        let Found { name, mesh, file_from_mesh, pose, material, skin } = found;
        if material.as_ref().is_some_and(|own| own.gloss == Some(Gloss::DecalAlpha) && own.decal.is_none()) {
            let message = "has gloss = \"decal-alpha\", and there is no `decal`";
            return Err(table.read().error("material", message));
        }
        if material.is_none() && shading.per_vertex && mesh.materials.iter().any(|own| own.bump.is_some()) {
            let message =
                "has a normal map, which lighting = \"per-vertex\" of [shading] cannot show: write a `material`";
            return Err(table.read().error("mesh", message));
        }
        let has_own_bumps = material.is_none() && mesh.materials.iter().any(|own| own.bump.is_some());
        let (mesh, bases) = with_bases(mesh, material.as_deref(), shading, table)?;
        let triangles = mesh.triangle_count();
        let own_bases = || BasisCounts { triangles, from_mesh: true, ..BasisCounts::default() };
        let bases = bases.or(has_own_bumps.then(own_bases));
        if let Some(why) = self.closed.then(|| mesh.why_not_closed()).flatten() {
            return Err(table.read().error("closed", format_args!("is not true: {why}")));
        }
        let world_from_mesh = file_from_mesh.map_or(self.world_from_file, |placed| self.world_from_file * placed);
        let world_from_model = world_from_mesh * DMat4::from_translation(mesh.origin);
        let wave = self.wave.map(|wave| wave.relative_to(mesh.origin));
        let material = material.map(|material| relative_to(material, mesh.origin));
        Ok(Object {
            name,
            mesh,
            world_from_model,
            wave,
            material,
            skin,
            photo: None,
            pose,
            bases,
            lit: self.lit,
            casts_shadow: self.casts_shadow,
            closed: self.closed,
        })
    }
}

/// A copy of `object` at each of the places, with the mesh and the material that it has. `world_from_group`: the object's own
/// placement, which moves all of them.
fn placed(
    object: &Object,
    world_from_group: &DMat4,
    file_from_mesh: Option<DMat4>,
    instances: &[Instance],
) -> Result<Vec<Object>, SettingsError> {
    let is_moved = *world_from_group != DMat4::IDENTITY;
    let place = |(number, instance): (usize, &Instance)| {
        // A product with the identity may change the sign of a zero.
        let world_from_file = if is_moved { *world_from_group * instance.placement } else { instance.placement };
        let world_from_mesh = file_from_mesh.map_or(world_from_file, |placed| world_from_file * placed);
        let world_from_model = world_from_mesh * DMat4::from_translation(object.mesh.origin);
        let placed = Object { name: format!("{}[{number}]", object.name), world_from_model, ..object.clone() };
        check_reach(&placed, &instance.origin)?;
        Ok(placed)
    };
    instances.iter().enumerate().map(place).collect()
}

/// Exponent of specular light that three squarings make.
const COMBINED_SHININESS: f32 = 8.0;

/// The material with the skin that the object's model names, where it has no decal of its own.
fn with_skin(
    material: Option<Arc<Material>>,
    owner: &str,
    find: impl FnOnce() -> Option<(ModelSkin, Option<Arc<Texture>>)>,
) -> (Option<Arc<Material>>, Option<ModelSkin>) {
    if material.as_ref().is_some_and(|material| material.decal.is_some()) {
        return (material, None);
    }
    match find() {
        None => (material, None),
        Some((skin, None)) => (material, Some(skin)),
        Some((skin, decal)) => {
            let name = format!("material of {owner}");
            let own = material.map_or_else(|| Material { name, ..Material::default() }, |own| (*own).clone());
            (Some(Arc::new(Material { decal, ..own })), Some(skin))
        }
    }
}

/// The mesh with the bases that a bump map needs.
fn with_bases(
    mesh: Arc<Mesh>,
    material: Option<&Material>,
    shading: &Shading,
    table: &Settings,
) -> Result<(Arc<Mesh>, Option<BasisCounts>), SettingsError> {
    let Some((material, bump)) = material.and_then(|material| Some((material, material.bump.as_ref()?))) else {
        return Ok((mesh, None));
    };
    let error = |message: &str| Err(table.read().error("material", message));
    let shines = material.specular != [0.0; 3] && material.shininess != COMBINED_SHININESS;
    if shines && shading.bumps.squares_eighth() {
        let message = format_args!(
            "has a `shininess` of {}, and the register combiners of bump = \"{}\" square three times: write shininess = 8, or \
             choose bump = \"reference\"",
            material.shininess,
            shading.bumps.method.name()
        );
        return Err(table.read().error("material", message));
    }
    if shading.per_vertex {
        return error("has a `bump`, which lighting = \"per-vertex\" of [shading] cannot show: leave one of them out");
    }
    let generated = material.texgen.as_ref().map(|texgen| |vertex: usize| texgen.texcoord(mesh.positions[vertex]));
    let texcoord = generated.as_ref().map(|generated| generated as &dyn Fn(usize) -> [f64; 2]);
    match mesh.with_bases(bump.fit, texcoord) {
        Some((based, counts)) => Ok((Arc::new(based), Some(counts))),
        None => error("has a `bump`, and the mesh has no texture coordinates for it: give it vt lines, or a `texgen`"),
    }
}

/// Warns of parts that the alpha test discards completely.
fn warn_of_clear(object: &Object, table: &Settings, assets: &mut Assets) {
    let has_texcoords = object.mesh.texcoords.is_some();
    let gone = "at most: below 0.5 the alpha test discards all";
    if let Some(material) = &object.material {
        let most = material.most_alpha(has_texcoords);
        if most < 0.5 {
            let what = format!("leaves an alpha of {most} {gone} of object \"{}\", and its shadow", object.name);
            assets.warn(table.read().error("material", what).to_string());
        }
        return;
    }
    for (index, material) in object.mesh.materials.iter().enumerate() {
        let parts = object.mesh.parts.iter().filter(|part| part.material == Some(index));
        let triangles = parts.map(|part| part.indices.len() / 3).sum::<usize>();
        let most = if triangles > 0 { material.most_alpha(has_texcoords) } else { 1.0 };
        if most < 0.5 {
            let origin = if material.opacity_origin.is_empty() { &object.mesh.name } else { &material.opacity_origin };
            let hint = if origin.contains(": Tr ") { "; if Tr was meant as an opacity, write d" } else { "" };
            assets.warn(format!(
                "{origin}: material \"{}\" leaves an alpha of {most} {gone} that has it, and its shadow: {triangles} triangles of \
                 object \"{}\"{hint}",
                material.name, object.name
            ));
        }
    }
}

/// A material whose generated coordinates are those of the file's space.
fn relative_to(material: Arc<Material>, origin: DVec3) -> Arc<Material> {
    match material.texgen {
        Some(texgen) => Arc::new(Material { texgen: Some(texgen.relative_to(origin)), ..(*material).clone() }),
        None => material,
    }
}

/// `{ direction, amplitude, axis, wavelength, phase }`, in model space; `None` where nothing moves.
fn wave(table: &Settings) -> Result<Option<Wave>, SettingsError> {
    let mut reader = table.read();
    let mut way = |key, what| {
        let vector = reader.vector(key)?.ok_or_else(|| reader.missing(key, what))?;
        vector.try_normalize().ok_or_else(|| reader.error(key, "must not be of zero length"))
    };
    let direction = way("direction", "the way that vertices move, [x, y, z]")?;
    let axis = way("axis", "the way from crest to crest, [x, y, z]")?;
    let amplitude = reader
        .number("amplitude", -LARGEST..=LARGEST)?
        .ok_or_else(|| reader.missing("amplitude", "how far vertices move"))?;
    let wavelength =
        reader.length("wavelength")?.ok_or_else(|| reader.missing("wavelength", "the length from crest to crest"))?;
    let phase = reader.number("phase", -LARGEST..=LARGEST)?.unwrap_or(0.0);
    reader.finish()?;
    let wave = Wave { reach: amplitude * direction, vector: axis / wavelength, phase: phase.rem_euclid(1.0) };
    Ok((amplitude != 0.0).then_some(wave))
}

/// Refuses an object with a corner so far out that f32 cannot hold its square.
fn check_reach(object: &Object, origin: &Origin) -> Result<(), SettingsError> {
    let bounds = object.world_bounds();
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    if bounds.is_empty() || reach <= LARGEST {
        return Ok(());
    }
    let message = format!(
        "object \"{}\" reaches out to {}; coordinates may be {} at most",
        object.name,
        Plain(reach),
        Plain(LARGEST)
    );
    Err(SettingsError::new(origin, message))
}
