//! Passes and tests that slide projectors do not need: left out, said, and the picture is the same. What is ignored or clamped
//! is said, too.

use glumbra::pass::{Format, Work};

use super::*;

/// A room in the light of one projector that never saturates; every colour is a code of 8 bits.
fn dim_room(lights: &str, background: &str) -> String {
    let shading =
        format!("[shading]\npasses = \"slide\"\nbackground = \"{background}\"\nambient = [0.2, 0.2, 0.2]\n[camera]");
    ROOM.replace("[camera]", &shading)
        .replace("0.5, 0.9, 1.0", "0.4, 0.8, 1.0")
        .replace("0.8, 0.7, 0.5", "0.8, 0.6, 0.4")
        .replace("0.9, 0.9, 0.6", "0.8, 0.8, 0.6")
        .replace("1.0, 0.6, 0.7", "1.0, 0.6, 0.2")
        + lights
}

#[test]
fn one_projector_that_never_saturates_is_one_pass_and_the_same_picture() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let path = folder.path().join("slide.png");
    picture(&mut Random::new(5), [48, 32]).save(&path).unwrap();
    let light = |color: f64, more: &str| {
        projector(
            [0.5, 1.8, 3.5],
            [0.0, 0.7, -1.0],
            50.0,
            &format!("color = [{color:?}, {color:?}, {color:?}]\nimage = {path:?}\n{more}"),
        )
    };
    let (all, few) = (Request { keep_all: true, ..Request::default() }, Request::default());
    for background in ["scene", "ambient"] {
        for lights in [light(0.8, ""), light(1.6, "attenuation = [2.0, 0.0, 0.1]"), String::new()] {
            let scene = load(&dim_room(&lights, background), folder.path());
            let (merged, plan) = draw(&scene, &few, &mut renderer);
            assert_eq!(labels(&plan), ["lit"]);
            assert!(is_left_out(&plan, "passes of the slide projector", "nothing clamps"), "{:?}", plan.left_out);
            let (three, plan) = draw(&scene, &all, &mut renderer);
            assert!(plan.list.passes.len() >= 2, "{:?}", labels(&plan));
            let codes = apart(&merged, &three);
            println!("{background}, {} projectors: {codes} codes", scene.lights.len());
            // The image, the product and the one pass are rounded by half a code each, which is less than two.
            assert!(codes < 1.01, "{codes}");
            // In floats only their order differs.
            let float = |keep_all| Request { keep_all, float_picture: true, ..Request::default() };
            let (merged, three) =
                (draw(&scene, &float(false), &mut renderer).0, draw(&scene, &float(true), &mut renderer).0);
            assert!(apart(&merged, &three) < 1e-3, "{}", apart(&merged, &three));
        }
    }
    // A sum above 1 is clamped before the product, and that is said.
    let scene = load(&dim_room(&light(1.0, ""), "scene"), folder.path());
    let plan = draw(&scene, &few, &mut renderer).1;
    assert_eq!(labels(&plan), ["depth and ambient light", "slide of light 0", "surfaces' colours"]);
    let is_said = |plan: &Plan| {
        plan.chosen.iter().any(|chosen| chosen.choice.contains("clamped to 1") && chosen.why.contains("1.2"))
    };
    assert!(is_said(&plan), "{:?}", plan.chosen);
    let plan = draw(&scene, &Request { float_picture: true, ..Request::default() }, &mut renderer).1;
    assert!(!is_said(&plan) && labels(&plan) == ["lit"]);
}

