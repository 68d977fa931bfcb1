//! A plan in words: for `glumbra plan`, and as values for `--json`.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Display, Write};

use super::{ImageSummary, PassSummary, Plan, Summary, image_bytes};
use crate::compositions::focus;
use crate::pass::{
    Blend, Channels, Compare, CubeFace, Define, DrawPass, DrawState, IndexOrder, Input, Pass, Primitive, Redraw,
    Stencil, StencilOp, StencilOps, Work,
};

impl Plan {
    /// The plan as values.
    pub fn summary(&self) -> Summary {
        let images: Vec<ImageSummary> = self
            .list
            .images
            .iter()
            .map(|desc| ImageSummary {
                label: desc.label.clone(),
                format: desc.format.to_string(),
                size: desc.size,
                bytes: desc.storage.layers() * image_bytes(desc.format, desc.size, desc.storage.is_mipmapped()),
            })
            .collect();
        Summary {
            passes: self.list.passes.iter().map(|pass| self.pass_summary(pass)).collect(),
            image_bytes: images.iter().map(|image| image.bytes).sum(),
            images,
            buffer_bytes: self.buffer_bytes(),
            left_out: self.left_out.clone(),
            chosen: self.chosen.clone(),
            warnings: self.warnings.clone(),
        }
    }

    fn buffer_bytes(&self) -> u64 {
        let mut seen = HashSet::new();
        let batches = self.list.passes.iter().filter_map(|pass| match &pass.work {
            Work::Draw(draw) => Some(&draw.batches),
            Work::CopyDepth { .. } => None,
        });
        let mut bytes = 0;
        for batch in batches.flatten() {
            for draw in &batch.draws {
                let mesh = std::sync::Arc::as_ptr(&draw.mesh.0);
                for attribute in &batch.program.attributes {
                    if seen.insert((mesh, Err(*attribute))) {
                        let vertices = (draw.mesh.positions.len() + draw.mesh.homogeneous.len()) as u64;
                        let components = if draw.mesh.homogeneous.is_empty() { attribute.components() } else { 4 };
                        bytes += 4 * components as u64 * vertices;
                    }
                }
                if seen.insert((mesh, Ok(draw.order))) {
                    bytes += 4 * draw.mesh.indices.len() as u64;
                }
            }
        }
        bytes
    }

    fn pass_summary(&self, pass: &Pass) -> PassSummary {
        let redraw = match pass.redraw {
            Redraw::Always => "every frame",
            Redraw::WhenChanged => "once",
        };
        let label = pass.label.clone();
        match &pass.work {
            Work::CopyDepth { from, to, face } => PassSummary {
                label,
                redraw,
                target: vec![format!("{}{} by glCopyTexSubImage2D", self.list.desc(*to).label, face_words(*face))],
                size: self.list.desc(*to).size,
                state: Vec::new(),
                shaders: Vec::new(),
                inputs: vec![self.list.desc(*from).label.clone()],
                draws: Vec::new(),
                draw_calls: 0,
                triangles: 0,
            },
            Work::Draw(draw) => self.draw_summary(label, redraw, draw),
        }
    }

    fn draw_summary(&self, label: String, redraw: &'static str, pass: &DrawPass) -> PassSummary {
        let target = pass.target.color.iter().chain(&pass.target.depth).map(|id| {
            let desc = self.list.desc(*id);
            let level = if pass.target.level > 0 { format!(", level {}", pass.target.level) } else { String::new() };
            format!("{}{} ({}{level})", desc.label, face_words(pass.target.face), desc.format)
        });
        let mut summary = PassSummary {
            label,
            redraw,
            target: target.collect(),
            size: pass.viewport,
            state: state_words(pass),
            shaders: Vec::new(),
            inputs: Vec::new(),
            draws: Vec::new(),
            draw_calls: 0,
            triangles: 0,
        };
        let [mut shaders, mut inputs] = [HashSet::new(), HashSet::new()];
        for batch in &pass.batches {
            let defines = batch.program.defines.iter().filter(|define| !define.has_parameters());
            let defines: Vec<String> = defines.map(Define::full_name).collect();
            push_new(&mut summary.shaders, &mut shaders, format!("{}[{}]", batch.program.label, defines.join(" ")));
            for input in &batch.inputs {
                push_new(&mut summary.inputs, &mut inputs, self.input_words(input));
            }
            let part = batch.scissor.map_or(String::new(), |scissor| format!(", {}", scissor_words(scissor)));
            for draw in &batch.draws {
                let order = if draw.order == IndexOrder::VertexCache { ", vertex-cache order" } else { "" };
                summary.draws.push(format!(
                    "{}: {} {} of {}{order}{part}",
                    draw.label,
                    draw.primitive_count(),
                    if draw.primitive == Primitive::Lines { "lines" } else { "triangles" },
                    draw.mesh.name
                ));
                summary.draw_calls += 1;
                if draw.primitive == Primitive::Triangles {
                    summary.triangles += draw.primitive_count();
                }
            }
        }
        summary
    }

