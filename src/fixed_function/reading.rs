//! Turns a batch's description into layers of the fixed-function pipeline, or says why that is impossible. Knows no GL.
//!
//! A lit batch is drawn in several passes [LEC, "Advice for Shadowed Illumination Model"; Segal 1992, 3.3]: ambient light
//! first, then each light, added where it reaches; specular light by itself where a decal must not modulate it. A light
//! alone needs one.

use glam::Vec3;

use super::bounds::{self, CoordinateRange};
use super::layer::{Layer, LayerBlend, LayerLighting, PointLight, Primary, TangentVector};
use super::primary::{Parts, is_attenuated, is_lit, own_ambient, primary, primary_of_bumps, product, unlit_source};
use super::stack::{Stack, Weight};
use crate::pass::{
    self, Batch, Compare, Decal, FixedFunctionDesc, FixedFunctionLight, Lit, Projection, Shade, ShadeView, Texturing,
};

/// The layers of a batch, in the order in which they are drawn; `blend` is its pass's.
///
/// # Errors
///
/// Reason why fixed function cannot draw it.
pub fn layers(batch: &Batch, blend: Option<pass::Blend>) -> Result<Vec<Layer>, String> {
    match &batch.meaning {
        FixedFunctionDesc::Depth(texturing) => Ok(vec![cut_out("depth", batch, texturing)?]),
        FixedFunctionDesc::Constant(color) => Ok(vec![Layer::first("colour", Primary::Color(*color))]),
        FixedFunctionDesc::Lit(lit) => match blend {
            None if lit.added => Err(String::from("light beside ambient light that is elsewhere")),
            None => lit_layers(batch, lit),
            Some(blend) => blended_layers(batch, lit, blend),
        },
        FixedFunctionDesc::Decal(decal) => Ok(vec![decal_layer(batch, decal, blend)?]),
        FixedFunctionDesc::Alpha(view) => alpha_layers(batch, view),
        FixedFunctionDesc::Sampled(view) => view_layers(batch, view),
        FixedFunctionDesc::Shader(what) => Err((*what).to_owned()),
    }
}

impl Layer {
    fn first(name: &str, primary: Primary) -> Self {
        let name = name.to_owned();
        let (units, alpha_test, blend) = (Vec::new(), None, LayerBlend::Replace);
        Self { name, primary, units, alpha_test, blend, first: true, alpha_write: true }
    }
}

/// The decal and the gloss. Holes need no test: at depth EQUAL nothing is met in them.
fn decal_layer(batch: &Batch, decal: &Decal, blend: Option<pass::Blend>) -> Result<Layer, String> {
    if blend != Some(pass::Blend::MultiplyAndStoreAlpha) {
        return Err(String::from("a decal in a pass that does not multiply by it"));
    }
    let mut stack = Stack::new(batch);
    stack.decal(decal)?;
    let mut layer = Layer::first("decal", Primary::Color([1.0; 4]));
    (layer.units, layer.blend) = (stack.finish(), LayerBlend::MultiplyAndStoreAlpha);
    Ok(layer)
}

/// Black, and only where the surface has no holes.
fn cut_out(name: &str, batch: &Batch, texturing: &Texturing) -> Result<Layer, String> {
    let mut layer = Layer::first(name, Primary::Color([0.0, 0.0, 0.0, opacity(texturing)]));
    let mut stack = Stack::new(batch);
    stack.surface(texturing, false, true)?;
    layer.units = stack.finish();
    layer.alpha_test = tested(texturing);
    Ok(layer)
}

fn tested(texturing: &Texturing) -> Option<(Compare, f32)> {
    texturing.alpha_test.as_ref().map(|_| (Compare::GreaterEqual, 0.5))
}

fn opacity(texturing: &Texturing) -> f32 {
    texturing.alpha_test.as_ref().map_or(1.0, |test| test.opacity)
}

