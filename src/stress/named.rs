//! The named extreme cases of `data/stress/cases.toml`, each sweep laid out value by value.

use serde::Deserialize;

use super::case::{Case, CaseSource, FILES, files_named_in};
use super::pictures::{hills, noise};

const CASES: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/stress/cases.toml"));

macro_rules! scenes {
    ($($name:literal),*) => {
        const SCENES: &[(&str, &str)] = &[
            $(($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/stress/scenes/", $name, ".toml"))) ),*
        ];
    };
}

scenes!("spot", "point", "sun", "room", "slide", "slide-dark", "alpha", "beam", "lens", "dust", "bump");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    case: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    scene: String,
    why: String,
    #[serde(default)]
    set: Vec<String>,
    sweep: Option<Sweep>,
    #[serde(default)]
    files: Vec<Made>,
    #[serde(default)]
    pictures: Vec<Noise>,
    #[serde(default)]
    rows: Vec<String>,
    #[serde(default)]
    judged: Judgement,
    #[serde(default)]
    refused: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sweep {
    parameter: String,
    values: Vec<f64>,
}

/// Part of a case that is judged.
#[derive(Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Judgement {
    /// Each light's shade, by every technique.
    #[default]
    Shades,
    /// The picture's colours.
    Colors,
}

/// A picture of noise, or of heights.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Noise {
    name: String,
    size: [u32; 2],
    #[serde(default)]
    hills: bool,
}

/// A mesh file whose coordinates are another's, scaled and then moved along all axes alike.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Made {
    name: String,
    from: String,
    scale: String,
    r#move: String,
}

/// Reason why the list of cases cannot be used: a fault of this program's own data.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// The list does not follow TOML's grammar, or a key is wrong.
    #[error("data/stress/cases.toml: {0}")]
    Toml(#[from] toml::de::Error),
    /// A case names a scene or a value that does not exist.
    #[error("data/stress/cases.toml: case \"{case}\": {what}")]
    Case { case: String, what: String },
}

/// All named cases.
///
/// # Errors
///
/// A fault of the list itself.
pub fn cases() -> Result<Vec<Case>, Error> {
    let file: File = toml::from_str(CASES)?;
    let laid_out =
        file.case.iter().map(|entry| lay_out(entry).map_err(|what| Error::Case { case: entry.name.clone(), what }));
    Ok(laid_out.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

fn lay_out(entry: &Entry) -> Result<Vec<Case>, String> {
    match &entry.sweep {
        None => Ok(vec![case(entry, None)?]),
        Some(sweep) => sweep.values.iter().map(|value| case(entry, Some((&sweep.parameter, *value)))).collect(),
    }
}

fn case(entry: &Entry, sweep: Option<(&String, f64)>) -> Result<Case, String> {
    let value = sweep.map_or(f64::NAN, |(_, value)| value);
    let fill_all = |texts: &[String]| texts.iter().map(|text| fill(text, value)).collect::<Result<Vec<_>, _>>();
    let scene = SCENES.iter().find(|(name, _)| *name == entry.scene);
    let (_, toml) = scene.ok_or_else(|| format!("no scene \"{}\"", entry.scene))?;
    let set = fill_all(&entry.set)?;
    let named = files_named_in(&format!("{toml}\n{}", set.join("\n")));
    let mut made = entry.files.iter().map(|made| make(made, value)).collect::<Result<Vec<_>, _>>()?;
    made.extend(entry.pictures.iter().map(|picture| {
        let bytes = if picture.hills { hills(picture.size, false, 1) } else { noise(picture.size, 1) };
        (picture.name.clone(), bytes)
    }));
    if entry.scene == "bump" {
        made.push((String::from("hills.png"), hills([128, 64], true, 5)));
    }
    Ok(Case {
        name: sweep.map_or_else(|| entry.name.clone(), |(_, value)| format!("{}-{value:e}", entry.name)),
        source: CaseSource::Named,
        why: entry.why.clone(),
        toml: (*toml).to_owned(),
        set,
        files: named,
        made,
        rows: fill_all(&entry.rows)?,
        shades: entry.judged == Judgement::Shades,
        colors: entry.judged == Judgement::Colors,
        sweep: sweep.map(|(parameter, value)| (parameter.clone(), value)),
        refused: entry.refused,
        refusal: None,
    })
}

/// `text` with every `{…}` worked out for x = `value`.
fn fill(text: &str, value: f64) -> Result<String, String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        // A brace of an inline table that holds a formula.
        if after.find('{').is_some_and(|inner| after.find('}').is_none_or(|end| inner < end)) {
            out.push_str(before);
            out.push('{');
            rest = after;
            continue;
        }
        let Some((inside, after)) = after.split_once('}') else { return Err(format!("no }} in \"{text}\"")) };
        out.push_str(before);
        match formula(inside, value) {
            Some(number) if number.fract() == 0.0 && inside == "x" => out.push_str(&format!("{number:.0}")),
            Some(number) => out.push_str(&format!("{number:?}")),
            // An inline table, and no formula.
            None => out.push_str(&format!("{{{inside}}}")),
        }
        rest = after;
    }
    out.push_str(rest);
    Ok(out)
}

