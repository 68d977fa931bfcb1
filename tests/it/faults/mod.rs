//! Faults of the machine, brought about on purpose: each is told by one clear error, and nothing is lost, half written or
//! mixed. Needs Unix: limits are set by the shell, drivers are chosen by Mesa's variables.

mod disk;
mod driver;
mod memory;
mod paths;
mod reports;
mod streams;

use std::path::Path;
use std::process::{Command, Output};

use crate::support::shell::*;
