//! Figures that explain: what a bias does, which layers a map may hold, what a filter weighs. Most of their panels are measured
//! by the ray tracer.

use super::cut::{CutLine, MapCut};
use super::diagram::Kernel;
use super::panels::{embedded, panel, stage};
use super::sweep::Sweep;
use super::{Figure, PanelStage};
use crate::output::canvas::Color;
use crate::scene::Embedded;
use crate::views::View;

const OFFSET: Embedded = embedded!("offset.toml");
const LAYERS: Embedded = embedded!("layers.toml");
const LANTERN: Embedded = embedded!("lantern.toml");
const STRETCHED: Embedded = embedded!("stretched.toml");
const WORKSHOP: Embedded = embedded!("workshop.toml");

const BLUE: Color = [0, 114, 178];
const GREEN: Color = [0, 130, 95];
const INK: Color = [40, 42, 50];
const GRAY: Color = [140, 144, 154];

const NO_OFFSET: &str = "light.shadow.offset={ factor = 0.0, units = 0.0 }";
const SMALL: &str = "light.shadow.offset={ factor = 0.0, units = 20000.0 }";
const LARGE: &str = "light.shadow.offset={ factor = 0.0, units = 400000.0 }";
const SLOPED: &str = "light.shadow.offset={ factor = 1.1, units = 4.0 }";

const LINE: CutLine =
    CutLine { name: "", set: &[], color: INK, width: 2.0, is_dashed: false, in_steps: false, is_other_layer: false };

/// Eighteen whole texels of the block and of the floor before it, much enlarged.
const STAIRS: MapCut = MapCut {
    is_upright: true,
    // The middle of a texel.
    at: 0.398_437_5,
    part: [0.468_75, 0.5625],
    lines: &[
        CutLine { name: "surface", set: &["light.shadow.size=3072", NO_OFFSET], ..LINE },
        CutLine { name: "map", set: &[NO_OFFSET], color: BLUE, in_steps: true, ..LINE },
        CutLine { name: "map with its offset by slope", set: &[SLOPED], color: GREEN, in_steps: true, ..LINE },
    ],
    map: Some(1),
    behind: "behind the map: acne",
};

pub const POLYGON_OFFSET: Figure = Figure {
    name: "hsm-3-offset",
    title: "Polygon offset: none, constant, too much, by slope",
    source: "Hardware Shadow Mapping, Figure 3 and \"Why Is Polygon Offset Needed?\"",
    scene: OFFSET,
    columns: 3,
    panels: &[
        panel("no offset", &[NO_OFFSET], None)
            .note("A texel holds one depth; half of the surface that it covers lies behind it and shadows itself.")
            .wrong(),
        panel("constant, 20 000 units", &[SMALL], None)
            .note("Surfaces that face the light are clean. The steeper one is, the deeper a texel's far side lies.")
            .wrong(),
        panel("constant, 400 000 units", &[LARGE], None)
            .note("Enough for every slope, and too much for all else: shadows come away from what casts them.")
            .wrong(),
        panel("by slope: factor 1.1, 4 units", &[SLOPED], None)
            .note("Each polygon is pushed back by its change of depth across a texel, and by a few units for rounding.")
            .wrong(),
        stage("the truth, by ray tracing", &[NO_OFFSET], PanelStage::Truth).note("Shadows begin where things touch."),
        stage("what (a) has wrong", &[NO_OFFSET], PanelStage::Wrong).note(
            "Orange: false shadow. Blue: leak. Pale blue: leaks on faces turned from the light, kept dark by shading.",
        ),
        stage("a cut through the map: depths of eighteen texels, the block's face and the floor before it", &[], PanelStage::Cut(&STAIRS))
            .note("The map is a stair along the surface. Half of each texel lies behind it, and by how much grows with the slope: an offset that follows the slope moves each stair just behind the surface.")
            .wide(),
        stage("what (c) has wrong", &[LARGE], PanelStage::Wrong).note("The leak runs along every contact."),
    ],
    caption: "The map is sampled at other points than the picture. Their depths differ by slope times distance, not by rounding \
              alone: one constant is too small for steep surfaces or too large for contacts. GL's polygon offset, factor × \
              slope + units × r, is made for that. Shares are of what faces the light; a map of 192 × 192 texels, nearest filter.",
};

