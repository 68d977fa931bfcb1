//! Random scenes in projected light: images, beams and laws of distance; slide projectors; shadows in destination alpha;
//! lenses; dusty air; photographs and bumps on objects. A scene is a random one whose spotlights have more keys; some
//! of them stand at the eye, behind it, towards it, across the view or in the floor.
//! `colors.rs` judges them.

use fastrand::Rng;
use glam::DVec3;

use super::bumps::{HILLS, with_bumps};
use super::case::{Case, files_named_in, vector};
use super::photos::with_photos;
use super::pictures::{hills, noise};
use super::random;

/// Kind of a scene, by its number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Beams,
    Slides,
    AlphaShadows,
    Lenses,
    Dust,
    /// Slide projectors, of which some have lenses and some dust.
    Mixed,
}

const KINDS: [Kind; 6] = [Kind::Beams, Kind::Slides, Kind::AlphaShadows, Kind::Lenses, Kind::Dust, Kind::Mixed];

/// Most lights of a scene of alpha shadows, and of projectors.
const MOST_LIGHTS: usize = 8;
const MOST_PROJECTORS: usize = 16;

/// Scene number `index` of `seed`: the random scene of these numbers, with more keys for its lights.
pub fn case(seed: u64, index: u64) -> Case {
    let plain = random::case(seed, index);
    let rng = Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index ^ 0x6c69_6768_7400);
    let kind = KINDS[(index % KINDS.len() as u64) as usize];
    let mut draft = Draft { rng, kind, eye: DVec3::ZERO, target: DVec3::NEG_Z };
    let (toml, hill_sizes) = with_bumps(seed, index, &with_photos(seed, index, &draft.scene(&plain.toml)));
    let size = [[64, 48], [64, 48], [1, 1], [1, 37], [200, 3]][draft.rng.usize(0..5)];
    let mut made = vec![(String::from("noise.png"), noise(size, draft.rng.u64(..)))];
    for (deep, (name, size)) in HILLS.into_iter().zip(hill_sizes).enumerate().filter(|_| toml.contains("bump = {")) {
        made.push((name.to_owned(), hills(size, deep == 1, index)));
    }
    let (name, why) = (format!("projected-{seed}-{index}"), format!("a random scene in projected light: {kind:?}"));
    // The shades of the other kinds are those of these.
    let shades = kind == Kind::Beams;
    Case { name, why, files: files_named_in(&toml), toml, made, shades, colors: true, ..plain }
}

struct Draft {
    rng: Rng,
    kind: Kind,
    eye: DVec3,
    target: DVec3,
}

