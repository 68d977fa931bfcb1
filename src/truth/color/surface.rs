//! The visible point of a surface: material, interpolated normal, decal, bumps and gloss.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use super::bounds::Bounds;
use super::bumps::{BumpMap, BumpedPoint, Facet};
use super::projected::{Picture, Place, Wrapped, window};
use super::sample::Sample;
use super::unit;
use crate::geometry::{Bump, Gloss, Material, Placement, Texture};
use crate::scene::{Object, Scene};
use crate::truth::primary::SeenPoint;
use crate::truth::wave;

/// A point of a surface.
pub(super) struct Shaded<'a> {
    pub material: &'a Material,
    /// True if normals count; false: the diffuse colour as it is.
    pub lit: bool,
    pub at: Sample,
    /// Unit vector, interpolated, on the side that is seen.
    pub normal: DVec3,
    pub corners: [DVec3; 3],
    /// As the mesh has them, of unit length.
    pub corner_normals: [DVec3; 3],
    /// Barycentric coordinates of the point.
    pub weights: [f64; 3],
    pub decal: [Bounds; 3],
    /// Share of the specular light.
    pub gloss: Bounds,
    /// `None`: a surface without bumps.
    pub bumps: Option<BumpedPoint>,
}

/// Values that are the same all over an object.
pub(super) struct SurfaceTable<'a> {
    /// Matrix of normals of each object: the inverse transpose of its linear part.
    normals: Vec<DMat3>,
    fallback: Material,
    /// Decals by their addresses.
    decals: HashMap<usize, Picture<'a>>,
    /// Maps of gloss by the addresses of their pictures and their channels.
    glosses: HashMap<(usize, usize), Picture<'a>>,
    /// Bump maps by their addresses.
    bumps: HashMap<usize, BumpMap>,
}

/// The key of a decal, or of another part of a material.
fn key<T>(of: &T) -> usize {
    std::ptr::from_ref(of) as usize
}

/// The picture of a material's gloss, and the channel that has it.
fn gloss_map(material: &Material) -> Option<(&Texture, usize)> {
    match material.gloss.as_ref()? {
        Gloss::DecalAlpha => Some((material.decal.as_deref()?, 3)),
        Gloss::Map(map) => Some((&**map, if map.has_alpha { 3 } else { 0 })),
    }
}

impl<'a> SurfaceTable<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let normal = |object: &Object| DMat3::from_mat4(object.world_from_model).inverse().transpose();
        let normals = scene.objects.iter().map(normal).collect();
        let materials = || {
            scene.objects.iter().flat_map(|object| {
                let own = object.material.as_deref().into_iter();
                own.chain(&object.mesh.materials)
            })
        };
        let decals = materials().filter_map(|material| material.decal.as_deref());
        let decals = decals.map(|decal| (key(decal), Picture::new(decal))).collect();
        let glosses = materials().filter_map(gloss_map);
        let glosses = glosses.map(|(map, channel)| ((key(map), channel), Picture::of_channel(map, channel))).collect();
        let bumps: Vec<&Arc<Bump>> = materials().filter_map(|material| material.bump.as_ref()).collect();
        let bumps = bumps.into_iter().map(|bump| (key(&**bump), BumpMap::new(bump))).collect();
        Self { normals, fallback: Material::default(), decals, glosses, bumps }
    }

    /// The surface that a pixel shows; `None`: the mesh breaks its own rules.
    pub fn at<'s>(&'s self, seen: &SeenPoint<'_>, scene: &'s Scene, subpixel: f64) -> Option<Shaded<'s>> {
        let triangle = &seen.triangle;
        let object = scene.objects.get(triangle.object as usize)?;
        let first = 3 * triangle.index as usize;
        let indices: [usize; 3] = object
            .mesh
            .indices
            .get(first..first + 3)?
            .iter()
            .map(|index| *index as usize)
            .collect::<Vec<_>>()
            .try_into()
            .ok()?;
        let part = object.mesh.parts.iter().find(|part| part.indices.contains(&(first as u32)));
        let own = || object.mesh.materials.get(part?.material?);
        let material = object.material.as_deref().or_else(own).unwrap_or(&self.fallback);
        let weights = |point: DVec3| barycentric(&triangle.corners, point);
        let at = weights(seen.position);
        let matrix = self.normals[triangle.object as usize];
        let corner_normals = indices.map(|index| matrix * normal_at(object, index));
        let smooth = unit(mix(&corner_normals, at));
        let behind = smooth.dot(seen.position - scene.camera.eye) > 0.0 && smooth.dot(seen.normal) < 0.0;
        let beside = seen.spread.map(|way| way / subpixel);
        let texcoord = |point: DVec3| {
            let corners = indices.map(|index| texcoord(object, material, index));
            mix(&corners.map(|corner| corner.extend(0.0)), weights(point)).truncate()
        };
        let view = seen.position - scene.camera.eye;
        let own = Lookup { material, position: seen.position, beside, texcoord: &texcoord };
        let has_texcoords = object.mesh.texcoords.is_some() || material.texgen.is_some();
        let bump = material.bump.as_deref().filter(|_| has_texcoords && object.lit);
        let bumps = bump.and_then(|bump| {
            let facet = Facet {
                object,
                indices,
                corners: triangle.corners,
                texcoords: indices.map(|index| self::texcoord(object, material, index)),
                weights: at,
                moved: seen.spread.map(|way| {
                    let moved = weights(seen.position + way);
                    [0, 1, 2].map(|k: usize| moved[k] - at[k])
                }),
                perspective: beside.iter().map(|way| way.dot(view).abs()).sum::<f64>() / view.length_squared(),
                side: if behind { -1.0 } else { 1.0 },
            };
            let far = facet.texcoords.iter().map(|corner| corner.abs().max_element()).fold(1.0, f64::max);
            let place = own.place(&Placement::default(), far);
            // A sample moves by the 256th part of a pixel each way.
            let place = Place { error: DVec2::splat(1e-6 * far) + (place.pixel[0] + place.pixel[1]) / 256.0, ..place };
            Some(BumpedPoint::new(&facet, bump, self.bumps.get(&key(bump))?, scene, matrix, &place))
        });
        let tint = object.mesh.colors.as_ref().map(|colors| {
            let corners = indices.map(|index| DVec3::from_array(colors[index].map(f64::from)));
            let at = |point: DVec3| mix(&corners, weights(point));
            let around = seen.spread.map(|way| [at(seen.position + way), at(seen.position - way)]);
            (at(seen.position), around.concat())
        });
        Some(Shaded {
            material,
            lit: object.lit,
            at: Sample { position: seen.position, spread: seen.spread, error: seen.error, beside },
            gloss: if has_texcoords { self.gloss(&own) } else { Bounds::ALL },
            bumps,
            normal: if behind { -smooth } else { smooth },
            corners: triangle.corners,
            corner_normals: corner_normals.map(unit),
            weights: at,
            decal: tinted(if has_texcoords { self.decal(&own) } else { [Bounds::ALL; 3] }, tint),
        })
    }

    /// The decal's colour, filtered by mipmaps: bounds over all that a pixel's filter may meet.
    fn decal(&self, own: &Lookup<'_>) -> [Bounds; 3] {
        let decal = own.material.decal.as_deref();
        let Some(picture) = decal.and_then(|decal| self.decals.get(&key(decal))) else { return [Bounds::ALL; 3] };
        own.window(picture, &own.material.decal_placement)
    }

    /// Share of the specular light, by the same filter.
    fn gloss(&self, own: &Lookup<'_>) -> Bounds {
        let picture = gloss_map(own.material).and_then(|(map, channel)| self.glosses.get(&(key(map), channel)));
        let placement = match own.material.gloss {
            Some(Gloss::DecalAlpha) => own.material.decal_placement,
            _ => Placement::default(),
        };
        picture.map_or(Bounds::ALL, |picture| own.window(picture, &placement)[0])
    }
}

