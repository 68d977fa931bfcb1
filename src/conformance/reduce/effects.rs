//! What each call of GL writes and reads, by the specification: of the state, of objects, of pixels. Where that is in doubt it
//! reads too much rather than too little: then a call stays that might have gone.

use std::collections::{BTreeMap, BTreeSet};

use super::log::{Argument, Recorded};
use super::meaning::Kind;
use super::state::{Effects, Key, State, faces, text};
use crate::context::compatibility::raw;

/// An image's part that is attached to a framebuffer.
#[derive(Clone, Debug, Default, PartialEq)]
struct Attachment {
    /// Key of the texture or renderbuffer: `img:3`, `rb:1`.
    image: String,
    /// Its part: `DE1:0`.
    part: String,
    /// All that is drawn is in this part alone.
    is_flat: bool,
}

/// State and objects so far.
#[derive(Default)]
pub struct Tracker {
    pub state: State,
    attachments: BTreeMap<(usize, u32), Attachment>,
    /// Keys of what images were given or drawn, by image.
    contents: BTreeMap<String, BTreeSet<Key>>,
    sizes: BTreeMap<String, [i32; 2]>,
    /// Sources of a shader, and of a program.
    sources: BTreeMap<usize, String>,
    texts: BTreeMap<usize, String>,
    /// Program and name of a uniform's location.
    locations: BTreeMap<usize, (usize, String)>,
    /// Buffers of a vertex array's attributes.
    buffers: BTreeMap<(usize, u32), usize>,
    query: Option<usize>,
    serial: usize,
}

fn object(call: &Recorded, index: usize) -> usize {
    match call.arguments.get(index) {
        Some(Argument::Object(_, number) | Argument::Location(number)) => *number,
        _ => 0,
    }
}

fn made(kind: Kind, number: usize) -> Key {
    format!("obj:{}:{number}", kind.word())
}

/// The binding target of a texture's part: a face's is the cube map.
fn binding(target: u32) -> u32 {
    if (glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z).contains(&target) {
        glow::TEXTURE_CUBE_MAP
    } else {
        target
    }
}

const TARGETS: [(u32, &[&str]); 5] = [
    (glow::TEXTURE_1D, &["sampler1D", "sampler1DShadow"]),
    (glow::TEXTURE_2D, &["sampler2D", "sampler2DShadow", "usampler2D", "isampler2D"]),
    (glow::TEXTURE_CUBE_MAP, &["samplerCube", "samplerCubeShadow"]),
    (glow::TEXTURE_2D_ARRAY, &["sampler2DArray", "sampler2DArrayShadow", "usampler2DArray"]),
    (glow::TEXTURE_CUBE_MAP_ARRAY, &["samplerCubeArray", "samplerCubeArrayShadow"]),
];

impl Tracker {
    fn unit(&self) -> u32 {
        self.state.number("ActiveTexture") as u32
    }

    fn bound(&self, unit: u32, target: u32) -> usize {
        self.state.number(&format!("tex:{unit}:{target:04X}")) as usize
    }

    fn framebuffer(&self, which: &str) -> usize {
        self.state.number(which) as usize
    }

    fn vertex_array(&self) -> usize {
        self.state.number("VertexArray") as usize
    }

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

    /// Effects of a call, which is then in force.
    pub fn follow(&mut self, call: &Recorded) -> Effects {
        self.serial += 1;
        let effects = self.effects(call);
        self.state.put(&effects.sets);
        for key in &effects.writes {
            if let Some((image, _)) = key.split_once('/') {
                self.contents.entry(image.to_owned()).or_default().insert(key.clone());
            }
        }
        effects
    }

