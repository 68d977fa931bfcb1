//! Dusty air: a spotlight's beam, drawn over the picture in slices across the view, from back to front, each with the
//! light's image and shadow [LEC, "Combining Shadows with Atmospherics"].
//!
//! A slice is what a plane across the view axis cuts out of the beam: the light's pyramid between its near and far planes,
//! within the camera's. Each slice stands for a slab of air as thick as the spacing Δz. With `thickness_along_ray` the slab
//! counts by the ray's length in it, Δz / cos φ, where φ is the angle to the view axis. The slices of one light are blended,
//! over each other or added, into a float image, because 8 bits would round each share; that image is then blended over the
//! picture.

use std::sync::Arc;

use glam::{DVec3, DVec4, Vec4};

use super::Error;
use super::passes::{Buffers, Onto, Passes};
use super::projection::CameraProjection;
use crate::geometry::{Material, Mesh, Part};
use crate::lights::{Drawable, Ending, LightTerm};
use crate::math::{Aabb, frustum};
use crate::pass::{Batch, Blend, Clear, Compare, Define, DrawPass, DrawState, MeshRef, Redraw, Uniform, glsl};
use crate::scene::{Dust, DustBlend, Scene, Spot};

/// Optical depth below which the slices' shader takes the opacity by a series.
const SERIES_BOUND: f64 = 0.02;

/// The slices of a beam, as polygons in eye space.
struct Slices {
    /// Farthest first.
    polygons: Vec<Vec<DVec3>>,
    /// Distance of two slices along the view axis.
    spacing: f64,
}

impl Passes<'_> {
    /// Draws the dust of each light of `terms` over the finished picture.
    ///
    /// # Errors
    ///
    /// A light whose shadow can only be found at surfaces; one whose transform has no inverse.
    pub fn dust(&mut self, buffers: Buffers, lens: &CameraProjection, terms: &[&LightTerm]) -> Result<(), Error> {
        let mut layer = None;
        for term in terms {
            let light = &term.source;
            let (Some(dust), Some(spot)) = (light.dust, light.spot()) else { continue };
            if let Some(why) = why_not_in_air(term) {
                return Err(Error::DustUnshadowed { light: term.index, why });
            }
            let what = format!("dust of light {}", term.index);
            if dust.density == 0.0 {
                self.notes.left_out(what, "its density is 0");
                continue;
            }
            let slices = slices(self.scene, spot, dust.slices);
            if slices.polygons.is_empty() {
                self.notes.left_out(what, "the camera does not see its beam");
                continue;
            }
            let empty = dust.slices as usize - slices.polygons.len();
            if empty > 0 {
                self.notes.left_out(format!("{empty} of {} slices of the {what}", dust.slices), "the beam misses them");
            }
            let layer = *layer.get_or_insert_with(|| self.layer("dust"));
            self.dust_of(term, &dust, &slices, Buffers { color: layer, ..buffers }, lens)?;
            let label = format!("light {}: dust over the picture", term.index);
            let meaning = "the sum of a beam's slices";
            self.put_over(&label, layer, buffers, Blend::OverPremultiplied, meaning);
        }
        Ok(())
    }

    /// Blends one light's slices into the dust image, depth-tested against the surfaces.
    fn dust_of(
        &mut self,
        term: &LightTerm,
        dust: &Dust,
        slices: &Slices,
        layer: Buffers,
        lens: &CameraProjection,
    ) -> Result<(), Error> {
        let label = format!("light {}: dust in {} slices", term.index, slices.polygons.len());
        let scene = self.scene;
        let term = LightTerm { counting: None, ..(*term).clone() };
        let place = dust.jitter.then_some(glsl!("dust/jitter.frag"));
        let ending = Ending::Slice { chunk: glsl!("dust/slice.frag"), place };
        let item = drawable(slices, term.index, &lens.camera.eye_from_world.inverse());
        let terms = std::slice::from_ref(&term);
        let batches = (self.surface)(scene, &[item], &lens.camera, terms, &[], &ending, self.derived, self.list);
        let mut batches = batches.ok_or(Error::Singular { light: term.index })?;
        for batch in &mut batches {
            set_slices(scene, &term, dust, slices.spacing, lens, batch)?;
        }
        let state = DrawState {
            depth_test: Some(Compare::LessEqual),
            depth_write: false,
            blend: Some(Blend::OverPremultiplied),
            ..lens.of_surfaces(DrawState::OPAQUE)
        };
        let clear = Clear { color: Some([0.0; 4]), ..Clear::default() };
        let onto = Onto { label: &label, target: layer.target(), viewport: scene.image.size, lens, clear, state };
        let Onto { target, viewport, clear, state, .. } = onto;
        self.push(&label, Redraw::Always, DrawPass { target, viewport, clear, state, batches });
        Ok(())
    }
}

/// Reason why the light's shade is not found between surfaces, if there is one.
fn why_not_in_air(term: &LightTerm) -> Option<&'static str> {
    if term.counting.as_ref().is_some_and(|counting| !counting.tags()) {
        return Some("shadow volumes are counted at surfaces only");
    }
    let is_middle = term.map_info.is_some_and(|info| info.middle);
    is_middle.then_some("a midpoint map has shadows begin halfway between a caster and what lies behind it")
}

