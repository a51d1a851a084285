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
//! The same cubic gives the moments within a leap ([`moments`]), so frames never shorten one, and
//! however many there are the process is the same.
//!
//! Where there are baths, which may do the same in every cell, errors count in the root mean square
//! as well, and so do those of the moments between where a cell has bound all it can ([`turns`]).
//!
//! **Conservation.** Stages are sums of flows that cross a face both ways
//! ([`kernel`](super::kernel)); what flows into kept cells is followed with them
//! ([`held`](super::held)) and booked, and so is what baths bring ([`baths`]). **Bounds.**
//! Concentrations that leave 0…1 by more than a tenth of the tolerance shorten the leap; what is left of
//! rounding is put right without loss ([`limiter`]), or, where the whole cloth is full, taken out and
//! booked.

mod attempt;
mod baths;
mod binding;
mod keep;
mod limiter;
mod moments;
mod rates;
mod rkl2;
mod stiffness;
mod turns;
mod work;

use std::ops::Range;

use bevy::prelude::*;

use self::attempt::PLAIN;
use self::baths::{Baths, Given};
use self::binding::Binding;
pub use self::keep::KeptLeap;
use super::Faces;
use crate::cloth::Cloth;
use crate::diffusion::held::Held;
use crate::diffusion::lanes::{Cells, Lanes, Ways};
use crate::diffusion::passage::Law;
use crate::supply::{Cell, Soaked};

/// What the process does while a leap lasts.
#[derive(Debug, Clone, Copy)]
pub struct Chemistry {
    /// φ₀, as a share of the free capacity; 1: ρ = 1.
    pub equilibrium: f64,
    /// How dye binds, and the share of free dye that binds in a step.
    pub binding: Option<(crate::scenario::Isotherm, f64)>,
    /// Whether there are baths at any time.
    pub baths: bool,
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
    /// Whether errors count in the root mean square as well, and where cells turn: where there are baths
    /// at any time.
    strict: bool,
    /// The largest rate, per step: of diffusion, and in all.
    spreads: f64,
    stiffness: f64,
    /// The largest share of itself that a cell exchanges in a step.
    exchange: f64,
    /// The steps where the leap begins and ends.
    span: Range<u64>,
    /// Where the process began to run undisturbed.
    begun: u64,
    /// c and dc/dt (by diffusion and baths, per step) at the beginning and at the end.
    c: [Vec<Cells>; 2],
    rate: [Vec<Cells>; 2],
    /// A at the beginning and at the end, and room for a stage; empty where nothing binds.
    a: [Vec<Cells>; 3],
    held: Held,
    /// What flowed into each kept cell: at the last stage, and room for another.
    flowed: [Vec<f64>; 2],
    baths: Option<Baths>,
    /// c once the baths have acted; empty where there are none.
    soaked: Vec<Cells>,
    /// What they gave and took in each block: at the last stage, and room for another.
    given: [Vec<Given>; 2],
    /// For so many steps after a beginning steps are taken as the explicit solver takes them.
    soaking: u64,
    /// What had to be taken out of the cloth at the end of the leap, for it had no room.
    clipped: f64,
    /// What baths gave and took in the whole leap.
    brought: Given,
    /// What the ledger said before the leap, and when this leap last wrote there: what has been supplied
    /// is added to the former, so that the sum does not depend on how often it was asked for. None
    /// before the first time.
    booked: Option<[Given; 2]>,
    /// What has been done so far would have been the same whatever happens from this step on.
    depends: u64,
    /// Steps of the next leap, if nothing ends it earlier.
    next: u64,
    /// Evaluations of the rate so far.
    pub evaluations: u64,
    /// Leaps so far, and how many were thrown away.
    pub leaps: u64,
    /// Leaps that were thrown away.
    pub rejected: u64,
}

/// For so many steps after a beginning leaps are at most an eighth of the time since then, whatever
/// the estimate says. Edges are sharp then, and what the explicit solver makes of them, which is
/// the process as it is defined, differs from what its rate alone says.
const BEGINNING: u64 = 64;

