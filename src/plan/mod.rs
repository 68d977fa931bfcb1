//! Joins, orders and prunes the passes of a frame, and says what it left out and why. Names no technique.

mod after_pass;
mod closed;
mod compose;
mod lens;
#[doc(hidden)]
pub mod matrices;
mod photos;
mod pictures;
mod print;
mod prune;
mod shaders;
#[cfg(test)]
mod tests;

use glam::DVec3;
use serde::Serialize;

use crate::compositions;
use crate::geometry::Derived;
use crate::lights::{Chosen, LeftOut, MapInfo};
use crate::pass::{Format, ImageId, PassList};
use crate::scene::Scene;
pub use crate::views::View;

/// A request for a frame.
#[derive(Clone, Debug)]
pub struct Request {
    /// Viewer of the picture.
    pub subject: Subject,
    /// Views in addition to the picture.
    pub views: Vec<ViewRequest>,
    /// The picture in 32-bit float, for exact files.
    pub float_picture: bool,
    /// Leaves out what no view needs: the picture is then not drawn.
    #[doc(hidden)]
    pub views_only: bool,
    /// Frames to be drawn. Decides whether one-time work (sorting indices, keeping maps) is worth it.
    pub frames: u32,
    /// Draws what is left out otherwise, to prove that it changes no pixel and to see what it would cost: lights and
    /// objects out of sight, colour buffers of depth passes, maps that are there already.
    pub keep_all: bool,
    /// True if points that the camera sees are sampled to find pixels that will be wrong, for [`Plan::warnings`]. That
    /// costs some 10 to 100 ms a light: windows, which plan every frame, turn it off.
    pub sampled_warnings: bool,
    /// Object whose triangles' edges are drawn over the picture, by its index.
    pub wire: Option<usize>,
    /// Limits of the driver.
    pub limits: Limits,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            subject: Subject::Camera,
            views: Vec::new(),
            float_picture: false,
            views_only: false,
            frames: 1,
            keep_all: false,
            sampled_warnings: true,
            wire: None,
            limits: Limits::default(),
        }
    }
}

/// Viewer of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Subject {
    /// The scene's camera; the whole picture.
    #[default]
    Camera,
    /// A light, by its place in the scene, without shadows: the largest square of a power of two that fits the picture, in
    /// its lower left corner. A shadow map that is copied from the window's own depth buffer has that size as in the sample
    /// program hw_shadowmaps_simple.
    Light(usize),
}

/// Limits of a driver; [`Limits::default`] is GL 3.3's guarantee or common sense, for plans without one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The lesser of GL_MAX_TEXTURE_SIZE, GL_MAX_RENDERBUFFER_SIZE and GL_MAX_VIEWPORT_DIMS.
    pub max_image_size: u32,
    /// GL_MAX_TEXTURE_IMAGE_UNITS.
    pub max_inputs: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_image_size: 16384, max_inputs: 16 }
    }
}

/// One picture beside the main one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewRequest {
    /// View that is wanted.
    pub view: View,
    /// Index into the scene's lights; 0 for views of no light.
    pub light: usize,
}

/// A frame's passes, its pictures' images, and what was left out.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// Images and passes.
    pub list: PassList,
    /// Image of the picture.
    pub picture: ImageId,
    /// Views in the request's order.
    pub views: Vec<(ViewRequest, ImageId)>,
    /// Parts that this frame does not draw, each with the reason.
    pub left_out: Vec<LeftOut>,
    /// Choices that techniques made, each with the reason.
    pub chosen: Vec<Chosen>,
    /// Errors that the picture will show, one sentence each.
    pub warnings: Vec<String>,
    /// Maps of the lights that the picture or a view needs, in the scene's order.
    pub maps: Vec<MapInfo>,
    /// Texture coordinates from a light's and the camera's matrices.
    pub matrices: matrices::Matrices,
}

/// Reason why a scene cannot be planned.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// A light's shadow settings are raw: the scene was loaded without techniques.
    #[error(
        "{light}: its shadow settings were not read by glumbra's techniques: load the scene with glumbra::load, or read the table with techniques::read"
    )]
    Unread {
        /// Light or photograph, by its number.
        light: String,
    },
    /// The lights cannot be joined into passes.
    #[error(transparent)]
    Composition(#[from] compositions::Error),
    /// A view names a light that the scene does not have.
    #[error("--aov {view}: the scene has {count} light{}", if *.count == 1 { "" } else { "s" })]
    NoSuchLight { view: String, count: usize },
    /// A view shows a light's map, and its technique makes none.
    #[error("--aov {view}: light {light} has no shadow map ({why})")]
    NoMap { view: &'static str, light: usize, why: &'static str },
    /// A view does not exist for this kind of light.
    #[error("--aov {view}: light {light} is a {kind} light and {why}")]
    NoView { view: &'static str, light: usize, kind: &'static str, why: &'static str },
    /// An image is larger than the driver allows.
    #[error("{what} is {size}x{size}, more than the driver's limit of {limit}: choose a smaller one")]
    TooLarge { what: String, size: u32, limit: u32 },
    /// A pass binds more textures than the driver allows.
    #[error("the lit pass needs {needed} textures at once, the driver has {limit}: use fewer lights, maps or images")]
    TooManyInputs { needed: usize, limit: u32 },
    /// Too many lights are guarded by clip planes.
    #[error(
        "guard = \"clip-plane\" (lights {lights:?}): at most {most} lights can have it, because surfaces across all their planes are drawn once for each combination of sides. Choose another guard for the others."
    )]
    TooManyCuts { lights: Vec<usize>, most: usize },
    /// `--after-pass` names no pass of the plan.
    #[error("--after-pass {wanted}: the plan has no such pass; it has {names}")]
    NoPassAfter { wanted: String, names: String },
    /// `--after-pass` names a pass before the first of the picture.
    #[error(
        "--after-pass {number}: \"{label}\" comes before the picture has anything in it; passes that draw into it are {names}"
    )]
    BeforePicture { number: usize, label: String, names: String },
    /// A request names a pass that the plan does not have.
    #[error("--shaders {wanted}: no pass has that in its name; the passes are {names}")]
    NoSuchPass { wanted: String, names: String },
}

