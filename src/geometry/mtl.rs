//! MTL files: Ka, Kd, Ks, Ns, d, Tr, map_Kd, map_d, read here and not by tobj, which names no line, takes each colour for
//! three numbers and knows no Tr. Other statements are ignored, with a warning if that changes the picture. Format:
//! Wavefront's "MTL material format", version 4.2.

use std::path::{Path, PathBuf};

use super::map_options::MapOptions;
use super::mtl_maps::{LoadedMaps, Map, Statement};
use super::obj::corner::shorten;
use super::tally::WarningTally;
use super::{Error, Material, Warning, text, texture};

/// The materials of one or more library files.
#[derive(Debug, Default)]
pub(super) struct Library {
    /// In the order of the files.
    statements: Vec<Statements>,
    maps: Vec<Map>,
    oddities: WarningTally,
}

/// Statements of one material; `None`: it has none of that kind.
#[derive(Debug, Default)]
struct Statements {
    name: String,
    /// Ka, Kd and Ks, as [`Color`] numbers them.
    colors: [Option<[f32; 3]>; 3],
    /// Ns.
    shininess: Option<f32>,
    opacity: Option<Opacity>,
}

/// A colour of a material.
#[derive(Clone, Copy)]
enum Color {
    Ambient,
    Diffuse,
    Specular,
}

impl Color {
    fn name(self) -> &'static str {
        ["Ka", "Kd", "Ks"][self as usize]
    }
}

/// Opacity by d or Tr.
#[derive(Clone, Debug)]
struct Opacity {
    value: f32,
    /// True if given by d, which overrides Tr.
    by_d: bool,
    /// The statement, alone and with file and line.
    statement: String,
    origin: String,
}

