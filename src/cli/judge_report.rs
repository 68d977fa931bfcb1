//! The answer of `glumbra judge`: figures, as text and as JSON, held against limits.

use std::fmt::Write as _;

use serde::Serialize;

use super::Error;
use crate::judge::metrics::EdgeDistance;
use crate::judge::{Explanation, Judgement, PixelClass, WrongRegion};
use crate::scene::Scene;

/// JudgeLimits; `None`: none.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct JudgeLimits {
    pub false_shadow: Option<f64>,
    pub leak: Option<f64>,
    pub outside: Option<usize>,
    /// Pixels.
    pub edge: Option<f64>,
}

/// Figures of one picture.
#[derive(Serialize)]
pub struct JudgeReport {
    /// Version of this object's form.
    pub schema_version: u32,
    pub scene: String,
    pub picture: String,
    pub light: usize,
    pub light_name: String,
    pub size: [u32; 2],
    /// Explanation of wrong pixels, in words.
    pub band: String,
    pub compared: usize,
    pub false_shadow: usize,
    pub false_shadow_percent: f64,
    pub leak: usize,
    pub leak_percent: f64,
    pub surface: usize,
    pub light_outside: usize,
    pub outside_band: usize,
    pub unknown: usize,
    pub unknown_percent: f64,
    /// Not compared, by the reason.
    pub background: usize,
    pub outside_light: usize,
    pub turned_away: usize,
    pub no_shade: usize,
    /// From shown to true shadow edges, and from true to shown ones.
    pub edges: [Option<EdgeDistance>; 2],
    pub mistake: Option<String>,
    pub notes: Vec<String>,
    pub places: Vec<PlaceReport>,
    pub limits: JudgeLimits,
}

/// A place where the picture is wrong.
#[derive(Serialize)]
pub struct PlaceReport {
    pub kind: &'static str,
    pub explained: bool,
    pub pixels: usize,
    pub outside_band: usize,
    /// Least and greatest column and row.
    pub bounds: [[u32; 2]; 2],
    /// Column and row from the top left.
    pub pixel: [u32; 2],
    pub point: Option<[f64; 3]>,
    pub object: Option<String>,
    pub caster: Option<String>,
    /// Pixels to the nearest true shadow edge.
    pub edge_pixels: Option<f64>,
}

impl PlaceReport {
    pub fn of(region: &WrongRegion, scene: &Scene) -> Self {
        let name = |index: usize| scene.objects.get(index).map(|object| object.name.clone());
        let (kind, place) = match region.class {
            PixelClass::FalseShadow(place) => ("false shadow", place),
            PixelClass::Leak(place) => ("leak", place),
            PixelClass::Surface(place) => ("surface in only one of the two", place),
            _ => ("light beside the spotlight", Explanation::Beyond),
        };
        Self {
            kind,
            explained: place == Explanation::Explained,
            pixels: region.pixels,
            outside_band: region.beyond,
            bounds: region.bounds,
            pixel: region.at,
            point: region.position.map(|point| point.to_array()),
            object: region.object.and_then(name),
            caster: region.caster.and_then(name),
            edge_pixels: region.edge_pixels.is_finite().then_some(region.edge_pixels),
        }
    }

    fn to_text(&self, number: usize) -> String {
        let [[left, top], [right, bottom]] = self.bounds;
        let [x, y] = self.pixel;
        let pixels = if self.pixels == 1 { "1 pixel" } else { &format!("{} pixels", self.pixels) };
        let mut text = format!(
            "  {number}. {}: {pixels} ({} outside the band) in columns {left} to {right}, rows {top} to {bottom}\n     worst at \
             ({x}, {y})",
            self.kind, self.outside_band
        );
        if let Some([x, y, z]) = self.point {
            let _ = write!(text, ", the point ({x:.4}, {y:.4}, {z:.4})");
        }
        if let Some(object) = &self.object {
            let _ = write!(text, " of {object}");
        }
        text += &match self.edge_pixels {
            Some(pixels) => format!(", {pixels:.1} pixels from the nearest true shadow edge"),
            None => String::from(", and no true shadow edge is in the picture"),
        };
        match &self.caster {
            Some(caster) if self.kind == "false shadow" => text += &format!(", which {caster} casts"),
            Some(caster) => text += &format!("; the shadow that belongs there is that of {caster}"),
            None => {}
        }
        text + "\n"
    }
}

impl JudgeReport {
    /// Counts of a judgement; the rest is empty.
    pub fn of(found: &Judgement) -> Self {
        let count = |class: PixelClass| found.classes.iter().filter(|known| **known == class).count();
        Self {
            schema_version: 1,
            scene: String::new(),
            picture: String::new(),
            light: 0,
            light_name: String::new(),
            size: found.size,
            band: String::new(),
            compared: found.compared,
            false_shadow: found.false_shadow,
            false_shadow_percent: 100.0 * found.share(found.false_shadow),
            leak: found.leak,
            leak_percent: 100.0 * found.share(found.leak),
            surface: found.surface,
            light_outside: found.light_outside,
            outside_band: found.outside_band,
            unknown: found.unknown,
            unknown_percent: 100.0 * found.unknown_share(),
            background: count(PixelClass::Background),
            outside_light: count(PixelClass::OutsideLight),
            turned_away: count(PixelClass::TurnedAway),
            no_shade: count(PixelClass::NoShade),
            edges: [None; 2],
            mistake: None,
            notes: Vec::new(),
            places: Vec::new(),
            limits: JudgeLimits { false_shadow: None, leak: None, outside: None, edge: None },
        }
    }

