//! Effects of a fragment on its pixel [GL 4.6, 17.3]: stencil, depth, blending, masks.

use super::glsl::either_of;
use super::images::{Plane, stored_color, stored_depth};
use super::lookups::holds;
use crate::conformance::model::number::Num;
use crate::pass::{Blend, Compare, DrawState, Format, Stencil, StencilOp, StencilOps};

/// Planes that a pass draws into.
pub struct Targets<'a> {
    pub color: &'a mut Plane,
    pub depth: &'a mut Plane,
    pub color_format: Option<Format>,
    pub depth_format: Option<Format>,
}

/// Outputs of a fragment shader.
pub struct Outputs {
    pub color: [Num; 4],
    pub depth: Num,
}

/// A fragment, before its tests.
pub struct Fragment {
    pub lane: usize,
    pub pixel: [u32; 2],
    /// It is there for sure.
    pub is_sure: bool,
    pub front: Option<bool>,
    pub depth: Num,
    pub maker: u64,
}

impl Fragment {
    /// Tests whether a fragment of this depth may change anything.
    pub fn may_change(&self, targets: &Targets, state: &DrawState) -> bool {
        let fails = self.passes_depth(targets, state, self.depth) == Some(false);
        !fails || state.stencil.is_some()
    }

    fn index(&self, width: usize) -> usize {
        self.pixel[1] as usize * width + self.pixel[0] as usize
    }

    /// The depth as it is compared and stored.
    fn stored(&self, targets: &Targets, state: &DrawState, depth: Num) -> Num {
        let Some(format) = targets.depth_format else { return depth };
        let mut depth = depth;
        if state.depth_clamp && depth.is_known() {
            let [a, b] = state.depth_range.map(f64::from);
            depth = depth.most(Num::exact(a.min(b))).least(Num::exact(a.max(b)));
        }
        stored_depth(format, depth)
    }

    fn passes_depth(&self, targets: &Targets, state: &DrawState, depth: Num) -> Option<bool> {
        let Some(test) = state.depth_test.filter(|_| targets.depth_format.is_some()) else { return Some(true) };
        let index = self.index(targets.depth.size[0]);
        if self.maker != 0 && self.maker == targets.depth.makers[index] {
            return Some(matches!(test, Compare::LessEqual | Compare::Equal | Compare::GreaterEqual | Compare::Always));
        }
        holds(test, self.stored(targets, state, depth), targets.depth.depth[index])
    }

    pub fn write(&self, targets: &mut Targets, state: &DrawState, outputs: &Outputs) {
        let depth_passes = self.passes_depth(targets, state, outputs.depth);
        let mut stencil_passes = Some(true);
        if let Some(stencil) = state.stencil.filter(|_| targets.depth_format == Some(Format::Depth24Stencil8)) {
            let index = self.index(targets.depth.size[0]);
            let old = targets.depth.stencil[index];
            stencil_passes = old.and_then(|old| tested(&stencil, old));
            if stencil.write_mask != 0 {
                targets.depth.stencil[index] = self.counted(&stencil, old, stencil_passes, depth_passes);
            }
        }
        if depth_passes == Some(false) || stencil_passes == Some(false) {
            return;
        }
        let is_sure = self.is_sure && depth_passes.is_some() && stencil_passes.is_some();
        if state.depth_test.is_some() && state.depth_write && targets.depth_format.is_some() {
            let stored = self.stored(targets, state, outputs.depth);
            let index = self.index(targets.depth.size[0]);
            let plane = &mut *targets.depth;
            plane.depth[index] = if is_sure { stored } else { either_of(stored, plane.depth[index]) };
            plane.makers[index] = if is_sure { self.maker } else { 0 };
        }
        if let Some(format) = targets.color_format {
            let index = self.index(targets.color.size[0]);
            let texel = &mut targets.color.color[index];
            let blended = blended(format, state.blend, outputs.color, *texel);
            let mask = state.color_write.mask();
            for channel in (0..4).filter(|channel| mask[*channel]) {
                let old = texel[channel];
                texel[channel] = if is_sure { blended[channel] } else { either_of(blended[channel], old) };
            }
        }
    }

