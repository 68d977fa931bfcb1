//! The scene that is supplied for a bare OBJ file: a floor, a spotlight and a camera framed on the model. It is built
//! as [`Settings`], so that overrides reach it and it can be printed.

use glam::DVec3;

use super::resolve::{DEFAULT_BACKGROUND, DEFAULT_SIZE};
use super::settings::{Entry, Origin, Settings, Value};
use super::{Object, camera_framing};
use crate::math::Aabb;

/// Direction from the model to the light: from the left, above. Across the camera's view, so that the shadow falls beside
/// the model and not behind it.
const TOWARD_LIGHT: DVec3 = DVec3::new(-0.5, 1.3, 0.65);

/// The light's distance from the model's middle, in radii; its cone; half the floor's side, in radii.
const LIGHT_RADII: f64 = 4.0;
const CONE_DEGREES: f64 = 50.0;
const FLOOR_RADII: f64 = 4.0;

/// A model lower than this, in radii, is held above the floor by [`LIFT_RADII`]: lying on it, it would have no shadow.
const FLAT_RADII: f64 = 0.01;
const LIFT_RADII: f64 = 0.25;

/// Greatest height of a model's own floor over its lowest point, in radii. The supplied one lies as far below that: any
/// depth buffer resolves it.
const HAIR_RADII: f64 = 2e-3;

/// Least share of a model's extent from above that its own floor fills.
const LEAST_FLOOR: f64 = 1e-3;

/// A scene is supplied around models of these radii: camera, light and planes then have coordinates that a scene may have.
pub(super) const RADII: [f64; 2] = [1e-14, 1e14];

/// Place of the supplied floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Floor {
    /// At the model's lowest point.
    Touching,
    /// A little below it, because the model has a floor of its own.
    Below,
    /// No floor.
    Absent,
}

/// The scene around a model named `mesh` that fills `bounds`; `aspect` is the picture's width over its height.
///
/// y is up: it is not guessed.
pub fn framing(mesh: &str, bounds: &Aabb, aspect: f64, floor: Floor) -> Settings {
    let bounds = if bounds.is_empty() { Aabb { min: DVec3::ZERO, max: DVec3::ZERO } } else { *bounds };
    let stage = Stage::new(&bounds, floor);
    let model = table("object", vec![("mesh", text(mesh))]);
    root(vec![
        ("image", image()),
        ("camera", stage.camera(aspect)),
        ("light", array(vec![stage.light()])),
        ("object", array(if floor == Floor::Absent { vec![model] } else { vec![model, stage.floor()] })),
    ])
}

/// Distance of the supplied floor below a model's own.
pub(super) fn hair(bounds: &Aabb) -> f64 {
    HAIR_RADII * camera_framing::working_radius(bounds)
}

/// Tests whether a model has faces in the plane of its lowest point that are seen from above: a floor there would show through
/// them. The bottom of a closed mesh is not seen.
pub(super) fn has_floor(object: &Object) -> bool {
    let (mesh, positions) = (&object.mesh, object.drawn_positions());
    let place = |index: &u32| {
        let position = positions.get(*index as usize).copied().unwrap_or_default();
        object.world_from_model.transform_point3(DVec3::from_array(position.map(f64::from)))
    };
    let bounds = object.world_bounds();
    let (size, top) = (bounds.max - bounds.min, bounds.min.y + hair(&bounds));
    let turned = object.world_from_model.determinant().signum();
    let (mut above, mut below) = (0.0, 0.0);
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = [0, 1, 2].map(|k| place(&triangle[k]));
        if a.y.max(b.y).max(c.y) <= top {
            let area = 0.5 * turned * (b - a).cross(c - a).y;
            (above, below) = (above + area.max(0.0), below + (-area).max(0.0));
        }
    }
    let least = LEAST_FLOOR * size.x * size.z;
    above > least || (below > least && !mesh.is_closed())
}

/// The lengths that everything else follows from, rounded to short numbers.
struct Stage {
    bounds: Aabb,
    radius: f64,
    center: DVec3,
    floor_y: f64,
    has_floor: bool,
    light: DVec3,
}

impl Stage {
    fn new(bounds: &Aabb, floor: Floor) -> Self {
        let radius = camera_framing::working_radius(bounds);
        let flat = bounds.max.y - bounds.min.y < FLAT_RADII * radius;
        let floor_y = match floor {
            _ if flat => rounded(bounds.min.y - LIFT_RADII * radius, radius),
            Floor::Below => rounded(bounds.min.y - hair(bounds), 1e-2 * radius),
            Floor::Touching | Floor::Absent => lowest(bounds.min.y, radius),
        };
        let center = rounded_vector(bounds.center(), radius);
        let light = rounded_vector(center + TOWARD_LIGHT.normalize() * LIGHT_RADII * radius, radius);
        Self { bounds: *bounds, radius, center, floor_y, has_floor: floor != Floor::Absent, light }
    }

