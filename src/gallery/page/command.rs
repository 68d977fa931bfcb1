//! Commands that draw a picture of the gallery again, quoted for a shell.

use crate::gallery::draw::{EntrySide, quick_size};
use crate::gallery::entry::GalleryEntry;

/// The command that draws one side again; `full`: the scene's own size, which `--quick` halves.
pub fn render_command(entry: &GalleryEntry, side: EntrySide, quick: bool, full: [u32; 2]) -> String {
    if entry.fault.is_some() && side == EntrySide::Failure {
        let quick = if quick { " --quick" } else { "" };
        return format!("glumbra gallery{quick} --entry {0} --picture failure -o {0}-failure.png", entry.id);
    }
    let mut words = vec![String::from("glumbra render"), entry.scene.clone()];
    if quick {
        let [width, height] = quick_size(full);
        words.push(format!("--size {width}x{height}"));
    }
    words.push(quoted_sets(&entry.overrides(side)));
    words.push(format!("-o {}-{}.png", entry.id, if side == EntrySide::Failure { "failure" } else { "cure" }));
    words.retain(|word| !word.is_empty());
    words.join(" ")
}

/// Overrides as options.
pub fn quoted_sets(overrides: &[String]) -> String {
    overrides.iter().map(|set| format!("--set {}", quoted(set))).collect::<Vec<_>>().join(" ")
}

/// A word as a shell reads it. The entries' own words have no single quotes.
fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|letter| letter.is_ascii_alphanumeric() || "._-=,/".contains(letter));
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "\"")) }
}
