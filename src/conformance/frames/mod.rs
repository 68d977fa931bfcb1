//! GL-X7, GL-X8: small frames of the renderer itself, held against a model that runs the same pass lists on the CPU.
//!
//! The driver draws what the renderer draws: its own GLSL, its own sequences of state and copies. The model interprets the
//! finished text of each program ([`glsl`]), rasterises ([`triangle`]), samples ([`lookups`]) and tests and blends
//! ([`fragments`]) in f64, with a bound of the error that GL leaves a driver. What GL leaves open is not judged.

mod draws;
mod fragments;
mod glsl;
mod images;
mod judge;
mod lookups;
mod model;
mod scenes;
mod shaders;
mod triangle;

use std::collections::BTreeMap;

use self::judge::Tally;
use self::scenes::{FrameToDraw, Group};
use self::shaders::Library;
use super::bench::Error;
use super::{DriverUnderTest, Findings};
use crate::device::{Device, Measure};
use crate::geometry::Derived;
use crate::plan::{self, Limits, Request};
use crate::scene::Scene;

/// Share of numbers that must be judged in each group. Edges of triangles, of shadows and of filters are left out, and
/// what blends over them: on pictures of 1,700 pixels that is a good part.
const JUDGED: f64 = 0.5;

/// Frames of shadow maps of all kinds and of shadow volumes.
///
/// # Errors
///
/// None: each frame's error is a finding.
pub fn shadows(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    frames(subject, findings, &Group::SHADOWS);
    Ok(())
}

/// Frames of lit surfaces, projected light, bumps and views.
///
/// # Errors
///
/// None: each frame's error is a finding.
pub fn surfaces(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    frames(subject, findings, &Group::SURFACES);
    Ok(())
}

/// Draws the frames of these groups, one after another on one device, so that each meets what those before left.
fn frames(subject: &DriverUnderTest, findings: &mut Findings, groups: &[Group]) {
    let mut device = Device::new(&subject.context);
    let (max_image_size, max_inputs) = device.limits();
    let limits = Limits { max_image_size, max_inputs };
    let (mut library, derived) = (Library::default(), Derived::default());
    for group in groups.iter().copied() {
        let mut tally = Tally::default();
        let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
        let (mut count, mut failed) = (0, None);
        let planned = |scene: &Scene, request: Request| {
            plan::make_with(scene, &Request { sampled_warnings: false, limits, ..request }, &derived).ok()
        };
        for (number, FrameToDraw { said, plan }) in scenes::of_group(group, planned).into_iter().enumerate() {
            let said = || format!("frame {number} ({said})");
            let drawn = match model::run(&plan.list, &mut library) {
                Ok(drawn) => drawn,
                Err(why) => {
                    *skipped.entry(why).or_default() += 1;
                    continue;
                }
            };
            // Some a second time: the device leaves out passes whose targets hold their results already.
            let times = if number % 3 == 1 { 2 } else { 1 };
            let run = (0..times).try_for_each(|_| device.run(&plan.list, Measure::No).map(|_| ()));
            let judged = run.and_then(|()| judge::judge(&plan.list, &drawn, &mut device));
            match judged {
                Ok(mut judged) => {
                    judged.first = judged.first.map(|first| format!("{}: {first}", said()));
                    tally.add(judged);
                    count += 1;
                }
                Err(why) => {
                    failed.get_or_insert_with(|| format!("{}: {why}", said()));
                }
            }
        }
        report(findings, group, &tally, count, failed, &skipped);
    }
}

fn report(
    findings: &mut Findings,
    group: Group,
    tally: &Tally,
    count: usize,
    failed: Option<String>,
    skipped: &BTreeMap<String, usize>,
) {
    let Tally { judged, open, wrong, first } = tally;
    let all = judged + open;
    let share = *judged as f64 / all.max(1) as f64;
    let mut measured = match (failed, wrong, first) {
        (Some(why), ..) => why,
        (None, 1.., Some(first)) => format!("{wrong} of {judged} numbers wrong; first: {first}"),
        _ => format!("{judged} of {all} numbers of {count} frames judged and right"),
    };
    for (why, count) in skipped {
        measured += &format!("; {count} frames without a model: {why}");
    }
    let holds = *wrong == 0 && share >= JUDGED && measured.contains("judged and right");
    findings.must_hold(group.name(), holds, measured);
}
