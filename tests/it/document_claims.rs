//! Claims of the documents that are about how shadows are drawn, as a report measures them on a small scene whose numbers are
//! known beforehand: two boxes over a floor, one in the other's shadow.

use std::sync::LazyLock;
use std::time::Instant;

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::report::measure::documents::{self, ClaimRequest, Further};
use glumbra::report::store::claim_sweep::ClaimSweep;
use glumbra::report::store::claimed::{ClaimVerdict, Claimed};
use glumbra::scene::Scene;
use glumbra::truth;

const NEAR: f64 = 0.5;
const FAR: f64 = 10.0;

const SCENE: &str = r#"
[image]
size = [160, 120]
[camera]
eye = [2.2, 2.6, 3.6]
target = [0.2, 0.4, 0.0]
fov_y = 40.0
near = 0.5
far = 10.0
[[light]]
kind = "spot"
position = [-1.8, 3.6, 1.4]
target = [0.2, 0.3, 0.0]
cone = 60.0
shape = "frustum"
near = 0.8
far = 12.0
[light.shadow]
technique = "shadow-map"
size = 512
[[object]]
mesh = "quad"
scale = [3.0, 1.0, 3.0]
[[object]]
mesh = "box"
scale = 0.4
translate = [0.0, 0.9, 0.1]
[[object]]
mesh = "box"
scale = 0.3
translate = [0.5, 0.5, -0.2]
"#;

fn measure(scene: &Scene) -> Further {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let truth = truth::trace(scene, 0, &truth::Options::default()).unwrap();
    let request = ClaimRequest { scene, light: 0, truth: &truth, quick: true };
    let mut last = Instant::now();
    let further = documents::measure(&request, &mut renderer, |what| {
        println!("{:.2} s, then {what}", last.elapsed().as_secs_f64());
        last = Instant::now();
    });
    further.claims.iter().for_each(|claim| println!("{claim}"));
    further
}

static MEASURED: LazyLock<Further> = LazyLock::new(|| measure(&scene_of(SCENE)));

fn claim(words: &str) -> &'static Claimed {
    let found: Vec<&Claimed> = MEASURED.claims.iter().filter(|claim| claim.says.contains(words)).collect();
    assert_eq!(found.len(), 1, "{words}");
    found[0]
}

fn sweep(name: &str) -> &'static ClaimSweep {
    MEASURED.sweeps.iter().find(|sweep| sweep.name == name).unwrap_or_else(|| panic!("no sweep {name}"))
}

#[test]
fn every_claim_is_measured() {
    for claim in &MEASURED.claims {
        assert_ne!(claim.verdict, ClaimVerdict::NotMeasured, "{claim}");
        assert!(claim.first.value.is_some() && claim.second.value.is_some(), "{claim}");
    }
    assert_eq!(MEASURED.claims.len(), 15);
    assert_eq!(MEASURED.sweeps.len(), 4);
}

/// A verdict on times follows from the range of their ratio.
#[test]
fn copies_from_another_precision_are_timed() {
    for (words, buffer) in
        [("into depth24, one from depth16", "depth16"), ("into depth16, one from depth24", "depth24")]
    {
        let claim = claim(words);
        assert!(claim.first.settings.ends_with(buffer) && !claim.second.settings.ends_with(buffer), "{claim:?}");
        let [least, greatest] = claim.ratio_range.unwrap();
        assert!(claim.second.value.unwrap() > 0.0 && least <= greatest, "{claim}");
        assert_eq!(claim.verdict == ClaimVerdict::Holds, least > 1.0, "{claim}");
    }
}

/// A plane falls away by its slope: four times as wide a texel needs four times the offset, and one half in the first level.
/// The mean of four depths at a silhouette belongs to no surface.
#[test]
fn a_smaller_level_needs_an_offset_as_wide_as_its_texels() {
    let offset = claim("needs more polygon offset");
    let [small, first] = [&offset.first, &offset.second].map(|side| side.value.unwrap());
    assert!((0.45..0.6).contains(&first) && (0.9..1.1).contains(&(small / first / 4.0)), "{offset}");
    assert!(sweep("offset of smaller levels").series[0].fit.contains("95 % range"));
    let averaged = claim("cannot be averaged");
    // Texels at an edge that any caster touches are dark, in place of about half of them.
    assert!(averaged.ratio().unwrap() > 1.2, "{averaged}");
    let wrong = &sweep("wrong points of smaller levels").series;
    assert_eq!(wrong[0].points[0].measured.value, wrong[1].points[0].measured.value, "the first level is the same");
}

