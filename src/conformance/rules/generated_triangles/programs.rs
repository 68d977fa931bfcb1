//! Programs of random varyings: their texts, and what each number is of a vertex's value.

use std::fmt::Write;

use super::model::Interpolation;
use crate::conformance::random::Random;

/// A number of a varying: a part of the vertex's value, times a factor, and something added. All are exact as f32.
#[derive(Clone, Copy, Debug)]
pub struct Component {
    pub source: usize,
    pub factor: f64,
    pub added: f64,
    pub how: Interpolation,
    /// The value is an integer: rounded down after a multiplication by 64.
    pub whole: bool,
}

impl Component {
    /// The number of a vertex with this value.
    pub fn of(&self, value: [f32; 4]) -> f64 {
        let source = f64::from(value[self.source]) * if self.whole { 64.0 } else { 1.0 };
        source * self.factor + self.added
    }
}

/// Work of a program beside its varyings.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traits {
    /// It writes eight clip distances.
    pub distances: bool,
    /// gl_FragDepth is 1 - gl_FragCoord.z.
    pub depth: bool,
    /// A fragment is left out where x + 2 y is a multiple of 4.
    pub discards: bool,
    /// Qualifiers of gl_FragCoord.
    pub upper_left: bool,
    pub whole_centers: bool,
}

/// Numbers that one draw puts out beside gl_FragCoord, facing and the primitive's number.
pub const SHOWN: usize = 10;

/// Texts of a program, and its varyings' numbers.
pub struct Text {
    pub vertex: String,
    pub fragment: String,
    /// In groups of [`SHOWN`]; uniform `which` chooses one. The group after the last shows derivatives.
    pub components: Vec<Component>,
    /// Four numbers whose derivatives are shown.
    pub derived: [usize; 4],
    pub traits: Traits,
}

impl Text {
    pub fn groups(&self) -> usize {
        self.components.len().div_ceil(SHOWN)
    }

    /// Names of the varyings' kinds, for messages.
    pub fn summary(&self) -> String {
        let Traits { distances, depth, discards, upper_left, whole_centers } = self.traits;
        let named = [
            (distances, "gl_ClipDistance"),
            (depth, "gl_FragDepth"),
            (discards, "discard"),
            (upper_left, "origin_upper_left"),
            (whole_centers, "pixel_center_integer"),
        ];
        let names: Vec<_> = named.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
        let varyings = format!("{} numbers of varyings", self.components.len());
        [&[varyings.as_str()], names.as_slice()].concat().join(", ")
    }
}

/// Types of varyings: declaration before the name, after it, and each number's place in it.
const TYPES: [(&str, &str, &[&str]); 12] = [
    ("float", "", &[""]),
    ("vec2", "", &[".x", ".y"]),
    ("vec3", "", &[".x", ".y", ".z"]),
    ("vec4", "", &[".x", ".y", ".z", ".w"]),
    ("float", "[3]", &["[0]", "[1]", "[2]"]),
    ("vec2", "[2]", &["[0].x", "[0].y", "[1].x", "[1].y"]),
    ("vec3", "[2]", &["[0].x", "[0].y", "[0].z", "[1].x", "[1].y", "[1].z"]),
    ("mat2", "", &["[0].x", "[0].y", "[1].x", "[1].y"]),
    ("mat3", "", &["[0].x", "[0].y", "[0].z", "[1].x", "[1].y", "[1].z", "[2].x", "[2].y", "[2].z"]),
    ("Pair", "", &[".one", ".three.x", ".three.y", ".three.z"]),
    ("vec4", "[2]", &["[0].x", "[0].y", "[0].z", "[0].w", "[1].x", "[1].y", "[1].z", "[1].w"]),
    ("vec4", "", &[".r", ".g", ".b", ".a"]),
];

/// Types of integers: flat only.
const WHOLE: [(&str, &str, &str, &[&str]); 4] = [
    ("int", "", "int", &[""]),
    ("ivec2", "", "int", &[".x", ".y"]),
    ("uvec3", "", "uint", &[".x", ".y", ".z"]),
    ("int", "[2]", "int", &["[0]", "[1]"]),
];

