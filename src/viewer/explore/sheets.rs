//! Sheets over the picture: help, what is left out, times, the pass, an error.

use super::Explorer;
use super::keys::explore_help;
use super::shown::Paged;
use crate::output::canvas::Canvas;
use crate::viewer::picture::in_corner;
use crate::viewer::sheet::{EDGE, Sheet, Words, help_pages};
use crate::viewer::show::Show;

impl Explorer {
    /// The sheets, the first below all.
    pub(super) fn all_sheets(&self) -> Vec<Sheet> {
        let mut sheets: Vec<Sheet> = Vec::new();
        for words in [self.pass_words(), self.time_words(), self.error_words()].into_iter().flatten() {
            if let Some(canvas) = words.pages(self.size, "i").into_iter().next() {
                let sheet = in_corner(canvas, self.size, &sheets);
                sheets.push(sheet);
            }
        }
        if let Some((sheet, page)) = self.looks.paged {
            let low = sheets.iter().map(|sheet| sheet.place[1]).min().unwrap_or(self.size[1]);
            let mut pages = self.pages_in(sheet, [self.size[0], low.max(self.size[1] / 2)]);
            let canvas = pages.swap_remove(page.min(pages.len() - 1));
            sheets.insert(0, Sheet { canvas, place: [EDGE; 2] });
        }
        sheets
    }

    /// All pages of a sheet; at least one.
    pub(super) fn pages(&self, sheet: Paged) -> Vec<Canvas> {
        self.pages_in(sheet, self.size)
    }

    fn pages_in(&self, sheet: Paged, size: [u32; 2]) -> Vec<Canvas> {
        match sheet {
            Paged::Help => help_pages(explore_help(), size),
            Paged::LeftOut => self.left_out_words().pages(size, "i"),
        }
    }

    fn left_out_words(&self) -> Words {
        let left_out = self.facts.left_out.iter().map(|left| (left.what.clone(), left.why.clone()));
        let warnings = self.facts.warnings.iter().map(|warning| (String::from("warning"), warning.clone()));
        let error = self.error().map(|error| (String::from("error"), error.to_owned()));
        let legend = self.traced().map(|traced| traced.legend(&self.scene)).unwrap_or_default();
        let legend = legend.into_iter().map(|(color, words)| {
            let [red, green, blue] = color;
            (format!("#{red:02x}{green:02x}{blue:02x}"), words)
        });
        let rows: Vec<_> = error.into_iter().chain(left_out).chain(warnings).chain(legend).collect();
        let heading =
            if rows.is_empty() { "Nothing is left out." } else { "Left out of this frame, for it changes no pixel:" };
        Words { heading: heading.to_owned(), rows, warns: false }
    }

    fn pass_words(&self) -> Option<Words> {
        let place = self.looks.pass?;
        let (number, label) = self.facts.passes.get(place)?;
        Some(Words::line(format!("after pass {number}: {label}")))
    }

    fn time_words(&self) -> Option<Words> {
        let (plan, draw) = (self.facts.plan_ms, self.facts.draw_ms);
        let rate = 1e3 / (plan + draw).max(1e-3);
        let words = format!("frame: plan {plan:.1} ms, draw {draw:.1} ms; {rate:.0} a second");
        self.looks.times.then(|| Words::line(words))
    }

    fn error_words(&self) -> Option<Words> {
        self.error().map(|error| Words { warns: true, ..Words::line(error) })
    }
}
