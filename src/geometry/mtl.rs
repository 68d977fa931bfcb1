//! MTL files: Ka, Kd, Ks, Ns, d, Tr, map_Kd, map_d. The text is checked and written anew, then parsed by tobj; other
//! statements are left out. Format: Wavefront's "MTL material format", version 4.2.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::obj::scan::shorten;
use super::{Error, Material, Texture, text, texture};

/// The materials of one or more library files.
#[derive(Debug, Default)]
pub(super) struct Library {
    /// All files as one, in the spelling that tobj takes.
    text: String,
    names: Vec<String>,
    maps: Vec<Map>,
}

/// A texture that a material asks for.
#[derive(Debug)]
struct Map {
    material: usize,
    statement: Statement,
    /// The library's file and line.
    path: PathBuf,
    line: usize,
    /// The file as written, without options.
    written: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Statement {
    Decal,
    Alpha,
}

impl Statement {
    fn name(self) -> &'static str {
        match self {
            Self::Decal => "map_Kd",
            Self::Alpha => "map_d",
        }
    }
}

/// The files that `mtllib written` in the OBJ file `obj` names: one whose name may hold spaces, else several.
pub(super) fn find_libraries(obj: &Path, written: &str) -> Vec<Result<PathBuf, String>> {
    let folder = obj.parent().unwrap_or(Path::new(""));
    if let Some(found) = texture::find_file(folder, written) {
        return vec![Ok(found)];
    }
    let several: Vec<_> = written
        .split_ascii_whitespace()
        .map(|name| texture::find_file(folder, name).ok_or_else(|| name.to_owned()))
        .collect();
    if several.iter().any(Result::is_ok) { several } else { vec![Err(written.to_owned())] }
}

impl Library {
    pub(super) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.names.iter().any(|known| known == name)
    }

    /// Adds the materials of the file at `path`; refuses what is wrong with its line.
    pub(super) fn read(&mut self, path: &Path) -> Result<(), Error> {
        let bytes = text::read(path)?;
        let decoded = text::decode(&bytes, path)?;
        let first = self.names.len();
        for line in text::logical_lines(&decoded) {
            self.read_line(&line.text, line.number, path, first)
                .map_err(|what| Error::malformed(path, line.number, what))?;
        }
        Ok(())
    }

    /// Reads a statement; `first`: how many materials the files before this have.
    fn read_line(&mut self, line: &str, number: usize, path: &Path, first: usize) -> Result<(), String> {
        let line = line.trim();
        let keyword = line.split_ascii_whitespace().next().unwrap_or_default();
        let value = line[keyword.len()..].trim();
        let lower = keyword.to_ascii_lowercase();
        let known = matches!(lower.as_str(), "ka" | "kd" | "ks" | "ns" | "d" | "tr" | "map_kd" | "map_d");
        if known && self.names.len() == first {
            return Err(format!("{keyword} stands before the first newmtl"));
        }
        match lower.as_str() {
            "newmtl" => {
                let name = if value.is_empty() { "unnamed" } else { value };
                self.names.push(name.to_owned());
                self.write(format_args!("newmtl {name}"));
            }
            "ka" => self.write_color("Ka", value)?,
            "kd" => self.write_color("Kd", value)?,
            "ks" => self.write_color("Ks", value)?,
            "ns" => {
                let exponent = read_number("Ns", value.split_ascii_whitespace().next().unwrap_or_default())?;
                self.write(format_args!("Ns {}", exponent.clamp(0.0, 1000.0)));
            }
            "d" => {
                let opacity = read_number(
                    "d",
                    value.trim_start_matches("-halo").split_ascii_whitespace().next().unwrap_or_default(),
                )?;
                self.write(format_args!("d {}", opacity.clamp(0.0, 1.0)));
            }
            "tr" => {
                let transparency = read_number("Tr", value.split_ascii_whitespace().next().unwrap_or_default())?;
                self.write(format_args!("d {}", (1.0 - transparency).clamp(0.0, 1.0)));
            }
            "map_kd" => self.add_map(Statement::Decal, value, number, path)?,
            "map_d" => self.add_map(Statement::Alpha, value, number, path)?,
            _ => {}
        }
        Ok(())
    }

    fn write(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    /// One number stands for all three; colours by spectral curve are left out.
    fn write_color(&mut self, statement: &str, value: &str) -> Result<(), String> {
        let words: Vec<_> = value.split_ascii_whitespace().take(4).collect();
        if words.first() == Some(&"spectral") {
            return Ok(());
        }
        let words = if words.first() == Some(&"xyz") { &words[1..] } else { &words[..] };
        let [r, g, b] = match words {
            [gray] => [*gray; 3],
            [r, g, b, ..] => [*r, *g, *b],
            _ => return Err(format!("{statement} has {} of 3 numbers", words.len())),
        };
        let read = |word| read_number(statement, word).map(|value| value.clamp(0.0, 1.0));
        let (r, g, b) = (read(r)?, read(g)?, read(b)?);
        self.write(format_args!("{statement} {r} {g} {b}"));
        Ok(())
    }

    fn add_map(&mut self, statement: Statement, value: &str, line: usize, path: &Path) -> Result<(), String> {
        let written = skip_options(value);
        if written.is_empty() {
            return Err(format!("{} names no file", statement.name()));
        }
        let material = self.names.len().saturating_sub(1);
        // A material's last statement of a kind is the one that counts.
        self.maps.retain(|map| map.material != material || map.statement != statement);
        self.maps.push(Map { material, statement, path: path.to_owned(), line, written: written.to_owned() });
        Ok(())
    }

    /// The materials as tobj reads them.
    pub(super) fn parse(&self) -> tobj::MTLLoadResult {
        tobj::load_mtl_buf(&mut self.text.as_bytes())
    }

    /// The materials, in the order of the files, with their textures; a file used twice is loaded once.
    pub(super) fn load_materials(&self) -> Result<Vec<Material>, Error> {
        let parsed = self.parse().map(|(materials, _)| materials).unwrap_or_default();
        let mut materials: Vec<_> = parsed.into_iter().map(convert).collect();
        let mut loaded = HashMap::new();
        for map in &self.maps {
            let texture = map.load(&mut loaded)?;
            if let Some(material) = materials.get_mut(map.material) {
                match map.statement {
                    Statement::Decal => material.decal = Some(texture),
                    Statement::Alpha => material.alpha = Some(texture),
                }
            }
        }
        Ok(materials)
    }
}

