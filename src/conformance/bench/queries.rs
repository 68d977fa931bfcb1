//! Queries around draws: samples that pass, and time.

use glow::HasContext;

use super::{Bench, Error, no};

pub(super) type BeginConditional = unsafe extern "system" fn(u32, u32);
pub(super) type EndConditional = unsafe extern "system" fn();

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

    /// Tests whether conditional rendering exists.
    pub fn has_conditional(&self) -> bool {
        self.conditional.is_some()
    }

    /// Does `work` under the condition that `query` draws samples, in a mode of glBeginConditionalRender.
    ///
    /// # Errors
    ///
    /// GL's, and those of `query` and `work`.
    pub fn conditional(
        &self,
        mode: u32,
        query: impl FnOnce() -> Result<(), Error>,
        work: impl FnOnce() -> Result<(), Error>,
    ) -> Result<(), Error> {
        let Some((begin, end)) = self.conditional else { return Ok(()) };
        let gl = &self.gl;
        // SAFETY: the context is current; the query is deleted here, when it is no condition any more.
        unsafe {
            let name = gl.create_query().map_err(no("query"))?;
            gl.begin_query(glow::SAMPLES_PASSED, name);
            let asked = query();
            gl.end_query(glow::SAMPLES_PASSED);
            begin(name.0.get(), mode);
            let worked = work();
            end();
            gl.delete_query(name);
            asked.and(worked)?;
        }
        self.check("conditional rendering")
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
