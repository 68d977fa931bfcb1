//! Pictures beside the picture, which show how a shadow is made [HSM, Figures 2, 4, 5 and 6]. Each is a row of [`VIEWS`].

pub mod frustum_lines;

use crate::pass::{Filter, ImageId, Input, Sampler, Shade, Wrap, glsl};

use crate::lights::{Ending, LightTerm};

/// Content of a picture beside the main one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    Shade,
    Depth,
    LightDepth,
    LightView,
    LightDistance,
    ProjectedMap,
    TexelsPerPixel,
    StencilCount,
    StencilColors,
    Volume,
    Silhouette,
}

/// All views: name, view, whether it shows one light, and a description.
pub const VIEWS: &[(&str, View, bool, &str)] = &[
    (
        "shade",
        View::Shade,
        true,
        "the shadow term: 1 lit, 0 shadowed, between them the filter's value; transparent where the light does not reach",
    ),
    ("depth", View::Depth, false, "the camera's window-space depth"),
    ("light-depth", View::LightDepth, true, "the shadow map: window-space depth from the light"),
    ("light-view", View::LightView, true, "the scene as the light sees it, lit and without shadow"),
    ("light-distance", View::LightDistance, true, "r/q: each sample's planar distance from the light"),
    ("projected-map", View::ProjectedMap, true, "the shadow map's depths projected onto the scene"),
    (
        "texels-per-pixel",
        View::TexelsPerPixel,
        true,
        "the side, in texels of the shadow map, of what a pixel shows: below 1 texels are seen one by one",
    ),
    (
        "stencil-count",
        View::StencilCount,
        true,
        "the shadow volumes that hold each point, as they are counted: integers; of a map's tags, 1 in shadow",
    ),
    ("stencil-colors", View::StencilColors, true, "the same for the eye: green lit, red shadowed, with a legend"),
    ("volume", View::Volume, true, "the shadow volumes over the scene: outsides orange, insides blue"),
    ("silhouette", View::Silhouette, true, "the casters' possible silhouettes as the light sees them"),
];

impl View {
    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        VIEWS.iter().find(|row| row.1 == self).map_or("", |row| row.0)
    }

    /// Tests whether it shows one light of the scene.
    pub fn of_light(self) -> bool {
        VIEWS.iter().any(|row| row.1 == self && row.2)
    }

    /// Tests whether it needs a shadow map.
    pub fn needs_map(self) -> bool {
        matches!(self, Self::LightDepth | Self::ProjectedMap | Self::TexelsPerPixel)
    }

    /// Tests whether it shows what shadow volumes count.
    pub fn needs_count(self) -> bool {
        matches!(self, Self::StencilCount | Self::StencilColors | Self::Volume | Self::Silhouette)
    }

    /// Tests whether it shows a stencil buffer.
    pub fn is_stencil(self) -> bool {
        matches!(self, Self::StencilCount | Self::StencilColors)
    }

    /// Tests whether a count in the stencil buffer decides what it shows.
    pub fn depends_on_shade(self) -> bool {
        self == Self::Shade || self.needs_count()
    }
}

/// Ending of the fragments of a view from the camera, and the light's term with what the view reads. `None` for views
/// without a camera pass of their own.
pub fn camera_pass(view: View, term: &LightTerm) -> Option<(Ending, LightTerm)> {
    let mut term = term.clone();
    let ending = match view {
        View::Shade => Ending::View { chunk: glsl!("views/shade.frag"), shade: true },
        View::LightDistance => {
            term.shade.meaning = Shade::Shader("r/q as a colour");
            if let Some(coordinates) = &mut term.coordinates {
                coordinates.receiver_bias = glam::DMat4::IDENTITY;
            }
            term.shade.inputs.clear();
            term.shade.uniforms.clear();
            Ending::View { chunk: glsl!("views/distance.frag"), shade: false }
        }
        View::ProjectedMap => {
            term.shade.uniforms.clear();
            let name = format!("depth_map_{}", term.index);
            term.shade.meaning = Shade::Texture { input: name.clone().into(), clamped: false };
            term.shade.inputs = vec![Input { name: name.into(), ..uncompared(term.map?) }];
            Ending::View { chunk: glsl!("views/projected_map.frag"), shade: false }
        }
        View::TexelsPerPixel => {
            term.shade.uniforms.clear();
            term.shade.meaning = Shade::Shader("texels per pixel");
            let name = format!("counted_map_{}", term.index);
            term.shade.inputs = vec![Input { name: name.into(), ..uncompared(term.map?) }];
            Ending::View { chunk: glsl!("views/texels_per_pixel.frag"), shade: false }
        }
        View::Depth
        | View::LightDepth
        | View::LightView
        | View::StencilCount
        | View::StencilColors
        | View::Volume
        | View::Silhouette => return None,
    };
    Some((ending, term))
}

/// An input that reads a map's depths without comparison; the caller sets its name.
fn uncompared(image: ImageId) -> Input {
    let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    Input { name: "".into(), image, sampler }
}
