//! Shadow volumes: what inverting a bit saves against counting [GDC, "For Shadow Volumes With Intersecting Polygons"], what a
//! far plane moved away costs in depth precision, and what a near one cuts [GDC, "More Implications of Carmack's Reverse";
//! Everitt and Kilgard 2002].

use glam::{DMat4, DVec4};

use super::angle::small;
use super::{ClaimRequest, Number, Said, depths, with_keys};
use crate::device::{Measure, Pixels};
use crate::frame::{Renderer, ShadeImage};
use crate::judge::metrics::{self, Band, FEWEST_COMPARED};
use crate::pass::{ImageId, Pass, StencilOps, Work};
use crate::plan::{Plan, Request, ViewRequest};
use crate::report::measure::light_claims::is_more;
use crate::report::measure::paired::{PairedTimes, in_turn};
use crate::report::numbers::plain;
use crate::report::store::claim_sweep::{ClaimPoint, ClaimSeries, ClaimSweep};
use crate::report::store::claimed::{ClaimVerdict, Claimed};
use crate::scene::{Camera, Scene};
use crate::techniques::claims::Relation;
use crate::truth::{self, Truth};
use crate::views::View;

const COUNTING: &str = "GDC, \"For Shadow Volumes With Intersecting Polygons\"";
const FAR: &str = "GDC, \"More Implications of Carmack's Reverse\"";

const PARITY: &str = "technique = \"shadow-volume\", method = \"parity\"";
const TWO_DRAWS: &str = "technique = \"shadow-volume\", method = \"z-pass\"";
const INFINITE: &str = "technique = \"shadow-volume\", method = \"z-fail\"";

