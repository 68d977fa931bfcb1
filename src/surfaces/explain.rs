//! Notes on the guards against back projection in one picture [LEC, "Careful about Back Projecting Shadow Maps"].

use super::guarded::plane;
use super::partition::partition;
use crate::geometry::Derived;
use crate::lights::guard::{Guard, LightPlane, Side};
use crate::lights::{Drawable, LightTerm, Notes, Viewer};
use crate::math::frustum::{self, Overlap};

/// Names that a sentence lists before it counts.
const MOST_NAMES: usize = 3;

/// Notes the guards that the items in `viewer`'s view need for each light, and what is left out for them.
pub fn explain_guards(items: &[Drawable], viewer: &Viewer, terms: &[&LightTerm], derived: &Derived, notes: &mut Notes) {
    let clip_from_world = viewer.clip_from_world();
    let seen = |item: &&Drawable| {
        frustum::overlap(&(clip_from_world * item.world_from_model), &item.bounds) != Overlap::Outside
    };
    let seen: Vec<&Drawable> = items.iter().filter(seen).collect();
    for term in terms {
        let Some(plane) = plane(term, viewer) else { continue };
        let on = |side| seen.iter().copied().filter(move |item| plane.side(item, viewer) == side).collect::<Vec<_>>();
        explain(term, &plane, viewer, [on(Side::Before), on(Side::Across), on(Side::Behind)], derived, notes);
    }
}

fn explain(
    term: &LightTerm,
    plane: &LightPlane,
    viewer: &Viewer,
    [before, across, behind]: [Vec<&Drawable>; 3],
    derived: &Derived,
    notes: &mut Notes,
) {
    let index = term.index;
    let of = format!("guard of light {index} against back projection");
    let leaves_out = matches!(term.guard, Guard::Auto | Guard::Cull | Guard::ClipPlane);
    for item in behind.iter().filter(|_| leaves_out) {
        notes.left_out(format!("light {index} on {}", item.label), "it lies behind the light");
    }
    let all = before.len() + across.len() + behind.len();
    let crossing = format!("{} of {all} items that are seen cross the light's plane: {}", across.len(), names(&across));
    match (term.guard, across.is_empty()) {
        (Guard::Auto, true) if behind.is_empty() => notes.chosen(of, "none", "nothing visible lies behind the light"),
        (Guard::Auto, true) => {
            let why =
                format!("{} of {all} items that are seen lie behind the light, none crosses its plane", behind.len());
            notes.chosen(of, "leave-out", why);
        }
        (Guard::Auto, false) => notes.chosen(of, "fragment", format!("{crossing}; the others need none")),
        (Guard::None, _) if !(across.is_empty() && behind.is_empty()) => {
            notes.warnings.push(format!("light {index} has guard = \"none\": surfaces behind it are lit by mistake"))
        }
        (Guard::ClipPlane, false) => notes.chosen(of, "clip-plane", format!("{crossing}; each is drawn once a side")),
        (Guard::Cull | Guard::SpotCutoff, false) => {
            let why = match triangles(&across, plane, viewer, derived) {
                Some([crossing, all]) => {
                    format!("{crossing} of {all} triangles of {} cross the light's plane", names(&across))
                }
                None => format!("{crossing}, and waves in the vertex stage"),
            };
            notes.chosen(of, format!("{}, fragment where triangles cross", term.guard.name()), why);
        }
        _ => {}
    }
}

/// Number of triangles of `items` that cross the plane, and of all; `None` if some are not known before they are drawn.
fn triangles(items: &[&Drawable], plane: &LightPlane, viewer: &Viewer, derived: &Derived) -> Option<[u32; 2]> {
    let mut sum = [0, 0];
    let count = |item: &Drawable| (item.indices.end - item.indices.start) / 3;
    for item in items {
        let [_, across, _] = partition(item, &plane.in_model(item, viewer), derived)?;
        sum[0] += across.as_ref().map_or(0, count);
        sum[1] += count(item);
    }
    Some(sum)
}

fn names(items: &[&Drawable]) -> String {
    let mut names: Vec<&str> = items.iter().map(|item| item.label.as_str()).collect();
    names.dedup();
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    let names = names.join(", ");
    if more > 0 { format!("{names} and {more} more") } else { names }
}
