//! Names, versions and limits of a context, for `glumbra info` and for reports.

use glow::HasContext;
use serde::{Deserialize, Serialize};

use super::load::LoadedContext;

/// The driver of a context, and its limits.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContextInfo {
    /// The way the context was made, e.g. `EGL surfaceless`.
    pub backend: String,
    /// GL_VENDOR.
    pub vendor: String,
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VERSION.
    pub version: String,
    /// GL_SHADING_LANGUAGE_VERSION.
    pub shading_language: String,
    /// `core` or `compatibility`, by GL_CONTEXT_PROFILE_MASK; `none` before OpenGL 3.2.
    pub profile: String,
    /// True if the driver has GL_KHR_debug, or OpenGL 4.3, which includes it.
    pub khr_debug: bool,
    /// True if errors are reported with their text, at the call that made them.
    pub debug_output: bool,
    /// Bits of the counter of GL_TIME_ELAPSED queries; 0: passes cannot be timed on the device.
    pub timer_bits: u32,
    /// Limits of the context.
    pub limits: ContextLimits,
}

impl ContextInfo {
    /// The driver in a line: GL_RENDERER and GL_VERSION.
    pub fn driver(&self) -> String {
        format!("{}, OpenGL {}", self.renderer, self.version)
    }
}

/// Limits of a context, as its GL_MAX_* queries answer.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContextLimits {
    /// GL_MAX_TEXTURE_SIZE, in texels.
    pub texture_size: i32,
    /// GL_MAX_CUBE_MAP_TEXTURE_SIZE, in texels.
    pub cube_map_size: i32,
    /// GL_MAX_ARRAY_TEXTURE_LAYERS.
    pub array_layers: i32,
    /// Units that a fragment shader can read.
    pub texture_units: i32,
    /// GL_MAX_RENDERBUFFER_SIZE, in pixels.
    pub renderbuffer_size: i32,
    /// GL_MAX_VIEWPORT_DIMS: width and height in pixels.
    pub viewport: [i32; 2],
    /// GL_MAX_COLOR_ATTACHMENTS.
    pub color_attachments: i32,
    /// GL_MAX_DRAW_BUFFERS.
    pub draw_buffers: i32,
    /// GL_MAX_SAMPLES, for each pixel.
    pub samples: i32,
    /// Bits below the pixel to which vertices are snapped.
    pub subpixel_bits: i32,
    /// 1 where anisotropic filtering is absent.
    pub anisotropy: f32,
    /// GL_MAX_CLIP_DISTANCES.
    pub clip_distances: i32,
    /// GL_MAX_VERTEX_ATTRIBS.
    pub vertex_attributes: i32,
    /// Scalars, of one stage.
    pub vertex_uniforms: i32,
    /// GL_MAX_FRAGMENT_UNIFORM_COMPONENTS.
    pub fragment_uniforms: i32,
    /// GL_MAX_UNIFORM_BLOCK_SIZE.
    pub uniform_block_bytes: i32,
}

/// Queries the context, which must be current.
pub(super) fn describe(loaded: &LoadedContext) -> ContextInfo {
    let gl = &*loaded.gl;
    // SAFETY: queries of strings that every context has since OpenGL 2.0.
    let text = |name| unsafe { gl.get_parameter_string(name) };
    ContextInfo {
        backend: loaded.backend.clone(),
        vendor: text(glow::VENDOR),
        renderer: text(glow::RENDERER),
        version: text(glow::VERSION),
        shading_language: text(glow::SHADING_LANGUAGE_VERSION),
        profile: profile(gl).to_owned(),
        khr_debug: gl.supports_debug(),
        debug_output: loaded.debug_log.is_some(),
        timer_bits: loaded.timer_bits,
        limits: limits(gl),
    }
}

fn profile(gl: &glow::Context) -> &'static str {
    let version = gl.version();
    if (version.major, version.minor) < (3, 2) {
        return "none";
    }
    // SAFETY: the query exists since OpenGL 3.2.
    let mask = unsafe { gl.get_parameter_i32(glow::CONTEXT_PROFILE_MASK) };
    if mask & glow::CONTEXT_CORE_PROFILE_BIT as i32 != 0 { "core" } else { "compatibility" }
}

fn has(gl: &glow::Context, extension: &str) -> bool {
    gl.supported_extensions().contains(extension)
}

fn limits(gl: &glow::Context) -> ContextLimits {
    // SAFETY: each writes one value, or two for the viewport; a name that the context does not know leaves 0 and an
    // error, which is taken away at the end.
    let int = |name| unsafe { gl.get_parameter_i32(name) };
    let mut viewport = [0; 2];
    unsafe { gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport) };
    let anisotropic = has(gl, "GL_EXT_texture_filter_anisotropic") || has(gl, "GL_ARB_texture_filter_anisotropic");
    let limits = ContextLimits {
        texture_size: int(glow::MAX_TEXTURE_SIZE),
        cube_map_size: int(glow::MAX_CUBE_MAP_TEXTURE_SIZE),
        array_layers: int(glow::MAX_ARRAY_TEXTURE_LAYERS),
        texture_units: int(glow::MAX_TEXTURE_IMAGE_UNITS),
        renderbuffer_size: int(glow::MAX_RENDERBUFFER_SIZE),
        viewport,
        color_attachments: int(glow::MAX_COLOR_ATTACHMENTS),
        draw_buffers: int(glow::MAX_DRAW_BUFFERS),
        samples: int(glow::MAX_SAMPLES),
        subpixel_bits: int(glow::SUBPIXEL_BITS),
        anisotropy: if anisotropic {
            unsafe { gl.get_parameter_f32(glow::MAX_TEXTURE_MAX_ANISOTROPY_EXT) }
        } else {
            1.0
        },
        clip_distances: int(glow::MAX_CLIP_DISTANCES),
        vertex_attributes: int(glow::MAX_VERTEX_ATTRIBS),
        vertex_uniforms: int(glow::MAX_VERTEX_UNIFORM_COMPONENTS),
        fragment_uniforms: int(glow::MAX_FRAGMENT_UNIFORM_COMPONENTS),
        uniform_block_bytes: int(glow::MAX_UNIFORM_BLOCK_SIZE),
    };
    // SAFETY: reads and clears the error flag.
    unsafe { gl.get_error() };
    limits
}
