//! State of a window that shows a key-framed model: its pose and animation, the picture, the place of eye and light, how bumps
//! and shadows are drawn. Plain data; knows no window and no GL.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use super::model_keys::{ModelCommand, ModelMode, command, model_help};
use super::sheet::{help_pages, next_page};
use super::show::{Button, Reaction, Show};
use crate::geometry::Material;
use crate::geometry::md2::{Model, NormalSource, Pose};
use crate::plan::{self, Request, ViewRequest};
use crate::scene::{
    BumpMethod, Embedded, Entry, Error, Light, LightKind, Loaded, Object, Origin, Scene, SettingsError, Value,
};
use crate::techniques;

/// Key frames a second, at first.
const SPEED: f64 = 3.0;

/// Least and greatest of them.
const SPEEDS: [f64; 2] = [0.1, 60.0];

/// Heights between which eye and light move, and distances of the eye from the room's middle.
const HEIGHTS: [f64; 2] = [-20.0, 60.0];
const DISTANCES: [f64; 2] = [25.0, 72.0];

/// Objects whose names begin so are the backdrop.
const BACKDROP: &str = "room";

/// The object that stands where the light does.
const LAMP: &str = "lamp";

/// Values of `[shading] bump`, in the order of the key.
const METHODS: [&str; 3] = ["one-pass", "three-pass", "reference"];

/// State of a window.
#[derive(Clone, Debug)]
pub struct ModelState {
    embedded: Embedded,
    overrides: Vec<String>,
    first: Scene,
    scene: Scene,
    model: Arc<Model>,
    /// Index of the key-framed object.
    object: usize,
    /// Its material as loaded.
    material: Option<Arc<Material>>,
    /// Number of a key frame, with the share of the next.
    frame: f64,
    normals: NormalSource,
    mode: ModelMode,
    animates: bool,
    /// Key frames a second.
    speed: f64,
    shows_room: bool,
    shows_wire: bool,
    size: [u32; 2],
    help_page: Option<usize>,
    /// Reason why the last command changed nothing, or not what the help says.
    refused: Option<String>,
}

impl ModelState {
    /// A state that begins with a scene, one of whose meshes is a key-framed model, and with what `overrides` change in it.
    ///
    /// # Errors
    ///
    /// Errors of the scene, and a scene without a key-framed model among its files or objects.
    pub fn new(embedded: Embedded, overrides: Vec<String>, mode: ModelMode) -> Result<(Self, Vec<String>), Error> {
        let Loaded { scene, warnings } = techniques::load_embedded(&embedded, &overrides)?;
        let error = |message: &str| Error::Settings(SettingsError::new(&Origin::BuiltIn, message));
        let is_model = |name: &str| Path::new(name).extension().is_some_and(|extension| extension == "md2");
        let file = embedded.meshes.iter().find(|(name, _)| is_model(name));
        let (name, bytes) = file.ok_or_else(|| error("the program has no key-framed model"))?;
        let (model, _) =
            Model::decode(Path::new(name), bytes).map_err(|source| Error::Asset { origin: Origin::BuiltIn, source })?;
        let object = scene.objects.iter().position(|object| is_model(&object.mesh.name));
        let object = object.ok_or_else(|| error("no object of the scene is a key-framed model"))?;
        let file_name = |name: &str| Path::new(name).file_name().map(std::ffi::OsStr::to_owned);
        if file_name(&scene.objects[object].mesh.name) != file_name(name) {
            return Err(error("the program shows its own key-framed model: `glumbra render` shows others"));
        }
        let (pose, normals) = scene.objects[object].pose.unwrap_or_default();
        if pose.blend != 0.0 && pose.frames[1] != pose.frames[0] + 1 {
            return Err(error("the program blends a frame with the next: give the knight a `frame`"));
        }
        let state = Self {
            embedded,
            overrides,
            first: scene.clone(),
            model: Arc::new(model),
            object,
            material: scene.objects[object].material.clone(),
            frame: pose.frames[0] as f64 + pose.blend,
            normals,
            mode,
            animates: false,
            speed: SPEED,
            shows_room: true,
            shows_wire: false,
            size: scene.image.size,
            help_page: None,
            refused: None,
            scene,
        };
        Ok((state, warnings))
    }

    /// Number of key frames. A pose's number is from 0 to below it.
    pub fn frame_count(&self) -> usize {
        self.model.frame_count()
    }

    /// The scene as changed so far.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Number of the key frame, with the share of the next.
    pub fn key_frame(&self) -> f64 {
        self.frame
    }

    pub fn mode(&self) -> ModelMode {
        self.mode
    }

    /// Poses the model at a number of a key frame, with the share of the next one of its animation. The last one's next is the
    /// first. Numbers beyond the model's are taken for its last.
    pub fn pose_at(&mut self, frame: f64) {
        self.frame = frame.clamp(0.0, self.frame_count() as f64);
        self.pose();
    }

