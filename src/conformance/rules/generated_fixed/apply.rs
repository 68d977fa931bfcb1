//! Commands, applied to the model's state.

use glam::{DMat4, DVec3, DVec4};

use super::start::COORDINATES;
use super::state::{CombinerState, FixedState, LIGHTS, target_index};
use crate::conformance::bench::fixed_commands::FixedCommand as Command;
use crate::context::compatibility::raw;

pub fn wide(values: [f32; 4]) -> DVec4 {
    DVec4::from_array(values.map(f64::from))
}

fn wide3(values: [f32; 3]) -> DVec3 {
    DVec3::from_array(values.map(f64::from))
}

fn matrix(values: &[f32; 16]) -> DMat4 {
    DMat4::from_cols_array(&values.map(f64::from))
}

/// Faces that a name means: front and back.
fn faces(face: u32) -> [bool; 2] {
    [face != glow::BACK, face != glow::FRONT]
}

impl FixedState {
    /// Applies a command; `targets` are those of the textures.
    pub fn apply(&mut self, command: &Command, targets: &[u32]) {
        match command {
            Command::Switch(what, on) => self.switch(*what, *on),
            Command::ActiveTexture(unit) => self.active = *unit as usize,
            Command::Texture(slot) => {
                self.units[self.active].bound[target_index(targets[*slot])] = Some(*slot);
            }
            Command::TexParameter(target, name, value) => self.parameter(*target, *name, *value as u32),
            Command::TexEnv(name, value) => self.environment(*name, *value as u32),
            Command::TexEnvScale(name, value) => {
                let unit = &mut self.units[self.active];
                let combiner = if *name == raw::RGB_SCALE { &mut unit.rgb } else { &mut unit.alpha };
                combiner.scale = f64::from(*value);
            }
            // Clamped to [0, 1] [GL 4.6 compatibility, 16.1].
            Command::TexEnvColor(color) => {
                self.units[self.active].constant = wide(*color).clamp(DVec4::ZERO, DVec4::ONE);
            }
            Command::TexGenMode(coordinate, mode) => {
                self.units[self.active].generate[coordinate_index(*coordinate)] = *mode;
            }
            Command::TexGenPlane(coordinate, name, plane, _) => {
                let (index, plane) = (coordinate_index(*coordinate), wide(*plane));
                let under = self.under_modelview(plane);
                let unit = &mut self.units[self.active];
                if *name == raw::OBJECT_PLANE {
                    unit.object_planes[index] = plane;
                } else {
                    unit.eye_planes[index] = under;
                }
            }
            Command::MatrixMode(mode) => self.matrix_mode = *mode,
            Command::LoadIdentity => self.load(DMat4::IDENTITY),
            Command::LoadMatrix(values) => self.load(matrix(values)),
            Command::MultMatrix(values) => self.multiply(matrix(values)),
            Command::Translate(by) => self.multiply(DMat4::from_translation(wide3(*by))),
            Command::Scale(by) => self.multiply(DMat4::from_scale(wide3(*by))),
            Command::Rotate(degrees, axis) => {
                let axis = wide3(*axis).normalize();
                self.multiply(DMat4::from_axis_angle(axis, f64::from(*degrees).to_radians()));
            }
            Command::PushMatrix => {
                let stack = self.stack();
                stack.push(Self::top(stack));
            }
            Command::PopMatrix => {
                let stack = self.stack();
                if stack.len() > 1 {
                    stack.pop();
                }
            }
            Command::PushAttrib(mask) => {
                let mut copy = self.clone();
                copy.saved.clear();
                self.saved.push((*mask, Box::new(copy)));
            }
            Command::PopAttrib => self.pop(),
            Command::NewList(slot, commands) => self.lists[*slot].clone_from(commands),
            Command::CallList(slot) => {
                for command in self.lists[*slot].clone() {
                    self.apply(&command, targets);
                }
            }
            Command::Clear(color) => self.background = wide(*color),
            Command::Draw(figure) => self.leave(figure),
            Command::AlphaFunc(function, reference) => {
                self.alpha_test = (*function, f64::from(*reference).clamp(0.0, 1.0));
            }
            Command::ClipPlane(index, plane) => {
                self.planes[*index as usize] = self.under_modelview(DVec4::from_array(*plane));
            }
            Command::FrontFace(front) => self.front = *front,
            Command::ShadeModel(mode) => self.shade = *mode,
            command => self.set_light(command),
        }
        self.track();
    }

