//! Judges one light's shade pixel by pixel: who counts, what is wrong, and what explains it.

use std::collections::HashMap;

use super::bound::{Bound, explains, reach};
use super::colors::{DrawnColors, excess};
use super::edges::is_near;
use super::metrics::{self, EdgeDistance, is_lit};
use super::near::NearEdges;
use super::verdicts::{Explanation, Judgement, PixelClass};
use crate::frame::ShadeImage;
use crate::lights::MapInfo;
use crate::scene::{LightKind, LightShape, Scene};
use crate::truth::{self, Answer, Around, ColorPixel, ColorTruth, Hit, Surroundings, Truth};

/// One light's truths, with which any number of pictures of its scene are judged.
pub struct Judge<'a> {
    scene: &'a Scene,
    light: usize,
    surroundings: Surroundings<'a>,
    truth: Truth,
    /// With the depth buffer's doubt, for [`Bound::Exact`]; `None`: not traced yet.
    exact_truth: Option<Truth>,
    /// Shadow edges and silhouettes in the picture, for [`Bound::Band`]; `None`: not found yet.
    near: Option<NearEdges>,
    /// Known surroundings, by pixel and reach.
    known: HashMap<(usize, u64), Option<Around>>,
}

impl<'a> Judge<'a> {
    /// Traces the truth of light number `light`.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot read.
    pub fn new(scene: &'a Scene, light: usize) -> Result<Self, truth::Error> {
        let surroundings = Surroundings::new(scene, light, &options())?;
        let truth = surroundings.truth()?;
        Ok(Self { scene, light, surroundings, truth, exact_truth: None, near: None, known: HashMap::new() })
    }

    /// The truth that pictures under `bound` are compared with. That of [`Bound::Exact`] is traced at its first use.
    pub fn truth(&mut self, bound: &Bound) -> &Truth {
        if *bound != Bound::Exact {
            return &self.truth;
        }
        if self.exact_truth.is_none() {
            // What could be traced once can be traced again.
            let doubtful = truth::Options { depth_buffer_bits: Some(24), ..options() };
            self.exact_truth = truth::trace(self.scene, self.light, &doubtful).ok();
        }
        self.exact_truth.as_ref().unwrap_or(&self.truth)
    }

    /// Judges a shade. A value of NaN: the picture does not show the shade there.
    ///
    /// # Errors
    ///
    /// A picture of another size.
    pub fn shade(&mut self, image: &ShadeImage, bound: &Bound) -> Result<Judgement, metrics::Error> {
        self.judge(image, bound, false)
    }

    /// Judges a shade that was found from pictures in the light of one lamp, as [`super::shade_of_pictures`] finds it: light
    /// beside a spotlight's cone or frustum is wrong, too.
    ///
    /// # Errors
    ///
    /// A picture of another size.
    pub fn pictured_shade(&mut self, image: &ShadeImage, bound: &Bound) -> Result<Judgement, metrics::Error> {
        self.judge(image, bound, true)
    }

    fn judge(&mut self, image: &ShadeImage, bound: &Bound, pictured: bool) -> Result<Judgement, metrics::Error> {
        metrics::check_size(&self.truth, image)?;
        self.truth(bound);
        self.find_edges(bound);
        let classes = (0..self.truth.pixels.len()).map(|index| self.class(image, bound, pictured, index)).collect();
        Ok(Judgement::of([image.width, image.height], classes))
    }

    /// Finds the edges that a band is along.
    fn find_edges(&mut self, bound: &Bound) {
        if matches!(bound, Bound::Band { .. }) && self.near.is_none() {
            self.near = Some(NearEdges::of(&self.truth));
        }
    }

