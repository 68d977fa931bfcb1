//! Commands, applied to the model, and a test whether GL defines what they do.

use crate::conformance::bench::commands::{
    CAPACITY, Clear, Command, Filling, Place, Point, Program, Rectangle, Setting,
};
use crate::conformance::bench::{GlFormat, GlShape};

use super::image::Image;
use super::pixel::channels;
use super::state::{Attached, Framebuffer, State};

impl State {
    /// Applies a command that is [allowed](Self::allows).
    pub fn apply(&mut self, command: &Command) {
        match *command {
            Command::Texture { slot, desc, fresh } => self.make_texture(slot, desc, fresh),
            Command::DeleteTexture(slot) => self.forget_texture(slot),
            Command::Upload { slot, level, layer, area, packing, ref bytes, .. } => {
                self.upload(slot, [level, layer], area, &packing, bytes);
            }
            Command::Levels(slot) => self.make_levels(slot),
            Command::Renderbuffer { slot, format, size, samples } => {
                self.renderbuffers[slot] = Some(Image::new(GlShape::Flat, format, size, 1, 1, samples));
            }
            Command::Framebuffer(slot) => {
                self.framebuffers[slot] = Some(Framebuffer::NEW);
                self.bound.iter_mut().filter(|bound| **bound == Some(slot)).for_each(|bound| *bound = None);
            }
            Command::Attach { slot, point, place } => {
                self.bound[0] = Some(slot);
                let stencil = place.and_then(|place| self.image(place)).is_some_and(|image| image.format.has_stencil());
                let attached = place.map(|place| Attached { place, stencil, stale: false });
                if let Some(framebuffer) = &mut self.framebuffers[slot] {
                    match point {
                        Point::Color(index) => framebuffer.color[index as usize] = attached,
                        Point::Depth => framebuffer.depth = attached,
                    }
                }
            }
            Command::DrawBuffers(outputs) => {
                if let Some(framebuffer) = self.bound[0].and_then(|slot| self.framebuffers[slot].as_mut()) {
                    framebuffer.outputs = outputs;
                }
            }
            Command::ReadBuffer(index) => {
                if let Some(framebuffer) = self.bound[1].and_then(|slot| self.framebuffers[slot].as_mut()) {
                    framebuffer.read = index;
                }
            }
            Command::Bind { draw, read, slot } => {
                for (bound, meant) in self.bound.iter_mut().zip([draw, read]) {
                    if meant {
                        *bound = Some(slot);
                    }
                }
            }
            Command::Set(setting) => self.set(setting),
            Command::Clear(clear) => self.clear(clear),
            Command::Fill { array, first, ref rectangles, filling } => {
                let mut all =
                    self.arrays[array].filter(|_| filling == Filling::Part).unwrap_or([Rectangle::NOTHING; CAPACITY]);
                all[first..first + rectangles.len()].copy_from_slice(rectangles);
                self.arrays[array] = Some(all);
            }
            Command::Draw { array, first, count, .. } => {
                let rectangles = self.arrays[array].map(|all| all[first..first + count].to_vec()).unwrap_or_default();
                rectangles.iter().for_each(|rectangle| self.draw_rectangle(rectangle));
            }
            Command::Blit { from, to, bits } => self.blit(from, to, bits),
            Command::Copy { from, slot, level, layer, at } => self.copy(from, slot, [level, layer], at),
            Command::BeginQuery => self.is_counting = true,
            Command::EndQuery => self.is_counting = false,
            Command::Read { .. } | Command::Flush => {}
        }
    }

