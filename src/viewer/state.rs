//! State of a window: the scene, the display mode, what the mouse holds, the tweak that the keys step. Plain data; knows no
//! window and no GL.

use glam::{DMat4, DVec2, DVec3};

use super::keys::{self, Command};
use super::mode::{Handle, Mode};
use super::orbit::{distance_of_sphere, dolly, orbit, turn_about};
use super::sheet::{help_pages, next_page};
use super::show::{Button, Reaction, Show};
use super::{TWEAKS, Tweak};
use crate::math::{Aabb, frustum};
use crate::plan::Request;
use crate::scene::{Entry, Frustum, Light, LightKind, Origin, Scene, Settings, SettingsError, Value};
use crate::techniques;

/// State of a window.
#[derive(Clone, Debug)]
pub struct State {
    first: Scene,
    scene: Scene,
    mode: Mode,
    held: Handle,
    tweak: usize,
    size: [u32; 2],
    help_page: Option<usize>,
    /// Error of the last command, if it has changed nothing.
    refused: Option<String>,
    techniques: &'static [&'static str],
}

impl State {
    /// A state that begins with `scene` as it is.
    pub fn new(scene: Scene, mode: Mode) -> Self {
        let size = scene.image.size;
        Self {
            first: scene.clone(),
            scene,
            mode,
            held: Handle::default(),
            tweak: 0,
            size,
            help_page: None,
            refused: None,
            techniques: &[],
        }
    }

