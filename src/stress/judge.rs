//! One row of a case: drawn, and compared with the truth pixel by pixel.
//!
//! # The bound
//! A pixel counts if the ray tracer is certain and the picture shows the same surface.
//!
//! - **Shadow volumes**: no pixel may be wrong. The ray tracer's certainty then grants the depth buffer's rounding, too.
//! - **Maps**: only surfaces that face the light count; on the others shading leaves no light. A wrong pixel is explained
//!   in four ways, all by the map's own numbers ([`MapInfo`]) and the scene:
//!   1. A silhouette or an open edge, as the light sees it, lies within a lookup's reach (the *band*). An edge of the
//!      visible surface itself counts if a texel holds the middle of two layers: past it the second one lies far behind.
//!   2. The pixel is dark, and a caster within that reach lies before the visible surface's plane (a crease).
//!   3. The pixel is dark, and a less steep surface within that reach is nearer to the light than its own polygon offset
//!      compensates: an offset uses the slope of the surface that is stored, not of the one that is compared.
//!   4. The pixel is lit, and its caster in the map lies so close before it that the bias reaches across.
//!
//!   For a midpoint map, instead of 2 and 3: the pixel is dark, and somewhere within that reach the middle between two
//!   layers lies before it. So thin a caster shades its own lit side, where it falls away from the light.
//!
//!   A wrong pixel that none of these explains is beyond the bound. So is a picture with more than [`MOST_WRONG`] wrong
//!   pixels.
//! - **All**: a surface where the truth has none, or the other way around, is beyond the bound.

use std::collections::HashMap;

use super::results::{CaseRow, Verdict};
use super::rows::RowSettings;
use crate::device::Pixels;
use crate::frame::{self, Renderer, ShadeImage};
use crate::lights::map::Bias;
use crate::lights::{MapInfo, MapShape};
use crate::pass::{DepthFormat, Face};
use crate::plan::{Plan, Request, ViewRequest};
use crate::scene::{LightKind, LightShape, Scene, with_shadow};
use crate::techniques;
use crate::truth::{self, Answer, Around, Blocker, Hit, Nearer, Surroundings, Truth};
use crate::views::View;

/// The greatest part of the pixels compared that may be wrong although each is explained. A map whose band is wider is too
/// coarse for its picture.
pub const MOST_WRONG: f64 = 0.015;

/// Fewest compared pixels for a meaningful share.
const FEWEST_FOR_A_SHARE: usize = 1000;

/// One light's truths.
pub struct Judge<'a> {
    scene: &'a Scene,
    light: usize,
    surroundings: Surroundings<'a>,
    /// Truth for maps.
    pub truth: Truth,
    /// Truth for shadow volumes: with the depth buffer's doubt.
    pub volume_truth: Truth,
    /// Known surroundings, by pixel and reach.
    known: HashMap<(usize, u64), Option<Around>>,
}

/// A row, and what a picture of it needs.
pub struct Judged {
    /// The row with its verdict.
    pub row: CaseRow,
    /// Shade that was compared; `None`: nothing was drawn.
    pub shade: Option<ShadeImage>,
    /// Pixels beyond the bound, by index.
    pub beyond: Vec<usize>,
}

impl<'a> Judge<'a> {
    /// Traces the truths of light number `light`.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot read.
    pub fn new(scene: &'a Scene, light: usize) -> Result<Self, truth::Error> {
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let surroundings = Surroundings::new(scene, light, &options)?;
        let truth = surroundings.truth()?;
        let doubtful = truth::Options { depth_buffer_bits: Some(24), ..options };
        let volume_truth = truth::trace(scene, light, &doubtful)?;
        Ok(Self { scene, light, surroundings, truth, volume_truth, known: HashMap::new() })
    }

    /// The truth that rows of these settings are compared with.
    pub fn truth_of(&self, settings: &RowSettings) -> &Truth {
        if settings.is_exact() { &self.volume_truth } else { &self.truth }
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
        let (plan, shade) = match self.draw(drawn, settings, renderer) {
            Ok(drawn) => drawn,
            Err(Failure::Refused(why)) => {
                return Judged {
                    row: CaseRow { verdict: Verdict::Refused, why, ..row },
                    shade: None,
                    beyond: Vec::new(),
                };
            }
            Err(Failure::Broken(why)) => {
                return Judged {
                    row: CaseRow { verdict: Verdict::SilentlyWrong, why, ..row },
                    shade: None,
                    beyond: Vec::new(),
                };
            }
        };
        let counts = self.compare(settings, &plan, &shade);
        let is_right = counts.beyond.is_empty() && !counts.is_coarse();
        let verdict = match (is_right, plan.warnings.is_empty()) {
            (true, true) => Verdict::Right,
            (true, false) => Verdict::FalseAlarm,
            (false, false) => Verdict::Warned,
            (false, true) => Verdict::SilentlyWrong,
        };
        let row = CaseRow {
            verdict,
            compared: counts.compared,
            wrong: counts.wrong,
            beyond: counts.beyond.len(),
            why: plan.warnings.join("; "),
            ..row
        };
        Judged { row, shade: Some(shade), beyond: counts.beyond }
    }