    fn effects(&mut self, call: &Recorded) -> Effects {
        let numbers = call.numbers();
        let all = text(&numbers);
        let rest = |from: usize| text(&numbers[from.min(numbers.len())..]);
        let one = |key: String, value: String| Effects::set(vec![(key, value)], Vec::new());
        let unit = self.unit();
        match call.name {
            "glEnable" | "glDisable" => {
                let value = if call.name == "glEnable" { "1" } else { "0" };
                let is_unit_s = matches!(
                    call.u(0),
                    glow::TEXTURE_1D | glow::TEXTURE_2D | glow::TEXTURE_CUBE_MAP | raw::TEXTURE_GEN_S
                        ..=raw::TEXTURE_GEN_Q
                );
                let (place, reads) =
                    if is_unit_s { (format!(":{unit}"), vec!["ActiveTexture".to_owned()]) } else { Default::default() };
                Effects::set(
                    vec![(
                        format!("{}:{:04X}{place}", if is_unit_s { "unitcap" } else { "cap" }, call.u(0)),
                        value.to_owned(),
                    )],
                    reads,
                )
            }
            "glDepthRange" | "glDepthRangef" => one("DepthRange".into(), all),
            "glClearDepth" | "glClearDepthf" => one("ClearDepth".into(), all),
            "glPolygonOffset" => one("PolygonOffset".into(), format!("{all},0")),
            "glPolygonOffsetClamp" | "glPolygonOffsetClampEXT" => one("PolygonOffset".into(), all),
            "glStencilFunc" | "glStencilMask" | "glStencilOp" => {
                let head = call.name.trim_start_matches("gl");
                let sides = ["front", "back"].map(|side| (format!("{head}:{side}"), all.clone()));
                Effects::set(sides.to_vec(), Vec::new())
            }
            "glStencilFuncSeparate" | "glStencilMaskSeparate" | "glStencilOpSeparate" => {
                let head = call.name.trim_start_matches("gl").trim_end_matches("Separate");
                Effects::set(faces(call, head, &rest(1)), Vec::new())
            }
            "glPolygonMode" => Effects::set(faces(call, "PolygonMode", &rest(1)), Vec::new()),
            "glBlendFunc" => one("BlendFunc".into(), format!("{all},{all}")),
            "glBlendFuncSeparate" => one("BlendFunc".into(), all),
            "glBlendEquation" => one("BlendEquation".into(), format!("{all},{all}")),
            "glBlendEquationSeparate" => one("BlendEquation".into(), all),
            "glDepthFunc" | "glDepthMask" | "glCullFace" | "glFrontFace" | "glLineWidth" | "glPointSize"
            | "glClearColor" | "glClearStencil" | "glScissor" | "glViewport" | "glBlendColor" | "glColorMask"
            | "glAlphaFunc" | "glShadeModel" | "glProvokingVertex" | "glClearAccum" => one(call.name.into(), all),
            "glPixelStorei" | "glPixelTransferf" | "glHint" | "glClampColor" => {
                one(format!("{}:{:04X}", call.name, call.u(0)), rest(1))
            }
            "glActiveTexture" => one("ActiveTexture".into(), all),
            "glBindTexture" => Effects::set(
                vec![(format!("tex:{unit}:{:04X}", call.u(0)), rest(1))],
                vec!["ActiveTexture".into(), made(Kind::Texture, object(call, 1))],
            ),
            "glBindSampler" => Effects::set(
                vec![(format!("sampler:{}", glow::TEXTURE0 + call.u(0)), rest(1))],
                vec![made(Kind::Sampler, object(call, 1))],
            ),
            "glUseProgram" => Effects::set(vec![("Program".into(), all)], vec![format!("linked:{}", object(call, 0))]),
            "glBindVertexArray" => {
                Effects::set(vec![("VertexArray".into(), all)], vec![made(Kind::VertexArray, object(call, 0))])
            }
            "glBindBuffer" => {
                let (key, mut reads) = self.buffer_binding(call.u(0));
                reads.retain(|read| *read != key);
                reads.push(made(Kind::Buffer, object(call, 1)));
                Effects::set(vec![(key, rest(1))], reads)
            }
            "glBindFramebuffer" => {
                let keys: &[&str] = match call.u(0) {
                    glow::DRAW_FRAMEBUFFER => &["DrawFramebuffer"],
                    glow::READ_FRAMEBUFFER => &["ReadFramebuffer"],
                    _ => &["DrawFramebuffer", "ReadFramebuffer"],
                };
                let sets = keys.iter().map(|key| ((*key).to_owned(), rest(1))).collect();
                Effects::set(sets, vec![made(Kind::Framebuffer, object(call, 1))])
            }
            "glBindRenderbuffer" => {
                Effects::set(vec![("Renderbuffer".into(), rest(1))], vec![made(Kind::Renderbuffer, object(call, 1))])
            }
            "glDrawBuffer" | "glDrawBuffers" | "glReadBuffer" => {
                let (which, end) =
                    if call.name == "glReadBuffer" { ("ReadFramebuffer", "read") } else { ("DrawFramebuffer", "draw") };
                let value = if call.name == "glDrawBuffers" { rest(1) } else { all };
                Effects::set(vec![(format!("fb:{}:{end}", self.framebuffer(which)), value)], vec![which.into()])
            }
            "glFramebufferTexture"
            | "glFramebufferTexture2D"
            | "glFramebufferTextureLayer"
            | "glFramebufferRenderbuffer" => self.attach(call),
            "glTexImage1D"
            | "glTexImage2D"
            | "glTexImage3D"
            | "glTexStorage2D"
            | "glTexSubImage2D"
            | "glCopyTexImage2D"
            | "glCopyTexSubImage2D"
            | "glGenerateMipmap"
            | "glTexImage2DMultisample" => self.texture(call),
            "glTexParameteri" | "glTexParameterf" | "glTexParameterfv" | "glTexParameteriv" => {
                let key = format!("tex:{unit}:{:04X}", call.u(0));
                let name = format!("texpar:{}:{:04X}", self.bound(unit, call.u(0)), call.u(1));
                Effects::set(vec![(name, rest(2))], vec!["ActiveTexture".into(), key])
            }
            "glSamplerParameteri" | "glSamplerParameterf" | "glSamplerParameterfv" => {
                let sampler = object(call, 0);
                let name = format!("sampar:{sampler}:{:04X}", call.u(1));
                Effects::set(vec![(name, rest(2))], vec![made(Kind::Sampler, sampler)])
            }
            "glRenderbufferStorage" | "glRenderbufferStorageMultisample" => {
                let image = format!("rb:{}", self.state.number("Renderbuffer"));
                let size = call.arguments.len() - 2;
                self.sizes.insert(image.clone(), [call.i(size), call.i(size + 1)]);
                Effects::make(vec![format!("{image}/def")], vec!["Renderbuffer".into()])
            }
            "glShaderSource" => {
                if let Some(Argument::Text(source)) = call.arguments.get(2) {
                    self.sources.insert(object(call, 0), source.clone());
                }
                Effects::make(vec![format!("src:{}", object(call, 0))], vec![made(Kind::Shader, object(call, 0))])
            }
            "glCompileShader" => {
                let shader = object(call, 0);
                Effects::make(vec![format!("compiled:{shader}")], vec![format!("src:{shader}")])
            }
            "glAttachShader" => {
                let [program, shader] = [0, 1].map(|index| object(call, index));
                let source = self.sources.get(&shader).cloned().unwrap_or_default();
                self.texts.entry(program).or_default().push_str(&source);
                let reads = vec![format!("compiled:{shader}"), made(Kind::Program, program)];
                Effects::change(vec![format!("attached:{program}")], reads)
            }
            "glBindAttribLocation" => {
                let program = object(call, 0);
                Effects::change(vec![format!("attached:{program}")], vec![made(Kind::Program, program)])
            }
            "glLinkProgram" => {
                let program = object(call, 0);
                Effects::make(vec![format!("linked:{program}")], vec![format!("attached:{program}")])
            }
            "glGetUniformLocation" => match (call.made.first(), call.arguments.get(1)) {
                (Some((_, number)), Some(Argument::Text(name))) => {
                    let program = object(call, 0);
                    self.locations.insert(*number, (program, name.clone()));
                    Effects::make(vec![made(Kind::Location, *number)], vec![format!("linked:{program}")])
                }
                _ => Effects::default(),
            },
            name if name.starts_with("glUniform") => match self.locations.get(&object(call, 0)) {
                Some((program, name)) => {
                    let value = if numbers[1..].iter().all(|number| *number == 0.0) { "0".into() } else { rest(1) };
                    let reads = vec!["Program".into(), made(Kind::Location, object(call, 0))];
                    Effects::set(vec![(format!("uni:{program}:{name}"), value)], reads)
                }
                None => Effects::default(),
            },
            "glBufferData" | "glBufferSubData" => {
                let (key, mut reads) = self.buffer_binding(call.u(0));
                let buffer = self.state.number(&key);
                reads.push(key);
                let writes = vec![format!("buf:{buffer}")];
                if call.name == "glBufferData" { Effects::make(writes, reads) } else { Effects::change(writes, reads) }
            }
            "glVertexAttribPointer" => {
                let (array, buffer) = (self.vertex_array(), self.state.number("ArrayBuffer"));
                self.buffers.insert((array, call.u(0)), buffer as usize);
                let value = format!("{all},{buffer}");
                Effects::set(
                    vec![(format!("attr:{array}:{}", call.u(0)), value)],
                    vec!["VertexArray".into(), "ArrayBuffer".into()],
                )
            }
            "glEnableVertexAttribArray" | "glDisableVertexAttribArray" => {
                let value = if call.name.starts_with("glEnable") { "1" } else { "0" };
                let key = format!("attron:{}:{}", self.vertex_array(), call.u(0));
                Effects::set(vec![(key, value.to_owned())], vec!["VertexArray".into()])
            }
            "glBeginQuery" => {
                self.query = Some(object(call, 1));
                Effects::make(vec!["counted".into()], vec![made(Kind::Query, object(call, 1))])
            }
            "glEndQuery" => {
                let query = self.query.take().unwrap_or(0);
                Effects::make(vec![format!("result:{query}")], vec!["counted".into(), made(Kind::Query, query)])
            }
            "glGetQueryObjectuiv" | "glGetQueryObjectui64v" => {
                Effects::change(Vec::new(), vec![format!("result:{}", object(call, 0))])
            }
            "glClear" | "glClearBufferfv" | "glClearBufferiv" | "glClearBufferfi" => self.clear(call),
            "glBlitFramebuffer" => self.blit(call),
            "glDrawArrays" | "glDrawArraysInstanced" | "glDrawElements" | "glDrawElementsBaseVertex" => {
                self.draw(false)
            }
            "glBegin" => Effects::make(vec!["stream".into()], Vec::new()),
            "glVertex4fv" => Effects::change(vec!["stream".into()], self.state.keys("current:").cloned().collect()),
            "glEnd" => self.draw(true),
            "glReadPixels" => self.read_pixels(call),
            "glCheckFramebufferStatus" => {
                let which = if call.u(0) == glow::READ_FRAMEBUFFER { "ReadFramebuffer" } else { "DrawFramebuffer" };
                Effects::change(Vec::new(), self.attached(which))
            }
            name if Kind::of_maker(name).is_some() || name.starts_with("glCreate") => {
                Effects::make(call.made.iter().map(|(kind, number)| made(*kind, *number)).collect(), Vec::new())
            }
            _ => self.fixed(call, unit, &numbers),
        }
    }

