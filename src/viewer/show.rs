//! Content of a window, and what keys and mouse do to it: the contract between [`run`](super::run) and a sample's state.

use std::time::Duration;

use glam::DVec2;

use super::Error;
use super::sheet::{EDGE, Sheet, help_pages};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::judge::truth_pictures::{self, TruthView};
use crate::lights::LeftOut;
use crate::plan::Request;
use crate::scene::Scene;

/// Reaction to a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    Redraw,
    /// Only the title has changed.
    Retitle,
    /// Scene and picture are to be saved: [`Show::save_picture`].
    Save,
    Quit,
}

/// Button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    Left,
    Middle,
    Right,
}

/// Facts of the frame that was drawn last.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// Labels of the passes from the first that draws into the picture, of the whole plan; each with its number.
    pub passes: Vec<(usize, String)>,
    pub left_out: Vec<LeftOut>,
    pub warnings: Vec<String>,
    /// Milliseconds of planning, and of drawing until the driver has finished.
    pub plan_ms: f64,
    pub draw_ms: f64,
}

/// Content of a window. Plain data; knows no window and no GL.
pub trait Show {
    /// Width and height of the picture, in pixels.
    fn size(&self) -> [u32; 2];

    fn resize(&mut self, size: [u32; 2]);

    /// Scene and request to draw now. Where the request has a view, the first one is shown in place of the picture.
    fn frame(&self) -> (Scene, Request);

    /// One line for the title and standard output.
    fn status(&self) -> String;

    /// Applies a key, by its name. `None`: it has no command.
    fn key(&mut self, name: &str) -> Option<Reaction>;

    /// Applies a drag with a button held. `drag` in pixels, right and down.
    fn drag(&mut self, button: Button, drag: DVec2);

    /// Moves nearer by steps of the wheel, or farther by less than 0.
    fn dolly(&mut self, steps: f64);

    /// The page of the help that the window shows; `None`: none.
    fn help_page(&self) -> Option<usize>;

    /// Each key's and gesture's name, and what it does.
    fn help(&self) -> Vec<(String, String)>;

    /// Tests whether something moves by itself.
    fn moves(&self) -> bool {
        false
    }

    /// Moves on by a time in seconds, where something moves.
    fn advance(&mut self, _seconds: f64) {}

    /// The ray tracer's picture that is shown in place of the scene's.
    fn traced(&self) -> Option<TruthView> {
        None
    }

    /// The ray tracer's picture of the scene as it was drawn; `picture` and `drawn` as [`TruthView::picture`] has them. A
    /// content that changes little may keep the rays.
    ///
    /// # Errors
    ///
    /// As [`TruthView::picture`].
    fn trace(
        &mut self,
        view: TruthView,
        scene: &Scene,
        picture: &Pixels,
        drawn: Option<&Pixels>,
    ) -> Result<Pixels, truth_pictures::Error> {
        view.picture(scene, picture, drawn, false)
    }

    /// Tests whether a view stands to the right of the picture, not in its place.
    fn is_beside(&self) -> bool {
        false
    }

    /// The pass after which the picture is shown, by its number in the plan; `None`: the last.
    fn after_pass(&self) -> Option<usize> {
        None
    }

    /// Takes the facts of the frame that was drawn.
    fn note(&mut self, _facts: Facts) {}

    /// Sheets over the picture, the first below all.
    fn sheets(&self) -> Vec<Sheet> {
        let Some(page) = self.help_page() else { return Vec::new() };
        let mut pages = help_pages(self.help(), self.size());
        let canvas = pages.swap_remove(page.min(pages.len() - 1));
        vec![Sheet { canvas, place: [EDGE; 2] }]
    }

    /// Goes back to what could be drawn, after an error. False if it cannot: the window closes.
    fn refuse(&mut self, _error: &Error) -> bool {
        false
    }

    /// Saves scene and picture.
    fn save_picture(&mut self, _renderer: &mut Renderer) {}

    /// Time between two calls of [`Show::poll`]; `None`: there is nothing to look for.
    fn polls(&self) -> Option<Duration> {
        None
    }

    /// Looks for changes from outside; `None`: there are none.
    fn poll(&mut self) -> Option<Reaction> {
        None
    }

    /// A line for the end, after so many frames were drawn.
    fn end(&self, _frames: u32) -> Option<String> {
        None
    }
}
