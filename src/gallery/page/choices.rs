//! The table "When which?".

use std::fmt::Write;

use super::command::quoted_sets;
use crate::gallery::choices::{MapVerdict, MeasuredChoice, Price};
use crate::report::numbers::plain;
use crate::report::show::html::tags::escape;

/// Name of the section in links.
pub const ID: &str = "when-which";
pub const TITLE: &str = "When which? Where shadow maps are suited, and where not";

/// The section; empty without cases.
pub fn section(choices: &[MeasuredChoice]) -> String {
    if choices.is_empty() {
        return String::new();
    }
    let rows: String = choices.iter().map(row).collect();
    format!(
        "<section class=\"entry\" id=\"{ID}\" tabindex=\"-1\">\n<h2>{TITLE}</h2>\n\
         <p>What the documents say of shadow maps in each case, and what two techniques do on such a scene here: the share of \
         wrong pixels among the surfaces that face the light, and the median time of a frame that draws everything anew. \
         Times are of this driver and this machine, and of small pictures.</p>\n\
         <div class=\"cases\">\n{rows}</div>\n</section>\n"
    )
}

fn row(measured: &MeasuredChoice) -> String {
    let choice = &measured.choice;
    let verdict = if choice.verdict == MapVerdict::Suited { "cure" } else { "failure" };
    let mut lines = String::new();
    for (candidate, price) in [&choice.first, &choice.second].into_iter().zip(&measured.measures) {
        let sets: Vec<String> = choice.set.iter().chain(&candidate.set).cloned().collect();
        let Price { wrong_percent, frame_ms } = price;
        let _ = writeln!(
            lines,
            "<tr><th scope=\"row\">{}<div><code>{} {}</code></div></th><td>{} %</td>\
             <td>{} ms</td></tr>",
            escape(&candidate.name),
            escape(&choice.scene),
            escape(&quoted_sets(&sets)),
            plain(*wrong_percent),
            plain(*frame_ms)
        );
    }
    format!(
        "<div class=\"case\" id=\"{}\"><h3>{}</h3><p>The document calls shadow maps <b class=\"{verdict}\">{}</b>. {}</p>\n\
         <table><thead><tr><th></th><th scope=\"col\">wrong</th><th scope=\"col\">a frame</th></tr></thead><tbody>\n{lines}\
         </tbody></table>\n<p class=\"source\">[{}] <cite>{}</cite></p></div>\n",
        choice.id,
        escape(&choice.title),
        choice.verdict.name(),
        escape(&choice.why),
        escape(&choice.document),
        escape(&choice.section)
    )
}
