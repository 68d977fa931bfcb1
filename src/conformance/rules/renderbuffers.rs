//! GL-K6: renderbuffers are drawn, read and copied like textures, right way up [GL 4.6, 8.6, 9.2.4, 18.2].

use std::rc::Rc;

use crate::conformance::bench::{
    Error, GlCopyTo, GlDraw, GlFormat, GlImageDesc, GlPart, GlPlace, GlShape, GlState, Surface, Vertex, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 16;

/// A colour's code and a depth for each pixel: no two of a row or a column alike.
fn due(x: usize, y: usize) -> (u8, f64) {
    let number = (7 * x + 3 * y * SIDE) % 256;
    (number as u8, (number as f64 + 0.5) / 256.0)
}

fn pattern() -> Vec<Vertex> {
    let edge = |at: usize| at as f32 * 2.0 / SIDE as f32 - 1.0;
    let cell = |pixel: usize| {
        let [x, y] = [pixel % SIDE, pixel / SIDE];
        let (code, depth) = due(x, y);
        let value = [f32::from(code) / 255.0, 0.0, 1.0, 1.0];
        rectangle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)], 2.0 * depth as f32 - 1.0, value)
    };
    (0..SIDE * SIDE).flat_map(cell).collect()
}

/// Pixels whose colour or depth is not that of the pattern at `place` of their own place.
fn wrong(surface: &Surface, is_depth: bool, place: impl Fn(usize, usize) -> [usize; 2]) -> [usize; 2] {
    let across = surface.size[0] as usize;
    let due = |index: usize| {
        let [x, y] = place(index % across, index / across);
        due(x, y)
    };
    if is_depth {
        let seen = surface.depths();
        [seen.iter().enumerate().filter(|(index, seen)| (**seen - due(*index).1).abs() > 1e-4).count(), seen.len()]
    } else {
        let seen = surface.colors();
        [seen.iter().enumerate().filter(|(index, seen)| seen[0] != due(*index).0).count(), seen.len()]
    }
}

/// GL-K6: what is drawn into a renderbuffer, read from it, and copied from it to a texture and to faces of a cube map.
pub fn renderbuffers(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let formats =
        [GlFormat::Rgba8, GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth24Stencil8, GlFormat::Depth32F];
    for format in formats {
        findings.part(|findings| of(subject, findings, format));
    }
    Ok(())
}

fn of(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const FROM: [i32; 4] = [3, 2, 8, 9];
    let (bench, name) = (&subject.bench, format.name());
    let (color, depth) = if format.is_depth() { (None, Some(format)) } else { (Some(format), None) };
    let surface = bench.renderbuffers([SIDE as u32; 2], color, depth, 0)?;
    let state = GlState { depth: depth.and(GlState::WRITE.depth), ..GlState::WRITE };
    bench.draw(&GlDraw::plain(&surface, state, &pattern()))?;
    let [bad, count] = wrong(&surface, format.is_depth(), |x, y| [x, y]);
    findings.none_wrong(format!("{name}, drawn and read"), bad, count);
    let [x, y, width, height] = FROM;
    for (shape, layers) in [(GlShape::Flat, 1), (GlShape::Cube, 6)] {
        // A cube map's faces are square.
        let size = if shape == GlShape::Cube { [height as u32; 2] } else { [width as u32, height as u32] };
        let image = Rc::new(bench.blank(GlImageDesc { shape, layers, ..GlImageDesc::flat(format, size) })?);
        let (mut bad, mut count) = (0, 0);
        for layer in 0..layers {
            let from = [x, y, size[0] as i32, size[1] as i32];
            if let Some(codes) = bench.copy(&surface, from, GlCopyTo { image: &image, level: 0, layer, at: [0; 2] }) {
                return Err(Error::Gl { what: "a copy from a renderbuffer", codes });
            }
            let place = Some(GlPlace { image: &image, level: 0, part: GlPart::Face(layer) });
            let (color, depth) = if format.is_depth() { (None, place) } else { (place, None) };
            let copied = bench.surface_at(color, depth)?;
            let [off, all] = wrong(&copied, format.is_depth(), |s, t| [s + x as usize, t + y as usize]);
            bad += off;
            count += all;
        }
        let to = if shape == GlShape::Cube { "a cube map" } else { "a texture" };
        findings.none_wrong(format!("{name}, copied to {to}"), bad, count);
    }
    Ok(())
}
