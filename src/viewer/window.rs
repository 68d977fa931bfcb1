//! A [`Show`] in a window: winit's events in, pictures out. A frame is drawn into the same framebuffer object as
//! without a window and then copied, so both have the same pixels. Nothing is drawn but on an event, or where something moves.

use std::io::Write;
use std::rc::Rc;
use std::time::{Duration, Instant};

use glam::DVec2;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalPosition;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use super::Error;
use super::keys::help_of;
use super::picture;
use super::show::{Button, Reaction, Show};
use crate::context::window::{self, WindowContext};
use crate::context::{self, Choice, Context, ContextInfo, ContextRequest, Profile};
use crate::device::Pixels;
use crate::frame::Renderer;

/// Look of a window.
#[derive(Clone, Debug)]
pub struct Shown {
    /// The window's title begins with it.
    pub title: String,
    /// Draw one frame, read it back from the window, and close it.
    pub capture: bool,
}

/// Pixels of a wheel without notches that count as one.
const PIXELS_A_STEP: f64 = 20.0;

/// Longest time in seconds that one frame moves on: a window that was hidden does not jump.
const LONGEST_STEP: f64 = 0.25;

/// Opens a window of the state's size and shows it until the user quits. The window's own pixels, if they were to be
/// captured, and its driver.
///
/// # Errors
///
/// No display, no context, and every error of a frame.
pub fn run(state: impl Show, shown: Shown) -> Result<Option<(Pixels, ContextInfo)>, Error> {
    if !context::display_is_named() {
        return Err(Error::NoDisplay);
    }
    let events = window::event_loop().map_err(cannot_open)?;
    events.set_control_flow(ControlFlow::Wait);
    let mut app = App {
        state,
        shown,
        live: None,
        mouse: Mouse::default(),
        moved: None,
        polled: Instant::now(),
        frames: 0,
        captured: None,
        failed: None,
    };
    let ended = events.run_app(&mut app);
    if let Some(error) = app.failed {
        return Err(error);
    }
    ended.map_err(|error| Error::Open(error.to_string()))?;
    if let Some(line) = app.state.end(app.frames) {
        say(&line);
    }
    Ok(app.captured)
}

struct App<S> {
    state: S,
    shown: Shown,
    live: Option<Live>,
    mouse: Mouse,
    /// Time to which the state was moved on.
    moved: Option<Instant>,
    /// Time at which the state looked for changes.
    polled: Instant,
    /// Number of frames that were drawn.
    frames: u32,
    captured: Option<(Pixels, ContextInfo)>,
    failed: Option<Error>,
}

/// A window, with the renderer that draws in it.
struct Live {
    renderer: Renderer,
    context: Rc<WindowContext>,
}

#[derive(Default)]
struct Mouse {
    at: Option<DVec2>,
    held: Vec<Button>,
}

impl<S: Show> App<S> {
    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Live, Error> {
        let request = ContextRequest {
            choice: Choice::Window,
            device: None,
            profile: Profile::Core33,
            debug: cfg!(debug_assertions),
        };
        let context =
            WindowContext::open(event_loop, &self.title(), self.state.size(), &request).map_err(cannot_open)?;
        let context = Rc::new(context);
        let renderer = Renderer::new(&(context.clone() as Rc<dyn Context>));
        Ok(Live { renderer, context })
    }

    fn title(&self) -> String {
        format!("{}: {}", self.shown.title, self.state.status())
    }

    /// Draws the state as it is into the window.
    fn draw(&mut self) -> Result<(), Error> {
        let Some(Live { renderer, context }) = &mut self.live else { return Ok(()) };
        let size = context.size();
        self.state.resize(size);
        let drawn = picture::draw_or_go_back(&mut self.state, renderer)?;
        self.frames += 1;
        drawn.present(renderer, size)?;
        if self.shown.capture && self.captured.is_none() {
            self.captured = Some((renderer.read_window(size)?, context.describe()));
        }
        Ok(context.swap_buffers()?)
    }

    fn redraw(&self) {
        if let Some(live) = &self.live {
            live.context.window().request_redraw();
        }
    }

    /// Shows the state in the title and on standard output.
    fn tell(&self) {
        if let Some(live) = &self.live {
            live.context.window().set_title(&self.title());
        }
        say(&self.state.status());
    }

    fn key(&mut self, event_loop: &ActiveEventLoop, key: &Key) {
        let Some(reaction) = key_name(key).and_then(|name| self.state.key(name)) else { return };
        match reaction {
            Reaction::Redraw => {
                self.tell();
                self.redraw();
            }
            Reaction::Retitle => self.tell(),
            Reaction::Save => {
                if let Some(live) = &mut self.live {
                    self.state.save_picture(&mut live.renderer);
                }
                self.tell();
            }
            Reaction::Quit => event_loop.exit(),
        }
    }

