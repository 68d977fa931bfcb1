//! FLIP, the difference that a viewer sees where two pictures alternate in one place [Andersson 2020]: it knows what an eye
//! at the usual distance from a screen resolves, and weighs edges and points. The library is the authors' own.

use image::{Rgb, RgbImage};

/// FLIP of each pixel, in [0, 1], row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width * height` values; 0: no difference.
    pub values: Vec<f32>,
}

/// The largest picture, in pixels. The library keeps some hundred bytes a pixel, and ends the process without memory.
pub const MOST_PIXELS: u64 = 1 << 24;

/// Value from which a picture of a map has the brightest colour. Most differences lie far below 1.
pub const BRIGHTEST: f32 = 0.25;

/// True if FLIP is compiled in: cargo feature `flip`.
pub const HAS_FLIP: bool = cfg!(feature = "flip");

/// Compares a picture with its reference, seen from 0.7 m on a screen of 0.7 m and 3840 pixels width. `None`: the pictures
/// differ in size, are empty, have more than [`MOST_PIXELS`], or FLIP is not compiled in ([`HAS_FLIP`]).
pub fn flip(reference: &RgbImage, picture: &RgbImage) -> Option<FlipMap> {
    let (width, height) = picture.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    if reference.dimensions() != (width, height) || pixels == 0 || pixels > MOST_PIXELS {
        return None;
    }
    Some(FlipMap { width, height, values: values(reference, picture)? })
}

#[cfg(feature = "flip")]
fn values(reference: &RgbImage, picture: &RgbImage) -> Option<Vec<f32>> {
    let image = |image: &RgbImage| nv_flip::FlipImageRgb8::with_data(image.width(), image.height(), image.as_raw());
    Some(nv_flip::flip(image(reference), image(picture), nv_flip::DEFAULT_PIXELS_PER_DEGREE).to_vec())
}

#[cfg(not(feature = "flip"))]
fn values(_: &RgbImage, _: &RgbImage) -> Option<Vec<f32>> {
    None
}

impl FlipMap {
    /// The mean over all pixels, in [0, 1].
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|value| f64::from(*value)).sum::<f64>() / self.values.len().max(1) as f64
    }

    /// The map in colours, [`BRIGHTEST`] and more in the brightest.
    pub fn picture(&self) -> RgbImage {
        let colors = colors();
        RgbImage::from_fn(self.width, self.height, |x, y| {
            let index = y as usize * self.width as usize + x as usize;
            Rgb(self.values.get(index).map_or([0; 3], |value| color_of(&colors, *value)))
        })
    }
}

/// Colours of some values of FLIP, for a legend: from none to [`BRIGHTEST`], which stands for more, too.
pub fn legend() -> Vec<([u8; 3], f32)> {
    let colors = colors();
    let steps = 5_u8;
    let values = (0..=steps).map(|step| BRIGHTEST * f32::from(step) / f32::from(steps));
    values.map(|value| (color_of(&colors, value), value)).collect()
}

/// The colour map "magma", from black to a light yellow.
#[cfg(feature = "flip")]
fn colors() -> Vec<[u8; 3]> {
    nv_flip::magma_lut().to_vec().as_chunks::<3>().0.to_vec()
}

/// Black to white, for maps that were made elsewhere.
#[cfg(not(feature = "flip"))]
fn colors() -> Vec<[u8; 3]> {
    (0..=255).map(|code| [code; 3]).collect()
}

fn color_of(colors: &[[u8; 3]], value: f32) -> [u8; 3] {
    let place = (value / BRIGHTEST).clamp(0.0, 1.0) * colors.len().saturating_sub(1) as f32;
    colors.get(place.round() as usize).copied().unwrap_or_default()
}

#[cfg(all(test, feature = "flip"))]
mod tests {
    use super::*;

    fn gray(size: u32, of: impl Fn(u32, u32) -> u8) -> RgbImage {
        RgbImage::from_fn(size, size, |x, y| Rgb([of(x, y); 3]))
    }

    #[test]
    fn equal_pictures_do_not_differ_and_black_differs_from_white_everywhere() {
        let noise = gray(40, |x, y| (37 * x + 91 * y) as u8);
        assert!(flip(&noise, &noise).unwrap().mean() < 1e-6);
        let [black, white] = [0, 255].map(|code| gray(40, |_, _| code));
        assert!(flip(&black, &white).unwrap().mean() > 0.9);
    }

    /// The published behaviour that RMSE lacks: a checker of single pixels melts into grey at 67 pixels a degree, one of large
    /// squares does not. Both have the same RMSE.
    #[test]
    fn detail_that_no_eye_resolves_counts_less() {
        let even = gray(96, |_, _| 128);
        let checker =
            |square: u32| gray(96, |x, y| if (x / square + y / square).is_multiple_of(2) { 118 } else { 138 });
        let [fine, coarse] = [1, 24].map(|square| flip(&even, &checker(square)).unwrap().mean());
        assert!(fine < 0.5 * coarse, "{fine} {coarse}");
    }

    #[test]
    fn sizes_that_do_not_fit_have_no_map() {
        assert_eq!(flip(&RgbImage::new(3, 4), &RgbImage::new(4, 3)), None);
        assert_eq!(flip(&RgbImage::new(0, 0), &RgbImage::new(0, 0)), None);
    }

    #[test]
    fn the_legend_goes_from_black_to_the_brightest() {
        let map = FlipMap { width: 3, height: 1, values: vec![0.0, BRIGHTEST, 1.0] };
        let picture = map.picture();
        let legend = legend();
        assert_eq!(picture.get_pixel(0, 0).0, legend[0].0);
        assert_eq!(picture.get_pixel(1, 0).0, legend.last().unwrap().0);
        assert_eq!(picture.get_pixel(2, 0), picture.get_pixel(1, 0));
        let brightness = |color: &[u8; 3]| color.iter().map(|channel| u32::from(*channel)).sum::<u32>();
        assert!(legend.windows(2).all(|pair| brightness(&pair[0].0) < brightness(&pair[1].0)), "{legend:?}");
    }
}
