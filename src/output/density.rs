//! Texels per pixel as colours with a legend [HSM, Figure 6]: green where a pixel shows one texel, warm where texels are
//! larger than pixels, cold where they are smaller.

use super::canvas::{Canvas, Color, LINE, text_width};

/// Colours from 1/8 to 8 texels, one a factor of 2.
const SCALE: [Color; 7] =
    [[128, 18, 32], [214, 62, 44], [246, 178, 66], [102, 178, 92], [56, 150, 186], [50, 84, 176], [76, 42, 130]];
/// The legend's words for a density of 1.
pub const ONE: &str = "1 texel a pixel";
const OUTSIDE: Color = [30, 32, 38];

/// Interpolates between the two nearest colours, by the logarithm.
fn color(texels: f32) -> Color {
    let at = (texels.max(f32::MIN_POSITIVE).log2() + 3.0).clamp(0.0, 6.0);
    let (low, part) = (at.floor(), at.fract());
    let (a, b) = (SCALE[low as usize], SCALE[(low as usize + 1).min(6)]);
    std::array::from_fn(|k| (f32::from(a[k]) + part * (f32::from(b[k]) - f32::from(a[k]))).round() as u8)
}

/// The picture of such a view, `size` pixels, rows from the top, without a legend.
pub fn plain(size: [u32; 2], data: &[f32]) -> Canvas {
    let mut canvas = Canvas::new(size, OUTSIDE);
    for (index, pixel) in (0u32..).zip(data.chunks_exact(4)).filter(|(_, pixel)| pixel[3] > 0.0) {
        canvas.set([index % size[0], index / size[0]], color(pixel[0]));
    }
    canvas
}

/// Colours and their words; `one` is what a density of 1 is called.
pub fn legend(one: &str) -> [(Color, &str); 7] {
    let names = ["1/8 and less", "1/4", "1/2", one, "2", "4", "8 and more"];
    std::array::from_fn(|row| (SCALE[row], names[row]))
}

/// The same with a legend; `one` is what the legend calls a density of 1. Small pictures go without.
pub fn colored(size: [u32; 2], data: &[f32], one: &str) -> Canvas {
    const SWATCH: u32 = 10;
    let mut canvas = plain(size, data);
    let names = legend(one);
    let longest = names.iter().map(|(_, name)| text_width(name)).max().unwrap_or(0);
    let (width, height) = (SWATCH + 18 + longest, LINE * names.len() as u32 + 8);
    if width + 8 > size[0] || height + 8 > size[1] {
        return canvas;
    }
    let [left, top] = emptiest_corner(size, data, [width, height]);
    canvas.fill([left, top], [width, height], [24, 26, 30]);
    for (row, (swatch, name)) in (0u32..).zip(names) {
        let top = top + 6 + LINE * row;
        canvas.fill([left + 6, top], [SWATCH, SWATCH], swatch);
        canvas.write([left + 6 + SWATCH + 6, top - 2], name, [230, 230, 230]);
    }
    canvas
}

/// Corner where a `room` four pixels from the edges hides the least of the picture; upper left among equals.
fn emptiest_corner(size: [u32; 2], data: &[f32], room: [u32; 2]) -> [u32; 2] {
    let hidden = |[left, top]: &[u32; 2]| -> usize {
        let row = |y: u32| {
            let first = (y * size[0] + left) as usize;
            data.chunks_exact(4).skip(first).take(room[0] as usize).filter(|pixel| pixel[3] > 0.0).count()
        };
        (*top..top + room[1]).map(row).sum()
    };
    let ([right, bottom], edge) = ([size[0] - room[0] - 4, size[1] - room[1] - 4], 4);
    let corners = [[edge, edge], [right, edge], [edge, bottom], [right, bottom]];
    corners.into_iter().min_by_key(hidden).unwrap_or([edge; 2])
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
    #[test]
    fn the_legend_stands_where_nothing_is_seen() {
        const SIZE: [u32; 2] = [400, 300];
        for empty in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let seen = |x: u32, y: u32| [x / 200, y / 150] != empty;
            let pixel = |i: u32| [1.0, 0.0, 0.0, f32::from(u8::from(seen(i % SIZE[0], i / SIZE[0])))];
            let data: Vec<f32> = (0..SIZE[0] * SIZE[1]).flat_map(pixel).collect();
            let shown = colored(SIZE, &data, ONE);
            let at = |x: u32, y: u32| &shown.bytes()[3 * (y * SIZE[0] + x) as usize..][..3];
            let kept = |(x, y): (u32, u32)| !seen(x, y) || at(x, y) == color(1.0);
            assert!((0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).all(kept), "{empty:?}");
        }
    }
}
