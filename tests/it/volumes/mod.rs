//! Shadow volumes on the CPU, without GL: closure, counts against brute force and against the ray tracer, caps.

mod closure;
mod counts;
pub mod homogeneous;
mod near_plane;
mod oracle;
mod seen;
pub mod shapes;
