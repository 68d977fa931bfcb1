//! `glumbra repack`: a model's skin turned and packed so that tangent bases agree across edges.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;

use super::json::JsonArgs;
use super::repack_report::{Report, print, warn};
use super::scene_args::parse_size;
use crate::geometry::md2::{self, Model, NormalSource, Pose};
use crate::geometry::skin::{self, LARGEST, Raster, RepackOptions, Repacked, Skin};
use crate::geometry::{self, Mesh, load_obj};
use crate::output::{self, atomic_write};
use crate::png_file::PngTexts;

/// Turns and packs the skin of a model so that its tangent bases agree across edges.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct RepackArgs {
    /// The model: .md2 or .obj
    #[arg(value_name = "MODEL")]
    model: PathBuf,

    /// The folder for the new model and pictures, which have the names of the old ones; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,

    /// The skin's colours
    #[arg(long, value_name = "FILE")]
    decal: Option<PathBuf>,

    /// The skin's heights
    #[arg(long, value_name = "FILE")]
    height: Option<PathBuf>,

    /// The skin's gloss
    #[arg(long, value_name = "FILE")]
    gloss: Option<PathBuf>,

    /// Size of the new skin in texels; the islands are made smaller where they do not fit. By default the smallest size with
    /// sides of powers of two that holds them as they are
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,

    /// Texels around each island that repeat the colours at its rim
    #[arg(long, value_name = "TEXELS", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=256))]
    gutter: u32,

    /// Turns mirrored islands over, and gives them texels of their own
    #[arg(long)]
    unmirror: bool,

    /// Also cuts islands at edges where the t axes of two triangles differ by more than this angle
    #[arg(long, value_name = "DEGREES", default_value_t = 180.0, value_parser = parse_angle)]
    cut: f64,

    /// Fractions of a texel to which an MD2 model's places on the skin are rounded: 8 is eighths. The file's header
    /// then has a skin N times as large as the picture, which other programs may not expect; absent: whole texels
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=128))]
    steps: Option<u32>,

    /// The key frame of an MD2 model in which angles are measured, counted from 0; absent: the first
    #[arg(long, value_name = "N")]
    frame: Option<usize>,

    #[command(flatten)]
    json: JsonArgs,
}

const HELP: &str = "\
Bump maps are lit in tangent space, by each triangle's directions of s and t. Where two triangles meet whose t axes point \
apart, the light's direction jumps in tangent space, and the shading of an interpolated vector shows the edge. The command \
cuts the skin into islands (triangles that are joined on the surface and on the skin), turns them until no turn of one \
island lessens the sum of length times angle over the edges between them, and packs them in a new picture.

The table has the angle between the t axes of each two neighbouring triangles, around their common vertex normal: the most \
that a light vector jumps there in tangent space. Where one of the two is mirrored and the other not, a light vector along \
the surface is reversed whatever the angle: those edges are counted apart, and --unmirror removes them.

Islands that share texels (mirrored halves, left and right limbs) share them afterwards too and turn together, except \
mirrored ones with --unmirror. A quarter turn keeps every texel: it is taken where the mean angle at the island's edges \
is at most 0.05 degrees worse than at the best angle. MD2 files hold whole texels: places \
on the skin are rounded, which turns small triangles by some degrees, and the pictures are sampled in the rounded places; \
--steps 8 rounds to eighths. An OBJ model gets a material library with the decal; its own materials are left out.

Examples:
  glumbra repack knight.md2 --decal knight.png --height height.png -o repacked
  glumbra repack knight.md2 --decal knight.png --unmirror --cut 45 -o repacked
  glumbra repack model.obj --decal skin.png --size 512x512 --gutter 8 -o out";

/// Greatest place on the skin in an MD2 file.
const MOST_STEPS: u32 = i16::MAX as u32;

/// Error of the command.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    File(#[from] geometry::Error),
    #[error("{}: {source}", model.display())]
    Skin { model: PathBuf, source: skin::Error },
    #[error("{}: cannot tell the format: a model ends in .md2 or .obj", .0.display())]
    UnknownFormat(PathBuf),
    #[error("{}: is an OBJ model; {option} is of MD2 models", model.display())]
    Md2Only { model: PathBuf, option: &'static str },
    #[error("{}: has no texture coordinates, so there is no skin to pack", .0.display())]
    NoSkin(PathBuf),
    #[error("{}: has {frames} frames; --frame {frame} counts from 0", model.display())]
    NoFrame { model: PathBuf, frame: usize, frames: usize },
    #[error("{}: the new skin has more than 65536 distinct texels, which an MD2 file cannot index", .0.display())]
    TooManyTexels(PathBuf),
    #[error("{}: --steps {steps} makes a side of the skin {side} steps long; an MD2 file counts to {MOST_STEPS}", model.display())]
    TooManySteps { model: PathBuf, steps: u32, side: u32 },
    #[error("--size {width}x{height}: a skin has 1 to {LARGEST} texels a side")]
    Size { width: u32, height: u32 },
    #[error("{model}: an OBJ model does not say how many texels its skin has; give --decal, --height or --gloss", model = .0.display())]
    NoTexels(PathBuf),
    #[error("{file}: is read by this command; name another folder with -o", file = .0.display())]
    Overwrites(PathBuf),
    #[error("{}: is a folder, where a file would be written; name another folder with -o", .0.display())]
    Folder(PathBuf),
    #[error("{file}: two of the files to write have this name; rename {input}", file = file.display(), input = input.display())]
    SameName { file: PathBuf, input: PathBuf },
    #[error("{file}: cannot be written: {reason}", file = file.display())]
    Write { file: PathBuf, reason: String },
}

