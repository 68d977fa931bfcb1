//! Colour of each pixel in f64, with bounds: material, decal, lighting, projected light, lenses, dusty air and exact
//! visibility. The formulas are the scene's own [LEC, "Advice for Shadowed Illumination Model"; Segal 1992, 3.1 to 3.3],
//! written here once more: no matrix, no map and no table of the renderer is used.
//!
//! Each factor of a colour is a value with a least and a greatest bound. Where a factor may jump within the error of a
//! sample (a shadow's edge, a cone's edge, a texel's edge), its bounds are both sides; where it is smooth, they are the
//! value. Pictures are compared with the value where the bounds are near it, and else with the bounds.
//!
//! The normals of bumps are found again from the heights in the file (`bumps/`).
//!
//! Light through a lens is the mean over its points; dusty air is marched at the planes of its slices.

mod air;
mod bounds;
mod bumps;
mod known;
mod lamp;
mod lantern;
mod photo;
mod projected;
mod sample;
mod surface;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::light::Lamp;
use super::primary::SeenPoint;
use super::world::World;
use super::{Error, Options, Tracer, lens_points};
use crate::scene::{Background, Law, Light, PicturePasses, Scene};
use air::DustyBeam;
pub use bounds::Bounds;
pub use known::{has_combined_bumps, why_no_colors};
use lamp::{Source, Wash};
use photo::Photograph;
use surface::{Shaded, SurfaceTable};

