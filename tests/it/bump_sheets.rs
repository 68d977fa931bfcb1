//! The sheets of bump mapping: what is right in them is right, what is wrong on purpose differs from it, and the numbers below
//! panels are measured.

use glumbra::context::{self, ContextRequest};
use glumbra::figures::{Apart, FIGURES, Figure, Panel, SceneChange};
use glumbra::frame::Renderer;
use glumbra::output::canvas::Canvas;

fn figure(name: &str) -> &'static Figure {
    FIGURES.iter().find(|figure| figure.name == name).unwrap()
}

fn renderer() -> Renderer {
    Renderer::new(&context::open(&ContextRequest::default()).unwrap())
}

fn picture(name: &str, panel: usize, renderer: &mut Renderer) -> Canvas {
    figure(name).picture(&figure(name).panels[panel], 1, renderer).unwrap()
}

fn numbers(name: &str, panel: usize, renderer: &mut Renderer) -> String {
    figure(name).numbers(&figure(name).panels[panel], renderer).unwrap().unwrap()
}

fn apart(name: &str, [one, other]: [usize; 2], renderer: &mut Renderer) -> Apart {
    let apart = Apart::of(&picture(name, one, renderer), &picture(name, other, renderer));
    println!("{name}, {one} and {other}: {apart:?}");
    apart
}

/// Root mean square of two pictures' differences in codes, over columns from `from` to `to`, shares of the width.
fn off(one: &Canvas, other: &Canvas, [from, to]: [f64; 2]) -> f64 {
    let width = one.size()[0] as usize;
    let columns = (from * width as f64) as usize..(to * width as f64) as usize;
    let pairs = one.bytes().chunks_exact(3).zip(other.bytes().chunks_exact(3)).enumerate();
    let inside: Vec<f64> = pairs
        .filter(|(index, _)| columns.contains(&(index % width)))
        .flat_map(|(_, (a, b))| (0..3).map(|k| f64::from(a[k].abs_diff(b[k])).powi(2)))
        .collect();
    (inside.iter().sum::<f64>() / inside.len() as f64).sqrt()
}

const ALL: [&str; 14] = [
    "gdc-bump-passes",
    "gdc-bump-vectors",
    "gdc-bump-torus",
    "gdc-gloss",
    "gdc-pre-lit",
    "gdc-key-frames",
    "gdc-knight-room",
    "gdc-mirrored-skin",
    "mip-dimming",
    "gdc-normalisation-cube",
    "gdc-nine-bits",
    "gdc-self-shadow",
    "gdc-repacked-skin",
    "gdc-height-differences",
];

/// Every sheet draws, every panel shows something, and the title of a panel that is wrong on purpose says so.
#[test]
fn every_sheet_of_bumps_draws() {
    let mut renderer = renderer();
    for name in ALL {
        let mut panels = 0;
        let sheet = figure(name).draw(1, &mut renderer, || panels += 1).unwrap();
        assert_eq!(panels, figure(name).panels.len());
        assert!(sheet.size()[0] >= 850 && sheet.size()[1] > 600, "{name}: {:?}", sheet.size());
        for (index, panel) in figure(name).panels.iter().enumerate() {
            let is_wrong = matches!(
                panel.change,
                Some(
                    SceneChange::TangentsTurned
                        | SceneChange::NormalsInwards
                        | SceneChange::Undimmed
                        | SceneChange::DimmedTwice
                        | SceneChange::Careless { repacked: false }
                )
            );
            assert!(!is_wrong || panel.title.contains("wrong on purpose"), "{name}, panel {index}");
            let picture = picture(name, index, &mut renderer);
            let mut colors: Vec<&[u8]> = picture.bytes().chunks_exact(3).collect();
            colors.sort_unstable();
            colors.dedup();
            // A light below the plate: ambient light alone, and the background.
            let least = if (name, index) == ("gdc-self-shadow", 2) { 1 } else { 3 };
            assert!(colors.len() >= least, "{name}, panel {index}: {} colours", colors.len());
        }
    }
}

