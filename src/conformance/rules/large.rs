//! GL-K4: surfaces of thousands of pixels along a side are cleared, drawn and copied to their ends [GL 4.6, 9.2.7, 17.4.3, 18.2].

use crate::conformance::bench::{
    Error, GlClear, GlCopyTo, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Sampling, Shader, Surface, full,
    rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

/// No power of two, and more than tiles and clears of hardware may take at once.
const LONG: u32 = 4099;
const SHORT: u32 = 3;

/// Stored colour, depth and stencil.
type Pixel = ([u8; 4], f64, u8);

/// Pixels that are not as `due` says of their places.
fn wrong(surface: &Surface, due: impl Fn(u32, u32) -> Pixel) -> usize {
    let seen = surface.colors().into_iter().zip(surface.depths()).zip(surface.stencils());
    let off = |(index, ((color, depth), stencil)): (u32, (([u8; 4], f64), u8))| {
        let due = due(index % surface.size[0], index / surface.size[0]);
        color != due.0 || (depth - due.1).abs() > 1e-4 || stencil != due.2
    };
    (0..).zip(seen).filter(|pixel| off(*pixel)).count()
}

/// GL-K4: a wide surface and a high one.
pub fn large(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let long = LONG.min(subject.bench.largest_side());
    for (name, size) in [("wide", [long, SHORT]), ("high", [SHORT, long])] {
        findings.part(|findings| strip(subject, findings, name, size));
        findings.part(|findings| places(subject, findings, name, size));
    }
    Ok(())
}

/// gl_FragCoord, texelFetch and textureSize: each pixel knows its place, and each texel is found.
fn places(subject: &DriverUnderTest, findings: &mut Findings, name: &str, size: [u32; 2]) -> Result<(), Error> {
    const FRAGMENT: &str = "vec2 other = texelFetch(map, textureSize(map, 0) - 1 - ivec2(gl_FragCoord.xy), 0).xy;
result = vec4(gl_FragCoord.xy, other);";
    let [width, height] = size;
    let place = |index: u32| [(index % width) as f32, (index / width) as f32];
    let texels: Vec<_> = (0..width * height).map(|index| [place(index)[0], place(index)[1], 0.0, 1.0]).collect();
    let image = subject.bench.float_image(size, &texels)?;
    let surface = subject.bench.surface(size, Some(GlFormat::Rgba32F), None)?;
    let vertices = full(0.0);
    let draw = GlDraw {
        shader: Shader { version: "#version 150", ..Shader::of(FRAGMENT) },
        images: &[("map", &image, Sampling::NEAREST)],
        ..GlDraw::plain(&surface, GlState { depth: None, ..GlState::WRITE }, &vertices)
    };
    subject.bench.draw(&draw)?;
    let due = |index: u32| {
        let ([x, y], [s, t]) = (place(index), place(width * height - 1 - index));
        [x + 0.5, y + 0.5, s, t]
    };
    let wrong = (0..).zip(surface.floats()).filter(|(index, seen)| *seen != due(*index)).count();
    findings.none_wrong(format!("places of a {name} surface"), wrong, texels.len());
    Ok(())
}

fn strip(subject: &DriverUnderTest, findings: &mut Findings, name: &str, size: [u32; 2]) -> Result<(), Error> {
    const CLEARED: Pixel = ([255, 0, 255, 0], 1.0, 9);
    const DRAWN: Pixel = ([0, 255, 0, 255], 0.25, 6);
    let bench = &subject.bench;
    let count = (size[0] * size[1]) as usize;
    let surface = bench.surface(size, Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    for (call, by_buffer) in [("glClear", false), ("glClearBuffer", true)] {
        let to = |(color, depth, stencil): Pixel| {
            let color = Some(color.map(|code| f32::from(code) / 255.0));
            let clear = GlClear { color, depth: Some(depth as f32), stencil: Some(stencil), by_buffer };
            bench.clear(&surface, GlState::WRITE, clear)
        };
        to(([0; 4], 0.0, 0))?;
        to(CLEARED)?;
        findings.none_wrong(format!("{call} of a {name} surface"), wrong(&surface, |_, _| CLEARED), count);
        // Depth alone, as before a map is drawn.
        let depth = GlClear { depth: Some(0.0), by_buffer, ..GlClear::default() };
        bench.clear(&surface, GlState::WRITE, depth)?;
        let due = (CLEARED.0, 0.0, CLEARED.2);
        findings.none_wrong(format!("{call} of a {name} surface's depth"), wrong(&surface, |_, _| due), count);
    }
    // The last pixel of each row or column is left as it was.
    let edge = size.map(|side| 1.0 - 2.0 / side as f32);
    let side = GlStencil { reference: i32::from(DRAWN.2), ..GlStencil::on_pass(GlStencilOp::Replace) };
    let state = GlState { stencil: Some([side; 2]), ..GlState::WRITE };
    let before = GlClear { color: Some([1.0, 0.0, 1.0, 0.0]), depth: Some(1.0), stencil: Some(9), by_buffer: false };
    bench.clear(&surface, GlState::WRITE, before)?;
    bench.draw(&GlDraw::plain(&surface, state, &rectangle([-1.0; 2], edge, -0.5, [0.0, 1.0, 0.0, 1.0])))?;
    let due = |x: u32, y: u32| if x + 1 < size[0] && y + 1 < size[1] { DRAWN } else { CLEARED };
    findings.none_wrong(format!("a draw into a {name} surface"), wrong(&surface, due), count);

    let image = bench.image(GlFormat::Depth24Stencil8, size)?;
    let error = bench.copy(&surface, surface.whole(), GlCopyTo { image: &image, level: 0, layer: 0, at: [0; 2] });
    let what = format!("a copy of a {name} surface's depth");
    match error {
        Some(error) => findings.must_hold(what, false, error),
        None => {
            let copied = bench.image_depths(&image)?;
            let off = copied.iter().zip(surface.depths()).filter(|(seen, due)| **seen != *due).count();
            findings.none_wrong(what, off, count);
        }
    }
    Ok(())
}
