//! Dusty air before a pixel's surface, with bounds: the light's beam in slices across the view, each by its formula
//! [LEC, "Combining Shadows with Atmospherics"]. The planes of the slices are found anew, from the corners of the space that
//! both the camera and the light see.

use glam::{DMat3, DVec3};

use super::bounds::Bounds;
use super::lamp::Source;
use super::sample::Sample;
use crate::scene::{Dust, DustBlend, Light, LightKind};
use crate::truth::Tracer;
use crate::truth::primary::SeenPoint;

/// A beam in dusty air.
pub(super) struct DustyBeam<'a> {
    source: Source<'a>,
    dust: Dust,
    is_shadowed: bool,
    tracer: Tracer<'a>,
    /// Depth of the farthest slice along the view axis, their distance, and how many there are.
    farthest: f64,
    spacing: f64,
    count: u32,
}

/// Dust before a surface.
pub(super) struct Haze {
    /// Light that it sends to the eye.
    pub color: [Bounds; 3],
    /// Share of the surface's light that it lets through.
    pub passes: Bounds,
}

const CLEAR: Haze = Haze { color: [Bounds::NONE; 3], passes: Bounds::ALL };

impl<'a> DustyBeam<'a> {
    /// `None`: the light has no dust, or the camera sees nothing of its beam. `slices`: in place of its own.
    pub fn new(light: &'a Light, is_shadowed: bool, slices: Option<u32>, tracer: Tracer<'a>) -> Option<Self> {
        let dust = light.dust.filter(|dust| dust.density > 0.0)?;
        let [near, far] = depths(light, &tracer)?;
        let count = slices.unwrap_or(dust.slices);
        let spacing = (far - near) / f64::from(count);
        let source = Source::through(light, glam::DVec2::ZERO);
        Some(Self { source, dust, is_shadowed, tracer, farthest: far - 0.5 * spacing, spacing, count })
    }

    /// The dust of a pixel's ray up to the surface that it shows.
    pub fn before(&self, x: u32, y: u32, seen: Option<&SeenPoint<'_>>) -> Haze {
        let eye = &self.tracer.eye;
        let direction = eye.direction(x, y);
        let end = seen.map_or([eye.far, 0.0], |seen| self.end(seen));
        let length = if self.dust.thickness_along_ray { direction.length() } else { 1.0 };
        let optical = self.dust.density * self.spacing * length;
        let opacity = -f64::exp_m1(-optical);
        let mut haze = CLEAR;
        // Nearest first.
        for number in (0..self.count).rev() {
            let depth = self.farthest - f64::from(number) * self.spacing;
            if depth > end[0] + end[1] {
                break;
            }
            let at = self.sample(direction, depth);
            let mut gate = self.source.reach(&at).times(self.source.between_planes(&at));
            if gate == Bounds::NONE {
                continue;
            }
            if depth >= end[0] - end[1] {
                gate = gate.times(Bounds::anything(f64::from(u8::from(depth <= end[0]))));
            }
            let shade = if self.is_shadowed { self.shade(&at) } else { Bounds::ALL };
            let light = self.source.in_air(at.position);
            let projected = self.source.projected(&at);
            let lit = gate.times(shade);
            let (share, passed) = match self.dust.blend {
                DustBlend::Add => (optical, Bounds::ALL),
                DustBlend::Over => {
                    let hides = if self.dust.hides_in_shadow { gate } else { lit };
                    (opacity, hides.scaled(opacity).complement())
                }
            };
            let before = haze.passes;
            haze.color = [0, 1, 2].map(|k: usize| {
                let sent = before.times(lit).times(projected[k]).scaled(share * light[k]);
                haze.color[k].plus(sent)
            });
            haze.passes = before.times(passed);
        }
        haze
    }

    /// Depth of a surface, and by how much a slice's depth may be misjudged against it.
    fn end(&self, seen: &SeenPoint<'_>) -> [f64; 2] {
        let eye = &self.tracer.eye;
        let depth = eye.depth_of(seen.position - eye.position);
        let moved = seen.spread.iter().map(|way| eye.depth_of(*way).abs()).sum::<f64>();
        [depth, moved + seen.error + eye.depth_error(depth, moved / self.tracer.subpixel)]
    }

