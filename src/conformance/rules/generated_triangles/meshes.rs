//! Meshes without seams: each pixel has one fragment, whatever the corners' w and however they are put together
//! [GL 4.6, 14.6.1].

use crate::conformance::DriverUnderTest;
use crate::conformance::bench::{Error, GlChange, GlFormat, GlIndices, GlPrimitive};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};

const SIZE: [u32; 2] = [61, 47];
const ROUNDS: usize = 60;

const VERTEX: &str = "#version 330
layout(location = 0) in vec4 position;
void main() { gl_Position = position; }
";
const FRAGMENT: &str = "#version 330
out vec4 result;
void main() { result = vec4(1.0, gl_FrontFacing ? 1.0 : 0.0, 0.0, 1.0); }
";

/// A rectangle of cells in the window, whose inner corners are moved.
struct Mesh {
    low: [f32; 2],
    high: [f32; 2],
    cells: [usize; 2],
    /// Clip positions by rows.
    corners: Vec<[f32; 4]>,
}

impl Mesh {
    fn new(dice: &mut Random, viewport: [i32; 4]) -> Self {
        let low = SIZE.map(|side| dice.between(-1.0, 0.4) * side as f32);
        let high = [0, 1].map(|part| low[part] + dice.between(0.2, 1.8) * SIZE[part] as f32);
        let cells = [(); 2].map(|()| dice.whole(1, 9) as usize);
        let common = dice.power(-12.0, 12.0);
        let spread = dice.pick(&[0.0, 0.5, 3.0]);
        let mut corners = Vec::new();
        for row in 0..=cells[1] {
            for column in 0..=cells[0] {
                let place = [column, row];
                let at = [0, 1].map(|part| {
                    let inner = place[part] > 0 && place[part] < cells[part];
                    let moved = if inner { dice.between(-0.24, 0.24) } else { 0.0 };
                    let share = (place[part] as f32 + moved) / cells[part] as f32;
                    // The outer ends are what the judge takes them for.
                    low[part] * (1.0 - share) + high[part] * share
                });
                let w = common * dice.power(-spread, spread + 0.01);
                let [x, y] = [0, 1].map(|part| {
                    let [from, side] = [viewport[part], viewport[part + 2]].map(|number| number as f32);
                    (at[part] - from) * 2.0 / side - 1.0
                });
                corners.push([x * w, y * w, dice.between(-0.9, 0.9) * w, w]);
            }
        }
        Self { low, high, cells, corners }
    }

    fn at(&self, column: usize, row: usize) -> u32 {
        (row * (self.cells[0] + 1) + column) as u32
    }

    /// Indices of triangles in any order and from any corner.
    fn triangles(&self, dice: &mut Random) -> Vec<u32> {
        let mut triangles = Vec::new();
        for row in 0..self.cells[1] {
            for column in 0..self.cells[0] {
                let [a, b] = [self.at(column, row), self.at(column + 1, row)];
                let [c, d] = [self.at(column + 1, row + 1), self.at(column, row + 1)];
                let pair = if dice.chance(0.5) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                triangles.extend(pair);
            }
        }
        for index in (1..triangles.len()).rev() {
            triangles.swap(index, dice.below(index + 1));
        }
        triangles.iter_mut().for_each(|triangle| triangle.rotate_left(dice.below(3)));
        triangles.into_iter().flatten().collect()
    }

    /// A row of cells as a strip.
    fn strip(&self, row: usize) -> Vec<u32> {
        (0..=self.cells[0]).flat_map(|column| [self.at(column, row), self.at(column, row + 1)]).collect()
    }
}

/// Counts the fragments of each pixel by blending.
pub fn meshes(subject: &DriverUnderTest) -> Result<GradeTally, Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(9100);
    let surface = bench.surface(SIZE, Some(GlFormat::Rgba32F), Some(GlFormat::Depth24))?;
    let program = bench.whole_program(VERTEX, FRAGMENT)?;
    let stream = bench.stream(1)?;
    let mut tally = GradeTally::default();
    bench.set_state(
        &surface,
        crate::conformance::bench::GlState { depth: None, ..crate::conformance::bench::GlState::WRITE },
    );
    bench.change(GlChange::Switch(glow::BLEND, true));
    bench.change(GlChange::Blend([glow::ONE, glow::ONE]));
    bench.use_whole(&program);
    let whole = [0, 0, SIZE[0] as i32, SIZE[1] as i32];
    let mut viewport = whole;
    let mut scissor = None;
    for _ in 0..ROUNDS {
        if dice.chance(0.5) {
            viewport =
                dice.pick(&[whole, [3, 5, 40, 30], [-30, -20, 140, 99], [-700, -1200, 2600, 2000], [9, 2, 31, 77]]);
            bench.change(GlChange::Viewport(viewport));
        }
        bench.change(GlChange::Switch(glow::SCISSOR_TEST, false));
        bench.clear_outputs_as_it_is(1, [0.0; 4], 1.0)?;
        if dice.chance(0.3) {
            scissor = dice.pick(&[None, Some([4, 6, 30, 21]), Some([-9, 11, 50, 90])]);
            if let Some(area) = scissor {
                bench.change(GlChange::Scissor(area));
            }
        }
        bench.change(GlChange::Switch(glow::SCISSOR_TEST, scissor.is_some()));
        let mesh = Mesh::new(&mut dice, viewport);
        let floats: Vec<f32> = mesh.corners.as_flattened().to_vec();
        if dice.chance(0.5) {
            let indices = mesh.triangles(&mut dice);
            let short: Vec<u16> = indices.iter().map(|index| *index as u16).collect();
            let indices = if dice.chance(0.5) { GlIndices::Long(&indices) } else { GlIndices::Short(&short) };
            bench.draw_stream(&stream, GlPrimitive::Triangles, &floats, Some(indices))?;
        } else {
            for row in 0..mesh.cells[1] {
                let indices = mesh.strip(row);
                bench.draw_stream(&stream, GlPrimitive::TriangleStrip, &floats, Some(GlIndices::Long(&indices)))?;
            }
        }
        let inside = |at: [f64; 2], slack: f64| {
            (0..2).all(|part| {
                at[part] > f64::from(mesh.low[part]) + slack && at[part] < f64::from(mesh.high[part]) - slack
            })
        };
        let kept = |area: [i32; 4], at: [f64; 2]| {
            (0..2).all(|part| (f64::from(area[part])..f64::from(area[part] + area[part + 2])).contains(&at[part]))
        };
        for (index, color) in surface.floats().into_iter().enumerate() {
            let at = [index as u32 % SIZE[0], index as u32 / SIZE[0]].map(|place| f64::from(place) + 0.5);
            // The corners' places are rounded to f32 for viewports of thousands of pixels.
            let due = match (inside(at, 1.0 / 32.0), inside(at, -1.0 / 32.0)) {
                (true, _) => kept(viewport, at) && scissor.is_none_or(|area| kept(area, at)),
                (_, false) => false,
                _ => continue,
            };
            let off = f64::from(color[0]) - f64::from(u8::from(due));
            tally.add(verify::within(off, 0.0, 0.0), off);
        }
    }
    bench.change(GlChange::Switch(glow::BLEND, false));
    Ok(tally)
}
