//! Every backend of contexts, what is said when none can be had, and `glumbra info`.

use std::process::Command;
use std::sync::{Arc, Barrier};

use assert_cmd::cargo::CommandCargoExt;
use glow::HasContext;
use glumbra::conformance::probe;
use glumbra::context::compatibility::{Binding, BindingError, raw};
use glumbra::context::{self, Backend, Choice, Context, ContextRequest, Error, Profile, egl};
use glumbra::device::debug::Debug;
use glumbra::device::queries::Timer;

mod support;
use support::xvfb::Xvfb;

const CORE: ContextRequest =
    ContextRequest { choice: Choice::Auto, device: None, profile: Profile::Core33, debug: true };
const COMPATIBILITY: ContextRequest = ContextRequest { profile: Profile::Compatibility, ..CORE };

/// Clears a framebuffer of its own to `color` and reads one pixel back.
fn cleared_pixel(context: &dyn Context, color: [f32; 4]) -> [u8; 4] {
    let gl = context.gl();
    let mut pixel = [0; 4];
    unsafe {
        let texture = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        let none = glow::PixelUnpackData::Slice(None);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, glow::RGBA8 as i32, 8, 8, 0, glow::RGBA, glow::UNSIGNED_BYTE, none);
        let framebuffer = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(texture), 0);
        gl.clear_color(color[0], color[1], color[2], color[3]);
        gl.clear(glow::COLOR_BUFFER_BIT);
        let pixels = glow::PixelPackData::Slice(Some(&mut pixel));
        gl.read_pixels(3, 3, 1, 1, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
        gl.delete_framebuffer(framebuffer);
        gl.delete_texture(texture);
    }
    pixel
}

/// The backend works: it draws, twice in turn, in both profiles.
fn check_backend(backend: Backend, name: &str) {
    for (request, profile) in [(CORE, "core"), (COMPATIBILITY, "compatibility"), (CORE, "core")] {
        let context = context::open_backend(backend, &request).unwrap();
        assert!(context.backend().starts_with(name), "{} is not {name}", context.backend());
        assert_eq!(context.describe().profile, profile);
        assert_eq!(cleared_pixel(&*context, [1.0, 0.0, 0.2, 1.0]), [255, 0, 51, 255]);
        Debug::new(&*context).check(name).unwrap();
    }
}

#[test]
fn egl_surfaceless_draws() {
    check_backend(Backend::EglSurfaceless, "EGL surfaceless");
}

#[test]
fn egl_device_draws() {
    check_backend(Backend::EglDevice, "EGL device 0");
}

#[test]
fn each_egl_device_can_be_chosen() {
    let devices = egl::devices().unwrap();
    assert!(!devices.is_empty());
    for device in devices {
        let request = ContextRequest { device: Some(device.index), ..CORE };
        let context = context::open(&request).unwrap();
        assert_eq!(context.backend(), format!("EGL device {}", device.index));
    }
}

#[test]
fn osmesa_draws() {
    match context::open_backend(Backend::OsMesa, &CORE) {
        // Mesa 25.1 dropped it; ci/setup installs it where there is one.
        Err(error) if error.to_string().contains("libOSMesa.so.8: cannot open shared object file") => {
            println!("skipped: this machine has no libOSMesa");
        }
        _ => check_backend(Backend::OsMesa, "OSMesa"),
    }
}

#[test]
fn contexts_of_one_thread_take_turns() {
    let first = context::open(&CORE).unwrap();
    let second = context::open_backend(Backend::EglDevice, &COMPATIBILITY).unwrap();
    for _ in 0..3 {
        first.make_current().unwrap();
        assert_eq!(first.describe().profile, "core");
        assert_eq!(cleared_pixel(&*first, [1.0; 4]), [255; 4]);
        second.make_current().unwrap();
        assert_eq!(second.describe().profile, "compatibility");
        assert_eq!(cleared_pixel(&*second, [0.0; 4]), [0; 4]);
    }
    // What is not current is dropped without touching what is.
    drop(first);
    assert_eq!(cleared_pixel(&*second, [1.0; 4]), [255; 4]);
}

#[test]
fn contexts_of_several_threads_work_at_the_same_time() {
    let threads = 4;
    let all_open = Arc::new(Barrier::new(threads));
    let work = |index: usize| {
        let all_open = all_open.clone();
        move || {
            for round in 0..8 {
                let backend = [Backend::EglSurfaceless, Backend::EglDevice][(index + round) % 2];
                let context = context::open_backend(backend, &CORE).unwrap();
                if round == 0 {
                    all_open.wait();
                }
                let value = (index * 60) as u8;
                let color = [f32::from(value) / 255.0; 4];
                assert_eq!(cleared_pixel(&*context, color), [value; 4]);
            }
        }
    };
    let handles: Vec<_> = (0..threads).map(|index| std::thread::spawn(work(index))).collect();
    for handle in handles {
        handle.join().unwrap();
    }
}

