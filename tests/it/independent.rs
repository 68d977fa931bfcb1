//! A second ray caster, written from geometry alone: boxes are slabs, floors are planes, and no mesh, matrix or ray of the
//! library takes part. Random scenes of these are drawn by every technique with its default settings.
//!
//! `GLUMBRA_INDEPENDENT=N` draws N scenes of each kind of light; `GLUMBRA_INDEPENDENT_SEED=N` others.

use glam::DVec3;
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::plan::{Request, ViewRequest};
use glumbra::views::View;

use crate::support::random::Random;
use crate::support::scene_of;

const SIZE: [u32; 2] = [160, 120];

/// Greatest share of wrong pixels where a map says nothing: 1024 texels a side, 160 pixels a row.
const MOST_OF_MAPS: f64 = 0.015;

/// Greatest share of wrong pixels of a shadow volume: edges of volumes are snapped to 1/256 of a pixel, and shadows' edges
/// cross some thousand of the picture's pixels.
const MOST_OF_VOLUMES: f64 = 0.0015;

/// Share of spot and point scenes that may have more without a warning.
const MOST_SCENES: f64 = 0.05;

/// Directions closer than this to a surface's plane are on neither side of it (cosine).
const GRAZING: f64 = 1e-3;

struct Block {
    center: DVec3,
    half: DVec3,
    /// Local axes in world space, of unit length.
    axes: [DVec3; 3],
    rotation: (DVec3, f64),
}

impl Block {
    fn new(random: &mut Random) -> Self {
        let size = random.size(0.15, 0.9);
        let half = DVec3::from_array([(); 3].map(|()| size * random.size(0.4, 1.6)));
        let center = DVec3::new(random.within(-2.0, 2.0), random.within(-0.2, 2.0), random.within(-2.0, 2.0));
        let rotation = ((random.vector() + 1e-3).normalize(), random.within(0.0, 360.0));
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turned(axis, rotation.0, rotation.1.to_radians()));
        Self { center, half, axes, rotation }
    }

    /// Parameter and outward normal where a ray enters, or leaves if it starts inside.
    fn hit(&self, origin: DVec3, way: DVec3, least: f64) -> Option<(f64, DVec3)> {
        let (mut enter, mut leave) = ((f64::NEG_INFINITY, DVec3::ZERO), (f64::INFINITY, DVec3::ZERO));
        for (axis, half) in self.axes.iter().zip(self.half.to_array()) {
            let (at, along) = (axis.dot(origin - self.center), axis.dot(way));
            if along == 0.0 {
                if at.abs() > half {
                    return None;
                }
                continue;
            }
            let side = along.signum();
            let [first, last] = [(-side * half - at) / along, (side * half - at) / along];
            if first > enter.0 {
                enter = (first, -side * *axis);
            }
            if last < leave.0 {
                leave = (last, side * *axis);
            }
        }
        if enter.0 > leave.0 {
            return None;
        }
        [enter, leave].into_iter().find(|(t, _)| *t > least)
    }
}

/// A vector turned about an axis of unit length, counter-clockwise as seen against it.
fn turned(v: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}

enum Light {
    Spot { position: DVec3, target: DVec3, cone: f64 },
    Point(DVec3),
    Sun(DVec3),
}

struct World {
    eye: DVec3,
    target: DVec3,
    fov_y: f64,
    light: Light,
    blocks: Vec<Block>,
    /// Half width of the floor, at y = 0.
    floor: f64,
    floor_casts: bool,
}

/// Visible surface and light of a point: the surface (0 the floor), and whether the light reaches it.
#[derive(Clone, Copy, PartialEq)]
struct Shown {
    surface: usize,
    normal: DVec3,
    lit: bool,
}

impl World {
    fn new(random: &mut Random, kind: usize) -> Self {
        let around = random.within(0.0, std::f64::consts::TAU);
        let distance = random.within(3.0, 8.0);
        let eye = DVec3::new(distance * around.cos(), random.within(0.5, 5.0), distance * around.sin());
        let above = DVec3::new(random.within(-3.0, 3.0), random.within(2.5, 5.0), random.within(-3.0, 3.0));
        let light = match kind {
            0 => Light::Spot { position: above, target: 0.3 * random.vector(), cone: random.within(25.0, 100.0) },
            1 => Light::Point(above),
            _ => Light::Sun(DVec3::new(random.within(-1.0, 1.0), -random.within(0.1, 1.5), random.within(-1.0, 1.0))),
        };
        Self {
            eye,
            target: DVec3::new(0.0, 0.5, 0.0),
            fov_y: random.within(30.0, 70.0),
            light,
            blocks: (0..1 + random.below(7)).map(|_| Block::new(random)).collect(),
            floor: random.size(3.0, 30.0),
            floor_casts: random.below(2) == 0,
        }
    }

