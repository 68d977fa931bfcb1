//! `glumbra judge`: how wrong the shadow in a picture is, by whichever renderer.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};

use super::Error;
use super::answers;
use super::compare::parse_percent;
use super::json::JsonArgs;
use super::judge_report::{self, JudgeLimits, JudgeReport};
use super::scene_args::SceneArgs;
use super::screen::Screen;
use crate::frame::ShadeImage;
use crate::judge::colors::{DrawnColors, shadow_of, true_colors, why_unshaded};
use crate::judge::difference::difference_picture;
use crate::judge::{Bound, FoundMistake, Judge, Judgement, color_mistake, shade_of_pictures};
use crate::output::atomic_write;
use crate::pictures::{self, PictureFile, Raster};
use crate::plan::{self, Request};
use crate::png_file::{self, PngTexts};
use crate::scene::Scene;

/// Says how wrong the shadow in a picture is, whichever program drew it, against exact visibility.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct JudgeArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// The picture: a PNG, EXR or NPY file of the scene's size, by the scene's camera
    picture: PathBuf,

    /// The light whose shadow it is, by its number in the scene
    #[arg(long, value_name = "N", default_value_t = 0)]
    light: usize,

    /// Content of the picture
    #[arg(long, value_enum, default_value_t)]
    kind: Kind,

    /// The same engine's picture without this light's shadow: the shade is then the part of its light that the picture
    /// shows, in whatever lighting model
    #[arg(long, value_name = "PICTURE", conflicts_with = "nothing")]
    unshadowed: Option<PathBuf>,

    /// The same engine's picture with this light off, where ambient or other light is in the two pictures
    #[arg(long, value_name = "PICTURE", requires = "unshadowed")]
    light_off: Option<PathBuf>,

    /// Value of a shade, in 0 to 1, that says that nothing is there; by default alpha 0 does
    #[arg(long, value_name = "VALUE")]
    nothing: Option<f32>,

    /// Explanation of wrong pixels: a true shadow edge within so many pixels of the picture; or `technique`, the bound of the
    /// scene's own shadow map, for glumbra's pictures; or `exact`, nothing
    #[arg(long, value_name = "PIXELS", default_value = "3", value_parser = parse_band)]
    band: Band,

    /// Percent of the pixels compared that may be in shadow where light belongs
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    max_false_shadow: Option<f64>,

    /// Percent of the pixels compared that may be lit where shadow belongs
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    max_leak: Option<f64>,

    /// Number of wrong pixels that may lie outside the band
    #[arg(long, value_name = "N")]
    max_outside: Option<usize>,

    /// Greatest mean distance, in pixels, from the true shadow edges to the nearest that a shade shows: shadows that lie
    /// aside
    #[arg(long, value_name = "PIXELS", value_parser = parse_pixels)]
    max_edge: Option<f64>,

    /// Places that are listed, the worst first
    #[arg(long, value_name = "N", default_value_t = 5)]
    worst: usize,

    /// Writes a picture of what is wrong (.png), in the colours of `render --aov difference`
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    #[command(flatten)]
    json: JsonArgs,
}

/// Content of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Grey: 1 lit, 0 in shadow, less than one half is shadow; alpha 0 where nothing is there
    #[default]
    Shade,
    /// Colours by the scene's own lighting model, within the bounds that the ray tracer finds
    Color,
}

/// Explanation of wrong pixels.
#[derive(Clone, Copy, Debug)]
enum Band {
    Pixels(f64),
    Technique,
    Exact,
}

const HELP: &str = "\
Values are taken as they stand: codes of 8 or 16 bits over their greatest, no gamma. Pixels count where the ray tracer is \
certain, and but for --band exact where the surface faces the light: on the others shading leaves no light. A picture without \
alpha is compared on every surface of the scene. Of colours, too dark is false shadow, and too bright is a leak. \
A mistake that explains what is wrong is named: a picture that is upside down, mirrored, turned, moved by up to 4 pixels; a \
shade that is inverted or of another light; colours with red and blue exchanged, or encoded by the curve of sRGB. \
`glumbra render --aov truth` draws what a shade should be, `--aov difference` how far glumbra's own picture is from it.

