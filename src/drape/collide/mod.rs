//! What keeps cloth from passing through itself and through other things.
//!
//! | file | what it does |
//! |---|---|
//! | [`colliders`], [`mesh`] | what the cloth falls on |
//! | [`topology`] | corners, edges and triangles of the cloth |
//! | [`boxes`], [`tree`], [`near`] | what may touch in a step |
//! | [`distance`], [`ccd`] | how far apart two things are, and when they first touch |
//! | [`filter`] | moves in which nothing touches |

pub mod boxes;
pub mod ccd;
pub mod colliders;
pub mod distance;
pub mod filter;
pub mod mesh;
pub mod near;
pub mod topology;
pub mod tree;
