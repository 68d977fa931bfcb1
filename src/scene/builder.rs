//! Scenes from code. A builder makes the document that a scene file is read as: keys, ranges, defaults and errors are those of
//! a file, and an error names the line of code that set the key.

use std::panic::Location;
use std::path::Path;

use glam::{DVec2, DVec3};

use super::assets::Assets;
use super::settings::{Entry, Origin, Settings, SettingsError, Value};
use super::{Error, Loaded, ReadShadow, Scene, overrides, resolve};
use crate::geometry::{self, PRIMITIVES};

impl Scene {
    /// Starts a scene in code.
    ///
    /// ```
    /// use glumbra::prelude::*;
    ///
    /// let scene = Scene::builder()
    ///     .size([160, 120])
    ///     .camera([2.5, 4.5, 5.0], [0.0, 0.2, 0.0], 40.0)
    ///     .light(LightBuilder::spot([-2.0, 5.0, 1.5], [0.0; 3], 50.0).shadow("shadow-map").set("shadow.size", 512))
    ///     .object(ObjectBuilder::mesh("quad").name("floor").scale([8.0, 1.0, 8.0]))
    ///     .object(ObjectBuilder::mesh("box").at([0.0, 0.5, 0.0]).scale([0.5; 3]).color([0.8, 0.5, 0.3]))
    ///     .build()?
    ///     .scene;
    /// assert_eq!(scene.objects.len(), 2);
    ///
    /// // A wrong key is refused as in a file, with the line that set it.
    /// let error = Scene::builder().object(ObjectBuilder::mesh("box").set("colour", 1)).build().unwrap_err();
    /// assert!(error.to_string().contains("unknown key `colour`"), "{error}");
    /// # Ok::<(), glumbra::scene::Error>(())
    /// ```
    #[track_caller]
    pub fn builder() -> SceneBuilder {
        let origin = here();
        SceneBuilder {
            root: Settings { path: String::new(), origin, entries: Vec::new() },
            meshes: Vec::new(),
            wrong: None,
        }
    }
}

/// A scene that is being put together; [`SceneBuilder::build`] reads it. Keys are those of a scene file.
#[derive(Clone, Debug)]
#[must_use]
pub struct SceneBuilder {
    root: Settings,
    /// Meshes in memory.
    meshes: Vec<ObjText>,
    /// First key that could not be set.
    wrong: Option<SettingsError>,
}

/// A light that is being put together: the keys of `[[light]]`.
#[derive(Clone, Debug)]
#[must_use]
pub struct LightBuilder(Table);

/// An object that is being put together: the keys of `[[object]]`.
#[derive(Clone, Debug)]
#[must_use]
pub struct ObjectBuilder {
    table: Table,
    mesh: Option<ObjText>,
}

/// A mesh as the text of an OBJ file.
#[derive(Clone, Debug)]
struct ObjText {
    name: String,
    text: String,
    origin: Origin,
}

/// A table, and the first key that could not be set in it.
#[derive(Clone, Debug)]
struct Table {
    settings: Settings,
    wrong: Option<SettingsError>,
}

impl Table {
    fn new(path: &str, origin: Origin) -> Self {
        Self { settings: Settings { path: path.to_owned(), origin, entries: Vec::new() }, wrong: None }
    }

    fn set(&mut self, key: &str, value: Value, origin: Origin) {
        set(&mut self.settings, &mut self.wrong, key, value, origin);
    }
}

/// Line of the code outside of this file that is being run.
#[track_caller]
fn here() -> Origin {
    let place = Location::caller();
    Origin::Code { file: place.file(), line: place.line() }
}

fn set(table: &mut Settings, wrong: &mut Option<SettingsError>, key: &str, value: Value, origin: Origin) {
    if let Err(error) = overrides::set(table, key, placed(value, &origin)) {
        wrong.get_or_insert(error);
    }
}

/// A value whose parts all come from `origin`.
fn placed(value: Value, origin: &Origin) -> Entry {
    let value = match value {
        Value::Array(items) => Value::Array(items.into_iter().map(|item| placed(item.value, origin)).collect()),
        other => other,
    };
    Entry { value, origin: origin.clone() }
}

