//! Scenes against truth: the named extreme cases and random ones have no picture that is silently wrong, and a renderer
//! that is broken on purpose has.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::scene::{LightKind, Scene};
use glumbra::stress::{
    self, Case, CaseResult, CaseRow, RowJudge, RowSettings, StressOptions, Verdict, named, random, tally,
};

/// A seed that no development went by.
const SEED: u64 = 20_261_127;

/// A fifth of the changed settings, others in each case: every one is drawn in some thirty named cases. `GLUMBRA_STRESS=all`
/// draws all of them, as `glumbra stress` does.
fn share() -> usize {
    if std::env::var("GLUMBRA_STRESS").is_ok_and(|share| share == "all") { 1 } else { 5 }
}

fn options() -> StressOptions {
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    StressOptions { jobs, technique: None, one_in: share(), pictures: false, context: ContextRequest::default() }
}

fn run(cases: &[Case]) -> Vec<CaseResult> {
    let mut results = Vec::new();
    stress::run(cases, &options(), &Arc::new(AtomicBool::new(false)), |_, result| results.push(result)).unwrap();
    assert_eq!(results.len(), cases.len());
    println!("{}", stress::to_text(&results, 160));
    results
}

/// Lists what fails, with what it takes to see it.
fn failures(results: &[CaseResult]) -> Vec<String> {
    let of = |result: &CaseResult| {
        let rows = result.rows.iter().filter(|row| row.verdict == Verdict::SilentlyWrong);
        let lines = rows.map(|row| {
            let (inside, wrong) = (row.settings.to_inline(), row.wrong_percent());
            format!(
                "{}, light {}: {inside}: {wrong:.3} %, {} beyond the bound {}",
                result.name, row.light, row.beyond, row.why
            )
        });
        let misjudged = result.is_misjudged().then(|| format!("{}: refused: {:?}", result.name, result.refused));
        lines.chain(misjudged).collect::<Vec<_>>()
    };
    results.iter().flat_map(of).collect()
}

#[test]
fn no_named_case_is_silently_wrong() {
    let cases = named::cases().unwrap();
    assert!(cases.len() >= 60);
    let results = run(&cases);
    let failures = failures(&results);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// 200 small pictures; and warnings are for pictures that are wrong.
#[test]
fn random_scenes_are_right_or_warned_of() {
    let small = |index| {
        let mut case = random::case(SEED, index);
        case.toml = case.toml.replace("size = [160, 120]", "size = [80, 60]");
        case
    };
    let results = run(&(0..200).map(small).collect::<Vec<_>>());
    let failures = failures(&results).join("\n");
    assert!(failures.is_empty(), "{failures}");
    let rows: Vec<&CaseRow> = results.iter().flat_map(|result| &result.rows).collect();
    let [_, alarms, ..] = tally(rows.iter().copied());
    assert!(50 * alarms <= rows.len(), "{alarms} false alarms in {} rows: more than 2 %", rows.len());
    let defaults: Vec<&&CaseRow> = rows.iter().filter(|row| row.settings.is_default()).collect();
    let unusable = defaults.iter().filter(|row| row.is_unusable()).count();
    assert!(20 * unusable <= defaults.len(), "{unusable} of {} default rows warned or refused", defaults.len());
}

/// The same random scene by itself and from a context that has drawn others: nothing is left over from the scene before.
#[test]
fn a_scene_is_judged_alike_whatever_was_drawn_before() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let case = random::case(SEED, 3);
    let once = stress::draw_case(&case, &options(), &mut renderer).rows;
    for index in 0..5 {
        stress::draw_case(&random::case(SEED, index), &options(), &mut renderer);
    }
    assert_eq!(stress::draw_case(&case, &options(), &mut renderer).rows, once);
}

