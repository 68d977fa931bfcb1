//! Bounds of a volume are never too small: random boxes, lights and eyes against volumes built and sampled.

use glam::{DMat4, DVec3};
use glumbra::geometry::volume::{CameraHulls, LightSource, VolumeHulls, scissor};
use glumbra::math::Aabb;
use glumbra::math::hull::Hull;
use glumbra::math::spaces::{perspective, view_from_world};

use super::homogeneous::Random;

/// Tests whether the way from the light to `point` meets the box.
fn is_behind(bounds: &Aabb, source: LightSource, point: DVec3) -> bool {
    let way = match source {
        LightSource::Point(light) => light - point,
        LightSource::Direction(way) => way * 1e3,
    };
    let (mut near, mut far) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        let (a, b) = ((bounds.min[axis] - point[axis]) / way[axis], (bounds.max[axis] - point[axis]) / way[axis]);
        (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
    }
    near <= far
}

#[test]
fn bounds_never_deny_what_is_there() {
    let mut yes = [0; 4];
    let mut no = [0; 4];
    for seed in 0..3000 {
        let mut random = Random::new(seed);
        let center = random.vector(2.0);
        let half = DVec3::new(1.1 + random.unit(), 1.1 + random.unit(), 1.1 + random.unit()) * 0.3;
        let bounds = Aabb { min: center - half, max: center + half };
        let source = if seed % 3 == 0 {
            LightSource::Direction(random.vector(1.0))
        } else {
            LightSource::Point(random.vector(3.0))
        };
        // Half of the eyes stand about where the shadow falls.
        let behind = center + source.away(center).normalize() * (1.0 + random.unit()) * 2.0;
        let eye = if seed % 2 == 0 { random.vector(3.0) } else { behind + random.vector(0.4) };
        let place = DMat4::from_rotation_z(random.unit()) * DMat4::from_scale(DVec3::new(-1.0, 1.2, 0.7));
        let clip = perspective(0.8, 1.4, 0.1, 12.0) * view_from_world(eye, eye + random.vector(1.0), DVec3::Y);
        // All in the box's own space; the tests are told of the world's.
        let (clip_from_box, box_source) = (clip * place, source.transformed(&place.inverse()));
        let (viewer, casting) = (CameraHulls::new(&clip), VolumeHulls::new(&bounds, &place, source));
        let said = [
            casting.may_hold_near(&viewer),
            casting.may_shadow_view(&viewer),
            casting.light_cap_may_be_seen(&viewer),
            casting.far_cap_may_be_seen(&viewer),
        ];
        let box_from_clip = clip_from_box.inverse();
        let mut found = [false; 4];
        for _ in 0..60 {
            let ndc = random.vector(1.0);
            let near = box_from_clip.project_point3(ndc.with_z(-1.0));
            found[0] |= is_behind(&bounds, box_source, near);
            // Evenly in depth, not in window depth.
            let inside = near.lerp(box_from_clip.project_point3(ndc.with_z(1.0)), random.unit().abs());
            found[1] |= is_behind(&bounds, box_source, inside);
            let point = center + half * random.vector(1.0);
            let seen = clip_from_box * point.extend(1.0);
            found[2] |= seen.truncate().abs().max_element() <= seen.w;
            let end = clip_from_box * box_source.away(point).extend(0.0);
            found[3] |= end.truncate().truncate().abs().max_element() <= end.w;
        }
        for k in 0..4 {
            assert!(said[k] || !found[k], "seed {seed}, test {k}");
            yes[k] += u32::from(said[k] && found[k]);
            no[k] += u32::from(!said[k]);
        }
    }
    println!("there {yes:?}, denied {no:?} of 3000");
    // They say no often enough to be of use.
    assert!(yes.iter().all(|count| *count > 100) && no.iter().all(|count| *count > 300));
}

#[test]
fn scissors_hold_every_pixel_of_the_hull() {
    let mut outside = 0;
    for seed in 0..2000 {
        let mut random = Random::new(seed);
        let eye = random.vector(2.0);
        let clip = perspective(1.1, 1.5, 0.05, 20.0) * view_from_world(eye, eye + random.vector(1.0), DVec3::Y);
        let apex = random.vector(2.0);
        let corners: Vec<DVec3> = [apex].into_iter().chain((0..4).map(|_| random.vector(3.0))).collect();
        let found = scissor(&corners, &clip, [150, 100]);
        outside += u32::from(found.is_none());
        for _ in 0..50 {
            let weights: Vec<f64> = corners.iter().map(|_| random.unit().abs().powi(4)).collect();
            let sum: f64 = weights.iter().sum();
            let point: DVec3 = corners.iter().zip(&weights).map(|(corner, weight)| *corner * (weight / sum)).sum();
            let seen = clip * point.extend(1.0);
            if seen.truncate().abs().max_element() > seen.w {
                continue;
            }
            let pixel = [75.0 * (seen.x / seen.w + 1.0), 50.0 * (seen.y / seen.w + 1.0)].map(|v| v.floor() as u32);
            let [x, y, width, height] = found.expect("a point is seen");
            assert!((x..x + width).contains(&pixel[0]) && (y..y + height).contains(&pixel[1]), "{seed}");
        }
    }
    assert!(outside > 100);
}

#[test]
fn a_caster_out_of_the_lights_reach_does_not_matter() {
    let base = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| DVec3::new(x, -4.0, z));
    let reach = Hull::pyramid(DVec3::ZERO, &base);
    let source = LightSource::Point(DVec3::ZERO);
    for (center, expected) in
        [(DVec3::NEG_Y * 2.0, true), (DVec3::NEG_Y * 4.3, false), (DVec3::new(0.9, -2.0, 0.0), false)]
    {
        let bounds = Aabb { min: center - 0.2, max: center + 0.2 };
        let casting = VolumeHulls::new(&bounds, &DMat4::IDENTITY, source);
        assert_eq!(casting.may_matter_within(&reach), expected, "{center}");
    }
}
