//! Runs a program on the CPU, in f32, as the extension's text says; shares nothing with the GLSL.

use std::collections::BTreeMap;

use super::{CombinerProgram, Component, GeneralStage, Mapping, Portion, Precision, Register, Variable};

/// RGBA values of registers; an absent register is zero.
pub type Registers = BTreeMap<Register, [f32; 4]>;

/// The final combiner's colour and alpha, each in [0, 1]. `start`: the constants, the fog, the colours and the textures;
/// constants of the program replace them.
pub fn run(program: &CombinerProgram, start: &Registers, precision: Precision) -> [f32; 4] {
    let mut registers = start.clone();
    let own = [Register::Constant0, Register::Constant1].into_iter().zip(program.constants);
    registers.extend(own.filter_map(|(register, value)| Some((register, value?))));
    for stage in &program.stages {
        run_stage(stage, &mut registers, precision);
    }
    finish(program, &registers, precision)
}

fn run_stage(stage: &GeneralStage, registers: &mut Registers, precision: Precision) {
    let mut before = registers.clone();
    let own = [Register::Constant0, Register::Constant1].into_iter().zip(stage.constants);
    before.extend(own.filter_map(|(register, value)| Some((register, value?))));
    if let Some(portion) = &stage.rgb {
        let [a, b, c, d] = portion.inputs.map(|input| rgb(&before, input));
        let product = |dot: bool, x: [f32; 3], y: [f32; 3]| {
            let each = [x[0] * y[0], x[1] * y[1], x[2] * y[2]];
            if dot { [each[0] + each[1] + each[2]; 3] } else { each }
        };
        let (ab, cd) = (product(portion.dots[0], a, b), product(portion.dots[1], c, d));
        let sum = [ab[0] + cd[0], ab[1] + cd[1], ab[2] + cd[2]];
        for (output, value) in portion.outputs.into_iter().zip([ab, cd, sum]) {
            if let Some(register) = output {
                let entry = registers.entry(register).or_default();
                for channel in 0..3 {
                    entry[channel] = result(portion, value[channel], precision);
                }
            }
        }
    }
    if let Some(portion) = &stage.alpha {
        let [a, b, c, d] = portion.inputs.map(|input| scalar(&before, input));
        let (ab, cd) = (a * b, c * d);
        for (output, value) in portion.outputs.into_iter().zip([ab, cd, ab + cd]) {
            if let Some(register) = output {
                registers.entry(register).or_default()[3] = result(portion, value, precision);
            }
        }
    }
}

/// Bias, scale and clamp of a portion.
fn result(portion: &Portion, value: f32, precision: Precision) -> f32 {
    let value = if portion.biased { value - 0.5 } else { value };
    rounded((value * portion.scale.factor()).clamp(-1.0, 1.0), precision)
}

fn rounded(value: f32, precision: Precision) -> f32 {
    match precision {
        Precision::Float => value,
        Precision::NineBits => (value * 255.0 + 0.5).floor() / 255.0,
    }
}

fn finish(program: &CombinerProgram, registers: &Registers, precision: Precision) -> [f32; 4] {
    let mut registers = registers.clone();
    let [a, b, c, d, e, f, g] = program.last.inputs;
    let (e, f) = (rgb(&registers, e), rgb(&registers, f));
    let product = [0, 1, 2].map(|channel| rounded(e[channel] * f[channel], precision));
    let [spare, color] = [Register::Spare0, Register::Color1].map(|name| value(&registers, name));
    let sum = [0, 1, 2].map(|channel| {
        let sum = (spare[channel] + color[channel]).max(0.0);
        if program.last.clamps_sum { sum.min(1.0) } else { sum }
    });
    registers.insert(Register::Product, [product[0], product[1], product[2], 0.0]);
    registers.insert(Register::ColorSum, [sum[0], sum[1], sum[2], 0.0]);
    let [a, b, c, d] = [a, b, c, d].map(|input| rgb(&registers, input));
    let color = [0, 1, 2].map(|channel| {
        let sum = a[channel] * b[channel] + (1.0 - a[channel]) * c[channel] + d[channel];
        rounded(sum.clamp(0.0, 1.0), precision)
    });
    [color[0], color[1], color[2], rounded(scalar(&registers, g).clamp(0.0, 1.0), precision)]
}

fn value(registers: &Registers, register: Register) -> [f32; 4] {
    registers.get(&register).copied().unwrap_or_default()
}

fn rgb(registers: &Registers, input: Variable) -> [f32; 3] {
    let [red, green, blue, alpha] = value(registers, input.register);
    let channels = if input.component == Component::Alpha { [alpha; 3] } else { [red, green, blue] };
    channels.map(|channel| mapped(input.mapping, channel))
}

fn scalar(registers: &Registers, input: Variable) -> f32 {
    let [_, _, blue, alpha] = value(registers, input.register);
    mapped(input.mapping, if input.component == Component::Alpha { alpha } else { blue })
}

/// Table NV_register_combiners.4.
fn mapped(mapping: Mapping, e: f32) -> f32 {
    match mapping {
        Mapping::Unsigned => e.max(0.0),
        Mapping::UnsignedInvert => 1.0 - e.clamp(0.0, 1.0),
        Mapping::Expand => 2.0 * e.max(0.0) - 1.0,
        Mapping::ExpandNegate => -2.0 * e.max(0.0) + 1.0,
        Mapping::HalfBias => e.max(0.0) - 0.5,
        Mapping::HalfBiasNegate => -e.max(0.0) + 0.5,
        Mapping::Signed => e,
        Mapping::SignedNegate => -e,
    }
}
