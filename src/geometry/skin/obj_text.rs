//! A mesh with other texture coordinates as the text of an OBJ file.

use std::fmt::Write as _;

use super::Skin;
use crate::geometry::{Mesh, topology};

/// The text of an OBJ file with the mesh's parts as objects, its triangles, positions and normals, and the texture
/// coordinates of `skin`, whose triangles are the mesh's. Numbers are the shortest that are read as the same values.
///
/// `material`: name of a material library's file and of the material in it that all parts use; the mesh's own materials are
/// left out.
pub fn write_obj(mesh: &Mesh, skin: &Skin, material: Option<(&str, &str)>) -> String {
    // Writing to a String cannot fail.
    let mut text = String::new();
    if let Some((library, _)) = material {
        let _ = writeln!(text, "mtllib {library}");
    }
    let (places, count) = topology::weld(&mesh.positions);
    let mut place_names = vec![0_usize; count];
    let mut places_written = 0;
    for (vertex, place) in places.iter().enumerate() {
        let name = &mut place_names[*place as usize];
        if *name == 0 {
            places_written += 1;
            *name = places_written;
            let _ = writeln!(text, "v {}", numbers(&position(mesh, vertex)));
        }
    }
    let [width, height] = skin.size.map(f64::from);
    let mut texcoords = Table::default();
    let corner = |texel: glam::DVec2| [(texel.x / width) as f32, (1.0 - texel.y / height) as f32];
    let of_texcoords: Vec<[usize; 3]> = skin
        .triangles
        .iter()
        .map(|triangle| triangle.texels.map(|texel| texcoords.number(&mut text, "vt", &corner(texel))))
        .collect();
    let mut normals = Table::default();
    let of_normals: Vec<usize> = mesh.normals.iter().map(|normal| normals.number(&mut text, "vn", normal)).collect();
    for part in &mesh.parts {
        if !part.name.is_empty() {
            let _ = writeln!(text, "o {}", part.name);
        }
        if let Some((_, name)) = material {
            let _ = writeln!(text, "usemtl {name}");
        }
        for triangle in part.indices.start / 3..part.indices.end / 3 {
            text.push('f');
            for (corner, vt) in of_texcoords[triangle as usize].into_iter().enumerate() {
                let vertex = mesh.indices[3 * triangle as usize + corner] as usize;
                let place = place_names[places[vertex] as usize];
                let vn = of_normals[vertex];
                let _ = write!(text, " {place}/{vt}/{vn}");
            }
            text.push('\n');
        }
    }
    text
}

/// A vertex in the file's space; without an origin, its f32 values in their shortest digits.
fn position(mesh: &Mesh, vertex: usize) -> [String; 3] {
    let position = mesh.positions[vertex];
    let origin = mesh.origin.to_array();
    [0, 1, 2].map(|axis| match origin == [0.0; 3] {
        true => position[axis].to_string(),
        false => (f64::from(position[axis]) + origin[axis]).to_string(),
    })
}

fn numbers(values: &[String]) -> String {
    values.join(" ")
}

/// Rows that have been written, each once.
#[derive(Default)]
struct Table {
    known: std::collections::HashMap<Vec<u32>, usize>,
}

impl Table {
    /// Number of a row, from 1; one that is new is written.
    fn number(&mut self, text: &mut String, keyword: &str, row: &[f32]) -> usize {
        let next = self.known.len() + 1;
        let bits = row.iter().map(|value| value.to_bits()).collect();
        *self.known.entry(bits).or_insert_with(|| {
            let values: Vec<String> = row.iter().map(f32::to_string).collect();
            let _ = writeln!(text, "{keyword} {}", numbers(&values));
            next
        })
    }
}
