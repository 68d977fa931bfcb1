//! `glumbra compare`: two pictures, how they differ, and whether that is too much.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use serde::Serialize;

use super::Error;
use super::answers::{self, difference_of_texts};
use super::json::JsonArgs;
use crate::pictures::compare::has_spot;
use crate::pictures::flip::{self, FlipMap};
use crate::pictures::{self, Comparison, Raster, alike};
use crate::png_file::PngTexts;

/// Compares two pictures pixel by pixel: PNG, EXR or NPY files of any program.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct CompareArgs {
    /// The picture
    actual: PathBuf,

    /// The picture that it should be
    expected: PathBuf,

    /// Greatest difference of a channel, in codes of 1/255
    #[arg(long, value_name = "CODES", value_parser = parse_limit)]
    max: Option<f64>,

    /// Percent of the pixels that may differ by more than --max
    #[arg(long, value_name = "PERCENT", requires = "max", value_parser = parse_percent)]
    share: Option<f64>,

    /// Greatest mean difference over all channels of all pixels, in codes of 1/255
    #[arg(long, value_name = "CODES", value_parser = parse_limit)]
    mean: Option<f64>,

    /// Side of a square, in pixels, that may not differ by more than --max in each of its pixels: a small shadow that
    /// vanishes is a small share
    #[arg(long, value_name = "PIXELS", requires = "max", value_parser = clap::value_parser!(u32).range(1..))]
    spot: Option<u32>,

    /// Finds FLIP, the difference that a viewer sees, in 0 to 1; MAX: its greatest mean
    #[arg(long, value_name = "MAX", num_args = 0..=1, value_parser = parse_flip)]
    flip: Option<Option<f64>>,

    /// Writes a picture of the differences (.png): black where there are none, white from 16 codes on
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    #[command(flatten)]
    json: JsonArgs,
}

const HELP: &str = "\
Values: codes of 8 and 16 bits are parts of the greatest code, floats are as they are; a difference of 1/255 is one code. \
No gamma is applied. A grey picture has three equal channels beside a coloured one; one without alpha is opaque. \
Without limits, no bit may differ.

Exit status: 0 the same, or within the limits; 1 beyond them; 2 wrong usage, or a file that cannot be read or compared.

Examples:
  glumbra compare actual.png golden.png
  glumbra compare actual.png golden.png --max 2 --share 0.1 -o difference.png
  glumbra compare actual.exr golden.exr --max 0.01
  glumbra compare actual.png golden.png --flip 0.02
  glumbra compare actual.png golden.png --json - | jq .passing";

/// Codes are stored as f32, parts of the greatest: a difference of two is off by less than this.
const ROUNDED_CODES: f64 = 1e-4;

/// Limits in codes of the table of tolerances that would pass.
const LIMITS: [f64; 6] = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0];

/// Object that `--json` writes.
#[derive(Serialize)]
struct Report {
    actual: String,
    expected: String,
    size: [u32; 2],
    channels: usize,
    pixels: usize,
    differing: usize,
    /// Codes of 1/255; null: a value is no number in only one of the pictures.
    max_codes: Option<f64>,
    mean_codes: Option<f64>,
    rms_codes: Option<f64>,
    /// Column and row from the top left.
    worst: Option<[u32; 2]>,
    first: Option<[u32; 2]>,
    /// Least and greatest column and row of the pixels that differ.
    bounds: Option<[[u32; 2]; 2]>,
    flip_mean: Option<f64>,
    flip_max: Option<f64>,
    /// Shares of pixels beyond each of some limits.
    passing: Vec<Passing>,
    /// Texts of the files that differ: keyword, actual, expected.
    texts: Vec<[String; 3]>,
    within: bool,
}

/// A tolerance that would pass: the smallest --share at this --max.
#[derive(Serialize)]
struct Passing {
    max_codes: f64,
    share_percent: f64,
}

/// Compares: 0 within the limits, 1 beyond, 2 for an error.
pub fn run(arguments: &CompareArgs) -> ExitCode {
    match compare(arguments) {
        Ok(within) => ExitCode::from(u8::from(!within)),
        Err(error) => super::failure(error, 2),
    }
}

