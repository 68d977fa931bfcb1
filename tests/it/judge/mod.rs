//! `glumbra::judge` and `glumbra judge`: planted wrong pixels are found to the last one, each where it is and by its kind;
//! pictures that are turned over, moved or of another light are named; and a picture by another renderer is judged.

mod color_mistakes;
mod command;
pub mod other_renderer;
mod surfaces;

use std::path::Path;

use glumbra::context;
use glumbra::frame::{Renderer, ShadeImage};
use glumbra::judge::colors::{draw_colors, true_colors};
use glumbra::judge::{Bound, Explanation, Judge, Judgement, Mistake, PixelClass};
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::truth::Answer;
use glumbra::views::View;

fn scene(name: &str, overrides: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes").join(name);
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    glumbra::load(&path, &overrides).unwrap().scene
}

/// The shade that the truth is itself; 0.5 would be lit.
fn perfect(judge: &mut Judge<'_>) -> ShadeImage {
    let truth = judge.truth(&Bound::NoMap);
    ShadeImage {
        width: truth.width,
        height: truth.height,
        shade: truth.pixels.iter().map(|pixel| f32::from(u8::from(pixel.lit_at_center == Some(true)))).collect(),
        covered: truth.pixels.iter().map(|pixel| pixel.hit.is_some()).collect(),
    }
}

/// Every pixel is counted once.
fn assert_counted_once(found: &Judgement) {
    let count = |class: PixelClass| found.classes.iter().filter(|known| **known == class).count();
    let left_out = [PixelClass::Background, PixelClass::Unknown, PixelClass::OutsideLight, PixelClass::TurnedAway];
    let left_out: usize = left_out.map(count).iter().sum::<usize>() + count(PixelClass::NoShade);
    assert_eq!(left_out + found.compared, found.classes.len());
    assert_eq!(count(PixelClass::Right) + found.wrong(), found.compared);
    assert_eq!(found.beyond().len(), found.outside_band);
    let drawn = found.classes.len() - count(PixelClass::Background);
    assert_eq!((found.drawn, found.unknown), (drawn, count(PixelClass::Unknown)));
    assert!((found.unknown_share() - found.unknown as f64 / drawn as f64).abs() < 1e-15);
}

#[test]
fn a_perfect_shade_has_no_wrong_pixel_by_any_bound() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let shade = perfect(&mut judge);
    for bound in [Bound::Exact, Bound::NoMap, Bound::Band { pixels: 0.0 }] {
        let found = judge.shade(&shade, &bound).unwrap();
        assert_counted_once(&found);
        assert_eq!((found.wrong(), found.outside_band), (0, 0), "{bound:?}");
        assert!(found.compared > 10_000 && found.unknown < 500, "{bound:?}");
    }
    assert_eq!(judge.mistake(&shade, true).unwrap(), None);
    // Without a map, surfaces that are turned away from the light count, too.
    let [exact, facing] = [Bound::Exact, Bound::NoMap].map(|bound| judge.shade(&shade, &bound).unwrap());
    let turned_away = |found: &Judgement| found.classes.iter().filter(|c| **c == PixelClass::TurnedAway).count();
    assert_eq!(turned_away(&exact), 0);
    assert!(turned_away(&facing) > 100 && exact.compared > facing.compared + 100);
}

/// Any number of pixels anywhere, by a seed: each count is exact.
#[test]
fn planted_pixels_are_counted_exactly() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let right = perfect(&mut judge);
    let facing: Vec<(usize, bool)> = {
        let pixels = judge.truth(&Bound::NoMap).pixels.iter().enumerate();
        let facing = pixels.filter(|(_, pixel)| pixel.hit.is_some_and(|hit| hit.faces_light()));
        let known = facing.filter(|(_, pixel)| matches!(pixel.answer, Answer::Lit | Answer::Shadowed));
        known.map(|(index, pixel)| (index, pixel.answer == Answer::Lit)).collect()
    };
    let background = right.covered.iter().position(|covered| !covered).unwrap();
    let mut random = fastrand::Rng::with_seed(17);
    for count in [1, 7, 200] {
        let mut shade = right.clone();
        let mut chosen = facing.clone();
        random.shuffle(&mut chosen);
        chosen.truncate(count + 2);
        // The last two: one that the picture does not show, one without a number.
        let ((missing, _), (unknown, _)) = (chosen.pop().unwrap(), chosen.pop().unwrap());
        shade.covered[missing] = false;
        shade.shade[unknown] = f32::NAN;
        shade.covered[background] = true;
        for (index, is_lit) in &chosen {
            // Just on the other side of one half.
            shade.shade[*index] = if *is_lit { 0.499 } else { 0.5 };
        }
        let lost = chosen.iter().filter(|(_, is_lit)| *is_lit).count();
        let found = judge.shade(&shade, &Bound::NoMap).unwrap();
        assert_counted_once(&found);
        assert_eq!([found.false_shadow, found.leak, found.surface], [lost, count - lost, 2]);
        assert_eq!((found.outside_band, found.light_outside), (count + 2, 0), "nothing explains a wrong pixel");
        assert_eq!(found.classes[unknown], PixelClass::NoShade);
        assert_eq!(found.classes[missing], PixelClass::Surface(Explanation::Beyond));
        let mut expected: Vec<usize> = chosen.iter().map(|(index, _)| *index).chain([missing, background]).collect();
        expected.sort_unstable();
        assert_eq!(found.beyond(), expected);
        let share = (count + 2) as f64 / found.compared as f64;
        assert!((found.share(found.wrong()) - share).abs() < 1e-15);
    }
}

