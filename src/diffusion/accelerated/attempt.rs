//! One leap: its stages, the state they lead to, and how far that can be trusted.

use std::sync::atomic::{AtomicU32, AtomicU64};

use rayon::prelude::*;

use super::binding::Mix;
use super::rates::{Judge, RatesOf};
use super::turns::Turns;
use super::work::Stages;
use super::{Leap, baths, limiter, rkl2};
use crate::diffusion::lanes::{Cells, LANES};
use crate::diffusion::passage::Law;
use crate::diffusion::tiles::{self, Level};

/// Leaps of up to so many steps are done step by step: no other way is cheaper.
pub(super) const PLAIN: u64 = 3;

/// Leaps of so many steps and more end with [`rkl2::calming`].
const CALMED: u64 = 100;

/// The largest root mean square of the estimated errors, in tolerances, of a strict process. A bath may
/// do the same in every cell of the cloth, and so may err there. Of plain steps only moments err.
const RMS: f64 = 1.0 / 24.0;
const RMS_OF_PLAIN: f64 = 1.0 / 8.0;

/// How a leap came out.
pub(super) struct Outcome {
    /// The largest estimated error, in tolerances.
    pub worst: f64,
    /// Their root mean square, where it counts, in what is allowed of it.
    pub rms: f64,
    /// How far concentrations left 0…1, in tolerances.
    pub beyond: f64,
}

impl Leap {
    /// Does a leap of some steps.
    pub(super) fn attempt(&mut self, steps: u64) -> Outcome {
        let h = steps as f64;
        let calm = if steps < CALMED {
            Vec::new()
        } else {
            rkl2::calming(self.stiffness)
        };
        let leap = h - calm.iter().sum::<f64>();
        // A few steps are done as the explicit solver does them.
        let is_plain = steps <= self.longest_plain();
        let stages = if is_plain {
            let splits = self.splits() as usize;
            vec![(1.0 / splits as f64, rkl2::EULER); steps as usize * splits]
        } else {
            let stages = rkl2::coefficients(rkl2::stages(self.stiffness * leap));
            stages.into_iter().map(|stage| (leap, stage)).collect()
        };
        let mix = |(h, stage): (f64, rkl2::Stage)| Mix {
            mu: stage.mu as f32,
            nu: stage.nu as f32,
            rate: (h * stage.rate) as f32,
            first: (h * stage.first) as f32,
        };
        let calm = calm.into_iter().map(|h| (h, rkl2::EULER));
        let mixes: Vec<Mix> = stages.into_iter().chain(calm).map(mix).collect();
        self.stages(&mixes);
        self.evaluations += mixes.len() as u64;
        let outcome = self.finish(h, is_plain);
        self.booked = None;
        self.brought = baths::total(&self.given[0]);
        outcome
    }

    /// Runs the stages; afterwards `c[1]` and `a[1]` hold the changes.
    fn stages(&mut self, mixes: &[Mix]) {
        let [c0, c1] = &mut self.c;
        let [rate0, rate1] = &mut self.rate;
        let [a0, a1, a2] = &mut self.a;
        for flowed in &mut self.flowed {
            flowed.fill(0.0);
        }
        let clear = |cells: &mut Vec<Cells>| {
            cells.par_iter_mut().for_each(|cells| *cells = Cells::ZERO);
        };
        clear(rate1);
        for given in &mut self.given {
            given.fill([0.0; 2]);
        }
        let baths = self.baths.as_ref();
        let mixes = if self.law == Law::Fick && self.binding.is_none() {
            // Before the first stage nothing has changed: it is the first rate, times a number.
            let share = mixes[0].rate + mixes[0].first;
            let cells = c1.par_iter_mut().zip(&*rate0);
            cells.for_each(|(change, rate)| *change = rate.times(share));
            if let Some(baths) = baths {
                baths.to_soaked(c1);
                baths.bring(share, &mut self.given[0]);
            }
            for (flowed, cell) in self.flowed[0].iter_mut().zip(&self.held.rim) {
                *flowed = cell.capacity * f64::from(share) * cell.rate;
            }
            &mixes[1..]
        } else {
            clear(c1);
            clear(a1);
            clear(a2);
            mixes
        };
        let work = Stages {
            lanes: self.lanes,
            ways: &self.ways,
            law: self.law,
            held: &self.held,
            begin: (c0, a0),
            soaked: if baths.is_some() { &self.soaked } else { c0 },
            baths,
            first_rate: rate0,
            binding: self.binding.as_ref(),
            mixes,
        };
        let [now, other] = &mut self.flowed;
        let [given, given_before] = &mut self.given;
        let levels = [
            Level {
                free: c1,
                bound: a1,
                held: now,
                brought: given,
            },
            Level {
                free: rate1,
                bound: a2,
                held: other,
                brought: given_before,
            },
        ];
        tiles::pass(&work, mixes.len(), levels);
        if mixes.len() % 2 == 1 {
            std::mem::swap(c1, rate1);
            std::mem::swap(a1, a2);
            self.flowed.swap(0, 1);
            self.given.swap(0, 1);
        }
    }

