//! `--context` and `--device`, the same in every subcommand that draws.

use clap::{Args, ValueEnum};

use crate::context::{Choice, ContextRequest, Profile};

/// GL context to draw with; flattened into a subcommand's arguments.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Context")]
pub struct ContextArgs {
    /// Maker of the OpenGL context
    #[arg(long, value_enum, value_name = "KIND", default_value_t = ContextKind::Auto)]
    context: ContextKind,
    /// The EGL device to draw on, by its number in `glumbra info`
    #[arg(long, value_name = "N")]
    device: Option<usize>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ContextKind {
    /// EGL, then OSMesa, then a hidden window where there is a display
    Auto,
    /// EGL: surfaceless, then a device, then a pbuffer
    Egl,
    /// Mesa's off-screen library
    #[value(name = "osmesa")]
    OsMesa,
    /// A hidden window on X11 or Wayland
    Window,
}

impl ContextArgs {
    /// The same arguments as words of a command line.
    pub fn to_words(self) -> Vec<String> {
        let kind = self.context.to_possible_value().map(|value| format!("--context={}", value.get_name()));
        kind.into_iter().chain(self.device.map(|device| format!("--device={device}"))).collect()
    }

    /// The request for these arguments. Debug builds ask for a debug context.
    pub fn request(&self, profile: Profile) -> ContextRequest {
        let choice = match self.context {
            ContextKind::Auto => Choice::Auto,
            ContextKind::Egl => Choice::Egl,
            ContextKind::OsMesa => Choice::OsMesa,
            ContextKind::Window => Choice::Window,
        };
        ContextRequest { choice, device: self.device, profile, debug: cfg!(debug_assertions) }
    }
}