/// Draws `broken`'s picture and holds it against the truth of the named case.
fn judged(name: &str, inside: [&str; 2], broken: impl Fn(&mut Scene)) -> Verdict {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let case = named::cases().unwrap().into_iter().find(|case| case.name == name).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let scene = case.load(folder.path()).unwrap().scene;
    let mut drawn = scene.clone();
    broken(&mut drawn);
    let [technique, keys] = inside.map(str::to_owned);
    let settings = RowSettings { technique, keys, pictured: false };
    RowJudge::new(&scene, 0).unwrap().row_of(&drawn, &settings, &mut renderer).row.verdict
}

/// A case that is right as it is.
const PLAIN: &str = "coplanar-faces";

#[test]
fn a_scene_that_is_drawn_as_it_is_is_right() {
    for technique in ["shadow-map", "midpoint", "shadow-volume"] {
        assert_eq!(judged(PLAIN, [technique, ""], |_| {}), Verdict::Right, "{technique}");
    }
}

#[test]
fn what_is_broken_on_purpose_is_seen() {
    let bias = ["shadow-map", "offset = { factor = -2.0, units = -4.0 }"];
    assert_eq!(judged(PLAIN, bias, |_| {}), Verdict::Warned, "a bias of the wrong sign, which the plan foresees");
    let none = ["shadow-map", "offset = { factor = 0.0, units = 0.0 }"];
    assert_eq!(judged(PLAIN, none, |_| {}), Verdict::Warned, "no bias, likewise");
    let far = ["shadow-map", "r = { scale = 0.5, bias = 0.4 }"];
    assert_eq!(judged(PLAIN, far, |_| {}), Verdict::SilentlyWrong, "a bias that leaks");
    for technique in ["shadow-map", "midpoint", "shadow-volume"] {
        let seen = |broken: &dyn Fn(&mut Scene)| judged(PLAIN, [technique, ""], broken);
        let fov = seen(&|scene| scene.camera.fov_y_radians += 1_f64.to_radians());
        assert_eq!(fov, Verdict::SilentlyWrong, "{technique}: a field of view that is 1 degree wider");
        let axis = seen(&|scene| turn(scene, |way| DVec3::new(way.z, way.y, way.x)));
        assert_eq!(axis, Verdict::SilentlyWrong, "{technique}: axes of the light swapped");
        let turned = seen(&|scene| turn(scene, |way| (way + 0.02 * DVec3::X).normalize()));
        assert_eq!(turned, Verdict::SilentlyWrong, "{technique}: a sun that stands a degree aside");
        let lost = seen(&|scene| scene.objects[1].casts_shadow = false);
        assert_eq!(lost, Verdict::SilentlyWrong, "{technique}: a caster left out");
        let gone = seen(&|scene| scene.objects.truncate(1));
        assert_eq!(gone, Verdict::SilentlyWrong, "{technique}: an object left out");
    }
}

/// Draws the first light of a random scene, each time with other keys, and says that nothing is beyond the bound.
fn assert_right(seed: u64, index: u64, technique: &str, keys: &[&str]) {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let folder = tempfile::tempdir().unwrap();
    let scene = random::case(seed, index).load(folder.path()).unwrap().scene;
    let mut judge = RowJudge::new(&scene, 0).unwrap();
    for &keys in keys {
        let settings = RowSettings { technique: technique.to_owned(), keys: keys.to_owned(), pictured: false };
        let row = judge.row(&settings, &mut renderer).row;
        assert_eq!((row.verdict, row.beyond), (Verdict::Right, 0), "{keys}");
    }
}

/// Both faces of one plane, of which neither lies behind the other, on a slope of more than 80 degrees to the light: its depth
/// is rounded by what it falls by across the whole map.
#[test]
fn steep_faces_in_one_plane_do_not_shade_each_other() {
    let keys = ["", "compare = \"gequal\"", "peel = \"compare\"", "format = \"depth32f\""];
    assert_right(SEED, 59, "midpoint", &keys);
}

