//! glTF 2.0: text (.gltf) and binary (.glb) files to meshes that nodes place, cameras and lights [Khronos, "glTF 2.0
//! Specification"].
//!
//! Colours are taken as written: a factor multiplies the texels as they stand in their picture, without colour management.
//! Each kind of thing that a file has and a scene cannot say is one warning, with the number of its occurrences.

mod accessor;
mod deform;
mod extensions;
mod file;
mod lights;
mod material;
mod motion;
mod nodes;
mod primitive;
mod texture;

use std::path::Path;
use std::sync::Arc;

use glam::DMat4;

use super::tally::WarningTally;
use super::{Error, Mesh, ModelWorld, Moment, PlacedMesh, Warning};
use deform::Deform;
use file::File;
use material::Surface;
use motion::Motion;
use nodes::Placed;
use texture::Pictures;

/// Reads a .gltf or .glb file, its buffers and its pictures; `moment`: a time of an animation, absent: as the nodes stand.
///
/// # Errors
///
/// A file that is not whole, that names what it does not have, or that needs an extension that is not read.
pub(super) fn load(path: &Path, moment: Option<&Moment>) -> Result<(ModelWorld, Vec<Warning>), Error> {
    let file = File::load(path)?;
    let mut odd = WarningTally::default();
    extensions::check(&file.root, path, &mut odd)?;
    let motion = moment.map(|moment| file.motion(moment)).transpose()?.unwrap_or_default();
    let placed = file.placed(&motion)?;
    let (cameras, lights) = (file.cameras(&placed, &mut odd)?, file.lights(&placed, &mut odd)?);
    let mut pictures = Pictures::default();
    let surfaces = (0..file.root.materials.len()).map(|at| Surface::read(at, &file, &mut pictures, &mut odd));
    let surfaces = surfaces.collect::<Result<Vec<_>, _>>()?;
    let shared = vec![None; file.root.meshes.len()];
    let mut places = vec![None; file.root.nodes.len()];
    placed.iter().enumerate().for_each(|(place, placed)| places[placed.node] = Some(place));
    let mut meshes = Meshes { file: &file, surfaces, motion, shared, places, odd };
    let mut world = ModelWorld { cameras, lights, seconds: file.seconds(), ..ModelWorld::default() };
    for node in &placed {
        meshes.place(node, &placed, &mut world)?;
    }
    let odd = meshes.odd;
    if world.meshes.is_empty() {
        let odd: Vec<String> = odd.warnings().map(|warning| warning.message).collect();
        let why = if odd.is_empty() { String::new() } else { format!(": {}", odd.join("; ")) };
        return Err(Error::NoTriangles { path: path.to_owned(), why });
    }
    Ok((world, odd.warnings().collect()))
}

/// Reads meshes as nodes need them.
struct Meshes<'a> {
    file: &'a File,
    surfaces: Vec<Surface>,
    motion: Motion,
    /// Meshes that were read, as the file has them.
    shared: Vec<Option<Arc<Mesh>>>,
    /// Place of each node of the file in the list of those of its scene.
    places: Vec<Option<usize>>,
    odd: WarningTally,
}

impl Meshes<'_> {
    /// Adds a node to the world, with the mesh that it has.
    fn place(&mut self, node: &Placed, placed: &[Placed], world: &mut ModelWorld) -> Result<(), Error> {
        let file = self.file;
        let name = file.node_name(node.node);
        let place = world.nodes.len();
        world.nodes.push((name.clone(), place..node.end));
        let Some(index) = file.root.nodes[node.node].mesh else { return Ok(()) };
        let source = file.get(index, &format!("nodes[{}].mesh", node.node), "meshes")?;
        let deform = self.deform(node, source, placed)?;
        let (is_new, mesh) = self.mesh(index.value(), &deform)?;
        if is_new {
            world.own.extend(source.name.clone().map(|name| (name, mesh.clone())));
        }
        if mesh.indices.is_empty() {
            return Ok(());
        }
        // A skin's joints place its vertices in the world, whatever its node says.
        let world_from_model = if deform.joints.is_some() { DMat4::IDENTITY } else { node.world_from_node };
        if world_from_model.determinant() == 0.0 {
            let what = || format!("nodes[{}]: is scaled to nothing: not drawn", node.node);
            self.odd.note("flattened", &file.path, 0, what);
            return Ok(());
        }
        world.meshes.push(PlacedMesh { name, mesh, world_from_model, place });
        Ok(())
    }

    fn deform(&self, node: &Placed, mesh: &gltf::json::Mesh, placed: &[Placed]) -> Result<Deform, Error> {
        let source = &self.file.root.nodes[node.node];
        let written = || source.weights.as_ref().or(mesh.weights.as_ref());
        let moved = self.motion.get(&node.node).and_then(|motion| motion.weights.clone());
        let still = || written().map(|weights| weights.iter().map(|weight| f64::from(*weight)).collect());
        let weights = moved.or_else(still).unwrap_or_default();
        Ok(Deform { weights, joints: self.file.joints(node.node, placed, &self.places)? })
    }

    /// The mesh, and whether it was read for the first time.
    fn mesh(&mut self, index: usize, deform: &Deform) -> Result<(bool, Arc<Mesh>), Error> {
        if !deform.is_none() {
            let mesh = primitive::read(index, self.file, &self.surfaces, deform, &mut self.odd)?;
            return Ok((true, Arc::new(mesh)));
        }
        if let Some(known) = &self.shared[index] {
            return Ok((false, known.clone()));
        }
        let mesh = Arc::new(primitive::read(index, self.file, &self.surfaces, deform, &mut self.odd)?);
        self.shared[index] = Some(mesh.clone());
        Ok((true, mesh))
    }
}
