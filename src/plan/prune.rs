//! Leaves out of a pass list what its pictures do not show: draws outside a pass's clip volume, passes that nothing
//! reads, images that no pass uses. Then chooses the index order that pays.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::{Plan, Request};
use crate::compositions::focus;
use crate::lights::{Chosen, LeftOut};
use crate::math::frustum::{self, Overlap};
use crate::pass::{
    Channels, FilledImages, Format, ImageDesc, ImageId, IndexOrder, Pass, PassList, Primitive, Redraw, Storage, Work,
};

/// Prunes in place.
pub fn prune(plan: &mut Plan, request: &Request) {
    if request.keep_all {
        return keep_all(plan);
    }
    cull_draws(plan);
    drop_unread_passes(plan, request.views_only);
    drop_unused_images(plan);
    plan.left_out.retain(|left| !focus::repeats(&left.what));
    choose_index_order(plan, request.frames);
}

/// The opposite of pruning: every pass in every frame, and a colour buffer for each depth pass.
fn keep_all(plan: &mut Plan) {
    let PassList { images, passes, .. } = &mut plan.list;
    // One for all passes of a depth buffer: a light's lens points may be thousands.
    let mut colors: HashMap<(Option<ImageId>, [u32; 2]), ImageId> = HashMap::new();
    for pass in passes {
        pass.redraw = Redraw::Always;
        let Work::Draw(draw) = &mut pass.work else { continue };
        if draw.target.color.is_none() {
            let color = *colors.entry((draw.target.depth, draw.viewport)).or_insert_with(|| {
                images.push(ImageDesc {
                    label: format!("{}: colour", pass.label),
                    size: draw.viewport,
                    format: Format::Rgba8,
                    storage: Storage::Renderbuffer,
                });
                ImageId(images.len() - 1)
            });
            draw.target.color = Some(color);
            draw.clear.color = Some([0.0; 4]);
            draw.state.color_write = Channels::All;
        }
    }
    plan.left_out.clear();
}

/// Removes draws whose bounds lie beyond one of the pass's clip planes. With clamped depth only the sides count, unless a
/// clip distance is used in place of the near plane.
fn cull_draws(plan: &mut Plan) {
    let left_out = &mut plan.left_out;
    for pass in &mut plan.list.passes {
        let label = pass.label.clone();
        let Work::Draw(draw_pass) = &mut pass.work else { continue };
        let has_no_ends = draw_pass.state.depth_clamp && draw_pass.state.clip_distances == 0;
        for batch in &mut draw_pass.batches {
            // Depth passes leave faces out by a key of the scene.
            let culls = batch.cull.is_some() && draw_pass.state.color_write.any();
            batch.draws.retain(|draw| {
                let seen = match has_no_ends {
                    true => frustum::may_show_clamped(&draw.clip_from_model, &draw.bounds),
                    false => frustum::overlap(&draw.clip_from_model, &draw.bounds) != Overlap::Outside,
                };
                if !seen {
                    left_out.push(LeftOut {
                        what: format!("{} in \"{label}\"", draw.label),
                        why: String::from("outside the pass's frustum"),
                    });
                } else if culls {
                    left_out.push(LeftOut {
                        what: format!("back faces of {} in \"{label}\"", draw.label),
                        why: String::from("it is closed and seen from outside"),
                    });
                }
                seen
            });
        }
        draw_pass.batches.retain(|batch| !batch.draws.is_empty());
    }
}

/// Removes passes whose images are neither read later nor requested, last first.
fn drop_unread_passes(plan: &mut Plan, views_only: bool) {
    let mut needed: HashSet<ImageId> = plan.views.iter().map(|(_, image)| *image).collect();
    needed.extend((!views_only).then_some(plan.picture));
    let mut kept: Vec<Pass> = Vec::new();
    for pass in std::mem::take(&mut plan.list.passes).into_iter().rev() {
        if pass.writes().iter().any(|image| needed.contains(image)) {
            needed.extend(pass.reads());
            kept.push(pass);
        } else {
            plan.left_out.push(LeftOut {
                what: format!("pass \"{}\"", pass.label),
                why: String::from("nothing reads what it draws"),
            });
        }
    }
    kept.reverse();
    plan.list.passes = kept;
}

