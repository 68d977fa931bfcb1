//! A glTF's mesh: its primitives joined, each a part with its material [Khronos, "glTF 2.0 Specification", 3.7].

use glam::DVec3;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::super::tally::WarningTally;
use super::super::tangents::BasisFit;
use super::super::{CREASE_DEGREES, Error, Mesh, MeshTangents, Part, far, normals};
use super::accessor::NUMBERS;
use super::deform::{Deform, Vertices};
use super::file::File;
use super::material::Surface;
use crate::math::Aabb;

/// The mesh `meshes[index]`, deformed, in world space if it has a skin; `surfaces`: the file's materials. Without triangles
/// it is empty.
pub(super) fn read(
    index: usize,
    file: &File,
    surfaces: &[Surface],
    deform: &Deform,
    odd: &mut WarningTally,
) -> Result<Mesh, Error> {
    let source = &file.root.meshes[index];
    let name = source.name.clone().unwrap_or_else(|| format!("meshes[{index}]"));
    let mut joined = Mesh { name: format!("{}#{name}", file.path.display()), ..Mesh::default() };
    for (at, primitive) in source.primitives.iter().enumerate() {
        let place = format!("meshes[{index}].primitives[{at}]");
        let surface = match primitive.material {
            None => Surface::absent(),
            Some(material) => {
                file.get(material, &place, "materials")?;
                surfaces.get(material.value()).cloned().unwrap_or_else(Surface::absent)
            }
        };
        let reader = Reader { file, primitive, place, deform, odd };
        if let Some(part) = reader.read(surface)? {
            let bytes =
                size_of_val(&part.positions[..]) + size_of_val(&part.normals[..]) + size_of_val(&part.indices[..]);
            append(&mut joined, part, &name, file)?;
            file.reading.advance(bytes as u64);
        }
    }
    joined.update_bounds();
    Ok(joined)
}

struct Reader<'a> {
    file: &'a File,
    primitive: &'a Primitive,
    place: String,
    deform: &'a Deform,
    odd: &'a mut WarningTally,
}

