//! One update of one cell (paper B eqs 2 and 3), and the γ with which it keeps its bounds.
//!
//! ```text
//! f ← f + γ·[ Σ_j w_ij·(f_j − f) + s − a ],   h ← h + γ·a
//! s = α·p·(M_s − f),   a = α_d·(a_d − h)·f
//! ```
//!
//! **Bounds.** Let W = Σ_j w_ij. For f, f_j, M_s in 0…1 and h in 0…a_d the bracket lies between
//! −f·(W + αp + α_d·a_d) and (1 − f)·(W + αp), so f stays in 0…1 whenever
//!
//! ```text
//! γ·(W + α·p + α_d·a_d) ≤ 1   in every cell,
//! ```
//!
//! and h grows by γ·α_d·f ≤ 1 times what is missing from a_d, so h stays in 0…a_d. The γ here is the
//! largest one that meets this in every cell, less one part in 2²⁰, and never more than that below 1
//! (B: 0 < γ < 1). That part is more than rounding takes: the terms that push towards a bound are off
//! by at most eleven parts in 2²⁴ altogether, those of the other sign only help, and 0 and 1 are
//! numbers that no sum below them rounds past. B's truncation to 0…1 is kept, and counted: it never
//! acts.
//!
//! **Ledger.** B's h grows by a while f loses γ·a, so dye would be made; here both move γ·a
//! (**choice**; it only rescales α_d). An update in place changes one side of a face at a time: the
//! dye that a sweep makes or loses on a face is γ·w times the change of the side that comes first,
//! and is booked as such.

use super::{BathSpec, Exchange};

/// The numbers of an update that are the same everywhere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    pub gamma: f32,
    /// M_s.
    pub bath: f32,
    /// α_d.
    pub binding: f32,
    /// a_d.
    pub most_bound: f32,
}

/// What is left below the largest γ for rounding: one part in 2²⁰.
const MARGIN: f64 = 1.0 / 1_048_576.0;

impl Rule {
    /// The rule of a bath. `supply` is α·p of every position.
    pub fn new(exchange: &Exchange, supply: &[f32], bath: &BathSpec) -> Self {
        let nx = exchange.nx;
        let drained = |i: usize| {
            let (y, x) = (i / nx, i % nx);
            let most = exchange.sum(0, y, x).max(exchange.sum(1, y, x));
            most + f64::from(supply[i])
        };
        let most = (0..supply.len()).map(drained).fold(0.0, f64::max);
        let stiffest = most + f64::from(bath.binding as f32) * f64::from(bath.most_bound as f32);
        // A number of 32 bits that is not above the one of 64.
        let gamma = (1.0 - MARGIN) / stiffest.max(1.0);
        Rule {
            gamma: (gamma as f32).min(1.0 - MARGIN as f32),
            bath: bath.concentration as f32,
            binding: bath.binding as f32,
            most_bound: bath.most_bound as f32,
        }
    }
}

/// A cell and what is around it.
pub(super) struct Around {
    pub f: f32,
    pub h: f32,
    /// f to the left, right, above, below, and in the other layer.
    pub others: [f32; 5],
    /// What is exchanged with each of them.
    pub weights: [f32; 5],
    /// α·p.
    pub supply: f32,
}

/// A cell after an update.
pub(super) struct Updated {
    pub f: f32,
    pub h: f32,
    /// s: what the bath gave, before γ.
    pub supplied: f32,
    /// Whether f had to be truncated.
    pub truncated: bool,
}

/// One update of one cell. Both orders of computing a sweep use it, so both give the same bits.
#[inline(always)]
pub(super) fn update(rule: &Rule, cell: Around) -> Updated {
    let Around {
        f,
        h,
        others,
        weights,
        supply,
    } = cell;
    let mut flow = weights[0] * (others[0] - f);
    for side in 1..5 {
        flow += weights[side] * (others[side] - f);
    }
    let supplied = supply * (rule.bath - f);
    let bound = rule.binding * (rule.most_bound - h) * f;
    let next = f + rule.gamma * (flow + supplied - bound);
    let truncated = next.clamp(0.0, 1.0);
    Updated {
        f: truncated,
        h: h + rule.gamma * bound,
        supplied,
        truncated: truncated != next,
    }
}
