//! Judges pictures of a light's shadow: pixel by pixel against exact visibility, by whichever renderer they are.
//!
//! A pixel counts if the ray tracer is certain and the picture shows the same surface. A wrong pixel is *explained* if a
//! stated [`Bound`] accounts for it, and otherwise *beyond the bound*.
//!
//! # Bounds
//! - **No map** ([`Bound::Exact`]: shadow volumes, ray tracing): no pixel may be wrong. The ray tracer's certainty then grants
//!   a depth buffer's rounding, too.
//! - **A shadow map of glumbra's own plan** ([`Bound::Map`]): only surfaces that face the light count; on the others shading
//!   leaves no light. A wrong pixel is explained in four ways, all by the map's own numbers ([`MapInfo`]) and the scene:
//!   1. A silhouette or an open edge, as the light sees it, lies within a lookup's reach (the *band*). An edge of the
//!      visible surface itself counts if a texel holds the middle of two layers: past it the second one lies far behind.
//!   2. The pixel is dark, and a caster within that reach lies before the visible surface's plane (a crease).
//!   3. The pixel is dark, and a less steep surface within that reach is nearer to the light than its own polygon offset
//!      compensates: an offset uses the slope of the surface that is stored, not of the one that is compared.
//!   4. The pixel is lit, and its caster in the map lies so close before it that the bias reaches across.
//!
//!   For a midpoint map, instead of 2 and 3: the pixel is dark, and somewhere within that reach the middle between two
//!   layers lies before it. So thin a caster shades its own lit side, where it falls away from the light.
//! - **Another renderer** ([`Bound::Band`]), whose map is unknown: only surfaces that face the light count. A wrong pixel is
//!   explained if a true shadow edge passes within so many pixels of it in the picture, or a silhouette, as the light sees it,
//!   within as many on its surface: the edge may be hidden.
//!
//! A surface where the truth has none, or the other way around, is beyond every bound but a band, which explains one pixel
//! along silhouettes.
//!
//! # Files
//! `light.rs` judges a picture, `bound.rs` explains a map's wrong pixels, `near.rs`, `band.rs` and `edges.rs` know true shadow
//! edges. `places.rs` says where a picture is wrong, `mistakes.rs` and `color_mistakes.rs` whether it only lies wrong.
//! `metrics.rs` has a report's shares and distances of edges, `difference.rs` draws them. `colors.rs` compares colours.
//! `truth_pictures.rs` makes the views `truth` and `difference`.
//!
//! ```
//! use glumbra::judge::{Bound, Judge};
//! use glumbra::{context, frame::Renderer, frame::draw_shade};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let size = ["light.shadow.size=1024".to_owned()];
//! let scene = glumbra::load("data/cases/scenes/box.toml".as_ref(), &size)?.scene;
//! // The picture may come from any renderer: 0 shadowed, 1 lit.
//! let mut renderer = Renderer::new(&context::open(&Default::default())?);
//! let shade = draw_shade(&scene, 0, &mut renderer)?;
//!
//! let mut judge = Judge::new(&scene, 0)?;
//! let found = judge.shade(&shade, &Bound::Band { pixels: 3.0 })?;
//! assert!(found.compared > 10_000 && found.share(found.wrong()) < 0.01);
//! // Right under an edge of the box, the map's texels see its top.
//! assert!(found.outside_band <= 10, "{} pixels are wrong far from any edge", found.outside_band);
//! # Ok(())
//! # }
//! ```

mod band;
mod bound;
mod color_mistakes;
#[doc(hidden)]
pub mod colors;
#[doc(hidden)]
pub mod difference;
mod edges;
mod light;
#[doc(hidden)]
pub mod metrics;
mod mistakes;
mod near;
mod pictured;
mod places;
#[doc(hidden)]
pub mod truth_pictures;
mod verdicts;

pub use bound::{Bound, MOST_WRONG};
#[doc(hidden)]
pub use color_mistakes::color_mistake;
pub use light::Judge;
#[doc(hidden)]
pub use mistakes::{FoundMistake, Mistake};
#[doc(hidden)]
pub use pictured::shade_of_pictures;
#[doc(hidden)]
pub use places::WrongRegion;
#[doc(hidden)]
pub use verdicts::Explanation;
pub use verdicts::{Judgement, PixelClass};

#[cfg(doc)]
use crate::lights::MapInfo;
