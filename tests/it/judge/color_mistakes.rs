//! Mistakes that make a whole picture's colours wrong are planted and named; other faults are not taken for one.

use glumbra::context;
use glumbra::frame::Renderer;
use glumbra::judge::colors::{DrawnColors, draw_colors, errors_of, true_colors};
use glumbra::judge::{Mistake, color_mistake};

use super::scene;

/// A light that is not grey, so that no two channels are alike.
const COLORED: [&str; 2] = ["light.color=[1.0, 0.8, 0.5]", "light.shadow.size=1024"];

/// The picture whose pixel at (x, y) is the one at `from`; the nearest within, where that lies outside.
fn moved(picture: &DrawnColors, from: impl Fn(i64, i64) -> [i64; 2]) -> DrawnColors {
    let [width, height] = picture.size.map(i64::from);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let codes = places.map(|(x, y)| {
        let [x, y] = from(x, y);
        picture.codes[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
    });
    DrawnColors { size: picture.size, codes: codes.collect() }
}

fn recoded(picture: &DrawnColors, code: impl Fn([f64; 3]) -> [f64; 3]) -> DrawnColors {
    DrawnColors { size: picture.size, codes: picture.codes.iter().map(|codes| code(*codes)).collect() }
}

/// The curve of sRGB [IEC 61966-2-1], in 8 bits.
fn encoded(code: f64) -> f64 {
    let linear = code / 255.0;
    let value = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round()
}

#[test]
fn colors_that_only_lie_wrong_are_named() {
    let mut renderer = Renderer::new(&context::open(&Default::default()).unwrap());
    let scene = scene("box.toml", &COLORED);
    let truth = true_colors(&scene, 0).unwrap();
    let right = draw_colors(&scene, false, &mut renderer).unwrap();
    assert_eq!(color_mistake(&truth, &right), None);
    let [width, height] = right.size.map(i64::from);
    for (picture, expected) in [
        (moved(&right, |x, y| [x, height - 1 - y]), Mistake::UpsideDown),
        (moved(&right, |x, y| [width - 1 - x, y]), Mistake::Mirrored),
        (moved(&right, |x, y| [width - 1 - x, height - 1 - y]), Mistake::Turned),
        (moved(&right, |x, y| [x - 2, y + 1]), Mistake::Shifted([2, -1])),
        (moved(&right, |x, y| [x, y - 4]), Mistake::Shifted([0, 4])),
        (recoded(&right, |[r, g, b]| [b, g, r]), Mistake::RedAndBlue),
        (recoded(&right, |codes| codes.map(encoded)), Mistake::Encoded),
    ] {
        let found = color_mistake(&truth, &picture).unwrap_or_else(|| panic!("no mistake in place of {expected:?}"));
        assert_eq!(found.mistake, expected, "{found}");
        assert!(found.without_share <= 0.25 * found.wrong_share && found.wrong_share > 0.001, "{found}");
    }
}

/// A picture that is wrong otherwise is not explained by any of them.
#[test]
fn other_faults_are_no_such_mistake() {
    let mut renderer = Renderer::new(&context::open(&Default::default()).unwrap());
    let truth = true_colors(&scene("box.toml", &COLORED), 0).unwrap();
    for fault in ["light.shadow.technique=none", "light.position=[-2.0, 4.0, 1.0]", "light.color=[0.9, 0.8, 0.5]"] {
        let wrong = scene("box.toml", &[COLORED[0], COLORED[1], fault]);
        let wrong = draw_colors(&wrong, false, &mut renderer).unwrap();
        let (errors, _) = errors_of(&truth, &wrong).unwrap();
        assert!(errors.beyond_percent > 1.0, "{fault}: {errors:?}");
        assert_eq!(color_mistake(&truth, &wrong), None, "{fault}");
    }
    let small = DrawnColors { size: [1, 1], codes: vec![[0.0; 3]] };
    assert_eq!(color_mistake(&truth, &small), None);
}
