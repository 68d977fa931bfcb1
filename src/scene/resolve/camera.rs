//! `[camera]`: every key may be absent; missing values are framed on the scene's objects.

use std::collections::HashSet;

use glam::DVec3;

use crate::math::Aabb;
use crate::scene::settings::{Plain, Reader, Settings, SettingsError, Value};
use crate::scene::sight::{Cut, LEAST_PIECE, Pyramid, Span};
use crate::scene::{Camera, Image, Object, camera_framing};

/// `[camera]` as written; values that depend on the objects follow later.
pub(super) struct CameraKeys {
    settings: Settings,
    eye: Option<DVec3>,
    target: Option<DVec3>,
    fov_y_radians: f64,
    near: Option<f64>,
    far: Option<f64>,
}

/// Reads `[camera]`, or each `[[camera]]`, and returns the first.
pub(super) fn read_first(root: &mut Reader<'_>) -> Result<CameraKeys, SettingsError> {
    let tables = match root.entry("camera").map(|entry| &entry.value) {
        Some(Value::Array(items)) if items.is_empty() => {
            return Err(root.error("camera", "is an empty array: leave it out, and one is framed"));
        }
        Some(Value::Array(_)) => root.tables("camera")?,
        _ => return read(root.table("camera")?),
    };
    let mut names: HashSet<&str> = HashSet::with_capacity(tables.len());
    for table in &tables {
        let mut reader = table.read();
        let name = reader.string("name")?;
        let name = name.ok_or_else(|| reader.missing("name", "`--camera NAME` chooses one of several cameras"))?;
        if !names.insert(name) {
            return Err(reader.error("name", format_args!("\"{name}\" is the name of another camera, too")));
        }
    }
    let mut cameras = tables.into_iter().map(|table| read(Some(table))).collect::<Result<Vec<_>, _>>()?;
    Ok(cameras.swap_remove(0))
}

/// Reads the keys, and checks them as far as that is possible without the objects.
fn read(table: Option<&Settings>) -> Result<CameraKeys, SettingsError> {
    let absent = || Settings { path: String::from("camera"), ..Settings::default() };
    let settings = table.cloned().unwrap_or_else(absent);
    let mut reader = settings.read();
    reader.string("name")?;
    let (eye, target) = (reader.vector("eye")?, reader.vector("target")?);
    match (eye, target) {
        (Some(eye), Some(target)) => reader.up(["eye", "target"], eye, target).map(drop)?,
        _ => reader.vector("up").map(drop)?,
    }
    let fov_y_radians =
        reader.angle_between("fov_y", 1.0, 179.0)?.unwrap_or(camera_framing::FOV_Y_DEGREES.to_radians());
    let [near, far] = reader.near_and_far()?;
    reader.finish()?;
    Ok(CameraKeys { eye, target, fov_y_radians, near, far, settings })
}

impl CameraKeys {
    /// The camera, framed on `objects` where values are missing; cuts by its planes and too coarse depths are added to
    /// `warnings`.
    pub fn complete(
        self,
        objects: &[Object],
        image: &Image,
        warnings: &mut Vec<String>,
    ) -> Result<Camera, SettingsError> {
        let corners: Vec<DVec3> = objects.iter().flat_map(|object| object.world_bounds().corners()).collect();
        let bounds = Aabb::from_points(corners.iter().copied());
        let radius = camera_framing::working_radius(&bounds);
        let (eye, target) = self.eye_and_target(&corners, &bounds, radius, image.aspect());
        let mut reader = self.settings.read();
        let up = reader.up(["eye", "target"], eye, target)?;
        let mut camera = Camera { eye, target, up, fov_y_radians: self.fov_y_radians, near: 0.0, far: 0.0 };
        let pyramid = Pyramid::of_camera(&camera, image.aspect());
        let spans: Vec<Span> = objects.iter().map(|object| pyramid.span(object)).collect();
        let seen = spans.iter().copied().fold(Span::EMPTY, Span::union);
        let [near, far] = camera_framing::depth_range(&corners, &camera, seen, radius);
        camera.near = self.near.unwrap_or_else(|| self.far.map_or(near, |far| near.min(far / 2.0)));
        camera.far = self.far.unwrap_or_else(|| far.max(2.0 * camera.near));
        reader.check_far(camera.near, camera.far)?;
        let view = ObjectsInView { camera: &camera, pyramid, objects, spans, size: image.size };
        let said = [view.cut_before(), view.cut_beyond(), view.coarse()].into_iter().flatten();
        warnings.extend(said.map(|(key, what)| reader.error(key, what).to_string()));
        warnings.extend(view.vague().map(|what| SettingsError::new(reader.origin(), what).to_string()));
        Ok(camera)
    }

