//! The frame of every JSON file of results: its schema, the version of that, and the program's.

use serde::Serialize;

/// Version of the results' keys. It grows when a key changes its meaning or goes. A new key does not change it.
pub const SCHEMA_VERSION: u32 = 1;

/// Results with the names by which a reader knows them.
#[derive(Serialize)]
struct Document<'a, T> {
    /// `glumbra-COMMAND`.
    schema: String,
    schema_version: u32,
    glumbra: &'static str,
    #[serde(flatten)]
    results: &'a T,
}

/// The results of a command, pretty, with a line's end.
///
/// # Errors
///
/// Those of the encoder.
pub fn document(command: &str, results: &impl Serialize) -> Result<String, serde_json::Error> {
    let schema = format!("glumbra-{command}");
    let document = Document { schema, schema_version: SCHEMA_VERSION, glumbra: env!("CARGO_PKG_VERSION"), results };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}
