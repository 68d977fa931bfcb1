//! GL-G3: uniforms of every kind that renderers upload, held to the bit [GL 4.6, 7.6; GLSL 4.60, 4.3.5, 5.10].

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, GlUniform, Shader, full};
use crate::conformance::{DriverUnderTest, Findings};

const DECLARATIONS: &str = "uniform int i; uniform float f; uniform vec2 v2; uniform vec3 v3; uniform vec4 v4;
uniform vec4 list[8]; uniform mat3 m3; uniform mat4 m4;";

/// A pixel for each vec4 that the uniforms hold.
const READ: &str = "int k = int(gl_FragCoord.x); vec4 seen = vec4(float(i), f, v2);
if (k == 1) seen = vec4(v3, 0.0);
if (k == 2) seen = v4;
if (k >= 3 && k < 11) seen = list[k - 3];
if (k >= 11 && k < 14) seen = vec4(m3[k - 11], 0.0);
if (k >= 14 && k < 18) seen = m4[k - 14];
if (k == 18) seen = vec4(m3 * vec3(1.0, 2.0, 4.0), 0.0);
if (k == 19) seen = m4 * vec4(1.0, 2.0, 4.0, 8.0);
result = seen;";
const WIDTH: usize = 20;

/// The same values passed on by the vertex stage, of every vertex the same.
const IN_VERTEX: &str =
    "gl_Position = position; passed = list[3] + m4 * v4 + vec4(v3, f) + vec4(m3 * v3, float(i)) + vec4(v2, v2);";

/// Values that differ in every component; multiples of 1/8, whose sums are exact.
#[derive(Clone, Copy)]
struct Values {
    seed: f32,
}

impl Values {
    fn at(self, index: usize) -> f32 {
        self.seed + index as f32 / 8.0 * if index.is_multiple_of(3) { -1.0 } else { 1.0 }
    }

    fn vec4(self, first: usize) -> [f32; 4] {
        [0, 1, 2, 3].map(|index| self.at(first + index))
    }

    fn list(self) -> [[f32; 4]; 8] {
        std::array::from_fn(|index| self.vec4(20 + 4 * index))
    }

    fn mat3(self) -> [f32; 9] {
        std::array::from_fn(|index| self.at(60 + index))
    }

    fn mat4(self) -> [f32; 16] {
        std::array::from_fn(|index| self.at(70 + index))
    }

    fn uniforms(self, by_rows: bool) -> Vec<(&'static str, GlUniform)> {
        let [x, y, z, _] = self.vec4(4);
        let (three, four) = (self.mat3(), self.mat4());
        let rows3 = std::array::from_fn(|index| three[index % 3 * 3 + index / 3]);
        let rows4 = std::array::from_fn(|index| four[index % 4 * 4 + index / 4]);
        vec![
            ("i", GlUniform::Int(self.seed as i32)),
            ("f", GlUniform::Float(self.at(1) + 1.0 / 4096.0)),
            ("v2", GlUniform::Vec2([self.at(2), self.at(3)])),
            ("v3", GlUniform::Vec3([x, y, z])),
            ("v4", GlUniform::Vec4(self.vec4(8))),
            ("list", GlUniform::Vec4s(self.list())),
            ("m3", if by_rows { GlUniform::Mat3ByRows(rows3) } else { GlUniform::Mat3(three) }),
            ("m4", if by_rows { GlUniform::Mat4ByRows(rows4) } else { GlUniform::Mat4(four) }),
        ]
    }

    fn product3(self, v: [f32; 3]) -> [f32; 3] {
        let m = self.mat3();
        [0, 1, 2].map(|row| (0..3).map(|column| m[3 * column + row] * v[column]).sum())
    }

    fn product4(self, v: [f32; 4]) -> [f32; 4] {
        let m = self.mat4();
        [0, 1, 2, 3].map(|row| (0..4).map(|column| m[4 * column + row] * v[column]).sum())
    }

