//! The moments within a leap, which frames show: on the cubic through both ends and their rates.

use std::ops::Range;

use rayon::prelude::*;

use super::baths::{Given, plus};
use super::turns::{Growth, Place, between};
use super::{Leap, limiter};
use crate::cloth::Grid;
use crate::diffusion::lanes::{Cells, LANES, Ways, unpack_row};
use crate::ledger::Ledger;

/// A row of the cloth at a moment.
struct Moment {
    /// c.
    free: Vec<Cells>,
    /// A; empty where nothing binds.
    bound: Vec<Cells>,
    /// What supply has given and taken since the leap began: to and from kept cells, and because the row
    /// does not follow the cubic.
    supplied: Given,
}

impl Leap {
    /// Shows the process at a step within the leap, and books the dye that supply has brought since
    /// the last time it was asked.
    pub fn show(
        &mut self,
        step: u64,
        concentration: &mut [f32],
        bound: &mut [f32],
        ledger: &mut Ledger,
    ) {
        let (h, t) = (
            (self.span.end - self.span.start) as f64,
            (step - self.span.start) as f64,
        );
        let t = t / h;
        let cubic = Cubic::new(t, h);
        let (lanes, binds) = (self.lanes, self.binding.is_some());
        let Grid { nx, ny } = lanes.grid;
        let (weft, warp) = concentration.split_at_mut(lanes.grid.layer_len());
        let layer = if binds { lanes.grid.layer_len() } else { 0 };
        let (weft_bound, warp_bound) = bound.split_at_mut(layer);
        let bound_rows = weft_bound
            .chunks_mut(nx)
            .zip(warp_bound.chunks_mut(nx))
            .map(Some)
            .chain(std::iter::repeat_with(|| None));
        let bound_rows: Vec<_> = bound_rows.take(ny).collect();
        let rows = weft.par_chunks_mut(nx).zip(warp.par_chunks_mut(nx));
        let this: &Leap = self;
        let supplied: Vec<Given> = rows
            .zip(bound_rows)
            .enumerate()
            .map(|(y, ((weft, warp), bound))| {
                let row = this.row_at(y, t, cubic);
                unpack_row(&row.free, [weft, warp]);
                if let Some((weft, warp)) = bound {
                    unpack_row(&row.bound, [weft, warp]);
                }
                row.supplied
            })
            .collect();
        // In order, so that no number of threads changes the sums.
        let rows = supplied.into_iter().fold([0.0; 2], plus);
        let mut supplied = plus(rows, [0.0, cubic.y1 * self.clipped]);
        if let Some(baths) = &self.baths {
            let [first, last] = baths.rate;
            let brought = [0, 1].map(|i| cubic.at(self.brought[i], first[i], last[i]));
            supplied = plus(supplied, brought);
        }
        let now = [ledger.supplied, ledger.removed];
        // Others may have booked something meanwhile.
        let before = self.booked.map_or(now, |[before, written]| {
            [0, 1].map(|i| before[i] + (now[i] - written[i]))
        });
        [ledger.supplied, ledger.removed] = plus(before, supplied);
        self.booked = Some([before, [ledger.supplied, ledger.removed]]);
    }

    /// A row at the share `t` of the leap.
    fn row_at(&self, y: usize, t: f64, cubic: Cubic) -> Moment {
        let row = y * self.lanes.blocks..(y + 1) * self.lanes.blocks;
        let (mut free, mut bound) = if t == 1.0 {
            let bound = self.a[1].get(row.clone()).unwrap_or_default();
            (self.c[1][row.clone()].to_vec(), bound.to_vec())
        } else {
            let bound = self.bound_at(y, t);
            (self.free_at(y, cubic, &bound), bound)
        };
        let ways = &self.ways[row.clone()];
        let mut supplied = [0.0; 2];
        if !limiter::limit(&mut free, ways) {
            // Between two states within the bounds a straight line is within them too.
            let straight = on_line(&self.c, row.clone(), t);
            bound = on_line(&self.a, row.clone(), t);
            // What baths bring to the row is then on a line as well.
            if self.baths.as_ref().is_some_and(|baths| baths.reach(y)) {
                supplied[0] = dye(&straight, ways) - dye(&free, ways);
            }
            free = straight;
        }
        let h = (self.span.end - self.span.start) as f64;
        let rim = self.held.within(y, row.clone());
        let rim = rim.map(|(i, cell)| (self.flowed[0][i], cell));
        let deep = self.held.deep_in_row(y);
        let deep = deep.map(|cell| (h * cell.capacity * cell.rate, cell));
        for (flowed, cell) in rim.chain(deep) {
            let [first, last] = [cell.rate, cell.rate_after].map(|rate| cell.capacity * rate);
            let flowed = cubic.at(flowed, first, last);
            let at = |a: &[Cells], block: usize| {
                a.get(block)
                    .map_or(0.0, |cells| f64::from(cells.0[cell.layer][cell.lane]))
            };
            let grown = at(&bound, cell.block - row.start) - at(&self.a[0], cell.block);
            let brought = grown - flowed;
            supplied = plus(supplied, [brought.max(0.0), (-brought).max(0.0)]);
        }
        Moment {
            free,
            bound,
            supplied,
        }
    }

