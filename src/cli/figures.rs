//! `glumbra figures`: figures of the documents in data/documents.md, from our own scenes.

use std::path::PathBuf;

use clap::Args;

use super::screen::Screen;
use super::{ContextArgs, Error};
use crate::context::{self, Profile};
use crate::figures::{self, FIGURES};
use crate::frame::Renderer;
use crate::output::{self, SheetFile};

/// Draws the figures of the documents in data/documents.md that show a result, from our own scenes, as contact sheets
/// with captions, graphs and shares of wrong pixels.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct FiguresArgs {
    /// The folder for the sheets and index.md; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "figures")]
    output: PathBuf,

    /// Draws this figure; may be given again
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,

    /// Factor of the sheets' width and height; at 1 a panel has 400 by 300 pixels. Renders pictures at that size
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    scale: u32,

    /// Lists the figures and draws none
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    context: ContextArgs,
}

const HELP: &str = "\
Examples:
  glumbra figures -o out/figures
  glumbra figures --only hsm-6-dueling-frusta --only gdc-volumes -o out
  glumbra figures --scale 2 -o out/large      # for slides and print";

/// Draws and writes.
pub fn run(arguments: &FiguresArgs, screen: Screen) -> Result<(), Error> {
    use std::io::Write;
    let chosen = figures::chosen(&arguments.only)?;
    if arguments.list {
        let mut out = std::io::stdout().lock();
        for figure in FIGURES {
            writeln!(out, "{:22} {}", figure.name, figure.title)?;
        }
        return Ok(());
    }
    let folder = &arguments.output;
    std::fs::create_dir_all(folder).map_err(|reason| figures::Error::Folder { folder: folder.clone(), reason })?;
    let context = context::open(&arguments.context.request(Profile::Core33))?;
    let mut renderer = Renderer::new(&context);
    screen.driver(context.as_ref());
    let driver = context.describe().driver();
    let panels = chosen.iter().map(|figure| figure.panels.len() as u64).sum();
    let bar = screen.bar(panels, "{bar:40} {pos}/{len} panels, {eta} left  {msg}");
    let mut sheets = Vec::new();
    for figure in &chosen {
        bar.set_message(figure.name);
        let sheet = figure.draw(arguments.scale, &mut renderer, || bar.inc(1))?;
        let path = folder.join(format!("{}.png", figure.name));
        sheets.push(SheetFile { path, canvas: sheet, texts: figure.texts(arguments.scale, &driver) });
    }
    bar.finish_and_clear();
    let index = folder.join("index.md");
    output::write_sheets(&sheets, &[(index.clone(), figures::index(&chosen))])?;
    writeln!(std::io::stdout(), "{}", index.display())?;
    Ok(())
}
