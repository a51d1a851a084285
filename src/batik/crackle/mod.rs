//! Crackle: the veins of dye where wax broke.
//!
//! Cracks grow over the distance field of the wax (Wyvill, van Overveld, Carpendale, *Rendering
//! Cracks in Batik*, NPAR 2004): a crack runs both ways from a place in the wax, first for where the
//! distance to all cracks and open areas is greatest and then across to them, and is itself part of
//! the field from then on. Three things of real cloth are added:
//!
//! - **Folds.** The first cracks come from folding the cloth. They run long and nearly straight,
//!   through open areas and into the wax beyond, and may cross each other.
//! - **Generations.** A later crack ends on earlier ones, at nearly right angles, and is thinner; the
//!   old ones have been worked wider, most of all where another one ends.
//! - **Crumpling.** Where the cloth was crumpled more, cracks are denser.
//!
//! Lengths are in cells; a cell's middle is at half numbers.

mod course;
mod crumple;
mod draw;
mod field;
mod grow;
mod network;
#[cfg(test)]
mod tests;

pub use network::{Crack, End, Network};

use crate::chance::Chance;
use crate::pattern::Raster;
use serde::{Deserialize, Serialize};

/// A point on the cloth, across and down, in cells from its top left corner.
pub type Point = [f32; 2];

/// How wax breaks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CrackleSpec {
    /// Length of all cracks over the area of the wax, per cell: meshes are about 2 / density cells
    /// wide. 0 for wax that does not break.
    pub density: f64,
    /// How wide the first cracks are, cells; less than one is drawn as faint as it is thin.
    pub width: f64,
    /// Width of each generation over that of the one before, 0 to 1.
    pub thinning: f64,
    /// How much cracks stray from their way: 0 smooth and straight, 1 ragged.
    pub jitter: f64,
    /// The share of all cracks' length that is folds, 0 to 1.
    pub folds: f64,
    /// The direction of most folds, degrees: 0 across the cloth, 90 down. None for folds of any
    /// direction.
    pub direction: Option<f64>,
    /// How unevenly the cloth was crumpled: 0 evenly, 1 hardly at all in places.
    pub crumple: f64,
    /// The size of what was crumpled together, cells.
    pub crumple_size: f64,
}

impl Default for CrackleSpec {
    fn default() -> Self {
        CrackleSpec {
            density: 0.022,
            width: 1.4,
            thinning: 0.75,
            jitter: 0.6,
            folds: 0.3,
            direction: None,
            crumple: 0.6,
            crumple_size: 220.0,
        }
    }
}

/// Cracked wax.
#[derive(Debug, Clone)]
pub struct Crackle {
    /// The cracks, in the order in which they broke.
    pub network: Network,
    /// How open every cell is for the cracks in it: 0 whole wax, 1 no wax left.
    pub map: Raster,
}

impl Crackle {
    /// Breaks the wax of a drawing (0 waxed, 1 open).
    ///
    /// `crumpled` may say how much the cloth was crumpled, 0 to 1, place by place; else it is chance.
    pub fn grow(
        drawing: &Raster,
        spec: &CrackleSpec,
        crumpled: Option<&Raster>,
        chance: Chance,
    ) -> Self {
        let network = grow::network(drawing, spec, crumpled, chance);
        let map = draw::map(&network, drawing.nx, drawing.ny, chance);
        Crackle { network, map }
    }

    /// The drawing with its cracks: what is open in either is open (0 waxed, 1 open).
    pub fn over(&self, drawing: &Raster) -> Raster {
        let mut both = drawing.clone();
        for (open, crack) in both.values.iter_mut().zip(&self.map.values) {
            *open = 1.0 - (1.0 - *open) * (1.0 - crack);
        }
        both
    }
}
