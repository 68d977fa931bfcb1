//! Notes on bump-mapped objects: their maps and tangent bases, how they are lit, and what is not exact.

use std::sync::Arc;

use super::Notes;
use crate::combiners::Precision;
use crate::geometry::bump::{BumpSource, Gloss, NormalFormat};
use crate::geometry::normal_map::Difference;
use crate::geometry::tangents::{BasisCounts, BasisFit};
use crate::geometry::{Bump, Material};
use crate::scene::{BumpMethod, BumpShading, Normalize, Object, PicturePasses, Scene};

/// Ratio of an object's scales from which register combiners light it visibly wrong: they take angles in its own space.
const EVEN: f64 = 1.01;

/// Notes each bump-mapped object, and how bumps are lit; warns of what is not exact.
pub fn note_bumps(scene: &Scene, notes: &mut Notes) {
    let shading = &scene.shading.bumps;
    let mut any = false;
    for object in &scene.objects {
        note_gloss(scene, object, notes);
        let bumps = bumps_of(object);
        let Some((bump, counts)) = bumps.first().zip(object.bases) else { continue };
        if !object.lit {
            notes.left_out(format!("bumps of {}", object.name), "lit = false: its normals do not count");
            continue;
        }
        if scene.shading.passes == PicturePasses::Slide {
            let why = "slide projectors multiply surfaces' colours: normals do not count";
            notes.left_out(format!("bumps of {}", object.name), why);
            continue;
        }
        any = true;
        let maps: Vec<String> = bumps.iter().map(|bump| of_map(bump)).collect();
        let (of, choice) = (format!("bumps of {}", object.name), maps.join("; "));
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
            notes.chosen("light on bumps", method.name(), of_combiners(shading));
            note_clamped_colors(scene, notes);
            note_lenses(scene, notes);
        }
    }
}

/// The bump maps of an object's own material, else of its file's, each once.
fn bumps_of(object: &Object) -> Vec<&Arc<Bump>> {
    let mut found: Vec<&Arc<Bump>> = Vec::new();
    for bump in materials_of(object).filter_map(|material| material.bump.as_ref()) {
        if !found.iter().any(|known| Arc::ptr_eq(known, bump)) {
            found.push(bump);
        }
    }
    found
}

/// An object's own material, else those of its file.
fn materials_of(object: &Object) -> impl Iterator<Item = &Material> {
    let of_file = if object.material.is_some() { &[][..] } else { &object.mesh.materials };
    object.material.as_deref().into_iter().chain(of_file)
}

/// Notes a gloss that changes nothing.
fn note_gloss(scene: &Scene, object: &Object, notes: &mut Notes) {
    let Some((material, gloss)) = object.material.as_ref().and_then(|own| Some((own, own.gloss.as_ref()?))) else {
        return;
    };
    let is_opaque = *gloss == Gloss::DecalAlpha && material.decal.as_ref().is_some_and(|decal| !decal.has_alpha);
    let why = if material.specular == [0.0; 3] {
        "its material is not specular"
    } else if !object.lit {
        "lit = false: nothing shines"
    } else if scene.shading.passes == PicturePasses::Slide {
        "slide projectors make no highlights"
    } else if object.mesh.texcoords.is_none() && material.texgen.is_none() {
        "its mesh has no texture coordinates"
    } else if is_opaque {
        "the decal's alpha is 1 everywhere"
    } else {
        return;
    };
    notes.left_out(format!("gloss of {}", object.name), why);
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

fn of_combiners(shading: &BumpShading) -> String {
    let BumpShading { method, normalize, precision, has_own_program: own, .. } = shading.clone();
    let stages = match &method {
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
    let own = if own { " of a file, which `shininess` does not change" } else { "" };
    let precision = if precision == Precision::NineBits { "registers of 9 bits" } else { "registers of floats" };
    format!("{stages}{own}, {normalize}, {precision}")
}

/// Warns of colours above 1, which registers clamp: the light's times the material's, at the light itself.
fn note_clamped_colors(scene: &Scene, notes: &mut Notes) {
    let materials = scene.objects.iter().filter(|object| object.bases.is_some() && object.lit);
    let materials: Vec<&Material> = materials.flat_map(materials_of).filter(|own| own.bump.is_some()).collect();
    for (index, light) in scene.lights.iter().enumerate() {
        let of = |material: &&Material| {
            let pairs = |light: [f32; 3], own: [f32; 3]| (0..3).map(move |k| light[k] * own[k]).fold(0.0, f32::max);
            pairs(light.diffuse, material.diffuse).max(pairs(light.specular, material.specular))
        };
        let brightest = materials.iter().map(of).fold(0.0, f32::max);
        let near = light.attenuation()[0];
        let reaches = match brightest {
            brightest if brightest <= near || brightest == 0.0 => continue,
            _ if near == 0.0 => String::from("above 1 near the light"),
            brightest => format!("{}", brightest / near),
        };
        notes.warnings.push(format!(
            "light {index}: its colour on a bumped surface reaches {reaches}; register combiners clamp it to 1 before it meets \
             the bumps"
        ));
    }
}

/// Warns of lights through a lens beside three passes: each lens point is added with its decal, in one pass.
fn note_lenses(scene: &Scene, notes: &mut Notes) {
    let is_apart = matches!(scene.shading.bumps.method, BumpMethod::ThreePass { .. });
    for (index, light) in scene.lights.iter().enumerate().filter(|_| is_apart) {
        if light.spot().is_some_and(|spot| spot.lens().is_some()) {
            notes.warnings.push(format!(
                "light {index}: its lens points are added one by one, with decal and highlight: bump = \"reference\" lights its \
                 bumps, not the register combiners of three passes"
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
