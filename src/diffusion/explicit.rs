//! The explicit solver, the reference: forward Euler in paper D's time step (eq 2).
//!
//! In pore-concentration form (model section 2) every cell changes by
//!
//! V_u,i · Δc_i = Σ_j G_ij · ρ_ij · (c_j − c_i),   G_ij = Δt/Δd² · D_ij · min(V_u,i , V_u,j)
//!
//! over its five neighbours. What one cell loses through a face the other gains, to the last bit,
//! since c_j − c_i only changes sign; so dye is conserved up to the rounding of c itself.
//!
//! **Bounds.** With a_ij = G_ij/V_u,i and Σ_j a_ij ≤ 1, c_i moves towards a mean of its neighbours
//! and never past it. [`Conductances`](super::Conductances) splits a step until
//! Σ_j a_ij ≤ 1 − 2⁻¹⁶; that margin is larger than every rounding error of the sum below, and
//! rounding is monotone, so 0 ≤ c ≤ 1 holds in float32 without any clamp.

use rayon::prelude::*;

use super::Conductances;

/// How the face between two cells passes dye.
trait Passage: Copy + Sync {
    /// The amount that passes to a cell with concentration `here` from one with `there`.
    fn flow(self, conductance: f32, here: f32, there: f32) -> f32;
}

/// ρ = 1: Fick's law alone.
#[derive(Clone, Copy)]
struct Fick;

impl Passage for Fick {
    #[inline(always)]
    fn flow(self, conductance: f32, here: f32, there: f32) -> f32 {
        conductance * (there - here)
    }
}

/// ρ = min(1, φ₀/c̄) with c̄ the mean of both sides (Weisz–Zollinger, paper D eq 4; model section 2).
#[derive(Clone, Copy)]
struct WeiszZollinger {
    equilibrium: f32,
}

impl Passage for WeiszZollinger {
    #[inline(always)]
    fn flow(self, conductance: f32, here: f32, there: f32) -> f32 {
        let mean = 0.5 * (here + there);
        // At c̄ = 0 the quotient is infinite and the minimum 1.
        conductance * (self.equilibrium / mean).min(1.0) * (there - here)
    }
}

/// Concentrations below this round to nothing.
///
/// Ahead of the dye, Fick's law makes ever smaller numbers, and processors are a hundred times
/// slower with the smallest of all (subnormal) than with any other. What is rounded away here is
/// far below the last bit of any cell that could be seen: a cloth of a billion cells loses less
/// than 10⁻¹⁵ of one cell a step.
const NOTHING: f32 = 1e-24;

#[inline(always)]
fn settle(c: f32) -> f32 {
    if c < NOTHING { 0.0 } else { c }
}

/// Cells that one task advances: larger tasks leave a core idle at the end of a step, smaller ones
/// cost more in handing out than in computing.
const CELLS_A_TASK: usize = 1 << 14;

/// Advances the concentration of free dye `now` by one (split) step into `next`.
///
/// Both hold `(layer, y, x)`. The result does not depend on the number of threads: every cell is
/// computed from `now` alone.
pub fn step(conductances: &Conductances, equilibrium: f64, now: &[f32], next: &mut [f32]) {
    if equilibrium < 1.0 {
        let passage = WeiszZollinger {
            equilibrium: equilibrium as f32,
        };
        advance(conductances, passage, now, next);
    } else {
        advance(conductances, Fick, now, next);
    }
}

fn advance<P: Passage>(conductances: &Conductances, passage: P, now: &[f32], next: &mut [f32]) {
    let nx = conductances.grid.nx;
    let (weft, warp) = next.split_at_mut(conductances.grid.layer_len());
    let rows_a_task = (CELLS_A_TASK / (2 * nx)).max(1);
    let advance_rows = |(task, (weft, warp)): (usize, (&mut [f32], &mut [f32]))| {
        let rows = weft.chunks_exact_mut(nx).zip(warp.chunks_exact_mut(nx));
        for (i, (weft, warp)) in rows.enumerate() {
            let y = task * rows_a_task + i;
            advance_row(&Row::new(conductances, now, 0, y), passage, weft);
            advance_row(&Row::new(conductances, now, 1, y), passage, warp);
        }
    };
    let tasks = weft
        .par_chunks_mut(rows_a_task * nx)
        .zip(warp.par_chunks_mut(rows_a_task * nx))
        .enumerate();
    if tasks.len() == 1 {
        advance_rows((0, (weft, warp)));
    } else {
        tasks.for_each(advance_rows);
    }
}

