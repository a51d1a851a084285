//! The timeline: moments kept within a budget of memory, so that any step is reached soon, forwards
//! and backwards.
//!
//! Moments are kept only [at rest](super::snapshot::is_at_rest), and evenly spread over what had to be
//! *computed*, not over steps: leaps of the accelerated solver are short at first and long later. When
//! memory is full, the moment goes whose neighbours lie closest together. The last moment at rest is
//! kept besides, for whoever paints at this moment goes back there.
//!
//! **Whatever the way, a step shows the same cloth.** Where the accelerated solver stops does not
//! shorten its leaps, and moments between their ends are computed from both ends; explicit steps and
//! scans are what they are. So fields agree bit for bit with those of a run straight from the
//! beginning, and with those of a recording. Of the ledger that is true as well but where explicit
//! steps are taken many at a time, or a batik's scans are booked: there it is the same sum, added up
//! in other parts, and may differ in its last bits.

use bevy::prelude::*;

use super::snapshot::{Snapshot, effort, is_at_rest};
use crate::schedule::{Prepare, ProcessClock, advance_to};

/// Moments of a process.
#[derive(Debug, Clone)]
pub struct Timeline {
    budget: usize,
    /// In the order of their steps.
    kept: Vec<Snapshot>,
    /// The last moment at rest.
    last: Option<Snapshot>,
    /// The least effort between two kept moments.
    spacing: u64,
}

/// The least effort between two kept moments, as long as there is room. To keep one takes as long as some
/// ten evaluations of the rate; so it costs little beside what it may save.
const CLOSEST: u64 = 64;

/// The least effort between two that are the last one at rest.
const LAST: u64 = 16;

impl Timeline {
    /// A timeline that keeps at most so many bytes.
    pub fn new(budget: usize) -> Self {
        Timeline {
            budget,
            kept: Vec::new(),
            last: None,
            spacing: CLOSEST,
        }
    }

    /// Bytes that it may keep.
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// Bytes that it keeps.
    pub fn bytes(&self) -> usize {
        let all = self.kept.iter().chain(&self.last);
        all.map(Snapshot::bytes).sum()
    }

    /// The steps that are kept, in order.
    pub fn steps(&self) -> impl Iterator<Item = u64> {
        self.kept.iter().map(|kept| kept.clock().step)
    }

    /// The last moment that is kept at or before `step`.
    pub fn nearest_before(&self, step: u64) -> Option<&Snapshot> {
        let after = self.kept.partition_point(|kept| kept.clock().step <= step);
        let kept = after.checked_sub(1).map(|i| &self.kept[i]);
        let last = self.last.as_ref().filter(|last| last.clock().step <= step);
        match (kept, last) {
            (Some(kept), Some(last)) if kept.clock().step >= last.clock().step => Some(kept),
            (kept, last) => last.or(kept),
        }
    }

    /// Forgets every moment that would be otherwise if something is changed from `step` on: supply, or the
    /// end of the process.
    pub fn forget_after(&mut self, step: u64) {
        self.kept.retain(|kept| kept.depends() <= step);
        self.last.take_if(|last| last.depends() > step);
    }

    /// Forgets everything.
    pub fn forget_all(&mut self) {
        *self = Timeline::new(self.budget);
    }

    /// Keeps this moment, if it is worth it.
    pub fn note(&mut self, world: &World) {
        if !is_at_rest(world) {
            return;
        }
        let (step, now) = (world.resource::<ProcessClock>().step, effort(world));
        let at = self.kept.partition_point(|kept| kept.clock().step < step);
        let after = self.kept.get(at);
        // The first time counts: supply may have acted here since.
        let is_here = |kept: &Snapshot| kept.clock().step == step;
        if after.is_some_and(is_here) || self.last.as_ref().is_some_and(is_here) {
            return;
        }
        let before = at.checked_sub(1).map(|i| self.kept[i].effort());
        let apart =
            |other: Option<u64>| other.is_none_or(|other| other.abs_diff(now) >= self.spacing);
        let is_wanted = apart(before) && apart(after.map(Snapshot::effort));
        // Only leaps look ahead, so only then is there anything to go back for.
        let leaps = world.contains_resource::<crate::diffusion::Leap>();
        if is_wanted {
            self.kept.insert(at, Snapshot::take(world));
            self.last = None;
        } else if leaps {
            let last = self.last.as_ref().map(Snapshot::effort);
            if [last, before]
                .into_iter()
                .flatten()
                .all(|old| old.abs_diff(now) >= LAST)
            {
                self.last = Some(Snapshot::take(world));
            }
        }
        self.thin_out();
    }

    /// Lets moments go until the rest fits.
    fn thin_out(&mut self) {
        let mut bytes = self.bytes();
        while bytes > self.budget {
            let crowded = (1..self.kept.len().saturating_sub(1))
                .min_by_key(|i| self.kept[i + 1].effort() - self.kept[i - 1].effort());
            let gone = match (crowded, self.kept.len()) {
                (Some(i), _) => self.kept.remove(i),
                (None, 2) => self.kept.remove(1),
                (None, _) => match self.last.take().or_else(|| self.kept.pop()) {
                    Some(gone) => gone,
                    None => return,
                },
            };
            bytes -= gone.bytes();
            let all = self.kept.last().map_or(0, Snapshot::effort);
            self.spacing = self.spacing.max(all / (2 * self.kept.len().max(1) as u64));
        }
    }

    /// Brings a prepared world to a step, from the nearest moment there is: this one, a kept one, or the
    /// beginning. `go_on` is asked before every run of the process, and told the step; where it says no
    /// the world stays between, and the same call goes on from there later.
    ///
    /// Returns whether the step was reached.
    pub fn go_to(
        &mut self,
        world: &mut World,
        step: u64,
        mut go_on: impl FnMut(u64) -> bool,
    ) -> bool {
        self.note(world);
        let clock = *world.resource::<ProcessClock>();
        let is_past = (clock.step, clock.part) > (step, 0);
        match self.nearest_before(step) {
            Some(kept) if is_past || kept.clock().step > clock.step => kept.restore(world),
            None if is_past => {
                world.run_schedule(Prepare);
                self.note(world);
            }
            _ => {}
        }
        loop {
            let clock = world.resource::<ProcessClock>();
            if clock.step >= step {
                return true;
            }
            if !go_on(clock.step) {
                return false;
            }
            let mut once = true;
            advance_to(world, step, |_| std::mem::take(&mut once));
            self.note(world);
        }
    }
}
