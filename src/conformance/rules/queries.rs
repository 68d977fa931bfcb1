//! GL-Q1 and GL-Q2: samples that pass, and time that elapses [GL 4.6, 4.2, 4.3, 17.3.5].

use std::time::Instant;

use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Shader, Vertex, full, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: i32 = 16;

/// GL-Q1: the exact number of samples that pass the tests.
pub fn samples(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    surface.clear_depth(0.5);
    surface.clear_stencil(0);
    surface.clear_stencil_in(Some([0, 0, 5, SIDE]), 1);
    let near = GlState { depth: Some(GlCompare::Less), depth_write: false, ..GlState::WRITE };
    let side = GlStencil { compare: GlCompare::Equal, reference: 1, ..GlStencil::on_pass(GlStencilOp::Keep) };
    let every_second = Shader::of("if (int(gl_FragCoord.x) % 2 == 1) discard; result = vec4(1.0);");
    let half = rectangle([-1.0; 2], [0.0, 1.0], -0.5, [0.0; 4]).to_vec();
    let (before, behind) = (full(-0.5).to_vec(), full(0.5).to_vec());
    let twice = [before.clone(), half.clone()].concat();
    let mixed = [before.clone(), behind.clone()].concat();
    let plain = Shader::PLAIN;
    let cases: [(&str, GlState, Shader, &[Vertex], u64); 11] = [
        ("all", near, plain, &before, 256),
        ("half of the surface", near, plain, &half, 128),
        ("what is drawn twice", near, plain, &twice, 384),
        ("what fails the depth test", near, plain, &behind, 0),
        ("what passes beside what fails", near, plain, &mixed, 256),
        ("without a depth test", GlState { depth: None, ..near }, plain, &behind, 256),
        ("within a scissor", GlState { scissor: Some([3, 4, 5, 6]), ..near }, plain, &before, 30),
        ("what passes the stencil test", GlState { stencil: Some([side; 2]), ..near }, plain, &before, 80),
        ("what is not discarded", near, every_second, &before, 128),
        ("without colour", GlState { color_write: false, ..near }, plain, &before, 256),
        ("NEVER", GlState { depth: Some(GlCompare::Never), ..near }, plain, &before, 0),
    ];
    for (name, state, shader, vertices, due) in cases {
        let draw = GlDraw { shader, ..GlDraw::plain(&surface, state, vertices) };
        let (count, there) = subject.bench.samples(|| subject.bench.draw(&draw))?;
        let measured = format!("{count}; {due} is due{}", if there { "" } else { ", and the result is never there" });
        findings.must_hold(name, count == due && there, measured);
    }
    let draw = GlDraw::plain(&surface, near, &half);
    let (count, _) = subject.bench.samples(|| (0..5).try_for_each(|_| subject.bench.draw(&draw)))?;
    findings.must_hold("five draws", count == 640, format!("{count}; 640 is due"));
    Ok(())
}

/// GL-Q2: no time without work, more for more work, no more than passes on the clock.
pub fn time(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    if subject.info.timer_bits == 0 {
        findings.untestable("GL_TIME_ELAPSED", "the context has no timer queries");
        return Ok(());
    }
    // Work in the fragment stage, whose bound the compiler does not know.
    let heavy = Shader {
        declarations: "uniform float unset;",
        ..Shader::of(
            "vec4 sum = vec4(unset); for (int i = 0; i < 64 + int(unset); ++i) sum += sin(sum + gl_FragCoord.xyxy); result = sum;",
        )
    };
    let surface = subject.bench.surface([256; 2], Some(GlFormat::Rgba8), None)?;
    let vertices = full(0.0);
    let state = GlState { depth: None, ..GlState::WRITE };
    let draw = GlDraw { shader: heavy, ..GlDraw::plain(&surface, state, &vertices) };
    // The first draw compiles.
    subject.bench.draw(&draw)?;
    subject.bench.finish();
    let (nothing, first) = subject.bench.elapsed(|| Ok(()))?;
    let start = Instant::now();
    let (much, second) = subject.bench.elapsed(|| (0..4).try_for_each(|_| subject.bench.draw(&draw)))?;
    let wall = start.elapsed().as_nanos() as u64;
    findings.must_hold("results are there after glFinish", first && second, format!("{first}, {second}"));
    let measured = format!("{nothing} ns without work, {much} ns for four draws, {wall} ns on the clock");
    findings.must_hold("work takes time, and more than none", much > 0 && much > nothing, measured.clone());
    // All of the work is waited for: what is not the driver's own time is a small part of it, at least once.
    let share = (0..4)
        .map(|_| {
            let start = Instant::now();
            let (time, _) = subject.bench.elapsed(|| (0..4).try_for_each(|_| subject.bench.draw(&draw)))?;
            Ok::<f64, Error>(time as f64 / start.elapsed().as_nanos() as f64)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let share = share.into_iter().fold(much as f64 / wall as f64, f64::max);
    findings.must_hold("a hundredth of the clock's at least", share >= 0.01, format!("{share:.3} of the clock's time"));
    // A clock of its own may run a little faster.
    findings.must_hold("no more than passes on the clock", much <= wall + wall / 10 + 100_000, measured);
    Ok(())
}
