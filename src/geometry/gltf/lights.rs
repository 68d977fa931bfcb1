//! Cameras and lights of a glTF, placed in the world [Khronos, "glTF 2.0 Specification", 3.10; Khronos,
//! "KHR_lights_punctual"].

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

use glam::{DMat4, DVec3};
use gltf::json::camera::Type;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type as LightType};
use gltf::json::validation::Checked;
use gltf::json::{Camera, Index};

use super::super::Error;
use super::super::tally::WarningTally;
use super::super::world::{PlacedCamera, PlacedLight, PlacedShape};
use super::file::File;
use super::nodes::Placed;

/// Greatest full angle of a spotlight, and of a camera, in degrees.
const WIDEST: f64 = 178.0;
/// Least of both.
const NARROWEST: f64 = 1.001;
/// Greatest colour of a light.
const BRIGHTEST: f64 = 1e6;

/// The axes of a node and its place.
struct Axes {
    place: DVec3,
    backward: DVec3,
    up: DVec3,
}

impl Axes {
    /// `None`: the node is flattened.
    fn of(world_from_node: &DMat4) -> Option<Self> {
        Some(Self {
            place: world_from_node.w_axis.truncate(),
            backward: world_from_node.z_axis.truncate().try_normalize()?,
            up: world_from_node.y_axis.truncate().try_normalize()?,
        })
    }
}

impl File {
    /// The cameras of the placed nodes.
    pub fn cameras(&self, placed: &[Placed], odd: &mut WarningTally) -> Result<Vec<PlacedCamera>, Error> {
        let (mut found, mut names) = (Vec::new(), Names::default());
        for node in placed {
            let Some(index) = self.root.nodes[node.node].camera else { continue };
            if let Some(camera) = self.camera(index, node, odd)? {
                let name = names.unique(camera.name.clone());
                found.push(PlacedCamera { name, ..camera });
            }
        }
        Ok(found)
    }

    fn camera(
        &self,
        index: Index<Camera>,
        node: &Placed,
        odd: &mut WarningTally,
    ) -> Result<Option<PlacedCamera>, Error> {
        let camera = self.get(index, &format!("nodes[{}].camera", node.node), "cameras")?;
        let place = format!("cameras[{}]", index.value());
        let Some(perspective) = &camera.perspective else {
            match camera.type_ {
                Checked::Valid(Type::Orthographic) => {
                    let what = || format!("{place}: is orthographic, which a scene's camera cannot be: left out");
                    odd.note("orthographic", &self.path, 0, what);
                    return Ok(None);
                }
                _ => return Err(self.error(place, "has neither `perspective` nor `orthographic`")),
            }
        };
        let Some(axes) = Axes::of(&node.world_from_node) else {
            return Ok(None);
        };
        let degrees = f64::from(perspective.yfov).to_degrees();
        let (near, far) = (f64::from(perspective.znear), perspective.zfar.map(f64::from));
        let is_right = degrees > 0.0 && near > 0.0 && far.is_none_or(|far| far > near);
        if !is_right || !degrees.is_finite() {
            return Err(self.error(place, "needs 0 < yfov and 0 < znear < zfar"));
        }
        let aspect = perspective.aspect_ratio.map(f64::from).filter(|aspect| (0.01..=100.0).contains(aspect));
        let fov_y_degrees = degrees.clamp(NARROWEST, WIDEST);
        if fov_y_degrees != degrees {
            let what = || format!("{place}: its angle of {degrees} degrees is drawn as {fov_y_degrees}");
            odd.note("angle", &self.path, 0, what);
        }
        let name = self.name_at(node.node, camera.name.as_deref(), "camera", index.value());
        let Axes { place: eye, backward, up } = axes;
        Ok(Some(PlacedCamera { name, eye, forward: -backward, up, fov_y_degrees, near, far, aspect }))
    }

