//! Random commands: any that GL defines in the state that the model is in.

use std::collections::VecDeque;

use crate::conformance::bench::commands::{
    ARRAYS, CAPACITY, Clear, Command, Drawing, FRAMEBUFFERS, Filling, Place, Point, Program, RENDERBUFFERS, Rectangle,
    Setting, TEXTURES,
};
use crate::conformance::bench::{GlShape, level_size};
use crate::conformance::random::Random;

use super::palette::Palette;
use super::pixels;
use super::state::State;

/// The framebuffer by which images are read at the end.
pub const READER: usize = FRAMEBUFFERS - 1;
/// Attempts at a command that the model allows.
const ATTEMPTS: usize = 200;

pub struct Generator {
    pub random: Random,
    pub palette: Palette,
    sizes: Vec<[u32; 2]>,
    pub queue: VecDeque<Command>,
}

impl Generator {
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let palette = Palette::new(&mut random);
        let mut sizes = vec![[16, 16], [8, 8]];
        sizes[1] = random.pick(&[[8, 8], [13, 7], [33, 20], [5, 16], [1, 6], [16, 16]]);
        // Drivers draw by tiles of up to 64 pixels.
        if random.below(4) == 0 {
            sizes[0] = random.pick(&[[70, 9], [9, 70], [160, 72], [300, 6], [300, 6], [6, 300]]);
        }
        let mut generator = Self { random, palette, sizes, queue: VecDeque::new() };
        generator.begin();
        generator
    }

    fn begin(&mut self) {
        let mut first: Vec<Command> = State::starting().into_iter().map(Command::Set).collect();
        for slot in 0..TEXTURES - 1 {
            first.push(self.texture(slot));
        }
        for slot in 0..RENDERBUFFERS {
            first.push(self.renderbuffer(slot));
        }
        first.extend((0..FRAMEBUFFERS).map(Command::Framebuffer));
        for array in 0..ARRAYS {
            let rectangles = (0..CAPACITY).map(|_| self.rectangle()).collect();
            first.push(Command::Fill { array, first: 0, rectangles, filling: Filling::Whole });
        }
        let made: Vec<_> = first.iter().flat_map(|command| self.content(command)).collect();
        self.queue.extend(first.into_iter().chain(made));
    }

    /// Tests whether all that was put together has been given.
    pub fn is_between(&self) -> bool {
        self.queue.is_empty()
    }

    /// The next command that the model allows; `None`: there is none after many attempts.
    pub fn next(&mut self, state: &State) -> Option<Command> {
        for _ in 0..ATTEMPTS {
            if self.queue.is_empty() {
                self.propose(state);
            }
            if let Some(command) = self.queue.pop_front().filter(|command| state.allows(command)) {
                return Some(command);
            }
        }
        None
    }

    /// Puts one proposal into the queue, or several that belong together.
    fn propose(&mut self, state: &State) {
        let command = match self.random.below(100) {
            0..24 => Command::Set(self.palette.setting(&mut self.random, state, &self.sizes)),
            24..27 => return self.look(state),
            27 => return self.clip(),
            28 => return self.squares(state),
            29..52 => self.draw(),
            52..57 => self.fill(),
            57..64 => self.clear(),
            64..67 => self.blit(),
            67..70 => return self.copy(state),
            70..74 => return self.upload(state),
            74..80 => return self.read(state),
            80..85 => {
                let [draw, read] = self.random.pick(&[[true, false], [false, true], [true, true]]);
                Command::Bind { draw, read, slot: self.random.below(FRAMEBUFFERS - 1) }
            }
            85..92 => return self.framebuffer(state),
            92 => {
                let slot = self.random.below(TEXTURES);
                let command = self.texture(slot);
                return self.make(command);
            }
            93 => Command::DeleteTexture(self.random.below(TEXTURES)),
            94 => {
                let slot = self.random.below(RENDERBUFFERS);
                let command = self.renderbuffer(slot);
                return self.make(command);
            }
            95 => {
                // A framebuffer that has the texture would not allow it.
                self.queue.extend((0..FRAMEBUFFERS).map(Command::Framebuffer));
                let slot = self.random.below(TEXTURES);
                self.queue.push_back(Command::Levels(slot));
                return self.look(state);
            }
            96..98 => {
                // A query around draws must change none of them.
                let draws = [self.draw(), self.draw()];
                self.queue.push_back(Command::BeginQuery);
                self.queue.extend(draws);
                return self.queue.push_back(Command::EndQuery);
            }
            98 => Command::Flush,
            _ => Command::DrawBuffers(self.random.pick(&[
                [Some(0), None],
                [None, Some(0)],
                [Some(0), Some(1)],
                [Some(1), Some(0)],
                [None; 2],
            ])),
        };
        self.queue.push_back(command);
    }

    pub fn size(&mut self) -> [u32; 2] {
        let sizes = self.sizes.clone();
        self.random.pick(&sizes)
    }

    /// A flat rectangle, sometimes beyond the view volume.
    pub fn rectangle(&mut self) -> Rectangle {
        let end = |random: &mut Random| {
            let along = [random.between(-1.2, 1.2), random.between(-1.2, 1.2)];
            let whole = random.below(4) == 0;
            if whole { [-1.0, 1.0] } else { [along[0].min(along[1]), along[0].max(along[1])] }
        };
        let ([x0, x1], [y0, y1]) = (end(&mut self.random), end(&mut self.random));
        let z = self.random.pick(&[-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, -1.25]);
        let w = [(); 4].map(|()| self.random.pick(&[1.0, 1.0, 0.5, 2.0, 8.0]));
        Rectangle {
            corners: [x0, y0, x1, y1],
            z,
            w,
            color: self.palette.color(&mut self.random),
            turned: self.random.below(3) == 0,
        }
    }

    fn fill(&mut self) -> Command {
        let array = self.random.below(ARRAYS);
        if self.random.below(3) == 0 {
            let rectangles = (0..CAPACITY).map(|_| self.rectangle()).collect();
            return Command::Fill { array, first: 0, rectangles, filling: Filling::Whole };
        }
        let count = 1 + self.random.below(3);
        let rectangles = (0..count).map(|_| self.rectangle()).collect();
        Command::Fill { array, first: self.random.below(CAPACITY), rectangles, filling: Filling::Part }
    }

    fn draw(&mut self) -> Command {
        let count = 1 + self.random.below(4);
        let drawing = self.random.pick(&[
            Drawing::Fans,
            Drawing::Elements(1),
            Drawing::Elements(2),
            Drawing::Elements(4),
            Drawing::Based,
        ]);
        Command::Draw { array: self.random.below(ARRAYS), first: self.random.below(CAPACITY), count, drawing }
    }

    /// Draws of which every second square is discarded: into whatever is attached, or into depth alone.
    fn squares(&mut self, state: &State) {
        let draws = [self.draw(), self.draw()];
        if let Some(slot) = state.bound[0].filter(|_| self.random.below(2) == 0) {
            for index in 0..2 {
                self.queue.push_back(Command::Attach { slot, point: Point::Color(index), place: None });
            }
            self.queue.push_back(Command::DrawBuffers([None; 2]));
            self.queue.push_back(Command::Bind { draw: false, read: true, slot });
            self.queue.push_back(Command::ReadBuffer(None));
            self.queue.push_back(Command::Set(Setting::DepthMask(true)));
            self.queue.push_back(Command::Clear(Clear::Depth(self.random.pick(&[1.0, 0.0, 0.7]))));
        }
        let period = [(); 2].map(|()| 1 + self.random.below(5) as i32);
        self.queue.push_back(Command::Set(Setting::Period(Program::Squares, period)));
        self.queue.push_back(Command::Set(Setting::DepthTest(true)));
        self.queue.extend(draws);
    }

    /// Draws that a clip distance cuts: only one program writes it.
    fn clip(&mut self) {
        let draws = [self.draw(), self.draw(), self.draw()];
        let clamp = Setting::DepthClamp(self.random.below(2) == 0);
        self.queue.push_back(Command::Set(clamp));
        let cut = self.palette.cut(&mut self.random);
        self.queue.push_back(Command::Set(Setting::Cut(Program::Clip, cut)));
        self.queue.push_back(Command::Set(Setting::Color(Program::Clip, self.palette.color(&mut self.random))));
        self.queue.push_back(Command::Set(Setting::ClipDistance(true)));
        self.queue.extend(draws);
        self.queue.push_back(Command::Set(Setting::ClipDistance(false)));
    }

    fn clear(&mut self) -> Command {
        let color = self.palette.color(&mut self.random);
        let depth = self.random.pick(&[1.0, 0.0, 0.3, 0.7]);
        let value = self.random.pick(&[0, 1, 0x5A, 0xFF]);
        Command::Clear(match self.random.below(8) {
            0 => Clear::Color(0, color),
            1 => Clear::Color(1, color),
            2 => Clear::Depth(depth),
            3 => Clear::Stencil(value),
            4 => Clear::Both(depth, value),
            _ => Clear::Bits([(); 3].map(|()| self.random.below(2) == 0)),
        })
    }

    fn blit(&mut self) -> Command {
        let [width, height] = self.size().map(|side| side as i32);
        let (mut from, mut to) = ([0, 0, width, height], [0, 0, width, height]);
        let scale = self.random.pick(&[1, 1, 1, 2, 3]);
        if self.random.below(2) == 0 {
            for axis in 0..2 {
                let side = from[axis + 2];
                let low = self.random.below(side as usize) as i32;
                let high = low + 1 + self.random.below((side - low) as usize) as i32;
                let moved = self.random.below(9) as i32 - 4;
                (from[axis], from[axis + 2]) = (low, high);
                (to[axis], to[axis + 2]) = (low + moved, low + moved + scale * (high - low));
            }
        }
        if self.random.below(3) == 0 {
            let axis = self.random.below(2);
            let turned = if self.random.below(2) == 0 { &mut from } else { &mut to };
            turned.swap(axis, axis + 2);
        }
        let bits = self.random.pick(&[
            [true, false, false],
            [true, true, true],
            [false, true, false],
            [false, false, true],
            [false, true, true],
        ]);
        Command::Blit { from, to, bits }
    }

    /// An area within a size: x, y, width, height.
    pub fn area(&mut self, size: [u32; 2]) -> [i32; 4] {
        if self.random.below(3) == 0 {
            return [0, 0, size[0] as i32, size[1] as i32];
        }
        let [[x, width], [y, height]] = size.map(|side| {
            let low = self.random.below(side as usize);
            [low as i32, 1 + self.random.below(side as usize - low) as i32]
        });
        [x, y, width, height]
    }

    /// A texture's slot, level and layer.
    pub fn place(&mut self, state: &State) -> Option<(usize, u32, u32, [u32; 2])> {
        let slot = self.random.below(TEXTURES);
        let image = state.textures[slot].as_ref()?;
        let level = self.random.below(image.levels as usize) as u32;
        Some((slot, level, self.random.below(image.layers as usize) as u32, image.size_of(level)))
    }

    fn upload(&mut self, state: &State) {
        let Some((slot, level, layer, size)) = self.place(state) else { return };
        let Some(image) = state.textures[slot].as_ref() else { return };
        if image.shape != GlShape::Array && self.random.below(3) == 0 {
            let command = self.define(slot, [level, layer], image.format, size);
            return self.queue.push_back(command);
        }
        let area = self.area(size);
        let packing = pixels::packing(&mut self.random, image.format, area, true);
        let bytes = pixels::bytes(&mut self.random, &packing, [area[2] as u32, area[3] as u32]);
        let area = area.map(|side| side as u32);
        self.queue.push_back(Command::Upload { slot, level, layer, area, packing, bytes, anew: false });
    }

    fn read(&mut self, state: &State) {
        let Some(framebuffer) = state.framebuffer(true) else { return };
        let Some((size, _)) = state.complete(framebuffer) else { return };
        let color = self.random.below(2) == 0;
        let Some(format) = state.read_place(color).and_then(|place| state.image(place)).map(|image| image.format)
        else {
            return;
        };
        let area = self.area(size);
        let packing = pixels::packing(&mut self.random, format, area, false);
        self.queue.push_back(Command::Read { area, packing });
    }

    /// Images of one size in a framebuffer.
    fn framebuffer(&mut self, state: &State) {
        let slot = self.random.below(FRAMEBUFFERS - 1);
        let mut places = Vec::new();
        for (index, image) in state.textures.iter().enumerate() {
            let Some(image) = image else { continue };
            for (level, layer) in (0..image.levels).flat_map(|level| (0..image.layers).map(move |layer| (level, layer)))
            {
                let size = level_size(image.size, level);
                places.push((
                    Place::Texture { slot: index, level, layer },
                    image.format.is_depth(),
                    size,
                    image.samples,
                ));
            }
        }
        for (index, image) in state.renderbuffers.iter().enumerate() {
            let Some(image) = image else { continue };
            places.push((Place::Renderbuffer(index), image.format.is_depth(), image.size, image.samples));
        }
        let (first, is_depth, size, samples) = self.random.pick(&places);
        let like = |depth: bool| {
            places
                .iter()
                .filter(|(place, is, of, count)| *is == depth && *of == size && *count == samples && *place != first)
                .map(|(place, ..)| *place)
                .collect::<Vec<_>>()
        };
        let (colors, depths) = (like(false), like(true));
        let some = |random: &mut Random, of: &[Place]| (!of.is_empty() && random.below(4) > 0).then(|| random.pick(of));
        let (color, depth) = if is_depth {
            (some(&mut self.random, &colors), Some(first))
        } else {
            (Some(first), some(&mut self.random, &depths))
        };
        let second = some(&mut self.random, &colors).filter(|second| Some(*second) != color);
        let second = second.filter(|_| color.is_some() && self.random.below(2) == 0);
        let mut commands = Vec::new();
        if self.random.below(3) == 0 {
            commands.push(Command::Framebuffer(slot));
        }
        commands.push(Command::Attach { slot, point: Point::Color(0), place: color });
        commands.push(Command::Attach { slot, point: Point::Color(1), place: second });
        commands.push(Command::Attach { slot, point: Point::Depth, place: depth });
        commands.push(Command::Bind { draw: true, read: true, slot });
        let output = color.map(|_| 0);
        commands.push(Command::DrawBuffers([output, second.map(|_| 1)]));
        commands.push(Command::ReadBuffer(output));
        if self.random.below(2) == 0 {
            let [width, height] = size.map(|side| side as i32);
            commands.push(Command::Set(Setting::Viewport([0, 0, width, height])));
        }
        self.queue.extend(commands);
    }

    /// A program that reads, with a texture that it may read.
    fn look(&mut self, state: &State) {
        let program = self.random.pick(&Program::ALL);
        let slot = self.random.below(TEXTURES);
        let Some(image) = state.textures[slot].as_ref() else { return };
        let commands = self.palette.reading(&mut self.random, program, slot, image);
        self.queue.extend(commands.into_iter().map(Command::Set));
    }
}
