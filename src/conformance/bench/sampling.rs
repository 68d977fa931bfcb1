//! How a texture is sampled: by its own parameters, or by a sampler object over parameters that say the contrary.

use glow::HasContext;

use super::image::{GlImage, GlShape};
use super::state::GlCompare;
use super::{Bench, Error};

/// GL_CLAMP, which only a compatibility context knows.
const CLAMP: u32 = 0x2900;

/// Wrap mode for coordinates outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlWrap {
    Repeat,
    MirroredRepeat,
    ClampToEdge,
    ClampToBorder,
    /// GL_CLAMP: halfway to the border, of a compatibility context.
    Clamp,
}

impl GlWrap {
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Repeat => glow::REPEAT,
            Self::MirroredRepeat => glow::MIRRORED_REPEAT,
            Self::ClampToEdge => glow::CLAMP_TO_EDGE,
            Self::ClampToBorder => glow::CLAMP_TO_BORDER,
            Self::Clamp => CLAMP,
        }
    }
}

/// Choice of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlMipmap {
    /// The base level alone.
    Off,
    /// The nearest level.
    Nearest,
    /// A blend of two levels.
    Linear,
}

/// Object that has the sampling state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlSampledBy {
    /// The texture's own parameters.
    Texture,
    /// A sampler object. The texture's parameters differ in each value: the object's are in force [GL 4.6, 8.2].
    Sampler,
}

impl GlSampledBy {
    pub const ALL: [Self; 2] = [Self::Texture, Self::Sampler];

    /// End of a finding's name.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Texture => "",
            Self::Sampler => ", by a sampler object",
        }
    }
}

/// Source of a channel that a shader sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlSwizzle {
    Red,
    Green,
    Blue,
    Alpha,
    Zero,
    One,
}

impl GlSwizzle {
    /// Each channel as it is.
    pub const SAME: [Self; 4] = [Self::Red, Self::Green, Self::Blue, Self::Alpha];

    pub(super) fn code(self) -> u32 {
        match self {
            Self::Red => glow::RED,
            Self::Green => glow::GREEN,
            Self::Blue => glow::BLUE,
            Self::Alpha => glow::ALPHA,
            Self::Zero => glow::ZERO,
            Self::One => glow::ONE,
        }
    }
}

/// The complete sampling state of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// LINEAR within a level.
    pub linear: bool,
    /// LINEAR where a texture is magnified, if another than `linear`.
    pub magnified: Option<bool>,
    pub mipmap: GlMipmap,
    /// Wrap modes of s, t and r.
    pub wrap: [GlWrap; 3],
    pub border: [f32; 4],
    pub compare: Option<GlCompare>,
    /// TEXTURE_MIN_LOD and TEXTURE_MAX_LOD.
    pub lod: [f32; 2],
    /// TEXTURE_LOD_BIAS.
    pub bias: f32,
    pub by: GlSampledBy,
    /// TEXTURE_BASE_LEVEL and TEXTURE_MAX_LEVEL, of the texture always; `None`: all levels that there are.
    pub levels: Option<[u32; 2]>,
    /// Sources of the channels, a state of the texture always.
    pub swizzle: [GlSwizzle; 4],
    /// DEPTH_STENCIL_TEXTURE_MODE is STENCIL_INDEX; of the texture always.
    pub stencil: bool,
    /// GL_TEXTURE_CUBE_MAP_SEAMLESS, of the whole context; set where a cube map is bound.
    pub seamless: bool,
}

impl Sampling {
    pub const NEAREST: Self = Self {
        linear: false,
        magnified: None,
        mipmap: GlMipmap::Off,
        wrap: [GlWrap::ClampToEdge; 3],
        border: [0.0; 4],
        compare: None,
        lod: [-1000.0, 1000.0],
        bias: 0.0,
        by: GlSampledBy::Texture,
        levels: None,
        swizzle: GlSwizzle::SAME,
        stencil: false,
        seamless: false,
    };

    /// The linear filter.
    pub const LINEAR: Self = Self { linear: true, ..Self::NEAREST };

    /// The nearest texel of the nearest level.
    pub const NEAREST_LEVEL: Self = Self { mipmap: GlMipmap::Nearest, ..Self::NEAREST };

    /// Four texels of each of two levels.
    pub const TRILINEAR: Self = Self { mipmap: GlMipmap::Linear, ..Self::LINEAR };

