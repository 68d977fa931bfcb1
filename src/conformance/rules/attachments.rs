//! GL-F6, GL-F9, GL-F10 and GL-F14: levels, faces and layers that are drawn into, renderbuffers, and framebuffers that GL must refuse
//! [GL 4.6, 9.2.7, 9.2.8, 9.4].

use std::rc::Rc;

use crate::conformance::bench::{
    Error, GlDraw, GlFormat, GlImage, GlImageDesc, GlPart, GlPlace, GlShape, GlState, Sampling, Surface, Vertex, full,
    level_size, rectangle,
};
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Texels along a side of level 0.
const SIDE: u32 = 8;
const LEVELS: u32 = 4;

/// A shape, with how its parts are attached.
struct Case {
    name: &'static str,
    shape: GlShape,
    layers: u32,
    part: fn(u32) -> GlPart,
}

/// GL-F6: each level of each face or layer is a target of its own.
pub fn parts(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut cases = vec![
        Case { name: "2D", shape: GlShape::Flat, layers: 1, part: GlPart::Face },
        Case { name: "2D by glFramebufferTexture", shape: GlShape::Flat, layers: 1, part: |_| GlPart::All },
        Case { name: "cube map", shape: GlShape::Cube, layers: 6, part: GlPart::Face },
        Case { name: "array", shape: GlShape::Array, layers: 5, part: GlPart::Layer },
    ];
    if subject.bench.has((4, 5), "GL_ARB_direct_state_access") {
        cases.push(Case { name: "cube map by layers", shape: GlShape::Cube, layers: 6, part: GlPart::Layer });
    } else {
        findings.untestable("cube map by layers", "neither OpenGL 4.5 nor ARB_direct_state_access");
    }
    if subject.bench.has((4, 0), "GL_ARB_texture_cube_map_array") {
        cases.push(Case { name: "array of cube maps", shape: GlShape::CubeArray, layers: 12, part: GlPart::Layer });
    } else {
        findings.untestable("array of cube maps", "neither OpenGL 4.0 nor ARB_texture_cube_map_array");
    }
    for case in cases {
        for format in GlFormat::DEPTHS.into_iter().chain([GlFormat::Rgba8, GlFormat::Rgba32F]) {
            findings.part(|findings| parts_of(subject, findings, &case, format));
        }
    }
    findings.part(|findings| lines(subject, findings));
    findings.part(|findings| renderbuffers(subject, findings));
    Ok(())
}

fn place<'a>(image: &'a Rc<GlImage>, case: &Case, level: u32, layer: u32) -> GlPlace<'a> {
    GlPlace { image, level, part: (case.part)(layer) }
}

/// Depths and codes that each part gets: multiples of 1 / 255.
fn code(level: u32, layer: u32) -> u8 {
    (level * 60 + layer * 4 + 3) as u8
}

