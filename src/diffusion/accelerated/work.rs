//! What one stage of a leap does with one row: dye flows, binds, and is kept where supply holds it.

use std::ops::Range;

use pulp::Simd;

use super::baths::{Baths, Dry, Soak};
use super::binding::{Binding, KeptPore, Mix, Pores};
use crate::diffusion::held::{Held, HeldCell};
use crate::diffusion::kernel::{At, Take};
use crate::diffusion::lanes::{Cells, Lanes, Ways};
use crate::diffusion::passage::{Fick, Law, Passage};
use crate::diffusion::tiles::{Level, Task, Work, flow};

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
    /// s at the beginning: c once the baths have acted.
    pub soaked: &'a [Cells],
    /// The baths, if there are any.
    pub baths: Option<&'a Baths>,
    /// The rate at the beginning of the leap.
    pub first_rate: &'a [Cells],
    /// How dye binds, if it does.
    pub binding: Option<&'a Binding>,
    /// What the stages make of the last two.
    pub mixes: &'a [Mix],
}

/// Mixes the last two stages and their rates, in place.
struct Combine<'a, B> {
    mix: Mix,
    soak: B,
    first_rate: &'a [Cells],
    into: &'a mut [Cells],
}

impl<B: Soak> Take for Combine<'_, B> {
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
        let liquid = self.soak.of_liquid(simd, at, here);
        let rate = self.soak.eased(simd, at, rate, liquid);
        let last = simd.add_f32s(
            simd.mul_f32s(simd.splat_f32s(mu), here),
            simd.mul_f32s(simd.splat_f32s(nu), *into),
        );
        let rates = simd.add_f32s(
            simd.mul_f32s(simd.splat_f32s(r), rate),
            simd.mul_f32s(simd.splat_f32s(first), first_rate),
        );
        let rates = self.soak.of_soaked(simd, at, rates);
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
struct Bind<'a, B> {
    mix: Mix,
    soak: B,
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

impl<B: Soak> Take for Bind<'_, B> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: At, _: S::f32s, rate: S::f32s) {
        let (mix, soak) = (self.mix, self.soak);
        let first_rate = at.of::<S>(self.first_rate);
        let last = soak.of_liquid(simd, at, at.of::<S>(self.last));
        let rate = if self.linear {
            simd.add_f32s(rate, first_rate)
        } else {
            soak.driven(simd, at, rate)
        };
        let rate = soak.eased(simd, at, rate, last);
        *at.of_mut::<S>(self.rates) = rate;
        let free = at.of_mut::<S>(self.into);
        let before = soak.of_liquid(simd, at, *free);
        let Some(row) = &mut self.pores else {
            let mixed = mix.of(simd, [last, before, rate, first_rate]);
            *free = without_nothing(simd, soak.of_soaked(simd, at, mixed));
            return;
        };
        let bound = at.of_mut::<S>(row.into);
        let pores = Pores {
            c: at.of::<S>(row.c),
            a: at.of::<S>(row.a),
            v_u: at.of::<S>(row.v_u),
            v_d: at.of::<S>(row.v_d),
            last: [last, at.of::<S>(row.last)],
            before: [before, *bound],
            rate,
            first_rate,
        };
        let [change, grown] = row.binding.stage(simd, mix, pores);
        *free = soak.of_soaked(simd, at, change);
        *bound = grown;
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
        let Some(baths) = self.baths else {
            return self.advance(Dry, task, from, into);
        };
        let row = self.whole(task.y);
        let first = row.start + task.blocks.start;
        let top = task.top * self.lanes.blocks;
        let local = first - top..row.start + task.blocks.end - top;
        let (change, brought) = (&from.free[local.clone()], &from.brought[local.clone()]);
        let into_brought = &mut into.brought[local];
        baths.follow(self.mixes[task.stage], first, change, brought, into_brought);
        let bath = baths.row(row.clone(), &self.begin.0[row]);
        self.advance(bath, task, from, into);
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

    fn advance<B: Soak>(&self, soak: B, task: Task, from: &Level, into: &mut Level) {
        match (self.law, self.binding) {
            (Law::Fick, None) => self.spread(soak, task, from, into),
            (Law::Fick, Some(_)) => self.spread_and_bind(soak, Fick, task, from, into),
            (Law::Slowed(law), _) => self.spread_and_bind(soak, law, task, from, into),
        }
    }

    /// Fick's law and nothing else: all in one loop.
    fn spread<B: Soak>(&self, soak: B, mut task: Task, from: &Level, into: &mut Level) {
        let mix = self.mixes[task.stage];
        let here = self.whole(task.y - task.top);
        let take = Combine {
            // The rate at the last stage is that of the change since the beginning, and the first.
            mix: Mix {
                first: mix.rate + mix.first,
                ..mix
            },
            soak,
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
    fn spread_and_bind<B: Soak, P: Passage>(
        &self,
        soak: B,
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
            soak,
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
                let begin = &self.soaked[self.whole(y)];
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
