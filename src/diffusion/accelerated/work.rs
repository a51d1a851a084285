//! What one stage of a leap does with one row: dye flows, binds, and is kept where supply holds it.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use super::binding::{Binding, KeptPore, Mix, Pores};
use crate::diffusion::held::{Held, HeldCell};
use crate::diffusion::kernel::{At, Take};
use crate::diffusion::lanes::{Cells, LANES, Lanes, Ways};
use crate::diffusion::passage::{Fick, Law, Passage};
use crate::diffusion::tiles::{Level, Task, Work, flow};
use pulp::Simd;

/// Changes smaller than this are none.
///
/// Ahead of the dye the numbers grow ever smaller, and processors are a hundred times slower with
/// the smallest of all (subnormal) than with any other.
pub const NOTHING: f32 = 1e-24;

/// The stages of a leap.
pub struct Stages<'a> {
    /// The layout.
    pub lanes: Lanes,
    /// The cloth.
    pub ways: &'a [Ways],
    /// How faces pass dye.
    pub law: Law,
    /// The kept cells.
    pub held: &'a Held,
    /// c and, where dye binds, A at the beginning of the leap.
    pub begin: (&'a [Cells], &'a [Cells]),
    /// The rate at the beginning of the leap.
    pub first_rate: &'a [Cells],
    /// How dye binds, if it does.
    pub binding: Option<&'a Binding>,
    /// What the stages make of the last two.
    pub mixes: &'a [Mix],
}

/// Mixes the last two stages and their rates, in place.
struct Combine<'a> {
    mix: Mix,
    first_rate: &'a [Cells],
    into: &'a mut [Cells],
}

impl Take for Combine<'_> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: At, here: S::f32s, rate: S::f32s) {
        let Mix {
            mu,
            nu,
            rate: r,
            first,
        } = self.mix;
        let first_rate = at.of::<S>(self.first_rate);
        let into = at.of_mut::<S>(self.into);
        let last = simd.add_f32s(
            simd.mul_f32s(simd.splat_f32s(mu), here),
            simd.mul_f32s(simd.splat_f32s(nu), *into),
        );
        let rates = simd.add_f32s(
            simd.mul_f32s(simd.splat_f32s(r), rate),
            simd.mul_f32s(simd.splat_f32s(first), first_rate),
        );
        *into = without_nothing(simd, simd.add_f32s(last, rates));
    }
}

/// Without what is too small to matter.
#[inline(always)]
pub fn without_nothing<S: Simd>(simd: S, change: S::f32s) -> S::f32s {
    let nothing = simd.less_than_f32s(simd.abs_f32s(change), simd.splat_f32s(NOTHING));
    simd.select_f32s(nothing, simd.splat_f32s(0.0), change)
}

/// Mixes the last two stages and their rates, and divides what cells hold into free and bound.
struct Bind<'a> {
    mix: Mix,
    /// Whether rates are those of the changes alone.
    linear: bool,
    first_rate: &'a [Cells],
    last: &'a [Cells],
    into: &'a mut [Cells],
    /// Where the rates are left.
    rates: &'a mut [Cells],
    pores: Option<PoreRow<'a>>,
}

/// A row where dye binds.
struct PoreRow<'a> {
    binding: &'a Binding,
    c: &'a [Cells],
    a: &'a [Cells],
    v_u: &'a [Cells],
    v_d: &'a [Cells],
    last: &'a [Cells],
    into: &'a mut [Cells],
}

impl Take for Bind<'_> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: At, _: S::f32s, rate: S::f32s) {
        let mix = self.mix;
        let first_rate = at.of::<S>(self.first_rate);
        let rate = if self.linear {
            simd.add_f32s(rate, first_rate)
        } else {
            rate
        };
        *at.of_mut::<S>(self.rates) = rate;
        let last = at.of::<S>(self.last);
        let free = at.of_mut::<S>(self.into);
        let Some(row) = &mut self.pores else {
            *free = without_nothing(simd, mix.of(simd, [last, *free, rate, first_rate]));
            return;
        };
        let bound = at.of_mut::<S>(row.into);
        let pores = Pores {
            c: at.of::<S>(row.c),
            a: at.of::<S>(row.a),
            v_u: at.of::<S>(row.v_u),
            v_d: at.of::<S>(row.v_d),
            last: [last, at.of::<S>(row.last)],
            before: [*free, *bound],
            rate,
            first_rate,
        };
        [*free, *bound] = row.binding.stage(simd, mix, pores);
    }
}

