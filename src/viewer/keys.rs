//! Keys and their commands: one table for the window and for the help.

use super::{Handle, Mode};

/// Command of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    NextMode,
    /// The next of the sample's shadow techniques.
    NextTechnique,
    ViewAll,
    Reset,
    /// Changes what the mouse turns and moves.
    Hold(Handle),
    NextTweak,
    /// Steps the current tweak.
    Step(f64),
    /// Shows or hides the help.
    Help,
    Quit,
}

/// Keys by the names that the window gives them, what they do, and a line of help.
const KEYS: &[(&[&str], Command, &str)] = &[
    // The pictures' names follow.
    (&["space"], Command::NextMode, "next picture"),
    (&["m"], Command::NextTechnique, "next shadow technique: Woo's midpoint map, polygon offset"),
    (&["v"], Command::ViewAll, "view all: the camera steps back until it sees everything"),
    (&["Home"], Command::Reset, "camera, light, object and tweaks as they were at first"),
    (&["c"], Command::Hold(Handle::Camera), "the mouse holds the camera"),
    (&["l"], Command::Hold(Handle::Light), "the mouse holds the light"),
    (&["o"], Command::Hold(Handle::Object), "the mouse holds the object"),
    (&["t"], Command::NextTweak, "next tweak: r scale, r bias, polygon offset scale, polygon offset bias"),
    (&["+", "=", "Up"], Command::Step(1.0), "the tweak one step up"),
    (&["-", "Down"], Command::Step(-1.0), "the tweak one step down"),
    (&["PageUp"], Command::Step(10.0), "ten steps up"),
    (&["PageDown"], Command::Step(-10.0), "ten steps down"),
    (&["h"], Command::Help, "this help in the window, or not"),
    (&["q", "Esc"], Command::Quit, "quit"),
];

/// The command of a key, by its name; letters in either case.
pub fn command(name: &str) -> Option<Command> {
    KEYS.iter().find(|(names, ..)| names.iter().any(|known| known.eq_ignore_ascii_case(name))).map(|row| row.1)
}

/// Actions of the mouse.
const MOUSE: [(&str, &str); 3] =
    [("left drag", "turns what the mouse holds"), ("right drag", "moves it nearer or farther"), ("wheel", "the same")];

pub const HEADING: &str = "Keys and mouse in the window:";

/// Columns of the keys' names.
const NAMES: usize = 14;

/// Each key's and gesture's name, and what it does, where there are so many techniques to choose from.
pub fn rows(techniques: &[&str]) -> Vec<(String, String)> {
    let used = |row: &&(&[&str], Command, &str)| techniques.len() > 1 || row.1 != Command::NextTechnique;
    let words = |command: &Command, what: &str| match command {
        Command::NextMode => format!("{what}: {}", modes()),
        _ => what.to_owned(),
    };
    let keys = KEYS.iter().filter(used).map(|(names, command, what)| (names.join(" "), words(command, what)));
    keys.chain(MOUSE.map(|(name, what)| (name.to_owned(), what.to_owned()))).collect()
}

/// The modes in the order in which they come, from the one that a window begins with.
fn modes() -> String {
    let order = std::iter::successors(Some(Mode::default()), |mode| Some(mode.next()));
    order.take(Mode::ALL.len()).map(Mode::in_words).collect::<Vec<_>>().join(", ")
}

/// Keys and mouse, for a person, where there are so many techniques to choose from.
pub fn help(techniques: &[&str]) -> String {
    help_of(rows(techniques))
}

/// Keys and mouse, for a person.
pub fn help_of(rows: Vec<(String, String)>) -> String {
    let rows = rows.into_iter().map(|(name, what)| format!("  {name:<NAMES$}  {what}"));
    [String::from(HEADING)].into_iter().chain(rows).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_bound_twice() {
        assert_eq!(crate::viewer::twice(KEYS.iter().flat_map(|row| row.0.iter())), None);
    }

    /// As [`super::super::State`] goes through them.
    #[test]
    fn the_help_lists_the_modes_in_the_order_that_space_takes() {
        let help = help(&[]);
        assert!(help.contains("next picture: with shadows, from the light, without shadows\n"), "{help}");
    }

    #[test]
    fn keys_are_found_in_either_case() {
        assert_eq!(command("Q"), Some(Command::Quit));
        assert_eq!(command("space"), Some(Command::NextMode));
        assert_eq!(command("x"), None);
        assert!(help(&[]).contains("q Esc") && !help(&[]).contains("technique"));
        assert!(help(&["midpoint", "shadow-map"]).contains("technique"));
    }
}
