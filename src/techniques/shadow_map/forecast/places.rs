//! Places of points in the picture and in a map, and lengths of depth there.

use glam::DVec3;

use super::lookup::Receiver;
use super::points::Seen;
use super::texels::Texels;
use crate::lights::LightView;
use crate::lights::box_raster::Sighting;
use crate::lights::projector::{Projector, Rays};
use crate::pass::DepthFormat;

/// Place of a point in the picture.
pub fn sighting(view: &LightView<'_>, point: DVec3) -> Sighting {
    let size = point.abs().max_element() + view.scene.camera.eye.abs().max_element();
    Sighting::new(view.camera.clip_from_world * point.extend(1.0), size)
}

/// A point as a map sees it; `beside`: where the rays of the pixels beside meet its plane.
pub fn receiver(texels: &Texels<'_>, point: &Seen, beside: [DVec3; 2]) -> Receiver {
    let light_from_world = texels.projector().light_from_world;
    let light = light_from_world.transform_point3(point.point);
    let place = texels.place(light).0;
    let across = beside.map(|beside| (texels.place(light_from_world.transform_point3(beside)).0 - place).length());
    Receiver {
        point: light,
        normal: light_from_world.transform_vector3(point.normal),
        pixel_texels: across[0].max(across[1]),
    }
}

/// Tests whether the map shows the point, or what lies at its place beyond the far plane or before the near one.
pub fn is_in(projector: &Projector, point: DVec3) -> bool {
    let clip = projector.clip_from_world() * point.extend(1.0);
    clip.w > 0.0
        && (matches!(projector.rays, Rays::Along(_)) || clip.truncate().truncate().abs().max_element() <= clip.w)
}

/// World units along the axis for one unit of window depth, at a distance along it.
pub fn length_of_depth(projector: &Projector, distance: f64) -> f64 {
    // z = A w - B: depth is (1 + A - B / w) / 2. For parallel light w is 1, and z linear.
    match projector.rays {
        Rays::From { .. } => 2.0 * distance * distance / projector.clip_from_light.w_axis.z.abs(),
        Rays::Along(_) => 2.0 / projector.clip_from_light.z_axis.z.abs(),
    }
}

/// Least difference of depth that is resolved: the format's, and no less than what the comparison's f32 is off by, half a
/// step of 2^-24 in the quotient and as much in each of its two terms and in the stored depth.
pub fn code(format: DepthFormat) -> f64 {
    match format {
        DepthFormat::Depth16 => 1.0 / 65535.0,
        _ => 2.0_f64.powi(-23),
    }
}
