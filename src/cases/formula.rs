//! Expected pixels, in f64 and by other means than the renderer's: similar triangles and angles instead of light matrices,
//! a ray through a pixel's centre instead of a raster. Reads the resolved scene only.

use crate::scene::{Camera, Frustum, Light, LightKind, LightShape, Scene};
use glam::{DVec2, DVec3};

use super::file::{Formula, Sphere};

/// Right, above and ahead of an observer.
struct Axes {
    right: DVec3,
    above: DVec3,
    ahead: DVec3,
}

fn axes(eye: DVec3, target: DVec3, up: DVec3) -> Axes {
    let ahead = (target - eye).normalize();
    let right = ahead.cross(up).normalize();
    Axes { right, above: right.cross(ahead), ahead }
}

fn camera_axes(camera: &Camera) -> Axes {
    axes(camera.eye, camera.target, camera.up)
}

/// Position of `point` in the picture, in pixels from the top left corner. `None` behind the eye.
pub fn pixel_position(scene: &Scene, point: DVec3) -> Option<DVec2> {
    let [width, height] = scene.image.size.map(f64::from);
    let (axes, from_eye) = (camera_axes(&scene.camera), point - scene.camera.eye);
    let depth = from_eye.dot(axes.ahead);
    let per_unit = 0.5 * height / (0.5 * scene.camera.fov_y_radians).tan();
    let (x, y) = (from_eye.dot(axes.right) / depth, from_eye.dot(axes.above) / depth);
    (depth > 0.0).then(|| DVec2::new(0.5 * width + x * per_unit, 0.5 * height - y * per_unit))
}

/// The pixel that holds `point`.
///
/// # Errors
///
/// A point outside the picture.
pub fn pixel(scene: &Scene, point: DVec3) -> Result<[u32; 2], String> {
    let [width, height] = scene.image.size.map(f64::from);
    match pixel_position(scene, point) {
        Some(p) if p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height => Ok([p.x as u32, p.y as u32]),
        other => Err(format!("{point} is not in the picture: {other:?}")),
    }
}

/// Point where the ray through the centre of `pixel` meets the plane through `point` with `normal`.
pub fn point_under(scene: &Scene, pixel: [u32; 2], point: DVec3, normal: DVec3) -> DVec3 {
    let [width, height] = scene.image.size.map(f64::from);
    let axes = camera_axes(&scene.camera);
    let unit = (0.5 * scene.camera.fov_y_radians).tan() / (0.5 * height);
    let right = (f64::from(pixel[0]) + 0.5 - 0.5 * width) * unit;
    let above = (0.5 * height - f64::from(pixel[1]) - 0.5) * unit;
    let direction = axes.ahead + right * axes.right + above * axes.above;
    let eye = scene.camera.eye;
    eye + direction * ((point - eye).dot(normal) / direction.dot(normal))
}

/// The length on a surface at `point`, along `direction`, that one pixel shows.
///
/// # Errors
///
/// A point that is not before the camera.
pub fn pixel_length(scene: &Scene, point: DVec3, direction: DVec3) -> Result<f64, String> {
    let step = 1e-3;
    let ends = [point - step * direction, point + step * direction].map(|end| pixel_position(scene, end));
    match ends {
        [Some(a), Some(b)] => Ok(2.0 * step / a.distance(b)),
        _ => Err(format!("{point} is not before the camera")),
    }
}

/// The frustum of a light that must be a spotlight.
///
/// # Errors
///
/// A light of another kind.
pub fn frustum(light: &Light) -> Result<&Frustum, String> {
    light.frustum().ok_or_else(|| format!("{} is no spotlight: it has no frustum", light.name))
}

/// To the light, which may be infinitely far away: then of unit length.
fn to_light(light: &Light, point: DVec3) -> DVec3 {
    match &light.kind {
        LightKind::Spot(spot) => spot.frustum.position - point,
        LightKind::Point(source) => source.position - point,
        LightKind::Directional { direction } => -*direction,
    }
}

/// The length on a floor with normal +y at `point` that one texel of a map of `size` covers at most.
pub fn texel_length(light: &Frustum, size: f64, point: DVec3) -> f64 {
    let from_light = point - light.position;
    let depth = from_light.dot((light.target - light.position).normalize());
    let slant = (from_light.y / from_light.length()).abs();
    2.0 * (0.5 * light.cone_radians).tan() * depth / size * std::f64::consts::SQRT_2 / slant
}

/// The shadow of `caster` on the floor at height `floor`: central or parallel projection from the light.
pub fn shadow_on_floor(light: &Light, caster: DVec3, floor: f64) -> DVec3 {
    let ray = to_light(light, caster);
    caster + ray * ((floor - caster.y) / ray.y)
}

