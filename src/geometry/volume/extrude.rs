//! Extrusion of an outline: sides, and caps at both ends [GDC, "Handling the "Trivial" None Near Clip Plane Capping Case"].
//! In the caster's model space, as homogeneous positions: the far end lies at w = 0, where no finite distance can be too
//! small.

use std::ops::Range;

use glam::DVec3;

use super::{Caster, LightSource, Outline};

/// End of a volume.
///
/// A rasterizer in f32 finds a depth from a triangle's slopes, whose rounding grows with the square of the triangle's
/// length over its width: the sides of a dense mesh, narrower than a pixel, are off by a thousand times the depth buffer's
/// error if they run to infinity, and not if they end soon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// At infinity: far vertices are (position - light, 0), scaled by a power of two. For a directional light they are one
    /// vertex, sides are triangles and there is no far cap.
    Infinite,
    /// At a finite distance [GDC, "More Implications of Carmack's Reverse"]: each vertex moved by this distance, in model
    /// units, along its own ray. Wrong by design where a shadow reaches farther.
    Truncated(f64),
    /// At the plane `normal · x = distance`, each vertex along its own ray; one that is beyond stays. For all points before
    /// the plane, seen from before it, the sides are those of the infinite volume. `normal` in model space, of any length,
    /// at less than a right angle to every ray.
    ToPlane { normal: DVec3, distance: f64 },
}

/// Caps that are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Caps {
    pub light: bool,
    pub far: bool,
}

impl Caps {
    pub const BOTH: Self = Self { light: true, far: true };
    pub const NONE: Self = Self { light: false, far: false };
}

/// A shadow volume's triangles; its buffers are kept from one extrusion to the next.
///
/// Triangles run counter-clockwise seen from outside the volume (in model space), except the range
/// [`Volume::light_cap_reversed`]. A point's count is the number of back faces less the number of front faces at or
/// behind it (z-fail with LESS), or the number of front faces less back faces before it (z-pass).
#[derive(Clone, Debug, Default)]
pub struct Volume {
    vertices: Vec<[f32; 4]>,
    indices: Vec<u32>,
    sides: Range<u32>,
    light_cap: Range<u32>,
    light_cap_reversed: Range<u32>,
    far_cap: Range<u32>,
    near_slots: Slots,
    far_slots: Slots,
}

impl Volume {
    /// Model space. Those with w = 1 are the mesh's own positions, bit for bit (0 = -0).
    pub fn vertices(&self) -> &[[f32; 4]] {
        &self.vertices
    }

    /// Three a triangle, into [`Volume::vertices`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Range of [`Volume::indices`] with the sides, from the outline to the far end; an edge of multiplicity m occurs m
    /// times.
    pub fn sides(&self) -> Range<u32> {
        self.sides.clone()
    }

    /// Counted triangles that face the light, each with its vertices in the mesh's order: drawn by the surface's own
    /// transform its depth equals the surface's to the bit.
    pub fn light_cap(&self) -> Range<u32> {
        self.light_cap.clone()
    }

    /// Counted triangles that are averted from the light, in the mesh's order too, hence wound the wrong way: seen from
    /// outside the volume they run clockwise. To be drawn with the front face reversed. Empty for closed casters.
    pub fn light_cap_reversed(&self) -> Range<u32> {
        self.light_cap_reversed.clone()
    }

    /// Copies of the counted triangles at the far end; empty for a directional light's infinite volume.
    pub fn far_cap(&self) -> Range<u32> {
        self.far_cap.clone()
    }

    /// Fills the buffers with the volume of `outline`, which was found for `caster`. Empty before the first
    /// [`Outline::find`].
    pub fn extrude(&mut self, caster: &Caster, outline: &Outline, extent: Extent, caps: Caps) {
        self.clear(caster);
        let Some(source) = outline.source() else { return };
        let end = End { source, extent };
        for edge in outline.edges() {
            let [from, to] = [edge.from, edge.to].map(|place| self.near(caster, place));
            let [far_from, far_to] = [edge.from, edge.to].map(|place| self.far(caster, place, &end));
            for _ in 0..edge.multiplicity {
                self.indices.extend([to, from, far_from]);
                if far_from != far_to {
                    self.indices.extend([to, far_from, far_to]);
                }
            }
        }
        self.sides = 0..self.index_count();
        if caps.light {
            self.light_cap = self.add_light_cap(caster, outline, 1);
            self.light_cap_reversed = self.add_light_cap(caster, outline, -1);
        }
        if caps.far && !end.is_one_point() {
            self.far_cap = self.add_far_cap(caster, outline, &end);
        }
    }

    fn clear(&mut self, caster: &Caster) {
        self.vertices.clear();
        self.indices.clear();
        self.near_slots.clear(caster.positions.len());
        self.far_slots.clear(caster.positions.len());
        for range in [&mut self.sides, &mut self.light_cap, &mut self.light_cap_reversed, &mut self.far_cap] {
            *range = 0..0;
        }
    }

    fn index_count(&self) -> u32 {
        self.indices.len() as u32
    }

