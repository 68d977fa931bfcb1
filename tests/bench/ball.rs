//! A ball of many triangles as an OBJ file, for the bench's ladders and for the tests of growth.

use std::fmt::Write as _;

/// A closed ball of about `triangles`, as the text of an OBJ file. It stands on the plane y = 0.
pub fn ball(triangles: usize, radius: f32) -> String {
    let columns = ((triangles as f64).sqrt().round() as usize).max(4);
    let rows = (triangles / (2 * columns) + 1).max(3);
    let mut text = format!("v 0 {} 0\n", 2.0 * radius);
    for row in 1..rows {
        let up = std::f32::consts::PI * row as f32 / rows as f32;
        for column in 0..columns {
            let around = std::f32::consts::TAU * column as f32 / columns as f32;
            let [x, y, z] = [up.sin() * around.cos(), 1.0 + up.cos(), up.sin() * around.sin()].map(|at| radius * at);
            let _ = writeln!(text, "v {x} {y} {z}");
        }
    }
    let _ = writeln!(text, "v 0 0 0");
    let place = |row: usize, column: usize| match row {
        0 => 1,
        row if row == rows => (rows - 1) * columns + 2,
        row => 2 + (row - 1) * columns + column % columns,
    };
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(down, aside)| place(row + down, column + aside));
            if row + 1 < rows {
                let _ = writeln!(text, "f {a} {d} {c}");
            }
            if row > 0 {
                let _ = writeln!(text, "f {a} {b} {d}");
            }
        }
    }
    text
}
