//! Effects of each call of GL by the specification: what it writes and reads of the state, of objects, of pixels. Where that
//! is in doubt it reads too much rather than too little: then a call stays that might have gone.

use std::collections::{BTreeMap, BTreeSet};

use super::log::{Argument, Recorded};
use super::meaning::Kind;
use super::state::{Effects, Key, State, faces, text};
use crate::context::compatibility::raw;

/// An image's part that is attached to a framebuffer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Attachment {
    /// Key of the texture or renderbuffer: `img:3`, `rb:1`.
    pub(super) image: String,
    /// Its part: `DE1:0`.
    pub(super) part: String,
    /// All that is drawn is in this part alone.
    pub(super) is_flat: bool,
}

/// State and objects so far.
#[derive(Default)]
pub struct Tracker {
    pub state: State,
    pub(super) attachments: BTreeMap<(usize, u32), Attachment>,
    /// Keys of what images were given or drawn, by image.
    pub(super) contents: BTreeMap<String, BTreeSet<Key>>,
    pub(super) sizes: BTreeMap<String, [i32; 2]>,
    /// Sources of a shader, and of a program.
    pub(super) sources: BTreeMap<usize, String>,
    pub(super) texts: BTreeMap<usize, String>,
    /// Program and name of a uniform's location.
    pub(super) locations: BTreeMap<usize, (usize, String)>,
    /// Buffers of a vertex array's attributes.
    pub(super) buffers: BTreeMap<(usize, u32), usize>,
    pub(super) query: Option<usize>,
    pub(super) serial: usize,
    /// A function whose effects are not followed.
    pub unknown: Option<&'static str>,
}

pub(super) fn object(call: &Recorded, index: usize) -> usize {
    match call.arguments.get(index) {
        Some(Argument::Object(_, number) | Argument::Location(number)) => *number,
        _ => 0,
    }
}

pub(super) fn made(kind: Kind, number: usize) -> Key {
    format!("obj:{}:{number}", kind.word())
}

impl Tracker {
    pub(super) fn unit(&self) -> u32 {
        self.state.number("ActiveTexture") as u32
    }

    pub(super) fn bound(&self, unit: u32, target: u32) -> usize {
        self.state.number(&format!("tex:{unit}:{target:04X}")) as usize
    }

    pub(super) fn framebuffer(&self, which: &str) -> usize {
        self.state.number(which) as usize
    }

    pub(super) fn vertex_array(&self) -> usize {
        self.state.number("VertexArray") as usize
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
            "glDepthFunc"
            | "glDepthMask"
            | "glCullFace"
            | "glFrontFace"
            | "glLineWidth"
            | "glPointSize"
            | "glClearColor"
            | "glClearStencil"
            | "glScissor"
            | "glViewport"
            | "glBlendColor"
            | "glColorMask"
            | "glAlphaFunc"
            | "glShadeModel"
            | "glProvokingVertex"
            | "glPrimitiveRestartIndex"
            | "glClearAccum" => one(call.name.into(), all),
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
            "glBindAttribLocation" | "glBindFragDataLocation" => {
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
            "glVertexAttribDivisor" => {
                let key = format!("attrdiv:{}:{}", self.vertex_array(), call.u(0));
                Effects::set(vec![(key, rest(1))], vec!["VertexArray".into()])
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
            "glDrawArrays"
            | "glDrawArraysInstanced"
            | "glDrawElements"
            | "glDrawElementsInstanced"
            | "glDrawElementsBaseVertex" => self.draw(false),
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

    fn buffer_binding(&self, target: u32) -> (Key, Vec<Key>) {
        if target == glow::ELEMENT_ARRAY_BUFFER {
            (format!("ElementBuffer:{}", self.vertex_array()), vec!["VertexArray".into()])
        } else {
            ("ArrayBuffer".into(), Vec::new())
        }
    }
}
