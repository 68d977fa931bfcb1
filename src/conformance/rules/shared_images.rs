//! GL-K2: an image that is attached to two framebuffers is one [GL 4.6, 9.2.7, 9.2.8; 17.4.3].

use std::rc::Rc;

use crate::conformance::bench::{
    Error, GlClear, GlDraw, GlFormat, GlImage, GlImageDesc, GlPart, GlPlace, GlShape, GlState, GlStencil, GlStencilOp,
    Surface, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 8;
const STATE: GlState = GlState {
    stencil: Some([GlStencil { reference: 7, ..GlStencil::on_pass(GlStencilOp::Replace) }; 2]),
    ..GlState::WRITE
};

/// Colour, depth and stencil of one pixel; what a surface does not have is left out.
type Pixel = (Option<[u8; 4]>, Option<f64>, Option<u8>);

const CLEARED: Pixel = (Some([0, 255, 0, 255]), Some(1.0), Some(3));
const CLEARED_TO: Pixel = (Some([255, 0, 0, 0]), Some(0.0), Some(4));
const DRAWN: Pixel = (Some([0, 0, 255, 255]), Some(0.5), Some(7));

fn clear(subject: &DriverUnderTest, surface: &Surface, to: Pixel, by_buffer: bool) -> Result<(), Error> {
    let (color, depth, stencil) = has(surface, to);
    let color = color.map(|color| color.map(|code| f32::from(code) / 255.0));
    let clear = |clear: GlClear| subject.bench.clear(surface, GlState::WRITE, GlClear { by_buffer, ..clear });
    // One after the other, as the device does.
    clear(GlClear { color, ..GlClear::default() })?;
    clear(GlClear { depth: depth.map(|depth| depth as f32), ..GlClear::default() })?;
    clear(GlClear { stencil, ..GlClear::default() })
}

/// The right half.
fn draw(subject: &DriverUnderTest, surface: &Surface) -> Result<(), Error> {
    let half = rectangle([0.0, -1.0], [1.0, 1.0], 0.0, [0.0, 0.0, 1.0, 1.0]);
    subject.bench.draw(&GlDraw::plain(surface, STATE, &half))
}

/// The parts of a pixel that the surface has.
fn has(surface: &Surface, (color, depth, stencil): Pixel) -> Pixel {
    let encoding = surface.depth_encoding();
    (
        color.filter(|_| surface.color_image().is_some()),
        depth.filter(|_| encoding.is_some()),
        stencil.filter(|_| encoding.is_some_and(|encoding| encoding.stencil_bits > 0)),
    )
}

/// Pixels that are not as `due` says: on the left, and on the right.
fn wrong(surface: &Surface, due: [Pixel; 2]) -> usize {
    let (color, depth, stencil) = has(surface, CLEARED);
    let [width, height] = surface.size.map(|side| side as usize);
    let place = |pixel: usize| usize::from(2 * (pixel % width) >= width);
    let due: Vec<Pixel> = (0..width * height).map(|pixel| has(surface, due[place(pixel)])).collect();
    let mut wrong = vec![false; width * height];
    if color.is_some() {
        surface.colors().iter().enumerate().for_each(|(pixel, seen)| wrong[pixel] |= due[pixel].0 != Some(*seen));
    }
    if depth.is_some() {
        let off = |due: Option<f64>, seen: f64| due.is_none_or(|due| (due - seen).abs() > 1e-4);
        surface.depths().iter().enumerate().for_each(|(pixel, seen)| wrong[pixel] |= off(due[pixel].1, *seen));
    }
    if stencil.is_some() {
        surface.stencils().iter().enumerate().for_each(|(pixel, seen)| wrong[pixel] |= due[pixel].2 != Some(*seen));
    }
    wrong.iter().filter(|wrong| **wrong).count()
}

/// GL-K2: clears and draws in turn, through one framebuffer and through another.
pub fn shared(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let depths = [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F, GlFormat::Depth24Stencil8];
    for depth in depths.into_iter().map(Some).chain([None]) {
        findings.part(|findings| {
            let image = |format: GlFormat| subject.bench.image(format, [SIDE as u32; 2]).map(Rc::new);
            let color = image(GlFormat::Rgba8)?;
            let depth = depth.map(image).transpose()?;
            let name = depth.as_ref().map_or("RGBA8", |depth| depth.format.name());
            let at = |color: Option<&Rc<GlImage>>| {
                subject.bench.surface_at(color.map(GlPlace::whole), depth.as_ref().map(GlPlace::whole))
            };
            // With depth alone, and twice with colour beside it.
            let first = at(Some(&color))?;
            let second = at(if depth.is_some() { None } else { Some(&color) })?;
            let third = at(Some(&color))?;
            for by_buffer in [false, true] {
                let (mut bad, mut count) = (0, 0);
                for (one, two) in [(&first, &second), (&second, &first), (&first, &third)] {
                    let mut judge = |surface: &Surface, due: [Pixel; 2]| {
                        bad += wrong(surface, due);
                        count += SIDE * SIDE;
                    };
                    clear(subject, one, CLEARED, by_buffer)?;
                    clear(subject, two, CLEARED, by_buffer)?;
                    draw(subject, two)?;
                    judge(two, [CLEARED, DRAWN]);
                    // The image is no longer as this framebuffer left it.
                    clear(subject, one, CLEARED, by_buffer)?;
                    judge(one, [CLEARED; 2]);
                    draw(subject, one)?;
                    clear(subject, two, CLEARED_TO, by_buffer)?;
                    clear(subject, one, CLEARED_TO, by_buffer)?;
                    judge(one, [CLEARED_TO; 2]);
                    draw(subject, one)?;
                    judge(one, [CLEARED_TO, DRAWN]);
                }
                let call = if by_buffer { "glClearBuffer" } else { "glClear" };
                findings.none_wrong(format!("{name}, two framebuffers, {call}"), bad, count);
            }
            Ok(())
        });
    }
    for format in [GlFormat::Rgba8, GlFormat::Depth24Stencil8] {
        for (name, shape, layers) in [("2D", GlShape::Flat, 1), ("cube map", GlShape::Cube, 6)] {
            findings.part(|findings| {
                levels(
                    subject,
                    findings,
                    name,
                    GlImageDesc { shape, layers, levels: 4, ..GlImageDesc::flat(format, [SIDE as u32; 2]) },
                )
            });
        }
    }
    Ok(())
}

/// Clears without a scissor reach all of a level and nothing else of the image.
fn levels(subject: &DriverUnderTest, findings: &mut Findings, name: &str, desc: GlImageDesc) -> Result<(), Error> {
    let image = Rc::new(subject.bench.blank(desc)?);
    let parts: Vec<_> = (0..desc.levels).flat_map(|level| (0..desc.layers).map(move |layer| (level, layer))).collect();
    let at = |&(level, layer): &(u32, u32)| {
        let place = Some(GlPlace { image: &image, level, part: GlPart::Face(layer) });
        if desc.format.is_depth() {
            subject.bench.surface_at(None, place)
        } else {
            subject.bench.surface_at(place, None)
        }
    };
    let code = |(level, layer): (u32, u32), call: usize| (1 + 32 * level + layer) as u8 + 8 * call as u8;
    let pixel = |code: u8| -> Pixel { (Some([code; 4]), Some(f64::from(code) / 255.0), Some(code)) };
    for (call, by_buffer) in [false, true].into_iter().enumerate() {
        for part in &parts {
            clear(subject, &at(part)?, pixel(code(*part, call)), by_buffer)?;
        }
        let (mut bad, mut count) = (0, 0);
        for part in &parts {
            let surface = at(part)?;
            bad += wrong(&surface, [pixel(code(*part, call)); 2]);
            count += (surface.size[0] * surface.size[1]) as usize;
        }
        let call = if by_buffer { "glClearBuffer" } else { "glClear" };
        findings.none_wrong(format!("{}, levels of a {name} image, {call}", desc.format.name()), bad, count);
    }
    Ok(())
}
