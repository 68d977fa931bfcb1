//! Turns GL errors into our errors, with the label of the pass that made them: by KHR_debug where the context reports, by
//! glGetError elsewhere.

use std::rc::Rc;

use glow::HasContext;

use crate::context::{Context, DebugLog, error_name};

/// GL's errors since the last check.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{label}: {}", messages.join("; "))]
pub struct GlError {
    /// The pass, or the step outside of one.
    pub label: String,
    /// The driver's text in a debug context, else the errors' names. Never empty.
    pub messages: Vec<String>,
}

/// Reads the errors of one context.
#[derive(Clone, Debug)]
pub struct Debug {
    gl: Rc<glow::Context>,
    log: Option<DebugLog>,
}

/// glGetError keeps one flag a kind of error; a context that is lost reports the same one without end.
const MOST_FLAGS: usize = 8;

impl Debug {
    /// A reader of the errors of `context`; it shares the context's functions and its log.
    pub fn new(context: &dyn Context) -> Self {
        Self { gl: context.gl().clone(), log: context.debug_log().cloned() }
    }

    /// Tests whether errors have the driver's text and the call that made them.
    pub fn is_verbose(&self) -> bool {
        self.log.is_some()
    }

    /// Fails if a GL call since the last check was in error, and names `label` as where. The context must be current.
    pub fn check(&self, label: &str) -> Result<(), GlError> {
        let flags = self.take_flags();
        let reported = self.log.as_ref().map(DebugLog::take_errors).unwrap_or_default();
        let mut messages: Vec<String> = reported.into_iter().map(|message| message.text).collect();
        if messages.is_empty() {
            messages = flags;
        }
        if messages.is_empty() { Ok(()) } else { Err(GlError { label: label.to_owned(), messages }) }
    }

    fn take_flags(&self) -> Vec<String> {
        // SAFETY: reads and clears the context's error flags.
        let next = || match unsafe { self.gl.get_error() } {
            glow::NO_ERROR => None,
            code => Some(error_name(code)),
        };
        std::iter::from_fn(next).take(MOST_FLAGS).collect()
    }
}
