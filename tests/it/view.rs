//! `glumbra view` without a window: each key changes what it says, what is saved is drawn again to the same pixels, a changed
//! file is seen, and a broken one leaves the picture.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use assert_cmd::cargo::CommandCargoExt;
use image::RgbImage;

/// A floor and a cube of a file, in a light whose shadow a map finds.
pub const SCENE: &str = r#"
include = "room.toml"
[image]
size = [120, 90]
background = [0.1, 0.1, 0.2]
[[camera]]
name = "front"
eye = [2, 4, 6]
target = [0, 0.5, 0]
[[camera]]
name = "above"
eye = [0, 8, 1]
target = [0, 0, 0]
[[object]]
mesh = "cube.obj"
translate = [0, 1, 0]
"#;

const ROOM: &str = r#"
[[light]]
name = "lamp"
position = [3, 6, 2]
target = [0, 0, 0]
cone = 70
near = 1
far = 20
shadow = { technique = "shadow-map", size = 256, offset = { factor = 2.0, units = 4.0 } }
[[object]]
mesh = "quad"
scale = [4, 1, 4]
"#;

const CUBE: &str = "mtllib cube.mtl\nusemtl red\n\
    v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

const RED: &str = "newmtl red\nKd 0.9 0.1 0.1\n";

/// A folder with the scene.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, text) in [("scene.toml", SCENE), ("room.toml", ROOM), ("cube.obj", CUBE), ("cube.mtl", RED)] {
            folder.write(name, text);
        }
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::cargo_bin("glumbra").unwrap();
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    fn glumbra(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    pub fn picture(&self, name: &str) -> RgbImage {
        image::open(self.path(name)).unwrap().into_rgb8()
    }

    /// Text that a script prints, and its last picture.
    fn view(&self, keys: &str) -> (Vec<String>, RgbImage) {
        self.view_of("scene.toml", keys)
    }

    fn view_of(&self, scene: &str, keys: &str) -> (Vec<String>, RgbImage) {
        let output = self.glumbra(&["view", scene, "--headless", "--keys", keys, "-o", "last.png"]);
        let (said, error) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
        assert!(output.status.success() && error.is_empty(), "{keys}: {error}");
        (said.lines().map(str::to_owned).collect(), self.picture("last.png"))
    }

    /// `glumbra render`'s picture.
    pub fn render(&self, scene: &str, arguments: &[&str]) -> RgbImage {
        let output = self.glumbra(&[&["render", scene, "-o", "render.png", "--quiet"], arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        self.picture("render.png")
    }
}

/// Number of frames that were drawn.
fn frames(said: &[String]) -> u32 {
    said.last().unwrap().strip_prefix("frames drawn: ").unwrap().parse().unwrap()
}

/// The last status.
fn status(said: &[String]) -> &str {
    &said[said.len() - 2]
}

#[test]
fn the_first_picture_is_render_s_and_idle_draws_nothing() {
    let folder = Folder::new();
    let (said, picture) = folder.view("wait(0.7) m x");
    assert!(picture == folder.render("scene.toml", &[]));
    assert_eq!(frames(&said), 1, "{said:?}");
    let (said, _) = folder.view("drag(5,0) wheel(1)");
    assert_eq!(frames(&said), 3, "{said:?}");
}

/// Each key changes what its line of help says, in words and in the picture.
#[test]
fn keys_change_what_they_say() {
    let folder = Folder::new();
    let (_, plain) = folder.view("");
    for (keys, words, changes) in [
        ("drag(20,0)", "picture", true),
        ("right-drag(20,5)", "picture", true),
        ("wheel(2)", "picture", true),
        ("middle-drag(40,0)", "picture", true),
        ("Up", "picture", true),
        ("Left PageUp", "picture", true),
        ("x w a", "mouse: flight", true),
        ("x drag(9,3)", "mouse: flight", true),
        ("m", "mouse: light", false),
        ("m drag(30,0)", "mouse: light", true),
        ("m right-drag(30,0)", "mouse: light", true),
        ("m wheel(-3)", "mouse: light", true),
        ("c", "camera above", true),
        ("c c", "camera front", false),
        ("drag(20,0) Home", "picture", false),
        ("m drag(30,0) t 6 r", "shadow-map 256, bias 4, slope 2, linear 1x1", false),
        ("t", "lamp: midpoint 256", true),
        ("2 2", "bias 6, slope 2", false),
        ("1", "bias 3, slope 2", false),
        ("4", "slope 2.5", false),
        ("3 3 3 3", "slope 0", true),
        ("5 5", "shadow-map 64", true),
        ("6", "shadow-map 512", true),
        ("k k", "linear 5x5", true),
        ("k k k k k", "linear 1x1", false),
        ("v", "light-depth |", true),
        ("v v", "volume (by shadow-volume) |", true),
        ("b", "difference |", true),
        ("v space", "picture |", false),
        ("v space space", "light-depth |", true),
        ("v b", "picture |", false),
        ("n", "picture |", false),
        ("v n", "light-depth |", true),
        ("p", "pass ", false),
        ("p o", "picture |", false),
        ("h", "picture |", true),
        ("f", "picture |", true),
        ("i", "picture |", true),
    ] {
        let (said, picture) = folder.view(keys);
        assert!(status(&said).contains(words), "{keys}: {}", status(&said));
        // An offset's small step may show or not, and a pass's name stands over its picture.
        let is_open = ["1", "2 2", "4", "p"].contains(&keys);
        assert!(is_open || (picture != plain) == changes, "{keys}: changed is not {changes}");
    }
}

#[test]
fn what_is_saved_is_drawn_again_to_the_same_pixels() {
    let folder = Folder::new();
    let moves = ["", "c", "drag(30,10) wheel(1)", "c right-drag(5,5) size(100,60)", "m drag(30,9) t 6 2 k", "t t t"];
    for (number, keys) in moves.into_iter().enumerate() {
        let (said, shown) = folder.view(&format!("{keys} s"));
        let name = format!("scene-view-{}", number + 1);
        assert!(status(&said).contains(&format!("saved {name}.png and {name}.toml")), "{}", status(&said));
        let saved = folder.picture(&format!("{name}.png"));
        assert!(saved == shown, "{keys}: the screen differs");
        // From another folder.
        let moved = tempfile::tempdir().unwrap();
        let scene = moved.path().join("moved.toml");
        fs::copy(folder.path(&format!("{name}.toml")), &scene).unwrap();
        assert!(saved == folder.render(scene.to_str().unwrap(), &[]), "{keys}: render differs");
    }
    assert!(folder.picture("scene-view-1.png") != folder.picture("scene-view-3.png"));
}

#[test]
fn a_suns_and_a_lamps_place_is_saved() {
    let folder = Folder::new();
    for light in
        ["kind = \"directional\"\nposition = [3, 6, 2]\ntarget = [0, 0, 0]", "kind = \"point\"\nposition = [3, 6, 2]"]
    {
        folder.write("room.toml", &format!("[[light]]\n{light}\n[[object]]\nmesh = \"quad\"\nscale = [4, 1, 4]\n"));
        let (_, plain) = folder.view("");
        let (said, _) = folder.view("m drag(40,10) s");
        let name = status(&said).split_once("saved ").unwrap().1.split_once(' ').unwrap().0.to_owned();
        let saved = folder.picture(&name);
        assert!(saved != plain && saved == folder.render(&name.replace(".png", ".toml"), &[]), "{light}");
    }
}

#[test]
fn passes_are_those_of_render() {
    let folder = Folder::new();
    let (said, _) = folder.view("p");
    let number = status(&said).strip_prefix("pass ").unwrap().split(' ').next().unwrap().to_owned();
    // The name of the pass covers the lower left corner alone.
    let (_, shown) = folder.view("p");
    let expected = folder.render("scene.toml", &["--after-pass", &number]);
    for (x, y, pixel) in shown.enumerate_pixels().filter(|(_, y, _)| *y < 40) {
        assert_eq!(pixel, expected.get_pixel(x, y), "{x} {y}");
    }
}

#[test]
fn truth_and_difference_are_those_of_render() {
    let folder = Folder::new();
    for (keys, name) in [("b b", "truth"), ("b", "difference")] {
        // A window so high that the legend leaves its upper part free.
        let (_, shown) = folder.view(&format!("size(160,300) {keys}"));
        folder.render("scene.toml", &["--aov", name, "--size", "160x300"]);
        let expected = folder.picture(&format!("render.{name}.png"));
        for (x, y, pixel) in shown.enumerate_pixels().filter(|(_, y, _)| *y < 150) {
            assert_eq!(pixel, expected.get_pixel(x, y), "{name} {x} {y}");
        }
        assert!(shown != expected, "{name} has a legend");
    }
}

/// No line of a long sheet is lost: in a low window there are more pages, and after the last there is none.
#[test]
fn sheets_have_pages() {
    let folder = Folder::new();
    let (_, plain) = folder.view("size(400,200)");
    let mut pages = Vec::new();
    for count in 1..20 {
        let (_, picture) = folder.view(&format!("size(400,200) {}", "h ".repeat(count)));
        if picture == plain {
            break;
        }
        assert!(!pages.contains(&picture), "page {count} was there");
        pages.push(picture);
    }
    assert!((4..15).contains(&pages.len()), "{} pages", pages.len());
}

/// A script that waits for files, line by line.
struct Waiting(Child, std::io::Lines<BufReader<std::process::ChildStdout>>);

impl Waiting {
    fn start(folder: &Folder, keys: &str) -> Self {
        let mut command = folder.command(&["view", "scene.toml", "--headless", "--keys", keys, "-o", "last.png"]);
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let out = BufReader::new(child.stdout.take().unwrap()).lines();
        Self(child, out)
    }

    fn hear(&mut self, text: &str) -> String {
        loop {
            let line = self.1.next().unwrap_or_else(|| panic!("it does not say {text}")).unwrap();
            if line.contains(text) {
                return line;
            }
        }
    }

    fn end(mut self) {
        self.1.by_ref().for_each(|line| drop(line.unwrap()));
        assert!(self.0.wait().unwrap().success());
    }
}

#[test]
fn a_change_of_each_file_is_seen() {
    for (name, from, to) in [
        ("scene.toml", "background = [0.1, 0.1, 0.2]", "background = [0.5, 0.6, 0.2]"),
        ("room.toml", "scale = [4, 1, 4]", "scale = [2, 1, 2]"),
        ("cube.obj", "v 1 1 1", "v 2 1.5 2"),
        ("cube.mtl", "0.9 0.1 0.1", "0.1 0.9 0.123"),
    ] {
        let folder = Folder::new();
        let before = folder.render("scene.toml", &[]);
        let mut waiting = Waiting::start(&folder, "wait(60)");
        waiting.hear("waiting");
        let text = fs::read_to_string(folder.path(name)).unwrap();
        assert!(text.contains(from));
        folder.write(name, &text.replace(from, to));
        waiting.hear("read again");
        waiting.end();
        let now = folder.picture("last.png");
        assert!(now != before && now == folder.render("scene.toml", &[]), "{name}");
    }
}

/// A file that is included and says nothing may say something later.
#[test]
fn an_included_file_without_keys_is_watched() {
    let folder = Folder::new();
    folder.write("empty.toml", "# nothing yet\n");
    folder.write("scene.toml", &SCENE.replace("\"room.toml\"", "[\"room.toml\", \"empty.toml\"]"));
    let before = folder.render("scene.toml", &[]);
    let mut waiting = Waiting::start(&folder, "wait(60)");
    waiting.hear("waiting");
    folder.write("empty.toml", "[shading]\nambient = [0.5, 0.4, 0.1]\n");
    waiting.hear("read again");
    waiting.end();
    let now = folder.picture("last.png");
    assert!(now != before && now == folder.render("scene.toml", &[]));
}

#[test]
fn a_broken_file_leaves_the_picture_and_is_told() {
    let folder = Folder::new();
    let before = folder.render("scene.toml", &[]);
    let mut waiting = Waiting::start(&folder, "wait(60) wait(60)");
    waiting.hear("waiting");
    folder.write("room.toml", "[[light]]\ncone = true\n");
    let told = waiting.hear("error: ");
    assert!(told.contains("room.toml:2") && told.contains("cone"), "{told}");
    waiting.hear("waiting");
    folder.write("room.toml", ROOM);
    let told = waiting.hear("read again");
    assert!(!told.contains("error"), "{told}");
    waiting.end();
    assert!(folder.picture("last.png") == before);
    // The error's sheet is in the lower part.
    let before = folder.render("scene.toml", &["--size", "400x300"]);
    let mut waiting = Waiting::start(&folder, "size(400,300) wait(60)");
    waiting.hear("waiting");
    folder.write("cube.obj", "v 1 2\n");
    waiting.hear("error: ");
    waiting.end();
    let shown = folder.picture("last.png");
    assert!(shown != before && shown.pixels().zip(before.pixels()).take(400 * 150).all(|(a, b)| a == b));
}

/// Things that the mouse has moved stay where the files do not change them.
#[test]
fn moves_outlast_a_change_of_something_else() {
    let folder = Folder::new();
    let (_, moved) = folder.view("drag(20,0)");
    let mut waiting = Waiting::start(&folder, "drag(20,0) wait(60)");
    waiting.hear("waiting");
    folder.write("cube.mtl", &format!("{RED}# the same\n"));
    waiting.hear("read again");
    waiting.end();
    assert!(folder.picture("last.png") == moved);
}

#[test]
fn wrong_arguments_are_refused() {
    let folder = Folder::new();
    for (arguments, code, expected) in [
        (&["view", "scene.toml", "--context", "egl"][..], 1, "go with --headless"),
        (&["view", "scene.toml", "--headless", "-o", "a.exr"], 1, "end its name in .png"),
        (&["view", "scene.toml", "--headless", "--save-in", "nowhere"], 1, "no such folder"),
        (&["view", "scene.toml", "--headless", "--keys", "jump"], 2, "'jump' is no key"),
        (&["view", "scene.toml", "--keys", "h"], 2, "--headless"),
        (&["view", "none.toml", "--headless"], 1, "none.toml"),
    ] {
        let output = folder.glumbra(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(code) && error.contains(expected), "{arguments:?}: {error}");
    }
    assert!(!Path::new(&folder.path("a.exr")).exists());
}
