//! Tests of tangent bases: formulas, displaced surfaces, mirrored and lost skins.

use std::f64::consts::TAU;

use super::*;
use crate::geometry::Part;
use crate::math::Aabb;

/// A mesh of a grid of (s, t) in [0, 1]², `columns` by `rows`, each vertex by a function of its place.
fn grid(
    [columns, rows]: [usize; 2],
    place: impl Fn(f64, f64) -> DVec3,
    normal: impl Fn(f64, f64) -> DVec3,
    skin: impl Fn(f64, f64) -> [f64; 2],
) -> Mesh {
    let at = |row: usize, column: usize| (column as f64 / columns as f64, row as f64 / rows as f64);
    let vertices: Vec<(f64, f64)> =
        (0..=rows).flat_map(|row| (0..=columns).map(move |column| at(row, column))).collect();
    let index = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
    let indices: Vec<u32> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .flat_map(|(row, column)| {
            let [a, b] = [index(row, column), index(row, column + 1)];
            let [c, d] = [index(row + 1, column), index(row + 1, column + 1)];
            [a, b, d, a, d, c]
        })
        .collect();
    let part = Part { name: String::new(), indices: 0..indices.len() as u32, material: None, bounds: Aabb::EMPTY };
    Mesh {
        positions: vertices.iter().map(|(u, v)| place(*u, *v).as_vec3().to_array()).collect(),
        normals: vertices.iter().map(|(u, v)| normal(*u, *v).as_vec3().to_array()).collect(),
        texcoords: Some(vertices.iter().map(|(u, v)| skin(*u, *v).map(|part| part as f32)).collect()),
        indices,
        parts: vec![part],
        ..Mesh::default()
    }
}

#[test]
fn edges_are_what_the_derivatives_say() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut number = || 2.0 * random.f64() - 1.0;
    for _ in 0..2000 {
        let places = [(); 3].map(|()| DVec3::new(number(), number(), number()));
        let skin = [(); 3].map(|()| [number(), number()]);
        let Some(found) = directions(places, skin) else { continue };
        let edges = [1, 2].map(|corner| places[corner] - places[0]);
        let [by_s, by_t] = derivatives(edges, skin, skin_area(skin).unwrap());
        for (edge, [s, t]) in edges.into_iter().zip(skin_edges(skin)) {
            let size = s.abs() * by_s.length() + t.abs() * by_t.length();
            assert!(edge.distance(s * by_s + t * by_t) < 1e-12 * size);
        }
        // T × B is outwards where the skin is not mirrored.
        let side = by_s.cross(by_t).dot(found.normal);
        assert!(side != 0.0 && (side < 0.0) == found.is_mirrored);
    }
}

/// A torus around y, s around the axis and t around the tube: T and B are the unit derivatives of its formula. A triangle
/// of a grid is half a cell: its derivatives are those of a place beside its middle, and the error falls with its size.
#[test]
fn bases_of_a_torus_are_those_of_its_formula() {
    let place = |u: f64, v: f64| {
        let around = 1.0 + 0.4 * (TAU * v).cos();
        DVec3::new(around * (TAU * u).cos(), 0.4 * (TAU * v).sin(), -around * (TAU * u).sin())
    };
    let along_s = |u: f64| DVec3::new(-(TAU * u).sin(), 0.0, -(TAU * u).cos());
    let along_t = |u: f64, v: f64| {
        let (sine, cosine) = (TAU * v).sin_cos();
        DVec3::new(-sine * (TAU * u).cos(), cosine, sine * (TAU * u).sin())
    };
    let normal = |u: f64, v: f64| along_s(u).cross(along_t(u, v));
    let worst = |segments: usize| {
        let mesh = grid([2 * segments, segments], place, normal, |u, v| [u, v]);
        let skin = mesh.texcoords.as_ref().unwrap();
        let tangents = Tangents::of_skin(&mesh, BasisFit::PerPolygon).unwrap();
        assert_eq!((tangents.mirrored, tangents.without), (0, 0));
        let triangles = mesh.indices.as_chunks::<3>().0.iter().zip(tangents.corners.as_chunks::<3>().0);
        let error = triangles.map(|(triangle, corners)| {
            let middle =
                |axis: usize| triangle.iter().map(|index| f64::from(skin[*index as usize][axis])).sum::<f64>() / 3.0;
            let (u, v) = (middle(0), middle(1));
            let [own, exact] = [corners[0].tangent, along_s(u)];
            own.angle_between(exact)
                .max(corners[0].bitangent.angle_between(along_t(u, v)))
                .max(corners[0].normal.angle_between(normal(u, v)))
        });
        error.fold(0.0, f64::max)
    };
    let errors = [16, 32, 64, 128].map(worst);
    println!("{errors:.5?} radians at 16, 32, 64, 128 segments");
    for pair in errors.windows(2) {
        assert!(pair[0] / pair[1] > 1.9, "{errors:?}");
    }
}

