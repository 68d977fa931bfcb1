//! GL-F7, GL-F8, GL-F11 and GL-F12: copies to levels and faces, blits, several samples, and scale and bias of depths
//! [GL 4.6, 8.6, 18.3.1, 9.2.4; compatibility 8.4.4.1].

use std::rc::Rc;

use super::copies::drawn;
use crate::conformance::bench::{
    Error, GlBlit, GlCopyTo, GlDraw, GlFormat, GlImage, GlImageDesc, GlPart, GlPlace, GlShape, GlState, Surface, full,
    level_size, rectangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side of what [`drawn`] draws.
const SIDE: usize = 32;

/// Colours that differ pixel by pixel.
fn colored(subject: &DriverUnderTest, format: GlFormat) -> Result<Surface, Error> {
    let mut random = Random::new(301);
    let texels: Vec<u8> = (0..4 * SIDE * SIDE).map(|_| (random.unit() * 256.0) as u8).collect();
    let image = subject.bench.filled(GlImageDesc::flat(format, [SIDE as u32; 2]), |_, _| texels.clone())?;
    subject.bench.surface_at(Some(GlPlace::whole(&Rc::new(image))), None)
}

/// The stored values: depths, or packed colours.
fn values(surface: &Surface, format: GlFormat) -> Vec<f64> {
    if format.is_depth() {
        return surface.depths();
    }
    surface.colors().into_iter().map(|color| f64::from(u32::from_ne_bytes(color))).collect()
}

fn source(subject: &DriverUnderTest, format: GlFormat) -> Result<Surface, Error> {
    if format.is_depth() { drawn(subject, format) } else { colored(subject, format) }
}

/// GL-F7: a rectangle to each level and face; glCopyTexImage2D.
pub fn copies(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::DEPTHS.into_iter().chain([GlFormat::Rgba8]) {
        for (name, shape) in [("2D", GlShape::Flat), ("cube map", GlShape::Cube)] {
            findings.part(|findings| copies_of(subject, findings, format, name, shape));
        }
        findings.part(|findings| anew(subject, findings, format));
    }
    Ok(())
}

fn part_of(subject: &DriverUnderTest, image: &Rc<GlImage>, level: u32, layer: u32) -> Result<Surface, Error> {
    let place = Some(GlPlace { image, level, part: GlPart::Face(layer) });
    if image.format.is_depth() { subject.bench.surface_at(None, place) } else { subject.bench.surface_at(place, None) }
}

fn copies_of(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    format: GlFormat,
    name: &str,
    shape: GlShape,
) -> Result<(), Error> {
    const LEVELS: u32 = 2;
    let (size, layers) = ([16; 2], if shape == GlShape::Cube { 6 } else { 1 });
    let source = source(subject, format)?;
    let stored = values(&source, format);
    let image = Rc::new(subject.bench.blank(GlImageDesc { shape, format, size, layers, levels: LEVELS })?);
    let parts: Vec<_> = (0..LEVELS).flat_map(|level| (0..layers).map(move |layer| (level, layer))).collect();
    for &(level, layer) in &parts {
        let surface = part_of(subject, &image, level, layer)?;
        surface.clear_depth(1.0);
        surface.clear_color([0.0; 4]);
    }
    let before = if format.is_depth() { 1.0 } else { 0.0 };
    // From (x, y) to (u, v), of a size: other ones for each part.
    let area = |level: u32, layer: u32| {
        let [x, y, u, v] = [3 + 2 * layer as i32, 5 + 3 * layer as i32, 1 + layer as i32 % 3, 2 + level as i32];
        let [width, height] = if level == 0 { [11, 9] } else { [4, 3] };
        ([x, y, width, height], [u, v])
    };
    let mut errors = Vec::new();
    for &(level, layer) in &parts {
        let (from, at) = area(level, layer);
        errors.extend(subject.bench.copy(&source, from, GlCopyTo { image: &image, level, layer, at }));
    }
    let (mut wrong, mut count) = (0, 0);
    for &(level, layer) in &parts {
        let ([x, y, width, height], [u, v]) = area(level, layer);
        let across = level_size(size, level)[0] as i32;
        for (index, seen) in values(&part_of(subject, &image, level, layer)?, format).into_iter().enumerate() {
            let [column, row] = [index as i32 % across - u, index as i32 / across - v];
            let inside = (0..width).contains(&column) && (0..height).contains(&row);
            let due = if inside { stored[(row + y) as usize * SIDE + (column + x) as usize] } else { before };
            wrong += usize::from(seen != due);
            count += 1;
        }
    }
    let what = format!("{} to levels and faces of a {name} image", format.name());
    match errors.first() {
        Some(error) => findings.must_hold(what, false, error.clone()),
        None => findings.none_wrong(what, wrong, count),
    }
    Ok(())
}

/// glCopyTexImage2D makes the level anew, of the rectangle's size.
fn anew(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let source = source(subject, format)?;
    let stored = values(&source, format);
    for (name, shape, layers) in [("2D", GlShape::Flat, 1), ("cube map", GlShape::Cube, 6)] {
        let image = Rc::new(subject.bench.blank(GlImageDesc { shape, layers, ..GlImageDesc::flat(format, [8; 2]) })?);
        let what = format!("{}: glCopyTexImage2D, {name}", format.name());
        let from = |layer: u32| [2 + 3 * layer as i32, 7 + layer as i32, 8, 8];
        let errors: Vec<_> = (0..layers)
            .filter_map(|layer| {
                subject.bench.copy_anew(&source, from(layer), GlCopyTo { image: &image, level: 0, layer, at: [0; 2] })
            })
            .collect();
        if let Some(error) = errors.first() {
            findings.must_hold(what, false, error.clone());
            continue;
        }
        let mut wrong = 0;
        for layer in 0..layers {
            let [x, y, ..] = from(layer).map(|place| place as usize);
            let seen = values(&part_of(subject, &image, 0, layer)?, format);
            let due = |index: usize| stored[(y + index / 8) * SIDE + x + index % 8];
            wrong += seen.iter().enumerate().filter(|(index, seen)| **seen != due(*index)).count();
        }
        findings.none_wrong(what, wrong, 64 * layers as usize);
    }
    Ok(())
}

/// GL-F8: glBlitFramebuffer of colour and of depth: moved, turned, scaled, within a scissor.
pub fn blits(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::DEPTHS.into_iter().chain([GlFormat::Rgba8]) {
        findings.part(|findings| blits_of(subject, findings, format));
    }
    for format in [GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8] {
        findings.part(|findings| stencil_blits(subject, findings, format));
    }
    Ok(())
}

fn blits_of(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let from = source(subject, format)?;
    let stored = values(&from, format);
    let (color, depth) = if format.is_depth() { (None, Some(format)) } else { (Some(format), None) };
    let to = subject.bench.surface([SIDE as u32; 2], color, depth)?;
    let mask = if format.is_depth() { glow::DEPTH_BUFFER_BIT } else { glow::COLOR_BUFFER_BIT };
    let before = if format.is_depth() { 1.0 } else { 0.0 };
    let all = SIDE as i32;
    for (name, corners, scissor) in [
        ("whole", [[0, 0, all, all]; 2], None),
        ("moved", [[3, 5, 19, 13], [10, 20, 26, 28]], None),
        ("upside down", [[0, 0, all, all], [0, all, all, 0]], None),
        ("mirrored", [[2, 4, 18, 20], [28, 6, 12, 22]], None),
        ("twice as large", [[4, 6, 14, 18], [1, 2, 21, 26]], None),
        ("within a scissor", [[0, 0, all, all]; 2], Some([5, 9, 11, 7])),
    ] {
        to.clear_depth(1.0);
        to.clear_color([0.0; 4]);
        let error = subject.bench.blit(&GlBlit { from: &from, to: &to, corners, mask, linear: false, scissor });
        let what = format!("{}, {name}", format.name());
        if let Some(error) = error {
            findings.must_hold(what, false, error);
            continue;
        }
        let [source, target] = corners;
        let place = |at: i32, axis: usize| {
            let [low, high] = [target[axis], target[axis + 2]];
            let along = (f64::from(at) + 0.5 - f64::from(low)) / f64::from(high - low);
            let there = f64::from(source[axis]) + along * f64::from(source[axis + 2] - source[axis]);
            (0.0..1.0).contains(&along).then(|| there.floor() as usize)
        };
        let [left, bottom, width, height] = scissor.unwrap_or(to.whole());
        let mut tally = GradeTally::default();
        for (index, seen) in values(&to, format).into_iter().enumerate() {
            let [x, y] = [index % SIDE, index / SIDE].map(|at| at as i32);
            let shown = (left..left + width).contains(&x) && (bottom..bottom + height).contains(&y);
            let due = match (place(x, 0), place(y, 1)) {
                (Some(column), Some(row)) if shown => stored[row * SIDE + column],
                _ => before,
            };
            // Depths may go through f32: one code of 24 bits. Colours are numbers of 32 bits here.
            let off = (seen - due) * if format.is_depth() { f64::from(24).exp2() } else { 1.0 };
            tally.add(verify::within(off, 0.0, if format.is_depth() { 1.5 } else { 0.0 }), off);
        }
        findings.tally(what, tally, if format.is_depth() { "of 2^-24" } else { "" });
    }
    Ok(())
}

/// Stencil values beside depths, or alone.
fn stencil_blits(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const CELLS: i32 = SIDE as i32;
    let [from, to] = [(); 2].map(|()| subject.bench.surface([SIDE as u32; 2], None, Some(format)));
    let (from, to) = (from?, to?);
    from.clear_depth(0.25);
    (0..CELLS).for_each(|row| from.clear_stencil_in(Some([0, row, CELLS, 1]), 7 * row as u8));
    for (name, mask) in [
        ("stencil alone", glow::STENCIL_BUFFER_BIT),
        ("depth alone", glow::DEPTH_BUFFER_BIT),
        ("depth and stencil", glow::DEPTH_BUFFER_BIT | glow::STENCIL_BUFFER_BIT),
    ] {
        to.clear_depth(0.75);
        to.clear_stencil(255);
        let corners = [[0, 0, CELLS, CELLS]; 2];
        let what = format!("{}, {name}", format.name());
        if let Some(error) =
            subject.bench.blit(&GlBlit { from: &from, to: &to, corners, mask, linear: false, scissor: None })
        {
            findings.must_hold(what, false, error);
            continue;
        }
        let depth = if mask & glow::DEPTH_BUFFER_BIT != 0 { 0.25 } else { 0.75 };
        let seen = to.stencils().into_iter().zip(to.depths()).enumerate();
        let wrong = seen.filter(|(index, (value, seen))| {
            let due = if mask & glow::STENCIL_BUFFER_BIT != 0 { 7 * (index / SIDE) as u8 } else { 255 };
            *value != due || (seen - depth).abs() > 1e-6
        });
        findings.none_wrong(what, wrong.count(), SIDE * SIDE);
    }
    Ok(())
}

/// GL-F11: several samples a pixel, resolved by a blit.
pub fn samples(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const ASKED: u32 = 4;
    if subject.bench.most_samples() < ASKED {
        findings.untestable("4 samples", format!("GL_MAX_SAMPLES is {}", subject.bench.most_samples()));
        return Ok(());
    }
    for depth in GlFormat::DEPTHS {
        findings.part(|findings| samples_of(subject, findings, depth, ASKED));
    }
    Ok(())
}

fn samples_of(subject: &DriverUnderTest, findings: &mut Findings, depth: GlFormat, samples: u32) -> Result<(), Error> {
    let size = [16; 2];
    let many = subject.bench.renderbuffers(size, Some(GlFormat::Rgba8), Some(depth), samples)?;
    let one = subject.bench.surface(size, Some(GlFormat::Rgba8), Some(depth))?;
    many.clear_color([0.0; 4]);
    many.clear_depth(0.25);
    for surface in [&one, &many] {
        surface.clear_color([0.0; 4]);
        surface.clear_depth(0.25);
    }
    // Columns up to 8 whole; column 8 in part.
    let quad = rectangle([-1.0; 2], [0.0625, 1.0], 0.5, [1.0; 4]);
    subject.bench.draw(&GlDraw::plain(&many, GlState::WRITE, &quad))?;
    let corners = [[0, 0, 16, 16]; 2];
    let mask = glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT;
    let error = subject.bench.blit(&GlBlit { from: &many, to: &one, corners, mask, linear: false, scissor: None });
    let what = format!("RGBA8 and {}, {samples} samples", depth.name());
    if let Some(error) = error {
        findings.must_hold(what, false, error);
        return Ok(());
    }
    let (colors, depths) = (one.colors(), one.depths());
    let wrong = (0..256).filter(|index| {
        let (column, color, depth) = (index % 16, colors[*index][0], depths[*index]);
        let near = |due: f64| (depth - due).abs() < 1e-4;
        match column {
            0..=7 => color != 255 || !near(0.75),
            // A share of the samples' colours, and between their depths.
            8 => !(0.2499..=0.7501).contains(&depth),
            _ => color != 0 || !near(0.25),
        }
    });
    findings.none_wrong(what.clone(), wrong.count(), 256);
    let part = colors.iter().skip(8).step_by(16).all(|color| (1..255).contains(&color[0]));
    let measured = format!("a pixel that is half covered has {} of 255", colors[8][0]);
    findings.must_hold(format!("{what}: an edge"), part, measured);
    Ok(())
}

/// GL-F12: DEPTH_SCALE and DEPTH_BIAS at uploads, copies and read-backs.
pub fn scale_and_bias(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = super::fixed::pipeline(subject, findings, "DEPTH_SCALE and DEPTH_BIAS") else { return Ok(()) };
    for format in GlFormat::PURE_DEPTHS {
        findings.part(|findings| {
            let surface = subject.bench.surface([4, 4], None, Some(format))?;
            let state = GlState { color_write: false, ..GlState::WRITE };
            subject.bench.draw(&GlDraw::plain(&surface, state, &full(0.0)))?;
            fixed.set_depth_transfer(0.5, 0.125);
            let result = transferred(subject, &surface, format);
            fixed.set_depth_transfer(1.0, 0.0);
            let [uploaded, copied, read] = result?;
            let mut tally = GradeTally::default();
            for (seen, due) in [(uploaded, 0.25), (copied, 0.375), (read, 0.375)] {
                tally.add(verify::within(seen - due, 1.0 / 65535.0, 1.0 / 32768.0), seen - due);
            }
            let measured = format!(
                "0.25 uploaded is {uploaded:.4}, 0.5 copied {copied:.4}, 0.5 read {read:.4}; 0.25, 0.375 and 0.375 are due"
            );
            let grade = if tally.wrong == 0 { verify::Grade::Good } else { verify::Grade::Wrong };
            findings.grade(format.name(), grade, measured);
            Ok(())
        });
    }
    Ok(())
}

/// An upload of 0.25, a copy of 0.5 and a read-back of 0.5; the first two read without scale or bias would be 0.25 and 0.375.
fn transferred(subject: &DriverUnderTest, surface: &Surface, format: GlFormat) -> Result<[f64; 3], Error> {
    let image = subject.bench.depth_image(format, [1, 1], &[&[0.25]])?;
    let copy = subject.bench.image(format, [4, 4])?;
    if let Some(codes) = subject.bench.copy_depth(surface, [0, 0, 4, 4], &copy, [0, 0]) {
        return Err(Error::Gl { what: "a copy under DEPTH_SCALE", codes });
    }
    let read = surface.depths();
    let by_shader = |image: &GlImage| {
        let images = [("map", image, crate::conformance::bench::Sampling::NEAREST)];
        let value = subject.bench.map("result = vec4(texture(map, vec2(0.5)).r);", &[[0.0; 4]], &images)?;
        Ok::<_, Error>(f64::from(value[0][0]))
    };
    Ok([by_shader(&image)?, by_shader(&copy)?, read[0]])
}
