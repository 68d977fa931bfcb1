//! Layers: images of floats in which light is summed before it joins the picture, whose 8 bits would round each share.

use std::sync::Arc;

use glam::DVec4;

use super::passes::{Buffers, Passes};
use crate::geometry::primitive;
use crate::pass::{
    Attribute, Batch, Blend, Clear, Draw, DrawPass, DrawState, Filter, FixedFunctionDesc, Format, ImageDesc, ImageId,
    IndexOrder, Input, MeshRef, Primitive, Program, Redraw, Sampler, Storage, Target, Wrap, glsl,
};

impl Passes<'_> {
    /// Adds a layer's image, of the picture's size.
    pub fn layer(&mut self, label: &str) -> ImageId {
        self.list.image(ImageDesc {
            label: label.to_owned(),
            size: self.scene.image.size,
            format: Format::Rgba32F,
            storage: Storage::Texture,
        })
    }

    /// Blends a layer over the picture. `meaning`: what the layer holds.
    pub fn put_over(&mut self, label: &str, layer: ImageId, picture: Buffers, blend: Blend, meaning: &'static str) {
        let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
        let program = Program {
            label: String::from("layer"),
            defines: Vec::new(),
            vertex: vec![glsl!("common/position.vert"), glsl!("common/depth.vert")],
            fragment: vec![glsl!("common/layer.frag")],
            attributes: vec![Attribute::Position],
        };
        let batch = Batch {
            program,
            meaning: FixedFunctionDesc::Shader(meaning),
            uniforms: Vec::new(),
            inputs: vec![Input { name: "layer".into(), image: layer, sampler }],
            cull: None,
            scissor: None,
            clip_planes: 0,
            draws: vec![whole_picture()],
        };
        let pass = DrawPass {
            target: Target { color: Some(picture.color), depth: None, level: 0, face: None },
            viewport: self.scene.image.size,
            clear: Clear::default(),
            state: DrawState { depth_test: None, depth_write: false, blend: Some(blend), ..DrawState::OPAQUE },
            batches: vec![batch],
        };
        self.push(label, Redraw::Always, pass);
    }
}

/// Covers every pixel: the square of side 2 in x and z, stood up in clip space.
fn whole_picture() -> Draw {
    let mesh = Arc::new(primitive("quad").unwrap_or_default());
    let clip_from_model = glam::DMat4::from_cols(DVec4::X, DVec4::Z, DVec4::Y, DVec4::W);
    Draw {
        label: String::from("every pixel"),
        primitive: Primitive::Triangles,
        indices: 0..mesh.indices.len() as u32,
        order: IndexOrder::File,
        bounds: mesh.bounds,
        mesh: MeshRef(mesh),
        clip_from_model,
        eye_from_model: None,
        mirrored: false,
        uniforms: Vec::new(),
    }
}
