//! "When which?": cases in which one technique is suited and another is not, each measured
//! [GDC, "Situations Suited for Shadow Mapping"].

use serde::Deserialize;

use super::draw::{facing_errors, load, quick_size};
use super::{Error, scenes};
use crate::frame::Renderer;
use crate::plan::Request;
use crate::scene::Scene;
use crate::truth;

/// A case, as `data/gallery/choices.toml` has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TechniqueChoice {
    /// Name in links.
    pub id: String,
    pub title: String,
    /// Use of shadow maps in this case, as the document has it.
    pub verdict: MapVerdict,
    /// A sentence or two.
    pub why: String,
    /// Tag of the document in data/documents.md, without brackets.
    pub document: String,
    pub section: String,
    /// Path of the scene in the repository.
    pub scene: String,
    /// Overrides of both techniques.
    #[serde(default)]
    pub set: Vec<String>,
    pub first: Candidate,
    pub second: Candidate,
}

/// Use of shadow maps in a case.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum MapVerdict {
    Suited,
    IllAdvised,
}

impl MapVerdict {
    /// The verdict in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Suited => "suited",
            Self::IllAdvised => "ill-advised",
        }
    }
}

/// A technique that is measured.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    pub name: String,
    /// Overrides that choose it.
    pub set: Vec<String>,
}

/// A case with its measures, the first technique's first.
#[derive(Clone, Debug)]
pub struct MeasuredChoice {
    pub choice: TechniqueChoice,
    pub measures: [Price; 2],
}

/// A technique's wrong pixels, and its price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// Percent of the surfaces that face the light.
    pub wrong_percent: f64,
    /// Median time of a frame that draws everything anew, in milliseconds.
    pub frame_ms: f64,
}

/// Frames that are timed after the first.
const FRAMES: u32 = 5;

/// Every case, in the page's order.
///
/// # Errors
///
/// A file that was compiled in damaged.
pub fn choices() -> Result<Vec<TechniqueChoice>, Error> {
    #[derive(Deserialize)]
    struct File {
        choice: Vec<TechniqueChoice>,
    }
    let file: File = toml::from_str(include_str!("../../data/gallery/choices.toml"))?;
    Ok(file.choice)
}

/// Measures both techniques of a case. `quick`: in pictures of half as many pixels a side.
///
/// # Errors
///
/// A scene that cannot be loaded, planned, drawn or traced.
pub fn measure(choice: &TechniqueChoice, quick: bool, renderer: &mut Renderer) -> Result<MeasuredChoice, Error> {
    let scene = |candidate: &Candidate| -> Result<Scene, Error> {
        let embedded = scenes::find(&choice.scene)
            .ok_or_else(|| Error::NoScene { id: choice.id.clone(), scene: choice.scene.clone() })?;
        let always = String::from("light.shadow.redraw=always");
        let overrides: Vec<String> = choice.set.iter().chain(&candidate.set).cloned().chain([always]).collect();
        let mut scene = load(&choice.id, embedded, &overrides)?;
        if quick {
            scene.image.size = quick_size(scene.image.size);
        }
        Ok(scene)
    };
    let scenes = [scene(&choice.first)?, scene(&choice.second)?];
    let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
    let truth =
        truth::trace(&scenes[0], 0, &options).map_err(|reason| Error::Truth { id: choice.id.clone(), reason })?;
    let mut price = |scene: &Scene| -> Result<Price, Error> {
        let failed = |reason| Error::Frame { id: choice.id.clone(), reason: Box::new(reason) };
        let (errors, _) = facing_errors(&choice.id, scene, (0, &truth), None, renderer)?;
        let request = Request { frames: FRAMES + 1, sampled_warnings: false, ..Request::default() };
        let plan = renderer.plan(scene, &request).map_err(failed)?;
        let mut times = renderer.draw_timed(&plan, FRAMES + 1, false, || ()).map_err(failed)?.frames_ms.split_off(1);
        times.sort_by(f64::total_cmp);
        let frame_ms = times.get(times.len() / 2).copied().unwrap_or_default();
        Ok(Price { wrong_percent: errors.wrong_percent, frame_ms })
    };
    let measures = [price(&scenes[0])?, price(&scenes[1])?];
    Ok(MeasuredChoice { choice: choice.clone(), measures })
}
