//! Bumps against a surface that is really displaced: fine meshes whose vertices are moved along their normals by a height in
//! closed form, drawn without a bump map, and the flat mesh with the map of the same heights. To first order in the height
//! they are one picture. Shares nothing with tangents, normal maps or colours in f64.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use glam::{DVec2, DVec3};
use glumbra::frame::Renderer;
use glumbra::judge::colors::draw_colors;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};

use super::{load_text, renderer};

/// Cells of a mesh each way.
const CELLS: usize = 200;

/// Height over a skin, in [0, 1]; it repeats.
fn height(st: DVec2) -> f64 {
    0.5 + 0.22 * (TAU * (2.0 * st.x + 0.1)).sin() + 0.2 * (TAU * (st.x + 2.0 * st.y)).sin()
}

/// A surface over (u, v) in [0, 1]², and its skin.
struct Sheet {
    name: &'static str,
    place: fn(f64, f64) -> DVec3,
    normal: fn(f64, f64) -> DVec3,
    skin: fn(f64, f64) -> DVec2,
    /// Lengths of the derivatives by s and t.
    lengths: DVec2,
    /// Texels of the height map: as many for each length.
    texels: [u32; 2],
    camera: &'static str,
}

const DOWN: &str =
    "eye = [0.1, 1.3, 0.3]\ntarget = [0.05, 0.0, 0.0]\nup = [0.0, 0.0, -1.0]\nfov_y = 50.0\nnear = 0.1\n";

const SHEETS: [Sheet; 3] = [
    Sheet {
        name: "plane",
        place: |u, v| DVec3::new(2.0 * u - 1.0, 0.0, 1.0 - 2.0 * v),
        normal: |_, _| DVec3::Y,
        skin: DVec2::new,
        lengths: DVec2::splat(2.0),
        texels: [256, 256],
        camera: DOWN,
    },
    Sheet {
        name: "cylinder",
        place: |u, v| {
            let (sine, cosine) = (PI * (u - 0.5)).sin_cos();
            DVec3::new(sine, PI * (v - 0.5), cosine)
        },
        normal: |u, _| {
            let (sine, cosine) = (PI * (u - 0.5)).sin_cos();
            DVec3::new(sine, 0.0, cosine)
        },
        skin: DVec2::new,
        lengths: DVec2::splat(PI),
        texels: [256, 256],
        camera: "eye = [0.2, 0.3, 2.6]\ntarget = [0.1, 0.1, 1.0]\nfov_y = 36.0\nnear = 0.1\n",
    },
    // The left half's skin is mirrored.
    Sheet {
        name: "mirrored",
        place: |u, v| DVec3::new(2.0 * u - 1.0, 0.0, 1.0 - 2.0 * v),
        normal: |_, _| DVec3::Y,
        skin: |u, v| DVec2::new((2.0 * u - 1.0).abs(), v),
        lengths: DVec2::new(1.0, 2.0),
        texels: [128, 256],
        camera: DOWN,
    },
];

impl Sheet {
    fn moved(&self, u: f64, v: f64, by: f64) -> DVec3 {
        (self.place)(u, v) + by * (height((self.skin)(u, v)) - 0.5) * (self.normal)(u, v)
    }

