//! Allowed ranges of a scene's numbers, if more than one table needs them, as methods of [`Reader`].

use glam::DVec3;

use super::record::ValueForm;
use super::settings::{Origin, Plain, Reader, SettingsError};

/// Greatest length or coordinate of a scene: its square is still a finite f32.
pub const LARGEST: f64 = 1e18;

/// Least length: its square is still a normal f32.
pub const SMALLEST: f64 = 1e-18;

/// Cosines this near to one count as parallel.
const PARALLEL: f64 = 1e-6;

type Result<T> = std::result::Result<T, SettingsError>;

impl<'a> Reader<'a> {
    /// A point or a vector, each coordinate at most [`LARGEST`] in size.
    pub fn vector(&mut self, key: &'static str) -> Result<Option<DVec3>> {
        Ok(self.numbers(key, -LARGEST..=LARGEST)?.map(DVec3::from_array))
    }

    /// A length above zero.
    pub fn length(&mut self, key: &'static str) -> Result<Option<f64>> {
        self.note(key, || ValueForm::Length);
        let Some(value) = self.number(key, f64::MIN..=f64::MAX)? else {
            return Ok(None);
        };
        if value < SMALLEST {
            let least = if value > 0.0 { Plain(SMALLEST) } else { Plain(0.0) };
            return Err(self.error(key, format_args!("must be above {least}, not {}", Plain(value))));
        }
        if value > LARGEST {
            return Err(self.error(key, format_args!("must be at most {}, not {}", Plain(LARGEST), Plain(value))));
        }
        Ok(Some(value))
    }

    /// An angle in degrees, strictly between the ends; radians out.
    pub fn angle_between(&mut self, key: &'static str, low: f64, high: f64) -> Result<Option<f64>> {
        self.note(key, || ValueForm::Angle([low, high]));
        let Some(value) = self.number(key, f64::MIN..=f64::MAX)? else {
            return Ok(None);
        };
        if value <= low || value >= high {
            let message = format!("must be above {low} and below {high} degrees, not {}", Plain(value));
            return Err(self.error(key, message));
        }
        Ok(Some(value.to_radians()))
    }

    /// A file's name with the place that names it; not empty.
    pub fn file(&mut self, key: &'static str) -> Result<Option<(&'a str, &'a Origin)>> {
        self.note(key, || ValueForm::File);
        let Some(name) = self.string(key)? else {
            return Ok(None);
        };
        if name.is_empty() || name.contains('\0') {
            return Err(self.error(key, "must name a file"));
        }
        Ok(self.entry(key).map(|entry| (name, &entry.origin)))
    }

    /// RGB, each channel in [0, `most`].
    pub fn colour(&mut self, key: &'static str, most: f64) -> Result<Option<[f32; 3]>> {
        Ok(self.numbers(key, 0.0..=most)?.map(|channels: [f64; 3]| channels.map(|channel| channel as f32)))
    }

    /// The unit `up` of a view from `from` to `to`, as written or supplied; `keys` names both ends for messages.
    pub fn up(&mut self, keys: [&str; 2], from: DVec3, to: DVec3) -> Result<DVec3> {
        let up = self.vector("up")?;
        let Some(forward) = (to - from).try_normalize() else {
            let message = format!("must differ from `{}`: both are {}", keys[0], point(from));
            return Err(self.error(keys[1], message));
        };
        let Some(up) = up else {
            return Ok(supplied_up(forward));
        };
        let Some(up) = up.try_normalize() else {
            return Err(self.error("up", "must not be of zero length"));
        };
        if up.cross(forward).length() < PARALLEL {
            let message = format!("must not be parallel to the view, from {} to {}", point(from), point(to));
            return Err(self.error("up", message));
        }
        Ok(up)
    }

    /// Near and far distances, as written; `far` above `near` where both are.
    pub fn near_and_far(&mut self) -> Result<[Option<f64>; 2]> {
        let (near, far) = (self.length("near")?, self.length("far")?);
        if let (Some(near), Some(far)) = (near, far) {
            self.check_far(near, far)?;
        }
        Ok([near, far])
    }

    /// Refuses a far plane that is not beyond the near plane, in f32.
    pub fn check_far(&self, near: f64, far: f64) -> Result<()> {
        if (far as f32) > (near as f32) {
            return Ok(());
        }
        Err(self.error("far", format_args!("must be above `near`, {}, not {}", Plain(near), Plain(far))))
    }
}

/// +y; for a view along y, the z axis that keeps +x to the right.
fn supplied_up(forward: DVec3) -> DVec3 {
    if DVec3::Y.cross(forward).length() > 1e-3 {
        DVec3::Y
    } else if forward.y < 0.0 {
        DVec3::NEG_Z
    } else {
        DVec3::Z
    }
}

fn point(point: DVec3) -> String {
    format!("[{}, {}, {}]", Plain(point.x), Plain(point.y), Plain(point.z))
}
