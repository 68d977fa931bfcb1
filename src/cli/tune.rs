//! `glumbra tune`: finds the polygon offset and the map size.

use clap::Args;

use super::json::JsonArgs;
use super::scene_args::SceneArgs;
use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::context::{self, Profile};
use crate::frame::Renderer;
use crate::report::measure::tune::{self, TuneOptions, Tuned, TunedPoint};

/// Finds the polygon offset and the smallest map that a scene needs, with ray-traced truth as the judge.
#[derive(Debug, Args)]
#[command(after_help = "\
For each map size and slope factor the least number of units is searched that leaves no false shadow (acne) on surfaces \
that face the light, beyond a band of texels around the true shadow edge; of these offsets the one that leaks least is \
taken, and of the sizes the smallest that leaks no more than --leak percent. At least 1000 pixels must be comparable. \
The answer takes the place of the light's [light.shadow]: it has the scene's other keys too. Whatever technique the scene names, it is the \
shadow map's offset; techniques without one are measured beside it.

Example:
  glumbra tune scene.toml --leak 0.1 --sizes 512,1024,2048")]
pub struct TuneArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// The light, by its place in the scene
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,

    /// Map sizes to try
    #[arg(long, value_name = "SIZE,...", value_delimiter = ',', default_values_t = [256, 512, 1024, 2048, 4096], value_parser = clap::value_parser!(u32).range(1..=16384))]
    sizes: Vec<u32>,

    /// The most leak that the smallest map may have, in percent of the pixels compared
    #[arg(long, value_name = "PERCENT", default_value_t = 0.1)]
    leak: f64,

    /// Acne allowed, in pixels per 100,000. Two pixels are always allowed, because thin steep triangles would otherwise
    /// force a huge offset
    #[arg(long, value_name = "COUNT", default_value_t = 1.0)]
    spare: f64,

    /// Half width of the band around the true edge, in texels of the map
    #[arg(long, value_name = "TEXELS", default_value_t = 2.0)]
    band: f64,

    #[command(flatten)]
    json: JsonArgs,

    #[command(flatten)]
    context: ContextArgs,
}

/// Tunes and prints.
pub fn run(arguments: &TuneArgs, screen: Screen) -> Result<(), Error> {
    let scene = arguments.scene.load(screen)?.scene;
    let mut sizes = arguments.sizes.clone();
    sizes.sort_unstable();
    sizes.dedup();
    let options = TuneOptions {
        light: arguments.light,
        sizes,
        leak_percent: arguments.leak,
        false_per_100_000: arguments.spare,
        band_texels: arguments.band,
    };
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    let mut renderer = Renderer::new(&context);
    screen.driver(context.as_ref());
    let bar = screen.spinner("{pos} offsets seen, {elapsed}: {msg}");
    let tuned = tune::tune(&scene, &options, &mut renderer, |point| {
        bar.inc(1);
        bar.set_message(line(point));
    })?;
    bar.finish_and_clear();
    arguments.json.write("tune", &tuned)?;
    if arguments.json.takes_standard_output() { Ok(()) } else { print(&tuned, &options) }
}

/// Fewest pixels in shadow; with fewer there is little that could leak.
const FEWEST_SHADOWED: usize = 100;

fn line(point: &TunedPoint) -> String {
    format!(
        "{:>5}  factor {:>4}  units {:>8}  false shadow {:>9.4} %  leak {:>8.4} %  wrong {:>8.4} %",
        point.size, point.factor, point.units, point.false_shadow_percent, point.leak_percent, point.wrong_percent
    )
}

fn print(tuned: &Tuned, options: &TuneOptions) -> Result<(), Error> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    let (compared, facing, shadowed) = (tuned.compared, tuned.compared_facing, tuned.compared_shadowed);
    writeln!(out, "# {compared} pixels were compared, {facing} of them facing the light; {shadowed} lie in shadow")?;
    if shadowed < FEWEST_SHADOWED {
        writeln!(out, "# So few in shadow say little of leak: an offset that is too large would not be seen")?;
    }
    writeln!(out, "# map   offset                          facing the light, beyond the band   all pixels compared")?;
    for point in &tuned.curve {
        writeln!(out, "{} {}", if point.clean { " " } else { "x" }, line(point))?;
    }
    writeln!(out, "\n# x: more false shadow than {} in 100,000. The best of each size:", options.false_per_100_000)?;
    for point in &tuned.best {
        writeln!(out, "  {}", line(point))?;
    }
    match &tuned.chosen {
        None => writeln!(out, "\n# No offset is free of false shadow at these sizes: try larger maps, or --spare.")?,
        Some(point) => {
            let within = if tuned.within_leak { "at most" } else { "the least found, still above" };
            writeln!(out, "\n# leak {:.4} %: {within} {} %", point.leak_percent, options.leak_percent)?;
            write!(out, "{}", tuned.chosen_toml.as_deref().unwrap_or_default())?;
        }
    }
    writeln!(out, "\n# Without an offset to tune:")?;
    for rival in &tuned.rivals {
        match &rival.errors {
            Ok(errors) => writeln!(
                out,
                "# {:<60} false shadow {:>9.4} %  leak {:>8.4} %  wrong {:>8.4} %",
                rival.settings, errors.false_shadow_percent, errors.leak_percent, errors.wrong_percent
            )?,
            Err(why) => writeln!(out, "# {:<60} {why}", rival.settings)?,
        }
    }
    Ok(())
}
