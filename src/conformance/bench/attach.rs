//! Attachments of framebuffers: levels, faces, layers and whole images, renderbuffers of one sample or several.

use std::rc::Rc;

use glow::HasContext;

use super::format::{Encoding, GlFormat};
use super::image::{GlImage, GlShape, level_size};
use super::surface::{Attached, Renderbuffer, Storage, Surface};
use super::{Bench, Error};

/// Part of an image's level that is attached, and the call that attaches it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlPart {
    /// glFramebufferTexture2D: a 2D image, or one face of a cube map.
    Face(u32),
    /// glFramebufferTextureLayer: of an array; of a cube map with OpenGL 4.5.
    Layer(u32),
    /// glFramebufferTexture: the whole level, all layers of it.
    All,
}

/// An image's level, to be attached.
#[derive(Clone, Copy)]
pub struct GlPlace<'a> {
    pub image: &'a Rc<GlImage>,
    pub level: u32,
    pub part: GlPart,
}

impl<'a> GlPlace<'a> {
    /// Level 0 of a 2D image.
    pub fn whole(image: &'a Rc<GlImage>) -> Self {
        Self { image, level: 0, part: GlPart::Face(0) }
    }
}

/// Points that a depth format is attached at.
fn depth_point(format: GlFormat) -> u32 {
    if format.has_stencil() { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT }
}

impl Bench {
    /// A framebuffer of new images; depth and stencil of one format.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] where the driver has no such image or framebuffer.
    pub fn surface(&self, size: [u32; 2], color: Option<GlFormat>, depth: Option<GlFormat>) -> Result<Surface, Error> {
        let image = |format: Option<GlFormat>| format.map(|format| self.image(format, size).map(Rc::new)).transpose();
        let (color, depth) = (image(color)?, image(depth)?);
        self.surface_at(color.as_ref().map(GlPlace::whole), depth.as_ref().map(GlPlace::whole))
    }

    /// A framebuffer of levels of images.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] where it is not complete.
    pub fn surface_at(&self, color: Option<GlPlace>, depth: Option<GlPlace>) -> Result<Surface, Error> {
        let size = color.or(depth).map_or([1; 2], |place| level_size(place.image.size, place.level));
        let attached = |place: GlPlace| Attached {
            storage: Storage::Image(place.image.clone()),
            format: place.image.format,
            encoding: place.image.encoding,
        };
        self.framebuffer(size, color.map(attached), depth.map(attached), [color, depth])
    }

    /// A framebuffer of renderbuffers, of one sample (0) or more.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] where the driver has no such renderbuffer or framebuffer.
    pub fn renderbuffers(
        &self,
        size: [u32; 2],
        color: Option<GlFormat>,
        depth: Option<GlFormat>,
        samples: u32,
    ) -> Result<Surface, Error> {
        let buffer =
            |format: Option<GlFormat>| format.map(|format| self.renderbuffer(size, format, samples)).transpose();
        let (color, depth) = (buffer(color)?, buffer(depth)?);
        self.framebuffer(size, color, depth, [None; 2])
    }

