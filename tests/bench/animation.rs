//! A key-framed model in motion, on one core without GL: positions and normals, tangent bases, silhouettes, in milliseconds a
//! frame. `cargo bench --bench floor -- --animation`.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use glam::{DMat4, DVec3};
use glumbra::geometry::md2::{Animation, Model, NormalSource, Pose};
use glumbra::geometry::tangents::{BasisFit, Tangents};
use glumbra::geometry::volume::{Caster, LightSource, Outline, PlaneBlend};

use super::{Arguments, Result};

/// Milliseconds a frame for bases and silhouettes of 800 triangles.
const WANTED: f64 = 0.1;

/// Prints a row for each step, then bases and silhouettes together against the time that is wanted.
pub fn run(arguments: &Arguments) -> Result<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/knight.md2");
    let (model, _) = Model::load(&path)?;
    let frames = if arguments.quick { 200 } else { 5000 };
    let mut animation = Animation::new(&model);
    let triangles = animation.mesh().triangle_count();
    println!("{}: {triangles} triangles, {frames} frames, each a twentieth of a key frame on", path.display());
    // A light around the model, so that no branch is learnt by heart.
    let light = |frame: usize| {
        let around = DMat4::from_rotation_y(0.05 * frame as f64);
        LightSource::Point(around.transform_vector3(DVec3::new(40.0, 13.3, 10.0)))
    };
    let pose = |frame: usize| {
        let at = frame as f64 / 20.0 % 15.0;
        let first = at.floor() as usize;
        Pose { frames: [first, first + 1], blend: at.fract() }
    };
    let row = |step: &str, work: &mut dyn FnMut(usize)| {
        (0..50).for_each(&mut *work);
        let mut times: Vec<f64> = (0..frames).map(|frame| time(|| work(frame))).collect();
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        times.sort_by(f64::total_cmp);
        let at = |share: usize| times[(times.len() * share / 100).min(times.len() - 1)];
        println!("{step:<58} {:8.4} ms (least {:.4}, 99 % {:.4}, mean {mean:.4})", at(50), times[0], at(99));
        at(50)
    };
    row("positions, normals, places", &mut |frame| animation.move_to(&pose(frame)));
    row("bases by key frames: orthogonal", &mut |_| {
        black_box(animation.tangents(BasisFit::Orthogonal));
    });
    row("silhouette, planes of key frames: exact", &mut |frame| {
        black_box(animation.outline(light(frame), PlaneBlend::Exact));
    });
    row("silhouette, planes of key frames: lerped", &mut |frame| {
        black_box(animation.outline(light(frame), PlaneBlend::Lerped));
    });
    let mut outline = Outline::default();
    let mut caster = animation.caster().clone();
    let positions = caster.positions().to_vec();
    row("silhouette, planes of the frame's positions", &mut |frame| {
        caster.move_to(|place| positions[place]);
        outline.find(&caster, light(frame));
    });
    let all = row("positions, bases and silhouette together", &mut |frame| {
        animation.move_to(&pose(frame));
        black_box(animation.tangents(BasisFit::Orthogonal));
        black_box(animation.outline(light(frame), PlaneBlend::Exact));
    });
    row("the same from the mesh alone: nothing precomputed", &mut |frame| {
        let mesh = model.mesh(&pose(frame), NormalSource::File);
        black_box(Tangents::of_skin(&mesh, BasisFit::Orthogonal));
        outline.find(&Caster::of_mesh(&mesh), light(frame));
    });
    let for_800 = all * 800.0 / triangles as f64;
    let verdict = if for_800 < WANTED { "less" } else { "NOT less" };
    println!("bases and silhouette of 800 triangles: {for_800:.4} ms a frame: {verdict} than {WANTED} ms");
    Ok(())
}

/// In milliseconds.
fn time(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    1e3 * start.elapsed().as_secs_f64()
}
