//! Draws of the model: vertices, triangles, and which fragments they have.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::fragments::{Fragment, Outputs, Targets};
use super::glsl::{LANES, Lanes, Machine, Slot};
use super::images::{Image, depth_step};
use super::lookups::{Bound, BoundTextures};
use super::shaders::Shaders;
use super::triangle::{Corner, SetUp, Triangle};
use crate::conformance::model::number::{Num, SLACK};
use crate::conformance::model::window::Covered;
use crate::geometry::Mesh;
use crate::pass::{Attribute, Batch, DepthFormat, Draw, DrawState, Face, Format, IndexOrder, Primitive, UniformValue};

/// A batch's shaders, state and textures.
pub struct DrawContext<'a> {
    shaders: &'a Shaders,
    state: DrawState,
    viewport: [u32; 2],
    textures: BoundTextures<'a>,
    vertex: Machine,
    fragment: Machine,
    /// For each input of the fragment stage, the first of its values in a corner.
    varyings: Vec<Option<usize>>,
    /// Bits of the uniforms that move vertices.
    moving: Vec<u32>,
}

/// Uniforms that decide a vertex's place or its clipping beside `clip_from_model`.
const MOVING: [&str; 4] = ["wave_reach", "wave_vector", "clip_planes", "eye_from_model"];

impl<'a> DrawContext<'a> {
    pub fn new(images: &'a [Image], shaders: &'a Shaders, state: DrawState, viewport: [u32; 2], batch: &Batch) -> Self {
        let bound = |name: &String| {
            let input = batch.inputs.iter().find(|input| input.name == *name)?;
            let image = &images[input.image.0];
            Some(Bound { image, sampler: input.sampler, is_cube: image.faces == 6, seamless: state.seamless })
        };
        let textures = BoundTextures(shaders.fragment.samplers.iter().map(bound).collect());
        let mut first = 0;
        let mut outputs = Vec::new();
        for output in &shaders.vertex.outputs {
            outputs.push((output.name.as_str(), first));
            first += output.slots.len();
        }
        let find = |name: &str| outputs.iter().find(|(known, _)| *known == name).map(|(_, first)| *first);
        let varyings = shaders.fragment.inputs.iter().map(|input| find(&input.name)).collect();
        let mut context = Self {
            shaders,
            state,
            viewport,
            textures,
            vertex: Machine::new(&shaders.vertex),
            fragment: Machine::new(&shaders.fragment),
            varyings,
            moving: Vec::new(),
        };
        batch.uniforms.iter().for_each(|uniform| context.uniform(&uniform.name, &uniform.value));
        context
    }

    fn uniform(&mut self, name: &str, value: &UniformValue) {
        let values: Vec<f32> = match value {
            UniformValue::Float(x) => vec![*x],
            UniformValue::Vec2(v) => v.to_array().to_vec(),
            UniformValue::Vec3(v) => v.to_array().to_vec(),
            UniformValue::Vec4(v) => v.to_array().to_vec(),
            UniformValue::Vec4Array(list) => list.iter().flat_map(|v| v.to_array()).collect(),
            UniformValue::Mat3(m) => m.to_cols_array().to_vec(),
            UniformValue::Mat4(m) => m.to_cols_array().to_vec(),
        };
        if MOVING.contains(&name) && (name != "eye_from_model" || self.state.clip_distances > 0) {
            self.moving.extend(values.iter().map(|value| value.to_bits()));
        }
        let Shaders { vertex, fragment } = self.shaders;
        for (shader, machine) in [(vertex, &mut self.vertex), (fragment, &mut self.fragment)] {
            if let Some(slots) = shader.uniforms.get(name) {
                machine.fill(slots, values.iter().map(|value| f64::from(*value)));
            }
        }
    }

