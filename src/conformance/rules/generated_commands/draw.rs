//! Rectangles through the model's pipeline: coverage, tests, blending and masks, one pixel at a time.

use crate::conformance::bench::commands::{OUTPUTS, Place, Program, Rectangle};
use crate::conformance::bench::{GlFace, GlFormat, GlStencil, GlStencilOp};

use super::blend::blended;
use super::pixel::{Bounds, Depth, KnownPixel, Way, channels, filled, step, stored};
use super::state::State;

/// Share of a pixel by which a corner may be off in the window: eight bits of sub-pixels, and the arithmetic.
const OFF: f64 = 1.0 / 64.0;

/// How surely a rectangle covers a pixel along one axis.
fn covered(low: f64, high: f64, pixel: u32, margin: f64) -> Option<bool> {
    let centre = f64::from(pixel) + 0.5;
    match () {
        () if centre - margin > low && centre + margin < high => Some(true),
        () if centre + margin < low || centre - margin > high => Some(false),
        () => None,
    }
}

pub fn stencil_result(op: GlStencilOp, value: u8, reference: i32) -> u8 {
    match op {
        GlStencilOp::Keep => value,
        GlStencilOp::Zero => 0,
        // The reference is clamped to the buffer's range when it is used [GL 4.6, 17.3.3].
        GlStencilOp::Replace => reference.clamp(0, 255) as u8,
        GlStencilOp::Increment => value.saturating_add(1),
        GlStencilOp::IncrementWrap => value.wrapping_add(1),
        GlStencilOp::Decrement => value.saturating_sub(1),
        GlStencilOp::DecrementWrap => value.wrapping_sub(1),
        GlStencilOp::Invert => !value,
    }
}

/// A fragment before the tests.
struct Fragment {
    colors: [[Bounds; 4]; OUTPUTS],
    depth: Depth,
    /// False: it may be there or not.
    sure: bool,
}

impl State {
    /// Draws one rectangle into the framebuffer that is bound.
    pub fn draw_rectangle(&mut self, rectangle: &Rectangle) {
        let Some(framebuffer) = self.framebuffer(false).copied() else { return };
        let Some((size, samples)) = self.complete(&framebuffer) else { return };
        let front = rectangle.turned == self.clockwise;
        let face = if front { GlFace::Front } else { GlFace::Back };
        let Some(depth) = self.window_depth(rectangle.z) else { return };
        if self.cull && self.culled == face {
            return;
        }
        let [x, y, width, height] = self.viewport.map(f64::from);
        // The view volume cuts at the viewport's edges [GL 4.6, 13.7].
        let edge = |from: f64, side: f64, at: f32| from + side * (f64::from(at.clamp(-1.0, 1.0)) + 1.0) / 2.0;
        let [x0, y0, x1, y1] = self.cut(rectangle.corners);
        let area = [edge(x, width, x0), edge(y, height, y0), edge(x, width, x1), edge(y, height, y1)];
        // With several samples a pixel is whole or unsure.
        let margin = if samples > 0 { 0.5 + OFF } else { OFF };
        let ends = [0, 1].map(|axis| {
            let (low, high) = (area[axis] - 1.0, area[axis + 2] + 1.0);
            [low.clamp(0.0, f64::from(size[axis])) as u32, (high.ceil().clamp(0.0, f64::from(size[axis]))) as u32]
        });
        for row in ends[1][0]..ends[1][1] {
            for column in ends[0][0]..ends[0][1] {
                let at = [column, row];
                let sides = [covered(area[0], area[2], column, margin), covered(area[1], area[3], row, margin)];
                if sides.contains(&Some(false)) || !self.in_scissor(at) {
                    continue;
                }
                let Some(colors) = self.shaded(rectangle, front, at) else { continue };
                let depth = if self.program == Program::Depth { self.written_depth() } else { depth };
                let fragment = Fragment { colors, depth, sure: !sides.contains(&None) };
                self.write(at, &fragment, usize::from(!front));
            }
        }
    }

    /// Corners of what a clip distance leaves.
    fn cut(&self, [x0, y0, x1, y1]: [f32; 4]) -> [f32; 4] {
        let [slope, height] = self.uniforms[self.program as usize].cut;
        let at = -height / slope;
        match self.clip_distance {
            true if slope > 0.0 => [x0.max(at), y0, x1, y1],
            true if slope < 0.0 => [x0, y0, x1.min(at), y1],
            true if height < 0.0 => [2.0; 4],
            _ => [x0, y0, x1, y1],
        }
    }

