//! Programs of the renderer, compiled for the model.

use std::collections::HashMap;
use std::rc::Rc;

use super::glsl::{Compiled, Unknown, compile};
use crate::pass::{Program, Stage};

/// Both stages of a program.
pub struct Shaders {
    pub vertex: Compiled,
    pub fragment: Compiled,
}

/// Programs that have been compiled, for all frames.
#[derive(Default)]
pub struct Library(HashMap<Program, Rc<Shaders>>);

impl Library {
    /// The program, compiled when it is first used.
    ///
    /// # Errors
    ///
    /// What of its text has no model.
    pub fn get(&mut self, program: &Program) -> Result<Rc<Shaders>, Unknown> {
        if let Some(known) = self.0.get(program) {
            return Ok(known.clone());
        }
        let stage = |stage: Stage| {
            compile(&program.source(stage).text, stage == Stage::Vertex)
                .map_err(|why| format!("{} ({}): {why}", program.label, stage.name()))
        };
        let shaders = Rc::new(Shaders { vertex: stage(Stage::Vertex)?, fragment: stage(Stage::Fragment)? });
        self.0.insert(program.clone(), shaders.clone());
        Ok(shaders)
    }
}
