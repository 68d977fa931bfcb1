//! The container: JSON, the binary chunk of a GLB, and buffers [Khronos, "glTF 2.0 Specification", 3.6.1 and 4].

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf::json::{Index, Root, root::Get};

use super::super::{Error, text};
use crate::process::{self, Reading};

/// A file with its buffers in memory.
#[derive(Debug)]
pub(super) struct File {
    pub path: PathBuf,
    pub root: Root,
    /// One for each buffer of the file, of at least the length that it states.
    pub buffers: Vec<Vec<u8>>,
    /// Bytes of the buffers that are read as numbers, and once more when their meshes are made: skins and animations read
    /// some again.
    pub reading: Reading,
}

/// An error at a place of the file's JSON, such as `meshes[0].primitives[1]`.
pub(super) fn inside(path: &Path, place: impl Into<String>, what: impl Into<String>) -> Error {
    Error::Inside { path: path.to_owned(), place: place.into(), what: what.into() }
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Base64 with or without its padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

impl File {
    /// Reads the file and its buffers.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let bytes = text::read(path)?;
        let (json, binary) = if bytes.starts_with(MAGIC) { chunks(path, &bytes)? } else { (&bytes[..], None) };
        let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
        check_version(path, json)?;
        let malformed = |error: gltf::json::Error| Error::Malformed {
            path: path.to_owned(),
            line: error.line(),
            what: format!("is no glTF: {error}"),
        };
        let root: Root = gltf::json::deserialize::from_slice(json).map_err(malformed)?;
        let total = root.buffers.iter().map(|buffer| buffer.byte_length.0).fold(0, u64::saturating_add);
        let reading = process::reading(text::name(path), total.saturating_mul(2));
        let mut file = Self { path: path.to_owned(), root, buffers: Vec::new(), reading };
        for index in 0..file.root.buffers.len() {
            let buffer = file.read_buffer(index, binary)?;
            file.buffers.push(buffer);
        }
        Ok(file)
    }

    /// An error at a place of the file.
    pub fn error(&self, place: impl Into<String>, what: impl Into<String>) -> Error {
        inside(&self.path, place, what)
    }

    /// Finds the entry that an index names.
    pub fn get<T>(&self, index: Index<T>, place: &str, list: &str) -> Result<&T, Error>
    where
        Root: Get<T>,
    {
        let what = || format!("names {list}[{}], which the file does not have", index.value());
        self.root.get(index).ok_or_else(|| self.error(place, what()))
    }

    /// The bytes of a view of a buffer, and the stride that it states.
    pub fn view(&self, index: Index<gltf::json::buffer::View>, place: &str) -> Result<(&[u8], Option<usize>), Error> {
        let view = self.get(index, place, "bufferViews")?;
        let own = format!("bufferViews[{}]", index.value());
        self.get(view.buffer, &own, "buffers")?;
        let bytes = self.buffers.get(view.buffer.value()).map_or(&[][..], Vec::as_slice);
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let range = usize::try_from(start).ok().zip(usize::try_from(view.byte_length.0).ok());
        let range = range.and_then(|(start, length)| bytes.get(start..start.checked_add(length)?));
        let bytes = range.ok_or_else(|| {
            let end = start.saturating_add(view.byte_length.0);
            let what = format!("ends at byte {end} of a buffer of {} bytes", bytes.len());
            self.error(&own, what)
        })?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0)))
    }

    /// The bytes that a URI names: inside it, or in a file beside this one.
    pub fn read_uri(&self, uri: &str, place: &str) -> Result<Vec<u8>, Error> {
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((kind, body)) = data.split_once(',') else {
                return Err(self.error(place, "has a data URI without data"));
            };
            if !kind.ends_with(";base64") {
                return Err(self.error(place, "has a data URI that is not base64"));
            }
            return BASE64.decode(body).map_err(|error| self.error(place, format!("is no base64: {error}")));
        }
        let found = self.beside(uri, place)?;
        text::read(&found)
    }

    /// The file that a relative URI names.
    pub fn beside(&self, uri: &str, place: &str) -> Result<PathBuf, Error> {
        if uri.contains("://") {
            return Err(self.error(place, format!("names {uri}: only files beside the model are read")));
        }
        let decoded = percent_decoded(uri);
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let found = [decoded.as_str(), uri].into_iter().find_map(|name| super::super::find_file(folder, name));
        found.ok_or_else(|| self.error(place, format!("names {decoded}, which is not beside the model")))
    }

    fn read_buffer(&self, index: usize, binary: Option<&[u8]>) -> Result<Vec<u8>, Error> {
        let place = format!("buffers[{index}]");
        let buffer = &self.root.buffers[index];
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => self.read_uri(uri, &place)?,
            (None, Some(binary)) if index == 0 => binary.to_vec(),
            (None, _) => return Err(self.error(place, "has no `uri`, and the file has no binary chunk for it")),
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let what = format!("has {} bytes of the {} that it states", bytes.len(), buffer.byte_length.0);
            return Err(self.error(place, what));
        }
        Ok(bytes)
    }
}

