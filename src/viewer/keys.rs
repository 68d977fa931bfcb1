//! Which key does what: one table for the window and for the help.

use super::Handle;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    NextMode,
    /// Of the sample's shadow techniques.
    NextTechnique,
    ViewAll,
    Reset,
    /// What the mouse turns and moves from now on.
    Hold(Handle),
    NextTweak,
    /// Of the current tweak.
    Step(f64),
    Help,
    Quit,
}

/// Keys by the names that the window gives them, what they do, and a line of help.
const KEYS: &[(&[&str], Command, &str)] = &[
    (&["space"], Command::NextMode, "next picture: with shadows, without, from the light"),
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
    (&["h"], Command::Help, "this help"),
    (&["q", "Esc"], Command::Quit, "quit"),
];

/// The command of a key, by its name; letters in either case.
pub fn command(name: &str) -> Option<Command> {
    KEYS.iter().find(|(names, ..)| names.iter().any(|known| known.eq_ignore_ascii_case(name))).map(|row| row.1)
}

/// Keys and mouse, for a person, where there are so many techniques to choose from.
pub fn help(techniques: &[&str]) -> String {
    let used = |row: &&(&[&str], Command, &str)| techniques.len() > 1 || row.1 != Command::NextTechnique;
    let rows = KEYS.iter().filter(used).map(|(names, _, what)| format!("  {:<14}  {what}", names.join(" ")));
    let mouse = [
        ("left drag", "turns what the mouse holds"),
        ("right drag", "moves it nearer or farther"),
        ("wheel", "the same"),
    ];
    let mouse = mouse.iter().map(|(name, what)| format!("  {name:<14}  {what}"));
    let lines: Vec<String> =
        [String::from("Keys and mouse in the window:")].into_iter().chain(rows).chain(mouse).collect();
    lines.join("\n")
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
    fn keys_are_found_in_either_case() {
        assert_eq!(command("Q"), Some(Command::Quit));
        assert_eq!(command("space"), Some(Command::NextMode));
        assert_eq!(command("x"), None);
        assert!(help(&[]).contains("q Esc") && !help(&[]).contains("technique"));
        assert!(help(&["midpoint", "shadow-map"]).contains("technique"));
    }
}