impl Draft {
    fn chance(&mut self, share: f64) -> bool {
        self.rng.f64() < share
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.rng.usize(0..from.len())]
    }

    /// Evenly in the logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + (high / low).ln() * self.rng.f64()).exp()
    }

    fn scene(&mut self, plain: &str) -> String {
        let mut lights = Vec::new();
        let (mut head, mut rest) = (String::new(), String::new());
        for block in blocks(plain) {
            match block.lines().next() {
                Some("[[light]]") => lights.push(block),
                Some("[[object]]") => rest.push_str(&block),
                _ => head.push_str(&block),
            }
        }
        if let Some(eye) = vector(&head, "eye") {
            self.eye = eye;
        }
        if let Some(target) = vector(&head, "target") {
            self.target = target;
        }
        if matches!(self.kind, Kind::Lenses | Kind::Mixed) {
            head = head.replace("size = [160, 120]", "size = [80, 60]");
        }
        head.push_str(&self.shading());
        let lights = self.lights(lights);
        let count = lights.len();
        for light in lights {
            head.push_str(&self.light(&light, count));
        }
        head + &rest
    }

    fn shading(&mut self) -> String {
        let passes = match self.kind {
            Kind::Slides | Kind::Mixed => "slide",
            Kind::AlphaShadows => "shadow",
            _ => return String::new(),
        };
        let background = if passes == "slide" { self.pick(&["scene", "ambient"]) } else { "scene" };
        let ambient = self.pick(&[0.0, 0.1, 0.1, 0.9]);
        format!(
            "\n[shading]\npasses = \"{passes}\"\nbackground = \"{background}\"\nambient = [{ambient:?}, 0.1, 0.05]\n"
        )
    }

    /// The lights of the scene: at least one spotlight, and only those where nothing else goes; some scenes have very many.
    fn lights(&mut self, mut lights: Vec<String>) -> Vec<String> {
        let is_spot = |light: &String| light.contains("\"spot\"");
        if matches!(self.kind, Kind::Slides | Kind::Mixed) {
            lights.retain(is_spot);
        }
        if !lights.iter().any(is_spot) {
            lights.push(self.spot());
        }
        let has_many = self.chance(0.2);
        let most = match self.kind {
            Kind::Slides if has_many => MOST_PROJECTORS,
            Kind::AlphaShadows if has_many => MOST_LIGHTS,
            _ => lights.len(),
        };
        let first = lights.len();
        for number in first..most {
            let again = lights[number % first].clone();
            let cone = format!(
                "cone = {:.1}\nup = [{:.2}, 0.3, {:.2}]",
                self.scale(5.0, 150.0),
                self.rng.f64(),
                self.rng.f64()
            );
            let changed =
                again.lines().map(|line| if line.starts_with("cone") { cone.clone() } else { line.to_owned() });
            lights.push(changed.collect::<Vec<_>>().join("\n") + "\n");
        }
        lights
    }

    /// A spotlight above what the camera looks at, about as far from it as the camera.
    fn spot(&mut self) -> String {
        let distance = self.eye.distance(self.target);
        let way = DVec3::new(self.rng.f64() - 0.5, 1.0, self.rng.f64() - 0.5).normalize();
        let position = self.target + way * distance;
        format!(
            "[[light]]\nkind = \"spot\"\nposition = {:?}\ntarget = {:?}\ncone = {:.1}\nnear = {:?}\nfar = {:?}\nshape = \"{}\"\n",
            position.to_array(),
            self.target.to_array(),
            self.scale(10.0, 120.0),
            0.1 * distance,
            3.0 * distance,
            self.pick(&["cone", "frustum"])
        )
    }

    fn light(&mut self, plain: &str, count: usize) -> String {
        let mut text = String::new();
        let number = |key: &str| plain.lines().find_map(|line| line.strip_prefix(key)?.parse::<f64>().ok());
        let planes = [number("near = ").unwrap_or(1.0), number("far = ").unwrap_or(10.0)];
        let is_spot = plain.contains("\"spot\"");
        let place = if is_spot { self.place(plain) } else { None };
        for line in plain.lines() {
            match (&place, line) {
                (Some([position, _]), line) if line.starts_with("position = ") => text.push_str(position),
                (Some([_, target]), line) if line.starts_with("target = ") => text.push_str(target),
                (_, line) => text.push_str(line),
            }
            text.push('\n');
        }
        if count > 3 {
            let color = 1.5 / count as f64;
            text.push_str(&format!("color = [{color:?}, {:?}, {color:?}]\n", 0.5 * color));
        }
        if is_spot {
            self.add_keys(planes, text.contains("\"frustum\""), &mut text);
        }
        if self.kind == Kind::AlphaShadows {
            let shadow =
                self.pick(&["", ", kernel = \"3x3\"", ", filter = \"nearest\"", ", size = 512, dimming = 0.3"]);
            text.push_str(&format!("shadow = {{ technique = \"shadow-map\"{shadow} }}\n"));
        }
        text
    }

    /// Hard places of a spotlight, as lines of its position and target: at the eye, behind it, towards it, across the view, in
    /// the floor.
    fn place(&mut self, plain: &str) -> Option<[String; 2]> {
        let [position, target] = [vector(plain, "position")?, vector(plain, "target")?];
        let ahead = self.target - self.eye;
        let aside = ahead.cross(DVec3::new(0.3, 1.0, 0.2)).normalize_or(DVec3::X) * ahead.length();
        let [position, target] = match self.rng.usize(0..14) {
            0 => [self.eye, self.target],
            1 => [self.eye - 0.4 * ahead, self.target],
            2 => [self.target, self.eye],
            3 => [self.target + aside, self.target],
            4 => [DVec3::new(position.x, self.target.y, position.z), self.target],
            _ => [position, target],
        };
        let line = |key: &str, at: DVec3| format!("{key} = {:?}", at.to_array());
        Some([line("position", position), line("target", target)])
    }

    fn add_keys(&mut self, planes: [f64; 2], is_frustum: bool, toml: &mut String) {
        let [has_aspect, has_image, has_beam, has_falloff, divides] =
            [0.5, 0.6, 0.4, 0.4, 0.3].map(|share| self.chance(share));
        if has_aspect && is_frustum {
            toml.push_str(&format!("aspect = {:?}\n", self.pick(&[0.2, 0.5, 1.5, 4.0, 1e-3, 50.0])));
        }
        if has_image {
            let filter = self.pick(&["nearest", "linear", "trilinear"]);
            let image = self.pick(&["floor.png", "noise.png"]);
            toml.push_str(&format!("image = \"{image}\"\nfilter = \"{filter}\"\n"));
        }
        if has_beam {
            toml.push_str(&self.beam());
        }
        if has_falloff {
            toml.push_str(&self.falloff(planes));
        }
        if divides {
            toml.push_str("interpolate = \"segal\"\n");
        }
        let is_slide = matches!(self.kind, Kind::Slides | Kind::Mixed);
        if is_slide {
            toml.push_str("law = \"slide\"\n");
        }
        let distance = (planes[0] * planes[1]).sqrt();
        let has_lens = self.chance(0.5);
        match self.kind {
            Kind::Lenses => toml.push_str(&self.focus(distance)),
            Kind::Dust => toml.push_str(&self.dust(distance)),
            Kind::Mixed if has_lens => toml.push_str(&self.focus(distance)),
            Kind::Mixed => toml.push_str(&self.dust(distance)),
            Kind::Beams | Kind::Slides | Kind::AlphaShadows => {}
        }
    }

    fn beam(&mut self) -> String {
        let profile = match self.rng.usize(0..3) {
            0 => format!("exponent = {:?}", self.pick(&[0.5, 2.0, 10.0, 60.0])),
            1 => format!("profile = [1.0, {:.2}, {:.2}, 0.0]", self.rng.f64(), self.rng.f64()),
            _ => String::from("shield = \"barn-doors.png\""),
        };
        let lens = if self.chance(0.3) { format!(", lens = {:.2}", self.rng.f64() - 0.5) } else { String::new() };
        format!("beam = {{ {profile}{lens} }}\n")
    }

    fn falloff(&mut self, [near, far]: [f64; 2]) -> String {
        let full = (near * far).sqrt() * (0.3 + 3.0 * self.rng.f64());
        match self.rng.usize(0..3) {
            0 => format!("falloff = {{ by = \"z\", law = \"inverse\", d0 = {full:e} }}\n"),
            1 => format!("falloff = {{ by = \"z\", law = \"inverse-square\", d0 = {full:e} }}\n"),
            _ => format!(
                "falloff = {{ by = \"z\", table = [[{:e}, 1.0], [{:e}, 0.5], [{:e}, 0.1]] }}\n",
                0.1 * far,
                0.3 * far,
                0.9 * far
            ),
        }
    }

    /// A lens for a scene of about this size; some are next to nothing, larger than the focal distance, or sharp nowhere.
    fn focus(&mut self, size: f64) -> String {
        let distance = size * self.pick(&[0.05, 0.5, 1.0, 1.0, 2.0, 1e8]);
        let radius = size * self.pick(&[1e-7, 0.01, 0.05, 0.05, 0.3, 3.0]);
        let samples = self.pick(&[1, 2, 3, 8, 16]);
        format!("focus = {{ distance = {distance:e}, radius = {radius:e}, samples = {samples} }}\n")
    }

    /// Dust from none to a wall.
    fn dust(&mut self, size: f64) -> String {
        let density = self.pick(&[0.0, 1e-3, 0.1, 0.3, 1.0, 1e4]) / size;
        let slices = self.pick(&[1, 8, 32, 64, 200]);
        let blend = self.pick(&["blend = \"over\"", "blend = \"over\", extinct = \"all\"", "blend = \"add\""]);
        let thickness = self.pick(&["ray", "ray", "ray", "axis"]);
        format!("dust = {{ density = {density:e}, slices = {slices}, {blend}, thickness = \"{thickness}\" }}\n")
    }
}