/// The shade as a colour. What is cut out, by holes or by a cone, becomes 0 in a layer of its own, because the alpha test
/// has one comparison and alpha must be 1 in the end.
fn view_layers(batch: &Batch, view: &ShadeView) -> Result<Vec<Layer>, String> {
    let projection = view.projection.as_ref();
    let reach = reach(batch, projection)?;
    check_reference(batch, &view.shade, reach)?;
    let mut stack = Stack::new(batch);
    stack.shade(&view.shade, projection, Weight::Shade)?;
    if let Some(projection) = projection {
        stack.reach(projection, reach.behind, true);
    }
    let mut shown = Layer::first("shade", Primary::Color([1.0; 4]));
    shown.units = stack.finish();
    let mut layers = Vec::new();
    if view.texturing.alpha_test.is_some() {
        layers.push(Layer { blend: LayerBlend::Erase, ..cut_out("holes", batch, &view.texturing)? });
        shown.first = false;
    }
    layers.push(shown);
    if let Some(projection) = projection.filter(|projection| projection.cone) {
        layers.push(outside_cone(batch, projection));
    }
    Ok(layers)
}

/// Erases what lies outside a light's cone.
fn outside_cone(batch: &Batch, projection: &Projection) -> Layer {
    let mut stack = Stack::new(batch);
    stack.cone(projection);
    let mut outside = Layer::first("outside the cone", Primary::Color([0.0, 0.0, 0.0, 1.0]));
    outside.units = stack.finish();
    outside.alpha_test = Some((Compare::LessEqual, 0.0));
    outside.blend = LayerBlend::Erase;
    outside.first = false;
    outside
}

/// The shade as alpha. Holes need no test: at depth EQUAL nothing is met in them.
fn alpha_layers(batch: &Batch, view: &ShadeView) -> Result<Vec<Layer>, String> {
    let projection = view.projection.as_ref();
    let reach = reach(batch, projection)?;
    check_reference(batch, &view.shade, reach)?;
    let most = if view.shade == Shade::Dark { 0.0 } else { 1.0 };
    let mut shown = Layer::first("shade", Primary::Color([0.0, 0.0, 0.0, most]));
    let mut stack = Stack::new(batch);
    stack.shade_in_alpha(&view.shade, projection)?;
    if let Some(projection) = projection {
        stack.reach(projection, reach.behind, true);
    }
    shown.units = stack.finish();
    let outside = projection.filter(|projection| projection.cone).map(|projection| outside_cone(batch, projection));
    Ok([shown].into_iter().chain(outside).collect())
}

/// Cases that may occur in a batch; none if a light has no coordinates.
fn reach(batch: &Batch, projection: Option<&Projection>) -> Result<CoordinateRange, String> {
    projection.map_or(Ok(CoordinateRange::default()), |projection| bounds::of(batch, projection))
}

/// Fixed-point formats clamp r/q to [0, 1]; for others the shader does, and no combiner can. It matters only where a
/// draw reaches beyond the depths of the map.
fn check_reference(batch: &Batch, shade: &Shade, reach: CoordinateRange) -> Result<(), String> {
    let Shade::Texture { input, clamped: true } = shade else { return Ok(()) };
    let input = batch.inputs.iter().find(|each| each.name == *input);
    let (beyond, where_) = match input.and_then(|input| input.sampler.compare) {
        Some(Compare::GreaterEqual) => (reach.below_zero, "r < 0"),
        _ => (reach.above_one, "r/q > 1"),
    };
    if beyond {
        return Err(format!(
            "it reaches beyond the light's far plane ({where_}), where a floating-point map does not clamp what it is \
             compared with: choose a fixed-point format or a farther plane"
        ));
    }
    Ok(())
}

