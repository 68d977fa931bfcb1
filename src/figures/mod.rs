//! Figures of the documents in data/documents.md that show a result, drawn from our own scenes as contact sheets with
//! captions. A figure is data (`table.rs`): panels, each a scene with changes and a view. Knows scenes, plans and frames;
//! no technique by more than a scene's keys, no GL.

mod panels;
mod projected;
mod sheet;
mod table;

use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::output::{self, canvas::Canvas};
use crate::plan::{Request, ViewRequest};
use crate::scene::{self, Embedded, Scene};
use crate::views::View;

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
    /// Overrides, as `--set` takes them.
    pub set: &'static [&'static str],
    /// View of the first light; `None`: the picture itself.
    pub view: Option<View>,
    /// Unit of the legend, in words, if the panel has the light's view of the eye instead of the eye's view of the light.
    /// Points that the eye does not see are then dark.
    pub counts: Option<&'static str>,
    /// Something else than the finished picture.
    pub stage: Option<PanelStage>,
}

/// Part of how a picture comes about.
#[derive(Clone, Copy, Debug)]
pub enum PanelStage {
    /// The picture as it stands after the pass of this label.
    After(&'static str),
    /// The image of the first light.
    Image,
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
    /// A panel's scene.
    ///
    /// # Errors
    ///
    /// An override that does not fit the scene.
    pub fn scene_of(&self, panel: &Panel) -> Result<Scene, Error> {
        let overrides: Vec<String> = panel.set.iter().map(|text| (*text).to_owned()).collect();
        Ok(crate::techniques::load_embedded(&self.scene, &overrides)?.scene)
    }

    /// Draws the sheet; `tick` is called once a panel.
    ///
    /// # Errors
    ///
    /// A scene that cannot be planned, or a driver that cannot draw it.
    pub fn draw(&self, renderer: &mut Renderer, mut tick: impl FnMut()) -> Result<Canvas, Error> {
        let mut pictures = Vec::new();
        for panel in self.panels {
            pictures.push(draw(&self.scene_of(panel)?, panel, renderer)?);
            tick();
        }
        Ok(sheet::compose(self, &pictures))
    }
}

fn draw(scene: &Scene, panel: &Panel, renderer: &mut Renderer) -> Result<Canvas, Error> {
    let shade = panel.counts.map(|_| View::Shade);
    let views = panel.view.into_iter().chain(shade).map(|view| ViewRequest { view, light: 0 }).collect();
    let mut plan = renderer.plan(scene, &Request { views, ..Request::default() })?;
    match panel.stage {
        Some(PanelStage::After(pass)) => plan = plan.after_pass(pass).map_err(frame::Error::from)?,
        Some(PanelStage::Image) => return Ok(output::to_canvas(&image_of(scene), None)),
        None => {}
    }
    renderer.draw(&plan)?;
    let mut frame = renderer.read(&plan)?;
    if plan.ends_in_alpha() {
        frame.picture = frame.picture.alpha_as_gray();
    }
    let shown = frame.views.first().unwrap_or(&frame.picture);
    match (panel.counts, shown, frame.views.get(1)) {
        (Some(one), Pixels::RgbaF32 { size, data }, Some(Pixels::RgbaF32 { data: shade, .. })) => {
            Ok(output::densities(*size, &where_lit(data, shade), one))
        }
        _ => Ok(output::to_canvas(shown, panel.view)),
    }
}

/// The image of the first light, rows from the top down; of no size if it has none.
fn image_of(scene: &Scene) -> Pixels {
    let image = scene.lights.first().and_then(|light| light.spot()?.image.as_deref());
    let (size, rgba) = image.map_or(([0; 2], &[][..]), |image| ([image.width, image.height], &image.rgba));
    let rows = rgba.chunks_exact(4 * size[0].max(1) as usize).rev();
    Pixels::Rgba8 { size, data: rows.flatten().copied().collect() }
}

/// `view` with nothing where the light does not reach.
fn where_lit(view: &[f32], shade: &[f32]) -> Vec<f32> {
    let pixels = view.as_chunks::<4>().0.iter().zip(shade.as_chunks::<4>().0);
    pixels.flat_map(|(pixel, [shade, ..])| if *shade > 0.5 { *pixel } else { [0.0; 4] }).collect()
}

/// A page that lists the figures with their captions.
pub fn index(figures: &[&Figure]) -> String {
    let mut text =
        String::from("# Figures\n\nResults that the shadow documents (data/documents.md) show, from our own scenes.\n");
    for Figure { name, title, source, caption, .. } in figures {
        text += &format!("\n## {title}\n\n*{source}*\n\n![{title}]({name}.png)\n\n{caption}\n");
    }
    text
}
