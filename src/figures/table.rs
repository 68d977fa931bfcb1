//! Every figure. Captions say what can be seen; the test figures checks that against pixels.

use super::panels::{embedded, panel, stage};
use super::{Figure, Panel, PanelStage};
use crate::scene::Embedded;
use crate::views::View;

const WORKSHOP: Embedded = embedded!("workshop.toml");
const LAMP: Embedded = embedded!("lamp.toml");
const BOXES: Embedded = embedded!("boxes.toml");
const NESTED: Embedded = embedded!("nested.toml");
const SLIDE: Embedded = embedded!("slide.toml");
const SPOTLIGHT: Embedded = embedded!("spotlight.toml");

/// A close view of the teapot's shadow on the floor.
const CLOSE: [&str; 3] = ["camera.eye=[4.3, 3.4, 3.6]", "camera.target=[1.15, 0.2, -0.45]", "camera.fov_y=26"];

/// A picture as large as the map, both square: the roles of eye and light can be swapped.
const SQUARE: [&str; 3] = ["image.size=[300, 300]", "camera.fov_y=48", "light.shadow.size=300"];

/// The roles swapped: a light in the eye's place, of its angle and as many texels as the eye has pixels, and the eye in the
/// light's, at `eye`, with a pixel for each texel of the map.
macro_rules! from_the_light {
    ($eye:literal, $target:literal) => {
        Panel {
            title: "from the light: pixels of the eye a texel",
            set: &[
                SQUARE[0],
                SQUARE[2],
                $eye,
                $target,
                "camera.fov_y=50",
                "light.position=[2.3, 3.1, 6.2]",
                "light.target=[0.1, 0.5, 0.0]",
                "light.cone=48",
                "light.shape=frustum",
            ],
            counts: Some("1 pixel a texel"),
            ..panel("", &[], Some(View::TexelsPerPixel)).map(300)
        }
    };
}

/// A light over the eye's shoulder, and one against it.
const BESIDE: [&str; 4] =
    ["light.position=[2.9, 3.9, 6.6]", "light.target=[0.1, 0.3, -0.1]", "light.cone=50", "light.shape=frustum"];
const AGAINST: [&str; 4] =
    ["light.position=[-0.4, 4.0, -5.0]", "light.target=[0.9, 0.0, 1.4]", "light.cone=50", "light.shape=frustum"];