const BY_UNITS: Sweep = Sweep {
    set: "light.shadow.offset={ factor = 0.0, units = {} }",
    values: &[1e3, 3e3, 1e4, 2e4, 4e4, 7e4, 1e5, 1.5e5, 2.5e5, 4e5, 7e5, 1.2e6],
    label: "constant offset, in units of 2⁻²⁴ of the depth range",
    ticks: &[1e3, 1e4, 1e5, 1e6],
    is_logarithmic: true,
};
const BY_FACTOR: Sweep = Sweep {
    set: "light.shadow.offset={ factor = {}, units = 4.0 }",
    values: &[0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0],
    label: "offset by slope: factor, with 4 units",
    ticks: &[0.0, 1.0, 2.0, 3.0, 4.0],
    is_logarithmic: false,
};

pub const BIAS_SWEEP: Figure = Figure {
    name: "hsm-bias-sweep",
    title: "How much bias? Acne against leak",
    source: "Hardware Shadow Mapping, \"Why Is Polygon Offset Needed?\"",
    scene: OFFSET,
    columns: 3,
    panels: &[
        stage("a constant offset", &[], PanelStage::Sweep(&BY_UNITS))
            .note("Acne falls while leak rises; where both are small together, neither is gone.")
            .wide(),
        panel("the best constant: 70 000 units", &["light.shadow.offset={ factor = 0.0, units = 70000.0 }"], None).wrong(),
        stage("an offset by slope", &[], PanelStage::Sweep(&BY_FACTOR))
            .note("From a factor of one on only edges are left: each texel lies behind the surface that it was drawn from.")
            .wide(),
        panel("factor 1.1, 4 units", &[SLOPED], None).wrong(),
    ],
    caption: "Each point is a picture that was compared with ray-traced truth, pixel by pixel. What is left at the best bias \
              are the map's own texels along the shadows' edges: 192 × 192 of them, with the nearest filter. Shares are of what faces the light.",
};

const NEAREST: [&str; 2] = ["light.shadow.technique=shadow-map", NO_OFFSET];
const BACKS: [&str; 2] = ["light.shadow.technique=second-depth", NO_OFFSET];
const MIDPOINT: [&str; 2] = ["light.shadow.technique=midpoint", "light.shadow.average=eye-linear"];
const FLOOR_ALONE: [&str; 4] =
    [NO_OFFSET, "object.1.casts_shadow=false", "object.2.casts_shadow=false", "object.3.casts_shadow=false"];

const TWO_LAYERS: MapCut = MapCut {
    is_upright: false,
    at: 0.56,
    part: [0.12, 0.88],
    lines: &[
        CutLine { name: "first layer", set: &NEAREST, color: BLUE, ..LINE },
        CutLine { name: "midpoint", set: &MIDPOINT, color: GREEN, width: 3.0, ..LINE },
        CutLine { name: "second layer", set: &MIDPOINT, color: GRAY, is_other_layer: true, ..LINE },
        CutLine { name: "floor", set: &FLOOR_ALONE, color: INK, width: 1.5, is_dashed: true, ..LINE },
    ],
    map: None,
    behind: "",
};

pub const WOO_LAYERS: Figure = Figure {
    name: "hsm-woo-layers",
    title: "Woo's two layers, and the middle between them",
    source: "Hardware Shadow Mapping, \"Advantages and Limitations\"",
    scene: LAYERS,
    columns: 3,
    panels: &[
        stage("Woo's map; the cut runs along the red line", &MIDPOINT, PanelStage::Marked(&TWO_LAYERS)).wrong(),
        stage("the cut: depths along one row of the map", &[], PanelStage::Cut(&TWO_LAYERS))
            .note("The light is above. Each solid thing has a layer where light enters and one where it would leave; the midpoint lies inside, away from both.")
            .wide(),
        panel("the first layer as the map, no offset", &NEAREST, None)
            .note("Every lit surface is the map itself: rounding and texels decide.")
            .wrong(),
        panel("the first layer", &NEAREST, Some(View::LightDepth)).note("Near is dark. Lit surfaces lie in this map."),
        panel("the midpoints", &MIDPOINT, Some(View::LightDepth)).note("The same with every surface pushed into its solid."),
    ],
    caption: "A first pass keeps the nearest depths. A second one rejects them and keeps the nearest mean of both: halfway between \
              the first two layers. Lit surfaces lie before it by half the thickness of what casts, shadowed ones behind it, and \
              no offset has to be found. The second layer of the graph is twice the midpoint less the first. Shares are of what faces the light.",
};