fn lit_layers(batch: &Batch, lit: &Lit) -> Result<Vec<Layer>, String> {
    check_lighting(lit)?;
    let mut layers = Vec::new();
    let base = ambient_layer(batch, lit)?;
    let lights = lit.lights.iter().map(|light| light_layers(batch, lit, light)).collect::<Result<Vec<_>, _>>()?;
    let mut lights: Vec<Layer> = lights.into_iter().flatten().collect();
    let dark = base.primary == Primary::Color([0.0, 0.0, 0.0, 1.0]);
    match lights.first_mut() {
        // Nothing is there to be added to, and what the light does not reach is black by its units.
        Some(only) if dark && base.alpha_test.is_none() && only.alpha_test.is_none() => {
            (only.first, only.blend, only.alpha_write) = (true, LayerBlend::Replace, true);
        }
        _ => layers.push(base),
    }
    layers.extend(lights);
    Ok(layers)
}

/// Layers of a pass that blends: each blends with what is there as the pass does. Nothing blends by an ambient layer that
/// is black, or that the picture has already.
fn blended_layers(batch: &Batch, lit: &Lit, blend: pass::Blend) -> Result<Vec<Layer>, String> {
    check_lighting(lit)?;
    let blend = match blend {
        pass::Blend::Add => LayerBlend::Add,
        pass::Blend::AddByStoredAlpha => LayerBlend::AddByStoredAlpha,
        pass::Blend::Multiply if lit.lights.is_empty() => LayerBlend::Multiply,
        _ => return Err(String::from("a pass that blends otherwise than its own layers can")),
    };
    let lights = lit.lights.iter().map(|light| light_layers(batch, lit, light)).collect::<Result<Vec<_>, _>>()?;
    let base = ambient_layer(batch, lit)?;
    let is_dark = matches!(base.primary, Primary::Color([0.0, 0.0, 0.0, _]));
    let base = (!lit.added && (blend == LayerBlend::Multiply || !is_dark)).then_some(base);
    let layers = base.into_iter().chain(lights.into_iter().flatten());
    Ok(layers.map(|layer| Layer { blend, alpha_write: false, ..layer }).collect())
}

fn check_lighting(lit: &Lit) -> Result<(), String> {
    let by_vertex = |light: &FixedFunctionLight| is_lit(lit, light) || is_attenuated(light);
    let shows_light = [lit.diffuse, lit.specular, lit.ambient].iter().any(|color| *color != [0.0; 3]);
    if !lit.per_vertex && lit.bumps.is_none() && shows_light && lit.lights.iter().any(by_vertex) {
        return Err(String::from(
            "its lighting is found for each fragment, fixed function's for each vertex: choose lighting = \"per-vertex\"",
        ));
    }
    if lit.lit && lit.shininess > 128.0 {
        return Err(format!("its specular exponent is {}, GL_SHININESS ends at 128", lit.shininess));
    }
    Ok(())
}

/// The first layer: all ambient light times the decal, and the surface's visibility.
fn ambient_layer(batch: &Batch, lit: &Lit) -> Result<Layer, String> {
    let scene = Vec3::from(lit.scene_ambient);
    let lit_by: Vec<&FixedFunctionLight> =
        lit.lights.iter().filter(|light| product(light.ambient, lit.ambient) != Vec3::ZERO).collect();
    let most = scene + lit_by.iter().map(|light| own_ambient(lit, light)).sum::<Vec3>();
    if most.max_element() > 1.0 && (lit.texturing.decal || lit_by.iter().any(|light| is_attenuated(light))) {
        return Err(String::from("its ambient light exceeds 1, where fixed function clamps it"));
    }
    let opacity = opacity(&lit.texturing);
    let primary = if lit_by.iter().any(|light| is_attenuated(light)) {
        let sources = lit_by.iter().map(|light| PointLight { ambient: light.ambient, ..unlit_source(light) }).collect();
        let (emission, ambient) = (lit.scene_ambient, lit.ambient);
        Primary::Lighting(LayerLighting { emission, ambient, opacity, sources, ..LayerLighting::default() })
    } else {
        Primary::Color(most.min(Vec3::ONE).extend(opacity).to_array())
    };
    let mut layer = Layer::first("ambient", primary);
    let mut stack = Stack::new(batch);
    let decal = lit.texturing.decal && most != Vec3::ZERO;
    stack.surface(&lit.texturing, decal, true)?;
    layer.units = stack.finish();
    layer.alpha_test = tested(&lit.texturing);
    // The picture's alpha stays 1 as cleared, whatever the alpha test used.
    layer.alpha_write = layer.alpha_test.is_none();
    Ok(layer)
}

