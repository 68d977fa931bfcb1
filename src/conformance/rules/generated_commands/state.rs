//! State of the model: every value that a setting sets, as GL has it at the start or as the player leaves it.

use crate::conformance::bench::commands::{
    ARRAYS, CAPACITY, FRAMEBUFFERS, OUTPUTS, Place, Program, RENDERBUFFERS, Rectangle, SAMPLERS, Sampled, Setting,
    TEXTURES, UNITS,
};
use crate::conformance::bench::{
    GlCompare, GlEquation, GlFace, GlFactor, GlImageDesc, GlOffset, GlShape, GlStencil, GlStencilOp,
};

use super::image::{Image, Sampler};

/// An attachment, and whether the stencil point has it too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attached {
    pub place: Place,
    pub stencil: bool,
    /// The object of that slot has been deleted since.
    pub stale: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct Framebuffer {
    pub color: [Option<Attached>; OUTPUTS],
    pub depth: Option<Attached>,
    pub outputs: [Option<u32>; OUTPUTS],
    pub read: Option<u32>,
}

impl Framebuffer {
    /// As it is made.
    pub const NEW: Self = Self { color: [None; OUTPUTS], depth: None, outputs: [Some(0), None], read: Some(0) };

    pub fn places(&self) -> impl Iterator<Item = &Attached> {
        self.color.iter().chain([&self.depth]).flatten()
    }

    pub fn places_mut(&mut self) -> impl Iterator<Item = &mut Option<Attached>> {
        self.color.iter_mut().chain([&mut self.depth])
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Uniforms {
    pub color: [f32; 4],
    pub period: [i32; 2],
    pub origin: [i32; 2],
    pub level: i32,
    pub layer: i32,
    pub reference: f32,
    pub unit: i32,
    pub axes: [[f32; 3]; 3],
    pub cut: [f32; 2],
}

/// Textures of a unit by target (2D, cube map, array), and its sampler object.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unit {
    pub textures: [Option<usize>; 3],
    pub sampler: Option<usize>,
}

/// Index of a target among a unit's.
pub fn target(shape: GlShape) -> usize {
    match shape {
        GlShape::Cube => 1,
        GlShape::Array => 2,
        _ => 0,
    }
}

#[derive(Clone, Debug)]
pub struct State {
    pub textures: [Option<Image>; TEXTURES],
    pub renderbuffers: [Option<Image>; RENDERBUFFERS],
    pub framebuffers: [Option<Framebuffer>; FRAMEBUFFERS],
    pub samplers: [Sampler; SAMPLERS],
    pub arrays: [Option<[Rectangle; CAPACITY]>; ARRAYS],
    pub units: [Unit; UNITS as usize],
    pub active: usize,
    /// Framebuffers that are bound for drawing and for reading.
    pub bound: [Option<usize>; 2],
    pub depth_test: bool,
    pub depth_func: GlCompare,
    pub depth_mask: bool,
    pub depth_range: [f64; 2],
    pub depth_clamp: bool,
    pub cull: bool,
    pub culled: GlFace,
    pub clockwise: bool,
    pub stencil_test: bool,
    pub stencil: [GlStencil; 2],
    pub blend: [bool; OUTPUTS],
    pub factors: [GlFactor; 4],
    pub equations: [GlEquation; 2],
    pub masks: [[bool; 4]; OUTPUTS],
    pub scissor_test: bool,
    pub scissor: [i32; 4],
    pub viewport: [i32; 4],
    pub offset_fill: bool,
    pub clip_distance: bool,
    pub offset: GlOffset,
    pub clear_color: [f32; 4],
    pub clear_depth: f64,
    pub clear_stencil: i32,
    pub program: Program,
    pub uniforms: [Uniforms; Program::ALL.len()],
    /// True while a query counts samples. What it counts is not judged: GL-Q1 to GL-Q3 do that.
    pub is_counting: bool,
}

impl State {
    /// As a context starts, but for what no command depends on before it is set. [`starting`] sets the rest.
    pub fn new() -> Self {
        let side = GlStencil { write_mask: !0, read_mask: !0, ..GlStencil::on_pass(GlStencilOp::Keep) };
        Self {
            textures: [const { None }; TEXTURES],
            renderbuffers: [const { None }; RENDERBUFFERS],
            framebuffers: [None; FRAMEBUFFERS],
            samplers: [Sampler::START; SAMPLERS],
            arrays: [None; ARRAYS],
            units: [Unit::default(); UNITS as usize],
            active: 0,
            bound: [None; 2],
            depth_test: false,
            depth_func: GlCompare::Less,
            depth_mask: true,
            depth_range: [0.0, 1.0],
            depth_clamp: false,
            cull: false,
            culled: GlFace::Back,
            clockwise: false,
            stencil_test: false,
            stencil: [side; 2],
            blend: [false; OUTPUTS],
            factors: [GlFactor::One, GlFactor::Zero, GlFactor::One, GlFactor::Zero],
            equations: [GlEquation::Add; 2],
            masks: [[true; 4]; OUTPUTS],
            scissor_test: false,
            scissor: [0, 0, 1, 1],
            viewport: [0, 0, 1, 1],
            offset_fill: false,
            clip_distance: false,
            offset: GlOffset { factor: 0.0, units: 0.0, clamp: 0.0 },
            clear_color: [0.0; 4],
            clear_depth: 1.0,
            clear_stencil: 0,
            program: Program::Plain,
            uniforms: [Uniforms::default(); Program::ALL.len()],
            is_counting: false,
        }
    }

