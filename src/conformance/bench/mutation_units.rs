//! Mistakes in the texture environments of the fixed-function pipeline.

use super::environment::{GlArgument, GlCombine, GlCombiner, GlEnvironment, GlOperand, GlSource, GlUnit};
use super::mutation::Mutation;

impl Mutation {
    pub(super) fn units<'a>(self, units: &[GlUnit<'a>]) -> Vec<GlUnit<'a>> {
        let mut units: Vec<_> =
            units.iter().map(|unit| GlUnit { environment: self.environment(unit.environment), ..*unit }).collect();
        if self == Self::Dot3WithoutFour
            && let Some(last) = units.last().copied()
            && matches!(last.environment.rgb.function, GlCombine::Dot3Rgb | GlCombine::Dot3Rgba)
        {
            // No environment divides: one more unit takes a quarter.
            units.push(GlUnit { environment: quarter(last.environment.rgb.function), ..last });
        }
        units
    }

    fn environment(self, environment: GlEnvironment) -> GlEnvironment {
        let combiner = |combiner: GlCombiner| GlCombiner {
            function: match (self, combiner.function) {
                (Self::Dot3AsModulate, GlCombine::Dot3Rgb | GlCombine::Dot3Rgba) => GlCombine::Modulate,
                (Self::AddSignedAsAdd, GlCombine::AddSigned) => GlCombine::Add,
                (_, function) => function,
            },
            arguments: combiner.arguments.map(|argument| self.argument(argument)),
            scale: if self == Self::CombineScaleIgnored { 1 } else { combiner.scale },
        };
        GlEnvironment { rgb: combiner(environment.rgb), alpha: combiner(environment.alpha), ..environment }
    }

    fn argument(self, argument: GlArgument) -> GlArgument {
        match (self, argument) {
            (Self::CrossbarIgnored, GlArgument { source: GlSource::Crossbar(_), .. }) => {
                GlArgument { source: GlSource::Texture, ..argument }
            }
            (Self::ComplementIgnored, GlArgument { operand: GlOperand::OneMinusAlpha, .. }) => {
                GlArgument { operand: GlOperand::Alpha, ..argument }
            }
            _ => argument,
        }
    }
}

/// A quarter of what DOT3 wrote.
fn quarter(dot: GlCombine) -> GlEnvironment {
    let [previous, constant] = [GlSource::Previous, GlSource::Constant].map(GlArgument::of);
    let modulate = GlCombiner { function: GlCombine::Modulate, arguments: [previous, constant, previous], scale: 1 };
    let alpha = if dot == GlCombine::Dot3Rgba { modulate } else { GlCombiner::replace(GlSource::Previous) };
    GlEnvironment { rgb: modulate, alpha, constant: [0.25; 4] }
}
