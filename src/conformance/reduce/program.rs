//! Calls of GL as a program in C that makes its own context, makes the calls, and judges what it reads.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::log::{Argument, Data, Recorded};
use super::meaning::{Kind, Meaning, meaning};
use super::names::Names;
use super::pixels::Scalar;
use crate::c_text::{Text, boolean, comment, float, literals};
use crate::conformance::layer::functions;
use crate::conformance::layer::value::Value;

/// Texts of a program about itself and its result.
pub struct Heading {
    /// Lines of the comment at the top.
    pub lines: Vec<String>,
    /// Lines that it prints.
    pub says: Vec<String>,
    /// EGL's bit of the profile, 1: core, 2: compatibility.
    pub profile: u32,
    /// Places and numbers that are judged, in C.
    pub judge: String,
}

/// Numbers of data up to which it stands in the call.
const INLINE: usize = 16;
/// Columns of a line of data.
const WIDTH: usize = 116;

/// Writes a program.
pub fn write(calls: &[Recorded], heading: &Heading) -> String {
    let mut writer = Writer {
        names: Names::new(),
        variables: BTreeMap::new(),
        counts: BTreeMap::new(),
        enums: BTreeSet::new(),
        data: Text::default(),
        data_count: 0,
        main: Text::default(),
        group: "",
    };
    for call in calls {
        writer.call(call);
    }
    let mut out = Text::default();
    out.line("/*");
    heading.lines.iter().for_each(|line| out.line(format!("   {}", comment(line)).trim_end()));
    out.line("*/\n");
    out.line(TYPES);
    for name in &writer.enums {
        if let Some(value) = Names::value(name) {
            out.line(&format!("#define {name} 0x{value:04X}"));
        }
    }
    let mut used: BTreeSet<&str> = calls.iter().map(|call| call.name).collect();
    used.extend(["glGetString", "glGetError"]);
    out.line("\n/* Functions of GL, by eglGetProcAddress. */");
    used.iter().for_each(|name| out.line(&pointer(name)));
    out.line("\nstatic const struct { const char *name; void *place; } functions[] = {");
    used.iter().for_each(|name| out.line(&format!("    {{\"{name}\", (void *)&{name}}},")));
    out.line("};\n");
    out.line(&CONTEXT.replace("@PROFILE@", &heading.profile.to_string()));
    out.0.push_str(&writer.data.0);
    out.line("\nint main(void)\n{");
    out.line("    if (!open_context()) {\n        return 2;\n    }");
    for line in &heading.says {
        out.line(&format!("    puts({});", literals(line, "").trim_end_matches("\\n\"").to_owned() + "\""));
    }
    out.line(
        "    printf(\"driver: %s, %s\\n\", (const char *)glGetString(0x1F01), (const char *)glGetString(0x1F02));",
    );
    out.0.push_str(&writer.main.0);
    out.0.push_str(&heading.judge);
    out.line("}");
    out.0
}

/// Declaration of a function's pointer.
fn pointer(name: &str) -> String {
    if name == "glGetString" {
        return "static const GLubyte *(*glGetString)(GLenum name);".to_owned();
    }
    if name == "glGetError" {
        return "static GLenum (*glGetError)(void);".to_owned();
    }
    let Some((parameters, result)) = functions::signature(name) else { return String::new() };
    let c_type = |parameter: &str, kind: &str| match kind {
        "u8" => "GLboolean ",
        "u32" => match meaning(name, parameter, kind, Value::Unsigned(0)) {
            Meaning::Enum => "GLenum ",
            _ => "GLuint ",
        },
        "i32" => "GLint ",
        "isize" => "GLsizeiptr ",
        "f32" => "GLfloat ",
        "f64" => "GLdouble ",
        "Out" => "void *",
        _ => "const void *",
    };
    let all: Vec<String> =
        parameters.iter().map(|[parameter, kind]| format!("{}{parameter}", c_type(parameter, kind))).collect();
    let result = match result {
        "" => "void",
        "i32" => "GLint",
        _ => "GLuint",
    };
    let parameters = if all.is_empty() { "void".to_owned() } else { all.join(", ") };
    format!("static {result} (*{name})({parameters});")
}