impl SceneBuilder {
    /// Width and height of the picture in pixels: `image.size`.
    #[track_caller]
    pub fn size(self, size: [u32; 2]) -> Self {
        self.set("image.size", size)
    }

    /// Colour of what no object covers, RGB in [0, 1]: `image.background`.
    #[track_caller]
    pub fn background(self, color: [f64; 3]) -> Self {
        self.set("image.background", color)
    }

    /// Ambient light, RGB in [0, 1]: `shading.ambient`.
    #[track_caller]
    pub fn ambient(self, color: [f64; 3]) -> Self {
        self.set("shading.ambient", color)
    }

    /// Camera at `eye` that looks at `target`, with a full vertical angle of `fov_y_degrees`. Its planes follow from the
    /// objects, unless `camera.near` and `camera.far` are set.
    #[track_caller]
    pub fn camera(self, eye: impl Into<DVec3>, target: impl Into<DVec3>, fov_y_degrees: f64) -> Self {
        self.set("camera.eye", eye.into()).set("camera.target", target.into()).set("camera.fov_y", fov_y_degrees)
    }

    /// Adds a light.
    pub fn light(mut self, light: LightBuilder) -> Self {
        self.push("light", light.0);
        self
    }

    /// Adds an object.
    pub fn object(mut self, object: ObjectBuilder) -> Self {
        self.push("object", object.table);
        self.meshes.extend(object.mesh);
        self
    }

    /// Sets any key, by its dotted name in a scene file: `camera.near`; `light.shadow.size` of each light so far,
    /// `light.0.cone` of one.
    #[track_caller]
    pub fn set(mut self, key: &str, value: impl Into<Value>) -> Self {
        set(&mut self.root, &mut self.wrong, key, value.into(), here());
        self
    }

    /// The document as the text of a scene file. Meshes in memory stand there by their names alone.
    pub fn to_toml(&self) -> String {
        self.root.to_toml()
    }

    /// Reads the document as [`super::load`] does; [`SceneBuilder::build`] has glumbra's own techniques read
    /// `[light.shadow]`.
    ///
    /// # Errors
    ///
    /// As [`super::load`]; the place is the line of code that set the key.
    #[doc(hidden)]
    pub fn build_with(self, shadows: &dyn ReadShadow) -> Result<Loaded, Error> {
        if let Some(error) = self.wrong {
            return Err(error.into());
        }
        let mut assets = Assets::default();
        for ObjText { name, text, origin } in self.meshes {
            if PRIMITIVES.contains(&name.as_str()) {
                let message = format!("a mesh cannot be named \"{name}\", which is built in");
                return Err(SettingsError::new(&origin, message).into());
            }
            let decoded = geometry::decode_obj(Path::new(&name), text.as_bytes());
            let (mesh, warnings) = decoded.map_err(|source| Error::Asset { origin, source })?;
            assets.give(&name, mesh, &warnings);
        }
        let scene = resolve::scene(&self.root, &mut assets, shadows)?;
        Ok(Loaded { scene, warnings: assets.warnings })
    }

    fn push(&mut self, key: &str, table: Table) {
        self.wrong = self.wrong.take().or(table.wrong);
        let origin = table.settings.origin.clone();
        let item = Entry { value: Value::Table(table.settings), origin: origin.clone() };
        match self.root.entries.iter_mut().find(|(name, _)| name == key) {
            Some((_, Entry { value: Value::Array(items), .. })) => items.push(item),
            _ => self.root.set(key, Entry { value: Value::Array(vec![item]), origin }),
        }
    }
}

impl LightBuilder {
    /// A spotlight at `position` that points at `target`; `cone_degrees` is its full angle.
    #[track_caller]
    pub fn spot(position: impl Into<DVec3>, target: impl Into<DVec3>, cone_degrees: f64) -> Self {
        let light = Self(Table::new("light", here())).set("kind", "spot");
        light.set("position", position.into()).set("target", target.into()).set("cone", cone_degrees)
    }