/// Removes images that no pass uses, and renumbers the rest.
pub(super) fn drop_unused_images(plan: &mut Plan) {
    let mut used: HashSet<ImageId> = plan.views.iter().map(|(_, image)| *image).collect();
    used.insert(plan.picture);
    used.extend(plan.list.passes.iter().flat_map(|pass| pass.reads().into_iter().chain(pass.writes())));
    let mut renumbered = HashMap::new();
    let mut kept = Vec::new();
    for (old, desc) in std::mem::take(&mut plan.list.images).into_iter().enumerate() {
        if used.contains(&ImageId(old)) {
            renumbered.insert(ImageId(old), ImageId(kept.len()));
            kept.push(desc);
        }
    }
    plan.list.images = kept;
    plan.list.filled = FilledImages::default();
    let new = |id: &mut ImageId| *id = renumbered.get(id).copied().unwrap_or(*id);
    new(&mut plan.picture);
    plan.views.iter_mut().for_each(|(_, image)| new(image));
    plan.list.passes.iter_mut().flat_map(Pass::images_mut).for_each(new);
}

/// Sorting a scattered mesh for the vertex cache costs about as much as drawing it this many times; each draw then saves
/// about a quarter (`ci/bench --model` prints both). A mesh whose file has it well ordered gains nothing.
const DRAWS_THAT_PAY: u64 = 4;

/// True if meshoptimizer is compiled in.
const HAS_ORDER: bool = cfg!(feature = "meshopt");

/// Draws each mesh in cache order where it is drawn often enough to pay for the sorting.
fn choose_index_order(plan: &mut Plan, frames: u32) {
    let mut draws: HashMap<*const crate::geometry::Mesh, u64> = HashMap::new();
    let mut sorted: HashMap<*const crate::geometry::Mesh, bool> = HashMap::new();
    let mut unsorted = BTreeSet::new();
    for_each_draw(
        plan,
        |pass_frames, draw| {
            *draws.entry(std::sync::Arc::as_ptr(&draw.mesh.0)).or_default() += pass_frames;
        },
        frames,
    );
    for_each_draw(
        plan,
        |_, draw| {
            let mesh = std::sync::Arc::as_ptr(&draw.mesh.0);
            let count = draws.get(&mesh).copied().unwrap_or(0);
            let pays = || count >= DRAWS_THAT_PAY && draw.mesh.triangle_count() >= 256 && draw.mesh.is_scattered();
            let sorted = draw.primitive == Primitive::Triangles && *sorted.entry(mesh).or_insert_with(pays);
            draw.order = if sorted && HAS_ORDER { IndexOrder::VertexCache } else { IndexOrder::File };
            if sorted && !HAS_ORDER {
                unsorted.insert(draw.mesh.name.clone());
            }
        },
        frames,
    );
    plan.chosen.extend(unsorted.into_iter().map(|mesh| Chosen {
        of: format!("triangles of {mesh}"),
        choice: String::from("the file's order"),
        why: String::from("an order for the vertex cache would be faster, and needs glumbra's cargo feature `meshopt`"),
    }));
}

/// Calls `visit` with the number of frames in which a draw is drawn.
fn for_each_draw(plan: &mut Plan, mut visit: impl FnMut(u64, &mut crate::pass::Draw), frames: u32) {
    for pass in &mut plan.list.passes {
        let drawn = if pass.redraw == Redraw::Always { u64::from(frames) } else { 1 };
        if let Work::Draw(draw_pass) = &mut pass.work {
            for draw in draw_pass.batches.iter_mut().flat_map(|batch| batch.draws.iter_mut()) {
                visit(drawn, draw);
            }
        }
    }
}
