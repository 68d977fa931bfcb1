//! Graphs of the sheets: two axes, lines, a legend above. The plotting library lays axes out; a painter draws them. Knows no
//! figure.

use std::convert::Infallible;
use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::{ChartBuilder, IntoDrawingArea, RGBColor, ShapeStyle};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color as _, FontTransform, IntoFont};
use plotters_backend::text_anchor::VPos;
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind};

use super::painter::{Align, Painter, Pen, UnitPoint};
use crate::output::canvas::Color;
use crate::output::letters::{FontWeight, TextStyle};

/// Steps of the library's whole numbers in a unit.
const FINE: i32 = 8;
const INK: Color = [40, 42, 50];

/// An axis.
#[derive(Clone, Debug)]
pub struct GraphAxis<'a> {
    pub label: &'a str,
    /// Value at the left or the bottom, and at the other end; may fall.
    pub range: [f64; 2],
    pub ticks: Vec<f64>,
    pub is_logarithmic: bool,
}

/// A line of a graph.
#[derive(Clone, Debug)]
pub struct Line<'a> {
    /// For the legend; empty: not in it.
    pub name: &'a str,
    pub pen: Pen,
    /// `None`: a gap.
    pub points: Vec<Option<[f64; 2]>>,
    /// Radius of a dot at each point; 0: none.
    pub dots: f32,
}

/// A graph with its axes.
#[derive(Clone, Debug)]
pub struct Graph<'a> {
    pub axes: [GraphAxis<'a>; 2],
    pub lines: Vec<Line<'a>>,
}

impl GraphAxis<'_> {
    /// Place from the left or the bottom, in [0, 1].
    fn share(&self, value: f64) -> f64 {
        let plane = |value: f64| if self.is_logarithmic { value.max(f64::MIN_POSITIVE).log10() } else { value };
        let [start, end] = self.range.map(plane);
        (plane(value) - start) / (end - start)
    }
}

/// An axis as the library has it.
struct Marked<'a>(&'a GraphAxis<'a>);

impl Ranged for Marked<'_> {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        limit.0 + (self.0.share(*value) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.0.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.0.range[0]..self.0.range[1]
    }
}

impl Graph<'_> {
    /// Draws the graph over all of `painter`.
    pub fn draw(&self, painter: &mut Painter<'_>) {
        // A painter has no error; the library's own come from fonts, of which it has none.
        let Ok(plane) = self.draw_axes(painter) else { return };
        for line in &self.lines {
            for points in line.points.split(Option::is_none) {
                let places: Vec<UnitPoint> = points.iter().flatten().map(|point| plane.place(self, *point)).collect();
                painter.line(&places, line.pen);
                if line.dots > 0.0 {
                    places.iter().for_each(|place| painter.disc(*place, line.dots, line.pen.color));
                }
            }
        }
        self.draw_legend(painter, plane.left);
    }

    fn draw_axes(&self, painter: &mut Painter<'_>) -> Result<Plane, Box<dyn std::error::Error>> {
        let [x, y] = &self.axes;
        let root = FineBackend { painter }.into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin_top(34 * FINE)
            .margin_right(16 * FINE)
            .margin_bottom(6 * FINE)
            .margin_left(6 * FINE)
            .x_label_area_size(38 * FINE)
            .y_label_area_size(50 * FINE)
            .build_cartesian_2d(Marked(x), Marked(y))
            .map_err(|error| error.to_string())?;
        let words = |value: &f64| number(*value);
        let ink = RGBColor(INK[0], INK[1], INK[2]);
        let font = |size: i32| ("sans-serif", size * FINE).into_font().color(&ink);
        chart
            .configure_mesh()
            .x_label_formatter(&words)
            .y_label_formatter(&words)
            .x_desc(x.label)
            .y_desc(y.label)
            .axis_desc_style(font(12))
            .label_style(font(11))
            .set_all_tick_mark_size(4 * FINE)
            .axis_style(ShapeStyle {
                color: RGBColor(120, 124, 134).to_rgba(),
                filled: false,
                stroke_width: FINE as u32,
            })
            .bold_line_style(ShapeStyle {
                color: RGBColor(222, 223, 227).to_rgba(),
                filled: false,
                stroke_width: FINE as u32,
            })
            .light_line_style(RGBColor(255, 255, 255).mix(0.0))
            .draw()
            .map_err(|error| error.to_string())?;
        let area = chart.plotting_area();
        let (horizontal, vertical) = area.get_pixel_range();
        let unit = |value: i32| value as f32 / FINE as f32;
        Ok(Plane {
            left: unit(horizontal.start),
            right: unit(horizontal.end),
            top: unit(vertical.start),
            bottom: unit(vertical.end),
        })
    }

    fn draw_legend(&self, painter: &mut Painter<'_>, left: f32) {
        let style = TextStyle { weight: FontWeight::Regular, size: 12.0, color: INK };
        let mut x = left;
        for line in self.lines.iter().filter(|line| !line.name.is_empty()) {
            painter.line(&[[x, 17.0], [x + 20.0, 17.0]], Pen { width: line.pen.width.max(2.0), ..line.pen });
            painter.write([x + 26.0, 21.0], line.name, &style, Align::Left);
            x += 26.0 + painter.letters().width(&style, line.name) + 18.0;
        }
    }
}

