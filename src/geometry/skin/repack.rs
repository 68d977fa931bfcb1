//! Cuts a skin, turns its pieces and packs them: from texels to texels.

use std::collections::BTreeSet;

use glam::{DVec2, dvec2};

use super::discontinuity::{Turn, crossings, shared_edges};
use super::islands::{self, Islands};
use super::pack::{self, Packed};
use super::turn::{best_turns, is_quarter, turn};
use super::{Discontinuity, Error, Skin, SkinTriangle};

/// Settings of [`repack`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepackOptions {
    /// Width and height of the new picture in texels; `None`: the fewest texels that hold the islands at their size, with
    /// sides of powers of two.
    pub size: Option<[u32; 2]>,
    /// Texels around each piece that are filled with the colours at its rim; at least 1.
    pub gutter: u32,
    /// Turns mirrored islands over, and gives them texels of their own.
    pub unmirror: bool,
    /// Angle between t axes in degrees beyond which an island is cut at an edge; 180: never.
    pub cut_degrees: f64,
    /// Steps to a texel to which places on the skin are rounded, as for MD2 files; `None`: they are not rounded.
    pub steps: Option<u32>,
}

/// A skin that has been packed again.
#[derive(Clone, Debug)]
pub struct Repacked {
    /// The same triangles in the same order, elsewhere.
    pub skin: Skin,
    /// The piece of each triangle.
    pub piece_of_triangle: Vec<usize>,
    pub islands: usize,
    /// Groups of islands that share texels and move together.
    pub pieces: usize,
    /// Pieces turned by something other than quarter turns, which leave texels whole.
    pub turned: usize,
    /// Scale of the islands, at most 1.
    pub scale: f64,
    /// Texels around each piece that are its own.
    pub gutter: u32,
    /// Triangles that rounding has left without an area on the skin, or turned over.
    pub flattened: usize,
    /// Angles across edges, after.
    pub discontinuity: Discontinuity,
}

/// A mapping of texels, y downwards: turned over, turned, scaled, and moved.
struct Mapping {
    turns_over: bool,
    turn: Turn,
    scale: f64,
    shift: DVec2,
}

impl Mapping {
    fn apply(&self, texel: DVec2) -> DVec2 {
        let [sine, cosine] = self.turn;
        let x = if self.turns_over { -texel.x } else { texel.x };
        // Counter-clockwise where y is upwards.
        let turned = dvec2(cosine * x + sine * texel.y, cosine * texel.y - sine * x);
        self.scale * turned + self.shift
    }
}

/// Cuts the skin into islands, turns them so that t axes agree across edges, and packs them in a new picture. At the same
/// scale the mean angle across edges does not grow: where turning would make it larger, the islands keep their angles.
///
/// # Errors
///
/// No room in a picture of the size given, or of the largest size.
pub fn repack(skin: &Skin, options: &RepackOptions) -> Result<Repacked, Error> {
    let edges = shared_edges(skin);
    let islands = islands::cut(skin, &edges, options.cut_degrees, options.unmirror);
    let turned_over = turn_over(skin, options);
    let (crossings, _) = crossings(&turned_over, &edges);
    let angles = best_turns(&turned_over, &crossings, &islands);
    let turned = lay_out(skin, &islands, &angles, options)?;
    if angles.iter().all(|angle| *angle == 0.0)
        || turned.discontinuity.mean_degrees <= skin.discontinuity().mean_degrees
    {
        return Ok(turned);
    }
    let kept = lay_out(skin, &islands, &vec![0.0; islands.pieces], options)?;
    let is_better = kept.discontinuity.mean_degrees < turned.discontinuity.mean_degrees;
    Ok(if is_better { kept } else { turned })
}

/// The skin with its mirrored triangles turned over, if that is wanted, wherever they then lie.
fn turn_over(skin: &Skin, options: &RepackOptions) -> Skin {
    let over = |triangle: &SkinTriangle| match options.unmirror && triangle.sense() < 0 {
        true => triangle.texels.map(|texel| dvec2(-texel.x, texel.y)),
        false => triangle.texels,
    };
    skin.moved(skin.size, &skin.triangles.iter().map(over).collect::<Vec<_>>())
}

fn lay_out(skin: &Skin, islands: &Islands, angles: &[f64], options: &RepackOptions) -> Result<Repacked, Error> {
    let mut mappings: Vec<Mapping> = angles
        .iter()
        .map(|angle| Mapping { turns_over: false, turn: turn(*angle), scale: 1.0, shift: DVec2::ZERO })
        .collect();
    for (triangle, piece) in skin.triangles.iter().zip(&islands.piece_of_triangle) {
        mappings[*piece].turns_over |= options.unmirror && triangle.sense() < 0;
    }
    let bounds = bounds(skin, islands, &mappings);
    let gutter = f64::from(options.gutter);
    let rectangles = |scale: f64| -> Vec<[u64; 2]> {
        let side = |low: f64, high: f64| ((scale * high).ceil() - (scale * low).floor()).max(1.0) + 2.0 * gutter;
        bounds.iter().map(|[low, high]| [side(low.x, high.x) as u64, side(low.y, high.y) as u64]).collect()
    };
    let Packed { size, scale, corners } = pack::pack(options.size, options.gutter, rectangles)?;
    for ((mapping, corner), [low, _]) in mappings.iter_mut().zip(corners).zip(&bounds) {
        mapping.scale = scale;
        mapping.shift = DVec2::from_array(corner.map(f64::from)) + gutter - (scale * *low).floor();
    }
    let place = |(triangle, piece): (&SkinTriangle, &usize)| {
        let texels = triangle.texels.map(|texel| mappings[*piece].apply(texel));
        options.steps.map(f64::from).map_or(texels, |steps| texels.map(|texel| (steps * texel).round() / steps))
    };
    let texels: Vec<[DVec2; 3]> = skin.triangles.iter().zip(&islands.piece_of_triangle).map(place).collect();
    let moved = skin.moved(size, &texels);
    let flattened = flattened(skin, &moved, options);
    let turned: BTreeSet<usize> = (0..islands.pieces).filter(|piece| !is_quarter(mappings[*piece].turn)).collect();
    Ok(Repacked {
        discontinuity: moved.discontinuity(),
        skin: moved,
        piece_of_triangle: islands.piece_of_triangle.clone(),
        islands: islands.count,
        pieces: islands.pieces,
        turned: turned.len(),
        scale,
        gutter: options.gutter,
        flattened,
    })
}

/// Least and greatest texels of each piece after its turn.
fn bounds(skin: &Skin, islands: &Islands, mappings: &[Mapping]) -> Vec<[DVec2; 2]> {
    let mut bounds = vec![[DVec2::INFINITY, DVec2::NEG_INFINITY]; mappings.len()];
    for (triangle, piece) in skin.triangles.iter().zip(&islands.piece_of_triangle) {
        for texel in triangle.texels {
            let place = mappings[*piece].apply(texel);
            let [low, high] = &mut bounds[*piece];
            (*low, *high) = (low.min(place), high.max(place));
        }
    }
    bounds
}

fn flattened(before: &Skin, after: &Skin, options: &RepackOptions) -> usize {
    let is_flattened = |(before, after): (&SkinTriangle, &SkinTriangle)| {
        let kept = if options.unmirror { before.sense().abs() } else { before.sense() };
        kept != 0 && kept != after.sense()
    };
    before.triangles.iter().zip(&after.triangles).filter(|pair| is_flattened(*pair)).count()
}
