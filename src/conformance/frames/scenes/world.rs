//! Cameras, objects and lights of small scenes, as text.

use std::f32::consts::TAU;

use crate::conformance::random::Random;

/// A number that a person would write.
fn short(value: f32) -> f32 {
    (value * 100.0).round() / 100.0
}

pub fn vector(list: [f32; 3]) -> String {
    let [x, y, z] = list.map(short);
    format!("[{x:?}, {y:?}, {z:?}]")
}

fn number(value: f32) -> String {
    format!("{:?}", short(value))
}

/// A place around the origin: so far away, and between these heights as a share of it.
pub fn around(dice: &mut Random, far: [f32; 2], heights: [f32; 2]) -> [f32; 3] {
    let (far, up, turn) = (dice.between(far[0], far[1]), dice.between(heights[0], heights[1]), dice.between(0.0, TAU));
    let flat = (1.0 - up * up).sqrt();
    [far * flat * turn.cos(), far * up, far * flat * turn.sin()]
}

pub fn color(dice: &mut Random, low: f32, high: f32) -> String {
    vector([0; 3].map(|_| dice.between(low, high)))
}

/// The picture and the camera.
pub fn view(dice: &mut Random) -> String {
    let [width, height] = dice.pick(&[[48, 36], [48, 36], [40, 40], [37, 45]]);
    let (eye, target) = (around(dice, [3.5, 5.5], [0.25, 0.8]), around(dice, [0.0, 0.5], [0.0, 0.9]));
    format!(
        "[image]\nsize = [{width}, {height}]\nbackground = {}\n\n[camera]\neye = {}\ntarget = {}\nfov_y = {}\nnear = {}\nfar = {}\n",
        color(dice, 0.0, 1.0),
        vector(eye),
        vector(target),
        number(dice.between(34.0, 55.0)),
        dice.pick(&["0.5", "0.5", "0.2", "1.0"]),
        dice.pick(&["30.0", "30.0", "12.0", "100.0"]),
    )
}

/// Decal, alpha, and planes of coordinates.
pub fn textures(dice: &mut Random) -> String {
    let mut keys = String::new();
    if dice.chance(0.35) {
        keys += dice.pick(&[", decal = \"tiles.png\"", ", decal = \"tiles.png\"", ", decal = \"leaves.png\""]);
    }
    if dice.chance(0.12) {
        keys += ", alpha = \"holes.png\"";
    }
    if keys.contains("holes") || keys.contains("leaves") {
        keys += dice.pick(&["", ", opacity = 0.8"]);
    }
    if !keys.is_empty() && dice.chance(0.4) {
        keys += ", texgen = { s = [0.6, 0.1, 0.3, 0.07], t = [0.0, 0.5, 0.7, 0.21], scale = 1.5 }";
    }
    keys
}

/// A photograph of a surface, taken from above. `more`: keys of it.
pub fn photograph(more: &str) -> String {
    let place = "eye = [0.8, 3.5, 2.0], target = [0.0, 0.0, 0.0], fov_y = 55.0, map = { size = 32 }";
    format!(", photo = {{ image = \"slide.png\", {place}, {more} }}")
}

/// Materials and keys that the objects of a frame share: each difference is a shader more, which a driver compiles for a while.
pub struct Style {
    /// Keys of the materials: decal, alpha, bumps.
    pub textures: String,
    pub is_specular: bool,
    /// Lines of things above the ground.
    pub lines: &'static str,
}

impl Style {
    /// `textures`: keys of the materials.
    pub fn new(dice: &mut Random, textures: String) -> Self {
        let wave =
            "wave = { direction = [0, 1, 0], amplitude = 0.25, axis = [1, 0, 0.25], wavelength = 1.2, phase = 0.1 }\n";
        let lines = match dice.below(12) {
            0 if !textures.contains("bump") => wave,
            1 if !textures.contains("bump") => "lit = false\n",
            2 => "casts_shadow = false\n",
            3..6 => "closed = true\n",
            _ => "",
        };
        Self { textures, is_specular: dice.chance(0.6), lines }
    }

