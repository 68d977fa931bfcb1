//! One frame of a [`Show`]: drawn by a renderer, then presented in a window or read as a canvas. Both have the same pixels.

use std::sync::Arc;
use std::time::Instant;

use super::Error;
use super::sheet::{EDGE, Sheet, legend};
use super::show::{Facts, Show};
use crate::frame::Renderer;
use crate::output::canvas::{Canvas, Color};
use crate::output::to_canvas;
use crate::plan::{Plan, Request};

/// A frame that was drawn.
pub struct DrawnFrame {
    plan: Plan,
    /// A picture that covers the window in place of the plan's.
    cover: Option<Canvas>,
    sheets: Vec<Sheet>,
}

/// As [`draw`]; what cannot be drawn is taken back while `show` knows how.
///
/// # Errors
///
/// As [`draw`].
pub fn draw_or_go_back(show: &mut impl Show, renderer: &mut Renderer) -> Result<DrawnFrame, Error> {
    loop {
        match draw(show, renderer) {
            Err(error) if show.refuse(&error) => {}
            drawn => return drawn,
        }
    }
}

/// Draws what `show` shows now, and gives it the facts.
///
/// # Errors
///
/// Every error of a frame, and of the ray tracer.
pub fn draw(show: &mut impl Show, renderer: &mut Renderer) -> Result<DrawnFrame, Error> {
    let (scene, mut request) = show.frame();
    let traced = show.traced();
    if let Some(traced) = traced {
        request.views = traced.drawn(&scene).into_iter().collect();
    }
    let start = Instant::now();
    let whole = renderer.plan(&scene, &Request { sampled_warnings: false, ..request })?;
    let mut facts = facts_of(&whole);
    facts.plan_ms = milliseconds(start);
    let plan = match show.after_pass() {
        Some(number) => whole.after_pass(&number.to_string()).map_err(crate::frame::Error::from)?,
        None => whole,
    };
    let start = Instant::now();
    renderer.draw(&plan)?;
    renderer.device().finish();
    facts.draw_ms = milliseconds(start);
    show.note(facts);
    let mut sheets = show.sheets();
    let is_alpha = plan.ends_in_alpha();
    let mut cover = None;
    if traced.is_some() || !plan.views.is_empty() || is_alpha {
        let frame = renderer.read(&plan)?;
        let picture = if is_alpha { frame.picture.clone().alpha_as_gray() } else { frame.picture.clone() };
        let mut view = frame.views.first().map(|pixels| to_canvas(pixels, plan.views.first().map(|row| row.0.view)));
        if let Some(traced) = traced {
            let pixels = show.trace(traced, &scene, &frame.picture, frame.views.first())?;
            view = Some(to_canvas(&pixels, None));
            sheets.push(in_corner(legend(&traced.legend(&scene), show.size()[0]), show.size(), &sheets));
        }
        let picture = to_canvas(&picture, None);
        cover = Some(match view {
            Some(view) if show.is_beside() => beside(&picture, &view, show.size()),
            // A map has a size of its own.
            Some(view) if view.size() != show.size() => filled(&view, show.size()),
            Some(view) => view,
            None => picture,
        });
    }
    Ok(DrawnFrame { plan, cover, sheets })
}

impl DrawnFrame {
    /// Copies the frame into the window of the renderer's context.
    ///
    /// # Errors
    ///
    /// An error of the device.
    pub fn present(&self, renderer: &mut Renderer, window: [u32; 2]) -> Result<(), Error> {
        match &self.cover {
            None => renderer.present(&self.plan, window)?,
            Some(canvas) => renderer.present_sheet(&Arc::new(canvas.to_texture("view")), [0; 2], window)?,
        }
        for sheet in &self.sheets {
            renderer.present_sheet(&Arc::new(sheet.canvas.to_texture("sheet")), sheet.place, window)?;
        }
        Ok(())
    }

    /// The frame as a window of its size would show it.
    ///
    /// # Errors
    ///
    /// An error of the device.
    pub fn canvas(&self, renderer: &mut Renderer) -> Result<Canvas, Error> {
        let mut canvas = match &self.cover {
            Some(canvas) => canvas.clone(),
            None => to_canvas(&renderer.read(&self.plan)?.picture, None),
        };
        self.sheets.iter().for_each(|sheet| canvas.paste(sheet.place, &sheet.canvas));
        Ok(canvas)
    }
}

/// The lower left corner of a window, above the sheets that stand there.
pub fn in_corner(canvas: Canvas, window: [u32; 2], others: &[Sheet]) -> Sheet {
    let middle = window[1] / 2;
    let low = others.iter().map(|sheet| sheet.place[1]).filter(|top| *top > middle).min();
    let bottom = low.unwrap_or(window[1]).saturating_sub(EDGE);
    Sheet { place: [EDGE, bottom.saturating_sub(canvas.size()[1])], canvas }
}

fn facts_of(plan: &Plan) -> Facts {
    let passes = plan.list.passes.iter().enumerate();
    let picture = passes.skip_while(|(_, pass)| !pass.writes().contains(&plan.picture));
    Facts {
        passes: picture.map(|(index, pass)| (index + 1, pass.label.clone())).collect(),
        left_out: plan.left_out.clone(),
        warnings: plan.warnings.clone(),
        ..Facts::default()
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Colour of what no picture covers.
const BEHIND: Color = [12, 12, 14];

/// A picture in the middle of a window, as large as that allows.
fn filled(picture: &Canvas, size: [u32; 2]) -> Canvas {
    let mut canvas = Canvas::new(size, BEHIND);
    paste_fitted(&mut canvas, picture, 0, size);
    canvas
}

/// Two pictures side by side, each as large as half of the window allows.
fn beside(left: &Canvas, right: &Canvas, size: [u32; 2]) -> Canvas {
    let half = [(size[0] / 2).max(1), size[1]];
    let mut canvas = Canvas::new(size, BEHIND);
    paste_fitted(&mut canvas, left, 0, half);
    paste_fitted(&mut canvas, right, size[0] / 2, half);
    canvas
}

/// Pastes a picture into the middle of a part of the canvas, from `start` to the right.
fn paste_fitted(canvas: &mut Canvas, picture: &Canvas, start: u32, room: [u32; 2]) {
    let fitted = picture.fitted(room);
    let edges = [0, 1].map(|axis| room[axis].saturating_sub(fitted.size()[axis]) / 2);
    canvas.paste([start + edges[0], edges[1]], &fitted);
}
