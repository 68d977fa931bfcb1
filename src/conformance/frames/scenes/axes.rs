//! Settings and their values, each in turn.

use crate::conformance::random::Random;

/// Values of one setting as lines of a scene file, empty where the default holds. The first word is the setting's name.
pub type Axis = &'static [&'static str];

/// Values that are chosen: of each axis one.
pub type Chosen = Vec<&'static str>;

/// Goes through the values of each axis in an order of its own.
pub struct Turns {
    axes: &'static [Axis],
    /// For each axis, values that have not had their turn.
    left: Vec<Vec<usize>>,
    /// Axis whose value is kept when others vary.
    pinned: usize,
}

impl Turns {
    pub fn new(axes: &'static [Axis]) -> Self {
        Self { axes, left: vec![Vec::new(); axes.len()], pinned: 0 }
    }

    pub fn next(&mut self, dice: &mut Random) -> Chosen {
        self.pinned = (self.pinned + 1) % self.axes.len().max(1);
        let mut chosen = Chosen::new();
        for (axis, left) in self.axes.iter().zip(&mut self.left) {
            if left.is_empty() {
                left.extend(0..axis.len());
            }
            chosen.push(axis[left.swap_remove(dice.below(left.len()))]);
        }
        chosen
    }

    /// Chooses others, all but the one whose turn it is.
    pub fn vary(&self, chosen: &mut Chosen, dice: &mut Random) {
        for (index, axis) in self.axes.iter().enumerate() {
            if index != self.pinned && dice.chance(0.4) {
                chosen[index] = dice.pick(axis);
            }
        }
    }
}
