//! The values that a stream's settings take: a few of each, so that states come again.

use crate::conformance::bench::commands::{Faces, OUTPUTS, Program, SAMPLERS, Sampled, Setting, TEXTURES, UNITS};
use crate::conformance::bench::{
    GlCompare, GlEquation, GlFace, GlFactor, GlMipmap, GlOffset, GlStencilOp, GlSwizzle, GlWrap,
};
use crate::conformance::random::Random;
use crate::conformance::verify::cube;

use super::image::Image;
use super::state::State;

pub struct Palette {
    programs: Vec<Program>,
    compares: [GlCompare; 3],
    factors: [[GlFactor; 4]; 2],
    equations: [[GlEquation; 2]; 2],
    ops: [[GlStencilOp; 3]; 3],
    read_masks: [u32; 2],
    write_masks: [u32; 2],
    masks: [[bool; 4]; 3],
    filters: [(bool, bool, GlMipmap); 2],
    wraps: [[GlWrap; 2]; 2],
}

impl Palette {
    pub fn new(random: &mut Random) -> Self {
        let wraps = [GlWrap::Repeat, GlWrap::MirroredRepeat, GlWrap::ClampToEdge, GlWrap::ClampToBorder];
        let mipmaps = [GlMipmap::Off, GlMipmap::Nearest, GlMipmap::Linear];
        let masks = [0xFF, 0x0F, 0xF0, 0x01, !0, 0x100FF, 0];
        let plain = [true; 4];
        Self {
            programs: (0..5).map(|_| random.pick(&Program::ALL)).collect(),
            compares: [(); 3].map(|()| random.pick(&GlCompare::ALL)),
            factors: [(); 2].map(|()| {
                let two = [(); 2].map(|()| random.pick(&GlFactor::ALL));
                let others = [(); 2].map(|()| random.pick(&GlFactor::ALL));
                if random.below(2) == 0 {
                    [two[0], two[1], two[0], two[1]]
                } else {
                    [two[0], two[1], others[0], others[1]]
                }
            }),
            equations: [[GlEquation::Add; 2], [(); 2].map(|()| random.pick(&GlEquation::ALL))],
            ops: [(); 3].map(|()| [(); 3].map(|()| random.pick(&GlStencilOp::ALL))),
            read_masks: [random.pick(&masks), 0xFF],
            write_masks: [random.pick(&masks), random.pick(&[0xFF, !0])],
            masks: [plain, [(); 4].map(|()| random.below(2) == 0), [false; 4]],
            filters: [(); 2].map(|()| (random.below(2) == 0, random.below(2) == 0, random.pick(&mipmaps))),
            wraps: [(); 2].map(|()| [(); 2].map(|()| random.pick(&wraps))),
        }
    }

    /// A colour: of each channel, numbers that codes of 8 bits and halves have, and some beyond [0, 1].
    pub fn color(&self, random: &mut Random) -> [f32; 4] {
        [(); 4].map(|()| random.pick(&[0.0, 1.0, 0.25, 0.75, 0.2, 0.6, 0.125, 1.0, 0.0, 0.8, 1.5, -0.5]))
    }

    /// A clip distance: its slope, and its height at the middle.
    pub fn cut(&self, random: &mut Random) -> [f32; 2] {
        let slope = random.pick(&[0.25, -0.25, 1.0, -4.0]);
        [slope, slope * random.between(-0.9, 0.9)]
    }

    fn compare(&self, random: &mut Random) -> GlCompare {
        random.pick(&self.compares)
    }

    /// A rectangle of pixels, sometimes beyond the image.
    fn rectangle(random: &mut Random, size: [u32; 2]) -> [i32; 4] {
        let [[x, width], [y, height]] = size.map(|side| {
            let side = side as i32;
            let low = random.below(side as usize + 4) as i32 - 3;
            [low, random.below(side as usize + 3) as i32]
        });
        [x, y, width, height]
    }

    fn switch(random: &mut Random) -> Setting {
        let on = random.below(3) > 0;
        match random.below(10) {
            0 => Setting::DepthTest(on),
            1 => Setting::DepthMask(on),
            2 => Setting::DepthClamp(on),
            3 => Setting::CullFace(!on),
            4 | 9 => Setting::StencilTest(on),
            5 => Setting::Blend(on),
            6 => Setting::BlendOf(random.below(OUTPUTS) as u32, on),
            7 => Setting::ScissorTest(!on),
            _ => Setting::OffsetFill(!on),
        }
    }

    fn faces(random: &mut Random) -> Faces {
        random.pick(&[Faces::Short, Faces::Both, Faces::Front, Faces::Back])
    }

