//! The explicit solver, the reference: forward Euler in paper D's time step (eq 2).
//!
//! In pore-concentration form (model section 2) every cell changes by
//!
//! V_u,i · Δc_i = Σ_j G_ij · ρ_ij · (c_j − c_i),   G_ij = Δt/Δd² · D_ij · min(V_u,i , V_u,j)
//!
//! over its five neighbours. What one cell loses through a face the other gains, to the last bit,
//! since c_j − c_i only changes sign; so dye is conserved up to the rounding of c itself.
//!
//! **Carry.** float32 near 1 has steps of 6·10⁻⁸; most cells of a slow process change by less in
//! a step of 1.8 s, and rounding would stop them. So each cell carries on what rounding left over
//! (compensated summation, Kahan 1965): c + carry is what the cell really holds, to about 48 bits,
//! and dye is conserved over any number of steps.
//!
//! **Bounds.** With a_ij = G_ij/V_u,i and Σ_j a_ij ≤ 1, c_i moves towards a mean of its neighbours
//! and never past it. [`Conductances`] splits a step until
//! Σ_j a_ij ≤ 1 − 2⁻¹⁶. That margin is larger than every rounding error of the sum and than the
//! carry, which is at most half a last bit of c; and rounding is monotone. So 0 ≤ c ≤ 1 holds in
//! float32 without any clamp.

use pulp::Scalar;
use rayon::prelude::*;

use super::Conductances;
use super::passage::{Fick, Law, Passage};

/// Concentrations below this round to nothing.
///
/// Ahead of the dye, Fick's law makes ever smaller numbers, and processors are a hundred times
/// slower with the smallest of all (subnormal) than with any other. What is rounded away here is
/// far below the last bit of any cell that could be seen: a cloth of a billion cells loses less
/// than 10⁻¹⁵ of one cell a step.
const NOTHING: f32 = 1e-24;

/// Adds `change` to a concentration and what it carries on; both are returned.
#[inline(always)]
pub(crate) fn add(c: f32, carry: f32, change: f32) -> (f32, f32) {
    let change = change + carry;
    let sum = c + change;
    let left_over = change - (sum - c);
    if sum < NOTHING {
        (0.0, 0.0)
    } else {
        (sum, left_over)
    }
}

/// Cells that one task advances: larger tasks leave a core idle at the end of a step, smaller ones
/// cost more in handing out than in computing.
const CELLS_A_TASK: usize = 1 << 14;

/// Advances the concentration of free dye `now` by one (split) step into `next`.
///
/// All hold `(layer, y, x)`; `carry` is what rounding has left over so far. The result does not
/// depend on the number of threads: every cell is computed from `now` and its own carry alone.
pub fn step(
    conductances: &Conductances,
    equilibrium: f64,
    now: &[f32],
    carry: &mut [f32],
    next: &mut [f32],
) {
    match Law::of(equilibrium) {
        Law::Fick => advance(conductances, Fick, now, carry, next),
        Law::Slowed(law) => advance(conductances, law, now, carry, next),
    }
}

fn advance<P: Passage>(
    conductances: &Conductances,
    passage: P,
    now: &[f32],
    carry: &mut [f32],
    next: &mut [f32],
) {
    let nx = conductances.grid.nx;
    let rows_a_task = (CELLS_A_TASK / (2 * nx)).max(1);
    let cells_a_task = rows_a_task * nx;
    // A task takes the same rows of both layers, which need each other.
    let layer = conductances.grid.layer_len();
    let (weft, warp) = next.split_at_mut(layer);
    let (weft_carry, warp_carry) = carry.split_at_mut(layer);
    let tasks = weft
        .par_chunks_mut(cells_a_task)
        .zip(warp.par_chunks_mut(cells_a_task))
        .zip(weft_carry.par_chunks_mut(cells_a_task))
        .zip(warp_carry.par_chunks_mut(cells_a_task))
        .enumerate();
    tasks.for_each(|(task, (((weft, warp), weft_carry), warp_carry))| {
        for i in 0..weft.len() / nx {
            let (y, cells) = (task * rows_a_task + i, i * nx..(i + 1) * nx);
            let row = Row::new(conductances, now, 0, y);
            advance_row(
                &row,
                passage,
                &mut weft_carry[cells.clone()],
                &mut weft[cells.clone()],
            );
            let row = Row::new(conductances, now, 1, y);
            advance_row(
                &row,
                passage,
                &mut warp_carry[cells.clone()],
                &mut warp[cells],
            );
        }
    });
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
fn advance_row<P: Passage>(row: &Row, passage: P, carry: &mut [f32], next: &mut [f32]) {
    let n = next.len();
    (next[0], carry[0]) = add(row.here[0], carry[0], row.change_at_end(passage, 0));
    if n == 1 {
        return;
    }
    let last = n - 1;
    (next[last], carry[last]) = add(
        row.here[last],
        carry[last],
        row.change_at_end(passage, last),
    );
    if n == 2 {
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
    let (next, carry) = (&mut next[1..][..m], &mut carry[1..][..m]);
    for x in 0..m {
        let c = here[x];
        let across = passage.flow(Scalar, west_g[x], c, west[x])
            + passage.flow(Scalar, east_g[x], c, east[x]);
        let down = passage.flow(Scalar, north_g[x], c, north[x])
            + passage.flow(Scalar, south_g[x], c, south[x]);
        let beside = passage.flow(Scalar, beside_g[x], c, beside[x]);
        let change = per_capacity[x] * ((across + down) + beside);
        (next[x], carry[x]) = add(c, carry[x], change);
    }
}

impl Row<'_> {
    /// The change of the cell at one end of the row, where the cloth has its edge.
    fn change_at_end<P: Passage>(&self, passage: P, x: usize) -> f32 {
        let c = self.here[x];
        let west = match x.checked_sub(1) {
            Some(w) => passage.flow(Scalar, self.east_g[w], c, self.here[w]),
            None => 0.0,
        };
        let east = match self.here.get(x + 1) {
            Some(east) => passage.flow(Scalar, self.east_g[x], c, *east),
            None => 0.0,
        };
        let down = passage.flow(Scalar, self.north_g[x], c, self.north[x])
            + passage.flow(Scalar, self.south_g[x], c, self.south[x]);
        let beside = passage.flow(Scalar, self.beside_g[x], c, self.beside[x]);
        self.per_capacity[x] * (((west + east) + down) + beside)
    }
}
