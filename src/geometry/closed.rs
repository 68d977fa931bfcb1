//! Tests whether a mesh bounds solids that look outwards, piece by piece: seen from outside, it then shows no back face.

use super::Mesh;
use super::volume::{Caster, SurfaceKind};
use crate::math::Aabb;

impl Mesh {
    /// Reason why back faces of the mesh may be seen from outside, as a part of a sentence; `None`: none is.
    ///
    /// Vertices are one where their positions are equal. A piece that looks inwards may lie in the box of one that looks
    /// outwards: it is a hollow.
    pub fn why_not_closed(&self) -> Option<&'static str> {
        let caster = Caster::of_mesh(self);
        if caster.shells().is_empty() || !caster.is_closed() {
            return Some("the mesh has open, crowded or turned edges");
        }
        let (solids, inwards): (Vec<_>, Vec<_>) =
            caster.shells().iter().partition(|shell| shell.kind == SurfaceKind::Closed);
        if solids.is_empty() {
            return Some("faces must look outwards, and those of the mesh look inwards");
        }
        // Few pieces look inwards: each is compared with all others.
        let is_hollow = |bounds: &Aabb| {
            let holds = |other: &Aabb| other.min.cmplt(bounds.min).all() && other.max.cmpgt(bounds.max).all();
            solids.iter().any(|solid| holds(&solid.bounds))
        };
        let all_hollow = inwards.iter().all(|shell| is_hollow(&shell.bounds));
        (!all_hollow).then_some("faces must look outwards, and those of some piece of the mesh look inwards")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::primitive;

    /// A box, and copies of it moved, scaled and turned inside out.
    fn boxes(copies: &[([f32; 3], f32, bool)]) -> Mesh {
        let single = primitive("box").unwrap();
        let mut all = Mesh { positions: Vec::new(), indices: Vec::new(), ..single.clone() };
        for (moved, scale, is_turned) in copies {
            let first = all.positions.len() as u32;
            all.positions.extend(single.positions.iter().map(|at| [0, 1, 2].map(|k| scale * at[k] + moved[k])));
            for [a, b, c] in single.indices.as_chunks::<3>().0 {
                let triangle = if *is_turned { [a, c, b] } else { [a, b, c] };
                all.indices.extend(triangle.map(|index| index + first));
            }
        }
        all
    }

    #[test]
    fn each_piece_must_look_outwards_or_be_a_hollow() {
        let (middle, aside) = ([0.0; 3], [9.0, 0.0, 0.0]);
        for (copies, is_closed) in [
            (&[(middle, 1.0, false)][..], true),
            (&[(middle, 1.0, true)], false),
            (&[(middle, 1.0, false), (aside, 1.0, false)], true),
            // More is outside than inside out, so that the volume of all is positive.
            (&[(middle, 1.0, false), (aside, 0.5, true)], false),
            (&[(middle, 1.0, false), (middle, 0.5, true)], true),
            (&[(middle, 0.5, false), (middle, 1.0, true)], false),
        ] {
            let mesh = boxes(copies);
            assert_eq!(mesh.why_not_closed().is_none(), is_closed, "{copies:?}: {:?}", mesh.why_not_closed());
        }
        let mut open = boxes(&[(middle, 1.0, false)]);
        open.indices.truncate(33);
        assert!(open.why_not_closed().is_some());
        let mut turned = boxes(&[(middle, 1.0, false)]);
        turned.indices.swap(0, 1);
        assert!(turned.why_not_closed().is_some());
    }
}
