//! Views of one counted light: its count, its shade, its volumes and their silhouettes.

use super::{LIT, once_counted};
use crate::compositions::Error;
use crate::compositions::passes::{Buffers, Onto, Passes};
use crate::compositions::projection::CameraProjection;
use crate::lights::light::{ShadeSource, StencilCount, VolumeDraw};
use crate::lights::{Ending, LightTerm};
use crate::pass::{
    Blend, Clear, Compare, DrawPass, DrawState, Face, FixedFunctionDesc, Format, ImageId, Redraw, Uniform, glsl,
};
use crate::views::{self, View};

impl Passes<'_> {
    /// A view of a counted light.
    pub(super) fn counted_view(
        &mut self,
        view: View,
        label: &str,
        term: &LightTerm,
        counting: &StencilCount,
    ) -> Result<ImageId, Error> {
        let lens = CameraProjection::for_counts(self.scene, std::iter::once(counting));
        let buffers = self.color_and_depth(label, self.scene.image.size, Format::Rgba32F, true);
        let target = buffers.target();
        match view {
            View::Volume | View::Silhouette if counting.volumes.is_empty() => {
                return Err(Error::NoCount { view: view.name(), light: term.index });
            }
            View::Volume | View::Silhouette => {
                return self.volume_view(view, label, buffers, &lens, term, counting);
            }
            View::StencilCount | View::StencilColors => {
                let onto = self.first(label, target, &lens, [0.0; 4]);
                self.surfaces(&onto, &[], &Ending::Lit)?;
                self.count(target, &lens, term, counting, &format!("{label}: "), Redraw::Always)?;
                return Ok(buffers.depth);
            }
            _ => {}
        }
        let lit = once_counted(term);
        let Some((ending, lit)) = views::camera_pass(view, &lit, false) else {
            return Err(Error::NoCount { view: view.name(), light: term.index });
        };
        let shadowed = term.under(ShadeSource::dark());
        let onto = self.first(label, target, &lens, [0.0; 4]);
        self.surfaces(&onto, &[shadowed], &ending)?;
        self.count(target, &lens, term, counting, &format!("{label}: "), Redraw::Always)?;
        let state = lens.of_surfaces(DrawState { stencil: Some(LIT), ..DrawState::REPEAT });
        let label = format!("{label}: where the count is 0");
        let onto = Onto { clear: Clear::default(), state, ..self.first(&label, target, &lens, [0.0; 4]) };
        self.surfaces(&onto, &[lit], &ending)?;
        Ok(buffers.color)
    }

    /// Volumes, translucent, or their silhouettes over the unshadowed scene [GDC, "Visualizing Shadow Volumes"].
    fn volume_view(
        &mut self,
        view: View,
        label: &str,
        buffers: Buffers,
        lens: &CameraProjection,
        term: &LightTerm,
        counting: &StencilCount,
    ) -> Result<ImageId, Error> {
        let target = buffers.target();
        let unshadowed = term.under(ShadeSource::lit());
        let onto = self.first(label, target, lens, self.background());
        self.surfaces(&onto, &[unshadowed], &Ending::Lit)?;
        let (draws, name): (&[VolumeDraw], _) = match view {
            View::Silhouette => (&counting.silhouettes, "silhouettes"),
            _ => (&counting.volumes, "volumes"),
        };
        // The outside of a volume is warm, its inside cold.
        let layers: &[(Option<Face>, [f32; 4])] = match view {
            View::Silhouette => &[(None, [1.0, 0.85, 0.0, 1.0])],
            _ => &[(Some(Face::Front), [0.1, 0.3, 0.9, 0.25]), (Some(Face::Back), [0.95, 0.55, 0.1, 0.25])],
        };
        let batches = layers.iter().flat_map(|(cull, color)| {
            let uniforms = vec![Uniform::new("color", glam::Vec4::from(*color))];
            let fragment = glsl!("stencil_counted/colored.frag");
            StencilCount::batches(draws, &lens.camera, *cull, fragment, FixedFunctionDesc::Constant(*color), uniforms)
        });
        let pass = DrawPass {
            target,
            viewport: self.scene.image.size,
            clear: Clear::default(),
            state: lens.of_surfaces(DrawState {
                depth_test: Some(Compare::LessEqual),
                depth_write: false,
                blend: Some(Blend::Over),
                ..DrawState::OPAQUE
            }),
            batches: batches.collect(),
        };
        self.push(&format!("{label}: {name}"), Redraw::Always, pass);
        Ok(buffers.color)
    }
}
