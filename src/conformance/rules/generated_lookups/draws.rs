//! Draws of look-ups: a program and a texture that go together, parameters of which a few change, coordinates of every kind.

use super::formats::{Format, Numbers};
use super::lookups::{Class, Function, Inputs, Kind, OFFSET, Source};
use super::model::{Shape, Texture};
use super::programs::{MAPS, Program, ROWS};
use super::uploads::{below, chance, pick};
use super::world::{TEXTURES, UNITS, World};
use crate::conformance::bench::{GlCompare, GlMipmap, GlTextureStep, GlWrap, Sampling, Vertex, rectangle};
use crate::conformance::random::Random;

/// Pixels of the surface, and of a draw's cell.
pub const COLUMNS: usize = 256;
pub const CELL: [usize; 2] = [32, 8];
pub const CELLS: usize = COLUMNS / CELL[0] * (ROWS / CELL[1]);

/// A draw, with all that its model needs.
pub struct Drawn {
    pub kind: Kind,
    pub texture: Texture,
    pub sampling: Sampling,
    pub seamless: bool,
    pub by_object: bool,
    pub unit: usize,
    pub lookups: Vec<([usize; 2], Inputs)>,
    /// Depths that are not compared are luminance: DEPTH_TEXTURE_MODE as it is at the start.
    pub compatible: bool,
}

/// Draws of a chunk: steps are in the world.
pub struct Chunk {
    pub drawn: Vec<Drawn>,
    /// Texels of the texture of inputs: coordinates in the lower rows, what else in the upper.
    pub inputs: Vec<[f32; 4]>,
    cells: usize,
}

/// A look-up's texture and unit in a draw.
#[derive(Clone, Copy)]
struct Use {
    slot: usize,
    unit: usize,
}

