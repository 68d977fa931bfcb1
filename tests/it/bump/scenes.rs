//! The doughnut and the knight by every method against colours in f64: without shadows, with shadow maps, with volumes.

use super::{Tally, colors, data, load, own_shadows, picture, renderer, tally};

/// The knight near by and without its decal, whose mipmaps are any driver's own.
fn near() -> Vec<String> {
    let [gloss, height] = ["knight-gloss.png", "knight-height.png"].map(|name| data("textures").join(name));
    let material = format!(
        "object.0.material={{ gloss = {gloss:?}, specular = [0.6, 0.6, 0.6], shininess = 8, bump = {{ height = {height:?}, scale = \
         3.0, border = \"clamp\" }} }}"
    );
    vec![material, String::from("camera.fov_y=20.0"), String::from("camera.target=[0.0, 10.0, 0.0]")]
}

const METHODS: [&str; 3] = ["reference", "one-pass", "three-pass"];

/// Name, file, changes, and the least share in percent of the bump-mapped pixels whose bounds are within two codes.
fn scenes() -> [(&'static str, &'static str, Vec<String>, f64); 3] {
    [
        ("the doughnut", "scenes/doughnut.toml", Vec::new(), 60.0),
        // Each pixel holds several of the decal's texels.
        ("the knight", "scenes/knight.toml", Vec::new(), 0.0),
        ("the knight near by", "scenes/knight.toml", near(), 50.0),
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
    for (what, name, changes, least) in scenes() {
        for method in METHODS {
            let mut changes: Vec<String> = changes.clone();
            changes.push(format!("shading.bump=\"{method}\""));
            let mut scene = load(&data(name), &changes);
            scene.lights.iter_mut().for_each(|light| light.shadow = glumbra::techniques::unshadowed());
            let truth = colors(&scene, &vec![None; scene.lights.len()]);
            let found = tally(&scene, &[&truth], &picture(&scene, &mut renderer));
            print(&format!("{what}, {method}"), &found);
            assert_eq!(found.wrong, 0, "{what}, {method}: {:?}", found.first);
            // Combiners look vectors up in eight bits, and the eighth power makes eight times their error.
            let least = if method == "reference" { least } else { 0.25 * least };
            assert!(found.share(found.known) > 95.0 && found.share(found.strict) >= least, "{what}, {method}");
        }
    }
}

/// One picture is the gloss of two objects, by two of its channels.
#[test]
fn a_picture_may_be_gloss_in_two_ways() {
    let (_context, mut renderer) = renderer();
    let floor = "object.1.material={ decal = \"../textures/knight-gloss.png\", gloss = \"decal-alpha\", \
                 specular = [0.6, 0.6, 0.6], shininess = 4 }";
    let file = data("scenes/knight.toml").display().to_string();
    let floor = floor.replace("..", &file.replace("/scenes/knight.toml", ""));
    let mut scene = load(&data("scenes/knight.toml"), std::slice::from_ref(&floor));
    scene.lights.iter_mut().for_each(|light| light.shadow = glumbra::techniques::unshadowed());
    for _ in 0..2 {
        let truth = colors(&scene, &[None]);
        let found = tally(&scene, &[&truth], &picture(&scene, &mut renderer));
        print("gloss in two ways", &found);
        assert_eq!(found.wrong, 0, "{:?}", found.first);
        scene.objects.reverse();
    }
}

/// The first light alone has a shadow: with volumes every pixel's shade is known; with a map it may be either, and few
/// pixels are none of the shadow that is due.
#[test]
fn pictures_with_shadows_are_those_of_f64() {
    let (_context, mut renderer) = renderer();
    for (what, name, changes, _) in scenes().into_iter().filter(|(what, ..)| *what != "the knight near by") {
        for method in METHODS {
            for technique in ["shadow-map", "shadow-volume"] {
                if method == "three-pass" && technique == "shadow-volume" {
                    continue; // refused: light that is counted has passes of its own
                }
                let mut changes: Vec<String> = changes.clone();
                changes.extend([format!("shading.bump=\"{method}\""), String::from("image.size=[256, 256]")]);
                changes.push(format!("light.shadow={{ technique = \"{technique}\" }}"));
                let mut scene = load(&data(name), &changes);
                scene.lights.iter_mut().skip(1).for_each(|light| light.shadow = glumbra::techniques::unshadowed());
                let truth = colors(&scene, &own_shadows(&scene));
                let drawn = picture(&scene, &mut renderer);
                let found = tally(&scene, &[&truth], &drawn);
                print(&format!("{what}, {method}, {technique}"), &found);
                if technique == "shadow-volume" {
                    assert_eq!(found.wrong, 0, "{what}, {method}: {:?}", found.first);
                    continue;
                }
                // Texels move the edges of shadows, and soften them.
                assert!(50 * found.wrong < found.compared, "{what}, {method}: {} wrong", found.wrong);
                let none = vec![None; scene.lights.len()];
                let open = colors(&scene, &none);
                let mut dark = scene.clone();
                (dark.lights[0].diffuse, dark.lights[0].specular) = ([0.0; 3], [0.0; 3]);
                let either = tally(&scene, &[&truth, &open, &colors(&dark, &none)], &drawn);
                assert_eq!(either.wrong, 0, "{what}, {method}: {:?}", either.first);
            }
        }
    }
}
