//! Figures of what goes wrong in bump mapping, measured: mirrored skins, mipmaps, cube maps that normalise, nine bits, the
//! horizon, discontinuous tangents, differences of heights [GDC].

use super::panels::{embedded, panel, stage};
use super::{Figure, PanelStage, ProfileLine, SceneChange, SkinMap};
use crate::scene::Embedded;
use crate::views::View;

const MIRRORED: Embedded = embedded!("mirrored.toml");
const FAR_TORUS: Embedded = embedded!("far-torus.toml");
const PLATE: Embedded = embedded!("plate.toml");
const KNIGHT: Embedded = embedded!("knight.toml");

pub const MIRRORED_SKIN: Figure = Figure {
    name: "gdc-mirrored-skin",
    title: "Studs on a mirrored skin, lit from the right",
    source: "GDC 2001, \"Compute Partial Derivatives From Polygon Plane Equations\"",
    scene: MIRRORED,
    columns: 3,
    panels: &[
        panel("the normal map: mirrored on the left half", &[], Some(View::NormalMap))
            .note("Red lies on the other side of each stud there: s grows to the left."),
        panel("right: N turned outwards, T and B kept", &[], None).from(2).note("Studs on both halves."),
        panel("the truth: the surface really displaced", &[], None)
            .changed(SceneChange::Displaced)
            .note("Each vertex of 260 000 triangles is moved. High studs hide a little of the plate behind them."),
        panel("wrong on purpose: T and B turned around", &[], None)
            .changed(SceneChange::TangentsTurned)
            .from(2)
            .note("The left half has dents in place of studs."),
        panel("wrong on purpose: N = T × B", &[], None)
            .changed(SceneChange::NormalsInwards)
            .from(2)
            .note("N looks inwards on the left half. The program turns what looks away from the eye, and the bumps turn with it."),
        stage(
            "difference of (b) from (c), 8 times as bright",
            &[],
            PanelStage::Difference { between: [1, 2], gain: 8 },
        )
        .note("Where studs stand out over the plate. Both halves are alike."),
    ],
    caption: "Models share texels between their left and right halves: on one of them the skin runs the other way around, and T × B \
              points into the model. Of the three vectors N has to be negated, and no other: the heights still grow along T and B.",
};

pub const MIP_DIMMING: Figure = Figure {
    name: "mip-dimming",
    title: "Bumps far away: means of normals are shorter, and dim",
    source: "Ours: what alpha in a normal map's smaller levels is for",
    scene: FAR_TORUS,
    columns: 3,
    panels: &[
        stage("the truth: 64 samples a pixel", &[], PanelStage::Fine).note("A pixel covers several normals."),
        panel("right: unit normals, their length in alpha", &[], None)
            .brightness()
            .note("mipmaps = \"unit-and-length\": alpha multiplies the diffuse light."),
        panel("right: the means themselves", &["object.material.bump.mipmaps=mean"], None)
            .brightness()
            .note("mipmaps = \"mean\": N' is shorter, and so is N' · L."),
        panel("wrong on purpose: unit normals, alpha 1", &[], None)
            .changed(SceneChange::Undimmed)
            .brightness()
            .note("As if the mean were a normal of the surface: too bright."),
        panel("wrong on purpose: dimmed twice", &[], None)
            .changed(SceneChange::DimmedTwice)
            .brightness()
            .note("Means as they are, and their length in alpha, too."),
        stage(
            "what alpha takes: (d) less (b), 4 times as bright",
            &[],
            PanelStage::Difference { between: [3, 1], gain: 4 },
        ),
    ],
    caption: "A picture of few pixels, enlarged. Light that reaches all normals of a pixel is the mean normal's dot product with \
              L: a mean of normals that differ is shorter than one, and what it lacks in length is light that the pixel lacks. \
              Normals that look away from the light count as 0, not below: means are a little too dark there.",
};

const SMOOTH: [&str; 3] =
    ["object.0.material.bump.scale=0", "shading.bump=one-pass", "light.0.position=[-0.5, 0.8, -0.1]"];
const EXACT: &str = "shading.normalize=exact";
macro_rules! cube {
    ($size:literal) => {
        cube!($size, "true")
    };
    ($size:literal, $seamless:literal) => {
        &[SMOOTH[0], SMOOTH[1], concat!("shading.normalize={ cube = ", $size, ", seamless = ", $seamless, " }")]
    };
}

