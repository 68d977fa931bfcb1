//! Effects of a draw: it reads the state that is in force, the textures that its shaders sample, its vertices.

use super::effects::Tracker;
use super::state::{Effects, Key};
use crate::context::compatibility::raw;

const TARGETS: [(u32, &[&str]); 5] = [
    (glow::TEXTURE_1D, &["sampler1D", "sampler1DShadow"]),
    (glow::TEXTURE_2D, &["sampler2D", "sampler2DShadow", "usampler2D", "isampler2D"]),
    (glow::TEXTURE_CUBE_MAP, &["samplerCube", "samplerCubeShadow"]),
    (glow::TEXTURE_2D_ARRAY, &["sampler2DArray", "sampler2DArrayShadow", "usampler2DArray"]),
    (glow::TEXTURE_CUBE_MAP_ARRAY, &["samplerCubeArray", "samplerCubeArrayShadow"]),
];

impl Tracker {
    /// Tests whether triangles are filled where the positions say that are given as attribute 0, four floats of eight.
    pub fn is_plain(&self) -> bool {
        let program = self.state.number("Program") as usize;
        let source = self.texts.get(&program).map_or("", String::as_str);
        let array = self.vertex_array();
        let is_filled =
            ["PolygonMode:front", "PolygonMode:back"].iter().all(|key| self.state.number(key) == f64::from(glow::FILL));
        let layout = self.state.numbers(&format!("attr:{array}:0"));
        // Index, size, type, normalised, stride, offset.
        let is_given = layout.get(1) == Some(&4.0) && layout.get(4) == Some(&32.0) && layout.get(5) == Some(&0.0);
        let is_one = source.matches("gl_Position").count() == 1 && source.contains("gl_Position = position;");
        is_filled && is_given && is_one && self.query.is_none()
    }

    /// All that sampling a texture by a unit reads.
    pub(super) fn sampled(&self, unit: u32, target: u32) -> Vec<Key> {
        let texture = self.bound(unit, target);
        let mut reads = vec![format!("tex:{unit}:{target:04X}")];
        if texture == 0 {
            return reads;
        }
        reads.extend(self.contents.get(&format!("img:{texture}")).into_iter().flatten().cloned());
        let sampler = self.state.number(&format!("sampler:{unit}")) as usize;
        reads.push(format!("sampler:{unit}"));
        if sampler > 0 {
            reads.extend(self.state.keys(&format!("sampar:{sampler}:")).cloned());
        }
        // Parameters of sampling are the sampler object's, if there is one [GL 4.6, 8.2].
        const BY_SAMPLER: [&str; 10] = ["2800", "2801", "2802", "2803", "8072", "813A", "813B", "884C", "884D", "1004"];
        let prefix = format!("texpar:{texture}:");
        let is_read = |key: &&Key| sampler == 0 || !BY_SAMPLER.iter().any(|name| key.ends_with(&format!(":{name}")));
        reads.extend(self.state.keys(&prefix).filter(is_read).cloned());
        reads
    }

