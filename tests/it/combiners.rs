//! Register combiners: the text, the extension's rules, and GLSL against an interpreter, bit for bit.

use std::collections::BTreeSet;

use glam::Vec4;
use glumbra::combiners::{
    self, CombinerProgram, Component, Final, GeneralStage, MOST_STAGES, Mapping, Portion, Precision, Register,
    Registers, Scale, Variable,
};
use glumbra::context::{self, ContextRequest};
use glumbra::device::{Device, Measure, Pixels};
use glumbra::lights::whole_target;
use glumbra::pass::{
    self, Attribute, Batch, Chunk, Clear, DrawPass, DrawState, FixedFunctionDesc, Format, ImageDesc, ImageId, Pass,
    PassList, Redraw, Storage, Target, Uniform, UniformValue, Work,
};

const TALK: &str = include_str!("../../data/combiners/gdc2001.rc");

/// Registers that have values before the first stage.
const STARTS: [Register; 9] = [
    Register::Constant0,
    Register::Constant1,
    Register::Fog,
    Register::Color0,
    Register::Color1,
    Register::Texture(0),
    Register::Texture(1),
    Register::Texture(2),
    Register::Texture(3),
];
const WRITABLE: [Register; 8] = [
    Register::Color0,
    Register::Color1,
    Register::Texture(0),
    Register::Texture(1),
    Register::Texture(2),
    Register::Texture(3),
    Register::Spare0,
    Register::Spare1,
];

/// Makes programs that the extension allows.
struct Maker {
    random: fastrand::Rng,
    /// Spares that have been written: the register, and whether its RGB.
    written: BTreeSet<(Register, bool)>,
}

impl Maker {
    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.random.usize(0..choices.len())]
    }

    fn color(&mut self) -> [f32; 4] {
        [(); 4].map(|()| self.random.f32())
    }

    fn constants(&mut self) -> [Option<[f32; 4]>; 2] {
        [(); 2].map(|()| (self.random.usize(0..4) == 0).then(|| self.color()))
    }

    fn input(&mut self, is_rgb: bool) -> Variable {
        loop {
            let component = self.one_of(if is_rgb {
                &[Component::Rgb, Component::Rgb, Component::Alpha]
            } else {
                &[Component::Blue, Component::Alpha]
            });
            let register = self.one_of(&[&STARTS[..], &[Register::Zero, Register::Spare0, Register::Spare1]].concat());
            let is_spare = matches!(register, Register::Spare0 | Register::Spare1);
            let part = (register, component != Component::Alpha);
            if is_spare && !self.written.contains(&part) || part == (Register::Fog, false) {
                continue;
            }
            return Variable { register, mapping: self.one_of(&Mapping::ALL), component };
        }
    }

    fn portion(&mut self, is_rgb: bool) -> Option<Portion> {
        if self.random.usize(0..6) == 0 {
            return None;
        }
        let dots = if is_rgb { [(); 2].map(|()| self.random.usize(0..3) == 0) } else { [false; 2] };
        let mut free = WRITABLE.to_vec();
        let mut outputs = [None; 3];
        for (index, output) in outputs.iter_mut().enumerate() {
            let is_sum_beside_dot = index == 2 && dots.contains(&true);
            if !is_sum_beside_dot && self.random.bool() {
                *output = Some(free.swap_remove(self.random.usize(0..free.len())));
            }
        }
        let biased = self.random.usize(0..3) == 0;
        let scale = self.one_of(if biased {
            &[Scale::One, Scale::Two][..]
        } else {
            &[Scale::Half, Scale::One, Scale::Two, Scale::Four]
        });
        Some(Portion { inputs: [(); 4].map(|()| self.input(is_rgb)), outputs, dots, biased, scale })
    }

    fn program(&mut self) -> CombinerProgram {
        self.written.clear();
        let stages = (0..self.random.usize(1..=MOST_STAGES))
            .map(|_| {
                let stage =
                    GeneralStage { constants: self.constants(), rgb: self.portion(true), alpha: self.portion(false) };
                for (portion, is_rgb) in [(&stage.rgb, true), (&stage.alpha, false)] {
                    let outputs = portion.iter().flat_map(|portion| portion.outputs.into_iter().flatten());
                    self.written.extend(outputs.map(|register| (register, is_rgb)));
                }
                stage
            })
            .collect();
        let has_sum = self.written.contains(&(Register::Spare0, true));
        let mut inputs = [0, 1, 2, 3, 4, 5].map(|_| self.input(true)).to_vec();
        inputs.push(self.input(false));
        for (index, input) in inputs.iter_mut().enumerate() {
            input.mapping = self.one_of(&[Mapping::Unsigned, Mapping::UnsignedInvert]);
            if index < 4 && self.random.usize(0..3) == 0 {
                let register = if has_sum && self.random.bool() { Register::ColorSum } else { Register::Product };
                *input = Variable { register, component: Component::Rgb, ..*input };
            }
        }
        let last = Final { inputs: inputs.try_into().unwrap(), clamps_sum: self.random.bool() };
        CombinerProgram { constants: self.constants(), stages, last }
    }
}