fn compare(arguments: &CompareArgs) -> Result<bool, Error> {
    if let Some(path) = &arguments.output {
        answers::check_png(path, &[&arguments.actual, &arguments.expected])?;
    }
    let [actual, expected] = [&arguments.actual, &arguments.expected].map(|path| pictures::read(path));
    let (actual, expected) = (actual?, expected?);
    let texts = difference_of_texts(&actual.texts, &expected.texts);
    let refused =
        |what| Error::NotCompared { actual: arguments.actual.clone(), expected: arguments.expected.clone(), what };
    let [actual, expected] = alike(actual.raster, expected.raster).map_err(refused)?;
    let found = Comparison::of(&actual, &expected).map_err(refused)?;
    let flip = arguments.flip.map(|_| flip_of(&actual, &expected)).transpose().map_err(refused)?;
    let within = is_within(arguments, [&actual, &expected], &found, flip.as_ref());
    if let Some(path) = &arguments.output {
        let difference = actual.difference(&expected).unwrap_or(expected);
        let texts = PngTexts::titled("differences of two pictures, from black for none to white at 16/255")
            .with("Actual", arguments.actual.display().to_string())
            .with("Expected", arguments.expected.display().to_string());
        difference.write_described_png(path, &texts).map_err(Error::DifferencePicture)?;
    }
    let report = Report {
        actual: arguments.actual.display().to_string(),
        expected: arguments.expected.display().to_string(),
        size: actual.size,
        channels: actual.channels,
        pixels: found.difference.of,
        differing: found.difference.count,
        max_codes: codes(found.difference.max),
        mean_codes: codes(found.difference.mean),
        rms_codes: codes(found.rms),
        worst: (found.difference.count > 0).then_some(found.difference.at),
        first: found.first,
        bounds: found.bounds,
        flip_mean: flip.as_ref().map(FlipMap::mean),
        flip_max: flip.as_ref().map(|map| f64::from(map.values.iter().copied().fold(0.0, f32::max))),
        passing: passing(&found),
        texts,
        within,
    };
    answers::answer(&arguments.json, "compare", &report, || to_text(&report, &found))?;
    Ok(within)
}

/// In codes of 1/255; `None`: not finite.
fn codes(value: f64) -> Option<f64> {
    value.is_finite().then_some(255.0 * value)
}

fn flip_of(actual: &Raster, expected: &Raster) -> Result<FlipMap, String> {
    if !flip::HAS_FLIP {
        return Err(String::from("this build has no FLIP: enable glumbra's cargo feature `flip`, which compiles C++"));
    }
    let [actual, expected] = [actual, expected].map(|raster| raster.to_image());
    let both = expected.zip(actual).ok_or_else(|| String::from("--flip needs pictures of at most four channels"))?;
    flip::flip(&both.0, &both.1).ok_or_else(|| format!("--flip takes at most {} pixels", flip::MOST_PIXELS))
}

fn is_within(
    arguments: &CompareArgs,
    [actual, expected]: [&Raster; 2],
    found: &Comparison,
    flip: Option<&FlipMap>,
) -> bool {
    let limit = |codes: f64| (codes + ROUNDED_CODES) / 255.0;
    let most_flip = arguments.flip.flatten();
    let has_limit = arguments.max.is_some() || arguments.mean.is_some() || most_flip.is_some();
    if !has_limit {
        return found.difference.count == 0;
    }
    let by_max = arguments.max.is_none_or(|max| {
        let slight = limit(max);
        let is_spot = |side| has_spot(actual, expected, slight, side);
        100.0 * found.share_beyond(slight) <= arguments.share.unwrap_or(0.0) && !arguments.spot.is_some_and(is_spot)
    });
    let by_mean = arguments.mean.is_none_or(|mean| found.difference.mean <= limit(mean));
    let by_flip = most_flip.zip(flip).is_none_or(|(most, map)| map.mean() <= most);
    by_max && by_mean && by_flip
}

/// Limits below the maximum, each with the share beyond it, and the maximum itself.
fn passing(found: &Comparison) -> Vec<Passing> {
    let beyond = |codes: f64| 100.0 * found.share_beyond((codes + ROUNDED_CODES) / 255.0);
    let most = 255.0 * found.difference.max;
    let below = LIMITS.into_iter().filter(|limit| limit + ROUNDED_CODES < most);
    let is_code = (most - most.round()).abs() < ROUNDED_CODES;
    let whole = if is_code { most.round() } else { rounded_up(most, 4) };
    let all = below.chain(most.is_finite().then_some(whole));
    all.map(|limit| Passing { max_codes: limit, share_percent: rounded_up(beyond(limit), 4) }).collect()
}

