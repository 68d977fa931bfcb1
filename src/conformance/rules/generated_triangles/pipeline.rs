//! State of rasterization as the model keeps it, and random changes of one piece of it.

use std::fmt;

use crate::conformance::bench::{GlChange, GlCompare, GlOffset, GlPolygonMode};
use crate::conformance::random::Random;

/// State that a draw depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    pub viewport: [i32; 4],
    pub depth_range: [f64; 2],
    pub depth_clamp: bool,
    pub scissor: Option<[i32; 4]>,
    pub scissor_box: [i32; 4],
    pub culls: bool,
    /// GL_FRONT, GL_BACK or GL_FRONT_AND_BACK.
    pub culled: u32,
    pub clockwise: bool,
    pub mode: GlPolygonMode,
    pub offset: GlOffset,
    /// POLYGON_OFFSET_FILL, LINE and POINT.
    pub offset_on: [bool; 3],
    /// Clip distances that are enabled, as bits.
    pub clips: u32,
    pub first: bool,
    pub depth_test: bool,
    pub compare: GlCompare,
    pub depth_write: bool,
    pub color_write: [bool; 4],
    pub program_point_size: bool,
}

impl Pipeline {
    /// GL's state at the start, for a target of this size, but for the depth test.
    pub fn new(size: [u32; 2]) -> Self {
        let whole = [0, 0, size[0] as i32, size[1] as i32];
        Self {
            viewport: whole,
            depth_range: [0.0, 1.0],
            depth_clamp: false,
            scissor: None,
            scissor_box: whole,
            culls: false,
            culled: glow::BACK,
            clockwise: false,
            mode: GlPolygonMode::Fill,
            offset: GlOffset { factor: 0.0, units: 0.0, clamp: 0.0 },
            offset_on: [false; 3],
            clips: 0,
            first: false,
            depth_test: true,
            compare: GlCompare::Always,
            depth_write: true,
            color_write: [true; 4],
            program_point_size: false,
        }
    }

    /// All calls that set it.
    pub fn whole(&self) -> Vec<GlChange> {
        let mut calls = vec![
            GlChange::Viewport(self.viewport),
            GlChange::DepthRange(self.depth_range, false),
            GlChange::Switch(glow::DEPTH_CLAMP, self.depth_clamp),
            GlChange::Switch(glow::SCISSOR_TEST, self.scissor.is_some()),
            GlChange::Scissor(self.scissor_box),
            GlChange::Switch(glow::CULL_FACE, self.culls),
            GlChange::CullFace(self.culled),
            GlChange::FrontFace(self.clockwise),
            GlChange::Mode(self.mode),
            GlChange::Offset(self.offset),
            GlChange::Provoke(self.first),
            GlChange::Switch(glow::DEPTH_TEST, self.depth_test),
            GlChange::DepthFunction(self.compare),
            GlChange::DepthWrite(self.depth_write),
            GlChange::ColorWrite(self.color_write),
            GlChange::Switch(glow::PROGRAM_POINT_SIZE, self.program_point_size),
            GlChange::Switch(glow::STENCIL_TEST, false),
            GlChange::Switch(glow::BLEND, false),
            GlChange::Switch(glow::DITHER, false),
            GlChange::Switch(glow::FRAMEBUFFER_SRGB, false),
        ];
        let offsets = OFFSETS.into_iter().zip(self.offset_on).map(|(what, on)| GlChange::Switch(what, on));
        calls.extend(offsets);
        calls.extend((0..8).map(|index| self.clip(index)));
        calls
    }

    fn clip(&self, index: u32) -> GlChange {
        GlChange::Switch(glow::CLIP_DISTANCE0 + index, self.clips >> index & 1 == 1)
    }

    /// Switches one clip distance; the call that does so.
    pub fn switch_clip(&mut self, index: u32) -> GlChange {
        self.clips ^= 1 << index;
        self.clip(index)
    }

