//! Programs of up to four look-ups: every fourth column of pixels shows the same one.

use super::lookups::{Class, LookUp, LookUpKind, Source};
use crate::conformance::random::Random;

/// Rows of the texture of inputs: coordinates, then what else a look-up takes.
pub const ROWS: usize = 128;

/// Names of the samplers.
pub const MAPS: [&str; 4] = ["map0", "map1", "map2", "map3"];

/// Look-ups of one program.
pub struct LookUpProgram {
    pub kinds: Vec<LookUpKind>,
}

impl LookUpProgram {
    /// Programs that together have every look-up once; those of vertex shaders have one each.
    pub fn all(gathers: bool, random: &mut Random) -> Vec<Self> {
        let (vertex, mut kinds): (Vec<_>, Vec<_>) =
            LookUpKind::all(gathers).into_iter().partition(|kind| kind.source == Source::Vertex);
        for index in (1..kinds.len()).rev() {
            kinds.swap(index, random.below(index + 1));
        }
        let several = kinds.chunks(MAPS.len()).map(|kinds| Self { kinds: kinds.to_vec() });
        several.chain(vertex.into_iter().map(|kind| Self { kinds: vec![kind] })).collect()
    }

    /// Whole sources of the vertex and the fragment shader.
    pub fn sources(&self) -> [String; 2] {
        let gathers = self.kinds.iter().any(|kind| kind.function == LookUp::Gather);
        let version = if gathers { "#version 400" } else { "#version 330" };
        let functions: String = self.kinds.iter().zip(MAPS).map(|(kind, map)| kind.text(map)).collect();
        if self.kinds.first().is_some_and(|kind| kind.source == Source::Vertex) {
            return [
                format!(
                    "{version}\nin vec4 position;\nin vec4 value;\nflat out vec4 passed;\nuniform vec4 more[16];
{functions}void main() {{\n    gl_Position = position;\n    passed = look_map0(value, more[3]);\n}}\n"
                ),
                format!("{version}\nflat in vec4 passed;\nout vec4 result;\nvoid main() {{ result = passed; }}\n"),
            ];
        }
        let mut calls = String::new();
        for (index, (kind, map)) in self.kinds.iter().zip(MAPS).enumerate() {
            let [middle, x, y, by] = [0, 1, 2, 3].map(|part| format!("more[{}]", 4 * index + part));
            let plane = format!("{middle} + {x} * passed.x + {y} * passed.y");
            let at = if kind.source == Source::Interpolated { plane.as_str() } else { "at" };
            let is_one = kind.source == Source::Interpolated || kind.function == LookUp::Size;
            let by = if is_one { by.as_str() } else { "by" };
            calls += &format!("    vec4 seen_{index} = look_{map}({at}, {by});\n");
        }
        let chosen: String = (1..self.kinds.len())
            .map(|index| format!("    if ((pixel.x & 3) == {index}) result = seen_{index};\n"))
            .collect();
        [
            format!(
                "{version}\nin vec4 position;\nin vec4 value;\nout vec4 passed;
void main() {{ gl_Position = position; passed = value; }}\n"
            ),
            format!(
                "{version}\nin vec4 passed;\nout vec4 result;\nuniform sampler2D inputs;\nuniform vec4 more[16];
{functions}void main() {{\n    ivec2 pixel = ivec2(gl_FragCoord.xy);\n    vec4 at = texelFetch(inputs, pixel, 0);
    vec4 by = texelFetch(inputs, pixel + ivec2(0, {ROWS}), 0);\n{calls}    result = seen_0;\n{chosen}}}\n"
            ),
        ]
    }
}

impl LookUpKind {
    /// The sampler, and a function that looks up in it.
    fn text(self, map: &str) -> String {
        let (sampler, call) = (self.sampler(), self.expression().replace("(map", &format!("({map}")));
        format!("uniform {sampler} {map};\nvec4 look_{map}(vec4 at, vec4 by) {{ return {call}; }}\n")
    }

    /// Tests whether a comparison's result is what comes out.
    pub fn compares(self) -> bool {
        self.class == Class::Shadow && self.function != LookUp::Size
    }
}
