//! Lighting in the model [GL 4.6 compatibility, 12.2.1].

use glam::{DVec3, DVec4};

use super::state::{FixedState, LightState, MaterialState};
use crate::context::compatibility::raw;

/// Distance of a cosine from a jump within which either side may be taken.
const NEAR: f64 = 1e-3;

/// Colours of a vertex.
#[derive(Clone, Copy, Debug)]
pub struct Shaded {
    pub primary: DVec4,
    pub secondary: DVec3,
}

impl FixedState {
    /// The material of a side, with what COLOR_MATERIAL makes the vertex's colour.
    fn material(&self, side: usize, color: DVec4) -> MaterialState {
        let mut material = self.materials[side];
        let [face, name] = self.color_material;
        let meant = face == glow::FRONT_AND_BACK || (face == glow::BACK) == (side == 1);
        if self.on.has(raw::COLOR_MATERIAL) && meant {
            material.set(name, color);
        }
        material
    }

    /// Colours of a side of a vertex, and whether no term is near a jump.
    pub fn lit(&self, side: usize, color: DVec4, eye: DVec3, normal: DVec3) -> (Shaded, bool) {
        let material = self.material(side, color);
        let normal = if side == 1 { -normal } else { normal };
        let mut primary = material.emission.truncate() + (material.ambient * self.scene_ambient).truncate();
        let mut secondary = DVec3::ZERO;
        let mut sure = true;
        for (light, _) in self.lights.iter().zip(0..).filter(|(_, index)| self.on.has(raw::LIGHT0 + index)) {
            let (diffuse, gleam, is_sure) = self.of_light(light, &material, eye, normal);
            sure &= is_sure;
            primary += diffuse;
            *(if self.separate { &mut secondary } else { &mut primary }) += gleam;
        }
        let primary = primary.extend(material.diffuse.w).clamp(DVec4::ZERO, DVec4::ONE);
        (Shaded { primary, secondary: secondary.clamp(DVec3::ZERO, DVec3::ONE) }, sure)
    }

    /// Ambient and diffuse light, the highlight, and whether no term is near a jump.
    fn of_light(
        &self,
        light: &LightState,
        material: &MaterialState,
        eye: DVec3,
        normal: DVec3,
    ) -> (DVec3, DVec3, bool) {
        let position = light.position;
        let at_infinity = position.w == 0.0;
        let way = if at_infinity { position.truncate() } else { position.truncate() / position.w - eye };
        let (distance, to_light) = (way.length(), way.normalize());
        let mut strength = 1.0;
        if !at_infinity {
            strength /= light.attenuation.dot(DVec3::new(1.0, distance, distance * distance));
        }
        let mut sure = true;
        if light.cutoff != 180.0 {
            let along = (-to_light).dot(light.direction.normalize());
            let least = light.cutoff.to_radians().cos();
            sure &= (along - least).abs() > NEAR;
            strength *= if along >= least { along.max(0.0).powf(light.exponent) } else { 0.0 };
        }
        let cosine = normal.dot(to_light);
        let shines = material.specular.truncate() * light.specular.truncate() != DVec3::ZERO;
        sure &= !shines || cosine.abs() > NEAR;
        let viewer = if self.local_viewer { (-eye).normalize() } else { DVec3::Z };
        let half = (to_light + viewer).normalize();
        // 0 to the power of 0 may be 1 or 0.
        sure &= !shines || material.shininess > 0.0 || normal.dot(half) > NEAR;
        let gleam = if cosine > 0.0 { normal.dot(half).max(0.0).powf(material.shininess) } else { 0.0 };
        let diffuse = material.ambient * light.ambient + cosine.max(0.0) * material.diffuse * light.diffuse;
        let highlight = gleam * material.specular * light.specular;
        (strength * diffuse.truncate(), strength * highlight.truncate(), sure)
    }
}
