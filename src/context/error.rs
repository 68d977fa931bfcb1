//! What can go wrong on the way to a context, said once and with what to do about it.

use std::fmt;

use super::{Choice, Road};

/// A road that was tried, and what it answered.
#[derive(Clone, Debug)]
pub struct Attempt {
    pub road: Road,
    pub answer: String,
}

#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    #[error("{}", Report(.0))]
    NoContext(Vec<Attempt>),
    #[error("--device {index}: {answer}; `glumbra info` lists the devices")]
    Device { index: usize, answer: String },
    #[error("--device {index} chooses among EGL devices; a context of kind `{}` has none", choice_name(.choice))]
    DeviceWithoutEgl { index: usize, choice: Choice },
    #[error("the {road} context cannot be made current: {answer}")]
    NotCurrent { road: String, answer: String },
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

/// What to install, by distribution.
const INSTALL: &[(&str, &str)] = &[
    ("Debian, Ubuntu", "apt-get install libegl1 libgl1-mesa-dri libosmesa6"),
    ("Fedora", "dnf install mesa-libEGL mesa-dri-drivers"),
    ("Arch", "pacman -S mesa libglvnd"),
    ("openSUSE", "zypper install Mesa-libEGL1 Mesa-dri"),
    ("Alpine", "apk add mesa-egl mesa-gl mesa-dri-gallium"),
];

/// The attempts as one message.
struct Report<'a>(&'a [Attempt]);

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "no OpenGL context can be had. What was tried, and what it answered:")?;
        for Attempt { road, answer } in self.0 {
            writeln!(f, "  {road:<16} {answer}")?;
        }
        writeln!(f, "Mesa draws without a graphics card and without a display. To install it:")?;
        for (system, command) in INSTALL {
            writeln!(f, "  {system:<16} {command}")?;
        }
        write!(f, "or run ci/demo, which installs what is missing.")
    }
}