impl World<'_> {
    /// Draws by each of the programs, with textures made as they are needed; `uniforms` has the units of their samplers.
    /// A program draws a few times, with little set anew in between.
    pub fn chunk(&mut self, programs: &[Program], chosen: &[usize], uniforms: &mut [[usize; 4]]) -> Chunk {
        let mut chunk = Chunk { drawn: Vec::new(), inputs: vec![[0.0; 4]; 2 * ROWS * COLUMNS], cells: 0 };
        for &number in chosen {
            if chance(&mut self.random, 0.3) {
                self.edit();
            }
            if chance(&mut self.random, 0.2) {
                self.seamless = !self.seamless;
                self.steps.push(GlTextureStep::Seamless(self.seamless));
            }
            let uses = self.uses(&programs[number].kinds, &uniforms[number]);
            for turn in 0..pick(&mut self.random, &[1, 2, 2, 3]) {
                if chunk.cells == CELLS {
                    return chunk;
                }
                self.draw((number, &programs[number].kinds), &uses, &mut uniforms[number], turn > 0, &mut chunk);
            }
        }
        chunk
    }

    /// A texture and a unit for each look-up, all of them different.
    fn uses(&mut self, kinds: &[Kind], uniforms: &[usize; 4]) -> Vec<Use> {
        let mut uses: Vec<Use> = Vec::new();
        for (kind, now) in kinds.iter().zip(uniforms) {
            let fits = |world: &Self, slot: usize| {
                let is_free = uses.iter().all(|used| used.slot != slot);
                is_free && world.textures[slot].as_ref().is_some_and(|texture| kind.reads(texture))
            };
            let fitting: Vec<_> = (0..TEXTURES).filter(|slot| fits(self, *slot)).collect();
            let free: Vec<_> = (0..TEXTURES).filter(|slot| uses.iter().all(|used| used.slot != *slot)).collect();
            let slot = if fitting.is_empty() || chance(&mut self.random, 0.35) {
                let slot = pick(&mut self.random, &free);
                self.make_for(slot, *kind);
                slot
            } else {
                pick(&mut self.random, &fitting)
            };
            let shape = kind.shape as usize;
            let bound = (0..UNITS).find(|unit| self.bindings[*unit][shape] == Some(slot));
            let wanted = match (bound, below(&mut self.random, 3)) {
                (Some(unit), 0) => unit,
                (_, 1) => *now,
                _ => below(&mut self.random, UNITS),
            };
            let is_free = |unit: usize| uses.iter().all(|used| used.unit != unit);
            let unit = (wanted..UNITS).chain(0..wanted).find(|unit| is_free(*unit)).unwrap_or(0);
            uses.push(Use { slot, unit });
        }
        uses
    }

    fn draw(
        &mut self,
        (program, kinds): (usize, &[Kind]),
        uses: &[Use],
        uniforms: &mut [usize; 4],
        again: bool,
        chunk: &mut Chunk,
    ) {
        let corner = [chunk.cells % (COLUMNS / CELL[0]) * CELL[0], chunk.cells / (COLUMNS / CELL[0]) * CELL[1]];
        let mut samplings = Vec::new();
        let mut objects = Vec::new();
        for (index, (kind, used)) in kinds.iter().zip(uses).enumerate() {
            if again && chance(&mut self.random, 0.3) {
                self.change(used.slot);
            }
            if uniforms[index] != used.unit {
                uniforms[index] = used.unit;
                let (name, value) = (MAPS[index], used.unit as i32);
                self.steps.push(GlTextureStep::Uniform { program, name, value });
            }
            let sampling = self.prepare(*kind, *used, again, &objects);
            objects.extend(self.units[used.unit]);
            samplings.push(sampling);
        }
        // What was bound elsewhere in the meantime is bound again.
        for (kind, used) in kinds.iter().zip(uses) {
            if self.bindings[used.unit][kind.shape as usize] != Some(used.slot) {
                self.bind(used.unit, used.slot);
            }
        }
        let mut more = Vec::new();
        let mut vertices = Vec::new();
        for (index, (kind, used)) in kinds.iter().zip(uses).enumerate() {
            let Some(texture) = self.textures[used.slot].clone() else { return };
            let sampling = samplings[index];
            let (lookups, numbers, corners) =
                self.lookups(&texture, &sampling, *kind, (corner, index, kinds.len()), &mut chunk.inputs);
            more.extend(numbers);
            vertices = corners;
            chunk.drawn.push(Drawn {
                kind: *kind,
                texture,
                sampling,
                seamless: self.seamless,
                by_object: self.units[used.unit].is_some(),
                unit: used.unit,
                lookups,
                compatible: self.compatible,
            });
        }
        self.steps.push(GlTextureStep::Draw { program, more, vertices });
        chunk.cells += 1;
    }

    /// Binds a texture, and changes a few of the parameters in force; after the first draw only numbers that a driver need not
    /// compile anew. `taken`: sampler objects of other look-ups.
    fn prepare(&mut self, kind: Kind, Use { slot, unit }: Use, again: bool, taken: &[usize]) -> Sampling {
        let mut active = false;
        if self.bindings[unit][kind.shape as usize] != Some(slot) {
            self.bind(unit, slot);
            active = true;
        }
        let is_taken = self.units[unit].is_some_and(|object| taken.contains(&object));
        if is_taken || !again && chance(&mut self.random, 0.3) {
            let object = if self.units[unit].is_some() { None } else { Some(self.object(taken)) };
            self.units[unit] = object;
            self.steps.push(GlTextureStep::BindSampler { unit: unit as u32, object });
        }
        let Some(texture) = self.textures[slot].clone() else { return Sampling::NEAREST };
        let own = self.reshuffle(slot, again);
        let object = self.units[unit];
        let before = object.and_then(|object| self.samplers[object]);
        let mut holder = before.unwrap_or(own);
        if again {
            nudge(&mut self.random, &mut holder);
        } else {
            for _ in 0..pick(&mut self.random, &[1, 2, 4, 6]) {
                mutate(&mut self.random, &mut holder);
            }
        }
        let mut own = own;
        fit(&mut self.random, (&mut holder, &mut own), &texture, kind, self.seamless);
        let mut to = own;
        if object.is_none() {
            to = Sampling { levels: own.levels, swizzle: own.swizzle, ..holder };
        }
        if kind.compares() {
            to.swizzle = Sampling::NEAREST.swizzle;
        }
        if to != texture.sampling {
            if !active {
                self.bind(unit, slot);
            }
            let from = Some(texture.sampling);
            self.steps.push(GlTextureStep::Parameters { target: texture.shape.target(), from, to });
            if let Some(texture) = &mut self.textures[slot] {
                texture.sampling = to;
            }
        }
        if let (Some(object), Some(before)) = (object, before)
            && before != holder
        {
            self.steps.push(GlTextureStep::SamplerParameters { object, from: Some(before), to: holder });
            self.samplers[object] = Some(holder);
        }
        Sampling { levels: to.levels, swizzle: to.swizzle, ..holder }
    }

    /// Coordinates of every fourth column of a cell: in the texture of inputs, in vertices, or of a plane.
    #[allow(clippy::type_complexity, reason = "used once")]
    fn lookups(
        &mut self,
        texture: &Texture,
        sampling: &Sampling,
        kind: Kind,
        (corner, index, count): ([usize; 2], usize, usize),
        inputs: &mut [[f32; 4]],
    ) -> (Vec<([usize; 2], Inputs)>, [[f32; 4]; 4], Vec<Vertex>) {
        let random = &mut self.random;
        let ndc = |x: f64, y: f64| [(x * 2.0 / COLUMNS as f64 - 1.0) as f32, (y * 2.0 / ROWS as f64 - 1.0) as f32];
        let [left, low] = corner.map(|at| at as f64);
        let half = CELL.map(|side| side as f64 / 2.0);
        let whole = rectangle(ndc(left, low), ndc(left + 2.0 * half[0], low + 2.0 * half[1]), 0.0, [0.0; 4]);
        let vertices = whole.map(|vertex| {
            let high = [0, 1].map(|axis| vertex.position[axis] > whole[0].position[axis]);
            let [x, y] = [0, 1].map(|axis| if high[axis] { half[axis] } else { -half[axis] } as f32);
            Vertex { value: [x, y, 0.0, 0.0], ..vertex }
        });
        let is_mine = |column: usize| column % 4 == index || index == 0 && column % 4 >= count;
        let places = (0..CELL[0] * CELL[1])
            .filter(|pixel| is_mine(pixel % CELL[0]))
            .map(|pixel| [corner[0] + pixel % CELL[0], corner[1] + pixel / CELL[0]]);
        let uniform = by(random, texture, sampling, kind);
        let mut more = [[0.0; 4], [0.0; 4], [0.0; 4], uniform];
        match kind.source {
            Source::Fetched => {
                let lookups = places.map(|[x, y]| {
                    let is_one = kind.function == Function::Size;
                    let at = place(random, texture, sampling, kind);
                    let by = if is_one { uniform } else { by(random, texture, sampling, kind) };
                    inputs[y * COLUMNS + x] = at;
                    inputs[(y + ROWS) * COLUMNS + x] = by;
                    let inputs = Inputs { at: at.map(f64::from), by: by.map(f64::from), slopes: None, error: 0.0 };
                    ([x, y], inputs)
                });
                (lookups.collect(), more, vertices.to_vec())
            }
            Source::Vertex => {
                let mut vertices = Vec::new();
                let lookups = places.take(64).map(|[x, y]| {
                    let at = place(random, texture, sampling, kind);
                    for [dx, dy] in [[0.1, 0.1], [1.2, 0.2], [0.2, 1.2]] {
                        let [x, y] = ndc(x as f64 + dx, y as f64 + dy);
                        vertices.push(Vertex { position: [x, y, 0.0, 1.0], value: at });
                    }
                    let by = uniform.map(f64::from);
                    ([x, y], Inputs { at: at.map(f64::from), by, slopes: None, error: 0.0 })
                });
                (lookups.collect(), more, vertices)
            }
            Source::Interpolated => {
                let (middle, slopes) = plane(random, texture, sampling, kind);
                let rounded = |values: [f64; 4]| values.map(|value| f64::from(value as f32));
                let (middle, slopes) = (rounded(middle), slopes.map(rounded));
                for (numbers, values) in more.iter_mut().zip([middle, slopes[0], slopes[1]]) {
                    *numbers = values.map(|value| value as f32);
                }
                let most = |values: [f64; 4]| values.into_iter().map(f64::abs).fold(0.0, f64::max);
                // A varying is followed from the surface's corner.
                let steep = most(slopes[0]) + most(slopes[1]);
                let error =
                    (most(middle) + 32.0 * steep) * f64::from(-22).exp2() + 512.0 * steep * f64::from(-23).exp2();
                let lookups = places.map(|[x, y]| {
                    let [dx, dy] = [x as f64 + 0.5 - left - half[0], y as f64 + 0.5 - low - half[1]];
                    let at = [0, 1, 2, 3].map(|part| middle[part] + slopes[0][part] * dx + slopes[1][part] * dy);
                    ([x, y], Inputs { at, by: uniform.map(f64::from), slopes: Some(slopes), error })
                });
                (lookups.collect(), more, vertices.to_vec())
            }
        }
    }
}

