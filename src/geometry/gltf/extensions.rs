//! Extensions of glTF: those that are read, and what a file says of others [Khronos, "glTF 2.0 Specification", 3.12].

use std::path::Path;

use gltf::json::Root;

use super::super::Error;
use super::super::tally::WarningTally;
use super::file::inside;

/// Extensions that are read. Those of materials that only change highlights or emitted light are none of them.
const READ: [&str; 3] = ["KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization"];

/// Refuses extensions that the file requires and that are not read; names those that it uses.
pub(super) fn check(root: &Root, path: &Path, odd: &mut WarningTally) -> Result<(), Error> {
    let unread = |name: &&String| !READ.contains(&name.as_str());
    let required: Vec<&str> = root.extensions_required.iter().filter(unread).map(String::as_str).collect();
    if !required.is_empty() {
        let what = format!("needs {}, which cannot be read: export the model without it", required.join(", "));
        return Err(inside(path, "extensionsRequired", what));
    }
    for name in root.extensions_used.iter().filter(unread) {
        odd.note(name, path, 0, || format!("extensionsUsed: {name} is not read: what it says is left out"));
    }
    Ok(())
}