struct Writer {
    names: Names,
    variables: BTreeMap<(Kind, usize), String>,
    counts: BTreeMap<Kind, usize>,
    enums: BTreeSet<&'static str>,
    /// Data and sources, before main.
    data: Text,
    data_count: usize,
    main: Text,
    group: &'static str,
}

impl Writer {
    fn call(&mut self, call: &Recorded) {
        let group = group(call.name);
        if group != self.group {
            self.main.line(&format!("\n    /* {group}. */"));
            self.group = group;
        }
        for (kind, number) in &call.made {
            let count = self.counts.entry(*kind).or_default();
            *count += 1;
            self.variables.insert((*kind, *number), format!("{}_{count}", kind.word()));
        }
        let made: Vec<String> = call.made.iter().filter_map(|made| self.variables.get(made).cloned()).collect();
        let arguments: Vec<String> = (0..call.arguments.len()).map(|index| self.argument(call, index)).collect();
        let arguments = arguments.join(", ");
        match (call.name, made.first()) {
            ("glGetUniformLocation", Some(name)) => {
                self.main.call(&format!("GLint {name} = {}({arguments})", call.name))
            }
            ("glCreateShader" | "glCreateProgram", Some(name)) => {
                self.main.call(&format!("GLuint {name} = {}({arguments})", call.name));
            }
            (_, Some(_)) => {
                self.main.call(&format!("GLuint {}", made.join(", ")));
                made.iter().for_each(|name| self.main.call(&format!("{}(1, &{name})", call.name)));
            }
            ("glGetError" | "glCheckFramebufferStatus", _) => {
                self.main.call(&format!("GLuint answer[1] = {{{}({arguments})}}", call.name));
            }
            _ if call.read.is_some() => {
                let bytes = call
                    .arguments
                    .iter()
                    .find_map(|argument| if let Argument::Out(bytes) = argument { Some(*bytes) } else { None });
                self.main.call(&format!("static GLubyte answer[{}]", bytes.unwrap_or(8)));
                self.main.call(&format!("{}({arguments})", call.name));
            }
            _ => self.main.call(&format!("{}({arguments})", call.name)),
        }
    }

    fn named(&mut self, function: &str, value: u32) -> String {
        match self.names.of(function, value) {
            Some(name) => {
                self.enums.insert(name);
                name.to_owned()
            }
            None if value < 256 => value.to_string(),
            None => format!("0x{value:04X}"),
        }
    }

    fn argument(&mut self, call: &Recorded, index: usize) -> String {
        let parameter = functions::signature(call.name)
            .and_then(|(parameters, _)| parameters.get(index))
            .map_or("", |[name, _]| name);
        match &call.arguments[index] {
            Argument::Enum(glow::TEXTURE0..=0x84DF)
                if call.name == "glActiveTexture" || call.name == "glMultiTexCoord4fv" =>
            {
                self.enums.insert("GL_TEXTURE0");
                format!("GL_TEXTURE0 + {}", call.u(index) - glow::TEXTURE0)
            }
            Argument::Enum(value) => self.named(call.name, *value),
            Argument::Bits(value) => {
                let bits = Names::bits(*value);
                self.enums.extend(&bits);
                if bits.is_empty() { value.to_string() } else { bits.join(" | ") }
            }
            Argument::Number(Value::Unsigned(value)) if parameter == "mask" => format!("0x{value:02X}"),
            Argument::Number(Value::Float(value)) => float(*value),
            Argument::Number(Value::Double(value)) => format!("{value:?}"),
            Argument::Number(Value::Byte(value)) => {
                let word = boolean(*value != 0);
                self.enums.insert(word);
                word.to_owned()
            }
            Argument::Number(value) => value.number().to_string(),
            Argument::Object(_, 0) => "0".to_owned(),
            Argument::Object(kind, number) => {
                self.variables.get(&(*kind, *number)).cloned().unwrap_or_else(|| "0".to_owned())
            }
            Argument::Location(number) => {
                self.variables.get(&(Kind::Location, *number)).cloned().unwrap_or_else(|| "-1".to_owned())
            }
            Argument::Data(data) => self.data(call, data),
            Argument::Text(source) if call.name == "glShaderSource" => {
                self.data_count += 1;
                let name = format!("source_{}", self.data_count);
                self.data.line(&format!("\nstatic const char *const {name} =\n{};", literals(source, "    ")));
                format!("&{name}")
            }
            Argument::Text(text) => format!("\"{text}\""),
            Argument::Offset(offset) => format!("(const void *){offset}"),
            Argument::Out(_) => "answer".to_owned(),
            Argument::Null => "NULL".to_owned(),
        }
    }