const EDGE_ON: [&str; 3] = ["camera.eye=[1.6, 0.9, 3.0]", "camera.target=[0.5, 0.07, 1.05]", "camera.fov_y=12"];

pub const SECOND_DEPTH: Figure = Figure {
    name: "hsm-second-depth",
    title: "Second depth: back faces in the map",
    source: "Hardware Shadow Mapping, \"Advantages and Limitations\"",
    scene: LAYERS,
    columns: 3,
    panels: &[
        panel("nearest depths, no offset", &NEAREST, None).note("Acne on all that is lit.").wrong(),
        panel("back faces, no offset", &BACKS, None).note("Front faces are far from what the map holds: no acne.").wrong(),
        stage("what (b) has wrong", &BACKS, PanelStage::Wrong)
            .note("The error has moved to faces turned away from the light (pale): shading keeps them dark. Of the rest, ledges leak (blue)."),
        panel(
            "a ledge, by back faces",
            &[BACKS[0], BACKS[1], EDGE_ON[0], EDGE_ON[1], EDGE_ON[2]],
            None,
        )
        .note("Where the block stands, its back is the floor's own depth: light leaks in.")
        .wrong(),
        panel("the same by Woo's midpoints", &[MIDPOINT[0], MIDPOINT[1], EDGE_ON[0], EDGE_ON[1], EDGE_ON[2]], None)
            .note("The map lies halfway up the block.")
            .wrong(),
        stage("the truth, by ray tracing", &[EDGE_ON[0], EDGE_ON[1], EDGE_ON[2]], PanelStage::Truth),
    ],
    caption: "Drawing back faces alone needs no offset where light falls: what a lit point is compared with is the far side of \
              the solid under it. Casters must be closed, and their back faces must lie apart from the next surface: a \
              back that touches the floor is compared with the floor. Shares are of what faces the light.",
};

/// A close view of the ball's shadow on a coarse map.
const EDGE: [&str; 4] =
    ["camera.eye=[-2.4, 2.2, 1.2]", "camera.target=[-0.93, 0.0, 0.1]", "camera.fov_y=13", "light.shadow.size=128"];

macro_rules! kernel {
    ($title:literal, $note:literal, $filter:literal, $kernel:literal, $taps:literal, $linear:literal) => {
        stage(
            $title,
            &[EDGE[0], EDGE[1], EDGE[2], EDGE[3], $filter, $kernel],
            PanelStage::Kernel(Kernel { taps: $taps, is_linear: $linear }),
        )
        .note($note)
    };
}

pub const KERNELS: Figure = Figure {
    name: "lec-kernels",
    title: "Kernels of percentage-closer filtering",
    source: "Projective texturing and shadow maps, lecture, \"Hardware Shadow Map Filtering\"",
    scene: LAYERS,
    columns: 3,
    panels: &[
        kernel!(
            "1, nearest",
            "One texel, one comparison: lit or not.",
            "light.shadow.filter=nearest",
            "light.shadow.kernel=1x1",
            1,
            false
        ),
        kernel!(
            "1, GL_LINEAR",
            "Four comparisons, weighed by place: a ramp of one texel.",
            "light.shadow.filter=linear",
            "light.shadow.kernel=1x1",
            1,
            true
        ),
        kernel!(
            "2 × 2, GL_LINEAR",
            "Four lookups, nine texels: a ramp of two.",
            "light.shadow.filter=linear",
            "light.shadow.kernel=2x2",
            2,
            true
        ),
        kernel!(
            "3 × 3, nearest",
            "Nine texels of one weight: nine steps, and no more.",
            "light.shadow.filter=nearest",
            "light.shadow.kernel=3x3",
            3,
            false
        ),
        kernel!(
            "3 × 3, GL_LINEAR",
            "Sixteen texels, smooth between them.",
            "light.shadow.filter=linear",
            "light.shadow.kernel=3x3",
            3,
            true
        ),
        kernel!(
            "5 × 5, GL_LINEAR",
            "Thirty-six texels: a ramp of five.",
            "light.shadow.filter=linear",
            "light.shadow.kernel=5x5",
            5,
            true
        ),
    ],
    caption: "Depths are compared first, and the answers are averaged: never the depths. In the corners: how much each texel of the \
              map weighs for the orange point. One lookup by GL_LINEAR compares four texels; n × n of them, a texel apart, weigh a \
              box of n texels around the point. A map of 128 × 128 texels, seen closely.",
};