/// A model that has been read.
enum Source {
    Md2(Box<Model>),
    Obj,
}

/// Repacks, writes, and prints what changed.
pub fn run(arguments: &RepackArgs) -> Result<(), super::Error> {
    let report = repack(arguments)?;
    arguments.json.write("repack", &report)?;
    if arguments.json.takes_standard_output() { Ok(()) } else { super::print(&print(&report)) }
}

fn repack(arguments: &RepackArgs) -> Result<Report, Error> {
    if let Some([width, height]) = arguments.size
        && [width, height].iter().any(|side| !(1..=LARGEST).contains(side))
    {
        return Err(Error::Size { width, height });
    }
    let (source, mesh) = load(arguments)?;
    let maps = arguments.maps();
    let pictures: Vec<Raster> = maps.iter().map(|path| Raster::load(path)).collect::<Result<_, _>>()?;
    let files = arguments.files(&maps)?;
    let old = old_skin(arguments, &source, &mesh, &pictures)?;
    let options = RepackOptions {
        size: arguments.size,
        gutter: arguments.gutter,
        unmirror: arguments.unmirror,
        cut_degrees: arguments.cut,
        steps: matches!(source, Source::Md2(_)).then_some(arguments.steps.unwrap_or(1)),
    };
    let wrong = |source: skin::Error| Error::Skin { model: arguments.model.clone(), source };
    let new = skin::repack(&old, &options).map_err(wrong)?;
    let mut contents = vec![model_bytes(arguments, &source, &mesh, &new)?];
    if let (Source::Obj, Some(library)) = (&source, arguments.library()) {
        contents.push(library.text.into_bytes());
    }
    for (picture, path) in pictures.iter().zip(&maps) {
        let sampled = new.resample(&old, picture).map_err(wrong)?;
        let failed = |error: std::io::Error| Error::Write { file: (*path).clone(), reason: error.to_string() };
        let texts = PngTexts::titled("a skin that was packed again")
            .with("Source", path.display().to_string())
            .with("Model", arguments.model.display().to_string());
        contents.push(sampled.to_png(&texts).map_err(failed)?);
    }
    write(&arguments.output, &files, &contents)?;
    let report = Report::new(&old, &new, &files);
    warn(&report);
    Ok(report)
}

impl RepackArgs {
    /// The maps that are given, the decal first.
    fn maps(&self) -> Vec<&PathBuf> {
        [&self.decal, &self.height, &self.gloss].into_iter().flatten().collect()
    }

    /// The files to write: the model, an OBJ model's material library, the maps.
    fn files(&self, maps: &[&PathBuf]) -> Result<Vec<PathBuf>, Error> {
        let inputs: Vec<&PathBuf> = [&self.model].into_iter().chain(maps.iter().copied()).collect();
        let model = self.output.join(self.model.file_name().unwrap_or_default());
        let library = self.library().map(|library| (self.output.join(library.file), &self.model));
        let pictures = maps.iter().map(|map| (self.output.join(picture_name(map)), *map));
        let mut files = Vec::new();
        for (file, input) in [(model, &self.model)].into_iter().chain(library).chain(pictures) {
            if files.contains(&file) {
                return Err(Error::SameName { file, input: input.clone() });
            }
            if inputs.iter().any(|input| output::is_same_file(input, &file)) {
                return Err(Error::Overwrites(file));
            }
            if file.is_dir() {
                return Err(Error::Folder(file));
            }
            files.push(file);
        }
        Ok(files)
    }

    /// The material library of an OBJ model with a decal.
    fn library(&self) -> Option<Library> {
        let decal = self.decal.as_ref().filter(|_| !is_md2(&self.model))?;
        let text = format!("newmtl {MATERIAL}\nmap_Kd {}\n", picture_name(decal).to_string_lossy());
        Some(Library { file: self.model.with_extension("mtl").file_name().unwrap_or_default().into(), text })
    }
}