    /// One setting, of any kind.
    pub fn setting(&self, random: &mut Random, state: &State, sizes: &[[u32; 2]]) -> Setting {
        let size = random.pick(sizes);
        match random.below(34) {
            0..7 => Self::switch(random),
            7 => Setting::DepthFunc(self.compare(random)),
            8 => {
                let ends = [0.0, 1.0, 0.25, 0.5, 1.5];
                let short = random.below(2) == 0;
                let any = [(); 2].map(|()| random.pick(&ends));
                Setting::DepthRange(random.pick(&[[0.0, 1.0], [1.0, 0.0], any]), short)
            }
            9 => Setting::Culled(random.pick(&[GlFace::Front, GlFace::Back])),
            10 => Setting::Clockwise(random.below(2) == 0),
            11..13 => {
                let reference = random.pick(&[0, 1, 3, 0x5A, 255, 300, -1]);
                Setting::StencilFunc(
                    Self::faces(random),
                    self.compare(random),
                    reference,
                    random.pick(&self.read_masks),
                )
            }
            13..15 => Setting::StencilOp(Self::faces(random), random.pick(&self.ops)),
            15 => Setting::StencilMask(Self::faces(random), random.pick(&self.write_masks)),
            16..18 => Setting::BlendFunc(random.pick(&self.factors)),
            18 => Setting::BlendEquation(random.pick(&self.equations)),
            19 => Setting::ColorMask(random.pick(&self.masks)),
            20 => Setting::ColorMaskOf(random.below(OUTPUTS) as u32, random.pick(&self.masks)),
            21 => Setting::Scissor(Self::rectangle(random, size)),
            22 => {
                let [x, y, width, height] = Self::rectangle(random, size);
                let [full_width, full_height] = size.map(|side| side as i32);
                random.pick(&[
                    Setting::Viewport([0, 0, full_width, full_height]),
                    Setting::Viewport([x, y, width + 1, height + 1]),
                ])
            }
            23 => Setting::Offset(GlOffset {
                factor: random.between(-2.0, 2.0),
                units: random.pick(&[0.0, 1.0, -3.0, 2.0]),
                clamp: 0.0,
            }),
            24 => Setting::ClearColor(self.color(random)),
            25 => Setting::ClearDepth(random.pick(&[1.0, 0.0, 0.3, 0.7, 1.5])),
            26 => Setting::ClearStencil(random.pick(&[0, 1, 0x5A, 0xFF])),
            27 => Setting::Program(random.pick(&self.programs)),
            28 | 29 => self.uniform(random),
            _ => self.sampling(random, state),
        }
    }

    fn uniform(&self, random: &mut Random) -> Setting {
        let program = random.pick(&self.programs);
        match random.below(7) {
            6 => Setting::Cut(program, self.cut(random)),
            0..3 => Setting::Color(program, self.color(random)),
            3 => Setting::Period(program, [(); 2].map(|()| 1 + random.below(5) as i32)),
            4 => Setting::Origin(program, [(); 2].map(|()| random.below(40) as i32)),
            _ => Setting::Reference(program, random.pick(&[0.1, 0.35, 0.55, 0.9, 0.0, 1.0])),
        }
    }

    fn sampling(&self, random: &mut Random, state: &State) -> Setting {
        let slot = random.below(TEXTURES);
        let object =
            if random.below(2) == 0 { Sampled::Sampler(random.below(SAMPLERS)) } else { Sampled::Texture(slot) };
        let levels = state.textures[slot].as_ref().map_or(1, |image| image.levels);
        match random.below(9) {
            0 => Setting::Texture(random.below(UNITS as usize) as u32, slot),
            1 => {
                let sampler = random.below(SAMPLERS);
                Setting::Sampler(random.below(UNITS as usize) as u32, (random.below(2) == 0).then_some(sampler))
            }
            2 => {
                let (min, mag, mipmap) = random.pick(&self.filters);
                Setting::Filters(object, min, mag, mipmap)
            }
            3 => Setting::Wrap(object, random.pick(&self.wraps)),
            4 => Setting::Border(object, [(); 4].map(|()| random.pick(&[0.0, 1.0, 0.2, 0.6]))),
            5 => Setting::Compare(object, (random.below(2) == 0).then(|| self.compare(random))),
            6 => Setting::LodRange(object, random.pick(&[[-1000.0, 1000.0], [0.0, 1.0], [1.0, 1.0], [1.0, 5.0]])),
            7 => {
                let base = random.below(levels as usize) as u32;
                Setting::Levels(slot, random.pick(&[[0, levels - 1], [base, levels - 1], [base, base]]))
            }
            _ => Setting::Swizzle(
                slot,
                random.pick(&[
                    GlSwizzle::SAME,
                    GlSwizzle::SAME,
                    [GlSwizzle::Blue, GlSwizzle::Red, GlSwizzle::One, GlSwizzle::Green],
                ]),
            ),
        }
    }

    /// Settings by which a program reads a texture: most of what must be so, and some at random.
    pub fn reading(&self, random: &mut Random, program: Program, slot: usize, image: &Image) -> Vec<Setting> {
        let unit = random.below(UNITS as usize);
        let compares = program == Program::Compare;
        let sampler = random.below(SAMPLERS);
        let by_sampler = random.below(2) == 0;
        let object = if by_sampler { Sampled::Sampler(sampler) } else { Sampled::Texture(slot) };
        let (mut min, mut mag, mipmap) = random.pick(&self.filters);
        if program == Program::LookCube {
            (min, mag) = (false, false);
        }
        let levels = image.range[1] - image.range[0] + 1;
        let level = if mipmap == GlMipmap::Off { 0 } else { random.below(levels as usize) as i32 };
        let mut all = vec![
            Setting::Texture(unit as u32, slot),
            Setting::Sampler(unit as u32, by_sampler.then_some(sampler)),
            Setting::Filters(object, min, mag, mipmap),
            Setting::Compare(object, compares.then(|| self.compare(random))),
            Setting::Unit(program, unit as i32),
            Setting::Level(program, level),
            Setting::Layer(program, random.below(image.layers as usize) as i32),
            Setting::Origin(program, [(); 2].map(|()| random.below(40) as i32)),
            Setting::Color(program, self.color(random)),
            Setting::Reference(program, random.pick(&[0.1, 0.35, 0.55, 0.9, 0.0, 1.0])),
        ];
        if program == Program::LookCube {
            let face = random.below(6);
            let at = |place: [f64; 2]| cube::direction(face, place).map(|part| part as f32);
            let middle = at([0.5, 0.5]);
            let along = |end: [f32; 3]| std::array::from_fn(|axis| end[axis] - middle[axis]);
            all.push(Setting::Axes(program, [along(at([1.0, 0.5])), along(at([0.5, 1.0])), middle]));
        }
        all
    }
}
