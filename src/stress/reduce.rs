//! A failing scene made small: what can be taken away or rounded while the picture stays silently wrong is.

use super::case::{Case, files_named_in};
use super::colors;
use super::results::Verdict;
use super::rows::row_of;
use super::run::{StressOptions, draw_case};
use crate::frame::Renderer;
use crate::scene::{self, Entry, Settings, Value};

/// Scenes tried at most: each costs two truths and one picture.
const MOST_TRIES: usize = 400;

/// No side of a picture is made shorter, in pixels.
const SHORTEST_SIDE: i64 = 16;

/// Keys of objects, lights and the camera that a scene can do without.
const SPARE_KEYS: [&str; 20] = [
    "rotate",
    "wave",
    "material",
    "casts_shadow",
    "name",
    "fov_y",
    "filter",
    "image",
    "beam",
    "falloff",
    "aspect",
    "shape",
    "up",
    "focus",
    "dust",
    "interpolate",
    "background",
    "ambient",
    "color",
    "shadow",
];

/// The smallest scene found on which `inside`, the inside of `[light.shadow]`, is silently wrong, with that setting in it.
/// `None` where the case as it is does not fail.
pub fn reduce(case: &Case, inside: &str, options: &StressOptions, renderer: &mut Renderer) -> Option<Case> {
    let folder = tempfile::tempdir().ok()?;
    let mut best = case.settings(folder.path()).ok()?;
    let by_color = colors::NAMES.contains(&row_of(inside).technique.as_str());
    let mut search = Search { case, inside, by_color, options, renderer, tries: 0 };
    if !search.fails(&best) {
        return None;
    }
    loop {
        let before = best.to_toml();
        search.without_items(&mut best, "light");
        search.without_items(&mut best, "object");
        search.without_keys(&mut best);
        search.smaller_picture(&mut best);
        search.rounder_numbers(&mut best);
        if best.to_toml() == before || search.tries >= MOST_TRIES {
            break;
        }
    }
    Some(search.case_of(&if by_color { best } else { with_shadow(best, inside) }))
}

struct Search<'a> {
    case: &'a Case,
    inside: &'a str,
    /// True if the row is of the picture's colours, and no technique's.
    by_color: bool,
    options: &'a StressOptions,
    renderer: &'a mut Renderer,
    tries: usize,
}

impl Search<'_> {
    fn case_of(&self, settings: &Settings) -> Case {
        let toml = settings.to_toml();
        Case {
            files: files_named_in(&toml),
            toml,
            set: Vec::new(),
            name: format!("reduced-{}", self.case.name),
            rows: if self.by_color { Vec::new() } else { vec![self.inside.to_owned()] },
            shades: !self.by_color,
            colors: self.by_color,
            refused: false,
            ..self.case.clone()
        }
    }

    fn fails(&mut self, settings: &Settings) -> bool {
        self.tries += 1;
        let case = self.case_of(settings);
        let result = draw_case(&case, self.options, self.renderer);
        result.rows.iter().any(|row| row.verdict == Verdict::SilentlyWrong)
    }

    /// Takes `change` where the scene still fails with it.
    fn attempt(&mut self, best: &mut Settings, change: impl FnOnce(&mut Settings)) -> bool {
        if self.tries >= MOST_TRIES {
            return false;
        }
        let mut changed = best.clone();
        change(&mut changed);
        let fails = self.fails(&changed);
        if fails {
            *best = changed;
        }
        fails
    }

    /// Leaves out the tables of an array of tables, one after the other; one is left.
    fn without_items(&mut self, best: &mut Settings, key: &str) {
        let mut index = 0;
        while count(best, key) > 1 && index < count(best, key) {
            let removed = self.attempt(best, |settings| {
                if let Some(Value::Array(items)) = value_mut(settings, key) {
                    items.remove(index);
                }
            });
            index += usize::from(!removed);
        }
    }

    fn without_keys(&mut self, best: &mut Settings) {
        for table in 0..tables_mut(best).len() {
            for key in SPARE_KEYS {
                let has = tables_mut(best).get(table).is_some_and(|table| table.get(key).is_some());
                if has {
                    self.attempt(best, |settings| tables_mut(settings)[table].entries.retain(|(name, _)| name != key));
                }
            }
        }
    }

    fn smaller_picture(&mut self, best: &mut Settings) {
        let halve = |settings: &mut Settings| {
            if let Some(Value::Table(image)) = value_mut(settings, "image")
                && let Some(Value::Array(sides)) = value_mut(image, "size")
            {
                for side in sides {
                    if let Value::Integer(side) = &mut side.value {
                        *side = (*side / 2).max(SHORTEST_SIDE.min(*side));
                    }
                }
            }
        };
        let mut before = String::new();
        while best.to_toml() != before {
            before = best.to_toml();
            self.attempt(best, halve);
        }
    }

    fn rounder_numbers(&mut self, best: &mut Settings) {
        for index in 0..numbers_mut(best).len() {
            for digits in 1..=3 {
                let number = *numbers_mut(best)[index];
                let rounder = rounded(number, digits);
                if rounder == number || self.attempt(best, |settings| *numbers_mut(settings)[index] = rounder) {
                    break;
                }
            }
        }
    }
}

/// The scene with one setting for all of its lights.
fn with_shadow(mut settings: Settings, inside: &str) -> Settings {
    if let Ok(shadow) = scene::shadow_settings(inside)
        && let Some(Value::Array(lights)) = value_mut(&mut settings, "light")
    {
        for light in lights {
            if let Value::Table(light) = &mut light.value {
                light.set("shadow", Entry { value: Value::Table(shadow.clone()), origin: shadow.origin.clone() });
            }
        }
    }
    settings
}

fn value_mut<'a>(settings: &'a mut Settings, key: &str) -> Option<&'a mut Value> {
    settings.entries.iter_mut().find(|(name, _)| name == key).map(|(_, entry)| &mut entry.value)
}

fn count(settings: &Settings, key: &str) -> usize {
    match settings.get(key).map(|entry| &entry.value) {
        Some(Value::Array(items)) => items.len(),
        _ => 0,
    }
}

/// Every table below the root, those in arrays too.
fn tables_mut(settings: &mut Settings) -> Vec<&mut Settings> {
    let mut tables = Vec::new();
    for (_, entry) in &mut settings.entries {
        match &mut entry.value {
            Value::Table(table) => tables.push(table),
            Value::Array(items) => tables.extend(items.iter_mut().filter_map(|item| match &mut item.value {
                Value::Table(table) => Some(table),
                _ => None,
            })),
            _ => {}
        }
    }
    tables
}

/// Every float of the scene.
fn numbers_mut(settings: &mut Settings) -> Vec<&mut f64> {
    settings.entries.iter_mut().flat_map(|(_, entry)| numbers_of(&mut entry.value)).collect()
}

fn numbers_of(value: &mut Value) -> Vec<&mut f64> {
    match value {
        Value::Float(number) => vec![number],
        Value::Array(items) => items.iter_mut().flat_map(|item| numbers_of(&mut item.value)).collect(),
        Value::Table(table) => numbers_mut(table),
        _ => Vec::new(),
    }
}

/// Rounds to so many significant digits.
fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits - 1).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!([1, 2, 3].map(|digits| rounded(0.012_345, digits)), [0.01, 0.012, 0.0123]);
        assert_eq!(rounded(-98.7, 1), -100.0);
        assert_eq!(rounded(0.0, 1), 0.0);
    }
}
