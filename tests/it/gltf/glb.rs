//! Writes GLB files for tests: JSON that a test completes, and arrays of numbers behind it.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

pub const F32: u32 = 5126;

/// A file in the making.
pub struct Glb {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl Glb {
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [] }],
            "nodes": [], "meshes": [], "accessors": [], "bufferViews": [], "buffers": [{ "byteLength": 0 }],
        });
        Self { json, binary: Vec::new() }
    }

    /// Adds an entry to one of the lists at the root; returns its index.
    pub fn push(&mut self, list: &str, entry: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(entry);
        list.len() - 1
    }

    /// A node that is a root of the scene.
    pub fn root(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(node));
        node
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.binary.len().is_multiple_of(4) {
            self.binary.push(0);
        }
        let at = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.json["buffers"][0]["byteLength"] = json!(self.binary.len());
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": at, "byteLength": bytes.len() }))
    }

    /// An accessor of packed elements.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, F32, ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1], values.len())
    }

    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5123, "SCALAR", values.len())
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec(&self.json).unwrap();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let length = 12 + 8 + text.len() + 8 + binary.len();
        let word = |value: usize| (value as u32).to_le_bytes();
        let header = [*b"glTF", word(2), word(length), word(text.len()), *b"JSON"].concat();
        [header, text, [word(binary.len()), *b"BIN\0"].concat(), binary].concat()
    }

    pub fn write(&self, folder: &Path, name: &str) -> PathBuf {
        let path = folder.join(name);
        std::fs::write(&path, self.bytes()).unwrap();
        path
    }
}

/// A wedge: its corners, its normals, its texture coordinates (v downwards) and its triangles. All numbers are short.
pub const CORNERS: [[f32; 3]; 5] =
    [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0], [0.5, 1.5, 0.25]];
pub const NORMALS: [[f32; 3]; 5] =
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
pub const COORDINATES: [[f32; 2]; 5] = [[0.0, 1.0], [1.5, 1.0], [1.0, 0.25], [0.0, 0.0], [0.5, 0.5]];
pub const TRIANGLES: [u16; 18] = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 3, 2, 0, 2, 1];

/// Attributes of the wedge.
pub fn wedge_attributes(glb: &mut Glb) -> Value {
    let (position, normal, texcoord) = (glb.floats(&CORNERS), glb.floats(&NORMALS), glb.floats(&COORDINATES));
    json!({ "POSITION": position, "NORMAL": normal, "TEXCOORD_0": texcoord })
}

/// A mesh of the wedge, with a material or without; returns its index.
pub fn wedge(glb: &mut Glb, material: Option<usize>) -> usize {
    let attributes = wedge_attributes(glb);
    let indices = glb.indices(&TRIANGLES);
    let mut primitive = json!({ "attributes": attributes, "indices": indices });
    if let Some(material) = material {
        primitive["material"] = json!(material);
    }
    glb.push("meshes", json!({ "name": "wedge", "primitives": [primitive] }))
}

/// The wedge as an OBJ file. `material`: its library and its name.
pub fn wedge_obj(material: Option<(&str, &str)>) -> String {
    let mut text = material.map_or(String::new(), |(library, name)| format!("mtllib {library}\nusemtl {name}\n"));
    for ([x, y, z], ([nx, ny, nz], [u, v])) in CORNERS.iter().zip(NORMALS.iter().zip(&COORDINATES)) {
        text += &format!("v {x} {y} {z}\nvn {nx} {ny} {nz}\nvt {u} {}\n", 1.0 - v);
    }
    for [a, b, c] in TRIANGLES.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|index| index + 1)) {
        text += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n");
    }
    text
}
