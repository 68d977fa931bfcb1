//! `glumbra view`: a scene on standard input, which is read once, and rays that are kept while a scene stands still.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use glumbra::context::{self, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::viewer::explore::{Explorer, Sources, parse_steps, run_steps};

use crate::view::{Folder, SCENE};

#[test]
fn a_scene_on_standard_input_is_shown_saved_and_not_watched() {
    let folder = Folder::new();
    let expected = folder.render("scene.toml", &[]);
    fs::create_dir(folder.path("saved")).unwrap();
    let options = ["--keys", "s wait(1)", "-o", "last.png", "--save-in", "saved"];
    let mut command = folder.command(&[&["view", "-", "--headless"], &options[..]].concat());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(SCENE.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    let [said, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success() && error.contains("read once"), "{error}");
    assert!(said.contains("saved saved/stdin-view-1.png"), "{said}");
    assert!(folder.picture("last.png") == expected && folder.picture("saved/stdin-view-1.png") == expected);
    assert!(folder.render("saved/stdin-view-1.toml", &[]) == expected);
}

/// Rays are traced anew where the scene, its camera or the picture's size has changed, and for no sheet and no view.
#[test]
fn rays_are_kept_while_the_scene_stands_still() {
    let folder = Folder::new();
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let (sources, loaded) = Sources::load(&folder.path("scene.toml"), Vec::new()).unwrap();
    let mut state = Explorer::new(sources, loaded.scene, folder.path("")).unwrap();
    let mut traces = |state: &mut Explorer, keys: &str| {
        run_steps(state, &parse_steps(keys).unwrap(), &mut renderer, |_| {}).unwrap();
        state.traces()
    };
    assert_eq!(traces(&mut state, ""), 0);
    assert_eq!(traces(&mut state, "b h h b h"), 1, "the difference, the truth, and pages of the help over both");
    assert_eq!(traces(&mut state, "b b b b v v v v"), 1, "other views in between");
    assert_eq!(traces(&mut state, "drag(20,0)"), 2);
    assert_eq!(traces(&mut state, "size(100,80)"), 3);
    assert_eq!(traces(&mut state, "middle-drag(20,0)"), 4, "the light was moved");
}
