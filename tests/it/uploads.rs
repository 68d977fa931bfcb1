//! Uploads of a still scene: all in its first frame. glBufferData and glTexImage2D are counted on their way to the driver.

use std::cell::Cell;
use std::ffi::c_void;
use std::path::Path;
use std::rc::Rc;

use glumbra::context::{self, Context, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::plan::Request;

use crate::support::replaced::Replaced;

type BufferData = extern "system" fn(u32, isize, *const c_void, u32);
type TexImage2D = extern "system" fn(u32, i32, i32, i32, i32, i32, u32, u32, *const c_void);

thread_local! {
    static BUFFER_DATA: Cell<*const c_void> = const { Cell::new(std::ptr::null()) };
    static TEX_IMAGE_2D: Cell<*const c_void> = const { Cell::new(std::ptr::null()) };
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

extern "system" fn buffer_data(target: u32, size: isize, data: *const c_void, usage: u32) {
    COUNT.set(COUNT.get() + 1);
    // SAFETY: the driver's own function, found by this name.
    let driver: BufferData = unsafe { std::mem::transmute(BUFFER_DATA.get()) };
    driver(target, size, data, usage);
}

#[allow(clippy::too_many_arguments, reason = "GL's own signature")]
extern "system" fn tex_image_2d(
    target: u32,
    level: i32,
    internal: i32,
    width: i32,
    height: i32,
    border: i32,
    format: u32,
    kind: u32,
    pixels: *const c_void,
) {
    COUNT.set(COUNT.get() + 1);
    // SAFETY: as above.
    let driver: TexImage2D = unsafe { std::mem::transmute(TEX_IMAGE_2D.get()) };
    driver(target, level, internal, width, height, border, format, kind, pixels);
}

/// A context whose uploads are counted.
fn counting(inner: Rc<dyn Context>) -> Rc<dyn Context> {
    Replaced::new(inner, |name, driver| match name {
        name if name == c"glBufferData" => {
            BUFFER_DATA.set(driver);
            Some(buffer_data as *const c_void)
        }
        name if name == c"glTexImage2D" => {
            TEX_IMAGE_2D.set(driver);
            Some(tex_image_2d as *const c_void)
        }
        _ => None,
    })
}

#[test]
fn a_still_scene_uploads_nothing_after_its_first_frame() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/knight.toml");
    let context = counting(context::open(&ContextRequest::default()).unwrap());
    const MAP: &str = "light.shadow.technique=shadow-map";
    for (changes, planned_anew) in [
        (&["shading.bump=reference", MAP][..], true),
        (&["shading.bump=one-pass", MAP], true),
        (&["shading.bump=three-pass", MAP], true),
        // A plan extrudes volumes again: those of one plan are uploaded once.
        (&["shading.bump=one-pass"], false),
    ] {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let loaded = glumbra::load(&scene, &changes).unwrap();
        let mut renderer = Renderer::new(&context);
        let request = Request { frames: 4, ..Request::default() };
        let mut counts = Vec::new();
        let mut plan = renderer.plan(&loaded.scene, &request).unwrap();
        for _ in 0..4 {
            COUNT.set(0);
            if planned_anew {
                plan = renderer.plan(&loaded.scene, &request).unwrap();
            }
            renderer.draw(&plan).unwrap();
            counts.push(COUNT.get());
        }
        assert!(counts[0] >= 8, "counted: {counts:?}");
        assert_eq!(counts[1..], [0; 3], "{changes:?}");
        // Another pose is another mesh: its vertices are uploaded, its textures are not.
        let moved = [changes.as_slice(), &[String::from("object.0.blend=0.6")]].concat();
        let moved = glumbra::load(&scene, &moved).unwrap();
        COUNT.set(0);
        let plan = renderer.plan(&moved.scene, &request).unwrap();
        renderer.draw(&plan).unwrap();
        assert!(COUNT.get() > 0, "a new pose");
    }
}
