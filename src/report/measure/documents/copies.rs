//! Copies of a depth buffer into a texture of another precision [LEC, "New Depth Texture Internal Texture Formats"]: a copy
//! is said to be fastest where both have the same.

use super::{ClaimRequest, Said, with_keys};
use crate::device::Measure;
use crate::frame::{self, Renderer};
use crate::pass::{DepthFormat, Format, Work};
use crate::plan::{Plan, Request};
use crate::report::measure::light_claims::is_more;
use crate::report::measure::paired::{PairedTimes, in_turn};
use crate::report::store::claimed::{ClaimVerdict, Claimed};
use crate::scene::LightKind;
use crate::techniques::claims::Relation;

const FORMATS: [(&str, DepthFormat); 2] = [("depth24", DepthFormat::Depth24), ("depth16", DepthFormat::Depth16)];

/// Times a copy into each texture from a depth buffer of the other precision and of its own.
pub(super) fn measure(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Vec<Claimed> {
    let [wide, narrow] = FORMATS;
    [[wide, narrow], [narrow, wide]].map(|formats| of_texture(request, formats, renderer)).into()
}

fn of_texture(
    request: &ClaimRequest<'_>,
    [(texture, own), (buffer, other)]: [(&str, DepthFormat); 2],
    renderer: &mut Renderer,
) -> Claimed {
    let says = format!(
        "a copy is fastest where depth buffer and texture have one precision: into {texture}, one from {buffer} takes longer"
    );
    let said = Said {
        technique: "shadow-map",
        source: "LEC, \"New Depth Texture Internal Texture Formats\"",
        says: &says,
        quantity: "time of the copy alone, ms",
    };
    let settings = |buffer: &str| format!("transfer = \"copy\", format = \"{texture}\", of a depth buffer of {buffer}");
    let times = times(request, texture, [other, own], renderer);
    let of = |pick: fn(&PairedTimes) -> f64| times.as_ref().map(pick).map_err(Clone::clone);
    let first = (settings(buffer), of(|times| times.first_ms));
    let second = (settings(texture), of(|times| times.second_ms));
    let claim = said.compare(Relation::Greater, first, second);
    match &times {
        Err(_) => claim,
        Ok(times) => {
            let verdict = match is_more(times) {
                Some(true) => ClaimVerdict::Holds,
                Some(false) => ClaimVerdict::FailsHere,
                None => ClaimVerdict::Unknown,
            };
            Claimed { verdict, ratio_range: Some(times.ratio_range), ..claim }
        }
    }
}

/// Times of the copies from two depth buffers into one texture.
fn times(
    request: &ClaimRequest<'_>,
    texture: &str,
    buffers: [DepthFormat; 2],
    renderer: &mut Renderer,
) -> Result<PairedTimes, String> {
    let light = request.scene.lights.get(request.light).ok_or("there is no such light")?;
    if matches!(light.kind, LightKind::Point(_)) {
        return Err(String::from("a point light's map has six faces: a spotlight's is copied in one piece"));
    }
    let keys = format!("technique = \"shadow-map\", transfer = \"copy\", format = \"{texture}\"");
    let scene = with_keys(request.scene, request.light, &keys)?;
    let plan = renderer.plan(&scene, &Request { sampled_warnings: false, ..Request::default() });
    let plan = plan.map_err(|error| error.to_string())?;
    let [first, second] = buffers.map(|format| from_buffer(&plan, format));
    let (first, second) = (first?, second?);
    let rounds = if request.quick { 9 } else { 21 };
    let times = in_turn(rounds, |which| time_of_copy(if which == 0 { &first } else { &second }, renderer));
    times.map_err(|error| error.to_string())
}

fn from_buffer(plan: &Plan, format: DepthFormat) -> Result<Plan, String> {
    let mut plan = plan.clone();
    match copy_from(&mut plan, format) {
        true => Ok(plan),
        false => Err(String::from("no map is copied: no caster lies in the light's frustum")),
    }
}

/// Gives the depth buffer that a plan copies first another format. `false`: it copies none.
pub fn copy_from(plan: &mut Plan, format: DepthFormat) -> bool {
    let copied = plan.list.passes.iter().find_map(|pass| match pass.work {
        Work::CopyDepth { from, .. } => Some(from),
        Work::Draw(_) => None,
    });
    let desc = copied.and_then(|copied| plan.list.images.get_mut(copied.0));
    desc.map(|desc| desc.format = Format::Depth(format)).is_some()
}

fn time_of_copy(plan: &Plan, renderer: &mut Renderer) -> Result<f64, frame::Error> {
    renderer.device().forget();
    let times = renderer.device().run(&plan.list, Measure::Passes)?;
    let is_copy = |pass: &crate::pass::Pass| matches!(pass.work, Work::CopyDepth { .. });
    let copies = plan.list.passes.iter().zip(&times).filter(|(pass, _)| is_copy(pass));
    Ok(copies.map(|(_, time)| time.wall_ms).sum())
}
