//! Figures of bump mapping: passes, vectors in tangent space, highlights and skins, key-framed models, models with shadow
//! volumes [GDC].

use super::panels::{embedded, panel, stage};
use super::{Figure, PanelStage, SceneChange, SkinMap};
use crate::scene::Embedded;
use crate::views::View;

const KNIGHT: Embedded = embedded!("knight.toml");
const ROOM: Embedded = embedded!("knight-room.toml");
const DOUGHNUT: Embedded = embedded!("scenes/", "doughnut.toml");

const THREE: &str = "shading.bump=three-pass";
const ONE: &str = "shading.bump=one-pass";
/// A light of which ambient and diffuse light exceed 1.
const BRIGHT: &str = "light.0.diffuse=[1.6, 1.6, 1.5]";

pub const PASSES: Figure = Figure {
    name: "gdc-bump-passes",
    title: "Bump mapping in three passes, and in one",
    source: "GDC 2001, \"Three Passes\", \"Same Math in a Single Pass on GeForce3\"",
    scene: KNIGHT,
    columns: 3,
    panels: &[
        stage("pass 1: ambient and diffuse light", &[THREE], PanelStage::After("ambient and diffuse light"))
            .note("N' · L from the normal map, times the shadow; clamped to 1."),
        panel("pass 2, colour: the decal", &[THREE], Some(View::Decal)).note("Multiplies what is there."),
        panel("pass 2, alpha: the gloss map", &[THREE], Some(View::Gloss))
            .note("Kept in the frame's alpha for pass 3."),
        stage("after pass 2", &[THREE], PanelStage::After("decals and gloss")),
        panel("pass 3: highlights, (N' · H)⁸", &[THREE], Some(View::Specular))
            .note("Added, times the gloss in the frame's alpha."),
        panel("the sum: three passes", &[THREE], None),
        panel("the same in one pass", &[ONE], None).note("Four textures, four general combiners.").from(5),
        stage(
            "difference of (f) and (g), 60 times as bright",
            &[],
            PanelStage::Difference { between: [5, 6], gain: 60 },
        )
        .note("Three passes round to eight bits after each of them."),
        panel("three passes in a light that is too bright", &[THREE, BRIGHT], None),
        panel("one pass in that light", &[ONE, BRIGHT], None).note("Brighter where (i) had to stop."),
        stage("difference of (i) and (j), 4 times as bright", &[], PanelStage::Difference { between: [8, 9], gain: 4 })
            .note("Pass 1 stops at 1 before the decal is multiplied; one pass does not."),
    ],
    caption: "Pictures of three passes and of one are the same wherever ambient and diffuse light stay below 1. The two dot \
              products need a normal map and a cube map that normalises vectors each: dual-textured hardware takes three passes \
              for them and the decal, hardware with four textures takes one.",
};

pub const VECTORS: Figure = Figure {
    name: "gdc-bump-vectors",
    title: "A height field becomes normals, and the light's vectors come to them",
    source: "GDC 2001, \"Converting Height-Field to a Normal Map\", \"Tangent Space Basis is a Gateway for Vectors\"",
    scene: DOUGHNUT,
    columns: 3,
    panels: &[
        stage("the height field: white is high", &[], PanelStage::Skin(SkinMap::Heights)),
        stage("its normal map: mostly chalk blue", &[], PanelStage::Skin(SkinMap::Normals))
            .note("Straight up is (½, ½, 1) as a colour. Red leans along s, green along t."),
        panel("the normal map on the surface", &[SIZE], Some(View::NormalMap)),
        panel("the vector to the light in tangent space", &[SIZE], Some(View::TangentLight))
            .note("Smooth, as the torus's tangents are. Blue: the light is above the surface."),
        panel("the half-angle vector in tangent space", &[SIZE], Some(View::TangentHalf))
            .note("It depends on the eye, too."),
        panel("bumped normals in world space", &[SIZE], Some(View::Normal)).note("Green looks up."),
    ],
    caption: "Vectors are shown as colours, v / 2 + ½. Normals stay in the surface's own space, where one map serves every \
              place and pose; the vectors to the light and half-way to the eye are turned into that space at each vertex and \
              interpolated. Their dot products with (c) light the bumps.",
};

const SIZE: &str = "image.size=[400, 300]";
const FLAT: &str = "object.0.material.bump.scale=0";
macro_rules! dark {
    ($light:literal) => {
        concat!("light.", $light, ".diffuse=[0, 0, 0]")
    };
    ($light:literal, specular) => {
        concat!("light.", $light, ".specular=[0, 0, 0]")
    };
}
const NO_0: [&str; 2] = [dark!("0"), dark!("0", specular)];
const NO_1: [&str; 2] = [dark!("1"), dark!("1", specular)];
const NO_2: [&str; 2] = [dark!("2"), dark!("2", specular)];

pub const TORUS: Figure = Figure {
    name: "gdc-bump-torus",
    title: "A doughnut under three lights",
    source: "GDC 2001, \"GPU Bump Mapping for More than Just Doughnuts\"",
    scene: DOUGHNUT,
    columns: 3,
    panels: &[
        panel("without bumps: a flat height field", &[SIZE, FLAT], None),
        panel("bump-mapped", &[SIZE], None).note("The outline stays smooth: no vertex has moved."),
        panel("bumps twice as high", &[SIZE, "object.0.material.bump.scale=10"], None),
        panel("the warm lamp from the right alone", &[SIZE, NO_1[0], NO_1[1], NO_2[0], NO_2[1]], None)
            .note("With its shadow on the floor; bumps cast none."),
        panel("the blue lamp from the left alone", &[SIZE, NO_0[0], NO_0[1], NO_2[0], NO_2[1]], None),
        panel("the red light from behind alone", &[SIZE, NO_0[0], NO_0[1], NO_1[0], NO_1[1]], None),
    ],
    caption: "Each light is turned into the surface's tangent space and lights the same normal map: its bumps are bright on \
              their sides towards it. A torus has a formula, and its tangents are derivatives of it.",
};

