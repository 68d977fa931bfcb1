//! Pixel cases, one test a folder: `data/cases/<row>/<case>/`, the row of a technique or a composition, with a `case.toml` that says what must be seen. How it
//! is written: `tests/cases/file.rs`. Everything here judges pictures from outside: it reads the resolved scene, never
//! matrices, planes or pass lists. What judges is itself tested to fail, on the same context.
//!
//! `cargo test --test cases [FILTER]`; `ci/bless [FILTER]` regenerates golden images.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial};

mod bench;
mod check;
mod comparator;
mod compare;
mod draw;
mod file;
mod formula;
mod golden;
mod picture;
mod refusals;
mod refused;

use file::Case;

/// Scenes that several cases share; no technique's folder.
const SHARED: &str = "scenes";

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // llvmpipe has threads of its own, and one context serves all.
    arguments.test_threads.get_or_insert(1);
    if !arguments.list {
        println!("{}", draw::driver());
    }
    libtest_mimic::run(&arguments, trials()).exit_code()
}

fn trials() -> Vec<Trial> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases");
    let mut trials = vec![Trial::test("every_row_has_a_case", {
        let root = root.clone();
        move || every_row_has_a_case(&root).map_err(Into::into)
    })];
    // They draw goldens of their own, which blessing would refuse.
    if !golden::blessing() {
        let tests = comparator::TESTS.iter().chain(refusals::TESTS);
        trials.extend(tests.map(|(name, test)| {
            Trial::test(*name, || {
                test();
                Ok(())
            })
        }));
    }
    for technique in folders(&root).into_iter().filter(|folder| name(folder) != SHARED) {
        for folder in folders(&technique) {
            let title = format!("{}/{}", name(&technique), name(&folder));
            trials.push(Trial::test(title.clone(), move || {
                check::run(&Case::read(&folder, &title)?)?;
                Ok(())
            }));
        }
    }
    trials
}

/// A technique or composition without a case is untested, and a folder without either is never looked for.
fn every_row_has_a_case(root: &Path) -> Result<(), String> {
    let techniques = glumbra::techniques::TABLE.iter().map(|row| row.name());
    let known: Vec<&str> = techniques.chain(glumbra::compositions::TABLE.iter().map(|row| row.name())).collect();
    for row in &known {
        if folders(&root.join(row)).is_empty() {
            return Err(format!("the row \"{row}\" has no case in {}/{row}", root.display()));
        }
    }
    match folders(root).iter().map(|folder| name(folder)).find(|name| name != SHARED && !known.contains(&&**name)) {
        Some(name) => Err(format!("{}/{name} is the folder of no technique and no composition", root.display())),
        None => Ok(()),
    }
}

/// The folders in `path`, sorted.
fn folders(path: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