    /// Changes one piece; the calls that do so.
    pub fn change(&mut self, dice: &mut Random, size: [u32; 2], distances: u32) -> Vec<GlChange> {
        if self.mode != GlPolygonMode::Fill && dice.chance(0.6) {
            self.mode = GlPolygonMode::Fill;
            return vec![GlChange::Mode(self.mode)];
        }
        // What a driver may compile programs anew for changes less often than the rest.
        let kind = match dice.chance(0.8) {
            true => dice.pick(&[0, 0, 0, 2, 2, 3, 5, 6, 6, 7, 8, 9]),
            false => dice.pick(&[1, 4, 10, 10, 11, 12, 13, 14, 15, 16, 17, 18]),
        };
        match kind {
            1 => {
                self.mode = dice.pick(&[GlPolygonMode::Line, GlPolygonMode::Point]);
                vec![GlChange::Mode(self.mode)]
            }
            0 => {
                self.viewport = viewport(dice, size);
                vec![GlChange::Viewport(self.viewport)]
            }
            2 | 3 => {
                self.depth_range = depth_range(dice);
                // Ends that both calls take alike.
                vec![GlChange::DepthRange(self.depth_range, dice.chance(0.5))]
            }
            4 => {
                self.depth_clamp ^= true;
                vec![GlChange::Switch(glow::DEPTH_CLAMP, self.depth_clamp)]
            }
            5 => {
                self.scissor = if self.scissor.is_some() { None } else { Some(self.scissor_box) };
                vec![GlChange::Switch(glow::SCISSOR_TEST, self.scissor.is_some())]
            }
            6 => {
                self.scissor_box = scissor(dice, size);
                self.scissor = self.scissor.map(|_| self.scissor_box);
                vec![GlChange::Scissor(self.scissor_box)]
            }
            7 => {
                self.culls ^= true;
                vec![GlChange::Switch(glow::CULL_FACE, self.culls)]
            }
            8 => {
                // All faces are culled seldom: nothing would be drawn.
                self.culled = dice.pick(&[glow::FRONT, glow::BACK, glow::FRONT, glow::BACK, glow::FRONT_AND_BACK]);
                vec![GlChange::CullFace(self.culled)]
            }
            9 => {
                self.clockwise ^= true;
                vec![GlChange::FrontFace(self.clockwise)]
            }
            10 | 11 => {
                self.offset = offset(dice);
                vec![GlChange::Offset(self.offset)]
            }
            12 => {
                let index = dice.pick(&[0, 0, 1, 2]);
                self.switch_offset(index)
            }
            13 | 14 if distances > 0 => vec![self.switch_clip(dice.below(distances as usize) as u32)],
            13 | 14 => Vec::new(),
            15 => {
                self.first ^= true;
                vec![GlChange::Provoke(self.first)]
            }
            16 => {
                self.compare = dice.pick(&[GlCompare::Less, GlCompare::Always, GlCompare::Greater]);
                vec![GlChange::DepthFunction(self.compare)]
            }
            17 => {
                self.depth_write ^= true;
                vec![GlChange::DepthWrite(self.depth_write)]
            }
            _ => {
                self.depth_test ^= true;
                vec![GlChange::Switch(glow::DEPTH_TEST, self.depth_test)]
            }
        }
    }

    /// Switches the offset of one polygon mode. That of lines or points is on only while that of filled polygons is: Mesa's
    /// llvmpipe moves filled polygons when any of the three is on.
    fn switch_offset(&mut self, index: usize) -> Vec<GlChange> {
        let mut changed = vec![index];
        if self.offset_on[index] && index == 0 {
            changed.extend((1..3).filter(|other| self.offset_on[*other]));
        } else if !self.offset_on[index] && !self.offset_on[0] {
            changed = vec![0];
        }
        changed
            .into_iter()
            .map(|index| {
                self.offset_on[index] ^= true;
                GlChange::Switch(OFFSETS[index], self.offset_on[index])
            })
            .collect()
    }

    /// Tests whether a face is culled.
    pub fn leaves_out(&self, front: bool) -> bool {
        self.culls && (self.culled == glow::FRONT_AND_BACK || (self.culled == glow::FRONT) == front)
    }

    /// Tests whether a pixel is inside of the scissor.
    pub fn keeps(&self, pixel: [i32; 2]) -> bool {
        self.scissor.is_none_or(|[x, y, width, height]| {
            (x..x + width).contains(&pixel[0]) && (y..y + height).contains(&pixel[1])
        })
    }
}

const OFFSETS: [u32; 3] = [glow::POLYGON_OFFSET_FILL, glow::POLYGON_OFFSET_LINE, glow::POLYGON_OFFSET_POINT];