/// Polygons of the beam in `count` planes of equal spacing across the view axis, between its nearest and its farthest point.
/// Planes that miss the beam are dropped.
fn slices(scene: &Scene, spot: &Spot, count: u32) -> Slices {
    let eye_from_world = scene.camera.view_from_world();
    let world_from_eye = eye_from_world.inverse();
    let camera_clip = scene.camera.clip_from_view(scene.aspect());
    let light_clip = spot.frustum.clip_from_world() * world_from_eye;
    let (camera_planes, light_planes) = (frustum::planes(&camera_clip), frustum::planes(&light_clip));
    let camera_corners = frustum::corners(&camera_clip.inverse());
    let light_corners = frustum::corners(&(light_clip.inverse()));
    let faces = |corners: &[DVec3; 8], planes: &[DVec4; 6]| {
        frustum::faces(corners).into_iter().flat_map(|face| clipped(&face, planes)).collect::<Vec<DVec3>>()
    };
    let mut points = faces(&camera_corners, &light_planes);
    points.extend(faces(&light_corners, &camera_planes));
    let depths = points.iter().map(|point| -point.z);
    let near = depths.clone().fold(f64::INFINITY, f64::min);
    let far = depths.fold(f64::NEG_INFINITY, f64::max);
    // No points: the camera does not see the beam.
    if near >= far {
        return Slices { polygons: Vec::new(), spacing: 0.0 };
    }
    let spacing = (far - near) / f64::from(count);
    let slice = |number: u32| {
        let depth = far - (f64::from(number) + 0.5) * spacing;
        let half_height = depth * (0.5 * scene.camera.fov_y_radians).tan();
        let half_width = half_height * scene.aspect();
        // The camera's own sides clip this rectangle when it is drawn; a little wider, so that no pixel at the rim is lost.
        let [x, y] = [half_width, half_height].map(|half| 1.001 * half);
        let square = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| DVec3::new(x, y, -depth));
        clipped(&square, &light_planes)
    };
    let polygons = (0..count).map(slice).filter(|polygon| polygon.len() >= 3).collect();
    Slices { polygons, spacing }
}

/// Part of a convex polygon within all planes.
fn clipped(polygon: &[DVec3], planes: &[DVec4; 6]) -> Vec<DVec3> {
    planes.iter().fold(polygon.to_vec(), |polygon, plane| frustum::clip_polygon(&polygon, plane))
}

/// The slices as one mesh in eye space: GL draws triangles in their order.
fn drawable(slices: &Slices, light: usize, world_from_eye: &glam::DMat4) -> Drawable {
    let mut mesh = Mesh { name: format!("slices of the beam of light {light}"), ..Mesh::default() };
    for polygon in &slices.polygons {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(polygon.iter().map(|point| point.as_vec3().to_array()));
        let fan = (1..polygon.len() as u32 - 1).flat_map(|corner| [first, first + corner, first + corner + 1]);
        mesh.indices.extend(fan);
    }
    mesh.bounds = Aabb::from_points(slices.polygons.iter().flatten().copied());
    let indices = 0..mesh.indices.len() as u32;
    mesh.parts =
        vec![Part { name: String::from("slices"), indices: indices.clone(), material: None, bounds: mesh.bounds }];
    Drawable {
        label: mesh.name.clone(),
        object: usize::MAX,
        indices,
        bounds: mesh.bounds,
        mesh: MeshRef(Arc::new(mesh)),
        material: Arc::new(Material::default()),
        world_from_model: *world_from_eye,
        wave: None,
        photo: None,
        lit: false,
        casts_shadow: false,
        closed: false,
    }
}

/// Adds to a batch what the slices' shader reads besides the light.
fn set_slices(
    scene: &Scene,
    term: &LightTerm,
    dust: &Dust,
    spacing: f64,
    lens: &CameraProjection,
    batch: &mut Batch,
) -> Result<(), Error> {
    let [width, height] = scene.image.size.map(f64::from);
    let half_height = (0.5 * scene.camera.fov_y_radians).tan();
    let half_width = half_height * scene.aspect();
    let ray = DVec4::new(2.0 * half_width / width, 2.0 * half_height / height, -half_width, -half_height);
    batch.uniforms.push(Uniform::new("ray_from_pixel", ray.as_vec4()));
    let optical_depth = dust.density * spacing;
    batch.uniforms.push(Uniform::new("optical_depth", optical_depth as f32));
    let defines = &mut batch.program.defines;
    let most =
        if dust.thickness_along_ray { optical_depth * half_width.hypot(half_height).hypot(1.0) } else { optical_depth };
    // Well apart from the bound, so that rounding decides nothing.
    if most < 0.99 * SERIES_BOUND {
        defines.push(Define::flag("THIN"));
    } else if optical_depth > 1.01 * SERIES_BOUND {
        defines.push(Define::flag("THICK"));
    }
    if dust.thickness_along_ray {
        defines.push(Define::flag("SECANT"));
    }
    if dust.blend == DustBlend::Over {
        defines.push(Define::flag("OVER"));
        if dust.hides_in_shadow {
            defines.push(Define::flag("HIDES_IN_SHADOW"));
        }
    }
    if let (true, Some(coordinates)) = (dust.jitter, &term.coordinates) {
        let spaces = coordinates.spaces(lens.camera.eye_from_world);
        let texgen = crate::math::texgen::set_up(&spaces, coordinates.set_up, coordinates.split)
            .ok_or(Error::Singular { light: term.index })?;
        let of_eye: Vec4 = (texgen.texture_matrix * texgen.eye_planes * DVec4::W).as_vec4();
        defines.push(Define::flag("JITTER"));
        batch.uniforms.push(Uniform::of_light("coord_of_eye", term.index, of_eye));
        batch.uniforms.push(Uniform::new("spacing", spacing as f32));
        batch.uniforms.push(Uniform::new("depth_of_distance", lens.depth_of_distance().as_vec2()));
    }
    Ok(())
}
