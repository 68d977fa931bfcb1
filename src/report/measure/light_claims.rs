//! Claims about projected light and about times, measured on a report's scene: that projecting an image costs no more than
//! texturing [Segal 1992, 4], that a copy of the depth buffer costs more than rendering to the texture [HSM, "How To Do
//! It"], and that percentage-closer filtering is no soft shadow [LEC, "Hardware Shadow Map Filtering"].

use std::sync::Arc;

use super::paired::{PairedTimes, paired};
use super::reference::{with_light, with_spot};
use super::sweeps::{FILTERING, POINTS};
use crate::frame::{self, Renderer};
use crate::geometry::{Material, ObjectLinear};
use crate::report::numbers::plain;
use crate::report::store::claimed::{ClaimVerdict, Claimed, Measurement};
use crate::report::store::swept::{LightSweep, PointErrors, SweepPoint};
use crate::scene::{self, ImageFilter, Object, Scene, with_shadow};
use crate::techniques::{self, LightShadow, vary};

/// Rounds of two scenes that are timed in turn.
const ROUNDS: usize = 15;

/// Measures the claims that the light has the keys for. `sweeps`: the scene's own.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn measure(
    scene: &Scene,
    light: usize,
    sweeps: &[LightSweep],
    renderer: &mut Renderer,
) -> Result<Vec<Claimed>, frame::Error> {
    let mut claimed = Vec::new();
    if let Some(pair) = projected_and_textured(scene, light) {
        let times = paired([&pair[0], &pair[1]], false, ROUNDS, renderer)?;
        claimed.push(projecting(&times));
    }
    if let Some(pair) = copied_and_rendered(scene, light) {
        let times = paired([&pair[0], &pair[1]], true, ROUNDS, renderer)?;
        claimed.push(copying(&times));
    }
    claimed.extend(sweeps.iter().flat_map(filtering));
    Ok(claimed)
}

/// Tests whether light comes through a lens. The shade of its middle, on which techniques' claims are judged, is not what the
/// picture shows then.
pub fn has_lens(scene: &Scene, light: usize) -> bool {
    scene.lights.get(light).and_then(|light| light.spot()?.lens()).is_some()
}

const TIME: &str = "time of a frame, ms";

/// Greatest end of a ratio's range at which the first time is no more than the second, unless all of it is above 1.
const NO_MORE: f64 = 1.1;

/// Tests whether the first time is more than the second: all of the ratio's range is above 1. `None`: the range begins
/// at 1 or below and ends above [`NO_MORE`].
pub(super) fn is_more(times: &PairedTimes) -> Option<bool> {
    let [least, greatest] = times.ratio_range;
    match (least > 1.0, greatest <= NO_MORE) {
        (true, _) => Some(true),
        (false, true) => Some(false),
        (false, false) => None,
    }
}

fn measured(settings: &str, value: f64) -> Measurement {
    Measurement { settings: settings.to_owned(), value: Some(value), why: None }
}

fn projecting(times: &PairedTimes) -> Claimed {
    let verdict = match is_more(times) {
        Some(true) => ClaimVerdict::FailsHere,
        Some(false) => ClaimVerdict::Holds,
        None => ClaimVerdict::Unknown,
    };
    Claimed {
        technique: String::from("projected image"),
        source: String::from("Segal 1992, 4"),
        says: String::from("projecting an image costs no more than texturing a surface with it"),
        quantity: String::from(TIME),
        first: measured("image of the light, filter = \"trilinear\", no decal, no shadow", times.first_ms),
        relation: String::from("at most 1 ×"),
        second: measured("the same image as every surface's decal, no image of the light, no shadow", times.second_ms),
        ratio_range: Some(times.ratio_range),
        verdict,
    }
}