    /// Bound dye in a row at the share `t` of the leap.
    fn bound_at(&self, y: usize, t: f64) -> Vec<Cells> {
        let Some(binding) = &self.binding else {
            return Vec::new();
        };
        let row = y * self.lanes.blocks..(y + 1) * self.lanes.blocks;
        let h = (self.span.end - self.span.start) as f64;
        let grown = |place: Place, rates: [f32; 2], kept: bool| {
            let at = |cells: &[Cells]| cells[place.0].0[place.1][place.2];
            let [from, to] = [0, 1].map(|end| at(&self.a[end]));
            if to == from {
                return from;
            }
            let [first, last] = [0, 1].map(|end| {
                let state = [at(&self.c[end]), rates[end], at(&self.a[end])];
                Growth::of(binding, place, state, kept)
            });
            let all = f64::from(to) - f64::from(from);
            let turns = kept && first.at_limit != last.at_limit;
            from + between(t, h, all, [first, last].map(|growth| growth.rate), turns) as f32
        };
        let mut bound = vec![Cells::ZERO; row.len()];
        for (b, cells) in bound.iter_mut().enumerate() {
            for l in 0..2 {
                for i in 0..LANES {
                    let rates = [0, 1].map(|end| self.rate[end][row.start + b].0[l][i]);
                    cells.0[l][i] = grown((row.start + b, l, i), rates, false);
                }
            }
        }
        for cell in self.held.in_row(y) {
            let rates = [cell.rate, cell.rate_after].map(|rate| rate as f32);
            bound[cell.block - row.start].0[cell.layer][cell.lane] =
                grown((cell.block, cell.layer, cell.lane), rates, true);
        }
        bound
    }

    /// Concentrations in a row: what is free where the total follows a curve and so much is bound.
    fn free_at(&self, y: usize, cubic: Cubic, bound: &[Cells]) -> Vec<Cells> {
        let first = y * self.lanes.blocks;
        let now = |in_row: usize| {
            let b = first + in_row;
            let [c0, c1] = [&self.c[0][b], &self.c[1][b]];
            let [r0, r1] = [&self.rate[0][b], &self.rate[1][b]];
            let mut cells = *c0;
            for l in 0..2 {
                for i in 0..LANES {
                    let at = |cells: &Cells| cells.0[l][i];
                    let rates = cubic.rate0 as f32 * at(r0) + cubic.rate1 as f32 * at(r1);
                    let change = at(c1) - at(c0);
                    let mut c = cubic.y1 as f32 * change + rates;
                    // Kept cells do not change.
                    if !bound.is_empty() && (change != 0.0 || rates != 0.0) {
                        let before = at(&self.a[0][b]);
                        let all = at(&self.a[1][b]) - before;
                        let grown = at(&bound[in_row]) - before;
                        let per_capacity = self.ways[b].per_capacity[l][i];
                        c += (cubic.y1 as f32 * all - grown) * per_capacity;
                    }
                    cells.0[l][i] += c;
                }
            }
            cells
        };
        (0..self.lanes.blocks).map(now).collect()
    }
}

/// What some cells hold at the share `t` of a leap, on a straight line between its ends (the first two
/// of `ends`; nothing where they are empty).
fn on_line(ends: &[Vec<Cells>], row: Range<usize>, t: f64) -> Vec<Cells> {
    let [from, to] = [0, 1].map(|end| ends[end].get(row.clone()).unwrap_or_default());
    let t = t as f32;
    let between = |(from, to): (&Cells, &Cells)| {
        let mut cells = *from;
        let all = cells.0.as_flattened_mut().iter_mut();
        for (value, to) in all.zip(to.0.as_flattened()) {
            let (low, high) = (value.min(*to), value.max(*to));
            // What rounding adds must not lead beyond either end.
            *value = (*value + t * (to - *value)).max(low).min(high);
        }
        cells
    };
    from.iter().zip(to).map(between).collect()
}

/// The dye in a row of blocks.
fn dye(row: &[Cells], ways: &[Ways]) -> f64 {
    let mut dye = 0.0;
    for (cells, way) in row.iter().zip(ways) {
        let per_capacity = way.per_capacity.as_flattened();
        for (c, per_capacity) in cells.0.as_flattened().iter().zip(per_capacity) {
            if *per_capacity > 0.0 {
                dye += f64::from(*c) / f64::from(*per_capacity);
            }
        }
    }
    dye
}

/// The cubic through the ends of a leap: y = y₀ + y1·(y₁ − y₀) + rate0·F₀ + rate1·F₁.
#[derive(Debug, Clone, Copy)]
pub struct Cubic {
    y1: f64,
    rate0: f64,
    rate1: f64,
}

impl Cubic {
    /// At the share `t` of a leap of `h` steps.
    pub fn new(t: f64, h: f64) -> Self {
        Cubic {
            y1: t * t * (3.0 - 2.0 * t),
            rate0: h * t * (1.0 - t) * (1.0 - t),
            rate1: h * t * t * (t - 1.0),
        }
    }

    /// y where y₀ is nothing, for y₁, F₀ and F₁.
    pub fn at(self, y1: f64, rate0: f64, rate1: f64) -> f64 {
        self.y1 * y1 + self.rate0 * rate0 + self.rate1 * rate1
    }
}
