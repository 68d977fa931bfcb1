//! Pictures of projected light in a report: their names as files, and what they show. Both follow from the report's values,
//! so that merged parts have the same.

use super::results::{Row, SceneReport};
use super::swept::{LightSweep, PointErrors, SweepPoint};
use crate::report::numbers::plain;

/// A picture that a report may have.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPictureName {
    /// Name of its file, without fingerprint and ending.
    pub name: String,
    /// Sentence below the picture.
    pub caption: String,
    /// True if its colours are those of FLIP.
    pub is_flip: bool,
    /// Index of its sweep; `None`: it is of the scene as written.
    pub sweep: Option<usize>,
}

/// Name of the colours that rows are compared with.
pub const COLORS: &str = "colors-reference";
/// Name of FLIP of row 0.
pub const FLIP: &str = "colors-flip";

/// Name of a sweep's reference.
pub fn reference_name(sweep: usize) -> String {
    format!("sweep-{sweep}-reference")
}

/// Name of a sweep's picture, by its series and point.
pub fn drawn_name(sweep: usize, [series, point]: [usize; 2]) -> String {
    format!("sweep-{sweep}-{series}-{point}-drawn")
}

/// Name of its FLIP.
pub fn flip_name(sweep: usize, [series, point]: [usize; 2]) -> String {
    format!("sweep-{sweep}-{series}-{point}-flip")
}

/// Tests whether [`names`] may have made a name.
pub fn is_name(name: &str) -> bool {
    let Some(rest) = name.strip_prefix("sweep-") else { return [COLORS, FLIP].contains(&name) };
    let Some((numbers, what)) = rest.rsplit_once('-') else { return false };
    let count = numbers.split('-').count();
    let are_numbers = numbers.split('-').all(|number| number.parse::<usize>().is_ok());
    are_numbers && matches!((count, what), (1, "reference") | (3, "drawn" | "flip"))
}

/// Pictures of the scene in their order: colours to compare with, FLIP of row 0; and for each sweep its reference, each
/// series' first picture, and FLIP of every picture.
pub fn names(scene: &SceneReport) -> Vec<LightPictureName> {
    let mut names = Vec::new();
    let mut add = |name: String, caption: String, is_flip: bool, sweep: Option<usize>| {
        names.push(LightPictureName { name, caption, is_flip, sweep });
    };
    if let Some(from) = &scene.colors_from {
        add(COLORS.to_owned(), format!("The colours to compare with: {from}"), false, None);
        let row = scene.rows.iter().find(|row| row.index == 0).and_then(Row::measured);
        if let Some(flip) = row.and_then(|row| row.colors?.flip) {
            add(FLIP.to_owned(), format!("Row 0, as the scene is written: FLIP, mean {}", plain(flip)), true, None);
        }
    }
    for (index, sweep) in scene.sweeps.iter().enumerate() {
        add(reference_name(index), String::from("What the pictures are compared with"), false, Some(index));
        for (at, point, errors) in measured(sweep) {
            if at[1] == 0 {
                add(drawn_name(index, at), format!("{}, drawn", point.setting), false, Some(index));
            }
            if let Some(flip) = errors.errors.flip {
                let caption = format!("{}: FLIP, mean {}", point.setting, plain(flip));
                add(flip_name(index, at), caption, true, Some(index));
            }
        }
    }
    names
}

/// Points that were drawn, by series and place in it.
fn measured(sweep: &LightSweep) -> Vec<([usize; 2], &SweepPoint, &PointErrors)> {
    let mut measured = Vec::new();
    for (series, of) in sweep.series.iter().enumerate() {
        let drawn = of.points.iter().enumerate().filter_map(|(index, point)| Some((index, point, point.measured()?)));
        measured.extend(drawn.map(|(index, point, errors)| ([series, index], point, errors)));
    }
    measured
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::samples;

    #[test]
    fn every_name_is_known_again() {
        let scene = samples::projected_scene("a.toml", "f");
        let names = names(&scene);
        assert!(names.len() == 8, "{names:?}");
        assert!(names.iter().all(|picture| is_name(&picture.name)), "{names:?}");
        for other in ["sweep-1", "sweep-x-reference", "sweep-1-2-flip", "sweep-1-2-3-note", "colors", "note"] {
            assert!(!is_name(other), "{other}");
        }
    }
}
