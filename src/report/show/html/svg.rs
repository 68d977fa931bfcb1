//! A plot in the page, or the reason why it is not there.

use super::tags::escape;
use crate::report::show::plots;

/// The plot; `none` where there is nothing to plot.
pub(super) fn plot(svg: Result<Option<String>, plots::Error>, none: &str) -> String {
    match svg {
        Ok(Some(svg)) => format!("<div class=\"plot\">{}</div>\n", svg.trim()),
        Ok(None) if none.is_empty() => String::new(),
        Ok(None) => format!("<p class=\"note\">{}</p>\n", escape(none)),
        Err(error) => format!("<p class=\"note\">{}</p>\n", escape(&error.to_string())),
    }
}