/// Where there are baths leaps of up to so many parts of steps are done as the explicit solver does
/// them, and are never too long: where a bath feeds fibre, all happens within a few steps when the fibre
/// has enough.
const PLAIN_IN_BATHS: u64 = 8;

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
        Leap {
            spreads: bound.sharp,
            stiffness: bound.sharp + binds,
            exchange: (bound.rough / 2.0).max(binds),
            a: [room(), room(), room()],
            lanes,
            ways,
            law: Law::of(chemistry.equilibrium),
            binding,
            tolerance: chemistry.tolerance,
            strict: chemistry.baths,
            span: 0..0,
            begun: 0,
            c: [fresh(), fresh()],
            rate: [fresh(), fresh()],
            held: Held::default(),
            flowed: [Vec::new(), Vec::new()],
            baths: None,
            soaked: Vec::new(),
            given: [Vec::new(), Vec::new()],
            soaking: 0,
            clipped: 0.0,
            brought: [0.0; 2],
            booked: None,
            depends: 0,
            next: 1,
            evaluations: 0,
            leaps: 0,
            rejected: 0,
        }
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
            since if since < self.soaking => (since / 8).clamp(1, self.longest_plain()),
            since if since < BEGINNING => (since / 8).max(1),
            _ => u64::MAX,
        }
    }

    /// The most steps that a leap takes one by one, as the explicit solver does.
    fn longest_plain(&self) -> u64 {
        let splits = u64::from(self.splits());
        match self.baths {
            // However many parts a step has, as long as they matter.
            Some(_) if self.span.end - self.begun < self.soaking => {
                (PLAIN_IN_BATHS / splits).max(1)
            }
            Some(_) => PLAIN_IN_BATHS / splits,
            None if splits == 1 => PLAIN,
            None => 0,
        }
    }

    /// Leaps of so many steps end as the explicit solver's do, and what they show of any cell between
    /// is good enough.
    fn never_too_long(&self) -> u64 {
        let smooth = match (&self.baths, &self.binding) {
            (None, _) => 1,
            (Some(_), None) => u64::MAX,
            (Some(_), Some(binding)) => turns::smooth_for(binding, self.tolerance),
        };
        smooth.clamp(1, self.longest_plain().max(1))
    }

    /// The steps that the leap covers.
    pub fn span(&self) -> Range<u64> {
        self.span.clone()
    }

    /// Begins anew at a step with other concentrations, bound dye, kept cells or cells that baths
    /// reach.
    pub fn begin(
        &mut self,
        step: u64,
        concentration: &[f32],
        bound: &[f32],
        kept: &[Cell],
        soaked: &[Soaked],
    ) {
        self.span = step..step;
        self.begun = step;
        self.next = 1;
        self.lanes.pack(concentration, &mut self.c[1]);
        if self.binding.is_some() {
            self.lanes.pack(bound, &mut self.a[1]);
        }
        // What flows from one kept cell to another stays what it is only where rates are of changes.
        let all = self.binding.is_some() || self.law != Law::Fick;
        let kept = kept.iter().map(|(i, _)| *i as usize);
        self.held = Held::new(self.lanes, &self.ways, kept, all);
        self.flowed = [0, 1].map(|_| vec![0.0; self.held.rim.len()]);
        self.baths = Baths::new(self.lanes, &self.ways, self.splits(), soaked);
        let blocks = self.baths.as_ref().map_or(0, |_| self.lanes.len());
        self.given = [0, 1].map(|_| vec![[0.0; 2]; blocks]);
        self.soaked = vec![Cells::ZERO; blocks];
        self.booked = None;
        let baths = self.baths.as_ref();
        let binds = self.binding.as_ref().map_or(0.0, Binding::stiffness);
        let error = self.tolerance / 20.0;
        self.soaking = baths.map_or(0, |baths| baths.soaking(error, binds));
        let spreads = self.spreads;
        self.stiffness = baths.map_or(spreads, |baths| baths.stiffness(spreads)) + binds;
        self.bind_after_moving();
        self.find_rates(None);
    }

    /// Says of what dye binds a share: see [`Binding::moved`].
    fn bind_after_moving(&mut self) {
        let splits = self.splits();
        if let Some(binding) = &mut self.binding {
            binding.moved = match self.baths {
                Some(_) => 1.0 / splits as f32,
                None if splits == 1 => 1.0,
                None => 0.0,
            };
        }
    }

    /// Leaps on from the end of the last leap, but not beyond `limit`.
    pub fn leap(&mut self, limit: u64) {
        self.c.swap(0, 1);
        self.rate.swap(0, 1);
        self.a.swap(0, 1);
        self.held.go_on();
        if let Some(baths) = &mut self.baths {
            baths.go_on();
        }
        let begin = self.span.end;
        let most = limit.saturating_sub(begin).clamp(1, self.longest());
        let never_too_long = self.never_too_long();
        let wanted = begin.saturating_add(self.next.clamp(1, self.longest()));
        self.depends = self.depends.max(match wanted > limit {
            true => limit.saturating_add(1),
            false => wanted,
        });
        loop {
            let steps = self.next.clamp(1, most);
            let outcome = self.attempt(steps);
            let too_far = outcome.beyond > 0.1
                || outcome.rms > 1.0
                || (outcome.worst > 1.0 && steps > never_too_long);
            // The estimates fall with the third power of the length.
            let reach = |error: f64| {
                let factor = 0.8 / libm::cbrt(error.max(1e-9));
                let factor = factor.clamp(0.2, if too_far { 0.5 } else { 3.0 });
                ((steps as f64 * factor) as u64).max(1)
            };
            let next = reach(outcome.worst).max(never_too_long);
            let next = next.min(reach(outcome.rms));
            // The step of the explicit solver is never too long.
            if too_far && steps > 1 {
                self.rejected += 1;
                if let Some(baths) = &mut self.baths {
                    baths.look(&self.c[0], &mut self.soaked);
                }
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
}
