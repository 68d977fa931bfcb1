//! Notes on bump-mapped objects: their maps and tangent bases, how they are lit, and what is not exact.

use super::Notes;
use crate::combiners::Precision;
use crate::geometry::Bump;
use crate::geometry::bump::{BumpSource, NormalFormat};
use crate::geometry::normal_map::Difference;
use crate::geometry::tangents::{BasisCounts, BasisFit};
use crate::scene::{BumpMethod, Normalize, Object, Scene};

/// Ratio of an object's scales from which register combiners light it visibly wrong: they take angles in its own space.
const EVEN: f64 = 1.01;

/// Notes each bump-mapped object, and how bumps are lit; warns of what is not exact.
pub fn note_bumps(scene: &Scene, notes: &mut Notes) {
    let shading = &scene.shading.bumps;
    let mut any = false;
    for object in &scene.objects {
        let bump = object.material.as_ref().and_then(|material| material.bump.as_ref());
        let Some((bump, counts)) = bump.zip(object.bases) else { continue };
        if !object.lit {
            notes.left_out(format!("bumps of {}", object.name), "lit = false: its normals do not count");
            continue;
        }
        any = true;
        let (of, choice) = (format!("bumps of {}", object.name), of_map(bump));
        notes.chosen(of, choice, of_bases(bump.fit, &counts));
        if counts.without > 0 {
            notes.warnings.push(format!(
                "{}: {} of {} triangles have no direction on the skin, where s and t do not grow with the surface: drawn \
                 without bumps",
                object.name, counts.without, counts.triangles
            ));
        }
        let ratio = scale_ratio(object);
        if shading.method != BumpMethod::Reference && ratio > EVEN {
            notes.warnings.push(format!(
                "{}: it is scaled by {ratio:.3} times as much along one axis as along another, and register combiners light it \
                 in its own space, where angles differ: bump = \"reference\" is right",
                object.name
            ));
        }
    }
    match (&shading.method, any) {
        (BumpMethod::Reference, true) => {
            let why = if shading.self_shadow { "with" } else { "without" };
            let why = format!("vectors per fragment, {why} the factor min(1, 8 L_z) for light below the horizon");
            notes.chosen("light on bumps", "reference", why);
        }
        (BumpMethod::Reference, false) => {}
        (method, false) => notes.left_out(format!("bump = \"{}\"", method.name()), "no lit object has a bump map"),
        (method, true) => {
            notes.chosen("light on bumps", method.name(), of_combiners(method, shading.normalize, shading.precision));
            note_clamped_colors(scene, notes);
        }
    }
}

fn of_map(bump: &Bump) -> String {
    let [width, height] = bump.size();
    let format = if bump.format == NormalFormat::Signed { "snorm8" } else { "unorm8" };
    let source = match &bump.source {
        BumpSource::Heights { scale, difference, .. } => {
            let difference = if *difference == Difference::Forward { "forward" } else { "central" };
            format!("{difference} differences of heights of {scale} texels at most")
        }
        BumpSource::Normals { .. } => String::from("the file's normals"),
    };
    format!("{width}x{height} normals in {format}, {} levels: {source}", bump.map.levels.len())
}

fn of_bases(fit: BasisFit, counts: &BasisCounts) -> String {
    let fit = match fit {
        BasisFit::PerPolygon => "triangles' own normals",
        BasisFit::Orthogonal => "vertices' normals, T and B at right angles",
        BasisFit::Skewed => "vertices' normals, T and B as the skin has them",
    };
    let BasisCounts { triangles, mirrored, skewed, from_mesh, .. } = counts;
    match from_mesh {
        true => format!("{fit}; directions of the mesh's own at its vertices"),
        false => format!(
            "{fit}; of {triangles} triangles {mirrored} have a mirrored skin, {skewed} one that is skewed by more than 10 degrees"
        ),
    }
}

fn of_combiners(method: &BumpMethod, normalize: Normalize, precision: Precision) -> String {
    let stages = match method {
        BumpMethod::OnePass(program) => format!("{} general stages", program.stages.len()),
        BumpMethod::ThreePass { diffuse, specular } => {
            format!(
                "{} general stages for diffuse light, {} for highlights",
                diffuse.stages.len(),
                specular.stages.len()
            )
        }
        BumpMethod::Reference => String::new(),
    };
    let normalize = match normalize {
        Normalize::Exact => String::from("vectors normalised exactly"),
        Normalize::Cube { size, seamless } => {
            let seams = if seamless { "" } else { ", seams shown" };
            format!("vectors normalised by a cube map of {size} texels a side{seams}")
        }
    };
    let precision = if precision == Precision::NineBits { "registers of 9 bits" } else { "registers of floats" };
    format!("{stages}, {normalize}, {precision}")
}

/// Warns of colours above 1, which registers clamp.
fn note_clamped_colors(scene: &Scene, notes: &mut Notes) {
    for (index, light) in scene.lights.iter().enumerate() {
        let brightest = light.diffuse.into_iter().chain(light.specular).fold(0.0, f32::max);
        let brightest = brightest / light.attenuation()[0];
        if brightest > 1.0 {
            notes.warnings.push(format!(
                "light {index}: its colour reaches {brightest}; register combiners clamp it to 1 before it meets the bumps"
            ));
        }
    }
}

/// Greatest scale of an object along a direction over the least.
fn scale_ratio(object: &Object) -> f64 {
    let linear = glam::DMat3::from_mat4(object.world_from_model);
    let squares = linear.transpose() * linear;
    // The extreme values of |M v| over unit vectors lie at the axes for objects that are scaled along them.
    let scales = [squares.x_axis.x, squares.y_axis.y, squares.z_axis.z].map(f64::sqrt);
    scales.into_iter().fold(0.0, f64::max) / scales.into_iter().fold(f64::INFINITY, f64::min)
}
