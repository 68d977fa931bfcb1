//! The doughnut and the knight by every method against colours in f64.

use super::{Tally, colors, data, load, own_shadows, picture, renderer, tally};

const KNIGHT: &str = "object.0.material={ decal = \"../textures/knight.png\", gloss = \"../textures/knight-gloss.png\", \
                      specular = [0.6, 0.6, 0.6], shininess = 8, bump = { height = \"../textures/knight-height.png\", scale = 5.0 } }";

const METHODS: [&str; 3] = ["reference", "one-pass", "three-pass"];

fn scenes() -> Vec<(&'static str, Vec<&'static str>)> {
    let is_knight_bumped = std::fs::read_to_string(data("scenes/knight.toml")).unwrap().contains("bump = {");
    vec![("scenes/doughnut.toml", vec![]), ("scenes/knight.toml", if is_knight_bumped { vec![] } else { vec![KNIGHT] })]
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
    for (name, changes) in scenes() {
        for method in METHODS {
            let method_key = format!("shading.bump=\"{method}\"");
            let changes = [&changes[..], &[&method_key, "light.shadow.technique=\"none\""]].concat();
            let scene = load(&data(name), &changes);
            let truth = colors(&scene, &vec![None; scene.lights.len()]);
            let found = tally(&scene, &[&truth], &picture(&scene, &mut renderer));
            print(&format!("{name} {method}"), &found);
            println!("{:?}", found.first);
        }
    }
}
