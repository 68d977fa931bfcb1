//! Texels per pixel as colours with a legend [Hardware Shadow Mapping, Fig. 6; techniques A17]: green where a pixel shows
//! one texel, warm where texels are larger than pixels and are seen, cold where they are smaller and are lost.

use super::canvas::{Canvas, Color, LETTER};

/// Colours from 1/8 to 8 texels, one a factor of 2.
const SCALE: [Color; 7] =
    [[128, 18, 32], [214, 62, 44], [246, 178, 66], [102, 178, 92], [56, 150, 186], [50, 84, 176], [76, 42, 130]];
const NAMES: [&str; 7] = ["1/8 and less", "1/4", "1/2", "1 texel a pixel", "2", "4", "8 and more"];
const OUTSIDE: Color = [30, 32, 38];

/// Between the two nearest colours, by the logarithm.
fn color(texels: f32) -> Color {
    let at = (texels.max(f32::MIN_POSITIVE).log2() + 3.0).clamp(0.0, 6.0);
    let (low, part) = (at.floor(), at.fract());
    let (a, b) = (SCALE[low as usize], SCALE[(low as usize + 1).min(6)]);
    std::array::from_fn(|k| (f32::from(a[k]) + part * (f32::from(b[k]) - f32::from(a[k]))).round() as u8)
}

/// The picture of such a view, `size` pixels, rows from the top; small pictures go without a legend.
pub fn colored(size: [u32; 2], data: &[f32]) -> Canvas {
    const SWATCH: u32 = 10;
    const STEP: u32 = LETTER[1] + 4;
    let mut canvas = Canvas::new(size, OUTSIDE);
    for (index, pixel) in (0u32..).zip(data.chunks_exact(4)).filter(|(_, pixel)| pixel[3] > 0.0) {
        canvas.set([index % size[0], index / size[0]], color(pixel[0]));
    }
    let longest = NAMES.iter().map(|name| name.len() as u32).max().unwrap_or(0);
    let (width, height) = (SWATCH + 18 + longest * LETTER[0], STEP * NAMES.len() as u32 + 8);
    if width + 8 > size[0] || height + 8 > size[1] {
        return canvas;
    }
    canvas.fill([4, 4], [width, height], [24, 26, 30]);
    for (row, (swatch, name)) in (0u32..).zip(SCALE.iter().zip(NAMES)) {
        let top = 10 + STEP * row;
        canvas.fill([10, top], [SWATCH, SWATCH], *swatch);
        canvas.write([10 + SWATCH + 6, top], name, [230, 230, 230]);
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_have_their_colours_and_all_else_lies_between() {
        for (index, expected) in SCALE.iter().enumerate() {
            assert_eq!(color((index as f32 - 3.0).exp2()), *expected);
        }
        assert_eq!([color(0.0), color(1e9)], [SCALE[0], SCALE[6]]);
        let between = color(2.0_f32.powf(0.5));
        assert!((0..3).all(|k| between[k].abs_diff(SCALE[3][k]).abs_diff(between[k].abs_diff(SCALE[4][k])) <= 1));
    }
}