/// First all parts are cleared, then a quarter of each is drawn: both in an order that is not the memory's.
fn parts_of(subject: &DriverUnderTest, findings: &mut Findings, case: &Case, format: GlFormat) -> Result<(), Error> {
    let desc = GlImageDesc { shape: case.shape, format, size: [SIDE; 2], layers: case.layers, levels: LEVELS };
    let image = Rc::new(subject.bench.blank(desc)?);
    let mut order: Vec<(u32, u32)> =
        (0..LEVELS).flat_map(|level| (0..case.layers).map(move |layer| (level, layer))).collect();
    let count = order.len();
    order.sort_by_key(|(level, layer)| (level * case.layers + layer) as usize * 7 % count);
    let target = |level: u32, layer: u32| {
        let place = Some(place(&image, case, level, layer));
        if format.is_depth() { subject.bench.surface_at(None, place) } else { subject.bench.surface_at(place, None) }
    };
    for &(level, layer) in &order {
        let surface = target(level, layer)?;
        let value = f32::from(code(level, layer)) / 255.0;
        surface.clear_depth(f64::from(value));
        surface.clear_color([value; 4]);
    }
    for &(level, layer) in order.iter().rev() {
        let surface = target(level, layer)?;
        let value = f32::from(255 - code(level, layer)) / 255.0;
        // The lower left quarter; of one texel all of it.
        let high = if level + 1 == LEVELS { 1.0 } else { 0.0 };
        let vertices = rectangle([-1.0; 2], [high; 2], 2.0 * value - 1.0, [value; 4]);
        let color_write = !format.is_depth();
        subject.bench.draw(&GlDraw::plain(&surface, GlState { color_write, ..GlState::WRITE }, &vertices))?;
    }
    let mut wrong = Vec::new();
    for &(level, layer) in &order {
        let seen = codes_of(&target(level, layer)?, format);
        let [width, height] = level_size([SIDE; 2], level);
        let drawn = |index: usize| {
            let [x, y] = [index as u32 % width, index as u32 / width];
            level + 1 == LEVELS || (x < width / 2 && y < height / 2)
        };
        let due = |index: usize| if drawn(index) { 255 - code(level, layer) } else { code(level, layer) };
        // A depth that is drawn may be a code of its format off: much less than one of 8 bits.
        if seen.len() != (width * height) as usize
            || seen.iter().enumerate().any(|(index, seen)| (seen - f64::from(due(index))).abs() > 0.1)
        {
            wrong.push(format!("level {level} layer {layer}"));
        }
    }
    let measured = match wrong.first() {
        None => format!("all {count} right"),
        Some(first) => format!("{} of {count} wrong, {first} among them", wrong.len()),
    };
    findings.must_hold(format!("{} {}", case.name, format.name()), wrong.is_empty(), measured);
    Ok(())
}

/// The stored values, in codes of 8 bits.
fn codes_of(surface: &Surface, format: GlFormat) -> Vec<f64> {
    match format {
        GlFormat::Rgba8 => surface.colors().into_iter().map(|color| f64::from(color[0])).collect(),
        _ if format.is_depth() => surface.depths().into_iter().map(|depth| depth * 255.0).collect(),
        _ => surface.floats().into_iter().map(|color| f64::from(color[0]) * 255.0).collect(),
    }
}

/// A 1D texture, as a row of pixels.
fn lines(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Rgba8, GlFormat::R32F] {
        let texels: Vec<f32> = (0..9).map(|index| index as f32 / 16.0).collect();
        let desc = GlImageDesc { shape: GlShape::Line, ..GlImageDesc::flat(format, [9, 1]) };
        let image = Rc::new(subject.bench.filled(desc, |_, _| match format {
            GlFormat::R32F => bytemuck::cast_slice(&texels).to_vec(),
            _ => (0..9).flat_map(|index| [index * 20, index, 200, 255]).collect(),
        })?);
        let surface = subject.bench.surface_at(Some(GlPlace { image: &image, level: 0, part: GlPart::All }), None)?;
        let wrong = match format {
            GlFormat::R32F => {
                surface.floats().iter().zip(&texels).filter(|(seen, due)| **seen != [**due, 0.0, 0.0, 1.0]).count()
            }
            _ => {
                let due = |index: u8| [index * 20, index, 200, 255];
                surface.colors().iter().zip(0..).filter(|(seen, index)| **seen != due(*index)).count()
            }
        };
        findings.none_wrong(format!("1D {}, read back", format.name()), wrong, 9);
    }
    Ok(())
}

