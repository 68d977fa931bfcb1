//! Two-dimensional textures in f64: wrap modes, the border, the nearest texel and the mean of four; and which level is
//! sampled [GL 4.6, 8.14.1 to 8.14.3].

use super::{Grade, bilinear};

/// Ways to wrap, as [GL 4.6, 8.14.2] numbers texels that lie outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrapping {
    Repeat,
    Mirror,
    Edge,
    Border,
    /// GL_CLAMP of the compatibility profile: halfway to the border under LINEAR.
    Half,
}

/// Texels of a level, with what lies outside.
#[derive(Clone, Copy)]
pub struct Flat<'a> {
    pub size: [u32; 2],
    /// Rows from t = 0.
    pub texels: &'a [[f64; 4]],
    /// Wrap modes of s and of t.
    pub wrap: [Wrapping; 2],
    pub border: [f64; 4],
}

/// Slack of a position in texels, strictly and at most.
const POSITION: [f64; 2] = [1.0 / 128.0, 1.0 / 16.0];

impl Flat<'_> {
    /// A texel of any column and row.
    fn texel(&self, place: [i64; 2]) -> [f64; 4] {
        let mut inside = [0; 2];
        for axis in 0..2 {
            let size = i64::from(self.size[axis]);
            inside[axis] = match self.wrap[axis] {
                Wrapping::Repeat => place[axis].rem_euclid(size),
                Wrapping::Mirror => {
                    let there = place[axis].rem_euclid(2 * size);
                    if there < size { there } else { 2 * size - 1 - there }
                }
                Wrapping::Edge => place[axis].clamp(0, size - 1),
                Wrapping::Border | Wrapping::Half if (0..size).contains(&place[axis]) => place[axis],
                Wrapping::Border | Wrapping::Half => return self.border,
            };
        }
        self.texels[inside[1] as usize * self.size[0] as usize + inside[0] as usize]
    }

    /// Position in texels; GL_CLAMP keeps coordinates in [0, 1].
    fn place(&self, coordinates: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let within = match self.wrap[axis] {
                Wrapping::Half => coordinates[axis].clamp(0.0, 1.0),
                _ => coordinates[axis],
            };
            within * f64::from(self.size[axis])
        })
    }

    /// Grade of NEAREST: near a texel's edge either neighbour may be meant. `error` is that of a value.
    pub fn nearest(&self, value: [f64; 4], coordinates: [f64; 2], error: f64) -> Grade {
        let place = self.place(coordinates);
        let near = [0, 1].map(|axis| {
            [-POSITION[0], POSITION[0]].map(|slack| {
                let texel = (place[axis] + slack).floor() as i64;
                // NEAREST never meets the border by GL_CLAMP.
                let most = i64::from(self.size[axis]) - 1;
                if self.wrap[axis] == Wrapping::Half { texel.clamp(0, most) } else { texel }
            })
        });
        let mut texels = near[1].into_iter().flat_map(|row| near[0].map(|column| self.texel([column, row])));
        let found = texels.any(|texel| (0..4).all(|channel| (texel[channel] - value[channel]).abs() <= error));
        if found { Grade::Good } else { Grade::Wrong }
    }

    /// Grade of LINEAR, and its distance from what is strictly allowed: positions good to 1/128 texel, else to 1/16, and
    /// `error` for a value, else twice that.
    pub fn linear(&self, value: [f64; 4], coordinates: [f64; 2], error: f64) -> (Grade, f64) {
        let outside = POSITION.map(|slack| self.distance(value, self.place(coordinates), slack));
        let grade = match () {
            () if outside[0] <= error => Grade::Good,
            () if outside[1] <= 2.0 * error => Grade::Allowed,
            () => Grade::Wrong,
        };
        (grade, outside[0])
    }

    /// Distance from the range of what a filter finds whose position is off by at most `slack`.
    fn distance(&self, value: [f64; 4], place: [f64; 2], slack: f64) -> f64 {
        let places = place.map(|at| {
            let middle = at - 0.5;
            [middle - slack, middle.round().clamp(middle - slack, middle + slack), middle + slack]
        });
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
        for (column, row) in places[1].into_iter().flat_map(|row| places[0].map(|column| (column, row))) {
            let (low, weights) = ([column, row].map(f64::floor), [column - column.floor(), row - row.floor()]);
            let texel = |x: f64, y: f64| self.texel([(low[0] + x) as i64, (low[1] + y) as i64]);
            let four = [texel(0.0, 0.0), texel(1.0, 0.0), texel(0.0, 1.0), texel(1.0, 1.0)];
            for (channel, range) in ranges.iter_mut().enumerate() {
                let mean = bilinear(four.map(|texel| texel[channel]), weights[0], weights[1]);
                *range = [range[0].min(mean), range[1].max(mean)];
            }
        }
        let outside = |[low, high]: [f64; 2], value: f64| (low - value).max(value - high).max(0.0);
        let distances = ranges.into_iter().zip(value).map(|(range, value)| outside(range, value));
        distances.fold(0.0, |worst: f64, off| if off.is_nan() { f64::NAN } else { worst.max(off) })
    }
}

