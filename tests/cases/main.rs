//! Our own pixel cases, one test a folder: `data/cases/ROW/CASE/`, the row of a technique or a composition. They run through
//! `glumbra::cases`, as `glumbra test data/cases` runs them; what judges is itself tested to fail, on the same context.
//!
//! `cargo test --test cases [FILTER]`; `ci/bless [FILTER]` regenerates golden images.

use std::cell::RefCell;
use std::fs;
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use glumbra::cases::{self, CaseRunner, PixelCase, Settings};
use libtest_mimic::{Arguments, Trial};

mod comparator;
mod failing;
mod refusals;

/// Scenes that several cases share; no technique's folder.
const SHARED: &str = "scenes";

thread_local! {
    /// One thread's runner, kept until the process ends: drivers differ in what they bear when a thread ends.
    static RUNNER: RefCell<ManuallyDrop<CaseRunner>> = RefCell::new(ManuallyDrop::new(CaseRunner::new(settings())));
}

fn settings() -> Settings {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("target"));
    let limit = Duration::from_secs(5);
    Settings { failures: target.join("case-failures"), bless: blessing(), limit, ..Settings::default() }
}

/// Tests whether `ci/bless` runs, which writes goldens.
fn blessing() -> bool {
    std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1")
}

/// Does something with this thread's runner.
pub fn with_runner<T>(act: impl FnOnce(&mut CaseRunner) -> T) -> T {
    RUNNER.with_borrow_mut(|runner| act(runner))
}

/// Makes the checks of a case. The error has the question, what was found, and the pictures.
pub fn run(case: &PixelCase) -> Result<(), String> {
    let outcome = with_runner(|runner| runner.run(case));
    match outcome.failure() {
        Some(failure) => Err(failure),
        None => {
            outcome.measured.iter().for_each(|measured| println!("{}: {measured}", case.name));
            Ok(())
        }
    }
}

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // llvmpipe has threads of its own, and one context serves all.
    arguments.test_threads.get_or_insert(1);
    if !arguments.list {
        let driver = with_runner(|runner| runner.drawer().driver());
        println!("{}", driver.unwrap_or_else(|error| error.to_string()));
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
    if !blessing() {
        let tests = comparator::TESTS.iter().chain(refusals::TESTS).chain(failing::TESTS);
        trials.extend(tests.map(|(name, test)| {
            Trial::test(*name, || {
                test();
                Ok(())
            })
        }));
    }
    match cases::find(&[root]) {
        Ok(found) => trials.extend(found.into_iter().map(|case| {
            Trial::test(case.name.clone(), move || {
                let case = PixelCase::read(&case.folder, &case.name).map_err(|error| error.to_string())?;
                Ok(run(&case)?)
            })
        })),
        Err(error) => trials.push(Trial::test("cases_are_found", move || Err(error.into()))),
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
        if let Some(empty) = folders(&root.join(row)).iter().find(|folder| !folder.join(cases::FILE).is_file()) {
            return Err(format!("{} has no {}", empty.display(), cases::FILE));
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
