//! Wrong pixels against the angle between eye and light [HSM, "Advantages and Limitations", Figure 6: dueling frusta]: the
//! light goes over the top of what the camera looks at, from behind the eye to a place that faces it.

use glam::{DQuat, DVec3};

use super::{ClaimRequest, Number, Said, with_keys};
use crate::frame::{Renderer, draw_shade};
use crate::judge::metrics::{self, Band, FEWEST_COMPARED};
use crate::report::measure::fit::line;
use crate::report::numbers::plain;
use crate::report::store::claim_sweep::{ClaimPoint, ClaimSeries, ClaimSweep};
use crate::report::store::claimed::Claimed;
use crate::scene::{LightKind, Scene};
use crate::techniques::claims::Relation;
use crate::truth;

const SOURCE: &str = "HSM, Figure 6, dueling frusta";

const UNIT: &str = "wrong facing the light, in %";

/// Pixels of the longer side of each picture.
const SIDES: [u32; 2] = [160, 320];

/// Texels a side of the map: fewer than the picture has pixels, so that its sampling is what is seen.
const TEXELS: u32 = 256;

/// Measures every angle. `tick` is called with each.
pub(super) fn measure(
    request: &ClaimRequest<'_>,
    renderer: &mut Renderer,
    tick: &mut impl FnMut(&str),
) -> (Vec<Claimed>, Vec<ClaimSweep>) {
    let step = if request.quick { 45 } else { 15 };
    let angles: Vec<f64> = (0..=180).step_by(step).map(f64::from).collect();
    let mut at = |degrees: &f64| -> Number {
        tick(&format!("{degrees} degrees between eye and light"));
        at_angle(request, *degrees).and_then(|scene| wrong_percent(&scene, request, renderer))
    };
    let measured: Vec<Number> = angles.iter().map(&mut at).collect();
    let (claim, sweep) = of_angles(request, &angles, &measured);
    let sweeps = if sweep.series[0].pairs().is_empty() { Vec::new() } else { vec![sweep] };
    (vec![claim], sweeps)
}

/// The claim and its sweep.
fn of_angles(request: &ClaimRequest<'_>, angles: &[f64], measured: &[Number]) -> (Claimed, ClaimSweep) {
    let point = |(degrees, value): (&f64, &Number)| ClaimPoint {
        x: *degrees,
        measured: super::number((format!("{degrees}° between eye and light"), value.clone())),
    };
    let points: Vec<ClaimPoint> = angles.iter().zip(measured).map(point).collect();
    let mut series = ClaimSeries { name: String::from("shadow map"), points, fit: String::new() };
    let pairs = series.pairs();
    series.fit = statement(&pairs).unwrap_or_default();
    let mean = |is_in: fn(f64) -> bool| {
        let chosen: Vec<f64> = pairs.iter().filter(|pair| is_in(pair[0])).map(|pair| pair[1]).collect();
        match chosen.is_empty() {
            true => Err(series.points.iter().find_map(|point| point.measured.why.clone()).unwrap_or_default()),
            false => Ok(chosen.iter().sum::<f64>() / chosen.len() as f64),
        }
    };
    let said = Said {
        technique: "shadow-map",
        source: SOURCE,
        says: "is more wrong where eye and light look towards each other than where they look the same way",
        quantity: UNIT,
    };
    let claim = said.compare(
        Relation::Greater,
        (String::from("mean over the angles above 90°"), mean(|angle| angle > 90.0)),
        (String::from("mean over the angles up to 90°"), mean(|angle| angle <= 90.0)),
    );
    let sweep = ClaimSweep {
        name: String::from("dueling frusta"),
        source: SOURCE.to_owned(),
        says: format!(
            "The light keeps its distance from what the camera looks at and goes over its top, from behind the eye to a place \
             that faces it; map of {TEXELS} texels a side, pictures of {} pixels along the longer side",
            SIDES[usize::from(!request.quick)]
        ),
        x: String::from("angle between eye and light, in degrees"),
        is_even: true,
        y: UNIT.to_owned(),
        series: vec![series],
    };
    (claim, sweep)
}

/// The fit in words.
fn statement(pairs: &[[f64; 2]]) -> Option<String> {
    let fit = line(pairs)?;
    let [slope, least, greatest] = [fit.slope, fit.range[0], fit.range[1]].map(|slope| plain(90.0 * slope));
    let words = match (fit.range[0] > 0.0, fit.range[1] < 0.0) {
        (true, _) => "grows with the angle",
        (_, true) => "falls with the angle",
        _ => "neither grows nor falls beyond its scatter",
    };
    let count = pairs.len();
    Some(format!("{words}: by {slope} percentage points in 90°, 95 % range {least} to {greatest}, {count} angles"))
}