/// Wrong pixels, counted fragments and times of parity and of counting in two draws.
pub(super) fn counting(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Vec<Claimed> {
    let scenes = [PARITY, TWO_DRAWS].map(|keys| with_keys(request.scene, request.light, keys));
    let [parity, counted] = &scenes;
    let said = |says, quantity| Said { technique: "shadow-volume", source: COUNTING, says, quantity };
    let wrong = |scene: &Result<Scene, String>, renderer: &mut Renderer| -> Number {
        wrong_percent(request, &plan_of(scene.as_ref().map_err(Clone::clone)?, request, false, renderer)?, renderer)
    };
    let drawn = |scene: &Result<Scene, String>, renderer: &mut Renderer| -> Number {
        fragments(scene.as_ref().map_err(Clone::clone)?, renderer)
    };
    let is_wrong =
        said("an inverted bit is right only where no volumes intersect, a count always", "wrong facing the light, %")
            .compare(
                Relation::Greater,
                (PARITY.to_owned(), wrong(parity, renderer)),
                (TWO_DRAWS.to_owned(), wrong(counted, renderer)),
            );
    let fills = said(
        "counting draws the volumes twice and fills more than inverting",
        "fragments of volumes that pass the depth test",
    )
    .compare(
        Relation::Greater,
        (TWO_DRAWS.to_owned(), drawn(counted, renderer)),
        (PARITY.to_owned(), drawn(parity, renderer)),
    );
    let times = times(request, [counted, parity], renderer);
    let of = |pick: fn(&PairedTimes) -> f64| times.as_ref().map(pick).map_err(Clone::clone);
    let costs = said("counting in two draws costs more than inverting", "time of a frame, ms").compare(
        Relation::Greater,
        (TWO_DRAWS.to_owned(), of(|times| times.first_ms)),
        (PARITY.to_owned(), of(|times| times.second_ms)),
    );
    let costs = match &times {
        Err(_) => costs,
        Ok(times) => {
            let verdict = match is_more(times) {
                Some(true) => ClaimVerdict::Holds,
                Some(false) => ClaimVerdict::FailsHere,
                None => ClaimVerdict::Unknown,
            };
            Claimed { verdict, ratio_range: Some(times.ratio_range), ..costs }
        }
    };
    vec![is_wrong, fills, costs]
}

/// `keep_all`: volumes reach to infinity; else the plan ends them just beyond all that is seen.
fn plan_of(scene: &Scene, request: &ClaimRequest<'_>, keep_all: bool, renderer: &mut Renderer) -> Result<Plan, String> {
    let views = vec![ViewRequest { view: View::Shade, light: request.light }];
    let request = Request { views, keep_all, sampled_warnings: false, ..Request::default() };
    renderer.plan(scene, &request).map_err(|error| error.to_string())
}

/// Wrong pixels facing the light, in percent.
fn wrong_percent(request: &ClaimRequest<'_>, plan: &Plan, renderer: &mut Renderer) -> Number {
    renderer.draw(plan).map_err(|error| error.to_string())?;
    let frame = renderer.read(plan).map_err(|error| error.to_string())?;
    let texels = match frame.views.into_iter().next() {
        Some(Pixels::RgbaF32 { data, .. }) => data,
        _ => Vec::new(),
    };
    let shade = ShadeImage::of_view(request.scene.image.size, &texels);
    let band = Band { texels: 0.0, map_size: [1, 1] };
    let facing = metrics::compare(request.truth, &shade, &band).map_err(|error| error.to_string())?.facing;
    match facing.compared < FEWEST_COMPARED {
        true => Err(format!("fewer than {FEWEST_COMPARED} pixels could be compared")),
        false => Ok(facing.wrong_percent),
    }
}

/// Fragments that pass the depth test in the passes that count.
fn fragments(scene: &Scene, renderer: &mut Renderer) -> Number {
    let request = Request { sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request).map_err(|error| error.to_string())?;
    renderer.device().forget();
    let times = renderer.device().run(&plan.list, Measure::Fragments).map_err(|error| error.to_string())?;
    let counts = |pass: &Pass| match &pass.work {
        Work::Draw(draw) => draw.state.stencil.is_some_and(|stencil| {
            stencil.write_mask != 0 && [stencil.front, stencil.back].iter().any(|ops| *ops != StencilOps::KEEP)
        }),
        Work::CopyDepth { .. } => false,
    };
    let counting: Vec<_> =
        plan.list.passes.iter().zip(&times).filter(|(pass, _)| counts(pass)).map(|(_, time)| time.fragments).collect();
    match counting.iter().copied().sum::<Option<u64>>() {
        Some(fragments) if !counting.is_empty() => Ok(fragments as f64),
        Some(_) => Err(String::from("no caster's volume is seen")),
        None => Err(String::from("the driver does not count fragments")),
    }
}

/// Times of frames that draw everything anew, of two scenes.
fn times(
    request: &ClaimRequest<'_>,
    scenes: [&Result<Scene, String>; 2],
    renderer: &mut Renderer,
) -> Result<PairedTimes, String> {
    let mut plan = |scene: &Result<Scene, String>| {
        let scene = scene.as_ref().map_err(Clone::clone)?;
        let request = Request { frames: 100, sampled_warnings: false, ..Request::default() };
        renderer.plan(scene, &request).map_err(|error| error.to_string())
    };
    let plans = [plan(scenes[0])?, plan(scenes[1])?];
    let rounds = if request.quick { 6 } else { 15 };
    let times = in_turn(rounds, |which| {
        let mut least = f64::INFINITY;
        // The first uploads what the other one's frame has replaced.
        for frame in 0..3 {
            renderer.device().forget();
            let ms = renderer.draw_timed(&plans[which], 1, false, || ())?.frames_ms;
            least = if frame == 0 { least } else { ms.into_iter().fold(least, f64::min) };
        }
        Ok(least)
    });
    times.map_err(|error| error.to_string())
}

/// Factors by which the far plane is moved away.
const MOVED: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 100.0, 1000.0];

