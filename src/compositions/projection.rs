//! The camera's projection and depth range, as stencil counts need them: a far plane at infinity [GDC, "OpenGL Renders W=0
//! Polygons Correctly"], or a ledge before the near plane [GDC, "Building a "Ledge" at the Front of the Depth Buffer"].
//! Surfaces and volumes share what is chosen here, so that their depths are comparable.

use glam::DVec2;

use crate::lights::Viewer;
use crate::lights::light::{LedgeDepths, StencilCount, VolumeDepths};
use crate::math::ledge::Ledge;
use crate::math::spaces::infinite_perspective;
use crate::pass::{Batch, Define, DrawState};
use crate::scene::Scene;

/// The bits of the depth buffer that volumes are counted against.
const DEPTH_BITS: u32 = 24;

/// Projection and depth ranges of the camera's picture.
pub struct CameraProjection {
    /// Viewer of surfaces, and of volumes on [`VolumeDepths::Scene`].
    pub camera: Viewer,
    depth_range: [f32; 2],
    /// True if the far plane is at infinity.
    infinite: bool,
    /// True if depth is clamped instead of clipped, for surfaces too: a triangle that is clipped in one pass only has other
    /// depths.
    clamped: bool,
    ledge: Option<Ledge>,
}

impl CameraProjection {
    /// The lens of the scene's camera.
    pub fn of_scene(scene: &Scene) -> Self {
        Self::of_viewer(Viewer::of_camera(scene))
    }

    /// The lens of a viewer, for pictures in which nothing is counted.
    pub fn of_viewer(camera: Viewer) -> Self {
        Self { camera, depth_range: [0.0, 1.0], infinite: false, clamped: false, ledge: None }
    }

    /// A projection under which all of `countings` can be counted. If one needs the ledge, the far plane is not at
    /// infinity: the others clamp their depth instead (see [`CameraProjection::state`]).
    pub fn for_counts<'a>(scene: &Scene, countings: impl Iterator<Item = &'a StencilCount> + Clone) -> Self {
        let mut lens = Self::of_scene(scene);
        let camera = &scene.camera;
        if let Some(depths) = countings.clone().find_map(|counting| counting.ledge) {
            let (fov, aspect) = (camera.fov_y_radians, scene.aspect());
            let ledge = match depths {
                LedgeDepths::Fewest => Ledge::new(fov, aspect, camera.near, camera.far, DEPTH_BITS),
                LedgeDepths::Given(depths) => Ledge::with_ranges(fov, aspect, camera.near, camera.far, depths),
            };
            lens.depth_range = ledge.scene_range.map(|depth| depth as f32);
            lens.ledge = Some(ledge);
        } else if countings.clone().any(|counting| counting.infinite) {
            lens.camera.clip_from_eye = infinite_perspective(camera.fov_y_radians, scene.aspect(), camera.near);
            lens.infinite = true;
        }
        let clamps = |counting: &StencilCount| counting.clamped || (counting.infinite && !lens.infinite);
        lens.clamped = countings.clone().any(clamps);
        lens
    }

    /// State of the surfaces.
    pub fn of_surfaces(&self, state: DrawState) -> DrawState {
        DrawState {
            depth_range: self.depth_range,
            depth_clamp: self.clamped,
            clip_distances: u8::from(self.clamped),
            ..state
        }
    }

    /// `x` and `y` of the surfaces' window depth `x + y / h` at the distance h along the view axis.
    pub fn depth_of_distance(&self) -> DVec2 {
        let [near, far] = self.depth_range.map(f64::from);
        let clip = &self.camera.clip_from_eye;
        let half = 0.5 * (far - near);
        DVec2::new(near + half * (1.0 - clip.z_axis.z), half * clip.w_axis.z)
    }

    /// Tests whether the scene's far plane does not clip, so that fragments beyond it must be discarded.
    pub fn has_no_far_plane(&self) -> bool {
        self.infinite || self.clamped
    }

    /// Projection of a count pass.
    pub fn viewer(&self, depths: VolumeDepths) -> Viewer {
        match (&self.ledge, depths) {
            (Some(ledge), VolumeDepths::Ledge | VolumeDepths::LedgeCap) => {
                Viewer { clip_from_eye: ledge.volume_clip_from_view, ..self.camera }
            }
            _ => self.camera,
        }
    }

    /// State of a count pass: its depth range, and depth clamp if the far plane would cut volumes.
    pub fn state(&self, counting: &StencilCount, state: &DrawState, depths: VolumeDepths) -> DrawState {
        let range = |range: [f64; 2]| range.map(|depth| depth as f32);
        let depth_range = match (&self.ledge, depths) {
            (Some(ledge), VolumeDepths::Ledge) => range(ledge.volume_range),
            (Some(ledge), VolumeDepths::LedgeCap) => range(ledge.cap_range),
            _ => self.depth_range,
        };
        let depth_clamp = state.depth_clamp || (counting.infinite && !self.infinite);
        DrawState {
            depth_range,
            depth_clamp,
            clip_distances: u8::from(depth_clamp),
            scissor: counting.scissor,
            ..*state
        }
    }

    /// Makes the vertex stage write what `state` clips by.
    pub fn adapt(state: &DrawState, batches: &mut [Batch]) {
        for batch in batches.iter_mut().filter(|_| state.clip_distances > 0) {
            batch.program.defines.push(Define::flag("CLIP_NEAR"));
        }
    }
}
