//! Shadow settings from `[light.shadow]`: read once, when a scene is loaded, with every error that they can have. What is
//! read describes its light in any plan, and cannot fail.

use std::path::Path;

use super::common::CommonKeys;
use super::none::Unshadowed;
use super::{DEFAULT_MAP_SIZE, MapSettings, ShadowSettings, TABLE, Technique, stencil_guard};
use crate::lights::guard::Guard;
use crate::lights::{LightTerm, LightView, Notes};
use crate::pass::PassList;
use crate::scene::{
    self, Embedded, Entry, LightKind, Loaded, Object, ReadShadow, Reader, Scene, Settings, SettingsError, Shadow,
    Value, ValueForm, suggest,
};

/// A light's technique, and the keys that it has read.
pub struct LightShadow {
    pub technique: &'static dyn Technique,
    /// Keys of every light.
    pub common: CommonKeys,
    settings: Box<dyn ShadowSettings>,
}

impl LightShadow {
    /// The settings of a light that was loaded by [`load`] or read by [`read`]; `None` if something else has read them.
    pub fn of(shadow: &Shadow) -> Option<&Self> {
        shadow.settings()
    }

    /// Adds the passes that prepare the light to `list`, and returns the light's term for the lit pass. Notes in `notes`
    /// what is left out.
    pub fn describe(&self, view: &LightView<'_>, list: &mut PassList, notes: &mut Notes) -> LightTerm {
        let first = list.passes.len();
        let mut term = self.settings.describe(view, list, notes);
        self.common.apply(&mut term, list.passes.get_mut(first..).unwrap_or_default());
        stencil_guard::guard(view, self.common.guard, &mut term, notes);
        term
    }

    /// Settings of the light's map; `None`: its technique draws none.
    pub fn map(&self) -> Option<&MapSettings> {
        self.settings.map()
    }
}

/// Texels a side of a light's map; of a map by default, if its technique draws none.
pub fn map_size(shadow: &Shadow) -> u32 {
    LightShadow::of(shadow).and_then(LightShadow::map).map_or(DEFAULT_MAP_SIZE, |map| map.size)
}

/// The techniques of [`TABLE`], as readers of `[light.shadow]`.
pub struct Techniques;

