//! The cloth meets other things and itself.
#![allow(missing_docs)]
pub mod boxes;
pub mod ccd;
pub mod colliders;
pub mod distance;
pub mod filter;
pub mod mesh;
pub mod near;
pub mod topology;
pub mod tree;
