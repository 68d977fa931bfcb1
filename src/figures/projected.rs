//! Figures of projected light: beams, laws of distance, affine texture coordinates, focus and soft shadows, photographs
//! [Segal 1992, 2 and 3], dusty air [LEC, "Combining Shadows with Atmospherics"].

use super::Figure;
use super::panels::{embedded, panel};
use crate::scene::Embedded;

const DUSTY_ROOM: Embedded = embedded!("dusty_room.toml");
const BOARDS: Embedded = embedded!("boards.toml");
const COLUMNS: Embedded = embedded!("columns.toml");
const YARD: Embedded = embedded!("beams.toml");
const LAMP_WALL: Embedded = embedded!("lamp-wall.toml");
const SWIM: Embedded = embedded!("swimming.toml");
const FACADE: Embedded = embedded!("facade.toml");

pub const BEAMS: Figure = Figure {
    name: "segal-beams",
    title: "Beams by intensity maps",
    source: "Segal 1992, 3.2",
    scene: YARD,
    columns: 3,
    panels: &[
        panel(
            "landing light: cos⁹⁰",
            &["light.0.cone=44", "light.0.beam={ exponent = 90 }", "light.0.color=[2, 2, 1.9]"],
            None,
        ),
        panel("taxi light: wide and low", &["light.0.color=[0, 0, 0]", "light.1.color=[1.8, 1.75, 1.6]"], None),
        panel(
            "flashlight: rings of its reflector",
            &[
                "light.0.cone=36",
                "light.0.beam={ profile = [0.75, 0.9, 1, 0.5, 0.45, 0.7, 0.35, 0.16, 0.10, 0.05, 0] }",
            ],
            None,
        ),
        panel(
            "head lights: two lenses with a cut-off",
            &["light.0.color=[0, 0, 0]", "light.2.color=[1.8, 1.75, 1.6]", "light.3.color=[1.8, 1.75, 1.6]"],
            None,
        ),
        panel("barn doors: a shield", &["light.0.color=[0, 0, 0]", "light.4.color=[1.6, 1.55, 1.4]"], None),
        panel(
            "the same through a lens, r (1 + 0.3 r²)",
            &["light.0.color=[0, 0, 0]", "light.5.color=[1.6, 1.55, 1.4]"],
            None,
        ),
    ],
    caption: "One texture holds what a lamp's reflector, lens and doors make of its light. It is projected through the light's \
              frustum and dark beyond its border; shadows fall as before. A power of the cosine by a map (a) is GL's own \
              spotlight to two codes of 255, but at every pixel, not at vertices alone. The lens (f) draws what it shows \
              together.",
};

/// No photograph: its camera looks away from all there is, and what it did not see keeps its own colour.
const DIRECT: [&str; 2] = ["object.material.photo.hidden=leave", "object.material.photo.target=[-6.3, 1.7, 30.0]"];
const SMEAR: &str = "object.material.photo.hidden=smear";

/// From the photograph's own place, and from above on its side.
const OWN: [&str; 3] = ["camera.eye=[-3.2, 1.7, 15.0]", "camera.target=[-0.1, 4.15, 0.0]", "camera.fov_y=38"];
const ABOVE: [&str; 2] = ["camera.eye=[-8.2, 7.6, 10.2]", "camera.target=[-0.1, 4.1, 0.0]"];

pub const PHOTOGRAPH: Figure = Figure {
    name: "segal-facade",
    title: "A photograph projected back onto a facade",
    source: "Segal 1992, 3.1",
    scene: FACADE,
    columns: 4,
    panels: &[
        panel("the photograph", &[OWN[0], OWN[1], OWN[2], DIRECT[0], DIRECT[1]], None),
        panel("from the right: drawn directly", &DIRECT, None),
        panel("the photograph, without a test of depth", &[SMEAR], None),
        panel("grey: what its eye did not see", &[], None),
        panel("projected back, from its own place", &OWN, None),
        panel("from the left: drawn directly", &[ABOVE[0], ABOVE[1], DIRECT[0], DIRECT[1]], None),
        panel("the photograph, without a test of depth", &[ABOVE[0], ABOVE[1], SMEAR], None),
        panel("grey: what its eye did not see", &ABOVE, None),
    ],
    caption: "One photograph (a) replaces all materials and lights: from its own place it is itself (e), from elsewhere (d, h) it \
              is the scene wherever its eye saw the surface, shadows included. Without a test of depth (c, g) it is smeared \
              onto what lies behind: the lamp and the balcony stand on the wall a second time, and the house's side repeats \
              its front. A depth map from the photograph's eye finds what it did not see.",
};

