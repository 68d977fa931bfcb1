//! Numbers of a shadow map that keys can step, as in the sample program hw_shadowmaps_simple.

use crate::scene::{Entry, Origin, Settings, Value};

/// A number in a table of `[light.shadow]`.
#[derive(Clone, Copy, Debug)]
pub struct Tweak {
    pub name: &'static str,
    /// Table and key.
    pub table: &'static str,
    pub key: &'static str,
    /// Default if neither is written.
    pub default: f64,
    pub step: f64,
    pub range: [f64; 2],
}

const R_STEP: f64 = 1.0 / 65535.0;

/// All tweaks, in the order in which they are chosen.
pub const TWEAKS: &[Tweak] = &[
    Tweak { name: "r scale", table: "r", key: "scale", default: 0.5, step: R_STEP, range: [-16.0, 16.0] },
    Tweak { name: "r bias", table: "r", key: "bias", default: 0.5, step: R_STEP, range: [-16.0, 16.0] },
    Tweak { name: "polygon offset scale", table: "offset", key: "factor", default: 2.0, step: 0.5, range: [-1e6, 1e6] },
    Tweak { name: "polygon offset bias", table: "offset", key: "units", default: 4.0, step: 1.0, range: [-1e9, 1e9] },
];

impl Tweak {
    /// The value in `shadow`, as written or by default.
    pub fn get(&self, shadow: &Settings) -> f64 {
        let Some(Value::Table(table)) = shadow.get(self.table).map(|entry| &entry.value) else { return self.default };
        match table.get(self.key).map(|entry| &entry.value) {
            Some(Value::Integer(value)) => *value as f64,
            Some(Value::Float(value)) => *value,
            _ => self.default,
        }
    }

    /// Steps the value, and stops at the ends of its range.
    pub fn step(&self, shadow: &mut Settings, steps: f64) {
        let value = (self.get(shadow) + steps * self.step).clamp(self.range[0], self.range[1]);
        let mut table = match shadow.get(self.table).map(|entry| &entry.value) {
            Some(Value::Table(table)) => table.clone(),
            // A missing key of an existing table means 0: write the default.
            _ => {
                TWEAKS.iter().filter(|other| other.table == self.table).fold(Settings::default(), |mut table, other| {
                    table.set(other.key, entry(Value::Float(other.default)));
                    table
                })
            }
        };
        table.set(self.key, entry(Value::Float(value)));
        shadow.set(self.table, entry(Value::Table(table)));
    }

    /// `polygon offset scale = 2.5`; r in steps besides, which are too small to read.
    pub fn in_words(&self, shadow: &Settings) -> String {
        let value = self.get(shadow);
        if self.step < 0.1 {
            let steps = (value - self.default) / self.step;
            format!("{} = {value:.6} ({} {:+.0}/65535)", self.name, self.default, steps)
        } else {
            format!("{} = {value}", self.name)
        }
    }
}

fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_add_up_and_leave_the_other_key_alone() {
        let mut shadow = Settings::default();
        let [scale, bias] = [&TWEAKS[2], &TWEAKS[3]];
        assert_eq!((scale.get(&shadow), bias.get(&shadow)), (2.0, 4.0));
        scale.step(&mut shadow, 1.0);
        bias.step(&mut shadow, -6.0);
        assert_eq!((scale.get(&shadow), bias.get(&shadow)), (2.5, -2.0));
        assert_eq!(scale.in_words(&shadow), "polygon offset scale = 2.5");
        scale.step(&mut shadow, 1e9);
        assert_eq!(scale.get(&shadow), 1e6);
    }

    #[test]
    fn r_is_told_in_steps() {
        let mut shadow = Settings::default();
        TWEAKS[1].step(&mut shadow, -3.0);
        assert_eq!(TWEAKS[1].get(&shadow), 0.5 - 3.0 / 65535.0);
        assert_eq!(TWEAKS[1].in_words(&shadow), "r bias = 0.499954 (0.5 -3/65535)");
    }
}
