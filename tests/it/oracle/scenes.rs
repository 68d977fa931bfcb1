//! Small scenes and meshes, made in code.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DMat4, DVec3};
use glumbra::geometry::{Material, Mesh, Part};
use glumbra::math::Aabb;
use glumbra::scene::{
    Background, Camera, Frustum, Image, Law, Light, LightKind, LightShape, Object, PicturePasses, Point, Scene,
    Shading, Spot,
};
use glumbra::truth::{Answer, Options, Pixel, Truth, trace};

pub const SIZE: u32 = 192;

/// Vertices and triangles.
pub type Shape = (Vec<DVec3>, Vec<[u32; 3]>);

pub fn mesh((points, triangles): &Shape) -> Mesh {
    let indices: Vec<u32> = triangles.iter().flatten().copied().collect();
    // Of what is drawn: an f32's own place may lie on the other side of a light.
    let bounds = Aabb::from_points(points.iter().map(|point| point.as_vec3().as_dvec3()));
    Mesh {
        name: String::from("test"),
        positions: points.iter().map(|p| p.as_vec3().to_array()).collect(),
        normals: vec![[0.0, 0.0, 1.0]; points.len()],
        texcoords: None,
        parts: vec![Part {
            name: String::from("test"),
            indices: 0..u32::try_from(indices.len()).unwrap(),
            material: None,
            bounds,
        }],
        indices,
        bounds,
        ..Mesh::default()
    }
}

pub fn object(name: &str, mesh: Mesh) -> Object {
    Object {
        name: name.to_owned(),
        mesh: Arc::new(mesh),
        world_from_model: DMat4::IDENTITY,
        wave: None,
        material: None,
        skin: None,
        photo: None,
        pose: None,
        bases: None,
        lit: true,
        casts_shadow: true,
        closed: false,
    }
}

pub fn with_material(mut object: Object, material: Material) -> Object {
    object.material = Some(Arc::new(material));
    object
}

