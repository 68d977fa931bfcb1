//! Random scenes: the same number of the same seed is the same scene on every machine.

use std::fmt::Write;

use fastrand::Rng;

use super::case::{Case, CaseSource, files_named_in};

/// Pixels of a picture.
const SIZE: [u32; 2] = [160, 120];

/// Scene number `index` of `seed`.
pub fn case(seed: u64, index: u64) -> Case {
    // An odd multiplier spreads neighbouring numbers over all seeds of the generator.
    let mut dice = Dice(Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index));
    let toml = Draft::new(&mut dice).scene(&mut dice);
    Case {
        name: format!("random-{seed}-{index}"),
        files: files_named_in(&toml),
        toml,
        source: CaseSource::Random,
        why: String::from("a random scene"),
        set: Vec::new(),
        made: Vec::new(),
        rows: Vec::new(),
        shades: true,
        colors: false,
        sweep: None,
        refused: false,
        refusal: None,
    }
}

struct Dice(Rng);

impl Dice {
    /// Evenly in [low, high).
    fn number(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// Evenly in the logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.number(low.ln(), high.ln()).exp()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.0.f64() < share
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.0.usize(0..from.len())]
    }

    /// A unit vector whose height above the horizon is evenly in [low, high], in degrees.
    fn direction(&mut self, low: f64, high: f64) -> [f64; 3] {
        let (up, around) = (self.number(low, high).to_radians(), self.number(0.0, std::f64::consts::TAU));
        [up.cos() * around.cos(), up.sin(), up.cos() * around.sin()]
    }
}

/// Three decimals or, of small numbers, three digits: what a person would write.
fn short(value: f64) -> f64 {
    let decimals = if value.abs() >= 0.1 || value == 0.0 { 3 } else { 2 - value.abs().log10().floor() as i32 };
    format!("{value:.*}", decimals.clamp(0, 20) as usize).parse().unwrap_or(value)
}

/// Place and size of the scene.
struct Draft {
    size: f64,
    place: [f64; 3],
}

impl Draft {
    /// Most scenes stand around the origin and are some units wide; some are far away, huge or tiny.
    fn new(dice: &mut Dice) -> Self {
        let size = if dice.chance(0.1) { 10.0_f64.powi(dice.0.i32(-6..=6)) } else { 1.0 };
        let far = if dice.chance(0.08) { size * 10.0_f64.powi(dice.0.i32(1..=5)) } else { 0.0 };
        let way = dice.direction(-90.0, 90.0);
        Self { size, place: way.map(|part| (part * far).round()) }
    }

    fn point(&self, local: [f64; 3]) -> String {
        let at = [0, 1, 2].map(|k| self.place[k] + self.size * short(local[k]));
        format!("[{:?}, {:?}, {:?}]", at[0], at[1], at[2])
    }

    fn length(&self, local: f64) -> String {
        format!("{:?}", self.size * short(local))
    }

    fn scene(&self, dice: &mut Dice) -> String {
        let [width, height] = match dice.0.u32(0..40) {
            0 => [dice.0.u32(1..=3), dice.0.u32(1..=200)],
            1 => [dice.0.u32(1..=200), dice.0.u32(1..=3)],
            _ => SIZE,
        };
        let mut toml = format!("[image]\nsize = [{width}, {height}]\n");
        self.camera(dice, &mut toml);
        let lights = if dice.chance(0.6) { 1 } else { dice.0.u32(2..=4) };
        for _ in 0..lights {
            self.light(dice, &mut toml);
        }
        if dice.chance(0.75) {
            self.floor(dice, &mut toml);
        }
        let mut last = String::new();
        for _ in 0..dice.0.u32(1..=8) {
            // Some objects stand twice at one place.
            if last.is_empty() || !dice.chance(0.03) {
                last = self.object(dice);
            }
            toml.push_str(&last);
        }
        toml
    }

    fn camera(&self, dice: &mut Dice, toml: &mut String) {
        let [distance, low, high] = match dice.0.u32(0..20) {
            0 => [dice.number(3.0, 9.0), -60.0, -2.0],
            1 | 2 => [dice.number(0.3, 2.0), 5.0, 80.0],
            3 => [dice.number(20.0, 200.0), 5.0, 80.0],
            _ => [dice.number(4.0, 10.0), 8.0, 75.0],
        };
        let eye = dice.direction(low, high).map(|part| part * distance);
        let target = [dice.number(-0.8, 0.8), dice.number(0.0, 0.8), dice.number(-0.8, 0.8)];
        let fov = if dice.chance(0.05) { dice.number(5.0, 140.0) } else { dice.number(25.0, 75.0) };
        let _ = write!(
            toml,
            "\n[camera]\neye = {}\ntarget = {}\nfov_y = {:?}\n",
            self.point(eye),
            self.point(target),
            short(fov)
        );
    }

    fn light(&self, dice: &mut Dice, toml: &mut String) {
        toml.push_str("\n[[light]]\n");
        match dice.0.u32(0..5) {
            0 | 1 => self.spot(dice, toml),
            2 | 3 => {
                let up = if dice.chance(0.2) { dice.number(1.0, 15.0) } else { dice.number(15.0, 90.0) };
                let to_light = dice.direction(up, up);
                let way = to_light.map(|part| -short(part));
                let _ = writeln!(toml, "kind = \"directional\"\ndirection = {way:?}");
            }
            _ => {
                let position = self.lamp(dice, 1.5, 6.0);
                let _ = writeln!(toml, "kind = \"point\"\nposition = {}", self.point(position));
            }
        }
    }

    /// Place of a lamp: above, or (sometimes) among the objects.
    fn lamp(&self, dice: &mut Dice, near: f64, far: f64) -> [f64; 3] {
        let distance = if dice.chance(0.12) { dice.number(0.2, 1.5) } else { dice.number(near, far) };
        dice.direction(10.0, 90.0).map(|part| part * distance)
    }

