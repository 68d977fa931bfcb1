//! Rectangles of pieces placed in one picture, without overlap.

use guillotiere::{AtlasAllocator, size2};

use super::Error;

/// Most texels a side of a new skin.
pub const LARGEST: u32 = 8192;
/// Halvings of the interval in which the greatest scale that fits is searched.
const HALVINGS: usize = 12;
/// Number of rectangles beyond which only the first order is tried.
const FEW: usize = 4096;
/// Scale below which the gutters alone are taken to fill the picture.
const LEAST_SCALE: f64 = 1.0 / 1024.0;

/// A picture's size, the scale of the pieces in it, and the top left corner of each piece's rectangle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Packed {
    pub size: [u32; 2],
    pub scale: f64,
    pub corners: Vec<[u32; 2]>,
}

/// Packs rectangles. `rectangles` gives their widths and heights at a scale, gutters included.
///
/// With a size, the pieces keep their scale or are made smaller until they fit. Without one, the picture has the fewest
/// texels that hold them at their scale, and sides that are powers of two.
pub(super) fn pack(
    size: Option<[u32; 2]>,
    gutter: u32,
    rectangles: impl Fn(f64) -> Vec<[u64; 2]>,
) -> Result<Packed, Error> {
    let Some(size) = size else { return grow(&rectangles(1.0)) };
    let place_at = |scale: f64| place(size, &rectangles(scale)).map(|corners| Packed { size, scale, corners });
    if let Some(packed) = place_at(1.0) {
        return Ok(packed);
    }
    let [width, height] = size;
    let mut best =
        place_at(LEAST_SCALE).ok_or_else(|| Error::NoRoom { width, height, pieces: rectangles(1.0).len(), gutter })?;
    let mut too_large = 1.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (best.scale + too_large);
        match place_at(middle) {
            Some(packed) => best = packed,
            None => too_large = middle,
        }
    }
    Ok(best)
}

/// The smallest picture with sides of powers of two.
fn grow(rectangles: &[[u64; 2]]) -> Result<Packed, Error> {
    let area: u64 = rectangles.iter().map(|[width, height]| width.saturating_mul(*height)).fold(0, u64::saturating_add);
    let most = LARGEST.trailing_zeros();
    for power in 0..=2 * most {
        if area > 1 << power {
            continue;
        }
        // A square, or a rectangle of 2 by 1 either way.
        let (low, high) = (power / 2, power.div_ceil(2));
        let sides = if low == high { vec![[low, low]] } else { vec![[high, low], [low, high]] };
        for size in sides.into_iter().filter(|[_, _]| high <= most).map(|powers| powers.map(|power| 1 << power)) {
            if let Some(corners) = place(size, rectangles) {
                return Ok(Packed { size, scale: 1.0, corners });
            }
        }
    }
    Err(Error::TooLarge { limit: LARGEST })
}

/// Places the larger rectangles first, in several orders. `None`: they do not fit.
fn place(size: [u32; 2], rectangles: &[[u64; 2]]) -> Option<Vec<[u32; 2]>> {
    let [width, height] = size.map(i32::try_from);
    let atlas = size2(width.ok()?, height.ok()?);
    let orders: [fn(&[u64; 2]) -> u64; 4] = [
        |[width, height]| *width.max(height),
        |[_, height]| *height,
        |[width, _]| *width,
        |[width, height]| width.saturating_mul(*height),
    ];
    let tried = if rectangles.len() <= FEW { orders.len() } else { 1 };
    orders.into_iter().take(tried).find_map(|measure| {
        let mut order: Vec<usize> = (0..rectangles.len()).collect();
        order.sort_by_key(|index| (std::cmp::Reverse(measure(&rectangles[*index])), *index));
        let mut allocator = AtlasAllocator::new(atlas);
        let mut corners = vec![[0; 2]; rectangles.len()];
        for index in order {
            let [width, height] = rectangles[index].map(i32::try_from);
            let place = allocator.allocate(size2(width.ok()?, height.ok()?))?.rectangle.min;
            corners[index] = [place.x, place.y].map(i32::cast_unsigned);
        }
        Some(corners)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of texels that rectangles cover; panics where two of them, or one and the rim, overlap.
    fn covered(packed: &Packed, rectangles: &[[u64; 2]]) -> usize {
        let [width, height] = packed.size.map(|side| side as usize);
        let mut owners = vec![false; width * height];
        for (corner, sides) in packed.corners.iter().zip(rectangles) {
            let [x, y] = corner.map(|at| at as usize);
            let [across, down] = sides.map(|side| side as usize);
            assert!(x + across <= width && y + down <= height);
            for (y, x) in (y..y + down).flat_map(|y| (x..x + across).map(move |x| (y, x))) {
                assert!(!std::mem::replace(&mut owners[y * width + x], true), "{x}, {y} twice");
            }
        }
        owners.into_iter().filter(|owner| *owner).count()
    }

    #[test]
    fn rectangles_lie_apart_in_the_smallest_picture() {
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..200 {
            let rectangles: Vec<[u64; 2]> =
                (0..random.usize(1..60)).map(|_| [random.u64(1..50), random.u64(1..50)]).collect();
            let packed = pack(None, 0, |_| rectangles.clone()).unwrap();
            let area: u64 = rectangles.iter().map(|[width, height]| width * height).sum();
            assert_eq!(covered(&packed, &rectangles) as u64, area);
            assert!(packed.size.iter().all(|side| side.is_power_of_two()));
            // A shelf for the widest and the highest, and half of the rest at worst.
            let texels = u64::from(packed.size[0]) * u64::from(packed.size[1]);
            assert!(texels < 4 * area + 128 * 128, "{texels} texels for {area}");
        }
    }

    #[test]
    fn a_small_picture_shrinks_the_pieces_as_little_as_it_must() {
        let sides = |scale: f64| vec![[(100.0 * scale).ceil() as u64 + 4; 2]; 9];
        let packed = pack(Some([152, 152]), 2, sides).unwrap();
        // Three in a row: 50 texels each, of which 46 are the piece's.
        assert!((packed.scale - 0.46).abs() < 1e-3, "{}", packed.scale);
        covered(&packed, &sides(packed.scale));
        assert_eq!(pack(Some([400, 400]), 2, sides).unwrap().scale, 1.0);
        assert!(matches!(pack(Some([12, 12]), 2, sides), Err(Error::NoRoom { pieces: 9, .. })));
        assert!(matches!(pack(None, 2, |_| vec![[u64::MAX; 2]; 2]), Err(Error::TooLarge { .. })));
    }
}