fn maker(seed: u64) -> Maker {
    Maker { random: fastrand::Rng::with_seed(seed), written: BTreeSet::new() }
}

#[test]
fn programs_are_printed_and_read_again() {
    let talk = combiners::parse(TALK).unwrap();
    combiners::check(&talk, 4).unwrap();
    assert_eq!(talk.stages.len(), 4);
    assert_eq!(combiners::unread(&talk), Vec::<String>::new());
    assert_eq!(combiners::parse(&talk.to_string()).unwrap(), talk);
    let mut maker = maker(11);
    for _ in 0..300 {
        let program = maker.program();
        combiners::check(&program, MOST_STAGES).unwrap_or_else(|error| panic!("{error}:\n{program}"));
        let mut again = combiners::parse(&program.to_string()).unwrap_or_else(|error| panic!("{error}:\n{program}"));
        // A portion's product that is discarded is written all the same: nothing else can differ.
        again.last.clamps_sum = program.last.clamps_sum;
        assert_eq!(again, program);
    }
}

/// Each mapping at values within and beyond [-1, 1], by the extension's table.
#[test]
fn mappings_are_exact() {
    let values = [-1.5_f32, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0];
    for (mapping, expected) in [
        (Mapping::Unsigned, [0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 1.0]),
        (Mapping::UnsignedInvert, [1.0, 1.0, 1.0, 1.0, 0.75, 0.5, 0.0]),
        (Mapping::Expand, [-1.0, -1.0, -1.0, -1.0, -0.5, 0.0, 1.0]),
        (Mapping::ExpandNegate, [1.0, 1.0, 1.0, 1.0, 0.5, 0.0, -1.0]),
        (Mapping::HalfBias, [-0.5, -0.5, -0.5, -0.5, -0.25, 0.0, 0.5]),
        (Mapping::HalfBiasNegate, [0.5, 0.5, 0.5, 0.5, 0.25, 0.0, -0.5]),
        // -1.5 is clamped when it is written.
        (Mapping::Signed, [-1.0, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0]),
        (Mapping::SignedNegate, [1.0, 1.0, 0.5, 0.0, -0.25, -0.5, -1.0]),
    ] {
        for (value, expected) in values.into_iter().zip(expected) {
            // spare0 = mapped (1 - 0), then half of it plus a half: readable in [0, 1].
            let shown = 0.5 * expected + 0.5;
            let found = through(mapping, value);
            assert_eq!(found, shown, "{mapping:?} of {value}");
        }
    }
}