    pub fn draw(&mut self, targets: &mut Targets, batch: &Batch, draw: &Draw) {
        self.moving.clear();
        let matrix = draw.clip_from_model.as_mat4();
        let moving: Vec<_> = batch.uniforms.iter().filter(|uniform| MOVING.contains(&uniform.name.as_ref())).collect();
        moving.into_iter().for_each(|uniform| self.uniform(&uniform.name, &uniform.value));
        self.uniform("clip_from_model", &UniformValue::Mat4(matrix));
        draw.uniforms.iter().for_each(|uniform| self.uniform(&uniform.name, &uniform.value));
        self.moving.extend(matrix.to_cols_array().map(f32::to_bits));
        let ordered;
        let indices = match draw.order {
            IndexOrder::File => &draw.mesh.indices,
            IndexOrder::VertexCache => {
                ordered = draw.mesh.cache_ordered();
                &ordered
            }
        };
        let indices = &indices[draw.indices.start as usize..draw.indices.end as usize];
        let corners = self.corners(&draw.mesh, indices);
        let [width, height] = self.viewport.map(f64::from);
        let depth_range = self.state.depth_range.map(|end| f64::from(end.clamp(0.0, 1.0)));
        let set_up = SetUp {
            viewport: [width, height],
            depth_clamp: self.state.depth_clamp,
            depth_range,
            clip_distances: usize::from(self.state.clip_distances),
            clockwise: draw.mirrored,
        };
        if draw.primitive == Primitive::Lines {
            for line in indices.as_chunks::<2>().0 {
                let ends = line.map(|index| corners[index as usize].as_ref());
                self.line(targets, ends, &set_up);
            }
            return;
        }
        for triangle in indices.as_chunks::<3>().0 {
            let [Some(a), Some(b), Some(c)] = triangle.map(|index| corners[index as usize].as_ref()) else { continue };
            let shape = Triangle::new([a, b, c], &set_up);
            if shape.empty || shape.front.is_some_and(|front| self.culls(front)) {
                continue;
            }
            let maker = self.maker(&draw.mesh, *triangle, &set_up);
            self.triangle(targets, &shape, maker);
        }
    }

    fn culls(&self, front: bool) -> bool {
        self.state.cull.is_some_and(|face| (face == Face::Front) == front)
    }

    fn maker(&self, mesh: &Mesh, triangle: [u32; 3], set_up: &SetUp) -> u64 {
        let places = triangle.into_iter().flat_map(|index| position(mesh, index as usize).map(f32::to_bits));
        let offset = self.state.polygon_offset.map_or([0.0; 2], |offset| [offset.factor, offset.units]);
        let state = [
            u32::from(self.state.depth_clamp),
            u32::from(self.state.clip_distances),
            u32::from(set_up.clockwise),
            self.viewport[0],
            self.viewport[1],
        ];
        let range = self.state.depth_range.map(f32::to_bits);
        let parts = places.chain(self.moving.iter().copied()).chain(offset.map(f32::to_bits)).chain(state).chain(range);
        maker(parts)
    }

    /// The vertices that the indices name, as the vertex shader puts them out.
    fn corners(&mut self, mesh: &Mesh, indices: &[u32]) -> Vec<Option<Corner>> {
        let count = mesh.positions.len().max(mesh.homogeneous.len());
        let mut used = vec![false; count];
        indices.iter().for_each(|index| used[*index as usize] = true);
        let list: Vec<usize> = (0..count).filter(|index| used[*index]).collect();
        let mut corners = vec![None; count];
        for four in list.chunks(LANES) {
            self.set_attributes(mesh, four);
            let shader = &self.shaders.vertex;
            self.vertex.run(shader, &super::glsl::NoTextures);
            let get = |slot: Slot, lane: usize| self.vertex.slots[slot as usize][lane];
            for (lane, vertex) in four.iter().enumerate() {
                let clip = [0, 1, 2, 3].map(|part: usize| get(shader.position[part], lane));
                let distances = shader.clip_distances.iter().map(|slot| get(*slot, lane)).collect();
                let values = shader.outputs.iter().flat_map(|output| &output.slots);
                let values = values.map(|slot| get(*slot, lane)).collect();
                corners[*vertex] = Some(Corner { clip, distances, values });
            }
        }
        corners
    }

    fn set_attributes(&mut self, mesh: &Mesh, vertices: &[usize]) {
        for input in &self.shaders.vertex.inputs {
            let attribute = Attribute::ALL.into_iter().find(|attribute| attribute.name() == input.name);
            for lane in 0..LANES {
                let vertex = vertices[lane.min(vertices.len() - 1)];
                let value = attribute.map_or([0.0, 0.0, 0.0, 1.0], |attribute| value_of(mesh, attribute, vertex));
                for (slot, value) in input.slots.iter().zip(value) {
                    self.vertex.slots[*slot as usize][lane] = Num::exact(f64::from(value));
                }
            }
        }
    }

