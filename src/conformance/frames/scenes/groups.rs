//! Groups of frames: what of the renderer each exercises, and with which settings.

use std::fmt::Write as _;

use super::Draft;
use super::axes::{Axis, Chosen};
use super::world::{Style, color, ground, light, photograph, textures, thing, view};
use crate::conformance::random::Random;
use crate::plan::{Request, View, ViewRequest};

/// Part of the renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    Maps,
    CubeMaps,
    Middles,
    Volumes,
    Surfaces,
    Projected,
    Bumps,
    Views,
}

const FORMATS: Axis = &[
    "format = \"depth16\"",
    "format = \"depth24\"",
    "format = \"depth32\"",
    "format = \"depth32f\"",
    "format = \"depth32f\"",
    "format = \"depth\"",
];
const TRANSFERS: Axis = &["transfer = \"fbo\"", "transfer = \"copy\""];
const FILTERS: Axis = &["filter = \"linear\"", "filter = \"nearest\""];
const ORDERS: Axis = &["compare = \"lequal\"", "compare = \"gequal\""];
const KERNELS: Axis = &["", "", "kernel = \"2x2\"", "kernel = \"3x3\""];
const SIZES: Axis = &["size = 32", "size = 24", "size = 40", "size = 48"];
const CULLS: Axis = &["", "cull = \"back\"", "cull = \"front\""];
const OFFSETS: Axis = &[
    "",
    "offset = { factor = 1.5, units = 4.0 }",
    "offset = { factor = 3.0, units = 0.0, texels = 1.0 }",
    "offset = { factor = 0.0, units = 0.0 }",
];
const BIASES: Axis = &["", "", "bias = \"receiver-plane\"", "bias = \"normal-offset\"", "bias = \"adaptive\""];
const DIMMINGS: Axis = &["", "", "dimming = 0.3"];

const MAPS: &[Axis] = &[
    FORMATS,
    TRANSFERS,
    FILTERS,
    ORDERS,
    KERNELS,
    BIASES,
    CULLS,
    OFFSETS,
    SIZES,
    &["", "", "", "mipmaps = true", "mipmaps = \"8-tap\""],
    &["", "", "fit = \"casters\"", "fit = \"view\""],
    &["", "addressing = \"direct3d\"", "addressing = \"direct3d-viewport\""],
    &["", "texgen = \"eye\"", "texgen = \"light\"", "texgen = \"identity\""],
    &["", "texture_matrix = \"scale-bias\"", "texture_matrix = \"projection\""],
    &["", "", "into = \"stencil\""],
    &[
        "",
        "guard = \"spot-cutoff\"",
        "guard = \"texture-1d\"",
        "guard = \"clip-plane\"",
        "guard = \"stencil\"",
        "guard = \"cull\"",
        "guard = \"fragment\"",
        "guard = \"none\"",
    ],
    DIMMINGS,
    &["", "", "", "casters = \"texel\""],
];

const CUBE_MAPS: &[Axis] =
    &[FORMATS, TRANSFERS, FILTERS, ORDERS, KERNELS, CULLS, OFFSETS, SIZES, DIMMINGS, &["", "", "into = \"stencil\""]];

const MIDDLES: &[Axis] = &[
    &["technique = \"midpoint\"", "technique = \"midpoint\"", "technique = \"second-depth\"\nclosed = \"assume\""],
    &["average = \"window\"", "average = \"eye-linear\""],
    &["peel = \"fetch\"", "peel = \"compare\""],
    &["", "single = \"first\"", "single = \"far\"", "single = \"first+offset\""],
    FORMATS,
    TRANSFERS,
    FILTERS,
    ORDERS,
    KERNELS,
    SIZES,
    DIMMINGS,
];

const VOLUMES: &[Axis] = &[
    &[
        "method = \"auto\"",
        "method = \"parity\"",
        "method = \"z-pass\"",
        "method = \"z-pass-two-sided\"",
        "method = \"z-pass-capped\"",
        "method = \"z-fail\"",
        "method = \"z-fail-clamped\"",
        "method = \"z-fail-truncated\"",
    ],
    &["", "count = \"saturate\""],
    &["", "passes = \"lit-unlit\""],
    &["", "ledge = [0.05, 0.1, 1.0]"],
    DIMMINGS,
];

