//! The verifiers with values just inside and just outside of their tiers.

use super::Grade::{Allowed, Good, Wrong};
use super::*;

const UNORM16: Encoding = Encoding { bits: 16, stencil_bits: 0, float: false };
const FLOAT: Encoding = Encoding { bits: 32, stencil_bits: 0, float: true };

/// The eight results of `left OP right`.
fn results(order: Ordering) -> [f32; 8] {
    GlCompare::ALL.map(|compare| f32::from(u8::from(compare.holds(order))))
}

#[test]
fn tiers_of_a_distance() {
    for (distance, grade) in [(1.0, Good), (-1.0, Good), (1.001, Allowed), (2.0, Allowed), (-2.001, Wrong)] {
        assert_eq!(within(distance, 1.0, 2.0), grade, "{distance}");
    }
    assert_eq!(within(f64::NAN, 1.0, 2.0), Wrong);
}

#[test]
fn comparisons_are_of_one_order() {
    let near = NEAR_TIE * 0.99;
    let cases = [
        (Ordering::Less, 0.25, 0.5, 0.0, Good),
        (Ordering::Equal, 0.25, 0.5, NEAR_TIE, Wrong),
        (Ordering::Equal, 0.5, 0.5, 0.0, Good),
        (Ordering::Greater, 0.5, 0.5, 0.0, Wrong),
        (Ordering::Equal, 0.5 + near, 0.5, NEAR_TIE, Allowed),
        (Ordering::Less, 0.5 + near, 0.5, NEAR_TIE, Allowed),
        (Ordering::Less, 0.5 + 1.01 * NEAR_TIE, 0.5, NEAR_TIE, Wrong),
        (Ordering::Less, 0.5, 0.5, NEAR_TIE, Allowed),
    ];
    for (order, reference, stored, error, grade) in cases {
        assert_eq!(comparisons(results(order), reference, stored, error), grade, "{order:?} {reference} {stored}");
    }
    let mut mixed = results(Ordering::Less);
    mixed[3] = 0.0; // LEQUAL fails although LESS holds
    assert_eq!(comparisons(mixed, 0.5, 0.5, NEAR_TIE), Wrong, "no order explains these");
}

#[test]
fn filtered_comparisons() {
    let half = [true, false, true, false];
    let slack = 1.0 / 32.0 + 1.0 / 128.0 + 1.0 / 512.0;
    let error = 1.0 / 32.0 + 1.0 / 512.0;
    let cases = [
        (0.75, half, Good),
        (0.75 + slack - 1e-6, half, Good),
        (0.75 + slack + 1e-6, half, Allowed),
        // The nearest texel alone, and the mean of four.
        (1.0, half, Allowed),
        (0.5, half, Allowed),
        (0.5 - error + 1e-6, half, Allowed),
        (0.5 - error - 1e-6, half, Wrong),
        // Filtered first: the one texel that passes weighs an eighth, and yet decides.
        (1.0, [false, true, false, false], Wrong),
        (0.99, [true; 4], Wrong),
        (0.999, [true; 4], Good),
        (0.0, [false; 4], Good),
        (0.1, [false; 4], Wrong),
        (f64::NAN, half, Wrong),
    ];
    for (value, passes, grade) in cases {
        assert_eq!(filtered(value, passes, [0.25, 0.5]), grade, "{value} {passes:?}");
    }
}

#[test]
fn depth_codes() {
    let code = |k: f64| k / 65535.0;
    let cases = [
        (code(100.0), code(100.4), UNORM16, Good),
        (code(101.0), code(100.4), UNORM16, Allowed),
        (code(102.0), code(100.4), UNORM16, Wrong),
        (code(99.0), code(100.6), UNORM16, Wrong),
        (1.0, 1.5, UNORM16, Good),
        (code(65534.0), 1.0, UNORM16, Wrong),
        (code(1.0), 0.0, UNORM16, Wrong),
        (0.75, 0.75, FLOAT, Good),
        (0.75 + 2f64.powi(-24), 0.75, FLOAT, Allowed),
        (0.75 + 2f64.powi(-23), 0.75, FLOAT, Wrong),
        (1e-4 + 2f64.powi(-24), 1e-4, FLOAT, Allowed),
        (1e-4 + 2f64.powi(-23), 1e-4, FLOAT, Wrong),
    ];
    for (stored, depth, encoding, grade) in cases {
        assert_eq!(depth_code(stored, depth, encoding), grade, "{stored} for {depth}");
    }
}

