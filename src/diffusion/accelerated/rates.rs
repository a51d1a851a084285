//! The rates at the end of a leap, and what they say of it.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use pulp::Simd;

use super::baths::Baths;
use super::turns::Turns;
use crate::diffusion::held::Held;
use crate::diffusion::kernel::{At, Take};
use crate::diffusion::lanes::{Cells, LANES, Lanes, Ways};
use crate::diffusion::passage::{Fick, Law};
use crate::diffusion::tiles::{Level, Task, Work, flow};

/// The rates alone.
struct Rates<'a>(&'a mut [Cells]);

impl Take for Rates<'_> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, _: S, at: At, _: S::f32s, rate: S::f32s) {
        *at.of_mut::<S>(self.0) = rate;
    }
}

/// The rates of a field of concentrations, and what they say of the leap that led there.
pub struct RatesOf<'a> {
    /// The layout.
    pub lanes: Lanes,
    /// The cloth.
    pub ways: &'a [Ways],
    /// How faces pass dye.
    pub law: Law,
    /// The baths, if there are any, and c: the field is then s.
    pub baths: Option<(&'a Baths, &'a [Cells])>,
    /// The leap, if there was one.
    pub judge: Option<&'a Judge<'a>>,
}

/// Estimates the error of a leap, see [`accelerated`](super).
pub struct Judge<'a> {
    /// c at the beginning.
    pub begin: &'a [Cells],
    /// The rate at the beginning.
    pub first_rate: &'a [Cells],
    /// Where dye binds, the change of the total; else that of c counts.
    pub change: Option<&'a [Cells]>,
    /// The steps of the leap.
    pub steps: f64,
    /// Where dye binds and moments count, how it turns.
    pub turns: Option<Turns<'a>>,
    /// The kept cells, which do not count.
    pub held: &'a Held,
    /// The largest error so far, as the bits of a float32: of positive numbers they keep the order.
    pub worst: AtomicU32,
    /// The sum of the squared errors of each row, as the bits of a float64; empty where only the
    /// largest error counts.
    pub squares: Vec<AtomicU64>,
}

impl Judge<'_> {
    /// The largest error of all, and the root mean square of `cells` cells.
    pub fn verdict(&self, cells: usize) -> (f64, f64) {
        let worst = f32::from_bits(self.worst.load(Ordering::Relaxed));
        let rows = self.squares.iter();
        let sum: f64 = rows
            .map(|row| f64::from_bits(row.load(Ordering::Relaxed)))
            .sum();
        (f64::from(worst), (sum / cells as f64).sqrt())
    }

    /// Judges a row of blocks by its concentrations and rates at the end.
    fn row(&self, row: Range<usize>, end: &[Cells], rates: &mut [Cells]) {
        let mut kept = Vec::new();
        for cell in self.held.in_row(row.start / end.len()) {
            let rate = &mut rates[cell.block - row.start].0[cell.layer][cell.lane];
            kept.push((cell, std::mem::replace(rate, 0.0)));
        }
        let begin = &self.begin[row.clone()];
        let mut turned = match &self.turns {
            Some(turns) => turns.row(row.clone(), [begin, end]),
            None => Vec::new(),
        };
        for (cell, _) in &kept {
            if let Some(turned) = turned.get_mut(cell.block - row.start) {
                turned.0[cell.layer][cell.lane] = 0.0;
            }
        }
        let third = (self.steps / 3.0) as f32;
        let (mut worst, mut squares) = ([0.0_f32; LANES], [0.0_f64; LANES]);
        let sums_up = !self.squares.is_empty();
        let change = self.change.map_or(end, |change| &change[row.clone()]);
        let fields = begin.iter().zip(change).zip(&self.first_rate[row.clone()]);
        for (b, (((begin, end), first), last)) in fields.zip(&*rates).enumerate() {
            let turned = turned.get(b).copied().unwrap_or(Cells::ZERO);
            for l in 0..2 {
                for i in 0..LANES {
                    let at = |cells: &Cells| cells.0[l][i];
                    let change = if self.change.is_some() {
                        at(end)
                    } else {
                        at(end) - at(begin)
                    };
                    let error = third * (at(first) + at(last)) - 2.0 / 3.0 * change;
                    let error = error.abs().max(turned.0[l][i]);
                    worst[i] = worst[i].max(error);
                    if sums_up {
                        squares[i] += f64::from(error) * f64::from(error);
                    }
                }
            }
        }
        let worst = worst.into_iter().fold(0.0, f32::max);
        // The largest of all is the same in whatever order rows come.
        self.worst.fetch_max(worst.to_bits(), Ordering::Relaxed);
        if let Some(row) = self.squares.get(row.start / end.len()) {
            let sum: f64 = squares.iter().sum();
            row.store(sum.to_bits(), Ordering::Relaxed);
        }
        for (cell, rate) in kept {
            rates[cell.block - row.start].0[cell.layer][cell.lane] = rate;
        }
    }
}

impl Work for RatesOf<'_> {
    fn blocks(&self) -> usize {
        self.lanes.blocks
    }

    fn rows(&self) -> usize {
        self.lanes.grid.ny
    }

    fn held_above(&self, _: usize) -> usize {
        0
    }

    fn row(&self, mut task: Task, from: &Level, into: &mut Level) {
        let blocks = self.lanes.blocks;
        let here = (task.y - task.top) * blocks..(task.y - task.top + 1) * blocks;
        let take = Rates(&mut into.free[here.clone()]);
        match self.law {
            Law::Fick => flow(Fick, self.lanes, self.ways, &mut task, from.free, take),
            Law::Slowed(law) => flow(law, self.lanes, self.ways, &mut task, from.free, take),
        }
        // Wide rows come in strips, the last of which ends them.
        if task.blocks.end < blocks {
            return;
        }
        let row = task.y * blocks..(task.y + 1) * blocks;
        let (mut end, rates) = (&from.free[here.clone()], &mut into.free[here]);
        if let Some((baths, c)) = self.baths {
            end = &c[row.clone()];
            baths.add_rates(row.start, end, rates);
        }
        if let Some(judge) = self.judge {
            judge.row(row, end, rates);
        }
    }
}
