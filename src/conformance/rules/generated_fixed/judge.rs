//! Pixels of a draw, held against the model.

use std::fmt;

use glam::DVec2;

use super::draws::{CELL, CELLS, SIZE};
use super::fragment::{FixedPixel, FixedTriangle};
use super::state::FixedState;
use super::vertex::FixedCorner;
use crate::conformance::bench::fixed_commands::{FixedFigure, FixedTexture, FixedWay};
use crate::context::compatibility::raw;

/// Slack of a pixel, in codes: half a code to the nearest, and one where lighting and fog are interpolated by few bits.
const CODES: f64 = 1.6;

/// Numbers of pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    pub judged: usize,
    pub unsure: usize,
}

/// A pixel that is not what it must be.
#[derive(Clone, Debug)]
pub struct Wrong {
    at: [usize; 2],
    expected: [[f64; 2]; 4],
    got: [u8; 4],
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.at;
        let codes = self.expected.map(|[low, high]| format!("{:.1} to {:.1}", 255.0 * low, 255.0 * high));
        write!(f, "pixel {x}, {y}: codes {} expected, {:?} found", codes.join(", "), self.got)
    }
}

/// Triangles of a cell's corners in the order that they were given; quads in either of two ways.
fn triangles(primitive: u32, corners: &[FixedCorner]) -> Vec<Vec<FixedTriangle>> {
    let of = |indices: [usize; 3], provoking: usize| FixedTriangle {
        corners: indices.map(|index| corners[index]),
        provoking: corners[provoking],
    };
    // The provoking vertex is a primitive's last, and a polygon's first [GL 4.6 compatibility, table 13.2].
    match primitive {
        glow::TRIANGLES => vec![vec![of([0, 1, 2], 2), of([3, 4, 5], 5)]],
        glow::TRIANGLE_STRIP => vec![vec![of([0, 1, 2], 2), of([2, 1, 3], 3)]],
        glow::TRIANGLE_FAN => vec![vec![of([0, 1, 2], 2), of([0, 2, 3], 3)]],
        _ => {
            let provoking = if primitive == raw::QUADS { 3 } else { 0 };
            let one = vec![of([0, 1, 2], provoking), of([0, 2, 3], provoking)];
            vec![one, vec![of([0, 1, 3], provoking), of([1, 2, 3], provoking)]]
        }
    }
}

impl FixedState {
    /// Judges a draw before it is applied; the first pixel that is wrong.
    pub fn judge(
        &self,
        figure: &FixedFigure,
        textures: &[FixedTexture],
        seen: &[[u8; 4]],
        count: &mut Count,
    ) -> Option<Wrong> {
        let transform = self.transform();
        let corners: Vec<FixedCorner> =
            figure.vertices.iter().map(|vertex| self.corner(&transform, figure.given, vertex, SIZE)).collect();
        let each = corners.len() / (CELLS[0] * CELLS[1]);
        for (cell, corners) in corners.chunks(each).enumerate() {
            let ways = triangles(figure.primitive, corners);
            for pixel in 0..CELL * CELL {
                let at = [cell % CELLS[0] * CELL + pixel % CELL, cell / CELLS[0] * CELL + pixel / CELL];
                let place = DVec2::new(at[0] as f64, at[1] as f64) + 0.5;
                let got = seen[at[1] * CELLS[0] * CELL + at[0]];
                let mut expected = Vec::new();
                for way in &ways {
                    // Either triangle's on the edge between them.
                    let within = |sure: Option<bool>| {
                        let of = way.iter().filter(move |triangle| triangle.covers(place) == sure);
                        of.map(|triangle| self.shade(triangle, place, textures)).collect::<Vec<FixedPixel>>()
                    };
                    let mut found = within(Some(true));
                    if found.is_empty() {
                        found = within(None);
                    }
                    expected.extend(if found.is_empty() { vec![FixedPixel::Unsure] } else { found });
                }
                match self.holds(&expected, got) {
                    None => count.unsure += 1,
                    Some(Ok(())) => count.judged += 1,
                    Some(Err(expected)) => return Some(Wrong { at, expected, got }),
                }
            }
        }
        None
    }