    fn set_light(&mut self, command: &Command) {
        match *command {
            Command::Light(light, name, values) => {
                let (values, modelview) = (wide(values), Self::top(&self.modelview));
                let light = &mut self.lights[light as usize % LIGHTS];
                match name {
                    raw::AMBIENT => light.ambient = values,
                    raw::DIFFUSE => light.diffuse = values,
                    raw::SPECULAR => light.specular = values,
                    raw::POSITION => light.position = modelview * values,
                    _ => light.direction = modelview.transform_vector3(values.truncate()),
                }
            }
            Command::LightNumber(light, name, value) => {
                let light = &mut self.lights[light as usize % LIGHTS];
                let place = match name {
                    raw::SPOT_EXPONENT => &mut light.exponent,
                    raw::SPOT_CUTOFF => &mut light.cutoff,
                    raw::CONSTANT_ATTENUATION => &mut light.attenuation.x,
                    raw::LINEAR_ATTENUATION => &mut light.attenuation.y,
                    _ => &mut light.attenuation.z,
                };
                *place = f64::from(value);
            }
            Command::LightModel(name, value) => match name {
                raw::LIGHT_MODEL_TWO_SIDE => self.two_side = value != 0,
                raw::LIGHT_MODEL_LOCAL_VIEWER => self.local_viewer = value != 0,
                _ => self.separate = value as u32 == raw::SEPARATE_SPECULAR_COLOR,
            },
            Command::SceneAmbient(color) => self.scene_ambient = wide(color),
            Command::Material(face, name, color) => self.set_material(face, name, wide(color)),
            Command::Shininess(face, value) => {
                for (material, _) in self.materials.iter_mut().zip(faces(face)).filter(|(_, meant)| *meant) {
                    material.shininess = f64::from(value);
                }
            }
            Command::ColorMaterial(face, name) => self.color_material = [face, name],
            Command::Fog(name, value) => {
                *(if name == raw::FOG_MODE { &mut self.fog.mode } else { &mut self.fog.source }) = value as u32;
            }
            Command::FogNumber(name, value) => {
                let place = match name {
                    raw::FOG_DENSITY => &mut self.fog.density,
                    raw::FOG_START => &mut self.fog.start,
                    _ => &mut self.fog.end,
                };
                *place = f64::from(value);
            }
            Command::FogColor(color) => self.fog.color = wide(color).clamp(DVec4::ZERO, DVec4::ONE),
            Command::Color(color) => self.current.color = wide(color),
            Command::SecondaryColor(color) => self.current.secondary = wide3(color),
            Command::Normal(normal) => self.current.normal = wide3(normal),
            Command::FogCoord(value) => self.current.fog = f64::from(value),
            Command::MultiTexCoord(unit, values) => self.current.coordinates[unit as usize] = wide(values),
            _ => {}
        }
    }

    fn switch(&mut self, what: u32, on: bool) {
        let is_of_unit = super::state::TARGETS.contains(&what) || COORDINATES.iter().any(|[_, switch]| *switch == what);
        if is_of_unit { self.units[self.active].on.set(what, on) } else { self.on.set(what, on) }
    }

    fn parameter(&mut self, target: u32, name: u32, value: u32) {
        let Some(slot) = self.units[self.active].bound[target_index(target)] else { return };
        let texture = &mut self.textures[slot];
        match name {
            glow::TEXTURE_MIN_FILTER | glow::TEXTURE_MAG_FILTER => texture.linear = value == glow::LINEAR,
            glow::TEXTURE_WRAP_S => texture.wrap[0] = value,
            glow::TEXTURE_WRAP_T => texture.wrap[1] = value,
            glow::TEXTURE_WRAP_R => texture.wrap[2] = value,
            glow::TEXTURE_COMPARE_MODE => texture.compares = value != glow::NONE,
            glow::TEXTURE_COMPARE_FUNC => texture.function = value,
            _ => texture.mode = value,
        }
    }

    fn environment(&mut self, name: u32, value: u32) {
        let unit = &mut self.units[self.active];
        let set = |combiner: &mut CombinerState, source: u32, operand: u32| match name {
            name if (source..source + 3).contains(&name) => combiner.sources[(name - source) as usize] = value,
            name if (operand..operand + 3).contains(&name) => combiner.operands[(name - operand) as usize] = value,
            _ => {}
        };
        match name {
            raw::TEXTURE_ENV_MODE => unit.mode = value,
            raw::COMBINE_RGB => unit.rgb.function = value,
            raw::COMBINE_ALPHA => unit.alpha.function = value,
            _ => {
                set(&mut unit.rgb, raw::SRC0_RGB, raw::OPERAND0_RGB);
                set(&mut unit.alpha, raw::SRC0_ALPHA, raw::OPERAND0_ALPHA);
            }
        }
    }