/// A square whose left half has its skin mirrored, and a slope of 1/2 along s: the true normal of the displaced surface
/// leans against the way that the height grows, which is +x on the right and -x on the left.
#[test]
fn a_mirrored_skin_has_its_bumps_outwards() {
    let skin = |u: f64, v: f64| [(2.0 * u - 1.0).abs(), v];
    let mesh = grid([2, 1], |u, v| DVec3::new(2.0 * u - 1.0, v, 0.0), |_, _| DVec3::Z, skin);
    for fit in [BasisFit::PerPolygon, BasisFit::Orthogonal, BasisFit::Skewed] {
        let tangents = Tangents::of_skin(&mesh, fit).unwrap();
        assert_eq!((tangents.mirrored, tangents.skewed, tangents.without), (2, 0, 0));
        let bump = DVec3::new(-0.5, 0.0, 1.0).normalize();
        for (index, corner) in tangents.corners.iter().enumerate() {
            let is_left = index / 6 == 0;
            let expected = DVec3::new(if is_left { 0.5 } else { -0.5 }, 0.0, 1.0).normalize();
            assert!(corner.model_from_tangent(bump).distance(expected) < 1e-6, "{fit:?} {index}: {corner:?}");
            assert!(corner.tangent_from_model(expected).distance(bump) < 1e-6);
        }
    }
}

/// A second judge: the surface is really moved along its normal by a small height. Its normals are those of the bump map
/// to first order, on a sheet whose skin is turned, stretched and mirrored.
#[test]
fn bumps_are_those_of_a_displaced_surface() {
    let mut random = fastrand::Rng::with_seed(5);
    for round in 0..40 {
        // Orthogonal skins of any turn, size and sense.
        let angle = TAU * random.f64();
        let [along_s, along_t] = [0.5 + random.f64(), 0.5 + random.f64()];
        let sense = if round % 2 == 0 { 1.0 } else { -1.0 };
        let by_s = along_s * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let by_t = sense * along_t * DVec3::new(-angle.sin(), angle.cos(), 0.0);
        let places = [DVec3::ZERO, by_s, by_t];
        let order = if sense > 0.0 { [0, 1, 2] } else { [0, 2, 1] };
        let skin = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let found = directions(order.map(|corner| places[corner]), order.map(|corner| skin[corner])).unwrap();
        let basis = found.fitted(DVec3::Z, BasisFit::Orthogonal);
        assert_eq!(found.is_mirrored, sense < 0.0);
        let [slope_s, slope_t] = [random.f64() - 0.5, random.f64() - 0.5];
        let mut errors = Vec::new();
        for height in [1e-1, 1e-2, 1e-3] {
            // The surface P(s, t) + height (slope_s s + slope_t t) N.
            let moved = (by_s + height * slope_s * DVec3::Z).cross(by_t + height * slope_t * DVec3::Z);
            let expected = (sense * moved).normalize();
            // The map's slopes are for lengths on the surface: divided by |P_s| and |P_t|.
            let bump = DVec3::new(-height * slope_s / along_s, -height * slope_t / along_t, 1.0).normalize();
            errors.push(basis.model_from_tangent(bump).angle_between(expected));
        }
        assert!(errors.iter().all(|error| *error < 1e-7), "{errors:?}");
    }
}

#[test]
fn corners_keep_the_normals_of_their_vertices() {
    let place = |u: f64, v: f64| DVec3::new(u + 0.3 * v, v, 0.2 * u * u);
    let normal = |u: f64, _: f64| DVec3::new(-0.4 * u, 0.1, 1.0).normalize();
    let mesh = grid([4, 4], place, normal, |u, v| [u, v]);
    for fit in [BasisFit::Orthogonal, BasisFit::Skewed] {
        let tangents = Tangents::of_skin(&mesh, fit).unwrap();
        assert!(tangents.skewed > 0, "sheared by 17 degrees");
        for (index, corner) in mesh.indices.iter().zip(&tangents.corners) {
            let vertex = DVec3::from_array(mesh.normals[*index as usize].map(f64::from));
            assert_eq!(corner.normal, vertex);
            // f32 normals are unit vectors to 1e-7.
            assert!(corner.tangent.dot(vertex).abs() < 1e-6 && corner.bitangent.dot(vertex).abs() < 1e-6);
            if fit == BasisFit::Orthogonal {
                assert!(corner.tangent.dot(corner.bitangent).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn triangles_without_a_direction_are_counted() {
    let flat = |skin: fn(f64, f64) -> [f64; 2]| grid([2, 2], |u, v| DVec3::new(u, v, 0.0), |_, _| DVec3::Z, skin);
    for (mesh, without) in [
        (flat(|_, _| [0.5, 0.5]), 8),
        (flat(|u, _| [u, u]), 8),
        (flat(|u, v| [u, v]), 0),
        (grid([2, 2], |u, _| DVec3::new(u, 0.0, 0.0), |_, _| DVec3::Y, |u, v| [u, v]), 8),
    ] {
        for fit in [BasisFit::PerPolygon, BasisFit::Orthogonal, BasisFit::Skewed] {
            let tangents = Tangents::of_skin(&mesh, fit).unwrap();
            assert_eq!(tangents.without, without);
            assert!(tangents.corners.iter().all(|corner| {
                // No direction on the skin: none in space.
                let length = if without > 0 { 0.0 } else { 1.0 };
                let is_long = |vector: DVec3, length: f64| (vector.length() - length).abs() < 1e-6;
                is_long(corner.tangent, length) && is_long(corner.bitangent, length) && is_long(corner.normal, 1.0)
            }));
        }
    }
    assert_eq!(Tangents::of_skin(&Mesh::default(), BasisFit::Orthogonal), None);
}