    fn eye_and_target(&self, corners: &[DVec3], bounds: &Aabb, radius: f64, aspect: f64) -> (DVec3, DVec3) {
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            return (eye, target);
        }
        let reach = |target: DVec3| corners.iter().map(|corner| corner.distance(target)).fold(radius, f64::max);
        match (self.eye, self.target) {
            (Some(eye), _) if eye == bounds.center() => (eye, eye - camera_framing::THREE_QUARTER * radius),
            (Some(eye), _) => (eye, bounds.center()),
            (None, Some(target)) => {
                let distance = camera_framing::sphere_distance(reach(target), self.fov_y_radians, aspect);
                (target + camera_framing::THREE_QUARTER.normalize() * distance, target)
            }
            (None, None) => {
                camera_framing::fit(corners, camera_framing::THREE_QUARTER, self.fov_y_radians, aspect, radius)
            }
        }
    }
}

/// Least thickness of a solid, in steps of depth.
const STEPS: f64 = 8.0;

/// Error of a place, in pixels, from which there is a warning.
const MOST_OFF: f64 = 8.0;

/// Error of f32 in a vertex that is in view.
fn off(span: Span) -> f64 {
    0.5 * f64::from(f32::EPSILON) * span.reach
}

/// Objects as a camera with its planes shows them; `spans` has one for each.
struct ObjectsInView<'a> {
    camera: &'a Camera,
    pyramid: Pyramid,
    objects: &'a [Object],
    spans: Vec<Span>,
    size: [u32; 2],
}

