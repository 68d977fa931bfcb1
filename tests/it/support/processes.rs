//! Child processes of a process under test, by /proc.

use std::io::Read;
use std::time::{Duration, Instant};

/// The processes whose parent is `id`.
pub fn children_of(id: u32) -> Vec<u32> {
    let parent_of = |child: u32| {
        let mut stat = String::new();
        std::fs::File::open(format!("/proc/{child}/stat")).ok()?.read_to_string(&mut stat).ok()?;
        stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse::<u32>().ok()
    };
    let all = std::fs::read_dir("/proc").unwrap().flatten();
    let ids = all.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    ids.filter(|child| parent_of(*child) == Some(id)).collect()
}

/// Waits until all of them have ended.
pub fn await_end(processes: &[u32]) {
    let is_alive =
        |id: &u32| std::fs::read_to_string(format!("/proc/{id}/stat")).is_ok_and(|stat| !stat.contains(" Z "));
    let start = Instant::now();
    while processes.iter().any(is_alive) {
        assert!(start.elapsed() < Duration::from_secs(10), "a child goes on");
        std::thread::sleep(Duration::from_millis(50));
    }
}
