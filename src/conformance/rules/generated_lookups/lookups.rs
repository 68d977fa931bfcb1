//! Look-up functions of GLSL: the programs that call them, and what each is due to give [GLSL 4.60, 8.9].

use super::model::{Comparison, Shape, Span, Texture};
use super::query::Query;
use crate::conformance::bench::Sampling;

/// LookUpKind of a sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    Float,
    Shadow,
    Int,
    Uint,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LookUp {
    Texture,
    Bias,
    /// textureProj with one coordinate more than the texture has.
    Proj,
    /// textureProj of four coordinates.
    ProjOfFour,
    ProjLod,
    Lod,
    Grad,
    Fetch,
    FetchOffset,
    Offset,
    LodOffset,
    ProjOffset,
    Size,
    Gather,
}

/// Stage that looks up, and where its coordinates come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A varying: levels follow from its derivatives.
    Interpolated,
    /// A texture of coordinates, new ones for each pixel.
    Fetched,
    /// An attribute; the vertex shader looks up.
    Vertex,
}

/// A look-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LookUpKind {
    pub shape: Shape,
    pub class: Class,
    pub function: LookUp,
    pub source: Source,
}

/// Offset of functions that have one.
pub const OFFSET: [i64; 3] = [-3, 5, 2];

impl LookUpKind {
    /// Every look-up that the GLSL at hand has.
    pub fn all(gathers: bool) -> Vec<Self> {
        let mut all = Vec::new();
        for shape in Shape::ALL {
            for class in [Class::Float, Class::Shadow, Class::Int, Class::Uint] {
                for function in LookUp::ALL {
                    for source in [Source::Interpolated, Source::Fetched, Source::Vertex] {
                        let kind = Self { shape, class, function, source };
                        if kind.is_there() && (gathers || function != LookUp::Gather) {
                            all.push(kind);
                        }
                    }
                }
            }
        }
        all
    }

    fn is_there(self) -> bool {
        let Self { shape, class, function, source } = self;
        let is_cube = shape == Shape::Cube;
        let has_levels = shape != Shape::Rectangle;
        let shadow = class == Class::Shadow;
        let there = match function {
            LookUp::Texture => true,
            LookUp::Bias => has_levels && !(shadow && shape == Shape::Array),
            LookUp::Proj => !matches!(shape, Shape::Cube | Shape::Array | Shape::Volume) && !shadow,
            LookUp::ProjOfFour | LookUp::ProjOffset => !matches!(shape, Shape::Cube | Shape::Array),
            LookUp::ProjLod => has_levels && !matches!(shape, Shape::Cube | Shape::Array),
            LookUp::Lod => has_levels && !(shadow && matches!(shape, Shape::Cube | Shape::Array)),
            LookUp::Grad => true,
            LookUp::Fetch => !is_cube && !shadow,
            LookUp::FetchOffset => !is_cube && !shadow,
            LookUp::Offset => !(is_cube || shadow && shape == Shape::Array),
            LookUp::LodOffset => has_levels && !is_cube && !(shadow && shape == Shape::Array),
            LookUp::Size => true,
            LookUp::Gather => matches!(shape, Shape::Flat | Shape::Array | Shape::Rectangle),
        };
        let shape_is_there = !(shadow && shape == Shape::Volume);
        let source_is_there = match source {
            Source::Interpolated => {
                matches!(function, LookUp::Texture | LookUp::Bias | LookUp::Proj | LookUp::ProjOfFour | LookUp::Offset)
            }
            Source::Fetched => !matches!(function, LookUp::Bias),
            Source::Vertex => matches!(function, LookUp::Lod | LookUp::Fetch | LookUp::ProjLod | LookUp::Size),
        };
        // Each function has a texture of two dimensions; fewer are read with the others, and of integers.
        let is_flat = shape == Shape::Flat;
        let is_usual = match function {
            LookUp::FetchOffset | LookUp::LodOffset | LookUp::ProjOffset => is_flat,
            LookUp::Proj => is_flat || source == Source::Fetched && shape == Shape::Rectangle,
            LookUp::ProjLod | LookUp::Grad | LookUp::Gather => shape != Shape::Rectangle,
            LookUp::ProjOfFour => is_flat || source == Source::Fetched,
            LookUp::Offset => source == Source::Fetched || is_flat,
            LookUp::Size => source == Source::Fetched || is_flat,
            _ => true,
        };
        let is_usual = is_usual
            && match class {
                Class::Float => true,
                Class::Shadow => !matches!(shape, Shape::Line) && function != LookUp::Size,
                Class::Int | Class::Uint => {
                    is_flat && matches!(function, LookUp::Texture | LookUp::Fetch | LookUp::ProjOfFour)
                        || matches!((shape, function), (Shape::Cube | Shape::Array, LookUp::Lod))
                }
            };
        let is_usual = is_usual
            && (source != Source::Vertex || class != Class::Int && matches!(function, LookUp::Lod | LookUp::Fetch));
        there && shape_is_there && source_is_there && is_usual
    }

