//! Shadow maps as tags in the stencil buffer against the shade that a shader looks up: every kind of light, holes,
//! kernels and filters, counts of volumes beside them; and what has no tag is refused by name.

use std::path::Path;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::pass::Redraw;
use glumbra::plan::{self, Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::views::View;

/// A scene of `data/` with overrides.
fn load(path: &str, set: &[&str]) -> Scene {
    let set: Vec<String> = [&["image.size=[160, 120]"], set].concat().iter().map(|text| (*text).to_owned()).collect();
    glumbra::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(path), &set).unwrap().scene
}

const DIRECTIONAL: &str =
    "light.0={ kind = \"directional\", direction = [1, -2, 0.4], shadow = { technique = \"shadow-map\" } }";
const POINT: &str = "light.0={ kind = \"point\", position = [-2, 5, 1.5], near = 1, far = 14, shadow = { technique = \"shadow-map\" } }";

/// Shade and reach are bit-equal where the shade is 0 or 1; else the tag is whether it is below one half.
#[test]
fn a_tag_is_the_shades_upper_half() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut view = |scene: &Scene, view: View| {
        let views = vec![ViewRequest { view, light: 0 }];
        let plan = renderer.plan(scene, &Request { views, float_picture: true, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        let frame = renderer.read(&plan).unwrap();
        match frame.views.into_iter().next().unwrap() {
            Pixels::RgbaF32 { data, .. } => data,
            Pixels::Stencil { data, .. } => data.into_iter().map(f32::from).collect(),
            _ => panic!("neither a shade nor a count"),
        }
    };
    let table: &[(&str, &[&str])] = &[
        ("cases/scenes/box.toml", &["light.shadow.filter=nearest"]),
        ("cases/scenes/box.toml", &["light.shadow.filter=linear"]),
        ("cases/scenes/box.toml", &["light.shadow.kernel=5x5", "light.shadow.bias=adaptive"]),
        (
            "cases/scenes/box.toml",
            &["light.shadow.addressing=direct3d", "light.shadow.format=depth32f", "light.shape=frustum"],
        ),
        ("cases/scenes/box.toml", &["light.shadow.fit=view", "light.shadow.mipmaps=8-tap"]),
        ("cases/scenes/box.toml", &["light.shadow.technique=midpoint", "light.shadow.compare=gequal"]),
        ("cases/scenes/box.toml", &[DIRECTIONAL, "light.shadow.filter=nearest"]),
        ("cases/scenes/box.toml", &[POINT, "light.shadow.filter=nearest"]),
        ("cases/scenes/box.toml", &[POINT]),
        ("cases/shadow-map/alpha-test/scene.toml", &["light.shadow.filter=nearest"]),
        ("cases/shadow-map/wave/scene.toml", &["light.shadow.filter=nearest"]),
        (
            "cases/shadow-map/wave/scene.toml",
            &["light.shadow.filter=nearest", "object.1.material={ alpha = \"data/meshes/fence.png\" }"],
        ),
        (
            "cases/scenes/two_lights.toml",
            &["light.1.shadow.technique=shadow-volume", "light.1.shadow.method=z-pass-capped"],
        ),
        ("scenes/teapot.toml", &["light.shadow.filter=linear", "shading.lighting=per-vertex"]),
    ];
    for (path, set) in table {
        let asked = load(path, set);
        let tagged = load(path, &[*set, &["light.0.shadow.into=stencil"]].concat());
        let (shade, tag, count) =
            (view(&asked, View::Shade), view(&tagged, View::Shade), view(&tagged, View::StencilCount));
        let mut shadowed = 0;
        for (index, (asked, tagged)) in shade.chunks_exact(4).zip(tag.chunks_exact(4)).enumerate() {
            let expected =
                if asked[3] == 0.0 { [0.0; 4] } else { [[0.0, 0.0, 0.0, 1.0], [1.0; 4]][usize::from(asked[0] >= 0.5)] };
            assert_eq!(tagged, expected, "{path} {set:?}: pixel {index}, asked {asked:?}");
            let is_shadowed = asked[3] == 1.0 && asked[0] < 0.5;
            shadowed += usize::from(is_shadowed);
            assert_eq!(count[index], f32::from(u8::from(is_shadowed)), "{path} {set:?}: pixel {index}");
        }
        assert!(shadowed > 50, "{path} {set:?}: {shadowed} pixels in shadow are too few to tell");
    }
}

/// Depth, map and tags of one tagged light are kept from frame to frame; a second one needs the same stencil buffer.
#[test]
fn tags_are_kept_with_the_depth_that_they_are_on() {
    let once = |path: &str| {
        let scene = load(path, &["light.shadow.into=stencil"]);
        let plan = plan::make(&scene, &Request { frames: 2, ..Request::default() }).unwrap();
        let once = plan.list.passes.iter().filter(|pass| pass.redraw == Redraw::WhenChanged);
        once.map(|pass| pass.label.clone()).collect::<Vec<_>>()
    };
    assert_eq!(once("cases/scenes/box.toml"), ["light 0: depth", "depth", "light 0: tag"]);
    assert_eq!(once("cases/scenes/two_lights.toml"), ["light 0: depth", "light 1: depth"]);
}

#[test]
fn a_tag_is_no_volume_to_look_at() {
    let scene = load("cases/scenes/box.toml", &["light.shadow.into=stencil"]);
    for view in [View::Volume, View::Silhouette] {
        let views = vec![ViewRequest { view, light: 0 }];
        let error = plan::make(&scene, &Request { views, ..Request::default() }).unwrap_err().to_string();
        assert!(error.contains("light 0 counts no shadow volumes"), "{error}");
    }
}

/// In exact colours: what is there and what is added come to what one shader gives, also where lighting per vertex is
/// clamped, and a light has ambient light or is dimmed.
#[test]
fn what_is_added_is_what_a_shader_gives() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut draw = |set: &[&str], more: &[&str]| {
        let scene = load("cases/scenes/two_lights.toml", &[&["light.shadow.filter=nearest"], set, more].concat());
        let plan = renderer.plan(&scene, &Request { float_picture: true, ..Request::default() }).unwrap();
        renderer.draw(&plan).unwrap();
        match renderer.read(&plan).unwrap().picture {
            Pixels::RgbaF32 { data, .. } => data,
            _ => panic!("no floats"),
        }
    };
    let bright = "light.diffuse=[1.5, 1.4, 1.3]";
    for lighting in ["shading.lighting=per-vertex", "shading.lighting=per-fragment"] {
        for more in [
            &["light.0.attenuation=[1, 0.1, 0]"][..],
            &["light.shadow.dimming=0.4"],
            &["light.ambient=[0.4, 0.3, 0.2]", "light.shadow.dimming=0.25", "light.specular=[1, 1, 1]"],
            &["light.shadow.dimming=1"],
        ] {
            let set = [&[bright, lighting], more].concat();
            let asked = draw(&set, &[]);
            let added = draw(&set, &["light.shadow.into=stencil"]);
            let apart = asked.iter().zip(&added).fold(0.0, |most: f32, (a, b)| most.max((a - b).abs()));
            // Sums of six or so roundings of f32 below 4.
            assert!(apart < 2e-6, "{set:?}: {apart}");
            assert!(asked.iter().any(|channel| *channel > 1.0), "{set:?}: nothing saturates");
        }
    }
}