    fn triangle(&mut self, targets: &mut Targets, triangle: &Triangle, maker: u64) {
        let [width, height] = self.viewport;
        let offset = self.offset(triangle, targets.depth_format);
        let ends = |axis: usize, side: u32| {
            let low = triangle.bounds[0][axis].floor().max(0.0) as u32 / 2 * 2;
            let high = triangle.bounds[1][axis].ceil().clamp(0.0, f64::from(side)) as u32;
            (low, high)
        };
        let ((left, right), (bottom, top)) = (ends(0, width), ends(1, height));
        let mut y = bottom;
        while y < top {
            let mut x = left;
            while x < right {
                self.quad(targets, triangle, [x, y], maker, &offset);
                x += 2;
            }
            y += 2;
        }
    }

    /// Range of what polygon offset adds [GL 4.6, 14.6.5].
    fn offset(&self, triangle: &Triangle, format: Option<Format>) -> Num {
        let Some(offset) = self.state.polygon_offset else { return Num::exact(0.0) };
        let [along, up] = triangle.slopes();
        let slopes = [along.abs().max(up.abs()) * 0.999, along.hypot(up) * 1.001];
        let units = match format {
            // By the exponent of the polygon's greatest depth, which clipping may make any.
            Some(Format::Depth(DepthFormat::Depth32F)) => [0.0, f64::from(-23).exp2()],
            Some(Format::UnsizedDepth | Format::Depth(DepthFormat::Depth32)) => {
                [f64::from(-32).exp2(), 2.02 * depth_step(Format::UnsizedDepth)]
            }
            Some(format) => [0.99 * depth_step(format), 2.02 * depth_step(format)],
            None => [0.0; 2],
        };
        let ends = |pair: [f64; 2], by: f64| {
            let [a, b] = pair.map(|end| end * by);
            [a.min(b), a.max(b)]
        };
        let (slope, unit) = (ends(slopes, f64::from(offset.factor)), ends(units, f64::from(offset.units)));
        let [low, high] = [slope[0] + unit[0], slope[1] + unit[1]];
        Num { value: (low + high) / 2.0, error: (high - low) / 2.0 / SLACK }
    }

    fn is_inside(&self, [x, y]: [u32; 2]) -> bool {
        let inside = self.state.scissor.is_none_or(|[left, bottom, width, height]| {
            (left..left + width).contains(&x) && (bottom..bottom + height).contains(&y)
        });
        inside && x < self.viewport[0] && y < self.viewport[1]
    }

    fn quad(&mut self, targets: &mut Targets, triangle: &Triangle, [x, y]: [u32; 2], maker: u64, offset: &Num) {
        let pixels: [[u32; 2]; LANES] = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
        let places = pixels.map(|pixel| pixel.map(|at| f64::from(at) + 0.5));
        let covered: [Covered; LANES] = std::array::from_fn(|lane| match self.is_inside(pixels[lane]) {
            true => triangle.covers(places[lane]),
            false => Covered::No,
        });
        if covered == [Covered::No; LANES] {
            return;
        }
        let depths: Lanes = places.map(|at| triangle.depth(at).plus(*offset));
        let shader = &self.shaders.fragment;
        let draws_color = targets.color_format.is_some() && self.state.color_write.any();
        let needs_shader = draws_color || shader.writes_depth || shader.discards;
        let mut fragments: Vec<Fragment> = Vec::with_capacity(LANES);
        for lane in (0..LANES).filter(|lane| covered[*lane] != Covered::No) {
            let is_sure = covered[lane] == Covered::Yes && !(triangle.front.is_none() && self.state.cull.is_some());
            let fragment = Fragment {
                lane,
                pixel: pixels[lane],
                is_sure,
                front: triangle.front,
                depth: depths[lane],
                maker: if shader.writes_depth { 0 } else { maker },
            };
            if shader.writes_depth || fragment.may_change(targets, &self.state) {
                fragments.push(fragment);
            }
        }
        if fragments.is_empty() {
            return;
        }
        if needs_shader {
            self.shade(triangle, &places, &depths);
        } else {
            (self.fragment.discarded, self.fragment.unsure) = (0, 0);
        }
        for fragment in fragments {
            let is_discarded = self.fragment.discarded >> fragment.lane & 1 == 1;
            let is_open = self.fragment.unsure >> fragment.lane & 1 == 1;
            if is_discarded {
                continue;
            }
            let get = |slot: Slot| match is_open {
                true => Num::UNKNOWN,
                false => self.fragment.slots[slot as usize][fragment.lane],
            };
            let color = shader.outputs.first().map_or([Num::UNKNOWN; 4], |output| {
                std::array::from_fn(|part| output.slots.get(part).map_or(Num::UNKNOWN, |slot| get(*slot)))
            });
            let depth = if shader.writes_depth { get(shader.depth) } else { fragment.depth };
            let outputs = Outputs { color, depth };
            Fragment { is_sure: fragment.is_sure && !is_open, ..fragment }.write(targets, &self.state, &outputs);
        }
    }