/// The least number of so many decimals that is not below `value`, nor below 0.
fn rounded_up(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    // A number that was rounded already stays.
    let rounded = (value * scale - 1e-9).ceil() / scale;
    if rounded > 0.0 { rounded } else { 0.0 }
}

fn to_text(report: &Report, found: &Comparison) -> String {
    let mut text = String::new();
    let [width, height] = report.size;
    let channels = match report.channels {
        1 => "grey",
        2 => "grey and alpha",
        3 => "RGB",
        4 => "RGBA",
        _ => "several channels",
    };
    let _ = writeln!(text, "{} and {}: {width}x{height}, {channels}", report.actual, report.expected);
    for [keyword, actual, expected] in &report.texts {
        let _ = writeln!(text, "  {keyword} differs: {actual} and {expected}");
    }
    if let (Some(worst), Some(first), Some([low, high])) = (report.worst, report.first, report.bounds) {
        let share = 100.0 * report.differing as f64 / report.pixels as f64;
        let _ = writeln!(
            text,
            "  differ     {} of {} pixels ({share:.4} %), in columns {} to {}, rows {} to {}; the first is ({}, {})",
            report.differing, report.pixels, low[0], high[0], low[1], high[1], first[0], first[1]
        );
        let name = channel_name(report.channels, found.channel);
        match report.max_codes {
            Some(max) => {
                let _ = writeln!(text, "  at most    {max:.4} codes of 255, at ({}, {}) in {name}", worst[0], worst[1]);
            }
            None => {
                let _ = writeln!(text, "  at ({}, {}) {name} is a number in only one of the two", worst[0], worst[1]);
            }
        }
        if let (Some(mean), Some(rms)) = (report.mean_codes, report.rms_codes) {
            let _ = writeln!(text, "  mean       {mean:.6} codes; root mean square {rms:.6}");
        }
    } else {
        text += "  no bit differs\n";
    }
    if let (Some(mean), Some(most)) = (report.flip_mean, report.flip_max) {
        let _ = writeln!(text, "  FLIP       {mean:.6} in the mean, {most:.4} at most");
    }
    if report.differing > 0 && !report.passing.is_empty() {
        text += "would pass\n";
        for Passing { max_codes, share_percent } in &report.passing {
            match *share_percent > 0.0 {
                true => {
                    let _ = writeln!(text, "  --max {max_codes} --share {share_percent}");
                }
                false => {
                    let _ = writeln!(text, "  --max {max_codes}");
                }
            }
        }
        if let Some(mean) = report.mean_codes {
            let _ = writeln!(text, "  --mean {}", rounded_up(mean, 6));
        }
    }
    text += if report.within { "within the limits\n" } else { "beyond the limits\n" };
    text
}

fn channel_name(channels: usize, channel: usize) -> String {
    let names: &[&str] = match channels {
        1 => &["grey"],
        2 => &["grey", "alpha"],
        3 | 4 => &["red", "green", "blue", "alpha"],
        _ => &[],
    };
    names.get(channel).map_or_else(|| format!("channel {channel}"), |name| (*name).to_owned())
}

fn parse_limit(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| *value >= 0.0);
    value.ok_or_else(|| format!("'{text}' is no number of codes from 0 on"))
}

/// Reads a percentage from 0 to 100.
pub fn parse_percent(text: &str) -> Result<f64, String> {
    let value = text.trim_end_matches('%').parse().ok().filter(|value| (0.0..=100.0).contains(value));
    value.ok_or_else(|| format!("'{text}' is no percentage from 0 to 100"))
}

fn parse_flip(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| format!("'{text}' is no FLIP from 0 to 1"))
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn a_limit_that_is_printed_passes() {
        for value in [0.0, 1.0, 0.123_456, 12.000_1, 99.999_99, 0.000_01] {
            let limit = rounded_up(value, 4);
            assert!(limit >= value && limit - value < 1.1e-4, "{value} {limit}");
        }
        assert_eq!([rounded_up(12.0, 4), rounded_up(0.1 + 0.2, 4), rounded_up(-1.0, 4)], [12.0, 0.3, 0.0]);
    }
}