    fn renderbuffer(&self, [width, height]: [u32; 2], format: GlFormat, samples: u32) -> Result<Attached, Error> {
        let gl = &self.gl;
        self.take_errors();
        let (internal, ..) = format.codes();
        let [width, height, samples] = [width, height, samples].map(|number| number as i32);
        // SAFETY: the context is current; the renderbuffer deletes itself.
        let (buffer, bits) = unsafe {
            let name = gl.create_renderbuffer().map_err(super::no("renderbuffer"))?;
            let buffer = Renderbuffer { gl: gl.clone(), name };
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(name));
            if samples == 0 {
                gl.renderbuffer_storage(glow::RENDERBUFFER, internal, width, height);
            } else {
                gl.renderbuffer_storage_multisample(glow::RENDERBUFFER, samples, internal, width, height);
            }
            let of = |name| gl.get_renderbuffer_parameter_i32(glow::RENDERBUFFER, name).max(0) as u32;
            (buffer, [of(glow::RENDERBUFFER_DEPTH_SIZE), of(glow::RENDERBUFFER_STENCIL_SIZE)])
        };
        if let Some(reason) = self.take_errors() {
            return Err(Error::Refused { format: format.name(), reason });
        }
        let float = matches!(format, GlFormat::Depth32F | GlFormat::Depth32FStencil8);
        let encoding = Encoding { bits: bits[0], stencil_bits: bits[1], float };
        Ok(Attached { storage: Storage::Renderbuffer(buffer), format, encoding })
    }

    /// `places` of colour and depth say which part of an image is attached.
    fn framebuffer(
        &self,
        size: [u32; 2],
        color: Option<Attached>,
        depth: Option<Attached>,
        places: [Option<GlPlace>; 2],
    ) -> Result<Surface, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the attachments live as long as the surface.
        let (surface, status) = unsafe {
            let name = gl.create_framebuffer().map_err(super::no("framebuffer"))?;
            let surface = Surface { gl: gl.clone(), name, size, color, depth, others: Vec::new() };
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
            let point = surface.depth.as_ref().map_or(glow::DEPTH_ATTACHMENT, |depth| depth_point(depth.format));
            for ((attached, point), place) in
                [(&surface.color, glow::COLOR_ATTACHMENT0), (&surface.depth, point)].into_iter().zip(places)
            {
                match (attached.as_ref().map(|attached| &attached.storage), place) {
                    (Some(Storage::Renderbuffer(buffer)), _) => {
                        let name = Some(buffer.name);
                        gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, point, glow::RENDERBUFFER, name);
                    }
                    (Some(Storage::Image(_)), Some(place)) => attach(gl, point, place),
                    _ => {}
                }
            }
            let buffer = if surface.color.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::NONE };
            gl.draw_buffer(buffer);
            gl.read_buffer(buffer);
            (surface, gl.check_framebuffer_status(glow::FRAMEBUFFER))
        };
        let format = surface.depth.as_ref().or(surface.color.as_ref()).map_or("nothing", |of| of.format.name());
        self.check("a framebuffer")?;
        match status {
            glow::FRAMEBUFFER_COMPLETE => Ok(surface),
            glow::FRAMEBUFFER_UNSUPPORTED => {
                Err(Error::Refused { format, reason: "GL_FRAMEBUFFER_UNSUPPORTED".to_owned() })
            }
            status => Err(Error::Refused { format, reason: format!("framebuffer status {status:#06x}") }),
        }
    }

    /// Tests whether a separate depth texture and stencil renderbuffer make a complete framebuffer.
    ///
    /// # Errors
    ///
    /// GL's, but not that of a framebuffer that it does not support.
    pub fn separate_stencil_is_complete(&self) -> Result<bool, Error> {
        let surface = self.surface([4, 4], None, Some(GlFormat::Depth24))?;
        let gl = &self.gl;
        // SAFETY: the context is current; the renderbuffer is deleted here.
        let status = unsafe {
            let buffer = gl.create_renderbuffer().map_err(super::no("renderbuffer"))?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::STENCIL_INDEX8, 4, 4);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            let point = glow::STENCIL_ATTACHMENT;
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, point, glow::RENDERBUFFER, Some(buffer));
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            gl.delete_renderbuffer(buffer);
            status
        };
        self.check("a stencil buffer of its own")?;
        Ok(status == glow::FRAMEBUFFER_COMPLETE)
    }

    /// Status of a framebuffer of one or two colour attachments and depth, some of which GL must refuse.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn status_of(&self, colors: &[GlPlace], depth: Option<GlPlace>) -> Result<u32, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the framebuffer is deleted here.
        let status = unsafe {
            let name = gl.create_framebuffer().map_err(super::no("framebuffer"))?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
            for (point, place) in (glow::COLOR_ATTACHMENT0..).zip(colors) {
                attach(gl, point, *place);
            }
            if let Some(place) = depth {
                attach(gl, depth_point(place.image.format), place);
            }
            if colors.is_empty() {
                gl.draw_buffer(glow::NONE);
                gl.read_buffer(glow::NONE);
            }
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            gl.delete_framebuffer(name);
            status
        };
        self.check("a framebuffer's status")?;
        Ok(status)
    }
}

/// # Safety
///
/// The context is current, and a framebuffer is bound.
unsafe fn attach(gl: &glow::Context, point: u32, place: GlPlace) {
    let (name, level) = (Some(place.image.name), place.level as i32);
    // SAFETY: as the caller promises; the texture exists.
    unsafe {
        match place.part {
            GlPart::Face(layer) if place.image.shape != GlShape::Line => {
                let target = place.image.shape.place(layer);
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, target, name, level);
            }
            GlPart::Layer(layer) => {
                gl.framebuffer_texture_layer(glow::FRAMEBUFFER, point, name, level, layer as i32);
            }
            GlPart::Face(_) | GlPart::All => gl.framebuffer_texture(glow::FRAMEBUFFER, point, name, level),
        }
    }
}
