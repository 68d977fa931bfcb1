//! The model of a frame: runs a pass list on images of numbers with bounds.

use super::draws::DrawContext;
use super::fragments::Targets;
use super::glsl::Unknown;
use super::images::{Image, Plane, stored_color, stored_depth};
use super::shaders::Library;
use crate::conformance::model::number::Num;
use crate::pass::{Batch, DrawPass, ImageId, Pass, PassList, Work};

/// Images of a list after its passes, and the pass that wrote each last.
pub struct Drawn {
    pub images: Vec<Image>,
    pub writers: Vec<Option<String>>,
}

/// Runs a list from images that hold nothing.
///
/// # Errors
///
/// A shader or an image without a model.
pub fn run(list: &PassList, library: &mut Library) -> Result<Drawn, Unknown> {
    let images = list.images.iter().map(Image::new).collect::<Result<Vec<_>, _>>()?;
    let writers = vec![None; images.len()];
    let mut drawn = Drawn { images, writers };
    for pass in &list.passes {
        match &pass.work {
            Work::Draw(draw) => draw_pass(&mut drawn.images, draw, library)?,
            Work::CopyDepth { .. } => copy(&mut drawn.images, pass),
        }
        for image in pass.writes() {
            drawn.writers[image.0] = Some(pass.label.clone());
        }
    }
    Ok(drawn)
}

fn copy(images: &mut [Image], pass: &Pass) {
    let Work::CopyDepth { from, to, face } = pass.work else { return };
    let (source, kind) = (images[from.0].planes[0].clone(), images[from.0].format);
    let target = &mut images[to.0];
    let format = target.format;
    let plane = &mut target.planes[face.map_or(0, |face| face as usize)];
    let [width, height] = plane.size;
    for y in 0..height {
        for x in 0..width {
            let depth = source.depth[y * source.size[0] + x];
            let to = y * width + x;
            plane.depth[to] = if kind == format { depth } else { stored_depth(format, depth) };
            plane.makers[to] = 0;
        }
    }
}

fn draw_pass(images: &mut [Image], pass: &DrawPass, library: &mut Library) -> Result<(), Unknown> {
    let place = |image: &Image| {
        let face = if image.faces > 1 { pass.target.face.map_or(0, |face| face as usize) } else { 0 };
        // A renderbuffer has one level, whichever of the other image is drawn into.
        (pass.target.level as usize).min(image.levels() - 1) * image.faces + face
    };
    let mut take = |image: Option<ImageId>| {
        image.map(|id| {
            let place = place(&images[id.0]);
            (id.0, place, images[id.0].format, std::mem::take(&mut images[id.0].planes[place]))
        })
    };
    let (mut color, mut depth) = (take(pass.target.color), take(pass.target.depth));
    if let Some((_, _, format, plane)) = &mut color
        && let Some(clear) = pass.clear.color
    {
        plane.color.fill(clear.map(|part| stored_color(*format, Num::exact(f64::from(part)), 0.6)));
    }
    if let Some((_, _, format, plane)) = &mut depth {
        if let Some(clear) = pass.clear.depth {
            plane.depth.fill(stored_depth(*format, Num::exact(f64::from(clear))));
            plane.makers.fill(0);
        }
        if let Some(clear) = pass.clear.stencil {
            plane.stencil.fill(Some(clear));
        }
    }
    let mut nothing = [Plane::default(), Plane::default()];
    let [no_color, no_depth] = &mut nothing;
    {
        let depth_format = depth.as_ref().map(|(_, _, format, _)| *format);
        let color_format = color.as_ref().map(|(_, _, format, _)| *format);
        let mut targets = Targets {
            color: color.as_mut().map_or(no_color, |(_, _, _, plane)| plane),
            depth: depth.as_mut().map_or(no_depth, |(_, _, _, plane)| plane),
            color_format,
            depth_format,
        };
        for batch in &pass.batches {
            draw_batch(images, &mut targets, pass, batch, library)?;
        }
    }
    for (image, place, _, plane) in [color, depth].into_iter().flatten() {
        images[image].planes[place] = plane;
    }
    Ok(())
}

fn draw_batch(
    images: &[Image],
    targets: &mut Targets,
    pass: &DrawPass,
    batch: &Batch,
    library: &mut Library,
) -> Result<(), Unknown> {
    let shaders = library.get(&batch.program)?;
    let state = batch.state(&pass.state);
    let mut context = DrawContext::new(images, &shaders, state, pass.viewport, batch);
    for draw in &batch.draws {
        context.draw(targets, batch, draw);
    }
    Ok(())
}
