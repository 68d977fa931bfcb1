//! Edges of an outline put together to loops.

use std::collections::HashMap;

/// An edge of the outline. Seen from the light, the counted triangle lies on the left of `from` to `to`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutlineEdge {
    /// Places of the caster.
    pub from: u32,
    pub to: u32,
    /// Number of times that it is part of the boundary; at least 1.
    pub multiplicity: u32,
}

/// Closed walks that use each edge as often as its multiplicity. The boundary of a sum of triangles leaves each place as
/// often as it enters it, so that a walk ends where it began.
pub(super) fn closed_walks(edges: &[OutlineEdge]) -> Vec<Vec<u32>> {
    let mut onward: HashMap<u32, Vec<u32>> = HashMap::with_capacity(edges.len());
    let mut total = 0usize;
    for edge in edges {
        for _ in 0..edge.multiplicity {
            onward.entry(edge.from).or_default().push(edge.to);
            total += 1;
        }
    }
    let mut walks = Vec::new();
    for edge in edges {
        while let Some(first) = onward.get_mut(&edge.from).and_then(Vec::pop) {
            let mut walk = vec![edge.from];
            let mut at = first;
            while at != edge.from {
                walk.push(at);
                let Some(next) = onward.get_mut(&at).and_then(Vec::pop) else { break };
                at = next;
            }
            walks.push(walk);
        }
    }
    debug_assert_eq!(walks.iter().map(Vec::len).sum::<usize>(), total);
    walks
}