/// All figures, in the order of their documents.
pub static FIGURES: &[Figure] = &[
    Figure {
        name: "hsm-title",
        title: "The eye's view without and with shadows",
        source: "Hardware Shadow Mapping, title picture",
        scene: WORKSHOP,
        columns: 2,
        panels: &[
            panel("unshadowed", &["light.shadow.technique=none"], None),
            panel("shadowed by a depth map of 1024 × 1024", &[], None),
        ],
        caption: "Without shadows nothing tells whether the objects stand on the floor or float. The shadow map changes no \
                  geometry: one more texture in the same lit pass.",
    },
    Figure {
        name: "hsm-2-light-view",
        title: "How a shadow map comes about",
        source: "Hardware Shadow Mapping, Figure 2",
        scene: WORKSHOP,
        columns: 3,
        panels: &[
            panel("the eye's view, shadowed", &[], None),
            panel("the scene as the light sees it", &[], Some(View::LightView)),
            panel("the shadow map: depth from the light", &[], Some(View::LightDepth)),
        ],
        caption: "What the light sees is lit: in its own view (b) no shadow is to be seen. The depth buffer of that view is the \
                  shadow map (c). Depths are stretched, near dark and far bright.",
    },
    super::explained::POLYGON_OFFSET,
    super::explained::BIAS_SWEEP,
    Figure {
        name: "hsm-4-comparison",
        title: "What is compared: a point's own distance and the map's",
        source: "Hardware Shadow Mapping, Figure 4",
        scene: WORKSHOP,
        columns: 3,
        panels: &[
            panel("the eye's view, shadowed", &[], None),
            panel("each point's own distance from the light, r/q", &[], Some(View::LightDistance)),
            panel("the map projected onto the scene", &[], Some(View::ProjectedMap)),
        ],
        caption: "The map's depths projected onto the scene (c) equal each point's own distance (b) where the light reaches, and \
                  are less where something nearer stands in its way: those points are in shadow (a). Depths and distances are \
                  stretched, near dark and far bright; blue: outside the light's cone.",
    },
    Figure {
        name: "hsm-5-filtering",
        title: "NEAREST beside LINEAR on a coarse map",
        source: "Hardware Shadow Mapping, Figure 5",
        scene: WORKSHOP,
        columns: 3,
        panels: &[
            panel(
                "64 × 64, NEAREST: 0 or 1",
                &["light.shadow.size=64", "light.shadow.filter=nearest", CLOSE[0], CLOSE[1], CLOSE[2]],
                None,
            ),
            panel("64 × 64, LINEAR: four comparisons", &["light.shadow.size=64", CLOSE[0], CLOSE[1], CLOSE[2]], None),
            panel("1024 × 1024, LINEAR", &CLOSE, None),
        ],
        caption: "A linear filter on a depth texture weighs the results of four comparisons, never depths. It softens the \
                  steps of a coarse map to a ramp of one texel; finer shapes come only from more texels.",
    },
    Figure {
        name: "hsm-6-dueling-frusta",
        title: "Sampling frequency: dueling frusta",
        source: "Hardware Shadow Mapping, Figure 6",
        scene: WORKSHOP,
        columns: 3,
        panels: &[
            panel(
                "the light over the eye's shoulder",
                &[SQUARE[0], SQUARE[1], SQUARE[2], BESIDE[0], BESIDE[1], BESIDE[2], BESIDE[3]],
                None,
            )
            .map(300),
            panel(
                "texels of the map a pixel of the eye's view",
                &[SQUARE[0], SQUARE[1], SQUARE[2], BESIDE[0], BESIDE[1], BESIDE[2], BESIDE[3]],
                Some(View::TexelsPerPixel),
            )
            .map(300),
            from_the_light!("camera.eye=[2.9, 3.9, 6.6]", "camera.target=[0.1, 0.3, -0.1]"),
            panel(
                "the light opposite the eye",
                &[SQUARE[0], SQUARE[1], SQUARE[2], AGAINST[0], AGAINST[1], AGAINST[2], AGAINST[3]],
                None,
            )
            .map(300),
            panel(
                "texels of the map a pixel of the eye's view",
                &[SQUARE[0], SQUARE[1], SQUARE[2], AGAINST[0], AGAINST[1], AGAINST[2], AGAINST[3]],
                Some(View::TexelsPerPixel),
            )
            .map(300),
            from_the_light!("camera.eye=[-0.4, 4.0, -5.0]", "camera.target=[0.9, 0.0, 1.4]"),
        ],
        caption: "A map of 300 × 300 texels, and as many pixels. Where eye and light look the same way, texels are spent evenly \
                  (b, c). Where they face each other, the floor that is nearest to the eye is farthest from the light: it has \
                  the fewest texels where the most pixels look (e, warm), and far away texels crowd that no pixel needs (e, \
                  cold). In the light's view (f) the part that needs many more texels than it has, cold there, is small; the \
                  warm rest is what the eye hardly uses. Dark: what the eye does not see.",
    },
    super::explained::CUBE_MAP,
    super::explained::WOO_LAYERS,
    super::explained::SECOND_DEPTH,
    super::explained::KERNELS,
    super::explained::MIPMAPS,
    Figure {
        name: "lec-dimming",
        title: "Dimming: how much diffuse light a shadow leaves",
        source: "Projective texturing and shadow maps, lecture, \"Advice for Shadowed Illumination Model\"",
        scene: WORKSHOP,
        columns: 3,
        panels: &[
            panel("dimming 0: ambient light alone", &["light.shadow.dimming=0.0"], None),
            panel("dimming 40 %", &["light.shadow.dimming=0.4"], None),
            panel("dimming 100 %: highlights alone are shadowed", &["light.shadow.dimming=1.0"], None),
        ],
        caption: "diffuseShade = dimming + (1 − dimming) shade. Forty percent keep the shape of what lies in shadow; specular \
                  light is taken away whole in every case.",
    },
    Figure {
        name: "lec-back-projection",
        title: "Back projection: q ≤ 0 must not be lit",
        source: "Hardware Shadow Mapping, \"Advantages and Limitations\"; lecture, \"Careful about Back Projecting Shadow Maps\"",
        scene: LAMP,
        columns: 2,
        panels: &[
            panel("cure: guard = \"auto\"", &[], None),
            panel("failure: no guard", &["light.shadow.guard=none"], None),
        ],
        caption: "The lamp shines at the right wall. Behind it s/q and t/q are in [0, 1] again, with q below 0: without a \
                  guard the projected picture appears on the left wall, too, turned by 180°, with a shadow of the \
                  ball that stands on the other side (b). Of six guards, which all show (a), the plan takes what the scene \
                  needs: the left wall is drawn without the lamp, the floor below it with a test per fragment.",
    },
    super::explained::GEOMETRY,
    Figure {
        name: "segal-3-slide",
        title: "A slide projector, and its three passes",
        source: "Segal 1992, 3.1 and Figure 3",
        scene: SLIDE,
        columns: 3,
        panels: &[
            stage("the slide", &[], PanelStage::Image),
            panel("the scene in ambient light and the slide's", &[], None),
            panel(
                "two projectors, red and cyan",
                &["light.0.color=[1.0, 0.30, 0.25]", "light.1.color=[0.25, 0.80, 1.0]"],
                None,
            ),
            stage("pass 1: depth; ambient light", &[], PanelStage::After("depth and ambient light")),
            stage("pass 2: the slide, added", &[], PanelStage::After("slide of light 0")),
            stage("pass 3: times the surfaces' colours", &[], PanelStage::After("surfaces' colours")),
        ],
        caption: "Projecting is texturing with another divisor: s/q and t/q of the projector find the texel. The light knows no \
                  angle and no occlusion: it falls through the box onto the floor and the wall behind it. Sums \
                  are made before the surfaces' colours are multiplied in; each further projector repeats pass 2.",
    },
    Figure {
        name: "segal-4-spotlight",
        title: "Spotlight and shadow together",
        source: "Segal 1992, 3.3 and Figure 4; lecture, \"Combine with Projective Texturing for Spotlight Shadows\"",
        scene: SPOTLIGHT,
        columns: 3,
        panels: &[
            panel("the shadow map", &[], Some(View::LightDepth)),
            stage("the intensity map", &[], PanelStage::Image),
            panel("both", &[], None),
            panel("the shadow alone", &[WITHOUT_IMAGE], None),
            panel("the intensity map alone", &["light.0.shadow.technique=none"], None),
            stage("the shade in destination alpha", &["shading.passes=shadow"], PanelStage::After("shade of light 0")),
        ],
        caption: "One light looks up two textures by the same coordinates: a depth, which is compared, and an intensity, which is \
                  a factor. Where both apply (c) is the product of (d) and (e). In three passes the comparison comes first, into \
                  alpha (f).",
    },
    Figure {
        name: "segal-three-passes",
        title: "Shadows in three passes, the last two for each light",
        source: "Segal 1992, 3.3",
        scene: SPOTLIGHT,
        columns: 3,
        panels: &[
            stage("pass 1: ambient light", &TWO_COLORS, PanelStage::After("ambient light")),
            stage("pass 2: the first light's shade, in alpha", &TWO_COLORS, PanelStage::After("shade of light 0")),
            stage("pass 3: its colour, by DST_ALPHA, ONE", &TWO_COLORS, PanelStage::After("light 0")),
            stage("pass 2 again: the second light's shade", &TWO_COLORS, PanelStage::After("shade of light 1")),
            stage("pass 3 again: the picture", &TWO_COLORS, PanelStage::After("light 1")),
            panel(
                "the same in one pass",
                &[TWO_COLORS[1], TWO_COLORS[2], TWO_COLORS[3], TWO_COLORS[4], TWO_COLORS[5]],
                None,
            ),
        ],
        caption: "A light's shade needs no more than one channel that is there already. Each light overwrites alpha, so \
                  that any number of coloured lights may follow; where both shadows meet, ambient light is left.",
    },
    Figure {
        name: "gdc-volumes",
        title: "Stencil shadow volumes",
        source: "GDC 2001, \"Visualizing Shadow Volumes\", \"Visualizing Stenciled Shadow Volume Tagging\"",
        scene: BOXES,
        columns: 2,
        panels: &[
            panel("the picture", &[], None),
            panel("the volumes: outsides orange, insides blue", &[], Some(View::Volume)),
            panel("possible silhouettes, as the light sees them", &[], Some(View::Silhouette)),
            panel("the stencil count: green lit, red shadowed", &[], Some(View::StencilColors)),
        ],
        caption: "From each edge between a face turned to the light and one turned away a quad is extruded away from the light. \
                  Entering a volume counts up, leaving it down; where the count is 0 at a visible point, nothing stands \
                  between it and the light. Where both volumes overlap the count is 2.",
    },
    Figure {
        name: "gdc-truncated",
        title: "Volumes that end too early",
        source: "GDC 2001, \"Polygons Very Close to the Light Source Cause Problems\", \"OpenGL Renders W=0 Polygons Correctly\"",
        scene: BOXES,
        columns: 2,
        panels: &[
            panel(
                "failure: extruded by 1.5",
                &["light.shadow.method=z-fail-truncated", "light.shadow.distance=1.5", LOW],
                None,
            ),
            panel("cure: vertices at infinity, w = 0", &["light.shadow.method=z-fail", LOW], None),
        ],
        caption: "The lower the light and the nearer to its occluder, the longer the shadow: a volume of a fixed length ends in \
                  mid air, and the floor behind is lit. Vertices at w = 0 end at infinity and need no length; the projection \
                  has its far plane there.",
    },
    Figure {
        name: "gdc-parity",
        title: "Parity counts modulo two",
        source: "GDC 2001, \"Stencil Inverting of Shadow Volume\", \"For Shadow Volumes With Intersecting Polygons\"",
        scene: BOXES,
        columns: 2,
        panels: &[
            panel("failure: one bit, inverted", &["light.shadow.method=parity"], None),
            panel("cure: counted", &["light.shadow.method=z-pass"], None),
        ],
        caption: "Where two volumes overlap, a bit that each of them inverts is 0 again: the floor in both shadows is lit. \
                  Counting up and down keeps 2 apart from 0.",
    },
    Figure {
        name: "gdc-eye-inside",
        title: "The eye inside a shadow volume",
        source: "GDC 2001, \"Shadow Volume Near Plane Clipping Artifacts\", \"Alternative to Near Plane Capping: Carmack's Reverse\"",
        scene: BOXES,
        columns: 3,
        panels: &[
            panel(
                "failure: plain z-pass",
                &["light.shadow.method=z-pass", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]],
                None,
            ),
            panel(
                "cure: z-pass, capped at the near plane",
                &["light.shadow.method=z-pass-capped", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]],
                None,
            ),
            panel("cure: z-fail", &["light.shadow.method=z-fail", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]], None),
            panel(
                "the count of (a)",
                &["light.shadow.method=z-pass", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]],
                Some(View::StencilColors),
            ),
            panel(
                "the count of (b)",
                &["light.shadow.method=z-pass-capped", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]],
                Some(View::StencilColors),
            ),
            panel(
                "the count of (c)",
                &["light.shadow.method=z-fail", EYE_INSIDE[0], EYE_INSIDE[1], EYE_INSIDE[2]],
                Some(View::StencilColors),
            ),
        ],
        caption: "With the eye in one shadow volume the way into it lies behind the near plane and is not counted: every count is \
                  one too low, −1 where 0 is right and 0 where 1 is, so that light and shadow change places. Caps on the near \
                  plane count the way in; z-fail counts behind the visible surface, where the eye's place does not matter.",
    },
    Figure {
        name: "stencil-width",
        title: "300 nested volumes in eight bits",
        source: "Ours: no document says how many bits of stencil a scene needs",
        scene: NESTED,
        columns: 2,
        panels: &[
            panel("INCR, DECR: stop at 255", &["light.shadow.count=saturate"], None),
            panel("INCR_WRAP, DECR_WRAP: modulo 256", &["light.shadow.count=wrap"], None),
        ],
        caption: "All 300 ways in are counted before all ways out. Counts that stop at 255 lose 45 of them for good: where the \
                  eye's ray has left all volumes but a few, too little is left and the far rim of the shadow is lit. Wrapping \
                  counts are right modulo 256; they fail only where a point lies in exactly 256 volumes.",
    },
    super::bumps::PASSES,
    super::bumps::VECTORS,
    super::bumps::TORUS,
    super::bumps::GLOSS,
    super::bumps::PRE_LIT,
    super::bumps::KEY_FRAMES,
    super::bumps::KNIGHT_ROOM,
    super::bump_errors::MIRRORED_SKIN,
    super::bump_errors::MIP_DIMMING,
    super::bump_errors::CUBE_MAPS,
    super::bump_errors::NINE_BITS,
    super::bump_errors::SELF_SHADOW,
    super::bump_errors::REPACKED_SKIN,
    super::bump_errors::HEIGHT_ERRORS,
    super::projected::DUST,
    super::projected::FOCUS,
    super::projected::SOFT_SHADOWS,
    super::projected::SWIMMING,
    super::projected::BEAMS,
    super::projected::FALLOFF,
    super::projected::PHOTOGRAPH,
];

/// The spotlight without its image.
const WITHOUT_IMAGE: &str = "light.0={ position = [-2.4, 3.6, 2.6], target = [0.1, 0.35, 0.0], cone = 46.0, near = 1.0, far = 12.0, shape = \"cone\", diffuse = [0.85, 0.85, 0.85], specular = [0.0, 0.0, 0.0], shadow = { technique = \"shadow-map\", size = 1024 } }";

/// Two coloured lights in place of the white one, by the passes of shadows in alpha.
const TWO_COLORS: [&str; 6] = [
    "shading.passes=shadow",
    "light.0.diffuse=[0.62, 0.38, 0.18]",
    "light.1.diffuse=[0.15, 0.32, 0.55]",
    "light.shape=frustum",
    "light.cone=70",
    "camera.eye=[3.6, 3.3, 4.6]",
];

/// A light that is hardly higher than the left box.
const LOW: &str = "light.position=[-2.0, 2.9, 0.5]";

/// A view from within the right box's shadow and no other, looking out of it over the lit floor.
const EYE_INSIDE: [&str; 3] = ["camera.eye=[1.3, 0.1, -0.1]", "camera.target=[3.6, 0.0, 1.4]", "camera.near=0.02"];
