//! A skin's picture in its new places.
//!
//! A texel of the new picture whose centre lies in a triangle has the old picture's colour there, with bilinear
//! filtering. Thin triangles may hold no centre: a texel that one touches has the colour at the triangle's nearest
//! point, unless a texel beside it has a centre in the same piece. The gutter around each island repeats the nearest of
//! those texels, so that filters and the first mipmaps find no foreign colour. All other texels have the mean colour.

use glam::{DVec2, dvec2};

use super::{Error, Raster, Repacked, Skin};

/// Most texels a side of a picture, as textures have.
const LIMIT: u32 = 16384;

/// Distance in texels from a texel's centre within which every triangle that touches the texel lies: half its diagonal, and
/// a little.
const TOUCH: f64 = 0.72;

/// Marks a texel without a colour.
const FREE: u32 = u32::MAX;

impl Repacked {
    /// Width and height of a map in the new skin: in proportion, where the map has more or fewer texels than the old skin.
    ///
    /// # Errors
    ///
    /// More texels than a picture may have.
    pub fn map_size(&self, old: &Skin, map: [u32; 2]) -> Result<[u32; 2], Error> {
        let mut size = [0; 2];
        for axis in 0..2 {
            let exact = f64::from(self.skin.size[axis]) * f64::from(map[axis]) / f64::from(old.size[axis]);
            if exact > f64::from(LIMIT) {
                return Err(Error::MapTooLarge { from: map[axis], to: exact.ceil() as u64, limit: LIMIT });
            }
            size[axis] = exact.round().max(1.0) as u32;
        }
        Ok(size)
    }

    /// A map of the skin `old` for the new one.
    ///
    /// # Errors
    ///
    /// More texels than a picture may have.
    pub fn resample(&self, old: &Skin, map: &Raster) -> Result<Raster, Error> {
        let size = self.map_size(old, map.size)?;
        let mut painter =
            Painter { old: map, new: map.black(size), owners: vec![FREE; size[0] as usize * size[1] as usize] };
        let old_scale = DVec2::from_array([0, 1].map(|axis| f64::from(map.size[axis]) / f64::from(old.size[axis])));
        let new_scale = DVec2::from_array([0, 1].map(|axis| f64::from(size[axis]) / f64::from(self.skin.size[axis])));
        let triangles = old.triangles.iter().zip(&self.skin.triangles).zip(&self.piece_of_triangle);
        let triangles: Vec<Patch> = triangles
            .map(|((old, new), piece)| Patch {
                old: old.texels.map(|texel| old_scale * texel),
                new: new.texels.map(|texel| new_scale * texel),
                piece: *piece as u32,
            })
            .collect();
        triangles.iter().for_each(|patch| painter.paint_centres(patch));
        let covered = painter.owners.clone();
        triangles.iter().for_each(|patch| painter.paint_touched(patch, &covered));
        let gutter = f64::from(self.gutter) * new_scale.max_element();
        painter.extend(gutter.ceil() as u32);
        painter.fill();
        Ok(painter.new)
    }
}

/// A triangle in texels of both pictures.
struct Patch {
    old: [DVec2; 3],
    new: [DVec2; 3],
    piece: u32,
}

struct Painter<'a> {
    old: &'a Raster,
    new: Raster,
    /// The piece whose colour a texel has.
    owners: Vec<u32>,
}

