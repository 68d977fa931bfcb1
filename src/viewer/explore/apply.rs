//! Effects of keys, mouse and changed files on an [`Explorer`]: its side of the contract with the window.

use std::time::Duration;

use glam::DVec2;

use super::keys::{self, ExploreCommand, explore_help};
use super::shown::Paged;
use super::{Explorer, save, sources};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::judge::truth_pictures::{self, TruthView};
use crate::plan::Request;
use crate::scene::{self, Entry, Origin, Scene, Value};
use crate::techniques;
use crate::viewer::Error;
use crate::viewer::sheet::Sheet;
use crate::viewer::show::{Button, Facts, Reaction, Show};

impl Explorer {
    /// Applies a command.
    pub fn apply(&mut self, command: ExploreCommand) -> Reaction {
        use ExploreCommand as C;
        (self.said, self.error) = (None, None);
        match command {
            C::Help => self.looks.page(Paged::Help, self.pages(Paged::Help).len()),
            C::LeftOut => self.looks.page(Paged::LeftOut, self.pages(Paged::LeftOut).len()),
            C::Save => return Reaction::Save,
            C::Quit => return Reaction::Quit,
            C::Fly => {
                self.flies = !self.flies;
                return Reaction::Retitle;
            }
            C::Hold => {
                self.holds_light = !self.holds_light;
                return Reaction::Retitle;
            }
            C::Walk(steps) => self.walk(steps),
            C::NextCamera => self.next_camera(),
            C::ResetCamera => self.scene.camera = self.base.camera.clone(),
            C::Reset => self.scene = self.base.clone(),
            C::NextLight => {
                self.light = (self.light + 1) % self.scene.lights.len().max(1);
                self.looks.has_failed = false;
            }
            C::NextTechnique => self.next_technique(),
            C::Bias(step) => self.step_offset("units", step),
            C::Slope(step) => self.step_offset("factor", step),
            C::MapSize(power) => self.scale_map(power),
            C::NextKernel => self.next_kernel(),
            C::View(by) => self.looks.step(by),
            C::Picture => {
                self.looks.look = if self.looks.look.is_some() { None } else { Some(self.looks.last) };
                self.looks.has_failed = false;
                self.looks.pass = None;
            }
            C::Beside => self.looks.is_beside = !self.looks.is_beside,
            C::Pass(by) => self.step_pass(by),
            C::Times => self.looks.times = !self.looks.times,
        }
        Reaction::Redraw
    }

