//! Stands in for `geometry` until its loaders are merged.
use std::path::{Path, PathBuf};

use crate::geometry::{Mesh, Texture};

#[derive(Debug, thiserror::Error)]
#[error("{path}: cannot be read: {reason}", path = .path.display())]
pub struct Error {
    path: PathBuf,
    reason: std::io::Error,
}

pub const PRIMITIVES: [&str; 5] = ["quad", "box", "sphere", "torus", "teapot"];

pub fn primitive(name: &str) -> Option<Mesh> {
    let h = if name == "quad" { 0.0 } else { 1.0 };
    PRIMITIVES.contains(&name).then(|| Mesh {
        name: name.into(),
        indices: vec![0, 1, 2],
        bounds: crate::math::Aabb { min: glam::dvec3(-1.0, -h, -1.0), max: glam::dvec3(1.0, h, 1.0) },
        ..Mesh::default()
    })
}

pub fn load_obj(path: &Path) -> Result<(Mesh, Vec<String>), Error> {
    let text = std::fs::read_to_string(path).map_err(|reason| Error { path: path.into(), reason })?;
    let mut points = Vec::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("v ")) {
        let p: Vec<f64> = line.split_whitespace().filter_map(|x| x.parse().ok()).collect();
        points.push(glam::dvec3(p[0], p[1], p[2]));
    }
    let bounds = crate::math::Aabb::from_points(points);
    Ok((Mesh { name: path.display().to_string(), indices: vec![0, 1, 2], bounds, ..Mesh::default() }, Vec::new()))
}

pub fn load_texture(path: &Path) -> Result<Texture, Error> {
    let bytes = std::fs::read(path).map_err(|reason| Error { path: path.into(), reason })?;
    Ok(Texture {
        name: path.display().to_string(),
        width: 1,
        height: 1,
        rgba: vec![bytes.len() as u8; 4],
        has_alpha: false,
    })
}
