//! A sheet to draw a plot on: titles, two axes, markers, lines and a legend at the right. Knows no report.
//!
//! Colours are those of Okabe and Ito without yellow, which is too light on white; markers differ in shape as well.

use plotters::coord::Shift;
use plotters::coord::combinators::{BindKeyPoints, IntoLogRange, LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Error;
use super::axis::PlotAxis;
use crate::report::numbers::plain;
use crate::report::show::html::tags::escape;

pub(crate) const SIZE: (u32, u32) = (900, 560);
const LEGEND_LEFT: i32 = 708;
const TEXT: RGBColor = RGBColor(0x22, 0x22, 0x28);
const FAINT: RGBColor = RGBColor(0x5c, 0x5c, 0x66);
const FONT: &str = "sans-serif";
const COLORS: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x55, 0x55, 0x5c),
];

type Root<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type LogAxis = WithKeyPoints<LogCoord<f64>>;
type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<LogAxis, LogAxis>>;
type Place = (i32, i32);

/// Text around the plot.
pub(crate) struct Words<'a> {
    pub title: String,
    pub captions: &'a [String],
    pub x: &'a str,
    pub y: &'a str,
}

/// Look of a kind of point: the number of its kind gives colour and shape.
#[derive(Clone, Copy)]
pub(crate) struct Marker {
    pub kind: usize,
    pub radius: i32,
    /// Opacity in [0, 1].
    pub opacity: f64,
    pub is_outlined: bool,
}

pub(crate) struct PlotCanvas<'a> {
    root: Root<'a>,
    chart: Chart<'a>,
    legend_y: i32,
    /// SVG.
    links: String,
}

/// Draws on a new sheet; the result is SVG.
pub(crate) fn draw(
    words: &Words<'_>,
    axes: [&PlotAxis; 2],
    draw: impl FnOnce(&mut PlotCanvas<'_>) -> Result<(), Error>,
) -> Result<String, Error> {
    let (mut svg, links);
    svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        write_titles(&root, words)?;
        let chart = draw_axes(&root, words, axes)?;
        let mut canvas = PlotCanvas { root, chart, legend_y: 100, links: String::new() };
        draw(&mut canvas)?;
        canvas.root.present().map_err(failed)?;
        links = canvas.links;
    }
    Ok(described(&svg, words, &links))
}

/// Adds a title and a description for readers who cannot see it, and `links` over everything.
fn described(svg: &str, words: &Words<'_>, links: &str) -> String {
    let Some((head, rest)) = svg.split_once('>') else { return svg.to_owned() };
    let (title, text) = (escape(&words.title), escape(&format!("{} against {}", words.y, words.x)));
    let body = rest.trim_end().trim_end_matches("</svg>");
    format!(
        "{head} role=\"img\" aria-label=\"{title}\">\n<title>{title}</title>\n<desc>{text}</desc>{body}{links}</svg>\n"
    )
}

fn write_titles(root: &Root<'_>, words: &Words<'_>) -> Result<(), Error> {
    let title = (FONT, 20, FontStyle::Bold).into_font().color(&TEXT);
    root.draw(&Text::new(cut(&words.title, 76), (24, 14), title)).map_err(failed)?;
    for (index, caption) in words.captions.iter().enumerate() {
        let style = (FONT, 12).into_font().color(&FAINT);
        root.draw(&Text::new(cut(caption, 140), (24, 40 + 16 * index as i32), style)).map_err(failed)?;
    }
    Ok(())
}

