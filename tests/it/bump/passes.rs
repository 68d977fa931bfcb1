//! One pass against three: the same picture where ambient and diffuse light is at most 1, and where it is more, the difference
//! that clamping before the decal makes.

use glumbra::scene::Scene;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};

use super::{colors, data, is_strict, load_text, picture, renderer};

fn decal() -> Vec<u8> {
    let picture = RgbImage::from_fn(64, 64, |x, y| Rgb([(90 + 2 * x) as u8, (200 - y) as u8, 160]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    DynamicImage::from(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn scene(method: &str, ambient: f64) -> Scene {
    let heights = data("textures/studs.png");
    let text = format!(
        "[image]\nsize = [240, 180]\n[camera]\neye = [0.6, 2.6, 2.2]\ntarget = [0.0, 0.05, 0.0]\n[shading]\nambient = [{ambient:?}, {ambient:?}, {ambient:?}]\n\
         bump = \"{method}\"\n[[light]]\nkind = \"point\"\nposition = [1.5, 2.5, 1.0]\nnear = 0.1\nfar = 9.0\n\
         diffuse = [0.8, 0.7, 0.6]\nspecular = [0.4, 0.4, 0.4]\n[light.shadow]\ntechnique = \"none\"\n[[object]]\nmesh = \"torus\"\n\
         material = {{ diffuse = [1.0, 1.0, 1.0], ambient = [1.0, 1.0, 1.0], specular = [0.5, 0.5, 0.5], shininess = 8, decal = \"decal.png\", \
         bump = {{ height = {heights:?}, scale = 4.0 }} }}\n"
    );
    load_text(&text, &[("decal.png", decal())]).unwrap()
}

#[test]
fn three_passes_are_one_pass_but_for_the_clamp_before_the_decal() {
    let (_context, mut renderer) = renderer();
    for (ambient, is_bright) in [(0.1, false), (0.7, true)] {
        let [one, three] = ["one-pass", "three-pass"].map(|method| {
            let scene = scene(method, ambient);
            (picture(&scene, &mut renderer), colors(&scene, &[None]))
        });
        let (mut compared, mut clamped, mut worst, mut most) = (0, 0, 0.0_f64, 0.0_f64);
        for index in 0..one.0.len() {
            let [due_one, due_three] = [&one.1.pixels[index], &three.1.pixels[index]];
            if !(is_strict(due_one, 8.0) && is_strict(due_three, 8.0)) {
                continue;
            }
            compared += 1;
            for k in 0..3 {
                // min(1, (a + d) c + s) - min(1, min(1, a + d) c + s).
                let due = 255.0 * (due_one.rgb[k].value - due_three.rgb[k].value);
                clamped += usize::from(due > 4.0);
                most = most.max(due);
                worst = worst.max((one.0[index][k] - three.0[index][k] - due).abs());
            }
        }
        println!(
            "ambient {ambient}: {compared} pixels, worst {worst:.2} codes; {clamped} channels clamped, by at most {most:.0}"
        );
        assert!(compared > 3000 && worst <= 2.0, "{compared} pixels, {worst} codes");
        assert_eq!(clamped > 500, is_bright, "{clamped} channels");
    }
}