    fn pose(&mut self) {
        let Some(object) = self.scene.objects.get_mut(self.object) else { return };
        let mut mesh = self.model.mesh(&pose(&self.model, self.frame), self.normals);
        let bump = object.material.as_ref().and_then(|material| material.bump.as_ref());
        if let Some((based, _)) = bump.and_then(|bump| mesh.with_bases(bump.fit, None)) {
            mesh = based;
        }
        object.mesh = Arc::new(mesh);
    }

    /// Applies a command; where the scene cannot be drawn so, nothing changes, and the status says why.
    pub fn apply(&mut self, command: ModelCommand) -> Reaction {
        self.refused = None;
        let before = self.clone();
        match command {
            ModelCommand::Animate => self.animates = !self.animates,
            ModelCommand::Speed(factor) => {
                self.speed = (self.speed * factor).clamp(SPEEDS[0], SPEEDS[1]);
                return Reaction::Retitle;
            }
            ModelCommand::NextAnimation => {
                let next = animation(&self.model, self.frame).end;
                self.pose_at(if next < self.frame_count() { next as f64 } else { 0.0 });
            }
            ModelCommand::Show(key) => self.mode = self.mode.next(key),
            ModelCommand::Wireframe => self.shows_wire = !self.shows_wire,
            ModelCommand::Backdrop => self.shows_room = !self.shows_room,
            ModelCommand::NextMethod => self.next_method(),
            ModelCommand::Gloss => self.switch_gloss(),
            ModelCommand::Normals => {
                self.normals = match self.normals {
                    NormalSource::File => NormalSource::Recomputed,
                    NormalSource::Recomputed => NormalSource::File,
                };
                self.pose();
            }
            ModelCommand::Technique(name) => self.take_technique(name),
            ModelCommand::Reset => {
                self.scene.camera = self.first.camera.clone();
                self.place_light(self.first.lights.first().and_then(Light::position));
            }
            ModelCommand::Help => self.help_page = next_page(self.help_page, help_pages(model_help(), self.size).len()),
            ModelCommand::Quit => return Reaction::Quit,
        }
        if let Err(error) = self.drawn() {
            *self = Self { refused: Some(error), ..before };
        }
        Reaction::Redraw
    }

    /// Tests whether the state can be drawn.
    fn drawn(&self) -> Result<(), String> {
        let (scene, request) = self.frame();
        plan::make(&scene, &request).map(drop).map_err(|error| error.to_string())
    }

    fn method(&self) -> usize {
        match self.scene.shading.bumps.method {
            BumpMethod::OnePass(_) => 0,
            BumpMethod::ThreePass { .. } => 1,
            BumpMethod::Reference => 2,
        }
    }

