//! `glumbra gallery`: failures and their cures on one page.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::context::{self, Profile};
use crate::device::Pixels;
use crate::frame::Renderer;
use crate::gallery::{self, GalleryEntry, PageFacts};
use crate::output::{self, Output};

/// Makes one page that teaches shadows by their failures: each on purpose, beside its cure and the ray tracer's truth, with
/// numbers, the scene, the passes, and the command that draws it again.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct GalleryArgs {
    /// The folder for index.html, made if it is not there; with --picture a file that ends in .png
    #[arg(short, long, value_name = "PATH", default_value = "gallery")]
    output: PathBuf,

    /// Draws pictures of half as many pixels a side
    #[arg(long)]
    quick: bool,

    /// Shows this entry; may be given again
    #[arg(long, value_name = "ID")]
    entry: Vec<String>,

    /// Writes one picture of one entry in place of the page
    #[arg(long, value_enum, value_name = "WHICH", requires = "entry")]
    picture: Option<Which>,

    /// Lists the entries and draws none
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    context: ContextArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// The failure
    Failure,
    /// The cure
    Cure,
    /// The ray tracer's picture of the cure's scene
    Truth,
    /// Differences of the failure from the truth
    Difference,
}

const HELP: &str = "\
Examples:
  glumbra gallery -o out/gallery
  glumbra gallery --quick --entry no-offset -o out/gallery
  glumbra gallery --entry no-offset --picture failure -o failure.png";

/// Draws and writes.
pub fn run(arguments: &GalleryArgs, screen: Screen) -> Result<(), Error> {
    let entries = gallery::chosen(&arguments.entry)?;
    if arguments.list {
        let lines = entries.iter().map(|entry| format!("{:24} {}\n", entry.id, entry.title));
        return super::print(&lines.collect::<String>());
    }
    if let Some(which) = arguments.picture {
        let [entry] = entries.as_slice() else { return Err(Error::OneEntry { count: entries.len() }) };
        output::check_path(&arguments.output)?;
        return picture(entry, which, arguments, screen);
    }
    let folder = &arguments.output;
    std::fs::create_dir_all(folder).map_err(|reason| gallery::Error::Folder { folder: folder.clone(), reason })?;
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    let mut renderer = Renderer::new(&context);
    screen.driver(context.as_ref());
    let facts = PageFacts { driver: context.describe().driver(), quick: arguments.quick };
    // The table of choices is of the whole page.
    let choices = if arguments.entry.is_empty() { gallery::choices()? } else { Vec::new() };
    let bar = screen.bar((entries.len() + choices.len()) as u64, "{bar:40} {pos}/{len} entries, {eta} left  {msg}");
    let mut shown = Vec::new();
    for entry in entries {
        bar.set_message(entry.id.clone());
        let drawn = gallery::show(&entry, arguments.quick, &mut renderer);
        if drawn.is_err() {
            bar.finish_and_clear();
        }
        shown.push((entry, drawn?));
        bar.inc(1);
    }
    let mut measured = Vec::new();
    for choice in &choices {
        bar.set_message(choice.id.clone());
        let prices = gallery::measure_choice(choice, arguments.quick, &mut renderer);
        if prices.is_err() {
            bar.finish_and_clear();
        }
        measured.push(prices?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let path = folder.join("index.html");
    output::write_sheets(&[], &[(path.clone(), gallery::to_html(&shown, &measured, &facts)?)])?;
    super::print(&format!("{}\n", path.display()))
}

/// Writes one picture.
fn picture(entry: &GalleryEntry, which: Which, arguments: &GalleryArgs, screen: Screen) -> Result<(), Error> {
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    screen.driver(context.as_ref());
    let shown = gallery::show(entry, arguments.quick, &mut Renderer::new(&context))?;
    let picture = match which {
        Which::Failure => &shown.failure.picture,
        Which::Cure => &shown.cure.picture,
        Which::Truth => &shown.truth,
        Which::Difference => &shown.difference,
    };
    let data = picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], u8::MAX]).collect();
    let pixels = Pixels::Rgba8 { size: [picture.width(), picture.height()], data };
    let path: &Path = &arguments.output;
    output::write_all(&[Output { path, pixels: &pixels, view: None }])?;
    screen.wrote(path, format_args!("{}, {} x {}", entry.title, picture.width(), picture.height()));
    Ok(())
}
