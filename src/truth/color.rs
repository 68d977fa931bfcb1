//! Colour of each pixel in f64, with bounds: material, decal, lighting, projected light and exact visibility. The
//! formulas are the scene's own [LEC, "Advice for Shadowed Illumination Model"; Segal 1992, 3.2], written here once more: no
//! matrix, no map and no table of the renderer is used.
//!
//! Each factor of a colour is a value with a least and a greatest bound. Where a factor may jump within the error of a
//! sample (a shadow's edge, a cone's edge, a texel's edge), its bounds are both sides; where it is smooth, they are the
//! value. Pictures are compared with the value where the bounds are near it, and else with the bounds.

mod bounds;
mod lamp;
mod photo;
mod projected;
mod surface;

use glam::DVec3;
use rayon::prelude::*;

use super::{Error, Options, Tracer};
use crate::scene::Scene;
pub use bounds::Bounds;
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
}

/// One pixel's colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPixel {
    /// RGB, each in [0, 1]: bounds and value.
    pub rgb: [Bounds; 3],
    /// False where something else may be seen, or where a surface waves: the bounds are [0, 1] then.
    pub is_known: bool,
}

impl ColorPixel {
    const UNKNOWN: Self = Self { rgb: [Bounds { least: 0.0, value: 0.5, most: 1.0, jumps: true }; 3], is_known: false };

    fn exactly(color: [f32; 3]) -> Self {
        Self { rgb: color.map(|channel| Bounds::exactly(f64::from(channel))), is_known: true }
    }

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

/// Finds the colour of every pixel of the scene's image. `shadows`: for each light the fraction of its diffuse light that
/// a full shadow leaves, in [0, 1]; `None`: nothing shadows it.
///
/// # Errors
///
/// As [`super::trace`]. There is no limit on ambiguous pixels: each has its bounds.
pub fn color(scene: &Scene, shadows: &[Option<f64>], options: &Options) -> Result<ColorTruth, Error> {
    let count = scene.lights.len().max(1);
    let tracers = (0..count).map(|light| Tracer::new(scene, light, options)).collect::<Result<Vec<_>, _>>()?;
    let sources: Vec<Source<'_>> = scene.lights.iter().map(Source::new).collect();
    let photos = photo::of_scene(scene, options)?;
    let painter = Painter { scene, tracers, sources, photos, shadows, surfaces: SurfaceTable::new(scene) };
    let [width, height] = scene.image.size;
    let at = |index: u32| painter.pixel(index % width, index / width);
    let pixels = (0..width * height).into_par_iter().map(at).collect();
    Ok(ColorTruth { width, height, pixels })
}

/// Everything that a colour needs.
struct Painter<'a> {
    scene: &'a Scene,
    /// One for each light.
    tracers: Vec<Tracer<'a>>,
    sources: Vec<Source<'a>>,
    photos: Vec<Photograph<'a>>,
    shadows: &'a [Option<f64>],
    surfaces: SurfaceTable,
}

impl Painter<'_> {
    fn pixel(&self, x: u32, y: u32) -> ColorPixel {
        let (seen, doubt) = self.tracers[0].look(x, y);
        let seen = match (seen, doubt) {
            (None, None) => return ColorPixel::exactly(self.scene.image.background),
            // A neighbouring triangle may have another normal, and so another colour.
            (Some(seen), None) if !seen.is_at_edge => seen,
            _ => return ColorPixel::UNKNOWN,
        };
        let Some(surface) = self.surfaces.at(&seen, self.scene, self.tracers[0].subpixel) else {
            return ColorPixel::UNKNOWN;
        };
        let material = surface.material;
        let ambient = |k: usize| f64::from(self.scene.shading.ambient[k]) * f64::from(material.ambient[k]);
        let mut diffuse = [0, 1, 2].map(|k| Bounds::exactly(ambient(k)));
        let mut specular = [Bounds::exactly(0.0); 3];
        for ((tracer, source), shadow) in self.tracers.iter().zip(&self.sources).zip(self.shadows) {
            let wash = self.wash(source, &surface);
            let reach = source.reach(&surface);
            let (shade, left) = match shadow {
                None => (Bounds::exactly(1.0), 0.0),
                Some(left) => (shade(tracer, &seen), *left),
            };
            let diffuse_shade = shade.scaled(1.0 - left).plus(Bounds::exactly(left));
            let projected = source.projected(&surface);
            let beams = projected.map(|factor| reach.times(factor));
            diffuse = [0, 1, 2].map(|k: usize| {
                let added = diffuse_shade.times(beams[k]).times(Bounds::exactly(wash.diffuse[k]));
                diffuse[k].plus(Bounds::exactly(wash.ambient[k])).plus(added)
            });
            specular = [0, 1, 2].map(|k: usize| {
                let added = shade.times(beams[k]).times(Bounds::exactly(wash.specular[k]));
                specular[k].plus(added)
            });
        }
        let rgb = [0, 1, 2].map(|k| diffuse[k].times(surface.decal[k]).plus(specular[k]).clamped());
        let of = |photo: &std::sync::Arc<crate::scene::Photo>| self.photos.iter().find(|known| known.is(photo));
        let photo = self.scene.objects[seen.triangle.object as usize].photo.as_ref().and_then(of);
        let rgb = photo.map_or(rgb, |photo| photo.on(&seen, [x, y], &surface, rgb));
        ColorPixel { rgb, is_known: true }
    }

    /// Light on the surface before shadow and beam, per fragment or per vertex.
    fn wash(&self, source: &Source<'_>, surface: &Shaded<'_>) -> Wash {
        let eye = self.scene.camera.eye;
        if !self.scene.shading.per_vertex {
            let to_viewer = (eye - surface.position).normalize_or_zero();
            return source.wash(surface, surface.position, surface.normal, to_viewer);
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
fn shade(tracer: &Tracer<'_>, seen: &super::primary::SeenPoint<'_>) -> Bounds {
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
