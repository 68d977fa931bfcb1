//! Answers of commands, held against the model.

use crate::conformance::bench::GlFormat;
use crate::conformance::bench::commands::{Command, Packing, UNTOUCHED};

use super::pixel::{Bounds, KnownPixel, filled, step};
use super::state::State;

/// Numbers of answers that were judged.
#[derive(Clone, Copy, Debug, Default)]
pub struct Judged {
    /// Numbers that were compared, and numbers that the model does not know.
    pub known: usize,
    pub unknown: usize,
}

/// A number that is not what it must be.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The number that was read, in words.
    pub what: String,
    pub expected: Bounds,
    pub got: f64,
}

/// The range of each number of a pixel in the client's layout.
fn expected(layout: u32, format: GlFormat, pixel: &KnownPixel) -> Vec<Bounds> {
    match layout {
        glow::DEPTH_COMPONENT => vec![pixel.depth.range().widened(step(format))],
        glow::STENCIL_INDEX => vec![pixel.stencil.map_or(Bounds::UNKNOWN, |value| Bounds::of(f64::from(value)))],
        glow::DEPTH_STENCIL => {
            let stencil = pixel.stencil.map_or(Bounds::UNKNOWN, |value| Bounds::of(f64::from(value)));
            vec![pixel.depth.range().widened(step(format)), stencil]
        }
        _ => {
            let [r, g, b, a] = filled(format, pixel.color);
            match layout {
                glow::BGRA => vec![b, g, r, a],
                glow::RGB => vec![r, g, b],
                glow::RED => vec![r],
                _ => vec![r, g, b, a],
            }
        }
    }
}

/// Numbers of a pixel in memory, each with the error of its type.
fn numbers(packing: &Packing, bytes: &[u8]) -> Vec<(f64, f64)> {
    let [layout, kind] = packing.layout;
    if layout == glow::DEPTH_STENCIL {
        let word = u32::from_ne_bytes(bytes[..4].try_into().unwrap_or_default());
        return vec![(f64::from(word >> 8) / 16_777_215.0, 0.0), (f64::from(word & 0xFF), 0.0)];
    }
    if layout == glow::STENCIL_INDEX {
        return vec![(f64::from(bytes[0]), 0.0)];
    }
    match kind {
        glow::UNSIGNED_BYTE => bytes.iter().map(|byte| (f64::from(*byte) / 255.0, 0.6 / 255.0)).collect(),
        glow::UNSIGNED_SHORT => bytes
            .chunks_exact(2)
            .map(|two| (f64::from(u16::from_ne_bytes([two[0], two[1]])) / 65535.0, 1.0 / 65535.0))
            .collect(),
        glow::UNSIGNED_INT => bytes
            .chunks_exact(4)
            .map(|four| {
                (f64::from(u32::from_ne_bytes(four.try_into().unwrap_or_default())) / f64::from(u32::MAX), 1e-7)
            })
            .collect(),
        _ => bytes
            .chunks_exact(4)
            .map(|four| f64::from(f32::from_ne_bytes(four.try_into().unwrap_or_default())))
            .map(|value| (value, 1e-7 * value.abs()))
            .collect(),
    }
}

impl State {
    /// Judges what a command has read; it has been applied already.
    pub fn judge(&self, command: &Command, bytes: &[u8], judged: &mut Judged) -> Option<Fault> {
        let Command::Read { area, packing } = command else { return None };
        self.judge_pixels(*area, packing, bytes, judged)
    }

    fn judge_pixels(&self, area: [i32; 4], packing: &Packing, bytes: &[u8], judged: &mut Judged) -> Option<Fault> {
        let [x, y, width, height] = area;
        let layout = packing.layout[0];
        let color = !matches!(layout, glow::DEPTH_COMPONENT | glow::STENCIL_INDEX | glow::DEPTH_STENCIL);
        let place = self.read_place(color)?;
        let (_, size) = packing.pixel();
        let mut written = vec![false; bytes.len()];
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let at = [(x + column) as u32, (y + row) as u32];
            let (pixel, format) = self.pixel(place, at)?;
            let from = packing.at(width as u32, column as usize, row as usize);
            written[from..from + size].fill(true);
            let read = numbers(packing, &bytes[from..from + size]);
            let fixed = packing.layout[1] != glow::FLOAT;
            for (channel, (expected, (got, error))) in
                expected(layout, format, &pixel).into_iter().zip(read).enumerate()
            {
                if !expected.is_known() {
                    judged.unknown += 1;
                    continue;
                }
                judged.known += 1;
                let is_code = layout == glow::STENCIL_INDEX || layout == glow::DEPTH_STENCIL && channel == 1;
                let range = if fixed && !is_code { expected.clamped() } else { expected }.widened(error);
                if !(range.low..=range.high).contains(&got) {
                    let what = format!("channel {channel} of {} at {}, {} of {place:?}", format.name(), at[0], at[1]);
                    return Some(Fault { what, expected: range, got });
                }
            }
        }
        let spoilt = bytes.iter().zip(&written).position(|(byte, written)| !written && *byte != UNTOUCHED);
        spoilt.map(|at| Fault {
            what: format!("byte {at} of the client's memory, beside the rows that are read"),
            expected: Bounds::of(f64::from(UNTOUCHED)),
            got: f64::from(bytes[at]),
        })
    }
}