    /// State of the fixed-function pipeline.
    fn fixed(&mut self, call: &Recorded, unit: u32, numbers: &[f64]) -> Effects {
        let rest = |from: usize| text(&numbers[from.min(numbers.len())..]);
        let one = |key: String, value: String| Effects::set(vec![(key, value)], Vec::new());
        let matrix =
            |mode: u32| if mode == glow::TEXTURE { format!("matrix:{mode}:{unit}") } else { format!("matrix:{mode}") };
        let modelview = matrix(raw::MODELVIEW);
        // What is transformed as it is set: its value is that of the matrix, too.
        let under = |value: String, state: &State| format!("{value}|{}", state.get(&modelview).unwrap_or_default());
        match call.name {
            "glMatrixMode" => one("MatrixMode".into(), rest(0)),
            "glLoadIdentity" | "glLoadMatrixf" | "glLoadMatrixd" | "glMultMatrixf" | "glMultMatrixd" | "glScalef"
            | "glTranslatef" => {
                let key = matrix(self.state.number("MatrixMode") as u32);
                let reads = vec!["MatrixMode".to_owned(), "ActiveTexture".to_owned()];
                match call.name {
                    "glLoadIdentity" => Effects::set(vec![(key, "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1".into())], reads),
                    "glLoadMatrixf" | "glLoadMatrixd" => Effects::set(vec![(key, rest(0))], reads),
                    _ => {
                        let sets = vec![(key.clone(), format!("product {}", self.serial))];
                        Effects { writes: vec![key], kills: false, reads, sets }
                    }
                }
            }
            "glTexEnvi" | "glTexEnvf" | "glTexEnvfv" => {
                let key = format!("texenv:{unit}:{}:{}", call.u(0), call.u(1));
                Effects::set(vec![(key, rest(2))], vec!["ActiveTexture".into()])
            }
            "glTexGeni" | "glTexGenfv" | "glTexGendv" => {
                let is_eye = call.u(1) == raw::EYE_PLANE;
                let value = if is_eye { under(rest(2), &self.state) } else { rest(2) };
                let mut reads = vec!["ActiveTexture".into()];
                reads.extend(is_eye.then_some(modelview));
                Effects::set(vec![(format!("texgen:{unit}:{}:{}", call.u(0), call.u(1)), value)], reads)
            }
            "glGetTexGendv" => {
                let reads = vec![format!("texgen:{unit}:{}:{}", call.u(0), call.u(1)), "ActiveTexture".into()];
                Effects::change(Vec::new(), reads)
            }
            "glLightf" | "glLightfv" => {
                let value = under(rest(2), &self.state);
                Effects::set(vec![(format!("light:{}:{}", call.u(0), call.u(1)), value)], vec![modelview])
            }
            "glLightModeli" | "glLightModelfv" | "glFogf" | "glFogi" | "glFogfv" | "glColorMaterial" => {
                one(format!("fixed:{}:{}", call.name.trim_end_matches(['f', 'i', 'v']), call.u(0)), rest(1))
            }
            "glMaterialf" | "glMaterialfv" => {
                let names: &[u32] = match call.u(1) {
                    raw::AMBIENT_AND_DIFFUSE => &[raw::AMBIENT, raw::DIFFUSE],
                    _ => &[call.u(1)],
                };
                let sets = names.iter().flat_map(|name| faces(call, &format!("material:{name}"), &rest(2)));
                Effects::set(sets.collect(), Vec::new())
            }
            "glColor4f" | "glColor4fv" => one("current:color".into(), rest(0)),
            "glNormal3f" | "glNormal3fv" => one("current:normal".into(), rest(0)),
            "glTexCoord4fv" => one(format!("current:{}", glow::TEXTURE0), rest(0)),
            "glMultiTexCoord4fv" => one(format!("current:{}", call.u(0)), rest(1)),
            _ => Effects::default(),
        }
    }

