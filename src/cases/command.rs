//! A command that draws in place of glumbra: `render` of a case. It reads the scene's file, and writes a picture of a kind.
//! `placeholders.rs` has its words. It runs in the case's folder. A shade may have an alpha: 0 where no surface is, or the
//! light's cone ends.

use std::fs::File;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::Instant;

use super::draw::{DrawnScene, Wanted};
use super::outcome::{CaseVerdict, Failure};
use super::placeholders::{OUTPUTS, extension, fill_word, placeholders};
use super::read::PixelCase;
use crate::pictures::{self, Raster};
use crate::process;
use crate::scene::Scene;
use crate::views::View;

/// Runs the command for what is wanted, and reads its picture. `show` adds a wrong picture to its failure.
///
/// # Errors
///
/// A scene that does not load; a command that cannot be started, crashes, fails, or does not end until `deadline`; no
/// picture, or one of another size or kind.
pub(super) fn draw(
    words: &[String],
    case: &PixelCase,
    wanted: Wanted,
    deadline: Instant,
    show: impl Fn(Failure, &Raster) -> Failure,
) -> Result<DrawnScene, Failure> {
    let loaded = crate::load(&case.scene(), &[]).map_err(|error| error.to_string())?;
    let (kind, light) = match wanted {
        Wanted::View(View::Shade, light) => ("shade", light),
        Wanted::Picture => ("picture", 0),
        _ => return Err("a command draws pictures and shades only".into()),
    };
    let folder = tempfile::tempdir().map_err(|error| format!("a folder for the command's picture: {error}"))?;
    let output = words.iter().flat_map(|word| placeholders(word)).find_map(extension).unwrap_or("png");
    let output = folder.path().join(format!("{kind}.{output}"));
    let words = fill(words, case, &loaded.scene, (kind, light), &output)?;
    let said = run(&words, &case.folder, folder.path(), deadline)?;
    let after = |message: String| format!("{message}{}", tail(&said));
    if !output.is_file() {
        return Err(after(format!("{} ended well and wrote no picture", quote(&words))).into());
    }
    let file = pictures::read(&output).map_err(|error| after(format!("the command's picture: {error}")))?;
    let picture = if kind == "shade" { shade_of(&file.raster) } else { colors_of(&file.raster) };
    let wrong = |what: String| show(after(format!("the command's picture: {what}")).into(), &file.raster);
    let picture = picture.map_err(wrong)?;
    let [width, height] = loaded.scene.image.size;
    if picture.size != [width, height] {
        let [found_width, found_height] = picture.size;
        return Err(wrong(format!("it is {found_width}x{found_height}, and the scene's {width}x{height}")));
    }
    Ok(DrawnScene { scene: loaded.scene, picture, left_out: Vec::new(), warnings: loaded.warnings, plan: None })
}

/// Red, green and blue of a picture.
fn colors_of(picture: &Raster) -> Result<Raster, String> {
    let rgb = picture.to_rgb().filter(|_| picture.channels > 2);
    rgb.ok_or_else(|| format!("it has {} channels, and colours have 3, or 4 with an alpha", picture.channels))
}

/// Gray of a shade, and 1 where its alpha is not 0.
fn shade_of(picture: &Raster) -> Result<Raster, String> {
    let rgb = picture.to_rgb().ok_or_else(|| format!("it has {} channels, and a shade has one", picture.channels))?;
    let has_alpha = picture.channels.is_multiple_of(2);
    let mut data = Vec::with_capacity(2 * rgb.data.len() / 3);
    for (index, (pixel, gray)) in picture.pixels().zip(rgb.pixels()).enumerate() {
        let value = gray.first().copied().unwrap_or_default();
        if gray.iter().any(|other| *other != value) || !(0.0..=1.0).contains(&value) {
            let (x, y) = (index % picture.size[0] as usize, index / picture.size[0] as usize);
            return Err(format!("a shade must be gray, 1 lit and 0 shadowed, and its pixel ({x}, {y}) is {gray:?}"));
        }
        let alpha = pixel.last().filter(|_| has_alpha).copied().unwrap_or(1.0);
        data.extend([value, f32::from(alpha > 0.0)]);
    }
    Ok(Raster { size: picture.size, channels: 2, data })
}

