//! Look-ups of the programs in the model: texels at places that are known, by filters whose result is known there.

use crate::conformance::bench::commands::Program;
use crate::conformance::bench::{GlFormat, GlMipmap, GlShape, GlSwizzle, GlWrap};
use crate::conformance::verify::cube;

use super::image::{Image, Sampler};
use super::pixel::{self, Bounds, Depth, KnownPixel, Way, filled, step};
use super::state::{State, Uniforms, target};

/// Share of a texel within which a place may belong to the texel beside it.
const NEAR: f64 = 1.0 / 64.0;

/// A texture that a program reads, and by which sampler state.
pub struct Looked<'a> {
    pub image: &'a Image,
    sampler: Sampler,
    uniforms: Uniforms,
}

/// Shape of the texture that a program reads.
pub fn shape(program: Program) -> GlShape {
    match program {
        Program::LookCube => GlShape::Cube,
        Program::FetchLayer => GlShape::Array,
        _ => GlShape::Flat,
    }
}

/// Index of a texel along one axis; `None`: the border.
fn wrapped(index: i64, size: u32, wrap: GlWrap) -> Option<u32> {
    let size = i64::from(size);
    let index = match wrap {
        GlWrap::Repeat => index.rem_euclid(size),
        GlWrap::MirroredRepeat => {
            let turned = index.rem_euclid(2 * size);
            if turned < size { turned } else { 2 * size - 1 - turned }
        }
        GlWrap::ClampToEdge => index.clamp(0, size - 1),
        GlWrap::ClampToBorder | GlWrap::Clamp if (0..size).contains(&index) => index,
        GlWrap::ClampToBorder | GlWrap::Clamp => return None,
    };
    Some(index as u32)
}

impl State {
    /// The texture that the program in use reads, if its unit has one.
    pub fn looked(&self) -> Option<(usize, Looked<'_>)> {
        let uniforms = self.uniforms[self.program as usize];
        let unit = &self.units[uniforms.unit as usize];
        let slot = unit.textures[target(shape(self.program))]?;
        let image = self.textures[slot].as_ref()?;
        Some((slot, Looked { image, sampler: self.in_force(uniforms.unit as usize, image), uniforms }))
    }
}

impl Looked<'_> {
    /// Tests whether GL says what the program reads: the levels are there, and comparison is on where it must be and
    /// off elsewhere [GL 4.6, 8.23].
    pub fn is_defined(&self, program: Program) -> bool {
        let Self { image, sampler, uniforms } = self;
        let [base, most] = image.range;
        let depth = image.format.is_depth();
        let compares = program == Program::Compare;
        let fetches = matches!(program, Program::Fetch | Program::FetchDepth | Program::FetchLayer);
        let has_level = uniforms.level >= 0 && base + uniforms.level as u32 <= most;
        // Without mipmaps the texture has one level.
        let one = sampler.mipmap == GlMipmap::Off;
        let plain = image.swizzle == GlSwizzle::SAME;
        has_level
            && (!one || uniforms.level == 0)
            && sampler.compare.is_some() == compares
            && (!compares || depth && plain)
            && (program != Program::FetchDepth || depth && plain)
            && (!matches!(program, Program::Fetch | Program::FetchLayer | Program::Look | Program::LookCube) || !depth)
            && (program != Program::FetchLayer || (uniforms.layer as u32) < image.layers)
            && (fetches || sampler.lod[0] <= sampler.lod[1])
            && (program != Program::LookCube || !sampler.linear[0] && !sampler.linear[1])
    }

    /// The colour that the program reads at a pixel.
    pub fn color(&self, program: Program, [x, y]: [u32; 2]) -> [Bounds; 4] {
        let Self { image, sampler, uniforms } = self;
        let level = image.range[0] + uniforms.level as u32;
        let size = image.size_of(level);
        let moved = [x, y].map(i64::from);
        let moved: [i64; 2] = std::array::from_fn(|axis| moved[axis] + i64::from(uniforms.origin[axis]));
        let inside = || std::array::from_fn(|axis| (moved[axis] % i64::from(size[axis])) as u32);
        match program {
            Program::Fetch => self.swizzled(image.at(level, 0, inside())),
            Program::FetchLayer => self.swizzled(image.at(level, uniforms.layer as u32, inside())),
            Program::FetchDepth => [sampled_depth(image.format, image.at(level, 0, inside()).depth); 4],
            Program::LookCube => {
                let at: [f64; 2] = inside().map(|index| (f64::from(index) + 0.5) / f64::from(size[0]) * 2.0 - 1.0);
                let [s, t, major] = uniforms.axes.map(|axis| axis.map(f64::from));
                let direction = std::array::from_fn(|axis| s[axis] * at[0] + t[axis] * at[1] + major[axis]);
                let level = self.chosen_level();
                let side = f64::from(image.size_of(level)[0]);
                let mut results = cube::faces(direction).map(|face| {
                    let place = cube::on_face(face, direction).map(|place| (place * side).clamp(0.0, side - 1e-9));
                    self.near([place[0], place[1]], |index| self.swizzled(image.at(level, face as u32, index)), level)
                });
                let first = results.next().unwrap_or([Bounds::UNKNOWN; 4]);
                results.fold(first, either)
            }
            Program::Look | Program::Compare => {
                let level = self.chosen_level();
                let chosen = image.size_of(level);
                let place = std::array::from_fn(|axis| {
                    (moved[axis] as f64 - f64::from(size[axis]) + 0.5) / f64::from(size[axis]) * f64::from(chosen[axis])
                });
                let texel = |at: [i64; 2]| self.texel(program, level, at);
                // The lowest level that there is is magnified if the level of detail is at most that much [GL 4.6, 8.15].
                let clamped = (uniforms.level as f32).clamp(sampler.lod[0], sampler.lod[1]);
                let most =
                    if sampler.linear[1] && !sampler.linear[0] && sampler.mipmap != GlMipmap::Off { 0.5 } else { 0.0 };
                if sampler.linear[usize::from(clamped <= most)] { linear(place, texel) } else { nearest(place, texel) }
            }
            _ => [Bounds::UNKNOWN; 4],
        }
    }

    fn chosen_level(&self) -> u32 {
        let [base, most] = self.image.range;
        if self.sampler.mipmap == GlMipmap::Off {
            return base;
        }
        let clamped = (self.uniforms.level as f32).clamp(self.sampler.lod[0], self.sampler.lod[1]).max(0.0);
        (base + clamped as u32).min(most)
    }

    /// Nearest texel at a place within a level.
    fn near(&self, place: [f64; 2], texel: impl Fn([u32; 2]) -> [Bounds; 4], level: u32) -> [Bounds; 4] {
        let size = self.image.size_of(level);
        nearest(place, |at| texel(std::array::from_fn(|axis| at[axis].clamp(0, i64::from(size[axis]) - 1) as u32)))
    }

    fn swizzled(&self, pixel: KnownPixel) -> [Bounds; 4] {
        let [r, g, b, a] = filled(self.image.format, pixel.color);
        self.image.swizzle.map(|source| match source {
            GlSwizzle::Red => r,
            GlSwizzle::Green => g,
            GlSwizzle::Blue => b,
            GlSwizzle::Alpha => a,
            GlSwizzle::Zero => Bounds::ZERO,
            GlSwizzle::One => Bounds::ONE,
        })
    }

    /// A texel, or the border, as the program makes a colour of it.
    fn texel(&self, program: Program, level: u32, at: [i64; 2]) -> [Bounds; 4] {
        let Self { image, sampler, uniforms } = self;
        let size = image.size_of(level);
        let index = [0, 1].map(|axis| wrapped(at[axis], size[axis], sampler.wrap[axis]));
        let mut pixel = KnownPixel::UNKNOWN;
        if let [Some(x), Some(y)] = index {
            pixel = image.at(level, 0, [x, y]);
        } else {
            let error = if pixel::is_fixed(image.format) { 0.6 / 255.0 } else { 1e-3 };
            pixel.color = sampler.border.map(|value| Bounds::of(f64::from(value)).widened(error));
            let value = f64::from(sampler.border[0]).clamp(0.0, 1.0);
            pixel.depth = Depth { value, slack: 2.0 * step(image.format), way: Way::Other };
        }
        if program != Program::Compare {
            return self.swizzled(pixel);
        }
        // A reference is clamped for fixed-point depths [GL 4.6, 8.23.1].
        let fixed = !matches!(image.format, GlFormat::Depth32F | GlFormat::Depth32FStencil8);
        let reference = f64::from(uniforms.reference);
        let value = if fixed { reference.clamp(0.0, 1.0) } else { reference };
        let reference = Depth { value, slack: 1.0 / 65536.0, way: Way::Other };
        let passes = sampler.compare.and_then(|compare| reference.passes(compare, pixel.depth, step(image.format)));
        let lit = passes.map_or(Bounds { low: 0.0, high: 1.0 }, |passes| Bounds::of(f64::from(u8::from(passes))));
        [lit, Bounds::of(0.25), lit, Bounds::ONE]
    }
}