    /// Half the floor's side.
    fn floor_half(&self) -> f64 {
        rounded(FLOOR_RADII * self.radius, self.radius)
    }

    /// Shadows of the model's corners on the floor.
    fn shadow_corners(&self) -> [DVec3; 8] {
        self.bounds.corners().map(|corner| {
            let along = corner - self.light;
            self.light + along * ((self.floor_y - self.light.y) / along.y)
        })
    }

    fn camera(&self, aspect: f64) -> Entry {
        let mut points = self.bounds.corners().to_vec();
        if self.has_floor {
            points.extend(self.shadow_corners());
        }
        let fov_y_radians = camera_framing::FOV_Y_DEGREES.to_radians();
        let (eye, target) =
            camera_framing::fit(&points, camera_framing::THREE_QUARTER, fov_y_radians, aspect, self.radius);
        let (eye, target) = (rounded_vector(eye, self.radius), rounded_vector(target, self.radius));
        table(
            "camera",
            vec![("eye", vector(eye)), ("target", vector(target)), ("fov_y", number(camera_framing::FOV_Y_DEGREES))],
        )
    }

    fn light(&self) -> Entry {
        table(
            "light",
            vec![
                ("kind", text("spot")),
                ("position", vector(self.light)),
                ("target", vector(self.center)),
                ("cone", number(CONE_DEGREES)),
                ("shape", text("cone")),
                ("shadow", shadow()),
            ],
        )
    }

    fn floor(&self) -> Entry {
        let half = self.floor_half();
        let at = DVec3::new(self.center.x, self.floor_y, self.center.z);
        let material = vec![("diffuse", vector(DVec3::splat(0.7)))];
        table(
            "object",
            vec![
                ("name", text("floor")),
                ("mesh", text("quad")),
                ("translate", vector(at)),
                ("scale", vector(DVec3::new(half, 1.0, half))),
                ("material", table("object.material", material)),
            ],
        )
    }
}

/// Shadow settings of a supplied light.
pub(super) fn shadow() -> Entry {
    // GL_LINEAR reaches up to a texel away along each axis, where a plane is up to two slopes nearer.
    let offset = vec![("factor", number(2.0)), ("units", number(4.0))];
    let shadow = vec![
        ("technique", text("shadow-map")),
        ("size", entry(Value::Integer(1024))),
        ("format", text("depth24")),
        ("filter", text("linear")),
        ("offset", table("light.shadow.offset", offset)),
    ];
    table("light.shadow", shadow)
}

fn image() -> Entry {
    let size = DEFAULT_SIZE.map(|side| entry(Value::Integer(i64::from(side)))).to_vec();
    let background = DEFAULT_BACKGROUND.map(|channel| number(shortest(f64::from(channel)))).to_vec();
    table("image", vec![("size", array(size)), ("background", array(background))])
}

/// `value` in steps of about a thousandth of `size`, as short a decimal as that allows.
fn rounded(value: f64, size: f64) -> f64 {
    let decimals = 3 - size.log10().floor() as i32;
    let written = if decimals > 0 {
        format!("{value:.*}", decimals.unsigned_abs() as usize)
    } else {
        let step = 10.0_f64.powi(-decimals);
        format!("{}", (value / step).round() * step)
    };
    // Adding zero turns -0 to 0.
    written.parse().unwrap_or(value) + 0.0
}

fn rounded_vector(vector: DVec3, size: f64) -> DVec3 {
    DVec3::from_array(vector.to_array().map(|value| rounded(value, size)))
}

/// The height of a floor under what ends at `value`: a short decimal that is the same f32, or as good as the same.
fn lowest(value: f64, radius: f64) -> f64 {
    if f64::from(value as f32) == value { shortest(value) } else { rounded(value, 1e-5 * radius) }
}

/// The shortest decimal that is the same f32.
fn shortest(value: f64) -> f64 {
    (value as f32).to_string().parse().unwrap_or(value) + 0.0
}

pub(super) fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}

pub(super) fn text(text: &str) -> Entry {
    entry(Value::String(text.to_owned()))
}

pub(super) fn number(value: f64) -> Entry {
    entry(Value::Float(value))
}

pub(super) fn vector(vector: DVec3) -> Entry {
    array(vector.to_array().map(number).to_vec())
}

pub(super) fn array(items: Vec<Entry>) -> Entry {
    entry(Value::Array(items))
}

pub(super) fn table(path: &str, entries: Vec<(&str, Entry)>) -> Entry {
    entry(Value::Table(settings(path, entries)))
}

fn root(entries: Vec<(&str, Entry)>) -> Settings {
    settings("", entries)
}