    /// Findings that fail the picture, in words.
    fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        let mut hold = |limit: Option<f64>, percent: f64, option: &str| {
            if let Some(limit) = limit.filter(|limit| percent > *limit) {
                failures.push(format!("{percent:.4} % is beyond {option} {limit}"));
            }
        };
        hold(self.limits.false_shadow, self.false_shadow_percent, "--max-false-shadow");
        hold(self.limits.leak, self.leak_percent, "--max-leak");
        if let Some(limit) = self.limits.outside.filter(|limit| self.outside_band > *limit) {
            failures.push(format!("{} pixels outside the band are beyond --max-outside {limit}", self.outside_band));
        }
        match (self.limits.edge, &self.edges[1]) {
            (Some(limit), Some(edges)) if edges.mean_pixels > limit => failures.push(format!(
                "true shadow edges lie {:.3} pixels from those shown in the mean: beyond --max-edge {limit}",
                edges.mean_pixels
            )),
            (Some(_), None) => failures.push(String::from("there are no shadow edges to hold against --max-edge")),
            _ => {}
        }
        if self.compared == 0 {
            failures.push(String::from("no pixel could be compared"));
        } else if self.unknown_percent > 50.0 {
            failures.push(format!("the ray tracer cannot decide {:.1} % of the picture", self.unknown_percent));
        }
        failures
    }

    /// Tests whether the picture is within the limits, and says something.
    pub fn is_within(&self) -> bool {
        self.failures().is_empty()
    }

    /// With the verdict.
    pub fn to_json(&self) -> Result<serde_json::Value, Error> {
        let mut value = serde_json::to_value(self)?;
        if let Some(object) = value.as_object_mut() {
            object.insert("within".to_owned(), self.is_within().into());
            object.insert("failures".to_owned(), self.failures().into());
        }
        Ok(value)
    }

    pub fn to_text(&self) -> String {
        let mut text = String::new();
        let [width, height] = self.size;
        let name = if self.light_name.is_empty() { String::new() } else { format!(" ({})", self.light_name) };
        let _ =
            writeln!(text, "{}, {width}x{height}, against light {}{name} of {}", self.picture, self.light, self.scene);
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        if let Some(mistake) = &self.mistake {
            let _ = writeln!(text, "mistake: {mistake}");
        }
        self.write_counts(&mut text);
        for (number, place) in self.places.iter().enumerate() {
            text += if number == 0 { "worst places\n" } else { "" };
            text += &place.to_text(number + 1);
        }
        let failures = self.failures();
        for failure in &failures {
            let _ = writeln!(text, "fails: {failure}");
        }
        let JudgeLimits { false_shadow, leak, outside, edge } = self.limits;
        let has_limit = false_shadow.is_some() || leak.is_some() || outside.is_some() || edge.is_some();
        if failures.is_empty() {
            text += match has_limit {
                true => "within the limits\n",
                false => "no limits are given: --max-false-shadow, --max-leak, --max-outside, --max-edge\n",
            };
        }
        text
    }

    fn write_counts(&self, text: &mut String) {
        let row = |text: &mut String, name: &str, count: usize, rest: &str| {
            let _ = writeln!(text, "  {name:13} {count:>9}{rest}");
        };
        let percent = |percent: f64| format!("  ({percent:.4} %)");
        row(text, "compared", self.compared, "");
        row(text, "false shadow", self.false_shadow, &percent(self.false_shadow_percent));
        row(text, "leak", self.leak, &percent(self.leak_percent));
        if self.surface > 0 {
            row(text, "surfaces", self.surface, "  shown by only one of picture and truth");
        }
        if self.light_outside > 0 {
            row(text, "beside light", self.light_outside, "  lit beside the cone or frustum");
        }
        let band = format!("  wrong, and not explained by {}", self.band);
        row(text, "outside band", self.outside_band, &band);
        let unknown = format!("  undecided by the ray tracer ({:.4} % of what is drawn)", self.unknown_percent);
        row(text, "unknown", self.unknown, &unknown);
        let rest = [
            (self.background, "background"),
            (self.outside_light, "outside the light"),
            (self.turned_away, "turned away"),
            (self.no_shade, "without light"),
        ];
        let rest: Vec<String> =
            rest.iter().filter(|(count, _)| *count > 0).map(|(count, name)| format!("{count} {name}")).collect();
        if !rest.is_empty() {
            let _ = writeln!(text, "  not compared  {}", rest.join(", "));
        }
        let [shown, real] = &self.edges;
        for (edges, name) in [(shown, "shown to true"), (real, "true to shown")] {
            if let Some(EdgeDistance { mean_pixels, p95_pixels, max_pixels, .. }) = edges {
                let _ = writeln!(
                    text,
                    "  edges, {name}: {mean_pixels:.3} pixels in the mean, {p95_pixels:.2} for 95 %, {max_pixels:.2} at most"
                );
            }
        }
    }
}