impl Map {
    fn load(&self, loaded: &mut HashMap<PathBuf, Arc<Texture>>) -> Result<Arc<Texture>, Error> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let Some(found) = texture::find_file(folder, &self.written) else {
            let what = format!("{}: there is no file '{}'", self.statement.name(), self.written);
            return Err(Error::malformed(&self.path, self.line, what));
        };
        if let Some(texture) = loaded.get(&found) {
            return Ok(Arc::clone(texture));
        }
        let texture = texture::load_texture(&found).map_err(|source| Error::Map {
            path: self.path.clone(),
            line: self.line,
            statement: self.statement.name(),
            source: Box::new(source),
        })?;
        Ok(Arc::clone(loaded.entry(found).or_insert_with(|| Arc::new(texture))))
    }
}

/// Where Ka is not given, Kd stands in, as with GL_AMBIENT_AND_DIFFUSE.
fn convert(material: tobj::Material) -> Material {
    let default = Material::default();
    let diffuse = material.diffuse.unwrap_or(default.diffuse);
    Material {
        name: material.name,
        ambient: material.ambient.unwrap_or(diffuse),
        diffuse,
        specular: material.specular.unwrap_or(default.specular),
        shininess: material.shininess.unwrap_or(default.shininess),
        opacity: material.dissolve.unwrap_or(default.opacity),
        decal: None,
        alpha: None,
        texgen: None,
    }
}

fn read_number(statement: &str, word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("{statement}: '{}' is not finite as a 32-bit float", shorten(word))),
        Err(_) if word.is_empty() => Err(format!("{statement} has no number")),
        Err(_) => Err(format!("{statement}: '{}' is not a number", shorten(word))),
    }
}

/// `value` without the options in front of a map's file, which may hold spaces.
fn skip_options(value: &str) -> &str {
    let mut rest = value;
    while rest.starts_with('-') {
        let (option, after) = split_word(rest);
        // How many words the option takes at least, and how many more numbers it may take.
        let (words, numbers) = match option.to_ascii_lowercase().as_str() {
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type" | "-texres" | "-bm" | "-boost" => (1, 0),
            "-mm" => (2, 0),
            "-o" | "-s" | "-t" => (1, 2),
            // A file whose name begins with a dash.
            _ => return rest,
        };
        rest = after;
        for _ in 0..words {
            rest = split_word(rest).1;
        }
        for _ in 0..numbers {
            let (word, after) = split_word(rest);
            if word.parse::<f32>().is_err() {
                break;
            }
            rest = after;
        }
    }
    rest
}

/// The first word and what follows the space behind it.
fn split_word(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| c.is_ascii_whitespace()).unwrap_or(text.len());
    (&text[..end], text[end..].trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_in_front_of_a_map_are_skipped() {
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
            assert_eq!(skip_options(value), file, "{value}");
        }
    }
}
