//! Rectangles of a map's texels, and a grid of cells that finds those that meet one without a look at each.

/// Left, bottom, right and top, in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle([u32; 4]);

impl Rectangle {
    pub const NOTHING: Self = Self([u32::MAX, u32::MAX, 0, 0]);

    /// The texels from left and bottom to before right and top.
    pub fn new(sides: [u32; 4]) -> Self {
        Self(sides)
    }

    pub fn with(self, Self(other): Self) -> Self {
        let [left, bottom, right, top] = self.0;
        Self([left.min(other[0]), bottom.min(other[1]), right.max(other[2]), top.max(other[3])])
    }

    pub fn within(self, Self(other): Self) -> Self {
        let [left, bottom, right, top] = self.0;
        let both = [left.max(other[0]), bottom.max(other[1]), right.min(other[2]), top.min(other[3])];
        if both[0] < both[2] && both[1] < both[3] { Self(both) } else { Self::NOTHING }
    }

    pub fn scissor(&self) -> [u32; 4] {
        let [left, bottom, right, top] = self.0;
        if self.area() == 0 { [0; 4] } else { [left, bottom, right - left, top - bottom] }
    }

    pub fn area(&self) -> u64 {
        let [left, bottom, right, top] = self.0;
        u64::from(right.saturating_sub(left)) * u64::from(top.saturating_sub(bottom))
    }
}

/// Greatest number of cells a side.
const MOST_CELLS: u32 = 128;

/// Rectangles in a square of cells.
pub struct Cells<'r> {
    rectangles: &'r [Rectangle],
    /// Number of cells a side, and of texels a side of each.
    side: u32,
    texels: u32,
    /// Numbers of the rectangles that cover some of each cell, row by row, in their order.
    cells: Vec<Vec<u32>>,
}

impl<'r> Cells<'r> {
    /// Sorts the rectangles of a map of `size` texels a side into some four cells each.
    pub fn new(rectangles: &'r [Rectangle], size: u32) -> Self {
        let side = (2.0 * (rectangles.len() as f64).sqrt()).ceil().clamp(1.0, f64::from(MOST_CELLS)) as u32;
        let texels = size.div_ceil(side).max(1);
        let mut cells = Self { rectangles, side, texels, cells: vec![Vec::new(); (side * side) as usize] };
        for (number, rectangle) in (0..).zip(rectangles) {
            cells.covered(rectangle).into_iter().for_each(|cell| cells.cells[cell].push(number));
        }
        cells
    }

    /// Numbers of the rectangles that share texels with `own`, each once, in their order.
    pub fn meeting(&self, own: &Rectangle) -> Vec<usize> {
        let numbers = self.covered(own).into_iter().flat_map(|cell| &self.cells[cell]).map(|number| *number as usize);
        let mut numbers: Vec<usize> =
            numbers.filter(|number| own.within(self.rectangles[*number]).area() > 0).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// The cells that a rectangle covers some of.
    fn covered(&self, rectangle: &Rectangle) -> Vec<usize> {
        if rectangle.area() == 0 {
            return Vec::new();
        }
        let cell = |texel: u32| (texel / self.texels).min(self.side - 1);
        let Rectangle([left, bottom, right, top]) = *rectangle;
        let (columns, rows) = (cell(left)..=cell(right - 1), cell(bottom)..=cell(top - 1));
        rows.flat_map(|row| columns.clone().map(move |column| (row * self.side + column) as usize)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_meet_are_those_of_a_look_at_each() {
        let mut random = fastrand::Rng::with_seed(7);
        for (count, size) in [(0, 64), (1, 1), (60, 64), (300, 1000), (300, 16)] {
            let mut rectangle = |most: u32| {
                let [left, bottom] = [(); 2].map(|()| random.u32(0..size));
                let [width, height] = [(); 2].map(|()| random.u32(0..=most));
                Rectangle::new([left, bottom, (left + width).min(size), (bottom + height).min(size)])
            };
            let rectangles: Vec<Rectangle> = (0..count).map(|_| rectangle(size / 8)).collect();
            let cells = Cells::new(&rectangles, size);
            for own in (0..50).map(|k| rectangle(size / (1 + k))) {
                let meets = |(_, other): &(usize, &Rectangle)| own.within(**other).area() > 0;
                let expected: Vec<usize> =
                    rectangles.iter().enumerate().filter(meets).map(|(number, _)| number).collect();
                assert_eq!(cells.meeting(&own), expected, "{own:?} among {count}");
            }
        }
    }

    #[test]
    fn small_rectangles_look_at_few() {
        // 100 by 100 of 4 texels in 10 by 10 each.
        let place = |k: u32| Rectangle::new([10 * (k % 100), 10 * (k / 100), 10 * (k % 100) + 4, 10 * (k / 100) + 4]);
        let all: Vec<Rectangle> = (0..10_000).map(place).collect();
        let cells = Cells::new(&all, 1000);
        let looked_at: usize = all.iter().flat_map(|own| cells.covered(own)).map(|cell| cells.cells[cell].len()).sum();
        assert!(looked_at < 40_000, "{looked_at}");
    }
}
