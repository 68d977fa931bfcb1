//! A small town house's façade: a brick wall with window recesses, stone trim and a balcony, shutters and a door, glass, and
//! a street lamp before it. One OBJ file for each material. Units: metres; the wall lies in z = 0 and looks along +z.

use std::fmt::Write as _;

use glam::{DVec2, DVec3, dvec2, dvec3};
use image::RgbImage;

use super::noise::{hash, tiled_noise};
use super::textures::draw;

/// Width of the house, its height to the roof, its depth.
const HOUSE: DVec3 = dvec3(9.0, 8.6, 5.0);

/// Depth of the recesses.
const RECESS: f64 = 0.32;

/// Openings: left, right, bottom, top.
const OPENINGS: [[f64; 4]; 9] = [
    [-3.55, -2.25, 0.95, 2.75],
    [-0.65, 0.65, 0.30, 2.75],
    [2.25, 3.55, 0.95, 2.75],
    [-3.45, -2.35, 3.95, 5.75],
    [-0.65, 0.65, 3.45, 5.75],
    [2.35, 3.45, 3.95, 5.75],
    [-3.35, -2.45, 6.55, 7.65],
    [-0.45, 0.45, 6.55, 7.65],
    [2.45, 3.35, 6.55, 7.65],
];

const DOOR: usize = 1;
const BALCONY: usize = 4;

/// Bricks are laid out over squares of this side.
const TILE: f64 = 1.0;

/// Triangles' corners, four for each rectangle, with texture coordinates.
#[derive(Default)]
struct Rectangles {
    corners: Vec<(DVec3, DVec2)>,
}

impl Rectangles {
    /// A rectangle from `at`, counter-clockwise as seen from its front.
    fn add(&mut self, at: DVec3, right: DVec3, up: DVec3) {
        for corner in [at, at + right, at + right + up, at + up] {
            // The coordinate across the rectangle's plane has no part in its texture.
            let along = if right.x.abs() + up.x.abs() > 0.0 { corner.x } else { corner.z };
            let above = if right.y.abs() + up.y.abs() > 0.0 { corner.y } else { corner.z };
            self.corners.push((corner, dvec2(along, above) / TILE));
        }
    }

    /// A box's six sides.
    fn add_box(&mut self, min: DVec3, max: DVec3) {
        let size = max - min;
        let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
        self.add(min + z, x, y);
        self.add(min + x, -x, y);
        self.add(min + x + z, -z, y);
        self.add(min, z, y);
        self.add(min + y + z, x, -z);
        self.add(min, x, z);
    }

    /// A box by its middle line along x, its lower edge, and its size.
    fn add_block(&mut self, center_x: f64, bottom: f64, front: f64, size: DVec3) {
        let min = dvec3(center_x - 0.5 * size.x, bottom, front - size.z);
        self.add_box(min, min + size);
    }

    fn obj_text(&self, what: &str) -> String {
        let mut text = format!("# {what} of a façade, made by generate_data.\n");
        for (position, _) in &self.corners {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "v {:.3} {:.3} {:.3}", position.x, position.y, position.z);
        }
        for (_, st) in &self.corners {
            let _ = writeln!(text, "vt {:.4} {:.4}", st.x, st.y);
        }
        for first in (1..=self.corners.len()).step_by(4) {
            let corners = (first..first + 4).map(|corner| format!(" {corner}/{corner}"));
            let _ = writeln!(text, "f{}", corners.collect::<String>());
        }
        text
    }
}

/// The files below `meshes/`, with their text.
pub fn meshes() -> Vec<(&'static str, String)> {
    vec![
        ("facade-wall.obj", wall().obj_text("Brick")),
        ("facade-stone.obj", stone().obj_text("Stone")),
        ("facade-wood.obj", wood().obj_text("Painted wood")),
        ("facade-glass.obj", glass().obj_text("Glass")),
        ("facade-iron.obj", iron().obj_text("Iron")),
    ]
}

/// Ends of the intervals that openings cut an axis into.
fn cuts(first: f64, last: f64, ends: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut cuts: Vec<f64> = ends.chain([first, last]).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}