#[test]
fn depths_of_planes() {
    let strict = 2f64.powi(-22) * 1.5 + 1.0 / 65535.0;
    let allowed = strict + 0.25 / 256.0;
    for (error, grade) in [(strict, Good), (strict * 1.001, Allowed), (-allowed, Allowed), (allowed * 1.001, Wrong)] {
        assert_eq!(plane_depth(error, [0.125, -0.125], 8, UNORM16), grade, "{error}");
    }
}

#[test]
fn offsets() {
    for (m, grade) in [(0.4, Good), (0.5, Good), (0.3995, Allowed), (0.45, Good), (0.361, Allowed), (0.359, Wrong)] {
        assert_eq!(offset_slope(m, [0.3, -0.4]), grade, "{m}");
    }
    assert_eq!(offset_slope(0.549, [0.3, 0.4]), Allowed);
    assert_eq!(offset_slope(0.551, [0.3, 0.4]), Wrong);
    let cases =
        [(1.0, Good), (1.02, Allowed), (1.9999, Allowed), (2.0, Allowed), (2.01, Wrong), (0.98, Wrong), (0.0, Wrong)];
    for (steps, grade) in cases {
        assert_eq!(offset_unit(steps), grade, "{steps}");
    }
}

#[test]
fn offsets_are_told_to_half_a_unit_or_a_code() {
    // A unit of two codes, of one, and one that moves nothing.
    for (units, due, step, grade) in [
        (64.4, 64.0, 0.5, Good),
        (64.6, 64.0, 0.5, Wrong),
        (64.9, 64.0, 1.0, Good),
        (66.0, 64.0, 1.0, Wrong),
        (64.0, 0.0, 1.0, Wrong),
        (f64::INFINITY, 64.0, f64::INFINITY, Wrong),
        (f64::NAN, 64.0, f64::INFINITY, Wrong),
    ] {
        assert_eq!(offset_moves(units, due, step), grade, "{units} for {due}");
    }
}

#[test]
fn eight_bit_codes() {
    let cases =
        [(128, 127.6, Good), (127, 127.6, Allowed), (126, 127.6, Wrong), (129, 127.9, Wrong), (255, 400.0, Good)];
    for (code, value, grade) in cases {
        assert_eq!(unorm8(code, value / 255.0), grade, "{code} for {value}");
    }
}

#[test]
fn stencil_values() {
    let cases = [
        (GlStencilOp::Increment, 255, 0, 0xFF, 255),
        (GlStencilOp::IncrementWrap, 255, 0, 0xFF, 0),
        (GlStencilOp::Increment, 0x0F, 0, 0x0F, 0),
        (GlStencilOp::Replace, 0, 0xAB, 0x0F, 0x0B),
        (GlStencilOp::Replace, 0, 300, 0xFF, 255),
        (GlStencilOp::Replace, 7, -1, 0xFF, 0),
        (GlStencilOp::Decrement, 0, 0, 0xFF, 0),
        (GlStencilOp::DecrementWrap, 0, 0, 0xFF, 255),
        (GlStencilOp::Invert, 0x0F, 0, 0xF0, 0xFF),
        (GlStencilOp::Keep, 9, 1, 0xFF, 9),
        (GlStencilOp::Zero, 0xFF, 1, 0x0F, 0xF0),
    ];
    for (op, old, reference, mask, new) in cases {
        assert_eq!(stencil(op, old, reference, mask), new, "{op:?} of {old}");
    }
    assert!(stencil_passes(GlCompare::Less, 3, 4, 0xFF));
    assert!(!stencil_passes(GlCompare::Less, 4, 3, 0xFF));
    assert!(stencil_passes(GlCompare::Equal, 300, 255, 0xFF));
    assert!(stencil_passes(GlCompare::Equal, 0x13, 0x23, 0x0F));
}

#[test]
fn coverage_of_either_winding() {
    let corners = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
    let turned = [corners[0], corners[2], corners[1]];
    for corners in [corners, turned] {
        assert_eq!(covers(corners, [2.0, 2.0], 0.01), Some(true));
        assert_eq!(covers(corners, [2.0, 0.02], 0.01), Some(true));
        assert_eq!(covers(corners, [2.0, 0.005], 0.01), None);
        assert_eq!(covers(corners, [2.0, -0.02], 0.01), Some(false));
        assert_eq!(covers(corners, [6.0, 6.0], 0.01), Some(false));
        assert_eq!(covers(corners, [20.0, 0.0], 0.01), Some(false), "on an edge's line, and beyond another");
    }
}
