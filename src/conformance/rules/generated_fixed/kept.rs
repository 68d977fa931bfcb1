//! Attributes that are saved and given back, and display lists.

use super::generate::StreamMaker;
use super::state::FixedState;
use crate::conformance::bench::fixed_commands::FixedCommand as Command;
use crate::context::compatibility::raw;

impl StreamMaker<'_> {
    /// Saves attributes, or gives them back. What tracks the current colour is left alone: GL does not say when it follows.
    pub fn attributes(&mut self) {
        let tracks = |state: &FixedState| state.on.has(raw::COLOR_MATERIAL);
        if tracks(&self.state) {
            return;
        }
        let last = self.state.saved.last().map(|(_, state)| tracks(state));
        if last == Some(false) && self.chance(0.6) {
            // Clip planes that Mesa 22.3.6 gives back are read so, and those of before clip on.
            let planes = (self.state.saved.last())
                .is_some_and(|(mask, state)| mask & raw::TRANSFORM_BIT != 0 && state.planes != self.state.planes);
            if planes {
                return;
            }
            let Some((mask, before, source)) =
                self.state.saved.last().map(|(mask, state)| (*mask, state.on.clone(), state.fog.source))
            else {
                return;
            };
            let now = self.state.on.clone();
            self.push(Command::PopAttrib);
            // Mesa 22.3.6 does not give COLOR_SUM back, which is saved with FOG_BIT and ENABLE_BIT, nor lights with ENABLE_BIT alone.
            if mask & (raw::FOG_BIT | raw::ENABLE_BIT) != 0 {
                self.push(Command::Switch(raw::COLOR_SUM, before.has(raw::COLOR_SUM)));
            }
            // Nor the source of fog coordinates with FOG_BIT.
            if mask & raw::FOG_BIT != 0 {
                self.push(Command::Fog(raw::FOG_COORD_SRC, source as i32));
            }
            if mask & (raw::LIGHTING_BIT | raw::ENABLE_BIT) == raw::ENABLE_BIT {
                for light in (raw::LIGHT0..=raw::LIGHT7).filter(|light| now.has(*light) != before.has(*light)) {
                    self.push(Command::Switch(light, before.has(light)));
                }
            }
            return;
        }
        if self.state.saved.len() < 4 {
            let bits = [
                raw::CURRENT_BIT,
                raw::LIGHTING_BIT,
                raw::FOG_BIT,
                raw::TRANSFORM_BIT,
                raw::TEXTURE_BIT,
                raw::ENABLE_BIT,
                raw::POLYGON_BIT,
                glow::COLOR_BUFFER_BIT,
            ];
            // Mesa 22.3.6 does not give back what was set within another glPushAttrib that does not save it.
            let is_within = !self.state.saved.is_empty();
            let mask = match self.random.below(3) {
                _ if is_within => bits.iter().sum(),
                0 if self.chance(0.5) => bits.iter().sum(),
                1 => self.deal("bit", &bits),
                _ => self.deal("bit", &bits) | self.random.pick(&bits),
            };
            self.push(Command::PushAttrib(mask));
            if !is_within {
                self.change_saved(mask);
            }
        }
    }

    /// Changes numbers that are saved, so that something is to be given back.
    fn change_saved(&mut self, mask: u32) {
        let saves = |bit: u32| mask & bit != 0;
        if saves(raw::CURRENT_BIT) {
            self.current();
        }
        if saves(raw::LIGHTING_BIT) {
            let light = self.random.below(3) as u32;
            self.light_number(light);
            self.material();
        }
        if saves(raw::FOG_BIT) {
            self.fog_number();
            self.fog_number();
        }
        if saves(raw::TRANSFORM_BIT) {
            self.clip_plane(0);
        }
        if saves(raw::TEXTURE_BIT) {
            self.environment_number();
            self.plane();
        }
    }

    /// A list of a few commands that is kept, or one that was.
    pub fn list(&mut self) {
        let slot = self.random.below(3);
        if self.chance(0.6) && !self.state.lists[slot].is_empty() {
            return self.push(Command::CallList(slot));
        }
        let (state, made) = (self.state.clone(), std::mem::take(&mut self.made));
        for _ in 0..1 + self.random.below(4) {
            match self.random.below(6) {
                0 => self.environment_number(),
                1 => self.plane(),
                2 => self.current(),
                3 => self.material(),
                4 => self.fog_number(),
                _ => {
                    let light = self.random.below(8) as u32;
                    self.light_number(light);
                }
            }
        }
        let commands = std::mem::replace(&mut self.made, made);
        self.state = state;
        self.push(Command::NewList(slot, commands));
    }
}
