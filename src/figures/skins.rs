//! Skins that are made in memory: pre-lit decals, skins packed again, and pictures of a skin's maps. Knows materials; no GL.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::relief;
use crate::geometry::bump::{Bump, BumpSource};
use crate::geometry::normal_map::{HeightField, MipColors};
use crate::geometry::skin::{self, Raster, RepackOptions, Skin};
use crate::geometry::{Gloss, Material, Mesh, Texture};
use crate::output::canvas::Canvas;
use crate::scene::{Object, Scene};

/// A map of a skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkinMap {
    Heights,
    Normals,
    Decal,
}

/// The map of the first object with bumps, as a picture; of no size if it has none.
pub fn picture_of(scene: &Scene, map: SkinMap) -> Canvas {
    let material = scene.objects.iter().filter_map(|object| object.material.as_deref()).find(|own| own.bump.is_some());
    let found = material.and_then(|material| picture_in(material, map));
    found.unwrap_or_else(|| Canvas::new([1, 1], [0; 3]))
}

fn picture_in(material: &Material, map: SkinMap) -> Option<Canvas> {
    let bump = material.bump.as_ref()?;
    let (size, rows): ([u32; 2], Vec<[u8; 3]>) = match (map, &bump.source) {
        (SkinMap::Heights, BumpSource::Heights { field, .. }) => {
            let gray = |height: &f32| [(255.0 * height).round() as u8; 3];
            ([field.width, field.height], field.heights.iter().map(gray).collect())
        }
        (SkinMap::Normals, source) => {
            let level = relief::normals(source, bump.border);
            let colors = level.unsigned(MipColors::UnitAndLength);
            ([level.width, level.height], colors.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
        }
        (SkinMap::Decal, _) => {
            let decal = material.decal.as_ref()?;
            let colors = decal.rgba.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]);
            ([decal.width, decal.height], colors.collect())
        }
        (SkinMap::Heights, BumpSource::Normals { .. }) => return None,
    };
    let bytes = rows.chunks_exact(size[0].max(1) as usize).rev().flatten().flatten().copied().collect();
    Some(Canvas::of_bytes(size, bytes))
}

/// A share of painted light that does not depend on the normal, and one that falls from above.
const PAINTED: [f64; 2] = [0.25, 0.9];

/// Share of a triangle's height beyond its edges that is painted too, so that filters find no unpainted texel.
const RIM: f64 = 0.2;

/// The decal times light from above on the bumps of `mesh`. `up` is in model space. Where triangles share texels, the one
/// that covers a texel best has it.
pub fn pre_lit(decal: &Texture, mesh: &Mesh, bump: &Bump, up: DVec3) -> Texture {
    let (Some(texcoords), Some(tangents)) = (&mesh.texcoords, &mesh.tangents) else { return decal.clone() };
    let bumps = relief::normals(&bump.source, bump.border);
    let [width, height] = [decal.width, decal.height].map(f64::from);
    let mut lights: Vec<(f64, f64)> = vec![(f64::NEG_INFINITY, 1.0); decal.rgba.len() / 4];
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let vector = |all: &[[f32; 3]], index: u32| DVec3::from_array(all[index as usize].map(f64::from));
        let skin = triangle.map(|index| DVec2::from_array(texcoords[index as usize].map(f64::from)));
        let mix = |all: &[[f32; 3]], weights: [f64; 3]| {
            (0..3).map(|corner| weights[corner] * vector(all, triangle[corner])).sum::<DVec3>()
        };
        let texels = skin.map(|st| st * DVec2::new(width, height));
        for (index, weights) in covered(texels, [decal.width, decal.height]) {
            let least = weights[0].min(weights[1]).min(weights[2]);
            if least <= lights[index].0 {
                continue;
            }
            let st: DVec2 = (0..3).map(|corner| weights[corner] * skin[corner]).sum();
            let bump = bumps.bilinear(st);
            let normal = bump.x * mix(&tangents.tangents, weights)
                + bump.y * mix(&tangents.bitangents, weights)
                + bump.z * mix(&mesh.normals, weights);
            let light = PAINTED[0] + PAINTED[1] * normal.normalize_or_zero().dot(up).max(0.0);
            lights[index] = (least, light);
        }
    }
    let colors = decal.rgba.as_chunks::<4>().0.iter().zip(&lights);
    let lit = colors.flat_map(|([r, g, b, a], (_, light))| {
        let [r, g, b] = [r, g, b].map(|code| (f64::from(*code) * light).round().min(255.0) as u8);
        [r, g, b, *a]
    });
    Texture { rgba: lit.collect(), ..decal.clone() }
}