pub const FALLOFF: Figure = Figure {
    name: "segal-falloff",
    title: "Planar and radial distance",
    source: "Segal 1992, 3.2",
    scene: LAMP_WALL,
    columns: 3,
    panels: &[
        panel(
            "planar: (3 / d)², d along the axis",
            &["light.falloff={ by = 'z', law = 'inverse-square', d0 = 3.0 }"],
            None,
        ),
        panel("radial: (3 / d)², d to the light", &["light.attenuation=[0, 0, 0.111111]"], None),
        panel(
            "planar, up and down: surfaces of equal light",
            &[
                "light.falloff={ by = 'z', table = [[1.0, 1.0], [1.4, 0.45], [1.8, 0.9], [2.2, 0.4], [2.6, 0.8], [3.0, 0.35], [3.4, 0.7], [3.8, 0.3], [4.2, 0.6], [4.4, 0.5]] }",
            ],
            None,
        ),
    ],
    caption: "A texture over the depth of the light's own projection makes light fade with the distance along its axis: the wall, \
              square to it, is evenly lit (a), and surfaces of equal light are planes (c). By the true distance (b) it darkens \
              towards its corners, by the square of the cosine of the angle from the axis: a quarter at 60°.",
};

pub const SWIMMING: Figure = Figure {
    name: "segal-swimming",
    title: "Coordinates without perspective swim",
    source: "Segal 1992, 2",
    scene: SWIM,
    columns: 2,
    panels: &[
        panel("with perspective", &["light.interpolate=perspective"], None),
        panel("affine: linear in the picture", &["light.interpolate=affine"], None),
        panel(
            "with perspective, the eye moved",
            &["light.interpolate=perspective", "camera.eye=[7.4, 2.2, 2.2]"],
            None,
        ),
        panel("affine, the eye moved", &["light.interpolate=affine", "camera.eye=[7.4, 2.2, 2.2]"], None),
    ],
    caption: "The slide and its shadow lie still on the floor when the eye moves (a, c). Without division by w they are right at \
              the corners of the floor's two triangles alone: they break along its diagonal, and another eye sees them \
              elsewhere (b, d).",
};

pub const DUST: Figure = Figure {
    name: "lec-dusty-room",
    title: "A beam of light in dusty air, sliced",
    source: "Projective texturing and shadow maps, lecture, \"Combining Shadows with Atmospherics\"",
    scene: DUSTY_ROOM,
    columns: 3,
    panels: &[
        panel("8 slices: bands", &["light.dust.slices=8"], None),
        panel("8 slices, moved from pixel to pixel: noise", &["light.dust.slices=8", "light.dust.jitter=true"], None),
        panel("32 slices", &["light.dust.slices=32"], None),
        panel("128 slices", &[], None),
        panel("without the shadow test", &["light.shadow.technique=none"], None),
        panel("without 1 / cos φ: too thin", &["light.dust.thickness=axis"], None),
    ],
    caption: "Planes across the view, from back to front, each with the light's shadow: the sum is the light that dust sends \
                  to the eye. Few slices show as bands; the error falls as 1 / slices. Without the shadow test the beam goes \
                  through walls and chair. A slice must count as thick as the ray goes through it, or corners are too dim.",
};

pub const FOCUS: Figure = Figure {
    name: "segal-focus",
    title: "A slide in focus: by accumulation of many projectors",
    source: "Segal 1992, 3.1",
    scene: BOARDS,
    columns: 2,
    panels: &[
        panel("one projector: sharp everywhere", &["light.focus.samples=1"], None),
        panel("a lens, in focus at the middle board", &[], None),
        panel("in focus at the near board", &["light.focus.distance=1.2"], None),
        panel("in focus at the far board", &["light.focus.distance=4.8"], None),
    ],
    caption: "128 projectors stand on a disc; their frusta are sheared so that all slides agree in one plane. \
              Elsewhere a point of the slide is a disc: its radius is the lens's times |1 − d / F|, d the distance \
              of the board, F that of the plane. Here F is 2.4, and the boards stand at half, one and two times F.",
};

pub const SOFT_SHADOWS: Figure = Figure {
    name: "segal-soft-shadows",
    title: "Soft shadows: a map for each point of a lamp",
    source: "Segal 1992, 3.1; lecture, \"Hardware Shadow Map Filtering\"",
    scene: COLUMNS,
    columns: 2,
    panels: &[
        panel("one point: hard shadows", &["light.focus.samples=1"], None),
        panel("16 points: still apart far from their casters", &["light.focus.samples=16"], None),
        panel("256 points", &[], None),
        panel(
            "a filter of 7 × 7 texels: as soft at the foot",
            &["light.focus.samples=1", "light.shadow.size=256", "light.shadow.kernel=7x7"],
            None,
        ),
    ],
    caption: "A lamp with an area makes a penumbra that widens with the distance from caster to floor: sharp where columns stand, soft where the beam's shadow ends. Percentage-closer filtering blurs by as many texels everywhere.",
};
