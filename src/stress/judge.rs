//! One row of a case: drawn, and judged against the truth pixel by pixel by the bound of its technique ([`crate::judge`]). A
//! picture with more than [`crate::judge::MOST_WRONG`] wrong pixels is beyond the bound, too.

use super::results::{CaseRow, Verdict};
use super::rows::RowSettings;
use crate::device::Pixels;
use crate::frame::{self, Renderer, ShadeImage};
use crate::judge::{Bound, Judge, shade_of_pictures};
use crate::plan::{Plan, Request, ViewRequest};
use crate::scene::{LightKind, Scene, with_shadow};
use crate::techniques;
use crate::truth;
use crate::views::View;

/// Judges rows of one light of a scene.
pub struct RowJudge<'a> {
    scene: &'a Scene,
    light: usize,
    judge: Judge<'a>,
}

/// A row, and what a picture of it needs.
pub struct Judged {
    /// The row with its verdict.
    pub row: CaseRow,
    /// Bound between right and wrong that the technique has.
    pub bound: Bound,
    /// Shade that was compared; `None`: nothing was drawn.
    pub shade: Option<ShadeImage>,
    /// Pixels beyond the bound, by index.
    pub beyond: Vec<usize>,
}

impl<'a> RowJudge<'a> {
    /// Traces the truth of light number `light`.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot read.
    pub fn new(scene: &'a Scene, light: usize) -> Result<Self, truth::Error> {
        Ok(Self { scene, light, judge: Judge::new(scene, light)? })
    }

    /// The judge of shades that were drawn otherwise.
    pub fn judge(&mut self) -> &mut Judge<'a> {
        &mut self.judge
    }

    /// Draws the light under `settings` and says how far from the truth it is.
    pub fn row(&mut self, settings: &RowSettings, renderer: &mut Renderer) -> Judged {
        self.row_of(self.scene, settings, renderer)
    }

    /// The same as [`row`](Self::row) with the picture of another scene of the same size, to test that a broken scene is
    /// noticed.
    pub fn row_of(&mut self, drawn: &Scene, settings: &RowSettings, renderer: &mut Renderer) -> Judged {
        let row = CaseRow::new(self.light, settings);
        let drawn = if settings.pictured { &in_one_light(drawn, self.light) } else { drawn };
        let unseen = |verdict, why| Judged {
            row: CaseRow { verdict, why, ..row.clone() },
            bound: Bound::NoMap,
            shade: None,
            beyond: Vec::new(),
        };
        let (plan, bound, shade) = match self.draw(drawn, settings, renderer) {
            Ok(drawn) => drawn,
            Err(Failure::Refused(why)) => return unseen(Verdict::Refused, why),
            Err(Failure::Broken(why)) => return unseen(Verdict::SilentlyWrong, why),
        };
        let judged = match settings.pictured {
            true => self.judge.pictured_shade(&shade, &bound),
            false => self.judge.shade(&shade, &bound),
        };
        let found = match judged {
            Ok(found) => found,
            Err(error) => return unseen(Verdict::SilentlyWrong, error.to_string()),
        };
        let is_right = found.outside_band == 0 && !found.is_coarse();
        let verdict = match (is_right, plan.warnings.is_empty()) {
            (true, true) => Verdict::Right,
            (true, false) => Verdict::FalseAlarm,
            (false, false) => Verdict::Warned,
            (false, true) => Verdict::SilentlyWrong,
        };
        let row = CaseRow {
            verdict,
            compared: found.compared,
            wrong: found.wrong(),
            beyond: found.outside_band,
            why: plan.warnings.join("; "),
            ..row
        };
        Judged { row, bound, shade: Some(shade), beyond: found.beyond() }
    }

    /// The plan, its bound, and the shade: as the lit pass finds it, or for pictured rows as the picture shows it against the same
    /// without shadow.
    fn draw(
        &self,
        scene: &Scene,
        settings: &RowSettings,
        renderer: &mut Renderer,
    ) -> Result<(Plan, Bound, ShadeImage), Failure> {
        let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
        let scene = techniques::with_keys(scene, self.light, &settings.to_inline()).map_err(|error| refused(&error))?;
        let (plan, picture, shade) = self.frame(&scene, renderer)?;
        let bound = Bound::of_plan(&scene, &plan, self.light);
        let mut seen = ShadeImage::of_view(scene.image.size, &shade);
        if settings.pictured {
            let bare = with_shadow(&scene, self.light, &techniques::unshadowed());
            let (_, unshadowed, _) = self.frame(&bare, renderer)?;
            seen.shade = shade_of_pictures(red(&picture), red(&unshadowed));
        }
        Ok((plan, bound, seen))
    }

    /// The plan, the picture's texels and the shade's.
    fn frame(&self, scene: &Scene, renderer: &mut Renderer) -> Result<(Plan, Vec<f32>, Vec<f32>), Failure> {
        let views = vec![ViewRequest { view: View::Shade, light: self.light }];
        let request = Request { views, float_picture: true, ..Request::default() };
        let plan = renderer.plan(scene, &request).map_err(|error| match error {
            frame::Error::Plan(error) => Failure::Refused(error.to_string()),
            other => Failure::Broken(other.to_string()),
        })?;
        let broken = |error: frame::Error| Failure::Broken(error.to_string());
        renderer.draw(&plan).map_err(broken)?;
        let mut read = renderer.read(&plan).map_err(broken)?;
        match (read.picture, read.views.pop()) {
            (Pixels::RgbaF32 { data: picture, .. }, Some(Pixels::RgbaF32 { data: shade, .. })) => {
                Ok((plan, picture, shade))
            }
            _ => Err(Failure::Broken(String::from("the pictures were not read back as floats"))),
        }
    }
}

/// The first channel of RGBA texels.
fn red(texels: &[f32]) -> impl Iterator<Item = f32> {
    texels.chunks_exact(4).map(|texel| texel[0])
}

/// The scene in the light of one lamp alone: white, without ambient light, highlights, image or attenuation, on white
/// surfaces that keep their holes.
fn in_one_light(scene: &Scene, light: usize) -> Scene {
    let mut scene = scene.clone();
    scene.shading.ambient = [0.0; 3];
    scene.image.background = [0.0; 3];
    for (index, lamp) in scene.lights.iter_mut().enumerate() {
        lamp.ambient = [0.0; 3];
        lamp.specular = [0.0; 3];
        lamp.diffuse = [if index == light { 1.0 } else { 0.0 }; 3];
        match &mut lamp.kind {
            LightKind::Spot(spot) => {
                (spot.attenuation, spot.image) = ([1.0, 0.0, 0.0], None);
                (spot.beam, spot.falloff) = (None, None);
            }
            LightKind::Point(point) => point.attenuation = [1.0, 0.0, 0.0],
            LightKind::Directional { .. } => {}
        }
    }
    scene
}

enum Failure {
    /// An error before anything was drawn.
    Refused(String),
    /// An error of the driver or of glumbra.
    Broken(String),
}