/// Edges of the area between the axes, in units.
struct Plane {
    left: f32,
    right: f32,
    top: f32,
    bottom: f32,
}

impl Plane {
    fn place(&self, graph: &Graph<'_>, point: [f64; 2]) -> UnitPoint {
        let share = |axis: usize| graph.axes[axis].share(point[axis]).clamp(0.0, 1.0) as f32;
        let (x, y) = (share(0), share(1));
        [self.left + x * (self.right - self.left), self.bottom + y * (self.top - self.bottom)]
    }
}

/// A number of an axis, without needless digits.
fn number(value: f64) -> String {
    let exponent = value.abs().log10().round();
    let is_power = value > 0.0 && (10_f64.powf(exponent) / value - 1.0).abs() < 1e-9;
    if is_power && exponent >= 3.0 {
        let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
        return format!("10{}", digits[(exponent as usize).min(9)]);
    }
    let rounded = (value * 1e6).round() / 1e6;
    format!("{rounded}").replace('-', "−")
}

/// Draws what the library wants drawn, in steps of a [`FINE`]th of a unit.
struct FineBackend<'p, 'a> {
    painter: &'p mut Painter<'a>,
}

fn units((x, y): BackendCoord) -> UnitPoint {
    [x as f32 / FINE as f32, y as f32 / FINE as f32]
}

fn rgb(color: BackendColor) -> Color {
    [color.rgb.0, color.rgb.1, color.rgb.2]
}

fn pen<S: BackendStyle>(style: &S) -> Pen {
    Pen { color: rgb(style.color()), width: style.stroke_width() as f32 / FINE as f32, is_dashed: false }
}

fn text_style<S: BackendTextStyle>(style: &S) -> TextStyle {
    TextStyle { weight: FontWeight::Regular, size: style.size() as f32 / FINE as f32, color: rgb(style.color()) }
}

type Done = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for FineBackend<'_, '_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let [width, height] = self.painter.size().map(|side| (side * FINE as f32) as u32);
        (width, height)
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Done {
        if color.alpha > 0.0 {
            self.painter.fill(units(point), [1.0 / FINE as f32; 2], rgb(color));
        }
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Done {
        self.draw_path([from, to], style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Done {
        if style.color().alpha > 0.0 {
            // On the middles of pixels: axes and ticks are then sharp.
            let middle = |[x, y]: UnitPoint| [x.floor() + 0.5, y.floor() + 0.5];
            let points: Vec<UnitPoint> = path.into_iter().map(|point| middle(units(point))).collect();
            self.painter.line(&points, pen(style));
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Done {
        let look = text_style(style);
        let turned = matches!(style.transform(), FontTransform::Rotate90 | FontTransform::Rotate270);
        let align = match style.anchor().h_pos {
            HPos::Left => Align::Left,
            HPos::Center => Align::Middle,
            HPos::Right => Align::Right,
        };
        // From a line's own point to its base line; a capital is 0.73 em high.
        let down = match style.anchor().v_pos {
            VPos::Top => 0.95 * look.size,
            VPos::Center => 0.36 * look.size,
            VPos::Bottom => -0.2 * look.size,
        };
        let [x, y] = units(at);
        let place = if turned { [x + down, y] } else { [x, y + down] };
        self.painter.write_turned(place, text, &look, align, turned);
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let look = text_style(style);
        let width = self.painter.letters().width(&look, text);
        Ok(((width * FINE as f32).ceil() as u32, (look.size * FINE as f32).ceil() as u32))
    }
}