/// Distance of a pixel's centre to the nearest side between pixels of one object where the truth changes, by trying all.
fn edge_distance(judge: &mut Judge<'_>, index: usize) -> f64 {
    let truth = judge.truth(&Bound::NoMap);
    let (width, height) = (truth.width as usize, truth.height as usize);
    let lit = |index: usize| truth.pixels[index].lit_at_center;
    let object = |index: usize| truth.pixels[index].hit.map(|hit| hit.object);
    let (x, y) = ((index % width) as f64, (index / width) as f64);
    let mut nearest = f64::INFINITY;
    for row in 0..height {
        for column in 0..width {
            let here = row * width + column;
            let beside = [(here + 1, column + 1 < width, [0.5, 0.0]), (here + width, row + 1 < height, [0.0, 0.5])];
            for (other, _, half) in beside.into_iter().filter(|(_, exists, _)| *exists) {
                let both = lit(here).zip(lit(other));
                if both.is_some_and(|(a, b)| a != b) && object(here) == object(other) {
                    nearest = nearest.min((column as f64 + half[0] - x).hypot(row as f64 + half[1] - y));
                }
            }
        }
    }
    nearest
}

#[test]
fn a_band_explains_what_lies_near_a_true_edge_and_nothing_far_from_it() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let right = perfect(&mut judge);
    let floor: Vec<usize> = {
        let pixels = judge.truth(&Bound::NoMap).pixels.iter().enumerate();
        let of_floor = pixels.filter(|(_, pixel)| pixel.hit.is_some_and(|hit| hit.object == 0));
        of_floor.filter(|(_, p)| matches!(p.answer, Answer::Lit | Answer::Shadowed)).map(|(index, _)| index).collect()
    };
    // Where the box stands on the floor it hides edges.
    let is_by_box = |judge: &mut Judge<'_>, index: usize| {
        let truth = judge.truth(&Bound::NoMap);
        let (x, y) = ((index % truth.width as usize) as u32, (index / truth.width as usize) as u32);
        let around =
            (y.saturating_sub(12)..y + 13).flat_map(|row| (x.saturating_sub(12)..x + 13).map(move |x| (x, row)));
        around.filter_map(|(x, y)| truth.at(x, y)?.hit).any(|hit| hit.object != 0)
    };
    let mut random = fastrand::Rng::with_seed(3);
    let (mut near, mut far) = (0, 0);
    for _ in 0..400 {
        let index = floor[random.usize(..floor.len())];
        let mut shade = right.clone();
        shade.shade[index] = 1.0 - shade.shade[index];
        let distance = edge_distance(&mut judge, index);
        let found = judge.shade(&shade, &Bound::Band { pixels: 3.0 }).unwrap();
        assert_eq!(found.wrong(), 1);
        if distance <= 3.0 {
            near += 1;
            assert_eq!(found.outside_band, 0, "pixel {index}, {distance} from an edge");
        } else if distance > 12.0 && !is_by_box(&mut judge, index) {
            far += 1;
            assert_eq!(found.outside_band, 1, "pixel {index}, {distance} from an edge");
        }
    }
    assert!(near >= 5 && far >= 100, "{near} {far}");
}

