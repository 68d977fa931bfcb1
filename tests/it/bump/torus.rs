//! Directions of s and t on a torus: those of its vertices are exact, and interpolated between them they are off by the square
//! of the segments' size.

use std::f64::consts::TAU;

use glam::DVec3;
use glumbra::geometry::{MeshTangents, primitive};

const MINOR: f64 = 0.4;

/// T, B and N at (s, t): derivatives of ((1 + r cos v) sin u, r sin v, (1 + r cos v) cos u), each of unit length.
fn exact(s: f64, t: f64) -> [DVec3; 3] {
    let ((sin_u, cos_u), (sin_v, cos_v)) = ((TAU * s).sin_cos(), (TAU * t).sin_cos());
    let tangent = DVec3::new(cos_u, 0.0, -sin_u);
    let bitangent = DVec3::new(-sin_v * sin_u, cos_v, -sin_v * cos_u);
    [tangent, bitangent, tangent.cross(bitangent)]
}

fn vector(at: [f32; 3]) -> DVec3 {
    DVec3::from_array(at.map(f64::from))
}

#[test]
fn the_built_in_torus_has_the_directions_of_its_formula() {
    let torus = primitive("torus").unwrap();
    let directions = torus.tangents.as_ref().unwrap();
    for (index, [s, t]) in torus.texcoords.as_ref().unwrap().iter().enumerate() {
        let [tangent, bitangent, normal] = exact(f64::from(*s), f64::from(*t));
        assert!(vector(directions.tangents[index]).distance(tangent) < 1e-6);
        assert!(vector(directions.bitangents[index]).distance(bitangent) < 1e-6);
        assert!(vector(torus.normals[index]).distance(normal) < 1e-6);
        let place = MINOR * normal;
        let (sin_u, cos_u) = (TAU * f64::from(*s)).sin_cos();
        assert!(vector(torus.positions[index]).distance(place + DVec3::new(sin_u, 0.0, cos_u)) < 1e-6);
    }
}

#[test]
fn the_error_of_interpolated_bases_falls_with_the_square_of_the_segments() {
    let worst = |segments: usize| {
        let place = |column: usize, row: usize| [column as f64 / segments as f64, row as f64 / segments as f64];
        let mut worst = 0.0_f64;
        for (column, row) in (0..segments).flat_map(|column| (0..segments).map(move |row| (column, row))) {
            let corners = [place(column, row), place(column + 1, row), place(column + 1, row + 1)];
            let axes = corners.map(|[s, t]| exact(s, t).map(|axis| axis.as_vec3().to_array()));
            // As a mesh keeps them: T, and the sense of B.
            let normals = axes.map(|[_, _, normal]| normal);
            let signed = axes.map(|[[x, y, z], ..]| [x, y, z, 1.0]);
            let kept = MeshTangents::from_signed(&normals, &signed);
            let [a, b] = [0.3, 0.45];
            let mix =
                |parts: &[[f32; 3]]| a * vector(parts[0]) + b * vector(parts[1]) + (1.0 - a - b) * vector(parts[2]);
            let [s, t] = [0, 1].map(|k| a * corners[0][k] + b * corners[1][k] + (1.0 - a - b) * corners[2][k]);
            for (found, due) in [mix(&kept.tangents), mix(&kept.bitangents), mix(&normals)].into_iter().zip(exact(s, t))
            {
                worst = worst.max(found.angle_between(due));
            }
        }
        worst
    };
    let errors = [24, 48, 96, 192].map(worst);
    println!("{errors:.6?} radians at 24, 48, 96, 192 segments");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.4, "{errors:?}");
    }
}
