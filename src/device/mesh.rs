//! Vertex and index buffers of a mesh: each attribute and index order is uploaded when a program first reads it.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext;

use super::{Error, MeshUse};
use crate::geometry::Mesh;
use crate::pass::{Attribute, IndexOrder};

/// GL's copy of a mesh, deleted on drop.
pub struct GpuMesh {
    gl: Rc<glow::Context>,
    mesh: Arc<Mesh>,
    attributes: HashMap<Attribute, glow::Buffer>,
    indices: HashMap<IndexOrder, glow::Buffer>,
    arrays: HashMap<MeshUse, glow::VertexArray>,
}

impl Drop for GpuMesh {
    fn drop(&mut self) {
        unsafe {
            self.arrays.values().for_each(|array| self.gl.delete_vertex_array(*array));
            self.attributes.values().chain(self.indices.values()).for_each(|buffer| self.gl.delete_buffer(*buffer));
        }
    }
}

impl GpuMesh {
    pub fn new(gl: &Rc<glow::Context>, mesh: &Arc<Mesh>) -> Self {
        Self {
            gl: gl.clone(),
            mesh: mesh.clone(),
            attributes: HashMap::new(),
            indices: HashMap::new(),
            arrays: HashMap::new(),
        }
    }

    /// Tests whether nothing else uses the mesh any more.
    pub fn is_orphan(&self) -> bool {
        Arc::strong_count(&self.mesh) == 1
    }

    /// The vertex array for a use, if [`GpuMesh::prepare`] made it.
    pub fn array(&self, wanted: &MeshUse) -> Option<glow::VertexArray> {
        self.arrays.get(wanted).copied()
    }

    /// Uploads what `wanted` reads and makes its vertex array. `Err` with an attribute that the mesh does not have.
    pub fn prepare(&mut self, wanted: &MeshUse) -> Result<Result<(), Attribute>, Error> {
        if self.arrays.contains_key(wanted) {
            return Ok(Ok(()));
        }
        let (attributes, order) = wanted;
        let mut buffers = Vec::new();
        for attribute in attributes {
            match self.attribute(*attribute)? {
                Some(buffer) => buffers.push((*attribute, buffer)),
                None => return Ok(Err(*attribute)),
            }
        }
        let indices = self.index_buffer(*order)?;
        unsafe {
            let array = self.gl.create_vertex_array().map_err(Error::Create)?;
            self.gl.bind_vertex_array(Some(array));
            for (attribute, buffer) in buffers {
                self.gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
                self.gl.enable_vertex_attrib_array(attribute as u32);
                let components = components(attribute, &self.mesh);
                self.gl.vertex_attrib_pointer_f32(attribute as u32, components, glow::FLOAT, false, 4 * components, 0);
            }
            self.gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
            self.gl.bind_vertex_array(None);
            self.arrays.insert(wanted.clone(), array);
        }
        Ok(Ok(()))
    }

    pub fn attribute(&mut self, attribute: Attribute) -> Result<Option<glow::Buffer>, Error> {
        if let Some(buffer) = self.attributes.get(&attribute) {
            return Ok(Some(*buffer));
        }
        let bytes: &[u8] = match attribute {
            Attribute::Position if self.mesh.positions.is_empty() => bytemuck::cast_slice(&self.mesh.homogeneous),
            Attribute::Position => bytemuck::cast_slice(&self.mesh.positions),
            Attribute::Normal => bytemuck::cast_slice(&self.mesh.normals),
            Attribute::Texcoord => match &self.mesh.texcoords {
                Some(texcoords) => bytemuck::cast_slice(texcoords),
                None => return Ok(None),
            },
            Attribute::Color => match &self.mesh.colors {
                Some(colors) => bytemuck::cast_slice(colors),
                None => return Ok(None),
            },
            Attribute::Tangent | Attribute::Bitangent => match &self.mesh.tangents {
                Some(directions) if attribute == Attribute::Tangent => bytemuck::cast_slice(&directions.tangents),
                Some(directions) => bytemuck::cast_slice(&directions.bitangents),
                None => return Ok(None),
            },
        };
        let buffer = upload(&self.gl, glow::ARRAY_BUFFER, bytes)?;
        self.attributes.insert(attribute, buffer);
        Ok(Some(buffer))
    }

    pub fn index_buffer(&mut self, order: IndexOrder) -> Result<glow::Buffer, Error> {
        if let Some(buffer) = self.indices.get(&order) {
            return Ok(*buffer);
        }
        let buffer = match order {
            IndexOrder::File => upload(&self.gl, glow::ELEMENT_ARRAY_BUFFER, bytemuck::cast_slice(&self.mesh.indices))?,
            IndexOrder::VertexCache => {
                let ordered = self.mesh.cache_ordered();
                upload(&self.gl, glow::ELEMENT_ARRAY_BUFFER, bytemuck::cast_slice(&ordered))?
            }
        };
        self.indices.insert(order, buffer);
        Ok(buffer)
    }
}

/// Numbers a vertex; GL completes a position of three with w = 1 [GL 4.6, 10.3.1].
fn components(attribute: Attribute, mesh: &Mesh) -> i32 {
    match attribute {
        Attribute::Position if mesh.positions.is_empty() => 4,
        _ => attribute.components(),
    }
}

fn upload(gl: &glow::Context, target: u32, bytes: &[u8]) -> Result<glow::Buffer, Error> {
    unsafe {
        let buffer = gl.create_buffer().map_err(Error::Create)?;
        // The element array binding belongs to the bound vertex array: none is bound here.
        gl.bind_vertex_array(None);
        gl.bind_buffer(target, Some(buffer));
        gl.buffer_data_u8_slice(target, bytes, glow::STATIC_DRAW);
        Ok(buffer)
    }
}