/// A key, and the warning about its value.
type Said = (&'static str, String);

impl ObjectsInView<'_> {
    /// Each object with its depths, the nearest first.
    fn by_depth(&self) -> Vec<(&Object, Span)> {
        let mut objects: Vec<_> = self.objects.iter().zip(self.spans.iter().copied()).collect();
        objects.sort_by(|a, b| a.1.least.total_cmp(&b.1.least));
        objects
    }

    /// Warning if the nearest object is cut by the near plane: nothing hides the gap.
    fn cut_before(&self) -> Option<Said> {
        let near = self.camera.near;
        let cut = self.by_depth().into_iter().take_while(|(_, span)| span.least < near);
        let mut cut = cut.filter(|(object, _)| self.pyramid.is_cut(object, Cut::Before(near), self.size, LEAST_PIECE));
        let (object, span) = cut.next()?;
        let part = if span.most < near { "" } else { "part of " };
        let begins = Plain(brief(span.least));
        let what = format!("= {} cuts off {part}`{}`, which begins at {begins}", Plain(brief(near)), object.name);
        Some(("near", what))
    }

    fn cut_beyond(&self) -> Option<Said> {
        let far = self.camera.far;
        let spans = self.objects.iter().zip(&self.spans).filter(|(_, span)| span.most > far);
        let (cut, spans): (Vec<&Object>, Vec<&Span>) = spans.unzip();
        let first = self.pyramid.first_beyond(&cut, far, self.objects, self.size)?;
        let (object, span) = (cut[first], spans[first]);
        let part = if span.least > far { "" } else { "part of " };
        let ends = Plain(brief(span.most));
        let what = format!("= {} cuts off {part}`{}`, which ends at {ends}", Plain(brief(far)), object.name);
        Some(("far", what))
    }

    /// Warning about depths that a buffer of 24 bits cannot resolve behind so near a plane.
    fn coarse(&self) -> Option<Said> {
        let Camera { near, far, .. } = *self.camera;
        let last = camera_framing::last_depth([near, far]);
        let seen = self.seen();
        // There is always a strip of it before the far plane; less than half a row of pixels is none.
        let row = 0.5 * f64::from(self.size[0].max(self.size[1]));
        let lost = seen.iter().find(|(object, span)| {
            span.most > last && self.pyramid.is_cut(object, Cut::Between(last, far), self.size, row)
        });
        if let Some((object, _)) = lost {
            let what = "is so near that what is farther than";
            let last = Plain(brief(last));
            let what = format!(
                "= {} {what} {last} falls on the last two values of a depth buffer of 24 bits, as does some of `{}`",
                Plain(brief(near)),
                object.name
            );
            return Some(("near", what));
        }
        // A vertex that is rounded by more than the clip planes' distance from the eye's plane puts them anywhere.
        if let Some((object, span)) = seen.iter().find(|(_, span)| off(*span) > 2.0 * near) {
            let what = format!(
                "= {} is less than 32-bit floats may be off by, {}, at the vertices of `{}`, up to {} away",
                Plain(brief(near)),
                Plain(brief(off(*span))),
                object.name,
                Plain(brief(span.reach)),
            );
            return Some(("near", what));
        }
        let (object, span) = seen.iter().find(|(object, span)| self.is_flattened(object, *span))?;
        let what = format!(
            "= {} is so near that a depth buffer of 24 bits tells apart no less than {} at `{}`, {} away",
            Plain(brief(near)),
            Plain(brief(camera_framing::depth_step(near, span.least))),
            object.name,
            Plain(brief(span.least)),
        );
        Some(("near", what))
    }

    /// A solid whose front and back are a few steps of depth apart: which of them is shown, and on which side of them a
    /// shadow's surface lies, is arbitrary.
    fn is_flattened(&self, object: &Object, span: Span) -> bool {
        let [thin, _, long] = extents(object);
        let pixel = self.camera.pixel_at(span.least, self.size);
        // Without back faces only what is all at one depth is lost.
        let room = if object.closed { long } else { thin };
        thin > 0.0 && long > pixel && camera_framing::depth_step(self.camera.near, span.least) > room / STEPS
    }

    /// Objects in view behind the near plane, the nearest first.
    fn seen(&self) -> Vec<(&Object, Span)> {
        let near = self.camera.near;
        self.by_depth().into_iter().filter(|(_, span)| !span.is_empty() && span.most > near).collect()
    }

    /// Warning about triangles so large, or so far from their object's origin, that rounding of vertices moves them
    /// visibly.
    fn vague(&self) -> Option<String> {
        let pixel = |span: Span| self.camera.pixel_at(span.least.max(self.camera.near), self.size);
        let (object, span) = self.seen().into_iter().find(|(_, span)| off(*span) > MOST_OFF * pixel(*span))?;
        Some(format!(
            "`{}` has vertices {} away from the eye or its own origin, which 32-bit floats move by up to {}: {:.0} pixels \
             where it begins",
            object.name,
            Plain(brief(span.reach)),
            Plain(brief(off(span))),
            off(span) / pixel(span),
        ))
    }
}

impl Camera {
    /// A pixel's side at a depth, in world units.
    fn pixel_at(&self, depth: f64, size: [u32; 2]) -> f64 {
        2.0 * depth * (0.5 * self.fov_y_radians).tan() / f64::from(size[1])
    }
}

/// The lengths of an object's box along its own axes, the shortest first.
fn extents(object: &Object) -> [f64; 3] {
    let size = object.mesh.bounds.max - object.mesh.bounds.min;
    let mut lengths = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| object.world_from_model.transform_vector3(axis * size.dot(axis)).length());
    lengths.sort_by(f64::total_cmp);
    lengths
}

/// A number to four digits.
fn brief(value: f64) -> f64 {
    // Adding zero turns -0 to 0.
    format!("{value:.3e}").parse().unwrap_or(value) + 0.0
}
