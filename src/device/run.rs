//! Runs a pass list: first everything it needs is made and checked, then each pass is drawn in order.

use std::collections::{HashMap, HashSet, VecDeque};
use std::rc::Rc;
use std::time::Instant;

use glow::HasContext;

use super::image::{self, GpuImage, ImageName};
use super::state::{apply, set_mirrored};
use super::{Device, Error, framebuffer, mesh, mesh_key, program, unchanged};
use crate::pass::{
    Batch, Draw, DrawPass, DrawState, Format, ImageDesc, ImageId, Pass, PassList, Primitive, Redraw, Target,
    UniformValue, Work,
};

/// Way in which passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// No timing.
    No,
    /// Each pass by the wall clock, ended by glFinish, and by GL_TIME_ELAPSED if the driver has it. Waiting after each pass
    /// makes the frame as a whole slower.
    Passes,
    /// The fragments that pass each pass's depth test (GL_SAMPLES_PASSED); no times.
    Fragments,
}

/// The time of one pass in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// Label of the pass, as `glumbra plan` prints it.
    pub label: String,
    /// Time from its first call to the return of glFinish, in milliseconds.
    pub wall_ms: f64,
    /// GL_TIME_ELAPSED in milliseconds, where the driver counts it.
    pub gpu_ms: Option<f64>,
    /// GL_SAMPLES_PASSED, if requested.
    pub fragments: Option<u64>,
}

/// A pass that a target already holds.
pub struct Done {
    pub pass: Pass,
    /// GL's numbers of the images it read and wrote.
    pub objects: Vec<u32>,
}

impl Device {
    /// Draws the list's passes; returns the times of those that were drawn, if they were to be measured.
    ///
    /// # Errors
    ///
    /// A shader that does not compile, a uniform that is missing or unknown, an image that cannot be had, a target
    /// that cannot be drawn into, and any GL error, each with the pass's label.
    pub fn run(&mut self, list: &PassList, measure: Measure) -> Result<Vec<PassTime>, Error> {
        self.make_current()?;
        self.prepare(list)?;
        let mut times = Vec::new();
        // Images redrawn in this frame: passes that read or extend them must be redrawn too.
        let mut written = HashSet::new();
        for pass in &list.passes {
            let objects = self.objects(list, pass);
            let builds_on_new = pass.reads().into_iter().chain(pass.writes()).any(|image| written.contains(&image));
            let kept = pass.redraw == Redraw::WhenChanged && !builds_on_new;
            if kept && self.is_held(list, pass) {
                continue;
            }
            written.extend(pass.writes());
            times.extend(self.timed(list, pass, measure)?);
            if pass.redraw == Redraw::WhenChanged {
                self.done.insert(pass.label.clone(), Done { pass: pass.clone(), objects });
            }
        }
        Ok(times)
    }

    /// Tests whether the pass's target already holds what it would draw. The pass must be unchanged. So must all others
    /// that count in the same stencil buffer, because counts cannot be separated, and all that are copied through the same
    /// depth buffer, which holds only the last one.
    fn is_held(&self, list: &PassList, pass: &Pass) -> bool {
        let is_as_it_was = |pass: &Pass| unchanged(self.done.get(&pass.label), pass, &self.objects(list, pass));
        let buffer = pass.counts_in();
        let copied = copied_through(list, pass);
        let joins = |other: &&Pass| {
            let counts = buffer.is_some() && other.counts_in() == buffer;
            counts || (copied.is_some() && copied_through(list, other) == copied)
        };
        is_as_it_was(pass) && list.passes.iter().filter(joins).all(is_as_it_was)
    }