Exit status: 0 within the limits, or no limit is given; 1 beyond one, or nothing could be compared, or more than half of the \
picture is undecided; 2 wrong usage, or a file that cannot be read or compared.

Examples:
  my-engine --scene room.gltf --shadow-term shade.png
  glumbra judge room.toml shade.png
  glumbra judge room.toml shade.png --max-false-shadow 0.1 --max-leak 0.2
  glumbra judge room.toml lit.png --unshadowed no-shadow.png -o wrong.png
  glumbra judge room.toml picture.exr --kind color --band 2 --json -
  glumbra render room.toml -o a.png --aov shade
  glumbra judge room.toml a.shade.png --band technique";

fn parse_band(text: &str) -> Result<Band, String> {
    match text {
        "technique" => Ok(Band::Technique),
        "exact" => Ok(Band::Exact),
        _ => parse_pixels(text).map(Band::Pixels).map_err(|error| format!("{error}, `technique` or `exact`")),
    }
}

fn parse_pixels(text: &str) -> Result<f64, String> {
    let pixels = text.parse().ok().filter(|pixels: &f64| pixels.is_finite() && *pixels >= 0.0);
    pixels.ok_or_else(|| format!("'{text}' is no number of pixels"))
}

/// Judges: 0 within the limits, 1 beyond, 2 for an error.
pub fn run(arguments: &JudgeArgs, screen: Screen) -> ExitCode {
    match judge(arguments, screen) {
        Ok(within) => ExitCode::from(u8::from(!within)),
        Err(error) => super::failure(error, 2),
    }
}

/// A picture as it is judged.
enum Picture {
    /// `knows_surfaces`: it says where surfaces are.
    Shade {
        image: ShadeImage,
        knows_surfaces: bool,
    },
    Colors(DrawnColors),
}

fn judge(arguments: &JudgeArgs, screen: Screen) -> Result<bool, Error> {
    if let Some(path) = &arguments.output {
        answers::check_png(path, &[&arguments.scene.scene, &arguments.picture])?;
    }
    let loaded = arguments.scene.load(screen)?;
    let scene = &loaded.scene;
    let count = scene.lights.len();
    if arguments.light >= count {
        return Err(crate::truth::Error::NoLight { index: arguments.light, count }.into());
    }
    let file = pictures::read(&arguments.picture)?;
    let picture = arguments.picture_of(&file, scene)?;
    let bound = arguments.bound(scene, arguments.light)?;
    let spinner = screen.spinner("tracing rays");
    spinner.enable_steady_tick(std::time::Duration::from_millis(100));
    let judged = Judged::of(arguments, scene, &bound, picture);
    spinner.finish_and_clear();
    let Judged { mut judge, judgement, shade, mistake, edges } = judged?;
    if let Some(path) = &arguments.output {
        let picture = difference_picture(judge.truth(&bound), &shade)?;
        let texts = arguments.texts("differences of a picture's shade from exact visibility");
        let png = png_file::of_rgb(&picture, &texts).map_err(|error| Error::DifferencePicture(error.to_string()))?;
        let written = atomic_write::write_all(&[path], |_, path| std::fs::write(path, &png));
        written.map_err(|(_, error)| Error::WriteFile { path: path.clone(), error })?;
    }
    let limits = JudgeLimits {
        false_shadow: arguments.max_false_shadow,
        leak: arguments.max_leak,
        outside: arguments.max_outside,
        edge: arguments.max_edge,
    };
    let places = judge.regions(&judgement, arguments.worst);
    let report = JudgeReport {
        scene: arguments.scene.scene.display().to_string(),
        picture: arguments.picture.display().to_string(),
        light: arguments.light,
        light_name: scene.lights[arguments.light].name.clone(),
        band: arguments.band_in_words(),
        notes: arguments.notes(&file),
        mistake: mistake.map(|found: FoundMistake| found.to_string()),
        edges,
        places: places.iter().map(|place| judge_report::PlaceReport::of(place, scene)).collect(),
        limits,
        ..JudgeReport::of(&judgement)
    };
    let within = report.is_within();
    answers::answer(&arguments.json, "judge", &report.to_json()?, || report.to_text())?;
    Ok(within)
}

