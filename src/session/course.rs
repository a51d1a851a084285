//! The course of the process: the ledger over time, for a plot.
//!
//! What has been seen once stays, also when one goes back; what is changed from a step on takes with
//! it what came after.

use std::collections::BTreeMap;

use bevy::prelude::*;

use crate::ledger::Ledger;
use crate::schedule::ProcessClock;

/// Ledgers by step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Course {
    points: BTreeMap<u64, Ledger>,
    step_h: f64,
}

/// One of the amounts of a ledger, in cell volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Account {
    /// All dye that entered the cloth.
    Supplied,
    /// Free dye in it.
    Free,
    /// Dye bound to its fibres.
    Bound,
    /// Dye that left it.
    Removed,
}

impl Account {
    /// All of them, in the order of a legend.
    pub const ALL: [Account; 4] = [
        Account::Supplied,
        Account::Free,
        Account::Bound,
        Account::Removed,
    ];

    /// What a legend calls it.
    pub fn name(self) -> &'static str {
        match self {
            Account::Supplied => "supplied",
            Account::Free => "free",
            Account::Bound => "bound",
            Account::Removed => "removed",
        }
    }

    /// This amount of a ledger.
    pub fn of(self, ledger: &Ledger) -> f64 {
        match self {
            Account::Supplied => ledger.supplied,
            Account::Free => ledger.free,
            Account::Bound => ledger.bound,
            Account::Removed => ledger.removed,
        }
    }
}

/// Points that are kept at the most; beyond, every other one is let go.
const MOST_POINTS: usize = 4096;

impl Course {
    /// Notes the ledger of a world that has just been looked at.
    pub fn note(&mut self, world: &World) {
        let clock = world.resource::<ProcessClock>();
        self.step_h = clock.step_h;
        self.points.insert(clock.step, *world.resource::<Ledger>());
        if self.points.len() > MOST_POINTS {
            let mut number = 0;
            self.points.retain(|_, _| {
                number += 1;
                number % 2 == 1
            });
        }
    }

    /// Forgets what was noted from `step` on.
    pub fn forget_from(&mut self, step: u64) {
        self.points.split_off(&step);
    }

    /// Points of one account in the order of time: hours and cell volumes.
    pub fn series(&self, account: Account) -> impl Iterator<Item = [f64; 2]> {
        let points = self.points.iter();
        points.map(move |(step, ledger)| [*step as f64 * self.step_h, account.of(ledger)])
    }

    /// The steps that were noted, each with its ledger.
    pub fn points(&self) -> impl Iterator<Item = (u64, &Ledger)> {
        self.points.iter().map(|(step, ledger)| (*step, ledger))
    }
}
