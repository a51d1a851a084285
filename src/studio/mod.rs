//! The studio: draped cloth in the light, for the recorder and for the window.
//!
//! | file | what it does |
//! |---|---|
//! | [`fine`] | the surface between the particles |
//! | [`hung`] | the cloth of an experiment, settled, and its movement |
//! | [`camera`] | where the camera stands |
//! | [`gltf`] | the cloth as a file for modelling programs |
//! | [`mips`] | pictures that are seen from afar |
//! | `cloth` | both sides of the cloth: meshes, pictures, normal maps |
//! | `things` | what the cloth falls on, and what it hangs from |
//! | `light` | soft light, and the ground |
//! | `offscreen` | frames without a window |
//!
//! What needs a graphics driver is only there with the feature `viewer`.

pub mod camera;
#[cfg(feature = "viewer")]
pub mod cloth;
pub mod fine;
pub mod gltf;
pub mod hung;
#[cfg(feature = "viewer")]
pub mod light;
pub mod mips;
#[cfg(feature = "viewer")]
pub mod offscreen;
#[cfg(feature = "viewer")]
pub mod things;
