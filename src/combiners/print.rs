//! A program as text, in the notation that [`super::parse`] reads.

use std::fmt;

use super::{CombinerProgram, Component, Final, Mapping, Portion, Register, Scale, Variable};

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Zero => f.write_str("zero"),
            Self::Constant0 => f.write_str("const0"),
            Self::Constant1 => f.write_str("const1"),
            Self::Fog => f.write_str("fog"),
            Self::Color0 => f.write_str("col0"),
            Self::Color1 => f.write_str("col1"),
            Self::Texture(unit) => write!(f, "tex{unit}"),
            Self::Spare0 => f.write_str("spare0"),
            Self::Spare1 => f.write_str("spare1"),
            Self::Product => f.write_str("final_product"),
            Self::ColorSum => f.write_str("color_sum"),
        }
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [before, behind] = match self.mapping {
            Mapping::Unsigned => ["unsigned(", ")"],
            Mapping::UnsignedInvert => ["unsigned_invert(", ")"],
            Mapping::Expand => ["expand(", ")"],
            Mapping::ExpandNegate => ["-expand(", ")"],
            Mapping::HalfBias => ["half_bias(", ")"],
            Mapping::HalfBiasNegate => ["-half_bias(", ")"],
            Mapping::Signed => ["", ""],
            Mapping::SignedNegate => ["-", ""],
        };
        let part = match self.component {
            Component::Rgb => "rgb",
            Component::Blue => "b",
            Component::Alpha => "a",
        };
        write!(f, "{before}{}.{part}{behind}", self.register)
    }
}

impl fmt::Display for CombinerProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "!!RC1.0")?;
        constants(f, "", &self.constants)?;
        for stage in &self.stages {
            writeln!(f, "{{")?;
            constants(f, "  ", &stage.constants)?;
            for (name, portion) in [("rgb", &stage.rgb), ("alpha", &stage.alpha)] {
                if let Some(portion) = portion {
                    writeln!(f, "  {name} {{")?;
                    portion_lines(f, portion)?;
                    writeln!(f, "  }}")?;
                }
            }
            writeln!(f, "}}")?;
        }
        final_lines(f, &self.last)
    }
}

fn constants(f: &mut fmt::Formatter<'_>, indent: &str, constants: &[Option<[f32; 4]>; 2]) -> fmt::Result {
    for (index, value) in constants.iter().enumerate() {
        if let Some([red, green, blue, alpha]) = value {
            writeln!(f, "{indent}const{index} = ({red:?}, {green:?}, {blue:?}, {alpha:?});")?;
        }
    }
    Ok(())
}

fn portion_lines(f: &mut fmt::Formatter<'_>, portion: &Portion) -> fmt::Result {
    let name = |register: Option<Register>| register.map_or(String::from("discard"), |register| register.to_string());
    let [a, b, c, d] = portion.inputs;
    let [ab, cd, sum] = portion.outputs;
    let sign = |dot: bool| if dot { '.' } else { '*' };
    writeln!(f, "    {} = {a} {} {b};", name(ab), sign(portion.dots[0]))?;
    writeln!(f, "    {} = {c} {} {d};", name(cd), sign(portion.dots[1]))?;
    if let Some(sum) = sum {
        writeln!(f, "    {sum} = sum();")?;
    }
    match (portion.biased, portion.scale) {
        (false, Scale::One) => Ok(()),
        (true, Scale::One) => writeln!(f, "    bias_by_negative_one_half();"),
        (true, Scale::Two) => writeln!(f, "    bias_by_negative_one_half_scale_by_two();"),
        (_, Scale::Two) => writeln!(f, "    scale_by_two();"),
        (_, Scale::Four) => writeln!(f, "    scale_by_four();"),
        (_, Scale::Half) => writeln!(f, "    scale_by_one_half();"),
    }
}

fn final_lines(f: &mut fmt::Formatter<'_>, last: &Final) -> fmt::Result {
    let [a, b, c, d, e, factor, g] = last.inputs;
    writeln!(f, "final_product = {e} * {factor};")?;
    writeln!(f, "out.rgb = lerp({a}, {b}, {c}) + {d};")?;
    writeln!(f, "out.a = {g};")?;
    if last.clamps_sum { writeln!(f, "clamp_color_sum();") } else { Ok(()) }
}
