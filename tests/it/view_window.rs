//! `glumbra view` in its window: real keys, and the pixels of the screen.

use crate::support::window::Running;
use crate::support::xvfb::Xvfb;
use crate::view::Folder;

#[test]
fn a_window_shows_what_a_script_shows_and_idles() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let folder = Folder::new();
    let headless = |keys: &str| {
        let done = folder.command(&["view", "scene.toml", "--headless", "--keys", keys, "-o", "last.png"]).output();
        assert!(done.unwrap().status.success());
        folder.picture("last.png").into_raw()
    };
    let expected = ["", "c", "c t", "c t v", "c t v h"].map(headless);
    let mut command = folder.command(&["view", "scene.toml"]);
    command.env("DISPLAY", server.display()).env_remove("WAYLAND_DISPLAY");
    let mut window = Running::start("glumbra view scene.toml", command, server.display(), [120, 90]);
    window.shows(&expected[0], "the scene");
    for (letter, (said, picture)) in [b'c', b't', b'v', b'h']
        .into_iter()
        .zip(["camera above", "midpoint", "light-depth", "h: help"].into_iter().zip(&expected[1..]))
    {
        window.press(letter);
        window.hear(said);
        window.shows(picture, said);
    }
    // Time in which nothing changes.
    std::thread::sleep(std::time::Duration::from_millis(1200));
    window.press(b's');
    window.hear("saved scene-view-1.png");
    assert!(folder.picture("scene-view-1.png").into_raw() == expected[2]);
    window.press(b'q');
    let line = window.hear("frames drawn: ");
    let frames: u32 = line.strip_prefix("frames drawn: ").unwrap().parse().unwrap();
    // One for each key that draws, and those that the window system asks for when the window comes.
    assert!((5..=8).contains(&frames), "{frames} frames");
    assert!(window.ended().success());
}