impl Kind {
    /// Tests whether a texture is one for this look-up.
    pub fn reads(self, texture: &Texture) -> bool {
        self.shape == texture.shape && self.takes(texture.format)
    }

    /// Tests whether the look-up is one of a format's.
    pub fn takes(self, format: &Format) -> bool {
        match self.class {
            Class::Uint => format.numbers == Numbers::Uint,
            Class::Int => format.numbers == Numbers::Int,
            Class::Shadow => format.is_depth(),
            Class::Float => !format.is_integer(),
        }
    }
}

/// Changes numbers that a driver need not compile for.
fn nudge(random: &mut Random, sampling: &mut Sampling) {
    if chance(random, 0.5) {
        sampling.border[below(random, 4)] = random.between(-0.5, 1.5);
    }
    if sampling.lod[0] > -900.0 && chance(random, 0.5) {
        sampling.lod[0] = (random.between(0.125, 3.0) * 8.0).round() / 8.0;
    }
    if sampling.lod[1] < 900.0 && chance(random, 0.5) {
        sampling.lod[1] = (random.between(0.125, 6.0) * 8.0).round() / 8.0;
    }
    sampling.lod[1] = sampling.lod[1].max(sampling.lod[0]);
    if sampling.bias != 0.0 && chance(random, 0.5) {
        sampling.bias = (random.between(0.1, 2.5) * 8.0).round() / 8.0;
    }
}

