//! Random commands of the fixed-function pipeline: little is set anew between draws. The maker's state is the model's.

use std::collections::BTreeMap;

use glam::DVec3;

use super::state::{FixedState, TARGETS, target_index};
use crate::conformance::bench::fixed_commands::{FIXED_UNITS, FixedCommand as Command, FixedGiven, FixedTexture};
use crate::conformance::random::Random;
use crate::context::compatibility::raw;

/// Ways in which fog thickens.
pub const FOG_MODES: [u32; 3] = [glow::LINEAR, raw::EXP, raw::EXP2];

pub struct StreamMaker<'a> {
    pub random: Random,
    pub state: FixedState,
    /// Commands that have been made and not been given.
    pub made: Vec<Command>,
    pub textures: &'a [FixedTexture],
    pub targets: Vec<u32>,
    /// Units that are used.
    pub units: usize,
    /// Attributes that each vertex is given.
    pub given: FixedGiven,
    decks: &'a mut Decks,
}

/// Lists whose entries are dealt in a random order, each once before any comes again: a few streams have all of them.
#[derive(Default)]
pub struct Decks(BTreeMap<&'static str, Vec<usize>>);

impl<'a> StreamMaker<'a> {
    pub fn new(seed: u64, textures: &'a [FixedTexture], units: usize, decks: &'a mut Decks) -> Self {
        let targets = textures.iter().map(|texture| texture.target).collect();
        let state = FixedState::new(textures.len());
        let (random, units) = (Random::new(seed), units.min(FIXED_UNITS));
        Self { random, state, made: Vec::new(), textures, targets, units, given: FixedGiven::default(), decks }
    }

    /// Deals one of a list; the lists of a name are of one length.
    pub fn deal<T: Copy>(&mut self, name: &'static str, list: &[T]) -> T {
        let deck = self.decks.0.entry(name).or_default();
        if deck.is_empty() {
            deck.extend(0..list.len());
        }
        let place = self.random.below(deck.len());
        list[deck.swap_remove(place)]
    }

    /// Makes a command, and applies it.
    pub fn push(&mut self, command: Command) {
        self.state.apply(&command, &self.targets);
        self.made.push(command);
    }

    pub fn chance(&mut self, share: f32) -> bool {
        self.random.chance(share)
    }

    /// Makes a unit the active one.
    pub fn activate(&mut self, unit: usize) {
        if self.state.active != unit {
            self.push(Command::ActiveTexture(unit as u32));
        }
    }

    pub fn matrix_mode(&mut self, mode: u32) {
        if self.state.matrix_mode != mode {
            self.push(Command::MatrixMode(mode));
        }
    }

    pub fn color(&mut self) -> [f32; 4] {
        [(); 4].map(|()| self.random.pick(&[0.0, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0]) * self.random.between(0.7, 1.0))
    }

    pub fn vector(&mut self, length: f32) -> [f32; 3] {
        let of = [(); 3].map(|()| self.random.between(-1.0, 1.0));
        let size = of.iter().map(|part| part * part).sum::<f32>().sqrt().max(0.1);
        of.map(|part| part / size * length)
    }

    /// Changes of numbers, which no driver compiles a program for; then a draw.
    pub fn step(&mut self, anew: bool) {
        if anew {
            for _ in 0..1 + self.random.below(4) {
                self.change_kind();
            }
            self.give();
        }
        for _ in 0..1 + self.random.below(5) {
            self.change_number();
        }
        self.repair();
    }

    /// A stream's beginning: several units, and sometimes lights.
    pub fn begin(&mut self) {
        self.made = super::start::starting();
        // q would be 0 where it is generated, and (0, 0) is a texel's corner.
        for unit in (0..self.units).rev() {
            self.activate(unit);
            let coordinates = self.coordinates();
            self.push(Command::MultiTexCoord(unit as u32, coordinates));
            for name in [raw::OBJECT_PLANE, raw::EYE_PLANE] {
                self.push(Command::TexGenPlane(raw::Q, name, [0.0, 0.0, 0.0, 1.0], false));
            }
        }
        for unit in 0..1 + self.random.below(self.units) {
            self.activate(unit);
            self.texture(unit);
            self.mode();
        }
        if self.deal("lighting", &[true, true, true, false]) {
            self.push(Command::Switch(raw::LIGHTING, true));
            for _ in 0..3 {
                let light = self.random.below(8) as u32;
                self.push(Command::Switch(raw::LIGHT0 + light, true));
                // Bright enough to be seen, and no sum of three is saturated.
                for name in [raw::DIFFUSE, raw::SPECULAR] {
                    let [red, green, blue] = [(); 3].map(|()| self.random.between(0.2, 0.5));
                    self.push(Command::Light(light, name, [red, green, blue, 1.0]));
                }
                (0..8).for_each(|_| self.light(light));
                self.kind_of_light(light);
                self.material();
            }
            let [red, green, blue] = [(); 3].map(|()| self.random.between(0.3, 0.7));
            self.push(Command::Material(glow::FRONT_AND_BACK, raw::SPECULAR, [red, green, blue, 1.0]));
        }
        if self.deal("fog", &[true, true, true, false]) {
            self.push(Command::Switch(raw::FOG, true));
            let mode = self.deal("fog mode", &FOG_MODES);
            self.push(Command::Fog(raw::FOG_MODE, mode as i32));
            (0..6).for_each(|_| self.fog_number());
        }
        if self.deal("alpha test", &[true, false, false]) {
            let reference = self.random.between(0.3, 0.7);
            self.push(Command::AlphaFunc(glow::GEQUAL, reference));
            self.push(Command::Switch(raw::ALPHA_TEST, true));
        }
        if self.deal("planes", &[true, false]) {
            self.modelview();
            self.clip_plane(0);
            self.push(Command::Switch(raw::CLIP_PLANE0, true));
        }
        for _ in 0..6 {
            self.change_kind();
        }
        for _ in 0..30 {
            self.change_number();
        }
    }

    fn change_kind(&mut self) {
        let unit = self.random.below(self.units);
        match self.random.below(26) {
            0..4 => {
                self.activate(unit);
                self.texture(unit);
            }
            4..8 => {
                self.activate(unit);
                self.mode();
            }
            8..11 => {
                self.activate(unit);
                self.generation();
            }
            11..13 => {
                let on = self.deal("lighting", &[true, true, true, false]);
                self.push(Command::Switch(raw::LIGHTING, on));
            }
            13 | 23 => {
                let on = self.chance(0.5);
                let light = self.random.below(8) as u32;
                self.push(Command::Switch(raw::LIGHT0 + light, on));
                if on {
                    (0..7).for_each(|_| self.light(light));
                }
            }
            14 => self.light_model(),
            15 | 21 => self.fog_kind(),
            16 => {
                let what =
                    self.random.pick(&[raw::NORMALIZE, raw::RESCALE_NORMAL, raw::COLOR_SUM, raw::COLOR_MATERIAL]);
                let on = self.chance(0.5);
                self.push(Command::Switch(what, on));
            }
            17 => {
                let face = self.random.pick(&[glow::FRONT, glow::BACK, glow::FRONT_AND_BACK]);
                let names = [raw::AMBIENT, raw::DIFFUSE, raw::SPECULAR, raw::EMISSION, raw::AMBIENT_AND_DIFFUSE];
                let name = self.random.pick(&names);
                self.push(Command::ColorMaterial(face, name));
            }
            18 => {
                let on = self.chance(0.4);
                self.push(Command::Switch(raw::ALPHA_TEST, on));
                let functions = [glow::GREATER, glow::GEQUAL, glow::LESS, glow::LEQUAL, glow::NOTEQUAL, glow::ALWAYS];
                let function = self.deal("alpha function", &functions);
                let reference = self.random.between(0.1, 0.9);
                self.push(Command::AlphaFunc(function, reference));
            }
            19 | 22 => {
                let plane = self.random.below(4) as u32;
                let on = self.chance(0.35);
                self.clip_plane(plane);
                self.push(Command::Switch(raw::CLIP_PLANE0 + plane, on));
            }
            20 => {
                let mode = self.random.pick(&[raw::FLAT, raw::SMOOTH]);
                self.push(Command::ShadeModel(mode));
                let front = self.random.pick(&[glow::CW, glow::CCW]);
                self.push(Command::FrontFace(front));
            }
            _ => self.attributes(),
        }
    }

    fn change_number(&mut self) {
        let unit = self.random.below(self.units);
        match self.random.below(26) {
            0..3 => self.modelview(),
            3 => self.projection(),
            4..6 => {
                self.activate(unit);
                self.matrix_mode(glow::TEXTURE);
                self.texture_matrix();
            }
            6..9 => {
                let light = self.random.below(8) as u32;
                self.light_number(light);
            }
            9..11 => self.material(),
            11 => {
                let color = self.color();
                self.push(Command::SceneAmbient(color.map(|part| 0.4 * part)));
            }
            12 | 24 => self.fog_number(),
            13..15 => {
                self.activate(unit);
                self.environment_number();
            }
            15..17 => {
                self.activate(unit);
                self.plane();
            }
            17..20 => self.current(),
            20 => {
                let plane = self.random.below(4) as u32;
                self.clip_plane(plane);
            }
            21 => {
                self.activate(unit);
                self.parameter();
            }
            22 => self.list(),
            _ => self.attributes(),
        }
    }

    /// Sets what a draw needs to be defined: textures that are bound, functions that fit them, matrices that can be inverted.
    fn repair(&mut self) {
        for unit in 0..FIXED_UNITS {
            for target in TARGETS {
                let state = &self.state.units[unit];
                if state.on.has(target) && state.bound[target_index(target)].is_none() {
                    self.activate(unit);
                    self.push(Command::Switch(target, false));
                }
            }
        }
        for unit in 0..FIXED_UNITS {
            let Some(slot) = self.state.texture_of(unit) else { continue };
            let state = &self.state.units[unit];
            // DECAL is of RGB and RGBA alone [GL 4.6 compatibility, table 16.16].
            if state.mode == raw::DECAL && !matches!(self.textures[slot].format, glow::RGBA8 | glow::RGB8) {
                self.activate(unit);
                self.push(Command::TexEnv(raw::TEXTURE_ENV_MODE, raw::MODULATE as i32));
            }
            if self.state.units[unit].mode == raw::COMBINE {
                self.repair_sources(unit);
            }
        }
        self.repair_matrices();
        self.repair_shininess();
    }

    /// Makes another unit the active one, and back: Mesa 22.3.6 draws with texture matrices of before until then.
    pub fn refresh(&mut self) {
        let active = self.state.active as u32;
        self.push(Command::ActiveTexture(u32::from(active == 0)));
        self.push(Command::ActiveTexture(active));
    }

    /// Mesa takes (n . l) to the power of itself for highlights of attenuated lights and of spots where all shininess is 0.
    fn repair_shininess(&mut self) {
        let state = &self.state;
        let dull = state.materials.iter().any(|material| material.shininess == 0.0);
        let weakened = (state.lights.iter().zip(0..)).any(|(light, index)| {
            state.on.has(raw::LIGHT0 + index) && (light.cutoff != 180.0 || light.attenuation != DVec3::X)
        });
        if dull && weakened {
            let shininess = self.random.pick(&[0.5, 1.0, 2.0, 5.0]);
            self.push(Command::Shininess(glow::FRONT_AND_BACK, shininess));
        }
    }

    /// No source may be a unit without a texture.
    fn repair_sources(&mut self, unit: usize) {
        for (alpha, first) in [(false, raw::SRC0_RGB), (true, raw::SRC0_ALPHA)] {
            let state = &self.state.units[unit];
            let sources = if alpha { state.alpha.sources } else { state.rgb.sources };
            for (index, source) in (0..).zip(sources) {
                let other = source.wrapping_sub(glow::TEXTURE0) as usize;
                if other < FIXED_UNITS && self.state.texture_of(other).is_none() {
                    self.activate(unit);
                    self.push(Command::TexEnv(first + index, raw::PREVIOUS as i32));
                }
            }
        }
    }
}

impl StreamMaker<'_> {
    /// Commands that give back every matrix that is kept.
    pub fn unstacked(&self) -> Vec<Command> {
        let mut all = Vec::new();
        let pops = |all: &mut Vec<Command>, mode: u32, depth: usize| {
            all.push(Command::MatrixMode(mode));
            all.extend((1..depth).map(|_| Command::PopMatrix));
        };
        pops(&mut all, raw::MODELVIEW, self.state.modelview.len());
        pops(&mut all, raw::PROJECTION, self.state.projection.len());
        for (unit, stack) in (0..).zip(&self.state.texture_matrices) {
            all.push(Command::ActiveTexture(unit));
            pops(&mut all, glow::TEXTURE, stack.len());
        }
        all
    }
}
