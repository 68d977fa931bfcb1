//! Meshes that are hard in one way each, with what is known of them.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};
use glumbra::geometry::volume::LightSource;
use glumbra::geometry::{Mesh, load_obj, primitive};
use proptest::prelude::*;

use crate::oracle::scenes::{Shape, cuboid, mesh, sphere, torus};

pub struct Case {
    pub name: &'static str,
    pub mesh: Mesh,
    /// True if only light-facing triangles count, for a light outside.
    pub facing_only: bool,
}

/// Every kind of mesh but random ones.
pub fn cases() -> Vec<Case> {
    let case = |name, mesh, facing_only| Case { name, mesh, facing_only };
    let shape = |name, shape: Shape, facing_only| Case { name, mesh: mesh(&shape), facing_only };
    vec![
        case("teapot", primitive("teapot").unwrap(), false),
        case("quad", primitive("quad").unwrap(), false),
        case("box", primitive("box").unwrap(), true),
        shape("torus", turned(torus(DVec3::ZERO, 1.0, 0.4, 24, 12)), true),
        shape("torus knot", torus_knot(160, 12), true),
        shape("nested boxes", nested_boxes(300), true),
        shape("low-polygon figure", figure(), true),
        shape("inside out", turned(cuboid(-DVec3::ONE, DVec3::ONE)), false),
        shape("two triangles back to back", doubled(true), false),
        shape("a triangle twice", doubled(false), false),
        shape("four pages on one spine", pages(4), false),
        shape("one face turned", one_turned(cuboid(-DVec3::ONE, DVec3::ONE)), false),
        shape("slivers and points", slivers(), false),
        shape("closed with a needle", needle(), true),
    ]
}

pub fn dense() -> Mesh {
    load_obj("data/meshes/dense.obj".as_ref()).unwrap().0
}

