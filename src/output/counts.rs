//! Stencil counts as colours with a legend [GDC, "Visualizing Stenciled Shadow Volume Tagging"]: green lit, red shadowed,
//! the deeper the darker; violet below 0, likewise.

use super::canvas::{Canvas, Color, LINE, text_width};

const LIT: Color = [66, 148, 82];
const SHADOWED: [Color; 6] = [[240, 120, 96], [222, 78, 62], [196, 44, 42], [160, 26, 36], [120, 16, 32], [84, 10, 28]];
/// Colours from -1 down.
const BELOW_ZERO: [Color; 4] = [[196, 140, 236], [150, 70, 200], [98, 44, 164], [56, 26, 112]];

/// The colour of a count modulo 256; from 128 on it is read as negative.
fn color(count: u8) -> Color {
    match count {
        0 => LIT,
        1..=127 => SHADOWED[usize::from(count - 1).min(SHADOWED.len() - 1)],
        _ => BELOW_ZERO[usize::from(255 - count).min(BELOW_ZERO.len() - 1)],
    }
}

/// A row in the legend: its colour, its words, how many pixels have it.
fn rows(data: &[u8]) -> Vec<(Color, String, usize)> {
    let count = |from: u8, to: u8| data.iter().filter(|value| (from..=to).contains(*value)).count();
    let mut rows = vec![(LIT, String::from("0 lit"), count(0, 0))];
    rows.extend((1..6u8).map(|value| (color(value), format!("{value}"), count(value, value))));
    rows.push((color(6), String::from("6 and more"), count(6, 127)));
    rows.extend(
        (253..=255u8).rev().map(|value| (color(value), format!("-{}", 256 - u16::from(value)), count(value, value))),
    );
    rows.push((color(252), String::from("-4 and less"), count(128, 252)));
    rows.retain(|(_, _, pixels)| *pixels > 0);
    rows
}

/// The picture of a stencil buffer, `size` pixels, rows from the top, without a legend.
pub fn plain(size: [u32; 2], data: &[u8]) -> Canvas {
    let mut canvas = Canvas::new(size, [0; 3]);
    for (index, value) in (0u32..).zip(data) {
        canvas.set([index % size[0], index / size[0]], color(*value));
    }
    canvas
}

/// Colours and their words.
pub fn legend(data: &[u8]) -> Vec<(Color, String)> {
    rows(data).into_iter().map(|(color, name, _)| (color, name)).collect()
}

/// The same with a legend, which counts pixels; small pictures go without.
pub fn colored(size: [u32; 2], data: &[u8]) -> Canvas {
    const SWATCH: u32 = 10;
    let mut canvas = plain(size, data);
    let rows = rows(data);
    let lines: Vec<String> = rows.iter().map(|(_, name, pixels)| format!("{name}: {pixels} px")).collect();
    let longest = lines.iter().map(|line| text_width(line)).max().unwrap_or(0);
    let (width, height) = (SWATCH + 18 + longest, LINE * rows.len() as u32 + 8);
    if width + 8 > size[0] || height + 8 > size[1] {
        return canvas;
    }
    canvas.fill([4, 4], [width, height], [24, 26, 30]);
    for (row, ((swatch, _, _), line)) in (0u32..).zip(rows.iter().zip(&lines)) {
        let top = 10 + LINE * row;
        canvas.fill([10, top], [SWATCH, SWATCH], *swatch);
        canvas.write([10 + SWATCH + 6, top - 2], line, [230, 230, 230]);
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_their_colours_and_the_legend_lists_those_that_occur() {
        let size = [200, 100];
        let mut data = vec![0u8; 20_000];
        data[19_999] = 1;
        (data[19_998], data[19_997], data[19_996]) = (200, 255, 254);
        let canvas = colored(size, &data);
        let bytes = canvas.into_bytes();
        let pixel = |index: usize| [bytes[3 * index], bytes[3 * index + 1], bytes[3 * index + 2]];
        assert_eq!([pixel(19_999), pixel(19_998), pixel(19_995)], [SHADOWED[0], BELOW_ZERO[3], LIT]);
        assert_eq!([pixel(19_997), pixel(19_996)], [BELOW_ZERO[0], BELOW_ZERO[1]]);
        let names: Vec<String> = rows(&data).into_iter().map(|(_, name, pixels)| format!("{name} {pixels}")).collect();
        assert_eq!(names, ["0 lit 19996", "1 1", "-1 1", "-2 1", "-4 and less 1"]);
    }

    #[test]
    fn a_picture_too_small_for_the_legend_has_none() {
        assert_eq!(colored([4, 4], &[0; 16]).into_bytes(), LIT.repeat(16));
    }
}
