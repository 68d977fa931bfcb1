//! PLY files, text and binary: vertices with normals, texture coordinates and colours, and polygons [Turk, "The PLY Polygon
//! File Format"].

use std::io::BufReader;
use std::path::Path;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use super::obj::polygon;
use super::tally::WarningTally;
use super::{CREASE_DEGREES, Error, Material, Mesh, Part, Warning, normals, text};
use crate::math::Aabb;

/// Names of a vertex's numbers, each with those that other programs write.
const NAMES: [&[&str]; 11] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "diffuse_red", "r"],
    &["green", "diffuse_green", "g"],
    &["blue", "diffuse_blue", "b"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
];
const POSITION: [usize; 3] = [0, 1, 2];
const NORMAL: [usize; 3] = [3, 4, 5];
const COLOR: [usize; 3] = [6, 7, 8];
const TEXCOORD: [usize; 2] = [9, 10];

/// A line of any element.
#[derive(Default)]
struct Row {
    numbers: [Option<f64>; NAMES.len()],
    corners: Option<Vec<i64>>,
}

impl Row {
    fn take<const N: usize>(&self, places: [usize; N]) -> Option<[f64; N]> {
        let mut out = [0.0; N];
        for (slot, place) in out.iter_mut().zip(places) {
            *slot = self.numbers[place]?;
        }
        Some(out)
    }
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if matches!(name, "vertex_indices" | "vertex_index") {
            self.corners = list(&value);
            return if self.corners.is_some() {
                PropertyAccessResult::Set
            } else {
                PropertyAccessResult::UnsupportedType
            };
        }
        let Some(place) = NAMES.iter().position(|names| names.contains(&name)) else {
            return PropertyAccessResult::Ignored;
        };
        let scale = if COLOR.contains(&place) { full(&value) } else { 1.0 };
        self.numbers[place] = number(&value).map(|number| number / scale);
        if self.numbers[place].is_some() { PropertyAccessResult::Set } else { PropertyAccessResult::UnsupportedType }
    }
}

fn number(value: &Property) -> Option<f64> {
    Some(match value {
        Property::Char(value) => f64::from(*value),
        Property::UChar(value) => f64::from(*value),
        Property::Short(value) => f64::from(*value),
        Property::UShort(value) => f64::from(*value),
        Property::Int(value) => f64::from(*value),
        Property::UInt(value) => f64::from(*value),
        Property::Float(value) => f64::from(*value),
        Property::Double(value) => *value,
        _ => return None,
    })
}

/// A colour's full value: of a whole number the greatest that its type has, as programs write them.
fn full(value: &Property) -> f64 {
    match value {
        Property::Float(_) | Property::Double(_) => 1.0,
        Property::Short(_) | Property::UShort(_) => 65535.0,
        _ => 255.0,
    }
}

fn list(value: &Property) -> Option<Vec<i64>> {
    fn wide<T: Copy + Into<i64>>(all: &[T]) -> Vec<i64> {
        all.iter().map(|value| (*value).into()).collect()
    }
    Some(match value {
        Property::ListChar(all) => wide(all),
        Property::ListUChar(all) => wide(all),
        Property::ListShort(all) => wide(all),
        Property::ListUShort(all) => wide(all),
        Property::ListInt(all) => wide(all),
        Property::ListUInt(all) => wide(all),
        _ => return None,
    })
}

/// Reads a PLY file: the elements `vertex` and `face`. Normals that it lacks are made from the triangles, smooth up to
/// [`CREASE_DEGREES`]. Colours of vertices multiply a white material; their alpha is left out.
///
/// # Errors
///
/// A file that is no PLY or is cut off; one without faces; positions that are not finite; faces with vertices that are not
/// there.
pub(super) fn load(path: &Path) -> Result<(Mesh, Vec<Warning>), Error> {
    let bytes = text::read(path)?;
    let wrong = |place: String, what: String| Error::Inside { path: path.to_owned(), place, what };
    let broken = |error: &ParseError| {
        // The first line alone: others repeat the file's text.
        let (said, line) = (error.to_string(), error.line().unwrap_or(0));
        let first = said.lines().next().unwrap_or_default();
        let what = first.strip_prefix(&format!("Line {line}: ")).unwrap_or(first).to_owned();
        if line > 0 { Error::malformed(path, line, what) } else { wrong(String::from("PLY"), what) }
    };
    let parser = Parser::<Row>::new();
    let mut reader = Reader::new(BufReader::new(&bytes[..]));
    let header = parser.read_header(&mut reader).map_err(|error| broken(&error))?;
    let payload = parser.read_payload(&mut reader, &header).map_err(|error| broken(&error))?;
    let mut odd = WarningTally::default();
    for name in header.elements.keys().filter(|name| !matches!(name.as_str(), "vertex" | "face")) {
        odd.note(name, path, 0, || format!("element {name}: is not drawn"));
    }
    let rows = |name: &str| payload.get(name).map_or(&[][..], Vec::as_slice);
    let mut mesh = vertices(rows("vertex"), path)?;
    faces(&mut mesh, rows("face"), path, &mut odd)?;
    if mesh.indices.is_empty() {
        return Err(Error::NoFaces { path: path.to_owned() });
    }
    finish(&mut mesh, path, &mut odd);
    Ok((mesh, odd.warnings().collect()))
}

