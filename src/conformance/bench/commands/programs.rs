//! Programs of the player, and their uniforms.

use glow::HasContext;

use super::super::Error;
use super::super::program::{GlProgram, build_stages};
use super::{Player, Setting};

/// The program that draws; each is one fragment shader. Textures are read at the pixel's own place, moved by `origin`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// The colour of the uniform.
    Plain,
    /// The colour of the vertices.
    Varying,
    /// Squares of pixels, `period` on a side, in turn discarded and drawn.
    Squares,
    /// Two outputs: the uniform, and the uniform with its channels turned round.
    Two,
    /// The uniform's colour, at the depth `reference`.
    Depth,
    /// A texel of a 2D texture's level by texelFetch, times the uniform.
    Fetch,
    /// The red channel of the same, in all channels: of a depth texture.
    FetchDepth,
    /// A texel of an array's layer by texelFetch.
    FetchLayer,
    /// A texel of a 2D texture by textureLod, at its centre and beyond the texture.
    Look,
    /// A texel of a cube map by textureLod, at its centre.
    LookCube,
    /// A comparison with `reference` in a 2D texture by textureLod, at a texel's centre: result, 1/4, result, 1.
    Compare,
    /// By which side is seen: the uniform or the vertices' colour.
    Sides,
    /// The uniform's colour with an alpha of 1.
    Opaque,
    /// The uniform's colour, where `cut.x * x + cut.y * w` of the position is not negative: a clip distance.
    Clip,
}

impl Program {
    pub const ALL: [Self; 14] = [
        Self::Plain,
        Self::Varying,
        Self::Squares,
        Self::Two,
        Self::Depth,
        Self::Fetch,
        Self::FetchDepth,
        Self::FetchLayer,
        Self::Look,
        Self::LookCube,
        Self::Compare,
        Self::Sides,
        Self::Opaque,
        Self::Clip,
    ];

    /// Declarations before main, and its body.
    fn fragment(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["", "result = color;"],
            Self::Varying => ["", "result = passed;"],
            Self::Squares => [
                "uniform ivec2 period;",
                "ivec2 at = ivec2(gl_FragCoord.xy) / period;
    if (((at.x + at.y) & 1) == 1) discard;
    result = color;",
            ],
            Self::Two => ["out vec4 second;", "result = color; second = color.abgr;"],
            Self::Depth => ["uniform float reference;", "result = color; gl_FragDepth = reference;"],
            Self::Fetch => {
                ["uniform sampler2D map;", "result = color * texelFetch(map, inside(textureSize(map, level)), level);"]
            }
            Self::FetchDepth => {
                ["uniform sampler2D map;", "result = texelFetch(map, inside(textureSize(map, level)), level).rrrr;"]
            }
            Self::FetchLayer => [
                "uniform sampler2DArray map; uniform int layer;",
                "result = texelFetch(map, ivec3(inside(textureSize(map, level).xy), layer), level);",
            ],
            Self::Look => {
                ["uniform sampler2D map;", "result = textureLod(map, beyond(textureSize(map, level)), float(level));"]
            }
            Self::LookCube => [
                "uniform samplerCube map; uniform vec3 axes[3];",
                "vec2 at = 2.0 * (vec2(inside(textureSize(map, level))) + 0.5) / vec2(textureSize(map, level)) - 1.0;
    result = textureLod(map, axes[0] * at.x + axes[1] * at.y + axes[2], float(level));",
            ],
            Self::Compare => [
                "uniform sampler2DShadow map; uniform float reference;",
                "float lit = textureLod(map, vec3(beyond(textureSize(map, level)), reference), float(level));
    result = vec4(lit, 0.25, lit, 1.0);",
            ],
            Self::Sides => ["", "result = gl_FrontFacing ? color : passed;"],
            Self::Opaque => ["", "result = vec4(color.rgb, 1.0);"],
            Self::Clip => ["", "result = color;"],
        }
    }

    /// Tests whether it reads a texture.
    pub fn reads(self) -> bool {
        matches!(self, Self::Fetch | Self::FetchDepth | Self::FetchLayer | Self::Look | Self::LookCube | Self::Compare)
    }

    /// Tests whether it has `reference`, `period` and `layer`.
    pub fn has(self, setting: &Setting) -> bool {
        match setting {
            Setting::Color(..) => !matches!(self, Self::Varying) && (!self.reads() || self == Self::Fetch),
            Setting::Period(..) => self == Self::Squares,
            Setting::Reference(..) => matches!(self, Self::Depth | Self::Compare),
            Setting::Layer(..) => self == Self::FetchLayer,
            Setting::Axes(..) => self == Self::LookCube,
            Setting::Cut(..) => self == Self::Clip,
            Setting::Origin(..) | Setting::Level(..) | Setting::Unit(..) => self.reads(),
            _ => false,
        }
    }
}

