//! How stiff diffusion is on a cloth: the largest rate at which any pattern of dye changes.

use rayon::prelude::*;

use crate::diffusion::lanes::{Cells, LANES, Lanes, Ways};

/// Rounds of sharpening. The first ten gain most of what there is to gain.
const ROUNDS: usize = 12;

/// Bounds for the largest eigenvalue of diffusion, per step.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Gershgorin's: twice the largest share that a cell exchanges.
    pub rough: f64,
    /// A sharper one.
    pub sharp: f64,
}

/// Bounds the largest eigenvalue of diffusion.
///
/// With |L| the operator in which every neighbour adds rather than subtracts, the eigenvalues of
/// diffusion are at most max_i (|L|x)_i / x_i for any positive x (Collatz and Wielandt). With x = 1
/// this is Gershgorin's bound, twice the largest share that a cell exchanges in a step; x from a
/// few rounds of the power method makes it some ten per cent sharper, and it stays a bound.
pub fn bound(lanes: Lanes, ways: &[Ways]) -> Bounds {
    let mut x = vec![Cells([[1.0; LANES]; 2]); lanes.len()];
    let mut y = vec![Cells::ZERO; lanes.len()];
    let (mut rough, mut sharp) = (0.0, f64::INFINITY);
    for round in 0..ROUNDS {
        let largest = apply(lanes, ways, &x, &mut y);
        sharp = f64::min(sharp, f64::from(largest));
        if round == 0 {
            rough = f64::from(largest);
        }
        let scale = 1.0 / largest.max(f32::MIN_POSITIVE);
        x.par_iter_mut().zip(&y).for_each(|(x, y)| {
            let (x, y) = (x.0.as_flattened_mut(), y.0.as_flattened());
            for (x, y) in x.iter_mut().zip(y) {
                // What stays of x keeps it positive, and damps patterns of the other sign.
                *x = (y * scale + 0.1 * *x).max(1e-6);
            }
        });
    }
    // The sums above are rounded.
    Bounds {
        rough,
        sharp: sharp * (1.0 + 1e-5),
    }
}

/// y = |L|x; returns max y/x.
fn apply(lanes: Lanes, ways: &[Ways], x: &[Cells], y: &mut [Cells]) -> f32 {
    let blocks = lanes.blocks;
    let row = |cells: usize| cells * blocks..(cells + 1) * blocks;
    let rows = y.par_chunks_mut(blocks).enumerate();
    let largest = rows.map(|(at, y)| {
        let (here, way) = (&x[row(at)], &ways[row(at)]);
        let above = at.saturating_sub(1);
        let (north, north_way) = (&x[row(above)], &ways[row(above)]);
        let south = &x[row((at + 1).min(lanes.grid.ny - 1))];
        let mut largest = 0.0_f32;
        for b in 0..blocks {
            for l in 0..2 {
                for i in 0..LANES {
                    let c = here[b].0[l][i];
                    let mut sum = way[b].beside[i] * (c + here[b].0[1 - l][i]);
                    let east = match here.get(b + 1) {
                        _ if i + 1 < LANES => here[b].0[l][i + 1],
                        Some(next) => next.0[l][0],
                        None => 0.0,
                    };
                    sum += way[b].east[l][i] * (c + east);
                    if i > 0 {
                        sum += way[b].east[l][i - 1] * (c + here[b].0[l][i - 1]);
                    } else if b > 0 {
                        let west = here[b - 1].0[l][LANES - 1];
                        sum += way[b - 1].east[l][LANES - 1] * (c + west);
                    }
                    sum += way[b].south[l][i] * (c + south[b].0[l][i]);
                    if at > 0 {
                        sum += north_way[b].south[l][i] * (c + north[b].0[l][i]);
                    }
                    sum *= way[b].per_capacity[l][i];
                    y[b].0[l][i] = sum;
                    largest = largest.max(sum / c);
                }
            }
        }
        largest
    });
    largest.reduce(|| 0.0, f32::max)
}
