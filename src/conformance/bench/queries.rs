//! Queries around draws: samples that pass, and time.

use glow::HasContext;

use super::{Bench, Error, no};

/// Attempts at a result after glFinish, before it counts as never there.
const ATTEMPTS: usize = 1000;

impl Bench {
    /// GL_SAMPLES_PASSED of what `work` draws, and whether the result was there after glFinish.
    ///
    /// # Errors
    ///
    /// GL's, and those of `work`.
    pub fn samples(&self, work: impl FnOnce() -> Result<(), Error>) -> Result<(u64, bool), Error> {
        self.queried(glow::SAMPLES_PASSED, work)
    }

    /// GL_TIME_ELAPSED of what `work` draws in nanoseconds, and whether the result was there after glFinish.
    ///
    /// # Errors
    ///
    /// GL's, and those of `work`.
    pub fn elapsed(&self, work: impl FnOnce() -> Result<(), Error>) -> Result<(u64, bool), Error> {
        self.queried(glow::TIME_ELAPSED, work)
    }

    fn queried(&self, target: u32, work: impl FnOnce() -> Result<(), Error>) -> Result<(u64, bool), Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the query is deleted here.
        unsafe {
            let query = gl.create_query().map_err(no("query"))?;
            gl.begin_query(target, query);
            let worked = work();
            gl.end_query(target);
            gl.finish();
            let there = (0..ATTEMPTS).any(|_| gl.get_query_parameter_u32(query, glow::QUERY_RESULT_AVAILABLE) != 0);
            // The device reads samples as 32 bits, and times as 64.
            let result = match target {
                glow::SAMPLES_PASSED => u64::from(gl.get_query_parameter_u32(query, glow::QUERY_RESULT)),
                _ => gl.get_query_parameter_u64(query, glow::QUERY_RESULT),
            };
            gl.delete_query(query);
            worked?;
            self.check("a query")?;
            Ok((result, there))
        }
    }

    /// Waits until all is drawn.
    pub fn finish(&self) {
        // SAFETY: the context is current.
        unsafe { self.gl.finish() };
    }
}
