//! Figures of the documents in data/documents.md that show a result, drawn from our own scenes as contact sheets with
//! captions. A figure is data (`table.rs`, `projected.rs`, `bumps.rs`, `bump_errors.rs`, `explained.rs`): panels, each
//! a scene with changes and a view, or a graph of what was measured. Knows scenes, plans, frames, truth and a report's
//! measures; no technique by more than a scene's keys, no GL.

mod bump_errors;
mod bumps;
mod change;
mod cut;
mod diagram;
mod draw;
mod explained;
mod graph;
mod measure;
mod painter;
pub(crate) mod panels;
mod profile;
mod projected;
mod relief;
mod sheet;
mod skins;
mod slopes;
mod sweep;
mod table;
mod turns;

use crate::frame::{self, Renderer};
use crate::geometry::skin;
use crate::judge::metrics;
use crate::output::{self, canvas::Canvas};
use crate::png_file::PngTexts;
use crate::scene::{self, Embedded, Scene};
use crate::truth;
use crate::views::View;

pub use crate::output::letters::Letters;
pub use change::SceneChange;
pub use cut::{CutLine, MapCut};
pub use diagram::Kernel;
pub use measure::{Apart, Share};
pub(crate) use panels::embedded;
pub use profile::ProfileLine;
pub use skins::SkinMap;
pub use sweep::Sweep;
pub use table::FIGURES;

/// One contact sheet.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Name of its file, and for `--only`.
    pub name: &'static str,
    pub title: &'static str,
    /// The document and its figure or slide.
    pub source: &'static str,
    pub scene: Embedded,
    /// Panels in a row.
    pub columns: u32,
    pub panels: &'static [Panel],
    pub caption: &'static str,
}

/// One picture of a figure.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    pub title: &'static str,
    /// A sentence or two below the title; may be empty.
    pub note: &'static str,
    /// Overrides, as `--set` takes them.
    pub set: &'static [&'static str],
    /// Change of the scene that no key makes.
    pub change: Option<SceneChange>,
    /// View of the first light; `None`: the picture itself.
    pub view: Option<View>,
    /// Unit of the legend where the scene's light stands at the eye and its camera at the light, to count pixels of the
    /// eye a texel. Points in shadow, which the eye does not see, are then dark.
    pub counts: Option<&'static str>,
    /// Picture that is shown in place of the finished frame or a view.
    pub stage: Option<PanelStage>,
    /// Number below the panel.
    pub measured: Measured,
    /// Side of the shadow map in texels at scale 1, where the map grows with the picture; `None`: the scene's own at any
    /// scale.
    pub map: Option<u32>,
    /// Columns that the panel takes.
    pub span: u32,
}