    /// Settings that make a context's state that of [`new`](Self::new), whatever was set before.
    pub fn starting() -> Vec<Setting> {
        use crate::conformance::bench::commands::Faces;
        let start = Self::new();
        vec![
            Setting::DepthTest(false),
            Setting::DepthFunc(start.depth_func),
            Setting::DepthMask(true),
            Setting::DepthRange(start.depth_range, false),
            Setting::DepthClamp(false),
            Setting::CullFace(false),
            Setting::Culled(start.culled),
            Setting::Clockwise(false),
            Setting::StencilTest(false),
            Setting::StencilFunc(Faces::Both, GlCompare::Always, 0, !0),
            Setting::StencilOp(Faces::Both, [GlStencilOp::Keep; 3]),
            Setting::StencilMask(Faces::Both, !0),
            Setting::Blend(false),
            Setting::BlendFunc(start.factors),
            Setting::BlendEquation(start.equations),
            Setting::ColorMask([true; 4]),
            Setting::ScissorTest(false),
            Setting::Scissor(start.scissor),
            Setting::Viewport(start.viewport),
            Setting::OffsetFill(false),
            Setting::ClipDistance(false),
            Setting::Offset(start.offset),
            Setting::ClearColor(start.clear_color),
            Setting::ClearDepth(1.0),
            Setting::ClearStencil(0),
            Setting::Program(Program::Plain),
        ]
    }

    pub fn image(&self, place: Place) -> Option<&Image> {
        match place {
            Place::Texture { slot, .. } => self.textures[slot].as_ref(),
            Place::Renderbuffer(slot) => self.renderbuffers[slot].as_ref(),
        }
    }

    pub fn image_mut(&mut self, place: Place) -> Option<&mut Image> {
        match place {
            Place::Texture { slot, .. } => self.textures[slot].as_mut(),
            Place::Renderbuffer(slot) => self.renderbuffers[slot].as_mut(),
        }
    }

    /// Level and layer of a place.
    pub fn part(place: Place) -> [u32; 2] {
        if let Place::Texture { level, layer, .. } = place { [level, layer] } else { [0, 0] }
    }

    /// The framebuffer that is bound for drawing, or for reading.
    pub fn framebuffer(&self, reading: bool) -> Option<&Framebuffer> {
        self.framebuffers[self.bound[usize::from(reading)]?].as_ref()
    }