#[test]
fn regions_say_where_and_what_is_wrong() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let mut shade = perfect(&mut judge);
    let width = shade.width as usize;
    // Light in the midst of the box's shadow, and shadow on the floor far from it.
    let dark = pixel_of(&mut judge, |pixel| pixel.answer == Answer::Shadowed && pixel.hit.unwrap().faces_light());
    let bright = pixel_of(&mut judge, |pixel| pixel.answer == Answer::Lit && pixel.hit.unwrap().object == 0);
    for (start, columns, rows, value) in [(dark, 3, 2, 1.0), (bright, 4, 4, 0.0)] {
        for row in 0..rows {
            shade.shade[start + row * width..start + row * width + columns].fill(value);
        }
    }
    let found = judge.shade(&shade, &Bound::NoMap).unwrap();
    assert_eq!([found.leak, found.false_shadow], [6, 16]);
    let regions = judge.regions(&found, 10);
    assert_eq!(regions.iter().map(|region| region.pixels).collect::<Vec<_>>(), [16, 6]);
    assert_eq!(judge.regions(&found, 1).len(), 1);
    for (region, start, [columns, rows]) in [(&regions[0], bright, [4, 4]), (&regions[1], dark, [3, 2])] {
        let corner = [(start % width) as u32, (start / width) as u32];
        assert_eq!(region.bounds, [corner, [corner[0] + columns - 1, corner[1] + rows - 1]]);
        let index = region.at[1] as usize * width + region.at[0] as usize;
        let hit = judge.truth(&Bound::NoMap).pixels[index].hit.unwrap();
        assert_eq!((region.position, region.object), (Some(hit.position), Some(0)), "the floor");
        assert_eq!(region.caster, Some(1), "the box");
        let distance = edge_distance(&mut judge, index);
        assert!((region.edge_pixels - distance).abs() < 1e-3, "{} {distance}", region.edge_pixels);
        for row in 0..rows as usize {
            for column in 0..columns as usize {
                let other = edge_distance(&mut judge, start + row * width + column);
                assert!(other <= distance + 1e-9, "the worst pixel is the farthest from the edge");
            }
        }
    }
}

/// The first pixel that is as wanted, and all around it for eight pixels.
fn pixel_of(judge: &mut Judge<'_>, is_wanted: impl Fn(&glumbra::truth::Pixel) -> bool) -> usize {
    let truth = judge.truth(&Bound::NoMap);
    let width = truth.width as usize;
    let is_wanted = |index: usize| truth.pixels[index].hit.is_some() && is_wanted(&truth.pixels[index]);
    let inside = (0..truth.pixels.len()).filter(|index| (8..width - 8).contains(&(index % width)));
    let mut inside = inside.filter(|index| (8..truth.height as usize - 8).contains(&(index / width)));
    inside
        .find(|index| (0..8).all(|row| (0..8).all(|column| is_wanted(index + row * width + column))))
        .expect("a square of such pixels")
}