#[test]
fn gl_errors_carry_the_label_and_are_told_once() {
    for debug in [true, false] {
        let context = context::open(&ContextRequest { debug, ..CORE }).unwrap();
        let errors = Debug::new(&*context);
        assert_eq!(errors.is_verbose(), debug && context.gl().supports_debug());
        errors.check("nothing").unwrap();
        unsafe { context.gl().enable(0xBAD) };
        let error = errors.check("light 0, depth pass").unwrap_err();
        assert_eq!(error.label, "light 0, depth pass");
        assert!(error.to_string().contains("GL_INVALID_ENUM"), "{error}");
        errors.check("after").unwrap();
    }
}

#[test]
fn timers_answer_in_order_and_once() {
    let context = context::open(&CORE).unwrap();
    let Some(mut timer) = Timer::new(&*context) else {
        println!("skipped: no timer queries");
        return;
    };
    assert_eq!(timer.poll(), None);
    for _ in 0..3 {
        timer.begin();
        cleared_pixel(&*context, [1.0; 4]);
        timer.end();
    }
    assert!((0..3).all(|_| timer.wait().is_some()));
    assert_eq!(timer.wait(), None);
    Debug::new(&*context).check("timer").unwrap();
}

#[test]
fn depth_formats_are_as_wide_as_they_say() {
    let context = context::open(&CORE).unwrap();
    let facts = probe::depth_formats(context.gl()).unwrap();
    Debug::new(&*context).check("probe").unwrap();
    // OpenGL 3.3, 3.8.1: these are required, and each has at least its bits.
    let required =
        [("DEPTH_COMPONENT16", 16, false), ("DEPTH_COMPONENT24", 24, false), ("DEPTH_COMPONENT32F", 32, true)];
    for (name, bits, float) in required {
        let measured = facts.iter().find(|facts| facts.format == name).unwrap().measured.as_ref().unwrap();
        assert!(measured.depth_bits >= bits, "{name}: {measured:?}");
        assert_eq!(measured.float, float, "{name}");
        assert!(measured.one_unit_shows, "{name}: {measured:?}");
        for unit in measured.units {
            // The least difference that can be told, within the factor of 2 that drivers take.
            assert!((0.99..=2.01).contains(&unit.codes), "{name}: {unit:?}");
        }
    }
}

#[test]
fn a_missing_display_is_told_with_what_needs_none() {
    let output = glumbra(&["info", "--context", "window"]);
    assert_eq!(output.code, 1);
    assert_eq!(output.stdout, "");
    assert!(output.stderr.starts_with("error: no OpenGL context can be had."), "{}", output.stderr);
    for part in ["window ", "neither DISPLAY nor WAYLAND_DISPLAY is set", "needs no window: try --context egl"] {
        assert!(output.stderr.contains(part), "no `{part}` in {}", output.stderr);
    }
}