/// All of the target, or any part of it, or more; mostly small.
fn viewport(dice: &mut Random, size: [u32; 2]) -> [i32; 4] {
    let [width, height] = size.map(|side| side as i32);
    match dice.below(6) {
        0 => [0, 0, width, height],
        1 => [dice.whole(1, width / 2), dice.whole(1, height / 2), dice.whole(4, width), dice.whole(4, height)],
        2 => [dice.whole(-width, -1), dice.whole(-height, -1), 2 * width + 3, 2 * height + 5],
        3 => [dice.whole(-900, 0), dice.whole(-900, 0), dice.whole(1000, 4096), dice.whole(1000, 4096)],
        4 => [dice.whole(0, width - 4), dice.whole(0, height - 4), dice.whole(1, 6), dice.whole(1, 6)],
        _ => [dice.whole(-9, 9), dice.whole(-9, 9), dice.whole(width / 2, 90), dice.whole(height / 2, 70)],
    }
}

/// Ends are multiples of 1/1024, beyond [0, 1] too.
fn depth_range(dice: &mut Random) -> [f64; 2] {
    let mut end = |low: i32, high: i32| f64::from(dice.whole(low, high)) / 1024.0;
    let (a, b, c) = (end(0, 1024), end(0, 1024), end(16, 128));
    match dice.below(6) {
        0 => [0.0, 1.0],
        1 => [1.0, 0.0],
        2 => [a, b],
        3 => [a * 0.75, a * 0.75 + c],
        4 => [a * 0.75 + c, a * 0.75],
        _ => dice.pick(&[[-1.0, 2.0], [0.25, 3.0], [-2.0, 0.5], [1.5, -0.5]]),
    }
}

fn scissor(dice: &mut Random, size: [u32; 2]) -> [i32; 4] {
    let [width, height] = size.map(|side| side as i32);
    match dice.below(6) {
        0 => [dice.whole(-10, width / 2), dice.whole(-10, height / 2), dice.whole(width / 2, 99), 200],
        1 => [dice.whole(-20, -1), dice.whole(-20, -1), dice.whole(20, width), dice.whole(20, height + 9)],
        2 => [dice.whole(0, width / 3), 0, 10_000, dice.whole(1, height)],
        3 => [dice.whole(0, 9), dice.whole(0, 9), dice.whole(0, 3), dice.whole(0, 3)],
        _ => [dice.whole(0, 9), dice.whole(0, 9), dice.whole(width / 3, width), dice.whole(height / 3, height)],
    }
}

fn offset(dice: &mut Random) -> GlOffset {
    let factor = dice.pick(&[0.0, 1.0, -1.0, 2.5, -4.0, 0.5, 16.0]);
    let units = dice.pick(&[0.0, 1.0, -1.0, 64.0, -300.0, 4096.0, -65536.0]);
    let clamp = dice.pick(&[0.0, 0.0, 0.0, 0.015_625, -0.007_812_5]);
    GlOffset { factor, units, clamp }
}

impl fmt::Display for Pipeline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { viewport, depth_range, scissor, mode, clips, compare, .. } = self;
        write!(f, "viewport {viewport:?}, depth range {depth_range:?}, polygons by {mode:?}")?;
        if let Some(area) = scissor {
            write!(f, ", scissor {area:?}")?;
        }
        if self.depth_clamp {
            write!(f, ", DEPTH_CLAMP")?;
        }
        if self.culls {
            let name = match self.culled {
                glow::FRONT => "front",
                glow::BACK => "back",
                _ => "all",
            };
            write!(f, ", {name} faces culled")?;
        }
        if self.clockwise {
            write!(f, ", CW")?;
        }
        if self.offset_on != [false; 3] {
            let GlOffset { factor, units, clamp } = self.offset;
            write!(f, ", offset ({factor}, {units}, {clamp}) for {:?}", self.offset_on)?;
        }
        if *clips != 0 {
            write!(f, ", clip distances {clips:#010b}")?;
        }
        if self.depth_test {
            write!(f, ", {compare:?}")?;
        } else {
            write!(f, ", no depth test")?;
        }
        if !self.depth_write {
            write!(f, ", no depth writes")?;
        }
        if self.first {
            write!(f, ", first vertex convention")?;
        }
        Ok(())
    }
}