    fn input_words(&self, input: &Input) -> String {
        let desc = self.list.desc(input.image);
        let compare = input.sampler.compare.map_or(String::new(), |c| format!(", compare {}", compare_name(c)));
        let lod = input.sampler.lod_halves.map_or(String::new(), |lod| format!(", LOD {}", 0.5 * f64::from(lod)));
        format!("{} = {} ({:?}{compare}{lod})", input.name, desc.label, input.sampler.filter)
    }
}

fn face_words(face: Option<CubeFace>) -> String {
    face.map_or(String::new(), |face| format!(", face {}", face.name()))
}

/// Adds a text to a list, once.
fn push_new(list: &mut Vec<String>, known: &mut HashSet<String>, text: String) {
    if known.insert(text.clone()) {
        list.push(text);
    }
}

fn compare_name(compare: Compare) -> &'static str {
    match compare {
        Compare::Never => "NEVER",
        Compare::Less => "LESS",
        Compare::LessEqual => "LEQUAL",
        Compare::Equal => "EQUAL",
        Compare::NotEqual => "NOTEQUAL",
        Compare::GreaterEqual => "GEQUAL",
        Compare::Greater => "GREATER",
        Compare::Always => "ALWAYS",
    }
}

fn state_words(pass: &DrawPass) -> Vec<String> {
    let DrawState { depth_test, depth_write, color_write, cull, polygon_offset, depth_range, .. } = pass.state;
    let DrawState { depth_clamp, clip_distances, stencil, blend, scissor, .. } = pass.state;
    let mut words = Vec::new();
    if let Some([r, g, b, a]) = pass.clear.color {
        words.push(format!("clear colour ({r}, {g}, {b}, {a})"));
    }
    if let Some(depth) = pass.clear.depth {
        words.push(format!("clear depth {depth}"));
    }
    if let Some(stencil) = pass.clear.stencil {
        words.push(format!("clear stencil {stencil}"));
    }
    words.push(depth_test.map_or(String::from("no depth test"), |test| format!("depth {}", compare_name(test))));
    words.push(format!(
        "write {}",
        match (color_write, depth_write) {
            (Channels::None, true) => "depth",
            (Channels::None, false) => "nothing",
            (Channels::Rgb, true) => "RGB and depth",
            (Channels::Rgb, false) => "RGB",
            (Channels::Alpha, true) => "alpha and depth",
            (Channels::Alpha, false) => "alpha",
            (Channels::All, true) => "colour and depth",
            (Channels::All, false) => "colour",
        }
    ));
    if let Some(face) = cull {
        words.push(format!("cull {face:?}").to_lowercase());
    }
    if let Some(offset) = polygon_offset {
        words.push(format!("polygon offset ({}, {})", offset.factor, offset.units));
    }
    if depth_range != [0.0, 1.0] {
        words.push(format!("depth range ({}, {})", depth_range[0], depth_range[1]));
    }
    if depth_clamp {
        words.push(String::from("depth clamp"));
    }
    if clip_distances > 0 {
        words.push(String::from("clip distance 0"));
    }
    words.extend(stencil.iter().flat_map(stencil_words));
    match blend {
        Some(Blend::Add) => words.push(String::from("blend ONE ONE")),
        Some(Blend::OverPremultiplied) => words.push(String::from("blend ONE ONE_MINUS_SRC_ALPHA")),
        Some(Blend::Over) => words.push(String::from("blend SRC_ALPHA ONE_MINUS_SRC_ALPHA")),
        Some(Blend::AddByStoredAlpha) => words.push(String::from("blend DST_ALPHA ONE")),
        Some(Blend::MultiplyAndStoreAlpha) => words.push(String::from("blend DST_COLOR ZERO, alpha ONE ZERO")),
        Some(Blend::Multiply) => words.push(String::from("blend DST_COLOR ZERO")),
        None => {}
    }
    words.extend(scissor.map(scissor_words));
    words
}

fn scissor_words([left, bottom, width, height]: [u32; 4]) -> String {
    format!("scissor {width}x{height} at ({left}, {bottom})")
}

