//! GL-S1 and GL-S2: stencil operations and tests, and which side a polygon shows [GL 4.6, 14.6.1, 17.3.3].

use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFace, GlFormat, GlState, GlStencil, GlStencilOp, Shader, Surface, Vertex, full,
    rectangle,
};
use crate::conformance::{DriverUnderTest, Findings, verify};

/// Values that stand in the buffer beforehand, one a column.
const OLD: [u8; 8] = [0, 1, 0x0F, 0x7F, 0x80, 0xAB, 254, 255];
const FORMAT: GlFormat = GlFormat::Depth24Stencil8;

/// A surface of `rows`, each with all of [`OLD`]. Depth is cleared first; [`clears`] tests the other order.
fn prepared(subject: &DriverUnderTest, rows: usize) -> Result<Surface, Error> {
    let surface = subject.bench.surface([OLD.len() as u32, rows as u32], None, Some(FORMAT))?;
    surface.clear_depth(0.5);
    clear_columns(&surface, rows);
    Ok(surface)
}

fn clear_columns(surface: &Surface, rows: usize) {
    for (column, old) in OLD.into_iter().enumerate() {
        surface.clear_stencil_in(Some([column as i32, 0, 1, rows as i32]), old);
    }
}

/// Clears of stencil within scissors, before and after one of depth without: neither reaches beyond its own buffer and
/// scissor [GL 4.6, 17.4.3]. Zink, which puts clears off, lets the last stencil value fill the whole buffer in the first
/// order.
fn clears(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const ROWS: usize = 4;
    for depth_last in [true, false] {
        let surface = subject.bench.surface([OLD.len() as u32, ROWS as u32], None, Some(FORMAT))?;
        if !depth_last {
            surface.clear_depth(0.5);
        }
        clear_columns(&surface, ROWS);
        if depth_last {
            surface.clear_depth(0.5);
        }
        let values = surface.stencils();
        let wrong = values.chunks(OLD.len()).flat_map(|row| row.iter().zip(OLD)).filter(|(new, old)| *new != old);
        let order = if depth_last { "before" } else { "after" };
        let what = format!("stencil cleared within scissors, {order} depth without");
        findings.none_wrong(what, wrong.count(), values.len());
    }
    Ok(())
}

/// Draws each of `sides` into its own row; wrong values against `due`, which gets the row and the old value.
fn rows(
    subject: &DriverUnderTest,
    sides: &[GlStencil],
    state: GlState,
    due: impl Fn(&GlStencil, u8) -> u8,
) -> Result<(usize, usize), Error> {
    let surface = prepared(subject, sides.len())?;
    for (row, side) in sides.iter().enumerate() {
        let scissor = Some([0, row as i32, OLD.len() as i32, 1]);
        let state = GlState { stencil: Some([*side; 2]), scissor, color_write: false, ..state };
        subject.bench.draw(&GlDraw::plain(&surface, state, &full(0.0)))?;
    }
    let values = surface.stencils();
    let pairs = sides.iter().zip(values.chunks(OLD.len()));
    let wrong =
        pairs.map(|(side, row)| row.iter().zip(OLD).filter(|(new, old)| **new != due(side, *old)).count()).sum();
    Ok((wrong, values.len()))
}

/// GL-S1: operations, masks, tests, and which of the three operations is taken.
pub fn operations(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    clears(subject, findings)?;
    let no_depth = GlState { depth: None, ..GlState::WRITE };
    for op in GlStencilOp::ALL {
        let mut sides = Vec::new();
        for reference in [0, 0xAB, 300, -1] {
            for write_mask in [0xFF, 0x0F, 0x00] {
                sides.push(GlStencil { reference, write_mask, ..GlStencil::on_pass(op) });
            }
        }
        let due = |side: &GlStencil, old| verify::stencil(op, old, side.reference, side.write_mask);
        let (wrong, count) = rows(subject, &sides, no_depth, due)?;
        findings.none_wrong(format!("{op:?}"), wrong, count);
    }
    let mut sides = Vec::new();
    for compare in GlCompare::ALL {
        for reference in [0, 0x80, 0xAB, 300] {
            for read_mask in [0xFF, 0x0F] {
                sides.push(GlStencil { compare, reference, read_mask, ..GlStencil::on_pass(GlStencilOp::Invert) });
            }
        }
    }
    let due = |side: &GlStencil, old: u8| {
        if verify::stencil_passes(side.compare, side.reference, old, side.read_mask) { !old } else { old }
    };
    let (wrong, count) = rows(subject, &sides, no_depth, due)?;
    findings.none_wrong("8 tests, the reference on the left", wrong, count);
    chosen(subject, findings)?;
    repeated(subject, findings)
}