    /// Data in the call, or in an array before main.
    fn data(&mut self, call: &Recorded, data: &Data) -> String {
        let numbers = data.scalar.numbers(&data.bytes);
        let literal = |value: f64| match data.scalar {
            Scalar::F32 => float(value as f32),
            Scalar::F64 => format!("{value:?}"),
            Scalar::U32 if value >= 65536.0 => format!("0x{:08X}u", value as u32),
            _ => format!("{value}"),
        };
        let c_type = data.scalar.c_type();
        if numbers.len() <= INLINE && !call.name.starts_with("glTexImage") && !call.name.starts_with("glBuffer") {
            let all: Vec<String> = numbers.iter().map(|number| literal(*number)).collect();
            return format!("(const {c_type}[]){{{}}}", all.join(", "));
        }
        self.data_count += 1;
        let what = if call.name.contains("Buffer") {
            "vertices"
        } else if call.name.contains("Tex") {
            "texels"
        } else {
            "values"
        };
        let name = format!("{what}_{}", self.data_count);
        let zeros = numbers.iter().filter(|number| number.to_bits() == 0).count();
        let words: Vec<String> = if 2 * zeros > numbers.len() {
            let some = numbers.iter().enumerate().filter(|(_, number)| number.to_bits() != 0);
            let some: Vec<String> = some.map(|(index, number)| format!("[{index}] = {}", literal(*number))).collect();
            if some.is_empty() { vec!["0".to_owned()] } else { some }
        } else {
            numbers.iter().map(|number| literal(*number)).collect()
        };
        let per_line = if what == "vertices" && data.scalar == Scalar::F32 { 8 } else { usize::MAX };
        let mut text = String::new();
        let (mut line, mut count) = (String::from("   "), 0);
        for word in words {
            if line.len() + word.len() + 2 > WIDTH || count == per_line {
                let _ = writeln!(text, "{line}");
                (line, count) = (String::from("   "), 0);
            }
            let _ = write!(line, " {word},");
            count += 1;
        }
        self.data.line(&format!("\nstatic const {c_type} {name}[{}] = {{\n{text}{line}\n}};", numbers.len()));
        name
    }
}

/// Part of the program that a call belongs to.
fn group(function: &str) -> &'static str {
    let has = |word: &str| function.contains(word);
    match function {
        "glClear" | "glClearBufferfv" | "glClearBufferiv" | "glClearBufferfi" => "Clear",
        "glClearColor" | "glClearDepth" | "glClearDepthf" | "glClearStencil" => "State",
        "glReadPixels" | "glGetError" | "glGetTexGendv" | "glCheckFramebufferStatus" => "What is read and judged",
        "glBlitFramebuffer" => "Copy",
        _ if has("Draw") && !has("DrawBuffer") => "Draw",
        "glBegin" | "glEnd" | "glVertex4fv" | "glTexCoord4fv" | "glMultiTexCoord4fv" | "glColor4fv" | "glNormal3fv" => {
            "Draw"
        }
        _ if has("Uniform") => "Uniforms",
        _ if has("Shader") || has("Program") || has("AttribLocation") => "Program",
        _ if has("Framebuffer") || has("Renderbuffer") || has("DrawBuffer") || has("ReadBuffer") => "Framebuffer",
        _ if has("Sampler") => "Sampler",
        _ if has("CopyTex") => "Copy",
        _ if (has("Tex") || has("Mipmap")) && !has("TexGen") && !has("TexEnv") => "Texture",
        _ if has("Vertex") || has("Buffer") => "Vertices",
        _ if has("Quer") => "Query",
        _ => "State",
    }
}

