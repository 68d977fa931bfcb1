//! Stencil shadow volumes on the CPU: adjacency, possible silhouettes, extrusion and caps, without GL and without a scene
//! [GDC, "Computing Shadow Volumes For Polygonal Models", "Near Clip Plane Capping Cases"].
//!
//! A caster's volume is a sum of prisms: for each *counted* triangle the points q + t (q - light), q on the triangle,
//! t >= 0. How often the sum holds a point is the number of counted triangles that the segment from the light to the
//! point crosses. [`Caster`] is what depends on the mesh alone, [`Outline`] on the light as well, [`Volume`] and
//! [`CappedVolume`] are triangles to draw.
//!
//! # Which triangles count
//! A caster falls into shells (triangles connected across edges). One that is closed, looks outwards, does not enclose
//! the light and is not touched by it is counted by its light-facing triangles ([`CountedFaces::Facing`]): every way in
//! crosses one of them.
//! Any other shell (open, non-manifold, inconsistently wound, inside out, around the light) is counted by all of its
//! triangles, averted ones turned over ([`CountedFaces::All`]), so that an open mesh casts from both its sides. A triangle
//! in whose plane the light stands never counts.
//!
//! # Why it is watertight
//! Sides stand on the boundary of the chain of counted triangles, edge by edge with signed integer multiplicity
//! [Aldridge 2004; Kim 2008], and all parts share the welded vertices; so the boundary of caps and sides together cancels edge by
//! edge, whatever the mesh is. Facing is decided by exact predicates.
//!
//! # How orientation is to be read
//! All work is done in model space with the light transformed there. Triangles run counter-clockwise seen from outside
//! their volume *in model space*: under a mirroring transform front faces run clockwise, as they do for the mesh itself.

mod caster;
mod components;
mod counting;
mod edges;
mod extrude;
mod key_planes;
mod loops;
mod near_cap;
mod near_plane;
mod outline;
mod planes;
mod seen;
mod source;

pub use caster::Caster;
pub use components::{Component, CountedFaces, SurfaceKind};
pub use extrude::{Caps, Extent, Volume, light_touches};
pub use key_planes::{KeyPlanes, PlaneBlend};
pub use loops::OutlineEdge;
pub use near_cap::{CappedVolume, Landing};
pub use outline::Outline;
pub use seen::{CameraHulls, VolumeHulls, scissor};
pub use source::LightSource;
