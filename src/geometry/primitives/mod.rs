//! Built-in meshes, found by name. Each call makes a new one, in its own (model) space.

mod teapot;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{Mesh, MeshTangents, Part};
use crate::math::Aabb;

/// The names that [`primitive`] knows.
pub const PRIMITIVES: &[&str] = &["quad", "box", "sphere", "torus", "teapot"];

/// Distance from the y axis to the middle of a torus's tube.
const TORUS_MAJOR: f64 = 1.0;
/// The radius of the torus's tube.
const TORUS_MINOR: f64 = 0.4;

/// The built-in mesh of that name, wound counter-clockwise seen from outside:
///
/// - `quad`: side 2 in x and z at y = 0, normal +y, s along +x and t along -z from 0 to 1;
/// - `box`: side 2 around the origin, flat normals, each face with the whole texture;
/// - `sphere`: radius 1, poles on the y axis, s around and t upwards;
/// - `torus`: around the y axis, radii 1 and 0.4;
/// - `teapot`: Newell's, as glutSolidTeapot(1): y up, spout to +x, x from -1.5 to 1.72, y from -0.75 to 0.825.
pub fn primitive(name: &str) -> Option<Mesh> {
    match name {
        "quad" => Some(quad()),
        "box" => Some(cube()),
        "sphere" => Some(sphere(96, 48)),
        "torus" => Some(torus(96, 48)),
        "teapot" => Some(teapot::teapot()),
        _ => None,
    }
}

/// A mesh in the making.
#[derive(Default)]
struct Builder {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    texcoords: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Builder {
    fn add_vertex(&mut self, position: DVec3, normal: DVec3, texcoord: [f64; 2]) {
        // Adding zero makes 0 of -0, so that equal places are equal bits.
        self.positions.push((position.as_vec3() + 0.0).to_array());
        self.normals.push((normal.normalize_or(DVec3::Y).as_vec3() + 0.0).to_array());
        self.texcoords.push(texcoord.map(|x| x as f32));
    }

    /// Adds a triangle, unless two of its corners lie at one place.
    fn add_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        if a != b && b != c && c != a {
            self.indices.extend(corners);
        }
    }

    /// Adds the cells of a grid of `columns + 1` by `rows + 1` vertices that begins at vertex `first`, row by row;
    /// columns crossed with rows point outwards.
    fn add_grid(&mut self, first: u32, columns: u32, rows: u32) {
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                self.add_triangle([a, b, c]);
                self.add_triangle([a, c, d]);
            }
        }
    }

    fn finish(self, name: &str) -> Mesh {
        let part =
            Part { name: name.to_owned(), indices: 0..self.indices.len() as u32, material: None, bounds: Aabb::EMPTY };
        let mut mesh = Mesh {
            name: name.to_owned(),
            positions: self.positions,
            normals: self.normals,
            texcoords: Some(self.texcoords),
            indices: self.indices,
            parts: vec![part],
            ..Mesh::default()
        };
        mesh.update_bounds();
        mesh
    }
}

fn quad() -> Mesh {
    let mut builder = Builder::default();
    add_face(&mut builder, DVec3::ZERO, DVec3::X, -DVec3::Z);
    builder.finish("quad")
}

/// A square of side 2 around `center`, s along `right` and t along `above`.
fn add_face(builder: &mut Builder, center: DVec3, right: DVec3, above: DVec3) {
    let first = builder.positions.len() as u32;
    for [s, t] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
        let position = center + (2.0 * s - 1.0) * right + (2.0 * t - 1.0) * above;
        builder.add_vertex(position, right.cross(above), [s, t]);
    }
    builder.add_grid(first, 1, 1);
}

fn cube() -> Mesh {
    let mut builder = Builder::default();
    for (normal, above) in [
        (DVec3::X, DVec3::Y),
        (-DVec3::X, DVec3::Y),
        (DVec3::Y, -DVec3::Z),
        (-DVec3::Y, DVec3::Z),
        (DVec3::Z, DVec3::Y),
        (-DVec3::Z, DVec3::Y),
    ] {
        add_face(&mut builder, normal, above.cross(normal), above);
    }
    builder.finish("box")
}

/// Latitude and longitude; the poles' triangles are fans, the seam's vertices lie at one place to the bit.
fn sphere(columns: u32, rows: u32) -> Mesh {
    let mut builder = Builder::default();
    for row in 0..=rows {
        let (height, radius) = match row {
            0 => (-1.0, 0.0),
            row if row == rows => (1.0, 0.0),
            _ => {
                let latitude = PI * (f64::from(row) / f64::from(rows) - 0.5);
                (latitude.sin(), latitude.cos())
            }
        };
        for column in 0..=columns {
            let (sine, cosine) = turn(column, columns);
            let position = DVec3::new(radius * sine, height, radius * cosine);
            builder.add_vertex(position, position, [fraction(column, columns), fraction(row, rows)]);
        }
    }
    builder.add_grid(0, columns, rows);
    builder.finish("sphere")
}

fn torus(columns: u32, rows: u32) -> Mesh {
    let mut builder = Builder::default();
    for row in 0..=rows {
        let (height, outwards) = turn(row, rows);
        for column in 0..=columns {
            let (sine, cosine) = turn(column, columns);
            let normal = DVec3::new(outwards * sine, height, outwards * cosine);
            let center = TORUS_MAJOR * DVec3::new(sine, 0.0, cosine);
            let texcoord = [fraction(column, columns), fraction(row, rows)];
            builder.add_vertex(center + TORUS_MINOR * normal, normal, texcoord);
        }
    }
    builder.add_grid(0, columns, rows);
    let mut mesh = builder.finish("torus");
    mesh.tangents = Some(torus_tangents(columns, rows));
    mesh
}

/// The unit derivatives of the torus's formula by s and t.
fn torus_tangents(columns: u32, rows: u32) -> MeshTangents {
    let mut tangents = MeshTangents::default();
    for row in 0..=rows {
        let (height, outwards) = turn(row, rows);
        for column in 0..=columns {
            let (sine, cosine) = turn(column, columns);
            tangents.tangents.push(DVec3::new(cosine, 0.0, -sine).as_vec3().to_array());
            let along_t = DVec3::new(-height * sine, outwards, -height * cosine);
            tangents.bitangents.push(along_t.as_vec3().to_array());
        }
    }
    tangents
}

/// Sine and cosine of a `step` of `steps` of a turn; the last is the first to the bit.
fn turn(step: u32, steps: u32) -> (f64, f64) {
    (TAU * fraction(step % steps, steps)).sin_cos()
}

fn fraction(step: u32, steps: u32) -> f64 {
    f64::from(step) / f64::from(steps)
}

#[cfg(test)]
mod tests;