    /// A light at `position` that shines every way alike.
    #[track_caller]
    pub fn point(position: impl Into<DVec3>) -> Self {
        Self(Table::new("light", here())).set("kind", "point").set("position", position.into())
    }

    /// Parallel light that travels along `direction`.
    #[track_caller]
    pub fn directional(direction: impl Into<DVec3>) -> Self {
        Self(Table::new("light", here())).set("kind", "directional").set("direction", direction.into())
    }

    /// The technique of its shadow, by its name in a scene file: `shadow-map`, `shadow-volume` and so on.
    #[track_caller]
    pub fn shadow(self, technique: &str) -> Self {
        self.set("shadow.technique", technique)
    }

    /// Sets any key of `[[light]]`: `color`, `shadow.size`, `shadow.offset.factor`.
    #[track_caller]
    pub fn set(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.0.set(key, value.into(), here());
        self
    }
}

impl ObjectBuilder {
    /// An object with a built-in mesh (`box`, `quad`, `sphere` and so on), or one of a file, .obj or .md2, relative to the
    /// current folder.
    #[track_caller]
    pub fn mesh(mesh: &str) -> Self {
        Self { table: Table::new("object", here()), mesh: None }.set("mesh", mesh)
    }

    /// An object with a mesh that is the text of an OBJ file. Objects with meshes of one name have the last of them.
    #[track_caller]
    pub fn obj(name: &str, text: &str) -> Self {
        let mesh = ObjText { name: name.to_owned(), text: text.to_owned(), origin: here() };
        Self { mesh: Some(mesh), ..Self::mesh(name) }
    }

    /// An object with a mesh of triangles, three numbers of `positions` each, counter-clockwise from outside. Normals are made
    /// from the triangles, smooth up to 60 degrees.
    #[track_caller]
    pub fn triangles(name: &str, positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let vertices = positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let faces = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| u64::from(corner) + 1); // OBJ counts from 1
            format!("f {a} {b} {c}\n")
        });
        Self::obj(name, &vertices.chain(faces).collect::<String>())
    }

    /// Its name in messages and plans.
    #[track_caller]
    pub fn name(self, name: &str) -> Self {
        self.set("name", name)
    }

    /// Where its mesh's origin is placed, in world space: `translate`.
    #[track_caller]
    pub fn at(self, place: impl Into<DVec3>) -> Self {
        self.set("translate", place.into())
    }

    /// Scale along each axis, before it is rotated and placed.
    #[track_caller]
    pub fn scale(self, scale: impl Into<DVec3>) -> Self {
        self.set("scale", scale.into())
    }

    /// Rotation about an axis through its origin, after scaling.
    #[track_caller]
    pub fn rotate(self, axis: impl Into<DVec3>, degrees: f64) -> Self {
        self.set("rotate.axis", axis.into()).set("rotate.angle", degrees)
    }

    /// Diffuse colour, RGB in [0, 1]: `material.diffuse`.
    #[track_caller]
    pub fn color(self, color: [f64; 3]) -> Self {
        self.set("material.diffuse", color)
    }

    /// Sets any key of `[[object]]`: `casts_shadow`, `material.specular`.
    #[track_caller]
    pub fn set(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.table.set(key, value.into(), here());
        self
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Float(value)
    }
}

impl From<i32> for Value {
    fn from(value: i32) -> Self {
        Self::Integer(value.into())
    }
}

impl From<u32> for Value {
    fn from(value: u32) -> Self {
        Self::Integer(value.into())
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Boolean(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::String(value.to_owned())
    }
}

impl From<DVec2> for Value {
    fn from(value: DVec2) -> Self {
        value.to_array().into()
    }
}

impl From<DVec3> for Value {
    fn from(value: DVec3) -> Self {
        value.to_array().into()
    }
}

/// The places of the parts are set where the value is.
impl<T: Into<Self>, const N: usize> From<[T; N]> for Value {
    fn from(values: [T; N]) -> Self {
        let entry = |value: T| Entry { value: value.into(), origin: Origin::BuiltIn };
        Self::Array(values.into_iter().map(entry).collect())
    }
}
