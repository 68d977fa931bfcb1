//! Passes and casters that the plan leaves out change no pixel. Each scene is drawn twice: with casters culled by what the
//! camera sees, and, because a view of the map needs all of it, with none culled.

use std::fmt::Write as _;

use crate::support::scene_of;
use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Plan, Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::views::View;

/// A field of boxes and spheres on a floor, wider than the camera and the light see.
fn field(eye: [f64; 3], light: [f64; 3], cone: f64, shadow: &str) -> Scene {
    let mut text = format!(
        "[image]\nsize = [192, 128]\n[camera]\neye = {eye:?}\ntarget = [0.0, 0.0, 0.0]\nfov_y = 40.0\nnear = 0.2\nfar = 60.0\n\
         [[light]]\nkind = \"spot\"\nposition = {light:?}\ntarget = [0.0, 0.0, 0.0]\ncone = {cone:?}\nnear = 0.5\nfar = 80.0\n\
         [light.shadow]\n{shadow}\n\
         [[object]]\nmesh = \"quad\"\nscale = [20.0, 1.0, 20.0]\n"
    );
    for k in 0..49 {
        let (mesh, x, z) = (["box", "sphere"][k % 2], 3.0 * ((k % 7) as f64 - 3.0), 3.0 * ((k / 7) as f64 - 3.0));
        let _ = writeln!(text, "[[object]]\nmesh = \"{mesh}\"\nscale = 0.5\ntranslate = [{x:?}, 0.6, {z:?}]");
    }
    scene_of(&text)
}

fn unseen(plan: &Plan) -> usize {
    plan.left_out.iter().filter(|left| left.why.starts_with("the camera sees nothing that it shadows")).count()
}

#[test]
fn casters_whose_shadow_is_unseen_change_no_pixel() {
    let settings =
        ["size = 256", "size = 64\nfilter = \"nearest\"", "size = 128\naddressing = \"direct3d\"", "size = 32"];
    let left_out = unseen_change_no_pixel(&settings.map(|keys| format!("technique = \"shadow-map\"\n{keys}")));
    assert!(left_out > 100, "only {left_out} casters were left out: the test shows nothing");
}

/// A midpoint map keeps those that may be the second layer of a caster whose shadow is seen.
#[test]
fn casters_of_no_second_layer_change_no_pixel() {
    let settings = [
        "size = 256",
        "size = 128\nfilter = \"nearest\"\ncull = \"back\"",
        "size = 256\nsingle = \"first\"",
        "size = 64",
    ];
    let left_out = unseen_change_no_pixel(&settings.map(|keys| format!("technique = \"midpoint\"\n{keys}")));
    assert!(left_out > 100, "only {left_out} casters were left out: the test shows nothing");
}

/// Draws the field under each of the settings in turn; how many casters were left out in all.
fn unseen_change_no_pixel(shadows: &[String; 4]) -> usize {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let eyes = [[6.0, 5.0, 8.0], [0.5, 3.0, 6.0], [-14.0, 2.0, 0.3], [2.0, 12.0, -3.0]];
    let lights = [[6.0, 14.0, 4.0], [-16.0, 3.0, 2.0], [0.1, 20.0, 0.0]];
    let (mut all_unseen, mut number) = (0, 0);
    for eye in eyes {
        for light in lights {
            for cone in [50.0, 120.0] {
                let scene = field(eye, light, cone, &shadows[number % shadows.len()]);
                number += 1;
                let culled = renderer.plan(&scene, &Request::default()).unwrap();
                renderer.draw(&culled).unwrap();
                let picture = renderer.read(&culled).unwrap().picture;
                let views = vec![ViewRequest { view: View::LightDepth, light: 0 }];
                let whole = renderer.plan(&scene, &Request { views, ..Request::default() }).unwrap();
                assert_eq!(unseen(&whole), 0);
                renderer.draw(&whole).unwrap();
                let equal = renderer.read(&whole).unwrap().picture == picture;
                assert!(equal, "eye {eye:?}, light {light:?}, cone {cone}: {} casters left out", unseen(&culled));
                all_unseen += unseen(&culled);
            }
        }
    }
    println!("{all_unseen} casters left out");
    all_unseen
}