/// Everything that one row of one layer is computed from; each slice is one row long.
struct Row<'a> {
    here: &'a [f32],
    north: &'a [f32],
    south: &'a [f32],
    beside: &'a [f32],
    east_g: &'a [f32],
    north_g: &'a [f32],
    south_g: &'a [f32],
    beside_g: &'a [f32],
    per_capacity: &'a [f32],
}

impl<'a> Row<'a> {
    fn new(conductances: &'a Conductances, now: &'a [f32], layer: usize, y: usize) -> Self {
        let grid = conductances.grid;
        let row = |field: &'a [f32], layer: usize, y: usize| {
            &field[(layer * grid.ny + y) * grid.nx..][..grid.nx]
        };
        let first = y == 0;
        // Beyond the edge of the cloth stands the row itself: no difference, no flow.
        let above = if first { y } else { y - 1 };
        let below = if y + 1 == grid.ny { y } else { y + 1 };
        Row {
            here: row(now, layer, y),
            north: row(now, layer, above),
            south: row(now, layer, below),
            beside: row(now, 1 - layer, y),
            east_g: row(&conductances.east, layer, y),
            north_g: row(&conductances.south, layer, above),
            south_g: row(&conductances.south, layer, y),
            beside_g: row(&conductances.beside, 0, y),
            per_capacity: row(&conductances.per_capacity, layer, y),
        }
    }
}

/// Computes one row. The terms are added in pairs of opposite neighbours, so that a mirrored cloth
/// gives exactly the mirrored result.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance_row<P: Passage>(row: &Row, passage: P, next: &mut [f32]) {
    let n = next.len();
    next[0] = row.end(passage, 0);
    next[n - 1] = row.end(passage, n - 1);
    if n < 3 {
        return;
    }
    // Between the ends every neighbour exists. Slices of one length, shifted against each other,
    // let the compiler drop every bounds check and use whole vectors.
    let m = n - 2;
    let (west, here, east) = (&row.here[..m], &row.here[1..][..m], &row.here[2..][..m]);
    let (west_g, east_g) = (&row.east_g[..m], &row.east_g[1..][..m]);
    let (north, north_g) = (&row.north[1..][..m], &row.north_g[1..][..m]);
    let (south, south_g) = (&row.south[1..][..m], &row.south_g[1..][..m]);
    let (beside, beside_g) = (&row.beside[1..][..m], &row.beside_g[1..][..m]);
    let per_capacity = &row.per_capacity[1..][..m];
    let next = &mut next[1..][..m];
    for x in 0..m {
        let c = here[x];
        let across = passage.flow(west_g[x], c, west[x]) + passage.flow(east_g[x], c, east[x]);
        let down = passage.flow(north_g[x], c, north[x]) + passage.flow(south_g[x], c, south[x]);
        let beside = passage.flow(beside_g[x], c, beside[x]);
        next[x] = settle(c + per_capacity[x] * ((across + down) + beside));
    }
}

impl Row<'_> {
    /// The cell at one end of the row, whose neighbour beyond the edge of the cloth is missing.
    fn end<P: Passage>(&self, passage: P, x: usize) -> f32 {
        let c = self.here[x];
        let west = match x.checked_sub(1) {
            Some(w) => passage.flow(self.east_g[w], c, self.here[w]),
            None => 0.0,
        };
        let east = match self.here.get(x + 1) {
            Some(east) => passage.flow(self.east_g[x], c, *east),
            None => 0.0,
        };
        let down = passage.flow(self.north_g[x], c, self.north[x])
            + passage.flow(self.south_g[x], c, self.south[x]);
        let beside = passage.flow(self.beside_g[x], c, self.beside[x]);
        settle(c + self.per_capacity[x] * (((west + east) + down) + beside))
    }
}