    fn class(&mut self, image: &ShadeImage, bound: &Bound, pictured: bool, index: usize) -> PixelClass {
        let truth = if *bound == Bound::Exact { self.exact_truth.as_ref() } else { None };
        let pixel = truth.unwrap_or(&self.truth).pixels[index];
        let value = image.shade[index];
        let should_be_lit = match (pixel.answer, image.covered[index]) {
            (Answer::Lit, true) => true,
            (Answer::Shadowed, true) => false,
            (Answer::OutsideCone, true) if pictured && pixel.hit.is_some_and(|hit| self.is_beside(&hit)) => {
                return if value > 0.0 { PixelClass::LightOutside } else { PixelClass::Right };
            }
            (Answer::Lit | Answer::Shadowed, false) | (Answer::Background, true) => {
                return PixelClass::Surface(self.place_of_surface(bound, index));
            }
            (Answer::Background, false) => return PixelClass::Background,
            (Answer::Ambiguous(_), _) => return PixelClass::Unknown,
            (Answer::OutsideCone, _) => return PixelClass::OutsideLight,
        };
        let faces = pixel.hit.is_some_and(|hit| hit.faces_light());
        match (faces || bound.counts_turned_away(), value.is_nan()) {
            (false, _) => PixelClass::TurnedAway,
            (true, true) => PixelClass::NoShade,
            (true, false) if is_lit(value) == should_be_lit => PixelClass::Right,
            (true, false) => self.wrong_class(bound, index, should_be_lit),
        }
    }

    fn wrong_class(&mut self, bound: &Bound, index: usize, should_be_lit: bool) -> PixelClass {
        let place =
            if self.accounts_for(bound, index, should_be_lit) { Explanation::Explained } else { Explanation::Beyond };
        if should_be_lit { PixelClass::FalseShadow(place) } else { PixelClass::Leak(place) }
    }

    /// The truth without a depth buffer's doubt.
    pub(super) fn plain_truth(&self) -> &Truth {
        &self.truth
    }

    pub(super) fn scene(&self) -> &Scene {
        self.scene
    }

    pub(super) fn light(&self) -> usize {
        self.light
    }

    /// The object whose shadow lies on the point that a pixel shows: the one before it along the light's ray.
    pub(super) fn caster(&self, pixel: usize) -> Option<usize> {
        let [x, y] = self.place(pixel);
        let around = self.surroundings.around(x, y, 0.0)?;
        let nearest = around.blockers.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
        nearest.map(|blocker| blocker.object as usize)
    }

    /// Distances in pixels from the shadow edges that a picture shows on surfaces facing the light to the nearest true ones, and
    /// from the true ones to the nearest shown. `None`: there are none to measure.
    ///
    /// # Errors
    ///
    /// A picture of another size.
    pub fn edge_distances(&self, image: &ShadeImage) -> Result<[Option<EdgeDistance>; 2], metrics::Error> {
        metrics::check_size(&self.truth, image)?;
        let known = image.shade.iter().zip(&image.covered).map(|(value, covered)| *covered && !value.is_nan());
        let shade = image.shade.iter().map(|value| value.clamp(0.0, 1.0)).collect();
        let known = ShadeImage { covered: known.collect(), shade, ..*image };
        // No band: the distances are of use alone.
        let found = metrics::compare(&self.truth, &known, &metrics::Band { texels: 0.0, map_size: [1, 1] })?;
        Ok([found.facing.rendered_to_true, found.facing.true_to_rendered])
    }

    /// Takes every pixel of a picture that does not know where surfaces are as covered where the truth has a surface.
    pub fn cover_surfaces(&self, image: &mut ShadeImage) {
        image.covered = self.truth.pixels.iter().map(|pixel| pixel.answer != Answer::Background).collect();
    }

    /// A shade that is wrong where a judgement of colours says so: for a picture of the differences.
    pub fn shade_of(&self, judgement: &Judgement) -> ShadeImage {
        let pixels = || self.truth.pixels.iter().zip(&judgement.classes);
        let shade = pixels().map(|(pixel, class)| match class {
            PixelClass::FalseShadow(_) => 0.0,
            PixelClass::Leak(_) => 1.0,
            _ => f32::from(u8::from(pixel.answer == Answer::Lit)),
        });
        let covered = pixels()
            .map(|(pixel, class)| (pixel.answer != Answer::Background) != matches!(class, PixelClass::Surface(_)));
        let [width, height] = judgement.size;
        ShadeImage { width, height, shade: shade.collect(), covered: covered.collect() }
    }