/// An intermediate picture, a comparison with the ray tracer, a graph or a diagram.
#[derive(Clone, Copy, Debug)]
pub enum PanelStage {
    /// The picture as it stands after the pass of this label.
    After(&'static str),
    /// The image of the first light.
    Image,
    /// The picture with the ray tracer's shadows.
    Truth,
    /// The picture, pale, with its wrong pixels in colour.
    Wrong,
    /// The picture by many samples a pixel.
    Fine,
    /// The picture with the faces of a point light's cube told apart.
    Faces,
    /// The picture with a kernel's weights in a corner.
    Kernel(Kernel),
    /// The picture, and where a cut runs through it.
    Marked(&'static MapCut),
    /// A cut through shadow maps, as a graph.
    Cut(&'static MapCut),
    /// Wrong shares over the values of a key, as a graph.
    Sweep(&'static Sweep),
    /// Light, texture, screen and eye.
    Geometry,
    /// A map of the first skin with bumps, as it is.
    Skin(SkinMap),
    /// Difference of the pictures of two panels, numbered from 0, `gain` times as bright.
    Difference { between: [usize; 2], gain: u8 },
    /// Brightness along the middle row of panels' pictures, as a graph.
    Profile(&'static [ProfileLine]),
    /// Angles between neighbouring tangent bases, before and after the skin is packed again, as bars.
    Turns,
    /// Errors of normal maps by their resolution, as a graph.
    Slopes,
}

/// Number below a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    Nothing,
    /// Shares of false shadow and of leak, by the ray tracer.
    Wrong,
    /// Difference from many samples a pixel.
    AgainstFine,
    /// Mean brightness of what is drawn, and that by many samples a pixel.
    Brightness,
    /// Difference from the picture of another panel, numbered from 0.
    From(usize),
    /// Correlation of the decal's brightness with the normals' component upwards, where there are bumps.
    FollowsUp,
}

/// Reason why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("there is no figure \"{name}\": {hint}")]
    Unknown { name: String, hint: String },
    #[error(transparent)]
    Scene(#[from] scene::Error),
    #[error(transparent)]
    Frame(#[from] frame::Error),
    #[error(transparent)]
    File(#[from] output::Error),
    #[error("figure {figure}: {reason}")]
    Truth { figure: &'static str, reason: truth::Error },
    #[error("figure {figure}: {reason}")]
    Measure { figure: &'static str, reason: metrics::Error },
    #[error("figure {figure}: {reason}")]
    Skin { figure: &'static str, reason: skin::Error },
    #[error("the font that is compiled in cannot be read: {0}")]
    Font(#[from] ab_glyph::InvalidFont),
    #[error("figure {figure}: the sheet is too large for memory; take a smaller --scale")]
    TooLarge { figure: &'static str },
    #[error("{folder}: cannot be made: {reason}", folder = .folder.display())]
    Folder { folder: std::path::PathBuf, reason: std::io::Error },
}

/// The figures of these names, all where there are none.
///
/// # Errors
///
/// A name that no figure has.
pub fn chosen(names: &[String]) -> Result<Vec<&'static Figure>, Error> {
    let find = |name: &String| {
        FIGURES.iter().find(|figure| figure.name == *name).ok_or_else(|| Error::Unknown {
            name: name.clone(),
            hint: scene::suggest(name, FIGURES.iter().map(|figure| figure.name)),
        })
    };
    if names.is_empty() { Ok(FIGURES.iter().collect()) } else { names.iter().map(find).collect() }
}

impl Figure {
    /// Texts of its PNG file.
    pub fn texts(&self, scale: u32, driver: &str) -> PngTexts {
        PngTexts::titled(format!("figure {}: {}", self.name, self.title))
            .with("Source", self.source)
            .with(PngTexts::SCENE, self.scene.path)
            .with("Scale", scale.to_string())
            .with(PngTexts::DRIVER, driver)
    }

    /// A panel's scene.
    ///
    /// # Errors
    ///
    /// An override that does not fit the scene.
    pub fn scene_of(&self, panel: &Panel) -> Result<Scene, Error> {
        self.scene_with(panel, &[])
    }

    /// A panel's scene with more overrides.
    fn scene_with(&self, panel: &Panel, more: &[String]) -> Result<Scene, Error> {
        let own = panel.set.iter().map(|text| (*text).to_owned());
        let overrides: Vec<String> = own.chain(more.iter().cloned()).collect();
        let mut scene = crate::techniques::load_embedded(&self.scene, &overrides)?.scene;
        if let Some(change) = panel.change {
            change.apply(&mut scene).map_err(|reason| Error::Skin { figure: self.name, reason })?;
        }
        Ok(scene)
    }

    /// A panel's scene with `scale` times the pixels a side, and a map that grows with it where the panel says so.
    ///
    /// # Errors
    ///
    /// An override that does not fit the scene.
    pub fn scene_at(&self, panel: &Panel, scale: u32) -> Result<Scene, Error> {
        let scene = self.scene_of(panel)?;
        if scale <= 1 {
            return Ok(scene);
        }
        let [width, height] = scene.image.size.map(|side| side * scale);
        let size = format!("image.size=[{width}, {height}]");
        let map = panel.map.map(|texels| format!("light.shadow.size={}", texels * scale));
        self.scene_with(panel, &[size].into_iter().chain(map).collect::<Vec<_>>())
    }

    /// A panel's picture without its text, with `scale` times the pixels a side.
    ///
    /// # Errors
    ///
    /// As [`Figure::draw`].
    pub fn picture(&self, panel: &Panel, scale: u32, renderer: &mut Renderer) -> Result<Canvas, Error> {
        let letters = Letters::load()?;
        Ok(draw::Drawing::new(self, scale, &letters, renderer).draw(panel)?.picture)
    }

    /// Shares of the wrong pixels of a panel at scale 1, in percent.
    ///
    /// # Errors
    ///
    /// As [`Figure::draw`].
    pub fn wrong(&self, panel: &Panel, renderer: &mut Renderer) -> Result<Share, Error> {
        let letters = Letters::load()?;
        draw::Drawing::new(self, 1, &letters, renderer).wrong(panel)
    }

    /// Number below a panel at scale 1, in words.
    ///
    /// # Errors
    ///
    /// As [`Figure::draw`].
    pub fn numbers(&self, panel: &Panel, renderer: &mut Renderer) -> Result<Option<String>, Error> {
        let letters = Letters::load()?;
        Ok(draw::Drawing::new(self, 1, &letters, renderer).draw(panel)?.numbers)
    }

    /// Draws the sheet, `scale` times as wide and high as at scale 1. `tick` is called once for each panel.
    ///
    /// # Errors
    ///
    /// A scene that cannot be planned, or a driver that cannot draw it; a picture that the ray tracer cannot answer.
    pub fn draw(&self, scale: u32, renderer: &mut Renderer, mut tick: impl FnMut()) -> Result<Canvas, Error> {
        let letters = Letters::load()?;
        let mut drawing = draw::Drawing::new(self, scale, &letters, renderer);
        let mut pictures = Vec::new();
        for panel in self.panels {
            pictures.push(drawing.draw(panel)?);
            tick();
        }
        sheet::compose(self, &pictures, &letters, scale).ok_or(Error::TooLarge { figure: self.name })
    }
}

/// Name of a panel by its place: (a), (b).
fn letter_of(index: usize) -> String {
    format!("({})", char::from(b'a' + (index % 26) as u8))
}

/// A page that lists the figures with their captions and panels.
pub fn index(figures: &[&Figure]) -> String {
    let mut text =
        String::from("# Figures\n\nResults that the shadow documents (data/documents.md) show, from our own scenes.\n");
    for Figure { name, title, source, caption, panels, .. } in figures {
        text += &format!("\n## {title}\n\n*{source}*\n\n![{title}]({name}.png)\n\n{caption}\n\n");
        for (index, panel) in panels.iter().enumerate() {
            let between = if panel.note.is_empty() { "" } else { ". " };
            text += &format!("- {} {}{between}{}\n", letter_of(index), panel.title, panel.note);
        }
    }
    text
}