    /// Compares the nearest texel.
    pub const fn compare(compare: GlCompare) -> Self {
        Self { compare: Some(compare), ..Self::NEAREST }
    }

    /// Compares four texels.
    pub const fn compare_linear(compare: GlCompare) -> Self {
        Self { linear: true, ..Self::compare(compare) }
    }

    /// A state that differs in every value that a sampler object has.
    fn contrary(self) -> Self {
        let other = |wrap| if wrap == GlWrap::Repeat { GlWrap::ClampToEdge } else { GlWrap::Repeat };
        let compare = match self.compare {
            None => Some(GlCompare::Never),
            Some(GlCompare::Never | GlCompare::Less | GlCompare::Equal) => Some(GlCompare::Greater),
            Some(_) => None,
        };
        Self {
            linear: !self.linear,
            magnified: self.magnified.map(|linear| !linear),
            mipmap: if self.mipmap == GlMipmap::Off { GlMipmap::Linear } else { GlMipmap::Off },
            wrap: self.wrap.map(other),
            border: self.border.map(|value| 1.0 - value),
            compare,
            lod: [0.25, 0.75],
            bias: 3.0 - self.bias,
            ..self
        }
    }

    /// The parameters that textures and sampler objects share: integers, then floats.
    #[allow(clippy::type_complexity, reason = "two lists, used once")]
    fn parameters(self) -> ([(u32, u32); 7], [(u32, f32); 3]) {
        let filter = |linear| if linear { glow::LINEAR } else { glow::NEAREST };
        let min = match (self.mipmap, self.linear) {
            (GlMipmap::Off, linear) => filter(linear),
            (GlMipmap::Nearest, false) => glow::NEAREST_MIPMAP_NEAREST,
            (GlMipmap::Nearest, true) => glow::LINEAR_MIPMAP_NEAREST,
            (GlMipmap::Linear, false) => glow::NEAREST_MIPMAP_LINEAR,
            (GlMipmap::Linear, true) => glow::LINEAR_MIPMAP_LINEAR,
        };
        let mode = if self.compare.is_some() { glow::COMPARE_REF_TO_TEXTURE } else { glow::NONE };
        let [s, t, r] = self.wrap.map(GlWrap::code);
        (
            [
                (glow::TEXTURE_MIN_FILTER, min),
                (glow::TEXTURE_MAG_FILTER, filter(self.magnified.unwrap_or(self.linear))),
                (glow::TEXTURE_WRAP_S, s),
                (glow::TEXTURE_WRAP_T, t),
                (glow::TEXTURE_WRAP_R, r),
                (glow::TEXTURE_COMPARE_MODE, mode),
                (glow::TEXTURE_COMPARE_FUNC, self.compare.unwrap_or(GlCompare::LessEqual).code()),
            ],
            [
                (glow::TEXTURE_MIN_LOD, self.lod[0]),
                (glow::TEXTURE_MAX_LOD, self.lod[1]),
                (glow::TEXTURE_LOD_BIAS, self.bias),
            ],
        )
    }
}

