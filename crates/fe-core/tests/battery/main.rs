//! Elements, blocks, assembly and loads against independent computations.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod assembly;
mod blocks;
mod common;
mod grids;
mod loads;
mod meshes;
mod plane;
mod quadratic;
mod shape_bounds;
mod shapes;
mod surfaces;
