//! A flat bump map is no bump map: the picture of the surface without it, to the bit, and no seam on a mirrored skin.

use glumbra::scene::Scene;
use image::{DynamicImage, GrayImage, ImageFormat, Luma};

use super::{load_text, picture, renderer};

fn flat() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let flat = DynamicImage::from(GrayImage::from_pixel(5, 4, Luma([77])));
    flat.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const LIGHTS: [&str; 3] = [
    "kind = \"spot\"\nposition = [2.0, 3.0, 2.0]\ntarget = [0.0, 0.3, 0.0]\ncone = 70.0\nnear = 0.5\nfar = 12.0\n",
    "kind = \"point\"\nposition = [-1.5, 2.0, 1.5]\nnear = 0.1\nfar = 12.0\n",
    "kind = \"directional\"\ndirection = [0.4, -1.0, -0.3]\n",
];

/// A torus, a mirrored ball, and a sheet that is seen from behind. `bump`: keys of the material.
fn scene(light: &str, technique: &str, bump: &str) -> Scene {
    let object = |mesh: &str, pose: &str| {
        format!(
            "[[object]]\nmesh = \"{mesh}\"\n{pose}\nmaterial = {{ diffuse = [0.6, 0.5, 0.4], specular = [0.3, 0.3, 0.3], \
             shininess = 10{bump} }}\n"
        )
    };
    let text = format!(
        "[image]\nsize = [160, 120]\n[camera]\neye = [1.8, 2.2, 3.0]\ntarget = [0.0, 0.3, 0.0]\n[shading]\nself_shadow = false\n\
         [[light]]\n{light}diffuse = [0.7, 0.6, 0.5]\nspecular = [0.5, 0.5, 0.5]\n[light.shadow]\ntechnique = \"{technique}\"\n{}{}{}{}",
        object("torus", "scale = [0.8, 0.6, 0.8]\ntranslate = [0.0, 0.5, 0.0]"),
        object("sphere", "scale = [-0.4, 0.4, 0.4]\ntranslate = [0.2, 0.8, 0.1]"),
        object("quad", "rotate = { axis = [0.0, 0.0, 1.0], angle = 120.0 }\ntranslate = [-1.3, 1.0, 0.0]"),
        object("quad", "scale = 3.0")
    );
    load_text(&text, &[("flat.png", flat())]).unwrap()
}

#[test]
fn a_flat_map_is_the_picture_without_it() {
    let (_context, mut renderer) = renderer();
    for light in LIGHTS {
        for technique in ["none", "shadow-map", "shadow-volume"] {
            let plain = picture(&scene(light, technique, ""), &mut renderer);
            for format in ["snorm8", "unorm8"] {
                for basis in ["orthogonal", "skewed"] {
                    let keys =
                        format!(", bump = {{ height = \"flat.png\", format = \"{format}\", basis = \"{basis}\" }}");
                    let bumped = picture(&scene(light, technique, &keys), &mut renderer);
                    let apart = |(one, other): (&[f64; 3], &[f64; 3])| {
                        (0..3).map(|k| (one[k] - other[k]).abs()).fold(0.0, f64::max)
                    };
                    let worst = plain.iter().zip(&bumped).map(apart).fold(0.0, f64::max);
                    // No code of unsigned bytes is straight up: both ways lean by a third of a degree.
                    let most = if format == "snorm8" { 0.0 } else { 2.0 };
                    assert!(worst <= most, "{light}{technique}, {format}, {basis}: {worst} codes");
                }
            }
        }
    }
}

/// A square whose left half has its skin mirrored. The flat map shows no seam; the picture is that without it.
#[test]
fn a_mirrored_skin_has_no_seam() {
    let (_context, mut renderer) = renderer();
    let mesh = "v -1 0 -1\nv 0 0 -1\nv 1 0 -1\nv -1 0 1\nv 0 0 1\nv 1 0 1\nvt 1 1\nvt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\nvt 1 0\n\
                vn 0 1 0\nf 4/4/1 5/5/1 2/2/1 1/1/1\nf 5/5/1 6/6/1 3/3/1 2/2/1\n";
    let scene = |method: &str, bump: &str| {
        let text = format!(
            "[image]\nsize = [120, 90]\n[camera]\neye = [0.2, 2.0, 1.4]\ntarget = [0.0, 0.0, 0.0]\n[shading]\nbump = \"{method}\"\n\
             [[light]]\nkind = \"point\"\nposition = [0.4, 1.0, 0.3]\nnear = 0.1\nfar = 9.0\ndiffuse = [0.7, 0.7, 0.7]\nspecular = [0.3, 0.3, 0.3]\n\
             [light.shadow]\ntechnique = \"none\"\n[[object]]\nmesh = \"mirrored.obj\"\n\
             material = {{ diffuse = [0.8, 0.8, 0.8], specular = [0.5, 0.5, 0.5], shininess = 8{bump} }}\n"
        );
        load_text(&text, &[("flat.png", flat()), ("mirrored.obj", mesh.as_bytes().to_vec())]).unwrap()
    };
    let bump = ", bump = { height = \"flat.png\" }";
    let plain = picture(&scene("reference", ""), &mut renderer);
    for (method, most) in [("reference", 1.0), ("one-pass", 8.0), ("three-pass", 8.0)] {
        let bumped_scene = scene(method, bump);
        assert_eq!(bumped_scene.objects[0].bases.unwrap().mirrored, 2);
        let bumped = picture(&bumped_scene, &mut renderer);
        // Around the seam, which runs through the middle.
        let jump = |pixels: &[[f64; 3]]| {
            let rows = pixels.chunks_exact(120).skip(30).take(30).flat_map(|row| row[30..90].windows(2));
            rows.map(|pair| (pair[0][0] - pair[1][0]).abs()).fold(0.0, f64::max)
        };
        let worst = plain.iter().zip(&bumped).map(|(one, other)| (one[0] - other[0]).abs()).fold(0.0, f64::max);
        println!("{method}: {worst} codes off plain light, steps of at most {} and {}", jump(&plain), jump(&bumped));
        // Combiners interpolate vectors over the square's halves, and look them up in a cube of 64 texels.
        assert!(worst <= most, "{method}: {worst} codes");
        assert!(jump(&bumped) <= jump(&plain) + 1.0, "{method}: a step of {} codes", jump(&bumped));
    }
}
