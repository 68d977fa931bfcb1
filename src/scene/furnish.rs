//! Cameras and lights of a model's file in the supplied scene, as [`Settings`]: overrides reach them, and they can be printed.

use glam::DVec3;

use super::default_scene::{array, entry, number, shadow, table, text, vector};
use super::resolve::DEFAULT_SIZE;
use super::settings::{Entry, Settings, Value};
use crate::geometry::{ModelWorld, PlacedCamera, PlacedLight, PlacedShape};

/// The longest side of a picture that a file's camera has a shape for.
const LONGEST_SIDE: f64 = 4096.0;

/// Puts the file's cameras and lights in place of the supplied ones, if it has any. The picture is as high as one of any scene,
/// and as wide as the first camera says.
pub(super) fn with_world(root: &mut Settings, world: &ModelWorld) {
    if let [first, others @ ..] = &world.cameras[..] {
        let cameras = match others {
            [] => camera(first),
            _ => array(world.cameras.iter().map(camera).collect()),
        };
        root.set("camera", cameras);
        if let (Some(aspect), Some(image)) = (first.aspect, image_table(root)) {
            let [_, height] = DEFAULT_SIZE;
            let width = (f64::from(height) * aspect).round().clamp(1.0, LONGEST_SIDE);
            let side = |side: i64| entry(Value::Integer(side));
            image.set("size", array(vec![side(width as i64), side(i64::from(height))]));
        }
    }
    if !world.lights.is_empty() {
        root.set("light", array(world.lights.iter().map(light).collect()));
    }
}

fn image_table(root: &mut Settings) -> Option<&mut Settings> {
    let (_, found) = root.entries.iter_mut().find(|(key, _)| key == "image")?;
    if let Value::Table(table) = &mut found.value { Some(table) } else { None }
}

fn camera(camera: &PlacedCamera) -> Entry {
    let mut keys = vec![
        ("name", text(&camera.name)),
        ("eye", vector(camera.eye)),
        ("target", vector(camera.eye + camera.forward)),
        ("up", vector(camera.up)),
        ("fov_y", number(camera.fov_y_degrees)),
        ("near", number(camera.near)),
    ];
    keys.extend(camera.far.map(|far| ("far", number(far))));
    table("camera", keys)
}

fn light(light: &PlacedLight) -> Entry {
    let mut keys = vec![("name", text(&light.name))];
    // Candela: it falls off with the square of the distance.
    let falls_off = || ("attenuation", vector(DVec3::Z));
    match light.shape {
        PlacedShape::Spot { position, direction, cone_degrees } => keys.extend([
            ("kind", text("spot")),
            ("position", vector(position)),
            ("target", vector(position + direction)),
            ("cone", number(cone_degrees)),
            ("shape", text("cone")),
            falls_off(),
        ]),
        PlacedShape::Point { position } => {
            keys.extend([("kind", text("point")), ("position", vector(position)), falls_off()])
        }
        PlacedShape::Directional { direction } => {
            keys.extend([("kind", text("directional")), ("direction", vector(direction))]);
        }
    }
    keys.push(("color", array(light.color.map(number).to_vec())));
    keys.push(("shadow", shadow()));
    table("light", keys)
}
