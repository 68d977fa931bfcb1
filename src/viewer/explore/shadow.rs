//! Changes of the chosen light's `[light.shadow]`: technique, offset, size of the map, filter.

use super::Explorer;
use crate::scene::{Entry, Origin, Settings, SettingsError, Value};
use crate::techniques::{self, LightShadow, TABLE};

/// Least and greatest side of a map.
const SIDES: [i64; 2] = [1, 16384];

/// Filter and comparisons a side, in the order of their key.
const KERNELS: [(&str, i64); 5] = [("nearest", 1), ("linear", 1), ("linear", 3), ("linear", 5), ("linear", 7)];

impl Explorer {
    /// The chosen light's shadow in words; `None`: the scene has no light.
    pub(super) fn shadow_in_words(&self) -> Option<String> {
        let shadow = &self.scene.lights.get(self.light)?.shadow;
        let read = LightShadow::of(shadow)?;
        let name = read.technique.name();
        let Some(map) = read.map() else { return Some(name.to_owned()) };
        let offset = techniques::map_offset(map).polygon;
        let filter = text(shadow.written(), "filter").unwrap_or("linear");
        let (size, kernel) = (map.size, map.kernel);
        Some(format!("{name} {size}, bias {}, slope {}, {filter} {kernel}x{kernel}", offset.units, offset.factor))
    }

    /// The next technique that serves the light.
    pub(super) fn next_technique(&mut self) {
        let Some(light) = self.scene.lights.get(self.light) else { return self.say_no_light() };
        let place = LightShadow::of(&light.shadow)
            .and_then(|read| TABLE.iter().position(|row| row.name() == read.technique.name()))
            .unwrap_or(0);
        let mut why = String::from("there is no other technique");
        for step in 1..TABLE.len() {
            let name = TABLE[(place + step) % TABLE.len()].name();
            let set = |written: &mut Settings| written.set("technique", entry(Value::String(name.to_owned())));
            match self.change(set) {
                Ok(()) => return,
                Err(error) => why = error.message,
            }
        }
        self.said = Some(why);
    }

    /// Steps `key` of the polygon offset, `units` or `factor`.
    pub(super) fn step_offset(&mut self, key: &'static str, step: f64) {
        let Some(light) = self.scene.lights.get(self.light) else { return self.say_no_light() };
        let Some(map) = LightShadow::of(&light.shadow).and_then(LightShadow::map) else { return self.say_no_map() };
        let offset = techniques::map_offset(map);
        let values = [
            ("factor", f64::from(offset.polygon.factor)),
            ("units", f64::from(offset.polygon.units)),
            ("texels", offset.texels),
        ];
        let mut table = Settings { path: String::from("light.shadow.offset"), ..Settings::default() };
        for (name, value) in values.map(|(name, value)| (name, decimal(value) + if name == key { step } else { 0.0 })) {
            table.set(name, entry(Value::Float(value)));
        }
        let done = self.change(|written| written.set("offset", entry(Value::Table(table))));
        self.say_error(done);
    }

    /// Multiplies the map's side by a power of two.
    pub(super) fn scale_map(&mut self, power: i32) {
        let Some(light) = self.scene.lights.get(self.light) else { return self.say_no_light() };
        let Some(map) = LightShadow::of(&light.shadow).and_then(LightShadow::map) else { return self.say_no_map() };
        let size = (f64::from(map.size) * f64::from(power).exp2()) as i64;
        if size < SIDES[0] || size > SIDES[1] {
            self.said = Some(format!("a map has {} to {} texels a side", SIDES[0], SIDES[1]));
            return;
        }
        let done = self.change(|written| written.set("size", entry(Value::Integer(size))));
        self.say_error(done);
    }

    /// The next filter.
    pub(super) fn next_kernel(&mut self) {
        let Some(light) = self.scene.lights.get(self.light) else { return self.say_no_light() };
        let Some(map) = LightShadow::of(&light.shadow).and_then(LightShadow::map) else { return self.say_no_map() };
        let now = (text(light.shadow.written(), "filter").unwrap_or("linear"), i64::from(map.kernel));
        let place = KERNELS.iter().position(|row| *row == now).map_or(0, |place| place + 1);
        let (filter, kernel) = KERNELS[place % KERNELS.len()];
        let done = self.change(|written| {
            written.set("filter", entry(Value::String(filter.to_owned())));
            written.set("kernel", entry(Value::Integer(kernel)));
        });
        self.say_error(done);
    }

    /// Changes the chosen light's table. If it cannot be read then, it stays as it is.
    fn change(&mut self, change: impl FnOnce(&mut Settings)) -> Result<(), SettingsError> {
        let Some(light) = self.scene.lights.get(self.light) else { return Ok(()) };
        let mut written = light.shadow.written().clone();
        change(&mut written);
        let shadow = techniques::read(written, &light.kind, &self.scene.objects)?;
        self.scene.lights[self.light].shadow = shadow;
        Ok(())
    }

    fn say_error(&mut self, done: Result<(), SettingsError>) {
        if let Err(error) = done {
            self.said = Some(error.message);
        }
    }

    fn say_no_light(&mut self) {
        self.said = Some(String::from("the scene has no light"));
    }

    fn say_no_map(&mut self) {
        self.said = Some(format!("light {} has no shadow map; t: next technique", self.light));
    }
}

/// The value of a key that is a string.
fn text<'a>(written: &'a Settings, key: &str) -> Option<&'a str> {
    match written.get(key).map(|entry| &entry.value) {
        Some(Value::String(text)) => Some(text),
        _ => None,
    }
}

/// A number that was rounded to 32 bits, as a person wrote it: 1.1, not 1.10000002.
fn decimal(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn entry(value: Value) -> Entry {
    Entry { value, origin: Origin::BuiltIn }
}
