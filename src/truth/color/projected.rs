//! Pictures that are projected: GL's filters in f64, with bounds over the texels that a sample may meet.

use std::borrow::Cow;
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
    let (low, high) = ((at - reach).floor(), (at + reach).ceil());
    let mut bounds = value.to_array().map(Bounds::exactly);
    let mut y = low.y;
    while y <= high.y {
        let mut x = low.x;
        while x <= high.x {
            let color = texel(texture, wrap, x, y);
            bounds = widened(bounds, color);
            x += 1.0;
        }
        y += 1.0;
    }
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
    let mut bounds = value.to_array().map(Bounds::exactly);
    let mut y = sides[0].y;
    while y <= sides[1].y {
        let mut x = sides[0].x;
        while x <= sides[1].x {
            let color = texel(texture, Wrapped::Clamped, x, y);
            bounds = widened(bounds, color);
            x += 1.0;
        }
        y += 1.0;
    }
    if sides[0] == sides[1] { bounds } else { bounds.map(Bounds::jumping) }
}

/// The bounds, with a colour in them.
fn widened(bounds: [Bounds; 3], color: DVec3) -> [Bounds; 3] {
    let color = color.to_array();
    [0, 1, 2].map(|k: usize| {
        let Bounds { least, value, most, .. } = bounds[k];
        Bounds::around(value, [least, most, color[k]])
    })
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
