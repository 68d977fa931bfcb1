//! Lights that each item is drawn with, and their guards against back projection [LEC, "Careful about Back Projecting
//! Shadow Maps"]: items are split if a guard needs it. Knows items, lights and planes; no shader.

use glam::Vec4;

use super::Ending;
use super::partition::partition;
use crate::geometry::Derived;
use crate::lights::guard::{Guard, LightPlane, Side};
use crate::lights::{Drawable, LightTerm, Viewer};

/// Part of a light that an item is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reach {
    /// All of it: no drawn part of the item lies behind the light.
    Free,
    /// The part that each fragment's test leaves.
    Fragment,
    /// The part that the texture of two texels leaves.
    Texture,
    /// The part that the vertices' factor leaves.
    Cutoff,
    /// Its ambient light only.
    Nowhere,
}

impl Reach {
    pub const ALL: [Self; 5] = [Self::Free, Self::Fragment, Self::Texture, Self::Cutoff, Self::Nowhere];
}

/// An item, or a part of one, under the same lights all over.
#[derive(Clone, Debug)]
pub struct Piece {
    pub item: Drawable,
    /// Reach of each light.
    pub reaches: Vec<Reach>,
    /// Half-spaces that it is cut to, in eye space: kept points have a product >= 0.
    pub clip_planes: Vec<Vec4>,
}

/// Lights whose guard is a clip plane, at most: an item across all their planes is drawn two to the power of this times.
pub const MOST_CLIP_PLANES: usize = 3;

/// The pieces that `items` are drawn as.
pub fn pieces(
    items: &[Drawable],
    viewer: &Viewer,
    terms: &[LightTerm],
    ending: &Ending,
    derived: &Derived,
) -> Vec<Piece> {
    let whole = |item: &Drawable| Piece { item: item.clone(), reaches: Vec::new(), clip_planes: Vec::new() };
    let mut pieces: Vec<Piece> = items.iter().map(whole).collect();
    for term in terms {
        let plane = plane(term, viewer);
        let one = |piece| under(piece, term, plane.as_ref(), viewer, ending, derived);
        pieces = pieces.into_iter().flat_map(one).collect();
    }
    pieces
}

pub fn plane(term: &LightTerm, viewer: &Viewer) -> Option<LightPlane> {
    LightPlane::of(term.coordinates.as_ref(), term.source.spot().is_some(), viewer)
}

/// Splits `piece` for one more light.
fn under(
    piece: Piece,
    term: &LightTerm,
    plane: Option<&LightPlane>,
    viewer: &Viewer,
    ending: &Ending,
    derived: &Derived,
) -> Vec<Piece> {
    let Some(plane) = plane.filter(|_| term.guard != Guard::None) else { return vec![piece.with(Reach::Free)] };
    // A view shows one light, also where it does not reach: nothing is left out.
    if !ending.shows_light() {
        return vec![piece.with(Reach::Fragment)];
    }
    let side = plane.side(&piece.item, viewer);
    let alone = match (term.guard, side) {
        (Guard::Fragment, _) => Reach::Fragment,
        (Guard::Texture1d, _) => Reach::Texture,
        // The count says where the light is.
        (Guard::Stencil | Guard::None, _) => Reach::Free,
        (Guard::SpotCutoff, Side::Before | Side::Behind) => Reach::Cutoff,
        (_, Side::Before) => Reach::Free,
        (_, Side::Behind) => Reach::Nowhere,
        (Guard::Auto, Side::Across) => Reach::Fragment,
        (Guard::ClipPlane, Side::Across) => return cut(piece, plane),
        (Guard::Cull, Side::Across) => {
            return parted(piece, plane, viewer, derived, [Reach::Free, Reach::Fragment, Reach::Nowhere]);
        }
        (Guard::SpotCutoff, Side::Across) => {
            return parted(piece, plane, viewer, derived, [Reach::Cutoff, Reach::Fragment, Reach::Cutoff]);
        }
    };
    vec![piece.with(alone)]
}

impl Piece {
    fn with(mut self, reach: Reach) -> Self {
        self.reaches.push(reach);
        self
    }
}

/// Both half-spaces, by planes that are each other's negative to the bit: no pixel is missing between them and none is
/// drawn twice [GL 4.6, 13.7].
fn cut(piece: Piece, plane: &LightPlane) -> Vec<Piece> {
    let q = plane.q_from_eye.as_vec4();
    [(q, Reach::Free), (-q, Reach::Nowhere)]
        .map(|(half_space, reach)| {
            let mut half = piece.clone().with(reach);
            half.clip_planes.push(half_space);
            half
        })
        .into()
}

/// The triangles before the light's plane, across it and behind it.
fn parted(piece: Piece, plane: &LightPlane, viewer: &Viewer, derived: &Derived, reaches: [Reach; 3]) -> Vec<Piece> {
    let Some(parts) = partition(&piece.item, &plane.in_model(&piece.item, viewer), derived) else {
        return vec![piece.with(Reach::Fragment)];
    };
    let parts = parts.into_iter().zip(reaches).filter_map(|(part, reach)| Some((part?, reach)));
    parts.map(|(item, reach)| Piece { item, ..piece.clone() }.with(reach)).collect()
}
