//! Morph targets and skins of a glTF, on the CPU in f64: shadow volumes need the vertices where they are drawn [Khronos, "glTF
//! 2.0 Specification", 3.7.2.2 and 3.7.3].

use glam::{DMat3, DMat4, DVec3};
use gltf::json::mesh::{MorphTarget, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::super::Error;
use super::accessor::{INDICES, NUMBERS};
use super::file::File;
use super::nodes::Placed;

/// How a node changes the vertices of its mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Deform {
    /// Weights of the mesh's morph targets; missing ones are 0.
    pub weights: Vec<f64>,
    /// World from the mesh as it was bound, by joint. `None`: the mesh has no skin.
    pub joints: Option<Vec<DMat4>>,
}

impl Deform {
    /// Tests whether the mesh is drawn as its file has it.
    pub fn is_none(&self) -> bool {
        self.joints.is_none() && self.weights.iter().all(|weight| *weight == 0.0)
    }
}

/// Vertices that are being moved. Normals and tangents are as long as the positions, or empty; a tangent's last number is its
/// sense.
pub(super) struct Vertices {
    pub positions: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
    pub tangents: Vec<[f64; 4]>,
}

impl File {
    /// The joints of the skin of a node.
    ///
    /// # Errors
    ///
    /// A joint that is no node of the scene; too few inverse bind matrices.
    ///
    /// `places`: the place in `placed` of each node of the file.
    pub fn joints(
        &self,
        node: usize,
        placed: &[Placed],
        places: &[Option<usize>],
    ) -> Result<Option<Vec<DMat4>>, Error> {
        let Some(index) = self.root.nodes[node].skin else { return Ok(None) };
        let skin = self.get(index, &format!("nodes[{node}].skin"), "skins")?;
        let place = format!("skins[{}]", index.value());
        let binds = match skin.inverse_bind_matrices {
            None => vec![DMat4::IDENTITY.to_cols_array(); skin.joints.len()],
            Some(accessor) => self.vectors::<16>(accessor, &format!("{place}.inverseBindMatrices"), NUMBERS)?,
        };
        if binds.len() < skin.joints.len() {
            let what = format!("has {} inverse bind matrices for {} joints", binds.len(), skin.joints.len());
            return Err(self.error(place, what));
        }
        let joint = |(at, (joint, bind)): (usize, (&Index<gltf::json::Node>, &[f64; 16]))| {
            let found = places.get(joint.value()).copied().flatten().map(|place| &placed[place]);
            let what = || format!("is node {}, which the scene does not have", joint.value());
            let found = found.ok_or_else(|| self.error(format!("{place}.joints[{at}]"), what()))?;
            Ok(found.world_from_node * DMat4::from_cols_array(bind))
        };
        skin.joints.iter().zip(&binds).enumerate().map(joint).collect::<Result<_, _>>().map(Some)
    }

    /// Moves the vertices of a primitive: by its morph targets, then by its skin, into world space.
    ///
    /// # Errors
    ///
    /// Accessors of other lengths than the primitive's; joints that the skin does not have.
    pub fn deform(
        &self,
        vertices: &mut Vertices,
        primitive: &Primitive,
        place: &str,
        deform: &Deform,
    ) -> Result<(), Error> {
        for (at, (target, weight)) in primitive.targets.iter().flatten().zip(&deform.weights).enumerate() {
            if *weight != 0.0 {
                self.morph(vertices, target, *weight, &format!("{place}.targets[{at}]"))?;
            }
        }
        match &deform.joints {
            None => Ok(()),
            Some(joints) => self.skin(vertices, primitive, place, joints),
        }
    }

    fn morph(&self, vertices: &mut Vertices, target: &MorphTarget, weight: f64, place: &str) -> Result<(), Error> {
        let count = vertices.positions.len();
        let read = |index: Option<Index<Accessor>>, name: &str| {
            let place = format!("{place}.{name}");
            let read = index.map(|index| self.matching::<3>(index, &place, count)).transpose()?;
            Ok::<_, Error>(read.unwrap_or_default())
        };
        let add = |to: &mut [f64], by: [f64; 3]| to.iter_mut().zip(by).for_each(|(to, by)| *to += weight * by);
        for (position, by) in vertices.positions.iter_mut().zip(read(target.positions, "POSITION")?) {
            add(position, by);
        }
        for (normal, by) in vertices.normals.iter_mut().zip(read(target.normals, "NORMAL")?) {
            add(normal, by);
        }
        for (tangent, by) in vertices.tangents.iter_mut().zip(read(target.tangents, "TANGENT")?) {
            add(&mut tangent[..3], by);
        }
        Ok(())
    }

    /// The elements of an accessor, one for each vertex.
    fn matching<const N: usize>(
        &self,
        index: Index<Accessor>,
        place: &str,
        count: usize,
    ) -> Result<Vec<[f64; N]>, Error> {
        let values = self.vectors::<N>(index, place, NUMBERS)?;
        if values.len() == count {
            return Ok(values);
        }
        Err(self.error(place, format!("has {} elements for {count} vertices", values.len())))
    }

    fn skin(&self, vertices: &mut Vertices, primitive: &Primitive, place: &str, joints: &[DMat4]) -> Result<(), Error> {
        let count = vertices.positions.len();
        let mut blends = vec![DMat4::ZERO; count];
        let mut sums = vec![0.0; count];
        for set in 0.. {
            let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
            let (of, by) = (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set)));
            let (Some(of), Some(by)) = (of, by) else { break };
            let at = format!("{place}.attributes.JOINTS_{set}");
            let of = self.vectors::<4>(of, &at, INDICES)?;
            let by = self.matching::<4>(by, &format!("{place}.attributes.WEIGHTS_{set}"), count)?;
            if of.len() != count {
                return Err(self.error(at, format!("has {} elements for {count} vertices", of.len())));
            }
            for (vertex, (of, by)) in of.iter().zip(&by).enumerate() {
                for (joint, weight) in of.iter().zip(by).filter(|(_, weight)| **weight != 0.0) {
                    let Some(world_from_bound) = joints.get(*joint as usize) else {
                        let what = format!("names joint {joint} of {}, at element {vertex}", joints.len());
                        return Err(self.error(at, what));
                    };
                    blends[vertex] += *world_from_bound * *weight;
                    sums[vertex] += weight;
                }
            }
        }
        if let Some(vertex) = sums.iter().position(|sum| *sum <= 0.0) {
            return Err(self.error(place, format!("has a skin, and vertex {vertex} has no weights of joints")));
        }
        for (vertex, (blend, sum)) in blends.iter().zip(&sums).enumerate() {
            vertices.place(vertex, &(*blend * sum.recip()));
        }
        Ok(())
    }
}

impl Vertices {
    fn place(&mut self, vertex: usize, world_from_bound: &DMat4) {
        let position = &mut self.positions[vertex];
        *position = world_from_bound.transform_point3(DVec3::from_array(*position)).to_array();
        if let Some(normal) = self.normals.get_mut(vertex) {
            // The inverse, transposed, but for its length: of cofactors, which a flattened joint has, too.
            let linear = DMat3::from_mat4(*world_from_bound);
            let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
            let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * linear.determinant().signum();
            *normal = (cofactors * DVec3::from_array(*normal)).to_array();
        }
        if let Some(tangent) = self.tangents.get_mut(vertex) {
            let along = world_from_bound.transform_vector3(DVec3::new(tangent[0], tangent[1], tangent[2]));
            let sense = tangent[3] * DMat3::from_mat4(*world_from_bound).determinant().signum();
            *tangent = along.extend(sense).to_array();
        }
    }
}