fn stencil_words(stencil: &Stencil) -> Vec<String> {
    let Stencil { test, reference, read_mask, write_mask, front, back } = *stencil;
    let mut words = vec![match test {
        Compare::Always => String::from("stencil ALWAYS"),
        _ if read_mask == 0xFF => format!("stencil {} {reference}", compare_name(test)),
        _ => format!("stencil {} {reference} & 0x{read_mask:02X}", compare_name(test)),
    }];
    let side = |name: &str, ops: StencilOps| {
        let ops = [("stencil fail", ops.stencil_fail), ("depth fail", ops.depth_fail), ("pass", ops.pass)];
        let ops: Vec<String> = ops
            .iter()
            .filter(|(_, op)| *op != StencilOp::Keep)
            .map(|(when, op)| format!("{} on {when}", op_name(*op)))
            .collect();
        (!ops.is_empty()).then(|| format!("{name} {}", ops.join(" ")))
    };
    if write_mask != 0 {
        words.extend(side("front", front));
        words.extend(side("back", back));
    }
    words
}

fn op_name(op: StencilOp) -> &'static str {
    match op {
        StencilOp::Keep => "KEEP",
        StencilOp::Zero => "ZERO",
        StencilOp::Replace => "REPLACE",
        StencilOp::Increment => "INCR",
        StencilOp::IncrementWrap => "INCR_WRAP",
        StencilOp::Decrement => "DECR",
        StencilOp::DecrementWrap => "DECR_WRAP",
        StencilOp::Invert => "INVERT",
    }
}

impl Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut repeated = 0;
        for (number, pass) in self.passes.iter().enumerate() {
            if focus::repeats(&pass.label) {
                repeated += 1;
                continue;
            }
            if std::mem::take(&mut repeated) > 0 {
                writeln!(f, "…  the same for the other lens points")?;
            }
            let [width, height] = pass.size;
            writeln!(f, "{}. {} ({})", number + 1, pass.label, pass.redraw)?;
            let mut line = |name: &str, words: &[String]| -> fmt::Result {
                if words.is_empty() { Ok(()) } else { writeln!(f, "   {name:<8} {}", words.join(", ")) }
            };
            let mut target = pass.target.join(" + ");
            write!(target, ", {width}x{height}")?;
            line("target", &[target])?;
            line("state", &pass.state)?;
            line("shader", &pass.shaders)?;
            line("reads", &pass.inputs)?;
            line("draws", &short(&pass.draws))?;
            if pass.draw_calls > 1 {
                line("in all", &[format!("{} triangles in {} draws", pass.triangles, pass.draw_calls)])?;
            }
        }
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        writeln!(f, "\nBuffers: {:.1} MiB; images: {:.1} MiB", mib(self.buffer_bytes), mib(self.image_bytes))?;
        for image in &self.images {
            writeln!(f, "   {} {} {}x{}", image.label, image.format, image.size[0], image.size[1])?;
        }
        if !self.chosen.is_empty() {
            writeln!(f, "\nChosen:")?;
        }
        let chosen = self.chosen.iter().map(|chosen| format!("{}: {}: {}", chosen.of, chosen.choice, chosen.why));
        instances_joined(chosen).iter().try_for_each(|line| writeln!(f, "   {line}"))?;
        writeln!(f, "\nLeft out:")?;
        let left_out = self.left_out.iter().map(|left_out| format!("{}: {}", left_out.what, left_out.why));
        instances_joined(left_out).iter().try_for_each(|line| writeln!(f, "   {line}"))?;
        for warning in &self.warnings {
            writeln!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}

/// The lines, where those of an object's instances that say the same are one: the first, and how many more there are.
fn instances_joined(lines: impl Iterator<Item = String>) -> Vec<String> {
    let mut first: HashMap<String, usize> = HashMap::new();
    let mut joined: Vec<(String, usize)> = Vec::new();
    for line in lines {
        let place = match of_any_instance(&line) {
            None => joined.len(),
            Some(key) => *first.entry(key).or_insert(joined.len()),
        };
        match joined.get_mut(place) {
            Some((_, more)) => *more += 1,
            None => joined.push((line, 0)),
        }
    }
    let words = |(line, more): (String, usize)| match more {
        0 => line,
        _ => format!("{line} (and {more} more of its instances)"),
    };
    joined.into_iter().map(words).collect()
}

/// The line without the number of its instance, `name[17]`; `None`: it is of none.
fn of_any_instance(line: &str) -> Option<String> {
    let (name, rest) = line.split_once('[')?;
    let (number, rest) = rest.split_once(']')?;
    let is_number = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
    is_number.then(|| format!("{name}[]{rest}"))
}

/// The first few of a long list, and how many more there are.
fn short(list: &[String]) -> Vec<String> {
    const SHOWN: usize = 12;
    let mut shown: Vec<String> = list.iter().take(SHOWN).cloned().collect();
    if list.len() > SHOWN {
        shown.push(format!("and {} more", list.len() - SHOWN));
    }
    shown
}
