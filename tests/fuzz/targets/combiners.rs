//! Programs of register combiners: read, checked, printed, read again, run, made GLSL of.
#![no_main]

use glumbra::combiners::{self, MOST_STAGES, Precision, Register, Registers};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(program) = combiners::parse(text) else { return };
    let again = combiners::parse(&program.to_string());
    // Printed and read again it is the same, but for constants that are no numbers.
    let is_finite = |constants: &[Option<[f32; 4]>; 2]| constants.iter().flatten().flatten().all(|part| part.is_finite());
    if is_finite(&program.constants) && program.stages.iter().all(|stage| is_finite(&stage.constants)) {
        assert_eq!(again.as_ref(), Ok(&program), "{program}");
    }
    if combiners::check(&program, MOST_STAGES).is_err() {
        return;
    }
    let start = Registers::from([(Register::Texture(0), [0.25, 0.5, 1.0, 0.75]), (Register::Color0, [1.0; 4])]);
    for precision in [Precision::Float, Precision::NineBits] {
        let found = combiners::run(&program, &start, precision);
        assert!(found.iter().all(|part| (0.0..=1.0).contains(part)), "{found:?} of {program}");
        assert!(!combiners::fragment(&program, precision).is_empty());
    }
    let _ = combiners::unread(&program);
});