fn settings(path: &str, entries: Vec<(&str, Entry)>) -> Settings {
    let entries = entries.into_iter().map(|(key, entry)| (key.to_owned(), entry)).collect();
    Settings { path: path.to_owned(), origin: Origin::BuiltIn, entries }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::assets::Assets;
    use crate::scene::{Scene, resolve};

    /// The supplied scene, with a box in the place of the model that has the same bounds.
    fn scene(min: DVec3, max: DVec3, aspect: f64) -> Scene {
        let bounds = Aabb { min, max };
        let mut root = framing("box", &bounds, aspect, Floor::Touching);
        let half = (0.5 * (max - min)).max(DVec3::splat(1e-15));
        if let Some((_, Entry { value: Value::Array(objects), .. })) =
            root.entries.iter_mut().find(|(key, _)| key == "object")
            && let Value::Table(model) = &mut objects[0].value
        {
            model.set("translate", vector(bounds.center()));
            model.set("scale", vector(half));
        }
        let scene = resolve::scene(&root, &mut Assets::default(), &crate::techniques::Techniques)
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.lights.len(), 1);
        scene
    }

    #[test]
    fn model_and_shadow_are_in_view_and_in_the_light() {
        let shapes =
            [[1.0, 1.0, 1.0], [0.1, 1.0, 0.1], [1.0, 0.1, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 0.0]];
        for place in [DVec3::ZERO, DVec3::new(1e4, -1e4, 1e4)] {
            for size in [1e-3, 1.0, 37.0, 1e3, 1e9] {
                for (shape, aspect) in shapes.into_iter().flat_map(|shape| [(shape, 1.0), (shape, 2.5), (shape, 0.4)]) {
                    let extent = DVec3::from_array(shape) * size;
                    check_view(place, place + extent, aspect);
                }
            }
        }
    }

    fn check_view(min: DVec3, max: DVec3, aspect: f64) {
        let scene = scene(min, max, aspect);
        let (light, camera) = (scene.lights[0].frustum().unwrap(), &scene.camera);
        let what = format!("{min} to {max}, aspect {aspect}: {camera:?}");
        let radius = camera_framing::working_radius(&Aabb { min, max });
        let floor = scene.objects[1].world_bounds().min.y;
        let mut spread = Aabb::EMPTY;
        let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
        let light_from_world = light.clip_from_world();
        for corner in (Aabb { min, max }).corners() {
            let along = corner - light.position;
            let shadow = light.position + along * ((floor - light.position.y) / along.y);
            for point in [corner, shadow] {
                let seen = clip_from_world.project_point3(point);
                assert!(seen.abs().max_element() < 1.0, "{what}: {point} is seen at {seen}");
                let lit = light_from_world.project_point3(point);
                assert!(lit.truncate().length() < 1.0 && lit.z.abs() < 1.0, "{what}: {point} is lit at {lit}");
                spread = spread.including(seen);
            }
        }
        let extent = (spread.max - spread.min).truncate();
        assert!(extent.max_element() > 1.5, "{what}: fills only {extent}");
        assert!(floor <= min.y + 1e-3 * radius, "{what}: floor at {floor}");
    }

    #[test]
    fn the_planes_hold_the_floor_that_is_seen() {
        let scene = scene(DVec3::splat(-1.0), DVec3::ONE, 1.0);
        let floor = scene.objects[1].world_bounds();
        let light = scene.lights[0].frustum().unwrap();
        for (clip_from_world, from) in [
            (scene.camera.clip_from_view(1.0) * scene.camera.view_from_world(), scene.camera.eye),
            (light.clip_from_world(), light.position),
        ] {
            let world_from_clip = clip_from_world.inverse();
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (0.0, -1.0), (0.0, 0.0)] {
                let ray = world_from_clip.project_point3(DVec3::new(x, y, 1.0)) - from;
                let hit = from + ray * ((floor.min.y - from.y) / ray.y);
                let depth = clip_from_world.project_point3(hit).z;
                assert!(depth.abs() < 1.0, "({x}, {y}) from {from} meets the floor at {hit}, depth {depth}");
            }
        }
    }

    #[test]
    fn numbers_are_short() {
        let bounds = Aabb { min: DVec3::new(-0.3, f64::from(0.1_f32), -0.4), max: DVec3::new(0.7, 1.9, 0.6) };
        let toml = framing("a \"b\".obj", &bounds, 1.0, Floor::Touching).to_toml();
        assert!(toml.contains("translate = [0.2, 0.1, 0.1]"), "{toml}");
        assert!(toml.contains(r#"mesh = "a \"b\".obj""#), "{toml}");
        let long = |word: &&str| {
            word.trim_matches(['[', ']', ',']).len() > 7 && word.contains('.') && !word.contains(['"', 'l'])
        };
        assert_eq!(toml.split_whitespace().find(long), None, "{toml}");
        for (value, size, expected) in [(1234.5678, 900.0, 1234.6), (-0.00012, 1.0, 0.0), (1.23456e-4, 1e-3, 1.23e-4)] {
            assert_eq!(rounded(value, size), expected);
        }
    }
}