/// A steep side far behind in the box of a sun, before a floor beyond the box: its offset is as deep as what is left of the
/// box.
/// Sides of volumes that the eye sees edge-on: the ray tracer calls the one or two samples that they cover uncertain.
#[test]
fn sides_seen_edge_on_are_in_doubt() {
    let keys = "method = \"z-fail-truncated\"";
    assert_right(1, 657, "shadow-volume", &[keys]);
    assert_right(5, 40, "shadow-volume", &[keys]);
}

/// A facet that the camera sees within 2 degrees: one pixel of it is dark, of the rounding of r and q in their interpolation.
#[test]
fn the_rounding_of_steep_interpolation_is_told() {
    let settings = RowSettings { technique: "shadow-map".into(), keys: String::new(), pictured: false };
    let folder = tempfile::tempdir().unwrap();
    let scene = random::case(1, 304).load(folder.path()).unwrap().scene;
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let row = RowJudge::new(&scene, 1).unwrap().row(&settings, &mut renderer).row;
    // Another driver may interpolate otherwise, and have no wrong pixel.
    assert!(matches!(row.verdict, Verdict::Warned | Verdict::FalseAlarm), "{row:?}");
}

#[test]
fn no_offset_lets_light_through_to_what_lies_behind_the_map() {
    let keys = ["size = 256", "size = 256, compare = \"gequal\"", "size = 256, format = \"depth32f\""];
    assert_right(5, 87, "shadow-map", &keys);
}

/// A box's side that the eye sees edge-on, a tenth of a degree above its plane: the pixel beside lies past its horizon.
#[test]
fn a_normal_offset_has_its_normal_next_to_the_horizon_too() {
    assert_right(32, 78, "shadow-map", &["bias = \"normal-offset\"", "bias = \"normal-offset\", kernel = \"5x5\""]);
}

/// Rows that were silently wrong, each by another term that a warning or the bound lacked.
#[test]
fn rows_that_were_silently_wrong_are_not() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let rows = [
        // One unit of polygon offset is two codes of 16 bits; a share of few points is uncertain.
        ((31337, 177), 0, "shadow-map", "format = \"depth16\"", false),
        // Interpolation is rounded several times on the way from the window's origin.
        ((31337, 179), 1, "shadow-map", "", false),
        // A gap is measured along the ray, and the bias along the axis of a cube's face.
        ((888, 261), 0, "shadow-map", "kernel = \"3x3\"", false),
        // A filtered shade next to one half, of a far side that is lit.
        ((20001, 776), 0, "second-depth", "closed = \"assume\"", false),
        // Texels that are longer than wide.
        ((20001, 1029), 0, "shadow-map", "fit = \"view\"", false),
        // Light of less than half a code.
        ((20001, 957), 1, "shadow-volume", "", true),
    ];
    for ((seed, index), light, technique, keys, pictured) in rows {
        let folder = tempfile::tempdir().unwrap();
        let scene = random::case(seed, index).load(folder.path()).unwrap().scene;
        let settings = RowSettings { technique: technique.into(), keys: keys.into(), pictured };
        let row = RowJudge::new(&scene, light).unwrap().row(&settings, &mut renderer).row;
        assert_ne!(row.verdict, Verdict::SilentlyWrong, "random-{seed}-{index}: {row:?}");
    }
}

fn turn(scene: &mut Scene, way: impl Fn(DVec3) -> DVec3) {
    if let LightKind::Directional { direction } = &mut scene.lights[0].kind {
        *direction = way(*direction);
    }
}

/// A failing scene is made small and still fails.
#[test]
fn what_fails_is_reduced_to_a_scene_that_still_fails() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    // A scene with several objects, and a lamp that has no map of its own to hide the fault.
    let several = |case: &Case| case.toml.matches("[[object]]").count() > 3 && case.toml.contains("\"directional\"");
    let case = (0..50).map(|index| random::case(SEED, index)).find(several).unwrap();
    // A scale of r, which no plan foresees.
    let inside = "technique = \"shadow-map\", r = { scale = 0.5, bias = 0.4 }";
    let reduced = stress::reduce(&case, inside, &options(), &mut renderer).expect("such a bias leaks");
    let objects = |toml: &str| toml.matches("[[object]]").count();
    assert!(objects(&reduced.toml) < objects(&case.toml), "{}", reduced.toml);
    assert!(reduced.toml.contains("r = { scale = 0.5, bias = 0.4 }"), "{}", reduced.toml);
    let again = stress::draw_case(&reduced, &options(), &mut renderer);
    assert!(again.fails(), "{}", reduced.toml);
}

