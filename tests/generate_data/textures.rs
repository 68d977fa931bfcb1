//! The textures: a floor of inlaid stone, the picture that a lamp throws, and shields that stand before lamps.

use glam::{DVec2, DVec3, dvec2, dvec3};
use image::{ImageBuffer, Luma, Rgb, RgbImage};

use super::noise::{hash, tiled_noise};

const FLOOR_SIZE: u32 = 512;
const SPOT_SIZE: u32 = 256;
const CHECKER_SIZE: u32 = 512;
const SHIELD_SIZE: u32 = 128;
const STUDS_SIZE: [u32; 2] = [512, 256];

/// Four large tiles, each framed by strips of dark stone, with a star of two marbles in it; tiles without a seam.
pub fn floor() -> RgbImage {
    draw([FLOOR_SIZE; 2], floor_color)
}

/// White in the middle and exactly black at the border, with the faint rings of a lamp's lens.
pub fn spot() -> RgbImage {
    draw([SPOT_SIZE; 2], spot_color)
}

/// The opening between four barn doors, one of them askew: bright with soft edges, the nearer the door the softer.
pub fn barn_doors() -> RgbImage {
    draw([SHIELD_SIZE; 2], barn_doors_color)
}

/// The lens of a low beam: dark above a cut-off that rises to the right, brightest just below it.
pub fn head_light() -> RgbImage {
    draw([SHIELD_SIZE; 2], head_light_color)
}

/// Heights of round studs in rows, each row half a stud from the next, on a surface twice as wide as it is high; tiles.
pub fn studs() -> ImageBuffer<Luma<u16>, Vec<u16>> {
    const COLUMNS: f64 = 24.0;
    const ROWS: f64 = 10.0;
    ImageBuffer::from_fn(STUDS_SIZE[0], STUDS_SIZE[1], |x, y| {
        let place =
            dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5) / dvec2(f64::from(STUDS_SIZE[0]), f64::from(STUDS_SIZE[1]));
        let height = (0..2).map(|odd| {
            let off =
                dvec2(COLUMNS * place.x - 0.5 * f64::from(odd), 0.5 * ROWS * place.y - 0.5 * f64::from(odd) - 0.25);
            let off = off - off.round();
            // In units of a stud's own spacing; rows of one parity are two rows apart.
            let distance_squared = (off * dvec2(1.0, 2.0)).length_squared() / (0.46 * 0.46);
            let inside = (1.0 - distance_squared).max(0.0);
            inside * inside * (3.0 - 2.0 * inside)
        });
        Luma([(65535.0 * height.fold(0.0, f64::max) + 0.5).floor() as u16])
    })
}

/// A board of 32 by 32 squares; those at the border are red where the others are blue.
pub fn checker() -> RgbImage {
    draw([CHECKER_SIZE; 2], checker_color)
}

fn checker_color(place: DVec2) -> DVec3 {
    let [column, row] = [32.0 * place.x, 32.0 * place.y].map(|at| at.floor() as u32);
    match (column + row).is_multiple_of(2) {
        true => DVec3::new(0.94, 0.91, 0.83),
        false if [column, row].iter().any(|at| [0, 31].contains(at)) => DVec3::new(0.62, 0.26, 0.18),
        false => DVec3::new(0.16, 0.26, 0.38),
    }
}

/// `color` at each texel, the mean of 4×4 samples; places in [0, 1).
pub(super) fn draw([width, height]: [u32; 2], color: fn(DVec2) -> DVec3) -> RgbImage {
    const SAMPLES: u32 = 4;
    let size = dvec2(f64::from(width), f64::from(height));
    RgbImage::from_fn(width, height, |x, y| {
        let mut sum = DVec3::ZERO;
        for sample in 0..SAMPLES * SAMPLES {
            let inner =
                dvec2(f64::from(sample % SAMPLES) + 0.5, f64::from(sample / SAMPLES) + 0.5) / f64::from(SAMPLES);
            sum += color((dvec2(f64::from(x), f64::from(y)) + inner) / size);
        }
        let mean = sum / f64::from(SAMPLES * SAMPLES);
        Rgb(mean.to_array().map(|value| (255.0 * value.clamp(0.0, 1.0) + 0.5).floor() as u8))
    })
}

/// Stones, by where they lie in a tile.
#[derive(Clone, Copy)]
enum Stone {
    Joint,
    Slate,
    Cream,
    Rust,
    Green,
}

fn floor_color(place: DVec2) -> DVec3 {
    let tile = (place * 2.0).floor();
    // From the tile's middle, in [-1, 1].
    let q = (place * 2.0 - tile) * 2.0 - 1.0;
    let (stone, piece) = stone_at(q);
    let number = piece + 40 * (tile.x as i64 + 2 * tile.y as i64);
    let (base, contrast) = match stone {
        Stone::Joint => (dvec3(0.20, 0.18, 0.16), 0.25),
        Stone::Slate => (dvec3(0.27, 0.29, 0.33), 0.30),
        Stone::Cream => (dvec3(0.86, 0.80, 0.68), 0.12),
        Stone::Rust => (dvec3(0.58, 0.36, 0.26), 0.22),
        Stone::Green => (dvec3(0.37, 0.45, 0.38), 0.24),
    };
    // Each piece is cut from another place of the block.
    let block = hash(number, 0, 0, 20);
    let shade = 0.92 + 0.16 * hash(number, 1, 0, 20);
    base * shade * (1.0 + contrast * marble(place, 7.0 * block))
}

