//! Paths in JSON, which holds Unicode alone.

use std::collections::BTreeMap;
use std::path::Path;

/// The bytes of paths that are not UTF-8, in hexadecimal digits, by the text that stands for each.
pub(super) type PathBytes = BTreeMap<String, String>;

/// The path as text. Where that loses something, its bytes go to `bytes`.
pub(super) fn path_text(path: &Path, bytes: &mut PathBytes) -> String {
    let text = path.to_string_lossy().into_owned();
    if path.to_str().is_none() {
        let digits = path.as_os_str().as_encoded_bytes().iter().map(|byte| format!("{byte:02x}"));
        bytes.insert(text.clone(), digits.collect());
    }
    text
}
