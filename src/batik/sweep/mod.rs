//! Pixel diffusing: dye moves through waxed cloth in sweeps (paper B §3.2, §3.4, eqs 1 to 5).
//!
//! The cloth is two layers of cells; the wax over both of them lets the bath through as far as it is
//! permeable. Dye flows between neighbours, comes in from the bath and binds to fibre. One **scan**
//! is two sweeps that change cells in place: from the top left to the bottom right, at every
//! position first the warp and then the weft, and back again the other way round.
//!
//! A sweep in place is a sequence: every cell needs the one to its left and the one above it to be
//! done. [`PixelDiffusing`] does many cells at a time in an order that gives the same bits, in
//! vectors along diagonals and in tiles on all cores; [`plain::scan`] is the loop itself.

mod exchange;
pub mod plain;
mod rule;
#[cfg(test)]
mod tests;
mod tile;
mod tiles;

pub use exchange::{Classes, Exchange, ExchangeSpec};
use serde::{Deserialize, Serialize};
pub use tiles::PixelDiffusing;

/// A bath of dye.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BathSpec {
    /// M_s: its concentration, 0 to 1.
    pub concentration: f64,
    /// α: how much of what is missing comes in through open wax in one update, 0 to ½.
    pub supply: f64,
    /// α_d: how fast dye binds, 0 to 1.
    pub binding: f64,
    /// a_d: the most dye that fibre binds, in units of the most free dye.
    pub most_bound: f64,
}

impl Default for BathSpec {
    fn default() -> Self {
        BathSpec {
            concentration: 1.0,
            supply: 0.5,
            binding: 0.1,
            most_bound: 0.5,
        }
    }
}

/// Dye of the cloth: free dye f and bound dye h of every cell, in the order `(layer, y, x)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Dye {
    /// f, 0 to 1.
    pub free: Vec<f32>,
    /// h, 0 to a_d.
    pub bound: Vec<f32>,
}

impl Dye {
    /// No dye, on a cloth of `nx` by `ny` cells.
    pub fn none(nx: usize, ny: usize) -> Self {
        Dye {
            free: vec![0.0; 2 * nx * ny],
            bound: vec![0.0; 2 * nx * ny],
        }
    }

    /// All dye, in units of the most free dye of a cell.
    pub fn total(&self) -> f64 {
        let sum = |field: &[f32]| field.iter().map(|v| f64::from(*v)).sum::<f64>();
        sum(&self.free) + sum(&self.bound)
    }
}

/// What sweeps have done so far, in units of the most free dye of a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Account {
    /// What the bath has given.
    pub supplied: f64,
    /// What updates in place have made (or, below 0, lost): they change one side of a flow before
    /// the other.
    pub made: f64,
    /// How often f had to be truncated to 0…1.
    pub truncated: u64,
}