    fn timed(&mut self, list: &PassList, pass: &Pass, measure: Measure) -> Result<Option<PassTime>, Error> {
        match measure {
            Measure::No => {
                self.draw_pass(list, pass)?;
                return Ok(None);
            }
            Measure::Fragments => return self.counted(list, pass).map(Some),
            Measure::Passes => {}
        }
        self.finish();
        let start = Instant::now();
        if let Some(timer) = &mut self.timer {
            timer.begin();
        }
        let drawn = self.draw_pass(list, pass);
        if let Some(timer) = &mut self.timer {
            timer.end();
        }
        drawn?;
        self.finish();
        let wall_ms = start.elapsed().as_secs_f64() * 1e3;
        let gpu_ms = self.timer.as_mut().and_then(|timer| timer.wait()).map(|time| time.as_secs_f64() * 1e3);
        Ok(Some(PassTime { label: pass.label.clone(), wall_ms, gpu_ms, fragments: None }))
    }

    fn counted(&mut self, list: &PassList, pass: &Pass) -> Result<PassTime, Error> {
        // SAFETY: the context is current; the query is deleted whether or not the pass could be drawn.
        let query = unsafe { self.gl.create_query() }.map_err(Error::Create)?;
        unsafe { self.gl.begin_query(glow::SAMPLES_PASSED, query) };
        let drawn = self.draw_pass(list, pass);
        let count = unsafe {
            self.gl.end_query(glow::SAMPLES_PASSED);
            let count = self.gl.get_query_parameter_u32(query, glow::QUERY_RESULT);
            self.gl.delete_query(query);
            count
        };
        drawn?;
        let label = pass.label.clone();
        Ok(PassTime { label, wall_ms: 0.0, gpu_ms: None, fragments: Some(u64::from(count)) })
    }

    fn draw_pass(&mut self, list: &PassList, pass: &Pass) -> Result<(), Error> {
        match &pass.work {
            Work::Draw(draw) => self.draw(list, &pass.label, draw)?,
            Work::CopyDepth { .. } => self.copy_depth(list, pass)?,
        }
        self.check(&pass.label)
    }

    /// Makes images, programs and vertex arrays, and drops images and meshes that the list no longer uses.
    fn prepare(&mut self, list: &PassList) -> Result<(), Error> {
        self.make_images(list)?;
        self.meshes.retain(|_, mesh| !mesh.is_orphan());
        for pass in &list.passes {
            let Work::Draw(draw_pass) = &pass.work else { continue };
            for batch in &draw_pass.batches {
                self.make_program(&pass.label, batch)?;
                for draw in &batch.draws {
                    self.make_array(&pass.label, batch, draw)?;
                }
                for input in &batch.inputs {
                    if !self.samplers.contains_key(&input.sampler) {
                        let sampler = image::create_sampler(&self.gl, input.sampler)?;
                        self.samplers.insert(input.sampler, sampler);
                    }
                }
            }
        }
        if self.programs.end_round() {
            // GL may give the numbers of deleted programs to new ones.
            self.state = None;
        }
        Ok(())
    }

    pub(super) fn make_images(&mut self, list: &PassList) -> Result<(), Error> {
        type Alike = VecDeque<(ImageDesc, Rc<GpuImage>)>;
        let mut old: HashMap<(String, [u32; 2]), Alike> = HashMap::new();
        for (desc, image) in std::mem::take(&mut self.images) {
            old.entry((desc.label.clone(), desc.size)).or_default().push_back((desc, image));
        }
        let mut kept = HashSet::new();
        for desc in &list.images {
            let alike = old.get_mut(&(desc.label.clone(), desc.size));
            let found = alike.and_then(|alike| alike.remove(alike.iter().position(|(have, _)| have == desc)?));
            let image = match found {
                Some((_, image)) => {
                    kept.insert(image.name.number());
                    image
                }
                None => Rc::new(image::create(&self.gl, desc)?),
            };
            self.images.push((desc.clone(), image));
        }
        if old.values().any(|alike| !alike.is_empty()) || kept.len() != self.images.len() {
            // GL may give the numbers of deleted images to new ones: forget what was known of them.
            self.done.retain(|_, done| done.objects.iter().all(|number| kept.contains(number)));
            self.framebuffers.clear();
        }
        Ok(())
    }