/// The rates alone.
struct Rates<'a>(&'a mut [Cells]);

impl Take for Rates<'_> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, _: S, at: At, _: S::f32s, rate: S::f32s) {
        *at.of_mut::<S>(self.0) = rate;
    }
}

impl Work for Stages<'_> {
    fn blocks(&self) -> usize {
        self.lanes.blocks
    }

    fn rows(&self) -> usize {
        self.lanes.grid.ny
    }

    fn held_above(&self, y: usize) -> usize {
        self.held.above(y)
    }

    fn row(&self, task: Task, from: &Level, into: &mut Level) {
        match (self.law, self.binding) {
            (Law::Fick, None) => self.spread(task, from, into),
            (Law::Fick, Some(_)) => self.spread_and_bind(Fick, task, from, into),
            (Law::Slowed(law), _) => self.spread_and_bind(law, task, from, into),
        }
    }
}

impl Stages<'_> {
    /// The blocks of a row of the cloth.
    fn whole(&self, y: usize) -> Range<usize> {
        y * self.lanes.blocks..(y + 1) * self.lanes.blocks
    }

    /// The kept cells that a task comes across, with their places in the levels and in the row.
    fn kept(&self, task: &Task) -> impl Iterator<Item = (usize, usize, &HeldCell)> {
        let (above, row) = (self.held.above(task.top), task.y * self.lanes.blocks);
        let blocks = row + task.blocks.start..row + task.blocks.end;
        self.held
            .within(task.y, blocks)
            .map(move |(i, cell)| (i - above, cell.block - row, cell))
    }

    /// Fick's law and nothing else: all in one loop.
    fn spread(&self, mut task: Task, from: &Level, into: &mut Level) {
        let mix = self.mixes[task.stage];
        let here = self.whole(task.y - task.top);
        let take = Combine {
            // The rate at the last stage is that of the change since the beginning, and the first.
            mix: Mix {
                first: mix.rate + mix.first,
                ..mix
            },
            first_rate: &self.first_rate[self.whole(task.y)],
            into: &mut into.free[here.clone()],
        };
        flow(Fick, self.lanes, self.ways, &mut task, from.free, take);
        let row = &mut into.free[here];
        for (i, block, cell) in self.kept(&task) {
            // Kept cells did not change before; what stands there now flowed in.
            let cell_now = &mut row[block].0[cell.layer][cell.lane];
            let flowed = f64::from(std::mem::replace(cell_now, 0.0))
                + f64::from(mix.rate + mix.first) * cell.rate;
            into.held[i] = f64::from(mix.mu) * from.held[i]
                + f64::from(mix.nu) * into.held[i]
                + cell.capacity * flowed;
        }
    }

    /// Everything else.
    fn spread_and_bind<P: Passage>(
        &self,
        passage: P,
        mut task: Task,
        from: &Level,
        into: &mut Level,
    ) {
        let mix = self.mixes[task.stage];
        let local = self.whole(task.y - task.top);
        let row = self.whole(task.y);
        let linear = self.law == Law::Fick;
        let kept: Vec<_> = self.kept(&task).map(|(i, b, cell)| (i, b, *cell)).collect();
        let at = |cells: &[Cells], block: usize, cell: &HeldCell| {
            cells[local.start + block].0[cell.layer][cell.lane]
        };
        let binds = self.binding.is_some();
        let bound_before = |(_, block, cell): &(usize, usize, HeldCell)| match binds {
            true => at(into.bound, *block, cell),
            false => 0.0,
        };
        let bound_before: Vec<f32> = kept.iter().map(bound_before).collect();
        let rates = std::mem::take(&mut task.spare);
        let take = Bind {
            mix,
            linear,
            first_rate: &self.first_rate[row.clone()],
            last: &from.free[local.clone()],
            into: &mut into.free[local.clone()],
            rates: &mut *rates,
            pores: self.binding.map(|binding| PoreRow {
                binding,
                c: &self.begin.0[row.clone()],
                a: &self.begin.1[row.clone()],
                v_u: &binding.capacity[row.clone()],
                v_d: &binding.fibre[row.clone()],
                last: &from.bound[local.clone()],
                into: &mut into.bound[local.clone()],
            }),
        };
        if linear {
            flow(passage, self.lanes, self.ways, &mut task, from.free, take);
        } else {
            // The law needs the concentrations themselves: those of three rows.
            let last = self.lanes.grid.ny - 1;
            let rows = task.y.saturating_sub(1)..=last.min(task.y + 1);
            task.top = *rows.start();
            let around = rows.flat_map(|y| {
                let change = &from.free[self.whole(y + local.start / self.lanes.blocks - task.y)];
                let begin = &self.begin.0[self.whole(y)];
                begin.iter().zip(change).map(|(c, d)| plus(c, d))
            });
            let around: Vec<Cells> = around.collect();
            flow(passage, self.lanes, self.ways, &mut task, &around, take);
        }
        for ((i, block, cell), before) in kept.into_iter().zip(bound_before) {
            let rate = rates[block].0[cell.layer][cell.lane];
            // The rates of the first stage leave kept cells out.
            let rate = rate + if linear { cell.rate as f32 } else { 0.0 };
            into.held[i] = f64::from(mix.mu) * from.held[i]
                + f64::from(mix.nu) * into.held[i]
                + cell.capacity * (f64::from(mix.rate * rate) + f64::from(mix.first) * cell.rate);
            let place = local.start + block;
            into.free[place].0[cell.layer][cell.lane] = 0.0;
            if let Some(binding) = self.binding {
                let at = |cells: &[Cells]| cells[cell.block].0[cell.layer][cell.lane];
                let pore = KeptPore {
                    c: at(self.begin.0),
                    a: at(self.begin.1),
                    rates: [rate, cell.rate as f32],
                    last: from.bound[place].0[cell.layer][cell.lane],
                    before,
                };
                into.bound[place].0[cell.layer][cell.lane] =
                    binding.stage_in_kept(mix, &cell, pore);
            }
        }
    }
}