    /// A draw: by the vertex array, or by what came since glBegin.
    pub(super) fn draw(&mut self, is_immediate: bool) -> Effects {
        let state = &self.state;
        let mut reads = self.attached("DrawFramebuffer");
        reads.extend(self.scissor_keys());
        reads.push("glViewport".into());
        reads.extend(state.keys("PolygonMode:").cloned());
        reads.extend([
            "glColorMask".into(),
            "DepthRange".into(),
            "glProvokingVertex".into(),
            "glPrimitiveRestartIndex".into(),
        ]);
        reads.extend(state.keys("glHint:").chain(state.keys("glClampColor:")).cloned());
        let writes_color = state.numbers("glColorMask").iter().any(|on| *on != 0.0)
            && self.drawn("DrawFramebuffer", &["color"]).iter().any(|_| true);
        let is_color_cap = |key: &Key| ["cap:0BE2", "cap:0BD0", "cap:8DB9"].iter().any(|cap| key.starts_with(cap));
        reads.extend(state.keys("cap:").filter(|key| writes_color || !is_color_cap(key)).cloned());
        let mut writes = Vec::new();
        if writes_color {
            writes.extend(self.drawn("DrawFramebuffer", &["color"]));
            if state.is_on(glow::BLEND) {
                reads.extend(["BlendFunc".into(), "BlendEquation".into(), "glBlendColor".into()]);
            }
        }
        if state.is_on(glow::DEPTH_TEST) {
            reads.extend(["glDepthFunc".into(), "glDepthMask".into()]);
            if !matches!(state.number("glDepthFunc") as u32, glow::ALWAYS | glow::NEVER) {
                reads.extend(self.drawn_and_given("DrawFramebuffer", &["depth"]));
            }
            if state.number("glDepthMask") != 0.0 {
                writes.extend(self.drawn("DrawFramebuffer", &["depth"]));
            }
        }
        let has_stencil = state.is_on(glow::STENCIL_TEST);
        if has_stencil {
            for head in ["StencilFunc:", "StencilOp:", "StencilMask:"] {
                reads.extend(state.keys(head).cloned());
            }
            reads.extend(self.drawn_and_given("DrawFramebuffer", &["stencil"]));
            writes.extend(self.drawn("DrawFramebuffer", &["stencil"]));
        }
        let is_on = |caps: &[u32]| caps.iter().any(|cap| state.is_on(*cap));
        if is_on(&[glow::POLYGON_OFFSET_FILL, glow::POLYGON_OFFSET_LINE, glow::POLYGON_OFFSET_POINT]) {
            reads.push("PolygonOffset".into());
        }
        if state.is_on(glow::CULL_FACE) {
            reads.push("glCullFace".into());
        }
        if is_on(&[raw::ALPHA_TEST]) {
            reads.push("glAlphaFunc".into());
        }
        reads.extend(["glLineWidth".into(), "glPointSize".into()]);
        let program = state.number("Program") as usize;
        let source = self.texts.get(&program).map_or("", String::as_str);
        let has_faces = source.contains("gl_FrontFacing") || program == 0;
        let sides = |head: &str| state.get(&format!("{head}:front")) != state.get(&format!("{head}:back"));
        let is_sided = has_stencil && ["StencilFunc", "StencilOp", "StencilMask"].iter().any(|head| sides(head));
        if has_faces || is_sided || state.is_on(glow::CULL_FACE) || sides("PolygonMode") {
            reads.push("glFrontFace".into());
        }
        reads.push("Program".into());
        if program > 0 {
            reads.push(format!("linked:{program}"));
            reads.extend(state.keys(&format!("uni:{program}:")).cloned());
            for (name, target) in samplers(source) {
                let unit = glow::TEXTURE0 + state.number(&format!("uni:{program}:{name}")) as u32;
                reads.extend(self.sampled(unit, target));
            }
        }
        if program == 0 || is_old(source) {
            for head in ["matrix:", "texenv:", "texgen:", "light:", "fixed:", "material:", "glShadeModel", "unitcap:"] {
                reads.extend(state.keys(head).cloned());
            }
            for unit in (0..8).map(|unit| glow::TEXTURE0 + unit) {
                for (target, _) in TARGETS {
                    if state.number(&format!("unitcap:{target:04X}:{unit}")) != 0.0 {
                        reads.extend(self.sampled(unit, target));
                    }
                }
            }
        }
        if is_immediate {
            reads.push("stream".into());
        } else {
            let array = self.vertex_array();
            reads.push("VertexArray".into());
            for (index, buffer) in
                self.buffers.range((array, 0)..=(array, u32::MAX)).map(|((_, index), buffer)| (index, buffer))
            {
                reads.push(format!("attron:{array}:{index}"));
                if state.number(&format!("attron:{array}:{index}")) != 0.0 {
                    let [layout, divisor] = ["attr", "attrdiv"].map(|head| format!("{head}:{array}:{index}"));
                    reads.extend([layout, divisor, format!("buf:{buffer}")]);
                }
            }
            let elements = format!("ElementBuffer:{array}");
            reads.push(format!("buf:{}", state.number(&elements)));
            reads.push(elements);
        }
        writes.extend(self.query.map(|_| "counted".to_owned()));
        Effects::change(writes, reads)
    }
}

/// Tests whether a shader may read the fixed-function pipeline's state.
fn is_old(source: &str) -> bool {
    !["#version 13", "#version 14", "#version 15", "#version 3", "#version 4"].iter().any(|line| source.contains(line))
}

/// Samplers that a shader declares and uses.
fn samplers(source: &str) -> Vec<(String, u32)> {
    let words: Vec<&str> = source
        .split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_')
        .filter(|word| !word.is_empty())
        .collect();
    let mut found = Vec::new();
    for pair in words.windows(2) {
        let target = TARGETS.iter().find(|(_, names)| names.contains(&pair[0]));
        if let Some((target, _)) = target
            && words.iter().filter(|word| **word == pair[1]).count() > 1
        {
            found.push((pair[1].to_owned(), *target));
        }
    }
    found
}
