//! A batik in the making, kept to go on from there later; and the same batik looked at in another way.

use std::sync::Arc;

use super::recipe::{Action, Wax};
use super::stage::{Batik, mixture};
use super::sweep::{Account, Dye, PixelDiffusing};
use crate::pattern::Raster;
use crate::scenario::Scenario;
use crate::texture::darkest_at;

/// How far a batik has come. Its wax follows from the recipe.
#[derive(Debug, Clone)]
pub struct KeptBatik {
    begun: usize,
    fixed: Vec<Arc<Vec<f32>>>,
    /// The bath that the cloth hangs in, where dye moves in sweeps.
    sweeps: Option<(Dye, Account)>,
    booked: f64,
}

impl KeptBatik {
    /// Bytes of memory at the most: baths that are over are shared between moments.
    pub fn bytes(&self) -> usize {
        let fixed = self.fixed.iter().map(|fixed| fixed.len()).sum::<usize>();
        let moving = self
            .sweeps
            .as_ref()
            .map_or(0, |(dye, _)| dye.free.len() + dye.bound.len());
        (fixed + moving) * size_of::<f32>() + size_of::<Self>()
    }
}

impl Batik {
    /// Whether dye moves in sweeps.
    pub(crate) fn sweeps(&self) -> bool {
        self.exchange.is_some()
    }

    /// What is needed to go on from here.
    pub(crate) fn keep(&self) -> KeptBatik {
        KeptBatik {
            begun: self.begun,
            fixed: self.fixed.clone(),
            sweeps: self
                .sweeps
                .as_ref()
                .map(|sweeps| (sweeps.dye(), sweeps.account())),
            booked: self.booked,
        }
    }

    /// Goes on from what was kept once, of the same recipe.
    pub(crate) fn resume(&mut self, kept: &KeptBatik) {
        let bath_goes_on = self.begun == kept.begun;
        if self.waxed(self.begun).map(|(i, _)| i) != self.waxed(kept.begun).map(|(i, _)| i)
            || self.wax.is_none()
        {
            let waxed = self.waxed(kept.begun).map(|(i, wax)| (i, wax.clone()));
            self.lay(waxed);
        }
        self.begun = kept.begun;
        self.fixed.clone_from(&kept.fixed);
        self.booked = kept.booked;
        match (&kept.sweeps, &mut self.sweeps) {
            (None, sweeps) => *sweeps = None,
            (Some((dye, account)), Some(sweeps)) if bath_goes_on => sweeps.resume(dye, *account),
            (Some((dye, account)), _) => self.sweeps = self.hang(dye, *account),
        }
    }

    /// The wax after so many actions, and which action laid it on.
    fn waxed(&self, begun: usize) -> Option<(usize, &Arc<Wax>)> {
        let actions = self.recipe.actions.iter().take(begun).enumerate();
        actions
            .rev()
            .find_map(|(i, action)| match action {
                Action::Wax(wax) => Some(Some((i, wax))),
                Action::Boil => Some(None),
                Action::Dye { .. } => None,
            })
            .flatten()
    }

    /// The bath that has begun last, with dye in the cloth already.
    fn hang(&self, dye: &Dye, account: Account) -> Option<PixelDiffusing> {
        let action = self.recipe.actions.get(self.begun.checked_sub(1)?)?;
        let (Action::Dye { bath, .. }, Some(exchange)) = (action, &self.exchange) else {
            return None;
        };
        let open = Raster::uniform(exchange.nx, exchange.ny, 1.0);
        let p = self.wax.as_ref().map_or(&open, |wax| &wax.permeation);
        let mut sweeps = PixelDiffusing::new(exchange, p, bath, dye);
        sweeps.resume(dye, account);
        Some(sweeps)
    }

    /// Takes over what a scenario says of how its batik is seen: its colours, what is shown.
    pub(crate) fn look_as(&mut self, scenario: &Scenario) {
        let Some(spec) = &scenario.batik else { return };
        (self.show, self.show_wax) = (spec.show, spec.show_wax);
        self.full = darkest_at(scenario);
        self.mixture = mixture(spec, self.full);
    }
}
