//! What one stage of a leap does with one row: dye flows, binds, and is kept where supply holds it.

use std::ops::Range;

use super::binding::{self, Binding, Blocks, Kept, Mix};
use crate::diffusion::held::Held;
use crate::diffusion::kernel::{At, Fick, Passage, Take, WeiszZollinger};
use crate::diffusion::lanes::{Cells, Lanes, Ways};
use crate::diffusion::tiles::{Level, Task, Work, flow};
use pulp::Simd;

/// Changes smaller than this are none.
pub const NOTHING: f32 = 1e-24;

/// How faces pass dye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Fick's law. Rates are proportional to differences, so the rate at a stage is the rate at the
    /// beginning and that of the change since then.
    Fick,
    /// Fick's law, slowed down where there is much dye.
    Slowed(WeiszZollinger),
}

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
        let change = simd.add_f32s(last, rates);
        // Ahead of the dye the numbers grow ever smaller, and processors are a hundred times
        // slower with the smallest of all (subnormal) than with any other.
        let nothing = simd.less_than_f32s(simd.abs_f32s(change), simd.splat_f32s(NOTHING));
        *into = simd.select_f32s(nothing, simd.splat_f32s(0.0), change);
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
    fn kept(
        &self,
        task: &Task,
    ) -> impl Iterator<Item = (usize, usize, &crate::diffusion::held::HeldCell)> {
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

    /// Everything else: rates first, then what they make of each cell.
    fn spread_and_bind<P: Passage>(
        &self,
        passage: P,
        mut task: Task,
        from: &Level,
        into: &mut Level,
    ) {
        let mix = self.mixes[task.stage];
        let here = self.whole(task.y - task.top);
        let there = self.whole(task.y);
        let blocks = task.blocks.clone();
        let mut rates = vec![Cells::ZERO; self.lanes.blocks];
        let whole = matches!(self.law, Law::Slowed(_));
        if whole {
            // The law needs the concentrations themselves: those of three rows.
            let last = self.lanes.grid.ny - 1;
            let rows = task.y.saturating_sub(1)..=last.min(task.y + 1);
            let top = *rows.start();
            let around = rows.flat_map(|y| {
                let change = &from.free[self.whole(y - task.top)];
                let begin = &self.begin.0[self.whole(y)];
                begin.iter().zip(change).map(|(c, d)| plus(c, d))
            });
            let around: Vec<Cells> = around.collect();
            let mut shifted = Task {
                top,
                south: &mut *task.south,
                blocks: blocks.clone(),
                ..task
            };
            let take = Rates(&mut rates);
            flow(passage, self.lanes, self.ways, &mut shifted, &around, take);
        } else {
            let take = Rates(&mut rates);
            flow(passage, self.lanes, self.ways, &mut task, from.free, take);
            let first = &self.first_rate[there.clone()][blocks.clone()];
            for (rate, first) in rates[blocks.clone()].iter_mut().zip(first) {
                *rate = plus(rate, first);
            }
        }
        let first = there.start + blocks.start;
        let local = here.start + blocks.start..here.start + blocks.end;
        let global = there.start + blocks.start..there.start + blocks.end;
        let kept: Vec<_> = self.kept(&task).map(|(i, b, cell)| (i, b, *cell)).collect();
        let mut grown = Vec::with_capacity(kept.len());
        for (i, block, cell) in &kept {
            let at = |cells: &[Cells]| cells[here.start + block].0[cell.layer][cell.lane];
            let rate =
                rates[*block].0[cell.layer][cell.lane] + if whole { 0.0 } else { cell.rate as f32 };
            into.held[*i] = f64::from(mix.mu) * from.held[*i]
                + f64::from(mix.nu) * into.held[*i]
                + cell.capacity * (f64::from(mix.rate * rate) + f64::from(mix.first) * cell.rate);
            grown.push(self.binding.map_or(0.0, |binding| {
                let v_u = cell.capacity as f32;
                let c = self.begin.0[cell.block].0[cell.layer][cell.lane];
                binding.stage_in_kept(
                    mix,
                    Kept {
                        moved: (v_u * (c + binding.moved * rate)).max(0.0),
                        moved_first: (v_u * (c + binding.moved * cell.rate as f32)).max(0.0),
                        v_d: binding.fibre(cell.block, cell.layer, cell.lane),
                        a: self.begin.1[cell.block].0[cell.layer][cell.lane],
                        last: at(from.bound),
                        before: at(into.bound),
                    },
                )
            }));
        }
        match self.binding {
            Some(binding) => binding::stage(
                binding,
                mix,
                Blocks {
                    first,
                    begin: (&self.begin.0[global.clone()], &self.begin.1[global.clone()]),
                    last: (&from.free[local.clone()], &from.bound[local.clone()]),
                    rate: (&rates[blocks.clone()], &self.first_rate[global]),
                    into: (&mut into.free[local.clone()], &mut into.bound[local]),
                },
            ),
            None => {
                let rates = rates[blocks.clone()].iter().zip(&self.first_rate[global]);
                let cells = into.free[local.clone()].iter_mut().zip(&from.free[local]);
                for ((into, last), (rate, first)) in cells.zip(rates) {
                    mixed(mix, into, last, rate, first);
                }
            }
        }
        for ((_, block, cell), grown) in kept.iter().zip(grown) {
            let block = here.start + block;
            into.free[block].0[cell.layer][cell.lane] = 0.0;
            if self.binding.is_some() {
                into.bound[block].0[cell.layer][cell.lane] = grown;
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

fn mixed(mix: Mix, into: &mut Cells, last: &Cells, rate: &Cells, first: &Cells) {
    let into = into.0.as_flattened_mut().iter_mut();
    let stages = into.zip(last.0.as_flattened());
    let rates = rate.0.as_flattened().iter().zip(first.0.as_flattened());
    for ((into, last), (rate, first)) in stages.zip(rates) {
        *into = (mix.mu * last + mix.nu * *into) + (mix.rate * rate + mix.first * first);
    }
}

/// The rates of a field of concentrations.
pub struct RatesOf<'a> {
    /// The layout.
    pub lanes: Lanes,
    /// The cloth.
    pub ways: &'a [Ways],
    /// How faces pass dye.
    pub law: Law,
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
        let take = Rates(&mut into.free[here]);
        match self.law {
            Law::Fick => flow(Fick, self.lanes, self.ways, &mut task, from.free, take),
            Law::Slowed(law) => flow(law, self.lanes, self.ways, &mut task, from.free, take),
        }
    }
}
