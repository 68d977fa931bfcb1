//! Options before an MTL map's file name: those that are applied, and those that are ignored. Format: Wavefront's "MTL
//! material format", version 4.2, "Options for texture map statements".

use super::obj::corner::shorten;
use super::{Placement, Texture};

/// Greatest scale or offset of texture coordinates.
const LARGEST: f32 = 1e6;

/// The value of a map statement.
#[derive(Debug, Default, PartialEq)]
pub(super) struct MapOptions<'a> {
    /// -s, -o and -clamp.
    pub placement: Placement,
    pub values: Values,
    /// Options that change nothing here, as written.
    pub left_out: Vec<&'a str>,
    /// The file, whose name may hold spaces; empty: none is named.
    pub file: &'a str,
}

/// Change of a texture's values before it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Values {
    /// -imfchan; `None`: alpha, or red where all is opaque.
    pub channel: Option<Channel>,
    /// -mm: added to the product of the value and the gain.
    pub base: f32,
    pub gain: f32,
}

impl Default for Values {
    fn default() -> Self {
        Self { channel: None, base: 0.0, gain: 1.0 }
    }
}

/// Channel of a scalar texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    Red,
    Green,
    Blue,
    /// The picture's alpha.
    Matte,
    Luminance,
}

impl Channel {
    /// Value of a texel, in [0, 255].
    fn of(self, [r, g, b, a]: [u8; 4]) -> f32 {
        match self {
            Self::Red => f32::from(r),
            Self::Green => f32::from(g),
            Self::Blue => f32::from(b),
            Self::Matte => f32::from(a),
            // Rec. 709's weights.
            Self::Luminance => 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b),
        }
    }
}

impl Values {
    fn apply(self, value: f32) -> u8 {
        (255.0 * self.base + self.gain * value).round().clamp(0.0, 255.0) as u8
    }

    /// A colour texture with its values changed; its alpha stays.
    pub fn of_color(self, texture: &Texture) -> Texture {
        let texel = |texel: &[u8; 4]| {
            let [r, g, b] = [0, 1, 2].map(|k| self.apply(f32::from(texel[k])));
            [r, g, b, texel[3]]
        };
        let rgba = texture.rgba.as_chunks::<4>().0.iter().flat_map(texel).collect();
        Texture { name: format!("{}, -mm {} {}", texture.name, self.base, self.gain), rgba, ..texture.clone() }
    }

    /// The scalar texture in red; opaque.
    pub fn of_scalar(self, texture: &Texture) -> Texture {
        let channel = match self.channel {
            Some(channel) => channel,
            None if texture.has_alpha => Channel::Matte,
            None => Channel::Red,
        };
        let texel = |texel: &[u8; 4]| {
            let value = self.apply(channel.of(*texel));
            [value, value, value, 255]
        };
        let rgba = texture.rgba.as_chunks::<4>().0.iter().flat_map(texel).collect();
        let name = format!("{}, {channel:?} by {} and {}", texture.name, self.gain, self.base).to_lowercase();
        Texture { name, rgba, has_alpha: false, ..texture.clone() }
    }
}

impl<'a> MapOptions<'a> {
    /// Reads the value of `statement`.
    pub fn read(statement: &str, value: &'a str) -> Result<Self, String> {
        let mut out = Self::default();
        let mut rest = value;
        while rest.starts_with('-') {
            let (option, after) = split_word(rest);
            let Some(after) = out.read_option(option, after).map_err(|what| format!("{statement} {option}: {what}"))?
            else {
                break;
            };
            rest = after;
        }
        out.file = rest;
        Ok(out)
    }

    /// Reads one option and returns the rest of the line; `None`: this is a file name that begins with a dash.
    fn read_option(&mut self, option: &'a str, mut rest: &'a str) -> Result<Option<&'a str>, String> {
        match option.to_ascii_lowercase().as_str() {
            "-s" => self.placement.scale = pair(&mut rest, 1.0)?,
            "-o" => self.placement.offset = pair(&mut rest, 0.0)?,
            "-t" => {
                pair(&mut rest, 0.0)?;
                self.left_out.push(option);
            }
            "-clamp" => self.placement.clamped = switch(&mut rest)?,
            "-mm" => (self.values.base, self.values.gain) = (number(&mut rest)?, number(&mut rest)?),
            "-imfchan" => match channel(word(&mut rest))? {
                Some(channel) => self.values.channel = Some(channel),
                None => self.left_out.push(option),
            },
            "-cc" => self.left_out.extend(switch(&mut rest)?.then_some(option)),
            "-blendu" | "-blendv" => self.left_out.extend((!switch(&mut rest)?).then_some(option)),
            "-bm" | "-boost" => {
                number(&mut rest)?;
                self.left_out.push(option);
            }
            "-texres" | "-type" => {
                word(&mut rest);
                self.left_out.push(option);
            }
            _ => return Ok(None),
        }
        Ok(Some(rest))
    }
}