/// The texels whose centres are in a triangle or on its rim, by number, rows from the bottom up, and the corners' weights.
fn covered([a, b, c]: [DVec2; 3], size: [u32; 2]) -> impl Iterator<Item = (usize, [f64; 3])> {
    let area = (b - a).perp_dot(c - a);
    let (low, high) = (a.min(b).min(c) - 2.0, a.max(b).max(c) + 2.0);
    let range = |axis: usize| low[axis].max(0.0) as u32..high[axis].clamp(0.0, f64::from(size[axis])) as u32;
    let (columns, rows) = (range(0), range(1));
    let texels = rows.flat_map(move |y| columns.clone().map(move |x| [x, y]));
    texels.filter(move |_| area != 0.0).filter_map(move |[x, y]| {
        let at = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let weights = [(c - b).perp_dot(at - b), (a - c).perp_dot(at - c), (b - a).perp_dot(at - a)];
        let weights = weights.map(|part| part / area);
        let is_near = weights.iter().all(|weight| *weight >= -RIM);
        is_near.then_some(((y * size[0] + x) as usize, weights))
    })
}

/// Packs an object's skin again, with its decal, gloss and heights.
pub fn repack(object: &mut Object, material: &mut Material, bump: &Bump, unmirror: bool) -> Result<(), skin::Error> {
    let [width, height] = bump.size();
    let Some(old) = Skin::of_mesh(&object.mesh, [width, height]) else { return Ok(()) };
    let new = skin::repack(&old, &options(unmirror))?;
    let again = |texture: &Texture| -> Result<Arc<Texture>, skin::Error> {
        Ok(Arc::new(texture_of(&texture.name, &new.resample(&old, &raster_of(texture))?)))
    };
    material.decal = material.decal.as_deref().map(again).transpose()?;
    if let Some(Gloss::Map(map)) = &material.gloss {
        material.gloss = Some(Gloss::Map(again(map)?));
    }
    if let BumpSource::Heights { field, scale, difference } = &bump.source {
        let field = heights_of(&field.name, &new.resample(&old, &raster_of_heights(field))?);
        let source = BumpSource::Heights { field, scale: *scale, difference: *difference };
        material.bump = Some(Arc::new(Bump::new(source, bump.format, bump.colors, bump.border, bump.fit)));
    }
    rebase(object, on_skin(&object.mesh, new.skin.size(), new.skin.texels()), bump);
    Ok(())
}

/// The mesh with three vertices a triangle, at these texels of a skin of `size`, y downwards. It has no bases.
fn on_skin(mesh: &Mesh, size: [u32; 2], texels: impl Iterator<Item = [DVec2; 3]>) -> Mesh {
    let [width, height] = size.map(f64::from);
    let place = |texel: DVec2| [(texel.x / width) as f32, (1.0 - texel.y / height) as f32];
    let texcoords: Vec<[f32; 2]> = texels.flatten().map(place).collect();
    let pick = |all: &[[f32; 3]]| mesh.indices.iter().map(|index| all[*index as usize]).collect();
    Mesh {
        positions: pick(&mesh.positions),
        normals: pick(&mesh.normals),
        indices: (0..texcoords.len() as u32).collect(),
        texcoords: Some(texcoords),
        tangents: None,
        ..mesh.clone()
    }
}

/// Gives an object the mesh with the bases of its skin.
fn rebase(object: &mut Object, mesh: Mesh, bump: &Bump) {
    if let Some((mesh, counts)) = mesh.with_bases(bump.fit, None) {
        (object.mesh, object.bases) = (Arc::new(mesh), Some(counts));
    }
}

/// Quarter turns of pieces, one after the other.
const CARELESS: [u32; 8] = [0, 1, 2, 1, 3, 2, 0, 3];