/// 1/2 + 1/2 of a mapped value, by a program that has it in tex0.
fn through(mapping: Mapping, value: f32) -> f32 {
    let input = |register, mapping| Variable { register, mapping, component: Component::Rgb };
    let one = input(Register::Zero, Mapping::UnsignedInvert);
    let zero = input(Register::Zero, Mapping::Unsigned);
    let stage = |inputs, scale| GeneralStage {
        rgb: Some(Portion {
            inputs,
            outputs: [None, None, Some(Register::Spare0)],
            dots: [false; 2],
            biased: false,
            scale,
        }),
        ..GeneralStage::default()
    };
    let first = stage([input(Register::Texture(0), mapping), one, zero, zero], Scale::One);
    let second = stage([input(Register::Spare0, Mapping::Signed), one, one, one], Scale::Half);
    let spare = input(Register::Spare0, Mapping::Unsigned);
    let alpha = Variable { component: Component::Alpha, ..zero };
    let last = Final { inputs: [zero, zero, zero, spare, zero, zero, alpha], clamps_sum: false };
    let program = CombinerProgram { constants: [None; 2], stages: vec![first, second], last };
    combiners::check(&program, 2).unwrap();
    combiners::run(&program, &Registers::from([(Register::Texture(0), [value; 4])]), Precision::Float)[0]
}

#[test]
fn what_the_extension_refuses_names_its_place() {
    let with = |from: &str, to: &str| {
        assert!(TALK.contains(from), "{from}");
        TALK.replacen(from, to, 1)
    };
    for (text, expected) in [
        (with("spare0 = sum();", "spare0 = sum();\n bias_by_negative_one_half();"), ""),
        (
            with("spare1 = expand(tex0) . expand(tex2);", "spare0 = expand(tex0) . expand(tex2);"),
            "stage 0, rgb: writes spare0 twice",
        ),
        (
            with("spare1 = expand(tex0) . expand(tex2);", "discard = zero * zero;\n spare1 = sum();"),
            "stage 0, rgb: has a dot product and a sum",
        ),
        (with("expand(tex1.b) *", "expand(tex1.rgb) *"), "stage 0, alpha, variable A: an alpha portion reads .a or .b"),
        (with("expand(tex0) .", "expand(tex0.b) ."), "stage 0, rgb, variable A: an rgb portion reads .rgb or .a"),
        (with("expand(tex0) .", "expand(fog.a) ."), "stage 0, rgb, variable A: the alpha of fog"),
        (
            with("expand(tex0) .", "spare1 ."),
            "stage 0, rgb, variable A: reads spare1.rgb, which no stage before it writes",
        ),
        (with("col0 = unsigned(tex3)", "const0 = unsigned(tex3)"), "stage 1, rgb: const0 cannot be written"),
        (
            with("unsigned(tex3) * unsigned(col0)", "unsigned(tex3) . unsigned(color_sum)"),
            "stage 1, rgb, variable D: color_sum is a register of the final",
        ),
        (
            with("spare1.a * spare1;", "expand(spare1.a) * spare1;"),
            "final combiner, variable E: the final combiner maps by",
        ),
        (
            with("final_product = spare1.a *", "final_product = color_sum *"),
            "final combiner, variable E: color_sum is readable by A, B, C and D only",
        ),
        (
            with("out.a = unsigned_invert(zero);", "out.a = unsigned(tex3.rgb);"),
            "final combiner, variable G: G reads .a or .b",
        ),
    ] {
        let program = combiners::parse(&text).unwrap_or_else(|error| panic!("{error}"));
        match combiners::check(&program, MOST_STAGES) {
            // Four and a bias: the later scaling is the one that counts, as with GL's last call.
            Ok(()) => assert_eq!(expected, "", "passes:\n{text}"),
            Err(error) => assert!(!expected.is_empty() && error.starts_with(expected), "{error}: not {expected}"),
        }
    }
    let talk = combiners::parse(TALK).unwrap();
    assert!(combiners::check(&talk, 2).unwrap_err().starts_with("has 4 general stages; a program has 1 to 2"));
    for (text, line, expected) in [
        ("RC1.0\n", 1, "begins with \"RC1.0\", not with"),
        ("!!RC1.0\nout.rgb = tex9;", 2, "'tex9' is no register"),
        ("!!RC1.0\n{\n rgb {\n spare0 = col0 / col1;\n }\n}", 4, "'/' has no meaning here"),
        ("!!RC1.0\n{\n rgb {\n spare0 = mux();\n }\n}", 4, "mux() is not to be had"),
        ("!!RC1.0\n{\n rgb {\n spare0 = col0 * col1\n }\n}", 5, "'}' stands where ';' is needed"),
        ("!!RC1.0\n{\n rgb {\n spare0 = col0 * col1;", 4, "'' is no register"),
        ("!!RC1.0\n{\n gray {\n", 3, "'gray' is no portion"),
        ("!!RC1.0\nconst0 = (0, 1, 2, 0);", 2, "2 is not in [0, 1]"),
        ("!!RC1.0\n{\n rgb { spare0 = col0.r * col1; }\n}", 3, "'.r' is no component"),
        ("!!RC1.0\n{\n}\n", 3, "has no final combiner"),
        ("!!RC1.0\nout.rgb = col0;\n{", 3, "'{' does not belong to the final combiner"),
    ] {
        let error = combiners::parse(text).unwrap_err();
        assert!(error.line == line && error.what.contains(expected), "{error}: not {line}: {expected}");
    }
}