/// Renderbuffers of depth with stencil and of colour: drawn, tested against and read.
fn renderbuffers(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use crate::conformance::bench::GlCompare;
    for depth in GlFormat::DEPTHS {
        findings.part(|findings| {
            let surface = subject.bench.renderbuffers([SIDE; 2], Some(GlFormat::Rgba8), Some(depth), 0)?;
            surface.clear_color([0.0; 4]);
            surface.clear_depth(0.5);
            let state = GlState { depth: Some(GlCompare::Less), ..GlState::WRITE };
            let near = rectangle([-1.0; 2], [0.0, 1.0], -0.5, [1.0; 4]);
            let behind = rectangle([0.0, -1.0], [1.0; 2], 0.5, [1.0; 4]);
            let vertices: Vec<Vertex> = near.into_iter().chain(behind).collect();
            subject.bench.draw(&GlDraw::plain(&surface, state, &vertices))?;
            let (colors, depths) = (surface.colors(), surface.depths());
            let wrong = (0..colors.len()).filter(|index| {
                let left = index % SIDE as usize <= 3;
                let (color, due) = if left { (255, 0.25) } else { (0, 0.5) };
                colors[*index][0] != color || (depths[*index] - due).abs() > 1e-4
            });
            findings.none_wrong(format!("renderbuffers RGBA8 and {}", depth.name()), wrong.count(), colors.len());
            Ok(())
        });
    }
    Ok(())
}

/// GL-F9: what is no framebuffer.
pub fn refused(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let image = |desc| subject.bench.blank(desc).map(Rc::new);
    let flat = image(GlImageDesc::flat(GlFormat::Rgba8, [4, 4]))?;
    let depth = image(GlImageDesc::flat(GlFormat::Depth24, [4, 4]))?;
    let array = image(GlImageDesc { shape: GlShape::Array, layers: 2, ..GlImageDesc::flat(GlFormat::Rgba8, [4, 4]) })?;
    let cube = image(GlImageDesc::cube(GlFormat::Depth24, 4))?;
    let part = |image, part, level| GlPlace { image, level, part };
    let whole = GlPlace::whole(&flat);
    let complete = glow::FRAMEBUFFER_COMPLETE;
    let bad = glow::FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
    let cases = [
        ("nothing attached", vec![], None, glow::FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT),
        ("colour alone", vec![whole], None, complete),
        ("colour and depth", vec![whole], Some(GlPlace::whole(&depth)), complete),
        ("a level that is not there", vec![part(&flat, GlPart::Face(0), 3)], None, bad),
        ("a layer that is not there", vec![part(&array, GlPart::Layer(2), 0)], None, bad),
        ("depth as a colour", vec![GlPlace::whole(&depth)], None, bad),
        ("colour as depth", vec![], Some(whole), bad),
        ("one face of depth", vec![], Some(part(&cube, GlPart::Face(3), 0)), complete),
        (
            "all layers beside one image",
            vec![part(&array, GlPart::All, 0), whole],
            None,
            glow::FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS,
        ),
        ("all layers", vec![part(&array, GlPart::All, 0)], None, complete),
    ];
    for (name, colors, depth, due) in cases {
        let seen = subject.bench.status_of(&colors, depth)?;
        // Which of the reasons is told is the driver's choice, if there are several.
        let holds = (seen == complete) == (due == complete);
        findings.must_hold(name, holds, format!("{seen:#06x}; {due:#06x} is due"));
    }
    Ok(())
}

/// GL-F10: a geometry shader sends a triangle to each face; each has depths of its own.
pub fn layered(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for (name, shape, layers) in [("cube map", GlShape::Cube, 6), ("array", GlShape::Array, 4)] {
        for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
            findings.part(|findings| {
                let desc = GlImageDesc { shape, format, size: [SIDE; 2], layers, levels: 1 };
                let image = Rc::new(subject.bench.blank(desc)?);
                let all = GlPlace { image: &image, level: 0, part: GlPart::All };
                let surface = subject.bench.surface_at(None, Some(all))?;
                surface.clear_depth(1.0);
                subject.bench.draw_layers(&surface, layers, &full(0.0))?;
                let mut wrong = Vec::new();
                for layer in 0..layers {
                    let part = if shape == GlShape::Cube { GlPart::Face(layer) } else { GlPart::Layer(layer) };
                    let one = subject.bench.surface_at(None, Some(GlPlace { image: &image, level: 0, part }))?;
                    let due = f64::from(layer) / 8.0;
                    if one.depths().iter().any(|depth| (depth - due).abs() > 1e-4) {
                        wrong.push(layer.to_string());
                    }
                }
                let measured =
                    if wrong.is_empty() { "all right".to_owned() } else { format!("wrong: {}", wrong.join(", ")) };
                findings.must_hold(format!("{name} {}", format.name()), wrong.is_empty(), measured);
                Ok(())
            });
        }
    }
    Ok(())
}