impl Reader<'_> {
    fn note(&mut self, kind: &str, what: &str) {
        let place = &self.place;
        self.odd.note(kind, &self.file.path, 0, || format!("{place}: {what}"));
    }

    fn attribute(&self, semantic: Semantic) -> Option<(Index<Accessor>, String)> {
        let place = format!("{}.attributes.{}", self.place, semantic.to_string());
        self.primitive.attributes.get(&Checked::Valid(semantic)).map(|index| (*index, place))
    }

    /// An attribute of every vertex.
    fn vectors<const N: usize>(&self, semantic: Semantic, count: usize) -> Result<Option<Vec<[f64; N]>>, Error> {
        let Some((index, place)) = self.attribute(semantic) else { return Ok(None) };
        let values = self.file.vectors::<N>(index, &place, NUMBERS)?;
        if values.len() != count {
            let what = format!("has {} elements for {count} vertices", values.len());
            return Err(self.file.error(place, what));
        }
        Ok(Some(values))
    }

    /// The primitive as a mesh with one material; `None`: there is nothing to draw.
    fn read(mut self, mut surface: Surface) -> Result<Option<Mesh>, Error> {
        let mode = match self.primitive.mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(self.file.error(format!("{}.mode", self.place), "is none that glTF knows")),
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            let what = if mode == Mode::Points { "points are not drawn" } else { "lines are not drawn" };
            self.note(what, what);
            return Ok(None);
        }
        let Some((index, place)) = self.attribute(Semantic::Positions) else {
            self.note("no positions", "has no POSITION: not drawn");
            return Ok(None);
        };
        let positions = self.file.vectors::<3>(index, &place, NUMBERS)?;
        let count = positions.len();
        let mut mesh = Mesh { indices: self.triangles(mode, count)?, ..Mesh::default() };
        if mesh.indices.is_empty() {
            return Ok(None);
        }
        self.texcoords(&mut mesh, &mut surface, count)?;
        mesh.colors = self.colors(count)?;
        let wants_bases = surface.material.bump.is_some();
        let tangents = if wants_bases { self.vectors::<4>(Semantic::Tangents, count)? } else { None };
        let normals = self.vectors::<3>(Semantic::Normals, count)?;
        let (has_normals, has_tangents) = (normals.is_some(), tangents.is_some());
        let (normals, tangents) = (normals.unwrap_or_default(), tangents.unwrap_or_default());
        let mut vertices = Vertices { positions, normals, tangents };
        self.file.deform(&mut vertices, self.primitive, &self.place, self.deform)?;
        (mesh.positions, mesh.origin) = far::relative(&vertices.positions);
        if has_normals {
            mesh.normals = singles(&vertices.normals);
        } else {
            flatten(&mut mesh);
        }
        // A file's tangents count with its normals only.
        if has_normals && has_tangents {
            mesh.tangents = Some(MeshTangents::from_signed(&unit_normals(&vertices), &unit_tangents(&vertices)));
            self.complete(&mut mesh);
        } else {
            self.complete(&mut mesh);
            if wants_bases && let Some((based, _)) = mesh.with_bases(BasisFit::Orthogonal, None) {
                mesh = based;
            }
        }
        self.note_single_sided(&mesh, &surface);
        let part = Part { name: String::new(), indices: 0..0, material: None, bounds: Aabb::EMPTY };
        mesh.parts = vec![part];
        mesh.materials = vec![surface.material];
        Ok(Some(mesh))
    }

    fn complete(&mut self, mesh: &mut Mesh) {
        if normals::complete(mesh, CREASE_DEGREES.to_radians()) > 0 {
            self.note("normals", "has normals without a length: made from the triangles");
        }
    }

    /// The coordinates that the surface's textures take; a surface without them loses its textures.
    fn texcoords(&mut self, mesh: &mut Mesh, surface: &mut Surface, count: usize) -> Result<(), Error> {
        let uv = surface.uv;
        let set = uv.map_or(0, |uv| uv.set);
        match (self.vectors::<2>(Semantic::TexCoords(set), count)?, uv) {
            (Some(found), Some(uv)) => mesh.texcoords = Some(found.into_iter().map(|at| uv.texcoord(at)).collect()),
            (Some(found), None) => {
                mesh.texcoords = Some(found.into_iter().map(|[u, v]| [u as f32, (1.0 - v) as f32]).collect());
            }
            (None, Some(_)) => {
                let what = format!("has no TEXCOORD_{set} for its textures: drawn without them");
                self.note("no coordinates", &what);
                (surface.material.decal, surface.material.bump) = (None, None);
            }
            (None, None) => {}
        }
        Ok(())
    }

    /// Colours of the vertices, of which alpha is left out.
    fn colors(&mut self, count: usize) -> Result<Option<Vec<[f32; 3]>>, Error> {
        let Some((index, place)) = self.attribute(Semantic::Colors(0)) else { return Ok(None) };
        let has_alpha = matches!(self.file.get(index, &place, "accessors")?.type_, Checked::Valid(Type::Vec4));
        let rgb = match has_alpha {
            true => {
                let colors = self.vectors::<4>(Semantic::Colors(0), count)?.unwrap_or_default();
                if colors.iter().any(|[.., alpha]| *alpha < 1.0) {
                    self.note("alpha of colours", "the alpha of its vertices' colours is not drawn");
                }
                Some(colors.into_iter().map(|[red, green, blue, _]| [red, green, blue]).collect())
            }
            false => self.vectors::<3>(Semantic::Colors(0), count)?,
        };
        Ok(rgb
            .map(|colors| singles(&colors).into_iter().map(|rgb| rgb.map(|channel| channel.clamp(0.0, 1.0))).collect()))
    }

    /// Both sides of all triangles are drawn: those of a closed mesh that look inwards are not seen.
    fn note_single_sided(&mut self, mesh: &Mesh, surface: &Surface) {
        if !surface.double_sided && !mesh.is_closed() {
            self.note("single", "is single-sided and not closed: its back faces are drawn all the same");
        }
    }

    fn triangles(&mut self, mode: Mode, count: usize) -> Result<Vec<u32>, Error> {
        let most = u32::try_from(count).map_err(|_| self.file.error(self.place.clone(), "has too many vertices"))?;
        let order = match self.primitive.indices {
            None => (0..most).collect(),
            Some(index) => self.file.whole(index, &format!("{}.indices", self.place))?,
        };
        if let Some(at) = order.iter().position(|index| *index >= most) {
            let what = format!("is {} at element {at}, and the primitive has {count} vertices", order[at]);
            return Err(self.file.error(format!("{}.indices", self.place), what));
        }
        let rest = if mode == Mode::Triangles { order.len() % 3 } else { 0 };
        if rest != 0 || (order.len() < 3 && !order.is_empty()) {
            self.note("rest", "has indices that make no whole triangle: left out");
        }
        Ok(match mode {
            Mode::TriangleStrip => {
                let triangle = |(at, run): (usize, &[u32])| {
                    if at % 2 == 0 { [run[0], run[1], run[2]] } else { [run[0], run[2], run[1]] }
                };
                order.windows(3).enumerate().flat_map(triangle).collect()
            }
            Mode::TriangleFan => {
                let first = order.first().copied().unwrap_or_default();
                order.get(1..).unwrap_or_default().windows(2).flat_map(|pair| [pair[0], pair[1], first]).collect()
            }
            _ => order[..order.len() - rest].to_vec(),
        })
    }
}

