//! Shadow volumes on the CPU, without GL: closure, counts against brute force and against the ray tracer, caps.

mod closure;
mod counts;
mod homogeneous;
mod near_plane;
mod oracle;
#[path = "../oracle/scenes.rs"]
#[allow(dead_code)]
mod scenes;
mod seen;
mod shapes;