/// A scene file's tables, each with its header.
fn blocks(toml: &str) -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    for line in toml.lines().filter(|line| !line.is_empty()) {
        if line.starts_with('[') || blocks.is_empty() {
            blocks.push(String::new());
        }
        if let Some(last) = blocks.last_mut() {
            last.push_str(line);
            last.push('\n');
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_loads_and_most_have_projected_light() {
        let folder = tempfile::tempdir().unwrap();
        let mut projected = [0; 6];
        for index in 0..240 {
            let case = case(3, index);
            let loaded = case.load(folder.path()).unwrap_or_else(|error| panic!("{error}\n{}", case.toml));
            let is_projected = crate::judge::colors::has_projected_light(&loaded.scene);
            projected[(index % 6) as usize] += usize::from(is_projected);
        }
        // Of 40 each; beams, and lights with alpha shadows, may be plain.
        assert!(projected.iter().all(|count| *count > 20), "{projected:?}");
    }

    #[test]
    fn scenes_are_split_into_their_tables() {
        let parts = blocks("[image]\nsize = [1, 2]\n\n[[light]]\nkind = \"spot\"\n[[light]]\n");
        assert_eq!(parts, ["[image]\nsize = [1, 2]\n", "[[light]]\nkind = \"spot\"\n", "[[light]]\n"]);
        assert_eq!(vector("eye = [1.0, -2.5, 3e2]\n", "eye"), Some(DVec3::new(1.0, -2.5, 300.0)));
    }
}
