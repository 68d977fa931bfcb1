//! Every backend of contexts, what is said when none can be had, and `glumbra info`.

use std::sync::{Arc, Barrier};

use glow::HasContext;
use glumbra::conformance::probe;
use glumbra::context::compatibility::{Binding, BindingError, raw};
use glumbra::context::{self, Backend, ContextRequest, egl};
use glumbra::device::debug::Debug;

use crate::support::contexts::{COMPATIBILITY, CORE, Output, check_backend, cleared_pixel, command, run};

fn glumbra(arguments: &[&str]) -> Output {
    run(command(arguments))
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
fn a_machine_without_drivers_is_told_about_every_backend() {
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
    let output = glumbra(&["info", "--json", "-", "--compatibility"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""));
    let json: serde_json::Value = serde_json::from_str(&output.stdout).unwrap();
    assert_eq!(json["context"]["profile"], "compatibility");
    assert!(json["context"]["limits"]["texture_size"].as_u64().unwrap() >= 1024);
    assert_eq!(json["depth_formats"].as_array().unwrap().len(), probe::FORMATS.len());
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

/// A scene with a shadow map, small.
fn small_scene() -> glumbra::scene::Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases/scenes/box.toml");
    glumbra::load(&path, &["image.size=[32, 32]".to_owned()]).unwrap().scene
}

#[test]
fn contexts_and_renderers_may_be_dropped_in_any_order() {
    use glumbra::frame::Renderer;
    let scene = small_scene();
    let open = || context::open(&ContextRequest::default()).unwrap();
    let draw = |renderer: &mut Renderer| {
        let plan = renderer.plan(&scene, &Default::default()).unwrap();
        renderer.draw(&plan).unwrap();
        format!("{:?}", renderer.read(&plan).unwrap().picture)
    };
    let picture = {
        let context = open();
        draw(&mut Renderer::new(&context))
    };
    // Each order of dropping two contexts (0, 1) and their renderers (2, 3): whichever is left still draws.
    for order in permutations(&[0, 1, 2, 3]) {
        let mut contexts = [(); 2].map(|()| None);
        let mut renderers = [(); 2].map(|()| None);
        for index in 0..2 {
            let context = open();
            renderers[index] = Some(Renderer::new(&context));
            contexts[index] = Some(context);
        }
        for dropped in &order {
            for renderer in renderers.iter_mut().flatten() {
                assert_eq!(draw(renderer), picture, "{order:?} at {dropped}");
            }
            match dropped {
                0 | 1 => contexts[*dropped] = None,
                _ => renderers[*dropped - 2] = None,
            }
        }
    }
}

fn permutations(of: &[usize]) -> Vec<Vec<usize>> {
    if of.is_empty() {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for (at, first) in of.iter().enumerate() {
        let rest: Vec<usize> = of.iter().enumerate().filter(|(index, _)| *index != at).map(|(_, one)| *one).collect();
        all.extend(permutations(&rest).into_iter().map(|rest| [vec![*first], rest].concat()));
    }
    all
}
