//! Nodes of a glTF's scene, placed in the world [Khronos, "glTF 2.0 Specification", 3.5].

use glam::{DMat4, DQuat, DVec3};
use gltf::json::{Index, Node};

use super::super::Error;
use super::file::File;
use super::motion::{Motion, NodeMotion};

/// A node of the scene.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// The node's number in the file.
    pub node: usize,
    pub world_from_node: DMat4,
    /// Number of nodes above it.
    depth: usize,
    /// Place in the list of the first node behind this one that is not below it.
    pub end: usize,
}

impl File {
    /// The nodes of the file's scene, parents before their children: of the scene that it names, else of the first, else all.
    ///
    /// # Errors
    ///
    /// A node that the file does not have, that two nodes have as their child, or that lies below itself.
    pub fn placed(&self, motion: &Motion) -> Result<Vec<Placed>, Error> {
        let mut is_seen = vec![false; self.root.nodes.len()];
        let mut open: Vec<Placed> = Vec::new();
        for (root, place) in self.roots()? {
            self.get(root, &place, "nodes")?;
            open.push(Placed { node: root.value(), world_from_node: DMat4::IDENTITY, depth: 0, end: 0 });
        }
        open.reverse();
        let mut done = Vec::new();
        while let Some(mut next) = open.pop() {
            let place = format!("nodes[{}]", next.node);
            if std::mem::replace(&mut is_seen[next.node], true) {
                return Err(self.error(place, "lies below two nodes, or below itself"));
            }
            let node = &self.root.nodes[next.node];
            next.world_from_node *= self.local(node, motion.get(&next.node), &place)?;
            for child in node.children.iter().flatten().rev() {
                self.get(*child, &format!("{place}.children"), "nodes")?;
                open.push(Placed { node: child.value(), depth: next.depth + 1, ..next.clone() });
            }
            done.push(next);
        }
        set_ends(&mut done);
        Ok(done)
    }

    fn roots(&self) -> Result<Vec<(Index<Node>, String)>, Error> {
        let scene = match self.root.scene {
            Some(scene) => Some((scene.value(), self.get(scene, "scene", "scenes")?)),
            None => self.root.scenes.first().map(|scene| (0, scene)),
        };
        if let Some((number, scene)) = scene {
            return Ok(scene.nodes.iter().map(|root| (*root, format!("scenes[{number}].nodes"))).collect());
        }
        let mut is_child = vec![false; self.root.nodes.len()];
        for child in self.root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten() {
            if let Some(is_child) = is_child.get_mut(child.value()) {
                *is_child = true;
            }
        }
        let roots = is_child.iter().enumerate().filter(|(_, is_child)| !**is_child);
        Ok(roots.map(|(node, _)| (Index::new(node as u32), String::from("nodes"))).collect())
    }

    /// The node's transform, as the file or a motion has it: a matrix, or scaled, then turned, then moved.
    fn local(&self, node: &Node, motion: Option<&NodeMotion>, place: &str) -> Result<DMat4, Error> {
        let still = NodeMotion::default();
        let motion = motion.unwrap_or(&still);
        let is_moved = motion.translation.is_some() || motion.rotation.is_some() || motion.scale.is_some();
        let vector = |moved: Option<[f64; 3]>, written: Option<[f32; 3]>, absent| {
            moved.or(written.map(|v| v.map(f64::from))).map_or(absent, DVec3::from_array)
        };
        let local = match node.matrix {
            Some(_) if is_moved => return Err(self.error(place, "has a matrix, and an animation that moves it")),
            Some(matrix) => DMat4::from_cols_array(&matrix.map(f64::from)),
            None => {
                let turn = motion.rotation.or(node.rotation.map(|turn| turn.0.map(f64::from)));
                let turn = turn.map_or(DQuat::IDENTITY, DQuat::from_array);
                let turn = match turn.length() {
                    length if length > 0.0 && length.is_finite() => turn.normalize(),
                    _ => return Err(self.error(place, "has a rotation without a length")),
                };
                let scale = vector(motion.scale, node.scale, DVec3::ONE);
                let shift = vector(motion.translation, node.translation, DVec3::ZERO);
                DMat4::from_scale_rotation_translation(scale, turn, shift)
            }
        };
        if !local.is_finite() || local.row(3) != glam::DVec4::W {
            return Err(self.error(place, "has a matrix that is not affine, or numbers that are not finite"));
        }
        Ok(local)
    }

    /// A node's name, or its number where it has none.
    pub fn node_name(&self, node: usize) -> String {
        let name = self.root.nodes.get(node).and_then(|node| node.name.clone());
        name.filter(|name| !name.is_empty()).unwrap_or_else(|| format!("node {node}"))
    }
}

/// Sets where each node's descendants end, in one walk over the list.
fn set_ends(placed: &mut [Placed]) {
    let mut open: Vec<usize> = Vec::new();
    for at in 0..=placed.len() {
        let depth = placed.get(at).map_or(0, |next| next.depth);
        while let Some(last) = open.pop_if(|last| placed[*last].depth >= depth) {
            placed[last].end = at;
        }
        open.push(at);
    }
}
