//! The rules, as data: a file for each kind.

mod blending;
mod comparison;
mod coordinates;
mod cube_maps;
mod depth;
mod environment;
mod framebuffers;
mod generated;
mod glsl;
mod invariance;
mod levels;
mod offset;
mod queries;
mod raster;
mod sequences;
mod stencil;
mod uploads;
mod vertices;

use super::Rule;

/// The kinds, in the order of a report.
const KINDS: &[&[Rule]] = &[
    comparison::RULES,
    coordinates::RULES,
    depth::RULES,
    offset::RULES,
    stencil::RULES,
    raster::RULES,
    invariance::RULES,
    framebuffers::RULES,
    environment::RULES,
    cube_maps::RULES,
    levels::RULES,
    uploads::RULES,
    blending::RULES,
    glsl::RULES,
    vertices::RULES,
    queries::RULES,
    sequences::RULES,
    generated::RULES,
];

/// Every rule, in the order of a report.
pub const TABLE: &[Rule] = &joined::<{ count() }>();

const fn count() -> usize {
    let (mut count, mut kind) = (0, 0);
    while kind < KINDS.len() {
        count += KINDS[kind].len();
        kind += 1;
    }
    count
}

/// The kinds' rules in one list; `COUNT` is their number.
const fn joined<const COUNT: usize>() -> [Rule; COUNT] {
    let mut rules = [KINDS[0][0]; COUNT];
    let (mut at, mut kind) = (0, 0);
    while kind < KINDS.len() {
        let mut index = 0;
        while index < KINDS[kind].len() {
            rules[at] = KINDS[kind][index];
            at += 1;
            index += 1;
        }
        kind += 1;
    }
    rules
}