    /// GLSL's type of the sampler.
    pub fn sampler(self) -> String {
        let prefix = match self.class {
            Class::Int => "i",
            Class::Uint => "u",
            _ => "",
        };
        let shape = match self.shape {
            Shape::Line => "1D",
            Shape::Flat => "2D",
            Shape::Volume => "3D",
            Shape::Cube => "Cube",
            Shape::Array => "2DArray",
            Shape::Rectangle => "2DRect",
        };
        let suffix = if self.class == Class::Shadow { "Shadow" } else { "" };
        format!("{prefix}sampler{shape}{suffix}")
    }

    /// Tests whether the coordinates are divided by the last.
    pub fn is_projective(self) -> bool {
        use LookUp::{Proj, ProjLod, ProjOfFour, ProjOffset};
        matches!(self.function, Proj | ProjOfFour | ProjLod | ProjOffset)
    }

    /// Tests whether the level follows from derivatives.
    pub fn is_implicit(self) -> bool {
        use LookUp::{Bias, Offset, Proj, ProjOfFour, ProjOffset, Texture};
        matches!(self.function, Texture | Bias | Proj | ProjOfFour | Offset | ProjOffset)
    }

    /// The look-up of `at` and `by`, as a vec4.
    pub fn expression(self) -> String {
        use LookUp::{
            Bias, Fetch, FetchOffset, Gather, Grad, Lod, LodOffset, Offset, Proj, ProjLod, ProjOfFour, ProjOffset,
            Size, Texture,
        };
        let shadow = self.class == Class::Shadow;
        let at = match (self.shape, shadow) {
            (Shape::Line, false) => "at.x",
            (Shape::Flat | Shape::Rectangle, false) => "at.xy",
            (Shape::Volume | Shape::Cube | Shape::Array, false) => "at.xyz",
            (Shape::Line, true) => "vec3(at.x, 0.375, at.w)",
            (Shape::Flat | Shape::Rectangle, true) => "vec3(at.xy, at.w)",
            _ => "at",
        };
        let four = match (self.shape, shadow) {
            (Shape::Line, true) => "vec4(at.x, 0.375, at.zw)",
            (Shape::Line, false) => "vec4(at.x, 0.375, -2.0, at.w)",
            (Shape::Volume, _) | (_, true) => "at",
            _ => "vec4(at.xy, -2.0, at.w)",
        };
        let short = if self.shape == Shape::Line { "at.xw" } else { "at.xyw" };
        let axes = self.shape.axes();
        let texel = match self.shape {
            Shape::Line => "int(at.x)",
            Shape::Flat | Shape::Rectangle => "ivec2(at.xy)",
            _ => "ivec3(at.xyz)",
        };
        let [x, y, z] = OFFSET;
        let offset = match axes {
            1 => format!("{x}"),
            2 => format!("ivec2({x}, {y})"),
            _ => format!("ivec3({x}, {y}, {z})"),
        };
        let gradients = match self.shape {
            Shape::Line => "by.x, by.z",
            Shape::Volume | Shape::Cube => "by.xyz, by.yzw",
            _ => "by.xy, by.zw",
        };
        let level = if self.shape == Shape::Rectangle { "" } else { ", int(at.w)" };
        // The same for all pixels: Mesa's llvmpipe takes the size of one level for several pixels side by side.
        let level_of_size = if level.is_empty() { "" } else { ", int(by.x)" };
        let call = match self.function {
            Texture => format!("texture(map, {at})"),
            Bias => format!("texture(map, {at}, by.x)"),
            Proj => format!("textureProj(map, {short})"),
            ProjOfFour => format!("textureProj(map, {four})"),
            ProjLod => format!("textureProjLod(map, {four}, by.x)"),
            Lod => format!("textureLod(map, {at}, by.x)"),
            Grad => format!("textureGrad(map, {at}, {gradients})"),
            Fetch => format!("texelFetch(map, {texel}{level})"),
            FetchOffset => format!("texelFetchOffset(map, {texel}{level}, {offset})"),
            Offset => format!("textureOffset(map, {at}, {offset})"),
            LodOffset => format!("textureLodOffset(map, {at}, by.x, {offset})"),
            ProjOffset => format!("textureProjOffset(map, {four}, {offset})"),
            Gather if shadow => {
                format!("textureGather(map, at.{}, at.w)", if self.shape == Shape::Array { "xyz" } else { "xy" })
            }
            Gather => format!("textureGather(map, {at})"),
            Size => {
                let call = format!("textureSize(map{level_of_size})");
                return match (self.shape, axes) {
                    (Shape::Line, _) => format!("vec4({call}, 0, 0, 1)"),
                    (Shape::Array | Shape::Volume, _) => format!("vec4({call}, 1)"),
                    _ => format!("vec4({call}, 0, 1)"),
                };
            }
        };
        if shadow && self.function != Gather { format!("vec4({call}, 0.0, 0.0, 1.0)") } else { format!("vec4({call})") }
    }
}

