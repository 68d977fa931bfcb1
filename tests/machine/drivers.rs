//! Backends of contexts that not every machine has.

use std::path::Path;
use std::process::Command;

use glumbra::context::{self, Backend, Choice, ContextRequest, Error, Profile};
use glumbra::device::debug::Debug;
use glumbra::device::queries::Timer;
use libtest_mimic::Completion;

use crate::contexts::{COMPATIBILITY, CORE, check_backend, cleared_pixel, command, run};
use crate::pipelines::{Pipelines, compare, load};
use crate::xvfb::Xvfb;
use crate::{Done, Test, tests};

/// Set for the copy of this program that has a display.
const BACKENDS_OF_A_DISPLAY: &str = "GLUMBRA_BACKENDS_OF_A_DISPLAY";

/// The tests; in the copy that has a display, the one that needs it.
pub fn tests() -> Vec<Test> {
    if std::env::var_os(BACKENDS_OF_A_DISPLAY).is_some() {
        return tests![backends_of_a_display].to_vec();
    }
    tests![
        osmesa_draws,
        osmesa_has_the_fixed_function_pipeline_too,
        timers_answer_in_order_and_once,
        egl_without_a_driver_names_its_error,
        window_and_pbuffer_draw_under_xvfb,
    ]
    .to_vec()
}

fn osmesa_draws() -> Done {
    match context::open_backend(Backend::OsMesa, &CORE) {
        // Mesa 25.1 dropped it; ci/setup installs it where there is one.
        Err(error) if error.to_string().contains("libOSMesa.so.8: cannot open shared object file") => {
            return Ok(Completion::ignored_with("this machine has no libOSMesa"));
        }
        _ => check_backend(Backend::OsMesa, "OSMesa"),
    }
    Ok(Completion::Completed)
}

fn osmesa_has_the_fixed_function_pipeline_too() -> Done {
    let request = ContextRequest { choice: Choice::OsMesa, profile: Profile::Compatibility, ..Default::default() };
    if context::open(&request).is_err() {
        return Ok(Completion::ignored_with("this machine has no libOSMesa"));
    }
    let scene = load(Path::new("data/scenes/hw_shadowmaps_simple.toml"), &["image.size=[256, 256]"]);
    assert_eq!(compare(&mut Pipelines::on(Choice::OsMesa), &scene, "OSMesa"), Ok(true));
    Ok(Completion::Completed)
}

fn timers_answer_in_order_and_once() -> Done {
    let context = context::open(&CORE).unwrap();
    let Some(mut timer) = Timer::new(&*context) else {
        return Ok(Completion::ignored_with("this driver has no timer queries"));
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
    Ok(Completion::Completed)
}

/// A driver that cannot be loaded is told by EGL's own code.
fn egl_without_a_driver_names_its_error() -> Done {
    let mut command = command(&["info", "--context", "egl"]);
    command.env("LIBGL_DRIVERS_PATH", "/nonexistent").env("GBM_BACKENDS_PATH", "/nonexistent");
    command.env("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent");
    let output = run(command);
    if output.code == 0 {
        return Ok(Completion::ignored_with("this libEGL finds its driver without libglvnd"));
    }
    assert_eq!(output.code, 1, "{}", output.stderr);
    assert!(!output.stderr.contains("panicked"), "{}", output.stderr);
    assert!(output.stderr.contains("EGL_"), "{}", output.stderr);
    Ok(Completion::Completed)
}

fn window_and_pbuffer_draw_under_xvfb() -> Done {
    let Some(server) = Xvfb::start() else {
        assert!(std::env::var_os("CI").is_none(), "ci/setup --test installs Xvfb");
        return Ok(Completion::ignored_with("this machine has no Xvfb"));
    };
    for (kind, backend) in [("window", "window"), ("egl", "EGL surfaceless")] {
        let mut command = command(&["info", "--json", "-", "--context", kind]);
        command.env("DISPLAY", server.display());
        let output = run(command);
        assert_eq!(output.code, 0, "{kind}: {}", output.stderr);
        let json: serde_json::Value = serde_json::from_str(&output.stdout).unwrap();
        assert_eq!(json["context"]["backend"], backend);
        assert_eq!(json["context"]["profile"], "core");
    }
    // The backends that `--context` does not name run in a copy of this program, which has the display in its environment.
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "backends_of_a_display", "--nocapture"]);
    command.env("DISPLAY", server.display()).env(BACKENDS_OF_A_DISPLAY, "1");
    let output = run(command);
    assert_eq!(output.code, 0, "{}{}", output.stdout, output.stderr);
    assert!(output.stdout.contains("1 passed"), "{}", output.stdout);
    Ok(Completion::Completed)
}

/// Run by `window_and_pbuffer_draw_under_xvfb`.
fn backends_of_a_display() -> Done {
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
    Ok(Completion::Completed)
}