    /// Tests whether GL makes no error of a command, and says what it does.
    pub fn allows(&self, command: &Command) -> bool {
        match *command {
            Command::Texture { .. } | Command::Renderbuffer { .. } | Command::Framebuffer(_) | Command::Flush => true,
            Command::DeleteTexture(slot) => self.textures[slot].is_some(),
            Command::Upload { slot, level, layer, area: [x, y, width, height], packing, anew, .. } => {
                self.textures[slot].as_ref().is_some_and(|image| {
                    let size = image.size_of(level);
                    let depth = packing.layout[0] == glow::DEPTH_COMPONENT;
                    let both = packing.layout[0] == glow::DEPTH_STENCIL;
                    level < image.levels
                        && layer < image.layers
                        && (!anew || [width, height] == size && image.shape != GlShape::Array)
                        && x + width <= size[0]
                        && y + height <= size[1]
                        && image.format.is_depth() == (depth || both)
                        && (both == (image.format == GlFormat::Depth24Stencil8))
                        && image.format != GlFormat::Depth32FStencil8
                })
            }
            Command::Levels(slot) => self.textures[slot].as_ref().is_some_and(|image| {
                !image.format.is_depth()
                    && image.size.iter().all(|side| side.is_power_of_two())
                    && image.range == [0, image.levels - 1]
                    && !self.is_attached(slot)
            }),
            Command::Attach { slot, point, place } => {
                self.framebuffers[slot].is_some()
                    && place.is_none_or(|place| {
                        let [level, layer] = Self::part(place);
                        self.image(place).is_some_and(|image| {
                            level < image.levels
                                && layer < image.layers
                                && image.format.is_depth() == (point == Point::Depth)
                        })
                    })
            }
            Command::DrawBuffers(outputs) => {
                outputs != [Some(0); 2] && outputs != [Some(1); 2] && self.framebuffer(false).is_some()
            }
            Command::ReadBuffer(_) => self.framebuffer(true).is_some(),
            Command::Bind { slot, .. } => self.framebuffers[slot].is_some(),
            Command::Set(setting) => self.allows_setting(setting),
            Command::Clear(clear) => {
                let Some(framebuffer) = self.framebuffer(false) else { return false };
                let stencil = framebuffer.depth.is_some_and(|of| of.stencil);
                self.complete(framebuffer).is_some()
                    && match clear {
                        Clear::Color(output, _) => framebuffer.outputs[output as usize].is_some(),
                        Clear::Both(..) | Clear::Stencil(_) => stencil,
                        Clear::Depth(_) => framebuffer.depth.is_some(),
                        Clear::Bits(_) => true,
                    }
            }
            Command::Fill { array, first, ref rectangles, filling } => match filling {
                Filling::Whole => first == 0 && rectangles.len() == CAPACITY,
                Filling::Part => self.arrays[array].is_some() && first + rectangles.len() <= CAPACITY,
            },
            Command::Draw { array, first, count, .. } => {
                self.arrays[array].is_some() && first + count <= CAPACITY && self.allows_draw()
            }
            Command::Blit { from, to, bits } => self.allows_blit(from, to, bits),
            Command::Copy { from, slot, level, layer, at } => self.allows_copy(from, slot, [level, layer], at),
            Command::Read { area, packing } => self.allows_read(area, packing.layout),
            Command::BeginQuery => !self.is_counting,
            Command::EndQuery => self.is_counting,
        }
    }

    /// Tests whether a framebuffer has a texture. Mesa 22.3.6 may give a texture new storage when its levels are made or
    /// others are chosen, and a framebuffer that has one of them draws into the old storage from then on.
    fn is_attached(&self, slot: usize) -> bool {
        let is = |of: &Attached| !of.stale && matches!(of.place, Place::Texture { slot: other, .. } if other == slot);
        self.framebuffers.iter().flatten().any(|framebuffer| framebuffer.places().any(is))
    }

    fn allows_setting(&self, setting: Setting) -> bool {
        let texture = |slot: usize| self.textures[slot].is_some();
        match setting {
            Setting::Texture(_, slot) | Setting::Swizzle(slot, _) => texture(slot),
            Setting::Levels(slot, [base, most]) => {
                let has = |image: &Image| {
                    base <= most && most < image.levels && (image.range == [base, most] || !self.is_attached(slot))
                };
                self.textures[slot].as_ref().is_some_and(has)
            }
            Setting::Filters(object, ..)
            | Setting::Wrap(object, _)
            | Setting::Border(object, _)
            | Setting::Compare(object, _)
            | Setting::LodRange(object, _) => match object {
                super::Sampled::Texture(slot) => texture(slot),
                super::Sampled::Sampler(_) => true,
            },
            _ => true,
        }
    }

    /// Tests whether a draw is defined: the framebuffer is complete, and the program reads what is not drawn into.
    fn allows_draw(&self) -> bool {
        let Some(framebuffer) = self.framebuffer(false) else { return false };
        if self.complete(framebuffer).is_none() {
            return false;
        }
        // An output that the program does not write leaves what it draws into undefined.
        // So does a clip distance that is on and not written [GL 4.6, 13.7]. One that is written and off must not clip, but
        // llvmpipe of Mesa 22.3.6 may: GL-R2 asks for it.
        if self.clip_distance != (self.program == Program::Clip) {
            return false;
        }
        let two = self.program == Program::Two;
        if !two && framebuffer.outputs[1].is_some() {
            return false;
        }
        let uniforms = &self.uniforms[self.program as usize];
        if self.program == Program::Squares && uniforms.period.contains(&0) {
            return false;
        }
        if !self.program.reads() {
            return true;
        }
        let Some((slot, looked)) = self.looked() else { return false };
        let fed =
            framebuffer.places().any(|of| matches!(of.place, Place::Texture { slot: other, .. } if other == slot));
        !fed && looked.is_defined(self.program)
    }

