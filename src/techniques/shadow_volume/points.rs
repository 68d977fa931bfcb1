//! Points that the camera sees, with the number of volumes that hold each, and whether light reaches it. By rays through
//! pixels, in f64.

use glam::{DVec2, DVec3};

use super::casters::CastingObject;
use super::source;
use crate::geometry::rays::{Ray, Triangles};
use crate::geometry::volume::{LightSource, Outline};
use crate::lights::{LightView, alpha};
use crate::scene::{LightKind, LightShape};

/// Distance from a point's own plane within which a surface counts as in it, relative to the segment from the light.
const IN_PLANE: f64 = 1e-9;

/// Step to which GL rounds positions, in pixels.
const SUBPIXEL: f64 = 1.0 / 256.0;

/// A visible point, and its counts.
#[derive(Clone, Copy, Debug)]
pub struct CountedPoint {
    /// Number of volumes that hold it.
    pub within: u32,
    /// Number of volumes that hold it if they end at the given distance.
    pub within_ended: u32,
    /// Volumes at whose surface it lies, within the depth buffer's rounding: they may hold it or not.
    pub doubtful: u32,
    /// Number of volumes that hold the point of the near rectangle on the same ray.
    pub before: u32,
    /// Number of volumes that the ray enters through holes of their casters, less those that it leaves so: without caps
    /// z-pass does not count them.
    pub through_holes: i32,
    /// Distance aside, in pixels, at which a picture may show it, in both directions.
    pub aside: f64,
    pub is_shadowed: bool,
    /// Distance behind the first caster that shadows it, in world units.
    pub behind: f64,
}

/// Surfaces to see and volumes to count.
pub struct CountedWorld<'a> {
    view: &'a LightView<'a>,
    source: LightSource,
    surfaces: Triangles,
    /// The item of each triangle of `surfaces`, and its number there.
    owners: Vec<(usize, u32)>,
    counted: Triangles,
    /// The far ends of `counted`, where volumes end.
    ended: Vec<[DVec3; 3]>,
    has_holes: bool,
    eye: Eye,
    /// The largest of all coordinates.
    largest: f64,
}

/// A ray's parameter is the depth along the camera's axis.
struct Eye {
    ahead: DVec3,
    /// A pixel's width and height at depth 1.
    right: DVec3,
    up: DVec3,
}

impl<'a> CountedWorld<'a> {
    /// Prepares the volumes of `casting`. `distance`: how far each caster's volume goes, in its model's units, if it ends.
    pub fn new(
        view: &'a LightView<'a>,
        casting: &[&CastingObject],
        distance: Option<&dyn Fn(&CastingObject) -> f64>,
    ) -> Self {
        let (mut surfaces, mut owners) = (Vec::new(), Vec::new());
        for (owner, item) in view.items.iter().enumerate() {
            for triangle in 0..(item.indices.end - item.indices.start) / 3 {
                let corners = alpha::vertices(item, triangle).map(|vertex| item.mesh.positions[vertex].map(f64::from));
                surfaces.push(corners.map(|corner| item.world_from_model.transform_point3(DVec3::from_array(corner))));
                owners.push((owner, triangle));
            }
        }
        let (mut counted, mut ended) = (Vec::new(), Vec::new());
        let mut outline = Outline::default();
        for caster in casting {
            let light = source(view).transformed(&caster.world_from_model.inverse());
            outline.find(&caster.caster, light);
            let to_world = |corner| caster.world_from_model.transform_point3(corner);
            let weighed = caster.caster.triangles().iter().zip(outline.weights());
            for (places, _) in weighed.filter(|(_, weight)| **weight != 0) {
                let positions = caster.caster.positions();
                let corners = places.map(|place| DVec3::from_array(positions[place as usize].map(f64::from)));
                counted.push(corners.map(to_world));
                if let Some(distance) = distance {
                    let end = |corner| corner + distance(caster) * light.away(corner).normalize_or_zero();
                    ended.push(corners.map(|corner| to_world(end(corner))));
                }
            }
        }
        let camera = &view.scene.camera;
        let ahead = (camera.target - camera.eye).normalize();
        let right = ahead.cross(camera.up).normalize();
        let pixel = 2.0 * (0.5 * camera.fov_y_radians).tan() / f64::from(view.scene.image.size[1]);
        let eye = Eye { ahead, right: pixel * right, up: pixel * right.cross(ahead) };
        let largest = surfaces.iter().flatten().fold(camera.eye.abs(), |most, corner| most.max(corner.abs()));
        Self {
            view,
            source: source(view),
            surfaces: Triangles::new(surfaces),
            owners,
            counted: Triangles::new(counted),
            ended,
            has_holes: casting.iter().any(|caster| caster.has_holes),
            eye,
            largest: largest.max_element(),
        }
    }