/// Pixels a program is run in, each with registers of its own.
const PIXELS: usize = 12;

/// The final colours of one program by GL, for so many sets of registers.
fn by_gl(device: &mut Device, program: &CombinerProgram, precision: Precision, sets: &[Registers]) -> Vec<[f32; 4]> {
    let chunk = |name: &'static str, text: String| Chunk { name: name.into(), text: text.into() };
    let main = format!(
        "uniform vec4 registers[{}];\nout vec4 fragment;\nvoid main()\n{{\n    int at = {} * int(gl_FragCoord.x);\n    \
         fragment = combine({});\n}}\n",
        PIXELS * STARTS.len(),
        STARTS.len(),
        (0..STARTS.len()).map(|index| format!("registers[at + {index}]")).collect::<Vec<_>>().join(", ")
    );
    let flat: Vec<Vec4> = sets
        .iter()
        .flat_map(|set| STARTS.map(|register| Vec4::from_array(set.get(&register).copied().unwrap_or_default())))
        .collect();
    let size = [PIXELS as u32, 1];
    let batch = Batch {
        program: pass::Program {
            label: String::from("combiners"),
            defines: Vec::new(),
            vertex: vec![
                chunk("position.vert", include_str!("../../glsl/common/position.vert").to_owned()),
                chunk("depth.vert", include_str!("../../glsl/common/depth.vert").to_owned()),
            ],
            fragment: vec![
                chunk("exact", "#define REGISTER EXACT\n".into()),
                chunk("combiners", combiners::fragment(program, precision)),
                chunk("main", main),
            ],
            attributes: vec![Attribute::Position],
        },
        meaning: FixedFunctionDesc::Shader("combiners"),
        uniforms: vec![Uniform { name: "registers".into(), value: UniformValue::Vec4Array(flat) }],
        inputs: Vec::new(),
        cull: None,
        scissor: None,
        clip_planes: 0,
        draws: vec![whole_target("every pixel")],
    };
    let label = String::from("colours");
    let image = ImageDesc { label, size, format: Format::Rgba32F, storage: Storage::Texture };
    let pass = DrawPass {
        target: Target { color: Some(ImageId(0)), depth: None, level: 0, face: None },
        viewport: size,
        clear: Clear::default(),
        state: DrawState { depth_test: None, depth_write: false, ..DrawState::OPAQUE },
        batches: vec![batch],
    };
    let pass = Pass { label: String::from("combine"), redraw: Redraw::Always, work: Work::Draw(pass) };
    let list = PassList { images: vec![image], passes: vec![pass], ..PassList::default() };
    device.run(&list, Measure::No).unwrap_or_else(|error| panic!("{error}:\n{program}"));
    let Pixels::RgbaF32 { data, .. } = device.read(&list, ImageId(0)).unwrap() else { panic!("no floats") };
    data.as_chunks::<4>().0.to_vec()
}