/// A sheet, a receiver that casts nothing below it, and a box below that, which the camera sees as little as its shadow.
/// The receiver is the second layer, so that the box changes no pixel, drawn or not.
#[test]
fn an_unseen_second_layer_is_drawn() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let quad =
        |y: f64, scale: f64| format!("[[object]]\nmesh = \"quad\"\nscale = {scale:?}\ntranslate = [0.0, {y:?}, 0.0]\n");
    let text = "[image]\nsize = [192, 128]\n[camera]\neye = [0.0, 2.4, 6.0]\ntarget = [0.0, 2.1, 0.0]\nfov_y = 18.0\nnear = 0.2\nfar = 60.0\n\
         [[light]]\nkind = \"spot\"\nposition = [0.0, 14.0, 0.1]\ntarget = [0.0, 0.0, 0.0]\ncone = 40.0\nnear = 0.5\nfar = 80.0\n\
         [light.shadow]\ntechnique = \"midpoint\"\n"
        .to_owned()
        + &quad(-2.0, 6.0)
        + &quad(1.6, 1.0)
        + "casts_shadow = false\n"
        + &quad(2.6, 0.5);
    let mut picture = |text: &str, keep_all| {
        let scene = scene_of(text);
        let plan = renderer.plan(&scene, &Request { keep_all, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        (renderer.read(&plan).unwrap().picture, unseen(&plan))
    };
    let below = text.clone() + "[[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [0.0, 0.4, 0.0]\n";
    let aside = text.clone() + "[[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [3.0, 0.4, 0.0]\n";
    let (without, _) = picture(&text, false);
    for (text, idle) in [(below, 0), (aside, 1)] {
        let (pruned, left_out) = picture(&text, false);
        assert_eq!(left_out, idle);
        assert!(pruned == picture(&text, true).0);
        assert!(pruned == without, "what is seen is the second layer itself");
    }
}

/// Every scene of ours, once as planned and once with all that its plan leaves out: lights and objects out of sight,
/// colour buffers of depth passes, maps drawn again in each frame.
#[test]
fn what_is_left_out_of_our_scenes_changes_no_pixel() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/data/");
    let out_of_sight = ["light.0.position=[9.0, 3.0, 60.0]", "light.0.target=[9.0, 0.0, 90.0]", "light.0.far=80.0"];
    let aside = ["camera.target=[9.0, 0.0, 4.0]"];
    let per_vertex = "shading.lighting=per-vertex";
    let (mut saved, mut wrong) = (0, Vec::new());
    for (name, lighting) in [
        ("scenes/main.toml", None),
        ("scenes/teapot.toml", None),
        ("scenes/hw_shadowmaps_simple.toml", None),
        ("cases/scenes/two_lights.toml", None),
        ("cases/scenes/two_lights.toml", Some(per_vertex)),
    ] {
        for changes in [&[][..], &out_of_sight[..], &aside[..]] {
            let changes: Vec<String> =
                changes.iter().copied().chain(lighting).chain(["image.size=[192, 128]"]).map(str::to_owned).collect();
            let scene = glumbra::load(format!("{root}{name}").as_ref(), &changes).unwrap().scene;
            let mut picture = |keep_all| {
                let plan = renderer.plan(&scene, &Request { keep_all, ..Request::default() }).unwrap();
                for _ in 0..2 {
                    renderer.draw(&plan).unwrap();
                }
                (renderer.read(&plan).unwrap().picture, plan)
            };
            let (pruned, plan) = picture(false);
            let (whole, whole_plan) = picture(true);
            let [differ, most] = differences(&pruned, &whole);
            if pruned != whole {
                let left_out = &plan.left_out;
                wrong.push(format!("{name}, {changes:?}: {differ} pixels differ, by {most} at most: {left_out:?}"));
            }
            assert!(whole_plan.left_out.is_empty() && !plan.left_out.is_empty());
            assert!(whole_plan.summary().image_bytes >= plan.summary().image_bytes);
            saved += whole_plan.list.passes.len() - plan.list.passes.len();
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(saved > 0, "no pass was ever left out");
}

/// Pixels that differ, and the most that a channel does, in codes.
fn differences(a: &Pixels, b: &Pixels) -> [usize; 2] {
    let (Pixels::Rgba8 { data: a, .. }, Pixels::Rgba8 { data: b, .. }) = (a, b) else { panic!("no RGBA8") };
    let apart = a.chunks_exact(4).zip(b.chunks_exact(4));
    let apart = apart.map(|(a, b)| a.iter().zip(b).map(|(a, b)| usize::from(a.abs_diff(*b))).max().unwrap_or(0));
    apart.filter(|most| *most > 0).fold([0, 0], |[count, most], apart| [count + 1, most.max(apart)])
}

/// Objects that are declared closed: their back faces are left out where they are seen from outside, and drawn where
/// the camera's near plane may cut them open. At a silhouette a front and a back face can round to the same depth, and
/// the one that is drawn first wins: without back faces it is always the front one. That is one pixel in thousands.
#[test]
fn back_faces_of_closed_objects_are_left_out() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let meshes = [
        ("sphere", true),
        ("torus", true),
        ("box", true),
        (concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/dense.obj"), true),
    ];
    for (mesh, outside) in meshes {
        for (eye, scale, outside) in [
            ("[2.2, 1.9, 3.1]", "0.7", outside),
            ("[0.1, 0.3, 0.2]", "3.0", false),
            ("[2.2, 1.9, 3.1]", "[-0.7, 0.7, 0.7]", outside),
        ] {
            let text = format!(
                "[image]\nsize = [160, 120]\n[camera]\neye = {eye}\ntarget = [0.0, 0.5, 0.0]\nnear = 0.1\nfar = 30.0\n\
                 [[light]]\nkind = \"spot\"\nposition = [2.0, 4.0, 3.0]\ntarget = [0.0, 0.5, 0.0]\ncone = 60.0\nnear = 0.5\nfar = 20.0\n[light.shadow]\ntechnique = \"shadow-map\"\n\
                 [[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\n[[object]]\nmesh = {mesh:?}\nscale = {scale}\nclosed = true\ntranslate = [0.0, 0.6, 0.0]\n"
            );
            let scene = scene_of(&text);
            let mut picture = |closed| {
                let mut scene = scene.clone();
                scene.objects[1].closed = closed;
                let plan = renderer.plan(&scene, &Request::default()).unwrap();
                renderer.draw(&plan).unwrap();
                (renderer.read(&plan).unwrap().picture, plan)
            };
            let ((pruned, plan), (whole, _)) = (picture(true), picture(false));
            let left_out = plan.left_out.iter().any(|left| left.what.starts_with("back faces of"));
            assert_eq!(left_out, outside, "{mesh} from {eye}");
            let [differ, _] = differences(&pruned, &whole);
            println!("{mesh} from {eye}, scale {scale}: {differ} pixels differ");
            assert!(differ <= if outside { 3 } else { 0 }, "{mesh} from {eye}, scale {scale}: {differ}");
        }
    }
}

#[test]
fn what_is_not_closed_cannot_be_declared_so() {
    for (mesh, message) in [("quad", "open, crowded or turned edges"), ("teapot", "open, crowded or turned edges")] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("open.toml");
        std::fs::write(&path, format!("[[object]]\nmesh = \"{mesh}\"\nclosed = true\n")).unwrap();
        let error = glumbra::load(&path, &[]).unwrap_err().to_string();
        assert!(error.contains("open.toml:3") && error.contains(message), "{error}");
    }
}

/// Whatever the light, the eye and the settings are, the picture is that of a plan that leaves nothing out.
#[test]
fn nothing_is_missed_under_any_setting_of_maps() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let settings = [
        "size = 256",
        "size = 64\nkernel = 7",
        "size = 128\nbias = \"normal-offset\"\nkernel = 3",
        "size = 128\nbias = \"receiver-plane\"\nkernel = 5",
        "size = 128\nbias = \"adaptive\"",
        "size = 96\nfilter = \"nearest\"\ntransfer = \"copy\"",
        "size = 128\ncompare = \"gequal\"",
        "size = 128\nfit = \"casters\"",
        "size = 128\nguard = \"none\"",
        "size = 128\nmipmaps = \"8-tap\"",
        "size = 128\naddressing = \"direct3d\"",
    ];
    let mut random = fastrand::Rng::with_seed(29);
    let mut all_unseen = 0;
    for number in 0..66 {
        let mut place = |low: f64, high: f64| low + (high - low) * random.f64();
        let eye = [place(-9.0, 9.0), place(0.3, 9.0), place(-9.0, 9.0)];
        let light = [place(-12.0, 12.0), place(0.5, 14.0), place(-12.0, 12.0)];
        let scene =
            field(eye, light, place(20.0, 140.0), &format!("technique = \"shadow-map\"\n{}", settings[number % 11]));
        let pictures = [false, true].map(|keep_all| {
            let plan = renderer.plan(&scene, &Request { keep_all, ..Request::default() }).unwrap();
            all_unseen += unseen(&plan);
            renderer.draw(&plan).unwrap();
            renderer.read(&plan).unwrap().picture
        });
        assert!(pictures[0] == pictures[1], "eye {eye:?}, light {light:?}, {}", settings[number % 11]);
    }
    assert!(all_unseen > 100, "only {all_unseen} casters were left out: the test shows nothing");
}

