//! Draws a figure's panels: each by the renderer, from the panel's own scene.

use std::collections::HashMap;

use super::measure::{self, Share};
use super::sheet::{Drawn, PANEL, width_of};
use super::{
    Error, Figure, Letters, Measured, Panel, PanelStage, cut, diagram, letter_of, profile, skins, slopes, sweep, turns,
};
use crate::device::Pixels;
use crate::figures::painter::Painter;
use crate::frame::{self, Renderer};
use crate::output::{self, Keyed, canvas::Canvas, canvas::Color};
use crate::plan::{Request, ViewRequest};
use crate::scene::Scene;
use crate::truth::{self, Truth};
use crate::views::View;

/// Ground of graphs and diagrams.
pub const CARD: Color = [255, 255, 255];

/// Samples a pixel and side of [`PanelStage::Fine`].
const SAMPLES: u32 = 8;

/// A figure that is being drawn.
pub struct Drawing<'a> {
    figure: &'a Figure,
    letters: &'a Letters,
    renderer: &'a mut Renderer,
    scale: u32,
    /// Ray-traced visibility, keyed by the scale and by the overrides of other keys than `light.shadow`.
    truths: HashMap<(u32, Vec<&'static str>), Truth>,
}

impl<'a> Drawing<'a> {
    pub fn new(figure: &'a Figure, scale: u32, letters: &'a Letters, renderer: &'a mut Renderer) -> Self {
        Self { figure, letters, renderer, scale, truths: HashMap::new() }
    }

    /// A panel's picture, and what is measured of it.
    pub fn draw(&mut self, panel: &Panel) -> Result<Drawn, Error> {
        match panel.stage {
            Some(PanelStage::Difference { between, gain }) => {
                let [one, other] = [self.other(between[0])?, self.other(between[1])?];
                let names = between.map(letter_of);
                let words = measure::Apart::of(&one, &other).in_words(&names[1]);
                let numbers = Some(format!("{}: {words}", names[0]));
                Ok(Drawn { picture: measure::amplify(&one, &other, gain), numbers })
            }
            Some(PanelStage::Turns) => {
                let found = turns::measure(&self.figure.scene_of(panel)?);
                let all = found.map_err(|reason| Error::Skin { figure: self.figure.name, reason })?;
                let picture = self.on_card(panel, |painter| turns::draw(painter, &all))?;
                Ok(Drawn { picture, numbers: Some(turns::in_words(&all)) })
            }
            Some(PanelStage::Slopes) => {
                let errors = slopes::measure();
                let picture = self.on_card(panel, |painter| slopes::graph(&errors).draw(painter))?;
                Ok(Drawn { picture, numbers: Some(slopes::in_words(&errors)) })
            }
            _ => Ok(Drawn { picture: self.shown(panel)?, numbers: self.numbers(panel)? }),
        }
    }

    /// The picture of another panel of the figure, numbered from 0.
    fn other(&mut self, index: usize) -> Result<Canvas, Error> {
        match self.figure.panels.get(index) {
            Some(panel) => self.shown(panel),
            None => Ok(Canvas::new([1, 1], CARD)),
        }
    }

    fn shown(&mut self, panel: &Panel) -> Result<Canvas, Error> {
        match panel.stage {
            Some(PanelStage::Truth) => self.true_picture(panel),
            Some(PanelStage::Wrong) => self.mark_wrong(panel),
            Some(PanelStage::Fine) => self.fine_picture(panel, self.scale),
            Some(PanelStage::Faces) => self.mark_faces(panel),
            Some(PanelStage::Kernel(kernel)) => {
                let picture = self.picture(panel, self.scale)?;
                self.over(&picture, |painter| diagram::draw_kernel(painter, kernel))
            }
            Some(PanelStage::Marked(cut)) => self.mark_cut(panel, cut),
            Some(PanelStage::Cut(cut)) => {
                let lines = cut::lines(self.figure, panel, cut, &mut |scene, view| self.depths(scene, view))?;
                self.on_card(panel, |painter| cut::graph(cut, &lines).draw(painter))
            }
            Some(PanelStage::Sweep(sweep)) => {
                let shares = sweep::measure(self.figure, panel, sweep, |scene| self.wrong_in(panel, scene))?;
                self.on_card(panel, |painter| sweep::graph(sweep, &shares).draw(painter))
            }
            Some(PanelStage::Geometry) => self.on_card(panel, diagram::draw_geometry),
            Some(PanelStage::Skin(map)) => Ok(skins::picture_of(&self.figure.scene_of(panel)?, map)),
            Some(PanelStage::Profile(lines)) => {
                let pictures: Result<Vec<Canvas>, Error> = lines.iter().map(|line| self.other(line.panel)).collect();
                let pictures = pictures?;
                self.on_card(panel, |painter| profile::graph(lines, &pictures).draw(painter))
            }
            _ => self.picture(panel, self.scale),
        }
    }