    /// The next way of lighting bumps that goes with the shadows; says why others do not.
    fn next_method(&mut self) {
        let (own, mut refused) = (self.method(), None);
        for step in 1..METHODS.len() {
            let name = METHODS[(own + step) % METHODS.len()];
            let overrides = [&self.overrides[..], &[format!("shading.bump=\"{name}\"")]].concat();
            let loaded = techniques::load_embedded(&self.embedded, &overrides);
            let bumps = loaded.map(|loaded| loaded.scene.shading.bumps).map_err(|error| error.to_string());
            let tried = bumps.and_then(|bumps| {
                self.scene.shading.bumps = bumps;
                self.drawn()
            });
            match tried {
                Ok(()) => break,
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        self.refused = refused;
    }

    fn switch_gloss(&mut self) {
        let Some(object) = self.scene.objects.get_mut(self.object) else { return };
        let (Some(own), Some(loaded)) = (&object.material, &self.material) else { return };
        let gloss = if own.gloss.is_some() { None } else { loaded.gloss.clone() };
        object.material = Some(Arc::new(Material { gloss, ..(**own).clone() }));
    }

    /// Gives every light a technique. Where one cannot have it, all keep theirs.
    fn take_technique(&mut self, name: &'static str) {
        let objects = &self.scene.objects;
        let shadows = self.scene.lights.iter().map(|light| {
            let mut written = light.shadow.written().clone();
            written.set("technique", Entry { value: Value::String(name.to_owned()), origin: Origin::BuiltIn });
            techniques::read(written, &light.kind, objects)
        });
        match shadows.collect::<Result<Vec<_>, _>>() {
            Ok(shadows) => self.scene.lights.iter_mut().zip(shadows).for_each(|(light, own)| light.shadow = own),
            Err(error) => self.refused = Some(error.to_string()),
        }
    }

    fn technique(&self) -> &str {
        let written = self.scene.lights.first().and_then(|light| light.shadow.written().get("technique"));
        match written.map(|entry| &entry.value) {
            Some(Value::String(name)) => name,
            _ => "none",
        }
    }

    /// Places the first light, and the lamp.
    fn place_light(&mut self, place: Option<DVec3>) {
        let (Some(place), Some(light)) = (place, self.scene.lights.first_mut()) else { return };
        match &mut light.kind {
            LightKind::Point(point) => point.position = place,
            LightKind::Spot(spot) => spot.frustum.position = place,
            LightKind::Directional { .. } => return,
        }
        let lamps = self.scene.objects.iter_mut().filter(|object| object.name == LAMP);
        lamps.for_each(|lamp| lamp.world_from_model.w_axis = place.extend(1.0));
    }

    fn name_of_frame(&self) -> String {
        let frames = &self.model.file().frames;
        frames.get(self.frame as usize).or(frames.last()).map_or_else(String::new, |frame| stem(&frame.name()))
    }
}

impl Show for ModelState {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn resize(&mut self, size: [u32; 2]) {
        self.size = size.map(|side| side.max(1));
    }

    fn frame(&self) -> (Scene, Request) {
        let mut scene = self.scene.clone();
        scene.image.size = self.size;
        let mut object = self.object;
        if !self.shows_room {
            let is_backdrop = |object: &Object| object.name.starts_with(BACKDROP);
            object -= scene.objects.iter().take(object).filter(|object| is_backdrop(object)).count();
            scene.objects.retain(|object| !is_backdrop(object));
        }
        let wire = self.shows_wire.then_some(object);
        let views = match self.mode {
            ModelMode::Scene => Vec::new(),
            ModelMode::View(view) => vec![ViewRequest { view, light: 0 }],
        };
        (scene, Request { views, wire, sampled_warnings: false, ..Request::default() })
    }

    fn status(&self) -> String {
        let (mode, animation, technique) = (self.mode.name(), self.name_of_frame(), self.technique());
        let (frame, speed, method) = (self.frame, self.speed, METHODS[self.method()]);
        let goes = if self.animates { "" } else { ", stopped" };
        let refused = self.refused.as_ref().map_or(String::new(), |error| format!(" | {error}"));
        format!(
            "{mode} | {animation}, frame {frame:.2}, {speed:.1} a second{goes} | bumps: {method} | shadows: {technique} | h: help{refused}"
        )
    }

    fn key(&mut self, name: &str) -> Option<Reaction> {
        command(name).map(|command| self.apply(command))
    }

    fn drag(&mut self, button: Button, drag: DVec2) {
        let turn = drag * std::f64::consts::PI / f64::from(self.size[1]);
        match button {
            Button::Left => {
                let camera = &mut self.scene.camera;
                camera.eye = on_circle(camera.eye, DVec2::new(-turn.x, turn.y));
            }
            Button::Middle => {
                let place = self.scene.lights.first().and_then(Light::position);
                self.place_light(place.map(|place| on_circle(place, DVec2::new(turn.x, -turn.y))));
            }
            Button::Right => {}
        }
    }

    fn dolly(&mut self, steps: f64) {
        let eye = &mut self.scene.camera.eye;
        let distance = eye.x.hypot(eye.z);
        if distance > 0.0 {
            let wanted = (distance * 0.9_f64.powf(steps)).clamp(DISTANCES[0], DISTANCES[1]);
            (eye.x, eye.z) = (eye.x * wanted / distance, eye.z * wanted / distance);
        }
    }

    fn help_page(&self) -> Option<usize> {
        self.help_page
    }

    fn help(&self) -> Vec<(String, String)> {
        model_help()
    }

    fn moves(&self) -> bool {
        self.animates
    }

    fn advance(&mut self, seconds: f64) {
        let Range { start, end } = animation(&self.model, self.frame);
        let (start, length) = (start as f64, (end - start) as f64);
        self.pose_at(start + (self.frame - start + self.speed * seconds).rem_euclid(length));
    }
}

/// A place moved around the room's middle by `turn.x`, and up by `turn.y`, a radian for half of the heights.
fn on_circle(place: DVec3, turn: DVec2) -> DVec3 {
    let turned = DMat4::from_rotation_y(turn.x).transform_vector3(place);
    let rise = 0.5 * (HEIGHTS[1] - HEIGHTS[0]) * turn.y;
    DVec3::new(turned.x, (turned.y + rise).clamp(HEIGHTS[0], HEIGHTS[1]), turned.z)
}

/// A frame's name without the number at its end.
fn stem(name: &str) -> String {
    name.trim_end_matches(|letter: char| letter.is_ascii_digit()).to_owned()
}

/// The frames of the animation that a frame is of: those around it whose names differ in their number alone.
fn animation(model: &Model, frame: f64) -> Range<usize> {
    let frames = &model.file().frames;
    let at = (frame as usize).min(frames.len().saturating_sub(1));
    let name = |index: usize| frames.get(index).map(|frame| stem(&frame.name()));
    let (mut start, mut end) = (at, at + 1);
    while start > 0 && name(start - 1) == name(at) {
        start -= 1;
    }
    while end < frames.len() && name(end) == name(at) {
        end += 1;
    }
    start..end
}

/// The pose at a number of a frame: between it and the next one of its animation, which goes in a circle.
fn pose(model: &Model, frame: f64) -> Pose {
    let Range { start, end } = animation(model, frame);
    let first = (frame as usize).clamp(start, end - 1);
    let second = if first + 1 == end { start } else { first + 1 };
    let blend = (frame - first as f64).clamp(0.0, 1.0);
    // A key frame needs no other.
    Pose { frames: if blend == 0.0 { [first; 2] } else { [first, second] }, blend }
}
