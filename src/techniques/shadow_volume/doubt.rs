//! Warnings of counts that cannot be right. Visible points are sampled, and the count by these settings is compared with a
//! ray to the light.

use glam::DVec2;
use rayon::prelude::*;

use super::casters::CastingObject;
use super::choice::CountMethod;
use super::layers;
use super::points::{CountedPoint, CountedWorld};
use super::settings::{Method, Settings};
use super::shapes;
use crate::lights::{Drawable, LightView, Notes};

/// Rays of the camera: one a pixel up to 160 x 120, and as many of a larger picture.
const MOST_SAMPLES: u32 = 20_000;

/// Number of layers that a stencil count can distinguish.
const LAYERS: u32 = 256;

/// Reason why a sample is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Fault {
    Hole,
    NearInVolume,
    EvenCount,
    Ended,
    TooMany,
}

/// Warns if a sample finds wrong pixels, with the reason. Nothing is sampled if nothing can be wrong.
pub fn warn(
    view: &LightView<'_>,
    casting: &[CastingObject],
    ways: &[CountMethod],
    settings: &Settings,
    notes: &mut Notes,
) {
    let drawn: Vec<&CastingObject> =
        casting.iter().zip(ways).filter(|(_, way)| **way != CountMethod::LeftOut).map(|(caster, _)| caster).collect();
    warn_of_reach(view, casting, ways, notes);
    if !may_be_wrong(view, &drawn, settings.method) {
        return;
    }
    let ends = settings.method == Method::ZFailTruncated;
    let world_distance = if ends { shapes::distance(view, settings) } else { 0.0 };
    let distance = |caster: &CastingObject| shapes::model_distance(caster, world_distance);
    let world = CountedWorld::new(view, &drawn, if ends { Some(&distance) } else { None });
    let [width, height] = view.scene.image.size;
    let step = (f64::from(width) * f64::from(height) / f64::from(MOST_SAMPLES)).sqrt().max(1.0);
    let [across, down] = [width, height].map(|size| (f64::from(size) / step).ceil() as u32);
    let samples = (0..across * down).into_par_iter().filter_map(|index| {
        let place = (DVec2::new(f64::from(index % across), f64::from(index / across)) + 0.5) * step;
        let point = world.at(place)?;
        if settings.wrap && may_wrap(&point) {
            return Some((Fault::TooMany, point));
        }
        let fault = fault(&point, settings)?;
        // The points that GL may show there instead must be wrong too.
        let aside = [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)].map(|way| point.aside * way);
        let is_sure = aside.into_iter().flat_map(|by| [by, -by]).all(|by| {
            let beside = world.at(place + by);
            beside.is_some_and(|beside| {
                // The point is dark on both sides of another volume's edge, and parity lights one of them.
                let is_dark = point.is_shadowed && beside.is_shadowed;
                self::fault(&beside, settings).is_some() || (settings.method == Method::Parity && is_dark)
            })
        });
        is_sure.then_some((fault, point))
    });
    let wrong: Vec<(Fault, CountedPoint)> = samples.collect();
    for fault in [Fault::Hole, Fault::NearInVolume, Fault::EvenCount, Fault::Ended, Fault::TooMany] {
        let points: Vec<CountedPoint> =
            wrong.iter().filter(|(own, _)| *own == fault).map(|(_, point)| *point).collect();
        if !points.is_empty() {
            let what = describe(fault, &points, &drawn, settings, view);
            let share = format!("{} of {} sampled pixels are wrong", points.len(), across * down);
            notes.warnings.push(format!("light {}: {what}; {share}", view.index));
        }
    }
}

/// Share of a pixel by which rounding may move a volume's edge without changing pixels.
const MOST_MOVED: f64 = 0.2;

/// The same share for surfaces that must not be cut, because caps meet them, and for every shadow on them: many edges, each
/// of which may change a pixel.
const MOST_MOVED_WHOLE: f64 = 1.0 / 64.0;

