//! Meshes whose skins are in blocks, each turned, scaled or mirrored for itself; pictures for them; points of triangles.

use std::f64::consts::TAU;

use glam::{DMat2, DVec2, DVec3, dvec2};
use glumbra::geometry::Mesh;
use glumbra::geometry::skin::{Raster, RepackOptions};

/// Side of the old skins in texels.
pub const SIDE: u32 = 256;

pub const OPTIONS: RepackOptions =
    RepackOptions { size: None, gutter: 2, unmirror: false, cut_degrees: 180.0, steps: None };

/// Parts of a grid of cells that are islands of the skin of their own.
pub struct Blocks {
    /// Blocks along u and v, and cells of each along u and v.
    pub blocks: [usize; 2],
    pub cells: [usize; 2],
}

impl Blocks {
    /// A mesh whose blocks each have a part of the skin for itself, mapped by `turn` from (u, v) of its cell in texels. `u`
    /// and `v` of `place` run from 0 to 1. Counter-clockwise from outside, if u × v points outwards.
    pub fn mesh(
        &self,
        place: impl Fn(f64, f64) -> (DVec3, DVec3),
        mut turn: impl FnMut(usize) -> (DMat2, bool),
    ) -> Mesh {
        let [across, up] = self.blocks;
        let [columns, rows] = self.cells;
        let mut mesh = Mesh { texcoords: Some(Vec::new()), ..Mesh::default() };
        let side = f64::from(SIDE);
        for block in 0..across * up {
            let (turned, is_mirrored) = turn(block);
            let mirror = if is_mirrored { dvec2(-1.0, 1.0) } else { DVec2::ONE };
            let first = mesh.positions.len() as u32;
            for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
                // The last column of a body that is closed around u is the first, to the bit.
                let u =
                    ((block % across * columns + column) % (across * columns + 1)) as f64 / (across * columns) as f64;
                let v = (block / across * rows + row) as f64 / (up * rows) as f64;
                let (position, normal) = place(u, v);
                mesh.positions.push(position.as_vec3().to_array());
                mesh.normals.push(normal.as_vec3().to_array());
                // The block's own square of the skin, around its middle.
                let squares = (across.max(up)) as f64;
                let middle = dvec2((block % across) as f64 + 0.5, (block / across) as f64 + 0.5) * side / squares;
                let own = dvec2(column as f64 / columns as f64, row as f64 / rows as f64) - 0.5;
                let texel = middle + turned * (mirror * own) * side / squares * 0.6;
                mesh.texcoords.as_mut().unwrap().push((texel / side).as_vec2().to_array());
            }
            let index = |row: usize, column: usize| first + (row * (columns + 1) + column) as u32;
            for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                let [a, b] = [index(row, column), index(row, column + 1)];
                let [c, d] = [index(row + 1, column), index(row + 1, column + 1)];
                mesh.indices.extend([a, b, d, a, d, c]);
            }
        }
        mesh
    }
}

/// A cylinder around y of radius 1 and height 2, outwards; its first and last columns meet to the bit.
pub fn cylinder(u: f64, v: f64) -> (DVec3, DVec3) {
    let (sine, cosine) = (TAU * u.rem_euclid(1.0)).sin_cos();
    // u counter-clockwise seen from above, v upwards: u × v is outwards.
    let outwards = DVec3::new(cosine, 0.0, -sine);
    (outwards + DVec3::Y * (2.0 * v - 1.0), outwards)
}

/// A sheet with waves.
pub fn sheet(u: f64, v: f64) -> (DVec3, DVec3) {
    let place = DVec3::new(2.0 * u, 2.0 * v, 0.1 * (9.0 * u).sin() * (7.0 * v).cos());
    let by_u = DVec3::new(2.0, 0.0, 0.9 * (9.0 * u).cos() * (7.0 * v).cos());
    let by_v = DVec3::new(0.0, 2.0, -0.7 * (9.0 * u).sin() * (7.0 * v).sin());
    (place, by_u.cross(by_v).normalize())
}

pub fn any_turn(random: &mut fastrand::Rng) -> DMat2 {
    DMat2::from_angle(TAU * random.f64())
}

/// A random mesh with random islands.
pub fn random_mesh(random: &mut fastrand::Rng) -> Mesh {
    let blocks =
        Blocks { blocks: [random.usize(1..5), random.usize(1..5)], cells: [random.usize(1..4), random.usize(1..4)] };
    let place = if random.bool() { cylinder } else { sheet };
    let mirrors = random.bool();
    let kind = random.u8(0..3);
    blocks.mesh(place, |_| {
        let turn = match kind {
            0 => DMat2::IDENTITY,
            1 => DMat2::from_angle(TAU / 4.0 * f64::from(random.u8(0..4))),
            _ => any_turn(random),
        };
        let size = DMat2::from_diagonal(dvec2(0.4 + 0.6 * random.f64(), 0.4 + 0.6 * random.f64()));
        (turn * size, mirrors && random.bool())
    })
}

pub fn random_options(random: &mut fastrand::Rng) -> RepackOptions {
    RepackOptions {
        size: random.bool().then(|| [random.u32(128..300), random.u32(128..300)]),
        gutter: random.u32(1..5),
        unmirror: random.bool(),
        cut_degrees: 180.0,
        steps: random.bool().then(|| random.u32(1..9)),
    }
}

/// Greatest change of [`smooth_decal`] in codes over a texel.
pub const GRADIENT: f64 = 3.0;

/// A picture of waves of three channels, of at most [`GRADIENT`].
pub fn smooth_decal(random: &mut fastrand::Rng) -> Raster {
    let waves = [(); 3].map(|()| (DVec2::from_angle(TAU * random.f64()), 127.0 / GRADIENT, TAU * random.f64()));
    let mut samples = Vec::new();
    for (y, x) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
        for (direction, length, phase) in waves {
            let at = direction.dot(dvec2(f64::from(x), f64::from(y))) / length + phase;
            samples.push((127.5 + 127.0 * at.sin()).round() as u16);
        }
    }
    Raster { size: [SIDE; 2], channels: 3, is_deep: false, samples }
}

/// The texel that holds a place.
pub fn lookup(picture: &Raster, place: DVec2) -> &[u16] {
    let [x, y] = [0, 1].map(|axis| place[axis].floor().clamp(0.0, f64::from(picture.size[axis] - 1)) as u32);
    picture.texel([x, y])
}

/// A random point of a triangle, as weights of its corners.
pub fn random_weights(random: &mut fastrand::Rng) -> [f64; 3] {
    let root = random.f64().sqrt();
    let share = random.f64();
    [1.0 - root, root * (1.0 - share), root * share]
}

pub fn at(corners: &[DVec2; 3], weights: [f64; 3]) -> DVec2 {
    (0..3).map(|corner| weights[corner] * corners[corner]).sum()
}

/// Texels of the old picture to one of the new, at most.
pub fn stretch(old: &[DVec2; 3], new: &[DVec2; 3]) -> f64 {
    let edges = |corners: &[DVec2; 3]| DMat2::from_cols(corners[1] - corners[0], corners[2] - corners[0]);
    let map = edges(old) * edges(new).inverse();
    let square = map.transpose() * map;
    let [half, det] = [0.5 * (square.x_axis.x + square.y_axis.y), square.determinant()];
    (half + (half * half - det).max(0.0).sqrt()).sqrt()
}
