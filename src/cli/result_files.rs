//! Files of a run's results: tried before it, written as results come, and whole at every moment.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use super::Error;
use super::json::is_standard_stream;
use crate::output::{self, atomic_write};

/// Refuses two options that name one file.
///
/// # Errors
///
/// The first two.
pub fn refuse_one_file_for_two(files: &[(&'static str, Option<&Path>)]) -> Result<(), Error> {
    let files: Vec<_> = files.iter().filter_map(|(name, path)| Some((*name, (*path)?))).collect();
    for (index, (first, path)) in files.iter().enumerate() {
        if let Some((second, _)) = files[index + 1..].iter().find(|(_, other)| output::is_same_file(path, other)) {
            return Err(Error::SameFile { path: (*path).to_owned(), first, second });
        }
    }
    Ok(())
}

/// Makes the folder of a file, and tries whether the file can be written. Standard output is not tried.
///
/// # Errors
///
/// The folder that cannot be made, or the file that cannot be written.
pub fn try_to_write(path: &Path) -> Result<(), Error> {
    if is_standard_stream(path) {
        return Ok(());
    }
    let make_folder = || match path.parent() {
        Some(folder) if folder != Path::new("") => std::fs::create_dir_all(folder),
        _ => io::Result::Ok(()),
    };
    let tried = make_folder().and_then(|()| atomic_write::try_to_write(path));
    tried.map_err(|error| Error::WriteFile { path: path.to_owned(), error })
}

/// Writes all, or none. `-` is standard output.
///
/// # Errors
///
/// A file that cannot be written.
pub fn put(files: &[(&Path, String)]) -> Result<(), Error> {
    for (_, text) in files.iter().filter(|(path, _)| is_standard_stream(path)) {
        super::print(text)?;
    }
    let files: Vec<&(&Path, String)> = files.iter().filter(|(path, _)| !is_standard_stream(path)).collect();
    let paths: Vec<&Path> = files.iter().map(|(path, _)| *path).collect();
    let written = atomic_write::write_all(&paths, |index, path| std::fs::write(path, &files[index].1));
    written.map_err(|(index, error)| Error::WriteFile { path: paths[index].to_owned(), error })
}

/// Tests whether `path` can be written again and again: what goes into a pipe or a device cannot be taken back.
pub fn can_be_replaced(path: &Path) -> bool {
    !is_standard_stream(path) && path.metadata().map_or(true, |found| found.is_file())
}

/// Times of writing results that are not all there yet.
pub struct Pace {
    pause: Duration,
    next: Instant,
}

impl Pace {
    /// Part of a run's time that writing may take at most. Each write has all results so far: without a bound, the time for
    /// all of them would grow with the square of the number of results.
    const SHARE: u32 = 20;

    /// Writes at once, and then at most once in `pause`.
    pub fn new(pause: Duration) -> Self {
        Self { pause, next: Instant::now() }
    }

    /// Calls `write` if it is time to. Returns whether it did.
    ///
    /// # Errors
    ///
    /// Those of `write`.
    pub fn write(&mut self, write: impl FnOnce() -> Result<(), Error>) -> Result<bool, Error> {
        let begin = Instant::now();
        if begin < self.next {
            return Ok(false);
        }
        let written = write();
        self.next = Instant::now() + self.pause.max((Self::SHARE - 1) * begin.elapsed());
        written.map(|()| true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Calls a pace without a rest for `time`, with writes of `each`. Returns the writes.
    fn writes(pause: Duration, each: Duration, time: Duration) -> u32 {
        let (mut pace, mut count, begin) = (Pace::new(pause), 0, Instant::now());
        while begin.elapsed() < time {
            count += u32::from(
                pace.write(|| {
                    std::thread::sleep(each);
                    Ok(())
                })
                .unwrap(),
            );
        }
        count
    }

    /// A write that takes long makes the next one come late. Sleeps may last longer, never shorter, so that these are the
    /// greatest numbers.
    #[test]
    fn writes_are_far_apart() {
        let ms = Duration::from_millis;
        let count = writes(ms(20), ms(0), ms(210));
        assert!((1..=11).contains(&count), "{count} in 210 ms, one in 20 ms");
        let count = writes(ms(20), ms(5), ms(210));
        assert!((1..=3).contains(&count), "{count} in 210 ms, each of 5 ms and followed by 95 ms");
    }
}