/// Depths that 16 bits cannot tell.
const FINE: [f32; 8] = [0.1, 0.3, 0.7, 0.9, 0.123_456, 0.654_321, 0.987_654, 1.0 / 3.0];

/// The bits that the driver tells are kept: what is uploaded comes back by a look-up.
fn kept(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const FETCH: &str = "result = texelFetch(map, ivec2(gl_FragCoord.xy), 0);";
    let image = subject.bench.depth_image(format, [8, 1], &[&FINE])?;
    let images = [("map", &image, Sampling::NEAREST)];
    let seen = subject.bench.map(FETCH, &[[0.0; 4]; 8], &images)?;
    let mut tally = GradeTally::default();
    for (value, due) in seen.into_iter().zip(FINE) {
        let off = f64::from(value[0]) - f64::from(due);
        // The nearest code or the next, looked up in f32.
        let step = image.encoding.step(f64::from(due));
        let lookup = f64::from(-22).exp2();
        tally.add(verify::within(off, 0.5 * step + lookup, step + lookup), off / step);
    }
    findings.tally(format!("{}: {} bits are told, and kept", format.name(), image.encoding.bits), tally, "steps");
    if format == GlFormat::Depth {
        findings.fact("bits of DEPTH_COMPONENT without a size", image.encoding.bits.to_string());
    }
    Ok(())
}

/// GL-F14: bits of formats: at least those that the name says, and of that type. How many DEPTH_COMPONENT has is the driver's
/// choice, which it tells.
pub fn bits(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use crate::conformance::bench::Encoding;
    for format in GlFormat::PURE_DEPTHS.into_iter().chain([GlFormat::Depth]) {
        findings.part(|findings| kept(subject, findings, format));
    }
    for format in GlFormat::DEPTHS {
        let (bits, float) = match format {
            GlFormat::Depth16 => (16, false),
            GlFormat::Depth24 | GlFormat::Depth24Stencil8 => (24, false),
            GlFormat::Depth32 => (32, false),
            _ => (32, true),
        };
        let stencil = if format.has_stencil() { 8 } else { 0 };
        let flat = subject.bench.blank(GlImageDesc::flat(format, [4, 4])).map(|image| image.encoding);
        let cube = subject.bench.blank(GlImageDesc::cube(format, 4)).map(|image| image.encoding);
        let buffer = subject.bench.renderbuffers([4, 4], None, Some(format), 0);
        let buffer = buffer.map(|surface| surface.depth_encoding().unwrap_or(NO_BITS));
        for (what, encoding) in [("texture", flat), ("cube map", cube), ("renderbuffer", buffer)] {
            findings.part(|findings| {
                let Encoding { bits: seen, stencil_bits, float: is_float } = encoding?;
                // Table 8.13 has DEPTH_COMPONENT32, but 8.5.1 does not require its bits.
                let least = if format == GlFormat::Depth32 { 24 } else { bits };
                let grade = match () {
                    () if is_float != float || stencil_bits < stencil || seen < least => Grade::Wrong,
                    () if seen < bits => Grade::Allowed,
                    () => Grade::Good,
                };
                let kind = if is_float { "float" } else { "fixed point" };
                let measured = format!("{seen} bits, {kind}, {stencil_bits} of stencil");
                findings.grade(format!("{}: {what}", format.name()), grade, measured);
                Ok(())
            });
        }
    }
    Ok(())
}

const NO_BITS: crate::conformance::bench::Encoding =
    crate::conformance::bench::Encoding { bits: 0, stencil_bits: 0, float: false };