impl LookUp {
    const ALL: [Self; 14] = [
        Self::Texture,
        Self::Bias,
        Self::Proj,
        Self::ProjOfFour,
        Self::ProjLod,
        Self::Lod,
        Self::Grad,
        Self::Fetch,
        Self::FetchOffset,
        Self::Offset,
        Self::LodOffset,
        Self::ProjOffset,
        Self::Size,
        Self::Gather,
    ];
}

/// Inputs of a look-up.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    pub at: [f64; 4],
    pub by: [f64; 4],
    /// Derivatives of `at` along x and y, of a varying.
    pub slopes: Option<[[f64; 4]; 2]>,
    /// Absolute error of `at`.
    pub error: f64,
}

/// Results that a look-up may give.
pub enum DueTexel<'a> {
    Filtered(Query<'a>),
    Open,
    Texel(Span),
    Exactly([f64; 4]),
    Four(Query<'a>),
}

impl LookUpKind {
    /// The results that a look-up may give in a texture, by the parameters in force.
    pub fn due<'a>(
        self,
        texture: &'a Texture,
        sampling: &'a Sampling,
        seamless: bool,
        inputs: &Inputs,
    ) -> DueTexel<'a> {
        use LookUp::{Bias, Fetch, FetchOffset, Gather, Grad, Lod, LodOffset, Offset, ProjLod, ProjOffset, Size};
        let last = texture.levels.len() - 1;
        let base = (sampling.levels.map_or(0, |[base, _]| base) as usize).min(last);
        let [x, y, z, w] = inputs.at;
        if matches!(self.function, Fetch | FetchOffset | Size) {
            let above = if self.function == Size { inputs.by[0] } else { w };
            let level = if self.shape == Shape::Rectangle { 0 } else { base + above as usize };
            let texels = &texture.levels[level.min(last)];
            let [width, height, depth] = texels.size.map(|side| side as f64);
            if self.function == Size {
                return DueTexel::Exactly(match self.shape {
                    Shape::Line => [width, 0.0, 0.0, 1.0],
                    Shape::Array | Shape::Volume => [width, height, depth, 1.0],
                    _ => [width, height, 0.0, 1.0],
                });
            }
            let used = if self.shape == Shape::Array { 3 } else { self.shape.axes() };
            let place = [x, y, z].map(|at| at as i64);
            let moved =
                |axis: usize| if self.function == FetchOffset && axis < self.shape.axes() { OFFSET[axis] } else { 0 };
            let texel = [0, 1, 2].map(|axis| if axis < used { place[axis] + moved(axis) } else { 0 });
            if !texels.known {
                return DueTexel::Open;
            }
            return DueTexel::Texel(Span::of(texels.at(texel), texels.slack));
        }
        let projective = self.is_projective();
        let divisor = if projective { w } else { 1.0 };
        let at = [x, y, z].map(|at| at / divisor);
        let size = &texture.levels[base].size;
        let lod = match self.function {
            Lod | LodOffset | ProjLod => [inputs.by[0]; 2],
            Grad => {
                let [dx, dy] = match self.shape {
                    Shape::Line => [[inputs.by[0], 0.0, 0.0], [inputs.by[2], 0.0, 0.0]],
                    Shape::Volume | Shape::Cube => {
                        let [a, b, c, d] = inputs.by;
                        [[a, b, c], [b, c, d]]
                    }
                    _ => [[inputs.by[0], inputs.by[1], 0.0], [inputs.by[2], inputs.by[3], 0.0]],
                };
                level_of(self.shape, size, at, [dx, dy])
            }
            _ => match inputs.slopes {
                Some(slopes) => {
                    let slopes = slopes.map(|[x, y, z, _]| [x, y, z].map(|slope| slope / divisor));
                    level_of(self.shape, size, at, slopes)
                }
                None => [0.0; 2],
            },
        };
        let bias = f64::from(sampling.bias) + if self.function == Bias { inputs.by[0] } else { 0.0 };
        // 0 has no sign for a comparison.
        let reference = if projective { z / w } else { w } + 0.0;
        let compare = sampling.compare.filter(|_| self.class == Class::Shadow).map(|function| {
            let range = texture.format.range();
            let clamped = range.map_or(reference, |[low, high]| reference.clamp(low, high));
            let bits = if texture.format.bits[0] == 16 { 16 } else { 20 };
            let rounded = if projective { f64::from(-21).exp2() } else { f64::from(-24).exp2() };
            let tie = f64::from(-bits).exp2() + reference.abs() * rounded + inputs.error / divisor.abs();
            let is_given = !projective && inputs.error == 0.0;
            // What is taken from memory as it is can be equal, and what is clamped.
            let exact = is_given || (clamped - reference).abs() > tie;
            let tie = if is_given && range.is_none() { 0.0 } else { tie };
            let reference = clamped + 0.0;
            Comparison { function, reference, tie, exact }
        });
        let rounded = match self.shape {
            Shape::Cube => -18,
            _ if projective => -20,
            _ => -22,
        };
        let has_offset = matches!(self.function, Offset | LodOffset | ProjOffset);
        let query = Query {
            texture,
            sampling,
            seamless,
            compare,
            at,
            error: f64::from(rounded).exp2() + inputs.error / divisor.abs(),
            offset: if has_offset { OFFSET } else { [0; 3] },
            lod: lod.map(|lod| lod + bias),
        };
        if self.function == Gather { DueTexel::Four(query) } else { DueTexel::Filtered(query) }
    }
}

