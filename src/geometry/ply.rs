//! PLY files, text and binary: vertices with normals, texture coordinates and colours, and polygons [Turk, "The PLY Polygon
//! File Format"].

use std::path::Path;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

use super::obj::polygon;
use super::tally::WarningTally;
use super::text::CountedBytes;
use super::{CREASE_DEGREES, Error, Material, Mesh, Part, Warning, far, normals, text};
use crate::math::Aabb;
use crate::process;

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

/// A line of `vertex`.
#[derive(Default)]
struct Vertex {
    numbers: [f64; NAMES.len()],
    /// The numbers that the line has.
    has: [bool; NAMES.len()],
}

impl Vertex {
    fn take<const N: usize>(&self, places: [usize; N]) -> Option<[f64; N]> {
        places.iter().all(|place| self.has[*place]).then(|| places.map(|place| self.numbers[place]))
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let Some(place) = NAMES.iter().position(|names| names.contains(&name)) else {
            return PropertyAccessResult::Ignored;
        };
        let Some(number) = number(&value) else { return PropertyAccessResult::UnsupportedType };
        let scale = if COLOR.contains(&place) { full(&value) } else { 1.0 };
        (self.numbers[place], self.has[place]) = (number / scale, true);
        PropertyAccessResult::Set
    }
}

/// A line of `face`: its vertices, counted from 0.
#[derive(Default)]
struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        let Some(corners) = list(&value) else { return PropertyAccessResult::UnsupportedType };
        self.0 = corners;
        PropertyAccessResult::Set
    }
}

/// A line of another element.
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
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
/// [`CREASE_DEGREES`]. Positions far from the file's origin are relative to [`Mesh::origin`]. Colours of vertices multiply a white material; their alpha is left out.
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
    let reading = process::reading(text::name(path), bytes.len() as u64);
    let mut reader = Reader::new(CountedBytes { inner: &bytes[..], reading: &reading });
    let header = Parser::<Other>::new().read_header(&mut reader).map_err(|error| broken(&error))?;
    let mut odd = WarningTally::default();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                let read = Parser::<Vertex>::new().read_payload_for_element(&mut reader, element, &header);
                read.map(|read| vertices = read)
            }
            "face" => {
                let read = Parser::<Face>::new().read_payload_for_element(&mut reader, element, &header);
                read.map(|read| faces = read)
            }
            _ => {
                odd.note(name, path, 0, || format!("element {name}: is not drawn"));
                Parser::<Other>::new().read_payload_for_element(&mut reader, element, &header).map(drop)
            }
        }
        .map_err(|error| broken(&error))?;
    }
    let mut mesh = mesh_of(&vertices, path)?;
    drop(vertices);
    cut(&mut mesh, &faces, path, &mut odd)?;
    if mesh.indices.is_empty() {
        return Err(Error::NoFaces { path: path.to_owned() });
    }
    finish(&mut mesh, path, &mut odd);
    Ok((mesh, odd.warnings().collect()))
}

/// The vertices, whose normals may be missing.
fn mesh_of(rows: &[Vertex], path: &Path) -> Result<Mesh, Error> {
    let wrong = |at: usize, what: &str| {
        let place = format!("vertex {at}");
        Error::Inside { path: path.to_owned(), place, what: what.to_owned() }
    };
    let mut mesh = Mesh::default();
    let has = |places: &[usize]| rows.first().is_some_and(|first| places.iter().all(|place| first.has[*place]));
    let (mut positions, mut colors, mut texcoords) = (Vec::new(), Vec::new(), Vec::new());
    for (at, row) in rows.iter().enumerate() {
        let position = row.take(POSITION).ok_or_else(|| wrong(at, "has no x, y and z"))?;
        if !position.iter().all(|number| (*number as f32).is_finite()) {
            return Err(wrong(at, "has a position that is not finite"));
        }
        positions.push(position);
        mesh.normals.push(row.take(NORMAL).map_or([0.0; 3], |normal| normal.map(|number| number as f32)));
        let color = row.take(COLOR).unwrap_or([1.0; 3]);
        // Not a number is black.
        colors.push(color.map(|channel| if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1.0) as f32 }));
        texcoords.push(row.take(TEXCOORD).unwrap_or_default().map(|number| number as f32));
    }
    (mesh.positions, mesh.origin) = far::relative(&positions);
    mesh.colors = has(&COLOR).then_some(colors);
    mesh.texcoords = has(&TEXCOORD).then_some(texcoords);
    if mesh.texcoords.iter().flatten().flatten().any(|number| !number.is_finite()) {
        return Err(wrong(0, "or another has texture coordinates that are not finite"));
    }
    Ok(mesh)
}

/// The polygons, cut into triangles.
fn cut(mesh: &mut Mesh, rows: &[Face], path: &Path, odd: &mut WarningTally) -> Result<(), Error> {
    let count = mesh.positions.len();
    for (at, row) in rows.iter().enumerate() {
        let known = row.0.iter().map(|corner| u32::try_from(*corner).ok().filter(|index| (*index as usize) < count));
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