    /// Turns the changes into the state at the end of the leap, and judges it.
    fn finish(&mut self, h: f64, is_plain: bool) -> Outcome {
        let blocks = self.lanes.blocks;
        let binds = self.binding.is_some();
        // First how much changed in all, free and bound, for the estimate: kept in the place of
        // what the rates at the end will be added to.
        let [c0, c1] = &mut self.c;
        let [a0, a1, change] = &mut self.a;
        if let Some(baths) = &mut self.baths {
            let bound = binds.then_some([a0.as_slice(), a1.as_slice()]);
            baths.restore_liquid(c1, c0, bound, &self.ways);
        }
        if binds {
            let all = change.par_iter_mut().zip(&*c1).zip(&mut *a1).zip(&*a0);
            all.zip(&self.ways)
                .for_each(|((((change, d), a), a0), way)| {
                    for l in 0..2 {
                        for i in 0..LANES {
                            let d = d.0[l][i];
                            let grown = a.0[l][i] * way.per_capacity[l][i];
                            // Kept cells, which do not change, count for nothing.
                            change.0[l][i] = if d == 0.0 { 0.0 } else { d + grown };
                            a.0[l][i] += a0.0[l][i];
                        }
                    }
                });
        }
        let rows = c1.par_chunks_mut(blocks).zip(c0.par_chunks(blocks));
        let (beyond, within) = rows
            .zip(self.ways.par_chunks(blocks))
            .map(|((row, begin), ways)| {
                let mut beyond = 0.0_f32;
                for (c, c0) in row.iter_mut().zip(begin) {
                    for (c, c0) in c.0.as_flattened_mut().iter_mut().zip(c0.0.as_flattened()) {
                        *c += c0;
                        beyond = beyond.max(-*c).max(*c - 1.0);
                    }
                }
                (beyond, beyond == 0.0 || limiter::limit(row, ways))
            })
            .reduce(|| (0.0, true), |a, b| (a.0.max(b.0), a.1 && b.1));
        // Where a row is full to the brim, the rest of the cloth has room for what rounding left; and
        // if all of it is full, what has no room is taken out, and booked.
        self.clipped = if within || limiter::limit(c1, &self.ways) {
            0.0
        } else {
            limiter::clip(c1, &self.ways)
        };
        let (worst, rms) = self.find_rates(Some(h));
        let most_rms = if is_plain { RMS_OF_PLAIN } else { RMS };
        Outcome {
            worst: worst / self.tolerance,
            rms: rms / most_rms / self.tolerance,
            beyond: f64::from(beyond) / self.tolerance,
        }
    }

    /// Finds the rates at the end of the leap. Returns the largest estimated error of one of `steps`
    /// steps, if there was any, and their root mean square where it counts.
    pub(super) fn find_rates(&mut self, steps: Option<f64>) -> (f64, f64) {
        let [c0, c1] = &mut self.c;
        let [rate0, rate1] = &mut self.rate;
        let binds = self.binding.is_some();
        // Dye flows by what c is once the baths have acted.
        let (flowing, baths) = match &mut self.baths {
            Some(baths) => {
                baths.look(c1, &mut self.soaked);
                (&mut self.soaked, Some((&*baths, c1.as_slice())))
            }
            None => (c1, None),
        };
        let squares = 0..if self.strict { self.lanes.grid.ny } else { 0 };
        let [a0, a1, _] = &self.a;
        let binding = self.binding.as_ref().filter(|_| self.strict);
        let turns = |steps| {
            binding.map(|binding| Turns {
                binding,
                a: [a0, a1],
                steps,
            })
        };
        let judge = steps.map(|steps| Judge {
            begin: c0,
            first_rate: rate0,
            change: binds.then_some(&self.a[2]),
            steps,
            turns: turns(steps),
            held: &self.held,
            worst: AtomicU32::new(0),
            squares: squares.map(|_| AtomicU64::new(0)).collect(),
        });
        let work = RatesOf {
            lanes: self.lanes,
            ways: &self.ways,
            law: self.law,
            baths,
            judge: judge.as_ref(),
        };
        let level = |free| Level {
            free,
            bound: &mut [],
            held: &mut [],
            brought: &mut [],
        };
        tiles::pass(&work, 1, [level(flowing), level(rate1)]);
        let cells = self.lanes.grid.len();
        let verdict = judge.map_or((0.0, 0.0), |judge| judge.verdict(cells));
        self.held.take_rates(&mut self.rate[1]);
        self.evaluations += 1;
        verdict
    }
}
