//! The number that a driver got wrong, and what it should be: found by asking the rule. The rule is run again on the answers
//! that the driver gave, one of them changed, and tells whether it is content.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use std::time::Instant;

use super::log::{Mode, Playback, Read};
use super::pixels::{Layout, Scalar};
use crate::conformance::{DriverUnderTest, Finding, Findings, Rule};

/// A wrong number of the driver's, and what is right.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Number of the read.
    pub read: usize,
    pub layout: Layout,
    /// Pixel, or value, of the read.
    pub element: usize,
    pub got: Vec<f64>,
    /// Least and greatest right number of each component; `None`: it is not judged.
    pub right: Vec<Option<[f64; 2]>>,
}

impl Judgement {
    /// Tests whether these components are right.
    pub fn holds(&self, values: &[f64]) -> bool {
        self.right
            .iter()
            .zip(values)
            .all(|(range, value)| range.is_none_or(|[low, high]| *value >= low && *value <= high))
    }
}

/// Rule that is asked.
pub struct Asked<'a> {
    pub rule: &'a Rule,
    pub subject: &'a DriverUnderTest,
    pub mode: &'a Rc<RefCell<Mode>>,
    pub reads: Rc<Vec<Read>>,
    /// The finding that fails, and how many of the same name come before it.
    pub finding: Finding,
    pub before: usize,
    pub tick: &'a mut dyn FnMut(),
    /// Questions that may still be asked, and until when.
    pub left: usize,
    pub until: Instant,
}

/// Questions at most about a finding, and seconds: a rule that is asked runs without its draws.
pub const MOST_QUESTIONS: usize = 3000;
pub const MOST_SECONDS: u64 = 60;

/// Answer of a rule: how many values are wrong, and the first of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    pub(super) wrong: f64,
    first: Option<(usize, u64)>,
}

/// Distinct values of a read, at most, for each to be tried in the place of each other.
const PALETTE: usize = 24;
/// Values that are tried in the place of a wrong one.
const CANDIDATES: usize = 12;

/// A float that no rule wants.
pub(super) const GARBAGE: f64 = -12345.678;

pub(super) type OtherAnswers = HashMap<usize, Vec<u8>>;

/// Runs a rule; the findings of it.
pub fn findings_of(rule: &Rule, subject: &DriverUnderTest) -> Vec<Finding> {
    let mut findings = Findings::default();
    if let Err(error) = (rule.check)(subject, &mut findings) {
        findings.error(&error);
    }
    findings.outcome(rule, 0.0).findings
}