/// Stone at `q`, in [-1, 1], and the number of the piece.
fn stone_at(q: DVec2) -> (Stone, i64) {
    const JOINT: f64 = 0.012;
    let a = q.abs();
    let edge = a.max_element();
    let quarter = i64::from(q.x > 0.0) + 2 * i64::from(q.y > 0.0);
    // The side of the square that the place is nearest to.
    let side = if a.x > a.y { i64::from(q.x > 0.0) } else { 2 + i64::from(q.y > 0.0) };
    let joint = |distance: f64| distance.abs() < JOINT;
    let slanted_joint = |distance: f64| distance * distance < 2.0 * JOINT * JOINT;
    // Two squares, one on its corner, make the star; a slab in its middle.
    let lozenge = a.x + a.y;
    if edge > 1.0 - JOINT || joint(edge - 0.84) {
        (Stone::Joint, 0)
    } else if edge > 0.84 {
        // Strips, with square blocks at the corners.
        let corner = a.min_element();
        if joint(corner - 0.84) {
            (Stone::Joint, 0)
        } else if corner > 0.84 {
            (Stone::Rust, 1 + quarter)
        } else {
            (Stone::Slate, 5 + side)
        }
    } else if joint(edge - 0.50) || slanted_joint(lozenge - 0.84) || slanted_joint(lozenge - 0.34) {
        (Stone::Joint, 0)
    } else if lozenge < 0.34 {
        (Stone::Slate, 9)
    } else if edge < 0.50 && lozenge < 0.84 {
        if joint(q.x) || joint(q.y) { (Stone::Joint, 0) } else { (Stone::Rust, 10 + quarter) }
    } else if edge < 0.50 {
        (Stone::Green, 14 + quarter)
    } else if lozenge < 0.84 {
        (Stone::Green, 18 + side)
    } else {
        (Stone::Cream, 22 + quarter)
    }
}

/// Veins and clouds in [-1, 1] or a little beyond; repeats after 1 in x and y.
fn marble(place: DVec2, depth: f64) -> f64 {
    let at = |period: i64, seed| {
        let p = place * period as f64;
        tiled_noise(dvec3(p.x, p.y, depth), period, seed)
    };
    let clouds = 0.6 * at(8, 21) + 0.3 * at(16, 22) + 0.2 * at(48, 23);
    let vein = (at(6, 24) + 0.5 * at(12, 25) + 0.25 * at(24, 26)).abs();
    let grain = at(256, 27);
    0.7 * clouds + 0.9 * (1.0 - vein / 0.05).max(0.0) + 0.35 * grain
}

fn spot_color(place: DVec2) -> DVec3 {
    let q = place * 2.0 - 1.0;
    let r = q.length();
    // Black well before the border: filtering must not reach past it.
    let disc = 1.0 - smoothstep(0.70, 0.95, r);
    let falloff = 1.0 - 0.22 * r * r;
    // The lens's rings: a wave of parabolas in r, fainter outwards.
    let phase = r * 9.0;
    let wave = phase - phase.floor();
    let ring = 4.0 * wave * (1.0 - wave);
    let rings = 1.0 - 0.10 * (1.0 - ring) * smoothstep(0.10, 0.25, r);
    let filament = 0.05 * tiled_noise(dvec3(6.0 * place.x, 6.0 * place.y, 0.5), 6, 30);
    // The lens's edge splits colours: warm outside.
    let warmth = smoothstep(0.55, 0.9, r);
    let color = dvec3(1.0, 1.0 - 0.10 * warmth, 0.97 - 0.27 * warmth);
    color * (disc * falloff * rings * (1.0 + filament))
}

pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn barn_doors_color(place: DVec2) -> DVec3 {
    let q = dvec2(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
    let door = |distance: f64, soft: f64| smoothstep(0.0, soft, distance);
    let left = door(q.x + 0.62 + 0.10 * q.y, 0.10);
    let right = door(0.62 - q.x, 0.10);
    let upper = door(0.45 - q.y - 0.18 * q.x, 0.14);
    let lower = door(q.y + 0.58, 0.06);
    let lamp = 1.0 - 0.35 * (q.x * q.x + q.y * q.y);
    DVec3::splat(left * right * upper * lower * lamp)
}

fn head_light_color(place: DVec2) -> DVec3 {
    let q = dvec2(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
    // Level to the left; to the right it rises by 15 degrees.
    let cut_off = if q.x > 0.0 { 0.268 * q.x } else { 0.0 };
    let below = cut_off - q.y;
    let edge = smoothstep(-0.02, 0.06, below);
    let spill = 0.06 * smoothstep(-0.7, 0.0, below);
    let (wide, hot) = (dvec2(q.x / 0.95, below / 0.75), dvec2((q.x - 0.08) / 0.40, (below - 0.10) / 0.22));
    let pool = |at: DVec2| (1.0 - at.length_squared()).max(0.0);
    let value = edge * (0.55 * pool(wide) + 0.60 * pool(hot)) + spill * pool(dvec2(q.x, 0.0));
    let value = value.min(1.0);
    dvec3(value, 0.98 * value, 0.92 * value)
}
