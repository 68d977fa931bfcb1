//! The table of keys as text and as a page in Markdown.

use std::fmt::Write as _;

use comfy_table::{Cell, ContentArrangement, Table, presets};

use super::{Absent, Key};

/// Words for a key that may not be missing.
const NEEDED: &str = "must be written";

impl Absent {
    /// The meaning in words; a default as TOML.
    pub fn words(&self) -> &str {
        match self {
            Self::Needed => NEEDED,
            Self::Default(value) => value,
            Self::Words(words) => words,
        }
    }
}

/// A line or more a key, `width` columns wide: path, values, and what holds without it.
pub fn list(keys: &[&Key], width: u16) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    table.set_header(["key", "values", "where it is not written"]);
    for key in keys {
        table.add_row([&key.key, &key.values, key.absent.words()].map(Cell::new));
    }
    let lines = table.lines().map(|line| line.trim_end().to_owned() + "\n");
    lines.collect()
}

/// All that is known of a key.
pub fn details(key: &Key) -> String {
    let mut text = format!("{}\n  {}\n  values:   {}\n", key.key, key.is, key.values);
    let _ = match &key.absent {
        Absent::Needed => writeln!(text, "  absent:   an error: {NEEDED}"),
        Absent::Default(value) => writeln!(text, "  default:  {value}"),
        Absent::Words(words) => writeln!(text, "  absent:   {words}"),
    };
    if !key.read_by.is_empty() {
        let _ = writeln!(text, "  read by:  {}", key.read_by.join(", "));
    }
    if let Some(set) = command(key) {
        let _ = writeln!(text, "  set by:   {set}");
    }
    text
}

/// The flag that writes the key's default from the command line.
fn command(key: &Key) -> Option<String> {
    let Absent::Default(value) = &key.absent else { return None };
    let path =
        ["light.", "object."].iter().find_map(|table| Some(format!("{table}0.{}", key.key.strip_prefix(table)?)));
    let path = path.unwrap_or_else(|| key.key.clone());
    let text = format!("{path}={value}");
    let is_plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "._=-".contains(c));
    Some(if is_plain { format!("--set {text}") } else { format!("--set '{text}'") })
}

/// The page data/scenes/keys.md.
pub fn page(keys: &[Key]) -> String {
    let mut text = String::from(
        "# Keys of scene files\n\n`glumbra keys --markdown` prints this page from the code; `glumbra keys KEY` explains one. What they do together is \
         in [README.md](README.md).\nBeside a key of `[light.shadow]` stand the techniques that read it, unless all do.\n",
    );
    let every = crate::techniques::TABLE.len();
    let mut section = "";
    for key in keys {
        let first = key.key.split('.').next().unwrap_or_default();
        let own = ["light.shadow", "object.material"].into_iter().find(|table| key.key.starts_with(table));
        let own = own.unwrap_or(first);
        if own != section {
            section = own;
            let _ = write!(
                text,
                "\n## {own}\n\n| key | values | where it is not written | what it is |\n|---|---|---|---|\n"
            );
        }
        let absent = match &key.absent {
            Absent::Default(value) => format!("`{value}`"),
            other => other.words().to_owned(),
        };
        let by = match key.read_by.len() {
            0 => String::new(),
            all if all == every => String::new(),
            _ => format!(" ({})", key.read_by.join(", ")),
        };
        let cells = [&format!("`{}`", key.key), &key.values, &absent, &format!("{}{by}", key.is)];
        let _ = writeln!(text, "| {} |", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
    }
    text
}
