//! GL-K14: clears and copies right after one another, of layers, under the scissor, masks of two faces, conditions and
//! FRAMEBUFFER_SRGB [GL 4.6, 8.6, 9.8, 10.9, 17.4.3].

use std::rc::Rc;

use super::copies::srgb;
use crate::conformance::bench::{
    Error, GlClear, GlCompare, GlCopyTo, GlDraw, GlFormat, GlImage, GlImageDesc, GlPart, GlPlace, GlShape, GlState,
    GlStencil, GlStencilOp, Surface, full,
};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 16;
const COUNT: usize = (SIDE * SIDE) as usize;
/// A rectangle: x, y, width, height.
const PART: [i32; 4] = [3, 5, 7, 6];
const WHOLE: [i32; 4] = [0, 0, SIDE as i32, SIDE as i32];

fn is_in_part(pixel: usize) -> bool {
    let [x, y] = [pixel % SIDE as usize, pixel / SIDE as usize].map(|at| at as i32);
    (PART[0]..PART[0] + PART[2]).contains(&x) && (PART[1]..PART[1] + PART[3]).contains(&y)
}

/// Pixels of an image whose first channel, in codes, is not due.
fn wrong(subject: &DriverUnderTest, image: &Rc<GlImage>, due: impl Fn(usize) -> u8) -> Result<usize, Error> {
    let surface = subject.bench.surface_at(Some(GlPlace::whole(image)), None)?;
    Ok(surface.colors().iter().enumerate().filter(|(pixel, color)| color[0] != due(*pixel)).count())
}

/// Stored values in codes of 8 bits.
fn codes(surface: &Surface, format: GlFormat) -> Vec<u8> {
    if format.is_depth() {
        surface.depths().into_iter().map(|depth| (255.0 * depth).round() as u8).collect()
    } else {
        surface.colors().into_iter().map(|color| color[0]).collect()
    }
}

fn color(code: u8) -> GlClear {
    GlClear { color: Some([f32::from(code) / 255.0; 4]), ..GlClear::default() }
}

/// GL-K14.
pub fn whole(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    findings.part(|findings| copied(subject, findings, &surface));
    findings.part(|findings| in_part(subject, findings, &surface));
    findings.part(|findings| conditioned(subject, findings, &surface));
    findings.part(|findings| masked(subject, findings, &surface));
    findings.part(|findings| layers(subject, findings));
    findings.part(|findings| encoded(subject, findings));
    Ok(())
}

/// A copy of what was cleared and not drawn into; under a scissor, which bounds no copy [8.6, 9.2.3].
fn copied(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let bench = &subject.bench;
    for (name, scissor) in [("a copy right after a clear", None), ("a copy under a scissor", Some(PART))] {
        let image = Rc::new(bench.byte_image([SIDE; 2], &[[9; 4]; COUNT])?);
        bench.set_state(surface, GlState::WRITE);
        bench.clear_as_it_is(color(200))?;
        bench.scissor(scissor);
        bench.copy_as_it_is(WHOLE, GlCopyTo { image: &image, level: 0, layer: 0, at: [0, 0] })?;
        bench.scissor(None);
        findings.none_wrong(name, wrong(subject, &image, |_| 200)?, COUNT);
    }
    Ok(())
}

/// A clear within a rectangle right after one of everything leaves what is around.
fn in_part(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let bench = &subject.bench;
    bench.set_state(surface, GlState::WRITE);
    bench.clear_as_it_is(GlClear { depth: Some(1.0), stencil: Some(1), ..color(50) })?;
    bench.scissor(Some(PART));
    bench.clear_as_it_is(GlClear { depth: Some(0.0), stencil: Some(2), ..color(150) })?;
    bench.scissor(None);
    let (colors, depths, stencils) = (surface.colors(), surface.depths(), surface.stencils());
    let is_wrong = |pixel: &usize| {
        let (color, depth, stencil) = if is_in_part(*pixel) { (150, 0.0, 2) } else { (50, 1.0, 1) };
        colors[*pixel] != [color; 4] || depths[*pixel] != depth || stencils[*pixel] != stencil
    };
    findings.none_wrong("a clear of a part after one of all", (0..COUNT).filter(is_wrong).count(), COUNT);
    Ok(())
}

/// Copies are none of the commands that a condition keeps from having an effect [10.9].
fn conditioned(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let bench = &subject.bench;
    if !bench.has_conditional() {
        findings.untestable("a copy under a condition", "the driver has no glBeginConditionalRender");
        return Ok(());
    }
    let image = Rc::new(bench.byte_image([SIDE; 2], &[[9; 4]; COUNT])?);
    bench.clear(surface, GlState::WRITE, color(120))?;
    let nothing = GlState { depth: Some(GlCompare::Never), ..GlState::WRITE };
    bench.conditional(
        glow::QUERY_WAIT,
        || bench.draw(&GlDraw::plain(surface, nothing, &full(0.0))),
        || bench.copy_as_it_is(WHOLE, GlCopyTo { image: &image, level: 0, layer: 0, at: [0, 0] }),
    )?;
    findings.none_wrong("a copy under a condition that fails", wrong(subject, &image, |_| 120)?, COUNT);
    Ok(())
}

