//! Pictures that are projected: GL's filters in f64, with bounds over the texels that a sample may meet.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

use glam::{DVec2, DVec3};

use super::bounds::Bounds;
use crate::geometry::Texture;

/// Texels a side beyond which a picture's own extremes are the bounds.
const MOST_TEXELS: f64 = 96.0;

/// Texels around a sample whose contrast bounds it: half of one is the filter's own reach, a quarter is doubt.
const REACH: f64 = 0.75;

/// Beyond the picture.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Wrapped {
    Repeated,
    Clamped,
}

/// A picture, and the least and the greatest of its texels once they are known.
pub(super) struct Picture<'a> {
    texture: Cow<'a, Texture>,
    extremes: OnceLock<(DVec3, DVec3)>,
}

impl<'a> Picture<'a> {
    pub fn new(texture: &'a Texture) -> Self {
        Self { texture: Cow::Borrowed(texture), extremes: OnceLock::new() }
    }

    /// One channel of a picture, as a grey one.
    pub fn of_channel(texture: &Texture, channel: usize) -> Self {
        let rgba = texture.rgba.as_chunks::<4>().0.iter().flat_map(|texel| [texel[channel]; 4]).collect();
        let grey = Texture { name: texture.name.clone(), rgba, ..*texture };
        Self { texture: Cow::Owned(grey), extremes: OnceLock::new() }
    }

    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.texture.width), f64::from(self.texture.height))
    }

    /// The value, and the picture's own extremes as bounds.
    fn any(&self, value: DVec3) -> [Bounds; 3] {
        let (least, most) = self.extremes.get_or_init(|| extremes(&self.texture));
        [0, 1, 2].map(|k| Bounds::around(value[k], [least[k], most[k]]).jumping())
    }
}

/// A place in a picture.
pub(super) struct Place {
    pub st: DVec2,
    /// How far it may be off.
    pub error: DVec2,
    /// How far it moves from a pixel to those to the right and above.
    pub pixel: [DVec2; 2],
}

/// The linearly filtered colour at a place, and its bounds; with `mipmapped`, over the texels of a pixel's footprint.
pub(super) fn window(picture: &Picture<'_>, wrap: Wrapped, place: &Place, mipmapped: bool) -> [Bounds; 3] {
    let (size, texture) = (picture.size(), &*picture.texture);
    let footprint = place.pixel.map(|step| step * size);
    let widest = footprint[0].length().max(footprint[1].length());
    // A filter of mipmaps averages texels up to twice as wide as the footprint, two of them each way.
    let averages = mipmapped && widest > 0.9;
    let reach = if averages { DVec2::splat(4.0 * widest + 2.0) } else { DVec2::splat(REACH) };
    let reach = reach + place.error * size;
    let at = place.st * size - 0.5;
    let value = bilinear(texture, wrap, at);
    if !reach.is_finite() || reach.max_element() * 2.0 >= MOST_TEXELS {
        return picture.any(value);
    }
    let bounds = around(value, texture, wrap, [(at - reach).floor(), (at + reach).ceil()]);
    if averages { bounds.map(Bounds::jumping) } else { bounds }
}

/// The colour of the texel that holds the place, and bounds over those that may.
pub(super) fn nearest(picture: &Picture<'_>, place: &Place) -> [Bounds; 3] {
    let (size, texture) = (picture.size(), &*picture.texture);
    let (at, error) = (place.st * size, place.error * size + 1.0 / 128.0);
    let value = texel(texture, Wrapped::Clamped, at.x.floor(), at.y.floor());
    let sides = [at - error, at + error].map(DVec2::floor);
    if (sides[1] - sides[0]).max_element() > MOST_TEXELS {
        return picture.any(value);
    }
    let bounds = around(value, texture, Wrapped::Clamped, sides);
    if sides[0] == sides[1] { bounds } else { bounds.map(Bounds::jumping) }
}

/// A value, with bounds that hold it and the texels from the first to the last, both included.
fn around(value: DVec3, texture: &Texture, wrap: Wrapped, ends: [DVec2; 2]) -> [Bounds; 3] {
    let codes = code_ranges(texture, wrap, ends);
    [0, 1, 2].map(|k| match codes {
        Some([least, most]) => Bounds::around(value[k], [least[k], most[k]].map(|code| f64::from(code) / 255.0)),
        None => Bounds::exactly(value[k]),
    })
}