fn fill(
    words: &[String],
    case: &PixelCase,
    scene: &Scene,
    (kind, light): (&str, usize),
    output: &Path,
) -> Result<Vec<String>, Failure> {
    let path = case.scene();
    let absolute = path.canonicalize().map_err(|error| format!("{}: {error}", path.display()))?;
    let text = |path: &Path| path.to_str().map(str::to_owned).ok_or(format!("{}: is not UTF-8", path.display()));
    let [width, height] = scene.image.size;
    let output = text(output)?;
    let mut values = vec![
        ("scene", text(&absolute)?),
        ("light", light.to_string()),
        ("width", width.to_string()),
        ("height", height.to_string()),
        ("kind", kind.to_owned()),
    ];
    values.extend(OUTPUTS.iter().map(|(name, _)| (*name, output.clone())));
    Ok(words.iter().map(|word| fill_word(word, &values)).collect())
}

/// Runs a command to its end, and returns what it wrote on standard output and standard error.
fn run(words: &[String], folder: &Path, scratch: &Path, deadline: Instant) -> Result<String, Failure> {
    let log = scratch.join("said");
    let file = File::create(&log).and_then(|file| Ok((file.try_clone()?, file)));
    let (out, err) = file.map_err(|error| format!("{}: {error}", log.display()))?;
    let (program, arguments) = words.split_first().ok_or("`render` names no program")?;
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).stdout(out).stderr(err);
    let begin = Instant::now();
    let failed = |error: std::io::Error| {
        format!("{program}: cannot be started in {}: {error}; is it installed, and in PATH?", folder.display())
    };
    let mut running = process::start(&mut command).map_err(failed)?;
    let ended = running.wait(deadline).map_err(|error| format!("{program}: cannot be waited for: {error}"))?;
    drop(running);
    let said = std::fs::read(&log).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default();
    match ended.map(|status| (status.success(), status)) {
        Some((true, _)) => Ok(said),
        Some((false, status)) => Err(how_it_failed(words, status, &said)),
        None => {
            let time = begin.elapsed().as_secs_f64();
            let message = format!("{} did not end in {time:.1} s, and was killed{}", quote(words), tail(&said));
            Err(Failure::new(CaseVerdict::Hang, message))
        }
    }
}

fn how_it_failed(words: &[String], status: ExitStatus, said: &str) -> Failure {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = process::signal_name(signal);
        let message = format!("{} crashed ({name}){}", quote(words), tail(said));
        return Failure::new(CaseVerdict::Crash, message);
    }
    format!("{} failed ({status}){}", quote(words), tail(said)).into()
}

/// The command as one would type it.
fn quote(words: &[String]) -> String {
    let is_plain = |word: &str| {
        !word.is_empty() && word.chars().all(|letter| letter.is_alphanumeric() || "-_./=:,+@%".contains(letter))
    };
    let quoted = words.iter().map(|word| match is_plain(word) {
        true => word.clone(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    });
    quoted.collect::<Vec<_>>().join(" ")
}

/// The last lines that a command wrote, indented; nothing where it wrote none.
fn tail(said: &str) -> String {
    const LINES: usize = 20;
    let lines: Vec<&str> = said.lines().map(str::trim_end).filter(|line| !line.is_empty()).collect();
    let last = &lines[lines.len().saturating_sub(LINES)..];
    last.iter().map(|line| format!("\n    | {line}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &[&str]) -> Vec<String> {
        text.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_command_is_shown_as_it_is_typed() {
        assert_eq!(quote(&words(&["sh", "-c", "kill -9 $$; echo 'x'"])), r#"sh -c 'kill -9 $$; echo '\''x'\'''"#);
    }
}