    /// The point of a slice that a pixel shows.
    fn sample(&self, direction: DVec3, depth: f64) -> Sample {
        let (tracer, eye) = (&self.tracer, &self.tracer.eye);
        let way = depth * direction;
        let position = eye.position + way;
        let met = way.length() + tracer.lamp.towards(position).length();
        let beside = [eye.right * depth, eye.up * depth];
        Sample { position, spread: beside.map(|way| way * tracer.subpixel), error: tracer.rounding * met, beside }
    }

    /// 1 where the light reaches a point of the air; in doubt where it does not reach all points of the sample alike.
    fn shade(&self, at: &Sample) -> Bounds {
        let reaches = |place: DVec3| self.tracer.reaches_air(place);
        let is_lit = reaches(at.position);
        let value = f64::from(u8::from(is_lit));
        let [a, b] = at.spread.map(|way| way + way.normalize_or_zero() * at.error);
        let is_sure = [a + b, a - b, b - a, -a - b].into_iter().all(|way| reaches(at.position + way) == is_lit);
        if is_sure { Bounds::exactly(value) } else { Bounds::anything(value) }
    }
}

/// Least and greatest depth along the view axis of what both the camera and the light see: at corners of that space, each of
/// which lies in three of the planes that bound it. `None`: there is no such space.
fn depths(light: &Light, tracer: &Tracer<'_>) -> Option<[f64; 2]> {
    /// Share of a corner's distance by which it may lie beyond a plane, by rounding.
    const ROUNDING: f64 = 1e-11;
    let LightKind::Spot(spot) = &light.kind else { return None };
    let eye = &tracer.eye;
    let planes: Vec<(DVec3, f64)> = eye.sides().into_iter().chain(sides(spot, eye.position)).collect();
    let mut span = [f64::INFINITY, f64::NEG_INFINITY];
    for (i, j, k) in triples(planes.len()) {
        let [(a, da), (b, db), (c, dc)] = [planes[i], planes[j], planes[k]];
        let matrix = DMat3::from_cols(a, b, c).transpose();
        if matrix.determinant().abs() < 1e-12 {
            continue;
        }
        // From the eye.
        let corner = matrix.inverse() * -DVec3::new(da, db, dc);
        let is_inside = |(normal, offset): &(DVec3, f64)| {
            normal.dot(corner) + offset >= -ROUNDING * (corner.length() + offset.abs())
        };
        if corner.is_finite() && planes.iter().all(is_inside) {
            let depth = eye.depth_of(corner);
            span = [span[0].min(depth), span[1].max(depth)];
        }
    }
    (span[0] < span[1]).then_some(span)
}

fn triples(count: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..count).flat_map(move |i| (i + 1..count).flat_map(move |j| (j + 1..count).map(move |k| (i, j, k))))
}

/// Planes that bound a spotlight: unit normals that look inwards, and distances inside of the plane, of the point `from`.
fn sides(spot: &crate::scene::Spot, from: DVec3) -> [(DVec3, f64); 6] {
    let frustum = &spot.frustum;
    let ahead = (frustum.target - frustum.position).normalize();
    let right = ahead.cross(frustum.up).normalize();
    let up = right.cross(ahead);
    let tangent = (0.5 * frustum.cone_radians).tan();
    let away = from - frustum.position;
    let through = |normal: DVec3| (normal, normal.dot(away));
    let side = |way: DVec3, tangent: f64| through((ahead * tangent - way).normalize());
    let wide = tangent * frustum.aspect;
    let (near, far) = (through(ahead), through(-ahead));
    [
        side(right, wide),
        side(-right, wide),
        side(up, tangent),
        side(-up, tangent),
        (near.0, near.1 - frustum.near),
        (far.0, far.1 + frustum.far),
    ]
}
