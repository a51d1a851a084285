//! The ledger: all dye that ever entered the cloth is free, bound, or removed again.
//!
//! Amounts are in cell volumes: a cell that is nothing but dye counts 1. Sums are kept and taken in
//! double precision, in a fixed order.

use bevy::prelude::*;

use crate::adsorption::BoundDye;
use crate::cloth::Cloth;
use crate::diffusion::FreeDye;
use crate::schedule::{DyeFrame, FrameSet, Prepare, PrepareSet};

/// Accounts of the dye.
pub struct LedgerPlugin;

impl Plugin for LedgerPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, open.in_set(PrepareSet::Cloth))
            .add_systems(DyeFrame, balance.in_set(FrameSet::Measure));
    }
}

/// What went in and out, and the last balance taken.
#[derive(Resource, Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// All dye that was given to the cloth.
    pub supplied: f64,
    /// All dye that was taken out of it again.
    pub removed: f64,
    /// Free dye at the last balance.
    pub free: f64,
    /// Bound dye at the last balance.
    pub bound: f64,
}

impl Ledger {
    /// Books dye that entered (positive) or left (negative) the cloth.
    pub fn book(&mut self, amount: f64) {
        if amount >= 0.0 {
            self.supplied += amount;
        } else {
            self.removed -= amount;
        }
    }

    /// What the accounts miss: supplied − (free + bound + removed). Nothing but rounding.
    pub fn imbalance(&self) -> f64 {
        self.supplied - (self.free + self.bound + self.removed)
    }
}

fn open(mut commands: Commands) {
    commands.insert_resource(Ledger::default());
}

pub(crate) fn balance(
    mut ledger: ResMut<Ledger>,
    cloth: Res<Cloth>,
    free: Res<FreeDye>,
    bound: Res<BoundDye>,
) {
    ledger.free = free.total(&cloth);
    ledger.bound = bound.total();
}
