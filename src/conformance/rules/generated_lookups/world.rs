//! State of the context as the model has it, and the steps that change it: textures, sampler objects, units.

use super::formats::{FORMATS, Numbers, OLD_FORMATS, TexelFormat};
use super::lookups::LookUpKind;
use super::model::{Level, Shape, Texture};
use super::uploads::Block;
use crate::conformance::bench::{GlMipmap, GlSwizzle, GlTexelPlace, GlTextureStep, GlWrap, Sampling};
use crate::conformance::random::Random;

/// Slots of textures and of sampler objects, and units that are used.
pub const TEXTURES: usize = 28;
pub const SAMPLERS: usize = 5;
pub const UNITS: usize = 24;

/// Parameters of a new texture or sampler object [GL 4.6, tables 23.15 and 23.18].
const NEW: Sampling = Sampling {
    linear: false,
    magnified: Some(true),
    mipmap: GlMipmap::Linear,
    wrap: [GlWrap::Repeat; 3],
    levels: Some([0, 1000]),
    ..Sampling::NEAREST
};

/// Source of copies: bytes of a surface, rows from below.
pub struct CopySource {
    pub size: [usize; 2],
    pub colors: Vec<[u8; 4]>,
}

pub struct World<'a> {
    pub random: Random,
    pub textures: Vec<Option<Texture>>,
    pub samplers: Vec<Option<Sampling>>,
    pub bindings: [[Option<usize>; Shape::ALL.len()]; UNITS],
    pub units: [Option<usize>; UNITS],
    pub seamless: bool,
    pub steps: Vec<GlTextureStep>,
    pub source: &'a CopySource,
    pub compatible: bool,
    formats: Vec<&'static TexelFormat>,
    names: usize,
    turn: usize,
}

impl<'a> World<'a> {
    pub fn new(seed: u64, compatible: bool, source: &'a CopySource) -> Self {
        let old: &[TexelFormat] = if compatible { OLD_FORMATS } else { &[] };
        let formats = FORMATS.iter().chain(old).collect();
        Self {
            random: Random::new(seed),
            textures: (0..TEXTURES).map(|_| None).collect(),
            samplers: vec![None; SAMPLERS],
            bindings: [[None; Shape::ALL.len()]; UNITS],
            units: [None; UNITS],
            seamless: false,
            steps: Vec::new(),
            source,
            compatible,
            formats,
            names: 0,
            turn: 0,
        }
    }

    /// Binds to a unit, where it becomes the active one.
    pub fn bind(&mut self, unit: usize, slot: usize) -> u32 {
        let Some(shape) = self.textures[slot].as_ref().map(|texture| texture.shape) else { return 0 };
        self.bindings[unit][shape as usize] = Some(slot);
        self.steps.push(GlTextureStep::Bind { unit: unit as u32, target: shape.target(), slot });
        shape.target()
    }

    pub(super) fn bind_somewhere(&mut self, slot: usize) -> u32 {
        let bound = |world: &Self, unit: usize| world.bindings[unit].contains(&Some(slot));
        let unit = match (0..UNITS).find(|unit| bound(self, *unit)) {
            Some(unit) if self.random.chance(0.5) => unit,
            _ => self.random.below(UNITS),
        };
        self.bind(unit, slot)
    }

    /// A new texture in a slot, of a shape, with all its levels.
    pub fn make(&mut self, slot: usize) {
        let chances =
            [Shape::Flat, Shape::Flat, Shape::Cube, Shape::Array, Shape::Volume, Shape::Line, Shape::Rectangle];
        let shape = self.random.pick(&chances);
        let format = self.format(shape, |_| true);
        self.make_as(slot, shape, format);
    }

    /// A new texture that a look-up can read.
    pub fn make_for(&mut self, slot: usize, kind: LookUpKind) {
        let format = self.format(kind.shape, |format| kind.takes(format));
        self.make_as(slot, kind.shape, format);
    }

