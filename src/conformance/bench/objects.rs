//! Calls one at a time on objects: copies and blits under the state that there is, a query that is begun again, a sampler
//! object made after another, levels made on any unit.

use glow::HasContext;

use super::{Bench, Error, GlCopyTo, GlImage, Surface, no};

impl Bench {
    /// Sets the scissor alone; `None` switches it off.
    pub fn scissor(&self, area: Option<[i32; 4]>) {
        // SAFETY: the context is current; only state is set.
        unsafe {
            match area {
                Some([x, y, width, height]) => {
                    self.gl.enable(glow::SCISSOR_TEST);
                    self.gl.scissor(x, y, width, height);
                }
                None => self.gl.disable(glow::SCISSOR_TEST),
            }
        }
    }

    /// glCopyTexSubImage2D from the framebuffer that is bound, under the state that there is.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn copy_as_it_is(&self, [x, y, width, height]: [i32; 4], to: GlCopyTo) -> Result<(), Error> {
        let (place, level) = (to.image.shape.place(to.layer), to.level as i32);
        // SAFETY: the context is current, and the image is not deleted. GL checks the rectangles.
        unsafe {
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(to.image.shape.target(), Some(to.image.name));
            self.gl.copy_tex_sub_image_2d(place, level, to.at[0], to.at[1], x, y, width, height);
        }
        self.check("a copy under the state that there is")
    }

    /// glBlitFramebuffer of all of one surface to another as large, under the state that there is.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn blit_as_it_is(&self, from: &Surface, to: &Surface, mask: u32) -> Result<(), Error> {
        let [width, height] = from.size.map(|side| side as i32);
        // SAFETY: the context is current; both framebuffers are not deleted.
        unsafe {
            self.gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from.name));
            self.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.name));
            self.gl.blit_framebuffer(0, 0, width, height, 0, 0, width, height, mask, glow::NEAREST);
        }
        self.check("a blit under the state that there is")
    }

    /// Results of one query object that is begun and ended `times` times around `work`, which has the turn's number.
    ///
    /// # Errors
    ///
    /// GL's, and those of `work`.
    pub fn samples_again(&self, times: u32, work: impl Fn(u32) -> Result<(), Error>) -> Result<Vec<u32>, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the query is deleted here.
        unsafe {
            let query = gl.create_query().map_err(no("query"))?;
            let mut counts = Vec::new();
            let mut worked = Ok(());
            for turn in 0..times {
                gl.begin_query(glow::SAMPLES_PASSED, query);
                worked = worked.and(work(turn));
                gl.end_query(glow::SAMPLES_PASSED);
                counts.push(gl.get_query_parameter_u32(query, glow::QUERY_RESULT));
            }
            gl.delete_query(query);
            worked?;
            self.check("a query that is begun again")?;
            Ok(counts)
        }
    }

    /// Parameters `names` of a sampler object that is made after another, to which `before` was given, is deleted.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn sampler_after(&self, before: &[(u32, u32)], names: &[u32]) -> Result<Vec<u32>, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; both objects are deleted here.
        unsafe {
            let first = gl.create_sampler().map_err(no("sampler object"))?;
            gl.bind_sampler(0, Some(first));
            for (name, value) in before {
                gl.sampler_parameter_i32(first, *name, *value as i32);
            }
            gl.bind_sampler(0, None);
            gl.delete_sampler(first);
            let second = gl.create_sampler().map_err(no("sampler object"))?;
            gl.bind_sampler(0, Some(second));
            let values = names.iter().map(|name| gl.get_sampler_parameter_i32(second, *name) as u32).collect();
            gl.bind_sampler(0, None);
            gl.delete_sampler(second);
            self.check("a sampler object after another")?;
            Ok(values)
        }
    }

    /// glGenerateMipmap of the image on unit 1, while `other` is on unit 0.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn generate_on_second_unit(&self, image: &GlImage, other: &GlImage) -> Result<(), Error> {
        let (gl, target) = (&self.gl, image.shape.target());
        // SAFETY: the context is current; the textures are not deleted.
        unsafe {
            gl.active_texture(glow::TEXTURE0);
            gl.bind_texture(target, Some(other.name));
            gl.active_texture(glow::TEXTURE1);
            gl.bind_texture(target, Some(image.name));
            gl.generate_mipmap(target);
            gl.bind_texture(target, None);
            gl.active_texture(glow::TEXTURE0);
        }
        self.check("glGenerateMipmap on unit 1")
    }
}
