//! A mesh as files of several formats, for the ladders of loading. All hold the same triangles.

use std::path::Path;

use glam::Vec3;
use glumbra::geometry::Mesh;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::Result;

/// Format of glumbra's model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    #[default]
    Obj,
    Glb,
    Ply,
    Stl,
    /// A GLB with a node for each place of the model, not one.
    Nodes,
}

impl Format {
    /// The file's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "model.obj",
            Self::Glb => "model.glb",
            Self::Ply => "model.ply",
            Self::Stl => "model.stl",
            Self::Nodes => "nodes.glb",
        }
    }

    /// Writes the file; an OBJ file is there already.
    pub fn write(self, mesh: &Mesh, places: &[Vec3], folder: &Path) -> Result<()> {
        let bytes = match self {
            Self::Obj => return Ok(()),
            Self::Glb => glb(mesh, &[Vec3::ZERO])?,
            Self::Nodes => glb(mesh, places)?,
            Self::Ply => ply(mesh),
            Self::Stl => stl(mesh),
        };
        Ok(std::fs::write(folder.join(self.name()), bytes)?)
    }
}

fn glb(mesh: &Mesh, places: &[Vec3]) -> Result<Vec<u8>> {
    let parts: [&[u8]; 3] = [
        bytemuck::cast_slice(&mesh.positions),
        bytemuck::cast_slice(&mesh.normals),
        bytemuck::cast_slice(&mesh.indices),
    ];
    let (count, total) = (mesh.positions.len(), parts.iter().map(|part| part.len()).sum::<usize>());
    let nodes: Vec<Value> = places.iter().map(|at| json!({ "mesh": 0, "translation": at.to_array() })).collect();
    let view = |at: usize| {
        let offset: usize = parts[..at].iter().map(|part| part.len()).sum();
        json!({ "buffer": 0, "byteOffset": offset, "byteLength": parts[at].len() })
    };
    let vectors = |view: usize| json!({ "bufferView": view, "componentType": 5126, "type": "VEC3", "count": count });
    let indices = json!({ "bufferView": 2, "componentType": 5125, "type": "SCALAR", "count": mesh.indices.len() });
    let primitive = json!({ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2 });
    let root = json!({
        "asset": { "version": "2.0" }, "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }], "nodes": nodes,
        "meshes": [{ "primitives": [primitive] }],
        "accessors": [vectors(0), vectors(1), indices],
        "bufferViews": [view(0), view(1), view(2)],
        "buffers": [{ "byteLength": total }],
    });
    let mut text = serde_json::to_vec(&root)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |value: usize| (value as u32).to_le_bytes();
    let header = [*b"glTF", word(2), word(28 + text.len() + total), word(text.len()), *b"JSON"].concat();
    Ok([&header, &text, &[word(total), *b"BIN\0"].concat()[..], parts[0], parts[1], parts[2]].concat())
}

fn ply(mesh: &Mesh) -> Vec<u8> {
    let triangles = mesh.indices.as_chunks::<3>().0;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        triangles.len()
    )
    .into_bytes();
    bytes.extend_from_slice(bytemuck::cast_slice(&mesh.positions));
    for triangle in triangles {
        bytes.push(3);
        bytes.extend_from_slice(bytemuck::cast_slice(triangle));
    }
    bytes
}

fn stl(mesh: &Mesh) -> Vec<u8> {
    let triangles = mesh.indices.as_chunks::<3>().0;
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for corner in triangle {
            bytes.extend_from_slice(bytemuck::cast_slice(&mesh.positions[*corner as usize]));
        }
        bytes.extend([0; 2]);
    }
    bytes
}
