//! glTF 2.0: text (.gltf) and binary (.glb) files to meshes that nodes place, cameras and lights [Khronos, "glTF 2.0
//! Specification"].
//!
//! Colours are taken as written: a factor multiplies the texels as they stand in their picture, without colour management.
//! Each kind of thing that a file has and a scene cannot say is one warning, with the number of its occurrences.

mod accessor;
mod extensions;
mod file;
mod lights;
mod material;
mod nodes;
mod primitive;
mod texture;

use std::path::Path;
use std::sync::Arc;

use super::tally::WarningTally;
use super::{Error, Mesh, PlacedMesh, Warning, World};
use file::File;
use material::Surface;
use texture::Pictures;

/// Reads a .gltf or .glb file, its buffers and its pictures.
///
/// # Errors
///
/// A file that is not whole, that names what it does not have, or that needs an extension that is not read.
pub(super) fn load(path: &Path) -> Result<(World, Vec<Warning>), Error> {
    let file = File::load(path)?;
    let mut odd = WarningTally::default();
    extensions::check(&file.root, path, &mut odd)?;
    let placed = file.placed()?;
    let (cameras, lights) = (file.cameras(&placed, &mut odd)?, file.lights(&placed, &mut odd)?);
    let mut pictures = Pictures::default();
    let surfaces = (0..file.root.materials.len()).map(|at| Surface::read(at, &file, &mut pictures, &mut odd));
    let surfaces = surfaces.collect::<Result<Vec<_>, _>>()?;
    let mut world = World { cameras, lights, ..World::default() };
    let mut read: Vec<Option<Arc<Mesh>>> = vec![None; file.root.meshes.len()];
    for node in placed {
        let name = file.node_name(node.node);
        world.nodes.push((name.clone(), node.node));
        let Some(index) = file.root.nodes[node.node].mesh else { continue };
        let source = file.get(index, &format!("nodes[{}].mesh", node.node), "meshes")?;
        let mesh = match &read[index.value()] {
            Some(mesh) => mesh.clone(),
            None => {
                let mesh = Arc::new(primitive::read(index.value(), &file, &surfaces, &mut odd)?);
                world.own.extend(source.name.clone().map(|name| (name, mesh.clone())));
                read[index.value()] = Some(mesh.clone());
                mesh
            }
        };
        if mesh.indices.is_empty() {
            continue;
        }
        if node.world_from_node.determinant() == 0.0 {
            let what = || format!("nodes[{}]: is scaled to nothing: not drawn", node.node);
            odd.note("flattened", path, 0, what);
            continue;
        }
        world.meshes.push(PlacedMesh { name, mesh, world_from_model: node.world_from_node, line: node.line });
    }
    if world.meshes.is_empty() {
        let odd: Vec<String> = odd.warnings().map(|warning| warning.message).collect();
        let why = if odd.is_empty() { String::new() } else { format!(": {}", odd.join("; ")) };
        return Err(Error::NoTriangles { path: path.to_owned(), why });
    }
    Ok((world, odd.warnings().collect()))
}