    fn make_program(&mut self, pass: &str, batch: &Batch) -> Result<(), Error> {
        if let Some(known) = self.programs.touch(&batch.program) {
            return known.check(pass, batch);
        }
        let linked = program::create(&self.gl, &batch.program)?;
        linked.check(pass, batch)?;
        self.programs.insert(batch.program.clone(), linked);
        Ok(())
    }

    fn make_array(&mut self, pass: &str, batch: &Batch, draw: &Draw) -> Result<(), Error> {
        let wanted = (batch.program.attributes.clone(), draw.order);
        let gl = &self.gl;
        let gpu = self.meshes.entry(mesh_key(&draw.mesh.0)).or_insert_with(|| mesh::GpuMesh::new(gl, &draw.mesh.0));
        gpu.prepare(&wanted)?.map_err(|attribute| Error::MissingAttribute {
            pass: pass.to_owned(),
            program: batch.program.label.clone(),
            name: attribute.name(),
            mesh: draw.mesh.name.clone(),
        })
    }

    pub(super) fn gpu_image(&self, id: ImageId) -> ImageName {
        self.images[id.0].1.name
    }

    fn objects(&self, list: &PassList, pass: &Pass) -> Vec<u32> {
        debug_assert_eq!(list.images.len(), self.images.len());
        let images = pass.reads().into_iter().chain(pass.writes());
        images.map(|id| self.gpu_image(id).number()).collect()
    }