    /// Depth in the window of a flat rectangle; `None`: it is clipped.
    fn window_depth(&self, z: f32) -> Option<Depth> {
        let outside = !(-1.0..=1.0).contains(&z);
        if outside && !self.depth_clamp {
            return None;
        }
        let [near, far] = self.depth_range;
        let value = near + (far - near) * (f64::from(z) + 1.0) / 2.0;
        let clamped = value.clamp(near.min(far), near.max(far));
        let mut depth = Depth { value: clamped, slack: 0.0, way: if outside { Way::Other } else { Way::Drawn } };
        if self.offset_fill && self.offset.units != 0.0 {
            // One unit is the least difference that the format resolves, or more [GL 4.6, 14.6.5]: within two steps of 16 bits.
            depth = Depth { slack: f64::from(self.offset.units).abs() * 2.0 / 65535.0, way: Way::Other, ..depth };
        }
        Some(depth)
    }

    /// gl_FragDepth, which depth clamp keeps in the depth range too [GL 4.6, 17.3.4].
    fn written_depth(&self) -> Depth {
        let value = f64::from(self.uniforms[Program::Depth as usize].reference).clamp(0.0, 1.0);
        let [near, far] = self.depth_range;
        let clamped = if self.depth_clamp { value.clamp(near.min(far), near.max(far)) } else { value };
        Depth { value: clamped, slack: 0.0, way: if clamped == value { Way::Written } else { Way::Other } }
    }

    pub fn in_scissor(&self, at: [u32; 2]) -> bool {
        let [x, y, width, height] = self.scissor.map(i64::from);
        let [column, row] = at.map(i64::from);
        !self.scissor_test || (column >= x && column < x + width && row >= y && row < y + height)
    }

    /// Colours of the outputs; `None`: discarded.
    fn shaded(&self, rectangle: &Rectangle, front: bool, at: [u32; 2]) -> Option<[[Bounds; 4]; OUTPUTS]> {
        let uniforms = self.uniforms[self.program as usize];
        let of = |color: [f32; 4]| color.map(|value| Bounds::of(f64::from(value)));
        let unknown = [Bounds::UNKNOWN; 4];
        // An interpolated constant is the constant, within the rounding of a division and of the sums before it.
        let passed = of(rectangle.color).map(|value| value.widened(1e-5 * value.high.abs()));
        let color = of(uniforms.color);
        Some(match self.program {
            Program::Plain | Program::Depth | Program::Clip => [color, unknown],
            Program::Opaque => [[color[0], color[1], color[2], Bounds::ONE], unknown],
            Program::Varying => [passed, unknown],
            Program::Squares => {
                let square = |axis: usize| at[axis] as i32 / uniforms.period[axis];
                if (square(0) + square(1)) & 1 == 1 {
                    return None;
                }
                [color, unknown]
            }
            Program::Two => {
                let [r, g, b, a] = color;
                [color, [a, b, g, r]]
            }
            Program::Sides => [if front { color } else { passed }, unknown],
            program => {
                let (_, looked) = self.looked()?;
                let texel = looked.color(program, at);
                let result = match program {
                    Program::Fetch => std::array::from_fn(|channel| {
                        let product = texel[channel].times(color[channel]);
                        if product.is_known() { product.widened(1e-7 * product.high.abs()) } else { product }
                    }),
                    _ => texel,
                };
                [result, unknown]
            }
        })
    }

