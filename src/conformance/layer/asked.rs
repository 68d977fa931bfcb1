//! State of the driver that an act at a call asks for.

use glow::HasContext;

use super::call::Call;

impl Call<'_> {
    /// An integer of the driver's state.
    pub fn get(&self, name: u32) -> i32 {
        // SAFETY: the context is current; `name` is of one integer.
        unsafe { self.gl().get_parameter_i32(name) }
    }

    /// Tests whether pixels that this call passes lie in the client's memory, row after row. True for other calls.
    pub fn has_plain_pixels(&self) -> bool {
        let names = match self.name {
            name if name.starts_with("glTex") && name.contains("Image") => [
                glow::PIXEL_UNPACK_BUFFER_BINDING,
                glow::UNPACK_ROW_LENGTH,
                glow::UNPACK_SKIP_ROWS,
                glow::UNPACK_SKIP_PIXELS,
                glow::UNPACK_ALIGNMENT,
            ],
            "glReadPixels" | "glGetTexImage" => [
                glow::PIXEL_PACK_BUFFER_BINDING,
                glow::PACK_ROW_LENGTH,
                glow::PACK_SKIP_ROWS,
                glow::PACK_SKIP_PIXELS,
                glow::PACK_ALIGNMENT,
            ],
            _ => return true,
        };
        let [buffer, row, rows, pixels, alignment] = names.map(|name| self.get(name));
        [buffer, row, rows, pixels] == [0; 4] && alignment < 8
    }

    /// Asks for texels, or gives some, while all pixels lie in the client's memory row after row, without gaps.
    pub fn with_plain_pixels<T>(&self, act: impl FnOnce(&glow::Context) -> T) -> T {
        const STORES: [u32; 10] = [
            glow::PACK_ALIGNMENT,
            glow::UNPACK_ALIGNMENT,
            glow::PACK_ROW_LENGTH,
            glow::PACK_SKIP_ROWS,
            glow::PACK_SKIP_PIXELS,
            glow::PACK_IMAGE_HEIGHT,
            glow::UNPACK_ROW_LENGTH,
            glow::UNPACK_SKIP_ROWS,
            glow::UNPACK_SKIP_PIXELS,
            glow::UNPACK_IMAGE_HEIGHT,
        ];
        let buffers = [
            (glow::PIXEL_PACK_BUFFER, glow::PIXEL_PACK_BUFFER_BINDING),
            (glow::PIXEL_UNPACK_BUFFER, glow::PIXEL_UNPACK_BUFFER_BINDING),
        ];
        let gl = self.gl();
        // SAFETY: the context is current; what is set at the end is what was read.
        unsafe {
            let held = buffers.map(|(target, binding)| (target, gl.get_parameter_buffer(binding)));
            let before = STORES.map(|name| (name, self.get(name)));
            held.iter().for_each(|(target, _)| gl.bind_buffer(*target, None));
            for (index, name) in STORES.into_iter().enumerate() {
                gl.pixel_store_i32(name, i32::from(index < 2));
            }
            let result = act(gl);
            before.into_iter().for_each(|(name, value)| gl.pixel_store_i32(name, value));
            held.into_iter().for_each(|(target, buffer)| gl.bind_buffer(target, buffer));
            result
        }
    }

    /// Tests whether something is enabled.
    pub fn enabled(&self, name: u32) -> bool {
        // SAFETY: the context is current.
        unsafe { self.gl().is_enabled(name) }
    }

    /// A float of the driver's state.
    pub fn float(&self, name: u32) -> f64 {
        // SAFETY: the context is current; `name` is of one number.
        f64::from(unsafe { self.gl().get_parameter_f32(name) })
    }

    /// Four integers of the driver's state.
    pub fn get4(&self, name: u32) -> [i32; 4] {
        let mut values = [0; 4];
        // SAFETY: the context is current; `name` is of at most four integers.
        unsafe { self.gl().get_parameter_i32_slice(name, &mut values) };
        values
    }

    /// An integer of an attachment of the framebuffer that is drawn into; 0 if it has none.
    pub fn attached(&self, point: u32, name: u32) -> i32 {
        let gl = self.gl();
        // SAFETY: the context is current; of a point without image only its type may be asked.
        unsafe {
            let kind = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE;
            let none = gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING).is_none()
                || gl.get_framebuffer_attachment_parameter_i32(glow::DRAW_FRAMEBUFFER, point, kind) == 0;
            if none { 0 } else { gl.get_framebuffer_attachment_parameter_i32(glow::DRAW_FRAMEBUFFER, point, name) }
        }
    }

    /// Bits of the depth image that is drawn into, and its component type; zeros without one.
    pub fn depth_format(&self) -> (i32, u32) {
        let read = |name| self.attached(glow::DEPTH_ATTACHMENT, name);
        let kind = read(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) as u32;
        (read(glow::FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE), kind)
    }

    /// A parameter of a level of the 2D texture that is bound.
    pub fn level(&self, level: i32, name: u32) -> i32 {
        // SAFETY: the context is current.
        unsafe { self.gl().get_tex_level_parameter_i32(glow::TEXTURE_2D, level, name) }
    }

    /// Gives a level of the 2D texture that is bound RGBA texels of 8 bits.
    pub fn upload(&self, level: i32, [width, height]: [i32; 2], texels: &[u8]) {
        let pixels = glow::PixelUnpackData::Slice(Some(texels));
        let (format, kind) = (glow::RGBA, glow::UNSIGNED_BYTE);
        // SAFETY: the context is current; the texels fill the rectangle.
        self.with_plain_pixels(|gl| unsafe {
            gl.tex_sub_image_2d(glow::TEXTURE_2D, level, 0, 0, width, height, format, kind, pixels);
        });
    }
}
