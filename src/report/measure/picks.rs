//! Recommended settings: the cheapest below an error, the most exact below a time, and how far the times can be trusted.
//!
//! A measured time is the work's own and what else the machine did meanwhile, which only adds. Two signs show how much that
//! is: the runs of one row, and rows whose passes are the same work (their polygon offsets differ, for example). On a
//! loaded machine the least of a row's runs is nearest to its own time, otherwise the median is taken. Two times cannot be
//! distinguished if their bars overlap: a bar reaches from the least to the greatest run of a row and of all of its work.

use std::collections::HashMap;

use crate::judge::metrics::FEWEST_COMPARED;
use crate::report::numbers::{grouped, plain};
use crate::report::store::results::{Measured, Row, SceneReport, Spread};

/// Limits for the recommended settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goals {
    /// The cheapest setting that is wrong in at most so many percent is named.
    pub wrong_percent: f64,
    /// The most exact setting whose redrawn frame takes at most so long is named.
    pub milliseconds: f64,
}

impl Default for Goals {
    /// One percent; a frame of 60 a second.
    fn default() -> Self {
        Self { wrong_percent: 1.0, milliseconds: 16.7 }
    }
}

/// Beyond this ratio of times that should be the same, a row is unsteady.
const UNSTEADY: f64 = 1.25;
/// One unsteady row in so many makes a loaded machine.
const LOADED_FROM: usize = 10;

/// Spread of a scene's times.
#[derive(Debug, Default)]
pub struct RowTimes<'r> {
    /// Measured rows.
    pub rows: usize,
    /// Rows whose median run takes much longer than the least.
    pub unsteady: usize,
    /// Twins: rows that do the same work as others.
    pub twins: usize,
    /// Twins whose least run takes much longer than that of another.
    pub unlike: usize,
    /// The least and the greatest run of all rows of a work.
    bars: HashMap<&'r str, [f64; 2]>,
}

impl<'r> RowTimes<'r> {
    /// Statistics of the scene's measured rows.
    pub fn of(scene: &'r SceneReport) -> Self {
        let mut times = Self::default();
        let mut works: HashMap<&str, Vec<Spread>> = HashMap::new();
        for measured in scene.rows.iter().filter_map(Row::measured) {
            let spread = measured.frame_redrawn;
            times.rows += 1;
            times.unsteady += usize::from(spread.median > UNSTEADY * spread.least);
            if !measured.work.is_empty() {
                works.entry(&measured.work).or_default().push(spread);
            }
        }
        for (work, spreads) in works.into_iter().filter(|(_, spreads)| spreads.len() > 1) {
            let least = |of: fn(&Spread) -> f64| spreads.iter().map(of).fold(f64::INFINITY, f64::min);
            let greatest = |of: fn(&Spread) -> f64| spreads.iter().map(of).fold(0.0, f64::max);
            times.twins += spreads.len();
            let most = UNSTEADY * least(|spread| spread.least);
            times.unlike += spreads.iter().filter(|spread| spread.least > most).count();
            times.bars.insert(work, [least(|spread| spread.least), greatest(|spread| spread.greatest)]);
        }
        times
    }

    /// Tests whether the machine did much else meanwhile.
    pub fn is_loaded(&self) -> bool {
        self.unsteady * LOADED_FROM > self.rows || self.unlike * LOADED_FROM > self.twins
    }

    /// The time that a row is ranked by, in milliseconds.
    pub fn of_row(&self, measured: &Measured) -> f64 {
        if self.is_loaded() { measured.frame_redrawn.least } else { measured.frame_redrawn.median }
    }

    /// From the least to the greatest run of the row and of those that do the same work, in milliseconds.
    pub fn bar(&self, measured: &Measured) -> [f64; 2] {
        let own = [measured.frame_redrawn.least, measured.frame_redrawn.greatest];
        self.bars.get(measured.work.as_str()).copied().unwrap_or(own)
    }