/// Changes one parameter.
fn mutate(random: &mut Random, sampling: &mut Sampling) {
    const WRAPS: [GlWrap; 4] = [GlWrap::Repeat, GlWrap::MirroredRepeat, GlWrap::ClampToEdge, GlWrap::ClampToBorder];
    match below(random, 10) {
        0 => sampling.linear = !sampling.linear,
        1 => sampling.magnified = Some(chance(random, 0.5)),
        2 => sampling.mipmap = pick(random, &[GlMipmap::Off, GlMipmap::Nearest, GlMipmap::Linear]),
        3 | 4 => sampling.wrap[below(random, 3)] = pick(random, &WRAPS),
        5 => {
            let part = below(random, 4);
            if chance(random, 0.5) {
                sampling.border[part] = random.between(-0.5, 1.5);
            } else {
                sampling.border = [(); 4].map(|()| random.unit());
            }
        }
        6 => sampling.compare = Some(pick(random, &GlCompare::ALL)),
        7 => {
            sampling.lod[0] =
                if chance(random, 0.5) { -1000.0 } else { (random.between(-2.0, 3.0) * 8.0).round() / 8.0 }
        }
        8 => {
            sampling.lod[1] = if chance(random, 0.5) { 1000.0 } else { (random.between(0.0, 6.0) * 8.0).round() / 8.0 }
        }
        _ => sampling.bias = if chance(random, 0.4) { 0.0 } else { (random.between(-2.5, 2.5) * 8.0).round() / 8.0 },
    }
    sampling.lod[1] = sampling.lod[1].max(sampling.lod[0]);
}

/// Makes parameters such that the result is defined.
fn fit(
    random: &mut Random,
    (sampling, own): (&mut Sampling, &mut Sampling),
    texture: &Texture,
    kind: Kind,
    seamless: bool,
) {
    let integer = texture.format.is_integer();
    if kind.shape == Shape::Rectangle {
        for wrap in &mut sampling.wrap {
            if matches!(wrap, GlWrap::Repeat | GlWrap::MirroredRepeat) {
                *wrap = pick(random, &[GlWrap::ClampToEdge, GlWrap::ClampToBorder]);
            }
        }
        sampling.mipmap = GlMipmap::Off;
        // Mesa's llvmpipe takes a derivative for one of normalised coordinates, and minifies too early: left out.
        sampling.magnified = Some(sampling.linear);
    }
    if integer {
        sampling.linear = false;
        sampling.magnified = Some(false);
        // Mesa's llvmpipe takes the levels of integers by NEAREST as it does by NEAREST_MIPMAP_NEAREST: this is left out.
        if sampling.mipmap != GlMipmap::Nearest && kind.shape != Shape::Rectangle {
            sampling.mipmap = GlMipmap::Nearest;
        }
        for wrap in &mut sampling.wrap {
            if *wrap == GlWrap::ClampToBorder {
                *wrap = GlWrap::ClampToEdge;
            }
        }
    }
    // Mesa's llvmpipe takes all wrap modes of a cube map for CLAMP_TO_EDGE, also without seamless filters: left out.
    if kind.shape == Shape::Cube && !seamless {
        sampling.wrap = [GlWrap::ClampToEdge; 3];
    }
    sampling.compare = match kind.class {
        Class::Shadow => sampling.compare.or(Some(pick(random, &GlCompare::ALL))),
        _ if texture.format.is_depth() => None,
        _ => sampling.compare,
    };
    // Without derivatives there is one filter of one level.
    if kind.source == Source::Fetched && kind.is_implicit() {
        sampling.magnified = Some(sampling.linear);
        if integer {
            own.levels = own.levels.map(|[base, _]| [base, base]);
        } else {
            sampling.mipmap = GlMipmap::Off;
        }
    }
}

