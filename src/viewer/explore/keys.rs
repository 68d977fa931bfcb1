//! Keys of `glumbra view` and their commands: one table for the window, for scripts and for the help.

use crate::viewer::show::Button;

/// Command of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExploreCommand {
    /// Shows the next page of the help, and after the last none.
    Help,
    Save,
    /// Drags look around, and w, a, s, d move; or not.
    Fly,
    /// Moves by steps to the right, upwards and forwards.
    Walk([f64; 3]),
    NextCamera,
    /// The camera as the file has it.
    ResetCamera,
    /// All as the files have it.
    Reset,
    NextLight,
    /// The mouse holds the light or the camera.
    Hold,
    NextTechnique,
    /// Steps of the polygon offset's units.
    Bias(f64),
    /// Steps of the polygon offset's factor.
    Slope(f64),
    /// Multiplies the side of the map by a power of two.
    MapSize(i32),
    NextKernel,
    /// Steps through the views.
    View(i32),
    /// The picture alone, or the last view again.
    Picture,
    /// The view beside the picture, or in its place.
    Beside,
    /// Steps through the passes.
    Pass(i32),
    /// Shows the next page of what is left out, and after the last none.
    LeftOut,
    Times,
    Quit,
}

use ExploreCommand as C;

/// Keys by the names that the window gives them, what they do, and a line of help.
const KEYS: &[(&[&str], ExploreCommand, &str)] = &[
    (&["h"], C::Help, "this help, page by page"),
    (&["q", "Esc"], C::Quit, "quit"),
    (&["p", "."], C::Pass(1), "the picture after the next pass; after the last one the whole"),
    (&["o", ","], C::Pass(-1), "the picture after the pass before"),
    (
        &["v"],
        C::View(1),
        "next view: shadow map, shadow volumes, silhouettes, stencil count, texels per pixel, truth, difference",
    ),
    (&["b"], C::View(-1), "the view before"),
    (&["space"], C::Picture, "the picture alone, or the view again"),
    (&["n"], C::Beside, "the view beside the picture, or in its place"),
    (&["i"], C::LeftOut, "what the plan leaves out and warns of, page by page"),
    (&["f"], C::Times, "times of the frame, or not"),
    (&["l"], C::NextLight, "choose the next light"),
    (&["m"], C::Hold, "the mouse holds the chosen light, or the camera"),
    (&["t"], C::NextTechnique, "the light's next shadow technique"),
    (&["1"], C::Bias(-1.0), "its bias (polygon offset's units) down"),
    (&["2"], C::Bias(1.0), "its bias up"),
    (&["3"], C::Slope(-0.5), "its slope offset (polygon offset's factor) down"),
    (&["4"], C::Slope(0.5), "its slope offset up"),
    (&["5"], C::MapSize(-1), "its map half as large"),
    (&["6"], C::MapSize(1), "its map twice as large"),
    (&["k", "7"], C::NextKernel, "its next filter: nearest, linear, 3x3, 5x5, 7x7"),
    (&["c"], C::NextCamera, "the scene's next camera"),
    (&["Home"], C::ResetCamera, "the camera as the file has it"),
    (&["r"], C::Reset, "camera, lights and shadows as the files have them"),
    (&["x"], C::Fly, "fly: a drag looks around, w a s d move too; or not"),
    (&["Up"], C::Walk([0.0, 0.0, 1.0]), "forwards"),
    (&["Down"], C::Walk([0.0, 0.0, -1.0]), "backwards"),
    (&["Left"], C::Walk([-1.0, 0.0, 0.0]), "to the left"),
    (&["Right"], C::Walk([1.0, 0.0, 0.0]), "to the right"),
    (&["PageUp"], C::Walk([0.0, 1.0, 0.0]), "upwards"),
    (&["PageDown"], C::Walk([0.0, -1.0, 0.0]), "downwards"),
    (&["s"], C::Save, "save the picture, and the scene as it now stands; while flying: backwards"),
];

/// Keys that have another command while flying.
const FLYING: &[(&str, ExploreCommand)] = &[
    ("w", C::Walk([0.0, 0.0, 1.0])),
    ("s", C::Walk([0.0, 0.0, -1.0])),
    ("a", C::Walk([-1.0, 0.0, 0.0])),
    ("d", C::Walk([1.0, 0.0, 0.0])),
];

/// Actions of the mouse; their names in scripts; and what they do.
const MOUSE: [(&str, &str); 4] = [
    ("left drag", "orbits the camera, or moves the light on a sphere about its target"),
    ("right drag", "moves the camera across, or the light on a plane that faces the camera"),
    ("middle drag", "moves the light on its sphere, whatever the mouse holds"),
    ("wheel", "what the mouse holds nearer, or farther"),
];

/// Drags of a script.
pub(super) const DRAGS: [(&str, Button); 3] =
    [("drag", Button::Left), ("right-drag", Button::Right), ("middle-drag", Button::Middle)];

/// The command of a key, by its name; letters in either case.
pub fn command(name: &str, flies: bool) -> Option<ExploreCommand> {
    let flying = FLYING.iter().find(|(known, _)| flies && known.eq_ignore_ascii_case(name)).map(|row| row.1);
    let known = || KEYS.iter().find(|row| row.0.iter().any(|known| known.eq_ignore_ascii_case(name))).map(|row| row.1);
    flying.or_else(known)
}

/// Tests whether a key has a command, now or while flying.
pub fn is_known(name: &str) -> bool {
    command(name, true).is_some()
}

/// Each key's and gesture's name, and what it does.
pub fn explore_help() -> Vec<(String, String)> {
    let keys = KEYS.iter().map(|(names, _, what)| (names.join(" "), (*what).to_owned()));
    keys.chain(MOUSE.map(|(name, what)| (name.to_owned(), what.to_owned()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_bound_twice() {
        let mut names: Vec<String> = KEYS.iter().flat_map(|row| row.0.iter().map(|name| name.to_lowercase())).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn flying_keys_move_only_in_flight() {
        assert_eq!((command("S", false), command("w", false)), (Some(C::Save), None));
        assert_eq!(command("s", true), Some(C::Walk([0.0, 0.0, -1.0])));
        assert!(is_known("w") && is_known("home") && !is_known("y"));
    }
}