fn wall() -> Rectangles {
    let mut wall = Rectangles::default();
    let (half, height, depth) = (0.5 * HOUSE.x, HOUSE.y, HOUSE.z);
    let rows = cuts(0.0, height, OPENINGS.iter().flat_map(|[_, _, bottom, top]| [*bottom, *top]));
    let columns = cuts(-half, half, OPENINGS.iter().flat_map(|[left, right, ..]| [*left, *right]));
    for row in rows.windows(2) {
        for column in columns.windows(2) {
            let (x, y) = (0.5 * (column[0] + column[1]), 0.5 * (row[0] + row[1]));
            let is_open = |[left, right, bottom, top]: &[f64; 4]| *left < x && x < *right && *bottom < y && y < *top;
            if !OPENINGS.iter().any(is_open) {
                let size = dvec2(column[1] - column[0], row[1] - row[0]);
                wall.add(dvec3(column[0], row[0], 0.0), DVec3::X * size.x, DVec3::Y * size.y);
            }
        }
    }
    for [left, right, bottom, top] in OPENINGS {
        let (width, tall, deep) = (DVec3::X * (right - left), DVec3::Y * (top - bottom), DVec3::Z * RECESS);
        wall.add(dvec3(left, bottom, 0.0), -deep, tall);
        wall.add(dvec3(right, bottom, -RECESS), deep, tall);
        wall.add(dvec3(left, bottom, 0.0), width, -deep);
        wall.add(dvec3(left, top, -RECESS), width, deep);
    }
    let (x, y, z) = (DVec3::X * HOUSE.x, DVec3::Y * height, DVec3::Z * depth);
    wall.add(dvec3(-half, 0.0, -depth), z, y);
    wall.add(dvec3(half, 0.0, 0.0), -z, y);
    wall.add(dvec3(half, 0.0, -depth), -x, y);
    wall.add(dvec3(-half, height, 0.0), x, -z);
    wall
}

fn stone() -> Rectangles {
    let mut stone = Rectangles::default();
    // Plinth on both sides of the door, string courses, cornice.
    stone.add_box(dvec3(-4.56, 0.0, -0.1), dvec3(-0.85, 0.62, 0.10));
    stone.add_box(dvec3(0.85, 0.0, -0.1), dvec3(4.56, 0.62, 0.10));
    for (bottom, height, front) in [(3.10, 0.22, 0.12), (6.02, 0.16, 0.10), (8.05, 0.20, 0.16), (8.25, 0.35, 0.38)] {
        stone.add_box(dvec3(-4.5 - front, bottom, -HOUSE.z), dvec3(4.5 + front, bottom + height, front));
    }
    // Quoins at both ends of the wall.
    for (index, side) in (0..12).flat_map(|index| [(index, -1.0), (index, 1.0)]) {
        let wide = if index % 2 == 0 { 0.55 } else { 0.34 };
        let bottom = 0.66 + 0.61 * f64::from(index);
        stone.add_block(side * (4.54 - 0.5 * wide), bottom, 0.05, dvec3(wide, 0.55, 0.3));
    }
    for (index, [left, right, bottom, top]) in OPENINGS.into_iter().enumerate() {
        let (middle, width) = (0.5 * (left + right), right - left);
        stone.add_block(middle, top, 0.07, dvec3(width + 0.36, 0.24, 0.2));
        stone.add_block(middle, top, 0.13, dvec3(0.22, 0.30, 0.2));
        if index != DOOR && index != BALCONY {
            stone.add_block(middle, bottom - 0.12, 0.20, dvec3(width + 0.30, 0.12, 0.5));
        }
    }
    // Steps before the door, the balcony's slab and its two brackets.
    stone.add_block(0.0, 0.0, 0.85, dvec3(2.2, 0.15, 0.85));
    stone.add_block(0.0, 0.15, 0.50, dvec3(1.8, 0.15, 0.82));
    stone.add_block(0.0, 3.30, 1.10, dvec3(3.0, 0.16, 1.1));
    for side in [-1.05, 1.05] {
        stone.add_block(side, 2.98, 0.75, dvec3(0.22, 0.32, 0.75));
        stone.add_block(side, 2.70, 0.38, dvec3(0.22, 0.28, 0.38));
    }
    stone
}

fn wood() -> Rectangles {
    let mut wood = Rectangles::default();
    for (index, [left, right, bottom, top]) in OPENINGS.into_iter().enumerate() {
        let (middle, width, height) = (0.5 * (left + right), right - left, top - bottom);
        let front = -RECESS + 0.10;
        let bar = 0.09;
        for x in [left + 0.5 * bar, right - 0.5 * bar] {
            wood.add_block(x, bottom, front, dvec3(bar, height, 0.09));
        }
        for y in [bottom, top - bar] {
            wood.add_block(middle, y, front, dvec3(width, bar, 0.09));
        }
        if index == DOOR {
            // Two leaves with panels, below a light.
            for side in [-1.0, 1.0] {
                wood.add_block(side * 0.28, bottom, front - 0.02, dvec3(0.55, 1.95, 0.06));
                for (y, tall) in [(0.15, 0.62), (0.92, 0.86)] {
                    wood.add_block(side * 0.28, bottom + y, front + 0.02, dvec3(0.34, tall, 0.05));
                }
            }
            wood.add_block(middle, bottom + 1.95, front, dvec3(width, 0.08, 0.09));
            continue;
        }
        wood.add_block(middle, bottom, front, dvec3(0.07, height, 0.08));
        for part in 1..3 {
            wood.add_block(middle, bottom + height * f64::from(part) / 3.0, front - 0.01, dvec3(width, 0.045, 0.07));
        }
        if index >= 3 {
            shutters(&mut wood, left, right, bottom, height);
        }
    }
    wood
}