const SURFACES: &[Axis] = &[
    &["", "lighting = \"per-vertex\""],
    &["", "", "passes = \"shadow\""],
    &["", "", "background = \"ambient\""],
    &["", "", "hidden = \"grey\"", "hidden = \"smear\"", "hidden = \"leave\", filter = \"trilinear\""],
];

const PROJECTED: &[Axis] = &[
    &["", "image = \"slide.png\"", "image = \"slide.png\""],
    &["", "filter = \"nearest\"", "filter = \"linear\"", "filter = \"trilinear\""],
    &[
        "",
        "beam = { profile = [1.0, 1.0, 0.5, 0.5, 0.0] }",
        "beam = { exponent = 3.0, lens = 0.3 }",
        "beam = { shield = \"holes.png\" }",
    ],
    &[
        "",
        "falloff = \"inverse\"",
        "falloff = \"inverse-square\"",
        "falloff = { by = \"z\", law = \"inverse\", d0 = 3.0 }",
        "falloff = { by = \"z\", table = [[1.0, 1.0], [4.0, 0.6], [8.0, 0.1]] }",
    ],
    &["", "interpolate = \"affine\"", "interpolate = \"segal\""],
    &["", "aspect = 1.5\nshape = \"frustum\"", "shape = \"frustum\""],
    &["", "", "law = \"slide\""],
    &["", "", "", "focus = { distance = 4.0, radius = 0.2, samples = 3 }"],
    &[
        "",
        "",
        "dust = { density = 0.2, slices = 5 }",
        "dust = { density = 0.3, slices = 4, blend = \"add\" }",
        "dust = { density = 0.2, slices = 5, extinct = \"all\", jitter = true }",
        "dust = { density = 0.9, slices = 4, thickness = \"axis\" }",
    ],
    &["", "", "frustum = \"shown\""],
];

const BUMPS: &[Axis] = &[
    &["bump = \"reference\"", "bump = \"one-pass\"", "bump = \"three-pass\""],
    &["", "self_shadow = false"],
    &["", "normalize = \"exact\"", "normalize = { cube = 16 }", "normalize = { cube = 16, seamless = false }"],
    &["", "precision = \"9-bit\""],
    &["", "two_units = true"],
    &[
        "bump = { height = \"heights.png\", scale = 2.0 }",
        "bump = { normal_map = \"normals.png\" }",
        "bump = { normal_map = \"normals.png\", green = \"down\", format = \"unorm8\" }",
        "bump = { height = \"heights.png\", scale = 3.0, difference = \"central\", border = \"clamp\", basis = \"skewed\" }",
        "bump = { height = \"heights.png\", scale = -2.0, mipmaps = \"mean\", format = \"unorm8\", basis = \"per-polygon\" }",
    ],
    &["", "gloss = \"gloss.png\"", "gloss = \"decal-alpha\", decal = \"leaves.png\"", "decal = \"tiles.png\""],
    &["spot", "point", "directional"],
    &["", "technique = \"shadow-map\"\nsize = 32", "technique = \"shadow-volume\""],
];

const VIEWS: &[Axis] = &[
    &["shade", "light-depth", "projected-map"],
    &["depth", "light-view", "light-distance", "texels-per-pixel"],
    &["normal", "normal-map", "decal", "gloss"],
    &["tangent-light", "tangent-half", "diffuse", "specular"],
    &["technique = \"shadow-map\"", "technique = \"shadow-map\"", "technique = \"midpoint\""],
    &["", "stencil-count", "stencil-colors", "volume", "silhouette"],
];

impl Group {
    /// Groups of shadows.
    pub const SHADOWS: [Self; 4] = [Self::Maps, Self::CubeMaps, Self::Middles, Self::Volumes];