/// Texels between pieces.
const APART: f64 = 8.0;

/// A mesh's skin with its pieces side by side, each turned by some quarter turns: the mesh, and the size of the skin.
/// `None`: it has no skin.
pub fn careless(mesh: &Mesh, size: [u32; 2]) -> Result<Option<(Mesh, [u32; 2])>, skin::Error> {
    let Some(old) = Skin::of_mesh(mesh, size) else { return Ok(None) };
    let packed = skin::repack(&old, &options(false))?;
    let pieces = &packed.piece_of_triangle;
    let mut bounds = vec![[DVec2::INFINITY, DVec2::NEG_INFINITY]; pieces.iter().max().map_or(0, |last| last + 1)];
    for (piece, texel) in pieces.iter().zip(old.texels()).flat_map(|(piece, all)| all.map(|texel| (*piece, texel))) {
        let [low, high] = bounds[piece];
        bounds[piece] = [low.min(texel), high.max(texel)];
    }
    let side = bounds.iter().map(|[low, high]| (*high - *low).max_element()).fold(0.0, f64::max).ceil() + APART;
    let turned = |(piece, texels): (&usize, [DVec2; 3])| {
        let [low, high] = bounds[*piece];
        let middle = DVec2::new(side * (*piece as f64 + 0.5), 0.5 * side);
        texels.map(|texel| {
            let mut from_middle = texel - 0.5 * (low + high);
            (0..CARELESS[piece % CARELESS.len()]).for_each(|_| from_middle = from_middle.perp());
            middle + from_middle
        })
    };
    let size = [side as u32 * bounds.len().max(1) as u32, side as u32];
    Ok(Some((on_skin(mesh, size, pieces.iter().zip(old.texels()).map(turned)), size)))
}

/// Turns the pieces of an object's skin; `repacked`: and packs them again.
pub fn turn_carelessly(object: &mut Object, bump: &Bump, repacked: bool) -> Result<(), skin::Error> {
    let Some((mut mesh, size)) = careless(&object.mesh, bump.size())? else { return Ok(()) };
    if repacked && let Some(skin) = Skin::of_mesh(&mesh, size) {
        let new = skin::repack(&skin, &options(false))?;
        mesh = on_skin(&mesh, new.skin.size(), new.skin.texels());
    }
    rebase(object, mesh, bump);
    Ok(())
}

/// As `glumbra repack` has them for an MD2 file.
pub fn options(unmirror: bool) -> RepackOptions {
    RepackOptions { size: None, gutter: 4, unmirror, cut_degrees: 180.0, steps: Some(1) }
}

fn flipped<T: Copy>(rows: &[T], width: u32) -> Vec<T> {
    rows.chunks_exact(width.max(1) as usize).rev().flatten().copied().collect()
}

fn raster_of(texture: &Texture) -> Raster {
    let samples = flipped(texture.rgba.as_chunks::<4>().0, texture.width);
    let samples = samples.into_iter().flatten().map(u16::from).collect();
    Raster { size: [texture.width, texture.height], channels: 4, is_deep: false, samples }
}

fn texture_of(name: &str, raster: &Raster) -> Texture {
    let rows = flipped(raster.samples.as_chunks::<4>().0, raster.size[0]);
    let rgba: Vec<u8> = rows.into_iter().flatten().map(|code| code as u8).collect();
    let has_alpha = rgba.iter().skip(3).step_by(4).any(|alpha| *alpha != 255);
    Texture { name: name.to_owned(), width: raster.size[0], height: raster.size[1], rgba, has_alpha }
}

fn raster_of_heights(field: &HeightField) -> Raster {
    let codes = flipped(&field.heights, field.width).into_iter().map(|height| (65535.0 * height).round() as u16);
    Raster { size: [field.width, field.height], channels: 1, is_deep: true, samples: codes.collect() }
}

fn heights_of(name: &str, raster: &Raster) -> HeightField {
    let heights = flipped(&raster.samples, raster.size[0]).into_iter().map(|code| f32::from(code) / 65535.0).collect();
    HeightField { name: name.to_owned(), width: raster.size[0], height: raster.size[1], heights }
}
