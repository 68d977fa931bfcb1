//! A child process of this program that is given work, is heard, and is ended if it takes too long: a crash of the driver, a
//! hang or a lack of memory ends the child and no more.
//!
//! A child tells its news on standard output, a JSON value a line. Its standard input stays open as long as it shall live.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;

use super::Error;

/// Between two ticks.
const TICK: Duration = Duration::from_millis(200);

/// Kind of end that no child should have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadEnd {
    /// A signal, or an exit of the driver's own.
    Crash,
    /// No word in time.
    Hang,
    /// Ended by the system, or by itself, for lack of memory.
    OutOfMemory,
}

/// News of a child.
pub enum Next<E> {
    /// A line of its own.
    Event(E),
    /// The end, and how: nothing if it ended as it should.
    End(Option<(BadEnd, String)>),
}

/// A child process. It is ended on drop.
pub struct ChildProcess {
    child: Child,
    lines: Receiver<String>,
    /// The text that it wrote on standard error, at the end of the thread that reads it.
    said: Option<JoinHandle<String>>,
    since: Instant,
}

impl ChildProcess {
    /// Starts this program with these words, and these variables where the environment has none of the name.
    ///
    /// # Errors
    ///
    /// The system's.
    pub fn start(words: &[String], variables: &[(&str, String)]) -> io::Result<Self> {
        let program = std::env::current_exe()?;
        let mut command = Command::new(program);
        command.args(words);
        command.envs(variables.iter().filter(|(name, _)| std::env::var_os(name).is_none()).cloned());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let (send, lines) = channel();
        if let Some(out) = child.stdout.take() {
            std::thread::spawn(move || {
                // Bytes: what a driver writes need not be UTF-8.
                let lines = BufReader::new(out).split(b'\n').map_while(Result::ok);
                lines.map(|line| String::from_utf8_lossy(&line).into_owned()).try_for_each(|line| send.send(line))
            });
        }
        let said = child.stderr.take().map(|err| std::thread::spawn(move || listen(err)));
        Ok(Self { child, lines, said, since: Instant::now() })
    }

    /// Writes a line on its standard input. If the child is gone, [`ChildProcess::next`] says so.
    pub fn send(&mut self, line: &str) {
        if let Some(input) = &mut self.child.stdin {
            let _ = writeln!(input, "{line}").and_then(|()| input.flush());
        }
    }

    /// Seconds since [`ChildProcess::next`] was called last.
    pub fn seconds(&self) -> f64 {
        self.since.elapsed().as_secs_f64()
    }

    /// Waits for the next event, or the end. Ends it if nothing comes in time, or if `tick`, called now and then, says so:
    /// that is no bad end.
    pub fn next<E: DeserializeOwned>(&mut self, limit: Duration, mut tick: impl FnMut() -> bool) -> Next<E> {
        self.since = Instant::now();
        loop {
            match self.lines.recv_timeout(TICK) {
                // Anything else is a driver's.
                Ok(line) => {
                    if let Ok(event) = serde_json::from_str(&line) {
                        return Next::Event(event);
                    }
                }
                Err(RecvTimeoutError::Timeout) if self.since.elapsed() > limit => {
                    self.end();
                    let how = format!("did not end in {} s, and was killed", limit.as_secs_f64());
                    return Next::End(Some((BadEnd::Hang, how)));
                }
                Err(RecvTimeoutError::Timeout) if !tick() => {
                    self.end();
                    return Next::End(None);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Next::End(self.child.wait().map_or_else(
                        |error| Some((BadEnd::Crash, format!("cannot be waited for: {error}"))),
                        how_it_ended,
                    ));
                }
            }
        }
    }

    fn end(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// Ends it, and gives what it wrote on standard error.
    pub fn finish(&mut self) -> String {
        drop(self.child.stdin.take());
        self.end();
        self.said.take().and_then(|thread| thread.join().ok()).unwrap_or_default()
    }
}

impl Drop for ChildProcess {
    fn drop(&mut self) {
        self.end();
    }
}

/// In a child: ends this process when standard input ends, which the parent holds, so that also a parent that is killed
/// leaves no child. `hear` gets each line of it.
pub fn end_with_parent(mut hear: impl FnMut(String) + Send + 'static) {
    std::thread::spawn(move || {
        let lines = BufReader::new(io::stdin()).split(b'\n').map_while(Result::ok);
        lines.for_each(|line| hear(String::from_utf8_lossy(&line).into_owned()));
        crate::process::leave(1);
    });
}

/// In a child: tells an event.
///
/// # Errors
///
/// Standard output that is closed: whoever started this process is no more.
pub fn tell(event: &impl serde::Serialize) -> Result<(), Error> {
    // A driver may have written on standard output, and left a line open.
    super::print(&format!("\n{}\n", serde_json::to_string(event)?))
}

/// Kind of an end by what a process said before it: its watchdog and its allocator end it themselves.
pub fn end_by_words(end: BadEnd, said: &str) -> BadEnd {
    match () {
        () if said.contains("out of memory") => BadEnd::OutOfMemory,
        () if said.contains("has done nothing for") => BadEnd::Hang,
        () => end,
    }
}

/// The last error that a process wrote on standard error, or its last line, after a colon.
pub fn quoted(said: &str) -> String {
    let lines = || said.lines().filter(|line| !line.trim().is_empty());
    let last = lines().rfind(|line| line.starts_with("error: ")).or_else(|| lines().next_back());
    last.map_or_else(String::new, |line| format!(": \"{}\"", line.trim()))
}

/// Reads to the end, and keeps the last part.
fn listen(mut stream: impl Read) -> String {
    const MOST: usize = 1 << 14;
    let (mut kept, mut part) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = stream.read(&mut part) {
        kept.extend_from_slice(&part[..count]);
        let surplus = kept.len().saturating_sub(MOST);
        kept.drain(..surplus);
    }
    String::from_utf8_lossy(&kept).into_owned()
}

/// The way in which a process ended; nothing if as it should.
fn how_it_ended(status: ExitStatus) -> Option<(BadEnd, String)> {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = crate::process::signal_name(signal);
        // Linux ends a process by SIGKILL where memory runs out; nobody else does it here.
        return Some(match name.as_str() {
            "SIGKILL" => {
                (BadEnd::OutOfMemory, "was killed by SIGKILL, as a system does that is out of memory".to_owned())
            }
            _ => (BadEnd::Crash, format!("crashed ({name})")),
        });
    }
    (!status.success()).then(|| (BadEnd::Crash, format!("ended itself ({status})")))
}
