//! GL-E4: lighting of vertices by glLight and glMaterial [GL 4.6 compatibility, 12.2.1].

use glam::{DMat4, DVec2, DVec3};

use super::fixed;
use crate::conformance::bench::fixed_function::FixedDraw;
use crate::conformance::bench::lit::{GlLight, GlLighting, LitDraw};
use crate::conformance::bench::{Error, GlFormat, GlState, full};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 64;

/// Pixels along a side of a cell of two triangles.
const CELL: u32 = 16;

/// Clip space from eye space: a scale, a shift, and a shear of x and y along z. z within 10.
const SCALE: DVec3 = DVec3::new(0.25, 0.25, -0.1);
const SHIFT: DVec2 = DVec2::new(0.125, -0.25);
const SHEAR: DVec2 = DVec2::new(0.03125, -0.0625);
const PROJECTION: DMat4 = DMat4::from_cols_array_2d(&[
    [SCALE.x, 0.0, 0.0, 0.0],
    [0.0, SCALE.y, 0.0, 0.0],
    [SHEAR.x, SHEAR.y, SCALE.z, 0.0],
    [SHIFT.x, SHIFT.y, 0.0, 1.0],
]);

const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };

/// A vertex's colour: f64, in the order of the specification's sum, clamped.
fn color(lighting: &GlLighting, position: DVec3, normal: DVec3) -> DVec3 {
    let rgb = |color: [f32; 3]| DVec3::from_array(color.map(f64::from));
    let mut sum = rgb(lighting.emission) + rgb(lighting.ambient) * rgb(lighting.scene_ambient);
    for light in &lighting.lights {
        let [x, y, z, w] = light.position.map(f64::from);
        let to_light = if w == 0.0 { DVec3::new(x, y, z) } else { DVec3::new(x, y, z) / w - position };
        let [constant, linear, quadratic] = light.attenuation.map(f64::from);
        let distance = to_light.length();
        let strength =
            if w == 0.0 { 1.0 } else { 1.0 / (constant + linear * distance + quadratic * distance * distance) };
        let l = to_light.normalize();
        let cosine = normal.dot(l).max(0.0);
        // The viewer is at infinity.
        let gleam = normal.dot((l + DVec3::Z).normalize()).max(0.0).powf(f64::from(lighting.shininess));
        let highlight = if cosine > 0.0 { gleam } else { 0.0 };
        sum += strength
            * (rgb(lighting.ambient) * rgb(light.ambient)
                + cosine * rgb(lighting.diffuse) * rgb(light.diffuse)
                + highlight * rgb(lighting.specular) * rgb(light.specular));
    }
    sum.clamp(DVec3::ZERO, DVec3::ONE)
}

/// Positions and attenuations of lights: at infinity, and such whose light fades.
const LIGHTS: [([f32; 4], [f32; 3]); 8] = [
    ([0.4, 0.7, 0.9, 0.0], [1.0, 0.0, 0.0]),
    ([-2.0, 3.0, 1.0, 1.0], [0.5, 0.2, 0.03]),
    ([6.0, -2.0, -2.0, 2.0], [0.8, 0.0, 0.1]),
    ([-0.5, -0.2, 1.0, 0.0], [1.0, 0.0, 0.0]),
    ([1.0, 1.0, 2.0, 1.0], [1.0, 0.05, 0.0]),
    ([0.1, -0.8, 0.7, 0.0], [1.0, 0.0, 0.0]),
    ([-3.0, -3.0, 3.0, 1.0], [0.7, 0.0, 0.01]),
    ([0.3, 0.1, 1.5, 0.0], [1.0, 0.0, 0.0]),
];

/// A material in the light of the first of [`LIGHTS`], `share` of it each.
fn lighting(random: &mut Random, count: usize, share: f32) -> GlLighting {
    let mut rgb = |most: f32| [(); 3].map(|()| random.between(0.1 * most, most));
    let light = |(position, attenuation): ([f32; 4], [f32; 3])| GlLight {
        position,
        ambient: rgb(0.2 * share),
        diffuse: rgb(0.8 * share),
        specular: rgb(0.8 * share),
        attenuation,
    };
    let lights = LIGHTS.into_iter().take(count).map(light).collect();
    GlLighting {
        scene_ambient: rgb(0.4),
        emission: rgb(0.1),
        ambient: rgb(0.6),
        diffuse: rgb(0.8),
        specular: rgb(0.7),
        alpha: 0.6,
        shininess: 9.0,
        lights,
    }
}

