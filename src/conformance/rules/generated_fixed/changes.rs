//! Single changes: a setting, and a value of it.

use super::generate::{FOG_MODES, StreamMaker};
use super::start::COORDINATES;
use super::state::{TARGETS, target_index};
use crate::conformance::bench::fixed_commands::FixedCommand as Command;
use crate::context::compatibility::raw;

impl StreamMaker<'_> {
    /// Binds a texture to the active unit and enables its target, or disables one.
    pub fn texture(&mut self, unit: usize) {
        if self.chance(0.25) {
            let target = self.random.pick(&TARGETS);
            return self.push(Command::Switch(target, false));
        }
        let slot = self.random.below(self.textures.len());
        let target = self.targets[slot];
        let before = self.state.units[unit].bound[target_index(target)];
        if before != Some(slot) {
            self.push(Command::Texture(slot));
        }
        // A target of more rank would hide it.
        for other in TARGETS.into_iter().filter(|other| target_index(*other) > target_index(target)) {
            if self.state.units[unit].on.has(other) && self.chance(0.7) {
                self.push(Command::Switch(other, false));
            }
        }
        if !self.state.units[unit].on.has(target) {
            self.push(Command::Switch(target, true));
        }
    }

    /// The mode of the active unit, or a combiner's function, sources and operands.
    pub fn mode(&mut self) {
        let modes =
            [glow::REPLACE, raw::MODULATE, raw::DECAL, glow::BLEND, raw::ADD, raw::COMBINE, raw::COMBINE, raw::COMBINE];
        let mode = self.deal("environment", &modes);
        self.push(Command::TexEnv(raw::TEXTURE_ENV_MODE, mode as i32));
        if mode != raw::COMBINE {
            return;
        }
        let functions = [glow::REPLACE, raw::MODULATE, raw::ADD, raw::ADD_SIGNED, raw::INTERPOLATE, raw::SUBTRACT];
        let operands = [glow::SRC_COLOR, glow::ONE_MINUS_SRC_COLOR, glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA];
        let units = self.units as u32;
        for (alpha, function, source, operand) in [
            (false, raw::COMBINE_RGB, raw::SRC0_RGB, raw::OPERAND0_RGB),
            (true, raw::COMBINE_ALPHA, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA),
        ] {
            if self.chance(0.8) {
                let dots = [raw::DOT3_RGB, raw::DOT3_RGBA];
                let any = self.deal(if alpha { "function of alpha" } else { "function" }, &functions);
                let of = if !alpha && self.chance(0.2) { self.deal("dot", &dots) } else { any };
                self.push(Command::TexEnv(function, of as i32));
            }
            for index in 0..3 {
                if self.chance(0.5) {
                    let sources =
                        [glow::TEXTURE, glow::TEXTURE, raw::PREVIOUS, raw::PREVIOUS, raw::PRIMARY_COLOR, raw::CONSTANT];
                    let crossbar = glow::TEXTURE0 + self.random.below(units as usize) as u32;
                    let of = if self.chance(0.2) { crossbar } else { self.random.pick(&sources) };
                    self.push(Command::TexEnv(source + index, of as i32));
                }
                if self.chance(0.5) {
                    let of = self.random.pick(&operands[if alpha { 2 } else { 0 }..]);
                    self.push(Command::TexEnv(operand + index, of as i32));
                }
            }
        }
        self.scale();
    }

    fn scale(&mut self) {
        let name = self.random.pick(&[raw::RGB_SCALE, raw::ALPHA_SCALE]);
        let scale = self.random.pick(&[1.0, 1.0, 2.0, 4.0]);
        self.push(Command::TexEnvScale(name, scale));
    }

    /// The environment's colour: any, or a dark one that the unit's scale makes bright.
    pub fn environment_number(&mut self) {
        let brightness = self.random.pick(&[1.0, 0.25]);
        let color = self.color().map(|part| brightness * part);
        self.push(Command::TexEnvColor(color));
    }

    /// Generation of one coordinate of the active unit, or of all.
    pub fn generation(&mut self) {
        let all = self.chance(0.4);
        let one = self.random.below(4);
        let on = self.chance(0.7);
        let modes = [raw::OBJECT_LINEAR, raw::EYE_LINEAR, raw::SPHERE_MAP, raw::REFLECTION_MAP, raw::NORMAL_MAP];
        let shared = self.deal("generation", &modes);
        for (index, [coordinate, switch]) in COORDINATES.into_iter().enumerate() {
            if !all && index != one {
                continue;
            }
            let fits = match shared {
                raw::SPHERE_MAP => index < 2,
                raw::REFLECTION_MAP | raw::NORMAL_MAP => index < 3,
                _ => true,
            };
            let mode = if fits { shared } else { self.random.pick(&modes[..2]) };
            if on {
                self.push(Command::TexGenMode(coordinate, mode));
            }
            self.push(Command::Switch(switch, on));
        }
    }

    /// A plane of the active unit. That of q keeps q near 1.
    pub fn plane(&mut self) {
        let index = self.random.below(4);
        let name = self.random.pick(&[raw::OBJECT_PLANE, raw::EYE_PLANE]);
        let mut plane = [(); 4].map(|()| self.random.between(-0.6, 0.6));
        if index == 3 {
            plane = [plane[0] * 0.1, plane[1] * 0.1, plane[2] * 0.1, 1.0 + plane[3]];
        }
        let doubles = self.chance(0.5);
        self.push(Command::TexGenPlane(COORDINATES[index][0], name, plane, doubles));
    }

    /// A parameter of a texture of the active unit.
    pub fn parameter(&mut self) {
        let Some(slot) = self.state.texture_of(self.state.active) else { return };
        let target = self.targets[slot];
        // Filters are other rules'.
        let is_depth = !self.textures[slot].depths.is_empty();
        match self.random.below(if is_depth { 5 } else { 2 }) {
            0 | 1 => {
                let name = self.random.pick(&[glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T, glow::TEXTURE_WRAP_R]);
                // Not to the border, beside which a texel would have to be known.
                let wraps = [glow::REPEAT, glow::CLAMP_TO_EDGE, glow::MIRRORED_REPEAT, raw::CLAMP];
                let wrap = self.random.pick(&wraps);
                self.push(Command::TexParameter(target, name, wrap as i32));
            }
            2 => {
                // RED is left out: llvmpipe's green of one stream is not explained.
                let mode = self.random.pick(&[raw::LUMINANCE, raw::INTENSITY, glow::ALPHA, raw::LUMINANCE]);
                self.push(Command::TexParameter(target, raw::DEPTH_TEXTURE_MODE, mode as i32));
            }
            3 => {
                let mode = self.random.pick(&[glow::COMPARE_REF_TO_TEXTURE, glow::NONE]);
                self.push(Command::TexParameter(target, glow::TEXTURE_COMPARE_MODE, mode as i32));
            }
            _ => {
                let function = self.random.pick(&[glow::LEQUAL, glow::GREATER, glow::LESS, glow::GEQUAL]);
                self.push(Command::TexParameter(target, glow::TEXTURE_COMPARE_FUNC, function as i32));
            }
        }
    }

    /// A number of a light that leaves its kind: far or near, a spot or not, attenuated or not.
    pub fn light_number(&mut self, light: u32) {
        let (color, [x, y, z]) = (self.color(), self.vector(4.0));
        let old = &self.state.lights[light as usize];
        let (cutoff, is_attenuated) = (old.cutoff, old.attenuation.y != 0.0);
        let w = self.state.lights[light as usize].position.w as f32;
        match self.random.below(7) {
            0 => self.push(Command::Light(light, raw::AMBIENT, color.map(|part| 0.2 * part))),
            1 => self.push(Command::Light(light, raw::DIFFUSE, color.map(|part| 0.7 * part))),
            2 => self.push(Command::Light(light, raw::SPECULAR, color.map(|part| 0.7 * part))),
            3 if cutoff != 180.0 => {
                let [x, y, z] = self.vector(1.0);
                self.push(Command::Light(light, raw::SPOT_DIRECTION, [x, y, z - 1.0, 0.0]));
            }
            4 if is_attenuated => {
                let number = self.random.pick(&[0.05, 0.2]);
                self.push(Command::LightNumber(light, raw::LINEAR_ATTENUATION, number));
            }
            _ => self.push(Command::Light(light, raw::POSITION, [x, y, z + 2.0 * w, w])),
        }
    }

    /// Makes a light one of each kind in turn: parallel or of a point, attenuated in one way or another.
    pub fn kind_of_light(&mut self, light: u32) {
        let w = self.deal("far", &[1.0, 1.0, 0.0, 2.0]);
        let [x, y, z] = self.vector(4.0);
        self.push(Command::Light(light, raw::POSITION, [x, y, z + 2.0 * w, w]));
        let kinds = [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.1], [0.8, 0.1, 0.05], [0.0, 0.4, 0.0]];
        let numbers = self.deal("attenuation", &kinds);
        let names = [raw::LINEAR_ATTENUATION, raw::QUADRATIC_ATTENUATION, raw::CONSTANT_ATTENUATION];
        for (name, number) in names.into_iter().zip([numbers[1], numbers[2], numbers[0]]) {
            self.push(Command::LightNumber(light, name, number));
        }
    }

    /// One property of a light.
    pub fn light(&mut self, light: u32) {
        let color = self.color();
        let position = self.vector(4.0);
        match self.random.below(12) {
            0 => self.push(Command::Light(light, raw::AMBIENT, color.map(|part| 0.2 * part))),
            1 => self.push(Command::Light(light, raw::DIFFUSE, color.map(|part| 0.7 * part))),
            2 => self.push(Command::Light(light, raw::SPECULAR, color.map(|part| 0.7 * part))),
            3..6 => {
                let w = self.random.pick(&[0.0, 1.0, 1.0, 2.0]);
                let [x, y, z] = position;
                self.push(Command::Light(light, raw::POSITION, [x, y, z + 2.0 * w, w]));
            }
            6 => {
                let [x, y, z] = self.vector(1.0);
                self.push(Command::Light(light, raw::SPOT_DIRECTION, [x, y, z - 1.0, 0.0]));
            }
            7 => {
                let cutoff = self.random.pick(&[180.0, 180.0, 90.0, 60.0, 35.0]);
                self.push(Command::LightNumber(light, raw::SPOT_CUTOFF, cutoff));
            }
            8 => {
                let exponent = self.random.pick(&[0.0, 1.0, 2.5, 8.0]);
                self.push(Command::LightNumber(light, raw::SPOT_EXPONENT, exponent));
            }
            9 => {
                let constant = self.random.between(0.5, 1.5);
                self.push(Command::LightNumber(light, raw::CONSTANT_ATTENUATION, constant));
            }
            10 => {
                let name = self.random.pick(&[raw::LINEAR_ATTENUATION, raw::QUADRATIC_ATTENUATION]);
                let number = self.random.pick(&[0.0, 0.05, 0.2]);
                self.push(Command::LightNumber(light, name, number));
                // Not all three are 0, or the light has no bound.
                self.push(Command::LightNumber(light, raw::CONSTANT_ATTENUATION, 1.0));
            }
            // The way that light falls off in nature, or one near to it: no constant part.
            _ => {
                let [linear, quadratic] = self.random.pick(&[[0.0, 0.1], [0.4, 0.0], [0.2, 0.05]]);
                for (name, number) in [
                    (raw::LINEAR_ATTENUATION, linear),
                    (raw::QUADRATIC_ATTENUATION, quadratic),
                    (raw::CONSTANT_ATTENUATION, 0.0),
                ] {
                    self.push(Command::LightNumber(light, name, number));
                }
            }
        }
    }

    pub fn light_model(&mut self) {
        match self.random.below(3) {
            0 => {
                let control = self.random.pick(&[raw::SINGLE_COLOR, raw::SEPARATE_SPECULAR_COLOR]);
                self.push(Command::LightModel(raw::LIGHT_MODEL_COLOR_CONTROL, control as i32));
            }
            1 => {
                let on = i32::from(self.chance(0.6));
                self.push(Command::LightModel(raw::LIGHT_MODEL_TWO_SIDE, on));
            }
            _ => {
                let on = i32::from(self.chance(0.6));
                self.push(Command::LightModel(raw::LIGHT_MODEL_LOCAL_VIEWER, on));
            }
        }
    }

    pub fn material(&mut self) {
        let face = self.random.pick(&[glow::FRONT, glow::BACK, glow::FRONT_AND_BACK]);
        let color = self.color();
        match self.random.below(7) {
            0 => self.push(Command::Material(face, raw::AMBIENT, color)),
            1 => self.push(Command::Material(face, raw::DIFFUSE, color)),
            2 => self.push(Command::Material(face, raw::SPECULAR, color)),
            3 => self.push(Command::Material(face, raw::EMISSION, color.map(|part| 0.3 * part))),
            4 => self.push(Command::Material(face, raw::AMBIENT_AND_DIFFUSE, color)),
            _ => {
                let shininess = self.random.pick(&[0.0, 1.0, 3.0, 8.0, 20.0, 64.0]);
                self.push(Command::Shininess(face, shininess));
            }
        }
    }

    pub fn fog_kind(&mut self) {
        match self.random.below(4) {
            0 | 1 => {
                let on = self.chance(0.7);
                self.push(Command::Switch(raw::FOG, on));
            }
            2 => {
                let mode = self.deal("fog mode", &FOG_MODES);
                self.push(Command::Fog(raw::FOG_MODE, mode as i32));
            }
            _ => {
                let source = self.random.pick(&[raw::FRAGMENT_DEPTH, raw::FOG_COORD, raw::FOG_COORD]);
                self.push(Command::Fog(raw::FOG_COORD_SRC, source as i32));
            }
        }
    }

    pub fn fog_number(&mut self) {
        let color = self.color();
        match self.random.below(4) {
            0 => self.push(Command::FogColor(color)),
            1 => {
                let density = self.random.between(0.02, 0.4);
                self.push(Command::FogNumber(raw::FOG_DENSITY, density));
            }
            2 => {
                let start = self.random.between(-1.0, 2.0);
                self.push(Command::FogNumber(raw::FOG_START, start));
            }
            _ => {
                let end = self.random.between(4.0, 12.0);
                self.push(Command::FogNumber(raw::FOG_END, end));
            }
        }
    }

    /// A plane that cuts some of the window, under the modelview that there is.
    pub fn clip_plane(&mut self, plane: u32) {
        let [x, y, z] = self.vector(1.0).map(f64::from);
        let offset = f64::from(self.random.between(-0.5, 2.5));
        self.push(Command::ClipPlane(plane, [x, y, 0.3 * z, offset]));
    }

    pub fn current(&mut self) {
        let (color, normal) = (self.color(), self.vector(1.0));
        match self.random.below(6) {
            0 => self.push(Command::Color(color)),
            1 => self.push(Command::SecondaryColor([0.4 * color[0], 0.4 * color[1], 0.4 * color[2]])),
            2 => self.push(Command::Normal(normal)),
            3 => {
                let fog = self.random.between(0.0, 6.0);
                self.push(Command::FogCoord(fog));
            }
            _ => {
                let (unit, coordinates) = (self.random.below(self.units) as u32, self.coordinates());
                self.push(Command::MultiTexCoord(unit, coordinates));
            }
        }
    }

    /// Texture coordinates, some of them projective.
    pub fn coordinates(&mut self) -> [f32; 4] {
        let [s, t] = [(); 2].map(|()| self.random.between(-1.2, 2.2));
        match self.random.below(3) {
            0 => [s, t, 0.0, 1.0],
            1 => [s, t, self.random.between(-0.2, 1.2), 1.0],
            _ => [s, t, self.random.between(-0.2, 1.2), self.random.between(0.6, 1.8)],
        }
    }
}