fn singles(vectors: &[[f64; 3]]) -> Vec<[f32; 3]> {
    vectors.iter().map(|vector| vector.map(|number| number as f32)).collect()
}

/// Tangents of unit length, with a sense of 1 or -1.
fn unit_tangents(vertices: &Vertices) -> Vec<[f32; 4]> {
    let unit = |[x, y, z, w]: &[f64; 4]| {
        let tangent = DVec3::new(*x, *y, *z).normalize_or_zero().as_vec3();
        [tangent.x, tangent.y, tangent.z, if *w < 0.0 { -1.0 } else { 1.0 }]
    };
    vertices.tangents.iter().map(unit).collect()
}

fn unit_normals(vertices: &Vertices) -> Vec<[f32; 3]> {
    let unit = |normal: &[f64; 3]| DVec3::from_array(*normal).normalize_or_zero().as_vec3().to_array();
    vertices.normals.iter().map(unit).collect()
}

/// Gives each triangle vertices of its own, with its own normal, as glTF wants it where normals are missing.
fn flatten(mesh: &mut Mesh) {
    let old = std::mem::take(&mut mesh.indices);
    mesh.positions = old.iter().map(|index| mesh.positions[*index as usize]).collect();
    mesh.texcoords = mesh.texcoords.as_ref().map(|all| old.iter().map(|index| all[*index as usize]).collect());
    mesh.colors = mesh.colors.as_ref().map(|all| old.iter().map(|index| all[*index as usize]).collect());
    mesh.indices = (0..old.len() as u32).collect();
    mesh.normals = Vec::with_capacity(old.len());
    for corners in mesh.positions.as_chunks::<3>().0 {
        let [a, b, c] = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3().to_array();
        mesh.normals.extend([normal; 3]);
    }
}

/// Adds a primitive to the mesh.
fn append(joined: &mut Mesh, part: Mesh, name: &str, file: &File) -> Result<(), Error> {
    let too_large = || Error::TooLarge { path: file.path.clone(), what: "vertices or indices" };
    let (before, added) = (joined.positions.len(), part.positions.len());
    let first = u32::try_from(before + added).map_err(|_| too_large())? - added as u32;
    let start = joined.indices.len() as u32;
    let end = u32::try_from(joined.indices.len() + part.indices.len()).map_err(|_| too_large())?;
    joined.texcoords = filled(joined.texcoords.take(), before, part.texcoords, added, 0.0);
    joined.colors = filled(joined.colors.take(), before, part.colors, added, 1.0);
    let pair = |tangents: Option<MeshTangents>| tangents.map(|all| (all.tangents, all.bitangents)).unzip();
    let ((t, b), (more_t, more_b)) = (pair(joined.tangents.take()), pair(part.tangents));
    let (t, b) = (filled(t, before, more_t, added, 0.0), filled(b, before, more_b, added, 0.0));
    joined.tangents = t.zip(b).map(|(tangents, bitangents)| MeshTangents { tangents, bitangents });
    if joined.positions.is_empty() {
        joined.origin = part.origin;
    }
    // Of primitives in two places, the second has as many bits as its distance from the first one leaves.
    let shift = part.origin - joined.origin;
    let place = |position: [f32; 3]| (DVec3::from_array(position.map(f64::from)) + shift).as_vec3().to_array();
    joined.positions.extend(part.positions.into_iter().map(place));
    joined.normals.extend(part.normals);
    joined.indices.extend(part.indices.iter().map(|index| index + first));
    let material = match (joined.materials.last(), part.materials.into_iter().next()) {
        (Some(last), Some(next)) if *last == next => joined.materials.len() - 1,
        (_, Some(next)) => {
            joined.materials.push(next);
            joined.materials.len() - 1
        }
        (_, None) => return Ok(()),
    };
    let part = Part { name: name.to_owned(), indices: start..end, material: Some(material), bounds: Aabb::EMPTY };
    joined.parts.push(part);
    Ok(())
}

/// Two arrays joined; one that is missing is filled with `absent` where the other is not.
fn filled<const N: usize>(
    before: Option<Vec<[f32; N]>>,
    length: usize,
    after: Option<Vec<[f32; N]>>,
    added: usize,
    absent: f32,
) -> Option<Vec<[f32; N]>> {
    if before.is_none() && after.is_none() {
        return None;
    }
    let mut all = before.unwrap_or_else(|| vec![[absent; N]; length]);
    all.extend(after.unwrap_or_else(|| vec![[absent; N]; added]));
    Some(all)
}