/// A square in the plane y = `height`, facing up.
pub fn square(half: f64, height: f64) -> Shape {
    let points = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    (points.map(|(x, z)| DVec3::new(x * half, height, z * half)).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
    let points = Aabb { min, max }.corners().to_vec();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (points, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A closed sphere of `2 * rings * rings` quads' grid, poles as single points.
pub fn sphere(center: DVec3, radius: f64, rings: u32) -> Shape {
    grid(2 * rings, rings, |u, v| {
        let ((sin, cos), (sin_v, cos_v)) = ((TAU * u).sin_cos(), (PI * v).sin_cos());
        let sin_v = if v == 0.0 || v == 1.0 { 0.0 } else { sin_v };
        center + radius * DVec3::new(cos * sin_v, cos_v, sin * sin_v)
    })
}

/// A closed torus around the y axis.
pub fn torus(center: DVec3, radius: f64, tube: f64, around: u32, across: u32) -> Shape {
    grid(around, across, |u, v| {
        let ((sin, cos), (sin_v, cos_v)) = ((TAU * (u % 1.0)).sin_cos(), (TAU * (v % 1.0)).sin_cos());
        let out = radius + tube * cos_v;
        center + DVec3::new(cos * out, tube * sin_v, sin * out)
    })
}

/// Seams repeat their vertices, as in files with texture coordinates.
fn grid(columns: u32, rows: u32, point: impl Fn(f64, f64) -> DVec3) -> Shape {
    let mut points = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let u = f64::from(column % columns) / f64::from(columns);
            points.push(point(u, f64::from(row) / f64::from(rows)));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (points, triangles)
}

/// A light that stands at `position` and looks at the origin's neighbourhood with 100 degrees.
pub fn light(position: DVec3, target: DVec3) -> Light {
    Light {
        kind: LightKind::Spot(Spot {
            frustum: Frustum {
                position,
                target,
                up: if (target - position).normalize().y.abs() > 0.9 { DVec3::Z } else { DVec3::Y },
                cone_radians: 100f64.to_radians(),
                aspect: 1.0,
                near: 0.01,
                far: 100.0,
                lean: glam::DVec2::ZERO,
            },
            shape: LightShape::Frustum,
            attenuation: [1.0, 0.0, 0.0],
            image: None,
            image_filter: glumbra::scene::ImageFilter::Linear,
            beam: None,
            falloff: None,
            interpolation: glumbra::scene::Interpolation::Perspective,
            frustum_shown: false,
            focus: None,
        }),
        ambient: [0.0; 3],
        diffuse: [1.0; 3],
        specular: [1.0; 3],
        name: String::from("light"),
        dust: None,
        law: Law::Lit,
        shadow: glumbra::techniques::unshadowed(),
    }
}

/// A light that shines every way from `position`.
pub fn point_light(position: DVec3) -> Light {
    let kind = LightKind::Point(Point { position, near: 0.01, far: 100.0, attenuation: [1.0, 0.0, 0.0] });
    Light { kind, ..light(position, position + DVec3::X) }
}

/// Parallel light that travels from `from` to the origin.
pub fn sun(from: DVec3) -> Light {
    Light { kind: LightKind::Directional { direction: -from.normalize() }, ..light(from, DVec3::ZERO) }
}

/// One light of each kind at `position`, or from there.
pub fn kinds(position: DVec3) -> [Light; 3] {
    [light(position, DVec3::ZERO), point_light(position), sun(position)]
}

/// From the light to a point, or any piece of that way.
pub fn way_of_light(light: &Light, to: DVec3) -> DVec3 {
    match &light.kind {
        LightKind::Spot(spot) => to - spot.frustum.position,
        LightKind::Point(point) => to - point.position,
        LightKind::Directional { direction } => *direction,
    }
}

/// The frustum of what [`light`] made.
pub fn frustum_of(light: &mut Light) -> &mut Frustum {
    match &mut light.kind {
        LightKind::Spot(spot) => &mut spot.frustum,
        other => panic!("{other:?} has no frustum"),
    }
}

pub fn scene(objects: Vec<Object>, light: Light) -> Scene {
    Scene {
        image: Image { size: [SIZE + 37, SIZE], background: [0.0; 3] },
        camera: Camera {
            eye: DVec3::new(1.7, 4.3, 6.1),
            target: DVec3::new(0.1, 0.4, 0.0),
            up: DVec3::Y,
            fov_y_radians: 50f64.to_radians(),
            near: 0.1,
            far: 60.0,
        },
        shading: Shading {
            ambient: [0.2; 3],
            per_vertex: false,
            passes: PicturePasses::One,
            bumps: Default::default(),
            background: Background::Scene,
        },
        lights: vec![light],
        objects,
    }
}

pub fn floor() -> Object {
    object("floor", mesh(&square(3.0, 0.0)))
}

pub fn trace_scene(scene: &Scene) -> Truth {
    trace(scene, 0, &Options::default()).unwrap()
}

/// Holds each floor pixel (object 0) against `is_lit`; `None` there: too near to tell. Prints what was compared.
pub fn check_floor(case: &str, truth: &Truth, is_lit: impl Fn(DVec3) -> Option<bool>) {
    let (mut lit, mut shadowed) = (0, 0);
    for (index, Pixel { answer, hit, .. }) in truth.pixels.iter().enumerate() {
        let Some(hit) = hit.filter(|hit| hit.object == 0) else { continue };
        match (answer, is_lit(hit.position)) {
            (Answer::Lit, Some(true)) => lit += 1,
            (Answer::Shadowed, Some(false)) => shadowed += 1,
            (Answer::Lit | Answer::Shadowed, Some(_)) => {
                panic!("{case}: pixel {index} at {}: {answer:?} is wrong", hit.position)
            }
            _ => {}
        }
    }
    println!(
        "{case}: {lit} lit, {shadowed} shadowed, {:.3} % of {} ambiguous {:?}",
        100.0 * truth.ambiguous_share(),
        truth.drawn(),
        truth.reasons()
    );
    assert!(lit > 100 && shadowed > 100, "{case}: too little to see");
    assert!(truth.ambiguous_share() < 0.03);
}