pub const CUBE_MAPS: Figure = Figure {
    name: "gdc-normalisation-cube",
    title: "Vectors normalised by a cube map",
    source: "GDC 2001, \"GPU Bump Mapping Texture Requirements\"",
    scene: PLATE,
    columns: 3,
    panels: &[
        panel("exact: v / |v|", &[SMOOTH[0], SMOOTH[1], EXACT], None).note("A flat plate below a lamp."),
        panel("64 texels a side", cube!("64"), None).from(0),
        panel("16 texels a side", cube!("16"), None).from(0),
        panel("4 texels a side", cube!("4"), None).from(0).note("Each texel shows."),
        panel("4 texels, seams not filtered", cube!("4", "false"), None)
            .from(0)
            .note("As of 2001: each face is filtered for itself, and its border shows."),
        stage(
            "difference of (b) and (a), 30 times as bright",
            &[],
            PanelStage::Difference { between: [1, 0], gain: 30 },
        ),
        stage(
            "difference of (c) and (a), 30 times as bright",
            &[],
            PanelStage::Difference { between: [2, 0], gain: 30 },
        ),
        stage("difference of (d) and (a), 6 times as bright", &[], PanelStage::Difference { between: [3, 0], gain: 6 }),
        stage("difference of (e) and (a), 6 times as bright", &[], PanelStage::Difference { between: [4, 0], gain: 6 })
            .note("The square is where the light's vector leaves one face of the cube."),
    ],
    caption: "A cube map holds at each direction the unit vector of that direction, in eight bits. Between \
              texels it is interpolated: the fewer texels, the further from the true direction. Eight bits leave an error at any \
              size. Differences are greatest in highlights, whose eighth power enlarges them.",
};

const NINE: &str = "shading.precision=9-bit";
const CLOSE: [&str; 5] = [SMOOTH[0], SMOOTH[1], EXACT, "light.0.diffuse=[0, 0, 0]", "light.0.specular=[1, 1, 1]"];
/// The edge of the highlight.
const RIM: [&str; 3] = ["camera.target=[0.55, 0.0, 0.1]", "camera.fov_y=8", "object.0.material.specular=[1, 1, 1]"];

pub const NINE_BITS: Figure = Figure {
    name: "gdc-nine-bits",
    title: "Register combiners of nine bits band highlights",
    source: "GDC 2001, \"Same Math in a Single Pass on GeForce3\"",
    scene: PLATE,
    columns: 3,
    panels: &[
        panel("in floats", &CLOSE, None),
        panel("in nine bits", &[CLOSE[0], CLOSE[1], CLOSE[2], CLOSE[3], CLOSE[4], NINE], None).from(0),
        stage("their difference, 50 times as bright", &[], PanelStage::Difference { between: [1, 0], gain: 50 })
            .note("Rings: each is a code of N' · H."),
        panel(
            "in floats: the highlight's rim, enlarged",
            &[CLOSE[0], CLOSE[1], CLOSE[2], CLOSE[3], CLOSE[4], RIM[0], RIM[1], RIM[2]],
            None,
        ),
        panel(
            "in nine bits: the same",
            &[CLOSE[0], CLOSE[1], CLOSE[2], CLOSE[3], CLOSE[4], RIM[0], RIM[1], RIM[2], NINE],
            None,
        )
        .from(3),
        stage("their brightness along the middle row", &[], PanelStage::Profile(&BANDS))
            .note("Steps of several codes in place of one."),
    ],
    caption: "Combiners of 2001 round each result to a sign and eight bits. The exponent 8 is three squarings: an error of half a \
              code in N' · H is doubled by each of them, and neighbouring codes of N' · H end up to eight apart. The \
              rounding between them adds to it. Numbers are codes of 255.",
};

const BANDS: [ProfileLine; 2] = [
    ProfileLine { panel: 3, name: "floats", color: [0, 114, 178] },
    ProfileLine { panel: 4, name: "nine bits", color: [213, 94, 0] },
];

const SUN: [&str; 4] = [
    "light.0.diffuse=[0, 0, 0]",
    "light.0.specular=[0, 0, 0]",
    "light.1.diffuse=[1, 0.95, 0.85]",
    "object.0.material.specular=[0, 0, 0]",
];
const OPEN: &str = "shading.self_shadow=false";
macro_rules! sun {
    ($direction:literal) => {
        &[SUN[0], SUN[1], SUN[2], SUN[3], concat!("light.1.direction=", $direction)]
    };
    ($direction:literal, open) => {
        &[SUN[0], SUN[1], SUN[2], SUN[3], concat!("light.1.direction=", $direction), OPEN]
    };
}