pub const MIPMAPS: Figure = Figure {
    name: "lec-mipmaps",
    title: "A projected image at a grazing angle, and its mipmaps",
    source: "Projective texturing and shadow maps, lecture, \"About Projective Texturing\"",
    scene: STRETCHED,
    columns: 3,
    panels: &[
        panel("nearest", &["light.filter=nearest"], None)
            .note("One texel a pixel, wherever it falls: far away it is chance.")
            .against_fine(),
        panel("linear", &["light.filter=linear"], None)
            .note("Four texels a pixel: smooth nearby, chance again where a pixel covers more.")
            .against_fine(),
        panel("trilinear", &["light.filter=trilinear"], None)
            .note(
                "Two mipmap levels, chosen by the longer side of a pixel's footprint: no aliasing, but too much blur.",
            )
            .against_fine(),
        stage("the mean of many samples a pixel", &[], PanelStage::Fine).note("What the filters are measured against."),
        panel(
            "texels of the image a pixel",
            &["light.shadow.technique=shadow-map", "light.shadow.size=512", "light.law=lit"],
            Some(View::TexelsPerPixel),
        )
        .note("Each colour is a factor of two, a level: 1 takes the image itself, 2 its first level."),
        panel(
            "trilinear, close to the border",
            &["camera.eye=[-4.3, 0.45, -5.2]", "camera.target=[-5.8, 0.0, -7.4]"],
            None,
        )
        .note("Beyond the image it is dark at every level: no border smears."),
    ],
    caption: "Projecting shrinks an image as texturing does. A pixel far away covers many texels, and a filter that takes four of \
              them flickers when the eye moves. Mipmaps hold the means beforehand. The level follows from the texels between \
              neighbouring pixels, the longer side of what one covers: at a grazing angle the other side is blurred with it.",
};

pub const CUBE_MAP: Figure = Figure {
    name: "hsm-cube-map",
    title: "A point light: six maps around a lamp",
    source: "Hardware Shadow Mapping, \"Advantages and Limitations\"",
    scene: LANTERN,
    columns: 3,
    panels: &[
        panel("the lamp lights all round", &[], None).note("Shadows cross from wall to wall without a seam.").wrong(),
        panel("the six faces, unfolded: depth from the lamp", &[], Some(View::LightDepth))
            .note("Near is dark. Left to right: −x, +z, +x, −z; above and below: +y and −y."),
        stage("the face that each pixel is looked up in", &[], PanelStage::Faces)
            .note("Red: where one frustum of 90 degrees ends and the next begins."),
    ],
    caption: "A spotlight's map covers less than half of the directions. Around a lamp six square frusta stand, the faces of a \
              cube map: a direction picks the face by its largest coordinate, and is compared with the depth along that axis. Faces \
              without a caster, or without anything that is seen, need not be drawn.",
};

pub const GEOMETRY: Figure = Figure {
    name: "segal-1-geometry",
    title: "A projected texture, as the eye sees it",
    source: "Segal 1992, 2 and Figure 1",
    scene: WORKSHOP,
    columns: 2,
    panels: &[
        stage("one point, two projections", &[], PanelStage::Geometry)
            .note("The rasterizer walks over the screen. It carries the light's coordinates along, divided by the eye's w, and divides once more at each pixel.")
            .wide(),
    ],
    caption: "A point of a surface has two sets of homogeneous coordinates: the eye's, whose quotients are its place on the \
              screen, and the light's, whose quotients are its place in the slide. Projecting a texture is texturing with \
              another divisor, xˡ / wˡ in place of a vertex's own s: no more work for each pixel.",
};