    fn load(&mut self, matrix: DMat4) {
        if let Some(top) = self.stack().last_mut() {
            *top = matrix;
        }
    }

    fn multiply(&mut self, matrix: DMat4) {
        let stack = self.stack();
        let top = Self::top(stack);
        self.load(top * matrix);
    }

    /// A plane in eye space, as a row times the inverse of the modelview.
    fn under_modelview(&self, plane: DVec4) -> DVec4 {
        Self::top(&self.modelview).inverse().transpose() * plane
    }

    fn set_material(&mut self, face: u32, name: u32, color: DVec4) {
        for (material, _) in self.materials.iter_mut().zip(faces(face)).filter(|(_, meant)| *meant) {
            material.set(name, color);
        }
    }

    /// Makes what COLOR_MATERIAL names the current colour [GL 4.6 compatibility, 12.2.3].
    fn track(&mut self) {
        if self.on.has(raw::COLOR_MATERIAL) {
            let [face, name] = self.color_material;
            self.set_material(face, name, self.current.color);
        }
    }

    /// Values that a draw leaves as the current ones: those of the last vertex in immediate mode. The player sets those that
    /// arrays leave undefined to the same.
    fn leave(&mut self, figure: &crate::conformance::bench::fixed_commands::FixedFigure) {
        let Some(last) = figure.vertices.last() else { return };
        let (given, current) = (figure.given, &mut self.current);
        if given.color {
            current.color = wide(last.color);
        }
        if given.secondary {
            current.secondary = wide3(last.secondary);
        }
        if given.normal {
            current.normal = wide3(last.normal);
        }
        if given.fog {
            current.fog = f64::from(last.fog);
        }
        for (unit, _) in given.coordinates.iter().enumerate().filter(|(_, given)| **given) {
            current.coordinates[unit] = wide(last.coordinates[unit]);
        }
    }

    /// Gives back what a mask names [GL 4.6 compatibility, 21.6].
    fn pop(&mut self) {
        let Some((mask, before)) = self.saved.pop() else { return };
        let has = |bit: u32| mask & bit != 0;
        let enable = has(raw::ENABLE_BIT);
        let mut switches = Vec::new();
        if has(raw::CURRENT_BIT) {
            self.current = before.current;
        }
        if has(raw::LIGHTING_BIT) {
            (self.lights, self.materials, self.scene_ambient) = (before.lights, before.materials, before.scene_ambient);
            (self.two_side, self.local_viewer, self.separate) = (before.two_side, before.local_viewer, before.separate);
            (self.color_material, self.shade) = (before.color_material, before.shade);
        }
        if enable || has(raw::LIGHTING_BIT) {
            switches.extend([raw::LIGHTING, raw::COLOR_MATERIAL]);
            switches.extend((0..LIGHTS as u32).map(|light| raw::LIGHT0 + light));
        }
        if has(raw::FOG_BIT) {
            self.fog = before.fog;
        }
        if enable || has(raw::FOG_BIT) {
            switches.extend([raw::FOG, raw::COLOR_SUM]);
        }
        if has(raw::TRANSFORM_BIT) {
            (self.planes, self.matrix_mode) = (before.planes, before.matrix_mode);
        }
        if enable || has(raw::TRANSFORM_BIT) {
            switches.extend([raw::NORMALIZE, raw::RESCALE_NORMAL]);
            switches.extend((0..super::state::PLANES as u32).map(|plane| raw::CLIP_PLANE0 + plane));
        }
        if has(glow::COLOR_BUFFER_BIT) {
            self.alpha_test = before.alpha_test;
        }
        if enable || has(glow::COLOR_BUFFER_BIT) {
            switches.push(raw::ALPHA_TEST);
        }
        if has(raw::POLYGON_BIT) {
            self.front = before.front;
        }
        if has(raw::TEXTURE_BIT) {
            self.active = before.active;
            for (unit, old) in self.units.iter_mut().zip(&before.units) {
                *unit = old.clone();
                // Parameters of textures that were bound are theirs again.
                for slot in old.bound.iter().flatten() {
                    self.textures[*slot] = before.textures[*slot];
                }
            }
        } else if enable {
            self.units.iter_mut().zip(&before.units).for_each(|(unit, old)| unit.on = old.on.clone());
        }
        for what in switches {
            self.on.set(what, before.on.has(what));
        }
    }
}

fn coordinate_index(coordinate: u32) -> usize {
    (coordinate - raw::S) as usize
}
