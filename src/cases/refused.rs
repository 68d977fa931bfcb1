//! Errors of a case file: checks that could not fail, and checks that would not be made. Found before anything is drawn.

use super::file::{Checks, ClassCount, Golden, MayBeWrong, Pick, Same, Sets, Sum, TruthCheck};
use super::placeholders;

/// The widest band beside a shadow's edge, in pixels: an edge that is further off is another one.
const WIDEST: f64 = 16.0;

/// The check that is refused, by its key and its number from 0 (none: the whole file), and why.
pub type RefusedCheck = (Option<(&'static str, usize)>, String);

/// The largest difference, in 255ths, that may lie in every pixel: what roundings add up to. The picture would be another
/// with more.
const EVERYWHERE: f64 = 4.0;

/// The share of the pixels in which any difference may lie: the rims of shadows and objects. A picture without its shadow
/// would pass with more.
const ANYTHING: f64 = 0.05;

impl Checks {
    /// Tests whether there is no check that could fail.
    pub fn is_empty(&self) -> bool {
        let lists = self.pick.len() + self.edge.len() + self.cone.len() + self.same.len() + self.truth.len();
        let words = [&self.fails_with, &self.warns, &self.leaves_out];
        lists + self.after.len() + self.sum.len() == 0
            && !self.count.iter().any(ClassCount::can_fail)
            && self.golden.is_none()
            && words.iter().all(|text| text.is_none())
    }
}

impl ClassCount {
    fn can_fail(&self) -> bool {
        self.least > 0.0 || self.most < 1.0
    }
}

/// Refuses a file where a check of it is worth nothing.
///
/// # Errors
///
/// The first such check, with its `why`.
pub fn check(checks: &Checks) -> Result<(), RefusedCheck> {
    whole(checks)?;
    each("pick", &checks.pick, pick)?;
    each("edge", &checks.edge, |edge| sets(edge.for_each.as_ref(), &edge.why))?;
    each("cone", &checks.cone, |cone| sets(cone.for_each.as_ref(), &cone.why))?;
    each("count", &checks.count, count)?;
    each("same", &checks.same, same)?;
    each("after", &checks.after, |after| {
        let nothing = after.of.is_empty() || after.firsts.is_empty();
        refuse(nothing, || format!("`after` compares nothing ({})", after.why))
    })?;
    each("sum", &checks.sum, sum)?;
    each("truth", &checks.truth, truth)?;
    each("golden", checks.golden.as_slice(), golden)?;
    beside_command(checks)
}

fn whole(checks: &Checks) -> Result<(), RefusedCheck> {
    let at = |key: &'static str| move |message: String| (Some((key, 0)), message);
    refuse(checks.is_empty(), || String::from("the case has no checks that could fail")).map_err(|why| (None, why))?;
    if checks.fails_with.is_some() {
        let others = Checks { fails_with: None, ..checks.clone() };
        let alone = others.is_empty() && others.count.is_empty();
        refuse(!alone, || String::from("no check can stand beside `fails_with`: nothing is drawn"))
            .map_err(at("fails_with"))?;
    }
    sets(checks.for_each.as_ref(), "the case").map_err(at("for_each"))?;
    let several = checks.for_each.is_some() && checks.golden.is_some();
    refuse(several, || String::from("a golden cannot be the picture of each set of `for_each`")).map_err(at("golden"))
}

fn each<T>(kind: &'static str, checks: &[T], refuse: impl Fn(&T) -> Result<(), String>) -> Result<(), RefusedCheck> {
    let mut numbered = checks.iter().enumerate();
    numbered.try_for_each(|(index, check)| refuse(check).map_err(|why| (Some((kind, index)), why)))
}

/// Refuses what only glumbra's own plan can answer where a command draws, and a command that cannot draw.
fn beside_command(checks: &Checks) -> Result<(), RefusedCheck> {
    let Some(words) = &checks.render else { return Ok(()) };
    placeholders::check(words, checks).map_err(|why| (Some(("render", 0)), why))?;
    let overrides = "changes the scene for glumbra only, and the command reads the scene's file: write another scene";
    let words = "is a word of glumbra's own plan, and a command has none";
    let drawn = "draws again by glumbra with other settings, which a command does not take";
    let keys = [
        ("set", !checks.set.is_empty(), overrides),
        ("for_each", checks.for_each.is_some(), overrides),
        ("fails_with", checks.fails_with.is_some(), words),
        ("warns", checks.warns.is_some(), words),
        ("leaves_out", checks.leaves_out.is_some(), words),
        ("same", !checks.same.is_empty(), drawn),
        ("after", !checks.after.is_empty(), drawn),
        ("sum", !checks.sum.is_empty(), drawn),
    ];
    if let Some((key, _, why)) = keys.into_iter().find(|(_, is_there, _)| *is_there) {
        return Err((Some((key, 0)), format!("`{key}` cannot stand beside `render`: it {why}")));
    }
    let refuse = |set: &[String], for_each: Option<&Sets>| match set.is_empty() && for_each.is_none() {
        true => Ok(()),
        false => Err(format!("`set` and `for_each` cannot stand beside `render`: each {overrides}")),
    };
    each("pick", &checks.pick, |check| refuse(&check.set, check.for_each.as_ref()))?;
    each("edge", &checks.edge, |check| refuse(&check.set, check.for_each.as_ref()))?;
    each("cone", &checks.cone, |check| refuse(&check.set, check.for_each.as_ref()))?;
    each("count", &checks.count, |check| refuse(&check.set, check.for_each.as_ref()))?;
    each("truth", &checks.truth, |check| {
        refuse(&check.set, check.for_each.as_ref())?;
        match check.bound {
            Some(MayBeWrong::Technique) => Err(format!(
                "`bound = \"technique\"` is glumbra's own technique, and a command's is not known: write `band`, in pixels, \
                 or `bound = \"exact\"` ({})",
                check.why
            )),
            _ => Ok(()),
        }
    })
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

fn count(count: &ClassCount) -> Result<(), String> {
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

/// The limits of a check against truth must leave no room for a shadow that is not there.
fn truth(truth: &TruthCheck) -> Result<(), String> {
    sets(truth.for_each.as_ref(), &truth.why)?;
    refuse(truth.bound.is_some() && truth.band.is_some(), || {
        format!("a check against truth has `bound` or `band`, not both ({})", truth.why)
    })?;
    for (key, pixels) in [("band", truth.band), ("edge", truth.edge)] {
        refuse(pixels.is_some_and(|pixels| !(0.0..=WIDEST).contains(&pixels)), || {
            format!("`{key}` must be from 0 to {WIDEST} pixels ({})", truth.why)
        })?;
    }
    let limits = [("false_shadow", truth.false_shadow), ("leak", truth.leak), ("outside_band", truth.outside_band)];
    limits.into_iter().try_for_each(|(key, percent)| {
        refuse(!(0.0..=100.0 * ANYTHING).contains(&percent), || {
            format!(
                "`{key}` = {percent} is no percentage from 0 to {}: a shadow could be missing ({})",
                100.0 * ANYTHING,
                truth.why
            )
        })
    })
}

fn golden(golden: &Golden) -> Result<(), String> {
    refuse(golden.max > EVERYWHERE, || {
        format!("a golden may be {}/255 off: more than {EVERYWHERE}/255 ({})", golden.max, golden.why)
    })
}
