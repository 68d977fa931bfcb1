//! Draws a scene's stencil count and compares it with the ray tracer's.

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::{Request, ViewRequest};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth::{Count, Options, VolumeCounts, volume_count};
use glumbra::views::View;

/// Every method, and those that claim to be right wherever the eye stands.
pub const RIGHT: [&str; 4] = ["auto", "z-fail", "z-fail-clamped", "z-pass-capped"];

/// The ray tracer's band may be any share of these pictures, which are made to be hard; what it decides is exact.
pub fn truth(scene: &Scene) -> VolumeCounts {
    volume_count(scene, 0, &Options { most_ambiguous: 1.0, ..Options::default() }).unwrap()
}

/// Comparison of a picture with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// Pixels at which the ray tracer is certain.
    pub told: usize,
    /// Pixels among these that are in some volume.
    pub inside: usize,
    /// Pixels among these with another stencil value, modulo 256.
    pub different: usize,
}

/// A renderer on a context of its own.
pub struct Bench {
    renderer: Renderer,
}

impl Bench {
    pub fn new() -> Self {
        let context = context::open(&ContextRequest::default()).unwrap();
        Self { renderer: Renderer::new(&context) }
    }

    /// The stencil count by `settings`, the inside of `[light.shadow]` but for its technique.
    pub fn count(&mut self, scene: &Scene, settings: &str) -> Vec<u8> {
        let inside = format!("technique = \"shadow-volume\", {settings}");
        let scene = techniques::with_keys(scene, 0, &inside).unwrap();
        let views = vec![ViewRequest { view: View::StencilCount, light: 0 }];
        let plan = match self.renderer.plan(&scene, &Request { views, ..Request::default() }) {
            Ok(plan) => plan,
            // No volume can matter to the picture.
            Err(error) if error.to_string().contains("counts no shadow volumes") => {
                return vec![0; (scene.image.size[0] * scene.image.size[1]) as usize];
            }
            Err(error) => panic!("{error}"),
        };
        self.renderer.draw(&plan).unwrap();
        match self.renderer.read(&plan).unwrap().views.pop() {
            Some(Pixels::Stencil { data, .. }) => data,
            other => panic!("{other:?} is no stencil"),
        }
    }

    pub fn hold(&mut self, scene: &Scene, truth: &VolumeCounts, settings: &str) -> Held {
        compare(truth, &self.count(scene, settings))
    }
}

pub fn compare(truth: &VolumeCounts, stencil: &[u8]) -> Held {
    let mut held = Held::default();
    for (pixel, counted) in truth.pixels.iter().zip(stencil) {
        let Count::Exactly(expected) = pixel.count else { continue };
        // A spotlight's volumes matter inside its beam.
        if pixel.hit.is_none_or(|hit| hit.in_map.abs().max_element() >= 1.0) {
            continue;
        }
        held.told += 1;
        held.inside += usize::from(expected > 0);
        held.different += usize::from(expected % 256 != u32::from(*counted));
    }
    held
}