/// The light's image projected, and the same image on every surface. All else is the same: material, light, shape, filter.
fn projected_and_textured(scene: &Scene, light: usize) -> Option<[Scene; 2]> {
    let image = scene.lights.get(light)?.spot()?.image.clone()?;
    let plain = with_light(scene, light, |light| {
        light.dust = None;
        light.shadow = techniques::unshadowed();
    });
    let plain = with_spot(&plain, light, |spot| {
        (spot.image, spot.beam, spot.falloff, spot.focus) = (None, None, None, None);
        // The filter of decals.
        spot.image_filter = ImageFilter::Trilinear;
    });
    let with_decal = |decal: bool| {
        let mut scene = plain.clone();
        for object in &mut scene.objects {
            object.material = Some(Arc::new(material(object, decal.then(|| image.clone()))));
        }
        scene
    };
    let projected = with_spot(&with_decal(false), light, |spot| spot.image = Some(image.clone()));
    Some([projected, with_decal(true)])
}

/// The object's material with another decal, once over the object in two of its axes.
fn material(object: &Object, decal: Option<Arc<crate::geometry::Texture>>) -> Material {
    let own = object.material.as_deref().or(object.mesh.materials.first());
    let size = (object.mesh.bounds.max - object.mesh.bounds.min).as_vec3();
    let per_side = |length: f32| if length > 0.0 && length.is_finite() { 1.0 / length } else { 1.0 };
    let texgen = ObjectLinear {
        s: [per_side(size.x), 0.0, 0.5 * per_side(size.z), 0.0],
        t: [0.0, per_side(size.y), 0.5 * per_side(size.z), 0.0],
        scale: 1.0,
    };
    Material { decal, alpha: None, opacity: 1.0, texgen: Some(texgen), ..own.cloned().unwrap_or_default() }
}

fn copying(times: &PairedTimes) -> Claimed {
    let verdict = match is_more(times) {
        Some(true) => ClaimVerdict::Holds,
        Some(false) => ClaimVerdict::FailsHere,
        None => ClaimVerdict::Unknown,
    };
    Claimed {
        technique: String::from("shadow-map"),
        source: String::from("Hardware Shadow Mapping"),
        says: String::from("a copy of the depth buffer into the map costs more than rendering into the map"),
        quantity: String::from(TIME),
        first: measured("transfer = \"copy\"", times.first_ms),
        relation: String::from("more than"),
        second: measured("transfer = \"fbo\"", times.second_ms),
        ratio_range: Some(times.ratio_range),
        verdict,
    }
}

/// The scene with its map copied, and with its map rendered to; `None`: the technique has no such choice.
fn copied_and_rendered(scene: &Scene, light: usize) -> Option<[Scene; 2]> {
    let source = scene.lights.get(light)?;
    let read = LightShadow::of(&source.shadow)?;
    if !techniques::keys(read.technique).contains(&"transfer") || has_lens(scene, light) {
        return None;
    }
    // What both share would hide the difference.
    let clear = with_light(scene, light, |light| light.dust = None);
    let by = |transfer: &str| {
        let inside = format!("technique = \"{}\", transfer = \"{transfer}\"", read.technique.name());
        let table = vary::over(source.shadow.written(), &scene::shadow_settings(&inside).ok()?);
        let shadow = techniques::read(table, &source.kind, &scene.objects).ok()?;
        Some(with_shadow(&clear, light, &shadow))
    };
    Some([by("copy")?, by("fbo")?])
}

/// Claims on percentage-closer filtering, from the sweep that has both its kernels and lens points.
fn filtering(sweep: &LightSweep) -> Vec<Claimed> {
    let points = |name: &str| {
        let series = sweep.series.iter().find(|series| series.name == name);
        series.map_or(&[][..], |series| &series.points)
    };
    let drawn = |point: &'_ SweepPoint| point.measured().map(|errors| (point.setting.clone(), *errors));
    let kernels: Vec<_> = points(FILTERING).iter().filter_map(drawn).collect();
    let lens: Vec<_> = points(POINTS).iter().filter_map(drawn).collect();
    let best = kernels.iter().min_by(|a, b| a.1.errors.rmse_codes.total_cmp(&b.1.errors.rmse_codes));
    let Some((kernel, best)) = best else { return Vec::new() };
    let claim = |says: &str, settings: String, rmse: f64| Claimed {
        technique: String::from("percentage-closer filtering"),
        source: String::from("LEC, \"Hardware Shadow Map Filtering\""),
        says: says.to_owned(),
        quantity: String::from("RMSE against the area light, codes of 1/255"),
        first: measured(
            &format!("the best of {} kernels: {kernel}, {} ms", kernels.len(), plain(best.frame.least)),
            best.errors.rmse_codes,
        ),
        relation: String::from("more than"),
        second: measured(&settings, rmse),
        ratio_range: None,
        verdict: if best.errors.rmse_codes > rmse { ClaimVerdict::Holds } else { ClaimVerdict::Fails },
    };
    let mut claims = Vec::new();
    if let Some((settings, rmse)) = at_time(&lens, best.frame.least) {
        claims.push(claim("is no soft shadow: in equal time lens points come nearer to one", settings, rmse));
    }
    if let Some((setting, errors)) = lens.iter().find(|(setting, _)| setting.ends_with("= 16")) {
        let settings = format!("{setting}, {} ms", plain(errors.frame.least));
        claims.push(claim(
            "is no soft shadow: no kernel comes as near to one as 16 lens points",
            settings,
            errors.errors.rmse_codes,
        ));
    }
    claims
}

