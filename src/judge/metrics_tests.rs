//! Small pictures made by hand.

use glam::{DVec2, DVec3};

use super::*;
use crate::truth::{Hit, Reason};

/// A flat floor of 1 unit a pixel that fills the light's frustum; `rows` by letter: `L`it, `S`hadowed, `A`mbiguous
/// (dark at its centre), `O`utside the cone, ` ` background, `T` shadowed and turned away.
fn truth(rows: &[&str]) -> Truth {
    let (width, height) = (rows[0].len(), rows.len());
    let pixel = |index: usize| {
        let (x, y) = (index % width, index / width);
        let (answer, lit_at_center) = match rows[y].as_bytes()[x] {
            b'L' => (Answer::Lit, Some(true)),
            b'S' | b'T' => (Answer::Shadowed, Some(false)),
            b'A' => (Answer::Ambiguous(Reason::ShadowEdge), Some(false)),
            b'O' => (Answer::OutsideCone, None),
            _ => (Answer::Background, None),
        };
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let hit = Hit {
            object: 0,
            triangle: 0,
            distance: 10.0,
            position: DVec3::new(at.x, 0.0, at.y),
            normal: DVec3::Y,
            cos_light: if rows[y].as_bytes()[x] == b'T' { -1.0 } else { 1.0 },
            pixel_size: 1.0,
            in_map: (2.0 * at / DVec2::new(width as f64, height as f64) - 1.0).extend(0.0),
        };
        Pixel { answer, lit_at_center, hit: (answer != Answer::Background).then_some(hit) }
    };
    Truth { width: width as u32, height: height as u32, pixels: (0..width * height).map(pixel).collect() }
}

/// `#` shadow, `.` light, a digit: tenths of light, ` ` nothing drawn.
fn shade(rows: &[&str]) -> ShadeImage {
    let letters: Vec<u8> = rows.iter().flat_map(|row| row.bytes()).collect();
    let value = |letter: &u8| match letter {
        b'.' => 1.0,
        b'0'..=b'9' => f32::from(letter - b'0') / 10.0,
        _ => 0.0,
    };
    ShadeImage {
        width: rows[0].len() as u32,
        height: rows.len() as u32,
        shade: letters.iter().map(value).collect(),
        covered: letters.iter().map(|&letter| letter != b' ').collect(),
    }
}

/// One texel a pixel.
fn band(texels: f64, truth: &Truth) -> Band {
    Band { texels, map_size: [truth.width, truth.height] }
}

#[test]
fn equal_pictures_have_no_error() {
    let truth = truth(&["LLLSSS", "LLLSSS"]);
    let metrics = compare(&truth, &shade(&["...###", "...###"]), &band(1.0, &truth)).unwrap();
    assert_eq!((metrics.all.compared, metrics.all.wrong_percent, metrics.all.rmse), (12, 0.0, 0.0));
    let same = EdgeDistance { edges: 2, mean_pixels: 0.0, p95_pixels: 0.0, max_pixels: 0.0 };
    assert_eq!((metrics.all.rendered_to_true, metrics.all.true_to_rendered), (Some(same), Some(same)));
    assert_eq!(metrics.all, metrics.facing);
    assert_eq!(metrics.left_out, NotCompared::default());
}

#[test]
fn false_shadow_and_leak_split_at_the_band() {
    // The edge between columns 4 and 5; k = 1.1 takes columns 3 to 6.
    let truth = truth(&["LLLLLSSSSS"]);
    let metrics = compare(&truth, &shade(&["#..#..##.#"]), &band(1.1, &truth)).unwrap().all;
    assert_eq!((metrics.compared, metrics.compared_in_band), (10, 4));
    assert_eq!((metrics.false_shadow.inside, metrics.false_shadow.outside), (1, 1));
    assert_eq!((metrics.leak.inside, metrics.leak.outside), (1, 1));
    assert_eq!((metrics.false_shadow_percent, metrics.leak_percent, metrics.wrong_percent), (20.0, 20.0, 40.0));
    assert_eq!((metrics.wrong_outside_percent, metrics.leak.inside_percent), (20.0, 10.0));
}

#[test]
fn the_band_is_measured_in_texels_of_the_map() {
    let truth = truth(&["LLLLLSSSSS"]);
    let picture = shade(&[".....#####"]);
    // Half as many texels: each is two pixels wide. No texel at all: the two pixels beside the edge remain.
    for (texels, map_width, expected) in [(1.1, 10, 4), (1.1, 5, 6), (2.1, 10, 6), (2.1, 40, 2), (0.0, 10, 2)] {
        let band = Band { texels, map_size: [map_width, 1] };
        let metrics = compare(&truth, &picture, &band).unwrap();
        assert_eq!(metrics.all.compared_in_band, expected, "{texels} texels of {map_width}");
    }
}

