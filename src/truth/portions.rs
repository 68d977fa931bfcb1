//! Order in which a picture's pixels are answered.

/// A picture's pixels are answered in so many portions, each spread over all of it: after each there is a check whether too
/// many are ambiguous already. If so, the rest is skipped.
pub(super) const COUNT: usize = 64;

/// Pixels a side of the tiles that a portion is made of: rays of neighbours meet the same boxes, which a cache then holds.
const TILE: u32 = 4;

/// The pixels of portion `first` by their numbers, counted row by row: those of every [`COUNT`]-th tile.
pub(super) fn pixels(first: usize, [width, height]: [u32; 2]) -> Vec<usize> {
    let across = width.div_ceil(TILE) as usize;
    let tiles = (first..across * height.div_ceil(TILE) as usize).step_by(COUNT);
    let corner = |tile: usize| [(tile % across) as u32 * TILE, (tile / across) as u32 * TILE];
    let end = |start: u32, most: u32| (start + TILE).min(most);
    let rows = tiles.map(corner).flat_map(|[x, y]| (y..end(y, height)).map(move |row| [x, row]));
    let pixels = rows.flat_map(|[x, row]| (x..end(x, width)).map(move |column| [column, row]));
    pixels.map(|[column, row]| row as usize * width as usize + column as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_in_one_portion() {
        for size in [[1, 1], [3, 5], [64, 48], [101, 67], [512, 9]] {
            let mut all: Vec<usize> = (0..COUNT).flat_map(|first| pixels(first, size)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..(size[0] * size[1]) as usize).collect::<Vec<_>>(), "{size:?}");
        }
    }
}