/// Numbers beside the coordinates: a level, a bias, gradients.
fn by(random: &mut Random, texture: &Texture, sampling: &Sampling, kind: Kind) -> [f32; 4] {
    let levels = texture.levels.len() as f32;
    match kind.function {
        Function::Size => {
            let [base, most] = sampling.levels.unwrap_or([0, 1000]).map(|level| level as usize);
            [below(random, most.min(texture.levels.len() - 1) - base + 1) as f32; 4]
        }
        Function::Grad => {
            let size = texture.levels[0].size[0].max(texture.levels[0].size[1]) as f32;
            let texels = random.between(-2.0, levels + 1.0).exp2();
            let unit = if kind.shape == Shape::Rectangle { 1.0 } else { size };
            let mut slope = || random.between(-1.0, 1.0) * texels / unit;
            [slope(), slope(), slope(), slope()]
        }
        _ if chance(random, 0.3) => [random.between(-1.0, levels + 1.0).round(); 4],
        _ => [random.between(-2.0, levels + 1.0); 4],
    }
}

/// A reference near to some texel's depth, or anywhere.
fn reference(random: &mut Random, texture: &Texture) -> f32 {
    if !texture.format.is_depth() {
        return random.unit();
    }
    let texels = &texture.levels[0].texels;
    let depth = texels[below(random, texels.len())][0];
    let step = pick(random, &[-20.0_f64, -18.0, -17.0, -15.0, -13.0, -11.0, -9.0, -6.0]).exp2() * 1.5;
    match below(random, 12) {
        0 => random.between(-3.0, 4.0),
        1 => random.unit() * 100.0,
        2 => pick(random, &[0.0, 1.0, 0.5, -0.0]),
        3..=5 => random.unit(),
        6 => depth as f32,
        7..=9 => (depth + step) as f32,
        _ => (depth - step) as f32,
    }
}

/// A coordinate along one axis of so many texels, in parts of the axis.
fn coordinate(random: &mut Random, texels: usize) -> f32 {
    let size = texels as f32;
    let texel = below(random, texels) as f32;
    match below(random, 16) {
        0..=5 => random.unit(),
        6..=7 => random.between(-0.6, 1.6),
        8..=9 => (texel + 0.5) / size,
        10 => (texel + pick(random, &[0.03125, 0.96875])) / size,
        11 => pick(random, &[0.0, 1.0, -0.0]) + pick(random, &[-0.25, 0.25, 0.5, -0.5, 1.5]) / size,
        12 => random.between(-8.0, 8.0),
        13 => (random.between(-100.0, 100.0).floor() * size + texel + 0.5) / size,
        14 => random.between(-2000.0, 2000.0).floor() + (texel + 0.25) / size,
        _ => random.between(-1e4, 1e4),
    }
}

/// A direction: any, near an edge or a corner of the cube, along an axis; of any length.
fn direction(random: &mut Random) -> [f32; 3] {
    let mut at = [(); 3].map(|()| random.between(-1.0, 1.0));
    match below(random, 6) {
        0 => {
            let [first, second] = [below(random, 3), below(random, 3)];
            at[first] = at[second] * pick(random, &[1.0, -1.0, 1.0 - 1.0 / 64.0, 1.0 / 64.0 - 1.0]);
        }
        1 => at = at.map(|part| if part < 0.0 { -1.0 - part / 64.0 } else { 1.0 - part / 64.0 }),
        2 => {
            at = [0.0; 3];
            at[below(random, 3)] = pick(random, &[1.0, -1.0]);
        }
        _ => {}
    }
    let length = if chance(random, 0.6) { 1.0 } else { random.between(-16.0, 16.0).exp2() };
    let most = at.into_iter().map(f32::abs).fold(0.0, f32::max);
    if most < 1e-3 { [length, 0.0, 0.0] } else { at.map(|part| part * length) }
}