    /// Format, size and samples of a framebuffer's image; `None`: it is not attached as its format asks for.
    fn described(&self, attached: Attached, color: bool) -> Option<([u32; 2], u32)> {
        let image = self.image(attached.place)?;
        let [level, layer] = Self::part(attached.place);
        let fits = image.format.is_depth() != color
            && (color || image.format.has_stencil() == attached.stencil)
            && level < image.levels
            && layer < image.layers
            // A level that sampling cannot reach makes the attachment incomplete [GL 4.6, 9.4.1].
            && (image.range[0]..=image.range[1]).contains(&level)
            && !attached.stale;
        fits.then(|| (image.size_of(level), image.samples))
    }

    /// Size and samples of a framebuffer that is complete, with images that are all of one size [GL 4.6, 9.4.2].
    pub fn complete(&self, framebuffer: &Framebuffer) -> Option<([u32; 2], u32)> {
        let mut all = Vec::new();
        for attached in framebuffer.color.into_iter().flatten() {
            all.push(self.described(attached, true)?);
        }
        if let Some(attached) = framebuffer.depth {
            all.push(self.described(attached, false)?);
        }
        let names = framebuffer.outputs.into_iter().flatten().chain(framebuffer.read);
        let named = names.into_iter().all(|index| framebuffer.color[index as usize].is_some());
        let first = *all.first()?;
        (named && all.iter().all(|one| *one == first)).then_some(first)
    }

    /// The sampler state that is in force on a unit for a texture.
    pub fn in_force(&self, unit: usize, image: &Image) -> Sampler {
        self.units[unit].sampler.map_or(image.sampler, |slot| self.samplers[slot])
    }

    /// Binds a texture to the unit that is active.
    pub fn bind_texture(&mut self, slot: usize) {
        if let Some(image) = &self.textures[slot] {
            self.units[self.active].textures[target(image.shape)] = Some(slot);
        }
    }

    /// The sampler state of an object; a texture's is bound for that.
    pub fn sampler_mut(&mut self, object: Sampled) -> Option<&mut Sampler> {
        match object {
            Sampled::Sampler(slot) => Some(&mut self.samplers[slot]),
            Sampled::Texture(slot) => {
                self.bind_texture(slot);
                self.textures[slot].as_mut().map(|image| &mut image.sampler)
            }
        }
    }

    /// Forgets a texture that is deleted: units and framebuffers that are bound lose it, others keep what has no name.
    pub fn forget_texture(&mut self, slot: usize) {
        self.textures[slot] = None;
        for unit in &mut self.units {
            unit.textures.iter_mut().filter(|bound| **bound == Some(slot)).for_each(|bound| *bound = None);
        }
        let bound = self.bound;
        for (index, framebuffer) in self.framebuffers.iter_mut().enumerate() {
            let Some(framebuffer) = framebuffer else { continue };
            for attached in framebuffer.places_mut() {
                let Some(of) = attached else { continue };
                if !matches!(of.place, Place::Texture { slot: other, .. } if other == slot) || of.stale {
                    continue;
                }
                if bound.contains(&Some(index)) {
                    *attached = None;
                } else {
                    of.stale = true;
                }
            }
        }
    }

    /// Makes a texture: the same object with other images where the shape stays and it is not made fresh.
    pub fn make_texture(&mut self, slot: usize, desc: GlImageDesc, fresh: bool) {
        let GlImageDesc { shape, format, size, layers, levels } = desc;
        let mut image = Image::new(shape, format, size, layers, levels, 0);
        match self.textures[slot].as_ref().filter(|before| !fresh && before.shape == shape) {
            Some(before) => (image.sampler, image.swizzle) = (before.sampler, before.swizzle),
            None => self.forget_texture(slot),
        }
        self.textures[slot] = Some(image);
        self.bind_texture(slot);
    }
}