    fn spot(&self, dice: &mut Dice, toml: &mut String) {
        let position = self.lamp(dice, 3.0, 8.0);
        let target = [dice.number(-0.6, 0.6), dice.number(-0.2, 0.8), dice.number(-0.6, 0.6)];
        let cone = if dice.chance(0.1) { dice.number(1.5, 178.0) } else { dice.scale(15.0, 110.0) };
        let distance = position.iter().map(|part| part * part).sum::<f64>().sqrt();
        let near = if dice.chance(0.1) { dice.scale(1e-4, 0.05) } else { dice.number(0.05, 0.4) };
        let _ = writeln!(
            toml,
            "kind = \"spot\"\nposition = {}\ntarget = {}\ncone = {:?}\nnear = {}\nfar = {}\nshape = \"{}\"",
            self.point(position),
            self.point(target),
            short(cone),
            self.length(near * distance),
            self.length(dice.number(2.0, 12.0) * distance),
            dice.pick(&["cone", "frustum"])
        );
    }

    fn floor(&self, dice: &mut Dice, toml: &mut String) {
        let half = if dice.chance(0.12) { dice.scale(10.0, 1e4) } else { dice.number(2.5, 8.0) };
        let _ = write!(
            toml,
            "\n[[object]]\nname = \"floor\"\nmesh = \"quad\"\ntranslate = {}\nscale = [{}, 1.0, {}]\n",
            self.point([0.0; 3]),
            self.length(half),
            self.length(half)
        );
        if dice.chance(0.08) {
            let angle = dice.number(-25.0, 25.0);
            let _ = writeln!(toml, "rotate = {{ axis = [1.0, 0.0, 0.5], angle = {:?} }}", short(angle));
        }
        if dice.chance(0.1) {
            toml.push_str("casts_shadow = false\n");
        }
    }

    fn object(&self, dice: &mut Dice) -> String {
        let mesh = dice.pick(&MESHES);
        let size = dice.scale(0.15, 0.9);
        let mut scale = [size; 3];
        if dice.chance(0.4) {
            scale = scale.map(|side| side * dice.scale(0.4, 2.0));
        }
        if dice.chance(0.08) {
            scale[dice.0.usize(0..3)] *= 0.02;
        }
        let scale = scale.map(short);
        let is_turned = dice.chance(0.6);
        // Boxes reach as far down as up: exactly on the floor, next to it, or anywhere.
        let height = match dice.0.u32(0..10) {
            0..=3 => scale[1],
            4 => scale[1] + dice.pick(&[-1e-3, 1e-3, -1e-5, 1e-5, -0.1]),
            _ => dice.number(0.2, 2.2),
        };
        let mirrors = dice.chance(0.1);
        let sides = [if mirrors { -scale[0] } else { scale[0] }, scale[1], scale[2]];
        let mut toml = format!(
            "\n[[object]]\nmesh = \"{mesh}\"\ntranslate = {}\nscale = [{}, {}, {}]\n",
            self.point([dice.number(-2.2, 2.2), height, dice.number(-2.2, 2.2)]),
            self.length(sides[0]),
            self.length(sides[1]),
            self.length(sides[2])
        );
        if is_turned {
            let axis = if dice.chance(0.4) { [0.0, 1.0, 0.0] } else { dice.direction(-90.0, 90.0).map(short) };
            let _ = writeln!(toml, "rotate = {{ axis = {axis:?}, angle = {:?} }}", short(dice.number(0.0, 360.0)));
        }
        if mesh == "quad" && dice.chance(0.25) {
            toml.push_str("material = { alpha = \"fence.png\" }\n");
        } else if dice.chance(0.06) {
            let _ = writeln!(
                toml,
                "wave = {{ direction = [0.0, 1.0, 0.0], axis = [1.0, 0.0, 0.3], amplitude = {:?}, wavelength = {:?}, phase = {:?} }}",
                short(dice.number(0.05, 0.4)),
                short(dice.number(0.5, 3.0)),
                short(dice.number(0.0, 1.0))
            );
        }
        if dice.chance(0.05) {
            toml.push_str("casts_shadow = false\n");
        }
        toml
    }
}

/// A mesh as often as it is listed.
const MESHES: [&str; 27] = [
    "box",
    "box",
    "box",
    "box",
    "box",
    "sphere",
    "sphere",
    "sphere",
    "torus",
    "torus",
    "torus",
    "teapot",
    "quad",
    "quad",
    "quad",
    "open_box.obj",
    "inward_box.obj",
    "doubled_box.obj",
    "mixed_box.obj",
    "flat_box.obj",
    "both_sides.obj",
    "fins.obj",
    "t_junction.obj",
    "moebius.obj",
    "slivers.obj",
    "soup.obj",
    "tetrahedron.obj",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_number_is_the_same_scene_and_another_is_another() {
        assert_eq!(case(1, 5), case(1, 5));
        assert_ne!(case(1, 5).toml, case(1, 6).toml);
        assert_ne!(case(1, 5).toml, case(2, 5).toml);
    }

    #[test]
    fn every_scene_loads() {
        let folder = tempfile::tempdir().unwrap();
        for index in 0..300 {
            let case = case(3, index);
            case.load(folder.path()).unwrap_or_else(|error| panic!("{error}\n{}", case.toml));
        }
    }

    #[test]
    fn numbers_are_short() {
        for (value, expected) in [(1.23456, 1.235), (0.0123456, 0.0123), (-0.5, -0.5), (0.0, 0.0), (123.4567, 123.457)]
        {
            assert_eq!(short(value), expected);
        }
    }
}