    fn to_toml(&self, shadow: &str) -> String {
        let list = |v: DVec3| format!("{:?}", v.to_array());
        let light = match &self.light {
            Light::Spot { position, target, cone } => format!(
                "kind = \"spot\"\nposition = {}\ntarget = {}\ncone = {cone:?}\n",
                list(*position),
                list(*target)
            ),
            Light::Point(position) => format!("kind = \"point\"\nposition = {}\n", list(*position)),
            Light::Sun(direction) => format!("kind = \"directional\"\ndirection = {}\n", list(*direction)),
        };
        let mut text = format!(
            "[image]\nsize = {SIZE:?}\n[camera]\neye = {}\ntarget = {}\nfov_y = {:?}\n[[light]]\n{light}shadow = {{ {shadow} }}\n\
             [[object]]\nmesh = \"quad\"\nscale = [{:?}, 1.0, {:?}]\ncasts_shadow = {}\n",
            list(self.eye),
            list(self.target),
            self.fov_y,
            self.floor,
            self.floor,
            self.floor_casts
        );
        for block in &self.blocks {
            text += &format!(
                "[[object]]\nmesh = \"box\"\nscale = {}\ntranslate = {}\nrotate = {{ axis = {}, angle = {:?} }}\n",
                list(block.half),
                list(block.center),
                list(block.rotation.0),
                block.rotation.1
            );
        }
        text
    }

