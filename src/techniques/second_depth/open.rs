//! What a map of far sides shows wrong, found by sampling: of points that the camera sees and the light may reach, what
//! lies on their way to the light is sorted into near and far sides. Says by name and share what goes wrong.
//!
//! - A point in shadow is lit where no far side lies before it: of what is open, wound both ways, or what the light stands
//!   in.
//! - A point in the light is dark where a far side lies at its own depth: its own, seen from behind, or that of a face
//!   given in both windings.

use glam::DVec3;

use super::samples::{Met, Placed, Seen, on_the_way, placed, seen, to_light};
use crate::techniques::projector::Rays;
use crate::techniques::shadow_map::bias;
use crate::techniques::shadow_map::settings::Settings;
use crate::techniques::{FrustumView, Item, Notes};

/// No more points than this are looked at, at the middles of pixels.
const MOST_SAMPLES: u32 = 20_000;

/// Lengths below this share of a point's coordinates and of its distance from the eye are none.
const SLACK: f64 = 1e-7;

/// Points that go wrong because of one item.
#[derive(Clone, Copy, Default)]
struct Wrong {
    lit: u32,
    dark: u32,
}

/// Warns of each of `casters` because of which seen points go wrong.
pub fn warn(view: &FrustumView<'_>, casters: &[&Item], settings: &Settings, notes: &mut Notes) {
    let items = placed(view, casters);
    let mut wrong = vec![Wrong::default(); items.len()];
    let mut reached = 0;
    let sampler = Sampler { view, items: &items, texel: bias::texel_at_one(&view.projector, settings), settings };
    for point in points(view, &items) {
        if !sampler.is_in_reach(&point) {
            continue;
        }
        reached += 1;
        match sampler.judge(&point) {
            Some(Verdict::Lit(item)) => wrong[item].lit += 1,
            Some(Verdict::Dark(item)) => wrong[item].dark += 1,
            None => {}
        }
    }
    let share = |count: u32| 100.0 * f64::from(count) / f64::from(reached.max(1));
    for (placed, wrong) in items.iter().zip(wrong) {
        let says = |count, what| {
            format!(
                "{} in the map of far sides of light {}: {what} {:.2} % of what the light reaches",
                placed.item.label,
                view.index,
                share(count)
            )
        };
        if wrong.lit > 0 {
            notes
                .warnings
                .push(format!("{} that it shadows: it has no far side there", says(wrong.lit, "lit by mistake are")));
        }
        if wrong.dark > 0 {
            notes.warnings.push(format!(
                "{}: a far side lies at the very depth of what is lit",
                says(wrong.dark, "dark by mistake are")
            ));
        }
    }
}

/// What goes wrong, and because of which item.
enum Verdict {
    Lit(usize),
    Dark(usize),
}

/// What the camera sees in the middles of pixels.
fn points<'a>(view: &'a FrustumView<'_>, items: &'a [Placed<'_>]) -> impl Iterator<Item = Seen> + 'a {
    let camera = &view.scene.camera;
    let [width, height] = view.scene.image.size;
    let world_from_clip = (camera.clip_from_view(view.scene.aspect()) * camera.view_from_world()).inverse();
    let step = (1..).find(|step| width.div_ceil(*step) * height.div_ceil(*step) <= MOST_SAMPLES).unwrap_or(1);
    let middles = move |size: u32| (step / 2..size).step_by(step as usize);
    middles(height).flat_map(move |y| middles(width).map(move |x| [x, y])).filter_map(move |[x, y]| {
        let [x, y] = [(x, width), (y, height)].map(|(at, size)| (2.0 * f64::from(at) + 1.0) / f64::from(size) - 1.0);
        let [near, far] = [-1.0, 1.0].map(|z| world_from_clip.project_point3(DVec3::new(x, y, z)));
        seen(items, camera.eye, near, far - near)
    })
}

struct Sampler<'a> {
    view: &'a FrustumView<'a>,
    items: &'a [Placed<'a>],
    /// The width of a texel at a distance of 1, or anywhere in parallel light.
    texel: f64,
    settings: &'a Settings,
}

impl Sampler<'_> {
    /// Whether the point faces the light and lies in its frustum.
    fn is_in_reach(&self, seen: &Seen) -> bool {
        let clip = self.view.clip_from_world() * seen.point.extend(1.0);
        let to_light = to_light(seen.point, &self.view.projector.rays);
        clip.w > 0.0 && clip.truncate().abs().max_element() <= clip.w && seen.normal.dot(to_light) > 0.0
    }

    fn texel_at(&self, point: DVec3) -> f64 {
        self.texel * (self.view.clip_from_world() * point.extend(1.0)).w
    }

    /// What goes wrong, if it does so all around the point as far as a lookup reaches.
    fn judge(&self, point: &Seen) -> Option<Verdict> {
        let rays = &self.view.projector.rays;
        let length = match rays {
            Rays::From { position, .. } => position.distance(point.point),
            Rays::Along(_) => 1.0,
        };
        let eye = point.point.distance(self.view.scene.camera.eye);
        let slack = SLACK * (point.point.abs().max_element() + eye) / length;
        let met = on_the_way(self.items, point, -slack, rays);
        let verdict = self.verdict(point, &met, slack)?;
        let reach = self.texel_at(point.point) * (bias::reach_texels(self.settings) + 1.0);
        let across = self.view.projector.light_from_world.transpose();
        let [x, y] = [across.x_axis, across.y_axis].map(|axis| axis.truncate());
        let signature = signature(&met, slack);
        let is_alike =
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                .into_iter()
                .all(|(right, up)| {
                    // In the seen triangle's plane, so that what lies at its depth stays there.
                    let moved = point.point + reach * (right * x + up * y);
                    let way = to_light(moved, rays);
                    let moved = moved + way * (point.normal.dot(point.point - moved) / point.normal.dot(way));
                    let there = on_the_way(self.items, &Seen { point: moved, ..*point }, -slack, rays);
                    self::signature(&there, slack) == signature
                });
        is_alike.then_some(verdict)
    }

    fn verdict(&self, point: &Seen, met: &[Met], slack: f64) -> Option<Verdict> {
        let is_here = |met: &Met| met.is_own || met.t.abs() <= slack;
        let in_map = |met: &Met| self.items[met.item].in_map;
        let before = met.iter().filter(|met| !is_here(met));
        let Some(first) = before.max_by(|a, b| a.t.total_cmp(&b.t)) else {
            return met
                .iter()
                .find(|met| is_here(met) && met.is_far_side && in_map(met) && met.item == point.item)
                .map(|met| Verdict::Dark(met.item));
        };
        // A far side at the point's own depth is before it in some texels and behind it in others.
        let is_kept = met.iter().any(|met| met.is_far_side && in_map(met) && !is_here(met));
        (!is_kept).then_some(Verdict::Lit(first.item))
    }
}

/// Which sides of which items are met, whatever their order.
fn signature(met: &[Met], slack: f64) -> Vec<(usize, bool, bool)> {
    let mut all: Vec<_> = met.iter().map(|met| (met.item, met.is_far_side, met.t.abs() <= slack)).collect();
    all.sort_unstable();
    all
}
