//! A frame as data: images, passes, draw state, shader variants, draws. Plain values that can be printed, compared and
//! run by more than one reader. Knows meshes and the math of texture coordinates; no scene, no technique, no GL.

mod define;
mod draw;
mod fixed_function_desc;
mod image;
mod program;
mod source;
mod state;

pub use define::Define;
pub use draw::{Batch, Draw, IndexOrder, MeshRef, Primitive};
pub use fixed_function_desc::{
    AlphaTest, BumpMap, Decal, FixedFunctionDesc, FixedFunctionLight, GlossSource, Lit, Projection, Shade, ShadeView,
    Texturing,
};
pub use image::{
    Border, Cube, CubeFace, DepthFormat, FilledImages, Filter, Format, ImageDesc, ImageId, Input, Sampler, Storage,
    Wrap,
};
pub use program::{Attribute, Chunk, Program, Uniform, UniformValue};
pub use source::{Source, SourceLine, Stage};
pub use state::{Blend, Channels, Compare, DrawState, Face, PolygonOffset, Stencil, StencilOp, StencilOps};

pub(crate) use program::glsl;

/// Everything that a frame's passes refer to, and the passes in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PassList {
    /// Images that the passes draw into and read, by [`ImageId`].
    pub images: Vec<ImageDesc>,
    /// Passes in the order in which they are drawn.
    pub passes: Vec<Pass>,
    /// Entries of [`PassList::filled_image`].
    #[doc(hidden)]
    pub filled: FilledImages,
}

impl PassList {
    /// Adds an image and returns its id.
    pub fn image(&mut self, desc: ImageDesc) -> ImageId {
        self.images.push(desc);
        ImageId(self.images.len() - 1)
    }

    /// The id of an image that is filled from the CPU: of the one with the same texels and size, if the list has it.
    pub fn filled_image(&mut self, desc: ImageDesc) -> ImageId {
        let next = ImageId(self.images.len());
        let Some(known) = self.filled.of(&desc.storage, desc.size) else { return self.image(desc) };
        // Images may have been renumbered.
        if self.images.get(known.0).is_none_or(|image| image.storage != desc.storage || image.size != desc.size) {
            *known = next;
            self.images.push(desc);
        }
        *known
    }

    /// Description of an image of this list.
    pub fn desc(&self, id: ImageId) -> &ImageDesc {
        &self.images[id.0]
    }
}

/// One step of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Name of the pass in plans, times and errors; unique in the list.
    pub label: String,
    /// Rule for frames after the first.
    pub redraw: Redraw,
    /// Work of the pass.
    pub work: Work,
}

/// Rule for leaving a pass out of a frame that would draw the same again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Redraw {
    /// Draws in every frame.
    Always,
    /// Draws in the first frame, and in each that differs in this pass.
    WhenChanged,
}

/// Work of a pass.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// Clears a target and draws into it.
    Draw(DrawPass),
    /// glCopyTexSubImage2D of the whole image, from the framebuffer that has `from` as its depth attachment.
    CopyDepth {
        /// Image with the depth values.
        from: ImageId,
        /// Depth texture that they are copied into, as many as it holds.
        to: ImageId,
        /// Face of `to`, if that is a cube map.
        face: Option<CubeFace>,
    },
}

/// Draws into one target under one draw state.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawPass {
    /// Images that it draws into.
    pub target: Target,
    /// Size in pixels, from the target's lower left corner. Clears affect the whole target.
    pub viewport: [u32; 2],
    /// Values that the target is cleared to first.
    pub clear: Clear,
    /// Draw state; a batch can change some of it.
    pub state: DrawState,
    /// Batches in the order in which they are drawn.
    pub batches: Vec<Batch>,
}

/// Framebuffer attachments, all of one size at their level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Target {
    /// Colour attachment; `None`: no colour is drawn.
    pub color: Option<ImageId>,
    /// Depth attachment; also the stencil attachment if its format has both.
    pub depth: Option<ImageId>,
    /// Level of images that have several.
    pub level: u32,
    /// Face of `depth`, if that is a cube map.
    pub face: Option<CubeFace>,
}

/// Values to clear to before the draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clear {
    /// RGBA; `None`: the stored colours stay.
    pub color: Option<[f32; 4]>,
    /// Window-space depth in [0, 1]; `None`: the stored depths stay.
    pub depth: Option<f32>,
    /// Stencil value; `None`: the stored values stay.
    pub stencil: Option<u8>,
}

impl Pass {
    /// The images that the pass samples, copies, or adds to without clearing them first.
    pub fn reads(&self) -> Vec<ImageId> {
        match &self.work {
            Work::Draw(draw) => {
                let inputs = draw.batches.iter().flat_map(|b| b.inputs.iter().map(|input| input.image));
                let color = draw.target.color.filter(|_| draw.clear.color.is_none());
                let tests = draw.state.depth_test.is_some() || draw.state.stencil.is_some();
                let depth = draw.target.depth.filter(|_| tests && draw.clear.depth.is_none());
                inputs.chain(color).chain(depth).collect()
            }
            Work::CopyDepth { from, .. } => vec![*from],
        }
    }

    /// Every image that the pass names, to be renumbered.
    pub fn images_mut(&mut self) -> Vec<&mut ImageId> {
        match &mut self.work {
            Work::CopyDepth { from, to, .. } => vec![from, to],
            Work::Draw(DrawPass { target: Target { color, depth, .. }, batches, .. }) => {
                let inputs = batches.iter_mut().flat_map(|batch| batch.inputs.iter_mut());
                color.iter_mut().chain(depth.iter_mut()).chain(inputs.map(|input| &mut input.image)).collect()
            }
        }
    }

    /// The image in whose stencil values the pass counts.
    pub fn counts_in(&self) -> Option<ImageId> {
        let Work::Draw(draw) = &self.work else { return None };
        draw.target.depth.filter(|_| draw.state.stencil.is_some_and(|stencil| stencil.write_mask != 0))
    }

    /// The most textures that one of its batches binds.
    pub fn most_inputs(&self) -> usize {
        match &self.work {
            Work::Draw(draw) => draw.batches.iter().map(|batch| batch.inputs.len()).max().unwrap_or(0),
            Work::CopyDepth { .. } => 0,
        }
    }

    /// The images that the pass writes. A pass that only tests depth or stencil writes neither.
    pub fn writes(&self) -> Vec<ImageId> {
        match &self.work {
            Work::Draw(draw) => {
                let state = &draw.state;
                let color = draw.target.color.filter(|_| state.color_write.any() || draw.clear.color.is_some());
                let counts = state.stencil.is_some_and(|stencil| stencil.write_mask != 0);
                let clears = draw.clear.depth.is_some() || draw.clear.stencil.is_some();
                let depth = draw.target.depth.filter(|_| state.depth_write || counts || clears);
                color.into_iter().chain(depth).collect()
            }
            Work::CopyDepth { to, .. } => vec![*to],
        }
    }
}