impl Painter<'_> {
    fn index(&self, [x, y]: [u32; 2]) -> usize {
        y as usize * self.new.size[0] as usize + x as usize
    }

    /// Texels whose centres are at most `reach` from the triangle's bounds.
    fn near(&self, patch: &Patch, reach: f64) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [a, b, c] = patch.new;
        let (low, high) = (a.min(b).min(c) - reach - 0.5, a.max(b).max(c) + reach - 0.5);
        let range = |axis: usize| {
            let end = f64::from(self.new.size[axis]);
            low[axis].ceil().clamp(0.0, end) as u32..(high[axis].floor() + 1.0).clamp(0.0, end) as u32
        };
        let columns = range(0);
        range(1).flat_map(move |y| columns.clone().map(move |x| [x, y]))
    }

    /// Colours the texels whose centres are in the triangle.
    fn paint_centres(&mut self, patch: &Patch) {
        for texel in self.near(patch, 0.0) {
            let index = self.index(texel);
            if self.owners[index] == FREE
                && let Some(weights) = weights_inside(&patch.new, centre(texel))
            {
                self.set(index, patch, weights);
            }
        }
    }

    /// Colours the texels that the triangle touches, unless they or texels beside them have a centre in the piece.
    fn paint_touched(&mut self, patch: &Patch, covered: &[u32]) {
        for texel in self.near(patch, TOUCH) {
            let index = self.index(texel);
            if self.owners[index] != FREE || self.around(texel).any(|index| covered[index] == patch.piece) {
                continue;
            }
            let (weights, place) = nearest(&patch.new, centre(texel));
            if place.distance(centre(texel)) <= TOUCH {
                self.set(index, patch, weights);
            }
        }
    }

    /// Indices of the texels beside and at the corners of one, those beside it first.
    fn around(&self, [x, y]: [u32; 2]) -> impl Iterator<Item = usize> + use<> {
        const STEPS: [[i64; 2]; 8] = [[0, -1], [-1, 0], [1, 0], [0, 1], [-1, -1], [1, -1], [-1, 1], [1, 1]];
        let [width, height] = self.new.size.map(i64::from);
        let places = STEPS.into_iter().map(move |[right, down]| [i64::from(x) + right, i64::from(y) + down]);
        let inside = move |[x, y]: &[i64; 2]| (0..width).contains(x) && (0..height).contains(y);
        places.filter(inside).map(move |[x, y]| (y * width + x) as usize)
    }

    fn set(&mut self, index: usize, patch: &Patch, weights: [f64; 3]) {
        let place = (0..3).map(|corner| weights[corner] * patch.old[corner]).sum();
        let channels = self.new.channels;
        let target = &mut self.new.samples[channels * index..channels * (index + 1)];
        sample(self.old, &patch.old, place, target);
        self.owners[index] = patch.piece;
    }

    /// Gives texels around coloured ones the colour of the nearest, ring by ring.
    fn extend(&mut self, rings: u32) {
        let width = self.new.size[0] as usize;
        let texel = |index: usize| [(index % width) as u32, (index / width) as u32];
        let is_free = |index: usize| self.owners[index] == FREE;
        let at_rim = |index: &usize| !is_free(*index) && self.around(texel(*index)).any(is_free);
        let mut ring: Vec<usize> = (0..self.owners.len()).filter(at_rim).collect();
        for _ in 0..rings {
            let mut next = Vec::new();
            for index in ring {
                for beside in self.around(texel(index)) {
                    if self.owners[beside] == FREE {
                        self.owners[beside] = self.owners[index];
                        let (from, channels) = (self.new.channels * index, self.new.channels);
                        self.new.samples.copy_within(from..from + channels, channels * beside);
                        next.push(beside);
                    }
                }
            }
            ring = next;
        }
    }

    /// Gives the other texels the mean of those that have a colour.
    fn fill(&mut self) {
        let channels = self.new.channels;
        let mut sums = vec![0.0; channels];
        let mut count = 0.0_f64;
        let texels = self.new.samples.chunks_exact(channels).zip(&self.owners);
        for (texel, _) in texels.filter(|(_, owner)| **owner != FREE) {
            count += 1.0;
            sums.iter_mut().zip(texel).for_each(|(sum, code)| *sum += f64::from(*code));
        }
        let mean: Vec<u16> = sums.iter().map(|sum| (sum / count.max(1.0)).round() as u16).collect();
        let texels = self.new.samples.chunks_exact_mut(channels).zip(&self.owners);
        texels.filter(|(_, owner)| **owner == FREE).for_each(|(texel, _)| texel.copy_from_slice(&mean));
    }
}

fn centre([x, y]: [u32; 2]) -> DVec2 {
    dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// Barycentric coordinates of a point in a triangle or on its rim. `None`: it is outside, or there is no inside.
fn weights_inside(triangle: &[DVec2; 3], point: DVec2) -> Option<[f64; 3]> {
    let [a, b, c] = *triangle;
    let area = (b - a).perp_dot(c - a);
    let parts = [(c - b).perp_dot(point - b), (a - c).perp_dot(point - c), (b - a).perp_dot(point - a)];
    let weights = parts.map(|part| part / area);
    (area != 0.0 && weights.iter().all(|weight| *weight >= -1e-9)).then_some(weights)
}

/// The nearest point of a triangle, and its barycentric coordinates.
fn nearest(triangle: &[DVec2; 3], point: DVec2) -> ([f64; 3], DVec2) {
    if let Some(weights) = weights_inside(triangle, point) {
        return (weights, point);
    }
    let mut best = ([1.0, 0.0, 0.0], triangle[0]);
    for [from, to] in [[0, 1], [1, 2], [2, 0]] {
        let (a, b) = (triangle[from], triangle[to]);
        let along = b - a;
        let share =
            if along == DVec2::ZERO { 0.0 } else { (along.dot(point - a) / along.length_squared()).clamp(0.0, 1.0) };
        let place = a + share * along;
        if place.distance_squared(point) < best.1.distance_squared(point) {
            let mut weights = [0.0; 3];
            (weights[from], weights[to]) = (1.0 - share, share);
            best = (weights, place);
        }
    }
    best
}

/// The picture's codes at a place, with bilinear filtering. It repeats beyond its rim; but where the triangle lies in one
/// repetition, the texels at the rim go on.
fn sample(picture: &Raster, triangle: &[DVec2; 3], place: DVec2, target: &mut [u16]) {
    let size = DVec2::from_array(picture.size.map(f64::from));
    let tile = (triangle.iter().copied().sum::<DVec2>() / (3.0 * size)).floor();
    let is_within = triangle.iter().all(|corner| {
        let within = *corner / size - tile;
        within.min_element() >= -1e-9 && within.max_element() <= 1.0 + 1e-9
    });
    let at = place - tile * size - 0.5;
    let low = at.floor();
    let share = at - low;
    let wrap = |value: f64, axis: usize| {
        let end = size[axis];
        let inside = if is_within { value.clamp(0.0, end - 1.0) } else { value.rem_euclid(end) };
        (inside as u32).min(picture.size[axis] - 1)
    };
    let columns = [wrap(low.x, 0), wrap(low.x + 1.0, 0)];
    let rows = [wrap(low.y, 1), wrap(low.y + 1.0, 1)];
    let texels = rows.map(|y| columns.map(|x| picture.texel([x, y])));
    let mix = |a: f64, b: f64, share: f64| if share == 0.0 { a } else { a + share * (b - a) };
    for (channel, target) in target.iter_mut().enumerate() {
        let row = |row: usize| mix(f64::from(texels[row][0][channel]), f64::from(texels[row][1][channel]), share.x);
        *target = (mix(row(0), row(1), share.y) + 0.5).floor() as u16;
    }
}
