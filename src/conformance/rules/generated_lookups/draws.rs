//! Draws of look-ups: a program and a texture that go together, parameters of which a few change, coordinates of every kind.

use super::coordinates::{by, place, plane};
use super::formats::{Numbers, TexelFormat};
use super::lookups::{Class, Inputs, LookUp, LookUpKind, Source};
use super::model::Texture;
use super::parameters::{fit, mutate, nudge};
use super::programs::{LookUpProgram, MAPS, ROWS};
use super::world::{TEXTURES, UNITS, World};
use crate::conformance::bench::{GlTextureStep, Sampling, Vertex, rectangle};

/// Pixels of the surface, and of a draw's cell.
pub const COLUMNS: usize = 256;
pub const CELL: [usize; 2] = [32, 8];
pub const CELLS: usize = COLUMNS / CELL[0] * (ROWS / CELL[1]);

/// A draw, with all that its model needs.
pub struct Drawn {
    pub kind: LookUpKind,
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
    /// Draws by each of the programs; textures are made as they are needed, and so often anew as `fresh` says; `uniforms` has
    /// the units of their samplers; `step` leaves programs out.
    /// A program draws a few times, with little set anew in between.
    pub fn chunk(&mut self, programs: &[LookUpProgram], uniforms: &mut [[usize; 4]], fresh: f32, step: usize) -> Chunk {
        let mut chunk = Chunk { drawn: Vec::new(), inputs: vec![[0.0; 4]; 2 * ROWS * COLUMNS], cells: 0 };
        for number in (0..programs.len()).step_by(step) {
            if self.random.chance(0.3) {
                self.edit();
            }
            if self.random.chance(0.2) {
                self.seamless = !self.seamless;
                self.steps.push(GlTextureStep::Seamless(self.seamless));
            }
            let uses = self.uses(&programs[number].kinds, &uniforms[number], fresh);
            for turn in 0..self.random.pick(&[1, 2, 2, 3]) {
                if chunk.cells == CELLS {
                    return chunk;
                }
                self.draw((number, &programs[number].kinds), &uses, &mut uniforms[number], turn > 0, &mut chunk);
            }
        }
        chunk
    }

    /// A texture and a unit for each look-up, all of them different.
    fn uses(&mut self, kinds: &[LookUpKind], uniforms: &[usize; 4], fresh: f32) -> Vec<Use> {
        let mut uses: Vec<Use> = Vec::new();
        for (kind, now) in kinds.iter().zip(uniforms) {
            let fits = |world: &Self, slot: usize| {
                let is_free = uses.iter().all(|used| used.slot != slot);
                is_free && world.textures[slot].as_ref().is_some_and(|texture| kind.reads(texture))
            };
            let fitting: Vec<_> = (0..TEXTURES).filter(|slot| fits(self, *slot)).collect();
            let free: Vec<_> = (0..TEXTURES).filter(|slot| uses.iter().all(|used| used.slot != *slot)).collect();
            let slot = if fitting.is_empty() || self.random.chance(fresh) {
                let slot = self.random.pick(&free);
                self.make_for(slot, *kind);
                slot
            } else {
                self.random.pick(&fitting)
            };
            let shape = kind.shape as usize;
            let bound = (0..UNITS).find(|unit| self.bindings[*unit][shape] == Some(slot));
            let wanted = match (bound, self.random.below(3)) {
                (Some(unit), 0) => unit,
                (_, 1) => *now,
                _ => self.random.below(UNITS),
            };
            let is_free = |unit: usize| uses.iter().all(|used| used.unit != unit);
            let unit = (wanted..UNITS).chain(0..wanted).find(|unit| is_free(*unit)).unwrap_or(0);
            uses.push(Use { slot, unit });
        }
        uses
    }

    fn draw(
        &mut self,
        (program, kinds): (usize, &[LookUpKind]),
        uses: &[Use],
        uniforms: &mut [usize; 4],
        again: bool,
        chunk: &mut Chunk,
    ) {
        let corner = [chunk.cells % (COLUMNS / CELL[0]) * CELL[0], chunk.cells / (COLUMNS / CELL[0]) * CELL[1]];
        let mut samplings = Vec::new();
        let mut objects = Vec::new();
        for (index, (kind, used)) in kinds.iter().zip(uses).enumerate() {
            if again && self.random.chance(0.3) {
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
    fn prepare(&mut self, kind: LookUpKind, Use { slot, unit }: Use, again: bool, taken: &[usize]) -> Sampling {
        let mut active = false;
        if self.bindings[unit][kind.shape as usize] != Some(slot) {
            self.bind(unit, slot);
            active = true;
        }
        let is_taken = self.units[unit].is_some_and(|object| taken.contains(&object));
        if is_taken || !again && self.random.chance(0.3) {
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
            for _ in 0..self.random.pick(&[3, 8, 16]) {
                mutate(&mut self.random, &mut holder);
            }
        }
        let mut own = own;
        fit(&mut self.random, (&mut holder, &mut own), &texture, kind, (self.seamless, again));
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
        kind: LookUpKind,
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
                    let is_one = kind.function == LookUp::Size;
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

impl LookUpKind {
    /// Tests whether a texture is one for this look-up.
    pub fn reads(self, texture: &Texture) -> bool {
        self.shape == texture.shape && self.takes(texture.format)
    }

    /// Tests whether the look-up is one of a format's.
    pub fn takes(self, format: &TexelFormat) -> bool {
        match self.class {
            Class::Uint => format.numbers == Numbers::Uint,
            Class::Int => format.numbers == Numbers::Int,
            Class::Shadow => format.is_depth(),
            Class::Float => !format.is_integer(),
        }
    }
}
