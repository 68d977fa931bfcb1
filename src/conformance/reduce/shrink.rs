//! Smaller programs: trials of less, each replayed, kept where the driver still errs in the same way. Only what by the
//! specification cannot change the number that is read is tried; so what is right stays what it is.

use super::ask::Judgement;
use super::effects::Tracker;
use super::log::{Argument, Recorded};
use super::pixels::Scalar;
use super::slice::{depended_on, needed};
use crate::conformance::layer::value::Value;

/// Trials at most: each draws the scene in a new context.
pub const MOST_TRIALS: usize = 250;

/// Replays programs.
pub struct Trials<'a> {
    /// Tests whether the driver errs in the same way; with `true`: in all that is read.
    pub errs: &'a mut dyn FnMut(&[&Recorded], bool) -> bool,
    pub count: usize,
}

impl Trials<'_> {
    fn errs(&mut self, calls: &[&Recorded], whole: bool) -> bool {
        if self.count >= MOST_TRIALS {
            return false;
        }
        self.count += 1;
        (self.errs)(calls, whole)
    }
}

/// The calls up to the read, the last of `calls`, that show the fault; `None`: even all of them do not.
pub fn calls(trials: &mut Trials, calls: &[Recorded]) -> Option<Vec<Recorded>> {
    let all: Vec<&Recorded> = calls.iter().collect();
    let core = needed(&all);
    let picked = |kept: &[usize]| -> Vec<Recorded> { kept.iter().map(|index| calls[*index].clone()).collect() };
    let refs = |kept: &[usize]| -> Vec<&Recorded> { kept.iter().map(|index| &calls[*index]).collect() };
    if trials.errs(&refs(&core), true) || trials.errs(&refs(&core), false) {
        return Some(picked(&core));
    }
    // The driver is led astray by calls that should not matter: as few of them as do it. First those that set what is in force.
    let mut wider = depended_on(&all);
    if !trials.errs(&refs(&wider), false) {
        if !trials.errs(&all, false) {
            return None;
        }
        wider = (0..calls.len()).collect();
    }
    let mut extra: Vec<usize> = wider.into_iter().filter(|index| core.binary_search(index).is_err()).collect();
    let with = |extra: &[usize]| {
        let mut kept = [&core[..], extra].concat();
        kept.sort_unstable();
        kept
    };
    fewer(&mut extra, &mut |part| trials.errs(&refs(&with(part)), false));
    Some(picked(&with(&extra)))
}

/// As few items as still hold: halves first, then smaller parts [Zeller and Hildebrandt 2002, ddmin].
fn fewer<T: Clone>(items: &mut Vec<T>, holds: &mut impl FnMut(&[T]) -> bool) {
    let mut size = items.len();
    while size > 0 {
        let mut start = 0;
        while start < items.len() {
            let mut without = items.clone();
            without.drain(start..(start + size).min(items.len()));
            if holds(&without) { *items = without } else { start += size }
        }
        size = if size == 1 { 0 } else { size.div_ceil(2).min(items.len().max(1)) };
    }
}

/// Leaves out triangles that do not come near the pixel, and values of tables for other pixels.
pub fn data(trials: &mut Trials, calls: Vec<Recorded>, judgement: &Judgement) -> Vec<Recorded> {
    let Some(pixel) = pixel_of(&calls, judgement) else { return calls };
    // Where a picture is read again in a draw or a copy, other pixels matter.
    let is_copy =
        |call: &Recorded| call.name.contains("Copy") || call.name.contains("Blit") || call.name == "glGenerateMipmap";
    if calls.iter().any(is_copy) || is_layered(&calls) {
        return calls;
    }
    let calls = scissors(trials, calls, pixel);
    let calls = tables(trials, calls, pixel);
    triangles(trials, calls, pixel)
}

/// Tests whether there is more than one framebuffer: one may be sampled while another is drawn.
fn is_layered(calls: &[Recorded]) -> bool {
    let made = |name: &str| calls.iter().filter(|call| call.name == name).count();
    made("glGenFramebuffers") > 1
}

/// The pixel that is judged, of the framebuffer.
pub fn pixel_of(calls: &[Recorded], judgement: &Judgement) -> Option<[i32; 2]> {
    let read = calls.last().filter(|call| call.name == "glReadPixels")?;
    let [column, row] = [judgement.element % judgement.layout.width, judgement.element / judgement.layout.width];
    Some([read.i(0) + column as i32, read.i(1) + row as i32])
}