impl ReadShadow for Techniques {
    /// As [`read`].
    fn read(&self, written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError> {
        read(written, kind, objects)
    }

    /// As [`read_photo`].
    fn read_photo(&self, written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError> {
        read_photo(written, kind, objects)
    }
}

/// Loads a scene (.toml), or a model (.obj, .md2, .gltf, .glb, .ply, .stl) with a scene supplied around it, with its lights'
/// shadow settings.
/// `overrides` are the texts of `--set`, `a.b.c=value`, applied in order.
///
/// # Errors
///
/// A file that cannot be read, or a key or value that is wrong, with file and line.
pub fn load(path: &Path, overrides: &[String]) -> Result<Loaded, scene::Error> {
    scene::load(path, overrides, &Techniques)
}

/// Loads a scene from the `text` of a scene file; the files that it names are relative to `folder`.
///
/// # Errors
///
/// As [`load`].
pub fn load_str(text: &str, folder: &Path, overrides: &[String]) -> Result<Loaded, scene::Error> {
    scene::load_str(text, folder, overrides, &Techniques)
}

impl scene::SceneBuilder {
    /// The scene and its warnings, with its lights' shadow settings: all checks of a scene file are made.
    ///
    /// # Errors
    ///
    /// A key or value that is wrong, with the line of code that set it; a mesh or picture that cannot be read.
    pub fn build(self) -> Result<Loaded, scene::Error> {
        self.build_with(&Techniques)
    }
}

/// Loads a scene that is part of the program; otherwise as [`load`].
///
/// # Errors
///
/// As [`load`].
pub fn load_embedded(embedded: &Embedded, overrides: &[String]) -> Result<Loaded, scene::Error> {
    scene::load_embedded(embedded, overrides, &Techniques)
}

/// Reads `[light.shadow]` of a light of this `kind` in a scene with these `objects`. An empty table means no shadow.
///
/// # Errors
///
/// A name that no row of [`TABLE`] has, a technique that does not serve such lights or objects, a key that no technique
/// reads, a key with a wrong value, keys that exclude each other; each with its place.
pub fn read(written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError> {
    let mut keys = written.read();
    let technique = chosen(kind, &mut keys)?;
    let common = CommonKeys::read(&mut keys, kind)?;
    let settings = technique.read(&mut keys, kind)?;
    if let (Guard::Stencil, Some(counting)) = (common.guard, settings.counts_by()) {
        let why = format_args!("= \"stencil\" does not go with {counting}: both tag in the one buffer");
        return Err(keys.error("guard", why));
    }
    refuse_in_focus(kind, common.guard, settings.counts_by(), &keys)?;
    check_others(technique, &mut keys)?;
    keys.finish()?;
    settings.check(kind, objects)?;
    Ok(Shadow::new(written, LightShadow { technique, common, settings }))
}

/// Technique that finds what a photograph's eye saw, where none is written.
const PHOTO_TECHNIQUE: &str = "shadow-map";

/// Reads `map` of a photograph: the keys of `[light.shadow]`, of a shadow map where no `technique` is written.
///
/// # Errors
///
/// As [`read`]; a technique that counts in the stencil buffer; keys of light.
fn read_photo(mut written: Settings, kind: &LightKind, objects: &[Object]) -> Result<Shadow, SettingsError> {
    if written.get("technique").is_none() {
        let (name, origin) = (String::from(PHOTO_TECHNIQUE), written.origin.clone());
        written.set("technique", Entry { value: Value::String(name), origin });
    }
    let shadow = read(written, kind, objects)?;
    let keys = shadow.written().read();
    keys.refuse(&["guard", "dimming"], "is no key of a photograph's map, which lights nothing")?;
    match LightShadow::of(&shadow).and_then(|read| read.settings.counts_by()) {
        None => Ok(shadow),
        Some(counting) => {
            let why =
                format_args!("needs a depth map that the shader looks up, and {counting} counts in the stencil buffer");
            Err(keys.error("technique", why))
        }
    }
}

/// Refuses keys of a light with a lens that its lens points cannot have.
fn refuse_in_focus(
    kind: &LightKind,
    guard: Guard,
    counts_by: Option<&'static str>,
    keys: &Reader<'_>,
) -> Result<(), SettingsError> {
    if !matches!(kind, LightKind::Spot(spot) if spot.lens().is_some()) {
        return Ok(());
    }
    let rule = "lens points are added one by one with depth EQUAL and a stencil bit for each";
    if let Some(counting) = counts_by {
        let why = format_args!("does not go with `focus`: {rule}, and {counting} counts there, too");
        return Err(keys.error("technique", why));
    }
    match guard {
        Guard::Stencil | Guard::ClipPlane => {
            Err(keys.error("guard", format_args!("= \"{}\" does not go with `focus`: {rule}", guard.name())))
        }
        _ => Ok(()),
    }
}

/// As [`read`], from the inside of an inline table: `technique = "shadow-map", size = 512`.
///
/// # Errors
///
/// A text that is no TOML; otherwise as [`read`].
pub fn read_text(inside: &str, kind: &LightKind, objects: &[Object]) -> Result<Shadow, scene::Error> {
    Ok(read(scene::shadow_settings(inside)?, kind, objects)?)
}

/// A copy of `scene` whose light `light` has the keys `inside` an inline table as its `[light.shadow]`: see [`read_text`].
///
/// # Errors
///
/// As [`read_text`].
pub fn with_keys(scene: &Scene, light: usize, inside: &str) -> Result<Scene, scene::Error> {
    let mut changed = scene.clone();
    if let Some(light) = changed.lights.get_mut(light) {
        light.shadow = read_text(inside, &light.kind, &scene.objects)?;
    }
    Ok(changed)
}

/// The settings of a light that nothing shadows, as an absent `[light.shadow]` has them.
pub fn unshadowed() -> Shadow {
    let settings = Box::new(Unshadowed);
    Shadow::new(Settings::default(), LightShadow { technique: &Unshadowed, common: CommonKeys::default(), settings })
}

/// Checks the keys that only other techniques read: they may be present, so that only `technique` needs to be changed.
fn check_others(chosen: &dyn Technique, keys: &mut Reader<'_>) -> Result<(), SettingsError> {
    TABLE.iter().filter(|row| row.name() != chosen.name()).try_for_each(|row| row.check(keys))
}

/// The keys of `[light.shadow]` that a light of this technique reads, `technique` apart.
pub fn keys(technique: &dyn Technique) -> Vec<&'static str> {
    let empty = Settings::default();
    let mut keys = empty.read();
    // A key that is absent has no wrong value.
    let _ = technique.check(&mut keys);
    let _ = CommonKeys::check(&mut keys);
    keys.known().to_vec()
}

/// The technique that `[light.shadow]` of a light of this `kind` names.
fn chosen(kind: &LightKind, settings: &mut Reader<'_>) -> Result<&'static dyn Technique, SettingsError> {
    settings.note("technique", || ValueForm::Choice(TABLE.iter().map(|row| row.name().to_owned()).collect()));
    let name = settings.string("technique")?.unwrap_or("none");
    let Some(technique) = TABLE.iter().find(|row| row.name() == name) else {
        let names = TABLE.iter().map(|row| row.name());
        return Err(settings.error("technique", format_args!("cannot be \"{name}\": {}", suggest(name, names))));
    };
    technique.serves(kind).map_err(|why| {
        let light = kind.name();
        settings.error("technique", format_args!("cannot be \"{name}\" for a {light} light: it {why}"))
    })?;
    Ok(*technique)
}
