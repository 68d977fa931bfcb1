//! `glumbra init`: a scene to begin with.

use std::path::PathBuf;

use clap::Args;

use super::screen::Screen;
use super::{Error, result_files};
use crate::keys;

/// The scene, which names no other file.
const SCENE: &str = include_str!("../../data/scenes/start.toml");
const SCENE_NAME: &str = "scene.toml";
/// The name by which the scene's first line names its schema.
const SCHEMA_NAME: &str = "schema.json";

/// Writes a scene to begin with, and a schema by which editors complete its keys
///
/// The scene needs no other file: a teapot and a ring under two lights, with the commands that show it.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  glumbra init first\n  glumbra render first/scene.toml -o picture.png")]
pub(super) struct InitArgs {
    /// The folder, made if it is not there; the scene and its schema must not be in it yet
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

pub(super) fn run(arguments: &InitArgs, screen: Screen) -> Result<(), Error> {
    let folder = &arguments.folder;
    let [scene, schema] = [SCENE_NAME, SCHEMA_NAME].map(|name| folder.join(name));
    let standing = [&scene, &schema].into_iter().find(|path| path.symlink_metadata().is_ok());
    if let Some(path) = standing {
        return Err(Error::Stands { path: path.clone() });
    }
    std::fs::create_dir_all(folder).map_err(|error| Error::MakeFolder { folder: folder.clone(), error })?;
    let schema_text = format!("{:#}\n", keys::schema(&keys::table()?));
    result_files::put(&[(&scene, SCENE.to_owned()), (&schema, schema_text)])?;
    screen.wrote(&scene, "scene");
    screen.wrote(&schema, "schema for editors");
    let scene = scene.display();
    screen.hint(format_args!("next: glumbra render '{scene}' -o picture.png"));
    Ok(())
}
