//! Edges of triangles, and the triangles that use them.

#[derive(Clone, Debug, Default)]
pub(super) struct PlainEdges {
    /// The two places, as the first triangle runs.
    pub places: Vec<[u32; 2]>,
    /// The first triangle and the second, which runs the other way.
    pub triangles: Vec<[u32; 2]>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct OtherEdges {
    /// The smaller place, the larger.
    pub places: Vec<[u32; 2]>,
    /// Edge k's uses are `uses[ends[k - 1]..ends[k]]`.
    pub ends: Vec<u32>,
    /// A triangle, and whether it runs from the smaller to the larger place (1) or back (-1).
    pub uses: Vec<(u32, i8)>,
}

/// One use of an edge: sorted by its two places, then by triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    /// The smaller place above the larger.
    pub places: u64,
    pub triangle: u32,
    /// True if the triangle runs from the smaller to the larger.
    forward: bool,
}

impl Use {
    fn places(self) -> [u32; 2] {
        [(self.places >> 32) as u32, self.places as u32]
    }
}

/// All edges of all triangles, those of one edge together.
pub(super) fn uses(triangles: &[[u32; 3]]) -> Vec<Use> {
    let mut uses = Vec::with_capacity(3 * triangles.len());
    for (triangle, [a, b, c]) in (0u32..).zip(triangles) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let places = (u64::from(*from.min(to)) << 32) | u64::from(*from.max(to));
            uses.push(Use { places, triangle, forward: from < to });
        }
    }
    uses.sort_unstable();
    uses
}

/// Renumbers the uses for triangles in another order.
pub(super) fn renumber(uses: &mut [Use], order: &[(u32, u32)]) {
    let mut new_from_old = vec![0; order.len()];
    for (new, (_, old)) in (0u32..).zip(order) {
        new_from_old[*old as usize] = new;
    }
    for each in &mut *uses {
        each.triangle = new_from_old[each.triangle as usize];
    }
    uses.sort_unstable();
}

pub(super) fn find_edges(uses: &[Use]) -> (PlainEdges, OtherEdges) {
    let (mut plain, mut other) = (PlainEdges::default(), OtherEdges::default());
    for edge in uses.chunk_by(|a, b| a.places == b.places) {
        let [low, high] = edge[0].places();
        match edge {
            [a, b] if a.forward != b.forward => {
                plain.places.push(if a.forward { [low, high] } else { [high, low] });
                plain.triangles.push([a.triangle, b.triangle]);
            }
            _ => {
                other.places.push([low, high]);
                other.uses.extend(edge.iter().map(|each| (each.triangle, if each.forward { 1 } else { -1 })));
                other.ends.push(other.uses.len() as u32);
            }
        }
    }
    (plain, other)
}

impl OtherEdges {
    /// Each edge's places and uses.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[(u32, i8)])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let uses = starts.zip(&self.ends).map(|(start, end)| &self.uses[*start as usize..*end as usize]);
        self.places.iter().copied().zip(uses)
    }
}