    /// The technique that the chosen light has for the view that is shown, if its own does not make that.
    fn technique_of_look(&self) -> Option<&'static str> {
        self.looks.now()?.technique(&self.scene.lights.get(self.light)?.shadow)
    }

    /// The scene, with the technique that the view needs.
    fn scene_of_look(&self) -> Scene {
        let mut scene = self.scene.clone();
        if let Some(technique) = self.technique_of_look() {
            let light = &mut scene.lights[self.light];
            let mut written = light.shadow.written().clone();
            written.set("technique", Entry { value: Value::String(technique.to_owned()), origin: Origin::BuiltIn });
            // If it does not serve the light, the plan says why there is no view.
            if let Ok(shadow) = techniques::read(written, &light.kind, &scene.objects) {
                light.shadow = shadow;
            }
        }
        scene
    }

    fn next_camera(&mut self) {
        if self.cameras.len() < 2 {
            self.said = Some(String::from("the scene has one camera"));
            return;
        }
        let next = (self.camera + 1) % self.cameras.len();
        match self.sources.camera(&self.cameras[next]) {
            Ok(camera) => {
                self.camera = next;
                self.base.camera = camera.clone();
                self.scene.camera = camera;
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Steps through the passes of the picture; before the first and after the last comes the whole.
    fn step_pass(&mut self, by: i32) {
        let count = self.facts.passes.len() as i32 + 1;
        let place = self.looks.pass.map_or(0, |place| place as i32 + 1);
        self.looks.pass = usize::try_from((place + by).rem_euclid(count) - 1).ok();
        self.looks.look = None;
    }

    /// Loads the scene's files again. What they have anew goes over what keys and mouse have changed; the rest stays.
    fn reload(&mut self) {
        let name = self.cameras.get(self.camera).cloned();
        let loaded = match self.sources.reload(name.as_deref()) {
            // The camera may have gone.
            Err(_) if name.is_some() => self.sources.reload(None),
            loaded => loaded,
        };
        match loaded.and_then(|loaded| Ok((loaded.scene, self.sources.cameras()?))) {
            Ok((scene, cameras)) => self.take(scene, cameras, name),
            Err(error) => self.file_error = Some(told(&error)),
        }
    }

    fn take(&mut self, scene: Scene, cameras: Vec<String>, name: Option<String>) {
        self.file_error = None;
        self.said = Some(String::from("read again"));
        let found = cameras.iter().position(|known| Some(known) == name.as_ref());
        self.camera = found.unwrap_or_else(|| self.sources.first_camera(&cameras));
        self.cameras = cameras;
        let mut next = scene.clone();
        if scene.camera == self.base.camera {
            next.camera = self.scene.camera.clone();
        }
        if scene.lights.len() == self.base.lights.len() {
            let before = self.base.lights.iter().zip(&self.scene.lights);
            for ((new, next), (old, now)) in scene.lights.iter().zip(&mut next.lights).zip(before) {
                if format!("{:?}", Kept::of(new)) == format!("{:?}", Kept::of(old)) {
                    (next.kind, next.shadow) = (now.kind.clone(), now.shadow.clone());
                }
            }
        }
        if scene.image.size != self.base.image.size {
            self.size = scene.image.size;
        }
        self.changes += 1;
        self.light = self.light.min(scene.lights.len().saturating_sub(1));
        self.base = scene;
        self.scene = next;
    }
}

/// The part of a light that files and keys may both change.
#[derive(Debug)]
#[expect(dead_code, reason = "compared by their text")]
struct Kept {
    place: Vec<glam::DVec3>,
    cone: Option<[f64; 4]>,
    shadow: String,
}

impl Kept {
    fn of(light: &scene::Light) -> Self {
        let cone = light.frustum().map(|frustum| [frustum.cone_radians, frustum.aspect, frustum.near, frustum.far]);
        Self { place: save::place(light), cone, shadow: light.shadow.written().to_toml() }
    }
}

/// An error of a change, and what is shown in spite of it.
fn told(error: &scene::Error) -> String {
    format!("{error} (the picture is that of before)")
}

impl Show for Explorer {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn resize(&mut self, size: [u32; 2]) {
        self.size = size.map(|side| side.max(1));
    }

    fn frame(&self) -> (Scene, Request) {
        let mut scene = self.scene_of_look();
        scene.image.size = match self.looks.now() {
            // Both pictures are as large as half of the window.
            Some(_) if self.looks.is_beside => [(self.size[0] / 2).max(1), self.size[1]],
            _ => self.size,
        };
        let views = self.looks.now().and_then(|look| look.drawn(self.light)).into_iter().collect();
        (scene, Request { views, ..Request::default() })
    }

    fn status(&self) -> String {
        let what = match (self.looks.now(), self.looks.pass.and_then(|place| self.facts.passes.get(place))) {
            (Some(look), _) => match self.technique_of_look() {
                Some(technique) => format!("{} (by {technique})", look.name()),
                None => look.name().to_owned(),
            },
            (None, Some((number, _))) => format!("pass {number}"),
            (None, None) => String::from("picture"),
        };
        let camera = self.cameras.get(self.camera).map(|name| format!("camera {name}"));
        let light = self.shadow_in_words().map(|shadow| {
            let name = &self.scene.lights[self.light].name;
            format!("{name}: {shadow}")
        });
        let held = match (self.holds_light, self.flies) {
            (true, _) => "mouse: light",
            (false, true) => "mouse: flight",
            (false, false) => "mouse: camera",
        };
        let error = self.error().map(|error| format!("error: {error}"));
        let parts = [Some(what), camera, light, Some(held.to_owned()), self.said.clone(), error];
        let parts = parts.into_iter().flatten().chain([String::from("h: help")]);
        parts.collect::<Vec<_>>().join(" | ")
    }

    fn key(&mut self, name: &str) -> Option<Reaction> {
        keys::command(name, self.flies).map(|command| self.apply(command))
    }

    fn drag(&mut self, button: Button, drag: DVec2) {
        match (button, self.holds_light) {
            (Button::Middle, _) | (Button::Left, true) => self.orbit_light(drag),
            (Button::Right, true) => self.slide_light(drag),
            (Button::Left, false) if self.flies => self.look(drag),
            (Button::Left, false) => self.orbit_camera(drag),
            (Button::Right, false) => self.pan(drag),
        }
    }

    fn dolly(&mut self, steps: f64) {
        match self.holds_light {
            true => self.dolly_light(steps),
            false => self.zoom(steps),
        }
    }

    fn help_page(&self) -> Option<usize> {
        self.looks.paged.filter(|(sheet, _)| *sheet == Paged::Help).map(|(_, page)| page)
    }

    fn help(&self) -> Vec<(String, String)> {
        explore_help()
    }

    fn traced(&self) -> Option<TruthView> {
        self.looks.now().and_then(|look| look.traced(self.light))
    }

    fn trace(
        &mut self,
        view: TruthView,
        scene: &Scene,
        picture: &Pixels,
        drawn: Option<&Pixels>,
    ) -> Result<Pixels, truth_pictures::Error> {
        // Keys and mouse change nothing else of a scene.
        let lights: Vec<Kept> = scene.lights.iter().map(Kept::of).collect();
        let state = format!("{} {:?} {:?} {lights:?}", self.changes, scene.image.size, scene.camera);
        self.truth.picture(view, &state, scene, picture, drawn)
    }

    fn is_beside(&self) -> bool {
        self.looks.is_beside
    }

    fn after_pass(&self) -> Option<usize> {
        let place = self.looks.pass?;
        self.facts.passes.get(place).map(|(number, _)| *number)
    }

    fn note(&mut self, facts: Facts) {
        self.facts = facts;
        self.good = (self.scene.clone(), self.looks.clone());
        (self.good_light, self.has_gone_back) = (self.light, false);
    }

    fn sheets(&self) -> Vec<Sheet> {
        self.all_sheets()
    }

    fn refuse(&mut self, error: &Error) -> bool {
        self.error = Some(error.to_string());
        let is_look = self.looks.look != self.good.1.look || self.light != self.good_light;
        if self.looks.now().is_some() && (is_look || self.has_gone_back) {
            self.looks.has_failed = true;
            return true;
        }
        let can_go_back = !self.has_gone_back;
        self.scene = self.good.0.clone();
        self.changes += 1;
        self.looks.pass = None;
        self.has_gone_back = true;
        can_go_back
    }

    fn save_picture(&mut self, renderer: &mut Renderer) {
        self.said = Some(match self.save_both(renderer) {
            Ok(said) => said,
            Err(error) => format!("not saved: {error}"),
        });
    }

    fn polls(&self) -> Option<Duration> {
        Some(sources::INTERVAL)
    }

    fn poll(&mut self) -> Option<Reaction> {
        if !self.sources.have_changed() {
            return None;
        }
        self.reload();
        Some(Reaction::Redraw)
    }

    fn end(&self, frames: u32) -> Option<String> {
        Some(format!("frames drawn: {frames}"))
    }
}
