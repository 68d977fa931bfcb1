//! A program as GLSL: straight code, a function of the registers' first values. A portion that nothing reads is left out, and
//! so is a clamp that no value can need.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::ranges::{Range, Ranges};
use super::{CombinerProgram, Component, Mapping, Portion, Precision, Register, Scale, Variable};

/// A register's RGB, or its alpha.
type Part = (Register, bool);

/// Portions whose results nothing reads, each as "stage 2, alpha"; stages are counted from 0.
pub fn unread(program: &CombinerProgram) -> Vec<String> {
    let kept = kept(program);
    let mut unread = Vec::new();
    for (number, (stage, kept)) in program.stages.iter().zip(&kept).enumerate() {
        for (portion, kept, name) in [(&stage.rgb, kept[0], "rgb"), (&stage.alpha, kept[1], "alpha")] {
            if portion.is_some() && !kept {
                unread.push(format!("stage {number}, {name}"));
            }
        }
    }
    unread
}

/// GLSL of the function `vec4 combine(vec4 const0, …, vec4 tex3)` and of those that it calls. Arguments: constants, fog,
/// two colours, the four textures; result: RGBA of the final combiner in [0, 1]. The program's own constants replace the
/// arguments. Arguments must lie in [0, 1]. The macro `REGISTER` qualifies what is written to registers: where `EXACT` is
/// `precise`, `#define REGISTER EXACT` makes every driver round as the interpreter does. It is nothing by default for floats,
/// as no colour shows their last bit; nine bits show it where they round.
pub fn fragment(program: &CombinerProgram, precision: Precision) -> String {
    let mut code = String::from(match precision {
        Precision::Float => {
            "#ifndef REGISTER\n#define REGISTER\n#endif\nfloat kept(float x) { return x; }\nvec3 kept(vec3 x) { return x; }\n"
        }
        Precision::NineBits => {
            "#ifndef REGISTER\n#define REGISTER EXACT\n#endif\n\
             float kept(float x) { return floor(x * 255.0 + 0.5) / 255.0; }\n\
             vec3 kept(vec3 x) { return floor(x * 255.0 + 0.5) / 255.0; }\n"
        }
    });
    code.push_str(
        "vec4 combine(vec4 const0, vec4 const1, vec4 fog, vec4 col0, vec4 col1, vec4 tex0, vec4 tex1, vec4 tex2, vec4 tex3)\n{\n\
         \x20   vec4 zero = vec4(0.0), spare0 = zero, spare1 = zero;\n",
    );
    constants(&mut code, &program.constants);
    let kept = kept(program);
    let mut ranges = Ranges::new(&program.constants);
    for (number, (stage, kept)) in program.stages.iter().zip(&kept).enumerate() {
        let rgb = stage.rgb.as_ref().filter(|_| kept[0]);
        let alpha = stage.alpha.as_ref().filter(|_| kept[1]);
        if rgb.is_none() && alpha.is_none() {
            continue;
        }
        let _ = writeln!(code, "    {{ // stage {number}");
        // Its own constants end with the stage.
        for (index, value) in stage.constants.iter().enumerate() {
            if let Some(value) = value {
                let _ = writeln!(code, "    vec4 const{index} = {};", vector(value));
            }
        }
        let mut writes = String::new();
        let before = ranges.within(&stage.constants);
        for (portion, is_rgb) in
            rgb.into_iter().map(|portion| (portion, true)).chain(alpha.map(|portion| (portion, false)))
        {
            general(&mut code, &mut writes, portion, is_rgb, &before);
            ranges.write(portion, is_rgb, &before);
        }
        let _ = writeln!(code, "{writes}    }}");
    }
    finish(&mut code, program, ranges);
    code
}

fn constants(code: &mut String, constants: &[Option<[f32; 4]>; 2]) {
    for (index, value) in constants.iter().enumerate() {
        if let Some(value) = value {
            let _ = writeln!(code, "    const{index} = {};", vector(value));
        }
    }
}

fn vector([red, green, blue, alpha]: &[f32; 4]) -> String {
    format!("vec4({red:?}, {green:?}, {blue:?}, {alpha:?})")
}

/// Reads and products of a portion into `code`; its writes, which come after all reads of the stage, into `writes`.
fn general(code: &mut String, writes: &mut String, portion: &Portion, is_rgb: bool, ranges: &Ranges) {
    let (kind, suffix, name) = if is_rgb { ("vec3", "rgb", "") } else { ("float", "a", "_a") };
    let inputs = portion.inputs.map(|input| (read(input, is_rgb, ranges), ranges.of(input)));
    let [needs_ab, needs_cd, needs_sum] = portion.outputs.map(|output| output.is_some());
    let product = |[(x, of_x), (y, of_y)]: [&(String, Range); 2], dot: bool| match (dot, *of_x, *of_y) {
        // In this order, as the interpreter adds.
        (true, ..) => format!("vec3(({x} * {y}).r + ({x} * {y}).g + ({x} * {y}).b)"),
        (false, Range::ONE, _) => y.clone(),
        (false, _, Range::ONE) => x.clone(),
        (false, ..) => format!("{x} * {y}"),
    };
    let [a, b, c, d] = &inputs;
    if needs_ab || needs_sum {
        let _ = writeln!(code, "    REGISTER {kind} ab{name} = {};", product([a, b], portion.dots[0]));
    }
    if needs_cd || needs_sum {
        let _ = writeln!(code, "    REGISTER {kind} cd{name} = {};", product([c, d], portion.dots[1]));
    }
    if needs_sum {
        let _ = writeln!(code, "    REGISTER {kind} sum{name} = ab{name} + cd{name};");
    }
    let unclamped = ranges.results(portion);
    for ((output, value), range) in portion.outputs.into_iter().zip(["ab", "cd", "sum"]).zip(unclamped) {
        if let Some(register) = output {
            let mut result = format!("{value}{name}");
            if portion.biased {
                result = format!("({result} - 0.5)");
            }
            if portion.scale != Scale::One {
                result = format!("{result} * {:?}", portion.scale.factor());
            }
            let clamped = range.clamped(result, -1.0, 1.0);
            let _ = writeln!(writes, "    {register}.{suffix} = kept({clamped});");
        }
    }
}

