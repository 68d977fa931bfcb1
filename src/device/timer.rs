//! GL_TIME_ELAPSED queries.

use std::rc::Rc;

use glow::HasContext;

/// A running or ended query, deleted on drop.
pub struct Timer {
    gl: Rc<glow::Context>,
    query: glow::Query,
}

impl Drop for Timer {
    fn drop(&mut self) {
        unsafe { self.gl.delete_query(self.query) };
    }
}

impl Timer {
    /// Starts counting; `None` where the driver makes no query.
    pub fn start(gl: &Rc<glow::Context>) -> Option<Self> {
        let query = unsafe { gl.create_query() }.ok()?;
        unsafe { gl.begin_query(glow::TIME_ELAPSED, query) };
        Some(Self { gl: gl.clone(), query })
    }

    pub fn end(self) -> Self {
        unsafe { self.gl.end_query(glow::TIME_ELAPSED) };
        self
    }

    /// Waits for the result; `None` where the driver counted nothing.
    pub fn milliseconds(&self) -> Option<f64> {
        let nanoseconds = unsafe { self.gl.get_query_parameter_u32(self.query, glow::QUERY_RESULT) };
        (nanoseconds > 0).then_some(f64::from(nanoseconds) * 1e-6)
    }
}
