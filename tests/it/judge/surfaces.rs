//! Pixels on which picture and truth show different things, and light where a spotlight has none.

use glumbra::judge::{Bound, Judge};
use glumbra::truth::Answer;

use super::{perfect, scene};

/// The outline of the box may lie a pixel aside in another renderer's picture, and its middle may not be missing.
#[test]
fn surfaces_are_explained_along_silhouettes_alone() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let right = perfect(&mut judge);
    let width = right.width as usize;
    let objects: Vec<Option<u32>> =
        judge.truth(&Bound::NoMap).pixels.iter().map(|pixel| pixel.hit.map(|hit| hit.object)).collect();
    let known: Vec<bool> = {
        let pixels = judge.truth(&Bound::NoMap).pixels.iter();
        pixels.map(|pixel| matches!(pixel.answer, Answer::Lit | Answer::Shadowed)).collect()
    };
    // The box against the floor behind it; above its bottom, where it touches the floor.
    let is_outline = |index: &usize| objects[*index] == Some(1) && objects[index - width] == Some(0) && known[*index];
    let outline = (width..objects.len()).find(is_outline).unwrap();
    let is_middle =
        |index: &usize| (0..9).all(|k| objects[index + k] == Some(1) && objects[index + 4 * width] == Some(1));
    let middle = 4 + (width..objects.len() - 9).find(is_middle).unwrap() + 2 * width;
    for (pixel, explained) in [(outline, true), (middle, false)] {
        let mut shade = right.clone();
        shade.covered[pixel] = false;
        for (bound, explained) in [(Bound::Band { pixels: 3.0 }, explained), (Bound::NoMap, false)] {
            let found = judge.shade(&shade, &bound).unwrap();
            assert_eq!((found.surface, found.outside_band), (1, usize::from(!explained)), "{pixel} {bound:?}");
        }
    }
}

/// Beside the spotlight a shade has no meaning, and a picture no light.
#[test]
fn light_beside_a_spotlight_is_wrong_in_a_picture_and_nothing_in_a_shade() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let mut shade = perfect(&mut judge);
    let beside: Vec<usize> = {
        let pixels = judge.truth(&Bound::NoMap).pixels.iter().enumerate();
        let outside = pixels.filter(|(_, pixel)| pixel.answer == Answer::OutsideCone);
        outside.filter(|(_, p)| p.hit.unwrap().in_map.length() > 1.0).map(|(index, _)| index).collect()
    };
    assert!(beside.len() > 1000);
    for index in &beside[..25] {
        shade.shade[*index] = 0.01;
    }
    let picture = judge.pictured_shade(&shade, &Bound::NoMap).unwrap();
    assert_eq!((picture.light_outside, picture.wrong(), picture.outside_band), (25, 25, 25));
    let as_shade = judge.shade(&shade, &Bound::NoMap).unwrap();
    assert_eq!((as_shade.wrong(), picture.compared), (0, as_shade.compared + beside.len()));
}