    fn material(&self, dice: &mut Random) -> String {
        let is_bumpy = self.textures.contains("bump") && dice.chance(0.8);
        let shininess = if is_bumpy { "8.0" } else { dice.pick(&["1.0", "5.0", "8.0", "20.0", "33.5"]) };
        let specular = match self.is_specular {
            true => format!(", specular = {}, shininess = {shininess}", color(dice, 0.0, 0.6)),
            false => String::new(),
        };
        format!("material = {{ diffuse = {}{specular}{} }}\n", color(dice, 0.2, 1.0), self.textures)
    }
}

pub fn ground(dice: &mut Random, style: &Style) -> String {
    let material = style.material(dice);
    let side = dice.between(2.5, 6.0);
    format!(
        "\n[[object]]\nname = \"ground\"\nmesh = \"quad\"\nscale = [{}, 1.0, {}]\n{material}",
        number(side),
        number(side)
    )
}

/// Meshes that enclose a volume.
const CLOSED: [&str; 4] = ["box", "ring.obj", "ball.obj", "box"];

/// A thing above the ground.
pub fn thing(dice: &mut Random, is_closed: bool, style: &Style) -> String {
    let mesh = if is_closed || dice.chance(0.7) { dice.pick(&CLOSED) } else { dice.pick(&["sheet.obj", "quad"]) };
    let size = dice.between(0.35, 0.8);
    let scale = match dice.below(5) {
        0 => [size, size * 0.5, size * 1.3],
        1 => [-size, size, size],
        2 => [size * 1.2, -size * 0.7, size],
        _ => [size; 3],
    };
    let [x, _, z] = around(dice, [0.0, 1.3], [0.0, 0.2]);
    let place = vector([x, dice.between(0.6, 1.5), z]);
    let turn = match dice.chance(0.7) {
        true => format!(
            "rotate = {{ axis = {}, angle = {} }}\n",
            vector(around(dice, [1.0, 1.0], [0.1, 0.9])),
            number(dice.between(0.0, 360.0))
        ),
        false => String::new(),
    };
    let is_open = !CLOSED.contains(&mesh);
    let lines = if is_open && style.lines.contains("closed") { "" } else { style.lines };
    format!(
        "\n[[object]]\nmesh = \"{mesh}\"\ntranslate = {place}\nscale = {}\n{turn}{lines}{}",
        vector(scale),
        style.material(dice)
    )
}

/// A light of this kind, without a shadow. `more`: its other lines.
pub fn light(dice: &mut Random, kind: &str, more: &str) -> String {
    let mut text = format!("\n[[light]]\nkind = \"{kind}\"\n");
    let position = around(dice, [3.0, 5.0], [0.5, 0.95]);
    match kind {
        "directional" => {
            let way = around(dice, [1.0, 1.0], [0.5, 0.95]).map(|part| -part);
            text += &format!("direction = {}\n", vector(way));
        }
        "point" => {
            text +=
                &format!("position = {}\nnear = 0.5\nfar = {}\n", vector(position), dice.pick(&["14.0", "14.0", "4.5"]))
        }
        _ => {
            let target = around(dice, [0.0, 0.6], [0.0, 0.5]);
            let cone = number(dice.between(35.0, 75.0));
            let shape = dice.pick(&["cone", "frustum"]);
            text += &format!(
                "position = {}\ntarget = {}\ncone = {cone}\nnear = {}\nfar = {}\n",
                vector(position),
                vector(target),
                dice.pick(&["1.0", "1.0", "2.5"]),
                dice.pick(&["12.0", "4.5", "4.0", "5.0"])
            );
            if !more.contains("shape") {
                text += &format!("shape = \"{shape}\"\n");
            }
        }
    }
    if !more.contains("law = ") {
        text += &match dice.below(3) {
            0 => format!("color = {}\n", color(dice, 0.3, 1.2)),
            1 => format!("diffuse = {}\nspecular = {}\n", color(dice, 0.3, 1.0), color(dice, 0.0, 1.0)),
            _ => format!("color = {}\nambient = {}\n", color(dice, 0.3, 0.9), color(dice, 0.0, 0.2)),
        };
        if kind != "directional" && dice.chance(0.25) {
            text += "attenuation = [0.6, 0.1, 0.02]\n";
        }
    } else {
        text += &format!("color = {}\n", color(dice, 0.3, 0.8));
    }
    text + more
}