/// All that is found of a picture.
struct Judged<'a> {
    judge: Judge<'a>,
    judgement: Judgement,
    /// The shade, or for colours one in which wrong pixels are those of the judgement.
    shade: ShadeImage,
    mistake: Option<FoundMistake>,
    edges: [Option<crate::judge::metrics::EdgeDistance>; 2],
}

impl<'a> Judged<'a> {
    fn of(arguments: &JudgeArgs, scene: &'a Scene, bound: &Bound, picture: Picture) -> Result<Self, Error> {
        let mut judge = Judge::new(scene, arguments.light)?;
        match picture {
            Picture::Colors(drawn) => {
                let truth = true_colors(scene, arguments.light)?;
                let mut judgement = judge.colors(&truth, &drawn, bound)?;
                // Colours show the shadow edges of every light.
                for light in (0..scene.lights.len()).filter(|light| *light != arguments.light) {
                    if shadow_of(&scene.lights[light].shadow, false).is_some() && judgement.outside_band > 0 {
                        let bound = arguments.bound(scene, light)?;
                        let other = Judge::new(scene, light)?.colors(&truth, &drawn, &bound)?;
                        judgement = judgement.explained_by(&other);
                    }
                }
                let shade = judge.shade_of(&judgement);
                let mistake = color_mistake(&truth, &drawn);
                Ok(Self { judge, judgement, shade, mistake, edges: [None; 2] })
            }
            Picture::Shade { mut image, knows_surfaces } => {
                if !knows_surfaces {
                    judge.cover_surfaces(&mut image);
                }
                let judgement = match arguments.unshadowed {
                    Some(_) => judge.pictured_shade(&image, bound)?,
                    None => judge.shade(&image, bound)?,
                };
                let mistake = judge.mistake(&image, knows_surfaces)?;
                let edges = judge.edge_distances(&image)?;
                Ok(Self { judge, judgement, shade: image, mistake, edges })
            }
        }
    }
}

impl JudgeArgs {
    /// The bound of light number `light`.
    fn bound(&self, scene: &Scene, light: usize) -> Result<Bound, Error> {
        Ok(match self.band {
            Band::Pixels(pixels) => Bound::Band { pixels },
            Band::Exact => Bound::Exact,
            Band::Technique => {
                let request = Request { sampled_warnings: false, ..Request::default() };
                Bound::of_plan(scene, &plan::make(scene, &request)?, light)
            }
        })
    }

    fn band_in_words(&self) -> String {
        match self.band {
            Band::Pixels(pixels) => format!("a true shadow edge within {pixels} pixels"),
            Band::Technique => String::from("the technique's own bound"),
            Band::Exact => String::from("nothing"),
        }
    }

    /// The picture as a shade or as colours.
    fn picture_of(&self, file: &PictureFile, scene: &Scene) -> Result<Picture, Error> {
        let wrong = |what: String| Error::NotJudged { picture: self.picture.clone(), what };
        let raster = &file.raster;
        if raster.size != scene.image.size {
            let ([width, height], [w, h]) = (raster.size, scene.image.size);
            return Err(wrong(format!(
                "it has {width}x{height} pixels, the scene's image {w}x{h}: draw it so, or give --size {width}x{height}"
            )));
        }
        if let Some(path) = &self.unshadowed {
            return self.ratio(raster, path);
        }
        if self.kind == Kind::Color {
            let rgb = raster.to_rgb().filter(|_| raster.channels > 2);
            let rgb = rgb.ok_or_else(|| wrong(String::from("--kind color needs red, green and blue")))?;
            let codes = rgb.pixels().map(|p| [0, 1, 2].map(|k| 255.0 * f64::from(p[k])));
            return Ok(Picture::Colors(DrawnColors { size: raster.size, codes: codes.collect() }));
        }
        if let Some(why) = why_unshaded(scene, self.light) {
            return Err(wrong(format!("{why}: --kind color")));
        }
        self.shade(raster).map_err(wrong)
    }

