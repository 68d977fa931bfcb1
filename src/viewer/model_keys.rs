//! Pictures of a key-framed model, and the keys of its window: one table for the window and for the help.

use crate::views::View;

/// Pictures of the samples md2shader and md2bump [GDC, "md2shader"].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ModelMode {
    /// The lit scene.
    #[default]
    Scene,
    /// A view in its place.
    View(View),
}

/// A mode's name on the command line, the mode, and the key that leads to it.
type Row = (&'static str, ModelMode, char);

const MODES: &[Row] = &[
    ("scene", ModelMode::Scene, 'r'),
    ("normal-map", ModelMode::View(View::NormalMap), 'r'),
    ("decal", ModelMode::View(View::Decal), 'r'),
    ("gloss", ModelMode::View(View::Gloss), 'r'),
    ("normal", ModelMode::View(View::Normal), 't'),
    ("diffuse", ModelMode::View(View::Diffuse), 't'),
    ("specular", ModelMode::View(View::Specular), 't'),
    ("tangent-light", ModelMode::View(View::TangentLight), 't'),
    ("tangent-half", ModelMode::View(View::TangentHalf), 't'),
    ("stencil", ModelMode::View(View::StencilColors), 's'),
    ("volume", ModelMode::View(View::Volume), 'v'),
];

impl ModelMode {
    /// Names on the command line.
    pub fn names() -> impl Iterator<Item = &'static str> {
        MODES.iter().map(|row| row.0)
    }

    /// The mode of a name on the command line.
    pub fn named(name: &str) -> Option<Self> {
        MODES.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        MODES.iter().find(|row| row.1 == self).map_or("", |row| row.0)
    }

    /// The next of a key's pictures. The last is followed by the first, or by the scene where the key has but one; another key's
    /// picture by the first.
    #[must_use]
    pub fn next(self, key: char) -> Self {
        let mut own: Vec<Self> = MODES.iter().filter(|row| row.2 == key).map(|row| row.1).collect();
        if own.len() == 1 {
            own.push(Self::Scene);
        }
        let place = own.iter().position(|mode| *mode == self).map_or(0, |place| place + 1);
        own.get(place).or(own.first()).copied().unwrap_or_default()
    }
}

/// Command of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelCommand {
    /// Starts and stops the animation.
    Animate,
    /// Multiplies its speed.
    Speed(f64),
    /// The next of the model's animations.
    NextAnimation,
    /// The next of a key's pictures.
    Show(char),
    /// Shows or hides the model's edges.
    Wireframe,
    /// Shows or hides the room.
    Backdrop,
    /// The next way in which bumps are lit: one pass, three passes, per fragment.
    NextMethod,
    /// The gloss map, or all of the model shining.
    Gloss,
    /// Normals of the file, or of the triangles.
    Normals,
    /// Shadow technique of a digit.
    Technique(&'static str),
    Reset,
    /// Shows or hides the help.
    Help,
    Quit,
}

const KEYS: &[(&[&str], ModelCommand, &str)] = &[
    (&["space"], ModelCommand::Animate, "animation on and off"),
    (&["+", "="], ModelCommand::Speed(1.4), "faster"),
    (&["-"], ModelCommand::Speed(1.0 / 1.4), "slower"),
    (&["a"], ModelCommand::NextAnimation, "next animation of the model"),
    (&["r"], ModelCommand::Show('r'), "next picture: scene, normal map, decal, gloss"),
    (&["t"], ModelCommand::Show('t'), "next picture: normals, diffuse, specular, vectors to light and half-angle"),
    (&["s"], ModelCommand::Show('s'), "the stencil count as colours, and back"),
    (&["v"], ModelCommand::Show('v'), "shadow volumes over the scene, and back"),
    (&["w"], ModelCommand::Wireframe, "the model's triangles as a wire frame over it, or not"),
    (&["b"], ModelCommand::Backdrop, "with or without the room"),
    (&["p"], ModelCommand::NextMethod, "bumps: one pass, three passes, reference"),
    (&["g"], ModelCommand::Gloss, "with or without the gloss map"),
    (&["n"], ModelCommand::Normals, "normals of the file, or recomputed"),
    (&["0"], ModelCommand::Technique("none"), "no shadows"),
    (&["1"], ModelCommand::Technique("shadow-volume"), "stencil shadow volumes"),
    (&["2"], ModelCommand::Technique("shadow-map"), "a shadow map"),
    (&["Home"], ModelCommand::Reset, "eye and light as they were at first"),
    (&["h"], ModelCommand::Help, "this help in the window, or not"),
    (&["q", "Esc"], ModelCommand::Quit, "quit"),
];

const MOUSE: [(&str, &str); 3] = [
    ("left drag", "moves the eye around"),
    ("middle drag", "moves the light around"),
    ("wheel", "eye nearer, farther"),
];

/// The command of a key, by its name; letters in either case.
pub fn command(name: &str) -> Option<ModelCommand> {
    KEYS.iter().find(|(names, ..)| names.iter().any(|known| known.eq_ignore_ascii_case(name))).map(|row| row.1)
}

/// Each key's and gesture's name, and what it does.
pub fn model_help() -> Vec<(String, String)> {
    let keys = KEYS.iter().map(|(names, _, what)| (names.join(" "), (*what).to_owned()));
    keys.chain(MOUSE.map(|(name, what)| (name.to_owned(), what.to_owned()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_bound_twice() {
        assert_eq!(crate::viewer::twice(KEYS.iter().flat_map(|row| row.0.iter())), None);
    }

    #[test]
    fn keys_go_round_their_pictures() {
        let walk = |mut mode: ModelMode, key: char, steps: usize| {
            (0..steps).for_each(|_| mode = mode.next(key));
            mode.name()
        };
        let scene = ModelMode::Scene;
        assert_eq!([1, 2, 3, 4].map(|steps| walk(scene, 'r', steps)), ["normal-map", "decal", "gloss", "scene"]);
        assert_eq!([1, 2, 3].map(|steps| walk(scene, 's', steps)), ["stencil", "scene", "stencil"]);
        assert_eq!([1, 5, 6].map(|steps| walk(scene, 't', steps)), ["normal", "tangent-half", "normal"]);
        assert_eq!(walk(ModelMode::View(View::Volume), 'r', 1), "scene");
        assert!(ModelMode::names().all(|name| ModelMode::named(name).is_some_and(|mode| mode.name() == name)));
    }
}
