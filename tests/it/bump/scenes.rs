//! The doughnut and the knight by every method against colours in f64.

use super::{Tally, colors, data, load, picture, renderer, tally};

/// The knight near by and without its decal, whose mipmaps are any driver's own.
const NEAR: [&str; 3] = [
    "object.0.material={ gloss = \"../textures/knight-gloss.png\", specular = [0.6, 0.6, 0.6], shininess = 8, bump = { height = \"../textures/knight-height.png\", scale = 3.0, border = \"clamp\" } }",
    "camera.fov_y=20.0",
    "camera.target=[0.0, 10.0, 0.0]",
];

const METHODS: [&str; 3] = ["reference", "one-pass", "three-pass"];

fn scenes() -> [(&'static str, &'static str, &'static [&'static str]); 3] {
    [
        ("the doughnut", "scenes/doughnut.toml", &[]),
        ("the knight", "scenes/knight.toml", &[]),
        ("the knight near by", "scenes/knight.toml", &NEAR),
    ]
}

fn print(what: &str, found: &Tally) {
    println!(
        "{what}: {} pixels, {:.1} % known, {:.1} % strictly; {} wrong, worst {:.2} beyond bounds, {:.2} off the value",
        found.bumped,
        found.share(found.known),
        found.share(found.strict),
        found.wrong,
        found.worst,
        found.worst_strict
    );
}

#[test]
fn pictures_without_shadows_are_those_of_f64() {
    let (_context, mut renderer) = renderer();
    for (what, name, changes) in scenes() {
        for method in METHODS {
            let method_key = format!("shading.bump=\"{method}\"");
            let changes = [changes, &[&method_key, "light.shadow.technique=\"none\""]].concat();
            let scene = load(&data(name), &changes);
            let truth = colors(&scene, &vec![None; scene.lights.len()]);
            let found = tally(&scene, &[&truth], &picture(&scene, &mut renderer));
            print(&format!("{what}, {method}"), &found);
            println!("{:?}", found.first);
        }
    }
}
