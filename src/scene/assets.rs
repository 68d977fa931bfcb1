//! The files that a scene names: each is loaded once however often it is used, and its loader's warnings are kept.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::resolve::pose::WrittenPose;
use super::settings::{Origin, SettingsError, suggest};
use super::{Error, ModelSkin};
use crate::geometry::bump::NormalFormat;
use crate::geometry::normal_map::{self, Difference, HeightField, HeightWrap, MipColors};
use crate::geometry::tangents::BasisFit;
use crate::geometry::{self, Bump, Mesh, ModelWorld, Moment, Named, PlacedMesh, Texture, find_file, md2};
use crate::math::Aabb;

/// Ends of the names of files that have a mesh.
pub(super) const MODELS: [&str; 6] = ["obj", "md2", "gltf", "glb", "ply", "stl"];

/// [`MODELS`] in words.
pub(super) const ENDINGS: &str = ".obj, .md2, .gltf, .glb, .ply or .stl";

/// Those of files whose nodes place several meshes.
const WORLDS: [&str; 2] = ["gltf", "glb"];

/// The model of a file or of a built-in name.
#[derive(Clone)]
pub(super) enum Model {
    /// One pose.
    Still(Arc<Mesh>),
    KeyFramed(Arc<md2::Model>),
    /// Meshes that nodes place.
    World(Arc<ModelWorld>),
}

impl Model {
    /// Bounds in the file's space, of the first frame.
    pub fn bounds(&self) -> Aabb {
        let whole = |mesh: &Mesh| Aabb { min: mesh.bounds.min + mesh.origin, max: mesh.bounds.max + mesh.origin };
        match self {
            Self::Still(mesh) => whole(mesh),
            Self::KeyFramed(model) => whole(&model.mesh(&md2::Pose::default(), md2::NormalSource::File)),
            Self::World(world) => world.bounds(),
        }
    }

    /// Meshes, cameras and lights that the file places; `None`: a single mesh.
    pub fn world(&self) -> Option<&Arc<ModelWorld>> {
        if let Self::World(world) = self { Some(world) } else { None }
    }
}

/// A file's only pose, and its warnings.
fn still((mesh, warnings): (Mesh, Vec<geometry::Warning>)) -> (Model, Vec<geometry::Warning>) {
    (Model::Still(Arc::new(mesh)), warnings)
}

fn key_framed((model, warnings): (md2::Model, Vec<geometry::Warning>)) -> (Model, Vec<geometry::Warning>) {
    (Model::KeyFramed(Arc::new(model)), warnings)
}

/// A bump map as written: objects with the same one share it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct BumpKey {
    pub file: Option<PathBuf>,
    pub is_height: bool,
    pub scale_bits: Option<u64>,
    pub difference: Option<Difference>,
    pub green: Option<bool>,
    pub format: NormalFormat,
    pub colors: MipColors,
    pub border: HeightWrap,
    pub fit: BasisFit,
}

/// A mesh, and its pose if its model is key-framed.
pub(super) type Posed = (Arc<Mesh>, Option<(md2::Pose, md2::NormalSource)>);

/// A pose of a file's model, bit for bit.
type PoseKey = (PathBuf, [usize; 2], u64, md2::NormalSource);

/// A file at a time, bit for bit, of an animation.
type MomentKey = (PathBuf, u64, Option<String>);

/// Files in memory, each by its name.
type Files = &'static [(&'static str, &'static [u8])];

/// Meshes and textures loaded so far.
#[derive(Default)]
pub(super) struct Assets {
    /// Models by built-in name, or by the file's canonical path.
    models: HashMap<PathBuf, Model>,
    /// Meshes of key-framed models.
    poses: HashMap<PoseKey, Arc<Mesh>>,
    /// Files whose nodes place meshes, at a time of an animation.
    moments: HashMap<MomentKey, Arc<ModelWorld>>,
    textures: HashMap<PathBuf, Arc<Texture>>,
    /// Bump maps by all that their files and keys say.
    pub bumps: HashMap<BumpKey, Arc<Bump>>,
    /// Pictures and models in memory, by the names that the scene file has for them.
    pictures: Files,
    files: Files,
    /// Warnings of the loaders and of the scene, each once.
    pub warnings: Vec<String>,
    /// Warnings that were kept.
    said: HashSet<String>,
}

impl Assets {
    /// Assets with pictures and models in memory, each by its name in the scene file.
    pub fn with_files(pictures: Files, models: Files) -> Self {
        Self { pictures, files: models, ..Self::default() }
    }

