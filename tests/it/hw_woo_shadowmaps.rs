//! The sample program with Woo's midpoint map, in a window of an X server: what its keys lead to is on the screen what
//! the headless pictures are, to the bit.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use assert_cmd::cargo::CommandCargoExt;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ConnectionExt as _, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
    KeyPressEvent, MapState, Window,
};
use x11rb::rust_connection::RustConnection;

use crate::support::xvfb::Xvfb;

const PROGRAM: &str = "hw_woo_shadowmaps";
const WIDTH: u16 = 301;
const HEIGHT: u16 = 207;
/// A machine that is busy with other tests needs seconds for a frame.
const PATIENCE: Duration = Duration::from_secs(60);

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

/// The program in its window; ended when dropped.
struct Running {
    program: Child,
    said: Receiver<String>,
    x: RustConnection,
    root: Window,
    window: Window,
}

impl Running {
    fn start(display: &str) -> Self {
        let mut program = command(Some(display)).stdout(Stdio::piped()).spawn().unwrap();
        let out = BufReader::new(program.stdout.take().unwrap());
        let (sender, said) = channel();
        std::thread::spawn(move || out.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let (x, screen) = x11rb::connect(Some(display)).unwrap();
        let root = x.setup().roots[screen].root;
        let mut running = Self { program, said, x, root, window: 0 };
        running.hear("hw_woo_shadowmaps: ");
        running.window = until("its window", || running.find());
        // No window manager is there to give it the keyboard.
        running.x.set_input_focus(InputFocus::PARENT, running.window, x11rb::CURRENT_TIME).unwrap().check().unwrap();
        running
    }

    fn find(&self) -> Option<Window> {
        let children = self.x.query_tree(self.root).unwrap().reply().unwrap().children;
        children.into_iter().find(|window| {
            let name = self.x.get_property(false, *window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64).unwrap().reply();
            let is_viewable = self
                .x
                .get_window_attributes(*window)
                .unwrap()
                .reply()
                .is_ok_and(|window| window.map_state == MapState::VIEWABLE);
            is_viewable && name.is_ok_and(|name| name.value.starts_with(PROGRAM.as_bytes()))
        })
    }

    /// Waits for a line that has this text.
    fn hear(&self, text: &str) -> String {
        loop {
            let line = self.said.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("it does not say `{text}`"));
            if line.contains(text) {
                return line;
            }
        }
    }

    /// Presses the key of a letter, and lets it go.
    fn press(&self, letter: u8) {
        let setup = self.x.setup();
        let count = setup.max_keycode - setup.min_keycode + 1;
        let map = self.x.get_keyboard_mapping(setup.min_keycode, count).unwrap().reply().unwrap();
        let each = usize::from(map.keysyms_per_keycode);
        let place = map.keysyms.iter().position(|symbol| *symbol == u32::from(letter)).unwrap() / each;
        let detail = setup.min_keycode + place as u8;
        for (response_type, mask) in
            [(KEY_PRESS_EVENT, EventMask::KEY_PRESS), (KEY_RELEASE_EVENT, EventMask::KEY_RELEASE)]
        {
            let event = KeyPressEvent {
                response_type,
                detail,
                root: self.root,
                event: self.window,
                same_screen: true,
                ..KeyPressEvent::default()
            };
            self.x.send_event(false, self.window, mask, event).unwrap().check().unwrap();
        }
    }

    /// RGB from the top, as the screen has it.
    fn screen(&self) -> Vec<u8> {
        let image = self.x.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, WIDTH, HEIGHT, !0).unwrap();
        let image = image.reply().unwrap();
        assert_eq!(image.depth, 24);
        image.data.chunks_exact(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect()
    }

    fn shows(&self, picture: &[u8], what: &str) {
        until(what, || (self.screen() == picture).then_some(()));
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// Asks again and again until there is an answer.
fn until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(start.elapsed() < PATIENCE, "{what} does not come");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn keys_go_over_to_polygon_offset_and_back_and_end_it() {
    let server = Xvfb::start().expect("Xvfb does not start: `ci/setup --test` installs it");
    let headless = |arguments: &[&str]| written(&["--headless", "-o"], arguments, None);
    let offset = ["--set", "light.shadow.technique=shadow-map"];
    let (midpoint, offset, from_light) = (headless(&[]), headless(&offset), headless(&["--mode", "light"]));
    let differing = midpoint.iter().zip(&offset).filter(|(a, b)| a != b).count();
    assert!(differing > 50 && differing < midpoint.len() / 20, "{differing}: the same shadow, but for its rims");

    let mut running = Running::start(server.display());
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
    let letters = (0..help.len()).step_by(3).filter(|first| help[*first..][..3] == [230; 3]).count();
    assert!(letters > 1000, "{letters} pixels of letters");
    running.press(b'h');
    running.shows(&from_light, "the picture without help");
    running.press(b'q');
    let ended = until("its end", || running.program.try_wait().unwrap());
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