    /// Judges colours against their bounds. Too dark a pixel is false shadow, too bright a one a leak, and one that differs
    /// where the scene has no surface is a surface in only one of the two. Pixels whose colour is not known are
    /// [`PixelClass::Unknown`].
    ///
    /// # Errors
    ///
    /// A picture of another size.
    pub fn colors(
        &mut self,
        truth: &ColorTruth,
        drawn: &DrawnColors,
        bound: &Bound,
    ) -> Result<Judgement, metrics::Error> {
        let expected = [self.truth.width, self.truth.height];
        if drawn.size != expected || drawn.codes.len() != self.truth.pixels.len() {
            return Err(metrics::Error::Size { found: drawn.size, expected });
        }
        self.find_edges(bound);
        let pixels = truth.pixels.iter().zip(&drawn.codes).enumerate();
        let class = |(index, (due, codes)): (usize, (&ColorPixel, &[f64; 3]))| {
            let is_seen = self.truth.pixels[index].hit.is_some();
            match (due.is_known, excess(truth, due, *codes), is_seen) {
                (false, ..) => PixelClass::Unknown,
                (true, None, false) => PixelClass::Background,
                (true, None, true) => PixelClass::Right,
                (true, Some(_), false) => PixelClass::Surface(self.place_of_surface(bound, index)),
                (true, Some(too_dark), true) => self.wrong_class(bound, index, too_dark),
            }
        };
        Ok(Judgement::of(expected, pixels.map(class).collect()))
    }

    /// Column and row of a pixel.
    pub(super) fn place(&self, index: usize) -> [u32; 2] {
        let width = self.truth.width as usize;
        [(index % width) as u32, (index / width) as u32]
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

    /// Surfaces in only one of the two are explained by a band alone, along silhouettes.
    fn place_of_surface(&self, bound: &Bound, index: usize) -> Explanation {
        let is_near = self.near.as_ref().is_some_and(|near| near.is_by_silhouette(index));
        if matches!(bound, Bound::Band { .. }) && is_near { Explanation::Explained } else { Explanation::Beyond }
    }

    /// Tests whether the bound explains a wrong pixel.
    fn accounts_for(&mut self, bound: &Bound, index: usize, should_be_lit: bool) -> bool {
        match bound {
            Bound::Exact | Bound::NoMap => false,
            Bound::Map(map) => self.map_accounts_for(map, index, should_be_lit),
            Bound::Band { pixels } => self.band_accounts_for(*pixels, index),
        }
    }

    fn map_accounts_for(&mut self, map: &MapInfo, index: usize, should_be_lit: bool) -> bool {
        let reach = reach(map);
        let [x, y] = self.place(index);
        let surroundings = &self.surroundings;
        let around =
            self.known.entry((index, reach.to_bits())).or_insert_with(|| surroundings.around(x, y, reach)).as_ref();
        around
            .is_some_and(|around| explains(map, around, should_be_lit, |codes| surroundings.middle(x, y, reach, codes)))
    }

    /// A shadow edge explains a pixel by its distance in the picture; one that is hidden or casts on no surface that is seen, by a
    /// silhouette that the light sees as near, on the surface.
    fn band_accounts_for(&self, pixels: f64, index: usize) -> bool {
        if self.near.as_ref().is_some_and(|near| near.to_shadow_edge(index) <= pixels) {
            return true;
        }
        let [x, y] = self.place(index);
        let cos = self.truth.pixels[index].hit.map(|hit| hit.cos_light.abs());
        let scale = self.surroundings.around(x, y, 0.0).map(|around| around.scale);
        // The light sees lengths on a surface shortened by the cosine; the corners of the square that is searched lie farther.
        let on_surface = self.pixel_step(index) * pixels * std::f64::consts::FRAC_1_SQRT_2;
        let reach = cos.zip(scale).map(|(cos, scale)| on_surface * cos / scale);
        reach.and_then(|reach| self.surroundings.around(x, y, reach)).is_some_and(|around| around.edge)
    }

    /// The shortest way on the surface to the point that a neighbour shows, in world units; 0: none shows this surface.
    fn pixel_step(&self, index: usize) -> f64 {
        let [x, y] = self.place(index);
        let Some(here) = self.truth.pixels[index].hit else { return 0.0 };
        let beside = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
        let hits = beside.into_iter().filter_map(|(x, y)| self.truth.at(x, y)?.hit).filter(|hit| is_near(&here, hit));
        let step = hits.map(|hit| here.position.distance(hit.position)).fold(f64::INFINITY, f64::min);
        if step.is_finite() { step } else { 0.0 }
    }
}

/// Every pixel is of use where most are certain: one that is not is only left out.
pub(super) fn options() -> truth::Options {
    truth::Options { most_ambiguous: 1.0, ..truth::Options::default() }
}