    /// A built-in mesh, or one of a file named from `origin`, in a pose if its model is key-framed.
    pub fn mesh(&mut self, name: &str, origin: &Origin, pose: &WrittenPose<'_>) -> Result<Posed, Error> {
        let path = file(name, origin);
        let model = match self.primitive(name) {
            Some(model) => model,
            None if is_model(&path) => {
                let bytes = embedded(self.files, name, origin);
                self.model_in(&path, bytes).map_err(|source| Error::Asset { origin: origin.clone(), source })?
            }
            None => {
                let hint = suggest(name, geometry::PRIMITIVES.iter().copied());
                let message =
                    format!("no mesh \"{name}\": neither built in ({hint}) nor a file that ends in {ENDINGS}");
                return Err(SettingsError::new(origin, message).into());
            }
        };
        match model {
            Model::Still(mesh) => {
                pose.refuse()?;
                Ok((mesh, None))
            }
            Model::World(_) => Err(SettingsError::new(origin, format!("\"{name}\" is no single mesh")).into()),
            Model::KeyFramed(model) => {
                let (pose, source) = pose.resolve(&model)?;
                let key = (canonical(&path), pose.frames, pose.blend.to_bits(), source);
                let mesh = self.poses.entry(key).or_insert_with(|| Arc::new(model.mesh(&pose, source)));
                Ok((mesh.clone(), Some((pose, source))))
            }
        }
    }

    /// The meshes of `name`, a file whose nodes place them, or one of its nodes or meshes, `file#name`; `None`: it is a file
    /// of another kind, or none.
    pub fn placed(
        &mut self,
        name: &str,
        origin: &Origin,
        moment: Option<&Moment>,
    ) -> Result<Option<Vec<PlacedMesh>>, Error> {
        let (of_file, part) = split_part(name);
        let path = file(of_file, origin);
        if !is_world(&path) {
            return Ok(None);
        }
        let bytes = embedded(self.files, of_file, origin);
        let model = self.model_in(&path, bytes).map_err(|source| Error::Asset { origin: origin.clone(), source })?;
        let Model::World(still) = model else { return Ok(None) };
        let world = match moment {
            None => still,
            Some(moment) => {
                let world = self.at(&path, moment);
                world.map_err(|source| Error::Asset { origin: origin.clone(), source })?
            }
        };
        let Some(part) = part else { return Ok(Some(world.meshes.clone())) };
        let refuse = |what: String| Err(SettingsError::new(origin, format!("{}: {what}", path.display())).into());
        match world.named(part) {
            Named::Node(meshes, _) if meshes.is_empty() => {
                refuse(format!("no node at or below \"{part}\" has a mesh of triangles"))
            }
            Named::Node(meshes, others) => {
                if others > 0 {
                    self.warn(format!("{origin}: {others} other nodes of {} are called \"{part}\"", path.display()));
                }
                Ok(Some(meshes))
            }
            Named::Mesh(mesh) => Ok(Some(vec![mesh])),
            Named::Unknown(names) => {
                let hint = suggest(part, names.iter().map(String::as_str));
                refuse(format!("no node and no mesh is called \"{part}\": {hint}"))
            }
        }
    }

    /// Keeps a warning, once.
    pub fn warn(&mut self, warning: String) {
        if self.said.insert(warning.clone()) {
            self.warnings.push(warning);
        }
    }

    /// A file whose nodes place meshes, at a time of an animation.
    pub fn at(&mut self, path: &Path, moment: &Moment) -> Result<Arc<ModelWorld>, geometry::Error> {
        let key = (canonical(path), moment.seconds.to_bits(), moment.animation.clone());
        if let Some(known) = self.moments.get(&key) {
            return Ok(known.clone());
        }
        // What is odd about the file was said when it was read first.
        let (world, _) = geometry::load_gltf(path, Some(moment))?;
        let world = Arc::new(world);
        self.moments.insert(key, world.clone());
        Ok(world)
    }

    /// A file's model.
    pub fn model(&mut self, path: &Path) -> Result<Model, geometry::Error> {
        self.model_in(path, None)
    }

    fn model_in(&mut self, path: &Path, embedded: Option<&[u8]>) -> Result<Model, geometry::Error> {
        let key = canonical(path);
        if let Some(model) = self.models.get(&key) {
            return Ok(model.clone());
        }
        let (model, warnings) = match embedded {
            Some(_) if is_world(path) || has_extension(path, "ply") || has_extension(path, "stl") => {
                return Err(geometry::Error::Embedded { path: path.to_owned() });
            }
            None if is_world(path) => {
                let (world, warnings) = geometry::load_gltf(path, None)?;
                (Model::World(Arc::new(world)), warnings)
            }
            None if has_extension(path, "ply") => still(geometry::load_ply(path)?),
            None if has_extension(path, "stl") => still(geometry::load_stl(path)?),
            Some(bytes) if has_extension(path, "md2") => key_framed(md2::Model::decode(path, bytes)?),
            None if has_extension(path, "md2") => key_framed(md2::Model::load(path)?),
            Some(bytes) => still(geometry::decode_obj(path, bytes)?),
            None => still(geometry::load_obj(path)?),
        };
        warnings.iter().for_each(|warning| self.warn(warning.to_string()));
        self.models.insert(key, model.clone());
        Ok(model)
    }

    /// Registers a model under `name` too, for paths that are not UTF-8.
    pub fn also_known_as(&mut self, name: &str, model: &Model) {
        self.models.insert(canonical(Path::new(name)), model.clone());
    }