    /// Names the time.
    pub fn name(&self) -> &'static str {
        if self.is_loaded() { "least" } else { "median" }
    }

    /// Warning about a loaded machine.
    pub fn warning(&self) -> Option<String> {
        let percent = plain(100.0 * (UNSTEADY - 1.0));
        self.is_loaded().then(|| {
            format!(
                "The machine did other work meanwhile: in {} of {} rows the median run took over {percent} % longer than the \
                 least, and of {} rows that do the same work as others {} took over {percent} % longer than the fastest. \
                 Settings are picked by the least of their runs.",
                self.unsteady, self.rows, self.twins, self.unlike
            )
        })
    }
}

/// A recommended setting.
#[derive(Debug)]
pub struct Pick<'r> {
    /// The row.
    pub row: &'r Row,
    /// Its measurement.
    pub measured: &'r Measured,
    /// Time that it was picked by.
    pub milliseconds: f64,
    /// See [`RowTimes::bar`].
    pub bar: [f64; 2],
    /// Rows that the times cannot rule out in its place.
    pub rivals: Vec<&'r Row>,
    /// True if its bar reaches beyond the requested time.
    pub may_be_late: bool,
}

/// Both recommendations for a scene, and their basis.
#[derive(Debug)]
pub struct Picks<'r> {
    /// Spread of the times that both are picked by.
    pub times: RowTimes<'r>,
    /// The fastest row that is exact enough; `None`: no row is.
    pub cheapest: Option<Pick<'r>>,
    /// The most exact row that is fast enough; `None`: no row is.
    pub most_exact: Option<Pick<'r>>,
}

impl<'r> Picks<'r> {
    /// Picks by `goals` among the scene's measured rows.
    pub fn of(scene: &'r SceneReport, goals: &Goals) -> Self {
        let times = RowTimes::of(scene);
        let cheapest = cheapest(scene, &times, goals.wrong_percent);
        let most_exact = most_exact(scene, &times, goals.milliseconds);
        Self { times, cheapest, most_exact }
    }
}

fn judged(scene: &SceneReport) -> impl Iterator<Item = (&Row, &Measured)> {
    let measured = scene.rows.iter().filter_map(|row| Some((row, row.measured()?)));
    measured.filter(|(_, measured)| measured.is_judged())
}

/// The rows that no other is both faster and less wrong than, by [`RowTimes::of_row`] and wrong percent; fastest first.
/// Without those of which too few pixels could be compared.
pub fn pareto<'r>(scene: &'r SceneReport, times: &RowTimes<'_>) -> Vec<(&'r Row, &'r Measured)> {
    let mut rows: Vec<_> = judged(scene).collect();
    rows.sort_by(|(_, a), (_, b)| {
        let by_time = times.of_row(a).total_cmp(&times.of_row(b));
        by_time.then(a.wrong_percent().total_cmp(&b.wrong_percent()))
    });
    let mut least = f64::INFINITY;
    rows.retain(|(_, measured)| {
        let is_less = measured.wrong_percent() < least;
        least = least.min(measured.wrong_percent());
        is_less
    });
    rows
}

/// The fastest row that is wrong in at most `percent` of the pixels compared; its rivals are as little wrong, and their bars
/// meet its own.
fn cheapest<'r>(scene: &'r SceneReport, times: &RowTimes<'_>, percent: f64) -> Option<Pick<'r>> {
    let mut front = pareto(scene, times).into_iter();
    let (row, measured) = front.find(|(_, measured)| measured.wrong_percent() <= percent)?;
    let bar = times.bar(measured);
    let is_rival = |other: &&'r Row| {
        let measured = other.measured().filter(|measured| measured.is_judged() && measured.wrong_percent() <= percent);
        other.index != row.index && measured.is_some_and(|measured| times.bar(measured)[0] <= bar[1])
    };
    let rivals = scene.rows.iter().filter(is_rival).collect();
    Some(Pick { row, measured, milliseconds: times.of_row(measured), bar, rivals, may_be_late: false })
}