    /// Tests a pixel against what any of the ways makes of it; `None`: it is not judged.
    fn holds(&self, ways: &[FixedPixel], got: [u8; 4]) -> Option<Result<(), [[f64; 2]; 4]>> {
        // A quad's or a polygon's values may be any mean of its corners' [GL 4.6 compatibility, 14.6.1].
        if let [FixedPixel::Color(one), others @ ..] = ways {
            let far = |other: &FixedPixel| match other {
                FixedPixel::Color(other) => one
                    .iter()
                    .zip(other)
                    .any(|(one, other)| one.iter().zip(other).any(|(one, other)| (one - other).abs() > 0.5 / 255.0)),
                FixedPixel::Unsure | FixedPixel::Background => false,
            };
            if others.iter().any(far) {
                return None;
            }
        }
        let mut first = None;
        for way in ways {
            let color = match way {
                FixedPixel::Unsure => return None,
                FixedPixel::Background => self.background.to_array().map(|value| [value; 2]),
                FixedPixel::Color(color) => *color,
            };
            let fits = color
                .iter()
                .zip(got)
                .all(|([low, high], got)| (255.0 * low - CODES..=255.0 * high + CODES).contains(&f64::from(got)));
            if fits {
                return Some(Ok(()));
            }
            first = first.or(Some(color));
        }
        first.map(Err)
    }

    /// The main settings of a draw.
    pub fn in_words(&self, figure: &FixedFigure, textures: &[FixedTexture]) -> String {
        let switches = [
            (raw::LIGHTING, "lighting"),
            (raw::NORMALIZE, "normalize"),
            (raw::RESCALE_NORMAL, "rescale normal"),
            (raw::FOG, "fog"),
            (raw::COLOR_SUM, "colour sum"),
            (raw::ALPHA_TEST, "alpha test"),
            (raw::COLOR_MATERIAL, "colour material"),
        ];
        let mut words: Vec<String> =
            switches.iter().filter(|(what, _)| self.on.has(*what)).map(|(_, name)| (*name).to_owned()).collect();
        let lights = (0..8).filter(|light| self.on.has(raw::LIGHT0 + light));
        words.extend(lights.map(|light| format!("light {light}")));
        words.extend(
            (0..4).filter(|plane| self.on.has(raw::CLIP_PLANE0 + plane)).map(|plane| format!("clip plane {plane}")),
        );
        if self.shade == raw::FLAT {
            words.push("flat".to_owned());
        }
        if self.two_side {
            words.push("two sides".to_owned());
        }
        for (unit, state) in self.units.iter().enumerate() {
            let Some(slot) = self.texture_of(unit) else { continue };
            let format = textures[slot].format;
            let mode = state.mode;
            let generated =
                super::start::COORDINATES.iter().zip(state.generate).filter(|([_, switch], _)| state.on.has(*switch));
            let generated: Vec<String> = generated.map(|([name, _], mode)| format!("{name:#x} by {mode:#x}")).collect();
            words.push(format!("unit {unit}: texture {slot} of {format:#x}, mode {mode:#x} {}", generated.join(", ")));
            if mode == raw::COMBINE {
                words.push(format!("{:x?} {:x?}", state.rgb, state.alpha));
            }
        }
        let way = match figure.way {
            FixedWay::Immediate => "glBegin",
            FixedWay::Arrays => "glDrawArrays",
            FixedWay::Elements => "glDrawElements",
            FixedWay::Buffers => "glDrawElements from buffers",
        };
        words.push(format!("{way} of {:#x}, given {:?}", figure.primitive, figure.given));
        words.join("; ")
    }
}
