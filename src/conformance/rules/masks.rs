//! GL-B1 and GL-B2: channels and bits that draws and clears may write, and clears within scissors [GL 4.6, 17.4.2,
//! 17.4.3].

use crate::conformance::bench::{
    Error, GlBlend, GlClear, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Surface, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: i32 = 16;
/// Codes that stand in the buffer beforehand, and those that are written.
const OLD: [u8; 4] = [17, 34, 51, 68];
const NEW: [u8; 4] = [200, 150, 100, 50];

fn floats(codes: [u8; 4]) -> [f32; 4] {
    codes.map(|code| f32::from(code) / 255.0)
}

fn channels(bits: usize) -> [bool; 4] {
    [0, 1, 2, 3].map(|channel| bits >> channel & 1 == 1)
}

fn masked(mask: [bool; 4], old: [u8; 4], new: [u8; 4]) -> [u8; 4] {
    [0, 1, 2, 3].map(|channel| if mask[channel] { new[channel] } else { old[channel] })
}

fn wrong(surface: &Surface, due: impl Fn(usize) -> [u8; 4]) -> usize {
    surface.colors().into_iter().enumerate().filter(|(index, color)| *color != due(*index)).count()
}

/// GL-B1: each of 16 colour masks, written and blended; and the stencil and depth masks beside them.
pub fn draws(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    let quad = rectangle([-1.0; 2], [1.0; 2], 0.0, floats(NEW));
    for blend in [None, Some(GlBlend::Add)] {
        let mut bad = 0;
        // Open and narrow masks in turn: none may last.
        for bits in (0..16).flat_map(|bits| [bits, 15]) {
            surface.clear_color(floats(OLD));
            let mask = channels(bits);
            let state = GlState { depth: None, blend, channels: mask, ..GlState::WRITE };
            subject.bench.draw(&GlDraw::plain(&surface, state, &quad))?;
            let new = if blend.is_some() { [0, 1, 2, 3].map(|channel| OLD[channel] + NEW[channel]) } else { NEW };
            bad += usize::from(wrong(&surface, |_| masked(mask, OLD, new)) > 0);
        }
        let how = if blend.is_some() { "blended by ONE, ONE" } else { "written" };
        findings.none_wrong(format!("16 colour masks, {how}"), bad, 32);
    }
    floats_too(subject, findings)
}

/// The masks on an image of floats.
fn floats_too(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba32F), None)?;
    let (old, new) = ([1.5, -2.0, 3.25, 0.75], [-4.0, 8.0, 0.5, 16.0]);
    let quad = rectangle([-1.0; 2], [1.0; 2], 0.0, new);
    let mut bad = 0;
    for bits in [0, 1, 2, 4, 8, 7, 15] {
        subject.bench.clear(
            &surface,
            GlState::WRITE,
            GlClear { color: Some(old), by_buffer: true, ..GlClear::default() },
        )?;
        let mask = channels(bits);
        subject.bench.draw(&GlDraw::plain(
            &surface,
            GlState { depth: None, channels: mask, ..GlState::WRITE },
            &quad,
        ))?;
        let due = [0, 1, 2, 3].map(|channel| if mask[channel] { new[channel] } else { old[channel] });
        bad += usize::from(surface.floats().into_iter().any(|color| color != due));
    }
    findings.none_wrong("7 colour masks on floats", bad, 7);
    Ok(())
}

/// Scissors of the clears: none, inner, of one column, beyond the surface, empty.
const SCISSORS: [Option<[i32; 4]>; 5] =
    [None, Some([3, 5, 7, 6]), Some([8, 0, 1, SIDE]), Some([12, 13, 40, 40]), Some([4, 4, 0, 5])];

fn inside(scissor: Option<[i32; 4]>, index: usize) -> bool {
    let [x, y] = [index as i32 % SIDE, index as i32 / SIDE];
    scissor.is_none_or(|[left, bottom, width, height]| {
        (left..left + width).contains(&x) && (bottom..bottom + height).contains(&y)
    })
}

/// GL-B2: clears of each buffer and of all, by both calls, under scissors and masks.
pub fn clears(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), Some(format))?;
            for by_buffer in [false, true] {
                let call = if by_buffer { "glClearBuffer" } else { "glClear" };
                for (what, clear) in combinations(by_buffer) {
                    let (bad, count) = tried(subject, &surface, clear)?;
                    findings.none_wrong(format!("{}: {call} of {what}", format.name()), bad, count);
                }
            }
            Ok(())
        });
    }
    alike(subject, findings)
}

/// Clears one after the other whose colours differ in one channel.
fn alike(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), None)?;
    for by_buffer in [false, true] {
        let mut bad = 0;
        for channel in 0..4 {
            let mut other = OLD;
            other[channel] = NEW[channel];
            for color in [OLD, other, OLD] {
                let clear = GlClear { color: Some(floats(color)), by_buffer, ..GlClear::default() };
                subject.bench.clear(&surface, GlState::WRITE, clear)?;
                bad += usize::from(wrong(&surface, |_| color) > 0);
            }
        }
        let call = if by_buffer { "glClearBuffer" } else { "glClear" };
        findings.none_wrong(format!("{call} of colours that differ in one channel"), bad, 12);
    }
    Ok(())
}

fn combinations(by_buffer: bool) -> [(&'static str, GlClear); 5] {
    let none = GlClear { by_buffer, ..GlClear::default() };
    let (color, depth, stencil) = (Some(floats(NEW)), Some(0.25), Some(0xC5));
    [
        ("colour", GlClear { color, ..none }),
        ("depth", GlClear { depth, ..none }),
        ("stencil", GlClear { stencil, ..none }),
        ("depth and stencil", GlClear { depth, stencil, ..none }),
        ("all three", GlClear { color, depth, stencil, ..none }),
    ]
}

/// Each scissor with each set of masks; pixels that are not as due.
fn tried(subject: &DriverUnderTest, surface: &Surface, clear: GlClear) -> Result<(usize, usize), Error> {
    let (mut bad, mut count) = (0, 0);
    for scissor in SCISSORS {
        for (bits, depth_write, write_mask) in [(15, true, 0xFF), (7, false, 0x0F), (8, true, 0xF0), (5, false, 0x00)] {
            surface.clear_color(floats(OLD));
            surface.clear_depth(0.75);
            surface.clear_stencil(0x3A);
            let side = GlStencil { write_mask, ..GlStencil::on_pass(GlStencilOp::Keep) };
            let mask = channels(bits);
            let state = GlState {
                channels: mask,
                depth_write,
                stencil: Some([side; 2]),
                scissor,
                // As a device that sets one mask.
                short_calls: true,
                ..GlState::WRITE
            };
            subject.bench.clear(surface, state, clear)?;
            let color = if clear.color.is_some() { masked(mask, OLD, NEW) } else { OLD };
            let depth = if clear.depth.is_some() && depth_write { 0.25 } else { 0.75 };
            let bits = write_mask as u8;
            let stencil = clear.stencil.map_or(0x3A, |new| (0x3A & !bits) | (new & bits));
            let seen = surface.depths().into_iter().zip(surface.stencils());
            for (index, (seen_color, (seen_depth, seen_stencil))) in surface.colors().into_iter().zip(seen).enumerate()
            {
                let (color, depth, stencil) =
                    if inside(scissor, index) { (color, depth, stencil) } else { (OLD, 0.75, 0x3A) };
                let same = seen_color == color && (seen_depth - depth).abs() < 1e-6 && seen_stencil == stencil;
                bad += usize::from(!same);
                count += 1;
            }
        }
    }
    Ok((bad, count))
}