/// Warns of casters so large that GL's clipping in f32 moves their visible parts by a part of a pixel: volumes meet their
/// casters' vertices, so that these cannot be cut before. With per-vertex lighting no item is cut.
fn warn_of_reach(view: &LightView<'_>, casting: &[CastingObject], ways: &[CountMethod], notes: &mut Notes) {
    let camera = &view.scene.camera;
    let most_moved = |item: &Drawable| {
        // Casters come in the order of the objects.
        let place = casting.binary_search_by_key(&item.object, |caster| caster.object);
        let way = place.ok().and_then(|place| ways.get(place)).copied();
        match way {
            _ if view.scene.shading.per_vertex => Some(MOST_MOVED_WHOLE),
            Some(CountMethod::ZFail | CountMethod::ZFailClamped | CountMethod::ZFailTruncated) => {
                Some(MOST_MOVED_WHOLE)
            }
            None | Some(CountMethod::LeftOut) => None,
            Some(_) => Some(MOST_MOVED),
        }
    };
    let height = 2.0 * (0.5 * camera.fov_y_radians).tan() * camera.target.distance(camera.eye);
    let pixel = height / f64::from(view.scene.image.size[1]);
    // Two roundings of 2^-24: one of the corner, one of the vertex that clipping makes.
    let moved = |reach: f64| reach * 2.0_f64.powi(-23) / pixel;
    let reaches = view.items.iter().filter_map(|item| {
        let corners = item.bounds.corners().map(|corner| item.world_from_model.transform_point3(corner));
        let reach = corners.iter().map(|corner| corner.distance(camera.eye)).fold(0.0, f64::max);
        most_moved(item).filter(|most| moved(reach) > *most).map(|_| reach)
    });
    let Some(farthest) = reaches.max_by(f64::total_cmp) else { return };
    notes.warnings.push(format!(
        "light {}: surfaces reach {farthest:.3e} units away, where f32 rounds by {:.2} pixels: edges of shadow volumes are \
         as far off",
        view.index,
        moved(farthest)
    ));
}

fn may_be_wrong(view: &LightView<'_>, drawn: &[&CastingObject], method: Method) -> bool {
    let is_partial = matches!(method, Method::Parity | Method::ZPass | Method::ZPassTwoSided | Method::ZFailTruncated);
    let most = LAYERS as usize;
    is_partial
        || drawn.iter().any(|caster| caster.has_holes)
        || (layers::in_all(drawn) >= most && layers::on_a_ray(view, drawn) >= most)
}

/// Tests whether the count may be a multiple of 256, which looks like none. The point is then surely in shadow.
fn may_wrap(point: &CountedPoint) -> bool {
    let most = point.within + point.doubtful;
    most >= LAYERS && most / LAYERS > point.within.saturating_sub(1) / LAYERS
}

/// Reason why a pixel is wrong; `None`: it is right, or the depth buffer's rounding decides.
fn fault(point: &CountedPoint, settings: &Settings) -> Option<Fault> {
    if point.doubtful > 0 {
        return None;
    }
    let within = match settings.method {
        Method::ZFailTruncated => point.within_ended,
        _ => point.within,
    };
    let before = match settings.method {
        Method::Parity | Method::ZPass | Method::ZPassTwoSided => point.before,
        _ => 0,
    };
    let through_holes = match settings.method {
        Method::Parity | Method::ZPass | Method::ZPassTwoSided | Method::ZPassCapped => point.through_holes,
        _ => 0,
    };
    let count = i64::from(within) - i64::from(before) - i64::from(through_holes);
    let is_dark = match (settings.method, settings.wrap) {
        (Method::Parity, _) => count % 2 != 0,
        (_, true) => count % i64::from(LAYERS) != 0,
        (_, false) => count > 0,
    };
    (is_dark != point.is_shadowed).then_some(match () {
        () if (point.within > 0 && !point.is_shadowed) || through_holes != 0 => Fault::Hole,
        () if within != point.within && before == 0 => Fault::Ended,
        () if before > 0 => Fault::NearInVolume,
        () if settings.method == Method::Parity => Fault::EvenCount,
        () => Fault::TooMany,
    })
}

fn describe(
    fault: Fault,
    points: &[CountedPoint],
    drawn: &[&CastingObject],
    settings: &Settings,
    view: &LightView<'_>,
) -> String {
    let most = |of: fn(&CountedPoint) -> u32| points.iter().map(of).max().unwrap_or(0);
    match fault {
        Fault::Hole => {
            let mut names: Vec<&str> =
                drawn.iter().filter(|caster| caster.has_holes).map(|caster| caster.label.as_str()).collect();
            names.dedup();
            format!("{} has holes by the alpha test, and its shadow volume has none", names.join(", "))
        }
        Fault::NearInVolume => {
            format!(
                "the eye's near rectangle stands in up to {} shadow volumes, which `method` does not count",
                most(|point| point.before)
            )
        }
        Fault::EvenCount => {
            format!("what is seen lies in up to {} shadow volumes, and an even number of them is light", {
                most(|point| point.within)
            })
        }
        Fault::Ended => {
            let behind = points.iter().map(|point| point.behind).fold(0.0, f64::max);
            let distance = shapes::distance(view, settings);
            format!(
                "volumes that end after {distance:.3} units end before what they shadow, up to {behind:.3} behind its caster"
            )
        }
        Fault::TooMany => {
            format!(
                "what is seen lies in up to {} shadow volumes, and {LAYERS} of them count as none",
                most(|point| point.within)
            )
        }
    }
}
