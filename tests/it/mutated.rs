//! Scenes whose numbers were changed at random: each is refused by an error, or planned and traced. None panics, and none
//! of what is traced is a picture of another size. `GLUMBRA_MUTATIONS` says how many are tried in place of a few; each is then
//! held to five seconds.

use std::path::Path;
use std::time::{Duration, Instant};

use glumbra::plan::{self, Error, Request};
use glumbra::truth;

use crate::support::random::Random;

/// So many where nothing else is asked for.
const FEW: usize = 80;

/// Small: what is slow in a picture of a few pixels is slow for no good reason.
const SIZE: [u32; 2] = [16, 12];

const LONGEST: Duration = Duration::from_secs(5);

/// The texts of scenes, with absolute names of their files.
fn scenes() -> Vec<String> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let mut texts = Vec::new();
    for folder in ["scenes", "figures"] {
        let mut files: Vec<_> =
            std::fs::read_dir(data.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "toml")) {
            let text = std::fs::read_to_string(file).unwrap();
            texts.push(text.replace("\"../", &format!("\"{}/", data.display())));
        }
    }
    assert!(texts.len() >= 9, "{}", texts.len());
    texts
}

/// Ranges of numbers, outside comments, texts and names.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let (mut in_text, mut in_comment, mut start) = (false, false, None);
    let mut before = ' ';
    for (at, letter) in text.char_indices().chain([(text.len(), '\n')]) {
        let is_part = letter.is_ascii_alphanumeric() || "+-._".contains(letter);
        match letter {
            '\n' => (in_text, in_comment) = (false, false),
            '"' if !in_comment => in_text = !in_text,
            '#' if !in_text => in_comment = true,
            _ => {}
        }
        if let Some(first) = start.filter(|_| !is_part) {
            if text[first..at].parse::<f64>().is_ok() {
                found.push(first..at);
            }
            start = None;
        } else if start.is_none() && is_part && !in_text && !in_comment && " =[,{".contains(before) {
            start = Some(at);
        }
        before = letter;
    }
    found
}

fn changed(random: &mut Random, old: &str) -> String {
    const ODD: [&str; 24] = [
        "0",
        "0.0",
        "-0.0",
        "1",
        "-1",
        "1e-5",
        "1e5",
        "1e-12",
        "1e9",
        "-1e9",
        "1e-18",
        "1e18",
        "1e38",
        "1e-38",
        "1e-300",
        "1e300",
        "-1e300",
        "inf",
        "-inf",
        "nan",
        "255",
        "65536",
        "9223372036854775807",
        "180.0",
    ];
    let value: f64 = old.parse().unwrap();
    match random.below(4) {
        0 => random.pick(&ODD).to_owned(),
        1 => format!("{:?}", value * random.size(1e-6, 1e6)),
        2 => format!("{:?}", -value),
        _ => format!("{:?}", value * (1.0 + random.within(-1e-9, 1e-9))),
    }
}

fn mutated(random: &mut Random, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        let places = numbers(&text);
        let place = places[random.below(places.len())].clone();
        let new = changed(random, &text[place.clone()]);
        text.replace_range(place, &new);
    }
    text
}

#[test]
fn numbers_are_found() {
    let text = "a1 = [1.5, -2e3]  # 7\nb = { c = \"8\", d = 9 }\n[[x]]\n";
    let found: Vec<&str> = numbers(text).into_iter().map(|place| &text[place]).collect();
    assert_eq!(found, ["1.5", "-2e3", "9"]);
}

#[test]
fn scenes_with_other_numbers_are_refused_or_traced() {
    let asked = std::env::var("GLUMBRA_MUTATIONS").ok().map(|count| count.parse::<usize>().unwrap());
    let texts = scenes();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let mut random = Random::new(1992);
    let (mut refused, mut traced, mut slowest) = (0, 0, (Duration::ZERO, String::new()));
    for _ in 0..asked.unwrap_or(FEW) {
        let base = random.below(texts.len());
        let text = mutated(&mut random, &texts[base]);
        std::fs::write(&path, &text).unwrap();
        let start = Instant::now();
        match glumbra::load(&path, &[format!("image.size={SIZE:?}")]) {
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
            }
            Ok(loaded) => {
                // Of a scene that loads only lights that exclude each other cannot be planned, or what no driver draws.
                match plan::make(&loaded.scene, &Request::default()) {
                    Ok(plan) => drop(plan.summary().to_string()),
                    Err(Error::Composition(_) | Error::TooManyCuts { .. } | Error::TooLarge { .. }) => {}
                    Err(error) => panic!("{error}\n{text}"),
                }
                for light in 0..loaded.scene.lights.len() {
                    if let Ok(truth) = truth::trace(&loaded.scene, light, &truth::Options::default()) {
                        assert_eq!([truth.width, truth.height], SIZE, "{text}");
                        traced += 1;
                    }
                }
            }
        }
        let taken = start.elapsed();
        // Of a few in a build for tests, on a busy machine, time says nothing.
        assert!(asked.is_none() || taken < LONGEST, "{taken:?}:\n{text}");
        if taken > slowest.0 {
            slowest = (taken, text);
        }
    }
    println!("{refused} refused, {traced} lights traced; the slowest took {:?}:\n{}", slowest.0, slowest.1);
    assert!(refused > 10 && traced > 10, "{refused} refused, {traced} traced: the changes are too wild or too tame");
}
