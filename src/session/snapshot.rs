//! A moment of the process, kept: everything that a run of [`DyeStep`](crate::schedule::DyeStep) changes.
//!
//! **Law.** Taken at a step, put back (in the same world or in another one prepared for the same
//! experiment) and gone on from, it leads to the same bits as a run that was never interrupted.
//!
//! | of | is kept | follows from the experiment |
//! |---|---|---|
//! | [`ProcessClock`] | all | |
//! | [`FreeDye`] | c, what rounding left over | room for the next step |
//! | [`BoundDye`], [`Ledger`] | all | |
//! | [`Supplies`] | which events are done, since when what is kept is kept | cells, holds, baths |
//! | [`Leap`] | both ends of the leap with their rates, or one where the process is at its end; kept cells, baths | conductances, isotherm |
//! | [`Batik`] | which actions have begun, fixed dyes, the bath's dye | wax, exchange, colours |
//!
//! Whether someone has changed the dye since the solver last saw it is kept as well: the solver begins
//! anew then.

use bevy::prelude::*;

use crate::adsorption::BoundDye;
use crate::batik::keep::KeptBatik;
use crate::batik::stage::Batik;
use crate::diffusion::{FreeDye, KeptLeap, Leap, Steps, changed_since};
use crate::ledger::Ledger;
use crate::schedule::ProcessClock;
use crate::supply::{Supplies, SupplyProgress};

/// A moment of the process.
#[derive(Debug, Clone)]
pub struct Snapshot {
    clock: ProcessClock,
    concentration: Vec<f32>,
    carry: Vec<f32>,
    bound: BoundDye,
    ledger: Ledger,
    supply: SupplyProgress,
    leap: Option<KeptLeap>,
    batik: Option<KeptBatik>,
    /// Whether the dye was changed after the solver did its work.
    disturbed: bool,
    depends: u64,
    effort: u64,
}

impl Snapshot {
    /// Keeps this moment of a prepared world.
    pub fn take(world: &World) -> Self {
        let clock = *world.resource::<ProcessClock>();
        let free = world.resource::<FreeDye>();
        let supplies = world.resource::<Supplies>();
        let leap = world.get_resource::<Leap>();
        let leap = leap.map(|leap| leap.keep(clock.step));
        let supply = supplies.progress();
        let acted = supply.has_acted(supplies, clock.step);
        let so_far = clock.step + u64::from(acted || clock.part > 0);
        let depends = leap.as_ref().map_or(0, KeptLeap::depends).max(so_far);
        Snapshot {
            clock,
            concentration: free.concentration.clone(),
            carry: free.carry.clone(),
            bound: world.resource::<BoundDye>().clone(),
            ledger: *world.resource::<Ledger>(),
            supply,
            leap,
            batik: world.get_resource::<Batik>().map(Batik::keep),
            disturbed: is_disturbed(world),
            depends,
            effort: effort(world),
        }
    }

    /// Puts this moment back into a world that is prepared for the same experiment, or for one that
    /// differs from it only from step [`Snapshot::depends`] on.
    pub fn restore(&self, world: &mut World) {
        if self.disturbed {
            self.restore_solver(world);
            world.increment_change_tick();
            self.restore_dye(world);
        } else {
            self.restore_dye(world);
            self.restore_solver(world);
        }
        // What is changed from now on is changed later than the solver.
        world.increment_change_tick();
    }

    fn restore_dye(&self, world: &mut World) {
        let mut free = world.resource_mut::<FreeDye>();
        free.concentration.clone_from(&self.concentration);
        free.carry.clone_from(&self.carry);
        let mut bound = world.resource_mut::<BoundDye>();
        bound.amount.clone_from(&self.bound.amount);
        bound.carry.clone_from(&self.bound.carry);
        world.resource_mut::<Supplies>().resume(self.supply);
        *world.resource_mut::<Ledger>() = self.ledger;
        *world.resource_mut::<ProcessClock>() = self.clock;
        if let (Some(mut batik), Some(kept)) = (world.get_resource_mut::<Batik>(), &self.batik) {
            batik.resume(kept);
        }
    }

    fn restore_solver(&self, world: &mut World) {
        if let (Some(mut leap), Some(kept)) = (world.get_resource_mut::<Leap>(), &self.leap) {
            leap.resume(kept);
        }
        if let Some(mut steps) = world.get_resource_mut::<Steps>() {
            steps.set_changed();
        }
    }

    /// The clock of this moment.
    pub fn clock(&self) -> ProcessClock {
        self.clock
    }

    /// The step from which on supply, or the end of the process, may be changed without anything
    /// being otherwise up to this moment. Later than the moment itself where the accelerated solver
    /// had looked ahead, or supply has acted already.
    pub fn depends(&self) -> u64 {
        self.depends
    }

    /// The same, of the accelerated solver alone: whatever supply does at this moment.
    pub fn looks_ahead_to(&self) -> u64 {
        self.leap.as_ref().map_or(0, KeptLeap::depends)
    }

    /// How much had to be computed up to this moment: see [`effort`].
    pub fn effort(&self) -> u64 {
        self.effort
    }

    /// Bytes of memory, at the most.
    pub fn bytes(&self) -> usize {
        let floats = [
            &self.concentration,
            &self.carry,
            &self.bound.amount,
            &self.bound.carry,
        ];
        floats
            .map(|field| size_of_val(field.as_slice()))
            .iter()
            .sum::<usize>()
            + self.leap.as_ref().map_or(0, KeptLeap::bytes)
            + self.batik.as_ref().map_or(0, KeptBatik::bytes)
            + size_of::<Self>()
    }
}

/// As much as a scan takes, in units of an explicit step of the same cloth.
const STEPS_A_SCAN: u64 = 8;

/// How much had to be computed up to this moment of a world: evaluations of the rate, steps, or what
/// scans are worth.
pub fn effort(world: &World) -> u64 {
    if let Some(leap) = world.get_resource::<Leap>() {
        return leap.evaluations;
    }
    let clock = world.resource::<ProcessClock>();
    let scans = world.get_resource::<Batik>().is_some_and(Batik::sweeps);
    let each = if scans { STEPS_A_SCAN } else { 1 };
    each * (clock.step * u64::from(clock.splits) + u64::from(clock.part))
}

/// Whether a moment is at rest: between steps, and at the end of a leap. Such a moment takes the least
/// memory, and leaps that follow are the same whether or not someone stopped here.
pub fn is_at_rest(world: &World) -> bool {
    let clock = world.resource::<ProcessClock>();
    let leap = world.get_resource::<Leap>();
    clock.part == 0 && leap.is_none_or(|leap| leap.rests_at(clock.step))
}

/// Whether someone has changed the dye after the solver did its work.
fn is_disturbed(world: &World) -> bool {
    let now = world.read_change_tick();
    let Some(free) = world.get_resource_ref::<FreeDye>() else {
        return false;
    };
    if let Some(leap) = world.get_resource_ref::<Leap>() {
        let bound = world.get_resource_ref::<BoundDye>();
        let supplies = world.get_resource_ref::<Supplies>();
        return changed_since(&free, &leap, now)
            || bound.is_some_and(|bound| changed_since(&bound, &leap, now))
            || supplies.is_some_and(|supplies| changed_since(&supplies, &leap, now));
    }
    let steps = world.get_resource_ref::<Steps>();
    steps.is_some_and(|steps| changed_since(&free, &steps, now))
}