#[test]
fn surfaces_that_coincide_are_lit_once() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let lights = projector([0.5, 1.8, 3.5], [0.0, 0.7, -1.0], 50.0, "color = [0.3, 0.3, 0.3]")
        + &projector([-1.0, 1.8, 3.5], [0.0, 0.7, -1.0], 50.0, "color = [0.3, 0.2, 0.1]");
    let once = dim_room(&lights, "scene");
    let twice = once.clone() + &once[once.find("[[object]]").unwrap()..once.find("[[light]]").unwrap()];
    let [(single, plan), (double, _)] =
        [&once, &twice].map(|text| draw(&load(text, folder.path()), &Request::default(), &mut renderer));
    assert!(plan.list.images.iter().any(|image| image.format == Format::Depth24Stencil8));
    assert_eq!(apart(&single, &double), 0.0);
    // What would be seen otherwise: the test can fail.
    let mut scene = load(&twice, folder.path());
    scene.shading.ambient = [0.2; 3];
    let mut plan = renderer.plan(&scene, &Request::default()).unwrap();
    for pass in &mut plan.list.passes {
        let Work::Draw(draw) = &mut pass.work else { continue };
        draw.state.stencil = None;
    }
    renderer.draw(&plan).unwrap();
    let Pixels::Rgba8 { data, .. } = renderer.read(&plan).unwrap().picture else { panic!() };
    let doubled: Vec<f64> = data.iter().map(|code| f64::from(*code) * CODE).collect();
    assert!(apart(&single, &doubled) > 20.0);
}

/// The stencil test is left out where items cannot meet, and nowhere else; the picture is the same.
#[test]
fn the_stencil_test_is_left_out_where_no_surfaces_can_coincide() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let lights = projector([0.5, 1.8, 3.5], [0.0, 0.5, 0.0], 50.0, "color = [0.3, 0.3, 0.3]")
        + &projector([-1.0, 1.8, 3.5], [0.0, 0.5, 0.0], 50.0, "color = [0.3, 0.2, 0.1]");
    let head = "[image]\nsize = [96, 72]\n[camera]\neye = [2.2, 2.6, 4.6]\ntarget = [0.0, 0.5, 0.0]\nfov_y = 46.0\nnear = 0.2\nfar = 40.0\n[shading]\npasses = \"slide\"\n";
    let object = |mesh: &str, y: f64, more: &str| {
        format!(
            "[[object]]\nmesh = \"{mesh}\"\nscale = 0.5\ntranslate = [0.0, {y:?}, 0.0]\nmaterial = {{ diffuse = [0.6, 0.8, 0.4] }}\n{more}"
        )
    };
    let closed = "closed = true\n";
    for (name, objects, needed) in [
        ("a square", object("quad", 0.0, ""), false),
        ("a square below a closed box", object("quad", -0.2, "") + &object("box", 0.5, closed), false),
        ("a square that a box stands on", object("quad", 0.0, "") + &object("box", 0.5, closed), true),
        ("a box that may be open", object("box", 0.5, ""), true),
        ("two squares in one plane", object("quad", 0.0, "") + &object("quad", 0.0, ""), true),
        ("a ring", object("torus", 0.5, closed), true),
    ] {
        let scene = load(&(String::from(head) + &objects + &lights), folder.path());
        let (picture, plan) = draw(&scene, &Request::default(), &mut renderer);
        let has_stencil = plan.list.images.iter().any(|image| image.format == Format::Depth24Stencil8);
        assert_eq!(has_stencil, needed, "{name}");
        assert_eq!(is_left_out(&plan, "stencil test of coincident surfaces", "share a plane"), !needed, "{name}");
        let (whole, _) = draw(&scene, &Request { keep_all: true, ..Request::default() }, &mut renderer);
        assert_eq!(apart(&picture, &whole), 0.0, "{name}");
    }
}

