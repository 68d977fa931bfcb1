//! Shaders of the player's programs.

use super::super::Error;
use super::super::program::{GlProgram, build_stages};
use super::Program;

impl Program {
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
}

const VERTEX: &str = "#version 330
in vec4 position;
in vec4 value;
out vec4 passed;
void main() { gl_Position = position; passed = value; }
";

const CLIPPED: &str = "#version 330
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

const HEAD: &str = "#version 330
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
