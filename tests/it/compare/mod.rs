//! `glumbra::pictures` and `glumbra compare`: every figure of a comparison, every format, and files that are broken.

mod command;
mod files;

use glumbra::pictures::compare::{Tolerance, compare, has_spot, measure};
use glumbra::pictures::{Comparison, Raster, alike};

fn raster(size: [u32; 2], channels: usize, value: impl Fn(usize) -> f32) -> Raster {
    let values = size[0] as usize * size[1] as usize * channels;
    Raster { size, channels, data: (0..values).map(value).collect() }
}

/// Differences that are planted, by a seed: every figure is that of a slow count.
#[test]
fn planted_differences_are_measured_exactly() {
    let mut random = fastrand::Rng::with_seed(1);
    for (channels, count) in [(1, 1), (3, 40), (4, 900)] {
        let size = [40, 30];
        let expected = raster(size, channels, |index| ((index * 37) % 256) as f32 / 255.0);
        let mut actual = expected.clone();
        let mut pixels: Vec<usize> = (0..1200).collect();
        random.shuffle(&mut pixels);
        pixels.truncate(count);
        // Steps of 1/64 below one half, so that every difference is exact.
        let steps: Vec<f32> = pixels.iter().map(|_| random.u8(1..32) as f32 / 64.0).collect();
        for (pixel, step) in pixels.iter().zip(&steps) {
            let value = &mut actual.data[pixel * channels + channels - 1];
            *value = if *value > 0.5 { *value - step } else { *value + step };
        }
        let off = |pixel: usize| {
            let index = pixel * channels + channels - 1;
            f64::from((actual.data[index] - expected.data[index]).abs())
        };
        let found = Comparison::of(&actual, &expected).unwrap();
        let values = (1200 * channels) as f64;
        let sum: f64 = pixels.iter().map(|pixel| off(*pixel)).sum();
        let squares: f64 = pixels.iter().map(|pixel| off(*pixel).powi(2)).sum();
        let most = pixels.iter().map(|pixel| off(*pixel)).fold(0.0, f64::max);
        assert_eq!((found.difference.count, found.difference.of, found.difference.max), (count, 1200, most));
        assert!((found.difference.mean - sum / values).abs() < 1e-9, "{found:?}");
        assert!((found.rms - (squares / values).sqrt()).abs() < 1e-9);
        let place = |pixel: usize| [(pixel % 40) as u32, (pixel / 40) as u32];
        assert_eq!(found.first, pixels.iter().min().map(|pixel| place(*pixel)));
        let [x, y] = found.difference.at;
        assert_eq!(off(y as usize * 40 + x as usize), most);
        assert_eq!(found.channel, channels - 1);
        let along = |k: usize| {
            let sides = || pixels.iter().map(|pixel| place(*pixel)[k]);
            [sides().min().unwrap(), sides().max().unwrap()]
        };
        let (columns, rows) = (along(0), along(1));
        assert_eq!(found.bounds, Some([[columns[0], rows[0]], [columns[1], rows[1]]]));
        for limit in [0.0, 0.1, 0.25, most] {
            let beyond = pixels.iter().filter(|pixel| off(**pixel) > limit).count();
            assert_eq!(found.count_beyond(limit), beyond, "{limit}");
            assert!((found.share_beyond(limit) - beyond as f64 / 1200.0).abs() < 1e-15);
        }
    }
}

#[test]
fn equal_pictures_do_not_differ_and_a_bit_does() {
    let one = raster([8, 8], 3, |index| index as f32);
    let found = Comparison::of(&one, &one).unwrap();
    assert_eq!((found.difference.count, found.rms, found.first, found.bounds), (0, 0.0, None, None));
    let mut other = one.clone();
    other.data[30] = f32::from_bits(other.data[30].to_bits() + 1);
    let found = Comparison::of(&other, &one).unwrap();
    assert_eq!((found.difference.count, found.difference.at, found.channel), (1, [2, 1], 0));
    other.data[30] = f32::NAN;
    assert_eq!(Comparison::of(&other, &one).unwrap().difference.max, f64::INFINITY);
    assert_eq!(Comparison::of(&other, &other).unwrap().difference.count, 0, "the same bits");
}