impl Asked<'_> {
    pub(super) fn ask(&mut self, changed: OtherAnswers) -> Answer {
        if self.left == 0 || Instant::now() > self.until {
            self.left = 0;
            return Answer { wrong: f64::MAX, first: None };
        }
        self.left -= 1;
        (self.tick)();
        *self.mode.borrow_mut() = Mode::Play(Playback { reads: self.reads.clone(), changed, next: 0 });
        let findings = findings_of(self.rule, self.subject);
        *self.mode.borrow_mut() = Mode::Pass;
        let finding = findings.iter().filter(|finding| finding.what == self.finding.what).nth(self.before);
        match finding {
            Some(finding) if finding.verdict.fails() => Answer { wrong: wrong_of(finding), first: finding.first_wrong },
            _ => Answer { wrong: 0.0, first: None },
        }
    }

    /// Asks with some elements of a read at one value.
    pub(super) fn ask_at(&mut self, base: &OtherAnswers, read: usize, elements: &[usize], value: &[f64]) -> Answer {
        let mut changed = base.clone();
        let bytes = changed.entry(read).or_insert_with(|| self.reads[read].bytes.clone());
        let layout = self.reads[read].layout;
        elements.iter().for_each(|element| layout.put(bytes, *element, value));
        self.ask(changed)
    }

    /// Finds the number that is wrong; `None`: no single number of one answer is.
    pub fn judge(&mut self) -> Option<Judgement> {
        let none = OtherAnswers::new();
        let base = self.ask(none.clone());
        if base.wrong == 0.0 {
            return None;
        }
        let is_picture = |read: &Read| !matches!(read.function, "glGetError" | "glCheckFramebufferStatus");
        let all: Vec<usize> = (0..self.reads.len()).filter(|read| self.reads[*read].layout.count() > 0).collect();
        let (pictures, states): (Vec<usize>, Vec<usize>) =
            all.into_iter().partition(|read| is_picture(&self.reads[*read]));
        if let Some(found) = base.first.and_then(|_| self.by_order(base, &pictures)) {
            return Some(found);
        }
        for read in pictures.into_iter().chain(states) {
            let all: Vec<usize> = (0..self.reads[read].layout.count()).collect();
            let garbage = self.garbage(read);
            let matters = base.wrong == 1.0 || self.ask_at(&none, read, &all, &garbage) != base;
            if let Some(found) = matters.then(|| self.by_values(base, read)).flatten() {
                return Some(found);
            }
        }
        None
    }

    /// The first wrong value of a tally depends on the last element whose change, with all behind it, changes it.
    fn by_order(&mut self, base: Answer, pictures: &[usize]) -> Option<Judgement> {
        let changed_from = |asked: &mut Self, first: usize| {
            let changes = pictures[first..].iter().map(|read| (*read, asked.garbled(*read, 0))).collect();
            asked.ask(changes).first != base.first
        };
        let read = pictures[last_true(pictures.len(), |index| changed_from(self, index))?];
        let count = self.reads[read].layout.count();
        let element = last_true(count, |element| {
            let changes = OtherAnswers::from([(read, self.garbled(read, element))]);
            self.ask(changes).first != base.first
        })?;
        let right = self.search(base, read, element)?;
        self.ranges(&OtherAnswers::new(), base, read, element, right)
    }

    /// A read whose elements from `first` on are garbage.
    pub(super) fn garbled(&self, read: usize, first: usize) -> Vec<u8> {
        let (layout, garbage) = (self.reads[read].layout, self.garbage(read));
        let mut bytes = self.reads[read].bytes.clone();
        (first..layout.count()).for_each(|element| layout.put(&mut bytes, element, &garbage));
        bytes
    }

    /// A value that no rule can want: none of the read's.
    pub(super) fn garbage(&self, read: usize) -> Vec<f64> {
        let Read { layout, bytes, .. } = &self.reads[read];
        let value = if layout.scalar.is_float() {
            GARBAGE
        } else {
            let there: Vec<f64> = (0..layout.count()).flat_map(|element| layout.get(bytes, element)).collect();
            [165.0, 91.0, 203.0, 77.0, 13.0].into_iter().find(|value| !there.contains(value)).unwrap_or(37.0)
        };
        vec![value; layout.components]
    }

    /// Values of the read and of others like it, and the ends of the range.
    pub(super) fn candidates(&self, read: usize, element: Option<usize>) -> Vec<Vec<f64>> {
        let layout = self.reads[read].layout;
        let one = match layout.scalar {
            Scalar::U8 => vec![255.0, 1.0],
            Scalar::U16 => vec![65535.0, 1.0],
            _ => vec![1.0],
        };
        let mut found: Vec<Vec<f64>> = Vec::new();
        let mut add = |value: Vec<f64>| {
            if !found.contains(&value) && found.len() < CANDIDATES {
                found.push(value);
            }
        };
        let near = element
            .into_iter()
            .flat_map(|at| [at.wrapping_sub(1), at + 1, at.wrapping_sub(layout.width), at + layout.width]);
        for at in near.filter(|at| *at < layout.count()) {
            add(layout.get(&self.reads[read].bytes, at));
        }
        add(vec![0.0; layout.components]);
        one.into_iter().for_each(|value| add(vec![value; layout.components]));
        for other in std::iter::once(read).chain(0..self.reads.len()) {
            let there = &self.reads[other];
            if there.layout.scalar == layout.scalar && there.layout.components == layout.components {
                let step = (there.layout.count() / 97).max(1);
                (0..there.layout.count()).step_by(step).for_each(|at| add(there.layout.get(&there.bytes, at)));
            }
        }
        found
    }

    /// The right value of an element by trying: values that are about, then each component by its distance.
    fn search(&mut self, base: Answer, read: usize, element: usize) -> Option<Vec<f64>> {
        let none = OtherAnswers::new();
        let layout = self.reads[read].layout;
        let got = layout.get(&self.reads[read].bytes, element);
        let mut best = got.clone();
        let mut distance = base.first.map(|(_, bits)| f64::from_bits(bits))?;
        for _ in 0..3 {
            for component in 0..best.len() {
                let is_float = layout.scalar.is_float();
                let step = if is_float { (best[component].abs() * 0.125).max(1.0 / 64.0) } else { 1.0 };
                let mut moved = best.clone();
                moved[component] += if moved[component] + step > layout.scalar.range()[1] { -step } else { step };
                let slope = match self.ask_at(&none, read, &[element], &moved) {
                    answer if answer.wrong < base.wrong => return Some(moved),
                    Answer { first: Some((_, bits)), .. } => {
                        (f64::from_bits(bits) - distance) / (moved[component] - best[component])
                    }
                    _ => 0.0,
                };
                if slope == 0.0 || !slope.is_finite() {
                    continue;
                }
                for to in [-distance / slope, distance / slope] {
                    let mut root = best.clone();
                    root[component] += to;
                    if !is_float {
                        root[component] =
                            root[component].round().clamp(layout.scalar.range()[0], layout.scalar.range()[1]);
                    }
                    match self.ask_at(&none, read, &[element], &root) {
                        answer if answer.wrong < base.wrong => return Some(root),
                        Answer { first: Some((before, bits)), .. }
                            if base.first.is_some_and(|(first, _)| first == before)
                                && f64::from_bits(bits).abs() < distance.abs() =>
                        {
                            (best, distance) = (root, f64::from_bits(bits));
                        }
                        _ => {}
                    }
                }
            }
        }
        for candidate in self.candidates(read, Some(element)) {
            if self.ask_at(&none, read, &[element], &candidate).wrong < base.wrong {
                return Some(candidate);
            }
        }
        // Few values: all of them, a component at a time.
        if layout.scalar == Scalar::U8 {
            for component in 0..got.len() {
                for value in 0..=255_u8 {
                    let mut tried = got.clone();
                    tried[component] = f64::from(value);
                    if self.ask_at(&none, read, &[element], &tried).wrong < base.wrong {
                        return Some(tried);
                    }
                }
            }
        }
        None
    }

    /// Looks through a read with few values: one of them is wrong where another would be right.
    fn by_values(&mut self, base: Answer, read: usize) -> Option<Judgement> {
        let none = OtherAnswers::new();
        let Read { layout, bytes, .. } = self.reads[read].clone();
        let mut places: BTreeMap<Vec<u64>, Vec<usize>> = BTreeMap::new();
        for element in 0..layout.count() {
            let key = layout.get(&bytes, element).into_iter().map(f64::to_bits).collect();
            places.entry(key).or_default().push(element);
        }
        if places.len() > PALETTE {
            return None;
        }
        let mut places: Vec<Vec<usize>> = places.into_values().collect();
        places.sort_by_key(Vec::len);
        let candidates = self.candidates(read, None);
        let garbage = self.garbage(read);
        for elements in places {
            let got = layout.get(&bytes, elements[0]);
            let with_garbage = self.ask_at(&none, read, &elements, &garbage).wrong;
            for right in candidates.iter().filter(|right| **right != got) {
                let with_right = self.ask_at(&none, read, &elements, right).wrong;
                if with_right >= with_garbage && with_right >= base.wrong {
                    continue;
                }
                // Halves in which the value is accepted, down to one element.
                let mut part = elements.clone();
                while part.len() > 1 {
                    let (left, rest) = part.split_at(part.len() / 2);
                    let gain = |asked: &mut Self, half: &[usize]| {
                        let right = asked.ask_at(&none, read, half, right).wrong;
                        asked.ask_at(&none, read, half, &garbage).wrong.max(base.wrong) - right
                    };
                    part = if gain(self, left) > 0.0 { left.to_vec() } else { rest.to_vec() };
                }
                if self.ask_at(&none, read, &part, right).wrong < base.wrong {
                    return self.ranges(&none, base, read, part[0], right.clone());
                }
                // Right only with all the others: they are set right first.
                if with_right < base.wrong {
                    let mut others = bytes.clone();
                    elements.iter().for_each(|element| layout.put(&mut others, *element, right));
                    for element in elements.iter().copied().take(64) {
                        let mut changed = others.clone();
                        layout.put(&mut changed, element, &got);
                        let context = OtherAnswers::from([(read, changed)]);
                        let answer = self.ask(context.clone());
                        if answer.wrong >= base.wrong {
                            return self.ranges(&context, answer, read, element, right.clone());
                        }
                    }
                }
            }
        }
        None
    }
}

/// The last index for which something holds that holds for all before it; `None`: for none.
fn last_true(count: usize, mut holds: impl FnMut(usize) -> bool) -> Option<usize> {
    if count == 0 || !holds(0) {
        return None;
    }
    let (mut low, mut high) = (0, count);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if holds(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// The count of a finding's message, `3 of 8 wrong`; 1 without one.
fn wrong_of(finding: &Finding) -> f64 {
    let mut words = finding.measured.split_whitespace();
    let count = words.next().and_then(|word| word.parse().ok()).filter(|count| *count > 0.0);
    count.filter(|_| words.next() == Some("of")).unwrap_or(1.0)
}
