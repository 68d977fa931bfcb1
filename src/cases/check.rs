//! Makes a case's checks, in the order of its file. The first that fails ends the case. Every picture that is drawn has been
//! checked for GL errors before.

use super::bench::CaseBench;
use super::draw::Wanted;
use super::file::Sets;
use super::golden::{self, GoldenFile, GoldenResult};
use super::outcome::{CaseVerdict, Failure};
use super::{floors, picks, relations, truths};

/// Kinds of checks, in the order in which they are made: keys of the file, and `gl` for GL errors.
pub const KINDS: [&str; 13] = [
    "gl",
    "fails_with",
    "warns",
    "leaves_out",
    "pick",
    "edge",
    "cone",
    "count",
    "same",
    "after",
    "sum",
    "truth",
    "golden",
];

/// Makes every check of one variant of a case.
///
/// # Errors
///
/// The first check that fails, with what it measured and where the pictures are.
pub(super) fn run(on: &CaseBench) -> Result<(), Failure> {
    let checks = &on.case.checks;
    if let Some(text) = &checks.fails_with {
        return fails_with(on, text).map_err(|failure| failure.at("fails_with", 0));
    }
    for (kind, wanted) in [("warns", &checks.warns), ("leaves_out", &checks.leaves_out)] {
        wanted.iter().try_for_each(|text| says(on, kind, text)).map_err(|failure| failure.at(kind, 0))?;
    }
    each("pick", &checks.pick, |each| repeat(each.for_each.as_ref(), |set| picks::pick(on, each, set)))?;
    each("edge", &checks.edge, |each| repeat(each.for_each.as_ref(), |set| floors::edge(on, each, set)))?;
    each("cone", &checks.cone, |each| repeat(each.for_each.as_ref(), |set| floors::cone(on, each, set)))?;
    each("count", &checks.count, |each| repeat(each.for_each.as_ref(), |set| floors::count(on, each, set)))?;
    each("same", &checks.same, |each| repeat(each.for_each.as_ref(), |set| relations::same(on, each, set)))?;
    each("after", &checks.after, |each| relations::after(on, each))?;
    each("sum", &checks.sum, |each| relations::sum(on, each))?;
    each("truth", &checks.truth, |each| repeat(each.for_each.as_ref(), |set| truths::truth(on, each, set)))?;
    each("golden", checks.golden.as_slice(), |wanted| golden(on, wanted))
}

/// Makes the checks of a kind.
fn each<T>(kind: &'static str, checks: &[T], check: impl Fn(&T) -> Result<(), Failure>) -> Result<(), Failure> {
    let mut numbered = checks.iter().enumerate();
    numbered.try_for_each(|(index, each)| check(each).map_err(|failure| failure.at(kind, index)))
}

/// Makes a check with each set of its `for_each`, or once where it has none.
fn repeat(for_each: Option<&Sets>, check: impl Fn(&[String]) -> Result<(), Failure>) -> Result<(), Failure> {
    let Some(sets) = for_each else { return check(&[]) };
    sets.iter().try_for_each(|set| check(set).map_err(|failure| failure.under(&format!("for_each {set:?}"))))
}

fn fails_with(on: &CaseBench, text: &str) -> Result<(), Failure> {
    match on.draw(&[], Wanted::Picture) {
        Ok(_) => Err(format!("the scene draws; it should fail with \"{text}\"").into()),
        Err(error) if error.message.contains(text) => Ok(()),
        Err(error) => Err(format!("the error is \"{}\", without \"{text}\"", error.message).into()),
    }
}

/// Warnings or what was left out.
fn says(on: &CaseBench, kind: &str, text: &str) -> Result<(), Failure> {
    let drawn = on.draw(&[], Wanted::Picture)?;
    let said = if kind == "warns" { &drawn.warnings } else { &drawn.left_out };
    match said.iter().any(|line| line.contains(text)) {
        true => Ok(()),
        false => Err(format!("nothing says \"{text}\": {said:?}").into()),
    }
}

fn golden(on: &CaseBench, wanted: &super::file::Golden) -> Result<(), Failure> {
    let drawn = on.draw(&[], Wanted::Picture)?;
    let actual = &drawn.picture;
    let of = GoldenFile { folder: &on.case.folder, texts: on.texts(golden::GOLDEN) };
    match golden::check(actual, wanted, &of, &on.driver()?, on.shared.bless)? {
        GoldenResult::Same(how) => {
            on.note(format!("golden: {how}"));
            Ok(())
        }
        GoldenResult::Wrong { why, expected } => Err(on.failure(why, actual, expected.as_ref())),
        GoldenResult::Written(how) => Err(Failure::new(CaseVerdict::Blessed, how)),
    }
}