/// A depth as a look-up without comparison gives it.
fn sampled_depth(format: GlFormat, depth: Depth) -> Bounds {
    depth.range().widened(2.0 * step(format))
}

fn either(one: [Bounds; 4], other: [Bounds; 4]) -> [Bounds; 4] {
    std::array::from_fn(|channel| one[channel].or(other[channel]))
}

/// The texel that a place lies in; near an edge of texels either.
fn nearest(place: [f64; 2], texel: impl Fn([i64; 2]) -> [Bounds; 4]) -> [Bounds; 4] {
    let ends = place.map(|at| [at - NEAR, at + NEAR].map(|at| at.floor() as i64));
    let mut all = texel([ends[0][0], ends[1][0]]);
    for at in [[ends[0][1], ends[1][0]], [ends[0][0], ends[1][1]], [ends[0][1], ends[1][1]]] {
        all = either(all, texel(at));
    }
    all
}

/// Four texels' mean. At a centre it is that texel, with a 64th of what lies around; elsewhere anything between them.
fn linear(place: [f64; 2], texel: impl Fn([i64; 2]) -> [Bounds; 4]) -> [Bounds; 4] {
    let places = place.map(|at| at - 0.5);
    let is_centre = places.iter().all(|at| (at - at.round()).abs() < NEAR);
    let low = places.map(|at| if is_centre { at.round() as i64 - 1 } else { at.floor() as i64 });
    let reach = if is_centre { 3 } else { 2 };
    let around = (0..reach * reach).map(|of| texel([low[0] + of % reach, low[1] + of / reach]));
    let hull = around.reduce(either).unwrap_or([Bounds::UNKNOWN; 4]);
    if !is_centre {
        return hull;
    }
    let centre = texel(places.map(|at| at.round() as i64));
    // Weights of 1/256 at most along each axis; a margin of two.
    std::array::from_fn(|channel| {
        let (middle, all) = (centre[channel], hull[channel]);
        let part = |from: f64, to: f64| if from == to { from } else { from + (to - from) / 64.0 };
        if !all.is_known() {
            return Bounds::UNKNOWN;
        }
        Bounds { low: part(middle.low, all.low), high: part(middle.high, all.high) }
    })
}