    /// Tests whether two framebuffers' images are the same.
    fn allows_blit(&self, from: [i32; 4], to: [i32; 4], bits: [bool; 3]) -> bool {
        let (Some(reading), Some(drawing)) = (self.framebuffer(true), self.framebuffer(false)) else { return false };
        let (Some((size, samples)), Some((_, others))) = (self.complete(reading), self.complete(drawing)) else {
            return false;
        };
        let inside = [0, 1].into_iter().all(|axis| {
            let ends = [from[axis], from[axis + 2]];
            ends.iter().all(|end| (0..=size[axis] as i32).contains(end))
                && ends[0] != ends[1]
                && to[axis] != to[axis + 2]
        });
        let places = |framebuffer: &Framebuffer| framebuffer.places().map(|of| of.place).collect::<Vec<_>>();
        let shared = places(reading).iter().any(|place| places(drawing).contains(place));
        let sources = self.read_place(true);
        let format = |place: Place| self.image(place).map(|image| image.format);
        let color = !bits[0]
            || sources.is_some_and(|place| {
                let targets = drawing.outputs.into_iter().flatten().filter_map(|index| drawing.color[index as usize]);
                let same = |of: Attached| format(of.place) == format(place);
                targets.into_iter().all(|of| samples == 0 || same(of))
            });
        let depth = !bits[1] && !bits[2]
            || reading.depth.zip(drawing.depth).is_some_and(|(one, other)| format(one.place) == format(other.place));
        let stencil = !bits[2] || reading.depth.is_some_and(|of| of.stencil);
        // Samples are resolved without a change of size [GL 4.6, 18.3.1].
        let resolved =
            samples == 0 || [0, 1].into_iter().all(|axis| from[axis + 2] - from[axis] == to[axis + 2] - to[axis]);
        inside && !shared && color && depth && stencil && resolved && others == 0
    }

    fn allows_copy(&self, from: [i32; 4], slot: usize, [level, layer]: [u32; 2], at: [i32; 2]) -> bool {
        let Some(image) = self.textures[slot].as_ref() else { return false };
        let color = !image.format.is_depth();
        let Some(source) = self.read_place(color) else { return false };
        let Some((size, 0)) = self.framebuffer(true).and_then(|framebuffer| self.complete(framebuffer)) else {
            return false;
        };
        let Some(format) = self.image(source).map(|image| image.format) else { return false };
        if level >= image.levels || layer >= image.layers {
            return false;
        }
        let within = |low: i32, side: i32, size: u32| low >= 0 && side > 0 && low + side <= size as i32;
        let target = image.size_of(level);
        let fits = [0, 1].into_iter().all(|axis| {
            within(from[axis], from[axis + 2], size[axis]) && within(at[axis], from[axis + 2], target[axis])
        });
        let same = matches!(source, Place::Texture { slot: other, .. } if other == slot);
        let formats = if color { channels(format) >= channels(image.format) } else { format == image.format };
        fits && !same && formats
    }

    fn allows_read(&self, [x, y, width, height]: [i32; 4], [layout, _]: [u32; 2]) -> bool {
        let Some((size, 0)) = self.framebuffer(true).and_then(|framebuffer| self.complete(framebuffer)) else {
            return false;
        };
        let color = !matches!(layout, glow::DEPTH_COMPONENT | glow::STENCIL_INDEX | glow::DEPTH_STENCIL);
        let Some(format) = self.read_place(color).and_then(|place| self.image(place)).map(|image| image.format) else {
            return false;
        };
        let has = match layout {
            glow::STENCIL_INDEX => format.has_stencil(),
            glow::DEPTH_STENCIL => format == GlFormat::Depth24Stencil8,
            _ => true,
        };
        has && x >= 0
            && y >= 0
            && width > 0
            && height > 0
            && x + width <= size[0] as i32
            && y + height <= size[1] as i32
    }
}
