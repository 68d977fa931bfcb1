//! Elements of SVG in a picture of fixed width. Colours are classes of the page's style, for light and dark ground.

use std::fmt::Write;

use glam::{DVec2, dvec2};

use crate::report::show::html::tags::escape;

/// Width of every picture, in its own units: as many as a narrow screen has pixels, so that letters stay legible there.
pub const WIDTH: f64 = 400.0;

/// A picture that is being drawn. Points are in its units, y downwards.
pub struct Svg {
    height: f64,
    name: String,
    body: String,
}

impl Svg {
    /// An empty picture; `name`: what it shows, for those who do not see it.
    pub fn new(height: f64, name: impl Into<String>) -> Self {
        Self { height, name: name.into(), body: String::new() }
    }

    /// A line through points.
    pub fn line(&mut self, class: &str, points: &[DVec2]) {
        self.shape("polyline", class, points);
    }

    /// A filled area.
    pub fn area(&mut self, class: &str, points: &[DVec2]) {
        self.shape("polygon", class, points);
    }

    fn shape(&mut self, element: &str, class: &str, points: &[DVec2]) {
        let points: Vec<String> = points.iter().map(|point| format!("{:.1},{:.1}", point.x, point.y)).collect();
        let _ = writeln!(self.body, "<{element} class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }

    /// A dot.
    pub fn dot(&mut self, class: &str, at: DVec2, radius: f64) {
        let _ =
            writeln!(self.body, "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\"/>", at.x, at.y);
    }

    /// A line of text from `at` to the right.
    pub fn text(&mut self, class: &str, at: DVec2, text: &str) {
        let _ =
            writeln!(self.body, "<text class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\">{}</text>", at.x, at.y, escape(text));
    }

    /// An arrow.
    pub fn arrow(&mut self, class: &str, from: DVec2, to: DVec2) {
        self.line(class, &[from, to]);
        let back = (from - to).normalize_or_zero() * 7.0;
        let side = dvec2(-back.y, back.x) * 0.45;
        self.line(class, &[to + back + side, to, to + back - side]);
    }

    /// Colours and their words, below each other from `at`.
    pub fn legend(&mut self, at: DVec2, rows: &[(&str, &str)]) {
        for (index, (class, words)) in rows.iter().enumerate() {
            let at = at + dvec2(0.0, 15.0 * index as f64);
            self.line(class, &[at, at + dvec2(22.0, 0.0)]);
            self.text("words", at + dvec2(28.0, 4.0), words);
        }
    }

    /// The whole element.
    pub fn finish(self) -> String {
        format!(
            "<svg class=\"diagram\" viewBox=\"0 0 {WIDTH} {:.0}\" role=\"img\" aria-label=\"{}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n{}</svg>\n",
            self.height,
            escape(&self.name),
            self.body
        )
    }
}
