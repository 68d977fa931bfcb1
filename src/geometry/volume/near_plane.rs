//! The near plane z = -near of view space, a light, and where rays from places away from the light meet the plane.
//!
//! With h(q) the height of q over the plane (positive ahead of the eye) and l that of the light (for a direction, its
//! rise), a ray from q lands if q's height lies between 0 and l: beyond the plane it comes down on it (l > 0), before it it
//! rises through it (l < 0). So an edge is cut in two places: where it meets the plane itself, a point that is its own
//! projection; and where its rays run parallel to the plane, whose projection is a direction with w = 0 [GDC, "Handling the
//! "Hard" Near Clip Plane Capping Case"].

use glam::DVec3;

use super::LightSource;
use super::extrude::at_infinity;

/// A place in view space, and its vertices in the volume once they exist.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewPlace {
    pub at: DVec3,
    height: f64,
    /// l - h w: positive where the ray comes down.
    fall: f64,
    pub stand: Stand,
    pub own: u32,
    pub projected: u32,
    pub infinite: u32,
}

/// Position of a place, for a light beyond the plane (l >= 0) or before it (l < 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stand {
    /// The place is on the other side of the plane than the light.
    AtPlane,
    /// Its ray meets the plane.
    Lands,
    /// At the light's height or past it: its ray never meets the plane.
    Never,
}

impl Stand {
    pub fn lands(self) -> bool {
        self == Self::Lands
    }

    /// Tests whether the place itself is in front of the eye.
    pub fn is_beyond_plane(self, plane: &NearPlane) -> bool {
        (self == Self::AtPlane) != plane.light_is_beyond()
    }
}

impl ViewPlace {
    pub const NONE: u32 = u32::MAX;

    pub fn lands(&self) -> bool {
        self.stand.lands()
    }
}

pub(super) struct NearPlane {
    source: LightSource,
    near: f64,
    /// l.
    light_height: f64,
    w: f64,
    /// Plane at which sides may end instead of at infinity, `normal · x = distance`, beyond all that is seen.
    end: Option<(DVec3, f64)>,
}

impl NearPlane {
    /// `source` and `end` in view space.
    pub fn new(source: LightSource, near: f64, end: Option<(DVec3, f64)>) -> Self {
        let light = source.homogeneous();
        Self { source, near, light_height: -light.z - near * light.w, w: light.w, end }
    }

    /// Tests whether the light stands ahead of the plane, or in it.
    pub fn light_is_beyond(&self) -> bool {
        self.light_height >= 0.0
    }

    pub fn away(&self, point: DVec3) -> DVec3 {
        self.source.away(point)
    }

    /// The end of a place's ray: at infinity, or beyond all that is seen and the near plane.
    pub fn far_end(&self, place: &ViewPlace) -> [f32; 4] {
        let away = self.away(place.at);
        let Some((normal, distance)) = self.end else { return at_infinity(away) };
        let to_end = (distance - normal.dot(place.at)) / normal.dot(away);
        let landing = if place.height < 0.0 && away.z < 0.0 { place.height / away.z } else { 0.0 };
        (place.at + to_end.max(landing).max(0.0) * away).as_vec3().extend(1.0).to_array()
    }

    pub fn place(&self, at: DVec3) -> ViewPlace {
        let height = -at.z - self.near;
        let fall = self.light_height - height * self.w;
        let stand = match self.light_is_beyond() {
            true if height < 0.0 => Stand::AtPlane,
            true if fall > 0.0 => Stand::Lands,
            false if height >= 0.0 => Stand::AtPlane,
            false if fall < 0.0 => Stand::Lands,
            _ => Stand::Never,
        };
        ViewPlace {
            at,
            height,
            fall,
            stand,
            own: ViewPlace::NONE,
            projected: ViewPlace::NONE,
            infinite: ViewPlace::NONE,
        }
    }

    /// (l q - h light) / (l - h w), for a place whose ray lands.
    pub fn projected(&self, place: &ViewPlace) -> [f32; 4] {
        let light = self.source.homogeneous().truncate();
        self.on_plane((self.light_height * place.at - place.height * light) / place.fall)
    }

    /// Point where the edge between two places meets the plane, if they are on different sides of it. The order of the two
    /// does not change a bit: sums of two commute.
    pub fn crossing(&self, a: &ViewPlace, b: &ViewPlace) -> Option<[f32; 4]> {
        let parted = (a.stand == Stand::AtPlane) != (b.stand == Stand::AtPlane);
        let (ha, hb) = (a.height.abs(), b.height.abs());
        parted.then(|| self.on_plane((b.at * ha + a.at * hb) / (ha + hb)))
    }

    /// The direction in the plane in which the projection of the edge between two places runs to infinity, if the rays of
    /// just one of them never land: a (B - light) - b (A - light) with a > 0 >= b [GDC, "Handling the "Hard" Near Clip
    /// Plane Capping Case"]. The same bits whichever comes first.
    pub fn direction_between(&self, a: &ViewPlace, b: &ViewPlace) -> Option<[f32; 4]> {
        let parted = (a.stand == Stand::Never) != (b.stand == Stand::Never);
        parted.then(|| match self.source {
            LightSource::Point(_) => {
                let direction = self.away(b.at) * a.fall.abs() + self.away(a.at) * b.fall.abs();
                at_infinity(direction.with_z(0.0))
            }
            // Parallel rays part so only where they run along the plane.
            LightSource::Direction(_) => at_infinity(self.away(a.at).with_z(0.0)),
        })
    }

    fn on_plane(&self, point: DVec3) -> [f32; 4] {
        point.with_z(-self.near).as_vec3().extend(1.0).to_array()
    }
}
