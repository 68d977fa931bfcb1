//! Scripts of keys, for `--keys`: names with spaces between them.

use glam::DVec2;

use super::keys::{DRAGS, is_known};
use crate::viewer::show::Button;

/// Step of a script.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A key, by its name.
    Key(String),
    /// A drag, in pixels to the right and down.
    Drag(Button, DVec2),
    /// Notches of the wheel; nearer, or farther by less than 0.
    Wheel(f64),
    /// Waits until a file has changed, so many seconds at most.
    Wait(f64),
    /// Another size of the window, in pixels.
    Size([u32; 2]),
}

/// Seconds of a `wait` that says none.
const PATIENCE: f64 = 10.0;

/// Longest wait, in seconds.
const LONGEST: f64 = 3600.0;

/// Greatest side of a window, in pixels.
const LARGEST_SIDE: f64 = 16384.0;

/// Reads a script.
///
/// # Errors
///
/// A step that is not known, or has other numbers than it needs: a sentence.
pub fn parse_steps(text: &str) -> Result<Vec<Step>, String> {
    text.split_whitespace().map(step).collect()
}

fn step(word: &str) -> Result<Step, String> {
    let Some((name, rest)) = word.split_once('(') else {
        return match word {
            "wait" => Ok(Step::Wait(PATIENCE)),
            key if is_known(key) => Ok(Step::Key(key.to_owned())),
            _ => Err(format!("'{word}' is no key of `glumbra view`, and no drag(X,Y), wheel(N), wait or size(W,H)")),
        };
    };
    let inside = rest.strip_suffix(')').ok_or_else(|| format!("'{word}': the `)` is missing"))?;
    let numbers: Vec<f64> = inside
        .split(',')
        .map(|number| match number.parse::<f64>() {
            Ok(number) if number.is_finite() && number.abs() <= 1e6 => Ok(number),
            _ => Err(format!("'{word}': '{number}' is no number up to a million")),
        })
        .collect::<Result<_, _>>()?;
    let drag = DRAGS.iter().find(|row| row.0 == name).map(|row| row.1);
    match (name, &numbers[..]) {
        (_, [x, y]) if drag.is_some() => Ok(Step::Drag(drag.unwrap_or(Button::Left), DVec2::new(*x, *y))),
        ("wheel", [notches]) => Ok(Step::Wheel(*notches)),
        ("wait", [seconds]) if (0.0..=LONGEST).contains(seconds) => Ok(Step::Wait(*seconds)),
        ("size", [width, height]) if [width, height].iter().all(|side| (1.0..=LARGEST_SIDE).contains(*side)) => {
            Ok(Step::Size([*width as u32, *height as u32]))
        }
        _ => Err(format!(
            "'{word}': write drag(X,Y), right-drag(X,Y), middle-drag(X,Y), wheel(N), wait(SECONDS) or size(W,H)"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_read() {
        let steps = parse_steps(" c Home drag(10,-2.5) middle-drag(1,2) wheel(-3) wait(0.5) size(64,32) ").unwrap();
        let key = |name: &str| Step::Key(name.to_owned());
        let drag = |button, x, y| Step::Drag(button, DVec2::new(x, y));
        assert_eq!(steps[..4], [key("c"), key("Home"), drag(Button::Left, 10.0, -2.5), drag(Button::Middle, 1.0, 2.0)]);
        assert_eq!(steps[4..], [Step::Wheel(-3.0), Step::Wait(0.5), Step::Size([64, 32])]);
    }

    #[test]
    fn wrong_steps_are_refused() {
        for (text, expected) in [
            ("jump", "'jump' is no key"),
            ("drag(1", "the `)` is missing"),
            ("drag(1,x)", "'x' is no number"),
            ("drag(1)", "write drag(X,Y)"),
            ("size(0,4)", "write drag(X,Y)"),
            ("wheel(inf)", "'inf' is no number"),
        ] {
            let error = parse_steps(text).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
