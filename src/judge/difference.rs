//! The truth, and a picture's differences from it, as pictures.
//!
//! Greys show the truth, darker for less light; only errors have a colour. The colours are of the set that Okabe and Ito
//! chose to be distinguishable with any colour vision, and differ in lightness from the grey below.

use image::{Rgb, RgbImage};

use super::metrics::{Error, check_size, is_lit};
use crate::frame::ShadeImage;
use crate::truth::{Answer, Pixel, Truth};

/// Colour where nothing is drawn.
pub const BACKGROUND: [u8; 3] = [0x12, 0x12, 0x16];
/// Colour of surfaces outside the light's cone or frustum.
pub const OUTSIDE_CONE: [u8; 3] = [0x32, 0x32, 0x3a];
/// Colour of shadow that both have.
pub const SHADOWED: [u8; 3] = [0x60, 0x60, 0x68];
/// Colour where the ray tracer is not certain.
pub const AMBIGUOUS: [u8; 3] = [0xa6, 0xa6, 0xa6];
/// Colour of light that both have.
pub const LIT: [u8; 3] = [0xf2, 0xf2, 0xf2];
/// Colour of shadow where light belongs.
pub const FALSE_SHADOW: [u8; 3] = [0x00, 0x72, 0xb2];
/// Colour of light where shadow belongs.
pub const LEAK: [u8; 3] = [0xe6, 0x9f, 0x00];
/// Colour where only the truth, or only the picture, has a surface in the light.
pub const NOT_COMPARED: [u8; 3] = [0xcc, 0x79, 0xa7];

/// The colours that only a difference has, then those it shares with the truth.
pub const LEGEND: [([u8; 3], &str); 8] = [
    (FALSE_SHADOW, "false shadow"),
    (LEAK, "leak"),
    (NOT_COMPARED, "in the light in only one of the two"),
    (LIT, "lit"),
    (AMBIGUOUS, "ambiguous"),
    (SHADOWED, "shadowed"),
    (OUTSIDE_CONE, "outside the light"),
    (BACKGROUND, "nothing there"),
];

/// Picture of the ray tracer's answer for each pixel.
pub fn truth_picture(truth: &Truth) -> RgbImage {
    paint(truth, |_, pixel| true_color(pixel))
}

/// A shade as a picture: from black, shadow, to white, light; [`BACKGROUND`] where nothing is drawn.
pub fn shade_picture(shade: &ShadeImage) -> RgbImage {
    RgbImage::from_fn(shade.width, shade.height, |x, y| {
        let index = y as usize * shade.width as usize + x as usize;
        let gray = shade.shade.get(index).map_or(0, |value| (255.0 * value).round() as u8);
        Rgb(if shade.covered.get(index) == Some(&true) { [gray; 3] } else { BACKGROUND })
    })
}

/// The truth, and over it the picture's errors.
///
/// # Errors
///
/// A picture of another size.
pub fn difference_picture(truth: &Truth, shade: &ShadeImage) -> Result<RgbImage, Error> {
    check_size(truth, shade)?;
    Ok(paint(truth, |index, pixel| match (pixel.answer, shade.covered[index]) {
        (Answer::Ambiguous(_), _) => AMBIGUOUS,
        (Answer::Background, true) | (Answer::Lit | Answer::Shadowed, false) => NOT_COMPARED,
        // Unknown: a surface that shows no light.
        (_, true) if shade.shade[index].is_nan() => true_color(pixel),
        (Answer::Lit, true) if !is_lit(shade.shade[index]) => FALSE_SHADOW,
        (Answer::Shadowed, true) if is_lit(shade.shade[index]) => LEAK,
        _ => true_color(pixel),
    }))
}

fn true_color(pixel: &Pixel) -> [u8; 3] {
    match pixel.answer {
        Answer::Background => BACKGROUND,
        Answer::OutsideCone => OUTSIDE_CONE,
        Answer::Lit => LIT,
        Answer::Shadowed => SHADOWED,
        Answer::Ambiguous(_) => AMBIGUOUS,
    }
}

fn paint(truth: &Truth, color: impl Fn(usize, &Pixel) -> [u8; 3]) -> RgbImage {
    RgbImage::from_fn(truth.width, truth.height, |x, y| {
        let index = y as usize * truth.width as usize + x as usize;
        Rgb(truth.pixels.get(index).map_or(BACKGROUND, |pixel| color(index, pixel)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Reason;

    fn truth(answers: &[Answer]) -> Truth {
        let pixel = |&answer: &Answer| Pixel { answer, lit_at_center: None, hit: None };
        Truth { width: answers.len() as u32, height: 1, pixels: answers.iter().map(pixel).collect() }
    }

    fn shade(values: &[Option<f32>]) -> ShadeImage {
        ShadeImage {
            width: values.len() as u32,
            height: 1,
            shade: values.iter().map(|value| value.unwrap_or(0.0)).collect(),
            covered: values.iter().map(Option::is_some).collect(),
        }
    }

    #[test]
    fn each_kind_of_pixel_has_its_color() {
        let unsure = Answer::Ambiguous(Reason::ShadowEdge);
        let cases = [
            (Answer::Background, None, BACKGROUND),
            (Answer::Background, Some(1.0), NOT_COMPARED),
            (Answer::OutsideCone, Some(0.0), OUTSIDE_CONE),
            (Answer::OutsideCone, None, OUTSIDE_CONE),
            (Answer::Lit, Some(f32::NAN), LIT),
            (Answer::Lit, Some(1.0), LIT),
            (Answer::Lit, Some(0.4), FALSE_SHADOW),
            (Answer::Lit, None, NOT_COMPARED),
            (Answer::Shadowed, Some(0.4), SHADOWED),
            (Answer::Shadowed, Some(0.5), LEAK),
            (unsure, Some(1.0), AMBIGUOUS),
        ];
        let picture = difference_picture(&truth(&cases.map(|case| case.0)), &shade(&cases.map(|case| case.1))).unwrap();
        for (x, (answer, value, color)) in cases.into_iter().enumerate() {
            assert_eq!(picture.get_pixel(x as u32, 0).0, color, "{answer:?} drawn as {value:?}");
        }
    }

    #[test]
    fn no_two_colors_of_the_legend_are_alike() {
        for (index, (color, name)) in LEGEND.iter().enumerate() {
            for (other, other_name) in &LEGEND[index + 1..] {
                let distance: u32 = color.iter().zip(other).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
                assert!(distance >= 60, "{name} and {other_name}");
            }
        }
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        assert!(difference_picture(&truth(&[Answer::Lit]), &shade(&[None, None])).is_err());
    }
}