/// A box, and beside it a smaller one inside out: the volume of both is positive, and the smaller one shows its back faces.
#[test]
fn a_piece_inside_out_cannot_be_declared_closed() {
    const CORNERS: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    const FACES: [[usize; 4]; 6] = [[4, 3, 2, 1], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
    let mut text = String::new();
    for (aside, scale) in [(0.0, 1.0), (4.0, 0.5)] {
        CORNERS.iter().for_each(|[x, y, z]| {
            let _ = writeln!(text, "v {} {} {}", aside + scale * x, scale * y, scale * z);
        });
    }
    let faces = |first: usize, is_turned: bool| {
        let line = |face: &[usize; 4]| {
            let mut face = *face;
            if is_turned {
                face.reverse();
            }
            format!("f {} {} {} {}\n", face[0] + first, face[1] + first, face[2] + first, face[3] + first)
        };
        FACES.iter().map(line).collect::<String>()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("closed.toml");
    std::fs::write(&path, "[[object]]\nmesh = \"boxes.obj\"\nclosed = true\n").unwrap();
    for is_turned in [false, true] {
        let faces = faces(0, false) + &faces(8, is_turned);
        std::fs::write(folder.path().join("boxes.obj"), text.clone() + &faces).unwrap();
        match glumbra::load(&path, &[]) {
            Ok(_) => assert!(!is_turned),
            Err(error) => assert!(is_turned && error.to_string().contains("some piece of the mesh look"), "{error}"),
        }
    }
}

#[test]
fn a_plan_says_which_meshes_are_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("closed.toml");
    for (object, is_said) in [
        ("mesh = \"torus\"", true),
        ("mesh = \"torus\"\nclosed = true", false),
        ("mesh = \"teapot\"", false),
        ("mesh = \"box\"", false),
    ] {
        std::fs::write(&path, format!("[[object]]\n{object}\n")).unwrap();
        let scene = glumbra::load(&path, &[]).unwrap().scene;
        let mut plan = glumbra::plan::make(&scene, &Request::default()).unwrap();
        plan.note_closed(&scene);
        let said = plan.chosen.iter().any(|chosen| chosen.why.contains("closed = true leaves them out"));
        assert_eq!(said, is_said, "{object}: {:?}", plan.chosen);
    }
}

/// A view alone is drawn as it is beside the picture, without the picture's passes.
#[test]
fn shades_are_the_same_without_the_picture() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    for keys in [
        "technique = \"none\"",
        "technique = \"shadow-map\"\nsize = 128",
        "technique = \"midpoint\"\nsize = 128",
        "technique = \"second-depth\"\nclosed = \"assume\"\nsize = 128",
        "technique = \"shadow-volume\"",
        "technique = \"shadow-volume\"\nmethod = \"z-fail\"",
    ] {
        let scene = field([6.0, 5.0, 8.0], [6.0, 14.0, 4.0], 50.0, keys);
        let mut drawn = |views_only| {
            let views = vec![ViewRequest { view: View::Shade, light: 0 }];
            let plan = renderer.plan(&scene, &Request { views, views_only, ..Request::default() }).unwrap();
            renderer.draw(&plan).unwrap();
            (renderer.read(&plan).unwrap().views, plan.list.passes.len())
        };
        let ((beside, all), (alone, fewer)) = (drawn(false), drawn(true));
        assert!(alone == beside, "{keys}");
        assert!(fewer < all, "{keys}: {fewer} of {all} passes");
    }
}