/// Leaves out clears and draws whose scissor keeps the pixel from them.
fn scissors(trials: &mut Trials, calls: Vec<Recorded>, [x, y]: [i32; 2]) -> Vec<Recorded> {
    let mut tracker = Tracker::default();
    let mut far = Vec::new();
    for (index, call) in calls.iter().enumerate() {
        tracker.follow(call);
        let draws = matches!(call.name, "glClear" | "glClearBufferfv" | "glClearBufferiv" | "glClearBufferfi")
            || call.name.starts_with("glDrawArrays")
            || call.name.starts_with("glDrawElements");
        let [left, bottom, width, height] = *tracker.state.numbers("glScissor") else { continue };
        let [x, y] = [f64::from(x), f64::from(y)];
        let is_far = x < left || y < bottom || x >= left + width || y >= bottom + height;
        if draws && is_far && tracker.state.is_on(glow::SCISSOR_TEST) {
            far.push(index);
        }
    }
    let with = |far: &[usize], all: &[usize]| -> Vec<Recorded> {
        let kept = (0..calls.len()).filter(|index| far.contains(index) || !all.contains(index));
        kept.map(|index| calls[index].clone()).collect()
    };
    let all = far.clone();
    if all.is_empty() {
        return calls;
    }
    let mut errs = |far: &[usize]| trials.errs(&with(far, &all).iter().collect::<Vec<_>>(), false);
    if errs(&[]) {
        far.clear();
    } else {
        fewer(&mut far, &mut errs);
    }
    tidied(trials, with(&far, &all))
}

/// Without calls that are of no use any more, if the driver errs without them.
fn tidied(trials: &mut Trials, calls: Vec<Recorded>) -> Vec<Recorded> {
    let refs: Vec<&Recorded> = calls.iter().collect();
    let kept = needed(&refs);
    let fewer: Vec<Recorded> = kept.iter().map(|index| calls[*index].clone()).collect();
    let is_enough = fewer.len() < calls.len() && trials.errs(&fewer.iter().collect::<Vec<_>>(), false);
    if is_enough { fewer } else { calls }
}

/// A draw of triangles: its call, that of its vertices, its viewport.
struct Triangles {
    draw: usize,
    upload: usize,
    viewport: [f64; 4],
}

/// Floats of a vertex of the bench: position and value.
const VERTEX: usize = 8;

/// Draws of triangles whose positions are clip space as they come.
fn plain_draws(calls: &[Recorded]) -> Vec<Triangles> {
    let mut tracker = Tracker::default();
    let (mut found, mut upload) = (Vec::new(), None);
    for (index, call) in calls.iter().enumerate() {
        tracker.follow(call);
        match call.name {
            "glBufferData" if call.u(0) == glow::ARRAY_BUFFER => upload = Some(index),
            "glDrawArrays" if call.u(0) == glow::TRIANGLES && call.u(1) == 0 && tracker.is_plain() => {
                let viewport: Option<[f64; 4]> = tracker.state.numbers("glViewport").try_into().ok();
                if let (Some(upload), Some(viewport)) = (upload.take(), viewport) {
                    found.push(Triangles { draw: index, upload, viewport });
                }
            }
            _ => {}
        }
    }
    found
}