/// Plans one frame of `scene`.
///
/// # Errors
///
/// Lights that cannot be drawn together, a view of a light or map that is not there, an image beyond the driver's limits.
pub fn make(scene: &Scene, request: &Request) -> Result<Plan, Error> {
    make_with(scene, request, &Derived::default())
}

/// The same, where `derived` keeps from plan to plan what is expensive to find again. A [`crate::frame::Renderer`] has one.
///
/// # Errors
///
/// As [`make`].
#[doc(hidden)]
pub fn make_with(scene: &Scene, request: &Request, derived: &Derived) -> Result<Plan, Error> {
    derived.forget_dropped();
    let near = scene.brought_near();
    let mut plan = compose::compose(near.as_ref().unwrap_or(scene), request, derived)?;
    plan.matrices.moved = near.map_or(DVec3::ZERO, |near| near.camera.eye - scene.camera.eye);
    prune::prune(&mut plan, request);
    plan.check(&request.limits)?;
    Ok(plan)
}

impl Plan {
    /// Checks that a driver with these limits can draw it.
    ///
    /// # Errors
    ///
    /// An image that is too large, or a pass with too many textures.
    pub fn check(&self, limits: &Limits) -> Result<(), Error> {
        for desc in &self.list.images {
            let size = desc.size[0].max(desc.size[1]);
            if size > limits.max_image_size {
                return Err(Error::TooLarge { what: desc.label.clone(), size, limit: limits.max_image_size });
            }
        }
        let needed = self.list.passes.iter().map(|pass| pass.most_inputs()).max().unwrap_or(0);
        if needed > limits.max_inputs as usize {
            return Err(Error::TooManyInputs { needed, limit: limits.max_inputs });
        }
        Ok(())
    }
}

/// A plan as `--json` prints it.
#[doc(hidden)]
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Passes in their order.
    pub passes: Vec<PassSummary>,
    /// Images of all passes.
    pub images: Vec<ImageSummary>,
    /// Bytes of all images.
    pub image_bytes: u64,
    /// Vertex and index buffers: each attribute and index order of each mesh that a draw reads, once.
    pub buffer_bytes: u64,
    /// As [`Plan::left_out`].
    pub left_out: Vec<LeftOut>,
    /// As [`Plan::chosen`].
    pub chosen: Vec<Chosen>,
    /// As [`Plan::warnings`].
    pub warnings: Vec<String>,
}

/// A pass in words and numbers.
#[doc(hidden)]
#[derive(Debug, Serialize)]
pub struct PassSummary {
    /// Label, unique in the plan.
    pub label: String,
    /// `every frame` or `once`.
    pub redraw: &'static str,
    /// Images that it draws into, with their formats.
    pub target: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Draw state in words; most of what is at GL's default is not named.
    pub state: Vec<String>,
    /// Programs with their defines, each once.
    pub shaders: Vec<String>,
    /// Sampled images, each once.
    pub inputs: Vec<String>,
    /// Draws, one line each.
    pub draws: Vec<String>,
    /// Number of draws.
    pub draw_calls: usize,
    /// Number of triangles; lines do not count.
    pub triangles: u64,
}

/// An image in words and numbers.
#[doc(hidden)]
#[derive(Debug, Serialize)]
pub struct ImageSummary {
    /// Label, unique in the plan.
    pub label: String,
    /// Internal format without `GL_`, e.g. `DEPTH_COMPONENT24`.
    pub format: String,
    /// Width and height in texels, of the largest level.
    pub size: [u32; 2],
    /// Bytes of all texels, faces and mipmaps included.
    pub bytes: u64,
}

/// Bytes of all texels, mipmaps included.
pub(crate) fn image_bytes(format: Format, size: [u32; 2], mipmapped: bool) -> u64 {
    let base = format.bytes() * u64::from(size[0]) * u64::from(size[1]);
    if mipmapped { base * 4 / 3 } else { base }
}
