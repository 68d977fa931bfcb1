//! The knight's skin: colours, heights and gloss of each body part, in a square of texels. Nothing is lit in it: the
//! renderer's light does that.

use glam::{DVec2, DVec3, dvec2, dvec3};
use image::{GrayImage, Luma, RgbImage};

use super::noise::noise;

/// Texels a side.
pub const SIZE: u32 = 256;

/// Body parts, each with its place on the skin.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Region {
    Trunk,
    Head,
    Plume,
    Pauldron,
    UpperArm,
    Forearm,
    Thigh,
    Shin,
    Foot,
    Shield,
    Sword,
}

/// Left, top, width and height in texels; they do not overlap.
const PLACES: [(Region, [u32; 4]); 11] = [
    (Region::Trunk, [0, 0, 112, 128]),
    (Region::Head, [112, 0, 96, 96]),
    (Region::Plume, [208, 0, 48, 96]),
    (Region::Pauldron, [112, 96, 80, 48]),
    (Region::UpperArm, [192, 96, 64, 48]),
    (Region::Forearm, [192, 144, 64, 64]),
    (Region::Thigh, [0, 128, 64, 64]),
    (Region::Shin, [0, 192, 64, 64]),
    (Region::Foot, [64, 192, 64, 64]),
    (Region::Shield, [128, 144, 64, 112]),
    (Region::Sword, [192, 208, 64, 48]),
];

/// A place on the surface: colour, height in [0, 1], gloss in [0, 1].
struct Paint {
    color: DVec3,
    height: f64,
    gloss: f64,
}

const STEEL: DVec3 = dvec3(0.60, 0.63, 0.68);
const GOLD: DVec3 = dvec3(0.80, 0.62, 0.25);
const RED: DVec3 = dvec3(0.62, 0.09, 0.09);
const LEATHER: DVec3 = dvec3(0.33, 0.20, 0.11);

impl Region {
    fn rectangle(self) -> [u32; 4] {
        PLACES.iter().find(|(region, _)| *region == self).map_or([0, 0, 1, 1], |(_, place)| *place)
    }

    /// A place in [0, 1]², from the top left, in texels of the skin.
    pub fn texel(self, across: f64, down: f64) -> [i16; 2] {
        let [left, top, width, height] = self.rectangle().map(f64::from);
        [(left + across * width + 0.5).floor() as i16, (top + down * height + 0.5).floor() as i16]
    }

    /// Paint at a place in [0, 1]², from the top left.
    fn paint(self, at: DVec2) -> Paint {
        let [_, _, width, height] = self.rectangle().map(f64::from);
        let texel = at * dvec2(width, height);
        match self {
            Self::Trunk => trunk(at, texel),
            Self::Head => helmet(at, texel),
            Self::Plume => plume(at, texel),
            Self::Pauldron => trimmed(plate(texel, 0.0), ridge(at.y, 0.9, 0.08)),
            Self::UpperArm | Self::Thigh => mail(texel),
            Self::Forearm => forearm(at, texel),
            Self::Shin => greave(at, texel),
            Self::Foot => bands(at, texel),
            Self::Shield => shield(at, texel),
            Self::Sword => sword(at, texel),
        }
    }
}

/// 1 in the middle of a line of half width `half` at `center`, falling to 0 at its sides, smoothly.
fn ridge(at: f64, center: f64, half: f64) -> f64 {
    let away = ((at - center) / half).abs().min(1.0);
    let rest = 1.0 - away * away;
    rest * rest
}

