//! The 162 unit normals that MD2 vertices name by number: the corners of an icosahedron, with each edge divided in four
//! and the faces likewise, moved to the unit sphere.

use glam::DVec3;

/// Number of directions: 10 · 4² + 2.
pub const COUNT: usize = 162;

/// The directions in the order of their numbers, in the file's space, of unit length.
pub fn directions() -> Vec<DVec3> {
    let lattice = lattice();
    let nearest = |rough: &[i8; 3]| {
        let rough = DVec3::from_array(rough.map(f64::from));
        lattice.iter().copied().max_by(|a, b| a.dot(rough).total_cmp(&b.dot(rough))).unwrap_or(DVec3::Z)
    };
    ROUGH.iter().map(nearest).collect()
}

/// Number of the direction that is nearest to one of the file's space; the first of several.
pub fn nearest_normal(direction: DVec3) -> u8 {
    let all = directions();
    let mut best = 0;
    for (number, candidate) in all.iter().enumerate() {
        if candidate.dot(direction) > all[best].dot(direction) {
            best = number;
        }
    }
    best as u8
}

/// All directions, in no order; those on edges and corners several times.
fn lattice() -> Vec<DVec3> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [(-1.0, -golden), (-1.0, golden), (1.0, -golden), (1.0, golden)] {
        corners.extend([DVec3::new(a, 0.0, b), DVec3::new(0.0, b, a), DVec3::new(b, a, 0.0)]);
    }
    // Corners of one edge are 2 apart, others farther.
    let are_near = |a: DVec3, b: DVec3| (a.distance(b) - 2.0).abs() < 0.1;
    let mut points = Vec::new();
    for (at, &a) in corners.iter().enumerate() {
        for (next, &b) in corners.iter().enumerate().skip(at + 1).filter(|(_, b)| are_near(a, **b)) {
            for &c in corners[next + 1..].iter().filter(|c| are_near(a, **c) && are_near(b, **c)) {
                let shares = (0..=4).flat_map(|i| (0..=4 - i).map(move |j| [i, j, 4 - i - j].map(f64::from)));
                points.extend(shares.map(|[i, j, k]| (i * a + j * b + k * c).normalize()));
            }
        }
    }
    points
}