/// Where one volume lies in another, two inverts undo each other; two counts do not.
#[test]
fn parity_is_wrong_where_volumes_intersect_and_fills_less() {
    let wrong = claim("an inverted bit is right only");
    assert!(wrong.first.value.unwrap() > 1.0 && wrong.second.value == Some(0.0), "{wrong}");
    let fills = claim("fills more than inverting");
    // Each face is drawn twice. llvmpipe does not count all fragments that change nothing.
    assert!(fills.ratio().is_some_and(|ratio| ratio > 1.1 && ratio <= 2.0), "{fills}");
    let costs = claim("costs more than inverting");
    assert!(costs.ratio_range.is_some(), "{costs}");
}

/// Depths before a finite far plane have f / (f - n) times the codes of those before one at infinity.
#[test]
fn a_far_plane_at_infinity_costs_what_its_projection_says() {
    let infinite = claim("at infinity costs hardly any");
    let expected = FAR / (FAR - NEAR);
    assert!((infinite.ratio().unwrap() / expected - 1.0).abs() < 1e-4, "{infinite}, expected {expected}");
    assert_eq!(claim("a far plane far away costs").verdict, ClaimVerdict::Holds);
    let points = &sweep("far planes").series[0].pairs();
    assert!(points.windows(2).all(|pair| pair[1][1] < pair[0][1]), "{points:?}");
    let cut = claim("cuts volumes");
    assert!(cut.first.value.unwrap() > 1.0 && cut.second.value == Some(0.0), "{cut}");
}

/// The closer the eye is to the light, the nearer are both grids to each other.
#[test]
fn shadows_are_worse_where_eye_and_light_face_each_other() {
    let wrong = claim("is more wrong where eye and light look towards");
    assert_eq!(wrong.verdict, ClaimVerdict::Holds, "{wrong}");
    let points = &sweep("dueling frusta").series[0].points;
    assert_eq!(points.iter().map(|point| point.x).collect::<Vec<_>>(), [0.0, 45.0, 90.0, 135.0, 180.0]);
    let at = |index: usize| points[index].measured.value.unwrap();
    assert!(at(3) > 1.5 * at(0), "{points:?}");
    // From below the floor nothing that is seen is lit.
    let below = &points[4].measured;
    assert!(below.value.is_none() && below.why.as_ref().is_some_and(|why| why.contains("too few")), "{below:?}");
}

/// Half of the rounded depths lie before the interpolated ones; in the buffer's own codes none does.
#[test]
fn one_grid_is_a_depth_test_in_codes_only() {
    let of: Vec<&Claimed> = MEASURED.claims.iter().filter(|claim| claim.says.contains("with r as a float")).collect();
    let dark = |index: usize| of[index].first.value.unwrap();
    assert!(of[0].first.settings.contains("depth16") && (35.0..65.0).contains(&dark(0)), "{}", of[0]);
    assert!(of.iter().all(|claim| claim.verdict == ClaimVerdict::Fails), "{of:?}");
    let codes = claim("in the buffer's own codes");
    assert_eq!((codes.verdict, codes.first.value), (ClaimVerdict::Holds, Some(0.0)), "{codes}");
}

/// A claim that a scene cannot show has a reason in words, and no verdict.
#[test]
fn a_scene_without_a_spotlight_says_what_it_cannot_show() {
    let sun = SCENE.replace(
        "kind = \"spot\"\nposition = [-1.8, 3.6, 1.4]\ntarget = [0.2, 0.3, 0.0]\ncone = 60.0\nshape = \"frustum\"\nnear = 0.8\nfar = 12.0",
        "kind = \"directional\"\ndirection = [0.5, -1.0, -0.3]",
    );
    let further = measure(&scene_of(&sun));
    for words in
        ["needs more polygon offset", "is more wrong where eye and light look towards", "in the buffer's own codes"]
    {
        let claim = further.claims.iter().find(|claim| claim.says.contains(words)).unwrap();
        assert_eq!(claim.verdict, ClaimVerdict::NotMeasured, "{claim}");
        assert!(claim.first.why.as_ref().is_some_and(|why| why.contains("only a spotlight")), "{claim:?}");
        assert!(claim.to_string().contains("not measured here"), "{claim}");
    }
    assert_eq!(further.sweeps.iter().map(|sweep| sweep.name.as_str()).collect::<Vec<_>>(), ["far planes"]);
}