/// Open shutters on both sides of a window, each with slats.
fn shutters(wood: &mut Rectangles, left: f64, right: f64, bottom: f64, height: f64) {
    let width = 0.5 * (right - left);
    for x in [left - 0.5 * width - 0.03, right + 0.5 * width + 0.03] {
        wood.add_block(x, bottom, 0.05, dvec3(width - 0.04, height, 0.05));
        let slats = (height / 0.16).floor() as u32;
        for slat in 0..slats {
            let y = bottom + 0.06 + f64::from(slat) * (height - 0.08) / f64::from(slats);
            wood.add_block(x, y, 0.075, dvec3(width - 0.16, 0.07, 0.04));
        }
    }
}

fn glass() -> Rectangles {
    let mut glass = Rectangles::default();
    for [left, right, bottom, top] in OPENINGS {
        let at = dvec3(left, bottom, -RECESS + 0.03);
        glass.add(at, DVec3::X * (right - left), DVec3::Y * (top - bottom));
    }
    glass
}

fn iron() -> Rectangles {
    let mut iron = Rectangles::default();
    // The balcony's railing: front and two sides.
    let (bottom, top, front) = (3.46, 4.42, 1.02);
    for rail in [bottom + 0.06, top - 0.05] {
        iron.add_block(0.0, rail, front + 0.03, dvec3(2.88, 0.05, 0.06));
        for side in [-1.42, 1.42] {
            iron.add_block(side, rail, front, dvec3(0.06, 0.05, front));
        }
    }
    for bar in 0..=18 {
        iron.add_block(-1.42 + 2.84 * f64::from(bar) / 18.0, bottom, front + 0.015, dvec3(0.03, top - bottom, 0.03));
    }
    for (side, bar) in [-1.42, 1.42].into_iter().flat_map(|side| (1..7).map(move |bar| (side, bar))) {
        iron.add_block(side, bottom, front * f64::from(bar) / 7.0, dvec3(0.03, top - bottom, 0.03));
    }
    // A street lamp: foot, post, arm, lantern and its cap.
    let (x, z) = (1.9, 3.2);
    for (y, side, tall) in [(0.0, 0.34, 0.35), (0.35, 0.20, 0.25), (0.60, 0.09, 2.70), (3.30, 0.24, 0.06)] {
        iron.add_block(x, y, z + 0.5 * side, dvec3(side, tall, side));
    }
    iron.add_block(x, 3.36, z + 0.17, dvec3(0.34, 0.42, 0.34));
    iron.add_block(x, 3.78, z + 0.23, dvec3(0.46, 0.07, 0.46));
    iron.add_block(x, 3.85, z + 0.10, dvec3(0.20, 0.12, 0.20));
    iron
}

/// Bricks in stretcher bond, each of its own red, with pale joints. Repeats without a seam.
pub fn bricks() -> RgbImage {
    draw([256; 2], brick_color)
}

fn brick_color(place: DVec2) -> DVec3 {
    const ROWS: f64 = 12.0;
    const COLUMNS: f64 = 4.0;
    let row = (place.y * ROWS).floor();
    let shift = if row as i64 % 2 == 0 { 0.0 } else { 0.5 };
    let along = place.x * COLUMNS + shift;
    let column = along.floor().rem_euclid(COLUMNS);
    let inside = dvec2((along - along.floor()) / COLUMNS, (place.y * ROWS - row) / ROWS);
    let edge = inside.x.min(1.0 / COLUMNS - inside.x).min(inside.y).min(1.0 / ROWS - inside.y);
    let grain = tiled_noise(dvec3(32.0 * place.x, 32.0 * place.y, 0.5), 32, 61);
    if edge < 0.006 {
        return dvec3(0.74, 0.70, 0.64) * (0.95 + 0.05 * grain);
    }
    let own = hash(column as i64, row as i64, 3, 62);
    let color = dvec3(0.66, 0.34, 0.25) * (1.0 - own) + dvec3(0.52, 0.24, 0.19) * own;
    color * (0.97 + 0.08 * grain)
}
