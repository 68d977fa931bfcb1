//! Costs of a plan: the times of its frames and passes, and what their work is.

use std::fmt::Write;

use crate::device::{Measure, PassTime};
use crate::frame::{self, Renderer};
use crate::pass::{DrawState, ImageId, Pass, Work};
use crate::plan::Plan;
use crate::report::store::fingerprint;
use crate::report::store::results::PassCost;
use crate::report::store::spread::Spread;

/// Times of a plan's frames and passes.
pub(super) struct Costs {
    pub redrawn: Spread,
    pub kept: Spread,
    pub passes: Vec<PassCost>,
}

/// Runs below which passes are timed in one of them: they take as long as the frames that a report is read for.
const FEW_RUNS: usize = 4;

/// One frame to warm up, then each kind of frame `runs` times.
pub(super) fn costs(plan: &Plan, runs: usize, renderer: &mut Renderer) -> Result<Costs, frame::Error> {
    renderer.draw_timed(plan, 1, false, || ())?;
    let mut redrawn = Vec::new();
    let mut kept = Vec::new();
    let mut passes: Vec<Vec<PassTime>> = Vec::new();
    for run in 0..runs.max(1) {
        renderer.device().forget();
        redrawn.extend(renderer.draw_timed(plan, 1, false, || ())?.frames_ms);
        kept.extend(renderer.draw_timed(plan, 1, false, || ())?.frames_ms);
        if run > 0 && runs < FEW_RUNS {
            continue;
        }
        renderer.device().forget();
        passes.push(renderer.device().run(&plan.list, Measure::Passes)?);
    }
    renderer.device().forget();
    let counted = renderer.device().run(&plan.list, Measure::Fragments)?;
    let passes = plan.list.passes.iter().enumerate().map(|(index, pass)| {
        let walls: Vec<f64> = passes.iter().filter_map(|run| run.get(index)).map(|time| time.wall_ms).collect();
        let gpus: Vec<f64> = passes.iter().filter_map(|run| run.get(index)).filter_map(|time| time.gpu_ms).collect();
        PassCost {
            label: pass.label.clone(),
            wall: Spread::of(&walls),
            gpu: (!gpus.is_empty()).then(|| Spread::of(&gpus)),
            triangles: triangles(pass),
            fragments: counted.get(index).and_then(|count| count.fragments),
        }
    });
    Ok(Costs { redrawn: Spread::of(&redrawn), kept: Spread::of(&kept), passes: passes.collect() })
}

/// Times of frames with everything drawn, after one to warm up.
pub(super) fn redrawn(plan: &Plan, runs: usize, renderer: &mut Renderer) -> Result<Spread, frame::Error> {
    renderer.draw_timed(plan, 1, false, || ())?;
    let mut times = Vec::new();
    for _ in 0..runs.max(1) {
        renderer.device().forget();
        times.extend(renderer.draw_timed(plan, 1, false, || ())?.frames_ms);
    }
    Ok(Spread::of(&times))
}

fn triangles(pass: &Pass) -> u64 {
    match &pass.work {
        Work::Draw(draw) => draw.batches.iter().flat_map(|batch| &batch.draws).map(|draw| draw.primitive_count()).sum(),
        Work::CopyDepth { .. } => 0,
    }
}

/// A hash of the work of a frame's passes, without their polygon offsets and the values of uniforms: frames with the same
/// one should take the same time.
pub(super) fn work_of(plan: &Plan) -> String {
    let image = |id: ImageId| {
        let desc = plan.list.desc(id);
        (desc.size, desc.format)
    };
    let mut text = String::new();
    for pass in &plan.list.passes {
        // Writing to a string cannot fail.
        let _ = match &pass.work {
            Work::CopyDepth { from, to, .. } => writeln!(text, "copy {:?} {:?}", image(*from), image(*to)),
            Work::Draw(draw) => {
                let state = DrawState { polygon_offset: None, ..draw.state };
                let targets = draw.target.color.iter().chain(&draw.target.depth).map(|id| image(*id));
                let targets: Vec<_> = targets.collect();
                writeln!(text, "{:?} {:?} {:?} {targets:?} {state:?}", draw.viewport, draw.target.level, draw.clear)
            }
        };
        let Work::Draw(draw) = &pass.work else { continue };
        for batch in &draw.batches {
            let inputs: Vec<_> = batch.inputs.iter().map(|input| (image(input.image), &input.sampler)).collect();
            let draws: Vec<_> = batch.draws.iter().map(|draw| (&draw.indices, draw.order)).collect();
            let (cull, scissor) = (batch.cull, batch.scissor);
            let _ = writeln!(text, "{:?} {inputs:?} {cull:?} {scissor:?} {draws:?}", batch.program);
        }
    }
    fingerprint::of_text(&text)
}