    fn shade(&mut self, triangle: &Triangle, places: &[[f64; 2]; LANES], depths: &Lanes) {
        let shader = &self.shaders.fragment;
        let machine = &mut self.fragment;
        for (input, first) in shader.inputs.iter().zip(&self.varyings) {
            for (part, slot) in input.slots.iter().enumerate() {
                machine.slots[*slot as usize] = match first {
                    Some(first) => places.map(|at| triangle.interpolate(first + part, input.varies, at)),
                    None => [Num::UNKNOWN; LANES],
                };
            }
        }
        let [x, y, z, w] = [0, 1, 2, 3].map(|part: usize| shader.position[part] as usize);
        machine.slots[x] = places.map(|[x, _]| Num::exact(x));
        machine.slots[y] = places.map(|[_, y]| Num::exact(y));
        machine.slots[z] = *depths;
        machine.slots[w] = places.map(|at| triangle.over_w(at));
        machine.run(shader, &self.textures);
    }

    /// Lines cover what a driver's rule for them says: pixels near one are not known.
    fn line(&mut self, targets: &mut Targets, ends: [Option<&Corner>; 2], set_up: &SetUp) {
        let [Some(a), Some(b)] = ends else { return };
        let places = [a, b].map(|corner| {
            let [x, y, _, w] = corner.clip.map(|number| number.value);
            let place = [(x / w + 1.0) * set_up.viewport[0] / 2.0, (y / w + 1.0) * set_up.viewport[1] / 2.0];
            (w > 1e-6).then_some(place)
        });
        for y in 0..self.viewport[1] {
            for x in 0..self.viewport[0] {
                let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                let is_near = match places {
                    [Some(a), Some(b)] => distance(at, a, b) < 2.0,
                    _ => true,
                };
                if is_near && self.is_inside([x, y]) {
                    let fragment = Fragment {
                        lane: 0,
                        pixel: [x, y],
                        is_sure: false,
                        front: Some(true),
                        depth: Num::UNKNOWN,
                        maker: 0,
                    };
                    let outputs = Outputs { color: [Num::UNKNOWN; 4], depth: Num::UNKNOWN };
                    fragment.write(targets, &self.state, &outputs);
                }
            }
        }
    }
}

/// Distance of a point to a segment.
fn distance(at: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    let squared = way[0] * way[0] + way[1] * way[1];
    let along = ((at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1]) / squared.max(1e-30);
    let along = along.clamp(0.0, 1.0);
    (at[0] - a[0] - along * way[0]).hypot(at[1] - a[1] - along * way[1])
}

fn position(mesh: &Mesh, index: usize) -> [f32; 4] {
    match mesh.positions.get(index) {
        Some([x, y, z]) => [*x, *y, *z, 1.0],
        None => mesh.homogeneous[index],
    }
}

/// A vertex's attribute, its missing components as GL has them.
fn value_of(mesh: &Mesh, attribute: Attribute, index: usize) -> [f32; 4] {
    let wide = |[x, y, z]: [f32; 3]| [x, y, z, 1.0];
    let none = [0.0, 0.0, 0.0, 1.0];
    match attribute {
        Attribute::Position => position(mesh, index),
        Attribute::Normal => mesh.normals.get(index).copied().map_or(none, wide),
        Attribute::Texcoord => mesh.texcoords.as_ref().map_or(none, |list| [list[index][0], list[index][1], 0.0, 1.0]),
        Attribute::Color => mesh.colors.as_ref().map_or(none, |list| wide(list[index])),
        Attribute::Tangent => mesh.tangents.as_ref().map_or(none, |list| wide(list.tangents[index])),
        Attribute::Bitangent => mesh.tangents.as_ref().map_or(none, |list| wide(list.bitangents[index])),
    }
}

/// A number that stands for all that decides a fragment's depth.
fn maker(parts: impl Iterator<Item = u32>) -> u64 {
    let mut hasher = DefaultHasher::new();
    parts.for_each(|part| part.hash(&mut hasher));
    hasher.finish().max(1)
}