/// Where nothing stops at 1, three passes are one pass to two codes; in a bright light they are not.
#[test]
fn three_passes_are_one_pass_until_light_stops_at_one() {
    let mut renderer = renderer();
    let name = "gdc-bump-passes";
    let same = apart(name, [5, 6], &mut renderer);
    let bright = apart(name, [8, 9], &mut renderer);
    assert!(same.most <= 2, "{same:?}");
    assert!(bright.most > 10 && bright.percent > 1.0, "{bright:?}");
    // The sum is what pass 2 left and the highlights times the gloss: two codes of rounding each.
    let [after, gloss, shine, sum] = [3, 2, 4, 5].map(|panel| picture(name, panel, &mut renderer));
    let mut worst = 0.0_f64;
    for (index, code) in sum.bytes().iter().enumerate() {
        let code_of = |picture: &Canvas| f64::from(picture.bytes()[index]);
        let expected = (code_of(&after) + code_of(&shine) * code_of(&gloss) / 255.0).min(255.0);
        // The shadow of the light is in the sum, not in the view: the sum may be darker there.
        worst = worst.max(f64::from(*code) - expected);
    }
    assert!(worst < 2.0, "{worst}");
}

/// Highlights with a gloss map are those without it times the map.
#[test]
fn gloss_multiplies_highlights() {
    let mut renderer = renderer();
    let [gloss, plain, glossy] = [0, 1, 2].map(|panel| picture("gdc-gloss", panel, &mut renderer));
    let mut bright = 0;
    for ((gloss, plain), glossy) in gloss.bytes().iter().zip(plain.bytes()).zip(glossy.bytes()) {
        let expected = f64::from(*gloss) * f64::from(*plain) / 255.0;
        assert!((f64::from(*glossy) - expected).abs() <= 1.5, "{gloss} {plain} {glossy}");
        bright += u32::from(*plain > 60 && *gloss < 60);
    }
    assert!(bright > 500, "{bright} channels would shine without the map");
}

/// A correlation as it stands below a panel.
fn correlation(panel: usize, renderer: &mut Renderer) -> f64 {
    let words = numbers("gdc-pre-lit", panel, renderer);
    println!("{words}");
    words.rsplit(' ').next().unwrap().replace('−', "-").parse().unwrap()
}

#[test]
fn pre_lit_decals_follow_the_normals() {
    let mut renderer = renderer();
    let (plain, painted) = (correlation(0, &mut renderer), correlation(3, &mut renderer));
    assert!(plain.abs() < 0.2 && painted > 0.4, "{plain} {painted}");
    let twice = apart("gdc-pre-lit", [5, 2], &mut renderer);
    assert!(twice.most > 40 && twice.percent > 5.0, "{twice:?}");
}

/// On both halves the bump map is near the displaced surface; made wrong on purpose it is so on the right half alone.
#[test]
fn a_mirrored_skin_is_right_and_wrong_as_its_sheet_says() {
    let mut renderer = renderer();
    let name = "gdc-mirrored-skin";
    let truth = picture(name, 2, &mut renderer);
    let [right, turned, inwards] = [1, 3, 4].map(|panel| picture(name, panel, &mut renderer));
    let (left_half, right_half) = ([0.0, 0.48], [0.52, 1.0]);
    let errors = [&right, &turned, &inwards].map(|own| [off(own, &truth, left_half), off(own, &truth, right_half)]);
    println!("{errors:.1?}");
    // Studs that stand out are seen a little elsewhere: not of the same height, but of the same sense.
    assert!(errors[0][0] < 25.0 && errors[0][1] < 25.0, "{errors:?}");
    for wrong in &errors[1..] {
        assert!(wrong[0] > 2.0 * errors[0][0] && wrong[1] < 1.05 * errors[0][1] + 0.5, "{errors:?}");
    }
}

/// The share that a panel's mean brightness is off, in percent, as it stands below it.
fn brightness(panel: usize, renderer: &mut Renderer) -> f64 {
    let words = numbers("mip-dimming", panel, renderer);
    println!("{words}");
    let percent = words.split(", ").nth(1).unwrap().split(' ').next().unwrap();
    percent.replace('−', "-").parse().unwrap()
}

#[test]
fn dimming_brings_mipmaps_near_many_samples() {
    let mut renderer = renderer();
    let [unit, mean, undimmed, twice] = [1, 2, 3, 4].map(|panel| brightness(panel, &mut renderer));
    assert!(unit.abs() < 6.0 && (unit - mean).abs() < 1.0, "{unit} {mean}");
    assert!(undimmed > unit + 6.0 && twice < unit - 6.0, "{undimmed} {twice}");
}