#[test]
fn a_shadow_moved_aside_is_as_far_away_as_it_was_moved() {
    let truth = truth(&["LLLLSSSSSS"; 4]);
    let metrics = compare(&truth, &shade(&[".......###"; 4]), &band(0.5, &truth)).unwrap().all;
    let away = EdgeDistance { edges: 4, mean_pixels: 3.0, p95_pixels: 3.0, max_pixels: 3.0 };
    assert_eq!((metrics.rendered_to_true, metrics.true_to_rendered), (Some(away), Some(away)));
    assert_eq!((metrics.leak.inside, metrics.leak.outside), (4, 8));
}

#[test]
fn acne_and_lost_shadows_show_in_one_direction_each() {
    let edge = truth(&["LLLLLLLLSS"]);
    let acne = compare(&edge, &shade(&[".#......##"]), &band(1.0, &edge)).unwrap().all;
    assert_eq!(acne.true_to_rendered.unwrap().max_pixels, 0.0);
    assert_eq!(acne.rendered_to_true.unwrap().max_pixels, 7.0);
    let lost = compare(&edge, &shade(&[".........."]), &band(1.0, &edge)).unwrap().all;
    assert_eq!((lost.rendered_to_true, lost.true_to_rendered, lost.leak.inside), (None, None, 2));
}

#[test]
fn each_pixel_left_out_is_counted_once_with_its_reason() {
    // The last column is outside the cone, where a shade is transparent and may be a surface's or none.
    let truth = truth(&["LLA OO", "SS  LO"]);
    let metrics = compare(&truth, &shade(&[".##.# ", "# . . "]), &band(1.0, &truth)).unwrap();
    let expected = NotCompared { background: 1, ambiguous: 1, outside_cone: 3, not_drawn: 1, only_drawn: 2 };
    assert_eq!(metrics.left_out, expected);
    assert_eq!((metrics.all.compared, metrics.all.false_shadow_percent), (4, 25.0));
}

#[test]
fn an_edge_through_an_ambiguous_pixel_is_found() {
    let truth = truth(&["LLLASS"]);
    let metrics = compare(&truth, &shade(&["..####"]), &band(0.0, &truth)).unwrap().all;
    assert_eq!(metrics.rendered_to_true.unwrap().max_pixels, 1.0);
}

#[test]
fn a_step_in_depth_is_no_shadow_edge() {
    let mut truth = truth(&["LLLSSS"]);
    for pixel in &mut truth.pixels[3..] {
        pixel.hit.as_mut().unwrap().position.y -= 5.0;
    }
    let metrics = compare(&truth, &shade(&["...###"]), &band(1.0, &truth)).unwrap().all;
    assert_eq!((metrics.compared_in_band, metrics.rendered_to_true), (0, None));
}

#[test]
fn surfaces_turned_away_count_in_all_only() {
    let truth = truth(&["LLLTTT"]);
    let metrics = compare(&truth, &shade(&["...#.."]), &band(1.0, &truth)).unwrap();
    assert_eq!((metrics.all.compared, metrics.facing.compared), (6, 3));
    assert_eq!((metrics.all.leak.inside + metrics.all.leak.outside, metrics.facing.wrong_percent), (2, 0.0));
    assert!(metrics.facing.rendered_to_true.is_none());
}

#[test]
fn filtered_shade_has_an_rmse_and_a_level() {
    let truth = truth(&["LLSS"]);
    let metrics = compare(&truth, &shade(&[".541"]), &band(1.0, &truth)).unwrap().all;
    assert_eq!(metrics.wrong_percent, 0.0);
    assert!((metrics.rmse - ((0.25 + 0.16 + 0.01) / 4.0f64).sqrt()).abs() < 1e-7);
}

#[test]
fn pictures_that_do_not_fit_are_refused() {
    let truth = truth(&["LS"]);
    let good = shade(&[".#"]);
    assert!(matches!(compare(&truth, &shade(&["."]), &band(1.0, &truth)), Err(Error::Size { .. })));
    let short = ShadeImage { covered: vec![true], ..good.clone() };
    assert!(matches!(compare(&truth, &short, &band(1.0, &truth)), Err(Error::Length { .. })));
    let broken = ShadeImage { shade: vec![1.0, f32::NAN], ..good.clone() };
    assert!(matches!(compare(&truth, &broken, &band(1.0, &truth)), Err(Error::Value { x: 1, y: 0, .. })));
    let empty = Band { texels: 1.0, map_size: [0, 5] };
    assert!(matches!(compare(&truth, &good, &empty), Err(Error::Band { .. })));
}
