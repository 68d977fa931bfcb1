//! Antialiased drawing on a sheet or a part of one: areas, lines, circles and text. A unit is `scale` pixels.
//! Knows letters; no figure.

use tiny_skia::{
    Color as Paint8, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};

use crate::output::canvas::{Canvas, Color};
use crate::output::letters::{Letters, TextStyle};

/// A point, x to the right and y down, in units.
pub type UnitPoint = [f32; 2];

/// Place of a text's own point: across, and up or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Left,
    Middle,
    Right,
}

/// Look of a line.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    pub color: Color,
    /// In units.
    pub width: f32,
    pub is_dashed: bool,
}

/// Something to draw on.
pub struct Painter<'a> {
    pixels: Pixmap,
    letters: &'a Letters,
    /// Pixels a unit.
    scale: f32,
}

impl<'a> Painter<'a> {
    /// A sheet of `size` units, of one colour; `None` if it is empty or larger than memory holds.
    pub fn new(letters: &'a Letters, size: [u32; 2], scale: u32, color: Color) -> Option<Self> {
        let mut pixels = Pixmap::new(size[0].checked_mul(scale)?, size[1].checked_mul(scale)?)?;
        pixels.fill(Paint8::from_rgba8(color[0], color[1], color[2], 255));
        Some(Self { pixels, letters, scale: scale as f32 })
    }

    /// A sheet that begins as a picture, whose pixels are its own.
    pub fn over(letters: &'a Letters, picture: &Canvas, scale: u32) -> Option<Self> {
        let [width, height] = picture.size();
        let mut pixels = Pixmap::new(width, height)?;
        copy(picture, &mut pixels, [0, 0]);
        Some(Self { pixels, letters, scale: scale as f32 })
    }

    /// The fonts.
    pub fn letters(&self) -> &'a Letters {
        self.letters
    }

    /// Width and height in units.
    pub fn size(&self) -> UnitPoint {
        [self.pixels.width() as f32 / self.scale, self.pixels.height() as f32 / self.scale]
    }

    /// The sheet as a picture.
    pub fn into_canvas(self) -> Canvas {
        let size = [self.pixels.width(), self.pixels.height()];
        let rgb = self.pixels.data().as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
        Canvas::of_bytes(size, rgb)
    }

    /// Copies a picture, pixel for pixel, its upper left corner at `place`.
    pub fn paste(&mut self, place: UnitPoint, picture: &Canvas) {
        let corner = place.map(|side| (side * self.scale).round() as i64);
        copy(picture, &mut self.pixels, corner);
    }

    /// Fills a rectangle of `size` from its upper left corner.
    pub fn fill(&mut self, [x, y]: UnitPoint, [width, height]: UnitPoint, color: Color) {
        self.area(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]], color, 1.0);
    }

    /// Fills a polygon. `opacity` is in [0, 1].
    pub fn area(&mut self, corners: &[UnitPoint], color: Color, opacity: f32) {
        let Some(path) = outline(corners, true) else { return };
        let paint = paint(color, opacity);
        self.pixels.fill_path(&path, &paint, FillRule::Winding, self.transform(), None);
    }

    /// Draws a line through points.
    pub fn line(&mut self, points: &[UnitPoint], pen: Pen) {
        let Some(path) = outline(points, false) else { return };
        self.stroke(&path, pen);
    }

    /// Fills a circle.
    pub fn disc(&mut self, [x, y]: UnitPoint, radius: f32, color: Color) {
        let Some(path) = PathBuilder::from_circle(x, y, radius) else { return };
        self.pixels.fill_path(&path, &paint(color, 1.0), FillRule::Winding, self.transform(), None);
    }

    /// Draws an arrow with a filled head.
    pub fn arrow(&mut self, from: UnitPoint, to: UnitPoint, pen: Pen) {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let length = x.hypot(y).max(f32::MIN_POSITIVE);
        let (x, y, head) = (x / length, y / length, 5.0 + 2.0 * pen.width);
        let neck = [to[0] - head * x, to[1] - head * y];
        let half = 0.42 * head;
        self.line(&[from, neck], pen);
        self.area(
            &[to, [neck[0] - half * y, neck[1] + half * x], [neck[0] + half * y, neck[1] - half * x]],
            pen.color,
            1.0,
        );
    }

    /// Writes a line; `place` is on its base line.
    pub fn write(&mut self, place: UnitPoint, text: &str, style: &TextStyle, align: Align) {
        self.write_turned(place, text, style, align, false);
    }

    /// The same from below to above, if `turned`.
    pub fn write_turned(&mut self, place: UnitPoint, text: &str, style: &TextStyle, align: Align, turned: bool) {
        let scaled = TextStyle { size: style.size * self.scale, ..*style };
        let width = self.letters.width(&scaled, text);
        let back = match align {
            Align::Left => 0.0,
            Align::Middle => 0.5 * width,
            Align::Right => width,
        };
        let [x, y] = place.map(|side| side * self.scale);
        let [x, y] = if turned { [x, y + back] } else { [x - back, y] };
        let origin = [x.floor(), y.round()];
        let shift = if turned { [0.0, 0.0] } else { [x - origin[0], 0.0] };
        let (letters, pixels) = (self.letters, &mut self.pixels);
        letters.cover(&scaled, text, shift, |column, row, covered| {
            let (column, row) = if turned { (row, -column) } else { (column, row) };
            mix(
                pixels,
                [origin[0] as i64 + i64::from(column), origin[1] as i64 + i64::from(row)],
                style.color,
                covered,
            );
        });
    }

    fn stroke(&mut self, path: &tiny_skia::Path, pen: Pen) {
        let dash = pen.is_dashed.then(|| StrokeDash::new(vec![5.0, 4.0], 0.0)).flatten();
        let stroke =
            Stroke { width: pen.width, line_cap: LineCap::Butt, line_join: LineJoin::Round, dash, ..Stroke::default() };
        self.pixels.stroke_path(path, &paint(pen.color, 1.0), &stroke, self.transform(), None);
    }

    fn transform(&self) -> Transform {
        Transform::from_scale(self.scale, self.scale)
    }
}

fn paint(color: Color, opacity: f32) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(color[0], color[1], color[2], (255.0 * opacity.clamp(0.0, 1.0)).round() as u8);
    paint
}

fn outline(points: &[UnitPoint], is_closed: bool) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    for (index, [x, y]) in points.iter().enumerate() {
        if index == 0 { path.move_to(*x, *y) } else { path.line_to(*x, *y) }
    }
    if is_closed {
        path.close();
    }
    path.finish()
}

fn copy(picture: &Canvas, pixels: &mut Pixmap, corner: [i64; 2]) {
    let width = i64::from(picture.size()[0].max(1));
    for (index, color) in (0_i64..).zip(picture.bytes().as_chunks::<3>().0) {
        mix(pixels, [corner[0] + index % width, corner[1] + index / width], *color, 1.0);
    }
}

/// Sets a share of a pixel; outside of the sheet nothing.
fn mix(pixels: &mut Pixmap, [x, y]: [i64; 2], color: Color, share: f32) {
    let [width, height] = [pixels.width(), pixels.height()].map(i64::from);
    if (0..width).contains(&x) && (0..height).contains(&y) {
        let first = 4 * (y * width + x) as usize;
        for (old, new) in pixels.data_mut()[first..first + 3].iter_mut().zip(color) {
            *old = (f32::from(*old) + share * (f32::from(new) - f32::from(*old))).round() as u8;
        }
    }
}