/// The error of as many lens points as take `milliseconds`, by a power law between two that were drawn; that of the fewest,
/// if those take longer.
fn at_time(lens: &[(String, PointErrors)], milliseconds: f64) -> Option<(String, f64)> {
    let (first, last) = (lens.first()?, lens.last()?);
    let at = |(setting, errors): &(String, PointErrors)| {
        (format!("{setting}, {} ms", plain(errors.frame.least)), errors.errors.rmse_codes)
    };
    if milliseconds <= first.1.frame.least {
        return Some(at(first));
    }
    let between = lens.windows(2).find(|pair| (pair[0].1.frame.least..=pair[1].1.frame.least).contains(&milliseconds));
    let Some([(a, from), (b, to)]) = between else { return Some(at(last)) };
    let part = (milliseconds / from.frame.least).ln() / (to.frame.least / from.frame.least).ln();
    let [low, high] = [from, to].map(|errors| errors.errors.rmse_codes.max(1e-9).ln());
    let rmse = (low + part.clamp(0.0, 1.0) * (high - low)).exp();
    Some((format!("between {a} and {b}, at {} ms", plain(milliseconds)), rmse))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::samples;

    #[test]
    fn a_time_is_more_only_if_all_of_its_range_is() {
        let times = |range| PairedTimes { first_ms: 1.0, second_ms: 1.0, ratio_range: range };
        for (range, expected) in [
            ([1.02, 1.3], Some(true)),
            ([1.01, 1.05], Some(true)),
            ([0.9, 1.05], Some(false)),
            ([0.7, 0.8], Some(false)),
            ([0.7, 1.8], None),
        ] {
            assert_eq!(is_more(&times(range)), expected, "{range:?}");
        }
        assert_eq!(projecting(&times([1.2, 1.3])).verdict, ClaimVerdict::FailsHere);
        assert_eq!(projecting(&times([0.9, 1.0])).verdict, ClaimVerdict::Holds);
        assert_eq!(copying(&times([1.2, 1.3])).verdict, ClaimVerdict::Holds);
        assert_eq!(copying(&times([0.9, 1.0])).verdict, ClaimVerdict::FailsHere);
        assert_eq!(copying(&times([0.9, 2.0])).verdict, ClaimVerdict::Unknown);
    }

    /// The sample's errors are 8 / √n codes in 1.9 n milliseconds: a power law, which the time between two points follows.
    #[test]
    fn errors_at_a_time_lie_on_the_law() {
        let scene = samples::projected_scene("a.toml", "f");
        let drawn = |point: &SweepPoint| point.measured().map(|errors| (point.setting.clone(), *errors));
        let lens: Vec<_> = scene.sweeps[0].series[0].points.iter().filter_map(drawn).collect();
        for count in [1.0, 2.0, 4.0, 9.0, 64.0_f64] {
            let (settings, rmse) = at_time(&lens, 1.9 * count).unwrap();
            assert!((rmse - 8.0 / count.sqrt()).abs() < 1e-9, "{settings}: {rmse}");
        }
        assert_eq!(at_time(&lens, 0.1).unwrap().1, 8.0, "faster than the fewest points");
        assert_eq!(at_time(&lens, 1e6).unwrap().1, 1.0, "slower than the most that were drawn");
        assert_eq!(at_time(&[], 1.0), None);
    }
}
