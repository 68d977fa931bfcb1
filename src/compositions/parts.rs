//! Parts of a light that is drawn by several passes: the part that a shadow leaves, and the light without its shadow.

use crate::lights::LightTerm;
use crate::lights::light::{Gain, ShadeSource};
use crate::scene::Scene;

/// The light without its shadow.
pub fn unshadowed(term: &LightTerm) -> LightTerm {
    term.under(ShadeSource::lit())
}

/// The part that a full shadow leaves: the light's own ambient light, and `left` of its diffuse light, in [0, 1]. `None`:
/// nothing.
pub fn left_by_shadow(scene: &Scene, term: &LightTerm, left: f32) -> Option<LightTerm> {
    let per_vertex = scene.shading.per_vertex;
    // Lighting per vertex is clamped before it is weighed.
    let diffuse = if per_vertex && left > 0.0 { 1.0 } else { left };
    let source = &term.source;
    let gives = |color: [f32; 3]| color != [0.0; 3];
    if !(gives(source.ambient) || (diffuse > 0.0 && gives(source.diffuse))) {
        return None;
    }
    let gain = Gain { ambient: 1.0, diffuse, specular: 0.0 };
    let mut part = LightTerm { dimming: 0.0, gain, ..unshadowed(term) };
    if per_vertex {
        part.diffuse_weight = term.dimming;
    }
    Some(part)
}
