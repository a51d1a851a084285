//! Draped cloth.
#![allow(missing_docs)]
mod build;
pub mod collide;
pub mod contact;
pub mod crease;
pub mod drape;
pub mod exact;
pub mod explicit;
pub mod hand;
mod implicit;
pub mod lattice;
pub mod limit;
pub mod links;
pub mod material;
pub mod pcg;
pub mod pins;
pub mod plugin;
pub mod response;
pub mod rows;
pub mod scenes;
pub mod spec;
pub mod surface;
pub mod system;
pub mod weights;
pub mod wind;
pub mod yarns;
