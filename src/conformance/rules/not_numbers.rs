//! GL-R6: positions that are infinite or no numbers [GL 4.6, 2.3.4.1].

use crate::conformance::bench::{Error, GlCompare, GlDraw, GlFormat, GlState, Surface, Vertex, rectangle};
use crate::conformance::verify::Grade;
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 16;

const INFINITE: f32 = f32::INFINITY;
const NONE: f32 = f32::NAN;

/// Corners of a triangle that has no place.
const TRIANGLES: [(&str, [[f32; 4]; 3]); 8] = [
    ("x is no number", [[NONE, -0.5, 0.0, 1.0], [0.5, -0.5, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0]]),
    ("z is no number", [[-0.5, -0.5, NONE, 1.0], [0.5, -0.5, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0]]),
    ("w is no number", [[-0.5, -0.5, 0.0, 1.0], [0.5, -0.5, 0.0, NONE], [0.0, 0.5, 0.0, 1.0]]),
    ("nothing is a number", [[NONE; 4]; 3]),
    ("x is infinite", [[-0.5, -0.5, 0.0, 1.0], [INFINITE, -0.5, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0]]),
    ("z is infinite", [[-0.5, -0.5, 0.0, 1.0], [0.5, -0.5, -INFINITE, 1.0], [0.0, 0.5, INFINITE, 1.0]]),
    ("w is infinite", [[-0.5, -0.5, 0.0, 1.0], [0.5, -0.5, 0.0, 1.0], [0.0, 0.5, 0.0, INFINITE]]),
    ("all is infinite", [[INFINITE; 4], [-INFINITE; 4], [INFINITE, -INFINITE, INFINITE, -INFINITE]]),
];

/// GL-R6: such a triangle may draw anything, but does not end the driver and does nothing to the draws after it.
pub fn positions(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24))?;
    for (name, corners) in TRIANGLES {
        let bad = corners.map(|position| Vertex { position, value: [1.0, 0.0, 0.0, 1.0] });
        let half = |low: f32, z: f32| rectangle([low, -1.0], [low + 1.0, 1.0], z, [0.0, 1.0, 0.0, 1.0]);
        // Nearer than anything that the triangle may draw, before it and after it.
        let list: Vec<Vertex> = [&half(-1.0, -1.0)[..], &bad, &half(0.0, -1.0)].concat();
        clear(&surface);
        let less = GlState { depth: Some(GlCompare::LessEqual), ..GlState::WRITE };
        subject.bench.draw(&GlDraw::plain(&surface, less, &list))?;
        let spoilt = surface.colors().into_iter().filter(|color| *color != [0, 255, 0, 255]).count();
        // What such a position draws is unspecified: neighbours in the same draw need not be right.
        let grade = if spoilt == 0 { Grade::Good } else { Grade::Allowed };
        findings.grade(format!("{name}: its neighbours"), grade, format!("{spoilt} of {} wrong", SIDE * SIDE));
        clear(&surface);
        subject.bench.draw(&GlDraw::plain(&surface, less, &[half(-1.0, 0.5), half(0.0, 0.5)].concat()))?;
        let seen = surface.colors().into_iter().zip(surface.depths());
        let wrong = seen.filter(|(color, depth)| *color != [0, 255, 0, 255] || (depth - 0.75).abs() > 1e-6).count();
        findings.none_wrong(format!("{name}: the next draw"), wrong, SIDE * SIDE);
    }
    Ok(())
}

fn clear(surface: &Surface) {
    surface.clear_color([0.0; 4]);
    surface.clear_depth(1.0);
}
