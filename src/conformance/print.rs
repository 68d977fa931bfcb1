//! A run as text: the table, the driver's numbers, and the end of the screen's text.

use std::fmt::Write;

use comfy_table::{ColumnConstraint, ContentArrangement, Table, Width, presets};

use super::{Checked, Finding, RuleOutcome, RuleVerdict};

/// The whole text. `width` in columns; `all` lists checks that pass, too.
pub fn print(checked: &Checked, width: u16, all: bool) -> String {
    let mut table = Table::new();
    table
        .load_style(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(width);
    table.set_header(["rule", "GL 4.6 says", "measured", "verdict", "tolerance"]);
    for outcome in &checked.outcomes {
        table.add_row([
            format!("{} {}", outcome.id, outcome.title),
            format!("{} [{}]", outcome.says, outcome.section),
            measured(outcome, all),
            outcome.verdict.to_string(),
            outcome.tolerance.to_owned(),
        ]);
    }
    let narrow = [(0, 18), (3, 10)];
    for (column, most) in narrow {
        if let Some(column) = table.column_mut(column) {
            column.set_constraint(ColumnConstraint::UpperBoundary(Width::Fixed(most)));
        }
    }
    let mut text = format!("{table}\n");
    // Writing to a string cannot fail.
    let _ = numbers(&mut text, checked);
    text += &super::screen::ending(checked, usize::from(width));
    text
}

/// Text of the measurements: passes are counted, the rest is listed.
fn measured(outcome: &RuleOutcome, all: bool) -> String {
    let told = |finding: &&Finding| all || finding.verdict != RuleVerdict::Pass;
    let mut lines: Vec<String> = outcome.findings.iter().filter(told).map(line).collect();
    let passed = outcome.findings.iter().filter(|finding| finding.verdict == RuleVerdict::Pass).count();
    if !all && passed > 0 {
        let asked = outcome.findings.len();
        lines.insert(
            0,
            if passed == asked {
                format!("{passed} checks, all pass")
            } else {
                format!("{passed} of {asked} checks pass")
            },
        );
    }
    lines.join("\n")
}

fn line(finding: &Finding) -> String {
    let mark = match finding.verdict {
        RuleVerdict::Pass => "",
        RuleVerdict::Warning => "warning: ",
        RuleVerdict::Waived => "waived: ",
        RuleVerdict::Untestable => "not here: ",
        verdict => return format!("{verdict}: {}", finding.message()),
    };
    format!("{mark}{}", finding.message())
}

fn numbers(text: &mut String, checked: &Checked) -> std::fmt::Result {
    let facts: Vec<_> =
        checked.outcomes.iter().flat_map(|outcome| outcome.facts.iter().map(move |fact| (outcome.id, fact))).collect();
    if !facts.is_empty() {
        writeln!(text, "\nNumbers of this driver")?;
    }
    for (id, fact) in facts {
        writeln!(text, "  {id}  {}: {}", fact.name, fact.value)?;
    }
    writeln!(text)
}
