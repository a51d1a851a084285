//! The accelerated solver: the process in leaps, each as long as the tolerance allows.
//!
//! A leap covers many explicit steps with a few evaluations of the rate ([`rkl2`]). Its length is
//! chosen so that the estimated error of no cell's concentration passes the tolerance; a leap that
//! does is thrown away and done again shorter. The estimate compares the end of the leap with the
//! cubic through both ends and their rates (after Sommeijer, Shampine, Verwer, J. Comput. Appl.
//! Math. 88, 1998):
//!
//! e = ⅔·(c₀ − c₁) + ⅓·h·(F₀ + F₁)
//!
//! The same cubic gives the moments within a leap, so frames never shorten one, and however many
//! there are the process is the same.
//!
//! **Conservation.** Stages are sums of flows that cross a face both ways ([`kernel`](super::kernel)); what flows
//! into kept cells is followed with them ([`held`](super::held)) and booked. **Bounds.** Concentrations that
//! leave 0…1 by more than a tenth of the tolerance shorten the leap; what is left of rounding is put
//! right without loss ([`limiter`]), or, where the whole cloth is full, taken out and booked.

mod binding;
mod limiter;
mod rkl2;
mod stiffness;
mod work;

use std::ops::Range;
use std::sync::atomic::AtomicU32;

use bevy::prelude::*;
use rayon::prelude::*;

use self::binding::{Binding, Mix};
use self::work::{Judge, RatesOf, Stages};
use super::Faces;
use crate::cloth::Cloth;
use crate::diffusion::held::Held;
use crate::diffusion::lanes::{Cells, LANES, Lanes, Ways, unpack_row};
use crate::diffusion::passage::Law;
use crate::diffusion::tiles::{self, Level};

/// What the process does while a leap lasts.
#[derive(Debug, Clone, Copy)]
pub struct Chemistry {
    /// φ₀, as a share of the free capacity; 1: ρ = 1.
    pub equilibrium: f64,
    /// How dye binds, and the share of free dye that binds in a step.
    pub binding: Option<(crate::scenario::Isotherm, f64)>,
    /// The largest error that a cell's concentration may gain in a leap.
    pub tolerance: f64,
}

/// The process between two moments, and what is needed to go on.
#[derive(Resource, Debug)]
pub struct Leap {
    lanes: Lanes,
    ways: Vec<Ways>,
    law: Law,
    binding: Option<Binding>,
    tolerance: f64,
    /// The largest rate, per step.
    stiffness: f64,
    /// The largest share of itself that a cell exchanges in a step.
    exchange: f64,
    /// The steps where the leap begins and ends.
    span: Range<u64>,
    /// Where the process began to run undisturbed.
    begun: u64,
    /// c and dc/dt (by diffusion, per step) at the beginning and at the end.
    c: [Vec<Cells>; 2],
    rate: [Vec<Cells>; 2],
    /// A at the beginning and at the end, and room for a stage; empty where nothing binds.
    a: [Vec<Cells>; 3],
    held: Held,
    /// What flowed into each kept cell: at the last stage, and room for another.
    flowed: [Vec<f64>; 2],
    /// What had to be taken out of the cloth at the end of the leap, for it had no room.
    clipped: f64,
    /// What flowed into all kept cells by diffusion (and was clipped), and what they bound, in the
    /// whole leap.
    taken: f64,
    bound: f64,
    /// What of it is in the ledger already.
    booked: f64,
    /// Steps of the next leap, if nothing ends it earlier.
    next: u64,
    /// Evaluations of the rate so far.
    pub evaluations: u64,
    /// Leaps so far, and how many were thrown away.
    pub leaps: u64,
    /// Leaps that were thrown away.
    pub rejected: u64,
}

/// Leaps of up to so many steps are done step by step: no other way is cheaper.
const PLAIN: u64 = 3;

/// For so many steps after a beginning leaps are at most an eighth of the time since then, whatever
/// the estimate says. Edges are sharp then, and what the explicit solver makes of them, which is
/// the process as it is defined, differs from what its rate alone says.
const BEGINNING: u64 = 64;

/// Leaps of so many steps and more end with [`rkl2::calming`].
const CALMED: u64 = 100;

