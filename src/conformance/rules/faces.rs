//! GL-S4: stencil states of front and back faces, all different, in one draw [GL 4.6, 17.3.3].

use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Surface, Vertex, rectangle,
};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings, verify};

/// Values that stand in the buffer beforehand: one a column, for each face.
const OLD: [u8; 8] = [0, 1, 0x0F, 0x7F, 0x80, 0xAB, 254, 255];
const COLUMNS: usize = 2 * OLD.len();
/// Depths of the front face and the back face; 0.5 is stored.
const DEPTHS: [f64; 2] = [0.25, 0.75];

/// One row: both faces' states, and the depth test.
#[derive(Clone, Copy)]
struct Row {
    sides: [GlStencil; 2],
    depth: Option<GlCompare>,
}

impl Row {
    /// The value that is due in a column.
    fn due(&self, column: usize) -> u8 {
        let (face, old) = (column / OLD.len(), OLD[column % OLD.len()]);
        let side = self.sides[face];
        let passes = verify::stencil_passes(side.compare, side.reference, old, side.read_mask);
        let nearer = DEPTHS[face].total_cmp(&0.5);
        let op = match (passes, self.depth) {
            (false, _) => side.ops[0],
            (true, Some(depth)) if !depth.holds(nearer) => side.ops[1],
            (true, _) => side.ops[2],
        };
        verify::stencil(op, old, side.reference, side.write_mask)
    }
}

/// A front face on the left half and a back face on the right one.
fn both_faces() -> Vec<Vertex> {
    let front = rectangle([-1.0, -1.0], [0.0, 1.0], (DEPTHS[0] * 2.0 - 1.0) as f32, [0.0; 4]);
    let mut back = rectangle([0.0, -1.0], [1.0, 1.0], (DEPTHS[1] * 2.0 - 1.0) as f32, [0.0; 4]);
    back.reverse();
    front.into_iter().chain(back).collect()
}

/// GL-S4: every operation in every place and every function, of one face beside others of the other.
pub fn both(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(301);
    judge(subject, findings, "operations", &operations(), false)?;
    judge(subject, findings, "functions, references and read masks", &functions(), false)?;
    let mixed: Vec<Row> = (0..20).map(|_| mixed(&mut random)).collect();
    judge(subject, findings, "all different, write masks too", &mixed, false)?;
    // As renderers set it that have one test and one mask: by the calls for both faces, and operations by face.
    let tests =
        mixed[..8].iter().map(|row| Row { sides: [row.sides[0], with_test(row.sides[1], row.sides[0])], ..*row });
    judge(subject, findings, "one test and mask by glStencilFunc and glStencilMask", &tests.collect::<Vec<_>>(), true)?;
    let same = mixed[8..16].iter().map(|row| Row { sides: [row.sides[0]; 2], ..*row });
    judge(subject, findings, "one state by the calls without a face", &same.collect::<Vec<_>>(), true)?;
    wraps(subject, findings)
}

fn with_test(side: GlStencil, of: GlStencil) -> GlStencil {
    GlStencil { ops: side.ops, ..of }
}

/// Each operation in each of three places, the other places and the other face having others.
fn operations() -> Vec<Row> {
    let op = |index: usize| GlStencilOp::ALL[index % GlStencilOp::ALL.len()];
    let mut rows = Vec::new();
    for first in 0..GlStencilOp::ALL.len() {
        let side = |shift: usize, compare, reference| GlStencil {
            compare,
            reference,
            ops: [op(first + shift), op(first + shift + 1), op(first + shift + 3)],
            ..GlStencil::on_pass(GlStencilOp::Keep)
        };
        // In turn the front's fragment passes the depth test and the back's fails, and the other way round.
        for depth in [Some(GlCompare::Less), Some(GlCompare::Greater)] {
            rows.push(Row { sides: [side(0, GlCompare::Less, 0x66), side(2, GlCompare::GreaterEqual, 0x99)], depth });
        }
    }
    rows
}