/// GL-E4: the colour of each pixel, from its triangle's three vertices; then a draw without lighting.
pub fn lighting_of_vertices(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = fixed::pipeline(subject, findings, "glLight") else { return Ok(()) };
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let mut random = Random::new(91);
    let (scale, offset) = (DVec3::new(0.5, 2.0, 1.25), DVec3::new(0.5, -0.25, -4.0));
    for (name, turned, count, share) in [
        ("counter-clockwise triangles", false, 3, 1.0),
        ("clockwise triangles", true, 3, 1.0),
        ("eight lights", false, 8, 0.375),
    ] {
        let lighting = lighting(&mut random, count, share);
        let cells = SIDE / CELL;
        // Corners in the window, eye-space positions and model-space normals of each triangle.
        let mut triangles: Vec<[(DVec2, DVec3, DVec3); 3]> = Vec::new();
        for index in 0..cells * cells {
            let corner = DVec2::new(f64::from(index % cells), f64::from(index / cells)) * f64::from(CELL);
            let order = if turned { [0, 2, 1, 0, 3, 2] } else { [0, 1, 2, 0, 2, 3] };
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|at| {
                let window = corner + DVec2::from_array(at) * f64::from(CELL);
                let clip = window / f64::from(SIDE) * 2.0 - 1.0;
                let z = f64::from(random.between(-6.0, -2.0));
                let place = ((clip - SHIFT - SHEAR * z) / SCALE.truncate()).extend(z);
                let normal = [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.1, 1.0)];
                (window, place, DVec3::from_array(normal.map(f64::from)))
            });
            triangles.extend(order.map(|index| corners[index]).as_chunks::<3>().0);
        }
        let model = |place: DVec3| ((place - offset) / scale).as_vec3().to_array();
        let vertices = triangles.iter().flatten();
        let positions: Vec<[f32; 3]> = vertices.clone().map(|(_, place, _)| model(*place)).collect();
        let normals: Vec<[f32; 3]> = vertices.map(|(.., normal)| normal.as_vec3().to_array()).collect();
        let (state, projection) = (FLAT, PROJECTION);
        let (positions, normals, lighting) = (&positions[..], &normals[..], &lighting);
        fixed.draw_lit(
            &subject.bench,
            &LitDraw { surface: &surface, state, lighting, scale, offset, projection, positions, normals },
        )?;
        let seen = surface.colors();
        let mut tally = GradeTally::default();
        for corners in &triangles {
            // By the inverse transpose of the modelview, then of unit length.
            let colors = corners.map(|(_, place, normal)| color(lighting, place, (normal / scale).normalize()));
            for (pixel, seen) in seen.iter().enumerate() {
                let at = DVec2::new(f64::from(pixel as u32 % SIDE), f64::from(pixel as u32 / SIDE)) + 0.5;
                let Some(weights) = weights(corners.map(|(window, ..)| window), at) else { continue };
                let due = (0..3).map(|index| weights[index] * colors[index]).sum::<DVec3>();
                let alpha = f64::from(lighting.alpha);
                for (code, due) in seen.iter().zip([due.x, due.y, due.z, alpha]) {
                    // A code, as the vertex is snapped and the power is of f32; two where interpolation has few bits.
                    let off = f64::from(*code) - 255.0 * due;
                    tally.add(verify::within(off, 1.0, 2.0), off);
                }
            }
        }
        findings.tally(name, tally, "codes");
    }
    let (vertices, color) = (full(0.0), [0.25, 0.5, 0.75, 1.0]);
    fixed.draw(&subject.bench, &FixedDraw { color, ..FixedDraw::plain(&surface, FLAT, &vertices) })?;
    let mut tally = GradeTally::default();
    for code in surface.colors().iter().flat_map(|seen| seen.iter().zip(color)) {
        tally.add(verify::unorm8(*code.0, f64::from(code.1)), f64::from(*code.0) - 255.0 * f64::from(code.1));
    }
    findings.tally("a draw without lighting, after it", tally, "codes");
    Ok(())
}

/// Weights of a triangle's corners at a pixel's centre; `None` outside, and within a quarter pixel of an edge.
fn weights(corners: [DVec2; 3], at: DVec2) -> Option<[f64; 3]> {
    let [a, b, c] = corners;
    let area = (b - a).perp_dot(c - a);
    let weights = [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)].map(|x| x / area);
    let least = 0.25 / f64::from(CELL);
    weights.iter().all(|weight| *weight > least).then_some(weights)
}
