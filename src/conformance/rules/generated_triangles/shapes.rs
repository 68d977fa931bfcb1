//! Random primitives: their corners in clip space, and how a draw puts them together.

use super::model::Corner;
use super::pipeline::Pipeline;
use crate::conformance::bench::GlPrimitive;
use crate::conformance::random::Random;

/// A draw's vertices.
pub struct Shapes {
    pub primitive: GlPrimitive,
    pub corners: Vec<Corner>,
    pub indices: Option<Vec<u32>>,
    /// Short indices.
    pub short: bool,
    pub kind: &'static str,
}

impl Shapes {
    /// Vertices in the order in which they are drawn.
    fn order(&self) -> Vec<usize> {
        match &self.indices {
            Some(indices) => indices.iter().map(|index| *index as usize).collect(),
            None => (0..self.corners.len()).collect(),
        }
    }

    /// Corners of each triangle in its winding, and which of them is provoking [GL 4.6, 10.1, table 13.2].
    pub fn triangles(&self, first: bool) -> Vec<([usize; 3], usize)> {
        let order = self.order();
        let count = order.len();
        match self.primitive {
            GlPrimitive::Triangles => {
                let whole = order.chunks_exact(3);
                whole.map(|three| ([three[0], three[1], three[2]], if first { 0 } else { 2 })).collect()
            }
            GlPrimitive::TriangleStrip => (0..count.saturating_sub(2))
                .map(|at| {
                    let [a, b, c] = [order[at], order[at + 1], order[at + 2]];
                    match at % 2 {
                        0 => ([a, b, c], if first { 0 } else { 2 }),
                        _ => ([b, a, c], if first { 1 } else { 2 }),
                    }
                })
                .collect(),
            GlPrimitive::TriangleFan => (1..count.saturating_sub(1))
                .map(|at| ([order[0], order[at], order[at + 1]], if first { 1 } else { 2 }))
                .collect(),
            _ => Vec::new(),
        }
    }
}

/// Kinds of corners.
const KINDS: [&str; 9] = [
    "near the target",
    "with perspective",
    "with w of many sizes",
    "far away",
    "behind the eye",
    "slivers",
    "tiny",
    "across near and far",
    "degenerate",
];

/// Vertices of a few triangles that mostly touch the target.
pub fn shapes(dice: &mut Random, pipeline: &Pipeline, size: [u32; 2]) -> Shapes {
    let kind = dice.pick(&[0, 0, 0, 1, 1, 1, 2, 3, 4, 4, 5, 6, 7, 7, 8]);
    let primitive = dice.pick(&[GlPrimitive::Triangles, GlPrimitive::TriangleStrip, GlPrimitive::TriangleFan]);
    let count = match primitive {
        GlPrimitive::Triangles => 3 * dice.pick(&[1, 1, 2, 3]) + dice.pick(&[0, 0, 0, 1, 2]),
        _ => dice.whole(3, 6) as usize,
    };
    let common = dice.power(-20.0, 20.0);
    let anchor = place(dice, size, 0.0);
    let mut corners: Vec<Corner> =
        (0..count).map(|index| corner(dice, pipeline, size, kind, common, anchor, index)).collect();
    if kind == 8 {
        let (one, other) = (dice.below(count), dice.below(count));
        corners[one].clip = corners[other].clip;
        // A corner between two others.
        if dice.chance(0.3) {
            corners[2].clip = [0, 1, 2, 3].map(|part| (corners[0].clip[part] + corners[1].clip[part]) * 0.5);
        }
    }
    let indices = dice.chance(0.4).then(|| {
        let vertices = corners.len();
        (0..count).map(|index| if dice.chance(0.7) { index } else { dice.below(vertices) } as u32).collect()
    });
    Shapes { primitive, corners, indices, short: dice.chance(0.5), kind: KINDS[kind] }
}

/// A place in the window, in pixels, up to `beyond` target sizes outside of it.
fn place(dice: &mut Random, size: [u32; 2], beyond: f32) -> [f32; 2] {
    size.map(|side| dice.between(-beyond, 1.0 + beyond) * side as f32)
}

fn corner(
    dice: &mut Random,
    pipeline: &Pipeline,
    size: [u32; 2],
    kind: usize,
    common: f32,
    anchor: [f32; 2],
    index: usize,
) -> Corner {
    let (at, w) = match kind {
        1 => (place(dice, size, 0.4), common * dice.power(-3.0, 3.0)),
        2 => (place(dice, size, 0.0), dice.power(-20.0, 20.0)),
        3 => {
            let reach = dice.power(1.0, 11.0);
            (place(dice, size, reach), common)
        }
        4 => {
            let behind = index % 3 == 1 || dice.chance(0.2);
            let w = dice.power(-1.0, 2.0);
            (place(dice, size, 0.6), if behind { -w } else { w })
        }
        5 => {
            let along = dice.between(-1.0, 2.0);
            let [x, y] = [anchor[0] - 9.0, anchor[1] + 4.0];
            let way = [1.0 - 2.0 * y / size[1] as f32, x / size[0] as f32 - 0.3];
            let off = dice.between(-0.7, 0.7);
            ([0, 1].map(|part| anchor[part] + along * 30.0 * way[part] + off), common)
        }
        6 => (anchor.map(|at| at + dice.between(-1.5, 1.5)), common * dice.power(-1.0, 1.0)),
        _ => (place(dice, size, 0.3), common),
    };
    let reach = match kind {
        7 => 3.0,
        3 | 4 => 1.2,
        _ => 0.97,
    };
    let z = dice.between(-reach, reach);
    let [x, y, width, height] = pipeline.viewport.map(|part| part as f32);
    let ndc = [(at[0] - x) * 2.0 / width - 1.0, (at[1] - y) * 2.0 / height - 1.0];
    let distances = [(); 8].map(|()| dice.between(-0.3, 1.0) * dice.pick(&[1.0, 1.0, 0.001, 300.0]));
    Corner {
        clip: [ndc[0] * w, ndc[1] * w, z * w.abs(), w],
        value: [(); 4].map(|()| dice.exact(16)),
        distances: distances.map(|distance| distance * w.abs()),
    }
}