/// Splits off the first word and the space after it.
fn split_word(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| c.is_ascii_whitespace()).unwrap_or(text.len());
    (&text[..end], text[end..].trim_start())
}

fn word<'a>(rest: &mut &'a str) -> &'a str {
    let (word, after) = split_word(rest);
    *rest = after;
    word
}

fn number(rest: &mut &str) -> Result<f32, String> {
    let word = word(rest);
    match word.parse::<f32>() {
        Ok(value) if value.abs() <= LARGEST => Ok(value),
        Ok(_) => Err(format!("'{}' is not in [-{LARGEST}, {LARGEST}]", shorten(word))),
        Err(_) => Err(format!("'{}' is not a number", shorten(word))),
    }
}

/// One to three numbers, of which the third is for textures in space.
fn pair(rest: &mut &str, absent: f32) -> Result<[f32; 2], String> {
    let mut out = [number(rest)?, absent, absent];
    for value in &mut out[1..] {
        if split_word(rest).0.parse::<f32>().is_err() {
            break;
        }
        *value = number(rest)?;
    }
    Ok([out[0], out[1]])
}

fn switch(rest: &mut &str) -> Result<bool, String> {
    match word(rest) {
        "on" => Ok(true),
        "off" => Ok(false),
        other => Err(format!("'{}' is neither on nor off", shorten(other))),
    }
}

/// The channel of a word; `None`: pictures here have no such channel.
fn channel(word: &str) -> Result<Option<Channel>, String> {
    match word {
        "r" => Ok(Some(Channel::Red)),
        "g" => Ok(Some(Channel::Green)),
        "b" => Ok(Some(Channel::Blue)),
        "m" => Ok(Some(Channel::Matte)),
        "l" => Ok(Some(Channel::Luminance)),
        "z" => Ok(None),
        other => Err(format!("'{}' is none of r, g, b, m, l, z", shorten(other))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_stand_in_front_of_a_file() {
        for (value, file) in [
            ("wood.png", "wood.png"),
            ("my wood.png", "my wood.png"),
            ("-s 1 1 1 wood.png", "wood.png"),
            ("-s 2 wood.png", "wood.png"),
            ("-clamp on -o 0.5 0 -mm 0 1 my wood.png", "my wood.png"),
            ("-imfchan r -bm 0.5 a.png", "a.png"),
            ("-odd.png", "-odd.png"),
            ("-s 1 1 1", ""),
        ] {
            assert_eq!(MapOptions::read("map_Kd", value).unwrap().file, file, "{value}");
        }
    }

    #[test]
    fn options_are_applied_or_left_out() {
        let text = "-blendu off -cc off -s 2 -o 0.5 -0.25 7 -clamp on -mm 0.25 0.5 -imfchan g -bm 3 -T 1 1 1 a b.png";
        let options = MapOptions::read("map_d", text).unwrap();
        assert_eq!(options.placement, Placement { scale: [2.0, 1.0], offset: [0.5, -0.25], clamped: true });
        assert_eq!(options.values, Values { channel: Some(Channel::Green), base: 0.25, gain: 0.5 });
        assert_eq!((options.left_out, options.file), (vec!["-blendu", "-bm", "-T"], "a b.png"));
    }

    #[test]
    fn wrong_options_are_refused() {
        for (value, what) in [
            ("-s wood.png", "map_Kd -s: 'wood.png' is not a number"),
            ("-o inf a.png", "map_Kd -o: 'inf' is not in"),
            ("-clamp a.png", "map_Kd -clamp: 'a.png' is neither on nor off"),
            ("-imfchan x a.png", "map_Kd -imfchan: 'x' is none of"),
            ("-mm 0", "map_Kd -mm: '' is not a number"),
        ] {
            let error = MapOptions::read("map_Kd", value).unwrap_err();
            assert!(error.starts_with(what), "{error}");
        }
    }

    #[test]
    fn a_channel_becomes_red() {
        let texture =
            Texture { name: String::from("a"), width: 1, height: 1, rgba: vec![10, 20, 30, 40], has_alpha: true };
        let value = |channel| Values { channel, ..Values::default() }.of_scalar(&texture).rgba[0];
        let channels = [Channel::Red, Channel::Green, Channel::Blue, Channel::Matte, Channel::Luminance];
        assert_eq!(channels.map(|channel| value(Some(channel))), [10, 20, 30, 40, 19]);
        assert_eq!(value(None), 40);
        let changed = Values { channel: None, base: 0.5, gain: 2.0 }.of_color(&texture);
        assert_eq!(changed.rgba, [148, 168, 188, 40]);
    }
}
