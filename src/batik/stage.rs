//! The stage of batik: its recipe is worked through as the clock goes on.
//!
//! Every bath is a process of its own. When it ends all its dye is fixed in the cloth, or only what
//! was bound where the cloth is rinsed; the next dye moves in clean water. Colours of several dyes are
//! mixed subtractively ([`mixing`](super::mixing)). Wax is seen until it is boiled off.

use std::borrow::Cow;
use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::mixing::{Dyestuff, Mixture};
use super::picture::Colours;
use super::recipe::{Action, Recipe, Wax, WaxedBath};
use super::sweep::{Classes, Dye, Exchange, ExchangeSpec, PixelDiffusing};
use super::wax::{WaxLayer, WaxLook};
use crate::adsorption::BoundDye;
use crate::cloth::Cloth;
use crate::diffusion::FreeDye;
use crate::ledger::Ledger;
use crate::pattern::Raster;
use crate::scenario::{
    BatikShow, BatikSolver, BatikSpec, BatikStep, MOST_BATHS, Reading, Scenario, Side,
};
use crate::schedule::{
    DyeFrame, DyeSet, DyeStep, FrameSet, Prepare, PrepareSet, ProcessClock, TheExperiment,
};
use crate::supply::SupplySystems;
use crate::texture::{DrawDye, OtherSide, Picture, Rgb, Texture, darkest_at, to_rgb};

/// Batik, where the scenario has a recipe for it.
pub struct BatikPlugin;

impl Plugin for BatikPlugin {
    fn build(&self, app: &mut App) {
        let is_batik = resource_exists::<Batik>;
        app.configure_sets(DyeFrame, DrawDye.run_if(not(is_batik)))
            .add_systems(
                Prepare,
                prepare
                    .in_set(PrepareSet::Stages)
                    .before(crate::supply::prepare),
            )
            .add_systems(
                DyeStep,
                (
                    turn.in_set(DyeSet::Supply)
                        .before(SupplySystems)
                        .run_if(is_batik),
                    scan.in_set(DyeSet::Diffusion).run_if(is_batik),
                ),
            )
            .add_systems(
                DyeFrame,
                (
                    (turn, gather)
                        .chain()
                        .in_set(FrameSet::Supply)
                        .before(SupplySystems)
                        .run_if(is_batik),
                    measure
                        .in_set(FrameSet::Measure)
                        .after(crate::ledger::balance)
                        .run_if(is_batik),
                    draw.in_set(FrameSet::Draw).after(DrawDye).run_if(is_batik),
                ),
            );
    }
}

/// A batik in the making.
#[derive(Resource)]
pub struct Batik {
    pub(super) recipe: Recipe,
    /// The actions that have begun; one more once the last has ended.
    pub(super) begun: usize,
    pub(super) wax: Option<Arc<Wax>>,
    /// The action that laid the wax on.
    pub(super) waxed_by: usize,
    /// The wax as it is seen from either side, face first; made when a side is first looked at.
    pub(super) layers: [Option<WaxLayer>; 2],
    /// What is fixed of earlier dyes, `(layer, y, x)`.
    pub(super) fixed: Vec<Arc<Vec<f32>>>,
    pub(super) mixture: Mixture,
    /// The amount that the mixture takes for full, under the solvers of paper D.
    pub(super) full: f64,
    /// What cells exchange in sweeps; none where the solvers of paper D move the dye.
    pub(super) exchange: Option<Exchange>,
    /// The bath that the cloth hangs in.
    pub(super) sweeps: Option<PixelDiffusing>,
    /// What of its account is in the ledger.
    pub(super) booked: f64,
    pub(super) show: BatikShow,
    pub(super) show_wax: bool,
    pub(super) seed: u64,
}

/// A map of the cloth as it is seen from one side.
fn as_seen(map: &Raster, side: Side) -> Cow<'_, Raster> {
    match side {
        Side::Face => Cow::Borrowed(map),
        Side::Back => Cow::Owned(map.mirrored()),
    }
}

/// The cloth and its dye.
#[derive(SystemParam)]
struct Vat<'w> {
    cloth: Res<'w, Cloth>,
    free: ResMut<'w, FreeDye>,
    bound: ResMut<'w, BoundDye>,
    ledger: ResMut<'w, Ledger>,
}

fn prepare(mut commands: Commands, cloth: Res<Cloth>, experiment: Res<TheExperiment>) {
    let scenario = &experiment.scenario;
    let (Some(spec), Some(recipe)) = (&scenario.batik, Recipe::of(&experiment)) else {
        return;
    };
    commands.insert_resource(Batik {
        recipe,
        begun: 0,
        wax: None,
        waxed_by: 0,
        layers: [None, None],
        fixed: Vec::new(),
        mixture: mixture(spec, darkest_at(scenario)),
        full: darkest_at(scenario),
        exchange: exchange(spec, scenario, &cloth),
        sweeps: None,
        booked: 0.0,
        show: spec.show,
        show_wax: spec.show_wax,
        seed: scenario.seed,
    });
}