    fn moved(&mut self, position: PhysicalPosition<f64>) {
        let at = DVec2::new(position.x, position.y);
        let drag = self.mouse.at.map_or(DVec2::ZERO, |last| at - last);
        self.mouse.at = Some(at);
        for button in &self.mouse.held {
            self.state.drag(*button, drag);
        }
        if !self.mouse.held.is_empty() {
            self.redraw();
        }
    }

    /// Moves the state on by the time since the last call, and draws it; waits for events where nothing moves.
    fn advance(&mut self, event_loop: &ActiveEventLoop) {
        if self.shown.capture || !self.state.moves() {
            self.moved = None;
            let flow = self.poll().map_or(ControlFlow::Wait, ControlFlow::wait_duration);
            return event_loop.set_control_flow(flow);
        }
        let now = Instant::now();
        let passed = self.moved.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        self.state.advance(passed.min(LONGEST_STEP));
        self.redraw();
        event_loop.set_control_flow(ControlFlow::Poll);
    }

    /// Has the state look for changes if it is time, and returns the time until it is again.
    fn poll(&mut self) -> Option<Duration> {
        let interval = self.state.polls().filter(|_| !self.shown.capture)?;
        if self.polled.elapsed() >= interval {
            self.polled = Instant::now();
            if self.state.poll().is_some() {
                self.tell();
                self.redraw();
            }
        }
        Some(interval.saturating_sub(self.polled.elapsed()))
    }

    fn wheel(&mut self, delta: MouseScrollDelta) {
        self.state.dolly(match delta {
            MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
            MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_A_STEP,
        });
        self.redraw();
    }

    fn end(&mut self, event_loop: &ActiveEventLoop, result: Result<(), Error>) {
        if let Err(error) = result {
            self.failed = Some(error);
        }
        if self.failed.is_some() || self.captured.is_some() {
            event_loop.exit();
        }
    }
}

impl<S: Show> ApplicationHandler for App<S> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.live.is_some() {
            return;
        }
        let opened = self.open(event_loop).map(|live| self.live = Some(live));
        self.redraw();
        if opened.is_ok() && !self.shown.capture {
            say(&format!("{}\n{}", self.title(), help_of(self.state.help())));
        }
        self.end(event_loop, opened);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::RedrawRequested => {
                let drawn = self.draw();
                self.end(event_loop, drawn);
            }
            WindowEvent::Resized(size) => {
                if let Some(live) = &self.live {
                    live.context.resize(size);
                }
                self.redraw();
            }
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key, state: ElementState::Pressed, .. }, ..
            } => self.key(event_loop, &logical_key),
            WindowEvent::MouseInput { state, button, .. } => {
                let button = match button {
                    MouseButton::Left => Button::Left,
                    MouseButton::Middle => Button::Middle,
                    MouseButton::Right => Button::Right,
                    _ => return,
                };
                self.mouse.held.retain(|held| *held != button);
                if state == ElementState::Pressed {
                    self.mouse.held.push(button);
                }
            }
            WindowEvent::CursorMoved { position, .. } => self.moved(position),
            WindowEvent::CursorLeft { .. } => self.mouse.at = None,
            WindowEvent::MouseWheel { delta, .. } => self.wheel(delta),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.advance(event_loop);
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // While the event loop still has its display.
        self.live = None;
    }
}

/// Reason why there is no window, without the place in winit's sources where that was noticed.
fn cannot_open(error: context::Error) -> Error {
    let text = match error {
        context::Error::Present(text) => text,
        other => other.to_string(),
    };
    let answer = text.strip_prefix("os error at ").and_then(|rest| rest.split_once(": ")).map(|(_, answer)| answer);
    Error::Open(answer.unwrap_or(&text).to_owned())
}

/// The name that [`keys`] has for a key.
fn key_name(key: &Key) -> Option<&str> {
    match key {
        Key::Character(text) => Some(text.as_str()),
        Key::Named(NamedKey::Space) => Some("space"),
        Key::Named(NamedKey::Escape) => Some("Esc"),
        Key::Named(NamedKey::Home) => Some("Home"),
        Key::Named(NamedKey::ArrowUp) => Some("Up"),
        Key::Named(NamedKey::ArrowDown) => Some("Down"),
        Key::Named(NamedKey::ArrowLeft) => Some("Left"),
        Key::Named(NamedKey::ArrowRight) => Some("Right"),
        Key::Named(NamedKey::Backspace) => Some("Backspace"),
        Key::Named(NamedKey::PageUp) => Some("PageUp"),
        Key::Named(NamedKey::PageDown) => Some("PageDown"),
        _ => None,
    }
}

/// A line on standard output. A reader that has gone is no reason to close the window.
fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
