//! The finished GLSL of a plan's programs, for `glumbra plan --shaders`.

use std::fmt::Write;

use super::{Error, Plan};
use crate::pass::{Pass, Program, Stage, Work};

/// A program, and the passes and draws that use it.
struct Use<'a> {
    program: &'a Program,
    passes: Vec<&'a str>,
    draws: Vec<&'a str>,
}

impl Plan {
    /// The finished GLSL of both stages of every program: of all passes, or of those whose name contains `pass`. Each
    /// program is printed once, however many passes draw with it.
    ///
    /// # Errors
    ///
    /// No pass of such a name.
    pub fn shaders(&self, pass: &str) -> Result<String, Error> {
        let chosen: Vec<&Pass> = self.list.passes.iter().filter(|each| each.label.contains(pass)).collect();
        if chosen.is_empty() {
            let names =
                self.list.passes.iter().map(|pass| format!("\"{}\"", pass.label)).collect::<Vec<_>>().join(", ");
            return Err(Error::NoSuchPass { wanted: pass.to_owned(), names });
        }
        let uses = uses(&chosen);
        let mut text = String::new();
        for (number, each) in uses.iter().enumerate() {
            let title = format!("program {} of {}, \"{}\"", number + 1, uses.len(), each.program.label);
            for stage in Stage::ALL {
                let between = if text.is_empty() { "" } else { "\n" };
                // Writing into a string cannot fail.
                let _ = writeln!(text, "{between}// ==== {title}: {} shader", stage.name());
                let _ = writeln!(text, "// passes: {}", names(&each.passes));
                let _ = writeln!(text, "// draws: {}", names(&each.draws));
                text.push_str(&each.program.source(stage).text);
            }
        }
        if uses.is_empty() {
            text.push_str("// no shader: the pass only copies\n");
        }
        Ok(text)
    }
}

fn uses<'a>(passes: &[&'a Pass]) -> Vec<Use<'a>> {
    let mut uses: Vec<Use> = Vec::new();
    for pass in passes {
        let Work::Draw(draw) = &pass.work else { continue };
        for batch in &draw.batches {
            let at = uses.iter().position(|each| each.program == &batch.program).unwrap_or_else(|| {
                uses.push(Use { program: &batch.program, passes: Vec::new(), draws: Vec::new() });
                uses.len() - 1
            });
            push_new(&mut uses[at].passes, &pass.label);
            batch.draws.iter().for_each(|draw| push_new(&mut uses[at].draws, &draw.label));
        }
    }
    uses
}

fn push_new<'a>(list: &mut Vec<&'a str>, name: &'a str) {
    if !list.contains(&name) {
        list.push(name);
    }
}

/// Names of a scene, on one line of a comment.
fn names(names: &[&str]) -> String {
    const MOST: usize = 12;
    let mut shown: Vec<String> = names.iter().take(MOST).map(|name| format!("{name:?}")).collect();
    if names.len() > MOST {
        shown.push(format!("and {} more", names.len() - MOST));
    }
    shown.join(", ")
}