/// Name of the material in an OBJ model's library.
const MATERIAL: &str = "skin";

struct Library {
    file: PathBuf,
    text: String,
}

/// A map's name, ending in .png.
fn picture_name(map: &Path) -> PathBuf {
    Path::new(map.file_name().unwrap_or_default()).with_extension("png")
}

fn is_md2(model: &Path) -> bool {
    model.extension().is_some_and(|end| end.eq_ignore_ascii_case("md2"))
}

fn load(arguments: &RepackArgs) -> Result<(Source, Mesh), Error> {
    let model = &arguments.model;
    let say = |warnings: &[geometry::Warning]| {
        warnings.iter().for_each(|warning| super::say(format_args!("warning: {warning}")));
    };
    if !is_md2(model) {
        let given = [("--frame", arguments.frame.is_some()), ("--steps", arguments.steps.is_some())];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(Error::Md2Only { model: model.clone(), option });
        }
    }
    if is_md2(model) {
        let (loaded, warnings) = Model::load(model)?;
        say(&warnings);
        let (frame, frames) = (arguments.frame.unwrap_or(0), loaded.frame_count());
        if frame >= frames {
            return Err(Error::NoFrame { model: model.clone(), frame, frames });
        }
        let mesh = loaded.mesh(&Pose { frames: [frame; 2], blend: 0.0 }, NormalSource::File);
        return Ok((Source::Md2(Box::new(loaded)), mesh));
    }
    if model.extension().and_then(OsStr::to_str).is_none_or(|end| !end.eq_ignore_ascii_case("obj")) {
        return Err(Error::UnknownFormat(model.clone()));
    }
    let (mesh, warnings) = load_obj(model)?;
    say(&warnings);
    if mesh.texcoords.is_none() {
        return Err(Error::NoSkin(model.clone()));
    }
    if !mesh.materials.is_empty() {
        let path = model.display();
        super::say(format_args!(
            "warning: {path}: its materials are left out; the new model has the picture of --decal, if any"
        ));
    }
    Ok((Source::Obj, mesh))
}

/// The skin as it is: in the texels of an MD2 file, or of an OBJ model's first map.
fn old_skin(arguments: &RepackArgs, source: &Source, mesh: &Mesh, pictures: &[Raster]) -> Result<Skin, Error> {
    match source {
        Source::Md2(model) => {
            let texels = model.texels().map(|texel| glam::DVec2::from_array(texel.map(f64::from)));
            Ok(Skin::of_texels(mesh, model.file().skin_size.map(i32::cast_unsigned), texels))
        }
        Source::Obj => {
            let size = pictures.first().ok_or_else(|| Error::NoTexels(arguments.model.clone()))?.size;
            Skin::of_mesh(mesh, size).ok_or_else(|| Error::NoSkin(arguments.model.clone()))
        }
    }
}

fn model_bytes(arguments: &RepackArgs, source: &Source, mesh: &Mesh, new: &Repacked) -> Result<Vec<u8>, Error> {
    match source {
        Source::Md2(model) => {
            let [width, height] = new.skin.size().map(|side| side.saturating_mul(arguments.steps.unwrap_or(1)));
            if width.max(height) > MOST_STEPS {
                let steps = arguments.steps.unwrap_or(1);
                return Err(Error::TooManySteps { model: arguments.model.clone(), steps, side: width.max(height) });
            }
            let file = model.with_skin([width, height], &new.skin.in_steps(arguments.steps.unwrap_or(1)));
            Ok(md2::write(&file.ok_or_else(|| Error::TooManyTexels(arguments.model.clone()))?))
        }
        Source::Obj => {
            let library = arguments.library().map(|library| library.file.to_string_lossy().into_owned());
            let material = library.as_deref().map(|library| (library, MATERIAL));
            Ok(skin::write_obj(mesh, &new.skin, material).into_bytes())
        }
    }
}

/// Makes the folder and writes all files or none.
fn write(folder: &Path, files: &[PathBuf], contents: &[Vec<u8>]) -> Result<(), Error> {
    let failed =
        |file: &Path, error: &std::io::Error| Error::Write { file: file.to_owned(), reason: error.to_string() };
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, &error))?;
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    atomic_write::write_all(&paths, |index, temporary| std::fs::write(temporary, &contents[index]))
        .map_err(|(index, error)| failed(paths[index], &error))
}

/// Reads an angle from 0 to 180 degrees.
fn parse_angle(text: &str) -> Result<f64, String> {
    let angle: f64 = text.parse().map_err(|_| format!("'{text}' is no number"))?;
    if (0.0..=180.0).contains(&angle) { Ok(angle) } else { Err(String::from("an angle from 0 to 180 degrees")) }
}