    /// Tests and writes at one pixel [GL 4.6, 17.3].
    fn write(&mut self, at: [u32; 2], fragment: &Fragment, side: usize) {
        let Some(framebuffer) = self.framebuffer(false).copied() else { return };
        let mut sure = fragment.sure;
        let mut lives = true;
        if let Some(attached) = framebuffer.depth {
            let Some((before, format)) = self.pixel(attached.place, at) else { return };
            let mut after = before;
            let has_stencil = attached.stencil && self.stencil_test;
            let state = self.stencil[side];
            let stencil_passes = if has_stencil { self.stencil_passes(state, before.stencil) } else { Some(true) };
            let depth_passes = if self.depth_test {
                fragment.depth.passes(self.depth_func, before.depth, step(format))
            } else {
                Some(true)
            };
            lives = stencil_passes != Some(false) && depth_passes != Some(false);
            let passes = match (stencil_passes, depth_passes) {
                (Some(stencil), Some(depth)) => Some(stencil && depth),
                (Some(false), _) | (_, Some(false)) => Some(false),
                _ => None,
            };
            if has_stencil {
                let op = match (stencil_passes, depth_passes) {
                    (Some(false), _) => Some(state.ops[0]),
                    (Some(true), Some(false)) => Some(state.ops[1]),
                    (Some(true), Some(true)) => Some(state.ops[2]),
                    (Some(true), None) if state.ops[1] == state.ops[2] => Some(state.ops[1]),
                    (None, Some(depth)) if state.ops[0] == state.ops[1 + usize::from(depth)] => Some(state.ops[0]),
                    (None, None) if state.ops[0] == state.ops[1] && state.ops[1] == state.ops[2] => Some(state.ops[0]),
                    _ => None,
                };
                after.stencil = op.zip(before.stencil).map(|(op, value)| {
                    let mask = state.write_mask as u8;
                    value & !mask | stencil_result(op, value, state.reference) & mask
                });
                if op == Some(GlStencilOp::Keep) || state.write_mask as u8 == 0 {
                    after.stencil = before.stencil;
                }
            }
            sure &= passes.is_some();
            if self.depth_test && self.depth_mask {
                match passes {
                    Some(true) => after.depth = fragment.depth,
                    Some(false) => {}
                    None => after.depth = either_depth(before.depth, fragment.depth),
                }
                if passes == Some(true) {
                    after.depth.slack += step(format);
                    if after.depth.way == Way::Other || format_is_float(format) {
                        after.depth.slack = after.depth.slack.max(2e-7);
                    }
                }
            }
            if !fragment.sure {
                after.depth =
                    if after.depth == before.depth { before.depth } else { either_depth(before.depth, after.depth) };
                after.stencil = after.stencil.filter(|value| Some(*value) == before.stencil);
            }
            self.set_pixel(attached.place, at, after);
        }
        if lives {
            self.write_colors(at, fragment, sure);
        }
    }

    fn write_colors(&mut self, at: [u32; 2], fragment: &Fragment, sure: bool) {
        let Some(framebuffer) = self.framebuffer(false).copied() else { return };
        for (output, attachment) in framebuffer.outputs.into_iter().enumerate() {
            let Some(attached) = attachment.and_then(|index| framebuffer.color[index as usize]) else { continue };
            let Some((before, format)) = self.pixel(attached.place, at) else { continue };
            let source = fragment.colors[output];
            let color = if self.blend[output] {
                blended(format, source, before.color, self.factors, self.equations)
            } else {
                source.map(|value| stored(format, value, None))
            };
            let mut after = before;
            for channel in (0..channels(format)).filter(|channel| self.masks[output][*channel]) {
                after.color[channel] = if sure { color[channel] } else { color[channel].or(before.color[channel]) };
            }
            after.color = filled(format, after.color);
            self.set_pixel(attached.place, at, after);
        }
    }

    fn stencil_passes(&self, state: GlStencil, value: Option<u8>) -> Option<bool> {
        use crate::conformance::bench::GlCompare;
        if matches!(state.compare, GlCompare::Always | GlCompare::Never) {
            return Some(state.compare == GlCompare::Always);
        }
        let mask = state.read_mask as u8;
        let reference = state.reference.clamp(0, 255) as u8 & mask;
        value.map(|value| state.compare.holds(reference.cmp(&(value & mask))))
    }

    pub fn pixel(&self, place: Place, at: [u32; 2]) -> Option<(KnownPixel, GlFormat)> {
        let [level, layer] = Self::part(place);
        self.image(place).map(|image| (image.at(level, layer, at), image.format))
    }

    pub fn set_pixel(&mut self, place: Place, [x, y]: [u32; 2], pixel: KnownPixel) {
        let [level, layer] = Self::part(place);
        if let Some(image) = self.image_mut(place) {
            let width = image.size_of(level)[0];
            image.plane_mut(level, layer)[(y * width + x) as usize] = pixel;
        }
    }
}

fn format_is_float(format: GlFormat) -> bool {
    matches!(format, GlFormat::Depth32F | GlFormat::Depth32FStencil8)
}

/// One of two depths, it is not known which.
fn either_depth(one: Depth, other: Depth) -> Depth {
    if !one.is_known() || !other.is_known() {
        return Depth::UNKNOWN;
    }
    let range = one.range().or(other.range());
    Depth { value: f64::midpoint(range.low, range.high), slack: (range.high - range.low) / 2.0, way: Way::Other }
}