#[test]
fn a_device_that_is_not_there_is_told() {
    let output = glumbra(&["info", "--device", "99"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("--device 99: there is no device 99"), "{}", output.stderr);
    let output = glumbra(&["info", "--device", "0", "--context", "osmesa"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("chooses among EGL devices"), "{}", output.stderr);
}

/// With empty files in place of the libraries, every backend fails with a message of its own.
#[test]
fn a_machine_without_drivers_is_told_about_every_road() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    let mut command = command(&["info"]);
    command.env("LD_LIBRARY_PATH", folder.path());
    let output = run(command);
    assert_eq!(output.code, 1, "{}", output.stderr);
    for backend in ["EGL surfaceless", "EGL device", "EGL pbuffer", "OSMesa"] {
        let line = output.stderr.lines().find(|line| line.trim_start().starts_with(backend));
        assert!(line.is_some_and(|line| line.contains("file too short")), "{backend}: {}", output.stderr);
    }
    for part in ["apt-get install libegl1", "ci/demo"] {
        assert!(output.stderr.contains(part), "no `{part}` in {}", output.stderr);
    }
    // Newer distributions have no such package, and apt-get then installs nothing.
    assert!(!output.stderr.contains("libosmesa6"), "{}", output.stderr);
}

/// A driver that cannot be loaded is told by EGL's own code.
#[test]
fn egl_without_a_driver_names_its_error() {
    let mut command = command(&["info", "--context", "egl"]);
    command.env("LIBGL_DRIVERS_PATH", "/nonexistent").env("GBM_BACKENDS_PATH", "/nonexistent");
    command.env("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent");
    let output = run(command);
    if output.code == 0 {
        println!("skipped: this libEGL finds its driver without libglvnd");
        return;
    }
    assert_eq!(output.code, 1, "{}", output.stderr);
    assert!(!output.stderr.contains("panicked"), "{}", output.stderr);
    assert!(output.stderr.contains("EGL_"), "{}", output.stderr);
}

#[test]
fn usage_errors_exit_with_2() {
    assert_eq!(glumbra(&["info", "--context", "glx"]).code, 2);
    assert_eq!(glumbra(&["info", "--device", "-1"]).code, 2);
    assert_eq!(glumbra(&[]).code, 2);
}

#[test]
fn info_prints_what_a_person_looks_for() {
    let output = glumbra(&["info"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""));
    for part in ["EGL surfaceless", "renderer", "GLSL", "core", "subpixel bits", "--device 0", "DEPTH_COMPONENT24"] {
        assert!(output.stdout.contains(part), "no `{part}` in {}", output.stdout);
    }
}

#[test]
fn info_prints_json() {
    let output = glumbra(&["info", "--json", "--compatibility"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""));
    let json: serde_json::Value = serde_json::from_str(&output.stdout).unwrap();
    assert_eq!(json["context"]["profile"], "compatibility");
    assert!(json["context"]["limits"]["texture_size"].as_u64().unwrap() >= 1024);
    assert_eq!(json["depth_formats"].as_array().unwrap().len(), probe::FORMATS.len());
}

#[test]
fn window_and_pbuffer_draw_under_xvfb() {
    let Some(server) = Xvfb::start() else {
        assert!(std::env::var_os("CI").is_none(), "ci/setup --test installs Xvfb");
        println!("skipped: this machine has no Xvfb");
        return;
    };
    for (kind, backend) in [("window", "window"), ("egl", "EGL surfaceless")] {
        let mut command = command(&["info", "--json", "--context", kind]);
        command.env("DISPLAY", server.display());
        let output = run(command);
        assert_eq!(output.code, 0, "{kind}: {}", output.stderr);
        let json: serde_json::Value = serde_json::from_str(&output.stdout).unwrap();
        assert_eq!(json["context"]["backend"], backend);
        assert_eq!(json["context"]["profile"], "core");
    }
    // The backends that `--context` does not name run in a copy of this test, which has the display in its environment.
    let exe = std::env::current_exe().unwrap();
    let mut command = Command::new(exe);
    command.args(["--exact", "backends_of_a_display", "--ignored", "--nocapture"]).env("DISPLAY", server.display());
    let output = run(command);
    assert_eq!(output.code, 0, "{}{}", output.stdout, output.stderr);
    assert!(output.stdout.contains("1 passed"), "{}", output.stdout);
}

/// Run by `window_and_pbuffer_draw_under_xvfb`.
#[test]
#[ignore = "needs a display; another test gives it one"]
fn backends_of_a_display() {
    check_backend(Backend::EglPbuffer, "EGL pbuffer");
    check_backend(Backend::Window, "window");
    let first = context::open_backend(Backend::Window, &CORE).unwrap();
    let second = context::open_backend(Backend::Window, &COMPATIBILITY).unwrap();
    first.make_current().unwrap();
    assert_eq!(cleared_pixel(&*first, [1.0; 4]), [255; 4]);
    drop(second);
    assert_eq!(cleared_pixel(&*first, [0.0; 4]), [0; 4]);
    // winit has one event loop a process: another thread is told, and does not hang.
    let other = std::thread::spawn(|| context::open_backend(Backend::Window, &CORE).map(|_| ()));
    assert!(matches!(other.join().unwrap(), Err(Error::NoContext(_))));
}

struct Output {
    code: i32,
    stdout: String,
    stderr: String,
}

fn glumbra(arguments: &[&str]) -> Output {
    run(command(arguments))
}

/// The command without a display, whatever this machine has.
fn command(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.args(arguments);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command
}

fn run(mut command: Command) -> Output {
    let output = command.output().unwrap();
    Output {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

#[test]
fn every_compatibility_context_has_the_fixed_function_pipeline() {
    let context = context::open(&COMPATIBILITY).unwrap();
    let fixed = Binding::load(&*context).unwrap();
    let mut plane = [0.0; 4];
    // SAFETY: the context is current. Texture generation keeps the plane times the inverse of the modelview.
    unsafe {
        fixed.MatrixMode(raw::MODELVIEW);
        fixed.LoadIdentity();
        fixed.Scaled(2.0, 4.0, 8.0);
        fixed.TexGendv(raw::S, raw::EYE_PLANE, [2.0, 4.0, 8.0, 0.5].as_ptr());
        fixed.LoadIdentity();
        fixed.GetTexGenfv(raw::S, raw::EYE_PLANE, plane.as_mut_ptr());
    }
    assert_eq!(plane, [1.0, 1.0, 1.0, 0.5]);
    Debug::new(&*context).check("texture generation").unwrap();
}

#[test]
fn a_core_context_has_no_fixed_function_pipeline_and_says_so() {
    let context = context::open(&CORE).unwrap();
    let error = Binding::load(&*context).err().unwrap();
    assert_eq!(error, BindingError::Core { backend: context.backend().to_owned() });
}