/// Makes a program of at most `most` numbers in varyings.
pub fn text(dice: &mut Random, most: usize, traits: Traits) -> Text {
    let (mut declared, mut set, mut read) = (String::new(), String::new(), Vec::new());
    let mut components = Vec::new();
    // Each number takes a whole vec4 at worst where a driver does not pack what is of different kinds.
    let mut locations = 0;
    // Half of the programs begin with a number that is flat beside a vector that is not.
    let begins_flat = dice.chance(0.5);
    for number in 0.. {
        let first = if begins_flat { number } else { usize::MAX };
        let integer = dice.chance(0.15) && first > 1;
        let (kind, after, places, cast) = if integer {
            let (kind, after, cast, places) = dice.pick(&WHOLE);
            (kind, after, places, cast)
        } else {
            let (kind, after, places) = match first {
                0 => TYPES[0],
                1 => TYPES[2],
                _ => dice.pick(&TYPES),
            };
            (kind, after, places, "")
        };
        let mut rows: Vec<&str> = places.iter().map(|place| place.split(['.']).next().unwrap_or("")).collect();
        rows.dedup();
        let taken = if kind == "Pair" { 2 } else { rows.len() };
        if components.len() + places.len() > most || locations + taken > 14 {
            break;
        }
        locations += taken;
        let choice = match first {
            0 => 0,
            1 => 7,
            _ => dice.below(8),
        };
        let (qualifier, how) = match (integer, choice) {
            (true, _) | (_, 0) => ("flat", Interpolation::Flat),
            (_, 1 | 2) => ("noperspective", Interpolation::NoPerspective),
            (_, 3) => ("centroid", Interpolation::Smooth),
            (_, 4) => ("smooth", Interpolation::Smooth),
            _ => ("", Interpolation::Smooth),
        };
        let name = format!("v{number}");
        let before = if qualifier.is_empty() { String::new() } else { format!("{qualifier} ") };
        let _ = writeln!(declared, "{before}WAY {kind} {name}{after};");
        for place in places {
            let component = Component {
                source: dice.below(4),
                factor: if integer { 1.0 } else { f64::from(dice.pick(&[1.0_f32, -1.0, 2.0, 0.5, 0.25])) },
                added: f64::from(dice.whole(-8, 8)) + if cast == "uint" { 8192.0 } else { 0.0 },
                how,
                whole: integer,
            };
            let Component { source, factor, added, .. } = component;
            let source = format!("value[{source}]");
            let _ = match integer {
                true => writeln!(set, "{name}{place} = {cast}(floor({source} * 64.0) + {added:.1});"),
                false => writeln!(set, "{name}{place} = {source} * {factor:?} + {added:.1};"),
            };
            read.push(format!("float({name}{place})"));
            components.push(component);
        }
    }
    let derived = [(); 4].map(|()| dice.below(components.len()));
    let vertex = vertex(&declared, &set, traits);
    let fragment = fragment(&declared, &read, derived, traits);
    Text { vertex, fragment, components, derived, traits }
}

const HEAD: &str = "#version 330\nstruct Pair { float one; vec3 three; };\n";

fn vertex(declared: &str, set: &str, traits: Traits) -> String {
    let mut text = String::from(HEAD);
    text += "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 value;\n";
    text += "layout(location = 2) in vec4 cut0;\nlayout(location = 3) in vec4 cut1;\n";
    text += &declared.replace("WAY", "out");
    if traits.distances {
        text += "out float gl_ClipDistance[8];\n";
    }
    text += "void main() {\ngl_Position = position;\n";
    text += set;
    if traits.distances {
        text += "for (int i = 0; i < 4; i++) { gl_ClipDistance[i] = cut0[i]; gl_ClipDistance[i + 4] = cut1[i]; }\n";
    }
    text + "}\n"
}

fn fragment(declared: &str, read: &[String], derived: [usize; 4], traits: Traits) -> String {
    let mut text = String::from(HEAD);
    let qualifiers: Vec<_> = [(traits.upper_left, "origin_upper_left"), (traits.whole_centers, "pixel_center_integer")]
        .into_iter()
        .filter(|(is, _)| *is)
        .map(|(_, name)| name)
        .collect();
    if !qualifiers.is_empty() {
        let _ = writeln!(text, "layout({}) in vec4 gl_FragCoord;", qualifiers.join(", "));
    }
    text += &declared.replace("WAY", "in");
    text +=
        "uniform int which;\nout vec4 result;\nout vec4 second;\nout vec4 third;\nout vec4 fourth;\nvoid main() {\n";
    text += "result = gl_FragCoord;\nsecond = vec4(0.0); third = vec4(0.0); vec2 last = vec2(0.0);\n";
    for (index, group) in read.chunks(SHOWN).enumerate() {
        let _ = writeln!(text, "if (which == {index}) {{");
        let places = ["second.x", "second.y", "second.z", "second.w", "third.x", "third.y", "third.z", "third.w"];
        for (place, value) in places.into_iter().chain(["last.x", "last.y"]).zip(group) {
            let _ = writeln!(text, "{place} = {value};");
        }
        text += "}\n";
    }
    let [a, b, c, d] = derived.map(|index| read[index].as_str());
    let _ = writeln!(
        text,
        "if (which == {}) {{
vec4 seen = vec4({a}, {b}, {c}, {d});
second = dFdx(seen); third = dFdy(seen); last = vec2(fwidth({a}), dFdx({b} - 2.0 * {c}));
}}",
        read.len().div_ceil(SHOWN)
    );
    text += "fourth = vec4(last, gl_FrontFacing ? 1.0 : 0.0, float(gl_PrimitiveID));\n";
    if traits.depth {
        text += "gl_FragDepth = 1.0 - gl_FragCoord.z;\n";
    }
    if traits.discards {
        text += "if (((int(floor(gl_FragCoord.x)) + 2 * int(floor(gl_FragCoord.y))) & 3) == 0) discard;\n";
    }
    text + "}\n"
}
