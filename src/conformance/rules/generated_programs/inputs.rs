//! Numbers that programs compute with: inputs of each pixel, uniforms, constants; and their names.

use super::code::{Program, Variable};
use super::make::Ranges;
use super::run::Variables;
use crate::conformance::bench::GlUniform;
use crate::conformance::model::number::Num;
use crate::conformance::model::scalars::wrapped;
use crate::conformance::model::value::{GlslValue, NumberBase, Type};
use crate::conformance::random::Random;

/// Pixels of a draw.
pub const PIXELS: usize = 128;

/// Vectors of floats that each pixel is given: the last three make integers.
pub const VECTORS: usize = 11;

/// Draws a number of some range.
type Draw = fn(&mut Random) -> f32;

/// Names of the vectors of floats in programs, and their numbers' range.
const FLOATS: [(&str, Draw); 8] = [
    ("a", |random| random.between(-4.0, 4.0)),
    ("m", |random| signed(random, -20.0, 20.0)),
    ("s", special),
    ("p", |random| {
        let reach = if random.unit() < 0.7 { 7.0 } else { 24.0 };
        random.between(-reach, reach).exp2()
    }),
    ("w", |random| signed(random, -30.0, 30.0)),
    ("n", |random| random.between(-1.0, 1.0)),
    ("t", |random| if random.unit() < 0.3 { special(random) } else { random.between(-20.0, 20.0) }),
    ("h", |random| random.between(-0.25, 1.25)),
];

/// A magnitude between powers of two, of either sign.
fn signed(random: &mut Random, low: f32, high: f32) -> f32 {
    let magnitude = random.between(low, high).exp2();
    if random.unit() < 0.5 { -magnitude } else { magnitude }
}

/// Whole numbers, halves, and what lies beside them.
fn special(random: &mut Random) -> f32 {
    let whole = random.between(-9.0, 9.0).floor();
    match random.unit() {
        x if x < 0.1 => 0.0,
        x if x < 0.2 => 1.0,
        x if x < 0.3 => -1.0,
        x if x < 0.5 => whole + 0.5,
        x if x < 0.6 => whole + 1.0 / 1024.0,
        x if x < 0.65 => whole * 1000.0,
        _ => whole,
    }
}

/// The vectors of all pixels: each of the eleven with one for each pixel. By `turn` the floats' ranges change places.
pub fn vectors(random: &mut Random, turn: usize) -> Vec<Vec<[f32; 4]>> {
    let mut all: Vec<Vec<[f32; 4]>> = Vec::new();
    for index in 0..FLOATS.len() {
        let (_, number) = FLOATS[(index + turn) % FLOATS.len()];
        all.push((0..PIXELS).map(|_| std::array::from_fn(|_| number(random))).collect());
    }
    // Pairs of numbers that are equal or near each other.
    for pixel in (0..PIXELS).step_by(5) {
        all[2][pixel][1] = all[2][pixel][0];
        all[0][pixel][2] = all[0][pixel][3] + random.between(-0.01, 0.01);
    }
    let mut whole = |low: f32, high: f32| -> Vec<[f32; 4]> {
        (0..PIXELS).map(|_| std::array::from_fn(|_| random.between(low, high).floor())).collect()
    };
    all.push(whole(-20.0, 21.0));
    all.push(whole(-32768.0, 32768.0));
    all.push(whole(0.0, 65536.0));
    all
}

/// Statements that make the integers of three vectors.
pub const INTEGERS: &str = "i = ivec4(x8); j = ivec4(x9) * 65536 + ivec4(x10); u = uvec4(j) ^ uvec4(i);";

/// GivenUniforms of a draw.
pub struct GivenUniforms {
    numbers: Vec<f32>,
    turns: i32,
}

impl GivenUniforms {
    pub fn new(random: &mut Random) -> Self {
        let turns = (random.unit() * 12.0) as i32;
        Self { numbers: (0..65).map(|_| (random.between(-3.0, 3.0) * 256.0).round() / 256.0).collect(), turns }
    }

    fn at<const N: usize>(&self, first: usize) -> [f32; N] {
        std::array::from_fn(|index| self.numbers[first + index])
    }

    pub fn list(&self) -> Vec<(&'static str, GlUniform)> {
        vec![
            ("uf", GlUniform::Float(self.numbers[0])),
            ("uv", GlUniform::Vec4(self.at(1))),
            ("u3", GlUniform::Vec3(self.at(5))),
            ("um3", GlUniform::Mat3(self.at(8))),
            ("um4", GlUniform::Mat4(self.at(17))),
            ("ul", GlUniform::Vec4s(std::array::from_fn(|index| self.at(33 + 4 * index)))),
            ("ui", GlUniform::Int(self.turns)),
        ]
    }

