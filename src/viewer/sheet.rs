//! Sheets of text over a window's picture: rows of a name and what it means, in pages where they are too high.

use super::keys::HEADING;
use crate::output::canvas::{Canvas, Color, LINE, text_width, wrapped};

/// Pixels between a window's edges and its sheets.
pub const EDGE: u32 = 8;

/// A picture over the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Its pixels.
    pub canvas: Canvas,
    /// Its upper left corner, in pixels from the window's.
    pub place: [u32; 2],
}

/// Text of a sheet.
#[derive(Clone, Debug, Default)]
pub struct Words {
    /// First line of each page.
    pub heading: String,
    /// Names, in a column of their own, and what they mean.
    pub rows: Vec<(String, String)>,
    /// True for a sheet of a warning's colour.
    pub warns: bool,
}

const PAPER: Color = [24, 26, 30];
const WARNING: Color = [96, 20, 24];
const INK: Color = [230, 230, 230];
const STRONG: Color = [255, 214, 90];
const MARGIN: u32 = 8;

/// Least width of what rows mean, in pixels: a narrower window shows a part of the sheet.
const NARROWEST: u32 = 120;

/// A line of a page: the name, where a row begins, and a part of what it means.
type Line = (String, String);

impl Words {
    /// A line alone.
    pub fn line(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), ..Self::default() }
    }

    /// The pages of a window of `size` pixels, of which none is higher than it; at least one. A page says which of how many
    /// it is, and that `key` leads to the next.
    pub fn pages(&self, size: [u32; 2], key: &str) -> Vec<Canvas> {
        let inside = size[0].saturating_sub(2 * EDGE + 2 * MARGIN).max(NARROWEST);
        let names = self.rows.iter().map(|(name, _)| text_width(name)).max().map_or(0, |width| width + 2 * MARGIN);
        let most = inside.saturating_sub(names).max(NARROWEST);
        let mut lines: Vec<Line> = Vec::new();
        for (name, what) in &self.rows {
            let parts = wrapped(what, most);
            let parts = if parts.is_empty() { vec![String::new()] } else { parts };
            for (index, part) in parts.into_iter().enumerate() {
                lines.push((if index == 0 { name.clone() } else { String::new() }, part));
            }
        }
        let heading = wrapped(&self.heading, inside);
        let room = size[1].saturating_sub(2 * EDGE + 2 * MARGIN) / LINE;
        // The number of the page takes a line.
        let heading_lines = heading.len() as u32;
        let whole = room.saturating_sub(heading_lines).max(1) as usize;
        if lines.len() <= whole {
            return vec![self.page(&heading, &lines, names)];
        }
        let each = whole.saturating_sub(1).max(1);
        let count = lines.len().div_ceil(each);
        let numbered = |(index, lines): (usize, &[Line])| {
            let mut heading = heading.clone();
            heading.push(format!("page {} of {count}; {key}: next", index + 1));
            self.page(&heading, lines, names)
        };
        lines.chunks(each).enumerate().map(numbered).collect()
    }

    fn page(&self, heading: &[String], lines: &[Line], names: u32) -> Canvas {
        let widths = lines.iter().map(|(_, part)| names + text_width(part));
        let width = widths.chain(heading.iter().map(|line| text_width(line))).max().unwrap_or(0);
        let count = (heading.len() + lines.len()) as u32;
        let paper = if self.warns { WARNING } else { PAPER };
        let mut canvas = Canvas::new([2 * MARGIN + width, 2 * MARGIN + LINE * count], paper);
        let mut top = MARGIN;
        for line in heading {
            canvas.write([MARGIN, top], line, INK);
            top += LINE;
        }
        for (name, part) in lines {
            canvas.write([MARGIN, top], name, STRONG);
            canvas.write([MARGIN + names, top], part, INK);
            top += LINE;
        }
        canvas
    }
}

/// The help's pages.
pub fn help_pages(rows: Vec<(String, String)>, size: [u32; 2]) -> Vec<Canvas> {
    Words { heading: HEADING.to_owned(), rows, warns: false }.pages(size, "h")
}

/// The page after one of `count`; after the last none, and after none the first.
pub fn next_page(now: Option<usize>, count: usize) -> Option<usize> {
    now.map_or(Some(0), |page| Some(page + 1).filter(|next| *next < count))
}

/// A legend: squares of colours and what they mean, for a window of this width.
pub fn legend(colors: &[(Color, String)], window_width: u32) -> Canvas {
    const SQUARE: u32 = 10;
    let left = MARGIN + SQUARE + 6;
    let most = window_width.saturating_sub(2 * EDGE + left + MARGIN).max(NARROWEST);
    let rows: Vec<(Color, Vec<String>)> = colors.iter().map(|(color, words)| (*color, wrapped(words, most))).collect();
    let widest = rows.iter().flat_map(|(_, lines)| lines).map(|line| text_width(line)).max().unwrap_or(0);
    let count: u32 = rows.iter().map(|(_, lines)| lines.len() as u32).sum();
    let mut canvas = Canvas::new([left + widest + MARGIN, 2 * MARGIN + LINE * count], PAPER);
    let mut top = MARGIN;
    for (color, lines) in rows {
        canvas.fill([MARGIN, top + 1], [SQUARE; 2], INK);
        canvas.fill([MARGIN + 1, top + 2], [SQUARE - 2; 2], color);
        for line in lines {
            canvas.write([left, top], &line, INK);
            top += LINE;
        }
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::super::keys::rows;
    use super::*;

    fn pages(size: [u32; 2]) -> Vec<[u32; 2]> {
        help_pages(rows(&["a", "b"]), size).iter().map(Canvas::size).collect()
    }

    #[test]
    fn a_sheet_is_as_wide_as_its_window_allows() {
        let [wide, narrow] = [512, 300].map(|width| pages([width, 1000])[0]);
        assert!(wide[0] <= 512 - 2 * EDGE && narrow[0] <= 300 - 2 * EDGE, "{wide:?} {narrow:?}");
        assert!(wide[0] > 400 && wide[1] < narrow[1] && wide[1] < 300, "{wide:?} {narrow:?}");
    }

    #[test]
    fn pages_have_every_line_and_fit() {
        let whole = pages([512, 1000]);
        let parts = pages([512, 150]);
        assert!(whole.len() == 1 && parts.len() > 1, "{whole:?} {parts:?}");
        assert!(parts.iter().all(|page| page[1] <= 150 - 2 * EDGE), "{parts:?}");
        let lines = |page: &[u32; 2], heading: u32| (page[1] - 2 * MARGIN) / LINE - heading;
        let sum: u32 = parts.iter().map(|page| lines(page, 2)).sum();
        assert_eq!(sum, lines(&whole[0], 1));
    }
}