    /// Measurements of a panel at scale 1, in words.
    fn numbers(&mut self, panel: &Panel) -> Result<Option<String>, Error> {
        Ok(match panel.measured {
            Measured::Nothing => None,
            Measured::Wrong => Some(self.wrong(panel)?.in_words()),
            Measured::AgainstFine => {
                let (own, fine) = (self.picture(panel, 1)?, self.fine_picture(panel, 1)?);
                Some(format!("{:.1} of 255 codes off (root mean square)", measure::difference(&own, &fine)))
            }
            Measured::Brightness => {
                let (own, fine) = (self.picture(panel, 1)?, self.fine_picture(panel, 1)?);
                let [own, fine] = measure::brightness(&own, &fine);
                let off = 100.0 * (own / fine.max(f64::MIN_POSITIVE) - 1.0);
                Some(format!("mean brightness {own:.1}, {off:+.1} % from many samples a pixel").replace('-', "−"))
            }
            Measured::From(other) => {
                let (own, other_picture) = (self.shown(panel)?, self.other(other)?);
                Some(measure::Apart::of(&own, &other_picture).in_words(&letter_of(other)))
            }
            Measured::FollowsUp => {
                let scene = self.figure.scene_of(panel)?;
                let found = self.follows_up(&scene)?;
                Some(format!("correlation of brightness with the normal upwards: {found:.2}").replace('-', "−"))
            }
        })
    }

    /// Shares of the wrong pixels at scale 1.
    pub fn wrong(&mut self, panel: &Panel) -> Result<Share, Error> {
        let scene = self.figure.scene_of(panel)?;
        self.wrong_in(panel, &scene)
    }

    /// The same of a scene that differs from the panel's by its light's shadow alone.
    fn wrong_in(&mut self, panel: &Panel, scene: &Scene) -> Result<Share, Error> {
        let shade = frame::draw_shade(scene, 0, self.renderer)?;
        let name = self.figure.name;
        Share::of(self.truth(panel, 1)?, &shade).map_err(|reason| Error::Measure { figure: name, reason })
    }

    /// The ray tracer's answers for a panel's pixels.
    fn truth(&mut self, panel: &Panel, scale: u32) -> Result<&Truth, Error> {
        let seen = panel.set.iter().copied().filter(|set| !set.starts_with("light.shadow"));
        let key = (scale, seen.collect::<Vec<_>>());
        match self.truths.entry(key) {
            std::collections::hash_map::Entry::Occupied(found) => Ok(found.into_mut()),
            std::collections::hash_map::Entry::Vacant(place) => {
                let scene = self.figure.scene_at(panel, scale)?;
                let truth = truth::trace(&scene, 0, &truth::Options::default())
                    .map_err(|reason| Error::Truth { figure: self.figure.name, reason })?;
                Ok(place.insert(truth))
            }
        }
    }

    /// The picture, a view, or the image of the light.
    fn picture(&mut self, panel: &Panel, scale: u32) -> Result<Canvas, Error> {
        let Keyed { canvas, legend } = draw_scene(&self.figure.scene_at(panel, scale)?, panel, self.renderer)?;
        match legend[..] {
            [] => Ok(canvas),
            _ => self.over(&canvas, |painter| diagram::draw_legend(painter, &canvas, &legend)),
        }
    }

    /// The picture with ray-traced shadows: each pixel of the unshadowed picture where it is lit, else of the unlit one.
    fn true_picture(&mut self, panel: &Panel) -> Result<Canvas, Error> {
        let plain = Panel { stage: None, view: None, ..*panel };
        let mut scene = self.figure.scene_with(&plain, &["light.shadow.technique=none".to_owned()])?;
        scene.image.size = scene.image.size.map(|side| side * self.scale);
        let lit = draw_scene(&scene, &plain, self.renderer)?.canvas;
        for light in scene.lights.iter_mut().take(1) {
            (light.diffuse, light.specular) = ([0.0; 3], [0.0; 3]);
        }
        let dark = draw_scene(&scene, &plain, self.renderer)?.canvas;
        let truth = self.truth(panel, self.scale)?;
        Ok(measure::compose(truth, &lit, &dark))
    }

    fn mark_wrong(&mut self, panel: &Panel) -> Result<Canvas, Error> {
        let scene = self.figure.scene_at(panel, self.scale)?;
        let picture = draw_scene(&scene, panel, self.renderer)?.canvas;
        let shade = frame::draw_shade(&scene, 0, self.renderer)?;
        Ok(measure::mark(self.truth(panel, self.scale)?, &shade, &picture))
    }

    /// The picture with the image looked up linearly, by [`SAMPLES`] times [`SAMPLES`] samples a pixel.
    fn fine_picture(&mut self, panel: &Panel, scale: u32) -> Result<Canvas, Error> {
        // At the largest scale fewer, or no driver could hold the picture.
        let samples = (2 * SAMPLES / (scale + 1)).max(2);
        // What is wrong on purpose is compared with what is right.
        let panel = &Panel { change: None, stage: None, ..*panel };
        let scene = self.figure.scene_of(panel)?;
        let has_image = scene.lights.iter().filter_map(|light| light.spot()).any(|spot| spot.image.is_some());
        let linear = has_image.then(|| "light.filter=linear".to_owned());
        let [width, height] = scene.image.size.map(|side| side * scale * samples);
        let size = format!("image.size=[{width}, {height}]");
        let more: Vec<String> = linear.into_iter().chain([size]).collect();
        let scene = self.figure.scene_with(panel, &more)?;
        Ok(measure::average(&draw_scene(&scene, panel, self.renderer)?.canvas, samples))
    }

