//! The device in parts, for another reader of pass lists: it draws on its own, into and from the same images.

use glow::HasContext;

use super::image::ImageName;
use super::state::{apply, set_mirrored};
use super::{Device, Error, mesh, mesh_key};
use crate::pass::{Attribute, Draw, DrawPass, DrawState, ImageId, Pass, PassList, Work};

/// GL's buffers of a mesh: attributes in the requested order, then the indices.
pub(crate) struct MeshBuffers {
    pub attributes: Vec<glow::Buffer>,
    pub indices: glow::Buffer,
}

impl Device {
    /// Makes the list's images, and forgets what their passes hold.
    pub(crate) fn prepare_images(&mut self, list: &PassList) -> Result<(), Error> {
        self.forget();
        self.make_images(list)
    }

    /// Binds and clears a pass's target under its state.
    pub(crate) fn begin(&mut self, list: &PassList, label: &str, pass: &DrawPass) -> Result<(), Error> {
        self.state = None;
        self.begin_pass(list, label, pass)
    }

    /// Sets all of `state`, whatever was set beside it.
    pub(crate) fn set_state(&mut self, state: &DrawState, mirrored: bool) {
        self.state = None;
        apply(&self.gl, state, &mut self.state);
        set_mirrored(&self.gl, mirrored, &mut self.state);
    }

    /// Does the work of a pass that draws nothing.
    pub(crate) fn copy(&mut self, list: &PassList, pass: &Pass) -> Result<(), Error> {
        match &pass.work {
            Work::CopyDepth { .. } => self.copy_depth(list, pass),
            Work::Draw(_) => Ok(()),
        }
    }

    /// The texture of an image that can be sampled.
    pub(crate) fn texture(&self, image: ImageId) -> Option<glow::Texture> {
        match self.gpu_image(image) {
            ImageName::Texture(texture) => Some(texture),
            ImageName::Cube(_) | ImageName::Line(_) | ImageName::Renderbuffer(_) => None,
        }
    }

    /// The cube map of an image.
    pub(crate) fn cube_map(&self, image: ImageId) -> Option<glow::Texture> {
        match self.gpu_image(image) {
            ImageName::Cube(texture) => Some(texture),
            ImageName::Texture(_) | ImageName::Line(_) | ImageName::Renderbuffer(_) => None,
        }
    }

    /// The buffers that a draw reads.
    pub(crate) fn buffers(&mut self, pass: &str, draw: &Draw, attributes: &[Attribute]) -> Result<MeshBuffers, Error> {
        let gl = &self.gl;
        let gpu = self.meshes.entry(mesh_key(&draw.mesh.0)).or_insert_with(|| mesh::GpuMesh::new(gl, &draw.mesh.0));
        let mut names = Vec::new();
        for attribute in attributes {
            names.push(gpu.attribute(*attribute)?.ok_or_else(|| Error::MissingAttribute {
                pass: pass.to_owned(),
                program: String::from("fixed function"),
                name: attribute.name(),
                mesh: draw.mesh.name.clone(),
            })?);
        }
        let indices = gpu.index_buffer(draw.order)?;
        unsafe { self.gl.bind_vertex_array(None) };
        Ok(MeshBuffers { attributes: names, indices })
    }
}