    /// Binds the target's framebuffer for drawing and reading.
    pub(super) fn bind_target(&mut self, list: &PassList, label: &str, target: Target) -> Result<(), Error> {
        let name = |id: Option<ImageId>| id.map(|id| self.gpu_image(id));
        let (color, depth) = (name(target.color), name(target.depth));
        let key = (target, color.iter().chain(&depth).map(|image| image.number()).collect());
        if let Some(framebuffer) = self.framebuffers.get(&key) {
            unsafe { self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer.name)) };
            return Ok(());
        }
        let describe = || {
            let labels = target.color.iter().chain(&target.depth).map(|id| list.desc(*id));
            let labels = labels.map(|desc| format!("{} ({})", desc.label, desc.format));
            (label.to_owned(), labels.collect::<Vec<_>>().join(" + "))
        };
        let point = |id| match list.desc(id).format {
            Format::Depth24Stencil8 => glow::DEPTH_STENCIL_ATTACHMENT,
            _ => glow::DEPTH_ATTACHMENT,
        };
        let depth = depth.zip(target.depth.map(point));
        let framebuffer = framebuffer::create(&self.gl, color, depth, target, describe)?;
        self.framebuffers.insert(key, framebuffer);
        Ok(())
    }

    fn draw(&mut self, list: &PassList, label: &str, pass: &DrawPass) -> Result<(), Error> {
        self.begin_pass(list, label, pass)?;
        for batch in &pass.batches {
            self.draw_batch(&pass.state, batch);
        }
        unsafe { self.gl.bind_vertex_array(None) };
        Ok(())
    }

    /// Binds and clears the target under the pass's state.
    pub(super) fn begin_pass(&mut self, list: &PassList, label: &str, pass: &DrawPass) -> Result<(), Error> {
        check_feedback(list, label, pass)?;
        self.bind_target(list, label, pass.target)?;
        let [width, height] = pass.viewport.map(|side| side as i32);
        unsafe { self.gl.viewport(0, 0, width, height) };
        apply(&self.gl, &pass.state, &mut self.state);
        self.clear(pass);
        Ok(())
    }

    /// Clears the whole target: every channel of its colour; depth through the pass's write mask, which must be open.
    fn clear(&self, pass: &DrawPass) {
        unsafe {
            self.gl.disable(glow::SCISSOR_TEST);
            if let Some(color) = pass.clear.color {
                self.gl.color_mask(true, true, true, true);
                self.gl.clear_buffer_f32_slice(glow::COLOR, 0, &color);
                let [red, green, blue, alpha] = pass.state.color_write.mask();
                self.gl.color_mask(red, green, blue, alpha);
            }
            if let Some(depth) = pass.clear.depth {
                self.gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]);
            }
            if let Some(stencil) = pass.clear.stencil {
                // The whole stencil value, however few bits the draws write.
                self.gl.stencil_mask(0xFF);
                self.gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[i32::from(stencil)]);
                self.gl.stencil_mask(pass.state.stencil.map_or(0xFF, |stencil| u32::from(stencil.write_mask)));
            }
            if pass.state.scissor.is_some() {
                self.gl.enable(glow::SCISSOR_TEST);
            }
        }
    }

    fn draw_batch(&mut self, state: &DrawState, batch: &Batch) {
        let Some(program) = self.programs.get(&batch.program) else { return };
        apply(&self.gl, &batch.state(state), &mut self.state);
        unsafe { self.gl.use_program(Some(program.name)) };
        for (unit, input) in (0..).zip(&batch.inputs) {
            let image = self.gpu_image(input.image);
            let Some(texture) = image.texture() else { continue };
            let sampler = self.samplers.get(&input.sampler).map(|sampler| sampler.name);
            unsafe {
                self.gl.active_texture(glow::TEXTURE0 + unit);
                self.gl.bind_texture(image.binding(), Some(texture));
                self.gl.bind_sampler(unit, sampler);
                self.gl.uniform_1_i32(program.sampler(&input.name), unit as i32);
            }
        }
        batch.uniforms.iter().for_each(|uniform| program.set(uniform));
        for draw in &batch.draws {
            let clip_from_model = UniformValue::Mat4(draw.clip_from_model.as_mat4());
            program.set_value("clip_from_model", &clip_from_model);
            draw.uniforms.iter().for_each(|uniform| program.set(uniform));
            set_mirrored(&self.gl, draw.mirrored, &mut self.state);
            let wanted = (batch.program.attributes.clone(), draw.order);
            let array = self.meshes.get(&mesh_key(&draw.mesh.0)).and_then(|mesh| mesh.array(&wanted));
            let mode = match draw.primitive {
                Primitive::Triangles => glow::TRIANGLES,
                Primitive::Lines => glow::LINES,
            };
            let count = draw.indices.end - draw.indices.start;
            unsafe {
                self.gl.bind_vertex_array(array);
                self.gl.draw_elements(mode, count as i32, glow::UNSIGNED_INT, 4 * draw.indices.start as i32);
            }
        }
    }

    pub(super) fn copy_depth(&mut self, list: &PassList, pass: &Pass) -> Result<(), Error> {
        let Work::CopyDepth { from, to, face } = pass.work else { return Ok(()) };
        let Some(texture) = self.gpu_image(to).texture() else { return Ok(()) };
        let binding = self.gpu_image(to).binding();
        let place = face.map_or(binding, image::face_code);
        self.bind_target(list, &pass.label, Target { color: None, depth: Some(from), level: 0, face: None })?;
        let [width, height] = list.desc(to).size.map(|side| side as i32);
        unsafe {
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(binding, Some(texture));
            self.gl.copy_tex_sub_image_2d(place, 0, 0, 0, 0, 0, width, height);
            self.gl.bind_texture(binding, None);
        }
        Ok(())
    }
}

/// An image that a pass both samples and draws into has undefined values.
fn check_feedback(list: &PassList, label: &str, pass: &DrawPass) -> Result<(), Error> {
    let attached = [pass.target.color, pass.target.depth];
    let mut inputs = pass.batches.iter().flat_map(|batch| batch.inputs.iter());
    match inputs.find(|input| attached.contains(&Some(input.image))) {
        Some(input) => Err(Error::Feedback { pass: label.to_owned(), image: list.desc(input.image).label.clone() }),
        None => Ok(()),
    }
}

/// The depth buffer that the pass copies, or draws for a copy.
fn copied_through(list: &PassList, pass: &Pass) -> Option<ImageId> {
    let source = |pass: &Pass| match pass.work {
        Work::CopyDepth { from, .. } => Some(from),
        Work::Draw(_) => None,
    };
    source(pass).or_else(|| list.passes.iter().filter_map(source).find(|image| pass.writes().contains(image)))
}