    fn buffer_binding(&self, target: u32) -> (Key, Vec<Key>) {
        if target == glow::ELEMENT_ARRAY_BUFFER {
            (format!("ElementBuffer:{}", self.vertex_array()), vec!["VertexArray".into()])
        } else {
            ("ArrayBuffer".into(), Vec::new())
        }
    }

    fn attach(&mut self, call: &Recorded) -> Effects {
        let which = if call.u(0) == glow::READ_FRAMEBUFFER { "ReadFramebuffer" } else { "DrawFramebuffer" };
        let framebuffer = self.framebuffer(which);
        let (image, kind, number) = match call.name {
            "glFramebufferRenderbuffer" => ("rb", Kind::Renderbuffer, object(call, 3)),
            "glFramebufferTexture2D" => ("img", Kind::Texture, object(call, 3)),
            _ => ("img", Kind::Texture, object(call, 2)),
        };
        let (part, is_flat) = match call.name {
            "glFramebufferRenderbuffer" => ("all".to_owned(), true),
            "glFramebufferTexture2D" => (format!("{:04X}:{}", call.u(2), call.u(4)), true),
            "glFramebufferTextureLayer" => (format!("layer {}:{}", call.u(4), call.u(3)), false),
            _ => (format!("all:{}", call.u(3)), false),
        };
        let attachment = Attachment { image: format!("{image}:{number}"), part, is_flat };
        let points: &[u32] = match call.u(1) {
            glow::DEPTH_STENCIL_ATTACHMENT => &[glow::DEPTH_ATTACHMENT, glow::STENCIL_ATTACHMENT],
            point => &[point],
        };
        let mut reads = vec![which.to_owned(), made(kind, number)];
        reads.extend(
            self.contents.get(&attachment.image).into_iter().flatten().filter(|key| key.contains("/def")).cloned(),
        );
        let mut sets = Vec::new();
        for point in points {
            sets.push((format!("fb:{framebuffer}:{point:04X}"), format!("{attachment:?}")));
            if number == 0 {
                self.attachments.remove(&(framebuffer, *point));
            } else {
                self.attachments.insert((framebuffer, *point), attachment.clone());
            }
        }
        Effects::set(sets, reads)
    }