pub const GLOSS: Figure = Figure {
    name: "gdc-gloss",
    title: "A gloss map: where a surface shines",
    source: "GDC 2001, \"Gloss Map Modulates Per-fragment Specular\"",
    scene: KNIGHT,
    columns: 3,
    panels: &[
        panel("the gloss map: white shines", &[], Some(View::Gloss))
            .note("Plate and blade shine; cloth and leather do not."),
        panel("highlights without it", &[], Some(View::Specular)).changed(SceneChange::WithoutGloss),
        panel("highlights with it", &[], Some(View::Specular)),
        panel("the decal", &[], Some(View::Decal)),
        panel("the picture without it", &[], None)
            .changed(SceneChange::WithoutGloss)
            .note("Cloth, belt and shield look wet."),
        panel("the picture with it", &[], None).from(4),
    ],
    caption: "Gloss multiplies the highlights, texel by texel. It may stand in the decal's alpha, which a picture of colours \
              leaves free; here it is a picture of its own.",
};

const FROM_BELOW: [&str; 3] =
    ["light.0.position=[88.0, -12.0, 66.0]", "light.0.target=[0.0, 4.0, 0.0]", "light.0.diffuse=[0.95, 0.95, 0.9]"];

pub const PRE_LIT: Figure = Figure {
    name: "gdc-pre-lit",
    title: "Pre-lit decals are lit twice",
    source: "GDC 2001, \"Warning about Pre-lit Decal Skins\", \"Decal Skin Comparison\"",
    scene: KNIGHT,
    columns: 3,
    panels: &[
        panel("an un-lit decal", &FROM_BELOW, Some(View::Decal))
            .follows_up()
            .note("Materials, not colours in some light."),
        panel("the same without bumps", &[FROM_BELOW[0], FROM_BELOW[1], FROM_BELOW[2], FLAT], None),
        panel("bump-mapped: right", &FROM_BELOW, None)
            .note("Bumps are bright on their lower sides: the lamp stands low."),
        panel("pre-lit from above", &FROM_BELOW, Some(View::Decal))
            .changed(SceneChange::PreLit)
            .follows_up()
            .note("Light and bumps are painted into the decal."),
        panel("pre-lit, without bump mapping", &FROM_BELOW, None)
            .changed(SceneChange::PreLitFlat)
            .note("Painted bumps look the same in any light."),
        panel("wrong on purpose: pre-lit and bump-mapped", &FROM_BELOW, None)
            .changed(SceneChange::PreLit)
            .from(2)
            .note("Two lights that disagree: what looks down is dark although the lamp is below."),
    ],
    caption: "The decals of older games have light from above painted in. Under per-pixel light they are lit twice, and the \
              painted light stays where it is when the lamp moves. A decal for bump mapping has materials alone. The number \
              is the correlation of a pixel's brightness in the decal with the upward component of its normal.",
};

macro_rules! pose {
    ($first:literal, $second:literal, $blend:literal) => {
        &[concat!("object.0.frames=[\"", $first, "\", \"", $second, "\"]"), concat!("object.0.blend=", $blend)]
    };
}

pub const KEY_FRAMES: Figure = Figure {
    name: "gdc-key-frames",
    title: "Key frames, and what lies between them",
    source: "GDC 2001, \"Examples of Quake 2 Model Keyframes\", \"More Bump Mapped Knight Examples\"",
    scene: KNIGHT,
    columns: 3,
    panels: &[
        panel("standing: key frame stand1", pose!("stand1", "stand2", "0"), None),
        panel("running: key frame run2", pose!("run2", "run3", "0"), None),
        panel("running: key frame run6", pose!("run6", "run7", "0"), None),
        panel("a quarter of the way from (b) to (c)", pose!("run2", "run6", "0.25"), None),
        panel("half-way", pose!("run2", "run6", "0.5"), None),
        panel("three quarters", pose!("run2", "run6", "0.75"), None),
    ],
    caption: "Vertices move on straight lines between two key frames, and the tangent bases with them; the maps stay as they \
              are. Key frames of a model follow each other closely: far apart as here, what turns becomes shorter on its way. \
              Light and shadow follow the pose: bumps are lit per pixel, the shadow is that of the moved vertices.",
};

pub const KNIGHT_ROOM: Figure = Figure {
    name: "gdc-knight-room",
    title: "A bump-mapped model with stencil shadow volumes",
    source: "GDC 2001, \"Combining Shadow Volumes With Bump Mapped Models\"",
    scene: ROOM,
    columns: 3,
    panels: &[
        panel("the picture: bumps in one pass a light", &[], None).note("A lamp that lights all round."),
        panel("the volumes: outsides orange, insides blue", &[], Some(View::Volume)),
        panel("possible silhouettes, as the light sees them", &[], Some(View::Silhouette))
            .note("Edges of the moved vertices; bumps have none."),
        panel("the stencil count: green lit, red shadowed", &[], Some(View::StencilColors)),
        panel("the light's diffuse part, without shadow", &[], Some(View::Diffuse)),
        panel("without bumps", &[FLAT], None),
    ],
    caption: "Ambient light first, then the volumes of knight and furniture into the stencil buffer, then the lamp's light with \
              its bumps where the count is 0. The volumes follow the interpolated pose. They know nothing of the bumps: these \
              are shaded, and cast no shadow on each other.",
};
