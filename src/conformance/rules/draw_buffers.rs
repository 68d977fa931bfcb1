//! GL-F15: several colour images of one framebuffer: drawn into by glDrawBuffers, cleared, and read by glReadBuffer [GL 4.6,
//! 17.4.1, 17.4.3, 18.2.1].

use crate::conformance::bench::{
    Error, GlBlend, GlBlit, GlCopyTo, GlDraw, GlFormat, GlState, Shader, Surface, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 4;
const FORMATS: [GlFormat; 4] = [GlFormat::Rgba8, GlFormat::Rgba32F, GlFormat::Rgba16F, GlFormat::Rgba8];

/// Colour that stands in every image beforehand, and the one that the shader's outputs are made of by turns.
const OLD: [f32; 4] = [0.0625, 0.25, 0.125, 0.1875];
const NEW: [f32; 4] = [0.75, 0.375, 0.5, 0.625];

const SHADER: Shader = Shader {
    declarations: "#ifndef VERTEX\nout vec4 second; out vec4 third; out vec4 fourth;\n#endif",
    ..Shader::of("result = passed; second = passed.yzwx; third = passed.zwxy; fourth = passed.wxyz;")
};

/// Images of the outputs in turn.
const BUFFERS: [&[Option<u32>]; 8] = [
    &[Some(0), Some(1), Some(2), Some(3)],
    &[Some(3), Some(2), Some(1), Some(0)],
    &[Some(1)],
    &[None, Some(2)],
    &[Some(2), None, Some(0), None],
    &[None, None, None, Some(0)],
    &[None],
    &[Some(1), Some(3), Some(0), Some(2)],
];

fn output(index: usize) -> [f32; 4] {
    [0, 1, 2, 3].map(|channel| NEW[(channel + index) % 4])
}

/// The value of an image after a draw to `buffers`; OLD if it is not among them.
fn due(buffers: &[Option<u32>], image: usize, value: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
    buffers.iter().position(|buffer| *buffer == Some(image as u32)).map_or(OLD, value)
}

/// A code of 8 bits at most: values lie a sixteenth apart.
fn same(seen: [f32; 4], due: [f32; 4]) -> bool {
    seen.iter().zip(due).all(|(seen, due)| (seen - due).abs() < 1.0 / 200.0)
}

/// Pixels of all images that are not as due.
fn wrong(surface: &Surface, due: impl Fn(usize) -> [f32; 4]) -> usize {
    let of_image = |image: usize| {
        surface.read_from(image as u32);
        surface.floats().into_iter().filter(|seen| !same(*seen, due(image))).count()
    };
    (0..FORMATS.len()).map(of_image).sum()
}

fn cleared(surface: &Surface) {
    surface.draw_to(BUFFERS[0]);
    (0..FORMATS.len() as u32).for_each(|image| surface.clear_output(image, OLD));
}

/// GL-F15: each output goes to its own image, and what no output has stays as it is.
pub fn several(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.several([SIDE; 2], &FORMATS)?;
    let pixels = FORMATS.len() * (SIDE * SIDE) as usize;
    let quad = rectangle([-1.0; 2], [1.0; 2], 0.0, NEW);
    for (name, blend) in [("written", None), ("blended by ONE, ONE", Some(GlBlend::Add))] {
        let mut bad = 0;
        for buffers in BUFFERS {
            cleared(&surface);
            surface.draw_to(buffers);
            let state = GlState { depth: None, blend, ..GlState::WRITE };
            subject.bench.draw(&GlDraw { shader: SHADER, ..GlDraw::plain(&surface, state, &quad) })?;
            bad += wrong(&surface, |image| {
                due(buffers, image, |index| match blend {
                    None => output(index),
                    Some(_) => [0, 1, 2, 3].map(|channel| OLD[channel] + output(index)[channel]),
                })
            });
        }
        findings.none_wrong(format!("{} orders of draw buffers, {name}", BUFFERS.len()), bad, BUFFERS.len() * pixels);
    }
    clears(findings, &surface, pixels);
    reads(subject, findings, &surface)
}

/// glClear clears all that are drawn into, glClearBuffer the one of an output.
fn clears(findings: &mut Findings, surface: &Surface, pixels: usize) {
    let (mut all, mut one, mut count) = (0, 0, 0);
    for buffers in BUFFERS {
        cleared(surface);
        surface.draw_to(buffers);
        surface.clear_color(NEW);
        all += wrong(surface, |image| due(buffers, image, |_| NEW));
        for chosen in 0..buffers.len() {
            cleared(surface);
            surface.draw_to(buffers);
            surface.clear_output(chosen as u32, NEW);
            one += wrong(surface, |image| if buffers[chosen] == Some(image as u32) { NEW } else { OLD });
            count += pixels;
        }
    }
    findings.none_wrong("glClear of several buffers", all, BUFFERS.len() * pixels);
    findings.none_wrong("glClearBufferfv of each output", one, count);
}

/// The read buffer is the framebuffer's: of read-backs, copies and blits.
fn reads(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    surface.draw_to(BUFFERS[0]);
    (0..4_usize).for_each(|image| surface.clear_output(image as u32, output(image)));
    let other = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let Some(image) = other.color_image() else { return Ok(()) };
    let (mut read, mut copied, mut blitted) = (0, 0, 0);
    let whole = surface.whole();
    for chosen in [2, 0, 3, 1, 1, 2] {
        let off = |colors: Vec<[f32; 4]>| colors.into_iter().filter(|seen| !same(*seen, output(chosen))).count();
        surface.read_from(chosen as u32);
        // Another framebuffer in between has a read buffer of its own.
        other.clear_color(OLD);
        read += off(surface.floats());
        let copy = GlCopyTo { image, level: 0, layer: 0, at: [0, 0] };
        if let Some(codes) = subject.bench.copy(surface, whole, copy) {
            return Err(Error::Gl { what: "glCopyTexSubImage2D", codes });
        }
        copied += off(other.floats());
        other.clear_color(OLD);
        let corners = [[0, 0, SIDE as i32, SIDE as i32]; 2];
        let mask = glow::COLOR_BUFFER_BIT;
        let blit = GlBlit { from: surface, to: &other, corners, mask, linear: false, scissor: None };
        if let Some(codes) = subject.bench.blit(&blit) {
            return Err(Error::Gl { what: "glBlitFramebuffer", codes });
        }
        blitted += off(other.floats());
    }
    let count = 6 * (SIDE * SIDE) as usize;
    for (name, bad) in [("glReadPixels", read), ("glCopyTexSubImage2D", copied), ("glBlitFramebuffer", blitted)] {
        findings.none_wrong(format!("{name} of the read buffer"), bad, count);
    }
    Ok(())
}
