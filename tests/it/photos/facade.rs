//! The figure of a façade: the committed photograph is the scene's own, and its panels show what the caption says.

use glumbra::figures::{FIGURES, Figure};
use glumbra::truth::{Answer, Options};

use super::*;

fn figure() -> &'static Figure {
    FIGURES.iter().find(|figure| figure.name == "segal-facade").unwrap()
}

fn panel(number: usize, more: &[&str]) -> Scene {
    let set: Vec<String> = figure().panels[number].set.iter().chain(more).map(|set| (*set).to_owned()).collect();
    glumbra::techniques::load_embedded(&figure().scene, &set).unwrap().scene
}

#[test]
fn the_committed_photograph_is_the_scene_s_own() {
    let mut studio = Studio::new();
    let picture = studio.draw(&panel(0, &["image.size=[800, 600]"]));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/textures/facade.png");
    let committed = image::open(path).unwrap().to_rgb8();
    assert_eq!(committed.dimensions(), (800, 600));
    let codes = committed.pixels().map(|pixel| pixel.0.map(i32::from));
    let apart = |(a, b): ([i32; 3], &[i32; 3])| (0..3).map(|k| (a[k] - b[k]).abs()).max().unwrap_or(0);
    let differ = codes.zip(&picture).map(apart).filter(|codes| *codes > 2).count();
    println!("{differ} of {} pixels differ by more than 2 codes", picture.len());
    // Another driver's edges and shadows' edges; none on the one that drew it.
    assert!(differ <= picture.len() / 100, "{differ}");
}

#[test]
fn the_panels_show_what_the_caption_says() {
    let mut studio = Studio::new();
    let apart = |a: &[i32; 3], b: &[i32; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).max().unwrap_or(0);
    // From its own place: the photograph but for edges, whose pixels the sheet's smaller picture mixes otherwise.
    let (photo, own) = (studio.draw(&panel(0, &[])), studio.draw(&panel(4, &[])));
    let differ = photo.iter().zip(&own).filter(|(a, b)| apart(a, b) > 40).count();
    assert!(differ < photo.len() / 12, "{differ} of {}", photo.len());
    for (direct, smeared, grey) in [(1, 2, 3), (5, 6, 7)] {
        let scene = panel(direct, &[]);
        let mut with_light = scene.clone();
        with_light.lights = vec![panel(grey, &[]).photos()[0].projector.clone()];
        let truth = truth::trace(&with_light, 0, &Options { most_ambiguous: 1.0, ..Options::default() }).unwrap();
        let pictures = [direct, smeared, grey].map(|number| studio.draw(&panel(number, &[])));
        let [mut hidden, mut grey, mut smeared, mut lit, mut right] = [0; 5];
        for (index, pixel) in truth.pixels.iter().enumerate() {
            let [own, smear, decided] = [0, 1, 2].map(|picture| pictures[picture][index]);
            match pixel.answer {
                Answer::Shadowed => {
                    hidden += 1;
                    grey += usize::from(decided == GREY);
                    smeared += usize::from(smear != GREY && apart(&own, &smear) > 24);
                }
                Answer::Lit => {
                    lit += 1;
                    right += usize::from(apart(&own, &decided) <= 40);
                }
                _ => {}
            }
        }
        println!("{hidden} hidden, {grey} grey, {smeared} smeared; {lit} seen, {right} as drawn directly");
        assert!(hidden > 3_000 && grey > hidden * 9 / 10 && smeared > hidden / 3, "{hidden} {grey} {smeared}");
        // Bricks are mixed otherwise at another distance; fringes of bars and slats are grey.
        assert!(lit > 20_000 && right > lit * 8 / 10, "{lit} {right}");
    }
}
