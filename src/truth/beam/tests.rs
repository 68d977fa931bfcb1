//! Tests of beams against triangles.

use super::*;

#[test]
fn crossing_takes_shared_edges_and_corners_for_both_sides() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::new(0.3, 0.7, 0.1), DVec3::new(0.2, -0.9, -0.1)];
    let origin = DVec3::new(0.3, 0.1, 5.0);
    for target in [a, b, a.lerp(b, 0.3), a.lerp(b, 1.0 / 7.0)] {
        let direction = target - origin;
        let hits = [[a, b, c], [b, a, d]].map(|corners| crossing(origin, direction, &corners));
        assert!(hits.iter().flatten().any(|t| (t - 1.0).abs() < 1e-12), "{target}: {hits:?}");
    }
}

/// From straight above the origin: from a place, and from infinity.
fn beams() -> [Beam; 2] {
    [Apex::At(DVec3::Z * 5.0), Apex::Infinity { travel: DVec3::NEG_Z, length: 9.0 }].map(|apex| Beam {
        apex,
        base: DVec3::ZERO,
        spread: [DVec3::ZERO; 2],
        surface_spread: [DVec3::ZERO; 2],
        slip: [DVec3::ZERO; 2],
        error: 1e-9,
        depth_error: 1e-9,
        start: 0.0,
        levers: true,
    })
}

#[test]
fn a_plain_edge_is_no_fold_and_a_ridge_is_one() {
    for beam in beams() {
        let edge = [DVec3::ZERO, DVec3::Y];
        assert!(!beam.is_fold(edge, DVec3::X, Some(-DVec3::X), 1e-9));
        assert!(beam.is_fold(edge, DVec3::X, Some(DVec3::new(0.5, 0.0, -1.0)), 1e-9));
        assert!(beam.is_fold(edge, DVec3::X, None, 1e-9));
    }
}

#[test]
fn what_is_seen_edge_on_is_missed_from_beside_it() {
    // Planes through the apex, turned any way: rounding alone decides on which side of an edge the third corner lies.
    for turn in 0..500 {
        let (sin, cos) = (0.013 * f64::from(turn)).sin_cos();
        let (apex, ahead) = (DVec3::new(0.3, 0.7, 5.1), DVec3::new(0.3 * sin, 0.2 * cos, -1.0).normalize());
        let aside = ahead.cross(DVec3::new(cos, sin, 0.1)).normalize();
        let along = ahead.cross(aside);
        let corners = [(-0.7, 2.1), (0.1, 3.3), (0.9, 2.7)].map(|(a, b)| apex + b * ahead + a * along);
        let beam = Beam { apex: Apex::At(apex), base: apex + 5.0 * ahead, ..beams()[0] };
        assert!(beam.meet(&corners, 1e-9).is_some(), "{turn}");
        for side in [-0.1, 0.1] {
            let beside = Beam { base: beam.base + side * aside, ..beam };
            assert!(beside.meet(&corners, 1e-9).is_none(), "{turn} {side}");
        }
    }
}

#[test]
fn clipped_is_what_the_parallelogram_sees() {
    for beam in beams() {
        let beam = Beam { spread: [0.2 * DVec3::X, 0.1 * DVec3::Y], ..beam };
        let corners = [DVec3::new(0.0, -9.0, 2.5), DVec3::new(9.0, 0.0, 2.5), DVec3::new(0.0, 9.0, 2.5)];
        let wide = if matches!(beam.apex, Apex::At(_)) { 0.1 } else { 0.2 };
        let clipped = beam.clip(&corners);
        let (min, max) = clipped.iter().fold((clipped[0], clipped[0]), |(a, b), &at| (a.min(at), b.max(at)));
        assert!(min.distance(DVec3::new(0.0, -0.5 * wide, 2.5)) < 1e-12, "{min}");
        assert!(max.distance(DVec3::new(wide, 0.5 * wide, 2.5)) < 1e-12, "{max}");
        assert!(beam.clip(&corners.map(|corner| corner + DVec3::X)).is_empty());
        let right = beam.overlap(clipped, &corners.map(|corner| corner + 0.5 * wide * DVec3::X - DVec3::Z));
        assert!(right.iter().all(|corner| corner.x > 0.0) && right.len() >= 4, "{right:?}");
    }
}

#[test]
fn a_surface_that_may_lie_aside_passes_what_its_place_does_not() {
    for beam in beams() {
        let [from, to] = [DVec3::new(0.01, -1.0, 2.5), DVec3::new(0.01, 1.0, 2.5)];
        assert!(!beam.passes_edge(from, to, 1e-9));
        assert!(Beam { slip: [DVec3::X * 0.03, DVec3::ZERO], ..beam }.passes_edge(from, to, 1e-9));
        assert!(!Beam { slip: [DVec3::Y * 0.03, DVec3::ZERO], ..beam }.passes_edge(from, to, 1e-9));
    }
}

#[test]
fn parallel_beams_meet_what_lies_straight_before_their_base() {
    let [from_place, parallel] = beams();
    // At half the way a point 0.3 aside is in the light's way to 0.6 aside; for parallel light it stays at 0.3.
    let triangle = |x: f64, z: f64| [DVec3::new(x, -1.0, z), DVec3::new(x + 1.0, -1.0, z), DVec3::new(x, 1.0, z)];
    for (beam, base, expected) in [
        (from_place, 0.5, None),
        (from_place, 0.7, Some(0.5)),
        (parallel, 0.25, None),
        (parallel, 0.35, Some(1.0 - 2.5 / 9.0)),
    ] {
        let beam = Beam { base: DVec3::X * base, ..beam };
        let meeting = beam.meet(&triangle(0.3, 2.5), 1e-9);
        assert_eq!(meeting.is_some(), expected.is_some(), "{base}");
        let Some((meeting, expected)) = meeting.zip(expected) else { continue };
        assert!((meeting.center.unwrap() - expected).abs() < 1e-12 && meeting.surely_inside);
        assert_eq!((meeting.at_base, meeting.at_start), (BeamSide::Before, BeamSide::Beyond));
    }
    // Behind the base, and farther up than the segment's own piece: nothing is before its start.
    let behind = parallel.meet(&triangle(-0.2, -1.0), 1e-9).unwrap();
    let far_up = parallel.meet(&triangle(-0.2, 99.0), 1e-9).unwrap();
    assert_eq!([behind, far_up].map(|meeting| meeting.at_base), [BeamSide::Beyond, BeamSide::Before]);
    assert_eq!([behind, far_up].map(|meeting| meeting.at_start), [BeamSide::Beyond; 2]);
}