/// Random scenes of beams, slide projectors, alpha shadows, lenses and dust, by their colours.
#[test]
fn random_projected_light_is_right_or_warned_of() {
    let small = |index| {
        let mut case = stress::projected::case(SEED, index);
        case.toml = case.toml.replace("size = [160, 120]", "size = [80, 60]");
        case.shades = false;
        case
    };
    let results = run(&(0..72).map(small).collect::<Vec<_>>());
    let failures = failures(&results).join("\n");
    assert!(failures.is_empty(), "{failures}");
    let rows: Vec<&CaseRow> = results.iter().flat_map(|result| &result.rows).collect();
    let [right, alarms, _, refused, _] = tally(rows.iter().copied());
    assert!(rows.len() > 150 && right * 10 > rows.len() * 8, "{right} of {} are right", rows.len());
    // Beams whose maps cannot be fine enough, and coarse shadows, are warned of where hardly a pixel shows it, or where what
    // they fall on shows a photograph.
    assert!(alarms * 6 <= rows.len() && refused * 20 <= rows.len(), "{alarms} and {refused} of {}", rows.len());
}

/// A picture of projected light that was drawn otherwise: every kind of row says so.
#[test]
fn projected_light_that_is_broken_on_purpose_is_seen() {
    type Change = fn(&mut Scene);
    let focus: Change = |scene| change_spot(scene, |spot| spot.focus.as_mut().unwrap().radius *= 2.0);
    let dust: Change = |scene| scene.lights[0].dust.as_mut().unwrap().density *= 1.3;
    let turned: Change = |scene| change_spot(scene, |spot| spot.frustum.up = DVec3::new(0.1, 1.0, 0.1).normalize());
    let dimmed: Change = |scene| scene.lights[5].diffuse = [0.0; 3];
    let unshadowed: Change = |scene| scene.objects.iter_mut().for_each(|object| object.casts_shadow = false);
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for (name, change, wrong) in [
        ("projected-slide", turned, [true, true, false]),
        ("projected-beam-cone-6e1", turned, [true, false, false]),
        ("projected-lens-radius-1e0", focus, [true, true, true]),
        ("projected-dust-2e-1", dust, [true, true, true]),
        ("projected-dust-2e-1", unshadowed, [false, false, true]),
        ("projected-lens-radius-1e0", unshadowed, [false, false, true]),
        ("projected-alpha", dimmed, [true, true, true]),
    ] {
        let case = named::cases().unwrap().into_iter().find(|case| case.name == name).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let scene = case.load(folder.path()).unwrap().scene;
        let mut drawn = scene.clone();
        change(&mut drawn);
        let (rows, known) = stress::color_rows_of(&scene, &drawn, &mut renderer);
        assert!(known > 0.9, "{name}: {known}");
        for (row, wrong) in rows.iter().zip(wrong) {
            let is_wrong = row.verdict == Verdict::SilentlyWrong;
            assert_eq!(is_wrong, wrong, "{name}: {row:?}");
        }
        let (rows, _) = stress::color_rows(&scene, &mut renderer);
        assert!(rows.iter().all(|row| row.verdict == Verdict::Right), "{name}: {rows:?}");
    }
}

fn change_spot(scene: &mut Scene, change: impl Fn(&mut glumbra::scene::Spot)) {
    if let LightKind::Spot(spot) = &mut scene.lights[0].kind {
        change(spot);
    }
}