/// `x`, or a number, one of `* / + -`, and `x`.
fn formula(inside: &str, value: f64) -> Option<f64> {
    if inside == "x" {
        return Some(value);
    }
    let front = inside.strip_suffix('x')?;
    let (number, operator) = front.split_at_checked(front.len().checked_sub(1)?)?;
    let number: f64 = number.parse().ok()?;
    match operator {
        "*" => Some(number * value),
        "/" => Some(number / value),
        "+" => Some(number + value),
        "-" => Some(number - value),
        _ => None,
    }
}

fn make(made: &Made, value: f64) -> Result<(String, Vec<u8>), String> {
    let number = |text: &str| fill(text, value)?.parse::<f64>().map_err(|error| format!("\"{text}\": {error}"));
    let (scale, offset) = (number(&made.scale)?, number(&made.r#move)?);
    let (_, bytes) =
        FILES.iter().find(|(name, _)| *name == made.from).ok_or_else(|| format!("no mesh \"{}\"", made.from))?;
    let text = String::from_utf8_lossy(bytes);
    let line = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let moved = numbers.split_whitespace().filter_map(|text| text.parse::<f64>().ok());
            moved.fold(String::from("v"), |line, number| format!("{line} {:?}", number * scale + offset))
        }
        None => line.to_owned(),
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    Ok((made.name.clone(), (lines.join("\n") + "\n").into_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_worked_out_and_tables_left_alone() {
        assert_eq!(fill("a=[{2*x}, {1/x}, {3+x}, {1-x}]", 4.0).unwrap(), "a=[8.0, 0.25, 7.0, -3.0]");
        assert_eq!(fill("size={x}, r={ axis = [1, 0, 0] }", 64.0).unwrap(), "size=64, r={ axis = [1, 0, 0] }");
        assert_eq!(fill("a=[{-0.5*x}]", 3.0).unwrap(), "a=[-1.5]");
        assert_eq!(fill("a={ b = [{2*x}, 1], c = {x} }", 2.0).unwrap(), "a={ b = [4.0, 1], c = 2 }");
        assert!(fill("a={2*x", 1.0).is_err());
    }

    #[test]
    fn every_case_loads_or_is_refused_as_it_says() {
        let all = cases().unwrap();
        assert!(all.len() >= 60, "{}", all.len());
        for case in &all {
            let folder = tempfile::tempdir().unwrap();
            let loaded = case.load(folder.path());
            assert_eq!(loaded.is_err(), case.refused, "{}: {:?}", case.name, loaded.err());
        }
        let mut names: Vec<&str> = all.iter().map(|case| case.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len(), "a name stands twice");
    }
}