fn draw_axes<'a>(root: &Root<'a>, words: &Words<'_>, [x, y]: [&PlotAxis; 2]) -> Result<Chart<'a>, Error> {
    let coordinates = |axis: &PlotAxis| {
        axis.range.clone().log_scale().with_key_points(axis.ticks.clone()).with_light_points(axis.minor.iter().copied())
    };
    let mut chart = ChartBuilder::on(root)
        .margin_left(10)
        .margin_right(SIZE.0 as i32 - LEGEND_LEFT + 20)
        .margin_top(84)
        .margin_bottom(10)
        .x_label_area_size(48)
        .y_label_area_size(66)
        .build_cartesian_2d(coordinates(x), coordinates(y))
        .map_err(failed)?;
    let label = |axis: &PlotAxis| {
        let axis = axis.clone();
        move |value: &f64| if axis.floor == Some(*value) { "0".to_owned() } else { plain(axis.value(*value)) }
    };
    chart
        .configure_mesh()
        .x_label_formatter(&label(x))
        .y_label_formatter(&label(y))
        .x_desc(words.x)
        .y_desc(words.y)
        .axis_desc_style((FONT, 14).into_font().color(&TEXT))
        .label_style((FONT, 13).into_font().color(&TEXT))
        .axis_style(FAINT)
        .bold_line_style(RGBColor(0xd4, 0xd4, 0xda))
        .light_line_style(RGBColor(0xf0, 0xf0, 0xf3))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

impl PlotCanvas<'_> {
    /// Place in pixels.
    pub fn place(&self, x: f64, y: f64) -> Place {
        self.chart.plotting_area().map_coordinate(&(x, y))
    }

    pub fn marker(&self, at: Place, marker: Marker) -> Result<(), Error> {
        let color = COLORS[marker.kind % COLORS.len()];
        let fill = color.mix(marker.opacity).filled();
        let outline =
            if marker.is_outlined { BLACK.stroke_width(2) } else { color.mix(marker.opacity).stroke_width(1) };
        let r = marker.radius;
        let shape = |corners: &[Place]| corners.iter().map(|(x, y)| (at.0 + x, at.1 + y)).collect::<Vec<_>>();
        let corners = match marker.kind % 4 {
            0 => {
                self.root.draw(&Circle::new(at, r, fill)).map_err(failed)?;
                return self.root.draw(&Circle::new(at, r, outline)).map_err(failed);
            }
            1 => shape(&[(-r, -r), (r, -r), (r, r), (-r, r), (-r, -r)]),
            2 => shape(&[(0, -r - 1), (r + 1, r), (-r - 1, r), (0, -r - 1)]),
            _ => shape(&[(0, -r - 2), (r + 2, 0), (0, r + 2), (-r - 2, 0), (0, -r - 2)]),
        };
        self.root.draw(&Polygon::new(corners.clone(), fill)).map_err(failed)?;
        self.root.draw(&PathElement::new(corners, outline)).map_err(failed)
    }

    /// Makes a place of the sheet a link, with a tip.
    pub fn link(&mut self, at: Place, target: &str, tip: &str) {
        self.links += &format!(
            "<a href=\"{}\"><title>{}</title><circle cx=\"{}\" cy=\"{}\" r=\"7\" fill=\"#000\" fill-opacity=\"0\"/></a>\n",
            escape(target),
            escape(tip),
            at.0,
            at.1
        );
    }

    /// A bar along the first axis, with ends.
    pub fn bar(&self, from: Place, to: Place, marker: Marker) -> Result<(), Error> {
        let color = COLORS[marker.kind % COLORS.len()].mix(marker.opacity);
        let ends = [from, to].map(|(x, y)| vec![(x, y - 3), (x, y + 3)]);
        for line in [vec![from, to]].into_iter().chain(ends) {
            self.root.draw(&PathElement::new(line, color.stroke_width(1))).map_err(failed)?;
        }
        Ok(())
    }

    /// Draws a ring around a marker.
    pub fn ring(&self, at: Place, radius: i32) -> Result<(), Error> {
        self.root.draw(&Circle::new(at, radius, TEXT.stroke_width(1))).map_err(failed)
    }

    /// Draws a line. `kind`: `None` for black.
    pub fn line(&self, places: Vec<Place>, kind: Option<usize>) -> Result<(), Error> {
        let color = kind.map_or(TEXT, |kind| COLORS[kind % COLORS.len()]);
        self.root.draw(&PathElement::new(places, color.stroke_width(2))).map_err(failed)
    }

    /// Gives a place of the sheet a tip.
    pub fn tip(&mut self, at: Place, tip: &str) {
        self.links += &format!(
            "<g><title>{}</title><circle cx=\"{}\" cy=\"{}\" r=\"7\" fill=\"#000\" fill-opacity=\"0\"/></g>\n",
            escape(tip),
            at.0,
            at.1
        );
    }

    /// Draws the line of pictures without a wrong pixel.
    pub fn floor(&self, axis: &PlotAxis, height: f64) -> Result<(), Error> {
        self.zeros(axis, height, "no wrong pixel")
    }

    /// Draws the line of zeros, and what they mean.
    pub fn zeros(&self, axis: &PlotAxis, height: f64, meaning: &str) -> Result<(), Error> {
        let ends = [axis.range.start, axis.range.end].map(|x| self.place(x, height));
        let dashes = (ends[0].0..ends[1].0).step_by(10).map(|x| [(x, ends[0].1), ((x + 5).min(ends[1].0), ends[0].1)]);
        for dash in dashes {
            self.root.draw(&PathElement::new(dash.to_vec(), FAINT.stroke_width(1))).map_err(failed)?;
        }
        self.text(meaning, (ends[0].0 + 8, ends[0].1 - 4), 12, Pos::new(HPos::Left, VPos::Bottom))
    }

    /// Below and left of a point: on a front nothing lies there.
    pub fn label(&self, text: &str, (x, y): Place) -> Result<(), Error> {
        self.text(text, (x - 7, y + 6), 12, Pos::new(HPos::Right, VPos::Top))
    }

    fn text(&self, text: &str, at: Place, size: i32, anchor: Pos) -> Result<(), Error> {
        let style = (FONT, size).into_font().color(&TEXT).pos(anchor);
        self.root.draw(&Text::new(text.to_owned(), at, style)).map_err(failed)
    }

    pub fn legend_heading(&mut self, text: &str) -> Result<(), Error> {
        let style = (FONT, 13, FontStyle::Bold).into_font().color(&TEXT).pos(Pos::new(HPos::Left, VPos::Center));
        self.legend_y += 8;
        self.root.draw(&Text::new(text.to_owned(), (LEGEND_LEFT, self.legend_y), style)).map_err(failed)?;
        self.legend_y += 20;
        Ok(())
    }

    /// A line of the legend; `symbol` draws at the place it gets.
    pub fn legend_row(
        &mut self,
        text: &str,
        symbol: impl FnOnce(&Self, Place) -> Result<(), Error>,
    ) -> Result<(), Error> {
        symbol(self, (LEGEND_LEFT + 10, self.legend_y))?;
        self.text(&cut(text, 22), (LEGEND_LEFT + 28, self.legend_y), 13, Pos::new(HPos::Left, VPos::Center))?;
        self.legend_y += 19;
        Ok(())
    }
}

/// Cuts text to at most `most` letters.
fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

fn failed<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> Error {
    Error::Draw(error.to_string())
}
