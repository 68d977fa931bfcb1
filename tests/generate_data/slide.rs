//! The picture of a slide projector: three church windows of coloured glass, 3 : 2, a cross in the middle one. Dark at the
//! border, and nothing in it is symmetric from top to bottom or, by its colours, from left to right.

use glam::{DVec2, DVec3, dvec2, dvec3};
use image::RgbImage;

use super::noise::{hash, tiled_noise};
use super::textures::draw;

const SIZE: [u32; 2] = [384, 256];

/// The whole picture, row 0 on top.
pub fn slide() -> RgbImage {
    draw(SIZE, color)
}

/// A window with a pointed arch: the middle of its sill, half its width, the height of its sides. Units: picture heights.
struct Window {
    sill: DVec2,
    half: f64,
    sides: f64,
}

const WINDOWS: [Window; 3] = [
    Window { sill: dvec2(0.29, 0.90), half: 0.145, sides: 0.42 },
    Window { sill: dvec2(0.75, 0.94), half: 0.205, sides: 0.50 },
    Window { sill: dvec2(1.21, 0.90), half: 0.145, sides: 0.42 },
];

/// Glass of the side windows and of the ground behind the cross, from cool to warm.
const GLASS: [[f64; 3]; 7] = [
    [0.10, 0.22, 0.72],
    [0.14, 0.48, 0.82],
    [0.10, 0.56, 0.42],
    [0.86, 0.70, 0.16],
    [0.92, 0.46, 0.10],
    [0.80, 0.14, 0.12],
    [0.52, 0.16, 0.52],
];

fn color(place: DVec2) -> DVec3 {
    // In picture heights, y downwards.
    let p = dvec2(place.x * 1.5, place.y);
    WINDOWS.iter().enumerate().find_map(|(index, window)| window.glass(index, p)).unwrap_or(DVec3::ZERO)
}

impl Window {
    /// Colour of the glass at `p`; black lead; `None` outside.
    fn glass(&self, index: usize, p: DVec2) -> Option<DVec3> {
        let at = dvec2(p.x - self.sill.x, self.sill.y - p.y);
        let rim = self.distance_to_rim(at);
        if rim < 0.0 {
            return None;
        }
        const FRAME: f64 = 0.012;
        if rim < FRAME {
            return Some(DVec3::ZERO);
        }
        let (pane, lead) = if index == 1 { self.cross(at, rim) } else { self.lozenges(at, rim, index) };
        let streak = tiled_noise(dvec3(11.0 * p.x, 3.0 * p.y, index as f64 + 0.5), 16, 41);
        let light = 0.90 + 0.16 * streak;
        Some(if lead < 0.0045 { DVec3::ZERO } else { pane * light })
    }

    /// Distance inwards from the sill, the sides or the two arcs, each around the foot of the other; negative outside.
    fn distance_to_rim(&self, at: DVec2) -> f64 {
        let side = self.half - at.x.abs();
        let above = at.y - self.sides;
        let arc = 2.0 * self.half - dvec2(at.x.abs() + self.half, above).length();
        at.y.min(if above > 0.0 { arc } else { side })
    }

    /// Lozenges in two colours that change upwards, within a border of another. The pane's colour, and the distance to the
    /// nearest lead.
    fn lozenges(&self, at: DVec2, rim: f64, index: usize) -> (DVec3, f64) {
        const BORDER: f64 = 0.034;
        if rim < BORDER {
            let strip = (at.y * 14.0).floor();
            let step = (at.y * 14.0 - strip).min(strip + 1.0 - at.y * 14.0) / 14.0;
            let warm = (strip as i64 + index as i64).rem_euclid(2) == 0;
            return (glass(if warm { 5 } else { 3 }), step.min(BORDER - rim));
        }
        let (u, v) = ((at.x + 0.6 * at.y) * 11.0, (at.x - 0.6 * at.y) * 11.0);
        let (cell_u, cell_v) = (u.floor(), v.floor());
        let edge = |x: f64, cell: f64| (x - cell).min(cell + 1.0 - x) / 13.0;
        let row = ((cell_u - cell_v) as i64).rem_euclid(5);
        let mixed = 0.75 + 0.5 * hash(cell_u as i64, cell_v as i64, index as i64, 42);
        let kind = if index == 0 { row % 3 } else { 6 - (row + 1) % 3 };
        (glass(kind as usize) * mixed, edge(u, cell_u).min(edge(v, cell_v)).min(rim - BORDER))
    }

    /// A pale cross on a ground of squares that is blue above and red below, with a yellow ring.
    fn cross(&self, at: DVec2, rim: f64) -> (DVec3, f64) {
        let center = dvec2(0.0, 0.50);
        let q = at - center;
        let arm = 0.036;
        let post = arm - q.x.abs();
        let beam = (arm - q.y.abs()).min(0.150 - q.x.abs());
        let inside = post.min(at.y - 0.04).min(0.78 - at.y).max(beam);
        let cream = dvec3(1.0, 0.97, 0.86);
        if inside > 0.0 {
            return (cream, inside);
        }
        let ring = (q.length() - 0.105).abs();
        if ring < 0.018 {
            return (glass(3) * 1.1, (-inside).min(0.018 - ring));
        }
        let (u, v) = (at.x * 13.0 + 0.5, at.y * 13.0);
        let (cell_u, cell_v) = (u.floor(), v.floor());
        let edge = |x: f64, cell: f64| (x - cell).min(cell + 1.0 - x) / 13.0;
        let mixed = 0.7 + 0.6 * hash(cell_u as i64, cell_v as i64, 7, 43);
        let kind = match at.y {
            y if y > 0.52 => i64::from(mixed > 1.05),
            y if y > 0.30 => 6 - i64::from(mixed > 1.1),
            _ => 5 - i64::from(mixed > 1.15),
        };
        let lead = edge(u, cell_u).min(edge(v, cell_v)).min(-inside).min(ring - 0.018).min(rim - 0.012);
        (glass(kind as usize) * mixed, lead)
    }
}

fn glass(kind: usize) -> DVec3 {
    DVec3::from_array(GLASS[kind])
}
