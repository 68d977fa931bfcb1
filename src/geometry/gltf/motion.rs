//! Animation of a glTF: translations, rotations, scales and weights of nodes at a time [Khronos, "glTF 2.0 Specification",
//! 3.11 and appendix C].

use std::collections::HashMap;

use glam::DQuat;
use gltf::json::animation::{Animation, Channel, Interpolation, Property};
use gltf::json::validation::Checked;

use super::super::{Error, Moment};
use super::accessor::{FLOATS, NUMBERS};
use super::file::File;

/// Values that an animation sets of a node.
#[derive(Clone, Debug, Default)]
pub(super) struct NodeMotion {
    pub translation: Option<[f64; 3]>,
    /// x, y, z, w, of unit length.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub weights: Option<Vec<f64>>,
}

/// Values that are set, by the node's number.
pub(super) type Motion = HashMap<usize, NodeMotion>;

impl File {
    /// The values that an animation gives to nodes at a moment.
    ///
    /// # Errors
    ///
    /// A file without animations, or without one of that name; one whose keys are wrong.
    pub fn motion(&self, moment: &Moment) -> Result<Motion, Error> {
        let (index, animation) = self.animation(moment)?;
        let mut motion = Motion::new();
        for (at, channel) in animation.channels.iter().enumerate() {
            let place = format!("animations[{index}].channels[{at}]");
            let node = channel.target.node;
            // A target without a node belongs to an extension; the crate reads none as an error.
            self.get(node, &place, "nodes")?;
            let set = motion.entry(node.value()).or_default();
            self.apply(channel, animation, &place, moment.seconds, set)?;
        }
        Ok(motion)
    }

    /// The time of the last key of the first animation; 0: there is none. Keys that are wrong are left out: [`File::motion`] says
    /// so of those that are used.
    pub fn seconds(&self) -> f64 {
        let samplers = self.root.animations.first().into_iter().flat_map(|animation| &animation.samplers);
        let times = samplers.filter_map(|sampler| self.vectors::<1>(sampler.input, "animations[0]", FLOATS).ok());
        times.flatten().fold(0.0, |last, [time]| f64::max(last, time))
    }

    fn animation(&self, moment: &Moment) -> Result<(usize, &Animation), Error> {
        let mut all = self.root.animations.iter().enumerate();
        let Some(wanted) = &moment.animation else {
            return all
                .next()
                .ok_or_else(|| self.error("animations", "there is none, and `at` asks for a time of one"));
        };
        let found = all.find(|(_, animation)| animation.name.as_deref() == Some(wanted));
        found.ok_or_else(|| {
            let names: Vec<&str> = self.root.animations.iter().filter_map(|known| known.name.as_deref()).collect();
            let known = if names.is_empty() { String::from("none has a name") } else { names.join(", ") };
            self.error("animations", format!("none is called \"{wanted}\": {known}"))
        })
    }

    fn apply(
        &self,
        channel: &Channel,
        animation: &Animation,
        place: &str,
        seconds: f64,
        set: &mut NodeMotion,
    ) -> Result<(), Error> {
        let Some(sampler) = animation.samplers.get(channel.sampler.value()) else {
            return Err(
                self.error(place, format!("names samplers[{}], which it does not have", channel.sampler.value()))
            );
        };
        let Checked::Valid(property) = channel.target.path else {
            return Err(self.error(format!("{place}.target.path"), "is none of translation, rotation, scale, weights"));
        };
        let Checked::Valid(interpolation) = sampler.interpolation else {
            return Err(self.error(place, "has an interpolation that is none of LINEAR, STEP, CUBICSPLINE"));
        };
        let times: Vec<f64> = self.vectors::<1>(sampler.input, place, FLOATS)?.into_iter().map(|[time]| time).collect();
        if times.is_empty() || !times.is_sorted_by(|before, after| before < after) {
            return Err(self.error(place, "needs keys whose times grow"));
        }
        let output = sampler.output;
        let values: Vec<f64> = match property {
            Property::Translation | Property::Scale => self.vectors::<3>(output, place, NUMBERS)?.concat(),
            Property::Rotation => self.vectors::<4>(output, place, NUMBERS)?.concat(),
            Property::MorphTargetWeights => self.vectors::<1>(output, place, NUMBERS)?.concat(),
        };
        let rows = if interpolation == Interpolation::CubicSpline { 3 * times.len() } else { times.len() };
        let width = values.len() / rows;
        if width == 0 || values.len() != width * rows {
            let what = format!("has {} numbers for {} keys", values.len(), times.len());
            return Err(self.error(place, what));
        }
        let is_fixed = |fixed: usize| property == Property::MorphTargetWeights || width == fixed;
        if !is_fixed(if property == Property::Rotation { 4 } else { 3 }) {
            return Err(self.error(place, format!("has {width} numbers a key")));
        }
        let keys = Keys { times: &times, values: &values, width, interpolation };
        let is_turn = property == Property::Rotation;
        let found = keys.at(seconds, is_turn);
        match (property, &found[..]) {
            (Property::Translation, [x, y, z]) => set.translation = Some([*x, *y, *z]),
            (Property::Scale, [x, y, z]) => set.scale = Some([*x, *y, *z]),
            (Property::Rotation, [x, y, z, w]) => {
                let length = [x, y, z, w].iter().map(|part| *part * *part).sum::<f64>().sqrt();
                if length == 0.0 {
                    return Err(self.error(place, "has a rotation without a length"));
                }
                set.rotation = Some([x / length, y / length, z / length, w / length]);
            }
            _ => set.weights = Some(found),
        }
        Ok(())
    }
}

/// Keys of a channel, `width` numbers each; three times as many of a cubic spline: tangent in, value, tangent out.
struct Keys<'a> {
    times: &'a [f64],
    values: &'a [f64],
    width: usize,
    interpolation: Interpolation,
}

impl Keys<'_> {
    /// The values at a time; `is_turn`: they are a quaternion.
    fn at(&self, seconds: f64, is_turn: bool) -> Vec<f64> {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|time| *time <= seconds);
        let (before, after) = (after.saturating_sub(1), after.min(last));
        if before == after || self.times[before] > seconds || self.interpolation == Interpolation::Step {
            return self.value(before).to_vec();
        }
        let span = self.times[after] - self.times[before];
        let share = (seconds - self.times[before]) / span;
        let (from, to) = (self.value(before), self.value(after));
        if self.interpolation == Interpolation::CubicSpline {
            let (leaving, coming) = (self.row(3 * before + 2), self.row(3 * after));
            let (square, cube) = (share * share, share * share * share);
            let blend = |k: usize| {
                (2.0 * cube - 3.0 * square + 1.0) * from[k]
                    + span * (cube - 2.0 * square + share) * leaving[k]
                    + (3.0 * square - 2.0 * cube) * to[k]
                    + span * (cube - square) * coming[k]
            };
            return (0..self.width).map(blend).collect();
        }
        match (is_turn, <[f64; 4]>::try_from(from), <[f64; 4]>::try_from(to)) {
            // glam takes the shorter way.
            (true, Ok(from), Ok(to)) => {
                let unit = |numbers| DQuat::from_array(numbers).normalize();
                let turned = unit(from).slerp(unit(to), share);
                if turned.is_finite() { turned.to_array().to_vec() } else { vec![0.0; 4] }
            }
            _ => from.iter().zip(to).map(|(from, to)| from + share * (to - from)).collect(),
        }
    }

    fn value(&self, key: usize) -> &[f64] {
        self.row(if self.interpolation == Interpolation::CubicSpline { 3 * key + 1 } else { key })
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.width..(row + 1) * self.width]
    }
}