    fn values(&self) -> Vec<GlslValue> {
        let part = |first: usize, count: usize| -> GlslValue {
            self.numbers[first..first + count].iter().map(|x| Num::exact(f64::from(*x))).collect()
        };
        let parts = [(0, 1), (1, 4), (5, 3), (8, 9), (17, 16), (33, 32)].map(|(first, count)| part(first, count));
        let turns = GlslValue::from(Num::exact(f64::from(self.turns)));
        parts.into_iter().chain([turns]).collect()
    }
}

/// Declarations of what [`variables`] names, in that order.
pub const DECLARATIONS: &str = "uniform float uf; uniform vec4 uv; uniform vec3 u3; uniform mat3 um3; uniform mat4 um4;
uniform vec4 ul[8]; uniform int ui;
const float KF = 0.625;
const vec3 KV = vec3(0.5, -1.25, 3.0);
const int KI[5] = int[5](3, -1, 40, 0, 1000);
const vec2 KA[3] = vec2[3](vec2(1.0, 0.25), vec2(-2.0, 7.0), vec2(0.0, 12.5));
struct Pair { vec3 first; float second; ivec2 third; };
Pair one; Pair pairs[2];
vec4 a, m, s, p, w, n, t, h;
ivec4 i, j;
uvec4 u;
";

/// Variables that every program has: inputs, uniforms, constants (functions see all of them), then members of structs.
pub struct Given {
    pub program: Program,
    pub ranges: Ranges,
    pub globals: Vec<usize>,
    /// Members of structs, which nothing has written yet.
    pub members: Vec<usize>,
}

pub fn given() -> Given {
    let vec4 = |base| Type::vector(base, 4);
    let mut list: Vec<(String, Type)> =
        FLOATS.iter().map(|(name, _)| ((*name).to_owned(), vec4(NumberBase::Float))).collect();
    let mut more = |name: &str, kind: Type| list.push((name.to_owned(), kind));
    more("i", vec4(NumberBase::Int));
    more("j", vec4(NumberBase::Int));
    more("u", vec4(NumberBase::Uint));
    more("uf", Type::FLOAT);
    more("uv", vec4(NumberBase::Float));
    more("u3", Type::vector(NumberBase::Float, 3));
    more("um3", Type::matrix(3, 3));
    more("um4", Type::matrix(4, 4));
    more("ul", vec4(NumberBase::Float).array(8));
    more("ui", Type::INT);
    more("KF", Type::FLOAT);
    more("KV", Type::vector(NumberBase::Float, 3));
    more("KI", Type::INT.array(5));
    more("KA", Type::vector(NumberBase::Float, 2).array(3));
    let globals: Vec<usize> = (0..list.len()).collect();
    for name in ["one", "pairs[0]", "pairs[1]"] {
        list.push((format!("{name}.first"), Type::vector(NumberBase::Float, 3)));
        list.push((format!("{name}.second"), Type::FLOAT));
        list.push((format!("{name}.third"), Type::vector(NumberBase::Int, 2)));
    }
    let members = (globals.len()..list.len()).collect();
    let variables = list.into_iter().map(|(name, kind)| Variable { name, kind }).collect();
    let ranges = Ranges { positive: 3, special: 2, small_integers: 8, unit: 5, small: 6, share: 7, turns: 17 };
    Given { program: Program { variables, ..Program::default() }, ranges, globals, members }
}

/// Their values for each pixel.
pub fn values(vectors: &[Vec<[f32; 4]>], uniforms: &GivenUniforms) -> Vec<Variables> {
    let float = |x: f32| Num::exact(f64::from(x));
    let constants: [&[f32]; 4] =
        [&[0.625], &[0.5, -1.25, 3.0], &[3.0, -1.0, 40.0, 0.0, 1000.0], &[1.0, 0.25, -2.0, 7.0, 0.0, 12.5]];
    let of_pixel = |pixel: usize| {
        let mut list: Variables =
            (0..FLOATS.len()).map(|vector| vectors[vector][pixel].map(float).into_iter().collect()).collect();
        let [small, high, low] = [8, 9, 10].map(|vector: usize| vectors[vector][pixel].map(|x| x as i64));
        let wide: [i64; 4] = std::array::from_fn(|part| high[part] * 65536 + low[part]);
        let integers = |numbers: [i64; 4]| numbers.map(|x| Num::exact(x as f64)).into_iter().collect::<GlslValue>();
        list.push(integers(small));
        list.push(integers(wide));
        list.push(integers(std::array::from_fn(|part| wrapped(wide[part] ^ small[part], NumberBase::Uint))));
        list.extend(uniforms.values());
        list.extend(constants.map(|numbers| numbers.iter().map(|x| float(*x)).collect()));
        list
    };
    (0..PIXELS).map(of_pixel).collect()
}
