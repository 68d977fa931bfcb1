use glumbra::context::{self, ContextRequest, Profile};
use glumbra::device::{Measure, Pixels};
use glumbra::frame::Renderer;
use glumbra::oracle::fixed_function::FixedFunction;
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene;
use glumbra::techniques::views::View;
use glumbra::viewer::Mode;
use std::path::Path;

fn floats(p: &Pixels) -> Vec<f32> {
    match p {
        Pixels::Rgba8 { data, .. } => data.iter().map(|b| f32::from(*b) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } => data.clone(),
        Pixels::Depth { data, .. } => data.clone(),
    }
}
fn stat(name: &str, a: &Pixels, b: &Pixels) {
    let (a, b) = (floats(a), floats(b));
    let n = a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a != b).count();
    let n255 = a
        .chunks(4)
        .zip(b.chunks(4))
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a.min(1.0) - b.min(1.0)).abs() > 1.001 / 255.0))
        .count();
    let max = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let sum: f32 = b.iter().sum();
    print!(" | {name}: {n}/{n255} {max:.6}{}", if sum == 0.0 { " EMPTY" } else { "" });
}

#[test]
fn explore() {
    let request = ContextRequest { profile: Profile::Compatibility, debug: true, ..Default::default() };
    let context = context::open(&request).unwrap();
    println!("{:?}", context.describe().version);
    let mut renderer = Renderer::new(&*context);
    let mut fixed = FixedFunction::new(&*context).unwrap();
    let scenes: Vec<String> = std::env::var("FF")
        .unwrap_or("data/scenes/hw_shadowmaps_simple.toml".into())
        .split(';')
        .map(str::to_owned)
        .collect();
    for entry in scenes {
        let mut words = entry.split_whitespace();
        let path = words.next().unwrap();
        let set: Vec<String> = words.map(str::to_owned).collect();
        println!("\n== {entry}");
        let Ok(loaded) = scene::load(Path::new(path), &set) else {
            println!("  does not load");
            continue;
        };
        for (mode, float) in
            [(Mode::Shadowed, false), (Mode::Shadowed, true), (Mode::Camera, true), (Mode::Light, true)]
        {
            let (scene, mut request) = mode.frame(&loaded.scene, loaded.scene.image.size);
            request.float_picture = float;
            if mode == Mode::Shadowed && std::env::var("NOVIEWS").is_err() {
                request.views = (0..scene.lights.len())
                    .flat_map(|light| [View::Shade, View::ProjectedMap].map(|view| ViewRequest { view, light }))
                    .collect();
            }
            let request = Request { ..request };
            let mut plan = match renderer.plan(&scene, &request) {
                Ok(plan) => plan,
                Err(e) => {
                    println!("  no plan {e}");
                    continue;
                }
            };
            let bad = fixed.inexpressible(&plan.list);
            if !bad.is_empty() {
                println!("  {mode:?}: {bad:#?}");
                continue;
            }
            fixed.run(&plan.list).unwrap();
            let ff: Vec<Pixels> = [plan.picture]
                .into_iter()
                .chain(plan.views.iter().map(|v| v.1))
                .map(|id| fixed.read(&plan.list, id).unwrap())
                .collect();
            if let Ok(dir) = std::env::var("FFOUT") {
                let name =
                    format!("{dir}/{}-{mode:?}-{float}.png", Path::new(path).file_stem().unwrap().to_string_lossy());
                glumbra::output::write_all(&[glumbra::output::Output {
                    path: Path::new(&name),
                    pixels: &ff[0],
                    view: None,
                }])
                .unwrap();
            }
            for arithmetic in [false, true] {
                if arithmetic {
                    plan.list = fixed.in_driver_arithmetic(&plan.list);
                }
                renderer.device().forget();
                renderer.device().run(&plan.list, Measure::No).unwrap();
                let frame = renderer.read(&plan).unwrap();
                print!(
                    "\n {mode:?} {} {}",
                    if float { "float" } else { "8bit" },
                    if arithmetic { "driver" } else { "own" }
                );
                stat("picture", &frame.picture, &ff[0]);
                for ((what, _), (a, b)) in plan.views.iter().zip(frame.views.iter().zip(&ff[1..])) {
                    stat(&format!("{}@{}", what.view.name(), what.light), a, b);
                }
            }
        }
    }
}
