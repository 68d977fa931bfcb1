//! Errors of opening a context, each with its remedy.

use std::fmt;

use super::{Backend, Choice};

/// A backend that was tried, and its answer.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// Backend that was tried.
    pub backend: Backend,
    /// Step that failed.
    pub reached: Reached,
    /// Reason that the system or the driver gave.
    pub answer: String,
}

/// Reason why there is no context, or why it cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// Every backend failed; each with its reason, in the order of the tries.
    #[error("{}", Report(.0))]
    NoContext(Vec<Attempt>),
    /// The requested EGL device has no context.
    #[error("--device {index}: {answer}; `glumbra info` lists the devices")]
    Device { index: usize, answer: String },
    /// A device is requested together with a context that is not EGL's.
    #[error("--device {index} chooses among EGL devices; a context of kind `{}` has none", choice_name(.choice))]
    DeviceWithoutEgl { index: usize, choice: Choice },
    /// The driver refuses to make the context current on this thread.
    #[error("the {backend} context cannot be made current: {answer}")]
    NotCurrent { backend: String, answer: String },
    /// The system's window could not be opened or drawn to.
    #[error("the window cannot be shown: {0}")]
    Present(String),
}

fn choice_name(choice: &Choice) -> &'static str {
    match choice {
        Choice::Auto => "auto",
        Choice::Egl => "egl",
        Choice::OsMesa => "osmesa",
        Choice::Window => "window",
    }
}

/// Packages to install, by distribution. OSMesa is left out: newer distributions have no such package.
const INSTALL: &[(&str, &str)] = &[
    ("Debian, Ubuntu", "apt-get install libegl1 libgl1-mesa-dri"),
    ("Fedora", "dnf install mesa-libEGL mesa-dri-drivers"),
    ("Arch", "pacman -S mesa libglvnd"),
    ("openSUSE", "zypper install Mesa-libEGL1 Mesa-dri"),
    ("Alpine", "apk add mesa-egl mesa-gl mesa-dri-gallium"),
];

/// Environment variables that choose a driver, or change what it offers (Mesa's envvars.rst; libglvnd's README).
const VARIABLES: &[&str] = &[
    "GALLIUM_DRIVER",
    "MESA_LOADER_DRIVER_OVERRIDE",
    "MESA_GL_VERSION_OVERRIDE",
    "MESA_GLSL_VERSION_OVERRIDE",
    "MESA_EXTENSION_OVERRIDE",
    "LIBGL_ALWAYS_SOFTWARE",
    "LIBGL_DRIVERS_PATH",
    "GBM_BACKENDS_PATH",
    "DRI_PRIME",
    "EGL_PLATFORM",
    "VK_DRIVER_FILES",
    "VK_ICD_FILENAMES",
    "__EGL_VENDOR_LIBRARY_DIRS",
    "__EGL_VENDOR_LIBRARY_FILENAMES",
    "__GLX_VENDOR_LIBRARY_NAME",
];

/// Those of [`VARIABLES`] that are set, with their values.
fn variables() -> Vec<String> {
    let set = VARIABLES.iter().filter_map(|name| std::env::var_os(name).map(|value| (name, value)));
    set.map(|(name, value)| format!("{name}={}", value.to_string_lossy())).collect()
}

/// Stage that a backend reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Reached {
    /// The library cannot be loaded.
    Nothing,
    /// The library is there; no driver answers.
    Library,
    /// A driver answers, and gives no context that will do.
    Driver,
}

/// Reason why a backend failed.
#[derive(Clone, Debug)]
pub(super) struct Refusal {
    pub reached: Reached,
    pub answer: String,
}

impl Refusal {
    pub fn nothing(answer: String) -> Self {
        Self { reached: Reached::Nothing, answer }
    }

    pub fn driver(answer: String) -> Self {
        Self { reached: Reached::Driver, answer }
    }
}

impl From<String> for Refusal {
    fn from(answer: String) -> Self {
        Self { reached: Reached::Library, answer }
    }
}

impl From<&str> for Refusal {
    fn from(answer: &str) -> Self {
        answer.to_owned().into()
    }
}

/// Attempts before `backend`, for the message of a crash in it: a line each, and the environment variables that may be the
/// cause.
pub(super) fn tried_before(backend: Backend, attempts: &[Attempt]) -> String {
    let mut text = format!("opening a context by {backend}");
    for Attempt { backend, answer, .. } in attempts {
        text.push_str(&format!("\n  before that      {backend}: {answer}"));
    }
    let set = variables();
    if !set.is_empty() {
        text.push_str(&format!("\n  the driver reads {}: try without", set.join(" ")));
    }
    text
}

/// The attempts as one message.
struct Report<'a>(&'a [Attempt]);

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "no OpenGL context can be had. What was tried, and what it answered:")?;
        for Attempt { backend, answer, .. } in self.0 {
            writeln!(f, "  {backend:<16} {answer}")?;
        }
        let farthest = self.0.iter().map(|attempt| attempt.reached).max().unwrap_or(Reached::Nothing);
        let set = variables();
        if self.0.iter().all(|attempt| attempt.backend == Backend::Window) {
            return write!(f, "A picture needs no window: try --context egl.");
        }
        if farthest > Reached::Nothing && !set.is_empty() {
            let these =
                if set.len() == 1 { "This variable chooses or changes" } else { "These variables choose or change" };
            return write!(f, "{these} the driver: {}. Try without.", set.join(" "));
        }
        if farthest == Reached::Driver {
            return write!(f, "A driver is there, but not for this. A newer Mesa draws OpenGL 3.3 on any machine.");
        }
        writeln!(f, "Mesa draws without a graphics card and without a display. To install it:")?;
        for (system, command) in INSTALL {
            writeln!(f, "  {system:<16} {command}")?;
        }
        write!(f, "or run ci/demo, which installs what is missing.")
    }
}
