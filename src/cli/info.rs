//! `glumbra info`: driver, limits and precision.

use std::fmt::Write as _;

use clap::Args;
use serde::Serialize;

use super::json::JsonArgs;
use super::{ContextArgs, Error};
use crate::conformance::probe::{self, DepthFacts, MeasuredDepth, OffsetUnit};
use crate::context::{self, ContextInfo, Profile, egl};
use crate::process;

#[derive(Clone, Debug, Args)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    context: ContextArgs,
    /// Uses a context with the fixed-function pipeline
    #[arg(long)]
    compatibility: bool,
    #[command(flatten)]
    json: JsonArgs,
}

/// All that is printed.
#[derive(Serialize)]
struct Info {
    context: ContextInfo,
    depth_formats: Vec<DepthFacts>,
    egl_devices: Vec<egl::EglDevice>,
    /// Reason why there are no devices to list.
    egl_devices_error: Option<String>,
}

pub(super) fn run(arguments: &InfoArgs) -> Result<(), Error> {
    let profile = if arguments.compatibility { Profile::Compatibility } else { Profile::Core33 };
    let context = context::open(&arguments.context.request(profile))?;
    let depth_formats = {
        let _doing = process::doing(format!("measuring depth formats ({})", context.backend()));
        probe::depth_formats(context.gl())?
    };
    let (egl_devices, egl_devices_error) = match egl::devices() {
        Ok(devices) => (devices, None),
        Err(error) => (Vec::new(), Some(error)),
    };
    let info = Info { context: context.describe(), depth_formats, egl_devices, egl_devices_error };
    arguments.json.write("info", &info)?;
    if arguments.json.takes_standard_output() { Ok(()) } else { super::print(&describe(&info)) }
}

fn describe(info: &Info) -> String {
    let mut text = String::new();
    section(&mut text, "Context", &context_rows(&info.context));
    section(&mut text, "Limits", &limit_rows(&info.context));
    section(&mut text, "EGL devices", &device_rows(info));
    depth_table(&mut text, &info.depth_formats);
    text
}

fn context_rows(context: &ContextInfo) -> Vec<(String, String)> {
    let timer = match context.timer_bits {
        0 => "none".to_owned(),
        bits => format!("{bits} bits"),
    };
    let debug = match (context.khr_debug, context.debug_output) {
        (false, _) => "no",
        (true, false) => "yes, not in use",
        (true, true) => "yes, in use",
    };
    rows(&[
        ("context", &context.backend),
        ("vendor", &context.vendor),
        ("renderer", &context.renderer),
        ("version", &context.version),
        ("GLSL", &context.shading_language),
        ("profile", &context.profile),
        ("KHR_debug", &debug),
        ("timer queries", &timer),
    ])
}

fn limit_rows(context: &ContextInfo) -> Vec<(String, String)> {
    let limits = &context.limits;
    let viewport = format!("{} x {}", limits.viewport[0], limits.viewport[1]);
    rows(&[
        ("texture size", &limits.texture_size),
        ("cube map size", &limits.cube_map_size),
        ("array layers", &limits.array_layers),
        ("texture units", &limits.texture_units),
        ("renderbuffer size", &limits.renderbuffer_size),
        ("viewport", &viewport),
        ("color attachments", &limits.color_attachments),
        ("draw buffers", &limits.draw_buffers),
        ("samples", &limits.samples),
        ("subpixel bits", &limits.subpixel_bits),
        ("anisotropy", &limits.anisotropy),
        ("clip distances", &limits.clip_distances),
        ("vertex attributes", &limits.vertex_attributes),
        ("vertex uniforms", &limits.vertex_uniforms),
        ("fragment uniforms", &limits.fragment_uniforms),
        ("uniform block", &format!("{} bytes", limits.uniform_block_bytes)),
    ])
}

fn device_rows(info: &Info) -> Vec<(String, String)> {
    if let Some(error) = &info.egl_devices_error {
        return rows(&[("none", error)]);
    }
    let describe = |device: &egl::EglDevice| {
        let file = device.file.as_ref().map(|file| format!(", {file}")).unwrap_or_default();
        (format!("--device {}", device.index), format!("{}{file}", device.name))
    };
    info.egl_devices.iter().map(describe).collect()
}

fn rows(rows: &[(&str, &dyn std::fmt::Display)]) -> Vec<(String, String)> {
    rows.iter().map(|(name, value)| ((*name).to_owned(), value.to_string())).collect()
}

fn section(text: &mut String, title: &str, rows: &[(String, String)]) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{title}");
    for (name, value) in rows {
        let _ = writeln!(text, "  {name:<18} {value}");
    }
    text.push('\n');
}

/// One line a format; `r` is one unit of glPolygonOffset.
fn depth_table(text: &mut String, formats: &[DepthFacts]) {
    let _ = writeln!(text, "Depth formats, with r (one unit of polygon offset) as measured");
    let _ = writeln!(
        text,
        "  {:<18} {:>4} {:>7} {:<6}  {:<21} {:<21} one unit shows",
        "format",
        "bits",
        "stencil",
        "kind",
        r_title(0, formats),
        r_title(1, formats)
    );
    for format in formats {
        let _ = match (&format.measured, &format.refusal) {
            (Some(measured), _) => writeln!(text, "  {:<18} {}", format.format, depth_row(measured)),
            (None, refusal) => {
                writeln!(text, "  {:<18} refused: {}", format.format, refusal.as_deref().unwrap_or("no reason"))
            }
        };
    }
}

fn r_title(index: usize, formats: &[DepthFacts]) -> String {
    let measured = formats.iter().find_map(|format| format.measured.as_ref());
    measured.map(|measured| format!("r at {}", measured.units[index].at_depth)).unwrap_or_default()
}

fn depth_row(measured: &MeasuredDepth) -> String {
    let kind = if measured.float { "float" } else { "fixed" };
    let [far, near] = measured.units.map(|unit| unit_text(&unit));
    let shows = if measured.one_unit_shows { "yes" } else { "no" };
    format!("{:>4} {:>7} {kind:<6}  {far:<21} {near:<21} {shows}", measured.depth_bits, measured.stencil_bits)
}

/// `2^-23.00 (2.00 codes)`
fn unit_text(unit: &OffsetUnit) -> String {
    match unit.depth {
        depth if depth > 0.0 => format!("2^{:.2} ({:.2} codes)", depth.log2(), unit.codes),
        depth => format!("{depth}"),
    }
}