    fn shade(&self, raster: &Raster) -> Result<Picture, String> {
        let rgb = raster.to_rgb().ok_or_else(|| format!("it has {} channels: a shade has one", raster.channels))?;
        if let Some(index) = rgb.pixels().position(|p| p.iter().any(|value| value.to_bits() != p[0].to_bits())) {
            let (x, y) = (index % raster.size[0] as usize, index / raster.size[0] as usize);
            return Err(format!(
                "it is no shade, for the pixel ({x}, {y}) is coloured: --kind color, or --unshadowed PICTURE for another \
                 lighting model"
            ));
        }
        let shade: Vec<f32> = rgb.pixels().map(|p| p[0]).collect();
        if let Some(value) = shade.iter().find(|value| **value < 0.0 || **value > 1.0) {
            return Err(format!("a shade is 0 to 1, and a value is {value}"));
        }
        const HALF_A_CODE: f32 = 0.5 / 255.0;
        let has_alpha = raster.channels.is_multiple_of(2);
        let covered = raster.pixels().zip(&shade).map(|(p, value)| match (self.nothing, p.last()) {
            (Some(nothing), _) => (value - nothing).abs() > HALF_A_CODE,
            (None, Some(alpha)) if has_alpha => *alpha > 0.0,
            _ => true,
        });
        let [width, height] = raster.size;
        let image = ShadeImage { width, height, covered: covered.collect(), shade };
        Ok(Picture::Shade { image, knows_surfaces: has_alpha || self.nothing.is_some() })
    }

    /// The part of the light that a picture shows, in the channel that has the most of it.
    fn ratio(&self, shown: &Raster, path: &PathBuf) -> Result<Picture, Error> {
        let read = |path: &PathBuf| -> Result<Raster, Error> {
            let raster = pictures::read(path)?.raster;
            let wrong = |what: &str| Error::NotJudged { picture: path.clone(), what: what.to_owned() };
            if raster.size != shown.size {
                return Err(wrong("it has another size than the picture"));
            }
            raster.to_rgb().ok_or_else(|| wrong("it has more than four channels"))
        };
        let wrong = |what: &str| Error::NotJudged { picture: self.picture.clone(), what: what.to_owned() };
        let shown_rgb = shown.to_rgb().ok_or_else(|| wrong("it has more than four channels"))?;
        let open = read(path)?;
        let off = self.light_off.as_ref().map(read).transpose()?;
        let rest = |index: usize| off.as_ref().map_or(0.0, |off| off.data[index]);
        let strongest = |pixel: usize| {
            let light = |k: usize| open.data[3 * pixel + k] - rest(3 * pixel + k);
            let k = (0..3).max_by(|a, b| light(*a).total_cmp(&light(*b))).unwrap_or(0);
            3 * pixel + k
        };
        let pixels = 0..shown_rgb.data.len() / 3;
        let part = |of: &Raster| -> Vec<f32> {
            pixels.clone().map(strongest).map(|index| of.data[index] - rest(index)).collect()
        };
        let shade = shade_of_pictures(part(&shown_rgb).into_iter(), part(&open).into_iter());
        let [width, height] = shown.size;
        let image = ShadeImage { width, height, covered: vec![true; shade.len()], shade };
        Ok(Picture::Shade { image, knows_surfaces: false })
    }

    /// Texts of a picture of what was found.
    fn texts(&self, title: &str) -> PngTexts {
        PngTexts::titled(title)
            .with(PngTexts::SCENE, self.scene.scene.display().to_string())
            .with(PngTexts::OVERRIDES, self.scene.changes.overrides().join(" "))
            .with("Light", self.light.to_string())
            .with("Picture", self.picture.display().to_string())
    }

    /// The picture's own words on its scene, where that is another scene than the one that is given.
    fn notes(&self, file: &PictureFile) -> Vec<String> {
        let given = [
            (PngTexts::SCENE, self.scene.scene.display().to_string()),
            (PngTexts::OVERRIDES, self.scene.changes.overrides().join(" ")),
        ];
        let is_ours = file.texts.iter().any(|(keyword, _)| keyword == PngTexts::SCENE);
        let said = |keyword: &str| file.texts.iter().find(|(known, _)| known == keyword).map_or("", |(_, text)| text);
        let differing = given.iter().filter(|(keyword, text)| is_ours && said(keyword) != text);
        let note = |(keyword, text): &(&str, String)| {
            let or_none = |text: &str| if text.is_empty() { String::from("none") } else { text.to_owned() };
            format!("{keyword} of the picture: {}; given: {}", or_none(said(keyword)), or_none(text))
        };
        differing.map(note).collect()
    }
}
