//! GL-Q3: conditional rendering [GL 4.6, 10.9].

use crate::conformance::bench::{
    Error, GlBlit, GlClear, GlCompare, GlDraw, GlFormat, GlState, Surface, full, rectangle,
};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side.
const SIDE: usize = 8;

#[derive(Clone, Copy)]
struct Mode {
    name: &'static str,
    code: u32,
    /// Does not draw without the result.
    waits: bool,
    /// May leave out regions where no sample passed.
    by_region: bool,
    /// Draws where no sample passed.
    inverted: bool,
}

const MODES: [Mode; 6] = [
    Mode { name: "QUERY_WAIT", code: glow::QUERY_WAIT, waits: true, by_region: false, inverted: false },
    Mode { name: "QUERY_NO_WAIT", code: glow::QUERY_NO_WAIT, waits: false, by_region: false, inverted: false },
    Mode {
        name: "QUERY_BY_REGION_WAIT",
        code: glow::QUERY_BY_REGION_WAIT,
        waits: true,
        by_region: true,
        inverted: false,
    },
    Mode {
        name: "QUERY_BY_REGION_NO_WAIT",
        code: glow::QUERY_BY_REGION_NO_WAIT,
        waits: false,
        by_region: true,
        inverted: false,
    },
    Mode {
        name: "QUERY_WAIT_INVERTED",
        code: glow::QUERY_WAIT_INVERTED,
        waits: true,
        by_region: false,
        inverted: true,
    },
    Mode {
        name: "QUERY_NO_WAIT_INVERTED",
        code: glow::QUERY_NO_WAIT_INVERTED,
        waits: false,
        by_region: false,
        inverted: true,
    },
];

/// Work under the condition: all of the surface becomes white.
#[derive(Clone, Copy, Debug)]
enum Work {
    Draw,
    Clear,
    ClearBuffer,
    Blit,
}

const WORKS: [Work; 4] = [Work::Draw, Work::Clear, Work::ClearBuffer, Work::Blit];

const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// GL-Q3: nothing is drawn after a query of no samples, all after one of some.
pub fn conditional(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    if !subject.bench.has_conditional() {
        findings.untestable("glBeginConditionalRender", "the driver does not have the function");
        return Ok(());
    }
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24))?;
    let white = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), None)?;
    white.clear_color([1.0; 4]);
    surface.clear_depth(0.5);
    for mode in MODES {
        if mode.inverted && !subject.bench.has((4, 5), "GL_ARB_conditional_render_inverted") {
            findings.untestable(mode.name, "neither OpenGL 4.5 nor ARB_conditional_render_inverted");
            continue;
        }
        for (what, columns) in [("no samples", 0), ("samples of a half", SIDE / 2), ("all samples", SIDE)] {
            let mut wrong = 0;
            for work in WORKS {
                wrong += judge(subject, &surface, &white, mode, columns, work)?;
            }
            findings.none_wrong(format!("{} after {what}", mode.name), wrong, WORKS.len() * 2 * SIDE * SIDE);
        }
    }
    Ok(())
}

/// Pixels that are wrong under the condition, and in a draw after its end.
fn judge(
    subject: &DriverUnderTest,
    surface: &Surface,
    white: &Surface,
    mode: Mode,
    columns: usize,
    work: Work,
) -> Result<usize, Error> {
    let bench = &subject.bench;
    surface.clear_color([0.0; 4]);
    let query = || {
        // Without columns all of it, none of which passes.
        let state = GlState { color_write: false, depth_write: false, ..GlState::WRITE };
        let (compare, right) = match columns {
            0 => (GlCompare::Never, 1.0),
            _ => (GlCompare::Always, columns as f32 * 2.0 / SIDE as f32 - 1.0),
        };
        let quad = rectangle([-1.0; 2], [right, 1.0], 0.0, [0.0; 4]);
        bench.draw(&GlDraw::plain(surface, GlState { depth: Some(compare), ..state }, &quad))
    };
    let quad = rectangle([-1.0; 2], [1.0; 2], 0.0, [1.0; 4]);
    bench.conditional(mode.code, query, || match work {
        Work::Draw => bench.draw(&GlDraw::plain(surface, FLAT, &quad)),
        Work::Clear | Work::ClearBuffer => {
            let by_buffer = matches!(work, Work::ClearBuffer);
            bench.clear(surface, FLAT, GlClear { color: Some([1.0; 4]), by_buffer, ..GlClear::default() })
        }
        Work::Blit => {
            let (corners, mask) = ([[0, 0, SIDE as i32, SIDE as i32]; 2], glow::COLOR_BUFFER_BIT);
            let blit = GlBlit { from: white, to: surface, corners, mask, linear: false, scissor: None };
            bench.blit(&blit).map_or(Ok(()), |codes| Err(Error::Gl { what: "a blit under a condition", codes }))
        }
    })?;
    let colors = surface.colors();
    let draws = (columns > 0) != mode.inverted;
    // Without waiting all may be drawn that should not be, but not a part.
    let same = if mode.waits || draws { draws } else { colors[0][0] == 255 };
    let wrong = colors.iter().enumerate().filter(|(pixel, color)| {
        let in_region = pixel % SIDE < columns;
        let free = mode.by_region && !in_region && (draws || !mode.waits);
        !free && **color != [if same { 255 } else { 0 }; 4]
    });
    let wrong = wrong.count();
    let after = full(0.0).map(|vertex| crate::conformance::bench::Vertex { value: [0.0, 0.0, 1.0, 1.0], ..vertex });
    bench.draw(&GlDraw::plain(surface, FLAT, &after))?;
    Ok(wrong + surface.colors().into_iter().filter(|color| *color != [0, 0, 255, 255]).count())
}
