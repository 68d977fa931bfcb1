//! Shadow volumes on one core without GL: adjacency, outline, extrusion, near caps, in milliseconds and triangles a
//! millisecond. `cargo bench --bench floor -- --volumes [--model OBJ]`.

use std::hint::black_box;
use std::time::Instant;

use glam::{DMat4, DVec3};
use glumbra::geometry::volume::{CappedVolume, Caps, Caster, Extent, LightSource, Outline, Volume};

use super::child::model_file;
use super::{Arguments, Result};

/// Prints a row for each step; each is run warm, with buffers that are large enough, from as many places of the light as
/// there are repeats, so that no branch is learnt by heart.
pub fn run(arguments: &Arguments) -> Result<()> {
    let (mesh, _) = glumbra::geometry::load_obj(&model_file(arguments))?;
    let repeats = if arguments.quick { 20 } else { 200 };
    let count = mesh.triangle_count();
    let row = |step: &str, mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        let median = times[times.len() / 2];
        println!("{step:<32} {median:9.3} ms (least {:.3}) {:12.0} triangles/ms", times[0], count as f64 / median);
    };
    let caster = Caster::of_mesh(&mesh);
    println!("{}: {count} triangles, {} edges, closed: {}", mesh.name, caster.edge_count(), caster.is_closed());
    row("adjacency", (0..5).map(|_| time(|| drop(black_box(Caster::of_mesh(&mesh))))).collect());

    let center = mesh.bounds.center();
    let light = |k: usize| center + DMat4::from_rotation_y(0.1 * k as f64).transform_vector3(DVec3::new(2.0, 3.4, 3.0));
    let sources =
        |k: usize| if k.is_multiple_of(2) { LightSource::Point(light(k)) } else { LightSource::Direction(light(k)) };
    let mut outline = Outline::default();
    let mut edges = 0;
    let mut exact = 0;
    let find = |k: usize, outline: &mut Outline| outline.find(&caster, sources(k));
    (0..5).for_each(|k| find(k, &mut outline));
    let times = (0..repeats).map(|k| {
        let time = time(|| find(k, &mut outline));
        (edges, exact) = (edges + outline.edges().len(), exact + outline.exact_tests());
        time
    });
    row("outline", times.collect());
    println!("  {} edges and {} exact tests an outline", edges / repeats, exact as f64 / repeats as f64);

    let mut volume = Volume::default();
    for (step, caps) in [("sides", Caps::NONE), ("sides and both caps", Caps::BOTH)] {
        let times = (0..repeats).map(|k| {
            find(k, &mut outline);
            time(|| volume.extrude(&caster, &outline, Extent::Infinite, caps))
        });
        row(step, times.collect());
    }
    let mut capped = CappedVolume::default();
    let view = glumbra::math::spaces::view_from_world(center + DVec3::new(-1.0, 0.4, -0.6), center, DVec3::Y);
    let times = (0..repeats).map(|k| {
        find(k, &mut outline);
        time(|| capped.cut(&caster, &outline, &view, 0.1))
    });
    row("sides and near cap", times.collect());
    Ok(())
}

/// In milliseconds.
fn time(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    1e3 * start.elapsed().as_secs_f64()
}
