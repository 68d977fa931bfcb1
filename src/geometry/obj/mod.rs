//! OBJ files: the text is scanned for mistakes, which tobj reports without a line ([`scan`]), moved to its vertices
//! ([`place`]), rewritten in the rare files that tobj would misread ([`rewrite`]), parsed by tobj, cut into triangles ([`polygon`]) and given the normals that it lacks
//! ([`super::normals`]). Format: Wavefront's "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual; polygons
//! only.

pub(super) mod corner;
mod place;
pub(super) mod polygon;
mod rewrite;
pub(super) mod scan;

use std::cell::Cell;
use std::collections::HashSet;
use std::path::Path;

use super::mtl::{self, Library};
use super::text::CountedBytes;
use super::{Error, Mesh, Part, Warning, normals, text};
use crate::math::Aabb;
use crate::process::{self, Reading};
use scan::{Scan, scan};

/// The angle in degrees between two triangles beyond which their common edge stays sharp, where normals are missing.
pub const CREASE_DEGREES: f64 = 60.0;

/// Reads the OBJ file at `path`, its material libraries and their textures.
///
/// A part for each run of faces with one object or group and one material. Normals that are missing, of no length or not
/// finite are made from the triangles, smooth up to [`CREASE_DEGREES`]. Warnings are: a library that does not exist, a
/// material that no library has, a texture that cannot be loaded, faces of fewer than three vertices, concave
/// ones too large to be cut well, and what is not drawn
/// (lines, points, curves, colours of vertices, statements of MTL). Positions that are far away from the file's origin, for
/// their size, are relative to [`Mesh::origin`].
pub fn load_obj(path: &Path) -> Result<(Mesh, Vec<Warning>), Error> {
    decode_obj(path, &text::read(path)?)
}

/// The same for the `bytes` of an OBJ file, which is called `path` in messages and next to which its material libraries lie.
pub fn decode_obj(path: &Path, bytes: &[u8]) -> Result<(Mesh, Vec<Warning>), Error> {
    let text = text::decode(bytes, path)?;
    let reading = process::reading(text::name(path), 2 * text.len() as u64);
    let scan = scan(&text, path, &reading)?;
    if u32::try_from(scan.places.count().max(text.len())).is_err() {
        return Err(Error::TooLarge { path: path.to_owned(), what: "bytes" });
    }
    let mut warnings: Vec<Warning> = scan.oddities.warnings().collect();
    if let Some((line, message)) = place::warning(&scan.places, scan.origin, &text) {
        warnings.push(Warning { path: path.to_owned(), line, message });
    }
    let library = load_libraries(&scan, path, &mut warnings)?;
    let models = parse(&text, &scan, &library, &reading).map_err(|error| {
        // The scan has refused everything that tobj refuses; if not, the error still names the file.
        Error::malformed(path, 0, error.to_string())
    })?;
    let (mut mesh, fanned) = join(models, path)?;
    if fanned > 0 {
        let (most, s) = (polygon::MOST_CORNERS_TO_CLIP, if fanned == 1 { "" } else { "s" });
        let message = format!(
            "{fanned} concave polygon{s} of more than {most} corners: cut as a fan, with triangles that overlap; write smaller ones"
        );
        warnings.push(Warning { path: path.to_owned(), line: 0, message });
    }
    let repaired = normals::complete(&mut mesh, CREASE_DEGREES.to_radians());
    if repaired > 0 {
        let message = format!("{repaired} normals have no length or are not finite; made from the triangles");
        warnings.push(Warning { path: path.to_owned(), line: 0, message });
    }
    mesh.materials = library.load_materials(&mut warnings);
    mesh.origin = scan.origin;
    mesh.update_bounds();
    Ok((mesh, warnings))
}

