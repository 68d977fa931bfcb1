//! Changes of textures between draws: pieces that are replaced, cleared or copied, levels and definitions made anew.

use super::formats::Numbers;
use super::layouts;
use super::model::Shape;
use super::uploads::Block;
use super::world::{TEXTURES, World};
use crate::conformance::bench::{GlTexelPlace, GlTextureStep};

impl World<'_> {
    /// One change of some texture's texels or definition.
    pub fn edit(&mut self) {
        let slot = self.random.below(TEXTURES);
        let kind = self.random.below(12);
        if self.textures[slot].is_none() || kind == 0 {
            return self.make(slot);
        }
        self.bind_somewhere(slot);
        match kind {
            1 => {
                let Some(texture) = &mut self.textures[slot] else { return };
                let shape = texture.shape;
                let format = self.format(shape, |_| true);
                if let Some(texture) = &mut self.textures[slot] {
                    texture.format = format;
                }
                self.define(slot);
                // An integer has no filter but NEAREST: the next draw sees to that.
            }
            2..=6 => self.replace(slot),
            7..=8 => self.clear(slot),
            9..=10 => self.copy(slot),
            _ => {
                let Some(texture) = &self.textures[slot] else { return };
                let is_srgb = texture.format.numbers == Numbers::Srgb;
                let can = texture.shape != Shape::Rectangle
                    && !texture.format.is_depth()
                    && !texture.format.is_integer()
                    && !is_srgb;
                let count = texture.levels.len();
                let sides = texture.levels[0].size;
                let is_known = (0..texture.shape.axes()).all(|axis| sides[axis].is_power_of_two());
                if can && is_known {
                    self.restrict(slot, Some([0, count as u32 - 1]));
                    self.halve(slot, count);
                }
            }
        }
    }

    /// A change of a texture's texels that leaves its format alone.
    pub fn change(&mut self, slot: usize) {
        self.bind_somewhere(slot);
        match self.random.below(4) {
            0 => self.clear(slot),
            1 => self.copy(slot),
            _ => self.replace(slot),
        }
    }

    /// A level and a block of it, in a layer or face.
    fn block(&mut self, slot: usize) -> Option<(usize, [usize; 3], [usize; 3])> {
        let texture = self.textures[slot].as_ref()?;
        let level = self.random.below(texture.levels.len().min(4));
        let size = texture.levels[level].size;
        let deep = matches!(texture.shape, Shape::Volume | Shape::Array);
        let (mut at, mut block) = ([0; 3], [1; 3]);
        for axis in 0..3 {
            at[axis] = self.random.below(size[axis]);
            block[axis] = if axis == 2 && !deep { 1 } else { 1 + self.random.below(size[axis] - at[axis]) };
        }
        Some((level, at, block))
    }

    fn place(&self, slot: usize, level: usize, at: [usize; 3]) -> GlTexelPlace {
        let shape = self.textures[slot].as_ref().map_or(Shape::Flat, |texture| texture.shape);
        let target = match shape {
            Shape::Cube => glow::TEXTURE_CUBE_MAP_POSITIVE_X + at[2] as u32,
            _ => shape.target(),
        };
        GlTexelPlace { slot, target, level: level as u32, at: at.map(|at| at as u32) }
    }

    fn replace(&mut self, slot: usize) {
        let Some((level, at, size)) = self.block(slot) else { return };
        let Some(texture) = &self.textures[slot] else { return };
        if texture.shape == Shape::Line {
            return;
        }
        let deep = matches!(texture.shape, Shape::Volume | Shape::Array);
        let block = Block::random(&mut self.random, texture.format, size, 2, deep);
        let place = self.place(slot, level, at);
        let size_of = size.map(|side| side as u32);
        self.steps.push(GlTextureStep::Replace { place, size: size_of, texels: block.texels });
        let texel = |[x, y, z]: [usize; 3]| block.stored[(z * size[1] + y) * size[0] + x];
        if let Some(texture) = &mut self.textures[slot] {
            texture.levels[level].replace(at, size, block.slack, texel);
        }
    }

    fn clear(&mut self, slot: usize) {
        let Some((level, at, mut size)) = self.block(slot) else { return };
        size[2] = 1;
        let Some(texture) = &self.textures[slot] else { return };
        let format = texture.format;
        if !format.drawn || matches!(texture.shape, Shape::Line | Shape::Rectangle) {
            return;
        }
        let value = layouts::value(&mut self.random, format, 2);
        let color = value.map(|value| value as f32);
        let (kept, slack) = format.store(color.map(f64::from));
        let place = self.place(slot, level, at);
        let area = [at[0], at[1], size[0], size[1]].map(|number| number as u32);
        self.steps.push(GlTextureStep::Clear { place, area, color, depth: format.is_depth() });
        if let Some(texture) = &mut self.textures[slot] {
            texture.levels[level].replace(at, size, slack, |_| kept);
        }
    }

    /// A copy from the surface of 8-bit colours, into formats of the same numbers.
    fn copy(&mut self, slot: usize) {
        let Some((level, at, mut size)) = self.block(slot) else { return };
        size[2] = 1;
        let Some(texture) = &self.textures[slot] else { return };
        let format = texture.format;
        let is_color = matches!(format.internal, glow::R8 | glow::RG8 | glow::RGB8 | glow::RGBA8 | glow::RGBA16F)
            || matches!(format.internal, glow::RGBA32F | glow::R32F | glow::RGBA16 | glow::RGB10_A2);
        if !is_color || texture.shape == Shape::Line {
            return;
        }
        let source = self.source;
        size[0] = size[0].min(source.size[0]);
        size[1] = size[1].min(source.size[1]);
        let from = [0, 1].map(|axis| self.random.below(source.size[axis] - size[axis] + 1));
        let place = self.place(slot, level, at);
        let (from_of, size_of) = (from.map(|at| at as u32), [size[0], size[1]].map(|side| side as u32));
        self.steps.push(GlTextureStep::Copy { place, surface: 0, from: from_of, size: size_of });
        let color = |[x, y, _]: [usize; 3]| {
            let color = source.colors[(from[1] + y) * source.size[0] + from[0] + x];
            format.store(color.map(|code| f64::from(code) / 255.0))
        };
        let mut slack = 0.0_f64;
        for y in 0..size[1] {
            for x in 0..size[0] {
                slack = slack.max(color([x, y, 0]).1);
            }
        }
        if let Some(texture) = &mut self.textures[slot] {
            texture.levels[level].replace(at, size, slack, |texel| color(texel).0);
        }
    }
}