fn finish(code: &mut String, program: &CombinerProgram, mut ranges: Ranges) {
    let [a, b, c, d, e, f, g] = program.last.inputs;
    let reads = |wanted: Register| [a, b, c, d].iter().any(|input| input.register == wanted);
    if reads(Register::Product) {
        let _ = writeln!(code, "    REGISTER vec3 product = {} * {};", read(e, true, &ranges), read(f, true, &ranges));
        ranges.write_final(Register::Product, ranges.final_product(e, f));
        code.push_str("    vec4 final_product = vec4(kept(product), 0.0);\n");
    }
    if reads(Register::ColorSum) {
        let most = if program.last.clamps_sum { 1.0 } else { f32::INFINITY };
        let range = ranges.color_sum();
        let sum = range.clamped(String::from("(spare0.rgb + col1.rgb)"), 0.0, most);
        ranges.write_final(Register::ColorSum, range.map(|value| value.clamp(0.0, most)));
        let _ = writeln!(code, "    vec4 color_sum = vec4({sum}, 0.0);");
    }
    let of_c = ranges.of(c);
    let mixed = ranges.mixed([a, b, c, d]).clamped(String::from("mixed"), 0.0, 1.0);
    let [a, b, c, d] = [a, b, c, d].map(|input| read(input, true, &ranges));
    let rest = if of_c == Range::ZERO { String::new() } else { format!(" + (1.0 - {a}) * {c}") };
    let _ = writeln!(code, "    REGISTER vec3 mixed = {a} * {b}{rest} + {d};");
    let alpha = ranges.of(g).clamped(read(g, false, &ranges), 0.0, 1.0);
    let _ = writeln!(code, "    return vec4(kept({mixed}), kept({alpha}));\n}}");
}

/// An input's expression: a vec3, or a float in an alpha portion.
fn read(input: Variable, is_rgb: bool, ranges: &Ranges) -> String {
    let register = input.register;
    let value = match (input.component, is_rgb) {
        (Component::Rgb, _) => format!("{register}.rgb"),
        (Component::Alpha, true) => format!("vec3({register}.a)"),
        (Component::Alpha, false) => format!("{register}.a"),
        (Component::Blue, _) => format!("{register}.b"),
    };
    let range = ranges.before_mapping(input);
    let positive = if range.least >= 0.0 { value.clone() } else { format!("max({value}, 0.0)") };
    match input.mapping {
        Mapping::Unsigned => positive,
        Mapping::UnsignedInvert if range.least >= 0.0 && range.most <= 1.0 => format!("(1.0 - {value})"),
        Mapping::UnsignedInvert => format!("(1.0 - clamp({value}, 0.0, 1.0))"),
        Mapping::Expand => format!("(2.0 * {positive} - 1.0)"),
        Mapping::ExpandNegate => format!("(1.0 - 2.0 * {positive})"),
        Mapping::HalfBias => format!("({positive} - 0.5)"),
        Mapping::HalfBiasNegate => format!("(0.5 - {positive})"),
        Mapping::Signed => value,
        Mapping::SignedNegate => format!("(-{value})"),
    }
}

/// For each stage, whether its RGB portion and its alpha portion write something that is read later.
fn kept(program: &CombinerProgram) -> Vec<[bool; 2]> {
    let mut needed: BTreeSet<Part> = BTreeSet::new();
    let [a, b, c, d, e, f, g] = program.last.inputs;
    let reads = |wanted: Register| [a, b, c, d].iter().any(|input| input.register == wanted);
    for input in [a, b, c, d] {
        needed.insert(part(input));
    }
    if reads(Register::Product) {
        needed.extend([e, f].map(part));
    }
    if reads(Register::ColorSum) {
        needed.extend([(Register::Spare0, true), (Register::Color1, true)]);
    }
    needed.insert(part(g));
    let mut kept = Vec::new();
    for stage in program.stages.iter().rev() {
        let portions = [(&stage.rgb, true), (&stage.alpha, false)];
        let written = |portion: &Option<Portion>, is_rgb: bool| -> Vec<Part> {
            let outputs = portion.iter().flat_map(|portion| portion.outputs.into_iter().flatten());
            outputs.map(|register| (register, is_rgb)).collect()
        };
        let used = portions.map(|(portion, is_rgb)| written(portion, is_rgb).iter().any(|part| needed.contains(part)));
        for ((portion, is_rgb), used) in portions.into_iter().zip(used) {
            if used {
                written(portion, is_rgb).iter().for_each(|part| {
                    needed.remove(part);
                });
            }
        }
        for ((portion, _), used) in portions.into_iter().zip(used) {
            if let Some(portion) = portion.as_ref().filter(|_| used) {
                needed.extend(portion.inputs.map(part));
            }
        }
        kept.push(used);
    }
    kept.reverse();
    kept
}

fn part(input: Variable) -> Part {
    (input.register, input.component != Component::Alpha)
}