    fn texture(&mut self, call: &Recorded) -> Effects {
        let unit = self.unit();
        let target = binding(call.u(0));
        let image = format!("img:{}", self.bound(unit, target));
        let mut reads = vec!["ActiveTexture".to_owned(), format!("tex:{unit}:{target:04X}")];
        let part = format!("{image}/def:{:04X}:{}", call.u(0), call.u(1));
        let transfer = |state: &State| -> Vec<Key> {
            ["glPixelStorei:", "glPixelTransferf:"]
                .iter()
                .flat_map(|head| state.keys(head).cloned().collect::<Vec<_>>())
                .collect()
        };
        match call.name {
            "glGenerateMipmap" => {
                reads.extend(self.contents.get(&image).into_iter().flatten().cloned());
                reads.extend(self.state.keys(&format!("texpar:{}:", &image[4..])).cloned());
                Effects::change(vec![format!("{image}/def:mipmap")], reads)
            }
            "glCopyTexImage2D" | "glCopyTexSubImage2D" => {
                reads.extend(self.read_contents());
                reads.extend(transfer(&self.state));
                if call.name == "glCopyTexImage2D" {
                    self.sizes.insert(format!("{image}:{:04X}:{}", call.u(0), call.u(1)), [call.i(5), call.i(6)]);
                }
                Effects::change(vec![part], reads)
            }
            name => {
                if matches!(call.arguments.last(), Some(Argument::Data(_))) {
                    reads.extend(transfer(&self.state));
                }
                let size = if name == "glTexImage1D" { [call.i(3), 1] } else { [call.i(3), call.i(4)] };
                if name == "glTexSubImage2D" {
                    return Effects::change(vec![part], reads);
                }
                self.sizes.insert(format!("{image}:{:04X}:{}", call.u(0), call.u(1)), size);
                // What was drawn into it is no more, either; it is kept all the same.
                Effects::make(vec![part], reads)
            }
        }
    }

