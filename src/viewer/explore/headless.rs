//! An [`Explorer`] without a window, led by a script of keys.

use std::time::{Duration, Instant};

use glam::DVec2;

use super::script::Step;
use super::{Explorer, sources};
use crate::frame::Renderer;
use crate::output::canvas::Canvas;
use crate::viewer::Error;
use crate::viewer::picture;
use crate::viewer::show::{Button, Reaction, Show};

/// Outcome of a script.
#[derive(Debug)]
pub struct Run {
    /// The picture that a window would show at the end.
    pub canvas: Canvas,
    /// Number of frames that were drawn.
    pub frames: u32,
}

/// Does each step, draws where a window would, and gives what the state says to `say`.
///
/// # Errors
///
/// What closes a window: every error of a frame that does not go away with the last change.
pub fn run_steps(
    state: &mut Explorer,
    steps: &[Step],
    renderer: &mut Renderer,
    mut say: impl FnMut(&str),
) -> Result<Run, Error> {
    let mut frames = 0;
    let mut draw = |state: &mut Explorer, renderer: &mut Renderer| {
        frames += 1;
        picture::draw_or_go_back(state, renderer)
    };
    let mut drawn = draw(state, renderer)?;
    say(&state.status());
    for step in steps {
        let reaction = match step {
            Step::Key(name) => state.key(name),
            Step::Drag(button, way) => {
                state.drag(*button, *way);
                Some(Reaction::Redraw)
            }
            Step::Wheel(notches) => {
                state.dolly(*notches);
                Some(Reaction::Redraw)
            }
            Step::Size(size) => {
                state.resize(*size);
                Some(Reaction::Redraw)
            }
            Step::Wait(seconds) => {
                say("waiting");
                wait(state, *seconds)
            }
        };
        match reaction {
            None => continue,
            Some(Reaction::Quit) => break,
            Some(Reaction::Redraw) => drawn = draw(state, renderer)?,
            Some(Reaction::Save) => {
                state.save_picture(renderer);
                drawn = draw(state, renderer)?;
            }
            Some(Reaction::Retitle) => {}
        }
        say(&state.status());
    }
    let canvas = drawn.canvas(renderer)?;
    Ok(Run { canvas, frames })
}

/// Times of `count` frames in milliseconds, while the camera turns once around.
///
/// # Errors
///
/// As [`run_steps`].
pub fn turn(state: &mut Explorer, count: u32, renderer: &mut Renderer) -> Result<Vec<f64>, Error> {
    let step = DVec2::new(2.0 * f64::from(state.size()[1]) / f64::from(count.max(1)), 0.0);
    let mut times = Vec::new();
    for _ in 0..count {
        let start = Instant::now();
        state.drag(Button::Left, step);
        picture::draw_or_go_back(state, renderer)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(times)
}

/// Waits until a file has changed, so many seconds at most.
fn wait(state: &mut Explorer, seconds: f64) -> Option<Reaction> {
    let end = Instant::now() + Duration::from_secs_f64(seconds);
    while Instant::now() < end {
        std::thread::sleep(sources::INTERVAL.min(end - Instant::now()));
        let reaction = state.poll();
        if reaction.is_some() {
            return reaction;
        }
    }
    None
}
