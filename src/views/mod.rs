//! Pictures beside the picture, which show how a shadow is made [HSM, Figures 2, 4, 5 and 6]. Each is a row of [`VIEWS`].

pub mod frustum_lines;

use crate::pass::{Filter, ImageId, Input, Sampler, Shade, Wrap, glsl};

use crate::lights::ending::{FormulaPart, SurfaceProperty};
use crate::lights::light::{Addition, Gain, ShadeSource};
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
    Normal,
    NormalMap,
    Decal,
    Gloss,
    TangentLight,
    TangentHalf,
    Diffuse,
    Specular,
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
    ("normal", View::Normal, false, "surfaces' normals in world space, bumps included, v as the colour v / 2 + 1 / 2"),
    ("normal-map", View::NormalMap, false, "the surfaces' normal maps, in tangent space: flat is chalk blue"),
    ("decal", View::Decal, false, "the surfaces' own colours, without light"),
    ("gloss", View::Gloss, false, "the share of highlights that surfaces reflect: 1 white, 0 black"),
    (
        "tangent-light",
        View::TangentLight,
        true,
        "the vector to the light in tangent space, as a colour; where there are bumps",
    ),
    (
        "tangent-half",
        View::TangentHalf,
        true,
        "the half-angle vector in tangent space, as a colour; where there are bumps",
    ),
    ("diffuse", View::Diffuse, true, "the light's diffuse part on the surfaces, without decal and shadow"),
    (
        "specular",
        View::Specular,
        true,
        "the light's highlights, without shadow; with the gloss, except of bump = \"three-pass\", where blending weighs them",
    ),
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
///
/// `three_passes`: highlights are shown as a pass of their own has them.
pub fn camera_pass(view: View, term: &LightTerm, three_passes: bool) -> Option<(Ending, LightTerm)> {
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
        View::TangentLight | View::TangentHalf => {
            term = unlit_by_shade(&term);
            Ending::TangentVector { chunk: glsl!("views/tangent_vector.frag"), half: view == View::TangentHalf }
        }
        View::Diffuse => {
            term = unlit_by_shade(&term);
            term.gain = Gain { ambient: 0.0, diffuse: 1.0, specular: 0.0 };
            Ending::Part(FormulaPart::Diffuse)
        }
        View::Specular => {
            term = unlit_by_shade(&term);
            term.gain = Gain { ambient: 0.0, diffuse: 0.0, specular: 1.0 };
            if three_passes { Ending::Part(FormulaPart::Specular) } else { Ending::Lit }
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
        | View::Silhouette
        | View::Normal
        | View::NormalMap
        | View::Decal
        | View::Gloss => return None,
    };
    Some((ending, term))
}

/// The light without its shadow, and without the scene's ambient light.
fn unlit_by_shade(term: &LightTerm) -> LightTerm {
    LightTerm { addition: Addition::Light, counting: None, dimming: 0.0, ..term.under(ShadeSource::lit()) }
}

/// Ending of the fragments of a view of the surfaces alone.
pub fn surface_pass(view: View) -> Option<Ending> {
    let shown = match view {
        View::Normal => SurfaceProperty::Normal,
        View::NormalMap => SurfaceProperty::NormalMap,
        View::Decal => SurfaceProperty::Decal,
        View::Gloss => SurfaceProperty::Gloss,
        _ => return None,
    };
    Some(Ending::Surface { chunk: glsl!("views/surface.frag"), shown })
}

/// An input that reads a map's depths without comparison; the caller sets its name.
fn uncompared(image: ImageId) -> Input {
    let sampler = Sampler { filter: Filter::Nearest, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    Input { name: "".into(), image, sampler }
}
