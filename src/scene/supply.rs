//! The scene that is supplied for a bare OBJ file: a floor, a spotlight and a camera framed on the model. It is built
//! as [`Settings`], so that overrides reach it and it can be printed.

use glam::DVec3;

use super::Camera;
use super::frame;
use super::resolve::{DEFAULT_BACKGROUND, DEFAULT_SIZE};
use super::settings::{Entry, Origin, Settings, Value};
use crate::math::Aabb;

/// From the model to the light: from the left, above. Across the camera's view, so that the shadow falls beside the
/// model and not behind it.
const TOWARD_LIGHT: DVec3 = DVec3::new(-0.62, 1.05, 0.36);

/// The light's distance from the model's middle, in radii; its cone; half the floor's side, in radii.
const LIGHT_RADII: f64 = 4.0;
const CONE_DEGREES: f64 = 50.0;
const FLOOR_RADII: f64 = 4.0;

/// A model lower than this, in radii, is held above the floor by [`LIFT_RADII`]: lying on it, it would have no shadow.
const FLAT_RADII: f64 = 0.01;
const LIFT_RADII: f64 = 0.25;

/// The scene around a model named `mesh` that fills `bounds`; `aspect` is the picture's width over its height.
///
/// y is up: it is not guessed.
pub fn framing(mesh: &str, bounds: &Aabb, aspect: f64) -> Settings {
    let bounds = if bounds.is_empty() { Aabb { min: DVec3::ZERO, max: DVec3::ZERO } } else { *bounds };
    let stage = Stage::new(&bounds);
    root(vec![
        ("image", image()),
        ("camera", stage.camera(aspect)),
        ("light", array(vec![stage.light()])),
        ("object", array(vec![table("object", vec![("mesh", text(mesh))]), stage.floor()])),
    ])
}

/// The lengths that everything else follows from, rounded to what a person would write.
struct Stage {
    bounds: Aabb,
    radius: f64,
    center: DVec3,
    floor_y: f64,
    light: DVec3,
}

impl Stage {
    fn new(bounds: &Aabb) -> Self {
        let radius = frame::working_radius(bounds);
        let flat = bounds.max.y - bounds.min.y < FLAT_RADII * radius;
        let lowest = if flat { rounded(bounds.min.y - LIFT_RADII * radius, radius) } else { shortest(bounds.min.y) };
        let center = rounded_vector(bounds.center(), radius);
        let light = rounded_vector(center + TOWARD_LIGHT.normalize() * LIGHT_RADII * radius, radius);
        Self { bounds: *bounds, radius, center, floor_y: lowest, light }
    }

    /// Half the floor's side.
    fn floor_half(&self) -> f64 {
        rounded(FLOOR_RADII * self.radius, self.radius)
    }

    fn floor_corners(&self) -> [DVec3; 4] {
        let half = self.floor_half();
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, z]| DVec3::new(self.center.x + half * x, self.floor_y, self.center.z + half * z))
    }

    /// Where the light throws the model's corners on the floor.
    fn shadow_corners(&self) -> [DVec3; 8] {
        self.bounds.corners().map(|corner| {
            let along = corner - self.light;
            self.light + along * ((self.floor_y - self.light.y) / along.y)
        })
    }

    fn camera(&self, aspect: f64) -> Entry {
        let mut points = self.bounds.corners().to_vec();
        points.extend(self.shadow_corners());
        let fov_y_radians = frame::FOV_Y_DEGREES.to_radians();
        let (eye, target) = frame::fit(&points, frame::THREE_QUARTER, fov_y_radians, aspect, self.radius);
        let (eye, target) = (rounded_vector(eye, self.radius), rounded_vector(target, self.radius));
        let camera = Camera { eye, target, up: DVec3::Y, fov_y_radians, near: 0.0, far: 0.0 };
        let [near, _] = frame::depth_range(&points, &camera, self.radius);
        points.extend(self.floor_corners());
        let [_, far] = frame::depth_range(&points, &camera, self.radius);
        // Half the model's least depth leaves the floor that the picture's lower edge shows.
        table(
            "camera",
            vec![
                ("eye", vector(eye)),
                ("target", vector(target)),
                ("fov_y", number(frame::FOV_Y_DEGREES)),
                ("near", number(rounded(0.5 * near, 0.1 * near))),
                ("far", number(rounded(far, self.radius))),
            ],
        )
    }

    fn light(&self) -> Entry {
        let [near, far] = self.light_range();
        let offset = vec![("factor", number(1.1)), ("units", number(4.0))];
        let shadow = vec![
            ("technique", text("shadow-map")),
            ("size", entry(Value::Integer(1024))),
            ("format", text("depth24")),
            ("filter", text("linear")),
            ("offset", table("light.shadow.offset", offset)),
        ];
        table(
            "light",
            vec![
                ("kind", text("spot")),
                ("position", vector(self.light)),
                ("target", vector(self.center)),
                ("cone", number(CONE_DEGREES)),
                ("near", number(near)),
                ("far", number(far)),
                ("shape", text("cone")),
                ("shadow", table("light.shadow", shadow)),
            ],
        )
    }

    /// From just before the model to just behind the farthest floor that the frustum shows.
    fn light_range(&self) -> [f64; 2] {
        let forward = (self.center - self.light).normalize();
        let depths = self.bounds.corners().map(|corner| forward.dot(corner - self.light));
        let height = self.light.y - self.floor_y;
        let (down, across) = (-forward.y, forward.y.mul_add(-forward.y, 1.0).sqrt());
        let tan = (0.5 * CONE_DEGREES).to_radians().tan();
        let near = depths.into_iter().fold(height / (down + tan * across), f64::min);
        let far = depths.into_iter().fold(height / (down - tan * across), f64::max);
        [rounded(0.95 * near, self.radius), rounded(1.05 * far, self.radius)]
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

/// The shortest decimal that is the same f32.
fn shortest(value: f64) -> f64 {
    (value as f32).to_string().parse().unwrap_or(value) + 0.0
}

fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}

fn text(text: &str) -> Entry {
    entry(Value::String(text.to_owned()))
}

fn number(value: f64) -> Entry {
    entry(Value::Float(value))
}

fn vector(vector: DVec3) -> Entry {
    array(vector.to_array().map(number).to_vec())
}

fn array(items: Vec<Entry>) -> Entry {
    entry(Value::Array(items))
}

fn table(path: &str, entries: Vec<(&str, Entry)>) -> Entry {
    entry(Value::Table(settings(path, entries)))
}

fn root(entries: Vec<(&str, Entry)>) -> Settings {
    settings("", entries)
}

fn settings(path: &str, entries: Vec<(&str, Entry)>) -> Settings {
    let entries = entries.into_iter().map(|(key, entry)| (key.to_owned(), entry)).collect();
    Settings { path: path.to_owned(), origin: Origin::BuiltIn, entries }
}