    /// Groups of light on surfaces.
    pub const SURFACES: [Self; 4] = [Self::Surfaces, Self::Projected, Self::Bumps, Self::Views];

    pub fn name(self) -> &'static str {
        match self {
            Self::Maps => "shadow maps",
            Self::CubeMaps => "cube maps",
            Self::Middles => "midpoint and second-depth maps",
            Self::Volumes => "shadow volumes",
            Self::Surfaces => "surfaces",
            Self::Projected => "projected light",
            Self::Bumps => "bumps",
            Self::Views => "views",
        }
    }

    pub fn axes(self) -> &'static [Axis] {
        match self {
            Self::Maps => MAPS,
            Self::CubeMaps => CUBE_MAPS,
            Self::Middles => MIDDLES,
            Self::Volumes => VOLUMES,
            Self::Surfaces => SURFACES,
            Self::Projected => PROJECTED,
            Self::Bumps => BUMPS,
            Self::Views => VIEWS,
        }
    }

    /// Frames of the group.
    pub fn frames(self) -> usize {
        match self {
            Self::Maps => 18,
            Self::CubeMaps => 8,
            Self::Middles => 8,
            Self::Volumes => 8,
            Self::Surfaces => 8,
            Self::Projected => 9,
            Self::Bumps => 9,
            Self::Views => 6,
        }
    }

    /// A scene with these settings.
    pub fn draft(self, chosen: &Chosen, dice: &mut Random) -> Draft {
        let written: Vec<&str> = chosen.iter().copied().filter(|value| !value.is_empty()).collect();
        let said = written.join(", ").replace('\n', ", ");
        let mut draft = Draft { text: view(dice), said, request: Request::default() };
        draft.requested(dice);
        match self {
            Self::Maps => {
                let kind = dice.pick(&["spot", "spot", "spot", "directional"]);
                draft.shading("", dice);
                draft.shadowed(kind, "technique = \"shadow-map\"", &fitting(chosen, kind), dice);
            }
            Self::CubeMaps => {
                draft.shading("", dice);
                draft.shadowed("point", "technique = \"shadow-map\"", chosen, dice);
            }
            Self::Middles => {
                draft.shading("", dice);
                draft.shadowed("spot", "", chosen, dice);
            }
            Self::Volumes => {
                draft.shading("", dice);
                for _ in 0..dice.whole(1, 2) {
                    let kind = dice.pick(&["spot", "point", "directional"]);
                    draft.shadowed(kind, "technique = \"shadow-volume\"", chosen, dice);
                }
            }
            Self::Surfaces => {
                draft.shading(&chosen[..3].join("\n"), dice);
                for index in 0..dice.whole(1, 3) {
                    let kind = dice.pick(&["spot", "point", "directional"]);
                    if index == 0 && kind != "point" {
                        draft.shadowed(kind, "technique = \"shadow-map\"\nsize = 32", &Chosen::new(), dice);
                    } else {
                        draft.text += &light(dice, kind, "");
                    }
                }
            }
            Self::Projected => {
                let is_slide = chosen.contains(&"law = \"slide\"");
                draft.shading(if is_slide { "passes = \"slide\"" } else { "" }, dice);
                draft.text += &light(dice, "spot", &(chosen.join("\n") + "\n"));
                if !is_slide && dice.chance(0.7) {
                    draft.text += "\n[light.shadow]\ntechnique = \"shadow-map\"\nsize = 32\n";
                }
            }
            Self::Bumps => {
                draft.shading(&fitting(&chosen[..5], "").join("\n"), dice);
                draft.text += &light(dice, chosen[7], "");
                if !chosen[8].is_empty() {
                    let _ = write!(draft.text, "\n[light.shadow]\n{}\n", chosen[8]);
                }
            }
            Self::Views => draft.viewed(chosen, dice),
        }
        draft.objects(self, chosen, dice);
        draft
    }
}

