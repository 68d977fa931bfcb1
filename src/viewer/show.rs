//! Content of a window, and what keys and mouse do to it: the contract between [`run`](super::run) and a sample's state.

use glam::DVec2;

use crate::plan::Request;
use crate::scene::Scene;

/// Reaction to a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    Redraw,
    /// Only the title has changed.
    Retitle,
    Quit,
}

/// Button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    Left,
    Middle,
    Right,
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

    /// Tests whether the window shows the help.
    fn helps(&self) -> bool;

    /// Each key's and gesture's name, and what it does.
    fn help(&self) -> Vec<(String, String)>;

    /// Tests whether something moves by itself.
    fn moves(&self) -> bool {
        false
    }

    /// Moves on by a time in seconds, where something moves.
    fn advance(&mut self, _seconds: f64) {}
}
