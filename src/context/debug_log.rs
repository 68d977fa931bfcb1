//! Messages of a debug context (KHR_debug), collected until they are read.

use std::sync::{Arc, Mutex, PoisonError};

use glow::HasContext;

/// One message of the driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DebugMessage {
    /// GL_DEBUG_TYPE_*.
    pub kind: u32,
    /// Number of the message; the driver chooses it.
    pub id: u32,
    /// Text of the driver, without a line end of its own.
    pub text: String,
}

impl DebugMessage {
    /// Tests whether it reports a mistake: an error, or behaviour that GL leaves undefined.
    pub fn is_error(&self) -> bool {
        matches!(self.kind, glow::DEBUG_TYPE_ERROR | glow::DEBUG_TYPE_UNDEFINED_BEHAVIOR)
    }
}

/// The messages of one context; clones share the list. Drivers may report from threads of their own.
#[derive(Clone, Debug, Default)]
pub struct DebugLog(Arc<Mutex<Vec<DebugMessage>>>);

/// A log holds no more than this: a driver that reports each draw must not fill the memory.
const MOST_MESSAGES: usize = 64;

impl DebugLog {
    /// Takes the messages that have come since the last call, oldest first.
    pub fn take(&self) -> Vec<DebugMessage> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes the mistakes that have come since the last call, oldest first, and leaves other messages.
    pub fn take_errors(&self) -> Vec<DebugMessage> {
        let mut messages = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        messages.extract_if(.., |message| message.is_error()).collect()
    }

    fn push(&self, message: DebugMessage) {
        let mut messages = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if messages.len() >= MOST_MESSAGES {
            // A mistake takes the place of another message.
            let Some(other) = messages.iter().position(|known| message.is_error() && !known.is_error()) else { return };
            messages.remove(other);
        }
        messages.push(message);
    }
}

/// Has the context report to a new log, at the call that is at fault; `None` where it has no KHR_debug.
///
/// Must come before `gl` is shared, which is why it is done where contexts are made.
pub(super) fn attach(gl: &mut glow::Context) -> Option<DebugLog> {
    if !gl.supports_debug() {
        return None;
    }
    let log = DebugLog::default();
    let sink = log.clone();
    // SAFETY: the context is current; the callback is owned by `gl` and touches only the log.
    unsafe {
        gl.debug_message_callback(move |_source, kind, id, severity, text| {
            let message = DebugMessage { kind, id, text: text.trim_end().to_owned() };
            if message.is_error() || severity == glow::DEBUG_SEVERITY_HIGH {
                sink.push(message);
            }
        });
        gl.enable(glow::DEBUG_OUTPUT);
        gl.enable(glow::DEBUG_OUTPUT_SYNCHRONOUS);
    }
    Some(log)
}