/// A point of a surface where its pictures are looked up.
struct Lookup<'s> {
    material: &'s Material,
    position: DVec3,
    /// Ways to the points that the pixels beside show.
    beside: [DVec3; 2],
    texcoord: &'s dyn Fn(DVec3) -> DVec2,
}

impl Lookup<'_> {
    /// The place in a picture. `far`: the greatest coordinate of the triangle, of which f32 keeps a share.
    fn place(&self, placement: &Placement, far: f64) -> Place {
        let [scale, offset] = [placement.scale, placement.offset].map(|pair| DVec2::from_array(pair.map(f64::from)));
        let place = |point: DVec3| scale * (self.texcoord)(point) + offset;
        let st = place(self.position);
        let step = self.beside.map(|way| (place(self.position + way) - st).abs());
        Place { st, error: DVec2::splat(1e-6 * far) + (step[0] + step[1]) / 128.0, pixel: step }
    }

    fn window(&self, picture: &Picture<'_>, placement: &Placement) -> [Bounds; 3] {
        let wrap = if placement.clamped { Wrapped::Clamped } else { Wrapped::Repeated };
        window(picture, wrap, &self.place(placement, 1.0), true)
    }
}

/// The decal's colour times that of the vertices, interpolated: at the point, and at those that its sample may show.
fn tinted(decal: [Bounds; 3], tint: Option<(DVec3, Vec<DVec3>)>) -> [Bounds; 3] {
    let Some((value, around)) = tint else { return decal };
    // Rounding of the interpolation in floats.
    const ROUNDING: f64 = 1e-6;
    std::array::from_fn(|channel| {
        let beside = around.iter().map(|color| color[channel]);
        let others = beside.flat_map(|color| [(color - ROUNDING).max(0.0), color + ROUNDING]);
        decal[channel].times(Bounds::around(value[channel].max(0.0), others))
    })
}

/// A vertex's normal in model space, as its wave turns it.
fn normal_at(object: &Object, index: usize) -> DVec3 {
    let own = DVec3::from_array(object.mesh.normals[index].map(f64::from));
    let place = DVec3::from_array(object.mesh.positions[index].map(f64::from));
    object.wave.map_or(own, |wave| wave::turned(own, place, &wave))
}

fn mix(corners: &[DVec3; 3], weights: [f64; 3]) -> DVec3 {
    (0..3).map(|k| corners[k] * weights[k]).sum()
}

fn barycentric([a, b, c]: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let area = (b - a).cross(c - a);
    let scale = area.length_squared().recip();
    let v = (point - a).cross(c - a).dot(area) * scale;
    let w = (b - a).cross(point - a).dot(area) * scale;
    [1.0 - v - w, v, w]
}

/// A vertex's texture coordinates: the mesh's own, or by object-linear planes.
fn texcoord(object: &Object, material: &Material, index: usize) -> DVec2 {
    if let Some(texgen) = &material.texgen {
        let [x, y, z] = object.mesh.positions[index].map(f64::from);
        let along = |plane: [f32; 4]| {
            let [a, b, c, d] = plane.map(f64::from);
            f64::from(texgen.scale) * (a * x + b * y + c * z + d)
        };
        return DVec2::new(along(texgen.s), along(texgen.t));
    }
    let own = object.mesh.texcoords.as_ref().and_then(|all| all.get(index));
    DVec2::from_array(own.copied().unwrap_or_default().map(f64::from))
}
