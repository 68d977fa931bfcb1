//! Layers: images of floats in which light is summed before it joins the picture, whose 8 bits would round each share.

use super::passes::{Buffers, Passes};
use crate::lights::whole_target;
use crate::pass::{
    Attribute, Batch, Blend, Clear, DrawPass, DrawState, Filter, FixedFunctionDesc, Format, ImageDesc, ImageId, Input,
    Program, Redraw, Sampler, Storage, Target, Wrap, glsl,
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
            draws: vec![whole_target("every pixel")],
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
