//! Lays a figure's panels out: title and source on top, a grid of pictures with their names, the caption below.

use super::Figure;
use crate::output::canvas::{Canvas, Color, Font};

const PAPER: Color = [252, 252, 250];
const INK: Color = [28, 30, 36];
const FAINT: Color = [112, 116, 126];
const RULE: Color = [206, 208, 212];

/// The most that a panel's picture takes.
const PANEL: [u32; 2] = [400, 300];
const MARGIN: u32 = 20;
const GAP: u32 = 14;
/// Below a panel, for its name.
const NAME: u32 = 24;
const LINE: u32 = 18;

/// The sheet of `figure`, whose panels show `pictures`.
pub fn compose(figure: &Figure, pictures: &[Canvas]) -> Canvas {
    let columns = figure.columns.max(1);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let width = 2 * MARGIN + columns * PANEL[0] + (columns - 1) * GAP;
    let caption = Font::Text.wrap(figure.caption, width - 2 * MARGIN);
    let head = MARGIN + 28 + LINE + 8;
    let foot = 14 + LINE * caption.len() as u32 + MARGIN;
    let height = head + rows * (PANEL[1] + NAME) + (rows - 1) * GAP + foot;
    let mut sheet = Canvas::new([width, height], PAPER);
    sheet.write_in(Font::Title, [MARGIN, MARGIN], figure.title, INK);
    sheet.write_in(Font::Text, [MARGIN, MARGIN + 26], figure.source, FAINT);
    for (index, (panel, picture)) in (0u32..).zip(figure.panels.iter().zip(pictures)) {
        let left = MARGIN + (index % columns) * (PANEL[0] + GAP);
        let top = head + (index / columns) * (PANEL[1] + NAME + GAP);
        let picture = picture.fitted(PANEL);
        let [across, down] = picture.size();
        sheet.fill([left, top], PANEL, [232, 233, 235]);
        sheet.paste([left + (PANEL[0] - across) / 2, top + (PANEL[1] - down) / 2], &picture);
        let name = format!("({}) {}", char::from(b'a' + (index % 26) as u8), panel.title);
        sheet.write_in(Font::Text, [left, top + PANEL[1] + 6], &name, INK);
    }
    let mut top = height - foot + 4;
    sheet.fill([MARGIN, top], [width - 2 * MARGIN, 1], RULE);
    top += 10;
    for line in caption {
        sheet.write_in(Font::Text, [MARGIN, top], &line, INK);
        top += LINE;
    }
    sheet
}