/// Settings without those that do not go with another one.
fn fitting(chosen: &[&'static str], kind: &str) -> Chosen {
    let has = |text: &str| chosen.iter().any(|value| value.starts_with(text));
    let is_out = |value: &&str| {
        let begins = |names: &[&str]| names.iter().any(|name| value.starts_with(name));
        let of_levels = ["filter", "transfer", "bias", "fit", "addressing"];
        (has("mipmaps") && begins(&of_levels))
            || (kind != "spot" && begins(&["guard"]))
            || (has("into") && (value.contains("\"stencil\"") || value.contains("clip-plane")) && begins(&["guard"]))
            || (has("bump = \"reference\"") && begins(&["normalize", "precision"]))
            || (!has("bump = \"reference\"") && begins(&["self_shadow"]))
            || (!has("bump = \"three-pass\"") && begins(&["two_units"]))
    };
    chosen.iter().copied().filter(|value| !is_out(value)).collect()
}

impl Draft {
    /// Requests beside the picture: floats show each error of the shaders, codes of 8 bits are what is seen.
    fn requested(&mut self, dice: &mut Random) {
        self.request.float_picture = dice.chance(0.5);
        self.request.keep_all = dice.chance(0.15);
        if dice.chance(0.05) {
            self.request.wire = Some(0);
        }
    }

    fn shading(&mut self, lines: &str, dice: &mut Random) {
        let per_vertex = if !lines.contains("lighting") && !lines.contains("bump") && dice.chance(0.25) {
            "lighting = \"per-vertex\"\n"
        } else {
            ""
        };
        let _ = write!(self.text, "\n[shading]\nambient = {}\n{per_vertex}{lines}\n", color(dice, 0.0, 0.3));
    }

    fn shadowed(&mut self, kind: &str, first: &str, chosen: &Chosen, dice: &mut Random) {
        self.text += &light(dice, kind, "");
        let _ = write!(self.text, "\n[light.shadow]\n{first}\n{}\n", chosen.join("\n"));
    }

    fn objects(&mut self, group: Group, chosen: &Chosen, dice: &mut Random) {
        let bump = match group {
            Group::Bumps => format!(", {}{}{}", chosen[5], if chosen[6].is_empty() { "" } else { ", " }, chosen[6]),
            Group::Views if dice.chance(0.5) => ", bump = { height = \"heights.png\", scale = 2.0 }".to_owned(),
            _ => String::new(),
        };
        let keys = match group {
            _ if !bump.is_empty() => bump,
            Group::Surfaces if !chosen[3].is_empty() => photograph(chosen[3]),
            _ => textures(dice),
        };
        // Volumes are of what encloses one.
        let is_closed = group == Group::Volumes || group == Group::Middles;
        let style = Style::new(dice, if is_closed && keys.contains("alpha") { String::new() } else { keys });
        // Bumps lie on things alone, and other textures not always on the ground.
        let is_plain = style.textures.contains("bump") || dice.chance(0.3);
        let plain = Style::new(dice, String::new());
        let plain = Style { is_specular: style.is_specular, ..plain };
        self.text += &ground(dice, if is_plain { &plain } else { &style });
        for _ in 0..dice.whole(1, 3) {
            self.text += &thing(dice, is_closed, &style);
        }
    }

    fn viewed(&mut self, chosen: &Chosen, dice: &mut Random) {
        self.shading("", dice);
        let is_volume = !chosen[5].is_empty();
        let technique = if is_volume { "technique = \"shadow-volume\"" } else { chosen[4] };
        self.text += &light(dice, "spot", "");
        let size = if is_volume { "" } else { "size = 32" };
        let _ = write!(self.text, "\n[light.shadow]\n{technique}\n{size}\n");
        // The second and the fourth take turns.
        for name in [0, if dice.chance(0.5) { 1 } else { 3 }, 2, 5].map(|axis| chosen[axis]) {
            let needs_map = ["light-depth", "projected-map", "texels-per-pixel"].contains(&name);
            let found = crate::views::VIEWS.iter().find(|(known, ..)| *known == name);
            if let Some((_, view, ..)) = found.filter(|_| !(is_volume && needs_map)) {
                self.request.views.push(ViewRequest { view: *view as View, light: 0 });
            }
        }
    }
}
