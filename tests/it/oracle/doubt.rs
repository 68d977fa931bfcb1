//! Doubt belongs to the pixel: what the scene reaches elsewhere makes no pixel ambiguous, and walls along the light make
//! no scene unusable.

use crate::support::scene_of;
use glumbra::truth::{self, Answer, Options, Reason};

const CAMERA: &str =
    "[image]\nsize = [128, 128]\n[camera]\neye = [3.0, 2.5, 4.0]\ntarget = [0.0, 0.6, 0.0]\nnear = 0.5\n";

#[test]
fn a_larger_floor_makes_no_pixel_doubtful() {
    for light in [
        "kind = \"directional\"\ndirection = [-1.0, -2.0, -0.6]",
        "kind = \"point\"\nposition = [2.0, 4.0, 3.0]\nnear = 0.1\nfar = 1e9",
        "position = [2.0, 4.0, 3.0]\ntarget = [0.0, 0.5, 0.0]\ncone = 60.0\nnear = 0.1\nfar = 1e9",
    ] {
        let mut answers = Vec::new();
        for half in [100.0, 4000.0, 1e5, 1e8] {
            let scene = scene_of(&format!(
                "{CAMERA}far = 50.0\n[[light]]\n{light}\n[[object]]\nmesh = \"box\"\nscale = 0.5\n\
                 translate = [0.0, 0.5, 0.0]\n[[object]]\nmesh = \"torus\"\nscale = 0.5\ntranslate = [1.0, 0.8, 1.0]\n\
                 [[object]]\nmesh = \"quad\"\nscale = [{half:?}, 1.0, {half:?}]\n"
            ));
            let truth = truth::trace(&scene, 0, &Options { most_ambiguous: 1.0, ..Options::default() }).unwrap();
            let share = truth.ambiguous_share();
            assert!(share < 3e-3, "{light}, {half}: {share} {:?}", truth.reasons());
            answers.push(truth);
        }
        // Where both are sure they agree: the floor is the same where it is seen.
        for truth in &answers[1..] {
            for (pixel, first) in truth.pixels.iter().zip(&answers[0].pixels) {
                let both = [pixel.answer, first.answer];
                if !both.iter().any(|answer| matches!(answer, Answer::Ambiguous(_))) {
                    assert_eq!(both[0], both[1], "{light}");
                }
            }
        }
    }
}

#[test]
fn walls_under_an_overhead_sun_are_no_reason_to_refuse() {
    let walls: String = [[-1.0, 0.0], [1.0, 0.5], [0.3, -1.5]]
        .iter()
        .map(|[x, z]| format!("[[object]]\nmesh = \"box\"\nscale = [0.4, 1.0, 0.4]\ntranslate = [{x:?}, 1.0, {z:?}]\n"))
        .collect();
    for direction in ["[0, -1, 0]", "[0, -1, 1e-9]", "[0.6, -0.8, 0.2]"] {
        let scene = scene_of(&format!(
            "{CAMERA}far = 50.0\n[[light]]\nkind = \"directional\"\ndirection = {direction}\n{walls}\
             [[object]]\nmesh = \"quad\"\nscale = 4.0\n"
        ));
        let truth = truth::trace(&scene, 0, &Options::default()).unwrap_or_else(|error| panic!("{direction}: {error}"));
        let of = |reason| truth.pixels.iter().filter(move |pixel| pixel.answer == Answer::Ambiguous(reason));
        let grazing = of(Reason::GrazingLight).count();
        assert_eq!(grazing > truth.drawn() / 20, direction != "[0.6, -0.8, 0.2]", "{direction}: {grazing}");
        for pixel in of(Reason::GrazingLight) {
            assert!(pixel.hit.unwrap().cos_light.abs() < 1e-3, "{direction}: {pixel:?}");
        }
    }
    // A surface that takes light whichever way it is turned is another matter.
    let scene = scene_of(&format!(
        "{CAMERA}far = 50.0\n[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n{}",
        walls.replace("[[object]]\n", "[[object]]\nlit = false\n")
    ));
    let refused = truth::trace(&scene, 0, &Options::default());
    assert!(matches!(refused, Err(truth::Error::TooAmbiguous { .. })), "{refused:?}");
}

/// Where f32 may move every surface by more than a mesh is large, a few pixels are enough to find that there is no truth,
/// and no pixel searches all of the mesh.
#[test]
fn a_light_so_far_away_that_nothing_is_sure_is_found_out_early() {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/dense.obj");
    let scene = scene_of(&format!(
        "{CAMERA}[[light]]\nkind = \"point\"\nposition = [4e9, 4, 3]\n[[object]]\nmesh = \"quad\"\nscale = 4.0\n\
         [[object]]\nmesh = {model:?}\n"
    ));
    let Err(truth::Error::TooAmbiguous { reasons, .. }) = truth::trace(&scene, 0, &Options::default()) else {
        panic!("there is no truth")
    };
    assert!(reasons.contains("; stopped after "), "{reasons}");
    let all = Options { most_ambiguous: 1.0, ..Options::default() };
    let truth = truth::trace(&scene, 0, &all).unwrap();
    assert_eq!(truth.ambiguous_share(), 1.0);
}
