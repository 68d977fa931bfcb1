//! Time that the device worked at something (GL_TIME_ELAPSED), read some frames later so that nothing waits for it.

use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Duration;

use glow::HasContext;

use crate::context::Context;

/// Times one thing again and again, a pass for example. Queries of one context must not nest.
pub struct Timer {
    gl: Rc<glow::Context>,
    idle: Vec<glow::Query>,
    /// Ended queries, oldest first.
    pending: VecDeque<glow::Query>,
    running: Option<glow::Query>,
}

impl Timer {
    /// `None` where the context has no timer queries.
    pub fn new(context: &dyn Context) -> Option<Self> {
        let gl = context.gl().clone();
        (context.timer_bits() > 0).then(|| Self { gl, idle: Vec::new(), pending: VecDeque::new(), running: None })
    }

    /// Starts the clock; without effect if it runs, or if GL gives no query object.
    pub fn begin(&mut self) {
        if self.running.is_some() {
            return;
        }
        // SAFETY: the context is current, and the query is no longer pending.
        unsafe {
            let query = self.idle.pop().or_else(|| self.gl.create_query().ok());
            if let Some(query) = query {
                self.gl.begin_query(glow::TIME_ELAPSED, query);
                self.running = Some(query);
            }
        }
    }

    /// Stops the clock.
    pub fn end(&mut self) {
        if let Some(query) = self.running.take() {
            // SAFETY: the query that runs is this one.
            unsafe { self.gl.end_query(glow::TIME_ELAPSED) };
            self.pending.push_back(query);
        }
    }

    /// The oldest time that is known by now, each once; does not wait.
    pub fn poll(&mut self) -> Option<Duration> {
        let query = *self.pending.front()?;
        // SAFETY: the query has ended and is not deleted.
        let available = unsafe { self.gl.get_query_parameter_u32(query, glow::QUERY_RESULT_AVAILABLE) };
        if available != 0 { self.take_oldest() } else { None }
    }

    /// The oldest time, waited for if it must be; `None` if nothing was timed.
    pub fn wait(&mut self) -> Option<Duration> {
        self.take_oldest()
    }

    fn take_oldest(&mut self) -> Option<Duration> {
        let query = self.pending.pop_front()?;
        // SAFETY: the query has ended and is not deleted; asking for its result waits until there is one.
        let nanoseconds = unsafe { self.gl.get_query_parameter_u64(query, glow::QUERY_RESULT) };
        self.idle.push(query);
        Some(Duration::from_nanos(nanoseconds))
    }
}

impl Drop for Timer {
    fn drop(&mut self) {
        self.end();
        for query in self.idle.drain(..).chain(self.pending.drain(..)) {
            // SAFETY: the query is this timer's own and is not used again.
            unsafe { self.gl.delete_query(query) };
        }
    }
}
