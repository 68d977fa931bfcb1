//! The sheets of `glumbra figures` themselves: their letters, panels of any scale, and that panels which explain something
//! show it, measured by the ray tracer.

use std::process::Command;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::figures::{FIGURES, Figure, Letters, Panel, PanelStage, Share};
use glumbra::frame::Renderer;
use glumbra::output::{self, canvas::Canvas};
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::Scene;

fn figure(name: &str) -> &'static Figure {
    FIGURES.iter().find(|figure| figure.name == name).unwrap()
}

/// Every text of a figure that is written on its sheet.
fn texts(figure: &'static Figure) -> Vec<&'static str> {
    let mut texts = vec![figure.title, figure.source, figure.caption];
    for panel in figure.panels {
        texts.extend([panel.title, panel.note]);
        match panel.stage {
            Some(PanelStage::Cut(cut)) => {
                texts.push(cut.behind);
                texts.extend(cut.lines.iter().map(|line| line.name));
            }
            Some(PanelStage::Sweep(sweep)) => texts.push(sweep.label),
            Some(PanelStage::Profile(lines)) => texts.extend(lines.iter().map(|line| line.name)),
            _ => {}
        }
    }
    texts
}

#[test]
fn the_fonts_hold_every_letter() {
    let letters = Letters::load().unwrap();
    for figure in FIGURES {
        for text in texts(figure) {
            assert_eq!(letters.missing(text), [], "{}: {text}", figure.name);
        }
    }
    // Numbers that are measured, ticks of axes, diagrams.
    assert_eq!(letters.missing("0123456789.% −⁰¹²³⁴⁵⁶⁷⁸⁹ °φσ×²≤≥√ (xˡ / wˡ)"), []);
    assert_eq!(letters.missing("a漢b"), ['漢'], "what the fonts lack is found");
}

fn renderer() -> Renderer {
    Renderer::new(&context::open(&ContextRequest::default()).unwrap())
}

/// A panel's picture of a scene, drawn without the figures' own code.
fn drawn(scene: &Scene, panel: &Panel, renderer: &mut Renderer) -> Canvas {
    let views = panel.view.map(|view| ViewRequest { view, light: 0 }).into_iter().collect();
    let mut plan = renderer.plan(scene, &Request { views, ..Request::default() }).unwrap();
    if let Some(PanelStage::After(pass)) = panel.stage {
        plan = plan.after_pass(pass).unwrap();
    }
    renderer.draw(&plan).unwrap();
    let frame = renderer.read(&plan).unwrap();
    output::to_canvas(frame.views.first().unwrap_or(&frame.picture), panel.view)
}

/// A panel at twice the scale is its scene with twice the pixels a side, to the bit; not an enlarged panel.
#[test]
fn a_larger_panel_is_drawn_larger() {
    let mut renderer = renderer();
    for (name, index) in [("hsm-title", 1), ("segal-3-slide", 4), ("gdc-volumes", 1)] {
        let panel = &figure(name).panels[index];
        let small = figure(name).picture(panel, 1, &mut renderer).unwrap();
        let large = figure(name).picture(panel, 2, &mut renderer).unwrap();
        let mut scene = figure(name).scene_of(panel).unwrap();
        assert!(small == drawn(&scene, panel, &mut renderer), "{name}, scale 1");
        scene.image.size = scene.image.size.map(|side| 2 * side);
        assert!(large == drawn(&scene, panel, &mut renderer), "{name}, scale 2");
        assert!(large != small.fitted(large.size()), "{name}: enlarged");
    }
    // A map that has as many texels as the picture pixels has so at each scale: what a pixel shows of it stays the same.
    let dueling = figure("hsm-6-dueling-frusta");
    let density = |scale: u32, renderer: &mut Renderer| {
        let panel = &dueling.panels[1];
        let scene = dueling.scene_at(panel, scale).unwrap();
        let views = vec![ViewRequest { view: panel.view.unwrap(), light: 0 }];
        let plan = renderer.plan(&scene, &Request { views, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let Pixels::RgbaF32 { size, data } = renderer.read(&plan).unwrap().views.remove(0) else { panic!() };
        assert_eq!(size, [300 * scale; 2]);
        let seen: Vec<f32> = data.chunks_exact(4).filter(|pixel| pixel[3] > 0.0).map(|pixel| pixel[0]).collect();
        f64::from(seen.iter().sum::<f32>()) / seen.len() as f64
    };
    let [one, two] = [1, 2].map(|scale| density(scale, &mut renderer));
    assert!((one / two - 1.0).abs() < 0.02, "{one} and {two} texels a pixel");
}

#[test]
fn a_sheet_grows_with_its_scale() {
    let mut renderer = renderer();
    for name in ["lec-dimming", "segal-1-geometry"] {
        let [one, two] = [1, 2].map(|scale| figure(name).draw(scale, &mut renderer, || {}).unwrap());
        assert_eq!(two.size(), one.size().map(|side| 2 * side), "{name}");
        // Text is drawn larger, too: ink of the paper's upper edge, where title and source stand.
        let ink = |sheet: &Canvas, scale: usize| {
            let row = 3 * sheet.size()[0] as usize;
            sheet.bytes()[..80 * scale * row].chunks_exact(3).filter(|pixel| pixel[0] < 128).count()
        };
        let (small, large) = (ink(&one, 1), ink(&two, 2));
        assert!(small > 300 && (3.2..4.8).contains(&(large as f64 / small as f64)), "{name}: {small}, {large}");
    }
}

fn shares(name: &str, panels: &[usize], renderer: &mut Renderer) -> Vec<Share> {
    let wrong = |panel: &usize| figure(name).wrong(&figure(name).panels[*panel], renderer).unwrap();
    let shares: Vec<Share> = panels.iter().map(wrong).collect();
    println!("{name}: {shares:?}");
    shares
}

/// Captions of offsets hold: without one acne, with a small constant some on steep surfaces, with a large one a leak
/// at contacts, by slope least of all.
#[test]
fn offsets_do_what_their_sheet_says() {
    let mut renderer = renderer();
    let all = shares("hsm-3-offset", &[0, 1, 2, 3], &mut renderer);
    let [none, small, large, slope] = all[..] else { panic!() };
    assert!(none.false_shadow > 20.0, "{none:?}");
    assert!(small.false_shadow > 3.0 * slope.false_shadow && small.false_shadow < 0.2 * none.false_shadow, "{small:?}");
    assert!(large.leak > 3.0 * slope.leak, "{large:?}");
    assert!([none, small, large].iter().all(|other| slope.wrong() < other.wrong()), "{slope:?}");
    let swept = shares("hsm-bias-sweep", &[1, 3], &mut renderer);
    assert!(swept[1].wrong() < swept[0].wrong(), "the best constant is worse than a slope's offset");
}

/// Woo's midpoints and back faces have no acne; back faces leak at ledges, where midpoints do not.
#[test]
fn layers_do_what_their_sheets_say() {
    let mut renderer = renderer();
    let all = shares("hsm-second-depth", &[0, 1, 3, 4], &mut renderer);
    let [nearest, backs, ledge, midpoint] = all[..] else { panic!() };
    assert!(nearest.false_shadow > 20.0 && backs.false_shadow < 1.0, "{nearest:?} {backs:?}");
    assert!(ledge.leak > midpoint.leak, "{ledge:?} {midpoint:?}");
    let woo = shares("hsm-woo-layers", &[0, 2], &mut renderer);
    assert!(woo[0].wrong() < 0.05 * woo[1].wrong(), "{woo:?}");
}

/// Share of the pixels in which two pictures differ by more than 24 codes.
fn differing(one: &Canvas, other: &Canvas) -> f64 {
    let pairs = one.bytes().chunks_exact(3).zip(other.bytes().chunks_exact(3));
    let differ = pairs.filter(|(a, b)| (0..3).any(|k| a[k].abs_diff(b[k]) > 24)).count();
    differ as f64 / (one.bytes().len() / 3) as f64
}

/// The ray tracer's picture is that of stencil shadow volumes, which have no texels, but for edges; pictures by maps differ
/// from it by what is wrong with them.
#[test]
fn the_picture_of_truth_is_the_truth() {
    let mut renderer = renderer();
    let sheet = figure("hsm-3-offset");
    let truth = sheet.picture(&sheet.panels[4], 1, &mut renderer).unwrap();
    let volumes = Panel { stage: None, set: &["light.shadow.technique=shadow-volume"], ..sheet.panels[4] };
    let mut from_truth = |panel: &Panel| differing(&truth, &sheet.picture(panel, 1, &mut renderer).unwrap());
    let (volumes, none, slope) = (from_truth(&volumes), from_truth(&sheet.panels[0]), from_truth(&sheet.panels[3]));
    println!("volumes {volumes:.5}, no offset {none:.4}, by slope {slope:.4}");
    assert!(volumes < 0.001 && slope < 0.02 && none > 0.1, "{volumes} {slope} {none}");
}

/// For a projected image far away, filters with mipmaps come nearest to the mean of many samples.
#[test]
fn mipmaps_come_nearest_to_many_samples() {
    let mut renderer = renderer();
    let sheet = figure("lec-mipmaps");
    let mut picture = |index: usize| sheet.picture(&sheet.panels[index], 1, &mut renderer).unwrap();
    let [nearest, linear, trilinear, fine] = [0, 1, 2, 3].map(&mut picture);
    // The upper half of the floor, where pixels cover several texels.
    let off = |one: &Canvas| {
        let rows = 3 * 400 * 80..3 * 400 * 130;
        let squares =
            one.bytes()[rows.clone()].iter().zip(&fine.bytes()[rows]).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
        (squares.sum::<f64>() / f64::from(3 * 400 * 50)).sqrt()
    };
    let [nearest, linear, trilinear] = [nearest, linear, trilinear].map(|picture| off(&picture));
    println!("nearest {nearest:.1}, linear {linear:.1}, trilinear {trilinear:.1} codes");
    assert!(trilinear < 0.8 * linear && linear < nearest, "{nearest} {linear} {trilinear}");
}

/// Larger kernels have wider ramps: more pixels between light and shadow.
#[test]
fn larger_kernels_have_wider_ramps() {
    let mut renderer = renderer();
    let sheet = figure("lec-kernels");
    let ramps: Vec<usize> = [0, 1, 2, 4, 5]
        .iter()
        .map(|index| {
            let scene = sheet.scene_of(&sheet.panels[*index]).unwrap();
            let shade = glumbra::frame::draw_shade(&scene, 0, &mut renderer).unwrap();
            shade
                .shade
                .iter()
                .zip(&shade.covered)
                .filter(|(shade, covered)| **covered && **shade > 0.01 && **shade < 0.99)
                .count()
        })
        .collect();
    println!("{ramps:?}");
    assert!(ramps[0] == 0 && ramps.windows(2).all(|pair| pair[1] as f64 > 1.2 * pair[0] as f64), "{ramps:?}");
}

#[test]
fn the_command_takes_a_scale() {
    let folder = tempfile::tempdir().unwrap();
    let run = |scale: &str| {
        let out = folder.path().join(scale);
        let arguments = ["figures", "--only", "segal-1-geometry", "--scale", scale, "-o", out.to_str().unwrap()];
        Command::new(env!("CARGO_BIN_EXE_glumbra")).args(arguments).output().unwrap()
    };
    for scale in ["1", "3"] {
        let done = run(scale);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    }
    let size = |scale: &str| image::image_dimensions(folder.path().join(scale).join("segal-1-geometry.png")).unwrap();
    let (one, three) = (size("1"), size("3"));
    assert_eq!(three, (3 * one.0, 3 * one.1));
    for scale in ["0", "5", "two"] {
        let refused = run(scale);
        let message = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(!refused.status.success() && message.contains("--scale"), "{scale}: {message}");
        assert!(!folder.path().join(scale).exists(), "{scale}: nothing is made");
    }
}
