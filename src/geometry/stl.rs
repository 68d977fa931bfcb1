//! STL files, text and binary: triangles without anything else [3D Systems, "StereoLithography Interface Specification"].

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use super::text::CountedBytes;
use super::{CREASE_DEGREES, Error, Mesh, Part, Warning, far, normals, text};
use crate::math::Aabb;
use crate::process;

/// Bytes before the triangles of a binary file, and bytes of each.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file. Vertices at one place are one; normals are made from the triangles, smooth up to [`CREASE_DEGREES`]: those
/// of the file are its triangles' own.
///
/// # Errors
///
/// A file that is no STL or is cut off, or has no triangles; positions that are not finite.
pub(super) fn load(path: &Path) -> Result<(Mesh, Vec<Warning>), Error> {
    let bytes = text::read(path)?;
    let wrong =
        |at: usize, what: String| Error::Inside { path: path.to_owned(), place: format!("triangle {at}"), what };
    let mut mesh = Mesh { name: path.display().to_string(), ..Mesh::default() };
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let reading = process::reading(text::name(path), bytes.len() as u64);
    for solid in solids(&bytes) {
        let first = mesh.indices.len() / 3;
        let mut reader = CountedBytes { inner: Cursor::new(solid), reading: &reading };
        let triangles = stl_io::create_stl_reader(&mut reader);
        let triangles = triangles.map_err(|error| wrong(first, format!("is no STL: {error}")))?;
        for (at, triangle) in (first..).zip(triangles) {
            let triangle = triangle.map_err(|error| wrong(at, format!("cannot be read: {error}")))?;
            for corner in triangle.vertices {
                // Adding zero turns -0 to 0: both are one place.
                let position = corner.0.map(|number| number + 0.0);
                if !position.iter().all(|number| number.is_finite()) {
                    return Err(wrong(at, String::from("has a position that is not finite")));
                }
                let next = u32::try_from(mesh.positions.len());
                let next = next.map_err(|_| Error::TooLarge { path: path.to_owned(), what: "vertices" })?;
                let index = *known.entry(position.map(f32::to_bits)).or_insert(next);
                if index == next {
                    mesh.positions.push(position);
                    mesh.normals.push([0.0; 3]);
                }
                mesh.indices.push(index);
            }
        }
    }
    if mesh.indices.is_empty() {
        return Err(Error::NoFaces { path: path.to_owned() });
    }
    // A text's digits beyond those of f32 are lost in the crate that reads it.
    let positions: Vec<[f64; 3]> = mesh.positions.iter().map(|position| position.map(f64::from)).collect();
    (mesh.positions, mesh.origin) = far::relative(&positions);
    let indices = u32::try_from(mesh.indices.len());
    let end = indices.map_err(|_| Error::TooLarge { path: path.to_owned(), what: "indices" })?;
    normals::complete(&mut mesh, CREASE_DEGREES.to_radians());
    mesh.parts = vec![Part { name: String::new(), indices: 0..end, material: None, bounds: Aabb::EMPTY }];
    mesh.update_bounds();
    Ok((mesh, Vec::new()))
}

/// The solids of a file, each as a file of its own whose first word says what kind it is: binary ones may begin as text does,
/// and text with a bare `solid`.
fn solids(bytes: &[u8]) -> Vec<Vec<u8>> {
    const WORD: &[u8] = b"solid";
    if !bytes.starts_with(WORD) {
        return vec![bytes.to_vec()];
    }
    let count = bytes.get(HEADER - 4..HEADER).and_then(|count| <[u8; 4]>::try_from(count).ok()).map(u32::from_le_bytes);
    let is_binary = count.is_some_and(|count| {
        (count as usize).checked_mul(TRIANGLE).and_then(|all| all.checked_add(HEADER)) == Some(bytes.len())
    });
    if is_binary {
        return vec![[&[0; WORD.len()], &bytes[WORD.len()..]].concat()];
    }
    let mut solids: Vec<Vec<u8>> = Vec::new();
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        match (line.trim_ascii_start().strip_prefix(WORD), solids.last_mut()) {
            // The name behind the word says nothing here.
            (Some(_), _) => solids.push(b"solid \n".to_vec()),
            (None, Some(last)) => last.extend_from_slice(line),
            (None, None) => {}
        }
    }
    solids
}