/// The picture in f64. Row 0 is the top.
#[derive(Clone, Debug)]
pub struct ColorTruth {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width * height` colours, row by row from the top.
    pub pixels: Vec<ColorPixel>,
    /// Codes of 1/255 that a picture of 8 bits may be off because it is rounded between its passes, beside its last rounding;
    /// 0 of a float picture.
    pub between_passes_codes: f64,
}

/// One pixel's colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPixel {
    /// RGB: bounds and value; in [0, 1] unless it is of a float picture.
    pub rgb: [Bounds; 3],
    /// False where something else may be seen: the bounds are [0, 1] then.
    pub is_known: bool,
}

/// Settings of a picture that decide its colours beside the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorRequest {
    /// True if nothing clamps colours; `false`: 8 bits, which clamp to 1 after each pass.
    pub float_picture: bool,
    /// Number of lens points of each light with a lens, in place of its own: many come near to the whole lens.
    pub lens_points: Option<u32>,
    /// Number of slices of each beam in dust, in place of its own: many come near to even air.
    pub slices: Option<u32>,
}

impl ColorPixel {
    const UNKNOWN: Self = Self { rgb: [Bounds { least: 0.0, value: 0.5, most: 1.0, jumps: true }; 3], is_known: false };

    /// Tests whether a picture must have the value itself: nothing jumps, and the bounds are at most `codes` of 1/255 apart.
    pub fn is_smooth(&self, codes: f64) -> bool {
        self.rgb.iter().all(|channel| !channel.jumps && 255.0 * (channel.most - channel.least) <= codes)
    }

    /// Distance of a picture's codes from the value, in codes, the greatest over the channels.
    pub fn error_codes(&self, codes: [f64; 3]) -> f64 {
        (0..3).map(|k| (codes[k] - 255.0 * self.rgb[k].value).abs()).fold(0.0, f64::max)
    }

    /// Distance of a picture's codes from the bounds, in codes, the greatest over the channels; 0 within them.
    pub fn excess_codes(&self, codes: [f64; 3]) -> f64 {
        let outside = |k: usize| {
            let Bounds { least, most, .. } = self.rgb[k];
            (255.0 * least - codes[k]).max(codes[k] - 255.0 * most).max(0.0)
        };
        (0..3).map(outside).fold(0.0, f64::max)
    }
}

/// Finds the colour of every pixel of the scene's image in 8 bits. `shadows`: for each light the fraction of its diffuse
/// light that a full shadow leaves, in [0, 1]; `None`: nothing shadows it.
///
/// # Errors
///
/// As [`super::trace`]; a scene whose colours cannot be known (see [`why_no_colors`]). There is no limit on ambiguous
/// pixels: each has its bounds.
pub fn color(scene: &Scene, shadows: &[Option<f64>], options: &Options) -> Result<ColorTruth, Error> {
    color_as(scene, shadows, &ColorRequest::default(), options)
}

/// The same, of a picture as requested.
///
/// # Errors
///
/// As [`color`].
pub fn color_as(
    scene: &Scene,
    shadows: &[Option<f64>],
    request: &ColorRequest,
    options: &Options,
) -> Result<ColorTruth, Error> {
    if let Some(why) = why_no_colors(scene) {
        return Err(Error::Colors { why });
    }
    if request.float_picture && known::has_combined_bumps(scene) {
        let why = String::from("register combiners clamp each pass, so that a picture in floats is none of sums alone");
        return Err(Error::Colors { why });
    }
    let painter = Painter::new(scene, shadows, request, options)?;
    let [width, height] = scene.image.size;
    let at = |index: u32| painter.pixel(index % width, index / width);
    let pixels = (0..width * height).into_par_iter().map(at).collect();
    let between_passes_codes = if request.float_picture { 0.0 } else { known::between_passes_codes(scene) };
    Ok(ColorTruth { width, height, pixels, between_passes_codes })
}

/// Everything that a colour needs.
struct Painter<'a> {
    scene: &'a Scene,
    lights: Vec<Shining<'a>>,
    /// Beams in dusty air, in the order of their lights.
    airs: Vec<DustyBeam<'a>>,
    photos: Vec<Photograph<'a>>,
    /// The tracer that grants the largest error looks for surfaces.
    looking: Tracer<'a>,
    surfaces: SurfaceTable<'a>,
    clamps: bool,
    /// True if bumps are lit in three passes.
    three_passes: bool,
}

/// A light of the scene.
struct Shining<'a> {
    /// The light, or each point of its lens, with a tracer if it has a shadow.
    points: Vec<(Source<'a>, Option<Tracer<'a>>)>,
    /// Fraction of diffuse light that a full shadow leaves.
    left: f64,
    has_lens: bool,
}

/// Light on a surface: by each of its colours, material included.
struct Sum {
    ambient: [Bounds; 3],
    diffuse: [Bounds; 3],
    specular: [Bounds; 3],
}

impl<'a> Painter<'a> {
    fn new(
        scene: &'a Scene,
        shadows: &[Option<f64>],
        request: &ColorRequest,
        options: &Options,
    ) -> Result<Self, Error> {
        let world = Arc::new(World::new(scene)?);
        let (center, radius) = world.ball();
        let tracer = |light: &Light, way: DVec3| {
            Tracer::of_lamp(&world, scene, Lamp::new(light, center, radius).moved(way), options)
        };
        let mut looking = Tracer::of_lamp(&world, scene, Lamp::above(center, radius), options)?;
        let (mut lights, mut airs) = (Vec::new(), Vec::new());
        for (index, light) in scene.lights.iter().enumerate() {
            let own = tracer(light, DVec3::ZERO)?;
            if own.largest_error > looking.largest_error {
                looking = tracer(light, DVec3::ZERO)?;
            }
            let shadow = shadows.get(index).copied().flatten().filter(|_| light.law == Law::Lit);
            let lens = light.spot().and_then(|spot| spot.lens());
            let places = match lens {
                None => vec![DVec2::ZERO],
                Some(focus) => lens_points(request.lens_points.unwrap_or(focus.samples)),
            };
            let point = |place: DVec2| {
                let source = Source::through(light, place);
                let traced = shadow.map(|_| tracer(light, source.way())).transpose()?;
                Ok((source, traced))
            };
            let points = places.into_iter().map(point).collect::<Result<Vec<_>, Error>>()?;
            airs.extend(DustyBeam::new(light, shadow.is_some(), request.slices, own));
            lights.push(Shining { points, left: shadow.unwrap_or(0.0), has_lens: lens.is_some() });
        }
        let (surfaces, clamps) = (SurfaceTable::new(scene), !request.float_picture);
        let photos = photo::of_scene(scene, options)?;
        let three_passes = known::is_in_three_passes(scene);
        Ok(Self { scene, lights, airs, photos, looking, surfaces, clamps, three_passes })
    }

    fn pixel(&self, x: u32, y: u32) -> ColorPixel {
        let (seen, doubt) = self.looking.look(x, y);
        let behind = match (&seen, doubt) {
            (None, None) => self.background(),
            // A neighbouring triangle may have another normal, and so another colour.
            (Some(seen), None) if !seen.is_at_edge => match self.surfaces.at(seen, self.scene, self.looking.subpixel) {
                Some(surface) => self.photographed(seen, [x, y], &surface),
                None => return ColorPixel::UNKNOWN,
            },
            _ => return ColorPixel::UNKNOWN,
        };
        let seen = seen.as_ref();
        let through = |behind: [Bounds; 3], air: &DustyBeam<'_>| {
            let haze = air.before(x, y, seen);
            [0, 1, 2].map(|k: usize| self.stored(behind[k].times(haze.passes).plus(haze.color[k])))
        };
        ColorPixel { rgb: self.airs.iter().fold(behind, through), is_known: true }
    }

    /// A colour as the picture stores it between two passes.
    fn stored(&self, color: Bounds) -> Bounds {
        if self.clamps { color.clamped() } else { color }
    }

    fn background(&self) -> [Bounds; 3] {
        let shading = &self.scene.shading;
        let is_ambient = shading.passes == PicturePasses::Slide && shading.background == Background::Ambient;
        let color = if is_ambient { shading.ambient } else { self.scene.image.background };
        color.map(|channel| self.stored(Bounds::exactly(f64::from(channel))))
    }

    /// A surface's colour: that of its photograph, where that has seen it, and else its own.
    fn photographed(&self, seen: &SeenPoint<'_>, pixel: [u32; 2], surface: &Shaded<'_>) -> [Bounds; 3] {
        let own = self.surface(seen, surface);
        let photo = self.scene.objects[seen.triangle.object as usize].photo.as_ref();
        let photo = photo.and_then(|photo| self.photos.iter().find(|known| known.is(photo)));
        photo.map_or(own, |photo| photo.on(seen, pixel, surface, own))
    }

    fn surface(&self, seen: &SeenPoint<'_>, surface: &Shaded<'_>) -> [Bounds; 3] {
        let [plain, lensed] = [false, true].map(|has_lens| {
            let lights = self.lights.iter().filter(move |light| light.has_lens == has_lens);
            self.sum(lights, seen, surface)
        });
        let material = surface.material;
        let scene_ambient = self.scene.shading.ambient.map(f64::from);
        [0, 1, 2].map(|k: usize| {
            let first = match self.scene.shading.passes {
                PicturePasses::Slide => {
                    let light = plain.diffuse[k].plus(Bounds::exactly(scene_ambient[k]));
                    let own = surface.decal[k].scaled(f64::from(material.diffuse[k]));
                    self.stored(light).times(own)
                }
                PicturePasses::One | PicturePasses::Shadow => {
                    let ambient = Bounds::exactly(scene_ambient[k] * f64::from(material.ambient[k]));
                    let light = ambient.plus(plain.ambient[k]).plus(plain.diffuse[k]);
                    // Three passes store the light before the decal is multiplied in.
                    let light = if self.three_passes { self.stored(light) } else { light };
                    light.times(surface.decal[k]).plus(plain.specular[k].times(surface.gloss))
                }
            };
            let through_lenses = lensed.ambient[k].plus(lensed.diffuse[k]).times(surface.decal[k]);
            self.stored(first.plus(through_lenses).plus(lensed.specular[k].times(surface.gloss)))
        })
    }

    /// Sum of lights. In the passes of the slide projector, of lights without a lens: the light alone, without material.
    fn sum<'s>(
        &'s self,
        lights: impl Iterator<Item = &'s Shining<'a>>,
        seen: &SeenPoint<'_>,
        surface: &Shaded<'_>,
    ) -> Sum
    where
        'a: 's,
    {
        let none = [Bounds::exactly(0.0); 3];
        let mut sum = Sum { ambient: none, diffuse: none, specular: none };
        let is_combined = surface.bumps.as_ref().is_some_and(bumps::BumpedPoint::is_combined);
        for light in lights {
            let share = 1.0 / light.points.len() as f64;
            let is_slide = self.scene.shading.passes == PicturePasses::Slide && !light.has_lens;
            for (source, tracer) in &light.points {
                let wash = if is_slide { source.slide(surface) } else { self.wash(source, surface) };
                let reach = source.reach(&surface.at);
                let is_dark = reach == Bounds::exactly(0.0);
                let shade = match tracer {
                    Some(tracer) if !is_dark => shade(tracer, seen),
                    _ => Bounds::exactly(1.0),
                };
                let diffuse_shade = match tracer {
                    Some(_) => shade.scaled(1.0 - light.left).plus(Bounds::exactly(light.left)),
                    None => shade,
                };
                let projected = if is_dark { none } else { source.projected(&surface.at) };
                for (k, factor) in projected.iter().enumerate() {
                    let beam = reach.times(*factor).scaled(share);
                    // Colours of register combiners are in [0, 1].
                    let input = |color: Bounds| if is_combined { color.clamped() } else { color };
                    let diffuse = input(diffuse_shade.times(beam).scaled(wash.diffuse[k])).times(wash.cosine);
                    let specular = input(shade.times(beam).scaled(wash.specular[k])).times(wash.shine);
                    sum.ambient[k] = sum.ambient[k].plus(Bounds::exactly(share * wash.ambient[k]));
                    sum.diffuse[k] = sum.diffuse[k].plus(diffuse);
                    sum.specular[k] = sum.specular[k].plus(specular);
                }
            }
        }
        sum
    }

    /// Light on the surface before shadow and beam, per fragment or per vertex.
    fn wash(&self, source: &Source<'_>, surface: &Shaded<'_>) -> Wash {
        let eye = self.scene.camera.eye;
        if !self.scene.shading.per_vertex {
            let to_viewer = (eye - surface.at.position).normalize_or_zero();
            return source.wash(surface, surface.at.position, surface.normal, to_viewer);
        }
        // GL_LIGHT_MODEL_LOCAL_VIEWER is off: the viewer is infinitely far away, against the view's axis.
        let to_viewer = (eye - self.scene.camera.target).normalize_or_zero();
        let ambient = |k: usize| {
            let scene = f64::from(self.scene.shading.ambient[k]) * f64::from(surface.material.ambient[k]);
            (1.0 - scene).max(0.0)
        };
        let corners = [0, 1, 2].map(|corner| {
            let (position, normal) = (surface.corners[corner], surface.corner_normals[corner]);
            source.wash(surface, position, normal, to_viewer).clamped([0, 1, 2].map(ambient))
        });
        Wash::between(&corners, surface.weights)
    }
}

/// 1 where the light reaches the point, 0 in its shadow.
fn shade(tracer: &Tracer<'_>, seen: &SeenPoint<'_>) -> Bounds {
    let (lit, doubt) = tracer.light_reaches(seen, true);
    let value = f64::from(u8::from(lit));
    // Beyond the planes of a map a light has no shadow that is agreed upon.
    let in_planes = tracer.lamp.is_between_planes(seen.position);
    if doubt.is_some() || !in_planes { Bounds::anything(value) } else { Bounds::exactly(value) }
}

/// A unit vector, or zero.
fn unit(vector: DVec3) -> DVec3 {
    vector.normalize_or_zero()
}