    fn due(self, pixel: usize) -> [f32; 4] {
        let (three, four, [x, y, z, _]) = (self.mat3(), self.mat4(), self.vec4(4));
        match pixel {
            0 => [(self.seed as i32) as f32, self.at(1) + 1.0 / 4096.0, self.at(2), self.at(3)],
            1 => [x, y, z, 0.0],
            2 => self.vec4(8),
            3..11 => self.list()[pixel - 3],
            11..14 => [three[3 * (pixel - 11)], three[3 * (pixel - 11) + 1], three[3 * (pixel - 11) + 2], 0.0],
            14..18 => std::array::from_fn(|row| four[4 * (pixel - 14) + row]),
            18 => {
                let [x, y, z] = self.product3([1.0, 2.0, 4.0]);
                [x, y, z, 0.0]
            }
            _ => self.product4([1.0, 2.0, 4.0, 8.0]),
        }
    }

    fn in_vertex(self) -> [f32; 4] {
        let [x, y, z, _] = self.vec4(4);
        let (list, f) = (self.list()[3], self.at(1) + 1.0 / 4096.0);
        let (four, three) = (self.product4(self.vec4(8)), self.product3([x, y, z]));
        let v2 = [self.at(2), self.at(3)];
        let vector = [x, y, z, f];
        let matrix = [three[0], three[1], three[2], (self.seed as i32) as f32];
        std::array::from_fn(|index| list[index] + four[index] + vector[index] + matrix[index] + v2[index % 2])
    }
}

/// GL-G3: each kind, twice over with other values; by columns and by rows; and each program's own.
pub fn uniforms(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([WIDTH as u32, 1], Some(GlFormat::Rgba32F), None)?;
    let shader = Shader { declarations: DECLARATIONS, ..Shader::of(READ) };
    let other = Shader { vertex: IN_VERTEX, fragment: "result = passed;", declarations: DECLARATIONS, ..Shader::PLAIN };
    let drawn = |shader: Shader, uniforms: &[(&str, GlUniform)]| {
        let state = GlState { depth: None, ..GlState::WRITE };
        subject.bench.draw(&GlDraw { shader, uniforms, ..GlDraw::plain(&surface, state, &full(0.0)) })?;
        Ok::<_, Error>(surface.floats())
    };
    let kinds = ["int, float and vec2", "vec3", "vec4"].into_iter().map(|name| (name, 1));
    let kinds: Vec<_> = kinds
        .chain([
            ("vec4[8]", 8),
            ("mat3 by columns", 3),
            ("mat4 by columns", 4),
            ("mat3 times vec3", 1),
            ("mat4 times vec4", 1),
        ])
        .collect();
    let mut wrong = [0; WIDTH];
    for (seed, by_rows) in [(3.0, false), (-7.0, false), (12.0, true), (3.0, true), (5.0, false)] {
        let values = Values { seed };
        for (pixel, seen) in drawn(shader, &values.uniforms(by_rows))?.into_iter().enumerate() {
            wrong[pixel] += usize::from(seen != values.due(pixel));
        }
    }
    let mut first = 0;
    for (name, count) in kinds {
        findings.none_wrong(name, wrong[first..first + count].iter().sum(), 5 * count);
        first += count;
    }
    // Sums of a few hundred eighths of 4096ths are good to a rounding or two.
    let (one, two) = (Values { seed: 2.0 }, Values { seed: -9.0 });
    let near = |seen: &[f32; 4], due: [f32; 4]| (0..4).all(|index| (seen[index] - due[index]).abs() <= 1e-3);
    let mut bad = 0;
    for values in [one, two] {
        bad += drawn(other, &values.uniforms(false))?.iter().filter(|seen| !near(seen, values.in_vertex())).count();
    }
    findings.none_wrong("in the vertex stage", bad, 2 * WIDTH);
    // What one program was given is not another's: the first still has seed 5.
    let kept = drawn(shader, &[])?;
    let bad = (0..WIDTH).filter(|pixel| kept[*pixel] != Values { seed: 5.0 }.due(*pixel)).count();
    findings.none_wrong("a program keeps its values while another is given its own", bad, WIDTH);
    Ok(())
}