    /// The same state with shadow techniques to choose from, by their names in `[light.shadow]`.
    #[must_use]
    pub fn with_techniques(self, techniques: &'static [&'static str]) -> Self {
        Self { techniques, ..self }
    }

    pub fn techniques(&self) -> &'static [&'static str] {
        self.techniques
    }

    /// Tests whether the window shows the help.
    pub fn helps(&self) -> bool {
        self.help_page.is_some()
    }

    /// The scene as changed so far.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Width and height of the picture, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn resize(&mut self, size: [u32; 2]) {
        self.size = size.map(|side| side.max(1));
    }

    /// Scene and request to draw now.
    pub fn frame(&self) -> (Scene, Request) {
        self.mode.frame(&self.scene, self.size)
    }

    /// One line: mode, the technique where there is a choice, what the mouse holds, the current tweak, and why the last
    /// command changed nothing, if it did not.
    pub fn status(&self) -> String {
        let mode = self.mode.in_words();
        let held = match self.held {
            Handle::Camera => "camera",
            Handle::Light => "light",
            Handle::Object => "object",
        };
        let tweak =
            self.scene.lights.first().map_or(String::new(), |light| self.tweak().in_words(light.shadow.written()));
        let technique = if self.techniques.len() > 1 { format!(" | {}", self.technique()) } else { String::new() };
        let refused = self.refused.as_ref().map_or(String::new(), |error| format!(" | {error}"));
        format!("{mode}{technique} | mouse: {held} | {tweak} | h: help{refused}")
    }

    pub fn apply(&mut self, command: Command) -> Reaction {
        self.refused = None;
        match command {
            Command::NextMode => self.mode = self.mode.next(),
            Command::NextTechnique => self.next_technique(),
            Command::ViewAll => self.view_all(),
            Command::Reset => self.scene = self.first.clone(),
            Command::Hold(handle) => {
                self.held = handle;
                return Reaction::Retitle;
            }
            Command::NextTweak => {
                self.tweak = (self.tweak + 1) % TWEAKS.len();
                return Reaction::Retitle;
            }
            Command::Step(steps) => {
                let tweak = self.tweak();
                self.change_shadows(|written| tweak.step(written, steps));
            }
            Command::Help => {
                self.help_page = next_page(self.help_page, help_pages(keys::rows(self.techniques), self.size).len())
            }
            Command::Quit => return Reaction::Quit,
        }
        Reaction::Redraw
    }

    /// The first light's.
    fn technique(&self) -> &str {
        match self
            .scene
            .lights
            .first()
            .and_then(|light| light.shadow.written().get("technique"))
            .map(|entry| &entry.value)
        {
            Some(Value::String(name)) => name,
            _ => "none",
        }
    }

    /// Every light has the technique that follows the first one's.
    fn next_technique(&mut self) {
        let place = self.techniques.iter().position(|name| *name == self.technique()).map_or(0, |place| place + 1);
        let Some(next) = self.techniques.get(place).or(self.techniques.first()) else { return };
        let value = Value::String((*next).to_owned());
        self.change_shadows(|written| {
            written.set("technique", Entry { value: value.clone(), origin: Origin::BuiltIn });
        });
    }

    /// Changes `[light.shadow]` of every light. Where one of them cannot be read then, all stay as they are.
    fn change_shadows(&mut self, change: impl Fn(&mut Settings)) {
        let objects = &self.scene.objects;
        let read = |light: &Light| {
            let mut written = light.shadow.written().clone();
            change(&mut written);
            techniques::read(written, &light.kind, objects)
        };
        match self.scene.lights.iter().map(read).collect::<Result<Vec<_>, SettingsError>>() {
            Ok(shadows) => {
                self.scene.lights.iter_mut().zip(shadows).for_each(|(light, shadow)| light.shadow = shadow);
            }
            Err(error) => self.refused = Some(error.to_string()),
        }
    }

    fn tweak(&self) -> &'static Tweak {
        &TWEAKS[self.tweak % TWEAKS.len()]
    }

    /// Turns what the mouse holds. `drag` in pixels, right and down; the window's height is half a turn. The scene
    /// follows the mouse when it turns the camera, and so do light and object.
    pub fn drag(&mut self, drag: DVec2) {
        let turn = drag * std::f64::consts::PI / f64::from(self.size[1]);
        match self.held {
            Handle::Camera => {
                let camera = &mut self.scene.camera;
                camera.eye = orbit(camera.eye, camera.target, camera.up, DVec2::new(-turn.x, turn.y));
            }
            Handle::Light => {
                if let Some(Light { kind: LightKind::Spot(spot), .. }) = self.scene.lights.first_mut() {
                    let Frustum { position, target, up, .. } = &mut spot.frustum;
                    *position = orbit(*position, *target, *up, DVec2::new(turn.x, -turn.y));
                }
            }
            Handle::Object => {
                let right = self.camera_axis(DVec3::X);
                let up = self.scene.camera.up;
                self.place_object(|middle| turn_about(middle, up, right, turn));
            }
        }
    }

    /// Moves what the mouse holds nearer (to what it looks at; the object: to the camera), or farther by less than 0.
    pub fn dolly(&mut self, steps: f64) {
        match self.held {
            Handle::Camera => {
                let camera = &mut self.scene.camera;
                let range = [2.0 * camera.near, 0.8 * camera.far];
                camera.eye = dolly(camera.eye, camera.target, steps, range);
            }
            Handle::Light => {
                if let Some(Light { kind: LightKind::Spot(spot), .. }) = self.scene.lights.first_mut() {
                    let Frustum { position, target, near, far, .. } = &mut spot.frustum;
                    *position = dolly(*position, *target, steps, [2.0 * *near, 0.95 * *far]);
                }
            }
            Handle::Object => {
                let camera = &self.scene.camera;
                let (eye, range) = (camera.eye, [2.0 * camera.near, 0.8 * camera.far]);
                self.place_object(|middle| DMat4::from_translation(dolly(middle, eye, steps, range) - middle));
            }
        }
    }

    /// A direction of the camera's own space in the world.
    fn camera_axis(&self, axis: DVec3) -> DVec3 {
        self.scene.camera.view_from_world().inverse().transform_vector3(axis)
    }

    /// Moves the object by the matrix that `moved` returns for its middle.
    fn place_object(&mut self, moved: impl Fn(DVec3) -> DMat4) {
        let objects = &mut self.scene.objects;
        let index = objects.iter().position(|object| object.lit).unwrap_or(0);
        if let Some(object) = objects.get_mut(index) {
            let middle = object.world_from_model.transform_point3(object.mesh.bounds.center());
            object.world_from_model = moved(middle) * object.world_from_model;
        }
    }

    /// The camera, where it looks from, so far away that it sees all objects and lights.
    fn view_all(&mut self) {
        let mut bounds = self.scene.world_bounds();
        for light in &self.scene.lights {
            bounds = light.position().map_or(bounds, |position| bounds.including(position));
            if let Some(spot) = light.spot().filter(|spot| spot.frustum_shown) {
                let world_from_clip = spot.frustum.clip_from_world().inverse();
                bounds = bounds.union(Aabb::from_points(frustum::corners(&world_from_clip)));
            }
        }
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let backwards = self.camera_axis(DVec3::Z);
        let camera = &mut self.scene.camera;
        let distance = distance_of_sphere(bounds.radius(), camera.fov_y_radians, aspect);
        camera.target = bounds.center();
        camera.eye = camera.target + distance * backwards;
        camera.far = camera.far.max(1.1 * (distance + bounds.radius()));
    }
}

/// Pixels of a drag that count as one notch of the wheel.
const PIXELS_A_STEP: f64 = 20.0;

impl Show for State {
    fn size(&self) -> [u32; 2] {
        self.size()
    }

    fn resize(&mut self, size: [u32; 2]) {
        self.resize(size);
    }

    fn frame(&self) -> (Scene, Request) {
        self.frame()
    }

    fn status(&self) -> String {
        self.status()
    }

    fn key(&mut self, name: &str) -> Option<Reaction> {
        keys::command(name).map(|command| self.apply(command))
    }

    fn drag(&mut self, button: Button, drag: DVec2) {
        match button {
            Button::Left => self.drag(drag),
            Button::Right => self.dolly(-drag.y / PIXELS_A_STEP),
            Button::Middle => {}
        }
    }

    fn dolly(&mut self, steps: f64) {
        self.dolly(steps);
    }

    fn help_page(&self) -> Option<usize> {
        self.help_page
    }

    fn help(&self) -> Vec<(String, String)> {
        keys::rows(self.techniques)
    }
}