/// The dyes of a recipe on its cloth; `full` is how much of one a cell of paper D holds.
pub(super) fn mixture(spec: &BatikSpec, full: f64) -> Mixture {
    let undyed = to_rgb(spec.cloth);
    let dyestuff = |step: &BatikStep| match step {
        BatikStep::Dye { colour, bath, .. } => {
            let full = match spec.sweeps() {
                true => 1.0 + bath.most_bound,
                false => full,
            };
            Some(Dyestuff::of_colour(to_rgb(*colour), undyed, full as f32))
        }
        _ => None,
    };
    Mixture::new(undyed, spec.steps.iter().filter_map(dyestuff).collect())
}

fn exchange(spec: &BatikSpec, scenario: &Scenario, cloth: &Cloth) -> Option<Exchange> {
    let BatikSolver::PixelDiffusing { reading, step } = spec.solver else {
        return None;
    };
    let exchange = ExchangeSpec {
        in_water: 1.93 * step,
        classes: match reading {
            Reading::Physical => Classes::PHYSICAL,
            Reading::Printed => Classes::PRINTED,
        },
        ..ExchangeSpec::default()
    };
    Some(Exchange::of(cloth, &exchange, scenario.seed))
}

impl Batik {
    /// The wax on the cloth now.
    pub fn wax(&self) -> Option<&Wax> {
        self.wax.as_deref()
    }

    /// How often f had to be truncated in the bath that the cloth hangs in; it never is.
    pub fn truncated(&self) -> u64 {
        let sweeps = self.sweeps.as_ref();
        sweeps.map_or(0, |sweeps| sweeps.account().truncated)
    }

    /// The baths that are supply to the solvers of paper D.
    pub(crate) fn baths(&self) -> impl Iterator<Item = WaxedBath<'_>> {
        let baths = self.exchange.is_none().then(|| self.recipe.baths());
        baths.into_iter().flatten()
    }

    /// Lays wax on, with the action that does so, or takes all off.
    pub(super) fn lay(&mut self, wax: Option<(usize, Arc<Wax>)>) {
        self.layers = [None, None];
        self.waxed_by = wax.as_ref().map_or(0, |(by, _)| *by);
        self.wax = wax.map(|(_, wax)| wax);
    }

    /// Whether something is to begin or to end at a step.
    fn is_due(&self, step: u64) -> bool {
        let begins = self.recipe.begins.get(self.begun);
        begins.is_some_and(|begins| *begins <= step)
    }

    /// Begins the actions that are due, and ends those before them. Does nothing the second time at
    /// one moment.
    fn turn(&mut self, step: u64, vat: &mut Vat) {
        while self.is_due(step) {
            let before = self.begun.checked_sub(1);
            if let Some(Action::Dye { rinse, .. }) = before.map(|i| &self.recipe.actions[i]) {
                self.fix(*rinse, vat);
            }
            match self.recipe.actions.get(self.begun) {
                None => {}
                Some(Action::Wax(wax)) => {
                    let wax = wax.clone();
                    self.lay(Some((self.begun, wax)));
                }
                Some(Action::Boil) => {
                    self.lay(None);
                }
                Some(Action::Dye { bath, .. }) => {
                    let (nx, ny) = (vat.cloth.grid.nx, vat.cloth.grid.ny);
                    let open = Raster::uniform(nx, ny, 1.0);
                    let p = self.wax.as_ref().map_or(&open, |wax| &wax.permeation);
                    let none = Dye::none(nx, ny);
                    let begin = |exchange| PixelDiffusing::new(exchange, p, bath, &none);
                    self.sweeps = self.exchange.as_ref().map(begin);
                    self.booked = 0.0;
                }
            }
            self.begun += 1;
        }
    }

    /// Ends a bath: its dye is fixed in the cloth, all of it or, where it is rinsed, what was bound.
    fn fix(&mut self, rinse: bool, vat: &mut Vat) {
        self.book(&mut vat.ledger);
        let (loose, mut fixed) = match self.sweeps.take() {
            Some(sweeps) => {
                let Dye { free, bound } = sweeps.dye();
                (free, bound)
            }
            None => {
                let mut fixed = vat.bound.amount.clone();
                fixed.resize(vat.cloth.grid.len(), 0.0);
                (vat.free.amounts(&vat.cloth), fixed)
            }
        };
        if rinse {
            vat.ledger.book(-sum(&loose));
        } else {
            let both = fixed.iter_mut().zip(&loose);
            both.for_each(|(fixed, loose)| *fixed += loose);
        }
        vat.free.wash();
        vat.bound.amount.fill(0.0);
        vat.bound.carry.fill(0.0);
        self.fixed.push(Arc::new(fixed));
    }

    /// Books what sweeps have supplied, and made or lost by changing cells in place, since the last
    /// time.
    fn book(&mut self, ledger: &mut Ledger) {
        if let Some(sweeps) = &self.sweeps {
            let account = sweeps.account();
            let all = account.supplied + account.made;
            ledger.book(all - self.booked);
            self.booked = all;
        }
    }
}