/// How a leap came out.
struct Outcome {
    /// The largest estimated error, in tolerances.
    error: f64,
    /// How far concentrations left 0…1, in tolerances.
    beyond: f64,
}

impl Leap {
    /// Prepares leaps on a cloth.
    pub fn new(cloth: &Cloth, faces: &Faces, step_h: f64, chemistry: Chemistry) -> Self {
        let lanes = Lanes::new(cloth.grid);
        let ways = lanes.ways(cloth, faces, step_h);
        let binding = chemistry
            .binding
            .map(|(isotherm, share)| Binding::new(isotherm, share, cloth, lanes));
        let binds = binding.as_ref().map_or(0.0, Binding::stiffness);
        let bound = stiffness::bound(lanes, &ways);
        let fresh = || vec![Cells::ZERO; lanes.len()];
        let room = || {
            if binding.is_some() {
                fresh()
            } else {
                Vec::new()
            }
        };
        let mut leap = Leap {
            stiffness: bound.sharp + binds,
            exchange: (bound.rough / 2.0).max(binds),
            a: [room(), room(), room()],
            lanes,
            ways,
            law: Law::of(chemistry.equilibrium),
            binding,
            tolerance: chemistry.tolerance,
            span: 0..0,
            begun: 0,
            c: [fresh(), fresh()],
            rate: [fresh(), fresh()],
            held: Held::default(),
            flowed: [Vec::new(), Vec::new()],
            clipped: 0.0,
            taken: 0.0,
            bound: 0.0,
            booked: 0.0,
            next: 1,
            evaluations: 0,
            leaps: 0,
            rejected: 0,
        };
        if leap.splits() > 1
            && let Some(binding) = &mut leap.binding
        {
            binding.moved = 0.0;
        }
        leap
    }

    /// Into how many parts the explicit solver would split a step of this process.
    pub fn splits(&self) -> u32 {
        (self.exchange / super::MOST_EXCHANGE).ceil().max(1.0) as u32
    }

    /// Whether the leap covers a step, or ends there.
    pub fn covers(&self, step: u64) -> bool {
        self.leaps > 0 && self.span.start <= step && step <= self.span.end
    }

    /// The most steps that the next leap may cover.
    fn longest(&self) -> u64 {
        match self.span.end - self.begun {
            since if since < BEGINNING => (since / 8).max(1),
            _ => u64::MAX,
        }
    }

    /// The steps that the leap covers.
    pub fn span(&self) -> Range<u64> {
        self.span.clone()
    }

    /// Begins anew at a step with other concentrations, bound dye or kept cells.
    pub fn begin(
        &mut self,
        step: u64,
        concentration: &[f32],
        bound: &[f32],
        kept: impl Iterator<Item = usize>,
    ) {
        self.span = step..step;
        self.begun = step;
        self.next = 1;
        self.lanes.pack(concentration, &mut self.c[1]);
        if self.binding.is_some() {
            self.lanes.pack(bound, &mut self.a[1]);
        }
        let all = self.binding.is_some();
        self.held = Held::new(self.lanes, &self.ways, kept, all);
        self.flowed = [0, 1].map(|_| vec![0.0; self.held.rim.len()]);
        self.find_rates(None);
    }

    /// Finds the rates at the end of the leap. Returns the estimated error of one of `steps` steps,
    /// if there was any.
    fn find_rates(&mut self, steps: Option<f64>) -> f64 {
        let [c0, c1] = &mut self.c;
        let [rate0, rate1] = &mut self.rate;
        let binds = self.binding.is_some();
        let judge = steps.map(|steps| Judge {
            begin: c0,
            first_rate: rate0,
            change: binds.then_some(&self.a[2]),
            steps,
            held: &self.held,
            worst: AtomicU32::new(0),
        });
        let work = RatesOf {
            lanes: self.lanes,
            ways: &self.ways,
            law: self.law,
            judge: judge.as_ref(),
        };
        let level = |free| Level {
            free,
            bound: &mut [],
            held: &mut [],
        };
        tiles::pass(&work, 1, [level(c1), level(rate1)]);
        let worst = judge.map_or(0, |judge| judge.worst.into_inner());
        self.held.take_rates(&mut self.rate[1]);
        self.evaluations += 1;
        f64::from(f32::from_bits(worst))
    }