    /// Attachments of a bound framebuffer, their images' definitions, and the framebuffer.
    fn attached(&self, which: &str) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut reads = vec![which.to_owned(), format!("fb:{framebuffer}:draw"), format!("fb:{framebuffer}:read")];
        for ((_, point), attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            reads.push(format!("fb:{framebuffer}:{point:04X}"));
            let contents = self.contents.get(&attachment.image).into_iter().flatten();
            reads.extend(contents.filter(|key| key.contains("/def")).cloned());
            if let Some(number) = attachment.image.strip_prefix("img:") {
                reads.extend(["813C", "813D"].map(|name| format!("texpar:{number}:{name}")));
            }
        }
        reads
    }

    fn aspect(point: u32) -> &'static str {
        match point {
            glow::DEPTH_ATTACHMENT => "depth",
            glow::STENCIL_ATTACHMENT => "stencil",
            _ => "color",
        }
    }

    /// Keys of what is in a framebuffer's images: of one aspect, or of all.
    fn drawn(&self, which: &str, aspects: &[&str]) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut keys = Vec::new();
        for ((_, point), attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            let aspect = Self::aspect(*point);
            if aspects.contains(&aspect) {
                keys.push(format!("{}/{}/{aspect}", attachment.image, attachment.part));
            }
        }
        keys
    }

    /// The same, with all that was drawn into the images in another way.
    fn drawn_and_given(&self, which: &str, aspects: &[&str]) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut keys = self.drawn(which, aspects);
        for (_, attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            let is_other = |key: &&Key| {
                let own = key.contains(&format!("/{}/", attachment.part)) && attachment.is_flat;
                !own && (key.contains("/layer") || key.contains("/all:") || key.contains("/def"))
            };
            keys.extend(self.contents.get(&attachment.image).into_iter().flatten().filter(is_other).cloned());
        }
        keys
    }

    fn read_contents(&self) -> Vec<Key> {
        let mut reads = self.attached("ReadFramebuffer");
        reads.extend(self.drawn_and_given("ReadFramebuffer", &["color", "depth", "stencil"]));
        reads
    }

    fn read_pixels(&self, call: &Recorded) -> Effects {
        let aspects: &[&str] = match call.u(4) {
            glow::DEPTH_COMPONENT => &["depth"],
            glow::STENCIL_INDEX => &["stencil"],
            glow::DEPTH_STENCIL => &["depth", "stencil"],
            _ => &["color"],
        };
        let mut reads = self.attached("ReadFramebuffer");
        reads.extend(self.drawn_and_given("ReadFramebuffer", aspects));
        for head in ["glPixelStorei:0D", "glPixelTransferf:", "glClampColor:"] {
            reads.extend(self.state.keys(head).cloned());
        }
        Effects::change(Vec::new(), reads)
    }

    /// The image's size, if the attachment is a whole level of a 2D image or a renderbuffer.
    fn size_of(&self, attachment: &Attachment) -> Option<[i32; 2]> {
        let key = if attachment.part == "all" {
            attachment.image.clone()
        } else {
            format!("{}:{}", attachment.image, attachment.part)
        };
        attachment.is_flat.then(|| self.sizes.get(&key).copied()).flatten()
    }

    /// Tests whether clears and draws reach all of the framebuffer's images.
    fn scissor_is_open(&self) -> bool {
        if !self.state.is_on(glow::SCISSOR_TEST) {
            return true;
        }
        let framebuffer = self.framebuffer("DrawFramebuffer");
        let scissor = self.state.numbers("glScissor");
        let mut sizes =
            self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)).map(|(_, at)| self.size_of(at));
        let [x, y, width, height] = *scissor else { return false };
        sizes.all(|size| {
            size.is_some_and(|[w, h]| x <= 0.0 && y <= 0.0 && x + width >= f64::from(w) && y + height >= f64::from(h))
        })
    }

    fn scissor_keys(&self) -> Vec<Key> {
        let mut keys = vec![format!("cap:{:04X}", glow::SCISSOR_TEST)];
        keys.extend(self.state.is_on(glow::SCISSOR_TEST).then(|| "glScissor".to_owned()));
        keys
    }

    fn clear(&self, call: &Recorded) -> Effects {
        let bits = match (call.name, call.u(0)) {
            ("glClear", bits) => bits,
            (_, glow::COLOR) => glow::COLOR_BUFFER_BIT,
            (_, glow::DEPTH) => glow::DEPTH_BUFFER_BIT,
            (_, glow::STENCIL) => glow::STENCIL_BUFFER_BIT,
            _ => glow::DEPTH_BUFFER_BIT | glow::STENCIL_BUFFER_BIT,
        };
        let mut reads = self.attached("DrawFramebuffer");
        reads.extend(self.scissor_keys());
        let mut aspects = Vec::new();
        let mut is_whole = self.scissor_is_open();
        let is_glclear = call.name == "glClear";
        if bits & glow::COLOR_BUFFER_BIT != 0 {
            aspects.push("color");
            reads.extend([
                "glColorMask".into(),
                format!("cap:{:04X}", glow::FRAMEBUFFER_SRGB),
                format!("cap:{:04X}", glow::DITHER),
            ]);
            reads.extend(is_glclear.then(|| "glClearColor".into()));
            is_whole &= self.state.get("glColorMask") == Some("1,1,1,1");
        }
        if bits & glow::DEPTH_BUFFER_BIT != 0 {
            aspects.push("depth");
            reads.push("glDepthMask".into());
            reads.extend(is_glclear.then(|| "ClearDepth".into()));
            is_whole &= self.state.get("glDepthMask") == Some("1");
        }
        if bits & glow::STENCIL_BUFFER_BIT != 0 {
            aspects.push("stencil");
            reads.extend(["StencilMask:front".into(), "StencilMask:back".into()]);
            reads.extend(is_glclear.then(|| "glClearStencil".into()));
            let mask =
                self.state.get("StencilMask:front").map_or(255, |mask| mask.parse::<f64>().unwrap_or(0.0) as u32);
            is_whole &= mask & 0xFF == 0xFF;
        }
        let framebuffer = self.framebuffer("DrawFramebuffer");
        is_whole &= self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)).all(|((_, point), at)| {
            at.is_flat && (*point <= glow::COLOR_ATTACHMENT0 || *point >= glow::DEPTH_ATTACHMENT)
        });
        Effects { writes: self.drawn("DrawFramebuffer", &aspects), kills: is_whole, reads, sets: Vec::new() }
    }

    fn blit(&self, call: &Recorded) -> Effects {
        let mut reads = self.read_contents();
        reads.extend(self.attached("DrawFramebuffer"));
        reads.extend(self.scissor_keys());
        reads.push(format!("cap:{:04X}", glow::FRAMEBUFFER_SRGB));
        let bits = [
            (glow::COLOR_BUFFER_BIT, "color"),
            (glow::DEPTH_BUFFER_BIT, "depth"),
            (glow::STENCIL_BUFFER_BIT, "stencil"),
        ];
        let aspects: Vec<&str> =
            bits.iter().filter(|(bit, _)| call.u(8) & bit != 0).map(|(_, aspect)| *aspect).collect();
        Effects::change(self.drawn("DrawFramebuffer", &aspects), reads)
    }

    /// All that sampling a texture by a unit reads.
    fn sampled(&self, unit: u32, target: u32) -> Vec<Key> {
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
    fn draw(&mut self, is_immediate: bool) -> Effects {
        let state = &self.state;
        let mut reads = self.attached("DrawFramebuffer");
        reads.extend(self.scissor_keys());
        reads.push("glViewport".into());
        reads.extend(state.keys("PolygonMode:").cloned());
        reads.extend(["glColorMask".into(), "DepthRange".into(), "glProvokingVertex".into()]);
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
                    reads.extend([format!("attr:{array}:{index}"), format!("buf:{buffer}")]);
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
