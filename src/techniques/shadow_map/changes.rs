//! Changes of a map's keys for `glumbra stress`.

use crate::scene::LightKind;
use crate::techniques::change::{Change, of_picture, of_shade};

/// Keys of every map.
const MAP: &[Change] = &of_shade([
    "filter = \"nearest\"",
    "kernel = \"3x3\"",
    "kernel = \"5x5\"",
    "format = \"depth16\"",
    "format = \"depth32f\"",
    "transfer = \"copy\"",
    "format = \"depth\", transfer = \"copy\"",
    "compare = \"gequal\"",
    "casters = \"texel\"",
    "into = \"stencil\"",
    "size = 256",
]);

/// Further keys of maps in one square.
const SQUARE: &[Change] = &of_shade([
    "bias = \"receiver-plane\"",
    "bias = \"normal-offset\"",
    "bias = \"adaptive\"",
    "bias = \"normal-offset\", kernel = \"5x5\"",
    "bias = \"adaptive\", filter = \"nearest\"",
    "fit = \"casters\"",
    "fit = \"view\"",
    "fit = \"view\", kernel = \"3x3\"",
    "mipmaps = \"8-tap\"",
    "addressing = \"direct3d\", matrix_bias = 0.0",
    "addressing = \"direct3d-viewport\"",
    "texgen = \"eye\"",
    "texgen = \"light\", texture_matrix = \"projection\"",
]);

/// Keys of a spotlight's map only.
const SPOT: &[Change] = &of_shade(["mipmaps = true"]);

/// Guards against back projection, which only a spotlight has.
const GUARDS: &[Change] = &of_picture([
    "guard = \"spot-cutoff\"",
    "guard = \"texture-1d\"",
    "guard = \"clip-plane\"",
    "guard = \"stencil\"",
    "guard = \"cull\"",
    "guard = \"fragment\"",
]);

/// All changes of a map of a light of this `kind`.
pub fn changes(kind: &LightKind) -> Vec<Change> {
    let lists: &[&[Change]] = match kind {
        LightKind::Point(_) => &[MAP],
        LightKind::Directional { .. } => &[MAP, SQUARE],
        LightKind::Spot(_) => &[MAP, SQUARE, SPOT, GUARDS],
    };
    lists.concat()
}