const TYPES: &str = "#include <dlfcn.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef unsigned int GLenum, GLuint;
typedef unsigned char GLboolean, GLubyte;
typedef signed char GLbyte;
typedef unsigned short GLushort;
typedef short GLshort;
typedef int GLint;
typedef float GLfloat;
typedef double GLdouble;
typedef ptrdiff_t GLsizeiptr;
typedef uint64_t GLuint64;
";

const CONTEXT: &str = "/* A context without a window: on Mesa's surfaceless platform, on EGL's first device, or on the default display. */
static int open_context(void)
{
    void *egl = dlopen(\"libEGL.so.1\", RTLD_NOW | RTLD_GLOBAL);
    if (!egl) {
        fprintf(stderr, \"no libEGL.so.1\\n\");
        return 0;
    }
    void *(*get)(const char *), *(*get_display)(void *), *(*platform)(unsigned, void *, const int *);
    unsigned (*initialize)(void *, int *, int *), (*bind_api)(unsigned), (*make_current)(void *, void *, void *, void *);
    unsigned (*choose)(void *, const int *, void **, int, int *), (*devices)(int, void **, int *);
    void *(*create_context)(void *, void *, void *, const int *), *(*create_pbuffer)(void *, void *, const int *);
    *(void **)&get = dlsym(egl, \"eglGetProcAddress\");
    *(void **)&get_display = dlsym(egl, \"eglGetDisplay\");
    *(void **)&initialize = dlsym(egl, \"eglInitialize\");
    *(void **)&bind_api = dlsym(egl, \"eglBindAPI\");
    *(void **)&choose = dlsym(egl, \"eglChooseConfig\");
    *(void **)&create_context = dlsym(egl, \"eglCreateContext\");
    *(void **)&create_pbuffer = dlsym(egl, \"eglCreatePbufferSurface\");
    *(void **)&make_current = dlsym(egl, \"eglMakeCurrent\");
    *(void **)&platform = get(\"eglGetPlatformDisplayEXT\");
    *(void **)&devices = get(\"eglQueryDevicesEXT\");
    for (int way = 0; way < 3; way++) {
        void *device = NULL, *display = NULL, *config = NULL, *surface = NULL;
        int count = 0;
        if (way == 0 && platform) display = platform(0x31DD /* EGL_PLATFORM_SURFACELESS_MESA */, NULL, NULL);
        if (way == 1 && platform && devices && devices(1, &device, &count) && count > 0) {
            display = platform(0x313F /* EGL_PLATFORM_DEVICE_EXT */, device, NULL);
        }
        if (way == 2) display = get_display(NULL);
        if (!display || !initialize(display, NULL, NULL) || !bind_api(0x30A2 /* EGL_OPENGL_API */)) continue;
        /* EGL_SURFACE_TYPE: EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE: EGL_OPENGL_BIT */
        static const int wanted[] = {0x3033, 1, 0x3040, 8, 0x3038}, size[] = {0x3057, 1, 0x3056, 1, 0x3038};
        if (!choose(display, wanted, &config, 1, &count) || count == 0) config = NULL;
        if (config) surface = create_pbuffer(display, config, size);
        /* OpenGL 3.3; EGL_CONTEXT_OPENGL_PROFILE_MASK: 1 is core, 2 compatibility */
        static const int version[] = {0x3098, 3, 0x30FB, 3, 0x30FD, @PROFILE@, 0x3038};
        void *context = create_context(display, config, NULL, version);
        if (!context || !make_current(display, surface, surface, context)) continue;
        for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
            void *address = get(functions[i].name);
            if (!address) {
                fprintf(stderr, \"the driver has no %s\\n\", functions[i].name);
                return 0;
            }
            memcpy(functions[i].place, &address, sizeof address);
        }
        return 1;
    }
    fprintf(stderr, \"no context of OpenGL 3.3\\n\");
    return 0;
}
";