/// Without a guard a wall behind the light looks up, mirrored, what is before the light: a caster there shows in it although
/// the camera sees nothing that it shadows.
#[test]
fn what_an_unguarded_light_projects_backwards_is_drawn() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let text = "[image]\nsize = [96, 96]\n[camera]\neye = [-0.5, 0.2, 0.1]\ntarget = [-5.0, 0.0, 0.0]\nfov_y = 60.0\nnear = 0.1\nfar = 60.0\n\
         [[light]]\nkind = \"spot\"\nposition = [0.0, 0.0, 0.0]\ntarget = [3.0, 0.0, 0.0]\ncone = 60.0\nnear = 0.5\nfar = 20.0\n\
         [light.shadow]\ntechnique = \"shadow-map\"\nsize = 128\nguard = \"none\"\n\
         [[object]]\nmesh = \"quad\"\nrotate = { axis = [0, 0, 1], angle = 90 }\nscale = 6.0\ntranslate = [-5.0, 0.0, 0.0]\n\
         [[object]]\nmesh = \"box\"\nscale = 0.5\ntranslate = [3.0, 0.0, 0.0]\n";
    let mut picture = |text: &str, keep_all| {
        let plan = renderer.plan(&scene_of(text), &Request { keep_all, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        renderer.read(&plan).unwrap().picture
    };
    let whole = picture(text, true);
    assert!(whole != picture(&format!("{text}casts_shadow = false\n"), true), "nothing is projected backwards");
    assert!(whole == picture(text, false));
}
