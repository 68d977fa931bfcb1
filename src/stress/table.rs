//! A run's outcome as text for a terminal.

use comfy_table::{Cell, ContentArrangement, Table, presets};

use super::colors;
use super::results::{CaseResult, CaseRow, Verdict, random_defaults, tally};
use crate::techniques::TABLE;

/// Cases listed at most.
const MOST_CASES: usize = 60;

/// Cases that are not right all over, then each technique's verdicts, then shares and time.
pub fn to_text(results: &[CaseResult], width: u16) -> String {
    let techniques = techniques_of(results);
    let mut text = String::new();
    let listed: Vec<&CaseResult> = results.iter().filter(|result| result.has_news()).collect();
    if !listed.is_empty() {
        text.push_str(&cases(&listed, &techniques, width));
        if listed.len() > MOST_CASES {
            text.push_str(&format!(
                "… and {} more cases; -o DIR or --json FILE has them all\n",
                listed.len() - MOST_CASES
            ));
        }
        text.push('\n');
    }
    text.push_str(&verdicts(results, &techniques, width));
    text.push_str(&shares(results));
    text
}

/// Names of the techniques that have rows, in the order of the technique table; then of what is judged by colours.
pub fn techniques_of(results: &[CaseResult]) -> Vec<&'static str> {
    let has_rows =
        |name: &&str| results.iter().flat_map(|result| &result.rows).any(|row| row.settings.technique == *name);
    TABLE.iter().map(|technique| technique.name()).chain(colors::NAMES).filter(has_rows).collect()
}

fn table(width: u16) -> Table {
    let mut table = Table::new();
    table
        .load_style(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(width);
    table
}

fn cases(listed: &[&CaseResult], techniques: &[&str], width: u16) -> String {
    let mut table = table(width);
    table.set_header(std::iter::once("case").chain(techniques.iter().copied()));
    for result in listed.iter().take(MOST_CASES) {
        let mut cells = vec![Cell::new(&result.name)];
        if let Some(why) = &result.refused {
            cells.push(Cell::new(format!("refused: {why}")));
        } else {
            cells.extend(techniques.iter().map(|name| Cell::new(worst(result, name))));
        }
        table.add_row(cells);
    }
    format!("{table}\n")
}

/// The worst row of a technique, in words.
fn worst(result: &CaseResult, technique: &str) -> String {
    let rows = || result.rows.iter().filter(|row| row.settings.technique == technique);
    let Some(worst) = rows().max_by(|a, b| rank(a).total_cmp(&rank(b))) else { return String::new() };
    if worst.verdict == Verdict::Right {
        return String::from("right");
    }
    let count = rows().filter(|row| row.verdict == worst.verdict).count();
    format!("{count} of {} {}: {:.2} % ({})", rows().count(), worst.verdict.name(), worst.wrong_percent(), worst.keys())
}

/// Rank by verdict, then by wrong pixels.
fn rank(row: &CaseRow) -> f64 {
    let verdict = Verdict::ALL.iter().position(|verdict| *verdict == row.verdict).unwrap_or(0);
    1e6 * verdict as f64 + row.wrong_percent()
}

fn verdicts(results: &[CaseResult], techniques: &[&str], width: u16) -> String {
    let mut table = table(width);
    table.set_header(["technique", "rows"].into_iter().chain(Verdict::ALL.map(Verdict::name)));
    let mut add = |name: &str, rows: Vec<&CaseRow>| {
        let counts = tally(rows.iter().copied());
        let cells = [name.to_owned(), rows.len().to_string()].into_iter();
        table.add_row(cells.chain(counts.iter().map(usize::to_string)));
    };
    let rows = || results.iter().flat_map(|result| &result.rows);
    for name in techniques {
        add(name, rows().filter(|row| row.settings.technique == *name).collect());
    }
    add("all", rows().collect());
    format!("{table}\n")
}

/// False alarms, what default settings cannot draw, how much the ray tracer decides, and the time.
pub fn shares(results: &[CaseResult]) -> String {
    let rows: Vec<&CaseRow> = results.iter().flat_map(|result| &result.rows).collect();
    let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
    let alarms = rows.iter().filter(|row| row.verdict == Verdict::FalseAlarm).count();
    let defaults: Vec<&CaseRow> = random_defaults(results).collect();
    let unusable = defaults.iter().filter(|row| row.is_unusable()).count();
    let decided = results.iter().map(|result| result.decided).sum::<f64>() / results.len().max(1) as f64;
    let seconds: f64 = results.iter().map(|result| result.seconds).sum();
    // Named scenes are extreme, and files are whatever they are: the limit is that of random ones.
    let of_random = if defaults.is_empty() {
        String::new()
    } else {
        let share = percent(unusable, defaults.len());
        format!("warned or refused with default settings: {share:.2} % of {} random rows (at most 5)\n", defaults.len())
    };
    format!(
        "false alarms: {:.2} % of all rows (at most 2)\n{of_random}\
         {} cases, {:.2} s each; the ray tracer is certain of {:.2} % of the pixels drawn\n",
        percent(alarms, rows.len()),
        results.len(),
        seconds / results.len().max(1) as f64,
        100.0 * decided,
    )
}