/// Coordinates of one look-up.
fn place(random: &mut Random, texture: &Texture, sampling: &Sampling, kind: Kind) -> [f32; 4] {
    let [base, most] = sampling.levels.unwrap_or([0, 1000]);
    let last = (most as usize).min(texture.levels.len() - 1);
    let level = base as usize + below(random, last - base as usize + 1);
    let size = texture.levels[level].size;
    if matches!(kind.function, Function::Fetch | Function::FetchOffset | Function::Size) {
        let axes = kind.shape.axes();
        let moved = |axis: usize| {
            if kind.function == Function::FetchOffset && axis < axes { OFFSET[axis] as f32 } else { 0.0 }
        };
        // With an offset that leads back into the texture.
        let at = [0, 1, 2].map(|axis| below(random, size[axis]) as f32 - moved(axis));
        return [at[0], at[1], at[2], (level - base as usize) as f32];
    }
    let layer = |random: &mut Random, layers: usize| match below(random, 6) {
        0 => random.between(-4.0, layers as f32 + 4.0).round() + 0.25,
        _ => below(random, layers) as f32 + random.between(-0.4, 0.4),
    };
    let reference = reference(random, texture);
    let unit = |at: f32, axis: usize| if kind.shape == Shape::Rectangle { at * size[axis] as f32 } else { at };
    let mut at = match kind.shape {
        Shape::Cube => direction(random),
        Shape::Array => [coordinate(random, size[0]), coordinate(random, size[1]), layer(random, size[2])],
        _ => [0, 1, 2].map(|axis| unit(coordinate(random, size[axis]), axis)),
    };
    if !kind.is_projective() {
        return [at[0], at[1], at[2], reference];
    }
    let q = match below(random, 8) {
        0 => random.between(-8.0, 8.0).exp2(),
        1 => -random.between(-8.0, 8.0).exp2(),
        2 => random.between(-20.0, 12.0).exp2(),
        3 => random.between(0.5, 5000.0),
        _ => random.between(0.25, 4.0) * pick(random, &[1.0, 1.0, -1.0]),
    };
    if kind.class == Class::Shadow {
        at[2] = reference;
    }
    [at[0] * q, at[1] * q, at[2] * q, q]
}

/// Coordinates at the middle of a cell, and their derivatives.
fn plane(random: &mut Random, texture: &Texture, sampling: &Sampling, kind: Kind) -> ([f64; 4], [[f64; 4]; 2]) {
    let base = sampling.levels.map_or(0, |[base, _]| base) as usize;
    let size = texture.levels[base.min(texture.levels.len() - 1)].size;
    let levels = texture.levels.len() as f32;
    // Texels a pixel: magnified, minified, or longer one way than the other.
    let texels = f64::from(random.between(-2.5, levels + 0.5).exp2());
    let mut middle = place(random, texture, sampling, kind).map(f64::from);
    let mut slopes = [[0.0; 4]; 2];
    let narrow = if chance(random, 0.3) { f64::from(random.between(0.05, 0.5)) } else { 1.0 };
    let turn = if chance(random, 0.4) { 0.0 } else { f64::from(random.between(0.0, 6.3)) };
    let (sin, cos) = turn.sin_cos();
    let directions = [[cos, sin, 0.3 * sin], [-sin * narrow, cos * narrow, 0.3 * cos]];
    let divisor = if kind.is_projective() { middle[3] } else { 1.0 };
    if kind.shape == Shape::Cube {
        // Within the plane of a face: s and t are linear. A look-up stays on the face where the slope is small.
        let face = below(random, 6);
        let (major, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
        let texels = texels.min(size[0] as f64 / 48.0);
        let length = f64::from(random.between(-3.0, 3.0).exp2());
        let reach = 2.0 * texels / size[0] as f64;
        let spare = (0.98 - reach * 21.0).max(0.0);
        let mut axis_of = 0;
        for axis in 0..3 {
            if axis == major {
                middle[axis] = sign * length;
                continue;
            }
            middle[axis] = f64::from(random.between(-1.0, 1.0)) * spare * length;
            for (slope, direction) in slopes.iter_mut().zip(directions) {
                slope[axis] = direction[axis_of] * reach * length;
            }
            axis_of += 1;
        }
        return (middle, slopes);
    }
    for axis in 0..kind.shape.axes() {
        let unit = if kind.shape == Shape::Rectangle { 1.0 } else { size[axis] as f64 };
        for (slope, direction) in slopes.iter_mut().zip(directions) {
            slope[axis] = direction[axis] * texels / unit * divisor;
        }
        // Not too far away for a float that is followed across the surface.
        middle[axis] = (middle[axis] / divisor % 64.0) * divisor;
    }
    (middle, slopes)
}
