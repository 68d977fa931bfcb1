//! A pass list as the OpenGL calls of the documents, in C that compiles: for `glumbra plan --gl`. Calls no GL.
//!
//! A list that the fixed-function pipeline can draw is listed as [`super::FixedFunction`] draws it. Any other is listed
//! as the device draws it, by shaders; the lights' eye planes are still given to glTexGen, and read back from it.

mod c;
mod fixed;
mod objects;
mod shader;
mod state;

use self::c::{Text, comment};
use self::objects::Objects;
use self::state::ListingState;
use super::{check_state, names, reading};
use crate::pass::{CubeFace, Draw, DrawPass, ImageId, PassList, Primitive, Redraw, Target, Work};

/// The list in C99: `create` makes its images, `frame` draws its passes.
pub fn c_source(list: &PassList) -> String {
    let refused = refusals(list);
    let mut listing = Listing { list, fixed: refused.is_empty(), objects: Objects::default(), body: Text::default() };
    for (number, pass) in list.passes.iter().enumerate() {
        let when = match pass.redraw {
            Redraw::Always => "in every frame",
            Redraw::WhenChanged => "in the first frame, and when something in it changes",
        };
        listing.body.line(&format!("\n/* {}. {}: {when} */", number + 1, comment(&pass.label)));
        listing.body.line(&format!("static void pass_{}(void)\n{{", number + 1));
        match &pass.work {
            Work::Draw(draw) => listing.draw_pass(draw),
            Work::CopyDepth { from, to, face } => listing.copy(from.0, to.0, *face),
        }
        listing.body.line("}");
    }
    let Listing { mut objects, body, .. } = listing;
    let mut out = Text::default();
    out.line(PROLOGUE);
    out.line(if refused.is_empty() {
        "/* Drawn by the fixed-function pipeline. */"
    } else {
        "/* Drawn by shaders, because the fixed-function pipeline cannot draw all of it:"
    });
    refused.iter().for_each(|why| out.line(&format!("   - {}", comment(why))));
    if !refused.is_empty() {
        out.line("*/");
    }
    objects.write(list, &mut out);
    out.0.push_str(&body.0);
    out.line("\nvoid frame(void)\n{");
    (1..=list.passes.len()).for_each(|number| out.call(&format!("pass_{number}()")));
    out.line("}");
    out.0
}

const PROLOGUE: &str =
    "/* Written by glumbra plan --gl. C99, for a context of OpenGL 3.3 or later in the compatibility profile:
   call create() once, then frame(). */
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <stddef.h>
";

/// Reasons why the fixed-function pipeline cannot draw the list, each once.
fn refusals(list: &PassList) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for pass in &list.passes {
        let Work::Draw(draw) = &pass.work else { continue };
        for batch in &draw.batches {
            let layers = check_state(list, draw, batch).and_then(|()| reading::layers(batch, draw.state.blend));
            let text = layers.err().map(|why| format!("\"{}\", {}: {why}", pass.label, names(batch)));
            found.extend(text.filter(|text| !found.contains(text)));
        }
    }
    found
}

/// The passes as they are written.
struct Listing<'a> {
    list: &'a PassList,
    /// By the fixed-function pipeline, else by shaders.
    fixed: bool,
    objects: Objects<'a>,
    body: Text,
}

impl<'a> Listing<'a> {
    fn draw_pass(&mut self, pass: &'a DrawPass) {
        let framebuffer = self.objects.framebuffer(pass.target);
        let [width, height] = pass.viewport;
        self.body.call(&format!("glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[{framebuffer}])"));
        self.body.call(&format!("glViewport(0, 0, {width}, {height})"));
        state::clear(&mut self.body, &pass.clear);
        let mut now = ListingState::of(pass.state);
        state::set(&mut self.body, None, &now.state);
        let is_seamless = |pass: &crate::pass::Pass| !matches!(&pass.work, Work::Draw(draw) if !draw.state.seamless);
        if !self.list.passes.iter().all(is_seamless) {
            self.body.enable("GL_TEXTURE_CUBE_MAP_SEAMLESS", now.state.seamless);
        }
        for batch in &pass.batches {
            match self.fixed {
                true => self.fixed_batch(pass, batch, &mut now),
                false => self.shader_batch(pass, batch, &mut now),
            }
        }
        if now.mirrored {
            self.body.call("glFrontFace(GL_CCW)");
        }
    }

    /// Sets the parts that differ from the state so far.
    fn change(&mut self, now: &mut ListingState, next: ListingState) {
        state::set(&mut self.body, Some(&now.state), &next.state);
        *now = ListingState { mirrored: now.mirrored, ..next };
    }

    fn mirror(&mut self, now: &mut ListingState, mirrored: bool) {
        if now.mirrored != mirrored {
            self.body.call(if mirrored { "glFrontFace(GL_CW)" } else { "glFrontFace(GL_CCW)" });
            now.mirrored = mirrored;
        }
    }

    fn bind_mesh(&mut self, draw: &'a Draw) -> usize {
        let mesh = self.objects.mesh(&draw.mesh, draw.order);
        self.body.call(&format!("bind_mesh({mesh})"));
        mesh
    }

    fn draw_elements(&mut self, draw: &Draw) {
        let mode = match draw.primitive {
            Primitive::Triangles => "GL_TRIANGLES",
            Primitive::Lines => "GL_LINES",
        };
        let (count, first) = (draw.indices.end - draw.indices.start, 4 * u64::from(draw.indices.start));
        self.body.call(&format!("glDrawElements({mode}, {count}, GL_UNSIGNED_INT, (const void *){first})"));
    }

    fn title(&mut self, text: &str) {
        self.body.line(&format!("\n    /* {} */", comment(text)));
    }

    fn copy(&mut self, from: usize, to: usize, face: Option<CubeFace>) {
        let source = Target { color: None, depth: Some(ImageId(from)), level: 0, face: None };
        let framebuffer = self.objects.framebuffer(source);
        let binding = c::binding(&self.list.images[to].storage);
        let target = face.map_or(binding, c::face_name);
        let [width, height] = self.list.images[to].size;
        self.body.call(&format!("glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[{framebuffer}])"));
        self.body.call("glActiveTexture(GL_TEXTURE0)");
        self.body.call(&format!("glBindTexture({binding}, images[{to}])"));
        self.body.call(&format!("glCopyTexSubImage2D({target}, 0, 0, 0, 0, 0, {width}, {height})"));
        self.body.call(&format!("glBindTexture({binding}, 0)"));
    }
}