/// Around the torus three times while going through it twice; closed, and nowhere through itself.
pub fn torus_knot(along: u32, around: u32) -> Shape {
    let middle = |u: f64| {
        let (a, b) = (2.0 * TAU * u, 3.0 * TAU * u);
        let out = 1.0 + 0.45 * b.cos();
        DVec3::new(out * a.cos(), 0.45 * b.sin(), out * a.sin())
    };
    let mut points = Vec::new();
    for k in 0..along {
        let u = f64::from(k) / f64::from(along);
        let way = (middle(u + 1e-4) - middle(u - 1e-4)).normalize();
        let right = way.cross(DVec3::Y).normalize();
        let up = right.cross(way);
        for j in 0..around {
            let (sin, cos) = (TAU * f64::from(j) / f64::from(around)).sin_cos();
            points.push(middle(u) + 0.16 * (cos * right + sin * up));
        }
    }
    let at = |k: u32, j: u32| (k % along) * around + j % around;
    let quads = (0..along).flat_map(|k| (0..around).map(move |j| (k, j)));
    let triangles = quads.flat_map(|(k, j)| {
        let [a, b, c, d] = [at(k, j), at(k + 1, j), at(k + 1, j + 1), at(k, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (points, triangles.collect())
}

pub fn nested_boxes(count: u32) -> Shape {
    joined((1..=count).map(|k| cuboid(DVec3::splat(-f64::from(k) / 200.0), DVec3::splat(f64::from(k) / 200.0))))
}

fn joined(shapes: impl Iterator<Item = Shape>) -> Shape {
    shapes.fold((Vec::new(), Vec::new()), |(mut points, mut triangles), (more, indices)| {
        let first = points.len() as u32;
        points.extend(more);
        triangles.extend(indices.into_iter().map(|triangle| triangle.map(|k| first + k)));
        (points, triangles)
    })
}

/// Body, head, arms and legs of a game's figure: boxes that stand in one another.
fn figure() -> Shape {
    let parts = [
        ([-0.3, -0.3, -0.15], [0.3, 0.5, 0.15]),
        ([-0.15, 0.45, -0.15], [0.15, 0.8, 0.15]),
        ([-0.8, 0.25, -0.1], [-0.25, 0.45, 0.1]),
        ([0.25, 0.2, -0.1], [0.45, 0.45, 0.7]),
        ([-0.28, -1.0, -0.12], [-0.04, -0.25, 0.12]),
        ([0.04, -1.0, -0.3], [0.28, -0.2, 0.0]),
    ];
    joined(parts.into_iter().map(|(min, max)| cuboid(DVec3::from_array(min), DVec3::from_array(max))))
}

pub fn turned((points, triangles): Shape) -> Shape {
    (points, triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

fn one_turned((points, mut triangles): Shape) -> Shape {
    triangles[0].swap(1, 2);
    (points, triangles)
}

fn doubled(opposite: bool) -> Shape {
    let points = vec![DVec3::new(-1.0, 0.1, 0.3), DVec3::new(1.0, 0.0, 0.2), DVec3::new(0.0, 0.3, -1.0)];
    (points, vec![[0, 1, 2], if opposite { [0, 2, 1] } else { [1, 2, 0] }])
}

/// Triangles that share one edge, every other turned.
fn pages(count: u32) -> Shape {
    let mut points = vec![DVec3::new(0.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let mut triangles = Vec::new();
    for k in 0..count {
        let (sin, cos) = (0.3 + TAU * f64::from(k) / f64::from(count)).sin_cos();
        points.push(DVec3::new(cos, 0.1, sin));
        triangles.push(if k % 2 == 0 { [0, 1, 2 + k] } else { [1, 0, 2 + k] });
    }
    (points, triangles)
}

/// Triangles with two equal corners, with three on a line, thin ones, and a sound one that shares their edges.
fn slivers() -> Shape {
    let points = [
        (0.0, 0.0, 0.0),
        (1.0, 0.0, 0.0),
        (0.5, 0.0, 0.0),
        (0.25, 1e-7, 0.0),
        (0.3, 0.8, 0.2),
        (0.0, 0.0, 0.0),
        (0.5, 0.0, -0.0),
    ];
    let points = points.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec();
    (points, vec![[0, 1, 2], [0, 2, 3], [0, 5, 1], [5, 6, 4], [2, 1, 4], [0, 1, 4], [2, 6, 2]])
}

/// A box one of whose corners is split into a triangle of three places on a line, still closed.
fn needle() -> Shape {
    let (mut points, mut triangles) = cuboid(-DVec3::ONE, DVec3::ONE);
    let [a, b, c] = triangles[0];
    // The middle of edge a-b in place of the edge: a triangle without area fills the gap.
    let middle = points.len() as u32;
    points.push(0.5 * (points[a as usize] + points[b as usize]));
    triangles[0] = [a, middle, c];
    triangles.push([middle, b, c]);
    triangles.push([a, b, middle]);
    (points, triangles)
}

pub fn ball() -> Mesh {
    mesh(&sphere(DVec3::ZERO, 1.0, 12))
}

/// Lights outside of anything within a radius of 2 of the origin.
pub fn lights_outside() -> Vec<LightSource> {
    vec![
        LightSource::Point(DVec3::new(2.1, 4.3, 3.2)),
        LightSource::Point(DVec3::new(-0.3, 2.6, 0.2)),
        LightSource::Direction(DVec3::new(0.3, 1.0, -0.2)),
    ]
}

pub fn placements() -> [(&'static str, DMat4); 3] {
    let turn = DMat4::from_rotation_y(0.7) * DMat4::from_rotation_x(-0.4);
    [
        ("as it is", DMat4::IDENTITY),
        ("turned and moved", DMat4::from_translation(DVec3::new(0.3, -0.2, 0.4)) * turn),
        ("mirrored", turn * DMat4::from_scale(DVec3::new(-1.1, 0.8, 0.9))),
    ]
}

/// Triangles over few places, so that edges are shared by any number of them, in any direction.
pub fn soup() -> impl Strategy<Value = Mesh> {
    let place = prop::array::uniform3(-8i32..=8).prop_map(|p| DVec3::from_array(p.map(|x| f64::from(x) / 6.0)));
    let shape = prop::collection::vec(place, 4..12).prop_flat_map(|points| {
        let count = points.len() as u32;
        let triangle = prop::array::uniform3(0..count);
        (Just(points), prop::collection::vec(triangle, 1..30))
    });
    shape.prop_map(|shape| mesh(&shape))
}

pub fn source() -> impl Strategy<Value = LightSource> {
    let vector = || prop::array::uniform3(-4.0f64..4.0).prop_map(DVec3::from_array);
    // On the lattice of the soups' corners too: in planes, on lines, at corners.
    let lattice = prop::array::uniform3(-12i32..=12).prop_map(|p| DVec3::from_array(p.map(|x| f64::from(x) / 6.0)));
    prop_oneof![
        vector().prop_map(LightSource::Point),
        lattice.clone().prop_map(LightSource::Point),
        vector().prop_map(LightSource::Direction),
        lattice.prop_filter("no direction", |way| *way != DVec3::ZERO).prop_map(LightSource::Direction),
    ]
}