    /// The stencil value after all that may happen; `None`: one of several.
    fn counted(
        &self,
        stencil: &Stencil,
        old: Option<u8>,
        stencil_passes: Option<bool>,
        depth_passes: Option<bool>,
    ) -> Option<u8> {
        let sides: &[&StencilOps] = match self.front {
            Some(true) => &[&stencil.front],
            Some(false) => &[&stencil.back],
            None => &[&stencil.front, &stencil.back],
        };
        let old_value = old.unwrap_or(0);
        let mut ends = Vec::new();
        for side in sides {
            let mut add = |op: StencilOp| {
                // Of a value that is not known nothing is known, but what sets or keeps it.
                let next = match op {
                    StencilOp::Keep => old,
                    StencilOp::Zero | StencilOp::Replace if stencil.write_mask == 0xFF => {
                        Some(changed(op, old_value, stencil))
                    }
                    _ => old.map(|old| changed(op, old, stencil)),
                };
                ends.push(next);
            };
            if stencil_passes != Some(true) {
                add(side.stencil_fail);
            }
            if stencil_passes != Some(false) {
                if depth_passes != Some(true) {
                    add(side.depth_fail);
                }
                if depth_passes != Some(false) {
                    add(side.pass);
                }
            }
        }
        if !self.is_sure {
            ends.push(old);
        }
        let first = ends[0]?;
        ends.iter().all(|end| *end == Some(first)).then_some(first)
    }
}

fn tested(stencil: &Stencil, old: u8) -> Option<bool> {
    let number = |value: u8| Num::exact(f64::from(value & stencil.read_mask));
    holds(stencil.test, number(stencil.reference), number(old))
}

fn changed(op: StencilOp, old: u8, stencil: &Stencil) -> u8 {
    let new = match op {
        StencilOp::Keep => old,
        StencilOp::Zero => 0,
        StencilOp::Replace => stencil.reference,
        StencilOp::Increment => old.saturating_add(1),
        StencilOp::IncrementWrap => old.wrapping_add(1),
        StencilOp::Decrement => old.saturating_sub(1),
        StencilOp::DecrementWrap => old.wrapping_sub(1),
        StencilOp::Invert => !old,
    };
    (old & !stencil.write_mask) | (new & stencil.write_mask)
}

/// A colour as it is stored after blending [GL 4.6, 17.3.6].
fn blended(format: Format, blend: Option<Blend>, source: [Num; 4], old: [Num; 4]) -> [Num; 4] {
    let source = match format {
        Format::Rgba8 => source.map(|part| match part.is_known() {
            true => part.most(Num::exact(0.0)).least(Num::exact(1.0)),
            false => part,
        }),
        _ => source,
    };
    let Some(blend) = blend else { return source.map(|part| stored_color(format, part, 0.6)) };
    let less = |alpha: Num| Num::exact(1.0).minus(alpha);
    let mixed = |channel: usize| match blend {
        Blend::Add => source[channel].plus(old[channel]),
        Blend::Over => source[channel].times(source[3]).plus(old[channel].times(less(source[3]))),
        Blend::OverPremultiplied => source[channel].plus(old[channel].times(less(source[3]))),
        Blend::AddByStoredAlpha => source[channel].times(old[3]).plus(old[channel]),
        Blend::Multiply | Blend::MultiplyAndStoreAlpha => source[channel].times(old[channel]),
    };
    let stored = |number: Num| stored_color(format, number, 1.6);
    let alpha = match blend {
        Blend::OverPremultiplied => stored(mixed(3)),
        Blend::MultiplyAndStoreAlpha => stored_color(format, source[3], 0.6),
        _ => old[3],
    };
    [stored(mixed(0)), stored(mixed(1)), stored(mixed(2)), alpha]
}