/// Precision that far planes leave, and wrong pixels where the scene's own cuts volumes.
pub(super) fn far_planes(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> (Vec<Claimed>, Vec<ClaimSweep>) {
    let unshadowed = with_keys(request.scene, request.light, "technique = \"none\"");
    let mut moved = |factor: f64| -> Number {
        let mut scene = unshadowed.clone()?;
        scene.camera.far *= factor;
        codes(&scene, request.light, renderer)
    };
    let numbers: Vec<(f64, Number)> = MOVED.iter().map(|factor| (*factor, moved(*factor))).collect();
    let infinite = with_keys(request.scene, request.light, INFINITE);
    let at_infinity = infinite.clone().and_then(|scene| codes(&scene, request.light, renderer));
    let near_far = format!("camera.near = {}, camera.far = {}", request.scene.camera.near, request.scene.camera.far);
    let at = |index: usize| numbers.get(index).map_or_else(|| Err(String::new()), |(_, number)| number.clone());
    let said = |source, says, quantity| Said { technique: "shadow-volume", source, says, quantity };
    const CODES: &str = "codes of 24 bits from the nearest to the farthest surface seen";
    let written = || (format!("{near_far}, as written"), at(0));
    let last = MOVED.len() - 1;
    let mut claims = vec![
        said(FAR, "a far plane far away costs depth precision", CODES).compare(
            Relation::Greater,
            written(),
            (format!("camera.far = {}", request.scene.camera.far * MOVED[last]), at(last)),
        ),
        said("Everitt and Kilgard 2002", "a far plane at infinity costs hardly any depth precision", CODES).compare(
            Relation::AtMost(1.1),
            written(),
            (String::from("method = \"z-fail\", which has its far plane at infinity"), at_infinity.clone()),
        ),
    ];
    claims.push(cut(request, renderer));
    let point = |(factor, number): &(f64, Number)| ClaimPoint {
        x: *factor,
        measured: super::number((format!("camera.far = {}", request.scene.camera.far * factor), number.clone())),
    };
    let mut points: Vec<ClaimPoint> = numbers.iter().map(point).collect();
    let fit = match (at(0), &at_infinity) {
        (Ok(first), Ok(infinite)) if *infinite > 0.0 => format!(
            "at infinity {} codes are left, {} % fewer; by the projections f / (f - n) times as many are expected at the written \
             distance, {} %",
            plain(*infinite),
            plain(100.0 * (1.0 - infinite / first)),
            plain(100.0 * request.scene.camera.near / request.scene.camera.far)
        ),
        _ => String::new(),
    };
    points.retain(|point| point.measured.value.is_some());
    let sweep = ClaimSweep {
        name: String::from("far planes"),
        source: FAR.to_owned(),
        says: String::from(
            "The scene under far planes that are moved away; depths of 24 bits read from the depth buffer",
        ),
        x: String::from("distance of the far plane, in times of the scene's"),
        is_even: false,
        y: CODES.to_owned(),
        series: vec![ClaimSeries { name: String::from("finite far planes"), points, fit }],
    };
    let sweeps = if sweep.series[0].points.is_empty() { Vec::new() } else { vec![sweep] };
    (claims, sweeps)
}

/// Depth codes of 24 bits between the nearest and the farthest surface that is seen.
fn codes(scene: &Scene, light: usize, renderer: &mut Renderer) -> Number {
    let (_, depths) = depths(scene, light, View::Depth, renderer)?;
    let seen = || depths.iter().copied().filter(|depth| *depth < 1.0);
    let (least, most) = (seen().fold(f64::INFINITY, f64::min), seen().fold(0.0, f64::max));
    match least < most {
        true => Ok((most - least) * 16_777_215.0),
        false => Err(String::from("the camera sees no two depths")),
    }
}

/// Wrong pixels under a far plane just beyond what is seen, of volumes that reach to infinity: the plan would end them before
/// it. From beside the light, looking along its rays, most of what is in
/// shadow has the far ends of volumes behind it; from elsewhere a ray leaves a volume through its sides.
fn cut(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Claimed {
    let seen = beside_the_light(request).and_then(|scene| {
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let truth = truth::trace(&scene, request.light, &options).map_err(|error| error.to_string())?;
        Ok((scene, truth))
    });
    let far = seen.as_ref().map_or(0.0, |(scene, truth)| beyond_the_seen(scene, truth));
    let mut wrong = |cut: bool| -> Number {
        let (scene, truth) = seen.as_ref().map_err(Clone::clone)?;
        let request = ClaimRequest { scene, truth, ..*request };
        let mut plan = plan_of(scene, &request, true, renderer)?;
        if cut && cut_by_far(&mut plan, [scene.camera.near, far]) == 0 {
            return Err(String::from("no caster's volume is seen"));
        }
        wrong_percent(&request, &plan, renderer)
    };
    let settings = |far: &str| format!("method = \"z-fail\", volumes to infinity, seen from beside the light, {far}");
    Said {
        technique: "shadow-volume",
        source: FAR,
        says: "a far plane that cuts volumes spoils the count behind what is seen",
        quantity: "wrong facing the light, %",
    }
    .compare(
        Relation::Greater,
        (settings(&format!("camera.far = {}, just beyond what is seen", plain(far))), wrong(true)),
        (settings("with its far plane at infinity"), wrong(false)),
    )
}

/// The scene seen from a tenth of the light's distance above the light.
fn beside_the_light(request: &ClaimRequest<'_>) -> Result<Scene, String> {
    let mut scene = with_keys(request.scene, request.light, INFINITE)?;
    let light = scene.lights.get(request.light).ok_or("there is no such light")?;
    let frustum = light.frustum().ok_or("only a spotlight looks along its rays")?;
    let ahead = frustum.target - frustum.position;
    let above = ahead.cross(frustum.up).cross(ahead).normalize();
    scene.camera = Camera {
        eye: frustum.position + 0.1 * ahead.length() * above,
        target: frustum.target,
        up: frustum.up,
        fov_y_radians: frustum.cone_radians,
        near: frustum.near,
        far: 2.0 * frustum.far,
    };
    scene.image.size = small(scene.image.size, request.quick);
    Ok(scene)
}

/// Distance of a far plane a hundredth beyond the farthest surface that is seen.
fn beyond_the_seen(scene: &Scene, truth: &Truth) -> f64 {
    let camera = &scene.camera;
    let ahead = (camera.target - camera.eye).normalize();
    let distances = truth.pixels.iter().filter_map(|pixel| Some((pixel.hit?.position - camera.eye).dot(ahead)));
    1.01 * distances.fold(camera.near, f64::max)
}

/// Gives passes of the camera, which have their far plane at infinity, a finite one; both planes by their distances. Returns
/// the number of draws that it changed.
pub fn cut_by_far(plan: &mut Plan, [near, far]: [f64; 2]) -> usize {
    let finite_from_infinite = finite_from_infinite(near, far);
    let targets: Vec<_> = camera_targets(plan);
    let mut changed = 0;
    for pass in &mut plan.list.passes {
        let Work::Draw(pass) = &mut pass.work else { continue };
        if !pass.target.depth.is_some_and(|depth| targets.contains(&depth)) {
            continue;
        }
        for draw in pass.batches.iter_mut().flat_map(|batch| &mut batch.draws) {
            draw.clip_from_model = finite_from_infinite * draw.clip_from_model;
            changed += 1;
        }
    }
    changed
}

/// Clip space of a finite far plane from that of one at infinity.
fn finite_from_infinite(near: f64, far: f64) -> DMat4 {
    // For a point at w, z is w - 2 n at infinity, and w (f + n) / (f - n) - 2 f n / (f - n) before a finite plane.
    let (f, n) = (far / (far - near), near / (far - near));
    DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, f, 0.0), DVec4::new(0.0, 0.0, n, 1.0))
}

/// Depth buffers in which volumes are counted.
fn camera_targets(plan: &Plan) -> Vec<ImageId> {
    let of = |pass: &Pass| match &pass.work {
        Work::Draw(draw) => draw.state.stencil.and(draw.target.depth),
        Work::CopyDepth { .. } => None,
    };
    plan.list.passes.iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::{infinite_perspective, perspective};

    #[test]
    fn a_far_plane_at_infinity_is_made_finite() {
        let (near, far) = (0.5, 20.0);
        let expected = perspective(0.9, 1.5, near, far) * infinite_perspective(0.9, 1.5, near).inverse();
        let made = finite_from_infinite(near, far);
        assert!(made.abs_diff_eq(expected, 1e-12), "{made}");
    }
}