/// The scene with its light `degrees` away from the eye, seen from the point that the camera looks at.
fn at_angle(request: &ClaimRequest<'_>, degrees: f64) -> Result<Scene, String> {
    let keys =
        format!("technique = \"shadow-map\", size = {TEXELS}, filter = \"nearest\", kernel = 1, mipmaps = false");
    let mut scene = with_keys(request.scene, request.light, &keys)?;
    let camera = scene.camera.clone();
    scene.image.size = small(scene.image.size, request.quick);
    let light = scene.lights.get_mut(request.light).ok_or("there is no such light")?;
    let LightKind::Spot(spot) = &mut light.kind else {
        return Err(String::from("only a spotlight has a frustum that faces the eye"));
    };
    let to_eye = (camera.eye - camera.target).normalize();
    let (axis, up) = over_the_top(to_eye, camera.up);
    let turn = DQuat::from_axis_angle(axis, degrees.to_radians());
    let distance = spot.frustum.position.distance(spot.frustum.target);
    spot.frustum.target = camera.target;
    spot.frustum.position = camera.target + distance * (turn * to_eye);
    spot.frustum.up = turn * up;
    (spot.image, spot.beam) = (None, None);
    Ok(scene)
}

/// A picture's size with its longer side shortened to [`SIDES`].
pub(super) fn small(size: [u32; 2], quick: bool) -> [u32; 2] {
    let longer = size[0].max(size[1]).max(1);
    let side = SIDES[usize::from(!quick)].min(longer);
    size.map(|own| (own * side / longer).max(1))
}

/// The axis that turns the way to the eye over the top, and what is up for a light beside the eye.
fn over_the_top(to_eye: DVec3, up: DVec3) -> (DVec3, DVec3) {
    let axis = to_eye.cross(up).normalize();
    (axis, axis.cross(to_eye))
}

/// Wrong pixels facing the light.
fn wrong_percent(scene: &Scene, request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Number {
    // Lights at grazing angles leave many pixels undecided; those are not compared.
    let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
    let truth = truth::trace(scene, request.light, &options).map_err(|error| error.to_string())?;
    let shade = draw_shade(scene, request.light, renderer).map_err(|error| error.to_string())?;
    let band = Band { texels: 0.0, map_size: [TEXELS; 2] };
    let facing = metrics::compare(&truth, &shade, &band).map_err(|error| error.to_string())?.facing;
    match facing.compared < FEWEST_COMPARED {
        true => Err(format!("{} pixels of what is seen face the light: too few", facing.compared)),
        false => Ok(facing.wrong_percent),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An eye to the south, a little above: the light rises to the zenith and sinks to the north.
    #[test]
    fn the_light_goes_over_the_top() {
        let to_eye = DVec3::new(0.0, 0.5, 1.0).normalize();
        let (axis, up) = over_the_top(to_eye, DVec3::Y);
        let at = |degrees: f64| DQuat::from_axis_angle(axis, degrees.to_radians()) * to_eye;
        for degrees in [0.0, 30.0, 90.0, 180.0_f64] {
            let way = at(degrees);
            assert!((way.dot(to_eye) - degrees.to_radians().cos()).abs() < 1e-12 && way.x.abs() < 1e-12, "{way}");
        }
        assert!(at(63.4).y > 0.999 && at(120.0).z < -0.7 && at(120.0).y > 0.3, "{} {}", at(63.4), at(120.0));
        assert!(up.dot(to_eye).abs() < 1e-12 && up.y > 0.8);
    }

    #[test]
    fn the_fit_says_whether_it_grows() {
        let pairs = |slope: f64| [0.0, 45.0, 90.0, 135.0].map(|x| [x, 1.0 + slope * x]);
        assert!(statement(&pairs(0.02)).unwrap().starts_with("grows with the angle: by 1.8 percentage points in 90°"));
        assert!(statement(&pairs(-0.01)).unwrap().starts_with("falls with"));
        assert!(statement(&[[0.0, 1.0], [45.0, 4.0], [90.0, 1.0]]).unwrap().starts_with("neither"));
        assert_eq!(statement(&[[0.0, 1.0]]), None);
    }
}