/// GLSL and the interpreter have the same bits, of programs of every kind and length; where a driver has no `precise`, within
/// some roundings. GLUMBRA_COMBINERS=1000 sets how many.
#[test]
fn glsl_and_the_interpreter_have_the_same_bits() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut device = Device::new(&context);
    let count = std::env::var("GLUMBRA_COMBINERS").ok().and_then(|count| count.parse().ok()).unwrap_or(150);
    let mut maker = maker(2001);
    let (mut unequal, mut compared, mut stages, mut gray) = (Vec::new(), 0, 0, 0);
    for index in 0..count {
        let program = maker.program();
        let precision = if index % 3 == 2 { Precision::NineBits } else { Precision::Float };
        let sets: Vec<Registers> =
            (0..PIXELS).map(|_| STARTS.into_iter().map(|register| (register, maker.color())).collect()).collect();
        let found = by_gl(&mut device, &program, precision, &sets);
        stages += program.stages.len();
        for (set, found) in sets.iter().zip(found) {
            let expected = combiners::run(&program, set, precision);
            compared += 1;
            gray += usize::from(expected[..3].iter().any(|channel| *channel > 0.0 && *channel < 1.0));
            // -0 and 0 are one number.
            if found.iter().zip(expected).any(|(found, expected)| *found != expected) {
                unequal.push(format!("program {index}: {found:?}, not {expected:?}\n{program}"));
            }
        }
    }
    println!("{count} programs of {stages} stages, {compared} pixels; {gray} neither black nor white");
    assert!(2 * gray > compared, "most colours are 0 or 1: the programs say little");
    assert!(unequal.is_empty(), "{} pixels: {}", unequal.len(), unequal[0]);
}

/// The talk's program is the mathematics of its slide "The Required Per-Pixel Math", with both self-shadowing terms.
#[test]
fn the_talks_program_is_its_mathematics() {
    let program = combiners::parse(TALK).unwrap();
    let mut random = fastrand::Rng::with_seed(5);
    let mut unit = || loop {
        let vector = glam::DVec3::new(random.f64(), random.f64(), random.f64()) * 2.0 - 1.0;
        if (0.1..1.0).contains(&vector.length()) {
            return vector.normalize();
        }
    };
    let mut random = fastrand::Rng::with_seed(6);
    let (mut most, mut lit) = (0.0_f64, 0);
    for _ in 0..5000 {
        let [normal, light, half] = [unit(), unit(), unit()];
        let mut color = |most: f64| [(); 3].map(|()| most * random.f64());
        let [ambient, colour, specular, decal] = [color(0.5), color(0.5), color(1.0), color(1.0)];
        let [dim, gloss] = [random.f64(), random.f64()];
        let packed = |vector: glam::DVec3, alpha: f64| {
            let vector = 0.5 * vector + 0.5;
            [vector.x as f32, vector.y as f32, vector.z as f32, alpha as f32]
        };
        let plain = |[red, green, blue]: [f64; 3], alpha: f64| [red as f32, green as f32, blue as f32, alpha as f32];
        let start = Registers::from([
            (Register::Constant0, plain(ambient, 0.0)),
            (Register::Color0, plain(colour, 0.0)),
            (Register::Color1, plain([0, 1, 2].map(|channel| specular[channel] * colour[channel]), 0.0)),
            (Register::Texture(0), packed(normal, dim)),
            (Register::Texture(1), packed(light, 0.0)),
            (Register::Texture(2), packed(half, 0.0)),
            (Register::Texture(3), plain(decal, gloss)),
        ]);
        let found = combiners::run(&program, &start, Precision::Float);
        let shadow = |z: f64| (8.0 * z.max(0.0)).min(1.0);
        let diffuse = dim * shadow(light.z) * normal.dot(light).max(0.0);
        let highlight = gloss * shadow(light.z) * shadow(half.z) * normal.dot(half).max(0.0).powi(8);
        lit += usize::from(diffuse > 0.0 && highlight > 0.0);
        for channel in 0..3 {
            let expected = (ambient[channel] + diffuse * colour[channel]) * decal[channel]
                + highlight * specular[channel] * colour[channel];
            most = most.max((f64::from(found[channel]) - expected.min(1.0)).abs());
        }
        assert_eq!(found[3], 1.0);
    }
    println!("greatest difference {most:.1e}; {lit} of 5000 with a highlight");
    // Roundings of f32: of packed vectors, of some ten products of numbers up to 4.
    assert!(most < 1e-5 && lit > 300, "{most} {lit}");
}
