//! Programs by `glumbra check --reduce` for broken drivers: each must show the fault on the broken driver, and not on the sound
//! one.

use std::time::Instant;

use glumbra::conformance::events::rule;
use glumbra::conformance::faults::Fault;
use glumbra::conformance::reduce::{ReduceError, reduce};

use crate::judge::{Row, context, each};

/// Result of one rule on one broken driver.
pub enum Outcome {
    /// Calls of the program, and replays.
    Shown(usize, usize),
    Refused(String),
    Wrong(String),
}

/// Reduces a rule on a driver with the fault, and holds the program against that driver and the sound one.
pub fn of(fault: &Fault, id: &str) -> Outcome {
    let Some(rule) = rule(id) else { return Outcome::Wrong(format!("no rule {id}")) };
    let reduced = match reduce(&|| Ok(context(Some(fault))), rule, &mut |_| {}) {
        Ok(reduced) => reduced,
        Err(error @ (ReduceError::NoNumber { .. } | ReduceError::GivenUp { .. } | ReduceError::NotAgain { .. })) => {
            return Outcome::Refused(error.to_string());
        }
        Err(error) => return Outcome::Wrong(error.to_string()),
    };
    let broken = reduced.shows_in(context(Some(fault)).as_ref());
    let sound = reduced.shows_in(context(None).as_ref());
    match (broken, sound) {
        (Some(true), Some(false)) => Outcome::Shown(reduced.calls[1], reduced.replays),
        _ => Outcome::Wrong(format!("broken {broken:?}, sound {sound:?}: {}", reduced.says)),
    }
}

/// Reduces every rule that sees a fault, and prints a line each; tests whether no program is wrong.
pub fn all(faults: &[&'static Fault], rows: &[Row]) -> bool {
    let start = Instant::now();
    let results = each(faults, |fault| {
        let red = rows.iter().find(|row| row.fault == fault.name).map(|row| row.red.clone()).unwrap_or_default();
        let outcomes: Vec<Outcome> = red.iter().map(|id| of(fault, id)).collect();
        for (id, outcome) in red.iter().zip(&outcomes) {
            match outcome {
                Outcome::Shown(calls, replays) => println!("{}, {id}: {calls} calls, {replays} replays", fault.name),
                Outcome::Refused(why) => println!("{}, {id}: refused: {why}", fault.name),
                Outcome::Wrong(how) => println!("{}, {id}: WRONG: {how}", fault.name),
            }
        }
        outcomes
    });
    let all: Vec<&Outcome> = results.iter().flatten().collect();
    let count = |test: fn(&Outcome) -> bool| all.iter().filter(|outcome| test(outcome)).count();
    let wrong = count(|outcome| matches!(outcome, Outcome::Wrong(_)));
    println!(
        "{} programs: {} show the fault, {} refused, {wrong} wrong; {:.0} s",
        all.len(),
        count(|outcome| matches!(outcome, Outcome::Shown(..))),
        count(|outcome| matches!(outcome, Outcome::Refused(_))),
        start.elapsed().as_secs_f64()
    );
    wrong == 0
}