/// Reads what the `mtllib` statements name, and warns of `usemtl` names that none of them has.
fn load_libraries(scan: &Scan, path: &Path, warnings: &mut Vec<Warning>) -> Result<Library, Error> {
    let mut library = Library::default();
    let mut read = HashSet::new();
    for (line, written) in &scan.libraries {
        for name in mtl::find_libraries(path, written) {
            match name {
                Ok(found) if !read.insert(found.clone()) => {}
                Ok(found) => library.read(&found)?,
                Err(name) => {
                    let message = format!("there is no material library '{name}'");
                    warnings.push(Warning { path: path.to_owned(), line: *line, message });
                }
            }
        }
    }
    let mut unknown = HashSet::new();
    for (line, name) in &scan.uses {
        let name = if name.is_empty() { rewrite::UNNAMED } else { name.as_str() };
        // If no library could be read, that was reported, or none was named.
        if !library.is_empty() && !library.has(name) && unknown.insert(name) {
            let message = format!("no material is named '{name}'; the default is used");
            warnings.push(Warning { path: path.to_owned(), line: *line, message });
        }
    }
    Ok(library)
}

/// The text's models as tobj reads them: single-indexed, polygons kept.
fn parse(text: &str, scan: &Scan, library: &Library, reading: &Reading) -> Result<Vec<tobj::Model>, tobj::LoadError> {
    let options =
        tobj::LoadOptions { single_index: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let rewritten = scan.needs_rewrite.then(|| rewrite::rewrite(text, scan));
    let mut reader = CountedBytes { inner: rewritten.as_deref().unwrap_or(text).as_bytes(), reading };
    // tobj gets all libraries as one, at its first `mtllib`.
    let asked = Cell::new(false);
    let materials = |_: &Path| match asked.replace(true) {
        false => library.for_tobj(),
        true => tobj::load_mtl_buf(&mut &b""[..]),
    };
    tobj::load_obj_buf(&mut reader, &options, materials).map(|(models, _)| models)
}

/// One mesh of all models, each a part, whose normals may be missing or wrong; and the number of polygons that are too large to
/// be cut well.
fn join(models: Vec<tobj::Model>, path: &Path) -> Result<(Mesh, usize), Error> {
    let mut fanned = 0;
    let mut mesh = Mesh { name: path.display().to_string(), ..Mesh::default() };
    let has_texcoords = models.iter().any(|model| !model.mesh.texcoords.is_empty());
    let mut texcoords = Vec::new();
    for model in models.into_iter().filter(|model| !model.mesh.indices.is_empty()) {
        let tobj::Mesh { positions, normals, texcoords: st, indices, face_arities, material_id, .. } = model.mesh;
        let first = mesh.positions.len();
        let start = index_u32(mesh.indices.len(), path)?;
        mesh.positions.extend_from_slice(positions.as_chunks::<3>().0);
        let end = mesh.positions.len();
        mesh.normals.extend_from_slice(normals.as_chunks::<3>().0);
        mesh.normals.resize(end, [0.0; 3]);
        if has_texcoords {
            texcoords.extend_from_slice(st.as_chunks::<2>().0);
            texcoords.resize(end, [0.0; 2]);
        }
        let offset = index_u32(first, path)?;
        let indices: Vec<u32> = indices.into_iter().map(|index| index + offset).collect();
        fanned += append_triangles(&mut mesh, indices, &face_arities);
        let stop = index_u32(mesh.indices.len(), path)?;
        let name = if model.name == "unnamed_object" { String::new() } else { model.name };
        mesh.parts.push(Part { name, indices: start..stop, material: material_id, bounds: Aabb::EMPTY });
    }
    mesh.texcoords = has_texcoords.then_some(texcoords);
    Ok((mesh, fanned))
}

/// Appends the faces `indices`, of `arities` corners each; none given: all have three. Counts those that are
/// too large to be cut well.
fn append_triangles(mesh: &mut Mesh, indices: Vec<u32>, arities: &[u32]) -> usize {
    if arities.is_empty() {
        if mesh.indices.is_empty() {
            mesh.indices = indices;
        } else {
            mesh.indices.extend_from_slice(&indices);
        }
        return 0;
    }
    let mut fanned = 0;
    let mut rest = &indices[..];
    for arity in arities {
        let (face, after) = rest.split_at((*arity as usize).min(rest.len()));
        let emit = &mut |triangle: [u32; 3]| mesh.indices.extend_from_slice(&triangle);
        fanned += usize::from(!polygon::triangulate(face, &mesh.positions, emit));
        rest = after;
    }
    fanned
}

fn index_u32(index: usize, path: &Path) -> Result<u32, Error> {
    u32::try_from(index).map_err(|_| Error::TooLarge { path: path.to_owned(), what: "indices" })
}

#[cfg(test)]
mod tests;
