//! Figures of projected light: beams, laws of distance, and coordinates that swim [Segal 1992, 2 and 3.2].

use super::{Figure, Panel};
use crate::scene::Embedded;

macro_rules! embedded {
    ($name:literal) => {
        Embedded {
            path: concat!("data/figures/", $name),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/figures/", $name)),
            pictures: &[
                ("../textures/floor.png", include_bytes!("../../data/textures/floor.png")),
                ("../textures/barn-doors.png", include_bytes!("../../data/textures/barn-doors.png")),
                ("../textures/head-light.png", include_bytes!("../../data/textures/head-light.png")),
            ],
        }
    };
}

const YARD: Embedded = embedded!("beams.toml");
const LAMP_WALL: Embedded = embedded!("lamp-wall.toml");
const SWIM: Embedded = embedded!("swimming.toml");

const fn panel(title: &'static str, set: &'static [&'static str]) -> Panel {
    Panel { title, set, view: None, stage: None, counts: None }
}

pub const BEAMS: Figure = Figure {
    name: "segal-beams",
    title: "Beams by intensity maps",
    source: "Segal 1992, 3.2",
    scene: YARD,
    columns: 3,
    panels: &[
        panel(
            "landing light: cos^90",
            &["light.0.cone=44", "light.0.beam={ exponent = 90 }", "light.0.color=[2, 2, 1.9]"],
        ),
        panel("taxi light: wide and low", &["light.0.color=[0, 0, 0]", "light.1.color=[1.8, 1.75, 1.6]"]),
        panel(
            "flashlight: rings of its reflector",
            &[
                "light.0.cone=36",
                "light.0.beam={ profile = [0.75, 0.9, 1, 0.5, 0.45, 0.7, 0.35, 0.16, 0.10, 0.05, 0] }",
            ],
        ),
        panel(
            "head lights: two lenses with a cut-off",
            &["light.0.color=[0, 0, 0]", "light.2.color=[1.8, 1.75, 1.6]", "light.3.color=[1.8, 1.75, 1.6]"],
        ),
        panel("barn doors: a shield", &["light.0.color=[0, 0, 0]", "light.4.color=[1.6, 1.55, 1.4]"]),
        panel(
            "the same through a lens, r (1 + 0.3 r^2)",
            &["light.0.color=[0, 0, 0]", "light.5.color=[1.6, 1.55, 1.4]"],
        ),
    ],
    caption: "One texture holds what a lamp's reflector, lens and doors make of its light. It is projected through the light's \
              frustum and dark beyond its border; shadows fall as before. A power of the cosine by a map (a) is GL's own \
              spotlight to two codes of 255, but at every pixel, not at vertices alone. The lens (f) draws what it shows \
              together.",
};

pub const FALLOFF: Figure = Figure {
    name: "segal-falloff",
    title: "Planar and radial distance",
    source: "Segal 1992, 3.2",
    scene: LAMP_WALL,
    columns: 3,
    panels: &[
        panel("planar: (2 / d)^2, d along the axis", &["light.falloff={ by = 'z', law = 'inverse-square', d0 = 2.0 }"]),
        panel("radial: (2 / d)^2, d to the light", &["light.attenuation=[0, 0, 0.25]"]),
        panel(
            "planar, up and down: surfaces of equal light",
            &[
                "light.falloff={ by = 'z', table = [[1.0, 1.0], [1.4, 0.45], [1.8, 0.9], [2.2, 0.4], [2.6, 0.8], [3.0, 0.35], [3.4, 0.7], [3.8, 0.3], [4.2, 0.6], [4.4, 0.5]] }",
            ],
        ),
    ],
    caption: "A texture over the depth of the light's own projection makes light fade with the distance along its axis: the wall, \
              square to it, is evenly lit (a), and surfaces of equal light are planes (c). By the true distance (b) it darkens \
              towards its corners, by the square of the cosine of the angle from the axis: a quarter at 60 degrees.",
};

pub const SWIMMING: Figure = Figure {
    name: "segal-swimming",
    title: "Coordinates without perspective swim",
    source: "Segal 1992, 2",
    scene: SWIM,
    columns: 2,
    panels: &[
        panel("with perspective", &["light.interpolate=perspective"]),
        panel("affine: linear in the picture", &["light.interpolate=affine"]),
        panel("with perspective, the eye moved", &["light.interpolate=perspective", "camera.eye=[7.4, 2.2, 2.2]"]),
        panel("affine, the eye moved", &["light.interpolate=affine", "camera.eye=[7.4, 2.2, 2.2]"]),
    ],
    caption: "The slide and its shadow lie still on the floor when the eye moves (a, c). Without division by w they are right at \
              the corners of the floor's two triangles alone: they break along its diagonal, and another eye sees them \
              elsewhere (b, d).",
};