/// Clears of stencil are under the mask of front faces [17.4.3.1: "the front stencil writemask"].
fn masked(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let side = |write_mask| GlStencil { write_mask, ..GlStencil::on_pass(GlStencilOp::Keep) };
    for by_buffer in [false, true] {
        for depth in [None, Some(0.5)] {
            for [front, back] in [[0x0F, 0xF0], [0xF0, 0x0F], [0xFF, 0], [0, 0xFF]] {
                surface.clear_stencil(0x55);
                let state = GlState { stencil: Some([side(front), side(back)]), ..GlState::WRITE };
                let clear = GlClear { depth, stencil: Some(0xAA), by_buffer, ..GlClear::default() };
                subject.bench.clear(surface, state, clear)?;
                let due = (0x55 & !front as u8) | (0xAA & front as u8);
                let wrong = surface.stencils().into_iter().filter(|seen| *seen != due).count();
                let call = if by_buffer { "glClearBuffer" } else { "glClear" };
                let beside = if depth.is_some() { ", depth beside it" } else { "" };
                let name =
                    format!("{call} of stencil under masks {front:#04x} of front and {back:#04x} of back{beside}");
                findings.none_wrong(name, wrong, COUNT);
            }
        }
    }
    Ok(())
}

/// A clear of a framebuffer whose image is attached with all its layers clears each of them [9.8].
fn layers(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const LAYERS: u32 = 6;
    let bench = &subject.bench;
    for (name, shape) in [("an array", GlShape::Array), ("a cube map", GlShape::Cube)] {
        for format in [GlFormat::Depth24, GlFormat::Rgba8] {
            let desc = GlImageDesc { shape, layers: LAYERS, ..GlImageDesc::flat(format, [SIDE; 2]) };
            let image = Rc::new(bench.blank(desc)?);
            let at = |part| {
                let place = Some(GlPlace { image: &image, level: 0, part });
                if format.is_depth() { bench.surface_at(None, place) } else { bench.surface_at(place, None) }
            };
            let all = at(GlPart::All)?;
            for by_buffer in [false, true] {
                let [before, code] = if by_buffer { [255, 51] } else { [0, 204] };
                let clear = |surface: &Surface, code: u8| {
                    let depth = format.is_depth().then_some(f32::from(code) / 255.0);
                    let color = if format.is_depth() { None } else { color(code).color };
                    bench.clear(surface, GlState::WRITE, GlClear { color, depth, by_buffer, ..GlClear::default() })
                };
                let part = |layer| if shape == GlShape::Cube { GlPart::Face(layer) } else { GlPart::Layer(layer) };
                for layer in 0..LAYERS {
                    clear(&at(part(layer))?, before)?;
                }
                clear(&all, code)?;
                let mut wrong = 0;
                for layer in 0..LAYERS {
                    let one = at(part(layer))?;
                    wrong += codes(&one, format).into_iter().filter(|seen| *seen != code).count();
                }
                let call = if by_buffer { "glClearBuffer" } else { "glClear" };
                findings.none_wrong(format!("{call} of all layers of {name}, {}", format.name()), wrong, 6 * COUNT);
            }
        }
    }
    Ok(())
}

/// A clear of an sRGB image is encoded under FRAMEBUFFER_SRGB, and is not without [17.4.3.1, 17.3.7].
fn encoded(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Srgb8Alpha8), None)?;
    for encode_srgb in [true, false] {
        for by_buffer in [false, true] {
            let mut tally = GradeTally::default();
            for value in [0.0_f32, 0.1, 0.25, 0.5, 0.75, 1.0] {
                let state = GlState { encode_srgb, ..GlState::WRITE };
                let color = Some([value, value, value, 0.5]);
                subject.bench.clear(&surface, state, GlClear { color, by_buffer, ..GlClear::default() })?;
                let value = f64::from(value);
                let due = 255.0 * if encode_srgb { srgb(value) } else { value };
                for seen in surface.colors() {
                    let off = f64::from(seen[0]) - due;
                    tally.add(verify::within(off, 0.6, 1.0 + 1e-4), off);
                }
            }
            let call = if by_buffer { "glClearBuffer" } else { "glClear" };
            let how = if encode_srgb { "under FRAMEBUFFER_SRGB" } else { "without FRAMEBUFFER_SRGB" };
            findings.tally(format!("{call} of an sRGB image {how}"), tally, "codes");
        }
    }
    Ok(())
}