pub const SELF_SHADOW: Figure = Figure {
    name: "gdc-self-shadow",
    title: "A light at the horizon",
    source: "GDC 2001, \"GPU Bump Mapping Basics\"",
    scene: PLATE,
    columns: 3,
    panels: &[
        panel("12° above: the factor is 1", sun!("[-1, -0.2126, 0.05]"), None),
        panel("3° above: the factor fades", sun!("[-1, -0.0524, 0.05]"), None),
        panel("3° below: dark", sun!("[-1, 0.0524, 0.05]"), None).note("A light behind the surface lights nothing."),
        panel("12° above, without the factor", sun!("[-1, -0.2126, 0.05]", open), None).from(0),
        panel("3° above, without the factor", sun!("[-1, -0.0524, 0.05]", open), None).from(1),
        panel("wrong on purpose: 3° below, without the factor", sun!("[-1, 0.0524, 0.05]", open), None)
            .from(2)
            .note("Bumps that face the light are lit through the plate."),
    ],
    caption: "The light is on the right. A bump may face a light that the surface itself does not see. The factor \
              min(1, 8 L · N), N without bumps, takes light away in the last 7.2° above the horizon, and leaves none below it. \
              It knows nothing of the bumps' neighbours: long shadows of studs are missing in all pictures.",
};

pub const REPACKED_SKIN: Figure = Figure {
    name: "gdc-repacked-skin",
    title: "Tangent bases that jump across edges, and a skin packed again",
    source: "GDC 2001, \"Tangent Space Vector Continuity\", \"Tangent Continuity Solutions\"",
    scene: KNIGHT,
    columns: 3,
    panels: &[
        panel("the vector to the light in tangent space", &[], Some(View::TangentLight))
            .note("Edges show where the bases of two triangles differ. This skin was painted with its pieces upright."),
        panel("wrong on purpose: its pieces turned at random", &[], Some(View::TangentLight))
            .changed(SceneChange::Careless { repacked: false })
            .note("By quarter turns, as if packed for the least space alone."),
        panel("the skin of (b) turned and packed again", &[], Some(View::TangentLight))
            .changed(SceneChange::Careless { repacked: true }),
        stage("the normal map of (a)", &[], PanelStage::Skin(SkinMap::Normals)),
        stage("packed again", &[], PanelStage::Skin(SkinMap::Normals))
            .changed(SceneChange::Repacked { unmirror: false }),
        stage("packed again, mirrored pieces apart", &[], PanelStage::Skin(SkinMap::Normals))
            .changed(SceneChange::Repacked { unmirror: true })
            .note("They have texels of their own, and bases that are no reflections."),
        stage("angles between neighbouring triangles, by the length of their edges", &[], PanelStage::Turns).wide(),
        panel("the picture with the skin of (f)", &[], None).changed(SceneChange::Repacked { unmirror: true }),
    ],
    caption: "Where two triangles meet whose t axes point apart, the light's vector jumps in tangent space, and what is interpolated \
              shows the edge. The command repack turns each piece of a skin so that neighbours agree, packs the pieces, and \
              samples the maps in their new places. A skin whose pieces stand upright already gains little by turning.",
};

pub const HEIGHT_ERRORS: Figure = Figure {
    name: "gdc-height-differences",
    title: "Normals from heights: error by resolution",
    source: "GDC 2001, \"Converting Height-Field to a Normal Map\"",
    scene: PLATE,
    columns: 2,
    panels: &[
        stage("h = 0.01 sin 6πs, differenced", &[], PanelStage::Slopes)
            .note("Twice the texels halve the error of forward differences, and quarter that of central ones.")
            .wide(),
        panel("forward differences", &["object.0.material.bump.difference=forward"], None)
            .from(2)
            .note("Slopes of half a texel further: all bumps move by half a texel."),
        panel("central differences", &[], None),
    ],
    caption: "A slope by finite differences is exact for a plane. Forward ones take this texel and the next: they are right half a \
              texel away. Central ones take the texels on both sides. Angles are measured against the wave's own derivative.",
};