    /// The mesh, displaced by `by` times its height, with the normals of that.
    fn obj(&self, by: f64) -> Vec<u8> {
        let mut text = String::new();
        let step = 1e-6;
        for (row, column) in (0..=CELLS).flat_map(|row| (0..=CELLS).map(move |column| (row, column))) {
            let [u, v] = [column, row].map(|at| at as f64 / CELLS as f64);
            let at = self.moved(u, v, by);
            let along = |du: f64, dv: f64| self.moved(u + du, v + dv, by) - self.moved(u - du, v - dv, by);
            let normal = along(step, 0.0).cross(along(0.0, step)).normalize();
            let normal = if by == 0.0 { (self.normal)(u, v) } else { normal };
            let st = (self.skin)(u, v);
            let _ = writeln!(
                text,
                "v {} {} {}\nvt {} {}\nvn {} {} {}",
                at.x, at.y, at.z, st.x, st.y, normal.x, normal.y, normal.z
            );
        }
        for (row, column) in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column))) {
            let a = row * (CELLS + 1) + column + 1;
            let [b, c, d] = [a + 1, a + CELLS + 2, a + CELLS + 1];
            let _ = writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\nf {a}/{a}/{a} {c}/{c}/{c} {d}/{d}/{d}");
        }
        text.into_bytes()
    }

    fn heights(&self) -> Vec<u8> {
        let [width, rows] = self.texels;
        // The file's first row is the highest t.
        let picture = ImageBuffer::from_fn(width, rows, |x, y| {
            let st = DVec2::new((f64::from(x) + 0.5) / f64::from(width), 1.0 - (f64::from(y) + 0.5) / f64::from(rows));
            Luma([(65535.0 * height(st)).round() as u16])
        });
        let mut bytes = std::io::Cursor::new(Vec::new());
        DynamicImage::from(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    /// The picture of a mesh; `bump`: the end of its material.
    fn picture(&self, mesh: Vec<u8>, shading: &str, bump: &str, renderer: &mut Renderer) -> Vec<[f64; 3]> {
        let text = format!(
            "[image]\nsize = [160, 120]\n[camera]\n{}[shading]\nambient = [0.1, 0.1, 0.1]\n{shading}\n\
             [[light]]\nkind = \"point\"\nposition = [0.9, 1.1, 2.0]\nnear = 0.1\nfar = 9.0\ndiffuse = [0.7, 0.6, 0.5]\n\
             specular = [0.4, 0.4, 0.4]\n[light.shadow]\ntechnique = \"none\"\n[[object]]\nmesh = \"sheet.obj\"\n\
             material = {{ diffuse = [0.9, 0.9, 0.9], specular = [0.5, 0.5, 0.5], shininess = 8{bump} }}\n",
            self.camera
        );
        let scene = load_text(&text, &[("sheet.obj", mesh), ("heights.png", self.heights())]).unwrap();
        draw_colors(&scene, shading.contains("reference"), renderer).unwrap().codes
    }
}

fn mean_difference(one: &[[f64; 3]], other: &[[f64; 3]]) -> f64 {
    let apart = one.iter().zip(other).map(|(one, other)| (0..3).map(|k| (one[k] - other[k]).abs()).sum::<f64>() / 3.0);
    apart.sum::<f64>() / one.len() as f64
}

#[test]
fn bumps_are_a_displaced_surface_to_first_order() {
    let (_context, mut renderer) = renderer();
    let reference = "bump = \"reference\"\nself_shadow = false";
    let heights = [0.16, 0.08, 0.04, 0.02];
    for sheet in &SHEETS {
        let plain = sheet.picture(sheet.obj(0.0), reference, "", &mut renderer);
        let mut errors = Vec::new();
        for by in heights {
            let moved = sheet.picture(sheet.obj(by), reference, "", &mut renderer);
            let scale = by * f64::from(sheet.texels[0]) / sheet.lengths.x;
            let bump = format!(", bump = {{ height = \"heights.png\", scale = {scale:?} }}");
            let bumped = sheet.picture(sheet.obj(0.0), reference, &bump, &mut renderer);
            let combined = sheet.picture(sheet.obj(0.0), "bump = \"one-pass\"", &bump, &mut renderer);
            let [own, none, combined] = [&bumped, &plain, &combined].map(|picture| mean_difference(picture, &moved));
            println!(
                "{}, height {by}: {own:.3} codes off the displaced surface, {combined:.3} in one pass; {none:.3} without bumps",
                sheet.name
            );
            errors.push((own, none));
        }
        let exponent = (errors[0].0 / errors[2].0).log2() / 2.0;
        println!("{}: the difference falls with the height to the power {exponent:.2}", sheet.name);
        // Proportional to the height, beside what eight bits of a normal leave: a quarter of a code at any height.
        assert!(exponent > 0.5 && errors.windows(2).all(|pair| pair[1].0 < pair[0].0), "{}: {errors:?}", sheet.name);
        // Turned inside out, or along the wrong axis, bumps would be as far off as none, or twice as far. On the cylinder a
        // displaced point is seen beside its own, in other light: a fifth of what its bumps do.
        let shares: Vec<f64> = errors.iter().map(|(own, none)| own / none).collect();
        assert!(shares[..3].iter().all(|share| *share < 0.4), "{}: {shares:.3?}", sheet.name);
    }
}
