//! The sample program with Woo's midpoint map, in a window of an X server: what its keys lead to is on the screen what
//! the headless pictures are, to the bit.

use std::process::Command;

use assert_cmd::cargo::CommandCargoExt;

use crate::support::window::{Running, until};
use crate::support::xvfb::Xvfb;

const PROGRAM: &str = "hw_woo_shadowmaps";
const WIDTH: u16 = 301;
const HEIGHT: u16 = 207;

fn command(display: Option<&str>) -> Command {
    let mut command = Command::cargo_bin(PROGRAM).unwrap();
    command.args(["--size", &format!("{WIDTH}x{HEIGHT}")]).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.env_remove("DISPLAY").envs(display.map(|display| ("DISPLAY", display)));
    command
}

/// The picture that the program writes.
fn written(names: &[&str], arguments: &[&str], display: Option<&str>) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let run = command(display).args(names).arg(&path).args(arguments).output().unwrap();
    assert!(run.status.success() && run.stderr.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&run.stderr));
    image::open(path).unwrap().into_rgb8().into_raw()
}

#[test]
fn keys_go_over_to_polygon_offset_and_back_and_end_it() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let headless = |arguments: &[&str]| written(&["--headless", "-o"], arguments, None);
    let offset = ["--set", "light.shadow.technique=shadow-map"];
    let (midpoint, offset, from_light) = (headless(&[]), headless(&offset), headless(&["--mode", "light"]));
    let differing = midpoint.iter().zip(&offset).filter(|(a, b)| a != b).count();
    assert!(differing > 50 && differing < midpoint.len() / 20, "{differing}: the same shadow, but for its rims");

    let mut running = Running::start(PROGRAM, command(Some(server.display())), server.display(), [WIDTH, HEIGHT]);
    running.shows(&midpoint, "the midpoint map's picture");
    for (key, status, picture) in
        [(b'm', "| shadow-map |", &offset), (b'm', "| midpoint |", &midpoint), (b' ', "from the light", &from_light)]
    {
        running.press(key);
        let line = running.hear(status);
        running.shows(picture, &line);
    }
    // Help lies over the picture's upper left corner, and goes again.
    running.press(b'h');
    let help = until("its help", || Some(running.screen()).filter(|screen| *screen != from_light));
    let at = |x: usize, y: usize| 3 * (y * usize::from(WIDTH) + x);
    assert_eq!(help[at(9, 9)..][..3], [24, 26, 30], "the sheet's paper");
    assert_eq!(help[at(2, 100)..][..3], from_light[at(2, 100)..][..3], "beside it");
    // Where a letter covers half of a pixel, every channel is beyond 127 there: paper 24 to 30, ink 230.
    let is_letter = |(now, before): &(&[u8], &[u8])| now != before && now.iter().all(|channel| *channel > 127);
    let letters = help.chunks_exact(3).zip(from_light.chunks_exact(3)).filter(is_letter).count();
    assert!(letters > 1000, "{letters} pixels of letters");
    // It has pages in so small a window; behind the last one it goes.
    let mut shown = help;
    for _ in 0..4 {
        running.press(b'h');
        shown = until("the next page, or none", || Some(running.screen()).filter(|screen| *screen != shown));
        if shown == from_light {
            break;
        }
    }
    running.shows(&from_light, "the picture without help");
    running.press(b'q');
    let ended = running.ended();
    assert!(ended.success(), "{ended}");
}

#[test]
fn the_window_is_captured_as_it_is_drawn_without_one() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    for arguments in [&[][..], &["--mode", "camera"], &["--set", "light.shadow.average=eye-linear"]] {
        let window = written(&["--capture"], arguments, Some(server.display()));
        assert!(window == written(&["--headless", "-o"], arguments, None), "{arguments:?}");
    }
}