/// The picture as `from` says where each pixel comes from.
fn moved(image: &ShadeImage, from: impl Fn(i64, i64) -> [i64; 2]) -> ShadeImage {
    let (width, height) = (i64::from(image.width), i64::from(image.height));
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let index = |[x, y]: [i64; 2]| {
        let [x, y] = from(x, y);
        (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize
    };
    let indices: Vec<usize> = places.map(index).collect();
    ShadeImage {
        shade: indices.iter().map(|index| image.shade[*index]).collect(),
        covered: indices.iter().map(|index| image.covered[*index]).collect(),
        ..*image
    }
}

#[test]
fn pictures_that_only_lie_wrong_are_named() {
    let scene = scene("two_lights.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let right = perfect(&mut judge);
    let (width, height) = (i64::from(right.width), i64::from(right.height));
    let mut inverted = right.clone();
    inverted.shade.iter_mut().for_each(|value| *value = 1.0 - *value);
    let mut other = Judge::new(&scene, 1).unwrap();
    let cases = [
        (moved(&right, |x, y| [x, height - 1 - y]), Mistake::UpsideDown),
        (moved(&right, |x, y| [width - 1 - x, y]), Mistake::Mirrored),
        (moved(&right, |x, y| [width - 1 - x, height - 1 - y]), Mistake::Turned),
        (inverted, Mistake::Inverted),
        (moved(&right, |x, y| [x - 2, y + 1]), Mistake::Shifted([2, -1])),
        (moved(&right, |x, y| [x, y - 4]), Mistake::Shifted([0, 4])),
        (perfect(&mut other), Mistake::OtherLight(1)),
    ];
    for knows_surfaces in [true, false] {
        for (image, expected) in &cases {
            let mut image = image.clone();
            if !knows_surfaces {
                judge.cover_surfaces(&mut image);
            }
            let found = judge.mistake(&image, knows_surfaces).unwrap().expect("a mistake");
            assert_eq!(found.mistake, *expected, "{found}");
            assert!(found.without_share <= 0.25 * found.wrong_share && found.wrong_share > 0.001, "{found}");
        }
    }
}

#[test]
fn shadows_that_are_moved_are_as_far_from_the_true_edges() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let right = perfect(&mut judge);
    let [shown, real] = judge.edge_distances(&right).unwrap().map(Option::unwrap);
    assert!(shown.mean_pixels < 0.2 && real.mean_pixels < 0.2, "{shown:?} {real:?}");
    // Acne far from any edge: shown edges lie far from true ones, and true ones are all shown.
    let mut acne = right.clone();
    let bright = pixel_of(&mut judge, |pixel| pixel.answer == Answer::Lit && pixel.hit.unwrap().object == 0);
    acne.shade[bright] = 0.0;
    let distance = edge_distance(&mut judge, bright);
    let [shown, real] = judge.edge_distances(&acne).unwrap().map(Option::unwrap);
    assert!((shown.max_pixels - distance).abs() < 1.0 && real.max_pixels < 0.2, "{distance} {shown:?} {real:?}");
    let off = moved(&right, |x, y| [x, y - 5]);
    let [_, real] = judge.edge_distances(&ShadeImage { covered: right.covered.clone(), ..off }).unwrap();
    let real = real.unwrap();
    // An edge that runs downwards stays where it is.
    assert!(real.max_pixels >= 3.0 && real.max_pixels < 9.0 && real.mean_pixels > 1.0, "{real:?}");
}

/// glumbra's own pictures: by the bound of their technique, no pixel is beyond.
#[test]
fn the_bound_of_a_technique_holds_its_own_pictures() {
    let context = context::open(&Default::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for overrides in [&["light.shadow.size=64"][..], &["light.shadow.technique=shadow-volume"]] {
        let scene = scene("box.toml", overrides);
        let views = vec![ViewRequest { view: View::Shade, light: 0 }];
        let plan = renderer.plan(&scene, &Request { views, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let texels = match renderer.read(&plan).unwrap().views.pop() {
            Some(glumbra::device::Pixels::RgbaF32 { data, .. }) => data,
            _ => panic!("no shade"),
        };
        let image = ShadeImage::of_view(scene.image.size, &texels);
        let bound = Bound::of_plan(&scene, &plan, 0);
        assert_eq!(bound == Bound::Exact, overrides[0].contains("volume"));
        let mut judge = Judge::new(&scene, 0).unwrap();
        let found = judge.shade(&image, &bound).unwrap();
        assert_eq!(found.outside_band, 0, "{overrides:?}");
        assert_eq!(found.wrong() > 0, bound != Bound::Exact, "a map of 64 texels is wrong somewhere");
        // The same wrong pixels, where nothing may be wrong.
        let strict = judge.shade(&image, &Bound::NoMap).unwrap();
        assert_eq!(strict.outside_band, strict.wrong());
    }
}

#[test]
fn colors_are_judged_by_their_bounds() {
    let context = context::open(&Default::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let scene = scene("box.toml", &["light.shadow.size=1024"]);
    let truth = true_colors(&scene, 0).unwrap();
    let right = draw_colors(&scene, false, &mut renderer).unwrap();
    let mut judge = Judge::new(&scene, 0).unwrap();
    let bound = Bound::Band { pixels: 3.0 };
    let found = judge.colors(&truth, &right, &bound).unwrap();
    assert_counted_once(&found);
    // Under the box's upper edge the map's texels see its top.
    assert!(found.outside_band <= 10 && found.surface == 0, "{} {}", found.outside_band, found.surface);
    assert!(found.compared > 10_000);
    // 16 pixels of lit floor 8 codes too dark, and then too bright.
    let start = pixel_of(&mut judge, |pixel| pixel.answer == Answer::Lit && pixel.hit.unwrap().object == 0);
    let width = right.size[0] as usize;
    for (off, counts) in [(-8.0, [16, 0]), (8.0, [0, 16])] {
        let mut wrong = right.clone();
        for index in (0..4).flat_map(|row| (0..4).map(move |column| start + row * width + column)) {
            wrong.codes[index] = wrong.codes[index].map(|code| code + off);
        }
        let with = judge.colors(&truth, &wrong, &bound).unwrap();
        assert_eq!([with.false_shadow - found.false_shadow, with.leak - found.leak], counts);
        assert_eq!(with.outside_band - found.outside_band, 16);
    }
}

#[test]
fn a_picture_of_another_size_is_refused() {
    let scene = scene("box.toml", &[]);
    let mut judge = Judge::new(&scene, 0).unwrap();
    let small = ShadeImage { width: 2, height: 1, shade: vec![0.0; 2], covered: vec![true; 2] };
    assert!(judge.shade(&small, &Bound::Exact).is_err());
    assert!(judge.edge_distances(&small).is_err());
    assert_eq!(judge.mistake(&small, true).unwrap(), None);
}
