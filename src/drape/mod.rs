//! Draped cloth: it hangs, falls over a ball or a table, wrinkles and holds a crease (paper C, after Choi and
//! Ko 2002 and Lander; model section 8).
//!
//! | file | what it does |
//! |---|---|
//! | [`spec`], [`scenes`] | what a drape is in RON, and the bundled ones |
//! | `build` | from there to a cloth that can move |
//! | [`material`], [`weights`] | measured properties of cloth, and masses and links made of them |
//! | [`lattice`], [`links`] | which particles are linked, and the force laws of single links |
//! | [`response`] | forces and Jacobians of all links |
//! | [`crease`] | folds that keep their side |
//! | [`explicit`], `implicit` | steps of time: forward Euler and Runge–Kutta, backward Euler and BDF2 |
//! | [`system`], [`pcg`], [`yarns`] | the linear system of an implicit step, conjugate gradients, their preconditioner |
//! | [`contact`], [`collide`] | what is close pushes back and rubs; nothing passes through anything |
//! | [`limit`] | yarns lock |
//! | [`wind`], [`pins`], [`hand`] | air, what holds the cloth, hands that draw at it |
//! | [`drape`](mod@drape) | the cloth in motion |
//! | [`surface`] | what is drawn |
//! | [`exact`] | whether anything passes through anything, without rounding errors |
//! | [`plugin`] | all of it in a Bevy app |
//! | [`rows`] | how the particles' numbers lie in memory |
//!
//! Metres, seconds, kilograms; y is up. `docs/drape.md` has what was measured.

mod build;
pub mod collide;
pub mod contact;
pub mod crease;
#[allow(clippy::module_inception)] // `drape::Drape` is the drape itself.
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
