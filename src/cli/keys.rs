//! `glumbra keys`: what may stand in a scene file.

use clap::{ArgGroup, Args};
use serde::Serialize;

use super::Error;
use super::json::JsonArgs;
use crate::keys::{self, Key};

/// Columns of the list where standard output is no terminal.
const WIDTH: u16 = 120;

/// Lists the keys of scene files: values, defaults, and which shadow technique reads them
///
/// Without KEY all are listed. The list is made from the code that reads scene files.
#[derive(Clone, Debug, Args)]
#[command(
    group(ArgGroup::new("other-form").args(["markdown", "schema"])),
    after_help = "Examples:\n  glumbra keys                        all keys, a line each\n  \
                  glumbra keys light.shadow.offset    a table\n  \
                  glumbra keys kernel                 keys with that name, explained\n  \
                  glumbra keys --schema > scene.schema.json\n\n\
                  An editor with the TOML language server taplo completes and checks keys in a scene file \
                  that begins with this line:\n\n  #:schema scene.schema.json"
)]
pub(super) struct KeysArgs {
    /// A key, a table, or a part of a name: light.shadow.size, shadow, size
    #[arg(value_name = "KEY")]
    key: Option<String>,
    /// Prints all keys as a page in Markdown
    #[arg(long, conflicts_with_all = ["key", "json"])]
    markdown: bool,
    /// Prints a JSON schema of scene files, for editors
    #[arg(long, conflicts_with_all = ["key", "json"])]
    schema: bool,
    #[command(flatten)]
    json: JsonArgs,
}

/// All that `--json` prints.
#[derive(Serialize)]
struct Found<'a> {
    keys: Vec<&'a Key>,
}

pub(super) fn run(arguments: &KeysArgs) -> Result<(), Error> {
    let table = keys::table()?;
    if arguments.markdown {
        return super::print(&keys::page(&table));
    }
    if arguments.schema {
        return super::print(&format!("{:#}\n", keys::schema(&table)));
    }
    let found = match &arguments.key {
        Some(pattern) => keys::find(&table, pattern)?,
        None => table.iter().collect(),
    };
    arguments.json.write("keys", &Found { keys: found.clone() })?;
    if arguments.json.takes_standard_output() {
        return Ok(());
    }
    let text = if arguments.key.is_some() {
        found.iter().map(|key| keys::details(key)).collect::<Vec<_>>().join("\n")
    } else {
        keys::list(&found, terminal_size::terminal_size().map_or(WIDTH, |(width, _)| width.0))
    };
    super::print(&text)
}
