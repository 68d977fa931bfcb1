//! The floor's GL objects, on plain EGL: its heap stays as the system has it.

use glow::HasContext;
use khronos_egl as egl;

use super::Result;

const PLATFORM_SURFACELESS_MESA: egl::Enum = 0x31DD;

/// A core context on the surfaceless platform, current until the process ends.
pub fn open() -> Result<glow::Context> {
    // SAFETY: libEGL's functions have the signatures that khronos-egl knows.
    let egl = unsafe { egl::DynamicInstance::<egl::EGL1_5>::load_required() }?;
    // SAFETY: the surfaceless platform takes no native display.
    let display =
        unsafe { egl.get_platform_display(PLATFORM_SURFACELESS_MESA, egl::DEFAULT_DISPLAY, &[egl::ATTRIB_NONE]) }?;
    egl.initialize(display)?;
    egl.bind_api(egl::OPENGL_API)?;
    // SAFETY: the surfaceless platform has EGL_KHR_no_config_context: no configuration is one.
    let config = unsafe { egl::Config::from_ptr(std::ptr::null_mut()) };
    let attributes = [
        egl::CONTEXT_MAJOR_VERSION,
        3,
        egl::CONTEXT_MINOR_VERSION,
        3,
        egl::CONTEXT_OPENGL_PROFILE_MASK,
        egl::CONTEXT_OPENGL_CORE_PROFILE_BIT,
        egl::NONE,
    ];
    let context = egl.create_context(display, config, None, &attributes)?;
    egl.make_current(display, None, None, Some(context))?;
    let address = |name: &str| egl.get_proc_address(name).map_or(std::ptr::null(), |f| f as *const _);
    // SAFETY: the context is current, and the addresses are its functions.
    let gl = unsafe { glow::Context::from_loader_function(address) };
    // The driver's code must outlive its threads.
    std::mem::forget(egl);
    Ok(gl)
}

/// As glumbra's own: what is freed stays with the process.
pub fn keep_heap() {
    // SAFETY: mallopt takes two integers and may be called at any time.
    unsafe {
        libc::mallopt(libc::M_TRIM_THRESHOLD, 1 << 30);
        libc::mallopt(libc::M_MMAP_THRESHOLD, 1 << 30);
        libc::mallopt(libc::M_TOP_PAD, 64 << 20);
    }
}

/// A linked program.
pub struct Program {
    pub name: glow::Program,
    /// Set for each draw.
    pub offset: Option<glow::UniformLocation>,
    pub material: Option<glow::UniformLocation>,
}

impl Program {
    /// With `defines` behind both stages' version.
    pub fn new(gl: &glow::Context, defines: &str, vertex: &str, fragment: &str) -> Result<Self> {
        unsafe {
            let name = gl.create_program()?;
            for (kind, source) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
                let shader = gl.create_shader(kind)?;
                let (version, rest) = source.split_once('\n').ok_or("a shader without a version")?;
                gl.shader_source(shader, &format!("{version}\n{defines}{rest}"));
                gl.compile_shader(shader);
                gl.attach_shader(name, shader);
            }
            gl.link_program(name);
            if !gl.get_program_link_status(name) {
                return Err(gl.get_program_info_log(name).into());
            }
            let [offset, material] = ["offset", "material"].map(|uniform| gl.get_uniform_location(name, uniform));
            Ok(Self { name, offset, material })
        }
    }

    pub fn at(&self, gl: &glow::Context, name: &str) -> Option<glow::UniformLocation> {
        unsafe { gl.get_uniform_location(self.name, name) }
    }
}

/// The framebuffer of the picture.
pub fn picture(gl: &glow::Context, size: i32) -> Result<glow::Framebuffer> {
    unsafe {
        let target = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
        for (format, attachment) in
            [(glow::RGBA8, glow::COLOR_ATTACHMENT0), (glow::DEPTH_COMPONENT24, glow::DEPTH_ATTACHMENT)]
        {
            let buffer = gl.create_renderbuffer()?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, size, size);
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(buffer));
        }
        Ok(target)
    }
}

/// One vertex array over interleaved positions and normals, left bound.
pub fn upload(gl: &glow::Context, vertices: &[u8], indices: &[u8]) -> Result<glow::VertexArray> {
    unsafe {
        let array = gl.create_vertex_array()?;
        gl.bind_vertex_array(Some(array));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, vertices, glow::STATIC_DRAW);
        gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, indices, glow::STATIC_DRAW);
        for location in [0, 1] {
            gl.enable_vertex_attrib_array(location);
            gl.vertex_attrib_pointer_f32(location, 3, glow::FLOAT, false, 24, 12 * location as i32);
        }
        Ok(array)
    }
}

/// A context, a framebuffer, a clear, a pixel read: what no picture comes without.
pub fn first_pixel() -> Result<()> {
    let gl = open()?;
    picture(&gl, 1)?;
    let mut pixel = [0; 4];
    unsafe {
        gl.clear_color(1.0, 0.0, 0.0, 1.0);
        gl.clear(glow::COLOR_BUFFER_BIT);
        let pixels = glow::PixelPackData::Slice(Some(&mut pixel));
        gl.read_pixels(0, 0, 1, 1, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
    }
    if pixel == [255, 0, 0, 255] { Ok(()) } else { Err(format!("cleared red, read {pixel:?}").into()) }
}
