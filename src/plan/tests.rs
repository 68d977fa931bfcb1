//! Plans against [GDC], [LEC] and [HSM]: numbers, formats, order of passes.

use std::path::Path;

use super::{Plan, Request, ViewRequest, make};
use crate::pass::{Blend, Compare, DepthFormat, DrawPass, Format, Work};
use crate::techniques;
use crate::views::View;

fn plan(scene: &str, set: &[&str]) -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes").join(scene);
    let set: Vec<String> = set.iter().map(|key| format!("light.shadow.{key}")).collect();
    let views = vec![ViewRequest { view: View::Shade, light: 0 }];
    make(&techniques::load(&path, &set).unwrap().scene, &Request { views, ..Request::default() }).unwrap()
}

/// The passes that draw, with their labels.
fn draws(plan: &Plan) -> Vec<(&str, &DrawPass)> {
    let passes = plan.list.passes.iter();
    let draw = passes.filter_map(|pass| match &pass.work {
        Work::Draw(draw) => Some((pass.label.as_str(), draw)),
        _ => None,
    });
    draw.collect()
}

/// Numbers of the slide: the scene in [0.1, 1], volumes in [0.05, 1], caps at 0.05 [GDC, "Building a "Ledge" at the Front
/// of the Depth Buffer"].
#[test]
fn the_talk_s_ledge_is_drawn_by_its_numbers() {
    for (ledge, [volumes, scene_near]) in
        [("ledge=[0.05, 0.1, 1.0]", [0.05, 0.1]), ("ledge=[0.2, 0.25, 1.0]", [0.2, 0.25])]
    {
        let plan = plan("box.toml", &["technique=shadow-volume", "method=z-pass-capped", ledge]);
        let range = |label: &str| draws(&plan).into_iter().find(|pass| pass.0 == label).unwrap().1.state.depth_range;
        assert_eq!(range("uncounted light"), [scene_near, 1.0]);
        assert_eq!(range("light 0: z-pass, sides"), [volumes, 1.0]);
        assert_eq!(range("light 0"), [scene_near, 1.0]);
    }
    let plan = plan("box.toml", &["technique=shadow-volume", "method=z-pass-capped"]);
    assert!(draws(&plan).iter().all(|(_, pass)| pass.state.depth_range[0] < 1e-6), "the thinnest by default");
}

/// Depth, count, the scene with the light where the count is 0, the scene without it where it is not; nothing is added
/// [GDC, "Shadow Volume Algorithm"].
#[test]
fn the_talk_s_two_passes_replace() {
    let plan = plan("box.toml", &["technique=shadow-volume", "passes=lit-unlit"]);
    let of_picture: Vec<_> = draws(&plan).into_iter().filter(|pass| !pass.0.starts_with("view")).collect();
    let labels: Vec<&str> = of_picture.iter().map(|pass| pass.0).collect();
    assert_eq!(labels, ["depth", "light 0: z-pass", "with light 0", "without light 0"]);
    let tests: Vec<_> =
        of_picture[2..].iter().map(|(_, pass)| (pass.state.stencil.unwrap().test, pass.state.blend)).collect();
    assert_eq!(tests, [(Compare::Equal, None), (Compare::NotEqual, None)]);
    assert!(of_picture[0].1.clear.depth.is_some() && of_picture[2].1.clear.color.is_some());
    let added = self::plan("box.toml", &["technique=shadow-volume"]);
    assert_eq!(draws(&added).iter().filter(|(_, pass)| pass.state.blend == Some(Blend::Add)).count(), 1);
}

/// Without a number of bits the texture is the driver's choice; the depth buffer that it is to follow has the picture's
/// [LEC, "New Depth Texture Internal Texture Formats"].
#[test]
fn an_unsized_map_is_copied_from_a_sized_depth_buffer() {
    for technique in ["technique=shadow-map", "technique=midpoint", "technique=second-depth"] {
        let plan = plan("box.toml", &[technique, "closed=assume", "format=depth", "transfer=copy"]);
        let formats = |depth_buffer: bool| {
            let images = plan.list.images.iter().filter(|desc| desc.label.starts_with("light 0"));
            let of = images.filter(|desc| desc.label.ends_with("depth buffer") == depth_buffer);
            of.map(|desc| desc.format).collect::<Vec<_>>()
        };
        assert!(!formats(false).is_empty() && formats(false).iter().all(|format| *format == Format::UnsizedDepth));
        let depth24 = Format::Depth(DepthFormat::Depth24);
        assert!(!formats(true).is_empty() && formats(true).iter().all(|format| *format == depth24), "{technique}");
    }
}

/// Half a texel is in the matrix or in the viewport, and never in both [HSM, "Direct3D API Details"].
#[test]
fn direct3d_s_half_texel_is_made_up_for_once() {
    let moved = |addressing: &str| {
        let plan = plan("box.toml", &[addressing, "size=64"]);
        let (_, depth) = draws(&plan).into_iter().find(|pass| pass.0 == "light 0: depth").unwrap();
        depth.batches[0].draws[0].clip_from_model
    };
    let [opengl, matrix, viewport] =
        ["addressing=opengl", "addressing=direct3d", "addressing=direct3d-viewport"].map(moved);
    let flipped = glam::DMat4::from_scale(glam::DVec3::new(1.0, -1.0, 1.0)) * opengl;
    assert!(viewport.abs_diff_eq(flipped, 1e-12));
    let half_pixel = glam::DMat4::from_translation(glam::DVec3::new(1.0 / 64.0, 1.0 / 64.0, 0.0));
    assert!(matrix.abs_diff_eq(half_pixel * flipped, 1e-12));
}
