//! Errors of a case file: checks that could not fail, and checks that would not be made. Found before anything is drawn.

use super::file::{Case, Checks, Count, Golden, Pick, Same, Sets, Sum};

/// The largest difference, in 255ths, that may lie in every pixel: what roundings add up to. The picture would be another
/// with more.
const EVERYWHERE: f64 = 4.0;

/// The share of the pixels in which any difference may lie: the rims of shadows and objects. A picture without its shadow
/// would pass with more.
const ANYTHING: f64 = 0.05;

impl Checks {
    /// Tests whether there is no check that could fail.
    pub fn is_empty(&self) -> bool {
        let lists = self.pick.len() + self.edge.len() + self.cone.len() + self.same.len();
        let words = [&self.fails_with, &self.warns, &self.leaves_out];
        lists + self.after.len() + self.sum.len() == 0
            && !self.count.iter().any(Count::can_fail)
            && self.golden.is_none()
            && words.iter().all(|text| text.is_none())
    }
}

impl Count {
    fn can_fail(&self) -> bool {
        self.least > 0.0 || self.most < 1.0
    }
}

/// Refuses `case` where a check of it is worth nothing.
///
/// # Errors
///
/// The first such check, with its `why`.
pub fn check(case: &Case) -> Result<(), String> {
    let checks = &case.checks;
    refuse(checks.is_empty(), || String::from("the case has no checks that could fail"))?;
    if checks.fails_with.is_some() {
        let others = Checks { fails_with: None, ..checks.clone() };
        let alone = others.is_empty() && others.count.is_empty();
        refuse(!alone, || String::from("no check can stand beside `fails_with`: nothing is drawn"))?;
    }
    sets(checks.for_each.as_ref(), "the case")?;
    let several = checks.for_each.is_some() && checks.golden.is_some();
    refuse(several, || String::from("a golden cannot be the picture of each set of `for_each`"))?;
    checks.pick.iter().try_for_each(pick)?;
    checks.edge.iter().try_for_each(|edge| sets(edge.for_each.as_ref(), &edge.why))?;
    checks.cone.iter().try_for_each(|cone| sets(cone.for_each.as_ref(), &cone.why))?;
    checks.count.iter().try_for_each(count)?;
    checks.same.iter().try_for_each(same)?;
    checks.after.iter().try_for_each(|after| {
        let nothing = after.of.is_empty() || after.firsts.is_empty();
        refuse(nothing, || format!("`after` compares nothing ({})", after.why))
    })?;
    checks.sum.iter().try_for_each(sum)?;
    checks.golden.iter().try_for_each(golden)
}

fn refuse(wrong: bool, why: impl FnOnce() -> String) -> Result<(), String> {
    if wrong { Err(why()) } else { Ok(()) }
}

fn sets(for_each: Option<&Sets>, why: &str) -> Result<(), String> {
    refuse(for_each.is_some_and(Vec::is_empty), || format!("`for_each` has no sets: nothing would be checked ({why})"))
}

fn pick(pick: &Pick) -> Result<(), String> {
    sets(pick.for_each.as_ref(), &pick.why)?;
    let asked = [pick.class.is_some(), pick.shade.is_some(), pick.color.is_some(), pick.formula.is_some()];
    refuse(!asked.contains(&true), || format!("a pick expects nothing ({})", pick.why))?;
    refuse(pick.within >= 255.0, || format!("a pick within {} cannot fail ({})", pick.within, pick.why))
}

fn count(count: &Count) -> Result<(), String> {
    sets(count.for_each.as_ref(), &count.why)?;
    refuse(!count.can_fail(), || format!("a count needs `least` above 0 or `most` below 1 ({})", count.why))
}

fn same(same: &Same) -> Result<(), String> {
    let Same { with, why, .. } = same;
    sets(same.for_each.as_ref(), why)?;
    refuse(same.of.is_empty() || same.sets.is_empty(), || format!("`same` compares nothing ({why})"))?;
    let itself = same.scene.is_none() && same.sets.contains(with);
    refuse(itself, || format!("`same` compares {with:?} with itself ({why})"))?;
    let (max, share) = match (same.exact, same.max, same.share) {
        (true, None, None) => return Ok(()),
        (false, Some(max), Some(share)) => (max, share),
        _ => return Err(format!("`same` needs exact = true, or max and share ({why})")),
    };
    refuse(255.0 * max > EVERYWHERE && share > ANYTHING, || {
        format!(
            "`same` lets a share of {share} differ by {max}: either max is at most {EVERYWHERE}/255, or share at most \
             {ANYTHING} ({why})"
        )
    })
}

fn sum(sum: &Sum) -> Result<(), String> {
    refuse(sum.plus.is_empty(), || format!("a sum adds nothing ({})", sum.why))?;
    refuse(255.0 * sum.max > EVERYWHERE, || {
        format!("a sum may be {} off: more than {EVERYWHERE}/255 ({})", sum.max, sum.why)
    })
}

fn golden(golden: &Golden) -> Result<(), String> {
    refuse(golden.max > EVERYWHERE, || {
        format!("a golden may be {}/255 off: more than {EVERYWHERE}/255 ({})", golden.max, golden.why)
    })
}
