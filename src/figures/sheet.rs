//! Lays a figure's panels out: title and source on top, a grid of pictures with their names, the caption below.

use super::painter::{Align, Painter, Pen};
use super::{Figure, Panel, letter_of};
use crate::output::canvas::{Canvas, Color};
use crate::output::letters::{FontWeight, Letters, TextStyle};

const PAPER: Color = [250, 250, 247];
const INK: Color = [26, 28, 34];
const FAINT: Color = [104, 108, 118];
const RULE: Color = [208, 210, 214];
const BEHIND: Color = [232, 233, 235];
/// Measured numbers.
const MEASURED: Color = [0, 92, 150];

/// The most that a panel's picture takes, in units.
pub const PANEL: [u32; 2] = [400, 300];
const MARGIN: f32 = 28.0;
const GAP: f32 = 20.0;
const TITLE: TextStyle = TextStyle { weight: FontWeight::SemiBold, size: 23.0, color: INK };
const SOURCE: TextStyle = TextStyle { weight: FontWeight::Regular, size: 13.0, color: FAINT };
const NAME: TextStyle = TextStyle { weight: FontWeight::SemiBold, size: 13.5, color: INK };
const NOTE: TextStyle = TextStyle { weight: FontWeight::Regular, size: 13.0, color: [58, 61, 70] };
const NUMBERS: TextStyle = TextStyle { weight: FontWeight::Regular, size: 13.0, color: MEASURED };
const CAPTION: TextStyle = TextStyle { weight: FontWeight::Regular, size: 15.0, color: INK };
/// Distance between base lines, in units.
const LINE: f32 = 18.0;
const CAPTION_LINE: f32 = 22.0;
/// Longer lines of a caption are hard to read.
const LONGEST_CAPTION: f32 = 830.0;

/// A panel's picture, and what was measured of it in words.
pub struct Drawn {
    pub picture: Canvas,
    pub numbers: Option<String>,
}

/// Width of a panel over `span` columns, in units.
pub fn width_of(span: u32) -> u32 {
    span.max(1) * PANEL[0] + (span.max(1) - 1) * GAP as u32
}

/// A panel's place in the grid, and the lines below it.
struct Cell<'a> {
    column: u32,
    lines: Vec<(String, TextStyle)>,
    panel: &'a Panel,
    drawn: &'a Drawn,
}

/// Panels row by row: as many as have room.
fn rows<'a>(figure: &'a Figure, drawn: &'a [Drawn], letters: &Letters) -> Vec<Vec<Cell<'a>>> {
    let mut rows: Vec<Vec<Cell<'_>>> = vec![Vec::new()];
    let mut column = 0;
    for (index, (panel, drawn)) in figure.panels.iter().zip(drawn).enumerate() {
        if column > 0 && column + panel.span > figure.columns {
            rows.push(Vec::new());
            column = 0;
        }
        let width = width_of(panel.span) as f32;
        let name = format!("{} {}", letter_of(index), panel.title);
        let text = |text: &str, style: TextStyle| {
            letters.wrap(&style, text, width).into_iter().map(move |line| (line, style)).collect::<Vec<_>>()
        };
        let mut lines = text(&name, NAME);
        lines.extend(text(panel.note, NOTE));
        lines.extend(drawn.numbers.iter().flat_map(|numbers| text(numbers, NUMBERS)));
        if let Some(row) = rows.last_mut() {
            row.push(Cell { column, lines, panel, drawn });
        }
        column += panel.span;
    }
    rows
}

/// Height of the text below a row.
fn text_height(row: &[Cell<'_>]) -> f32 {
    let lines = row.iter().map(|cell| cell.lines.len()).max().unwrap_or(0);
    8.0 + LINE * lines as f32
}

/// The sheet of `figure`, whose panels show `drawn`, with `scale` pixels a unit; `None` if memory cannot hold it.
pub fn compose(figure: &Figure, drawn: &[Drawn], letters: &Letters, scale: u32) -> Option<Canvas> {
    let rows = rows(figure, drawn, letters);
    let inner = width_of(figure.columns) as f32;
    let caption = letters.wrap(&CAPTION, figure.caption, inner.min(LONGEST_CAPTION));
    let title = letters.wrap(&TITLE, figure.title, inner);
    let source = letters.wrap(&SOURCE, figure.source, inner);
    let head = MARGIN + 30.0 * title.len() as f32 + LINE * source.len() as f32 + 18.0;
    let body: f32 =
        rows.iter().map(|row| PANEL[1] as f32 + text_height(row)).sum::<f32>() + GAP * (rows.len() - 1) as f32;
    let foot = 18.0 + CAPTION_LINE * caption.len() as f32 + MARGIN;
    let size = [(2.0 * MARGIN + inner) as u32, (head + body + foot).ceil() as u32];
    let mut sheet = Painter::new(letters, size, scale, PAPER)?;
    for (index, line) in (0u8..).zip(&title) {
        sheet.write([MARGIN, MARGIN + 19.0 + 30.0 * f32::from(index)], line, &TITLE, Align::Left);
    }
    for (index, line) in (0u8..).zip(source.iter().rev()) {
        sheet.write([MARGIN, head - 22.0 - LINE * f32::from(index)], line, &SOURCE, Align::Left);
    }
    let mut top = head;
    for row in &rows {
        row.iter().for_each(|cell| place(&mut sheet, cell, top, scale));
        top += PANEL[1] as f32 + text_height(row) + GAP;
    }
    let mut base = top - GAP + 18.0;
    sheet
        .line(&[[MARGIN, base - 0.5], [MARGIN + inner, base - 0.5]], Pen { color: RULE, width: 1.0, is_dashed: false });
    base += 24.0;
    for line in caption {
        sheet.write([MARGIN, base], &line, &CAPTION, Align::Left);
        base += CAPTION_LINE;
    }
    Some(sheet.into_canvas())
}

/// Draws a panel, its upper edge at `top`.
fn place(sheet: &mut Painter<'_>, cell: &Cell<'_>, top: f32, scale: u32) {
    let left = MARGIN + cell.column as f32 * (PANEL[0] as f32 + GAP);
    let room = [width_of(cell.panel.span), PANEL[1]];
    let picture = cell.drawn.picture.fitted(room.map(|side| side * scale));
    let [across, down] = picture.size().map(|side| side as f32 / scale as f32);
    let [width, height] = room.map(|side| side as f32);
    sheet.fill([left, top], [width, height], BEHIND);
    sheet.paste([left + ((width - across) / 2.0).floor(), top + ((height - down) / 2.0).floor()], &picture);
    let mut base = top + height + 20.0;
    for (line, style) in &cell.lines {
        sheet.write([left, base], line, style, Align::Left);
        base += LINE;
    }
}