fn plus(a: &Cells, b: &Cells) -> Cells {
    let mut sum = *a;
    for (a, b) in sum.0.as_flattened_mut().iter_mut().zip(b.0.as_flattened()) {
        *a += b;
    }
    sum
}

/// The rates of a field of concentrations, and what they say of the leap that led there.
pub struct RatesOf<'a> {
    /// The layout.
    pub lanes: Lanes,
    /// The cloth.
    pub ways: &'a [Ways],
    /// How faces pass dye.
    pub law: Law,
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
    /// The kept cells, which do not count.
    pub held: &'a Held,
    /// The largest error so far, as the bits of a float32: of positive numbers they keep the order.
    pub worst: AtomicU32,
}

impl Judge<'_> {
    /// Judges row `y` by its concentrations and rates at the end.
    fn row(&self, y: usize, end: &[Cells], rates: &mut [Cells]) {
        let row = y * end.len()..(y + 1) * end.len();
        let mut kept = Vec::new();
        for cell in self.held.in_row(y) {
            let rate = &mut rates[cell.block - row.start].0[cell.layer][cell.lane];
            kept.push((cell, std::mem::replace(rate, 0.0)));
        }
        let third = (self.steps / 3.0) as f32;
        let mut worst = [0.0_f32; LANES];
        let begin = &self.begin[row.clone()];
        let change = self.change.map_or(end, |change| &change[row.clone()]);
        let fields = begin.iter().zip(change).zip(&self.first_rate[row.clone()]);
        for (((begin, end), first), last) in fields.zip(&*rates) {
            for l in 0..2 {
                for (i, worst) in worst.iter_mut().enumerate() {
                    let at = |cells: &Cells| cells.0[l][i];
                    let change = if self.change.is_some() {
                        at(end)
                    } else {
                        at(end) - at(begin)
                    };
                    let error = third * (at(first) + at(last)) - 2.0 / 3.0 * change;
                    *worst = worst.max(error.abs());
                }
            }
        }
        let worst = worst.into_iter().fold(0.0, f32::max);
        // The largest of all is the same in whatever order rows come.
        self.worst.fetch_max(worst.to_bits(), Ordering::Relaxed);
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
        if let Some(judge) = self.judge
            && task.blocks.end == blocks
        {
            judge.row(task.y, &from.free[here.clone()], &mut into.free[here]);
        }
    }
}