/// lambda of derivatives: between the logarithms of the greatest and of the sums [GL 4.6, 8.14.1].
fn level_of(shape: Shape, size: &[usize; 3], at: [f64; 3], slopes: [[f64; 3]; 2]) -> [f64; 2] {
    let slopes = match shape {
        // On a face, by the quotient's rule.
        Shape::Cube => slopes.map(|slope| on_face(at, slope)),
        _ => slopes,
    };
    let axes = shape.axes();
    let texels = slopes.map(|slope| {
        [0, 1, 2].map(|axis| match axis {
            axis if axis >= axes => 0.0,
            _ if shape == Shape::Rectangle => slope[axis],
            axis => slope[axis] * size[axis] as f64,
        })
    });
    let greatest = [0, 1, 2].map(|axis| texels[0][axis].abs().max(texels[1][axis].abs()));
    [greatest.into_iter().fold(0.0, f64::max), greatest.into_iter().sum::<f64>()].map(|rho: f64| rho.max(1e-30).log2())
}

/// Derivatives of s and t of a direction.
fn on_face(at: [f64; 3], slope: [f64; 3]) -> [f64; 3] {
    use crate::conformance::verify::cube;
    let Some(face) = cube::faces(at).next() else { return [0.0; 3] };
    let step =
        1e-4 * at.into_iter().map(f64::abs).fold(0.0, f64::max) / slope.into_iter().map(f64::abs).fold(1e-30, f64::max);
    let there = |by: f64| cube::on_face(face, [0, 1, 2].map(|axis| at[axis] + by * step * slope[axis]));
    let [low, high] = [there(-1.0), there(1.0)];
    [(high[0] - low[0]) / (2.0 * step), (high[1] - low[1]) / (2.0 * step), 0.0]
}
