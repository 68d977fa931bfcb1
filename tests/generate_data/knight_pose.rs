//! The knight's joints, and how he stands and runs.

use glam::{DMat3, DVec3, dvec3};

/// Body parts that move as one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    Trunk,
    Head,
    UpperArm(Side),
    Forearm(Side),
    Thigh(Side),
    Shin(Side),
    Foot(Side),
    Shield,
    Sword,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Right,
    Left,
}

/// A rotation, then a movement.
#[derive(Clone, Copy)]
pub struct Place {
    turn: DMat3,
    origin: DVec3,
}

impl Place {
    pub fn of(self, point: DVec3) -> DVec3 {
        self.turn * point + self.origin
    }

    /// A child's place: its joint in this one's space, and its own turn.
    fn child(self, joint: DVec3, turn: DMat3) -> Self {
        Self { turn: self.turn * turn, origin: self.of(joint) }
    }
}

/// Turns by the tangent of half their angle, without a sine.
fn sine_and_cosine(half_tangent: f64) -> (f64, f64) {
    let square = half_tangent * half_tangent;
    (2.0 * half_tangent / (1.0 + square), (1.0 - square) / (1.0 + square))
}

/// Swings what hangs down forwards.
fn swing(half_tangent: f64) -> DMat3 {
    let (sine, cosine) = sine_and_cosine(half_tangent);
    DMat3::from_cols(dvec3(cosine, 0.0, sine), DVec3::Y, dvec3(-sine, 0.0, cosine))
}

/// Lifts what hangs down to the left.
fn lift(half_tangent: f64) -> DMat3 {
    let (sine, cosine) = sine_and_cosine(half_tangent);
    DMat3::from_cols(DVec3::X, dvec3(0.0, cosine, sine), dvec3(0.0, -sine, cosine))
}

/// Turns to the left.
fn turn(half_tangent: f64) -> DMat3 {
    let (sine, cosine) = sine_and_cosine(half_tangent);
    DMat3::from_cols(dvec3(cosine, sine, 0.0), dvec3(-sine, cosine, 0.0), DVec3::Z)
}

/// Sine of an eighth of turns.
pub fn wave(eighths: usize) -> f64 {
    let diagonal = 0.5_f64.sqrt();
    [0.0, diagonal, 1.0, diagonal, 0.0, -diagonal, -1.0, -diagonal][eighths % 8]
}

/// Half tangents of the angles of a pose.
#[derive(Clone, Copy, Default)]
pub struct Pose {
    rise: f64,
    lean: f64,
    twist: f64,
    look: f64,
    /// Right and left.
    arm: [f64; 2],
    elbow: [f64; 2],
    thigh: [f64; 2],
    knee: [f64; 2],
    foot: [f64; 2],
}

pub fn standing(frame: usize) -> Pose {
    let breath = wave(frame);
    Pose {
        rise: 0.15 * breath,
        lean: -0.01 * breath,
        look: 0.25 * wave(frame + 2),
        arm: [0.06 + 0.02 * breath, 0.18 - 0.02 * breath],
        elbow: [0.3, 0.45],
        thigh: [0.07, -0.03],
        knee: [0.03, 0.03],
        ..Pose::default()
    }
}

pub fn running(frame: usize) -> Pose {
    let step = [wave(frame), -wave(frame)];
    // A knee is bent most while its leg comes forwards.
    let bend = [wave(frame + 2), wave(frame + 6)].map(|forwards| 0.18 + 0.3 * forwards.max(0.0));
    Pose {
        rise: 1.2 * (wave(2 * frame + 2)) - 0.8,
        lean: -0.12,
        twist: 0.09 * step[0],
        look: -0.05 * step[0],
        arm: step.map(|step| -0.32 * step),
        elbow: [0.5, 0.62],
        thigh: step.map(|step| 0.12 + 0.36 * step),
        knee: bend,
        foot: step.map(|step| 0.1 * step),
    }
}

impl Pose {
    /// Places of all joints.
    pub fn place(&self, joint: Joint) -> Place {
        let hips = Place { turn: DMat3::IDENTITY, origin: dvec3(0.0, 0.0, self.rise) };
        let index = |side: Side| usize::from(side == Side::Left);
        let sign = |side: Side| if side == Side::Left { 1.0 } else { -1.0 };
        let trunk = || hips.child(DVec3::ZERO, swing(-self.lean) * turn(self.twist));
        let upper_arm = |side: Side| {
            let out = lift(0.09 * sign(side));
            trunk().child(dvec3(0.0, 8.2 * sign(side), 15.5), swing(self.arm[index(side)]) * out)
        };
        let forearm = |side: Side| upper_arm(side).child(dvec3(0.0, 0.0, -8.5), swing(self.elbow[index(side)]));
        let thigh = |side: Side| hips.child(dvec3(0.0, 3.6 * sign(side), -1.0), swing(self.thigh[index(side)]));
        let shin = |side: Side| thigh(side).child(dvec3(0.0, 0.0, -11.0), swing(-self.knee[index(side)]));
        match joint {
            Joint::Trunk => trunk(),
            Joint::Head => trunk().child(dvec3(0.3, 0.0, 18.0), turn(self.look)),
            Joint::UpperArm(side) => upper_arm(side),
            Joint::Forearm(side) => forearm(side),
            Joint::Thigh(side) => thigh(side),
            Joint::Shin(side) => shin(side),
            Joint::Foot(side) => shin(side).child(dvec3(0.0, 0.0, -10.4), swing(self.foot[index(side)])),
            // Across the left forearm, upright.
            Joint::Shield => forearm(Side::Left).child(dvec3(0.6, 2.6, -4.6), swing(-0.42)),
            // In the right fist, pointing forwards.
            Joint::Sword => forearm(Side::Right).child(dvec3(0.0, 0.0, -9.2), swing(0.85)),
        }
    }
}
