//! Keys of `glumbra view` and their commands: one table for the window, for scripts and for the help.

use super::shown::LOOKS;
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

/// Keys by the names that the window gives them, what they do, and a line of help; empty: that of the next row.
const KEYS: &[(&[&str], ExploreCommand, &str)] = &[
    (&["h"], C::Help, "this help, page by page, and then none"),
    (&["q", "Esc"], C::Quit, "quit"),
    (&["s"], C::Save, "save picture and scene as they now stand (in flight: back)"),
    (&["v"], C::View(1), ""),
    (&["b"], C::View(-1), "next view, view before; the views are named below"),
    (&["space"], C::Picture, "the picture alone, or the view again"),
    (&["n"], C::Beside, "the view beside the picture, or in its place"),
    (&["o", ","], C::Pass(-1), ""),
    (&["p", "."], C::Pass(1), "the picture after the pass before, after the next pass"),
    (&["i"], C::LeftOut, "what is left out of the frame, and warnings, by pages"),
    (&["f"], C::Times, "times of the frame, or not"),
    (&["l"], C::NextLight, "choose the next light"),
    (&["m"], C::Hold, "the mouse holds the chosen light, or the camera"),
    (&["t"], C::NextTechnique, "the light's next shadow technique"),
    (&["1"], C::Bias(-1.0), ""),
    (&["2"], C::Bias(1.0), "its bias down, up: the polygon offset's units"),
    (&["3"], C::Slope(-0.5), ""),
    (&["4"], C::Slope(0.5), "its slope offset down, up: the polygon offset's factor"),
    (&["5"], C::MapSize(-1), ""),
    (&["6"], C::MapSize(1), "its shadow map half, twice as large"),
    (&["k", "7"], C::NextKernel, "its next filter: nearest, linear, 3x3, 5x5, 7x7"),
    (&["c"], C::NextCamera, "the scene's next camera"),
    (&["Home"], C::ResetCamera, "the camera as the file has it"),
    (&["r"], C::Reset, "camera, lights and shadows as the files have them"),
    (&["x"], C::Fly, "fly, or not: a drag looks around, w a s d move"),
    (&["Up"], C::Walk([0.0, 0.0, 1.0]), ""),
    (&["Down"], C::Walk([0.0, 0.0, -1.0]), "move the camera forwards, backwards"),
    (&["Left"], C::Walk([-1.0, 0.0, 0.0]), ""),
    (&["Right"], C::Walk([1.0, 0.0, 0.0]), "to the left, to the right"),
    (&["PageUp"], C::Walk([0.0, 1.0, 0.0]), ""),
    (&["PageDown"], C::Walk([0.0, -1.0, 0.0]), "upwards, downwards"),
];

/// Keys that have another command while flying.
const FLYING: &[(&str, ExploreCommand)] = &[
    ("w", C::Walk([0.0, 0.0, 1.0])),
    ("s", C::Walk([0.0, 0.0, -1.0])),
    ("a", C::Walk([-1.0, 0.0, 0.0])),
    ("d", C::Walk([1.0, 0.0, 0.0])),
];

/// Actions of the mouse, and what they do.
const MOUSE: [(&str, &str); 4] = [
    ("left drag", "orbit the camera; move the held light about its target"),
    ("right drag", "move the camera across; the held light across the view"),
    ("middle drag", "move the chosen light about its target"),
    ("wheel", "what the mouse holds nearer, farther"),
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

/// Each key's and gesture's name, and what it does; last the views.
pub fn explore_help() -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut before = String::new();
    for (names, _, what) in KEYS {
        let names = format!("{before}{}", names.join(" "));
        if what.is_empty() {
            before = format!("{names} ");
        } else {
            rows.push((names, (*what).to_owned()));
            before.clear();
        }
    }
    rows.extend(MOUSE.map(|(name, what)| (name.to_owned(), what.to_owned())));
    rows.extend(LOOKS.iter().map(|look| (look.name().to_owned(), look.in_words().to_owned())));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_bound_twice() {
        assert_eq!(crate::viewer::twice(KEYS.iter().flat_map(|row| row.0.iter())), None);
    }

    #[test]
    fn flying_keys_move_only_in_flight() {
        assert_eq!((command("S", false), command("w", false)), (Some(C::Save), None));
        assert_eq!(command("s", true), Some(C::Walk([0.0, 0.0, -1.0])));
        assert!(is_known("w") && is_known("home") && !is_known("y"));
    }
}