    /// Point seen at a place of the picture, in pixels from its upper left corner. `None`: nothing, or a point outside the
    /// light's shape.
    pub fn at(&self, place: DVec2) -> Option<CountedPoint> {
        let camera = &self.view.scene.camera;
        let [width, height] = self.view.scene.image.size.map(f64::from);
        let way = self.eye.ahead + (place.x - 0.5 * width) * self.eye.right + (0.5 * height - place.y) * self.eye.up;
        let ray = Ray { origin: camera.eye, way, start: camera.near, end: camera.far };
        let mut seen: Option<(f64, u32)> = None;
        self.surfaces.crossings(&ray, |triangle, t| {
            if seen.is_none_or(|(nearest, _)| t < nearest) && self.is_opaque(triangle, ray.origin + t * way) {
                seen = Some((t, triangle));
            }
        });
        let (depth, own) = seen?;
        let point = camera.eye + depth * way;
        if !self.is_held(point) {
            return None;
        }
        let aside = SUBPIXEL + self.rounding(point, own) / (depth * self.eye.right.length());
        // Four codes of 24 bits, and what f32 rounds positions by.
        let doubt = (depth * depth / camera.near * way.length()) * 2.0_f64.powi(-22) + self.largest * 2.0_f64.powi(-21);
        let near = self.toward(camera.eye + camera.near * way);
        let mut before = 0;
        self.counted.crossings(&near, |_, _| before += 1);
        let mut through_holes = 0;
        if self.has_holes {
            // A surface before the point that is not seen has a hole there.
            self.counted.crossings(&Ray { end: depth - doubt / way.length(), ..ray }, |triangle, t| {
                let normal = normal(self.counted.corners(triangle));
                let light_ray = self.source.away(ray.origin + t * way);
                through_holes += if normal.dot(light_ray) * normal.dot(way) > 0.0 { 1 } else { -1 };
            });
        }
        Some(CountedPoint { before, through_holes, aside, ..self.held(point, way, own, doubt) })
    }

    fn held(&self, point: DVec3, way: DVec3, own: u32, doubt: f64) -> CountedPoint {
        let ray = self.toward(point);
        let length = ray.way.length();
        let longer = Ray { end: 1.0 + (4.0 * doubt / length).clamp(IN_PLANE, 1.0), ..ray };
        let normal = normal(self.surfaces.corners(own));
        let is_averted = normal.dot(ray.way) * normal.dot(way) < 0.0;
        // Whether a crossing lies before the point; `None` where its distance from the point is in doubt.
        let is_before = |corners: &[DVec3; 3], t: f64| {
            let other = self::normal(corners);
            let gap = other.dot(point - corners[0]).abs();
            if gap <= IN_PLANE * (length + self.largest) && other.dot(normal).abs() > 1.0 - IN_PLANE {
                Some(is_averted)
            } else if gap <= doubt {
                None
            } else {
                Some(t < 1.0)
            }
        };
        let (mut within, mut within_ended, mut doubtful, mut first) = (0, 0, 0, f64::INFINITY);
        self.counted.crossings(&longer, |triangle, t| match is_before(self.counted.corners(triangle), t) {
            Some(true) => {
                within += 1;
                within_ended += u32::from(self.goes_on(triangle, &ray));
                first = first.min(t);
            }
            Some(false) => {}
            None => doubtful += 1,
        });
        let mut is_shadowed = within > 0;
        if self.has_holes && is_shadowed {
            is_shadowed = false;
            self.surfaces.crossings(&longer, |triangle, t| {
                if self.view.items[self.owners[triangle as usize].0].casts_shadow
                    && is_before(self.surfaces.corners(triangle), t) == Some(true)
                    && self.is_opaque(triangle, ray.origin + t * ray.way)
                {
                    is_shadowed = true;
                }
            });
        }
        let behind = (1.0 - first).max(0.0) * length;
        CountedPoint { within, within_ended, doubtful, before: 0, through_holes: 0, aside: 0.0, is_shadowed, behind }
    }

    /// Rounding of f32 in a point of a triangle: four times, by 2^-24 of what meets in a transform.
    fn rounding(&self, point: DVec3, triangle: u32) -> f64 {
        let origin = self.view.items[self.owners[triangle as usize].0].world_from_model.w_axis.truncate();
        let light = match self.source {
            LightSource::Point(light) => light,
            LightSource::Direction(_) => self.view.scene.camera.eye,
        };
        let met = point.distance(origin) + origin.distance(self.view.scene.camera.eye) + origin.distance(light);
        4.0 * 2.0_f64.powi(-24) * met
    }

    /// Ray from the light to a point, which has t = 1.
    fn toward(&self, point: DVec3) -> Ray {
        let away = self.source.away(point);
        let way = match self.source {
            LightSource::Point(_) => away,
            // A ray from beyond the whole scene.
            LightSource::Direction(_) => away.normalize() * (4.0 * (self.largest + point.abs().max_element())),
        };
        Ray { origin: point - way, way, start: 0.0, end: 1.0 }
    }

    /// Tests whether the volume of a triangle that the ray crosses ends beyond t = 1, if it ends.
    fn goes_on(&self, triangle: u32, ray: &Ray) -> bool {
        let Some(end) = self.ended.get(triangle as usize) else { return true };
        let normal = (end[1] - end[0]).cross(end[2] - end[0]);
        normal.dot(end[0] - ray.origin) / normal.dot(ray.way) > 1.0
    }

    fn is_held(&self, point: DVec3) -> bool {
        let spot = match &self.view.light().kind {
            LightKind::Spot(spot) => spot,
            LightKind::Point(light) => {
                let depth = (point - light.position).abs().max_element();
                return light.near < depth && depth < light.far;
            }
            LightKind::Directional { .. } => return true,
        };
        let clip = spot.frustum.clip_from_world() * point.extend(1.0);
        let across = DVec2::new(clip.x, clip.y);
        clip.z.abs() < clip.w
            && match spot.shape {
                LightShape::Cone => across.length() < clip.w,
                LightShape::Frustum => across.abs().max_element() < clip.w,
            }
    }

    /// Tests whether a triangle's surface passes the alpha test at a point of it.
    fn is_opaque(&self, triangle: u32, point: DVec3) -> bool {
        let (owner, number) = self.owners[triangle as usize];
        alpha::passes(&self.view.items[owner], number, self.surfaces.corners(triangle), point)
    }
}

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}