/// Place of a statement.
#[derive(Clone, Copy)]
struct Place<'a> {
    path: &'a Path,
    line: usize,
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
        self.statements.is_empty()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.statements.iter().any(|known| known.name == name)
    }

    /// Adds the materials of the file at `path`; errors name their line.
    pub(super) fn read(&mut self, path: &Path) -> Result<(), Error> {
        let bytes = text::read(path)?;
        let decoded = text::decode(&bytes, path)?;
        let first = self.statements.len();
        for line in text::logical_lines(&decoded) {
            self.read_line(&line.text, Place { path, line: line.number }, first)
                .map_err(|what| Error::malformed(path, line.number, what))?;
        }
        Ok(())
    }

    /// Reads a statement; `first`: how many materials the files before this have.
    fn read_line(&mut self, line: &str, place: Place<'_>, first: usize) -> Result<(), String> {
        let line = line.trim();
        let keyword = line.split_ascii_whitespace().next().unwrap_or_default();
        let value = line[keyword.len()..].trim();
        let lower = keyword.to_ascii_lowercase();
        let known = matches!(lower.as_str(), "ka" | "kd" | "ks" | "ns" | "d" | "tr" | "map_kd" | "map_d");
        if known && self.statements.len() == first {
            return Err(format!("{keyword} stands before the first newmtl"));
        }
        match lower.as_str() {
            "newmtl" => {
                let name = if value.is_empty() { "unnamed" } else { value };
                self.statements.push(Statements { name: name.to_owned(), ..Statements::default() });
            }
            "ka" => self.read_color(Color::Ambient, value, place)?,
            "kd" => self.read_color(Color::Diffuse, value, place)?,
            "ks" => self.read_color(Color::Specular, value, place)?,
            "ns" => {
                let exponent = read_number("Ns", first_word(value))?;
                let exponent = self.clamped("Ns", exponent, 1000.0, place);
                if let Some(material) = self.statements.last_mut() {
                    material.shininess = Some(exponent);
                }
            }
            "d" | "tr" => self.read_opacity(lower == "d", value, place)?,
            "map_kd" => self.add_map(Statement::Decal, value, place)?,
            "map_d" => self.add_map(Statement::Alpha, value, place)?,
            "map_ka" if self.statements.len() > first => self.add_map(Statement::Ambient, value, place)?,
            _ => self.leave_out(keyword, &lower, value, place),
        }
        Ok(())
    }

    /// Warns of an ignored statement, if that may change the picture.
    fn leave_out(&mut self, keyword: &str, lower: &str, value: &str, place: Place<'_>) {
        let numbers = || value.split_ascii_whitespace().filter_map(|word| word.parse::<f32>().ok());
        let why = match lower {
            "" | "ni" | "sharpness" => return,
            _ if keyword.starts_with('#') => return,
            "illum" if numbers().all(|model| matches!(model as i32, 1 | 2)) => return,
            "ke" if numbers().all(|channel| channel == 0.0) => return,
            "tf" if numbers().all(|channel| channel == 1.0) => return,
            "illum" => "all surfaces are lit as by illum 2",
            "ke" | "map_ke" => "nothing shines by itself",
            "tf" => "nothing is transparent: the alpha test keeps or discards",
            "bump" | "map_bump" => {
                "MTL has no unit of height, not in -bm either; name the picture in the scene, with its height in texels: \
                 material = { bump = { height = \"FILE\", scale = 4.0 } }"
            }
            "norm" | "map_kn" => "name it in the scene: material = { bump = { normal_map = \"FILE\" } }",
            "disp" | "map_disp" => "vertices stay in their places",
            "refl" | "map_refl" => "nothing mirrors",
            "map_ka" | "map_ks" | "map_ns" | "map_tr" | "map_aat" | "decal" => {
                "of textures, map_Kd and map_d are drawn"
            }
            "pr" | "pm" | "ps" | "pc" | "pcr" | "aniso" | "anisor" | "map_pr" | "map_pm" | "map_ps" | "map_pc"
            | "map_pcr" | "map_rma" | "map_orm" => {
                self.note("physically based", place, || {
                    format!("{keyword} is left out, as all of physically based materials: Ka, Kd, Ks and Ns are drawn")
                });
                return;
            }
            _ => {
                self.note("unknown", place, || {
                    format!("'{}' is no statement of MTL; it is left out", shorten(keyword))
                });
                return;
            }
        };
        self.note(lower, place, || format!("{keyword} is left out: {why}"));
    }

    fn note(&mut self, kind: &str, place: Place<'_>, message: impl FnOnce() -> String) {
        self.oddities.note(kind, place.path, place.line, message);
    }

    /// `value` clamped to [0, `most`], with a warning if it was outside.
    fn clamped(&mut self, statement: &str, value: f32, most: f32, place: Place<'_>) -> f32 {
        let clamped = value.clamp(0.0, most);
        if clamped != value {
            let kind = format!("{statement} clamped");
            self.note(&kind, place, || format!("{statement}: {value} is not in [0, {most}]; {clamped} is drawn"));
        }
        clamped
    }

    /// Reads a colour. One number means all three channels; spectral curves are ignored.
    fn read_color(&mut self, color: Color, value: &str, place: Place<'_>) -> Result<(), String> {
        let statement = color.name();
        let words: Vec<_> = value.split_ascii_whitespace().take(4).collect();
        if words.first() == Some(&"spectral") {
            self.note("spectral", place, || {
                format!("{statement} spectral is left out: colours are red, green and blue")
            });
            return Ok(());
        }
        let is_xyz = words.first() == Some(&"xyz");
        if is_xyz {
            self.note("xyz", place, || format!("{statement} xyz: its numbers are taken for red, green and blue"));
        }
        let words = if is_xyz { &words[1..] } else { &words[..] };
        let [r, g, b] = match words {
            [gray] => [*gray; 3],
            [r, g, b, ..] => [*r, *g, *b],
            _ => return Err(format!("{statement} has {} of 3 numbers", words.len())),
        };
        let mut read = |word| read_number(statement, word).map(|value| self.clamped(statement, value, 1.0, place));
        let channels = [read(r)?, read(g)?, read(b)?];
        if let Some(material) = self.statements.last_mut() {
            material.colors[color as usize] = Some(channels);
        }
        Ok(())
    }

    /// Reads d, or Tr, which is 1 − d. Exporters do not agree on Tr: d overrides it.
    fn read_opacity(&mut self, by_d: bool, value: &str, place: Place<'_>) -> Result<(), String> {
        let name = if by_d { "d" } else { "Tr" };
        let without_halo = value.trim_start_matches("-halo");
        if by_d && without_halo.len() < value.len() {
            self.note("halo", place, || String::from("d -halo is drawn as d: the angle of view does not count"));
        }
        let number = read_number(name, first_word(without_halo))?;
        let number = self.clamped(name, number, 1.0, place);
        let value = if by_d { number } else { 1.0 - number };
        let statement = format!("{name} {number}");
        let origin = format!("{}:{}: {statement}", place.path.display(), place.line);
        let new = Opacity { value, by_d, statement, origin };
        let Some(material) = self.statements.last_mut() else { return Ok(()) };
        let known = &mut material.opacity;
        let said = known.clone().filter(|known| known.by_d != by_d && (known.value - value).abs() > 1e-3);
        if by_d || known.as_ref().is_none_or(|known| !known.by_d) {
            *known = Some(new.clone());
        }
        if let Some(known) = said {
            let Opacity { statement, .. } = &new;
            self.note("d against Tr", place, || {
                format!("{statement} contradicts {} of the same material: d counts", known.statement)
            });
        }
        Ok(())
    }

    fn add_map(&mut self, statement: Statement, value: &str, place: Place<'_>) -> Result<(), String> {
        let mut options = MapOptions::read(statement.name(), value)?;
        if options.file.is_empty() {
            return Err(format!("{} names no file", statement.name()));
        }
        if statement != Statement::Alpha && options.values.channel.take().is_some() {
            options.left_out.push("-imfchan");
        }
        for option in options.left_out.iter().filter(|_| statement != Statement::Ambient) {
            let kind = format!("{} {option}", statement.name());
            self.note(&kind, place, || format!("{kind} is left out"));
        }
        let material = self.statements.len().saturating_sub(1);
        // A material's last statement of a kind is the one that counts.
        self.maps.retain(|map| map.material != material || map.statement != statement);
        self.maps.push(Map {
            material,
            statement,
            path: place.path.to_owned(),
            line: place.line,
            placement: options.placement,
            values: options.values,
            written: options.file.to_owned(),
        });
        Ok(())
    }

    /// The materials' names and numbers, as tobj wants them. Of several of one name the last counts.
    pub(super) fn for_tobj(&self) -> tobj::MTLLoadResult {
        let named = |known: &Statements| tobj::Material { name: known.name.clone(), ..tobj::Material::default() };
        let numbers = self.statements.iter().enumerate().map(|(index, known)| (known.name.clone(), index)).collect();
        Ok((self.statements.iter().map(named).collect(), numbers))
    }

    /// The materials, in the order of the files, with their textures; a file used twice is loaded once. Oddities are added
    /// to `warnings`.
    pub(super) fn load_materials(mut self, warnings: &mut Vec<Warning>) -> Vec<Material> {
        let mut materials: Vec<Material> = std::mem::take(&mut self.statements).into_iter().map(material_of).collect();
        let mut loaded = LoadedMaps::default();
        for map in std::mem::take(&mut self.maps).iter() {
            let place = Place { path: &map.path, line: map.line };
            let Some(material) = materials.get_mut(map.material) else { continue };
            if map.statement == Statement::Ambient {
                let decal = material.decal.as_ref().map(|decal| &decal.name);
                if map.find().is_some_and(|found| decal != Some(&found.display().to_string())) {
                    self.leave_out("map_Ka", "map_ka", &map.written, place);
                }
                continue;
            }
            match loaded.texture(map) {
                Ok(texture) if map.statement == Statement::Decal => {
                    (material.decal, material.decal_placement) = (Some(texture), map.placement);
                }
                Ok(texture) => (material.alpha, material.alpha_placement) = (Some(texture), map.placement),
                Err(why) => {
                    let (name, without) = (map.statement.name(), map.statement.without());
                    let message = || format!("{name}: {why}: {without}");
                    self.note(&format!("{name} {why}"), place, message);
                }
            }
        }
        warnings.extend(self.oddities.warnings());
        materials
    }
}

/// Makes a material of its statements. If Ka is missing, Kd is used, as with GL_AMBIENT_AND_DIFFUSE.
fn material_of(statements: Statements) -> Material {
    let default = Material::default();
    let [ambient, diffuse, specular] = statements.colors;
    let diffuse = diffuse.unwrap_or(default.diffuse);
    let (opacity, opacity_origin) =
        statements.opacity.map_or((default.opacity, default.opacity_origin), |opacity| (opacity.value, opacity.origin));
    Material {
        name: statements.name,
        ambient: ambient.unwrap_or(diffuse),
        diffuse,
        specular: specular.unwrap_or(default.specular),
        shininess: statements.shininess.unwrap_or(default.shininess),
        opacity,
        opacity_origin,
        ..Material::default()
    }
}

fn first_word(text: &str) -> &str {
    text.split_ascii_whitespace().next().unwrap_or_default()
}

fn read_number(statement: &str, word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("{statement}: '{}' is not finite as a 32-bit float", shorten(word))),
        Err(_) if word.is_empty() => Err(format!("{statement} has no number")),
        Err(_) => Err(format!("{statement}: '{}' is not a number", shorten(word))),
    }
}
