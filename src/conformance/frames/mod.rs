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

use glow::HasContext;

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
    leave(&mut device);
}

/// Sets what the device has changed to GL's state at the start: other rules follow on the context.
fn leave(device: &mut Device) {
    let gl = device.raw_gl();
    let switches = [
        glow::DEPTH_TEST,
        glow::STENCIL_TEST,
        glow::BLEND,
        glow::SCISSOR_TEST,
        glow::CULL_FACE,
        glow::POLYGON_OFFSET_FILL,
        glow::DEPTH_CLAMP,
        glow::TEXTURE_CUBE_MAP_SEAMLESS,
    ];
    // SAFETY: the context is current; only state is set.
    unsafe {
        switches.into_iter().for_each(|switch| gl.disable(switch));
        (0..8).for_each(|distance| gl.disable(glow::CLIP_DISTANCE0 + distance));
        gl.enable(glow::DITHER);
        gl.use_program(None);
        gl.bind_vertex_array(None);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.bind_renderbuffer(glow::RENDERBUFFER, None);
        gl.bind_buffer(glow::ARRAY_BUFFER, None);
        gl.depth_func(glow::LESS);
        gl.depth_mask(true);
        gl.depth_range_f32(0.0, 1.0);
        gl.color_mask(true, true, true, true);
        gl.cull_face(glow::BACK);
        gl.front_face(glow::CCW);
        gl.polygon_offset(0.0, 0.0);
        gl.blend_func(glow::ONE, glow::ZERO);
        gl.stencil_mask(u32::MAX);
        gl.stencil_func(glow::ALWAYS, 0, u32::MAX);
        gl.stencil_op(glow::KEEP, glow::KEEP, glow::KEEP);
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 4);
        for unit in (0..16).rev() {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_sampler(unit, None);
            [glow::TEXTURE_1D, glow::TEXTURE_2D, glow::TEXTURE_CUBE_MAP]
                .into_iter()
                .for_each(|target| gl.bind_texture(target, None));
        }
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
    let is_drawn = failed.is_none();
    let mut measured = match (failed, wrong, first) {
        (Some(why), ..) => why,
        (None, 1.., Some(first)) => format!("{wrong} of {judged} numbers wrong; first: {first}"),
        _ => format!("{judged} of {all} numbers of {count} frames judged and right"),
    };
    for (why, count) in skipped {
        measured += &format!("; {count} frames without a model: {why}");
    }
    let missing = group.frames() - count - skipped.values().sum::<usize>();
    if missing > 0 && is_drawn {
        measured += &format!("; {missing} frames could not be planned");
    }
    let holds = is_drawn && *wrong == 0 && missing == 0 && share >= JUDGED;
    findings.must_hold(group.name(), holds, measured);
}