/// The vertices, whose normals may be missing.
fn vertices(rows: &[Row], path: &Path) -> Result<Mesh, Error> {
    let wrong = |at: usize, what: &str| {
        let place = format!("vertex {at}");
        Error::Inside { path: path.to_owned(), place, what: what.to_owned() }
    };
    let mut mesh = Mesh::default();
    let has =
        |places: &[usize]| rows.first().is_some_and(|first| places.iter().all(|place| first.numbers[*place].is_some()));
    let (mut colors, mut texcoords) = (Vec::new(), Vec::new());
    for (at, row) in rows.iter().enumerate() {
        let position = row.take(POSITION).ok_or_else(|| wrong(at, "has no x, y and z"))?;
        let position = position.map(|number| number as f32);
        if !position.iter().all(|number| number.is_finite()) {
            return Err(wrong(at, "has a position that is not finite"));
        }
        mesh.positions.push(position);
        mesh.normals.push(row.take(NORMAL).map_or([0.0; 3], |normal| normal.map(|number| number as f32)));
        let color = row.take(COLOR).unwrap_or([1.0; 3]);
        // Not a number is black.
        colors.push(color.map(|channel| if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1.0) as f32 }));
        texcoords.push(row.take(TEXCOORD).unwrap_or_default().map(|number| number as f32));
    }
    mesh.colors = has(&COLOR).then_some(colors);
    mesh.texcoords = has(&TEXCOORD).then_some(texcoords);
    if mesh.texcoords.iter().flatten().flatten().any(|number| !number.is_finite()) {
        return Err(wrong(0, "or another has texture coordinates that are not finite"));
    }
    Ok(mesh)
}

/// The polygons, cut into triangles.
fn faces(mesh: &mut Mesh, rows: &[Row], path: &Path, odd: &mut WarningTally) -> Result<(), Error> {
    let count = mesh.positions.len();
    for (at, row) in rows.iter().enumerate() {
        let corners = row.corners.as_deref().unwrap_or_default();
        let known = corners.iter().map(|corner| u32::try_from(*corner).ok().filter(|index| (*index as usize) < count));
        let Some(face) = known.collect::<Option<Vec<u32>>>() else {
            let what = format!("names a vertex that is none of the {count}");
            return Err(Error::Inside { path: path.to_owned(), place: format!("face {at}"), what });
        };
        if face.len() < 3 {
            odd.note("small", path, 0, || format!("face {at}: has fewer than three vertices: not drawn"));
            continue;
        }
        let mut triangles = Vec::new();
        if !polygon::triangulate(&face, &mesh.positions, &mut |triangle| triangles.extend_from_slice(&triangle)) {
            odd.note("fan", path, 0, || format!("face {at}: is concave and too large to be cut well: cut as a fan"));
        }
        mesh.indices.extend(triangles);
        if u32::try_from(mesh.indices.len()).is_err() {
            return Err(Error::TooLarge { path: path.to_owned(), what: "indices" });
        }
    }
    Ok(())
}

/// Makes the normals, and one part of a material: white where vertices have colours.
fn finish(mesh: &mut Mesh, path: &Path, odd: &mut WarningTally) {
    if normals::complete(mesh, CREASE_DEGREES.to_radians()) > 0 {
        odd.note("normals", path, 0, || {
            String::from("normals without a length or not finite: made from the triangles")
        });
    }
    mesh.name = path.display().to_string();
    let indices = 0..mesh.indices.len() as u32;
    let mut part = Part { name: String::new(), indices, material: None, bounds: Aabb::EMPTY };
    if mesh.colors.is_some() {
        let white = [1.0; 3];
        mesh.materials = vec![Material { ambient: white, diffuse: white, ..Material::default() }];
        part.material = Some(0);
    }
    mesh.parts = vec![part];
    mesh.update_bounds();
}
