//! The floor of pictures that come in three passes: a slide projector's, and shadows in destination alpha
//! [Segal 1992, 3.1 and 3.3].

use glow::HasContext;

use super::Result;
use super::floor_gl::Program;
use super::kinds::Kind;

/// One pass over all that there is, into the picture. The first clears it and writes depth; the others meet that by EQUAL.
pub struct PicturePass {
    pub program: Program,
    blend: Option<[u32; 2]>,
    mask: [bool; 4],
}

const ALL: [bool; 4] = [true; 4];
const RGB: [bool; 4] = [true, true, true, false];
const ALPHA: [bool; 4] = [false, false, false, true];

/// The passes of `kind`; none where one pass draws the picture.
pub fn make(gl: &glow::Context, kind: Kind) -> Result<Vec<PicturePass>> {
    let pass = |define: &str, blend, mask| -> Result<PicturePass> {
        let defines = format!("#define {define}\n");
        let program = Program::new(gl, &defines, include_str!("lit.vert"), include_str!("passes.frag"))?;
        Ok(PicturePass { program, blend, mask })
    };
    match kind {
        Kind::Slide => Ok(vec![
            pass("AMBIENT", None, ALL)?,
            pass("SLIDE", Some([glow::ONE, glow::ONE]), RGB)?,
            pass("OWN", Some([glow::DST_COLOR, glow::ZERO]), RGB)?,
        ]),
        Kind::AlphaShadow => Ok(vec![
            pass("AMBIENT_OWN", None, ALL)?,
            pass("SHADE", None, ALPHA)?,
            pass("LIGHT", Some([glow::DST_ALPHA, glow::ONE]), RGB)?,
        ]),
        _ => Ok(Vec::new()),
    }
}

impl PicturePass {
    /// Sets its state; `first`: it writes depth.
    pub fn begin(&self, gl: &glow::Context, first: bool) {
        let [red, green, blue, alpha] = self.mask;
        unsafe {
            gl.use_program(Some(self.program.name));
            gl.depth_func(if first { glow::LESS } else { glow::EQUAL });
            gl.depth_mask(first);
            gl.color_mask(red, green, blue, alpha);
            match self.blend {
                Some([source, stored]) => {
                    gl.enable(glow::BLEND);
                    gl.blend_func(source, stored);
                }
                None => gl.disable(glow::BLEND),
            }
        }
    }
}

/// Leaves the state as a single pass has it.
pub fn end(gl: &glow::Context) {
    unsafe {
        gl.depth_func(glow::LESS);
        gl.depth_mask(true);
        gl.color_mask(true, true, true, true);
        gl.disable(glow::BLEND);
    }
}
