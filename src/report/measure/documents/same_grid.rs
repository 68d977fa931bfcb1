//! One grid for eye and light [HSM, "How It Works"]: a map that is looked up on its own grid is said to be a depth test. That
//! holds for depths in the buffer's own codes; a comparison with interpolated floats errs by their rounding.

use super::{ClaimRequest, Number, Said, depths, with_keys};
use crate::frame::{Renderer, draw_shade};
use crate::report::store::claimed::Claimed;
use crate::scene::{Camera, Scene};
use crate::techniques::claims::Relation;
use crate::views::View;

/// Formats of the map, with the size of their steps.
const FORMATS: [&str; 3] = ["depth16", "depth24", "depth32f"];

pub(super) fn measure(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Vec<Claimed> {
    let said = |says| Said {
        technique: "shadow-map",
        source: "HSM, \"How It Works\"",
        says,
        quantity: "dark pixels where the eye is the light, which lights all that it sees, %",
    };
    let none = || (String::from("what the light sees is lit"), Ok(0.0));
    let side = if request.quick { 256 } else { 512 };
    let mut claims: Vec<Claimed> = FORMATS
        .iter()
        .map(|format| {
            let dark = at_light(request, format, side).and_then(|scene| dark_percent(&scene, request.light, renderer));
            let settings = format!("format = \"{format}\", size = {side}, filter = \"nearest\", no offset");
            said("on one grid a shadow map's comparison with r as a float is a depth test").compare(
                Relation::AtMost(1.0),
                (settings, dark),
                none(),
            )
        })
        .collect();
    let codes = at_light(request, "depth24", side).and_then(|scene| unequal_percent(&scene, request.light, renderer));
    let settings = format!("depth24: the depth buffer's codes against the map's, size = {side}");
    claims.push(said("on one grid a comparison of depths in the buffer's own codes is a depth test").compare(
        Relation::AtMost(1.0),
        (settings, codes),
        none(),
    ));
    claims
}

/// The scene seen from the light, in as many pixels as its map has texels.
fn at_light(request: &ClaimRequest<'_>, format: &str, side: u32) -> Result<Scene, String> {
    let light = request.scene.lights.get(request.light).ok_or("there is no such light")?;
    let frustum = light.frustum().ok_or("only a spotlight sees one perspective picture")?;
    if frustum.aspect != 1.0 || frustum.lean != glam::DVec2::ZERO {
        return Err(String::from("the light's frustum is not square or not symmetric: no camera has its grid"));
    }
    let keys = format!(
        "technique = \"shadow-map\", size = {side}, format = \"{format}\", filter = \"nearest\", kernel = 1, fit = \"none\", \
         mipmaps = false, bias = \"offset\", addressing = \"opengl\", offset = {{ factor = 0.0, units = 0.0 }}"
    );
    let mut scene = with_keys(request.scene, request.light, &keys)?;
    scene.image.size = [side; 2];
    scene.camera = Camera {
        eye: frustum.position,
        target: frustum.target,
        up: frustum.up,
        fov_y_radians: frustum.cone_radians,
        near: frustum.near,
        far: frustum.far,
    };
    Ok(scene)
}

/// Covered pixels that the comparison leaves dark.
fn dark_percent(scene: &Scene, light: usize, renderer: &mut Renderer) -> Number {
    let shade = draw_shade(scene, light, renderer).map_err(|error| error.to_string())?;
    let covered = shade.covered.iter().filter(|covered| **covered).count();
    let dark = shade.covered.iter().zip(&shade.shade).filter(|(covered, shade)| **covered && **shade < 0.5).count();
    match covered {
        0 => Err(String::from("the light sees nothing")),
        covered => Ok(100.0 * dark as f64 / covered as f64),
    }
}

/// Pixels of surfaces that lie behind the map's depth, both as codes of 24 bits.
fn unequal_percent(scene: &Scene, light: usize, renderer: &mut Renderer) -> Number {
    let (size, seen) = depths(scene, light, View::Depth, renderer)?;
    let (map_size, map) = depths(scene, light, View::LightDepth, renderer)?;
    if size != map_size {
        return Err(format!("a picture of {size:?} pixels and a map of {map_size:?} texels"));
    }
    let code = |depth: f64| (depth * 16_777_215.0).round();
    let both = || seen.iter().zip(&map).filter(|(seen, _)| **seen < 1.0);
    let behind = both().filter(|(seen, map)| code(**seen) > code(**map)).count();
    match both().count() {
        0 => Err(String::from("the light sees nothing")),
        count => Ok(100.0 * behind as f64 / count as f64),
    }
}
