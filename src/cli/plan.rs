//! `glumbra plan`: the passes of a frame in words, without drawing it.

use clap::Args;

use super::Error;
use super::json::{JsonArgs, is_standard_stream};
use super::scene_args::{SceneArgs, parse_view};
use super::screen::Screen;
use crate::plan::{self, Request, ViewRequest};
use crate::scene;

/// Prints the passes that a scene needs, and what is left out and why.
#[derive(Debug, Args)]
#[command(after_help = "No OpenGL is needed: a plan is data.")]
pub struct PlanArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// Also plans this view, as `glumbra render --aov` would draw it
    #[arg(long, value_name = "NAME", value_parser = |text: &str| parse_view(text, &[]))]
    aov: Vec<ViewRequest>,

    /// Plans for this many frames
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,

    #[command(flatten)]
    json: JsonArgs,

    /// Prints the finished GLSL of every program, as the driver compiles it, with file and line marks; with PASS, of the
    /// passes whose name contains it
    #[arg(long, value_name = "PASS", num_args = 0..=1, default_missing_value = "", group = "listing", conflicts_with = "json")]
    shaders: Option<String>,

    /// Prints each light's matrices with their numbers: S, P_light, L^-1, V, and the texgen planes E_po and E_e of each
    /// set-up, with the modelview under which they are loaded; for a cube map those of its six faces
    #[arg(long, group = "listing", conflicts_with = "json")]
    matrices: bool,

    /// Prints each pass as OpenGL calls, in C that compiles: glTexGenfv, glPolygonOffset, glCopyTexSubImage2D and so on
    #[arg(long, group = "listing", conflicts_with = "json")]
    gl: bool,

    /// Prints the scene itself as TOML, with what was supplied around a model and every --set, to start one's own from;
    /// it names files by absolute paths, so that it may be saved in any folder
    #[arg(long, group = "listing", conflicts_with = "json")]
    print_scene: bool,
}

/// Plans and prints.
pub fn run(arguments: &PlanArgs, screen: Screen) -> Result<(), Error> {
    let loaded = arguments.scene.load(screen)?;
    let request = Request {
        views: arguments.aov.clone(),
        frames: arguments.frames,
        sampled_warnings: !arguments.print_scene,
        ..Request::default()
    };
    // A scene that cannot be drawn is not printed either.
    let mut plan = plan::make(&loaded.scene, &request)?;
    if let Some(pass) = &arguments.shaders {
        return super::print(&plan.shaders(pass)?);
    }
    if arguments.matrices {
        return super::print(&plan.matrices_text());
    }
    if arguments.gl {
        return super::print(&crate::fixed_function::listing::c_source(&plan.list));
    }
    plan.note_closed(&loaded.scene);
    let summary = plan.summary();
    if arguments.print_scene && is_standard_stream(&arguments.scene.scene) {
        return Err(Error::PrintStandardInput);
    }
    if arguments.print_scene {
        let settings = scene::portable_settings(&arguments.scene.scene, &arguments.scene.changes.overrides())?;
        return super::print(&settings.to_toml());
    }
    arguments.json.write("plan", &summary)?;
    if arguments.json.takes_standard_output() { Ok(()) } else { super::print(&summary.to_string()) }
}
