//! How far a right number may be from the one that was found, and whether it stands by itself.

use super::ask::{Answer, Asked, GARBAGE, Judgement, OtherAnswers};
use super::log::Read;
use super::pixels::Scalar;

/// Another number for one that is read, from the wrong number and the right one.
type Move = fn(f64, f64, f64) -> f64;

impl Asked<'_> {
    /// How far each component may be from a right value.
    pub(super) fn ranges(
        &mut self,
        context: &OtherAnswers,
        base: Answer,
        read: usize,
        element: usize,
        right: Vec<f64>,
    ) -> Option<Judgement> {
        let Read { layout, bytes, .. } = self.reads[read].clone();
        let got = layout.get(&bytes, element);
        let mut ranges = Vec::new();
        for component in 0..right.len() {
            let mut holds = |value: f64| {
                let mut tried = right.clone();
                tried[component] = value;
                self.ask_at(context, read, &[element], &tried).wrong < base.wrong
            };
            let [low, high] = [-1.0, 1.0].map(|sign| farthest(layout.scalar, right[component], sign, &mut holds));
            let [least, most] = layout.scalar.range();
            ranges.push(if low <= least && high >= most { None } else { Some([low, high]) });
        }
        let judgement = Judgement { read, layout, element, got: got.clone(), right: ranges };
        // Another number that is right, too, as 0 where a pixel need not be drawn: then the bound is not the rule's.
        let mut others = self.candidates(read, Some(element));
        if layout.scalar == Scalar::U8 {
            others.extend((0..=255_u8).step_by(3).map(|value| vec![f64::from(value); layout.components]));
        }
        for other in others {
            if !judgement.holds(&other) && self.ask_at(context, read, &[element], &other).wrong < base.wrong {
                return None;
            }
        }
        let is_known = self.left > 0 && !judgement.holds(&got) && self.is_alone(context, read, element, &right);
        is_known.then_some(judgement)
    }

    /// Tests whether what is right does not depend on another of the driver's answers: else either of the two may be the wrong
    /// one. It does where the wrong number is right as soon as all others change as it should have changed itself.
    pub(super) fn is_alone(&mut self, context: &OtherAnswers, read: usize, element: usize, right: &[f64]) -> bool {
        let is_picture = |other: &usize| {
            let Read { function, layout, .. } = &self.reads[*other];
            *other != read && !matches!(*function, "glGetError" | "glCheckFramebufferStatus") && layout.count() > 0
        };
        let others: Vec<usize> = (0..self.reads.len()).filter(is_picture).collect();
        let got = self.reads[read].layout.get(&self.reads[read].bytes, element);
        let is_alike = |asked: &Self, other: usize| {
            let [own, other] = [read, other].map(|read| asked.reads[read].layout);
            (own.scalar, own.components, own.count()) == (other.scalar, other.components, other.count())
        };
        // What others would have to be for the wrong number to be right: garbage, moved as far, as many times as much, the same.
        // Last garbage in those alone that are of the same kind, which a rule may compare with: the rest, such as depths
        // beside colours, may have to be right, too.
        let moves: [(bool, Move); 5] = [
            (true, |_, _, _| GARBAGE),
            (true, |other, got, right| other + got - right),
            (true, |other, got, right| if right == 0.0 { other } else { other * got / right }),
            (true, |other, got, right| if other == right { got } else { other }),
            (false, |_, _, _| GARBAGE),
        ];
        for (all, how) in moves {
            let mut changed = context.clone();
            let moved: Vec<usize> = others.iter().copied().filter(|other| all || is_alike(self, *other)).collect();
            for other in moved.into_iter().chain([read]) {
                let layout = self.reads[other].layout;
                let mut bytes = changed.remove(&other).unwrap_or_else(|| self.reads[other].bytes.clone());
                let garbage = self.garbage(other);
                for at in (0..layout.count()).filter(|at| (other, *at) != (read, element)) {
                    let values = layout.get(&bytes, at);
                    let change = got.iter().zip(right).cycle();
                    let new = values.iter().zip(change).map(|(value, (got, right))| how(*value, *got, *right));
                    let mut new: Vec<f64> = new.collect();
                    if new.first() == Some(&GARBAGE) {
                        new.clone_from(&garbage);
                    }
                    layout.put(&mut bytes, at, &new);
                }
                changed.insert(other, bytes);
            }
            let wrong = self.ask(changed.clone()).wrong;
            let right = self.ask_at(&changed, read, &[element], right).wrong;
            if right != wrong {
                return right < wrong;
            }
        }
        false
    }
}

/// The farthest value on one side that still holds, where `right` does.
fn farthest(scalar: Scalar, right: f64, sign: f64, holds: &mut impl FnMut(f64) -> bool) -> f64 {
    let end = scalar.range()[usize::from(sign > 0.0)];
    if scalar.is_float() {
        let far = right.abs().max(1.0) * 1e9;
        if holds(right + sign * far) {
            return end;
        }
        // From a rounding of f32 on.
        let mut step = right.abs().max(1e-3) * f64::from(f32::EPSILON);
        let mut good = 0.0;
        while step < far && holds(right + sign * step) {
            good = step;
            step *= 4.0;
        }
        for _ in 0..5 {
            let middle = 0.5 * (good + step);
            if holds(right + sign * middle) { good = middle } else { step = middle }
        }
        return right + sign * good;
    }
    if right == end || holds(end) {
        return end;
    }
    let (mut good, mut bad) = (right, end);
    while (bad - good).abs() > 1.0 {
        let middle = (0.5 * (good + bad)).round();
        if middle == good || middle == bad {
            break;
        }
        if holds(middle) { good = middle } else { bad = middle }
    }
    good
}