#[test]
fn larger_cube_maps_are_nearer_to_exact() {
    let mut renderer = renderer();
    let name = "gdc-normalisation-cube";
    let exact = picture(name, 0, &mut renderer);
    let all = [1, 2, 3, 4].map(|panel| off(&picture(name, panel, &mut renderer), &exact, [0.0, 1.0]));
    println!("{all:.2?} codes");
    assert!(all[0] < 2.0 && all[1] < 3.0 && all[2] > 3.0 * all[1], "{all:?}");
    // A seam is a step between neighbours of one row.
    let step = |panel: usize, renderer: &mut Renderer| {
        let picture = picture(name, panel, renderer);
        let row = picture.bytes().chunks_exact(1200).nth(150).unwrap();
        row.chunks_exact(3).zip(row[3..].chunks_exact(3)).map(|(a, b)| a[1].abs_diff(b[1])).max().unwrap()
    };
    let (seamless, seams) = (step(3, &mut renderer), step(4, &mut renderer));
    assert!(seams > 3 * seamless.max(1), "{seamless} {seams}");
}

/// Nine bits are some codes off, and no more; their steps are larger than one.
#[test]
fn nine_bits_band() {
    let mut renderer = renderer();
    for pair in [[1, 0], [4, 3]] {
        let apart = apart("gdc-nine-bits", pair, &mut renderer);
        assert!((3..=6).contains(&apart.most), "{apart:?}");
    }
    let levels = |panel: usize, renderer: &mut Renderer| {
        let picture = picture("gdc-nine-bits", panel, renderer);
        let mut codes: Vec<u8> = picture.bytes().to_vec();
        codes.sort_unstable();
        codes.dedup();
        codes.len()
    };
    let (floats, bits) = (levels(3, &mut renderer), levels(4, &mut renderer));
    assert!(2 * bits < floats, "{bits} levels in place of {floats}");
}

#[test]
fn the_horizon_s_factor_is_what_its_sheet_says() {
    let mut renderer = renderer();
    let name = "gdc-self-shadow";
    assert_eq!(apart(name, [3, 0], &mut renderer).most, 0, "12 degrees above it is 1");
    assert!(apart(name, [4, 1], &mut renderer).most > 30);
    assert!(apart(name, [5, 2], &mut renderer).most > 60);
}

/// Packing mends what was turned at random; mirrored pieces have texels of their own; the picture stays.
#[test]
fn a_packed_skin_is_more_continuous() {
    let mut renderer = renderer();
    let words = numbers("gdc-repacked-skin", 6, &mut renderer);
    println!("{words}");
    let degrees: Vec<f64> = words
        .split(';')
        .next()
        .unwrap()
        .trim_start_matches("mean angle ")
        .split(", ")
        .map(|angle| angle.trim_end_matches('°').parse().unwrap())
        .collect();
    let [own, turned, packed, _] = degrees[..] else { panic!("{degrees:?}") };
    assert!(turned > own + 1.0 && packed < own + 0.6 * (turned - own), "{degrees:?}");
    assert!(words.contains(", 0.0 % of their length"), "{words}");
    // The maps are sampled in their new places: some texels' worth of difference, not another picture.
    let own = picture("gdc-gloss", 5, &mut renderer);
    let packed = picture("gdc-repacked-skin", 7, &mut renderer);
    let off = off(&own, &packed, [0.0, 1.0]);
    assert!(off < 8.0, "{off}");
}

#[test]
fn numbers_below_panels_are_measured() {
    let mut renderer = renderer();
    let heights = numbers("gdc-height-differences", 0, &mut renderer);
    assert!(heights.contains("forward 3.1°, 1.6°, 0.79°, 0.40°; central 0.59°, 0.15°, 0.038°,"), "{heights}");
    // Another scene in the same panel: another number.
    let sheet = figure("gdc-bump-passes");
    let same = sheet.numbers(&sheet.panels[6], &mut renderer).unwrap().unwrap();
    let other = Panel { set: &["shading.bump=one-pass", "light.0.diffuse=[0.3, 0.3, 0.3]"], ..sheet.panels[6] };
    let other = sheet.numbers(&other, &mut renderer).unwrap().unwrap();
    println!("{same}\n{other}");
    let codes = |words: &str| words.split(' ').find_map(|word| word.parse::<u32>().ok()).unwrap_or(0);
    assert!(codes(&same) <= 2 && codes(&other) > 20, "{same} / {other}");
}