#[test]
fn shapes_that_do_not_fit_are_refused() {
    let one = raster([4, 4], 3, |_| 0.0);
    for (size, channels) in [([4, 5], 3), ([5, 4], 3), ([4, 4], 1), ([4, 4], 4)] {
        assert!(measure(&one, &raster(size, channels, |_| 0.0)).is_err(), "{size:?} {channels}");
    }
    let empty = Raster { size: [0, 0], channels: 3, data: Vec::new() };
    assert!(Comparison::of(&empty, &empty).is_err());
    assert!(alike(one.clone(), raster([4, 4], 5, |_| 0.0)).is_err());
    assert!(alike(one, raster([4, 3], 3, |_| 0.0)).unwrap_err().contains("4x4 and 4x3"));
}

#[test]
fn channels_are_made_alike() {
    let pixel = |values: &[f32]| Raster { size: [1, 1], channels: values.len(), data: values.to_vec() };
    for (one, other, expected) in [
        (&[0.5][..], &[0.1, 0.2, 0.3][..], [&[0.5, 0.5, 0.5][..], &[0.1, 0.2, 0.3]]),
        (&[0.5, 0.7], &[0.1, 0.2, 0.3], [&[0.5, 0.5, 0.5, 0.7], &[0.1, 0.2, 0.3, 1.0]]),
        (&[0.5], &[0.6, 0.0], [&[0.5, 1.0], &[0.6, 0.0]]),
        (&[0.1, 0.2, 0.3], &[0.4, 0.5, 0.6, 0.7], [&[0.1, 0.2, 0.3, 1.0], &[0.4, 0.5, 0.6, 0.7]]),
        (&[0.5; 6], &[0.25; 6], [&[0.5; 6], &[0.25; 6]]),
    ] {
        let found = alike(pixel(one), pixel(other)).unwrap();
        assert_eq!(found.each_ref().map(|raster| &raster.data[..]), expected);
    }
}

/// A small shadow that vanishes: a small share, but a spot.
#[test]
fn a_spot_is_found_that_a_share_hides() {
    let expected = raster([20, 20], 1, |_| 1.0);
    let mut actual = expected.clone();
    let mut scattered = expected.clone();
    for (index, place) in [(3, 4), (4, 4), (5, 4), (3, 5), (4, 5), (5, 5), (3, 6), (4, 6), (5, 6)].iter().enumerate() {
        actual.data[place.1 * 20 + place.0] = 0.0;
        scattered.data[40 * index + 7] = 0.0;
    }
    let tolerance = Tolerance { max: 1.0, mean: 1.0, share: 0.03, slight: 0.1, spot: None };
    compare(&actual, &expected, &tolerance).unwrap();
    for (side, differs) in [(1, true), (3, true), (4, false)] {
        assert_eq!(has_spot(&actual, &expected, 0.1, side), differs, "{side}");
        assert_eq!(compare(&actual, &expected, &Tolerance { spot: Some(side), ..tolerance }).is_err(), differs);
    }
    assert!(!has_spot(&scattered, &expected, 0.1, 2) && !has_spot(&actual, &expected, 1.0, 1));
    let said = compare(&actual, &expected, &Tolerance { spot: Some(3), ..tolerance }).unwrap_err();
    assert!(said.contains("a spot at (3, 4)"), "{said}");
}

#[test]
fn a_picture_of_the_difference_is_sixteen_times_as_bright() {
    let one = raster([3, 1], 1, |_| 0.0);
    let other = Raster { data: vec![0.0, 4.0 / 255.0, 1.0], ..one.clone() };
    let difference = other.difference(&one).unwrap();
    assert_eq!(difference.data[0], 0.0);
    assert!((difference.data[1] - 0.25).abs() < 1e-6 && difference.data[2] > 1.0);
    assert_eq!(other.difference(&raster([3, 1], 2, |_| 0.0)), None);
}