    fn make_as(&mut self, slot: usize, shape: Shape, format: &'static TexelFormat) {
        for unit in &mut self.bindings {
            for bound in unit.iter_mut().filter(|bound| **bound == Some(slot)) {
                *bound = None;
            }
        }
        self.names += 1;
        let sampling = if shape == Shape::Rectangle {
            Sampling {
                linear: true,
                magnified: Some(true),
                mipmap: GlMipmap::Off,
                wrap: [GlWrap::ClampToEdge; 3],
                ..NEW
            }
        } else {
            NEW
        };
        self.textures[slot] = Some(Texture { shape, format, levels: Vec::new(), sampling, name: self.names });
        self.steps.push(GlTextureStep::New(slot));
        self.bind_somewhere(slot);
        self.define(slot);
    }

    /// Takes formats by turns, so that none is left out.
    pub(super) fn format(&mut self, shape: Shape, takes: impl Fn(&TexelFormat) -> bool) -> &'static TexelFormat {
        loop {
            self.turn += 1;
            let format = self.formats[self.turn * 7 % self.formats.len()];
            if takes(format) && !(format.is_depth() && shape == Shape::Volume) {
                return format;
            }
        }
    }

    fn size(&mut self, shape: Shape) -> [usize; 3] {
        let random = &mut self.random;
        let mut side = |most: usize| {
            let most = match random.below(10) {
                0..4 => most.min(9),
                4..8 => most.min(40),
                _ => most,
            };
            let side = 1 + random.below(most);
            if random.chance(0.3) { side.next_power_of_two() } else { side }
        };
        match shape {
            Shape::Line if side(10) == 1 => [2000 + side(48), 1, 1],
            Shape::Line if side(3) == 1 => [side(1000), 1, 1],
            Shape::Line => [side(130), 1, 1],
            Shape::Flat if side(10) == 1 => [2000 + side(90), side(3), 1],
            Shape::Flat if side(10) == 1 => [side(3), 2000 + side(90), 1],
            Shape::Flat if side(10) < 6 => [128 + side(60), 40 + side(50), 1],
            Shape::Flat | Shape::Rectangle => [side(130), side(130), 1],
            Shape::Volume => [side(30), side(24), side(16)],
            Shape::Cube => {
                let side = side(64);
                [side, side, 6]
            }
            Shape::Array => [side(60), side(60), side(7)],
        }
    }

    /// Defines all levels of a texture that is bound, in a size of their own.
    pub(super) fn define(&mut self, slot: usize) {
        let Some((shape, format)) = self.textures[slot].as_ref().map(|texture| (texture.shape, texture.format)) else {
            return;
        };
        let made = shape != Shape::Rectangle
            && !format.is_depth()
            && !format.is_integer()
            && format.numbers != Numbers::Srgb
            && self.random.chance(0.25);
        let mut size = self.size(shape);
        if made {
            // The filter of glGenerateMipmap is known where sides are halved.
            for side in &mut size[..shape.axes()] {
                *side = side.next_power_of_two();
            }
        }
        let longest = size[..shape.axes()].iter().copied().max().unwrap_or(1);
        let full = longest.ilog2() as usize + 1;
        let wanted = match shape {
            Shape::Rectangle => 1,
            _ if self.random.chance(0.55) => full,
            _ => 1 + self.random.below(full),
        };
        let scale = self.random.below(14) as i32 - 5;
        let mut levels = Vec::new();
        for level in 0..wanted {
            let size = level_size(size, level, shape.axes());
            if made && level > 0 {
                break;
            }
            levels.push(self.define_level(slot, level, size, scale));
        }
        if let Some(texture) = &mut self.textures[slot] {
            texture.levels = levels;
        }
        if made {
            self.restrict(slot, Some([0, wanted as u32 - 1]));
            self.halve(slot, wanted);
        }
        let range = if wanted == full && self.random.chance(0.4) { 1000 } else { wanted as u32 - 1 };
        if shape != Shape::Rectangle {
            self.restrict(slot, Some([0, range]));
        }
    }

    /// glGenerateMipmap of a texture that is bound and has its base level at 0.
    pub(super) fn halve(&mut self, slot: usize, count: usize) {
        let Some(texture) = &mut self.textures[slot] else { return };
        self.steps.push(GlTextureStep::Mipmap { target: texture.shape.target() });
        let axes = texture.shape.axes();
        texture.levels.truncate(1);
        for _ in 1..count {
            let Some(last) = texture.levels.last() else { return };
            let next = last.halved(axes, texture.format);
            texture.levels.push(next);
        }
    }

    pub(super) fn restrict(&mut self, slot: usize, levels: Option<[u32; 2]>) {
        let Some(texture) = &mut self.textures[slot] else { return };
        let to = Sampling { levels, ..texture.sampling };
        let from = Some(std::mem::replace(&mut texture.sampling, to));
        self.steps.push(GlTextureStep::Parameters { target: texture.shape.target(), from, to });
    }

    fn define_level(&mut self, slot: usize, level: usize, size: [usize; 3], scale: i32) -> Level {
        let Some((shape, format)) = self.textures[slot].as_ref().map(|texture| (texture.shape, texture.format)) else {
            return Level::of(size, Vec::new(), 0.0);
        };
        let place = |target| GlTexelPlace { slot, target, level: level as u32, at: [0; 3] };
        let internal = format.internal;
        if shape != Shape::Cube {
            let volume = matches!(shape, Shape::Volume | Shape::Array);
            let block = Block::random(&mut self.random, format, size, scale, volume);
            // Empty first, and filled in its middle by a piece: or whole.
            let target = shape.target();
            let sizes = size.map(|side| side as u32);
            if shape != Shape::Line && self.random.chance(0.15) {
                self.steps.push(GlTextureStep::Define { place: place(target), internal, size: sizes, texels: None });
                let texels = block.texels;
                self.steps.push(GlTextureStep::Replace { place: place(target), size: sizes, texels });
            } else {
                let texels = Some(block.texels);
                self.steps.push(GlTextureStep::Define { place: place(target), internal, size: sizes, texels });
            }
            return Level::of(size, block.stored, block.slack);
        }
        let (mut stored, mut slack) = (Vec::new(), 0.0_f64);
        for face in 0..6 {
            let block = Block::random(&mut self.random, format, [size[0], size[1], 1], scale, false);
            let target = glow::TEXTURE_CUBE_MAP_POSITIVE_X + face;
            let texels = Some(block.texels);
            let size = [size[0] as u32, size[1] as u32, 1];
            self.steps.push(GlTextureStep::Define { place: place(target), internal, size, texels });
            stored.extend(block.stored);
            slack = slack.max(block.slack);
        }
        Level::of(size, stored, slack)
    }

    /// A swizzle or a range of levels of a texture, now and then.
    pub fn reshuffle(&mut self, slot: usize, again: bool) -> Sampling {
        let random = &mut self.random;
        let Some(texture) = &self.textures[slot] else { return NEW };
        let mut to = texture.sampling;
        if !again && random.chance(0.25) {
            let all =
                [GlSwizzle::Red, GlSwizzle::Green, GlSwizzle::Blue, GlSwizzle::Alpha, GlSwizzle::Zero, GlSwizzle::One];
            to.swizzle = [(); 4].map(|()| random.pick(&all));
        } else if !again && random.chance(0.2) {
            to.swizzle = GlSwizzle::SAME;
        }
        if texture.shape != Shape::Rectangle && random.chance(0.25) {
            let count = texture.levels.len();
            let base = random.below(count);
            to.levels = Some([base as u32, (base + random.below(count - base)) as u32]);
        }
        to
    }

    /// A sampler object in a slot, new or there already.
    pub fn object(&mut self, taken: &[usize]) -> usize {
        let free: Vec<_> = (0..SAMPLERS).filter(|object| !taken.contains(object)).collect();
        let object = self.random.pick(&free);
        if self.samplers[object].is_none() || self.random.chance(0.1) {
            for unit in self.units.iter_mut().filter(|unit| **unit == Some(object)) {
                *unit = None;
            }
            self.steps.push(GlTextureStep::NewSampler(object));
            self.samplers[object] = Some(Sampling { levels: None, ..NEW });
        }
        object
    }
}

/// Size of a level: each axis that is halved.
fn level_size(size: [usize; 3], level: usize, axes: usize) -> [usize; 3] {
    [0, 1, 2].map(|axis| if axis < axes { (size[axis] >> level).max(1) } else { size[axis] })
}
