//! `glumbra generate`: shell completions and manual pages, for those who package glumbra. Not listed in the help.

use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory, Subcommand};
use clap_complete::Shell;

use super::screen::Screen;
use super::{Arguments, Error};
use crate::output::atomic_write;

/// Prints shell completions, or writes manual pages.
#[derive(Debug, Args)]
pub struct GenerateArgs {
    #[command(subcommand)]
    what: Generated,
}

#[derive(Debug, Subcommand)]
enum Generated {
    /// Prints completions, e.g. into /usr/share/bash-completion/completions/glumbra
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Writes a manual page for each command
    Man {
        /// The folder, e.g. /usr/share/man/man1; made if it is not there
        folder: PathBuf,
    },
}

/// Generates.
///
/// # Errors
///
/// A folder or file that cannot be written.
pub fn run(arguments: &GenerateArgs, screen: Screen) -> Result<(), Error> {
    match &arguments.what {
        Generated::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "glumbra", &mut text);
            super::print(&String::from_utf8_lossy(&text))
        }
        Generated::Man { folder } => write_pages(folder, screen),
    }
}

fn write_pages(folder: &Path, screen: Screen) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|error| Error::MakeFolder { folder: folder.to_owned(), error })?;
    let mut command = Arguments::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add_pages(&command, folder, &mut pages)?;
    let paths: Vec<&Path> = pages.iter().map(|(path, _)| path.as_path()).collect();
    let written = atomic_write::write_all(&paths, |index, path| std::fs::write(path, &pages[index].1));
    written.map_err(|(index, error)| Error::WriteFile { path: paths[index].to_owned(), error })?;
    paths.iter().for_each(|path| screen.wrote(path, "manual page"));
    Ok(())
}

/// The pages of a command and of those below it, hidden ones aside.
fn add_pages(command: &clap::Command, folder: &Path, pages: &mut Vec<(PathBuf, Vec<u8>)>) -> Result<(), Error> {
    let page = clap_mangen::Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text)?;
    pages.push((folder.join(page.get_filename()), text));
    let mut shown = command.get_subcommands().filter(|command| !command.is_hide_set());
    shown.try_for_each(|command| add_pages(command, folder, pages))
}