fn light_layers(batch: &Batch, lit: &Lit, light: &FixedFunctionLight) -> Result<Vec<Layer>, String> {
    let reach = reach(batch, light.projection.as_ref())?;
    check_reference(batch, &light.shade, reach)?;
    let has_diffuse = product(light.diffuse, lit.diffuse) != Vec3::ZERO;
    let has_specular = is_lit(lit, light) && product(light.specular, lit.specular) != Vec3::ZERO;
    let dimmed = if light.dimming > 0.0 { Weight::Dimmed(light.dimming) } else { Weight::Shade };
    let mut parts = Vec::new();
    if has_diffuse && has_specular && !lit.texturing.decal && light.diffuse_weight == 1.0 {
        // Both saturate together: what a dimmed shadow leaves of the diffuse light alone is added to it.
        parts.push(Parts { diffuse: true, specular: true, weight: Weight::Shade });
        if light.dimming > 0.0 && light.shade != Shade::Lit {
            parts.push(Parts { diffuse: true, specular: false, weight: Weight::Left(light.dimming) });
        }
    } else {
        let each = [(has_diffuse, true, dimmed), (has_specular, false, Weight::Shade)].into_iter();
        parts.extend(each.filter(|(has, ..)| *has).map(|(_, diffuse, weight)| {
            let specular = !diffuse;
            Parts { diffuse, specular, weight }
        }));
    }
    parts.into_iter().map(|parts| light_layer(batch, lit, light, parts, reach)).collect()
}

fn light_layer(
    batch: &Batch,
    lit: &Lit,
    light: &FixedFunctionLight,
    parts: Parts,
    reach: CoordinateRange,
) -> Result<Layer, String> {
    let projection = light.projection.as_ref();
    let cone = projection.filter(|projection| projection.cone);
    let bumps = lit.bumps.filter(|_| is_lit(lit, light));
    let (primary, already) = match bumps {
        Some(_) => (primary_of_bumps(lit, light, parts)?, None),
        None => primary(lit, light, parts)?,
    };
    let name = match parts {
        Parts { diffuse: true, specular: true, .. } => "light",
        Parts { diffuse: true, .. } => "diffuse light",
        Parts { .. } => "specular light",
    };
    let mut stack = Stack::new(batch);
    if let Some(bumps) = bumps {
        stack.bumps(bumps, &lit.texturing, TangentVector { light: light.position, half: parts.specular })?;
    }
    cone.iter().for_each(|projection| stack.cone(projection));
    if let Some(already) = already {
        if parts.weight != Weight::Shade && light.shade != Shade::Lit {
            return Err(String::from(
                "its light saturates at vertices and its shadow is dimmed: no combiner does both",
            ));
        }
        stack.subtract(already.to_array());
    }
    stack.shade(&light.shade, projection, parts.weight)?;
    if let Some(projection) = projection {
        light.beams.iter().try_for_each(|beam| stack.beam(beam, projection))?;
        stack.reach(projection, reach.behind, false);
    }
    if parts.diffuse && light.diffuse_weight < 1.0 {
        stack.weigh(light.diffuse_weight);
    }
    if parts.diffuse {
        stack.surface(&lit.texturing, lit.texturing.decal, false)?;
    }
    Ok(Layer {
        name: format!("{name} {}", light.index),
        primary,
        units: stack.finish(),
        alpha_test: cone.map(|_| (Compare::Greater, 0.0)),
        blend: LayerBlend::Add,
        first: false,
        alpha_write: false,
    })
}