    /// Correlation of the decal's brightness with the component upwards of the normals, where there are bumps.
    fn follows_up(&mut self, scene: &Scene) -> Result<f64, Error> {
        let views = [View::Decal, View::Normal, View::TangentLight].map(|view| ViewRequest { view, light: 0 }).to_vec();
        let plan = self.renderer.plan(scene, &Request { views, ..Request::default() })?;
        self.renderer.draw(&plan)?;
        let frame = self.renderer.read(&plan)?;
        let pictures: Vec<Canvas> = frame.views.iter().map(|pixels| output::to_canvas(pixels, None)).collect();
        let [decal, normal, bumps] = &pictures[..] else { return Ok(0.0) };
        let [decal, normal, bumps] = [decal, normal, bumps].map(|picture| picture.bytes().as_chunks::<3>().0);
        let pixels = decal.iter().zip(normal).zip(bumps).filter(|(_, bumps)| **bumps != [0; 3]);
        let pairs: Vec<[f64; 2]> = pixels
            .map(|((decal, normal), _)| [decal.iter().map(|code| f64::from(*code)).sum(), f64::from(normal[1])])
            .collect();
        Ok(measure::correlation(&pairs))
    }

    fn mark_faces(&mut self, panel: &Panel) -> Result<Canvas, Error> {
        let picture = self.picture(panel, self.scale)?;
        let light = self.figure.scene_of(panel)?.lights.first().and_then(crate::scene::Light::position);
        Ok(measure::mark_faces(self.truth(panel, self.scale)?, light.unwrap_or_default(), &picture))
    }

    fn mark_cut(&mut self, panel: &Panel, cut: &cut::MapCut) -> Result<Canvas, Error> {
        let picture = self.picture(panel, self.scale)?;
        let trace = cut::trace(self.figure, panel, cut, &mut |scene, view| self.depths(scene, view))?;
        self.over(&picture, |painter| cut::draw_trace(painter, &trace))
    }

    /// Depths of the panel's map, or of its picture, rows from the top.
    fn depths(&mut self, scene: &Scene, view: View) -> Result<([u32; 2], Vec<f32>), Error> {
        let views = vec![ViewRequest { view, light: 0 }];
        let plan = self.renderer.plan(scene, &Request { views, ..Request::default() })?;
        self.renderer.draw(&plan)?;
        match self.renderer.read(&plan)?.views.pop() {
            Some(Pixels::Depth { size, data }) => Ok((size, data)),
            _ => Ok(([0; 2], Vec::new())),
        }
    }

    fn over(&self, picture: &Canvas, draw: impl FnOnce(&mut Painter<'_>)) -> Result<Canvas, Error> {
        self.painted(Painter::over(self.letters, picture, self.scale), draw)
    }

    fn on_card(&self, panel: &Panel, draw: impl FnOnce(&mut Painter<'_>)) -> Result<Canvas, Error> {
        let size = [width_of(panel.span), PANEL[1]];
        self.painted(Painter::new(self.letters, size, self.scale, CARD), draw)
    }

    fn painted(&self, painter: Option<Painter<'_>>, draw: impl FnOnce(&mut Painter<'_>)) -> Result<Canvas, Error> {
        let mut painter = painter.ok_or(Error::TooLarge { figure: self.figure.name })?;
        draw(&mut painter);
        Ok(painter.into_canvas())
    }
}

/// Draws what a panel shows of a scene, without marks.
fn draw_scene(scene: &Scene, panel: &Panel, renderer: &mut Renderer) -> Result<Keyed, Error> {
    let shade = panel.counts.map(|_| View::Shade);
    let views = panel.view.into_iter().chain(shade).map(|view| ViewRequest { view, light: 0 }).collect();
    let mut plan = renderer.plan(scene, &Request { views, ..Request::default() })?;
    match panel.stage {
        Some(PanelStage::After(pass)) => plan = plan.after_pass(pass).map_err(frame::Error::from)?,
        Some(PanelStage::Image) => return Ok(output::to_keyed(&image_of(scene), None, None)),
        _ => {}
    }
    renderer.draw(&plan)?;
    let mut frame = renderer.read(&plan)?;
    if plan.ends_in_alpha() {
        frame.picture = frame.picture.alpha_as_gray();
    }
    let shown = frame.views.first().unwrap_or(&frame.picture);
    match (shown, frame.views.get(1)) {
        (Pixels::RgbaF32 { size, data }, Some(Pixels::RgbaF32 { data: shade, .. })) => {
            let lit = Pixels::RgbaF32 { size: *size, data: where_lit(data, shade) };
            Ok(output::to_keyed(&lit, panel.view, panel.counts))
        }
        _ => Ok(output::to_keyed(shown, panel.view, panel.counts)),
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