const VERTEX: &str = "#version 150
in vec4 position;
in vec4 value;
out vec4 passed;
void main() { gl_Position = position; passed = value; }
";

const CLIPPED: &str = "#version 150
in vec4 position;
in vec4 value;
out vec4 passed;
uniform vec2 cut;
void main() {
    gl_Position = position;
    passed = value;
    gl_ClipDistance[0] = cut.x * position.x + cut.y * position.w;
}
";

const HEAD: &str = "#version 150
in vec4 passed;
out vec4 result;
uniform vec4 color;
uniform ivec2 origin;
uniform int level;
ivec2 inside(ivec2 size) { return (ivec2(gl_FragCoord.xy) + origin) % size; }
vec2 beyond(ivec2 size) { return (vec2(ivec2(gl_FragCoord.xy) + origin - size) + 0.5) / vec2(size); }
";

/// Builds all programs; their uniforms are 0.
pub(super) fn build(gl: &std::rc::Rc<glow::Context>) -> Result<Vec<GlProgram>, Error> {
    let one = |program: &Program| {
        let [declared, body] = program.fragment();
        let fragment = format!("{HEAD}{declared}\nvoid main() {{\n    {body}\n}}\n");
        let vertex = if *program == Program::Clip { CLIPPED } else { VERTEX };
        build_stages(gl, &[(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, &fragment)])
    };
    Program::ALL.iter().map(one).collect()
}

impl Player<'_> {
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn set_uniform(&mut self, setting: Setting) {
        let (program, name) = match setting {
            Setting::Color(program, _) => (program, "color"),
            Setting::Period(program, _) => (program, "period"),
            Setting::Origin(program, _) => (program, "origin"),
            Setting::Level(program, _) => (program, "level"),
            Setting::Layer(program, _) => (program, "layer"),
            Setting::Reference(program, _) => (program, "reference"),
            Setting::Unit(program, _) => (program, "map"),
            Setting::Axes(program, _) => (program, "axes"),
            Setting::Cut(program, _) => (program, "cut"),
            Setting::Program(program) => (program, ""),
            _ => return,
        };
        let gl = self.gl;
        let name_of = self.programs[program as usize].name;
        // SAFETY: as the caller promises; the location is of the program that is used.
        unsafe {
            gl.use_program(Some(name_of));
            let location = if name.is_empty() { None } else { gl.get_uniform_location(name_of, name) };
            let at = location.as_ref();
            match setting {
                Setting::Color(_, [r, g, b, a]) => gl.uniform_4_f32(at, r, g, b, a),
                Setting::Period(_, [x, y]) | Setting::Origin(_, [x, y]) => gl.uniform_2_i32(at, x, y),
                Setting::Level(_, value) | Setting::Layer(_, value) | Setting::Unit(_, value) => {
                    gl.uniform_1_i32(at, value);
                }
                Setting::Reference(_, value) => gl.uniform_1_f32(at, value),
                Setting::Cut(_, [x, y]) => gl.uniform_2_f32(at, x, y),
                Setting::Axes(_, axes) => gl.uniform_3_f32_slice(at, axes.as_flattened()),
                _ => {}
            }
        }
    }
}
