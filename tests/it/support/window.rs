//! A sample program in its window: keys in, what it says and what the screen has out.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ConnectionExt as _, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
    KeyPressEvent, MapState, Window,
};
use x11rb::rust_connection::RustConnection;

/// A machine that is busy with other tests needs seconds for a frame.
const PATIENCE: Duration = Duration::from_secs(60);

/// The program in its window; ended when dropped.
pub struct Running {
    name: &'static str,
    size: [u16; 2],
    program: Child,
    said: Receiver<String>,
    x: RustConnection,
    root: Window,
    window: Window,
}

impl Running {
    /// Starts a program of this name, whose window has this size in pixels.
    pub fn start(name: &'static str, mut command: Command, display: &str, size: [u16; 2]) -> Self {
        let mut program = command.stdout(Stdio::piped()).spawn().unwrap();
        let out = BufReader::new(program.stdout.take().unwrap());
        let (sender, said) = channel();
        std::thread::spawn(move || out.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let (x, screen) = x11rb::connect(Some(display)).unwrap();
        let root = x.setup().roots[screen].root;
        let mut running = Self { name, size, program, said, x, root, window: 0 };
        running.hear(&format!("{name}: "));
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
            is_viewable && name.is_ok_and(|name| name.value.starts_with(self.name.as_bytes()))
        })
    }

    /// Waits for a line that has this text.
    pub fn hear(&self, text: &str) -> String {
        loop {
            let line = self.said.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("it does not say `{text}`"));
            if line.contains(text) {
                return line;
            }
        }
    }

    /// Presses the key of a letter, and lets it go.
    pub fn press(&self, letter: u8) {
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
            let sent = self.x.send_event(false, self.window, mask, event).unwrap().check();
            // A key that ends the program may do so before it is let go.
            assert!(sent.is_ok() || response_type == KEY_RELEASE_EVENT, "{sent:?}");
        }
    }

    /// RGB from the top, as the screen has it.
    pub fn screen(&self) -> Vec<u8> {
        let image = self.x.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, self.size[0], self.size[1], !0).unwrap();
        let image = image.reply().unwrap();
        assert_eq!(image.depth, 24);
        image.data.chunks_exact(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect()
    }

    /// The program's exit status, when it has ended.
    pub fn ended(&mut self) -> ExitStatus {
        until("its end", || self.program.try_wait().unwrap())
    }

    pub fn shows(&self, picture: &[u8], what: &str) {
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
pub fn until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(start.elapsed() < PATIENCE, "{what} does not come");
        std::thread::sleep(Duration::from_millis(20));
    }
}