/// Each function of a face beside the next of the other.
fn functions() -> Vec<Row> {
    let mut rows = Vec::new();
    for (index, compare) in GlCompare::ALL.into_iter().enumerate() {
        let side = |compare, reference, read_mask| GlStencil {
            compare,
            reference,
            read_mask,
            ops: [GlStencilOp::Zero, GlStencilOp::Keep, GlStencilOp::Invert],
            ..GlStencil::on_pass(GlStencilOp::Keep)
        };
        let next = GlCompare::ALL[(index + 3) % 8];
        for (reference, other, read_mask) in [(0x80, 1, 0xFF), (0xAB, 0x80, 0x0F)] {
            let sides = [side(compare, reference, read_mask), side(next, other, 0xF0)];
            rows.push(Row { sides, depth: None });
        }
    }
    rows
}

fn mixed(random: &mut Random) -> Row {
    let mut pick = |count: usize| (random.unit() * count as f32) as usize;
    let mut side = || GlStencil {
        compare: GlCompare::ALL[pick(8)],
        reference: pick(256) as i32,
        read_mask: [0xFF, 0x0F, 0xF0, 0x3C][pick(4)],
        write_mask: [0xFF, 0x0F, 0xAA, 0x7E][pick(4)],
        ops: [(); 3].map(|()| GlStencilOp::ALL[pick(8)]),
    };
    let sides = [side(), side()];
    let depth = [Some(GlCompare::Less), Some(GlCompare::Greater), Some(GlCompare::Always), None][pick(4)];
    Row { sides, depth }
}

/// A row of pixels for each state, drawn in turn, so that each state is set after another.
fn judge(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    what: &str,
    rows: &[Row],
    short_calls: bool,
) -> Result<(), Error> {
    let size = [COLUMNS as u32, rows.len() as u32];
    let surface = subject.bench.surface(size, None, Some(GlFormat::Depth24Stencil8))?;
    prepare(&surface);
    let vertices = both_faces();
    for (index, row) in rows.iter().enumerate() {
        let state = GlState {
            depth: row.depth,
            depth_write: false,
            stencil: Some(row.sides),
            color_write: false,
            scissor: Some([0, index as i32, COLUMNS as i32, 1]),
            short_calls,
            ..GlState::WRITE
        };
        subject.bench.draw(&GlDraw::plain(&surface, state, &vertices))?;
    }
    let values = surface.stencils();
    let pairs = rows.iter().zip(values.chunks(COLUMNS));
    let wrong = pairs.map(|(row, seen)| (0..COLUMNS).filter(|column| seen[*column] != row.due(*column)).count()).sum();
    findings.none_wrong(format!("{what}, {} states", rows.len()), wrong, values.len());
    Ok(())
}

fn prepare(surface: &Surface) {
    surface.clear_depth(0.5);
    for column in 0..COLUMNS {
        surface.clear_stencil_in(Some([column as i32, 0, 1, surface.size[1] as i32]), OLD[column % OLD.len()]);
    }
}

/// Both faces over the same pixels in one draw: 300 fronts that are counted up and 260 backs that are counted down, in
/// either order, by the operations that wrap.
fn wraps(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([4, 4], None, Some(GlFormat::Depth24Stencil8))?;
    let front = rectangle([-1.0; 2], [1.0; 2], 0.0, [0.0; 4]);
    let mut back = front;
    back.reverse();
    let (fronts, backs) = (front.repeat(300), back.repeat(260));
    let mut wrong = 0;
    for fronts_first in [true, false] {
        let vertices = if fronts_first { [fronts.clone(), backs.clone()] } else { [backs.clone(), fronts.clone()] };
        surface.clear_stencil(3);
        let state = GlState::counting(GlStencilOp::IncrementWrap, GlStencilOp::DecrementWrap);
        subject.bench.draw(&GlDraw::plain(&surface, state, &vertices.concat()))?;
        wrong += surface.stencils().into_iter().filter(|value| *value != 43).count();
    }
    findings.none_wrong("300 fronts and 260 backs in one draw, wrapped", wrong, 32);
    Ok(())
}