/// Derivatives of a position in texels of the base level, along x and along y: the level's number lambda lies between the
/// logarithms of the greatest of them and of the greatest sums, and is ideally that of the longer vector [GL 4.6, 8.14.1].
/// Least, ideal, most.
pub fn level_of(along: [[f64; 2]; 2]) -> [f64; 3] {
    let [u, v] = [0, 1].map(|axis| along[0][axis].abs().max(along[1][axis].abs()));
    let ideal = along.map(|[u, v]| u.hypot(v)).into_iter().fold(0.0, f64::max);
    [u.max(v), ideal, u + v].map(f64::log2)
}

/// Grade of a blend of levels whose number is the value: lambda between `low` and `high`, ideally `ideal`; strictly to 1/64 of
/// a level, else to 1/16; the value itself to 1/256. The level is kept within `range` in the end.
pub fn blended_level(value: f64, [low, ideal, high]: [f64; 3], range: [f64; 2]) -> (Grade, f64) {
    let within = |level: f64| level.clamp(range[0], range[1]);
    let (strict, most) = (1.0 / 64.0 + 1.0 / 256.0, 1.0 / 16.0 + 1.0 / 256.0);
    let off = (value - within(ideal)).abs();
    let grade = match () {
        () if off <= strict => Grade::Good,
        () if value >= within(low) - most && value <= within(high) + most => Grade::Allowed,
        () => Grade::Wrong,
    };
    (grade, off)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXELS: [[f64; 4]; 4] = [[0.0; 4], [100.0; 4], [200.0; 4], [40.0; 4]];

    fn flat(wrap: Wrapping) -> Flat<'static> {
        Flat { size: [2, 2], texels: &TEXELS, wrap: [wrap; 2], border: [255.0; 4] }
    }

    #[test]
    fn texels_outside() {
        let cases = [
            (Wrapping::Repeat, [2, 0], 0.0),
            (Wrapping::Repeat, [-1, 0], 100.0),
            (Wrapping::Mirror, [2, 0], 100.0),
            (Wrapping::Mirror, [-1, 1], 200.0),
            (Wrapping::Edge, [7, -3], 100.0),
            (Wrapping::Border, [2, 0], 255.0),
            (Wrapping::Border, [1, 1], 40.0),
        ];
        for (wrap, place, due) in cases {
            assert_eq!(flat(wrap).texel(place)[0], due, "{wrap:?} {place:?}");
        }
    }

    #[test]
    fn filters() {
        // Halfway between the left texels; far outside by GL_CLAMP, half of the border.
        assert_eq!(flat(Wrapping::Edge).linear([100.0; 4], [0.25, 0.5], 0.0).0, Grade::Good);
        assert_eq!(flat(Wrapping::Edge).linear([110.0; 4], [0.25, 0.5], 1.0).0, Grade::Allowed);
        assert_eq!(flat(Wrapping::Edge).linear([120.0; 4], [0.25, 0.5], 1.0).0, Grade::Wrong);
        assert_eq!(flat(Wrapping::Half).linear([127.5; 4], [-9.0, 0.25], 0.1).0, Grade::Good);
        assert_eq!(flat(Wrapping::Half).nearest([0.0; 4], [-9.0, 0.25], 0.0), Grade::Good);
        assert_eq!(flat(Wrapping::Border).nearest([255.0; 4], [-9.0, 0.25], 0.0), Grade::Good);
        assert_eq!(flat(Wrapping::Edge).nearest([255.0; 4], [0.1, 0.25], 0.0), Grade::Wrong);
    }

    #[test]
    fn levels() {
        assert_eq!(level_of([[4.0, 0.0], [0.0, 4.0]]), [2.0, 2.0, 3.0]);
        let range = [0.0, 5.0];
        assert_eq!(blended_level(2.01, [2.0, 2.0, 3.0], range).0, Grade::Good);
        assert_eq!(blended_level(2.9, [2.0, 2.0, 3.0], range).0, Grade::Allowed);
        assert_eq!(blended_level(1.9, [2.0, 2.0, 3.0], range).0, Grade::Wrong);
        assert_eq!(blended_level(5.0, [7.0, 7.0, 7.5], range).0, Grade::Good);
    }
}