/// Point where the tangent from the light touches the sphere, in the plane of the axis through its centre and `outward`.
pub fn tangent_point(light: &Light, sphere: &Sphere, outward: DVec3) -> DVec3 {
    let center = DVec3::from_array(sphere.center);
    let to_light = to_light(light, center);
    let (distance, axis) = (to_light.length(), to_light.normalize());
    let across = outward.reject_from(axis).normalize();
    let sine = if light.position().is_some() { sphere.radius / distance } else { 0.0 };
    center + sphere.radius * (sine * axis + (1.0 - sine * sine).sqrt() * across)
}

/// Distance of `point` from the light's axis, as a part of the light's reach: below 1 inside, above 1 outside.
pub fn reach(light: &Light, point: DVec3) -> f64 {
    let Some(spot) = light.spot() else { return 0.0 };
    let Frustum { position, target, up, cone_radians, aspect, .. } = spot.frustum;
    let (half, axes) = (0.5 * cone_radians, axes(position, target, up));
    let from_light = point - position;
    let depth = from_light.dot(axes.ahead);
    if depth <= 0.0 {
        return f64::INFINITY;
    }
    let off = DVec2::new(from_light.dot(axes.right), from_light.dot(axes.above)) / depth;
    match spot.shape {
        LightShape::Cone => off.length() / half.tan(),
        LightShape::Frustum => (off / DVec2::new(aspect, 1.0)).abs().max_element() / half.tan(),
    }
}

/// End of the reach from `start` along `direction`, by bisection.
///
/// # Errors
///
/// A reach that does not end there.
pub fn reach_end(light: &Light, start: DVec3, direction: DVec3) -> Result<f64, String> {
    let (mut inside, mut outside) = (0.0, 1e3);
    let at = |along: f64| reach(light, start + along * direction);
    if at(inside) >= 1.0 || at(outside) <= 1.0 {
        return Err(format!("the reach does not end between {start} and 1000 along {direction}"));
    }
    for _ in 0..80 {
        let middle = 0.5 * (inside + outside);
        if at(middle) < 1.0 { inside = middle } else { outside = middle }
    }
    Ok(inside)
}

/// The illumination formula [LEC, "Advice for Shadowed Illumination Model"] at `point`, by Lambert and Blinn with a viewer at
/// the eye: `(ambient + Σ (dimming + (1 - dimming) shade) beam diffuse) decal + Σ shade beam specular`.
///
/// # Errors
///
/// An object, a material or a shade that is not there.
pub fn illumination(scene: &Scene, point: DVec3, known: &Formula) -> Result<DVec3, String> {
    let color = |rgb: [f32; 3]| DVec3::from_array(rgb.map(f64::from));
    let object = scene.objects.get(known.object).ok_or("the formula's object is not in the scene")?;
    let material = object.material.as_ref().ok_or("the formula's object has no material of the scene's")?;
    let normal = DVec3::from_array(known.normal).normalize();
    let mut body = color(scene.shading.ambient) * color(material.ambient);
    let mut gloss = DVec3::ZERO;
    for (index, light) in scene.lights.iter().enumerate() {
        let ray = to_light(light, point);
        let [constant, linear, quadratic] = light.attenuation().map(f64::from);
        let strength = 1.0 / (constant + linear * ray.length() + quadratic * ray.length_squared());
        body += strength * color(light.ambient) * color(material.ambient);
        if reach(light, point) > 1.0 {
            continue;
        }
        let shade = *known.shade.get(index).ok_or("the formula needs a shade for each light")?;
        let beam = known.beam.get(index).map_or(DVec3::ONE, |beam| DVec3::from_array(*beam));
        let dimming = dimming(light);
        let l = ray.normalize();
        let n_dot_l = if object.lit { normal.dot(l).max(0.0) } else { 1.0 };
        let diffuse_shade = dimming + (1.0 - dimming) * shade;
        body += strength * diffuse_shade * n_dot_l * beam * color(light.diffuse) * color(material.diffuse);
        if object.lit && n_dot_l > 0.0 {
            let h = (l + (scene.camera.eye - point).normalize()).normalize();
            let power = normal.dot(h).max(0.0).powf(f64::from(material.shininess));
            gloss += strength * shade * power * beam * color(light.specular) * color(material.specular);
        }
    }
    Ok((body * DVec3::from_array(known.decal) + gloss).clamp(DVec3::ZERO, DVec3::ONE))
}

fn dimming(light: &Light) -> f64 {
    let mut keys = light.shadow.written().read();
    keys.number("dimming", 0.0..=1.0).ok().flatten().unwrap_or(0.0)
}

/// The side of the light's map in texels.
pub fn map_size(light: &Light) -> f64 {
    let mut keys = light.shadow.written().read();
    keys.integer("size", 1..=16384).ok().flatten().unwrap_or(1024) as f64
}