impl Bench {
    /// Binds to a unit and sets the whole sampling state.
    pub(crate) fn bind_image(&self, unit: u32, image: &GlImage, sampling: Sampling) -> Result<(), Error> {
        let sampling = self.mutation.map_or(sampling, |mutation| mutation.sampling(sampling));
        let by_sampler = sampling.by == GlSampledBy::Sampler;
        let (integers, floats) = if by_sampler { sampling.contrary() } else { sampling }.parameters();
        let border = if by_sampler { sampling.contrary().border } else { sampling.border };
        let (gl, target) = (&self.gl, image.shape.target());
        // SAFETY: the context is current and the texture is not deleted.
        unsafe {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(target, Some(image.name));
            for (name, value) in integers {
                // A colour image knows no comparison, but keeps the parameter.
                gl.tex_parameter_i32(target, name, value as i32);
            }
            for (name, value) in floats {
                gl.tex_parameter_f32(target, name, value);
            }
            gl.tex_parameter_f32_slice(target, glow::TEXTURE_BORDER_COLOR, &border);
            let [base, most] = sampling.levels.unwrap_or([0, image.levels - 1]);
            gl.tex_parameter_i32(target, glow::TEXTURE_BASE_LEVEL, base as i32);
            gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, most as i32);
            for (name, swizzle) in (glow::TEXTURE_SWIZZLE_R..).zip(sampling.swizzle) {
                gl.tex_parameter_i32(target, name, swizzle.code() as i32);
            }
            if image.format.has_stencil() && self.reads_stencil() {
                let mode = if sampling.stencil { glow::STENCIL_INDEX } else { glow::DEPTH_COMPONENT };
                gl.tex_parameter_i32(target, glow::DEPTH_STENCIL_TEXTURE_MODE, mode as i32);
            }
            if matches!(image.shape, GlShape::Cube | GlShape::CubeArray) {
                let switch = if sampling.seamless { glow::Context::enable } else { glow::Context::disable };
                switch(gl, glow::TEXTURE_CUBE_MAP_SEAMLESS);
            }
        }
        self.bind_sampler(unit, by_sampler.then_some(sampling))
    }

    /// Sets the parameters of the texture that is bound to the active unit's `target`, where they differ from those before.
    pub(super) fn set_parameters(&self, target: u32, before: Option<&Sampling>, to: &Sampling) {
        let gl = &self.gl;
        let (integers, floats) = to.parameters();
        let known = before.map(|before| before.parameters());
        // SAFETY: the context is current, and a texture is bound.
        unsafe {
            for (index, (name, value)) in integers.into_iter().enumerate() {
                if known.is_none_or(|(integers, _)| integers[index].1 != value) {
                    gl.tex_parameter_i32(target, name, value as i32);
                }
            }
            for (index, (name, value)) in floats.into_iter().enumerate() {
                if known.is_none_or(|(_, floats)| floats[index].1 != value) {
                    gl.tex_parameter_f32(target, name, value);
                }
            }
            if before.is_none_or(|before| before.border != to.border) {
                gl.tex_parameter_f32_slice(target, glow::TEXTURE_BORDER_COLOR, &to.border);
            }
            if let Some([base, most]) = to.levels {
                let before = before.and_then(|before| before.levels);
                if before.is_none_or(|[known, _]| known != base) {
                    gl.tex_parameter_i32(target, glow::TEXTURE_BASE_LEVEL, base as i32);
                }
                if before.is_none_or(|[_, known]| known != most) {
                    gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, most as i32);
                }
            }
            for (index, name) in (glow::TEXTURE_SWIZZLE_R..).take(4).enumerate() {
                if before.is_none_or(|before| before.swizzle[index] != to.swizzle[index]) {
                    gl.tex_parameter_i32(target, name, to.swizzle[index].code() as i32);
                }
            }
        }
    }

    /// The same of a sampler object.
    pub(super) fn set_sampler_parameters(&self, name: glow::Sampler, before: Option<&Sampling>, to: &Sampling) {
        let gl = &self.gl;
        let (integers, floats) = to.parameters();
        let known = before.map(|before| before.parameters());
        // SAFETY: the context is current, and the object exists.
        unsafe {
            for (index, (parameter, value)) in integers.into_iter().enumerate() {
                if known.is_none_or(|(integers, _)| integers[index].1 != value) {
                    gl.sampler_parameter_i32(name, parameter, value as i32);
                }
            }
            for (index, (parameter, value)) in floats.into_iter().enumerate() {
                if known.is_none_or(|(_, floats)| floats[index].1 != value) {
                    gl.sampler_parameter_f32(name, parameter, value);
                }
            }
            if before.is_none_or(|before| before.border != to.border) {
                gl.sampler_parameter_f32_slice(name, glow::TEXTURE_BORDER_COLOR, &to.border);
            }
        }
    }

    /// Binds a new sampler object, or none. The one before lives on until the next is made: nothing but the call unbinds it.
    fn bind_sampler(&self, unit: u32, sampling: Option<Sampling>) -> Result<(), Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; an object is deleted once another is bound in its place.
        unsafe {
            let name = match sampling {
                None => None,
                Some(sampling) => {
                    let name = gl.create_sampler().map_err(super::no("sampler object"))?;
                    let (integers, floats) = sampling.parameters();
                    for (parameter, value) in integers {
                        gl.sampler_parameter_i32(name, parameter, value as i32);
                    }
                    for (parameter, value) in floats {
                        gl.sampler_parameter_f32(name, parameter, value);
                    }
                    gl.sampler_parameter_f32_slice(name, glow::TEXTURE_BORDER_COLOR, &sampling.border);
                    Some(name)
                }
            };
            gl.bind_sampler(unit, name);
            if let Some(before) = name.and_then(|name| self.samplers.borrow_mut().insert(unit, name)) {
                gl.delete_sampler(before);
            }
        }
        Ok(())
    }
}
