//! [`Settings`] back to TOML, so that a supplied scene can be saved and changed.

use super::settings::{Entry, Settings, Value};

/// A table of this many entries, or one that holds tables, gets a header of its own.
const HEADER_FROM: usize = 5;

impl Settings {
    /// The table as a TOML document; reading it gives the same values.
    pub fn to_toml(&self) -> String {
        let mut out = String::new();
        body(&mut out, self, "");
        out
    }
}

fn body(out: &mut String, table: &Settings, prefix: &str) {
    let at_root = prefix.is_empty();
    for (name, entry) in table.entries.iter().filter(|(_, entry)| !has_header(entry, at_root)) {
        out.push_str(&format!("{} = {}\n", key(name), inline(&entry.value)));
    }
    for (name, entry) in table.entries.iter().filter(|(_, entry)| has_header(entry, at_root)) {
        let path = if at_root { key(name) } else { format!("{prefix}.{}", key(name)) };
        match &entry.value {
            Value::Table(inner) => section(out, inner, &path, ["[", "]"]),
            Value::Array(items) => items.iter().for_each(|item| {
                if let Value::Table(inner) = &item.value {
                    section(out, inner, &path, ["[[", "]]"]);
                }
            }),
            _ => {}
        }
    }
}

fn section(out: &mut String, table: &Settings, path: &str, [open, close]: [&str; 2]) {
    if !out.is_empty() {
        out.push('\n');
    }
    out.push_str(&format!("{open}{path}{close}\n"));
    body(out, table, path);
}

fn has_header(entry: &Entry, at_root: bool) -> bool {
    match &entry.value {
        Value::Table(table) => at_root || table.entries.len() >= HEADER_FROM || table.entries.iter().any(holds_table),
        Value::Array(items) => at_root && !items.is_empty() && items.iter().all(is_table),
        _ => false,
    }
}

fn is_table(entry: &Entry) -> bool {
    matches!(entry.value, Value::Table(_))
}

fn holds_table((_, entry): &(String, Entry)) -> bool {
    is_table(entry)
}

impl Value {
    /// The value on one line, as on the right of `=`.
    pub fn to_toml(&self) -> String {
        inline(self)
    }
}

fn inline(value: &Value) -> String {
    match value {
        Value::String(text) => quoted(text),
        Value::Integer(value) => value.to_string(),
        Value::Float(value) => number(*value),
        Value::Boolean(value) => value.to_string(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| inline(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) if table.is_empty() => String::from("{}"),
        Value::Table(table) => {
            let entry = |(name, entry): &(String, Entry)| format!("{} = {}", key(name), inline(&entry.value));
            let entries: Vec<String> = table.entries.iter().map(entry).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

/// Shortest digits that read back the same; TOML's own names for what is not finite.
fn number(value: f64) -> String {
    if value.is_nan() { String::from("nan") } else { format!("{value:?}") }
}

fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { quoted(name) }
}

fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push_str(&format!("\\U{:08X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::parse;

    #[test]
    fn what_is_printed_reads_back_the_same() {
        let text = "\"odd \\\"key\\\"\" = \"a\\\\b\\u0007\\n\"\nbig = 1e300\nsmall = -1e-7\nwhole = 2.0\n\
                    not = [nan, inf, -inf]\nempty = []\nnone = {}\n[t]\na.b.c = 1\n[[light]]\nx = 1\n\
                    [light.shadow]\no = { p = 1, q = 2 }\n[[light]]\n";
        let first = parse::document(Path::new("a"), text).unwrap().to_toml();
        let second = parse::document(Path::new("a"), &first).unwrap().to_toml();
        assert_eq!(first, second);
        for part in ["big = 1e300", "small = -1e-7", "whole = 2.0", "[nan, inf, -inf]", "[light.shadow]", "c = 1"] {
            assert!(first.contains(part), "{part} is not in\n{first}");
        }
    }
}