/// The least wrong row that takes at most so long; its rivals are less wrong, and their bars begin within that time.
fn most_exact<'r>(scene: &'r SceneReport, times: &RowTimes<'_>, milliseconds: f64) -> Option<Pick<'r>> {
    let mut front = pareto(scene, times).into_iter();
    let (row, measured) = front.rfind(|(_, measured)| times.of_row(measured) <= milliseconds)?;
    let bar = times.bar(measured);
    let is_rival = |(other, exact): &(&Row, &Measured)| {
        let is_less_wrong = exact.wrong_percent() < measured.wrong_percent();
        other.index != row.index && is_less_wrong && times.bar(exact)[0] <= milliseconds
    };
    let rivals = judged(scene).filter(is_rival).map(|(row, _)| row).collect();
    let may_be_late = bar[1] > milliseconds;
    Some(Pick { row, measured, milliseconds: times.of_row(measured), bar, rivals, may_be_late })
}

/// Number of rows that are named; the others are counted.
const NAMED: usize = 8;

impl Pick<'_> {
    /// `0.08 % wrong in 15.1 ms (bar from 15 to 15.3 ms)`.
    pub fn numbers(&self) -> String {
        let [least, greatest] = self.bar.map(plain);
        let (wrong, ms) = (plain(self.measured.wrong_percent()), plain(self.milliseconds));
        format!("{wrong} % wrong in {ms} ms (runs of this work took {least} to {greatest} ms)")
    }

    /// Rows that the times cannot rule out.
    pub fn doubts(&self, goals: &Goals) -> Vec<String> {
        let mut doubts = Vec::new();
        if self.bar[0] == self.bar[1] {
            doubts.push(String::from("It was timed once: how far its times spread is not known."));
        }
        if self.may_be_late {
            doubts.push(format!("Not sure: some runs of this work took longer than {} ms.", plain(goals.milliseconds)));
        }
        if !self.rivals.is_empty() {
            let mut rows: Vec<String> = self.rivals.iter().take(NAMED).map(|row| row.index.to_string()).collect();
            let more = self.rivals.len().saturating_sub(NAMED);
            rows.extend((more > 0).then(|| format!("{more} more")));
            let (noun, verb) = if self.rivals.len() == 1 { ("row", "is") } else { ("rows", "are") };
            doubts.push(format!("These times cannot rule out that {noun} {} {verb} better.", rows.join(", ")));
        }
        doubts
    }
}

/// Both answers of a scene for a terminal: TOML, everything else behind `#`.
pub fn to_text(scene: &SceneReport, goals: &Goals) -> String {
    let picks = Picks::of(scene, goals);
    let mut text = format!(
        "# {}, light {}: {} of {} settings\n",
        scene.path.display(),
        scene.light,
        scene.rows.len(),
        scene.grid_rows
    );
    if scene.rows.len() < scene.grid_rows {
        text += "# The best of these rows need not be the best of the grid.\n";
    }
    if let Some(why) = unjudged(scene) {
        return format!("{text}# {why}\n");
    }
    text.extend(picks.times.warning().map(|warning| format!("# {warning}\n")));
    let titles = titles(goals);
    for (title, pick) in titles.iter().zip([&picks.cheapest, &picks.most_exact]) {
        let Some(pick) = pick else {
            text += &format!("\n# {title}: no setting measured is\n");
            continue;
        };
        text += &format!("\n# {title}: row {}, {}\n", pick.row.index, pick.numbers());
        text.extend(pick.doubts(goals).iter().map(|doubt| format!("# {doubt}\n")));
        text += &pick.row.to_toml();
    }
    text
}

/// Titles of both answers.
pub fn titles(goals: &Goals) -> [String; 2] {
    [
        format!("Cheapest with at most {} % wrong", plain(goals.wrong_percent)),
        format!("Most exact within {} ms", plain(goals.milliseconds)),
    ]
}

/// Reason why no setting can be named, if too few pixels were compared.
pub fn unjudged(scene: &SceneReport) -> Option<String> {
    if let Some(why) = &scene.unshaded {
        return Some(format!("No setting is named: {why}."));
    }
    let most = scene.rows.iter().filter_map(Row::measured).map(|measured| measured.metrics.all.compared).max()?;
    (most < FEWEST_COMPARED).then(|| {
        format!(
            "No setting is named: {} pixels could be compared, fewer than {}. Does light {} reach what the camera sees? Is the \
             picture large enough?",
            grouped(most as u64),
            grouped(FEWEST_COMPARED as u64),
            scene.light
        )
    })
}

#[cfg(test)]
#[path = "picks_tests.rs"]
mod tests;
