//! Subcommands whose cargo feature is off: they say which one that is.

use std::ffi::OsString;

use clap::Args;

use super::Error;

/// Is not compiled in.
#[derive(Debug, Args)]
#[command(hide = true, disable_help_flag = true)]
pub struct AbsentArgs {
    /// Whatever the subcommand would take
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    _all: Vec<OsString>,
}

/// The error of such a subcommand.
pub fn refuse(what: &'static str, feature: &'static str) -> Result<(), Error> {
    Err(Error::NotBuilt { what, feature })
}