    fn add_light_cap(&mut self, caster: &Caster, outline: &Outline, weight: i8) -> Range<u32> {
        let start = self.index_count();
        for (triangle, own) in caster.triangles.iter().zip(outline.weights()) {
            if *own == weight {
                let corners = triangle.map(|place| self.near(caster, place));
                self.indices.extend(corners);
            }
        }
        start..self.index_count()
    }

    fn add_far_cap(&mut self, caster: &Caster, outline: &Outline, end: &End) -> Range<u32> {
        let start = self.index_count();
        for (places @ [a, b, c], weight) in caster.triangles.iter().zip(outline.weights()) {
            let corners = match weight {
                0 => continue,
                1.. => [*a, *c, *b],
                _ => [*a, *b, *c],
            };
            let [a, b, c] = corners.map(|place| self.far(caster, place, end));
            match end.middle_of_half_sky(places.map(|place| caster.position(place))) {
                None => self.indices.extend([a, b, c]),
                Some(normal) => {
                    let middle = self.vertices.len() as u32;
                    self.vertices.push(at_infinity(if *weight > 0 { -normal } else { normal }));
                    self.indices.extend([a, b, middle, b, c, middle, c, a, middle]);
                }
            }
        }
        start..self.index_count()
    }

    fn near(&mut self, caster: &Caster, place: u32) -> u32 {
        let [x, y, z] = caster.positions[place as usize];
        self.near_slots.get_or_push(place, &mut self.vertices, || [x, y, z, 1.0])
    }

    fn far(&mut self, caster: &Caster, place: u32, end: &End) -> u32 {
        // One vertex serves all sides if they end in one point.
        let slot = if end.is_one_point() { 0 } else { place };
        self.far_slots.get_or_push(slot, &mut self.vertices, || end.of(caster.position(place)))
    }
}

/// The far end of a volume.
struct End {
    source: LightSource,
    extent: Extent,
}

impl End {
    fn is_one_point(&self) -> bool {
        self.extent == Extent::Infinite && self.source.is_parallel()
    }

    fn middle_of_half_sky(&self, corners: [DVec3; 3]) -> Option<DVec3> {
        if self.extent == Extent::Infinite { normal_if_touched(self.source, corners) } else { None }
    }

    fn of(&self, position: DVec3) -> [f32; 4] {
        let away = self.source.away(position);
        match self.extent {
            Extent::Infinite => at_infinity(away),
            Extent::Truncated(distance) => {
                let end = position + distance * away.normalize_or_zero();
                end.as_vec3().extend(1.0).to_array()
            }
            Extent::ToPlane { normal, distance } => {
                let way = ((distance - normal.dot(position)) / normal.dot(away)).max(0.0);
                (position + way * away).as_vec3().extend(1.0).to_array()
            }
        }
    }
}

/// The normal of a triangle that the light all but touches. At infinity that triangle covers half the sky, and its corners
/// lie almost on a great circle: rounding may turn it into the other half. A corner in its middle prevents that.
fn normal_if_touched(source: LightSource, corners: [DVec3; 3]) -> Option<DVec3> {
    const TOUCHES: f64 = 1.0 / (1 << 10) as f64;
    if source.is_parallel() {
        return None;
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let [a, b, c] = corners.map(|corner| source.away(corner));
    let surrounds = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| p.cross(*q).dot(normal) >= 0.0);
    let height = a.dot(normal).abs() / normal.length();
    let touches = height <= TOUCHES * a.length().max(b.length()).max(c.length());
    (surrounds && touches).then_some(normal)
}

/// Tests whether the light all but touches a counted triangle of `caster`, for which `outline` was found: its shadow is
/// half the world, and a plane cuts that volume where it has no vertices to show on which side.
pub fn light_touches(caster: &Caster, outline: &Outline) -> bool {
    let Some(source) = outline.source() else { return false };
    let counted = caster.triangles.iter().zip(outline.weights()).filter(|(_, weight)| **weight != 0);
    let mut corners = counted.map(|(places, _)| places.map(|place| caster.position(place)));
    corners.any(|corners| normal_if_touched(source, corners).is_some())
}

/// The point at infinity in a direction: (direction, 0) scaled by a power of two, so that none is lost to f32's range
/// when a light stands 10⁻⁵⁰ away from a vertex, and every component keeps its bits.
pub(super) fn at_infinity(direction: DVec3) -> [f32; 4] {
    let size = direction.abs().max_element();
    let scaled = if (1e-15..1e15).contains(&size) || size == 0.0 {
        direction
    } else {
        // In two steps: the scale alone may lie outside f64's range.
        let half = (-0.5 * size.log2()).round().exp2();
        direction * half * half
    };
    scaled.as_vec3().extend(0.0).to_array()
}

/// The vertex of each place, once it has one.
#[derive(Clone, Debug, Default)]
struct Slots(Vec<u32>);

impl Slots {
    const NONE: u32 = u32::MAX;

    fn clear(&mut self, places: usize) {
        self.0.clear();
        self.0.resize(places, Self::NONE);
    }

    fn get_or_push(&mut self, place: u32, vertices: &mut Vec<[f32; 4]>, make: impl FnOnce() -> [f32; 4]) -> u32 {
        let slot = &mut self.0[place as usize];
        if *slot == Self::NONE {
            *slot = vertices.len() as u32;
            vertices.push(make());
        }
        *slot
    }
}