    /// The plan, and the shade: as the lit pass finds it, or for pictured rows as the picture shows it against the same
    /// without shadow.
    fn draw(
        &self,
        scene: &Scene,
        settings: &RowSettings,
        renderer: &mut Renderer,
    ) -> Result<(Plan, ShadeImage), Failure> {
        let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
        let scene = techniques::with_keys(scene, self.light, &settings.to_inline()).map_err(|error| refused(&error))?;
        let (plan, picture, shade) = self.frame(&scene, renderer)?;
        let mut seen = ShadeImage::of_view(scene.image.size, &shade);
        let channel = |texels: &[f32], channel: usize| -> Vec<f32> {
            texels.chunks_exact(4).map(|texel| texel[channel]).collect()
        };
        if settings.pictured {
            let bare = with_shadow(&scene, self.light, &techniques::unshadowed());
            let (_, unshadowed, _) = self.frame(&bare, renderer)?;
            let seen_shade = |pair| seen_shade(pair).clamp(0.0, 1.0);
            seen.shade = channel(&picture, 0).into_iter().zip(channel(&unshadowed, 0)).map(seen_shade).collect();
        }
        Ok((plan, seen))
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

    fn compare(&mut self, settings: &RowSettings, plan: &Plan, shade: &ShadeImage) -> Counts {
        let is_exact = settings.is_exact();
        let map = plan.maps.iter().find(|map| map.light == self.light).copied();
        let mut counts = Counts::default();
        for index in 0..self.truth.pixels.len() {
            let pixel = self.truth_of(settings).pixels[index];
            let should_be_lit = match (pixel.answer, shade.covered[index]) {
                (Answer::Lit, true) => true,
                (Answer::Shadowed, true) => false,
                // A picture may show no light there at all; a shade has no meaning.
                (Answer::OutsideCone, true) if settings.pictured => {
                    if !pixel.hit.is_some_and(|hit| self.is_beside(&hit)) {
                        continue;
                    }
                    counts.compared += 1;
                    if shade.shade[index] > 0.0 {
                        counts.wrong += 1;
                        counts.beyond.push(index);
                    }
                    continue;
                }
                (Answer::Lit | Answer::Shadowed, false) | (Answer::Background, true) => {
                    counts.beyond.push(index);
                    counts.compared += 1;
                    counts.wrong += 1;
                    continue;
                }
                _ => continue,
            };
            let faces = pixel.hit.is_some_and(|hit| hit.faces_light());
            if !(faces || is_exact) || shade.shade[index].is_nan() {
                continue;
            }
            counts.compared += 1;
            if (shade.shade[index] >= 0.5) == should_be_lit {
                continue;
            }
            counts.wrong += 1;
            let is_explained = !is_exact && map.is_some_and(|map| self.accounts_for(index, should_be_lit, &map));
            if !is_explained {
                counts.beyond.push(index);
            }
        }
        counts
    }

    /// Finds the surroundings of what a pixel shows, within so many texels of a map of this resolution; `None`: it shows
    /// nothing.
    pub fn around(&self, pixel: usize, map: &MapInfo, texels: f64) -> Option<Around> {
        let width = self.truth.width as usize;
        self.surroundings.around((pixel % width) as u32, (pixel / width) as u32, texels * map.texel)
    }

    /// Tests whether a point lies outside the sides of a spotlight, or behind it: before the near and beyond the far plane
    /// of its map a picture has light that the truth leaves out.
    fn is_beside(&self, hit: &Hit) -> bool {
        match &self.scene.lights[self.light].kind {
            LightKind::Spot(spot) => match spot.shape {
                LightShape::Cone => hit.in_map.length() > 1.0,
                LightShape::Frustum => hit.in_map.abs().max_element() > 1.0,
            },
            LightKind::Point(_) | LightKind::Directional { .. } => false,
        }
    }

    /// Tests whether the map's own texels explain a wrong pixel.
    fn accounts_for(&mut self, index: usize, should_be_lit: bool, map: &MapInfo) -> bool {
        // One texel more: positions round to a texel's neighbour.
        let reach = (map.reach_texels + 1.0) * map.texel * f64::from(1_u32 << (map.levels - 1).min(16));
        let width = self.truth.width as usize;
        let (x, y) = ((index % width) as u32, (index / width) as u32);
        let surroundings = &self.surroundings;
        let around =
            self.known.entry((index, reach.to_bits())).or_insert_with(|| surroundings.around(x, y, reach)).as_ref();
        let Some(around) = around else { return false };
        if around.edge {
            return true;
        }
        if map.middle && should_be_lit {
            // A depth is off by a code where it is stored, and by one where it is compared; layers within these are one.
            let codes = 2.0 * code(map, around.scale);
            return surroundings.middle(x, y, reach, codes) > -codes;
        }
        if should_be_lit {
            return around.rise > 0.0
                || (map.bias == Bias::Offset && around.nearer.iter().any(|near| shades(map, around, near)));
        }
        if map.middle && around.own_edge {
            return true;
        }
        let mut held = around.blockers.iter().filter(|blocker| holds(map, blocker)).peekable();
        held.peek().is_some() && held.all(|blocker| blocker.gap <= bias_reach(map, around, blocker))
    }
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

/// Least light that a picture of 8 bits shows: half a code. Shading at 90 degrees to the light is less in one pass and none
/// in another, by the rounding of its cosine.
const LEAST_LIGHT: f32 = 0.5 / 255.0;

/// Part of the light that a pixel shows of what it would show without shadow. NaN if there is no light to compare; 1 for
/// light where there should be none.
fn seen_shade((shown, unshadowed): (f32, f32)) -> f32 {
    match (shown > LEAST_LIGHT, unshadowed > LEAST_LIGHT) {
        (_, true) => shown / unshadowed,
        (true, false) => 1.0,
        (false, false) => f32::NAN,
    }
}

/// Tests whether a surface beside a point shades it in spite of its own polygon offset. GL's slope is the greater of the
/// two along the map's axes, each for a step of one texel: at least 1/√2 of the slope itself, for the texel's shorter side.
fn shades(map: &MapInfo, around: &Around, near: &Nearer) -> bool {
    let factor = f64::from(map.polygon.factor) * std::f64::consts::FRAC_1_SQRT_2;
    near.by > around.scale * (map.texel_short * factor * near.slope + map.texel * map.texels)
}

/// Tests whether the map is drawn from a blocker's side.
fn holds(map: &MapInfo, blocker: &Blocker) -> bool {
    match map.cull {
        None => true,
        Some(Face::Front) => blocker.is_far_side,
        Some(Face::Back) => !blocker.is_far_side,
    }
}

/// Greatest distance before a point of a surface whose shadow the bias removes, in world units along the ray.
fn bias_reach(map: &MapInfo, around: &Around, blocker: &Blocker) -> f64 {
    let texel = map.texel * around.scale;
    // GL's slope is the steeper of both axes', of a texel's width; the caster's depth is stored a reach aside, and the
    // receiver is compared a reach aside.
    let caster = (f64::from(map.polygon.factor.abs()) + map.reach_texels) * blocker.slope;
    let receiver = match map.bias {
        Bias::Offset => map.reach_texels * around.slope,
        Bias::ReceiverPlane | Bias::NormalOffset | Bias::Adaptive => 2.0 * map.reach_texels * around.slope,
    };
    // Drivers take two codes for one unit: of 24 bits they are one `code`.
    let unit = if map.format == DepthFormat::Depth16 { 2.0 } else { 1.0 };
    let codes = (unit * f64::from(map.polygon.units.abs()) + 2.0) * code(map, around.scale);
    // Depths are differences along the axis, gaps along the ray.
    around.ray * (texel * (caster + receiver + map.texels + 1.0) + codes)
}

/// Length of one code of the map's depth along the light's axis at distance `depth`, in world units.
fn code(map: &MapInfo, depth: f64) -> f64 {
    let code = match map.format {
        DepthFormat::Depth16 => 2.0_f64.powi(-16),
        _ => 2.0_f64.powi(-23),
    };
    match map.shape {
        MapShape::Spot { near, far } | MapShape::Cube { near, far } => {
            code * depth * depth * (far - near) / (near * far)
        }
        MapShape::Parallel { depth } => code * depth,
    }
}

#[derive(Default)]
struct Counts {
    compared: usize,
    wrong: usize,
    beyond: Vec<usize>,
}

impl Counts {
    fn is_coarse(&self) -> bool {
        self.compared >= FEWEST_FOR_A_SHARE && self.wrong as f64 > MOST_WRONG * self.compared as f64
    }
}

enum Failure {
    /// An error before anything was drawn.
    Refused(String),
    /// An error of the driver or of glumbra.
    Broken(String),
}