    /// The lights of the placed nodes.
    pub fn lights(&self, placed: &[Placed], odd: &mut WarningTally) -> Result<Vec<PlacedLight>, Error> {
        let (mut found, mut names) = (Vec::new(), Names::default());
        for node in placed {
            let extensions = self.root.nodes[node.node].extensions.as_ref();
            let Some(named) = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref()) else {
                continue;
            };
            let place = format!("nodes[{}].extensions.KHR_lights_punctual", node.node);
            let light = self.get(named.light, &place, "extensions.KHR_lights_punctual.lights")?;
            let place = format!("extensions.KHR_lights_punctual.lights[{}]", named.light.value());
            let Some(axes) = Axes::of(&node.world_from_node) else { continue };
            let shape = self.light_shape(light, &axes, &place, odd)?;
            let color = self.light_color(light, &place, odd)?;
            let name = self.name_at(node.node, light.name.as_deref(), "light", named.light.value());
            found.push(PlacedLight { name: names.unique(name), color, shape });
        }
        Ok(found)
    }

    fn light_shape(
        &self,
        light: &Light,
        axes: &Axes,
        place: &str,
        odd: &mut WarningTally,
    ) -> Result<PlacedShape, Error> {
        let (position, direction) = (axes.place, -axes.backward);
        if light.range.is_some() {
            odd.note("range", &self.path, 0, || format!("{place}: its range is left out: it reaches farther"));
        }
        Ok(match (&light.type_, &light.spot) {
            (Checked::Valid(LightType::Directional), _) => PlacedShape::Directional { direction },
            (Checked::Valid(LightType::Point), _) => PlacedShape::Point { position },
            (Checked::Valid(LightType::Spot), Some(spot)) => {
                let (inner, outer) = (f64::from(spot.inner_cone_angle), f64::from(spot.outer_cone_angle));
                if !(inner >= 0.0 && outer > inner && outer <= PI / 2.0 + 1e-6) {
                    return Err(self.error(format!("{place}.spot"), "needs 0 <= inner < outer <= pi / 2 of its angles"));
                }
                let what = || format!("{place}: does not fade from its inner angle on: it ends at the outer one");
                odd.note("inner", &self.path, 0, what);
                let degrees = 2.0 * outer.to_degrees();
                let cone_degrees = degrees.clamp(NARROWEST, WIDEST);
                if degrees != cone_degrees {
                    let what = || format!("{place}: its cone of {degrees} degrees is drawn as {cone_degrees}");
                    odd.note("cone", &self.path, 0, what);
                }
                PlacedShape::Spot { position, direction, cone_degrees }
            }
            (Checked::Valid(LightType::Spot), None) => return Err(self.error(place, "is a spotlight without `spot`")),
            (Checked::Invalid, _) => {
                return Err(self.error(place, "has a `type` that KHR_lights_punctual does not know"));
            }
        })
    }

    fn light_color(&self, light: &Light, place: &str, odd: &mut WarningTally) -> Result<[f64; 3], Error> {
        let bright = f64::from(light.intensity) / PI;
        let color = light.color.map(|channel| f64::from(channel) * bright);
        if !color.iter().all(|channel| *channel >= 0.0 && channel.is_finite()) {
            return Err(self.error(place, "has a colour or an intensity below 0, or one that is not finite"));
        }
        if color.iter().any(|channel| *channel > BRIGHTEST) {
            odd.note("bright", &self.path, 0, || format!("{place}: is brighter than {BRIGHTEST:e}: drawn as that"));
        }
        Ok(color.map(|channel| channel.min(BRIGHTEST)))
    }

    /// The name of a node, of what it has, or of its kind and number.
    fn name_at(&self, node: usize, own: Option<&str>, kind: &str, number: usize) -> String {
        let of_node = self.root.nodes[node].name.as_deref();
        let name = of_node.filter(|name| !name.is_empty()).or(own.filter(|name| !name.is_empty()));
        name.map_or_else(|| format!("{kind} {number}"), str::to_owned)
    }
}

/// Names that are taken.
#[derive(Default)]
struct Names {
    taken: HashSet<String>,
    /// Next number behind a name that is taken.
    next: HashMap<String, usize>,
}

impl Names {
    /// The name, with a number behind it if it is taken.
    fn unique(&mut self, name: String) -> String {
        if self.taken.insert(name.clone()) {
            return name;
        }
        let next = self.next.entry(name.clone()).or_insert(2);
        loop {
            let numbered = format!("{name} {next}");
            *next += 1;
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}
