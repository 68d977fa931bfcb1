//! Random textures and renderbuffers, and commands that give them content.

use crate::conformance::bench::commands::{Clear, Command, Faces, Place, Point, Setting};
use crate::conformance::bench::{GlFormat, GlImageDesc, GlShape, level_size};

use super::generate::{Generator, READER};
use super::pixels;

const COLORS: [GlFormat; 6] =
    [GlFormat::Rgba8, GlFormat::Rgba8, GlFormat::R8, GlFormat::Rgba16F, GlFormat::Rgba32F, GlFormat::R32F];
const DEPTHS: [GlFormat; 5] =
    [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F, GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8];

impl Generator {
    /// A texture of random shape, format, size and levels.
    pub fn texture(&mut self, slot: usize) -> Command {
        let mut size = self.size();
        let depth = slot % 2 == 1;
        let format = if depth { self.random.pick(&DEPTHS) } else { self.random.pick(&COLORS) };
        let (shape, layers) = match self.random.below(5) {
            0 if size[0] < 40 => {
                size = [size[0]; 2];
                (GlShape::Cube, 6)
            }
            1 => (GlShape::Array, 3),
            _ => (GlShape::Flat, 1),
        };
        let levels = 1 + self.random.below(3) as u32;
        // Levels of one texel along a side: a driver may refuse them as attachments while the texture is not complete
        // [GL 4.6, 9.4.2: FRAMEBUFFER_UNSUPPORTED].
        let most = 31 - size[0].min(size[1]).leading_zeros();
        let desc = GlImageDesc { shape, format, size, layers, levels: levels.min(most).max(1) };
        Command::Texture { slot, desc, fresh: self.random.below(2) == 0 }
    }

    /// A renderbuffer, of four samples now and then.
    pub fn renderbuffer(&mut self, slot: usize) -> Command {
        let depth = slot % 2 == 1;
        let format = if depth { self.random.pick(&DEPTHS) } else { self.random.pick(&COLORS) };
        let samples = if self.random.below(4) == 0 { 4 } else { 0 };
        Command::Renderbuffer { slot, format, size: self.size(), samples }
    }

    /// Makes an image, and gives it content under no masks.
    pub fn make(&mut self, command: Command) {
        let content = self.content(&command);
        let open = [
            Setting::ScissorTest(false),
            Setting::ColorMask([true; 4]),
            Setting::DepthMask(true),
            Setting::StencilMask(Faces::Both, !0),
        ];
        self.queue.push_back(command);
        self.queue.extend(open.map(Command::Set));
        self.queue.extend(content);
    }

    /// Commands that give a new image content: clears of each of its parts.
    pub fn content(&mut self, command: &Command) -> Vec<Command> {
        let (places, format): (Vec<_>, _) = match *command {
            Command::Texture { slot, desc, .. } => {
                let parts = (0..desc.levels).flat_map(|level| (0..desc.layers).map(move |layer| (level, layer)));
                (parts.map(|(level, layer)| Place::Texture { slot, level, layer }).collect(), desc.format)
            }
            Command::Renderbuffer { slot, format, .. } => (vec![Place::Renderbuffer(slot)], format),
            _ => return Vec::new(),
        };
        let mut commands = Vec::new();
        for place in places {
            if let (Command::Texture { desc, .. }, Place::Texture { slot, level, layer }) = (command, place)
                && desc.shape != GlShape::Array
                && !format.is_depth()
                && self.random.below(2) == 0
            {
                let area = level_size(desc.size, level);
                commands.push(self.define(slot, [level, layer], format, area));
                continue;
            }
            let color = self.palette.color(&mut self.random);
            commands.push(Command::Framebuffer(READER));
            let (point, clear) = match format {
                _ if !format.is_depth() => (Point::Color(0), Clear::Color(0, color)),
                _ if format.has_stencil() => (Point::Depth, Clear::Both(0.7, 3)),
                _ => (Point::Depth, Clear::Depth(0.7)),
            };
            commands.push(Command::Attach { slot: READER, point, place: Some(place) });
            if format.is_depth() {
                commands.push(Command::Bind { draw: false, read: true, slot: READER });
                commands.push(Command::DrawBuffers([None; 2]));
                commands.push(Command::ReadBuffer(None));
            }
            commands.push(Command::Clear(clear));
        }
        commands
    }

    /// A whole level by glTexImage, with random content.
    pub fn define(&mut self, slot: usize, [level, layer]: [u32; 2], format: GlFormat, size: [u32; 2]) -> Command {
        let area = [0, 0, size[0] as i32, size[1] as i32];
        let mut packing = pixels::packing(&mut self.random, format, area, true);
        if self.random.below(2) == 0 {
            // As images of files are given, if it may be so.
            let layout = if format.is_depth() { packing.layout } else { [glow::RGBA, glow::UNSIGNED_BYTE] };
            packing = pixels::tight(layout);
        }
        let bytes = pixels::bytes(&mut self.random, &packing, size);
        Command::Upload { slot, level, layer, area: [0, 0, size[0], size[1]], packing, bytes, anew: true }
    }
}
