//! `frame`, `frames`, `blend` and `normals` of an object with a key-framed model.

use crate::geometry::md2::{Model, NormalSource, Pose};
use crate::scene::settings::{Entry, Reader, SettingsError, Value, suggest};

/// Keys that only key-framed models have.
const KEYS: [&str; 4] = ["frame", "frames", "blend", "normals"];

/// The keys as written; a pose as soon as the model is known.
pub(in crate::scene) struct WrittenPose<'a> {
    reader: Reader<'a>,
    frame: Option<&'a Entry>,
    frames: Option<&'a [Entry]>,
    blend: f64,
    source: NormalSource,
}

impl<'a> WrittenPose<'a> {
    /// Reads the keys of an object's table. `reader`: of the same table, for messages.
    pub fn read(object: &mut Reader<'a>, reader: Reader<'a>) -> Result<Self, SettingsError> {
        let frame = object.entry("frame");
        let frames = match object.entry("frames").map(|entry| &entry.value) {
            None => None,
            Some(Value::Array(items)) if items.len() == 2 => Some(items.as_slice()),
            Some(_) => return Err(object.error("frames", "must be an array of two frames, names or numbers")),
        };
        let blend = object.number("blend", 0.0..=1.0)?;
        if frame.is_some() && frames.is_some() {
            return Err(object.error("frame", "and `frames` exclude each other: write one of them"));
        }
        if blend.is_some() && frames.is_none() {
            return Err(object.error("blend", "needs `frames`: the two that it lies between"));
        }
        let choices = [("file", NormalSource::File), ("recomputed", NormalSource::Recomputed)];
        let source = object.choice("normals", &choices)?.unwrap_or_default();
        Ok(Self { reader, frame, frames, blend: blend.unwrap_or(0.0), source })
    }

    /// Refuses each key for a mesh that has one pose only.
    pub fn refuse(&self) -> Result<(), SettingsError> {
        self.reader.refuse(&KEYS, "belongs to key-framed models: the object's mesh is no .md2 file")
    }

    /// The pose of `model`, and where its normals come from.
    pub fn resolve(&self, model: &Model) -> Result<(Pose, NormalSource), SettingsError> {
        let pose = match (self.frames, self.frame) {
            (Some([first, second]), _) => {
                let frames = [self.whole("frames", first, model)?, self.whole("frames", second, model)?];
                Pose { frames, blend: self.blend }
            }
            (_, Some(entry)) => match &entry.value {
                Value::Float(at) => self.between(*at, model)?,
                _ => Pose { frames: [self.whole("frame", entry, model)?; 2], blend: 0.0 },
            },
            _ => Pose::default(),
        };
        Ok((pose, self.source))
    }

    /// A frame by its number or its name.
    fn whole(&self, key: &str, entry: &Entry, model: &Model) -> Result<usize, SettingsError> {
        match &entry.value {
            Value::Integer(number) => usize::try_from(*number)
                .ok()
                .filter(|number| *number < model.frame_count())
                .ok_or_else(|| self.beyond(key, number, model)),
            Value::String(name) => model.frame_named(name).ok_or_else(|| {
                let names: Vec<String> = model.file().frames.iter().map(|frame| frame.name()).collect();
                let hint = suggest(name, names.iter().map(String::as_str));
                self.reader.error(key, format_args!("names no frame of the model, \"{name}\": {hint}"))
            }),
            _ => Err(self.reader.error(key, "must be the number or the name of a frame")),
        }
    }

    /// The pose at a number between two frames' numbers.
    fn between(&self, at: f64, model: &Model) -> Result<Pose, SettingsError> {
        let last = model.frame_count() - 1;
        if !(0.0..=last as f64).contains(&at) {
            return Err(self.beyond("frame", &at, model));
        }
        let first = (at.floor() as usize).min(last);
        Ok(Pose { frames: [first, (first + 1).min(last)], blend: at - first as f64 })
    }

    fn beyond(&self, key: &str, number: &dyn std::fmt::Display, model: &Model) -> SettingsError {
        let last = model.frame_count() - 1;
        self.reader.error(key, format_args!("must be a frame from 0 to {last}, not {number}"))
    }
}