fn sum(field: &[f32]) -> f64 {
    field.iter().map(|v| f64::from(*v)).sum()
}

fn turn(mut batik: ResMut<Batik>, clock: Res<ProcessClock>, mut vat: Vat) {
    if batik.is_due(clock.step) {
        batik.turn(clock.step, &mut vat);
    }
}

/// One scan.
fn scan(mut batik: ResMut<Batik>) {
    if let Some(sweeps) = &mut batik.sweeps {
        sweeps.scan();
    }
}

/// Brings the dye of the sweeps to where everyone looks for it.
fn gather(mut batik: ResMut<Batik>, mut vat: Vat) {
    batik.book(&mut vat.ledger);
    if let Some(sweeps) = &batik.sweeps {
        let dye = sweeps.dye();
        vat.free.concentration = dye.free;
        vat.bound.amount = dye.bound;
    }
}

/// Takes stock of earlier dyes, and of all dye where amounts are not those of paper D's cells.
fn measure(batik: Res<Batik>, mut vat: Vat) {
    if batik.exchange.is_some() {
        vat.ledger.free = sum(&vat.free.concentration);
        vat.ledger.bound = vat.bound.total();
    }
    let fixed: f64 = batik.fixed.iter().map(|fixed| sum(fixed)).sum();
    vat.ledger.bound += fixed;
}

/// Draws all dyes on the cloth, and the wax; or a map of the wax alone.
fn draw(
    mut batik: ResMut<Batik>,
    texture: Res<Texture>,
    experiment: Res<TheExperiment>,
    cloth: Res<Cloth>,
    (free, bound): (Res<FreeDye>, Res<BoundDye>),
    mut picture: ResMut<Picture>,
    other: Option<ResMut<OtherSide>>,
) {
    let full = darkest_at(&experiment.scenario);
    if let Some(spec) = experiment
        .scenario
        .batik
        .as_ref()
        .filter(|_| full != batik.full)
    {
        // Someone looks at it in another way.
        batik.mixture = mixture(spec, full);
        batik.full = full;
    }
    let now = match batik.exchange {
        Some(_) => {
            // Before the first bath nothing is bound, and there is no field of it.
            let all = free.concentration.iter().enumerate();
            all.map(|(i, f)| f + bound.at(i)).collect()
        }
        None => texture.amounts(&cloth, &free, &bound),
    };
    batik.draw_side(&cloth, &texture, &now, &mut picture);
    if let Some(mut other) = other {
        let OtherSide { texture, picture } = &mut *other;
        batik.draw_side(&cloth, texture, &now, picture);
    }
}

impl Batik {
    /// Draws the side of the cloth that a texture is for; `now` is the dye of the running bath.
    fn draw_side(&mut self, cloth: &Cloth, texture: &Texture, now: &[f32], picture: &mut Picture) {
        let side = texture.side;
        let map = match (self.show, &self.wax) {
            (BatikShow::Cloth, _) => None,
            (_, None) => Some(&Raster::uniform(cloth.grid.nx, cloth.grid.ny, 1.0)),
            (BatikShow::Drawing, Some(wax)) => Some(&wax.drawing),
            (BatikShow::Permeation, Some(wax)) => Some(&wax.permeation),
        };
        if let Some(map) = map {
            texture.draw_map(&as_seen(map, side), picture);
            return;
        }
        let colour = |i: usize| -> Rgb {
            let mut amounts = [0.0; MOST_BATHS + 1];
            for (amount, fixed) in amounts.iter_mut().zip(&self.fixed) {
                *amount = fixed[i];
            }
            amounts[self.fixed.len()] = now[i];
            self.mixture.colour(&amounts)
        };
        texture.draw_colours(cloth, colour, picture);
        let (true, Some(wax)) = (self.show_wax, &self.wax) else {
            return;
        };
        let layer = self.layers[side as usize].get_or_insert_with(|| {
            let seen = as_seen(&wax.drawing, side);
            let seed = self.seed.wrapping_add(self.waxed_by as u64);
            WaxLayer::new(&seen, WaxLook::default(), seed)
        });
        let Picture { width, height, rgb } = picture;
        let pixels = rgb.as_chunks::<3>().0;
        let cloth = Colours::of(*width, *height, |y, x| {
            pixels[y * *width + x].map(|channel| f32::from(channel) / 255.0)
        });
        *rgb = layer.over(&cloth).bytes();
    }
}
