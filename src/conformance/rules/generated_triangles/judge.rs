//! Comparison of what a driver drew with the model's framebuffer.

use super::model::Known;
use super::picture::{CLEARED, Picture, Pixel};
use crate::conformance::Findings;
use crate::conformance::verify::{self, GradeTally};

/// Kinds of numbers that are compared.
const KINDS: [&str; 6] = [
    "pixels of the primitives",
    "gl_FragCoord",
    "varyings",
    "derivatives",
    "gl_FrontFacing and gl_PrimitiveID",
    "depths",
];

/// Greatest share of pixels that are not judged.
const MOST_UNSURE: f64 = 0.2;

/// Grades by kind, and the first mistake of each.
#[derive(Default)]
pub struct Judge {
    tallies: [GradeTally; KINDS.len()],
    first: [Option<String>; KINDS.len()],
    unsure: usize,
    pixels: usize,
}

impl Judge {
    /// Compares all pixels after a draw.
    pub fn picture(
        &mut self,
        picture: &mut Picture,
        seen: &[Vec<[f32; 4]>; 4],
        depths: &[f64],
        derived: bool,
        case: &str,
    ) {
        for (index, pixel) in picture.pixels.iter_mut().enumerate() {
            let wrong = self.wrong();
            let place = [index as u32 % picture.size[0], index as u32 / picture.size[0]];
            self.pixels += 1;
            match pixel.cleared {
                None => self.unsure += 1,
                Some(due) => {
                    let is = seen[0][index][0] == CLEARED;
                    let due = Known::exact(f64::from(u8::from(!due)));
                    self.add(0, f64::from(u8::from(!is)), due, || format!("{case}; pixel {place:?}"));
                    if due.value == 1.0 && !is {
                        self.numbers(&pixel.outputs, seen.each_ref().map(|output| output[index]), derived, || {
                            format!("{case}; pixel {place:?}")
                        });
                    }
                }
            }
            let due = Known::spanning(pixel.depth[0], pixel.depth[1]);
            let due = Known { slack: due.slack + 1e-9, ..due };
            if due.slack < 0.25 {
                self.add(5, depths[index], due, || format!("{case}; pixel {place:?}"));
            }
            // One mistake is one mistake: what it leaves is not compared again.
            if self.wrong() > wrong {
                *pixel = Pixel::UNKNOWN;
            }
        }
    }

    fn wrong(&self) -> usize {
        self.tallies.iter().map(|tally| tally.wrong).sum()
    }

    fn numbers(&mut self, due: &[[Known; 4]; 4], seen: [[f32; 4]; 4], derived: bool, case: impl Fn() -> String) {
        for (output, (due, seen)) in due.iter().zip(seen).enumerate() {
            for (part, (due, seen)) in due.iter().zip(seen).enumerate() {
                let kind = match (output, part) {
                    (0, _) => 1,
                    (3, 2 | 3) => 4,
                    _ if derived => 3,
                    _ => 2,
                };
                self.add(kind, f64::from(seen), *due, || format!("{}, output {output}, part {part}", case()));
            }
        }
    }

    fn add(&mut self, kind: usize, seen: f64, due: Known, case: impl Fn() -> String) {
        if !due.slack.is_finite() || !due.value.is_finite() {
            return;
        }
        let slack = due.slack + due.value.abs() * f64::from(-22).exp2();
        let off = (seen - due.value).abs();
        let off = if off.is_nan() { f64::INFINITY } else { off };
        let distance = if slack > 0.0 { off / slack } else { off };
        let bounds = if slack > 0.0 { [1.0, 4.0] } else { [0.0; 2] };
        let grade = verify::within(distance, bounds[0], bounds[1]);
        self.tallies[kind].add(grade, distance);
        if grade == verify::Grade::Wrong && self.first[kind].is_none() {
            self.first[kind] = Some(format!("{}: {seen}, not {} to {slack:.3e}", case(), due.value));
        }
    }

    pub fn report(self, findings: &mut Findings) {
        for ((name, tally), first) in KINDS.into_iter().zip(self.tallies).zip(self.first) {
            findings.tally(name, tally, "slacks");
            if let Some(first) = first {
                findings.note(&first);
            }
        }
        let share = self.unsure as f64 / self.pixels.max(1) as f64;
        let measured = format!("{:.1} % of {} pixels are not judged", share * 100.0, self.pixels);
        findings.must_hold("pixels that the specification leaves open are few", share < MOST_UNSURE, measured);
    }
}
