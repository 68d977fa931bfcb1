//! Shadow volumes counted by GL, held against the oracle's counts: exact at every pixel outside its band.

mod animated;
mod closure;
mod count;
mod lights;
mod meshes;
mod positions;