/// 0 below `edge`, 1 above, smooth over `width`.
fn step(at: f64, edge: f64, width: f64) -> f64 {
    let share = ((at - edge) / width + 0.5).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

fn mixed(a: Paint, b: &Paint, share: f64) -> Paint {
    let mix = |a: f64, b: f64| a + (b - a) * share;
    Paint { color: a.color.lerp(b.color, share), height: mix(a.height, b.height), gloss: mix(a.gloss, b.gloss) }
}

/// Brushed steel with a few dents.
fn plate(texel: DVec2, raised: f64) -> Paint {
    let brushed = noise(dvec3(texel.x * 0.08, texel.y * 0.9, 3.0), 41);
    let dents = noise(dvec3(texel.x * 0.11, texel.y * 0.11, 7.0), 42);
    let dent = (dents - 0.45).max(0.0);
    Paint {
        color: STEEL * (1.0 + 0.05 * brushed - 0.25 * dent),
        height: 0.55 + raised - 0.35 * dent,
        gloss: 0.85 + 0.1 * brushed,
    }
}

/// A golden rim, raised.
fn trimmed(paint: Paint, share: f64) -> Paint {
    let height = paint.height + 0.2 * share;
    let gold = Paint { color: GOLD, height, gloss: 1.0 };
    let share = (3.0 * share).min(1.0);
    Paint { height, ..mixed(paint, &gold, share) }
}

/// Rivets in a row: at every `spacing` texels across, `down` texels from the top.
fn riveted(mut paint: Paint, texel: DVec2, down: f64, spacing: f64) -> Paint {
    let across = texel.x - spacing * ((texel.x / spacing).floor() + 0.5);
    let away = (dvec2(across, texel.y - down).length() / 2.2).min(1.0);
    paint.height += 0.3 * (1.0 - away * away).max(0.0);
    paint
}

/// Rings of wire in rows, every second one shifted.
fn mail(texel: DVec2) -> Paint {
    let row = (texel.y / 4.0).floor();
    let shift = if row.rem_euclid(2.0) < 0.5 { 0.0 } else { 2.0 };
    let column = ((texel.x + shift) / 4.0).floor();
    let in_ring = dvec2(texel.x + shift - 4.0 * (column + 0.5), texel.y - 4.0 * (row + 0.5));
    let wire = ridge(in_ring.length(), 1.6, 1.1);
    Paint { color: dvec3(0.20, 0.21, 0.24) + 0.3 * wire * STEEL, height: 0.25 + 0.4 * wire, gloss: 0.2 + 0.5 * wire }
}

fn cloth(texel: DVec2, color: DVec3) -> Paint {
    let weave = 0.5
        * (noise(dvec3(texel.x * 0.9, texel.y * 0.25, 1.0), 44) + noise(dvec3(texel.x * 0.25, texel.y * 0.9, 2.0), 45));
    let folds = noise(dvec3(texel.x * 0.07, texel.y * 0.015, 5.0), 46);
    Paint { color: color * (1.0 + 0.10 * weave), height: 0.4 + 0.06 * weave + 0.22 * folds, gloss: 0.05 }
}

/// Mail at the neck and the sides, a red tabard with half a golden cross in front, a belt.
fn trunk(at: DVec2, texel: DVec2) -> Paint {
    let chest = cloth(texel, RED);
    // The middle of the front is at 0: the cross is whole with its mirror image.
    let upright = step(0.13 - at.x, 0.0, 0.03) * step(at.y, 0.14, 0.03) * step(0.52 - at.y, 0.0, 0.03);
    let beam = step(0.36 - at.x, 0.0, 0.03) * ridge(at.y, 0.27, 0.075).powi(2).min(1.0);
    let cross = upright.max((2.0 * beam).min(1.0));
    let golden = Paint { color: GOLD, height: chest.height + 0.12, gloss: 0.35 };
    let mut paint = mixed(chest, &golden, cross);
    // The skirt's hem.
    let hem = step(at.y, 0.93, 0.02);
    paint = mixed(paint, &Paint { color: GOLD, height: 0.6, gloss: 0.4 }, hem);
    let belt = step(at.y, 0.53, 0.01) * step(0.62 - at.y, 0.0, 0.01);
    let grain = noise(dvec3(texel.x * 0.5, texel.y * 0.5, 0.0), 47);
    paint = mixed(paint, &Paint { color: LEATHER * (1.0 + 0.15 * grain), height: 0.75, gloss: 0.3 }, belt);
    let buckle = step(0.09 - at.x, 0.0, 0.02) * step(at.y, 0.515, 0.01) * step(0.635 - at.y, 0.0, 0.01);
    paint = mixed(paint, &Paint { color: GOLD, height: 0.95, gloss: 1.0 }, buckle);
    let collar = step(0.09 - at.y, 0.0, 0.02).max(step(at.x, 0.86, 0.03) * step(0.53 - at.y, 0.0, 0.02));
    mixed(paint, &mail(texel), collar)
}

/// A helmet with a slit for the eyes, holes to breathe through, a golden band in the middle.
fn helmet(at: DVec2, texel: DVec2) -> Paint {
    let mut paint = plate(texel, 0.0);
    // Forwards is at 0, backwards at 1.
    let visor = step(0.52 - at.x, 0.0, 0.03);
    let raised = visor * step(at.y, 0.30, 0.02) * step(0.88 - at.y, 0.0, 0.02);
    paint.height += 0.15 * raised;
    let slit = step(0.44 - at.x, 0.0, 0.02) * ridge(at.y, 0.43, 0.045).min(1.0);
    let dark = Paint { color: dvec3(0.02, 0.02, 0.03), height: 0.1, gloss: 0.0 };
    paint = mixed(paint, &dark, (2.0 * slit).min(1.0));
    for column in 0..3 {
        for row in 0..4 {
            let hole = dvec2(14.0 + 7.0 * f64::from(column), 54.0 + 7.0 * f64::from(row));
            let away = (texel - hole).length();
            paint = mixed(
                paint,
                &Paint { color: dvec3(0.03, 0.03, 0.04), height: 0.2, gloss: 0.1 },
                step(1.9 - away, 0.0, 1.0),
            );
        }
    }
    paint = riveted(paint, texel, 27.0, 12.0);
    paint = riveted(paint, texel, 86.0, 12.0);
    let band = step(0.06 - at.x, 0.0, 0.02).max(step(at.x, 0.94, 0.02));
    let clear = 1.0 - (2.0 * slit).min(1.0);
    trimmed(paint, 0.9 * band * clear)
}

fn plume(_: DVec2, texel: DVec2) -> Paint {
    let barbs = noise(dvec3(texel.x * 0.6 + texel.y * 0.25, texel.y * 0.05, 9.0), 48);
    Paint { color: RED * (1.15 + 0.35 * barbs), height: 0.5 + 0.35 * barbs, gloss: 0.1 }
}

/// A vambrace over leather, a gauntlet of narrow bands.
fn forearm(at: DVec2, texel: DVec2) -> Paint {
    if at.y > 0.62 {
        return bands(at, texel);
    }
    let paint = riveted(plate(texel, 0.05), texel, 34.0, 10.7);
    trimmed(paint, ridge(at.y, 0.10, 0.06).max(ridge(at.y, 0.58, 0.05)))
}

/// A plate over the shin with a ridge in front, and a golden knee.
fn greave(at: DVec2, texel: DVec2) -> Paint {
    let mut paint = plate(texel, 0.0);
    paint.height += 0.25 * ridge(at.x, 0.0, 0.12).max(ridge(at.x, 1.0, 0.12));
    paint = riveted(paint, texel, 56.0, 10.7);
    trimmed(paint, ridge(at.y, 0.14, 0.05).max(ridge(at.y, 0.30, 0.05)))
}

/// Overlapping bands of steel, each higher at its lower edge.
fn bands(_: DVec2, texel: DVec2) -> Paint {
    let share = (texel.y / 7.0).fract();
    let paint = plate(texel, 0.0);
    Paint { color: paint.color * (0.85 + 0.15 * share), height: 0.3 + 0.45 * share, ..paint }
}

/// Quarters of red and gold with a boss, and a rim with rivets. The face that looks outwards is around 3/4.
fn shield(at: DVec2, texel: DVec2) -> Paint {
    let wood = noise(dvec3(texel.x * 0.4, texel.y * 0.04, 0.0), 49);
    let across = at.x - 0.25;
    let is_red = (across < 0.0) == (at.y < 0.45);
    let color = if is_red { RED } else { GOLD * 0.9 };
    let base = Paint { color: color * (1.0 + 0.08 * wood), height: 0.45 + 0.08 * wood, gloss: 0.25 };
    let boss = ((at - dvec2(0.25, 0.45)) * dvec2(64.0, 112.0)).length() / 8.0;
    let dome = (1.0 - boss * boss).max(0.0).sqrt();
    let mut paint = mixed(base, &Paint { height: 0.5 + 0.45 * dome, ..plate(texel, 0.0) }, step(1.0 - boss, 0.0, 0.15));
    let rim =
        ridge(at.x, 0.5, 0.06).max(ridge(at.x, 0.0, 0.06)).max(ridge(at.x, 1.0, 0.06)).max(ridge(at.y, 0.08, 0.05));
    let metal = plate(texel, 0.25);
    paint = mixed(paint, &metal, (3.0 * rim).min(1.0));
    let inside = step(at.x, 0.53, 0.01) * step(0.97 - at.x, 0.0, 0.01);
    let back = Paint { color: LEATHER * (1.0 + 0.2 * wood), height: 0.4 + 0.1 * wood, gloss: 0.1 };
    mixed(paint, &back, inside)
}

/// Pommel, grip, guard and a blade with a groove.
fn sword(at: DVec2, texel: DVec2) -> Paint {
    let gold = || Paint { color: GOLD, height: 0.6, gloss: 1.0 };
    if at.y < 0.11 {
        return gold();
    }
    if at.y < 0.22 {
        let wound = ((texel.y + 0.5 * texel.x) / 2.5).fract();
        return Paint { color: LEATHER, height: 0.3 + 0.4 * ridge(wound, 0.5, 0.5), gloss: 0.15 };
    }
    if at.y < 0.28 {
        return gold();
    }
    let groove = ridge(at.x, 0.25, 0.10).max(ridge(at.x, 0.75, 0.10));
    let paint = plate(texel, 0.0);
    Paint { color: paint.color * (1.1 - 0.15 * groove), height: 0.6 - 0.35 * groove, gloss: 1.0 }
}

/// The paint of each texel, as the mean of 3×3 samples.
fn painted() -> Vec<Paint> {
    let mut texels = Vec::new();
    for (y, x) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (y, x))) {
        let holds = |[left, top, width, height]: [u32; 4]| {
            (left..left + width).contains(&x) && (top..top + height).contains(&y)
        };
        let found = PLACES.iter().find(|(_, place)| holds(*place));
        let mut sum = Paint { color: DVec3::ZERO, height: 0.0, gloss: 0.0 };
        if let Some((region, [left, top, width, height])) = found {
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                let inner = dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5) / 3.0;
                let at = dvec2(f64::from(x - left), f64::from(y - top)) + inner;
                let paint = region.paint(at / dvec2(f64::from(*width), f64::from(*height)));
                sum.color += paint.color / 9.0;
                sum.height += paint.height.clamp(0.0, 1.0) / 9.0;
                sum.gloss += paint.gloss.clamp(0.0, 1.0) / 9.0;
            }
        }
        texels.push(sum);
    }
    texels
}

/// Colours, heights and gloss.
pub fn skins() -> (RgbImage, GrayImage, GrayImage) {
    let paints = painted();
    let at = |x: u32, y: u32| &paints[(y * SIZE + x) as usize];
    let code = |value: f64| (255.0 * value.clamp(0.0, 1.0) + 0.5).floor() as u8;
    let colors = RgbImage::from_fn(SIZE, SIZE, |x, y| image::Rgb(at(x, y).color.to_array().map(code)));
    let heights = GrayImage::from_fn(SIZE, SIZE, |x, y| Luma([code(at(x, y).height)]));
    let gloss = GrayImage::from_fn(SIZE, SIZE, |x, y| Luma([code(at(x, y).gloss)]));
    (colors, heights, gloss)
}
