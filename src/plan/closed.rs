//! Says of which objects back faces are drawn that a key of the scene would leave out.

use std::collections::HashSet;
use std::sync::Arc;

use super::Plan;
use crate::geometry::Mesh;
use crate::lights::Chosen;
use crate::scene::{Object, Scene};

/// Triangles below which back faces cost nothing that could be measured.
const FEWEST_TRIANGLES: usize = 1000;

impl Plan {
    /// Adds to [`Plan::chosen`] which meshes are closed and look outwards although the scene does not say so. Their back faces
    /// are drawn: at an outline a front and a back face may round to one depth, and which of them shows is the driver's.
    ///
    /// The work is that of sorting the edges of each mesh: for readers of plans, not for each frame.
    #[doc(hidden)]
    pub fn note_closed(&mut self, scene: &Scene) {
        let mut known: HashSet<*const Mesh> = HashSet::new();
        let is_candidate = |object: &&Object| {
            !object.closed && object.wave.is_none() && object.mesh.triangle_count() >= FEWEST_TRIANGLES
        };
        for object in scene.objects.iter().filter(is_candidate) {
            if known.insert(Arc::as_ptr(&object.mesh)) && object.mesh.why_not_closed().is_none() {
                self.chosen.push(Chosen {
                    of: object.name.clone(),
                    choice: String::from("back faces drawn"),
                    why: String::from(
                        "its mesh is closed and looks outwards: closed = true leaves them out, and may change single pixels of its \
                         outline",
                    ),
                });
            }
        }
    }
}
