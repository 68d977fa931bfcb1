//! Contexts of a window on X11 or Wayland, by winit and glutin: a visible one for the sample program, and a hidden one as
//! the last backend. Sizes are physical pixels; the display's scale factor is ignored.

use std::cell::RefCell;
use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::Duration;

use glutin::config::{Config, ConfigTemplateBuilder, GlConfig};
use glutin::context::{
    ContextApi, ContextAttributesBuilder, GlProfile, NotCurrentContext, NotCurrentGlContext, PossiblyCurrentContext,
    PossiblyCurrentGlContext, Version,
};
use glutin::display::{Display, DisplayApiPreference, GlDisplay};
use glutin::surface::{GlSurface, Surface, SurfaceAttributesBuilder, WindowSurface};
use glutin_winit::finalize_window;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::platform::pump_events::EventLoopExtPumpEvents;
use winit::platform::x11::register_xlib_error_hook;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::{Window, WindowAttributes, WindowId};

use super::error::Refusal;
use super::load::{self, LoadedContext};
use super::{Backend, Context, ContextRequest, Error, Profile, display_is_named};

/// A window and its context.
///
/// The order of the fields is that of their end: surface, context, functions, and the window last.
pub struct WindowContext {
    surface: Surface<WindowSurface>,
    context: PossiblyCurrentContext,
    loaded: LoadedContext,
    window: Window,
}

/// An event loop for a visible window; one a process. Refuses, where winit would panic, a machine that lacks a library.
pub fn event_loop() -> Result<EventLoop<()>, Error> {
    check_libraries().map_err(Error::Present)?;
    EventLoop::new().map_err(|error| Error::Present(error.to_string()))
}

impl WindowContext {
    /// Opens a visible window of `size` pixels with a context that is current; for [`ApplicationHandler::resumed`].
    pub fn open(
        event_loop: &ActiveEventLoop,
        title: &str,
        size: [u32; 2],
        request: &ContextRequest,
    ) -> Result<Self, Error> {
        let attributes =
            Window::default_attributes().with_title(title).with_inner_size(PhysicalSize::<u32>::from(size));
        create(event_loop, attributes, request).map_err(Error::Present)
    }

    /// The window, for redraw requests, titles and cursors.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Width and height of what is drawn to, in physical pixels; never 0.
    pub fn size(&self) -> [u32; 2] {
        let PhysicalSize { width, height } = self.window.inner_size();
        [width.max(1), height.max(1)]
    }

    /// Follows the window to a new size, as [`WindowEvent::Resized`] gives it.
    pub fn resize(&self, size: PhysicalSize<u32>) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) {
            self.surface.resize(&self.context, width, height);
        }
    }

    /// Shows what was drawn into the default framebuffer.
    pub fn swap_buffers(&self) -> Result<(), Error> {
        self.window.pre_present_notify();
        self.surface.swap_buffers(&self.context).map_err(|error| Error::Present(error.to_string()))
    }
}

impl Context for WindowContext {
    fn loaded(&self) -> &LoadedContext {
        &self.loaded
    }

    fn make_current(&self) -> Result<(), Error> {
        self.context
            .make_current(&self.surface)
            .map_err(|error| Error::NotCurrent { backend: self.loaded.backend.clone(), answer: error.to_string() })
    }

    fn is_current(&self) -> bool {
        self.context.is_current()
    }
}

impl Drop for WindowContext {
    fn drop(&mut self) {
        if self.context.is_current() {
            // A context that cannot be released is destroyed as it is.
            let _ = self.context.make_not_current_in_place();
        }
    }
}

/// A context on a hidden window. The error is this backend's answer.
pub(super) fn open_hidden(request: &ContextRequest) -> Result<Rc<dyn Context>, Refusal> {
    thread_local! {
        /// winit allows one event loop a process. It is kept to the end: dropping it would close the display.
        static EVENTS: RefCell<Option<&'static mut EventLoop<()>>> = const { RefCell::new(None) };
    }
    if !display_is_named() {
        return Err("there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    check_libraries().map_err(Refusal::nothing)?;
    EVENTS.with_borrow_mut(|kept| {
        if kept.is_none() {
            *kept = Some(Box::leak(Box::new(start_events()?)));
        }
        let Some(events) = kept else { return Err("no event loop".into()) };
        let mut opening = Opening { request, opened: None };
        events.pump_app_events(Some(Duration::ZERO), &mut opening);
        match opening.opened {
            Some(Ok(context)) => Ok(Rc::new(context) as Rc<dyn Context>),
            Some(Err(answer)) => Err(answer.into()),
            None => Err("the window system does not answer".into()),
        }
    })
}

fn start_events() -> Result<EventLoop<()>, String> {
    let mut builder = EventLoop::builder();
    // Tests open contexts on threads of their own.
    #[cfg(target_os = "linux")]
    {
        winit::platform::x11::EventLoopBuilderExtX11::with_any_thread(&mut builder, true);
        winit::platform::wayland::EventLoopBuilderExtWayland::with_any_thread(&mut builder, true);
    }
    builder.build().map_err(|error| error.to_string())
}

/// Opens the hidden window when the event loop first lets it.
struct Opening<'a> {
    request: &'a ContextRequest,
    opened: Option<Result<WindowContext, String>>,
}

impl Opening<'_> {
    fn open(&mut self, event_loop: &ActiveEventLoop) {
        if self.opened.is_none() {
            let size = PhysicalSize::new(16, 16);
            let attributes =
                Window::default_attributes().with_title("glumbra").with_inner_size(size).with_visible(false);
            self.opened = Some(create(event_loop, attributes, self.request));
        }
    }
}

