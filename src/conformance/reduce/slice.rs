//! The calls that what is read depends on, by the specification; all others may go.

use std::collections::BTreeSet;

use super::effects::Tracker;
use super::log::Recorded;
use super::state::Key;

/// Indices of the calls that the last one depends on, itself among them; calls that set what is in force already are left out.
pub fn needed(calls: &[&Recorded]) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..calls.len()).collect();
    loop {
        let count = kept.len();
        kept = without_repeats(calls, &live(calls, &kept));
        if kept.len() == count {
            return kept;
        }
    }
}

/// The first function among the calls whose effects are not followed.
pub fn unknown(calls: &[Recorded]) -> Option<&'static str> {
    let mut tracker = Tracker::default();
    calls.iter().find_map(|call| {
        tracker.follow(call);
        tracker.unknown
    })
}

/// Indices of the calls that the last one depends on, with those that set what is in force already.
pub fn depended_on(calls: &[&Recorded]) -> Vec<usize> {
    live(calls, &(0..calls.len()).collect::<Vec<_>>())
}

/// Those of `among` that the last depends on.
fn live(calls: &[&Recorded], among: &[usize]) -> Vec<usize> {
    let mut tracker = Tracker::default();
    let effects: Vec<_> = among.iter().map(|index| tracker.follow(calls[*index])).collect();
    let Some((last, before)) = effects.split_last() else { return Vec::new() };
    let mut wanted: BTreeSet<&Key> = last.reads.iter().collect();
    let mut kept = vec![among[before.len()]];
    for (effect, index) in before.iter().zip(among).rev() {
        if !effect.writes.iter().any(|key| wanted.contains(key)) {
            continue;
        }
        kept.push(*index);
        if effect.kills {
            effect.writes.iter().for_each(|key| {
                wanted.remove(key);
            });
        }
        wanted.extend(&effect.reads);
    }
    kept.reverse();
    kept
}

/// Without calls that set what is in force already.
fn without_repeats(calls: &[&Recorded], among: &[usize]) -> Vec<usize> {
    let mut tracker = Tracker::default();
    let changes = |index: &&usize| {
        let before = tracker.state.clone();
        let effects = tracker.follow(calls[**index]);
        !before.has(&effects.sets)
    };
    let mut changes = changes;
    among.iter().filter(|index| changes(index)).copied().collect()
}
