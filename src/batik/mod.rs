//! Batik: wax keeps dye from cloth, breaks, and lets it in along its cracks.
//!
//! Paper B (batik by diffusion, 2016), and what it takes from elsewhere. `docs/batik.md` has the
//! model, the proofs and what it costs. All of it is plain functions; from a drawing to a picture:
//!
//! | step | what | where |
//! |---|---|---|
//! | 1 | a drawing becomes wax: I, 0 waxed to 1 open | [`drawing`] |
//! | 2 | the wax breaks | [`crackle`] |
//! | 3 | how well it lets dye through: p | [`permeation`] |
//! | 4 | what the cells of the cloth exchange | [`sweep::Exchange`] |
//! | 5 | the bath: dye comes in, moves and binds, scan by scan | [`sweep::PixelDiffusing`] |
//! | 6 | several dyes make one colour | [`mixing`] |
//! | 7 | the cloth is seen: ellipses where yarns cross | [`ellipse`], [`crossings`], [`picture`] |
//! | 8 | and the wax on it, until it is boiled off | [`wax`] |
//!
//! Fields have one value a position `(y, x)`, row 0 at the top, or one a cell `(layer, y, x)`, as
//! everywhere. Lengths are in cells.
//!
//! The permeation map is also what lets dye through under the solvers of paper D's model: it is the
//! shape of a bath ([`SupplySpec::Bath`](crate::scenario::SupplySpec)).

pub mod crackle;
pub mod crossings;
pub mod distance;
pub mod drawing;
pub mod ellipse;
pub(crate) mod keep;
pub mod mixing;
mod noise;
pub mod permeation;
pub mod picture;
pub mod recipe;
pub mod stage;
pub mod sweep;
pub mod wax;

#[cfg(test)]
mod tests;
