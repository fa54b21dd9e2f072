//! Elements, blocks, assembly and loads against independent computations.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod assembly;
mod blocks;
mod common;
mod grids;
mod loads;
mod locking;
mod meshes;
mod plane;
mod projected;
mod quadratic;
mod shape_bounds;
mod shapes;
mod surfaces;