/// Refuses other versions than 2.0 before anything else is read: in glTF 1 even its lists are of another kind. What is no JSON
/// gets its error later.
fn check_version(path: &Path, json: &[u8]) -> Result<(), Error> {
    let Ok(whole) = gltf::json::deserialize::from_slice::<gltf::json::Value>(json) else { return Ok(()) };
    let Some(asset) = whole.get("asset") else { return Ok(()) };
    let least = asset.get("minVersion").and_then(|version| version.as_str());
    let version = least.or(asset.get("version").and_then(|version| version.as_str()));
    match version {
        Some(written) if written == "2.0" || (least.is_none() && written.starts_with("2.")) => Ok(()),
        None if asset.get("version").is_none() => Ok(()),
        other => {
            let written = other.unwrap_or("another version");
            Err(inside(path, "asset", format!("is of glTF {written}; 2.0 can be read")))
        }
    }
}

/// JSON and binary chunks.
type Chunks<'a> = (&'a [u8], Option<&'a [u8]>);

fn chunks<'a>(path: &Path, bytes: &'a [u8]) -> Result<Chunks<'a>, Error> {
    let wrong = |offset: usize, what: String| Error::MalformedAt { path: path.to_owned(), offset, what };
    let word = |offset: usize| {
        let found = bytes.get(offset..offset + 4).and_then(|found| found.try_into().ok());
        found.map(u32::from_le_bytes).ok_or_else(|| wrong(offset, String::from("the GLB ends in its header")))
    };
    let (version, stated) = (word(4)?, word(8)?);
    if version != 2 {
        return Err(wrong(4, format!("is GLB {version}; version 2 can be read")));
    }
    if stated as usize > bytes.len() {
        return Err(wrong(8, format!("the GLB states {stated} bytes and has {}: it is cut off", bytes.len())));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at + 8 <= stated as usize {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        let body = bytes.get(at + 8..).and_then(|rest| rest.get(..length));
        let body = body.ok_or_else(|| wrong(at, format!("a chunk of {length} bytes goes beyond the GLB's end")))?;
        match kind {
            JSON if json.is_none() => json = Some(body),
            BIN if binary.is_none() => binary = Some(body),
            _ => {}
        }
        at += 8 + length;
    }
    let json = json.ok_or_else(|| wrong(12, String::from("the GLB has no JSON chunk")))?;
    Ok((json, binary))
}

/// A URI without its `%xx`.
fn percent_decoded(uri: &str) -> String {
    let mut out = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let code = match after {
            [high, low, ..] if *first == b'%' => {
                let digit = |digit: &u8| char::from(*digit).to_digit(16);
                digit(high).zip(digit(low)).map(|(high, low)| (16 * high + low) as u8)
            }
            _ => None,
        };
        out.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(out).unwrap_or_else(|_| uri.to_owned())
}