    /// Adds a mesh in memory, which objects call `name`.
    pub fn give(&mut self, name: &str, mesh: Mesh, warnings: &[geometry::Warning]) {
        warnings.iter().for_each(|warning| self.warn(warning.to_string()));
        self.models.insert(PathBuf::from(name), Model::Still(Arc::new(mesh)));
    }

    /// A picture file named from `origin`.
    pub fn texture(&mut self, name: &str, origin: &Origin) -> Result<Arc<Texture>, Error> {
        let path = file(name, origin);
        let key = canonical(&path);
        if let Some(texture) = self.textures.get(&key) {
            return Ok(texture.clone());
        }
        let texture = match embedded(self.pictures, name, origin) {
            Some(bytes) => geometry::decode_texture(&path, bytes),
            None => geometry::load_texture(&path),
        };
        let texture = Arc::new(texture.map_err(|source| Error::Asset { origin: origin.clone(), source })?);
        self.textures.insert(key, texture.clone());
        Ok(texture)
    }

    /// The heights of a picture file named from `origin`.
    pub fn heights(&mut self, name: &str, origin: &Origin) -> Result<HeightField, Error> {
        let path = file(name, origin);
        let heights = match embedded(self.pictures, name, origin) {
            Some(bytes) => normal_map::decode_heights(&path, bytes),
            None => normal_map::load_heights(&path),
        };
        heights.map_err(|source| Error::Asset { origin: origin.clone(), source })
    }

    /// The first skin that the model of [`Self::mesh`] names, looked for beside its file by its name alone; Quake II's `.pcx`,
    /// which cannot be read, as a picture of another kind, too. `None`: the mesh is no key-framed model, or names no skin.
    pub fn skin(&mut self, name: &str, origin: &Origin) -> Option<(ModelSkin, Option<Arc<Texture>>)> {
        let path = file(name, origin);
        let Some(Model::KeyFramed(model)) = self.models.get(&canonical(&path)) else { return None };
        let written = md2::text(model.file().skins.first()?);
        let bare = written.rsplit(['/', '\\']).next().filter(|bare| !bare.is_empty())?.to_owned();
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let others = ["png", "jpg", "tga", "bmp"].map(|kind| Path::new(&bare).with_extension(kind));
        let others = others.iter().filter_map(|name| name.to_str());
        let mut why = format!("no file {bare} is beside it");
        for found in std::iter::once(bare.as_str()).chain(others).filter_map(|name| find_file(&folder, name)) {
            let key = canonical(&found);
            let known = self.textures.get(&key).cloned();
            match known.map_or_else(|| geometry::load_texture(&found).map(Arc::new), Ok) {
                Ok(texture) => {
                    self.textures.insert(key, texture.clone());
                    return Some((ModelSkin::Worn(found.display().to_string()), Some(texture)));
                }
                Err(error) => why = error.to_string(),
            }
        }
        Some((ModelSkin::Absent { name: written, why }, None))
    }

    fn primitive(&mut self, name: &str) -> Option<Model> {
        if let Some(model) = self.models.get(Path::new(name)) {
            return Some(model.clone());
        }
        let model = Model::Still(Arc::new(geometry::primitive(name)?));
        self.models.insert(PathBuf::from(name), model.clone());
        Some(model)
    }
}

/// The file in memory that a scene file names.
fn embedded(files: Files, name: &str, origin: &Origin) -> Option<&'static [u8]> {
    let by_the_file = matches!(origin, Origin::File { .. });
    files.iter().find(|(known, _)| by_the_file && *known == name).map(|(_, bytes)| *bytes)
}

/// A file's name is relative to the scene file that names it; on the command line and in code, to the current folder.
pub(super) fn file(name: &str, origin: &Origin) -> PathBuf {
    match origin {
        Origin::File { path, .. } => path.parent().unwrap_or(Path::new("")).join(name),
        Origin::CommandLine(_) | Origin::Code { .. } | Origin::BuiltIn => PathBuf::from(name),
    }
}

/// Path that identifies a file; absolute, so never a built-in's name.
fn canonical(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| Path::new("/").join(path))
}

/// Tests whether `path` ends as a model's does.
pub fn is_model(path: &Path) -> bool {
    MODELS.iter().any(|extension| has_extension(path, extension))
}

/// Tests whether `path` ends as a file's does whose nodes place meshes.
fn is_world(path: &Path) -> bool {
    WORLDS.iter().any(|extension| has_extension(path, extension))
}

/// Tests whether the mesh of this name may have animations.
pub(super) fn is_animated(mesh: &str) -> bool {
    is_world(Path::new(split_part(mesh).0))
}

/// The file's name, and the node's or mesh's behind it: `room.glb#Chair`.
pub(super) fn split_part(name: &str) -> (&str, Option<&str>) {
    let mut marks = name.match_indices('#').map(|(at, _)| at);
    match marks.find(|at| is_world(Path::new(&name[..*at]))) {
        Some(at) => (&name[..at], Some(&name[at + 1..])),
        None => (name, None),
    }
}

/// Tests whether `path` ends in `.extension`, in whatever case.
pub(super) fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