/// sfail, dpfail, dppass; a disabled depth test passes.
fn chosen(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let ops = [GlStencilOp::Invert, GlStencilOp::Zero, GlStencilOp::Replace];
    let side = |compare| GlStencil { compare, reference: 0x33, ops, ..GlStencil::on_pass(GlStencilOp::Keep) };
    let fails = GlState { depth: Some(GlCompare::Never), ..GlState::WRITE };
    let cases = [
        ("the stencil test fails", GlCompare::Never, GlState::WRITE, None),
        ("the depth test fails", GlCompare::Always, fails, Some(0)),
        ("both pass", GlCompare::Always, GlState::WRITE, Some(0x33)),
        ("there is no depth test", GlCompare::Always, GlState { depth: None, ..GlState::WRITE }, Some(0x33)),
    ];
    for (name, compare, state, due) in cases {
        let (wrong, count) = rows(subject, &[side(compare)], state, |_, old| due.unwrap_or(!old))?;
        findings.none_wrong(name, wrong, count);
    }
    Ok(())
}

/// 261 fragments a pixel in one draw: saturated at 255, or wrapped to 5.
fn repeated(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let quads: Vec<Vertex> = (0..261).flat_map(|_| full(0.0)).collect();
    let surface = subject.bench.surface([4, 4], None, Some(FORMAT))?;
    let cases = [
        (GlStencilOp::Increment, 0, 255),
        (GlStencilOp::IncrementWrap, 0, 5),
        (GlStencilOp::Decrement, 255, 0),
        (GlStencilOp::DecrementWrap, 255, 250),
    ];
    for (op, from, due) in cases {
        surface.clear_stencil(from);
        subject.bench.draw(&GlDraw::plain(&surface, GlState::counting(op, op), &quads))?;
        let value = surface.stencils()[5];
        findings.must_hold(format!("{op:?}, 261 times"), value == due, format!("{from} becomes {value}; {due} is due"));
    }
    Ok(())
}

/// GL-S2: mirrored or not, front faces either way: the sign of the area in the window decides.
pub fn facing(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), Some(FORMAT))?;
    for (mirrored, clockwise) in [(false, false), (false, true), (true, false), (true, true)] {
        let mut quad = rectangle([-1.0; 2], [1.0; 2], 0.0, [0.0; 4]);
        if mirrored {
            quad.iter_mut().for_each(|vertex| vertex.position[0] *= -1.0);
        }
        let front = mirrored == clockwise;
        let winding = if clockwise { "CW" } else { "CCW" };
        let name = format!("{} quad, {winding} is front", if mirrored { "mirrored" } else { "plain" });
        let sides = [GlStencil::on_pass(GlStencilOp::IncrementWrap), GlStencil::on_pass(GlStencilOp::DecrementWrap)];
        surface.clear_stencil(10);
        let state =
            GlState { clockwise, stencil: Some(sides), ..GlState::counting(GlStencilOp::Keep, GlStencilOp::Keep) };
        subject.bench.draw(&GlDraw::plain(&surface, state, &quad))?;
        let value = surface.stencils()[5];
        let seen =
            [(11, "front"), (9, "back")].into_iter().find(|(due, _)| *due == value).map_or("neither", |(_, side)| side);
        let due = if front { "front" } else { "back" };
        findings.must_hold(format!("{name}: stencil"), seen == due, format!("{seen}; {due} is due"));
        for cull in [GlFace::Front, GlFace::Back] {
            surface.clear_color([0.5; 4]);
            let shader = Shader { fragment: "result = vec4(gl_FrontFacing ? 1.0 : 0.0);", ..Shader::PLAIN };
            let state = GlState { depth: None, clockwise, cull: Some(cull), ..GlState::WRITE };
            subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, state, &quad) })?;
            let color = surface.colors()[5][0];
            let due = if (cull == GlFace::Front) == front { 128 } else { u8::from(front) * 255 };
            let right = color == due || (due == 128 && color == 127);
            findings.must_hold(
                format!("{name}: {cull:?} faces culled, gl_FrontFacing"),
                right,
                format!("{color}; {due} is due"),
            );
        }
    }
    Ok(())
}