    /// Nearest surface, its number, outward normal and parameter.
    fn nearest(&self, origin: DVec3, way: DVec3) -> Option<(f64, usize, DVec3)> {
        let blocks = self.blocks.iter().zip(1..);
        let blocks = blocks.filter_map(|(block, number)| block.hit(origin, way, 0.0).map(|(t, n)| (t, number, n)));
        let floor = self.floor_hit(origin, way).map(|t| (t, 0, DVec3::Y));
        blocks.chain(floor).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn floor_hit(&self, origin: DVec3, way: DVec3) -> Option<f64> {
        let t = -origin.y / way.y;
        let at = origin + t * way;
        (t > 0.0 && t.is_finite() && at.x.abs() <= self.floor && at.z.abs() <= self.floor).then_some(t)
    }

    /// Way from a point to the light, and the parameter where the light is.
    fn to_light(&self, point: DVec3) -> (DVec3, f64) {
        match &self.light {
            Light::Spot { position, .. } | Light::Point(position) => (*position - point, 1.0),
            Light::Sun(direction) => (-*direction, f64::INFINITY),
        }
    }

    /// Tests whether a point lies well inside a spotlight's cone; others have no sides.
    fn is_inside(&self, point: DVec3) -> bool {
        let Light::Spot { position, target, cone } = &self.light else { return true };
        let angle = (*target - *position).angle_between(point - *position).to_degrees();
        angle < 0.48 * cone
    }

    /// The point seen through window position (x, y), in pixels from the upper left; `None`: nothing, or no light's.
    fn shown(&self, x: f64, y: f64) -> Option<Shown> {
        let ahead = (self.target - self.eye).normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        let up = right.cross(ahead);
        let [width, height] = SIZE.map(f64::from);
        let tan = (0.5 * self.fov_y).to_radians().tan();
        let way =
            ahead + right * (tan * width / height * (2.0 * x / width - 1.0)) + up * (tan * (1.0 - 2.0 * y / height));
        let (t, surface, normal) = self.nearest(self.eye, way)?;
        let normal = if normal.dot(way) > 0.0 { -normal } else { normal };
        let point = self.eye + t * way;
        let (to_light, end) = self.to_light(point);
        let faces = normal.dot(to_light.normalize()) > GRAZING;
        if !faces || !self.is_inside(point) {
            return None;
        }
        // A hair off the surface: a block does not shade the side that it is seen by.
        let start = point + 1e-9 * normal;
        let is_blocked = self.blocks.iter().any(|block| block.hit(start, to_light, 0.0).is_some_and(|(t, _)| t < end))
            || (self.floor_casts && surface != 0 && self.floor_hit(start, to_light).is_some_and(|t| t < end));
        Some(Shown { surface, normal, lit: !is_blocked })
    }

    /// Content of pixel (x, y), if everything within a hundredth of a pixel is the same.
    fn certain(&self, x: u32, y: u32) -> Option<Shown> {
        let [x, y] = [x, y].map(|at| f64::from(at) + 0.5);
        let middle = self.shown(x, y)?;
        let around = [(-0.01, 0.0), (0.01, 0.0), (0.0, -0.01), (0.0, 0.01)];
        around.iter().all(|(dx, dy)| self.shown(x + dx, y + dy) == Some(middle)).then_some(middle)
    }
}

/// Share of wrong pixels, and whether the plan warns; `None`: the scene is refused, or shows too little.
fn wrong(world: &World, shadow: &str, renderer: &mut Renderer) -> Option<(f64, bool)> {
    let scene = scene_of(&world.to_toml(shadow));
    let request = Request { views: vec![ViewRequest { view: View::Shade, light: 0 }], ..Request::default() };
    let plan = renderer.plan(&scene, &request).ok()?;
    let shade = draw_shade(&scene, 0, renderer).unwrap();
    let (mut compared, mut wrong) = (0_u32, 0_u32);
    for (index, shade) in shade.shade.iter().enumerate() {
        let index = u32::try_from(index).unwrap();
        let Some(shown) = world.certain(index % SIZE[0], index / SIZE[0]) else { continue };
        compared += 1;
        wrong += u32::from((*shade >= 0.5) != shown.lit);
    }
    (compared >= 1000).then(|| (f64::from(wrong) / f64::from(compared), !plan.warnings.is_empty()))
}

#[test]
fn a_second_ray_caster_finds_the_same_shadows() {
    let from_environment = |name| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    let count = from_environment("GLUMBRA_INDEPENDENT").unwrap_or(12);
    let seed = from_environment("GLUMBRA_INDEPENDENT_SEED").unwrap_or(7);
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut failures = Vec::new();
    for (kind, name) in ["spot", "point", "sun"].into_iter().enumerate() {
        for technique in ["shadow-map", "midpoint", "second-depth", "shadow-volume"] {
            // A cube has no second layer.
            if kind == 1 && ["midpoint", "second-depth"].contains(&technique) {
                continue;
            }
            let shadow = format!("technique = \"{technique}\"");
            let (mut worst, mut mean, mut beyond, mut drawn, mut warned) = (0.0_f64, 0.0, 0_u32, 0_u32, 0_u32);
            for number in 0..count {
                let mut random = Random::new(1000 * (seed + number) + kind as u64);
                let mut world = World::new(&mut random, kind);
                // Maps of far sides take closed casters alone.
                world.floor_casts &= technique != "second-depth";
                let Some((share, warns)) = wrong(&world, &shadow, &mut renderer) else { continue };
                let most = if technique == "shadow-volume" { MOST_OF_VOLUMES } else { MOST_OF_MAPS };
                (drawn, warned) = (drawn + 1, warned + u32::from(warns));
                mean += share;
                worst = worst.max(if warns { 0.0 } else { share });
                if share > most && !warns {
                    beyond += 1;
                    println!("{name} {number}, {technique}: {:.3} % wrong\n{}", 100.0 * share, world.to_toml(&shadow));
                }
            }
            let mean = 100.0 * mean / f64::from(drawn.max(1));
            println!(
                "{name:6} {technique:14} {drawn:4} drawn, {warned} warned, mean {mean:.4} %, worst unwarned {:.3} %, beyond {beyond}",
                100.0 * worst
            );
            let may_be_beyond =
                if kind == 2 || technique == "shadow-volume" { 0.0 } else { MOST_SCENES * f64::from(drawn) };
            if f64::from(beyond) > may_be_beyond || u64::from(drawn) * 2 < count {
                failures.push(format!("{name}, {technique}: {beyond} of {drawn} beyond, of {count}"));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
