//! Checks of a program by the rules of NV_register_combiners, which GL reports as GL_INVALID_OPERATION, GL_INVALID_VALUE
//! or GL_INVALID_ENUM. A read of a spare register that no earlier stage writes is an error, too.

use std::collections::BTreeSet;

use super::{CombinerProgram, Component, Mapping, Portion, Register, Scale, Variable};

/// Greatest number of general stages: GeForce3's. GeForce 256 and 2 have two.
pub const MOST_STAGES: usize = 8;

const VARIABLES: [&str; 7] = ["A", "B", "C", "D", "E", "F", "G"];

/// Checks a program of at most `stages` general stages. An error names stage, portion and variable.
///
/// # Errors
///
/// The first rule that is broken.
pub fn check(program: &CombinerProgram, stages: usize) -> Result<(), String> {
    if !(1..=stages).contains(&program.stages.len()) {
        return Err(format!("has {} general stages; a program has 1 to {stages}", program.stages.len()));
    }
    // Spares have no value before they are written.
    let mut written: BTreeSet<(Register, bool)> = BTreeSet::new();
    for (number, stage) in program.stages.iter().enumerate() {
        let before = written.clone();
        for (portion, is_rgb) in [(&stage.rgb, true), (&stage.alpha, false)] {
            let Some(portion) = portion else { continue };
            let place = format!("stage {number}, {}", if is_rgb { "rgb" } else { "alpha" });
            for (input, name) in portion.inputs.iter().zip(VARIABLES) {
                check_general(input, is_rgb).map_err(|why| format!("{place}, variable {name}: {why}"))?;
                check_written(input, is_rgb, &before).map_err(|why| format!("{place}, variable {name}: {why}"))?;
            }
            check_outputs(portion, is_rgb).map_err(|why| format!("{place}: {why}"))?;
            written.extend(portion.outputs.into_iter().flatten().map(|register| (register, is_rgb)));
        }
    }
    for (index, (input, name)) in program.last.inputs.iter().zip(VARIABLES).enumerate() {
        let why = check_final(input, index).and_then(|()| {
            let sum = Variable { register: Register::Spare0, component: Component::Rgb, ..*input };
            let read = if input.register == Register::ColorSum { &sum } else { input };
            check_written(read, index < 6, &written)
        });
        why.map_err(|why| format!("final combiner, variable {name}: {why}"))?;
    }
    Ok(())
}

fn check_general(input: &Variable, is_rgb: bool) -> Result<(), String> {
    if matches!(input.register, Register::Product | Register::ColorSum) {
        return Err(format!("{} is a register of the final combiner only", input.register));
    }
    match (input.component, is_rgb) {
        (Component::Blue, true) => return Err(String::from("an rgb portion reads .rgb or .a")),
        (Component::Rgb, false) => return Err(String::from("an alpha portion reads .a or .b")),
        _ => {}
    }
    if input.register == Register::Fog && input.component == Component::Alpha {
        return Err(String::from("the alpha of fog is readable in the final combiner only"));
    }
    check_unit(input.register)
}

fn check_unit(register: Register) -> Result<(), String> {
    match register {
        Register::Texture(unit) if unit > 3 => Err(format!("there is no tex{unit}: texture units are 0 to 3")),
        _ => Ok(()),
    }
}

/// An error for a spare register that no earlier stage has written.
fn check_written(input: &Variable, is_rgb: bool, written: &BTreeSet<(Register, bool)>) -> Result<(), String> {
    let reads_rgb = is_rgb && input.component == Component::Rgb || input.component == Component::Blue;
    let is_spare = matches!(input.register, Register::Spare0 | Register::Spare1);
    if !is_spare || written.contains(&(input.register, reads_rgb)) {
        return Ok(());
    }
    let part = if reads_rgb { "rgb" } else { "a" };
    Err(format!("reads {}.{part}, which no stage before it writes", input.register))
}

fn check_outputs(portion: &Portion, is_rgb: bool) -> Result<(), String> {
    let registers: Vec<Register> = portion.outputs.into_iter().flatten().collect();
    for (index, register) in registers.iter().enumerate() {
        let is_writable = matches!(
            register,
            Register::Color0 | Register::Color1 | Register::Texture(_) | Register::Spare0 | Register::Spare1
        );
        if !is_writable {
            return Err(format!("{register} cannot be written"));
        }
        check_unit(*register)?;
        if registers[..index].contains(register) {
            return Err(format!("writes {register} twice"));
        }
    }
    let has_dot = portion.dots.contains(&true);
    if has_dot && !is_rgb {
        return Err(String::from("an alpha portion has no dot products"));
    }
    if has_dot && portion.outputs[2].is_some() {
        return Err(String::from("has a dot product and a sum; a portion has only one of them"));
    }
    if portion.biased && matches!(portion.scale, Scale::Half | Scale::Four) {
        return Err(String::from("a bias needs a scale of one or two"));
    }
    Ok(())
}

fn check_final(input: &Variable, index: usize) -> Result<(), String> {
    if !matches!(input.mapping, Mapping::Unsigned | Mapping::UnsignedInvert) {
        return Err(String::from("the final combiner maps by unsigned or unsigned_invert only"));
    }
    let is_own = matches!(input.register, Register::Product | Register::ColorSum);
    if is_own && index > 3 {
        return Err(format!("{} is readable by A, B, C and D only", input.register));
    }
    if is_own && input.component != Component::Rgb {
        return Err(format!("{} has no alpha", input.register));
    }
    match (input.component, index < 6) {
        (Component::Blue, true) => return Err(String::from("A to F read .rgb or .a")),
        (Component::Rgb, false) => return Err(String::from("G reads .a or .b")),
        _ => {}
    }
    check_unit(input.register)
}