fn triangles(trials: &mut Trials, mut calls: Vec<Recorded>, pixel: [i32; 2]) -> Vec<Recorded> {
    for number in 0.. {
        let Some(Triangles { draw, upload, viewport }) = plain_draws(&calls).into_iter().nth(number) else { break };
        let Some(Argument::Data(data)) = calls[upload].arguments.get(2).cloned() else { continue };
        let floats = data.scalar.numbers(&data.bytes);
        if data.scalar != Scalar::F32 || floats.len() != calls[draw].i(2).max(0) as usize * VERTEX {
            continue;
        }
        let each = floats.chunks_exact(3 * VERTEX).map(<[f64]>::to_vec);
        let (far, near): (Vec<_>, Vec<_>) = each.enumerate().partition(|(_, floats)| misses(floats, pixel, viewport));
        let with = |far: &[(usize, Vec<f64>)]| {
            let mut kept = [near.clone(), far.to_vec()].concat();
            kept.sort_by_key(|(index, _)| *index);
            let floats: Vec<f64> = kept.iter().flat_map(|(_, floats)| floats.clone()).collect();
            let mut changed = calls.clone();
            let bytes: Vec<u8> = floats.iter().flat_map(|float| Scalar::F32.encode(*float)).collect();
            changed[upload].arguments[1] = Argument::Number(Value::Size(bytes.len() as isize));
            changed[upload].arguments[2] = Argument::Data(super::log::Data { scalar: Scalar::F32, bytes });
            changed[draw].arguments[2] = Argument::Number(Value::Signed((floats.len() / VERTEX) as i32));
            if kept.is_empty() {
                changed.remove(draw);
            }
            changed
        };
        let mut left = far;
        if left.is_empty() {
            continue;
        }
        let mut errs = |far: &[(usize, Vec<f64>)]| {
            let changed = with(far);
            trials.errs(&changed.iter().collect::<Vec<_>>(), false)
        };
        if errs(&[]) {
            left.clear();
        } else {
            fewer(&mut left, &mut errs);
        }
        let changed = with(&left);
        if changed.len() < calls.len() {
            // A draw has gone: the others have other numbers now.
            let changed = tidied(trials, changed);
            return triangles(trials, changed, pixel);
        }
        calls = changed;
    }
    calls
}

/// Tests whether a triangle surely stays a pixel away: some corner's weight in homogeneous coordinates is below 0 on all of a
/// square around the pixel.
fn misses(floats: &[f64], [x, y]: [i32; 2], [left, bottom, width, height]: [f64; 4]) -> bool {
    let corner = |index: usize| [floats[index * VERTEX], floats[index * VERTEX + 1], floats[index * VERTEX + 3]];
    let [a, b, c] = [corner(0), corner(1), corner(2)];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let whole = dot(cross(a, b), c);
    if whole == 0.0 || !whole.is_finite() {
        return false;
    }
    let middle = [f64::from(x) + 0.5 - left, f64::from(y) + 0.5 - bottom];
    let square = [[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]]
        .map(|[dx, dy]| [2.0 * (middle[0] + dx) / width - 1.0, 2.0 * (middle[1] + dy) / height - 1.0, 1.0]);
    [cross(b, c), cross(c, a), cross(a, b)]
        .iter()
        .any(|edge| square.iter().all(|point| dot(*edge, *point) / whole < 0.0))
}

/// The expression by which a shader reads a table: its own pixel's value alone.
const OWN: &str = "texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)";

/// Zeros in tables, but for the pixel and those beside it, from which derivatives come.
fn tables(trials: &mut Trials, mut calls: Vec<Recorded>, [x, y]: [i32; 2]) -> Vec<Recorded> {
    let reads_own = calls.iter().all(|call| match call.arguments.get(2) {
        Some(Argument::Text(source)) if call.name == "glShaderSource" => {
            let words = |text: &str| source.matches(text).count();
            words("inputs") == 0 || words(OWN) > 0 && words("inputs") == words(OWN) + words("sampler2D inputs")
        }
        _ => true,
    });
    let has_table =
        calls.iter().any(|call| matches!(call.arguments.get(2), Some(Argument::Text(source)) if source.contains(OWN)));
    if !reads_own || !has_table {
        return calls;
    }
    // The table is the last texture that is given: one texel a pixel, of four floats.
    let table = calls
        .iter()
        .rposition(|call| call.name == "glTexImage2D" && call.u(6) == glow::RGBA && call.u(7) == glow::FLOAT);
    let Some(table) = table else { return calls };
    let width = calls[table].i(3);
    let mut changed = calls.clone();
    let Some(Argument::Data(data)) = changed[table].arguments.get_mut(8) else { return calls };
    let near = |at: i32, pixel: i32| at / 2 >= pixel / 2 - 1 && at / 2 <= pixel / 2 + 1;
    for (texel, bytes) in data.bytes.chunks_exact_mut(16).enumerate() {
        let [column, row] = [texel as i32 % width.max(1), texel as i32 / width.max(1)];
        if !near(column, x) || !near(row, y) {
            bytes.fill(0);
        }
    }
    if trials.errs(&changed.iter().collect::<Vec<_>>(), false) {
        calls = changed;
    }
    calls
}
