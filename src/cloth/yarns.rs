//! The yarns of one direction: where each lies, and how it differs from its neighbours.
//!
//! Paper D gives every yarn a small random variation ("0.5r", r ∈ U(0.5, 1), one r a yarn).

use crate::chance::{Chance, Purpose};
use crate::scenario::YarnSpec;

/// What one yarn is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yarn {
    /// P: the share of the yarn that is pores, 0 to 1.
    pub porosity: f64,
    /// τ₁: 1 where the fibres lie straight, towards 0 the harder the yarn is twisted.
    pub twist: f64,
    /// B: how far this yarn is squeezed, 0 to 1.
    pub squeeze: f64,
}

/// The yarns of one direction, side by side: `width` cells of yarn, `gap` cells of gap, again and
/// again from the left (warp) or the top (weft).
#[derive(Debug, Clone, PartialEq)]
pub struct Yarns {
    /// Cells across one yarn.
    pub width: usize,
    /// Cells between one yarn and the next.
    pub gap: usize,
    /// Every yarn of the cloth, in order.
    pub yarns: Vec<Yarn>,
}

/// The random choices of one direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Draws {
    pub porosity: Purpose,
    pub twist: Purpose,
    pub squeeze: Purpose,
}

impl Yarns {
    /// Lays yarns side by side over `cells` cells.
    pub(super) fn lay(
        spec: &YarnSpec,
        cell_mm: f64,
        cells: usize,
        chance: Chance,
        draws: Draws,
    ) -> Self {
        let width = spec.width.whole_cells(cell_mm).max(1);
        let gap = spec.gap.whole_cells(cell_mm);
        // Each property draws from its own sequence, so that varying one leaves the others alone.
        let mut porosity = chance.sequence(draws.porosity);
        let mut twist = chance.sequence(draws.twist);
        let mut squeeze = chance.sequence(draws.squeeze);
        let yarns = (0..cells.div_ceil(width + gap))
            .map(|_| Yarn {
                porosity: spec.porosity * porosity.between(spec.vary_porosity),
                twist: spec.twist * twist.between(spec.vary_twist),
                squeeze: squeeze.between(spec.squeeze),
            })
            .collect();
        Yarns { width, gap, yarns }
    }

    /// Cells from one yarn to the next.
    pub fn pitch(&self) -> usize {
        self.width + self.gap
    }

    /// The number of the cloth cell, and so of the yarn, at a position across the yarns.
    pub fn number(&self, across: usize) -> usize {
        across / self.pitch()
    }

    /// The yarn at a position across the yarns; none in a gap.
    pub fn at(&self, across: usize) -> Option<&Yarn> {
        let within = across % self.pitch();
        (within < self.width).then(|| &self.yarns[self.number(across)])
    }
}
