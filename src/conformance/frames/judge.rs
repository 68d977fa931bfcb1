//! Holds what a driver drew against the model.

use super::images::{Image, Plane};
use super::model::Drawn;
use crate::conformance::model::number::{Num, SLACK};
use crate::device::{Device, Error, Pixels};
use crate::pass::{Format, ImageId, PassList, Storage};

/// A bound wider than this is no judgement: a sixteenth of what a colour may be, or of all depths.
const WIDEST: f64 = 1.0 / 16.0;

/// Numbers of one frame, or of several.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub judged: usize,
    pub open: usize,
    pub wrong: usize,
    pub first: Option<String>,
}

impl Tally {
    pub fn add(&mut self, other: Self) {
        self.judged += other.judged;
        self.open += other.open;
        self.wrong += other.wrong;
        if self.first.is_none() {
            self.first = other.first;
        }
    }

    fn number(&mut self, due: Num, seen: f64, said: impl FnOnce() -> String) {
        let reach = SLACK * due.error;
        let size = due.value.abs().max(1.0);
        if !due.is_known() || reach > WIDEST * size {
            self.open += 1;
        } else {
            self.judged += 1;
        }
        // A bit of what is read back is lost where it becomes a float.
        let off = (seen - due.value).abs() - 1e-7 * size;
        if due.is_known() && (off.is_nan() || off > reach) {
            self.wrong += 1;
            self.first.get_or_insert_with(|| format!("{}: {seen:?} is not {:?} within {reach:.1e}", said(), due.value));
        }
    }
}

/// Compares every image that passes write.
///
/// # Errors
///
/// An image that the driver cannot read.
pub fn judge(list: &PassList, drawn: &Drawn, device: &mut Device) -> Result<Tally, Error> {
    let mut tally = Tally::default();
    for (index, desc) in list.images.iter().enumerate() {
        let Some(writer) = &drawn.writers[index] else { continue };
        let (image, id) = (&drawn.images[index], ImageId(index));
        let name = format!("{}, last written by {writer}", desc.label);
        let pixels = device.read(list, id)?;
        if let Storage::Cube(_) = desc.storage {
            cube(&mut tally, image, &pixels, &name);
            continue;
        }
        plane(&mut tally, image.plane(0, 0), &pixels, &name);
        if desc.format == Format::Depth24Stencil8 {
            let Pixels::Stencil { data, .. } = device.read_stencil(list, id)? else { continue };
            let [width, height] = image.plane(0, 0).size;
            for (index, due) in image.plane(0, 0).stencil.iter().enumerate() {
                let (x, y) = (index % width, index / width);
                let seen = f64::from(data[(height - 1 - y) * width + x]);
                let due = due.map_or(Num::UNKNOWN, |due| Num::exact(f64::from(due)));
                tally.number(due, seen, || format!("stencil of {name}, pixel ({x}, {y})"));
            }
        }
    }
    Ok(tally)
}

fn plane(tally: &mut Tally, plane: &Plane, pixels: &Pixels, name: &str) {
    let [width, height] = plane.size;
    for y in 0..height {
        for x in 0..width {
            let index = y * width + x;
            let seen = ((height - 1 - y) * width) + x;
            match pixels {
                Pixels::Depth { data, .. } => {
                    let due = plane.depth[index];
                    tally.number(due, f64::from(data[seen]), || format!("{name}, pixel ({x}, {y}), depth"));
                }
                Pixels::Rgba8 { data, .. } => {
                    for channel in 0..4 {
                        let value = f64::from(data[4 * seen + channel]) / 255.0;
                        tally.number(plane.color[index][channel], value, || channel_of(name, [x, y], channel));
                    }
                }
                Pixels::RgbaF32 { data, .. } => {
                    for channel in 0..4 {
                        let value = f64::from(data[4 * seen + channel]);
                        tally.number(plane.color[index][channel], value, || channel_of(name, [x, y], channel));
                    }
                }
                Pixels::Stencil { .. } => {}
            }
        }
    }
}

fn channel_of(name: &str, [x, y]: [usize; 2], channel: usize) -> String {
    format!("{name}, pixel ({x}, {y}), {}", ["red", "green", "blue", "alpha"][channel])
}

/// The faces as the device unfolds them.
fn cube(tally: &mut Tally, image: &Image, pixels: &Pixels, name: &str) {
    const PLACES: [[usize; 2]; 6] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
    let Pixels::Depth { data, .. } = pixels else { return };
    for (face, [column, row]) in PLACES.into_iter().enumerate() {
        let plane = image.plane(0, face);
        let side = plane.size[0];
        for (index, due) in plane.depth.iter().enumerate() {
            let (x, y) = (index % side, index / side);
            let seen = data[(row * side + y) * 4 * side + column * side + x];
            tally.number(*due, f64::from(seen), || format!("face {face} of {name}, pixel ({x}, {y}), depth"));
        }
    }
}