impl ApplicationHandler for Opening<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        self.open(event_loop);
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, _: WindowEvent) {}

    // The event loop resumes only once; a second window of the process comes by here.
    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.open(event_loop);
    }
}

/// winit and its helpers panic where these cannot be loaded.
fn check_libraries() -> Result<(), String> {
    let needed: &[&str] = if cfg!(target_os = "linux") { &["libxkbcommon.so.0", "libxkbcommon-x11.so.0"] } else { &[] };
    for name in needed {
        // SAFETY: these libraries have no constructors that act on the process.
        unsafe { libloading::Library::new(name) }.map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Window, surface and context, in the order in which GLX wants them: the window is made for the configuration.
fn create(
    event_loop: &ActiveEventLoop,
    attributes: WindowAttributes,
    request: &ContextRequest,
) -> Result<WindowContext, String> {
    let handle = event_loop.display_handle().map_err(|error| error.to_string())?.as_raw();
    let preference = DisplayApiPreference::GlxThenEgl(Box::new(register_xlib_error_hook));
    // SAFETY: the display's handle is the event loop's, which outlives the window.
    let display = unsafe { Display::new(handle, preference) }.map_err(|error| error.to_string())?;
    let config = choose_config(&display)?;
    let window = finalize_window(event_loop, attributes, &config).map_err(|error| error.to_string())?;
    let surface = create_surface(&display, &config, &window)?;
    let context = create_context(&display, &config, &window, request)?;
    let context = context.make_current(&surface).map_err(|error| error.to_string())?;
    // SAFETY: the context is current; the display answers with its functions or null.
    let loaded =
        unsafe { load::load(Backend::Window.to_string(), request, move |name| display.get_proc_address(name)) }?;
    Ok(WindowContext { surface, context, loaded, window })
}

/// The plainest configuration: nothing but finished pictures is shown in a window, and these come from framebuffer
/// objects. Among equals the driver's first.
fn choose_config(display: &Display) -> Result<Config, String> {
    let template = ConfigTemplateBuilder::new().with_depth_size(0).with_stencil_size(0).build();
    // SAFETY: the template names no native window.
    let configs = unsafe { display.find_configs(template) }.map_err(|error| error.to_string())?;
    let plainest = configs.min_by_key(|config| (config.num_samples(), config.depth_size(), config.stencil_size()));
    plainest.ok_or_else(|| "the display has no configuration for OpenGL".to_owned())
}

fn create_surface(display: &Display, config: &Config, window: &Window) -> Result<Surface<WindowSurface>, String> {
    let handle = window.window_handle().map_err(|error| error.to_string())?.as_raw();
    let size = window.inner_size();
    let at_least_one = |length: u32| NonZeroU32::new(length).unwrap_or(NonZeroU32::MIN);
    let attributes = SurfaceAttributesBuilder::<WindowSurface>::new().build(
        handle,
        at_least_one(size.width),
        at_least_one(size.height),
    );
    // SAFETY: the window was made for this configuration and outlives the surface.
    unsafe { display.create_window_surface(config, &attributes) }.map_err(|error| error.to_string())
}

fn create_context(
    display: &Display,
    config: &Config,
    window: &Window,
    request: &ContextRequest,
) -> Result<NotCurrentContext, String> {
    let handle = window.window_handle().map_err(|error| error.to_string())?.as_raw();
    let profile = match request.profile {
        Profile::Core33 => GlProfile::Core,
        Profile::Compatibility => GlProfile::Compatibility,
    };
    let attributes = ContextAttributesBuilder::new()
        .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
        .with_profile(profile)
        .with_debug(request.debug)
        .build(Some(handle));
    // SAFETY: the window's handle is valid as long as the window, which outlives the context.
    unsafe { display.create_context(config, &attributes) }.map_err(|error| error.to_string())
}