/// The least and the greatest codes of the texels from the first to the last, both included, by channel. `None`: there are
/// none.
fn code_ranges(texture: &Texture, wrap: Wrapped, [first, last]: [DVec2; 2]) -> Option<[[u8; 4]; 2]> {
    if !(first.is_finite() && last.cmpge(first).all()) {
        return None;
    }
    let width = texture.width as usize;
    let [columns, rows] = [(first.x, last.x, texture.width), (first.y, last.y, texture.height)]
        .map(|(first, last, count)| runs(wrap, [first, last], count));
    let (mut least, mut most) = ([u8::MAX; 16], [u8::MIN; 16]);
    for row in rows.into_iter().flatten() {
        for run in columns.clone() {
            let texels = texture.rgba.get(4 * (row * width + run.start)..4 * (row * width + run.end));
            // A picture that is cut off is black there.
            let (fours, rest) = texels.unwrap_or(&[0; 4]).as_chunks::<16>();
            // A loop of known length: the compiler takes all sixteen codes at once.
            for four in fours {
                for k in 0..16 {
                    (least[k], most[k]) = (least[k].min(four[k]), most[k].max(four[k]));
                }
            }
            for (k, code) in rest.iter().enumerate() {
                (least[k], most[k]) = (least[k].min(*code), most[k].max(*code));
            }
        }
    }
    let of_channel = |codes: [u8; 16], pick: fn(u8, u8) -> u8| {
        [0, 1, 2, 3].map(|k: usize| [4, 8, 12].into_iter().fold(codes[k], |code, four| pick(code, codes[four + k])))
    };
    Some([of_channel(least, u8::min), of_channel(most, u8::max)])
}

/// The one or two runs of `count` texels that those from the first to the last lie in.
fn runs(wrap: Wrapped, [first, last]: [f64; 2], count: u32) -> [Range<usize>; 2] {
    let end = count as usize;
    if wrap == Wrapped::Clamped {
        let [first, last] = [first, last].map(|at| at.clamp(0.0, f64::from(count - 1)) as usize);
        return [first..last + 1, 0..0];
    }
    let (start, length) = (first.rem_euclid(f64::from(count)) as usize, (last - first) as usize + 1);
    if length >= end {
        return [0..end, 0..0];
    }
    [start..(start + length).min(end), 0..(start + length).saturating_sub(end)]
}

/// GL's linear filter [GL 4.6, 8.14.2]; `at` in texels, texel 0 at 0.
fn bilinear(picture: &Texture, wrap: Wrapped, at: DVec2) -> DVec3 {
    let (first, part) = (at.floor(), at - at.floor());
    let mut color = DVec3::ZERO;
    for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let weight = |d: f64, part: f64| if d == 0.0 { 1.0 - part } else { part };
        color += weight(dx, part.x) * weight(dy, part.y) * texel(picture, wrap, first.x + dx, first.y + dy);
    }
    color
}

fn texel(picture: &Texture, wrap: Wrapped, x: f64, y: f64) -> DVec3 {
    let index = |at: f64, count: u32| match wrap {
        Wrapped::Repeated => at.rem_euclid(f64::from(count)) as usize,
        Wrapped::Clamped => at.clamp(0.0, f64::from(count - 1)) as usize,
    };
    let place = 4 * (index(y, picture.height) * picture.width as usize + index(x, picture.width));
    let channel = |k: usize| picture.rgba.get(place + k).copied().map_or(0.0, |code| f64::from(code) / 255.0);
    DVec3::new(channel(0), channel(1), channel(2))
}

fn extremes(picture: &Texture) -> (DVec3, DVec3) {
    let colors =
        picture.rgba.chunks_exact(4).map(|texel| DVec3::from_array([0, 1, 2].map(|k| f64::from(texel[k]) / 255.0)));
    colors.fold((DVec3::ONE, DVec3::ZERO), |(least, most), color| (least.min(color), most.max(color)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ranges of whole runs of texels are those of a look at each, beyond the picture too.
    #[test]
    fn ranges_are_those_of_each_texel() {
        let mut random = fastrand::Rng::with_seed(11);
        for (width, height) in [(1, 1), (3, 2), (16, 7), (33, 40)] {
            let rgba = (0..4 * width * height).map(|_| random.u8(..)).collect();
            let texture = Texture { name: String::new(), width, height, rgba, has_alpha: false };
            for wrap in [Wrapped::Repeated, Wrapped::Clamped] {
                for _ in 0..200 {
                    let first = DVec2::new(f64::from(random.i32(-50..50)), f64::from(random.i32(-50..50)));
                    let size = [(); 2].map(|()| random.i32(0..40));
                    let last = first + DVec2::new(f64::from(size[0]), f64::from(size[1]));
                    let (mut least, mut most) = (DVec3::ONE, DVec3::ZERO);
                    for (x, y) in (0..=size[1]).flat_map(|y| (0..=size[0]).map(move |x| (x, y))) {
                        let color = texel(&texture, wrap, first.x + f64::from(x), first.y + f64::from(y));
                        (least, most) = (least.min(color), most.max(color));
                    }
                    let found = code_ranges(&texture, wrap, [first, last]).unwrap();
                    let found = found.map(|codes| DVec3::from_array([0, 1, 2].map(|k| f64::from(codes[k]) / 255.0)));
                    assert_eq!(found, [least, most], "{first} to {last} of {width} x {height}");
                }
            }
        }
        let texture = Texture { name: String::new(), width: 1, height: 1, rgba: vec![9; 4], has_alpha: false };
        let far = DVec2::splat(1e300);
        assert_eq!(code_ranges(&texture, Wrapped::Repeated, [far, far]), Some([[9; 4]; 2]));
        assert_eq!(code_ranges(&texture, Wrapped::Repeated, [DVec2::NAN, far]), None);
    }
}