    /// Leaps on from the end of the last leap, but not beyond `limit`.
    pub fn leap(&mut self, limit: u64) {
        self.c.swap(0, 1);
        self.rate.swap(0, 1);
        self.a.swap(0, 1);
        self.held.go_on();
        let begin = self.span.end;
        let most = limit.saturating_sub(begin).clamp(1, self.longest());
        loop {
            let steps = self.next.clamp(1, most);
            let outcome = self.attempt(steps);
            let too_far = outcome.error > 1.0 || outcome.beyond > 0.1;
            // The estimate falls with the third power of the length.
            let factor = 0.8 / libm::cbrt(outcome.error.max(1e-9));
            let factor = factor.clamp(0.2, if too_far { 0.5 } else { 3.0 });
            let next = ((steps as f64 * factor) as u64).max(1);
            // The step of the explicit solver is never too long.
            if too_far && steps > 1 {
                self.rejected += 1;
                self.next = next.min(steps - 1);
                continue;
            }
            // A leap that was cut short says little about how long the next may be.
            if steps < self.next {
                self.next = self.next.max(next);
            } else {
                self.next = next;
            }
            self.span = begin..begin + steps;
            self.leaps += 1;
            return;
        }
    }

    /// Does a leap of some steps.
    fn attempt(&mut self, steps: u64) -> Outcome {
        let h = steps as f64;
        let calm = if steps < CALMED {
            Vec::new()
        } else {
            rkl2::calming(self.stiffness)
        };
        let leap = h - calm.iter().sum::<f64>();
        // A few steps are done as the explicit solver does them, where it is stable.
        let stages = if steps <= PLAIN && self.splits() == 1 {
            vec![(1.0, rkl2::EULER); steps as usize]
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
        let outcome = self.finish(h);
        let flowed: f64 = self.flowed[0].iter().sum();
        self.taken = flowed + h * self.held.deep_inflow() + self.clipped;
        self.bound = self.kept_bound();
        self.booked = 0.0;
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
        let mixes = if self.law == Law::Fick && self.binding.is_none() {
            // Before the first stage nothing has changed: it is the first rate, times a number.
            let share = mixes[0].rate + mixes[0].first;
            let cells = c1.par_iter_mut().zip(&*rate0);
            cells.for_each(|(change, rate)| *change = rate.times(share));
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
            first_rate: rate0,
            binding: self.binding.as_ref(),
            mixes,
        };
        let [now, other] = &mut self.flowed;
        let levels = [
            Level {
                free: c1,
                bound: a1,
                held: now,
            },
            Level {
                free: rate1,
                bound: a2,
                held: other,
            },
        ];
        tiles::pass(&work, mixes.len(), levels);
        if mixes.len() % 2 == 1 {
            std::mem::swap(c1, rate1);
            std::mem::swap(a1, a2);
            self.flowed.swap(0, 1);
        }
    }

    /// Turns the changes into the state at the end of the leap, and judges it.
    fn finish(&mut self, h: f64) -> Outcome {
        let blocks = self.lanes.blocks;
        let binds = self.binding.is_some();
        // First how much changed in all, free and bound, for the estimate: kept in the place of
        // what the rates at the end will be added to.
        let [c0, c1] = &mut self.c;
        let [a0, a1, change] = &mut self.a;
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
        let error = self.find_rates(Some(h));
        Outcome {
            error: error / self.tolerance,
            beyond: f64::from(beyond) / self.tolerance,
        }
    }

    /// What kept cells have bound in the leap.
    fn kept_bound(&self) -> f64 {
        let grown = |cell: &crate::diffusion::held::HeldCell| {
            let at = |a: &[Cells]| f64::from(a[cell.block].0[cell.layer][cell.lane]);
            at(&self.a[1]) - at(&self.a[0])
        };
        match self.binding {
            Some(_) => self.held.rim.iter().map(grown).sum(),
            None => 0.0,
        }
    }

    /// Shows the process at a step within the leap. Returns the dye that supply brought to the kept
    /// cells since the last time it was asked.
    pub fn show(&mut self, step: u64, concentration: &mut [f32], bound: &mut [f32]) -> f64 {
        let (h, t) = (
            (self.span.end - self.span.start) as f64,
            (step - self.span.start) as f64,
        );
        let t = t / h;
        let cubic = Cubic::new(t, h);
        let (lanes, binds) = (self.lanes, self.binding.is_some());
        let nx = lanes.grid.nx;
        let (weft, warp) = concentration.split_at_mut(lanes.grid.layer_len());
        let layer = if binds { lanes.grid.layer_len() } else { 0 };
        let (weft_bound, warp_bound) = bound.split_at_mut(layer);
        let rows = weft.par_chunks_mut(nx).zip(warp.par_chunks_mut(nx));
        let this: &Leap = self;
        rows.enumerate().for_each(|(y, (weft, warp))| {
            let mut row = this.row_at(y, t, cubic);
            let ways = &this.ways[y * lanes.blocks..][..lanes.blocks];
            if !limiter::limit(&mut row, ways) {
                // Between two states within the bounds a straight line is within them too.
                row = this.row_at(y, t, Cubic::straight(t));
            }
            unpack_row(&row, [weft, warp]);
        });
        if binds {
            let rows = weft_bound
                .par_chunks_mut(nx)
                .zip(warp_bound.par_chunks_mut(nx));
            rows.enumerate().for_each(|(y, (weft, warp))| {
                unpack_row(&this.bound_at(y, t), [weft, warp]);
            });
        }
        let (first, last) = self.held.inflow();
        let flowed = cubic.rate0 * first + cubic.rate1 * last + cubic.y1 * self.taken;
        let supplied = t * self.bound - flowed;
        let since = supplied - self.booked;
        self.booked = supplied;
        since
    }

    /// Bound dye in a row at the share `t` of the leap.
    fn bound_at(&self, y: usize, t: f64) -> Vec<Cells> {
        let row = y * self.lanes.blocks..(y + 1) * self.lanes.blocks;
        let (from, to) = (&self.a[0][row.clone()], &self.a[1][row]);
        let t = t as f32;
        let between = |(a, b): (&Cells, &Cells)| {
            let mut cells = *a;
            let all = cells.0.as_flattened_mut().iter_mut();
            for (a, b) in all.zip(b.0.as_flattened()) {
                *a += t * (b - *a);
            }
            cells
        };
        from.iter().zip(to).map(between).collect()
    }

    /// Concentrations in a row at the share `t` of the leap: what is free of the total.
    fn row_at(&self, y: usize, t: f64, cubic: Cubic) -> Vec<Cells> {
        let row = y * self.lanes.blocks..(y + 1) * self.lanes.blocks;
        if t == 1.0 {
            return self.c[1][row].to_vec();
        }
        let now = |b: usize| {
            let [c0, c1] = [&self.c[0][b], &self.c[1][b]];
            let [r0, r1] = [&self.rate[0][b], &self.rate[1][b]];
            let mut cells = *c0;
            for l in 0..2 {
                for i in 0..LANES {
                    let at = |cells: &Cells| cells.0[l][i];
                    let rates = cubic.rate0 as f32 * at(r0) + cubic.rate1 as f32 * at(r1);
                    let change = at(c1) - at(c0);
                    let mut c = cubic.y1 as f32 * change + rates;
                    if self.binding.is_some() && (change != 0.0 || rates != 0.0) {
                        // The total follows the cubic, what is bound a line.
                        let grown = at(&self.a[1][b]) - at(&self.a[0][b]);
                        let per_capacity = self.ways[b].per_capacity[l][i];
                        c += (cubic.y1 - t) as f32 * grown * per_capacity;
                    }
                    cells.0[l][i] += c;
                }
            }
            cells
        };
        row.map(now).collect()
    }
}

/// The cubic through the ends of a leap: y = y₀ + y1·(y₁ − y₀) + rate0·F₀ + rate1·F₁.
#[derive(Debug, Clone, Copy)]
struct Cubic {
    y1: f64,
    rate0: f64,
    rate1: f64,
}

impl Cubic {
    fn new(t: f64, h: f64) -> Self {
        Cubic {
            y1: t * t * (3.0 - 2.0 * t),
            rate0: h * t * (1.0 - t) * (1.0 - t),
            rate1: h * t * t * (t - 1.0),
        }
    }

    fn straight(t: f64) -> Self {
        Cubic {
            y1: t,
            rate0: 0.0,
            rate1: 0.0,
        }
    }
}
