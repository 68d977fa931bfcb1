//! An X server without a screen, for as long as a test needs one.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// Ends its server when dropped.
pub struct Xvfb {
    server: Child,
    display: String,
}

impl Xvfb {
    /// Starts a server on a display number that is free; `None` where Xvfb is not installed or does not start.
    pub fn start() -> Option<Self> {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        // The server writes its number when it is ready; the end of the pipe means that it is gone.
        let mut number = String::new();
        let answer = server.stdout.take().map(|out| BufReader::new(out).read_line(&mut number));
        let server = Self { server, display: format!(":{}", number.trim()) };
        matches!(answer, Some(Ok(length)) if length > 0).then_some(server)
    }

    /// The value of DISPLAY.
    pub fn display(&self) -> &str {
        &self.display
    }
}

impl Drop for Xvfb {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