/// The directions in hundredths: enough to tell them apart. Their order was found from the vertices of models, by the mean of
/// their triangles' normals.
const ROUGH: [[i8; 3]; COUNT] = [
    [-53, 0, 85],
    [-44, 24, 86],
    [-30, 0, 96],
    [-31, 50, 81],
    [-16, 26, 95],
    [0, 0, 100],
    [0, 85, 53],
    [-15, 72, 68],
    [15, 72, 68],
    [0, 53, 85],
    [31, 50, 81],
    [53, 0, 85],
    [30, 0, 96],
    [44, 24, 86],
    [16, 26, 95],
    [-68, 15, 72],
    [-81, 31, 50],
    [-59, 43, 69],
    [-85, 53, 0],
    [-86, 44, 24],
    [-72, 68, 15],
    [-69, 59, 43],
    [-50, 81, 31],
    [-24, 86, 44],
    [-43, 69, 59],
    [-72, 68, -15],
    [-50, 81, -31],
    [-53, 85, 0],
    [0, 85, -53],
    [-24, 86, -44],
    [0, 96, -30],
    [-26, 95, -16],
    [0, 100, 0],
    [0, 96, 30],
    [-26, 95, 16],
    [24, 86, 44],
    [26, 95, 16],
    [50, 81, 31],
    [24, 86, -44],
    [26, 95, -16],
    [50, 81, -31],
    [85, 53, 0],
    [72, 68, 15],
    [72, 68, -15],
    [53, 85, 0],
    [43, 69, 59],
    [86, 44, 24],
    [69, 59, 43],
    [81, 31, 50],
    [68, 15, 72],
    [59, 43, 69],
    [96, 30, 0],
    [100, 0, 0],
    [95, 16, 26],
    [85, -53, 0],
    [96, -30, 0],
    [86, -44, 24],
    [95, -16, 26],
    [81, -31, 50],
    [68, -15, 72],
    [85, 0, 53],
    [86, 44, -24],
    [81, 31, -50],
    [95, 16, -26],
    [53, 0, -85],
    [68, 15, -72],
    [68, -15, -72],
    [85, 0, -53],
    [81, -31, -50],
    [86, -44, -24],
    [95, -16, -26],
    [15, 72, -68],
    [31, 50, -81],
    [43, 69, -59],
    [44, 24, -86],
    [59, 43, -69],
    [69, 59, -43],
    [-15, 72, -68],
    [-31, 50, -81],
    [0, 53, -85],
    [-53, 0, -85],
    [-44, 24, -86],
    [-30, 0, -96],
    [-16, 26, -95],
    [0, 0, -100],
    [30, 0, -96],
    [16, 26, -95],
    [-44, -24, -86],
    [-31, -50, -81],
    [-16, -26, -95],
    [0, -85, -53],
    [-15, -72, -68],
    [15, -72, -68],
    [0, -53, -85],
    [31, -50, -81],
    [44, -24, -86],
    [16, -26, -95],
    [24, -86, -44],
    [50, -81, -31],
    [43, -69, -59],
    [72, -68, -15],
    [69, -59, -43],
    [59, -43, -69],
    [0, -96, -30],
    [0, -100, 0],
    [26, -95, -16],
    [0, -85, 53],
    [0, -96, 30],
    [24, -86, 44],
    [26, -95, 16],
    [50, -81, 31],
    [72, -68, 15],
    [53, -85, 0],
    [-24, -86, -44],
    [-50, -81, -31],
    [-26, -95, -16],
    [-85, -53, 0],
    [-72, -68, -15],
    [-72, -68, 15],
    [-53, -85, 0],
    [-50, -81, 31],
    [-24, -86, 44],
    [-26, -95, 16],
    [-86, -44, 24],
    [-81, -31, 50],
    [-69, -59, 43],
    [-68, -15, 72],
    [-44, -24, 86],
    [-59, -43, 69],
    [-31, -50, 81],
    [-15, -72, 68],
    [-43, -69, 59],
    [-16, -26, 95],
    [44, -24, 86],
    [16, -26, 95],
    [31, -50, 81],
    [15, -72, 68],
    [0, -53, 85],
    [43, -69, 59],
    [59, -43, 69],
    [69, -59, 43],
    [-96, 30, 0],
    [-95, 16, 26],
    [-100, 0, 0],
    [-85, 0, 53],
    [-96, -30, 0],
    [-95, -16, 26],
    [-86, 44, -24],
    [-95, 16, -26],
    [-81, 31, -50],
    [-86, -44, -24],
    [-95, -16, -26],
    [-81, -31, -50],
    [-68, 15, -72],
    [-68, -15, -72],
    [-85, 0, -53],
    [-69, 59, -43],
    [-59, 43, -69],
    [-43, 69, -59],
    [-43, -69, -59],
    [-59, -43, -69],
    [-69, -59, -43],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_the_lattice_each_once() {
        let all = directions();
        for (index, direction) in all.iter().enumerate() {
            assert!((direction.length() - 1.0).abs() < 1e-12);
            let rough = DVec3::from_array(ROUGH[index].map(|part| f64::from(part) / 100.0));
            assert!(direction.distance(rough) < 0.01, "{index}: {direction} is not {rough}");
            assert!(all[..index].iter().all(|other| other.angle_between(*direction) > 0.2), "{index} is there twice");
        }
        // Every point of the lattice is in the table.
        for point in lattice() {
            assert!(all.iter().any(|direction| direction.distance(point) < 1e-12), "{point}");
        }
    }
}