#[test]
fn what_a_slide_does_not_need_is_left_out_and_said() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let seen = projector([0.5, 1.8, 3.5], [0.0, 0.7, -1.0], 50.0, "color = [0.9, 0.9, 0.9]");
    let unseen = projector([0.0, 1.0, 9.0], [0.0, 1.0, 20.0], 30.0, "");
    let mut text = dim_room(&(seen + &unseen), "scene");
    let (_, plan) = draw(&load(&text, folder.path()), &Request::default(), &mut renderer);
    assert_eq!(labels(&plan), ["depth and ambient light", "slide of light 0", "surfaces' colours"]);
    assert!(is_left_out(&plan, "light 1", "reaches nothing visible") || is_left_out(&plan, "light 1", "do not meet"));
    for color in ["0.8, 0.6, 0.4", "0.4, 0.8, 1.0", "0.8, 0.8, 0.6", "1.0, 0.6, 0.2"] {
        text = text.replace(color, "1.0, 1.0, 1.0");
    }
    let scene = load(&text, folder.path());
    let (white, plan) = draw(&scene, &Request::default(), &mut renderer);
    assert_eq!(labels(&plan), ["depth and ambient light", "slide of light 0"]);
    assert!(is_left_out(&plan, "surfaces' colours", "white"));
    let (whole, plan) = draw(&scene, &Request { keep_all: true, ..Request::default() }, &mut renderer);
    assert!(plan.list.passes.len() == 4 && plan.left_out.is_empty(), "{:?}", labels(&plan));
    assert_eq!(apart(&white, &whole), 0.0);
}

/// Transparency of a slide has no meaning: light is added whole.
#[test]
fn a_slide_s_alpha_is_ignored_and_said() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let clear = picture(&mut Random::new(9), [48, 32]);
    let mut opaque = clear.clone();
    opaque.pixels_mut().for_each(|texel| texel.0[3] = 255);
    let pictures = [("clear", clear), ("opaque", opaque)].map(|(name, image)| {
        let path = folder.path().join(format!("{name}.png"));
        image.save(&path).unwrap();
        let light = projector([0.5, 1.8, 3.5], [0.0, 0.7, -1.0], 50.0, &format!("image = {path:?}"));
        draw(&load(&dim_room(&light, "scene"), folder.path()), &Request::default(), &mut renderer)
    });
    assert_eq!(apart(&pictures[0].0, &pictures[1].0), 0.0);
    let said = |plan: &Plan| plan.chosen.iter().any(|chosen| chosen.of.contains("alpha") && chosen.choice == "ignored");
    assert_eq!(pictures.map(|(_, plan)| said(&plan)), [true, false]);
}

/// A projector's law in one pass among other lights: the same light without cosine, beside lights with one.
#[test]
fn projectors_and_lights_add_up_in_one_pass() {
    let (folder, mut renderer) = (tempfile::tempdir().unwrap(), renderer());
    let slide = projector([0.5, 1.8, 3.5], [0.0, 0.7, -1.0], 50.0, "color = [0.4, 0.3, 0.2]");
    let lamp = "[[light]]\nkind = \"point\"\nposition = [-1.0, 2.5, 2.0]\ndiffuse = [0.3, 0.3, 0.3]\nspecular = [0.1, 0.1, 0.1]\n";
    let text = dim_room(&(slide + lamp), "scene").replace("\"slide\"\nbackground", "\"one\"\nbackground");
    for lighting in ["per-fragment", "per-vertex"] {
        let text = text.replace("[shading]", &format!("[shading]\nlighting = \"{lighting}\""));
        let both = load(&text, folder.path());
        let float = Request { float_picture: true, ..Request::default() };
        let mut alone = |kept: Option<usize>| {
            let mut scene = both.clone();
            for (index, light) in scene.lights.iter_mut().enumerate() {
                if Some(index) != kept {
                    (light.diffuse, light.specular) = ([0.0; 3], [0.0; 3]);
                }
            }
            draw(&scene, &float, &mut renderer).0
        };
        let [dark, slide, lamp] = [None, Some(0), Some(1)].map(&mut alone);
        let sum: Vec<f64> = (0..dark.len()).map(|k| slide[k] + lamp[k] - dark[k]).collect();
        let picture = draw(&both, &float, &mut renderer).0;
        assert!(apart(&picture, &sum) < 1e-3 && apart(&slide, &dark) > 20.0, "{lighting}: {}", apart(&picture, &sum));
    }
}
