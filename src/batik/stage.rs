//! The stage of batik: a recipe of wax, dye and boiling, as the clock goes on.
//!
//! Every bath is a process of its own. When it ends all its dye is fixed in the cloth, or only what
//! was bound where the cloth is rinsed; the next dye moves in clean water. Colours of several dyes are mixed
//! subtractively ([`mixing`](super::mixing)). Wax is seen until it is boiled off.

use bevy::prelude::*;

use super::crackle::Crackle;
use super::mixing::{Dyestuff, Mixture};
use super::permeation::permeation;
use super::picture::Colours;
use super::sweep::{BathSpec, Classes, Dye, Exchange, ExchangeSpec, PixelDiffusing};
use super::wax::{WaxLayer, WaxLook};
use crate::adsorption::BoundDye;
use crate::chance::Chance;
use crate::cloth::Cloth;
use crate::diffusion::FreeDye;
use crate::ledger::Ledger;
use crate::pattern::{Canvas, Raster};
use crate::scenario::{BatikShow, BatikSolver, BatikSpec, BatikStep, Experiment, Reading};
use crate::schedule::{
    DyeFrame, DyeSet, DyeStep, FrameSet, Prepare, PrepareSet, ProcessClock, TheExperiment,
};
use crate::texture::{Picture, Texture, darkest_at, to_rgb};

/// Batik, where the scenario has a recipe for it.
pub struct BatikPlugin;

impl Plugin for BatikPlugin {
    fn build(&self, app: &mut App) {
        let is_batik = resource_exists::<Batik>;
        app.add_systems(
            Prepare,
            prepare
                .in_set(PrepareSet::Stages)
                .run_if(|experiment: Res<TheExperiment>| experiment.scenario.batik.is_some()),
        )
        .add_systems(
            DyeStep,
            (
                turn.in_set(DyeSet::Supply)
                    .before(crate::supply::SupplySystems)
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
                    .before(crate::supply::SupplySystems)
                    .run_if(is_batik),
                measure
                    .in_set(FrameSet::Measure)
                    .after(crate::ledger::balance)
                    .run_if(is_batik),
                draw.in_set(FrameSet::Draw)
                    .after(crate::texture::draw)
                    .run_if(is_batik),
            ),
        );
    }
}

/// The wax on the cloth after one step of the recipe.
#[derive(Debug, Clone)]
pub struct Wax {
    /// I: 0 waxed, 1 open, with its cracks.
    pub drawing: Raster,
    /// p: how well it lets dye through, 0 to 1.
    pub permeation: Raster,
}

/// What one step of the recipe does.
#[derive(Debug, Clone)]
enum Action {
    /// The wax is this from now on.
    Wax(Wax),
    /// A bath, and whether the cloth is rinsed after it.
    Dye(BathSpec, bool),
    /// There is no wax any more.
    Boil,
}

/// A batik in the making.
#[derive(Resource)]
pub struct Batik {
    actions: Vec<Action>,
    /// Where each begins, and where the last one ends.
    begins: Vec<u64>,
    /// The actions that have begun.
    begun: usize,
    wax: Option<Wax>,
    /// The wax as it is seen.
    layer: Option<WaxLayer>,
    /// What was bound of earlier dyes, `(layer, y, x)`.
    settled: Vec<Vec<f32>>,
    mixture: Mixture,
    exchange: Option<Exchange>,
    /// The bath that the cloth hangs in.
    sweeps: Option<PixelDiffusing>,
    /// What of its account is in the ledger.
    booked: f64,
    show: BatikShow,
    show_wax: bool,
    seed: u64,
}

/// The wax after every step of a recipe, as the steps with wax lay it on; none without wax.
fn waxes(spec: &BatikSpec, canvas: &Canvas, experiment: &Experiment) -> Vec<Option<Wax>> {
    let mut now: Option<Wax> = None;
    let mut all = Vec::with_capacity(spec.steps.len());
    for (i, step) in spec.steps.iter().enumerate() {
        match step {
            BatikStep::Wax {
                drawing,
                waxed,
                pattern,
                crackle,
                edge,
                ..
            } => {
                let (nx, ny) = (canvas.nx, canvas.ny);
                let open = match (drawing, pattern) {
                    (Some(file), _) => match experiment.images.drawing(file) {
                        Some(drawing) => drawing.wax(nx, ny, *waxed),
                        None => Raster::uniform(nx, ny, 1.0),
                    },
                    (None, Some(pattern)) => {
                        let mut open = canvas.draw(pattern);
                        open.values.iter_mut().for_each(|v| *v = 1.0 - *v);
                        open
                    }
                    (None, None) => Raster::uniform(nx, ny, 1.0),
                };
                // Every layer of wax breaks in its own way.
                let chance = Chance(canvas.seed.wrapping_add(i as u64));
                let mut drawing = Crackle::grow(&open, crackle, None, chance).over(&open);
                if let Some(before) = &now {
                    let both = drawing.values.iter_mut().zip(&before.drawing.values);
                    both.for_each(|(open, before)| *open = open.min(*before));
                }
                let permeation = permeation(&drawing, edge);
                now = Some(Wax {
                    drawing,
                    permeation,
                });
            }
            BatikStep::Boil => now = None,
            BatikStep::Dye { .. } => {}
        }
        all.push(now.clone());
    }
    all
}

/// The baths of a recipe for the solvers of paper D: from when, until when, and what they are like, with p.
pub(crate) fn baths(experiment: &Experiment) -> Vec<(u64, u64, BathSpec, Raster)> {
    let scenario = &experiment.scenario;
    let Some(spec) = scenario.batik.as_ref().filter(|spec| !spec.sweeps()) else {
        return Vec::new();
    };
    let canvas = Canvas::of(experiment);
    let begins = spec.begins(scenario.process.step_h);
    let all = spec.steps.iter().zip(waxes(spec, &canvas, experiment));
    let each = all
        .zip(begins.windows(2))
        .filter_map(|((step, wax), span)| {
            let BatikStep::Dye { bath, .. } = step else {
                return None;
            };
            let open = || Raster::uniform(canvas.nx, canvas.ny, 1.0);
            let p = wax.map_or_else(open, |wax| wax.permeation);
            Some((span[0], span[1], *bath, p))
        });
    each.collect()
}

fn prepare(mut commands: Commands, cloth: Res<Cloth>, experiment: Res<TheExperiment>) {
    let scenario = &experiment.scenario;
    let Some(spec) = &scenario.batik else {
        return;
    };
    let canvas = Canvas::of(&experiment);
    let waxes = waxes(spec, &canvas, &experiment);
    let undyed = to_rgb(spec.cloth);
    let mut dyes = Vec::new();
    let mut actions = Vec::new();
    for (step, wax) in spec.steps.iter().zip(waxes) {
        actions.push(match (step, wax) {
            (BatikStep::Wax { .. }, Some(wax)) => Action::Wax(wax),
            (
                BatikStep::Dye {
                    colour,
                    bath,
                    rinse,
                    ..
                },
                _,
            ) => {
                let full = match spec.sweeps() {
                    true => (1.0 + bath.most_bound) as f32,
                    false => darkest_at(scenario) as f32,
                };
                dyes.push(Dyestuff::of_colour(to_rgb(*colour), undyed, full));
                Action::Dye(*bath, *rinse)
            }
            _ => Action::Boil,
        });
    }
    let exchange = match spec.solver {
        BatikSolver::PixelDiffusing { reading, step } => {
            let exchange = ExchangeSpec {
                in_water: 1.93 * step,
                classes: match reading {
                    Reading::Physical => Classes::PHYSICAL,
                    Reading::Printed => Classes::PRINTED,
                },
                ..ExchangeSpec::default()
            };
            Some(Exchange::of(&cloth, &exchange, scenario.seed))
        }
        BatikSolver::Diffusion => None,
    };
    commands.insert_resource(Batik {
        actions,
        begins: spec.begins(scenario.process.step_h),
        begun: 0,
        wax: None,
        layer: None,
        settled: Vec::new(),
        mixture: Mixture::new(undyed, dyes),
        exchange,
        sweeps: None,
        booked: 0.0,
        show: spec.show,
        show_wax: spec.show_wax,
        seed: scenario.seed,
    });
}

impl Batik {
    /// The wax on the cloth now.
    pub fn wax(&self) -> Option<&Wax> {
        self.wax.as_ref()
    }

    /// How often f had to be truncated in the bath that the cloth hangs in; it never is.
    pub fn truncated(&self) -> u64 {
        self.sweeps
            .as_ref()
            .map_or(0, |sweeps| sweeps.account().truncated)
    }

    /// Books what sweeps have supplied, and made or lost by changing cells in place, since the last time.
    fn book(&mut self, ledger: &mut Ledger) {
        if let Some(sweeps) = &self.sweeps {
            let account = sweeps.account();
            let all = account.supplied + account.made;
            ledger.book(all - self.booked);
            self.booked = all;
        }
    }

    /// Begins the actions that are due, and ends those before them. Does nothing the second time at one
    /// moment.
    fn turn(
        &mut self,
        step: u64,
        cloth: &Cloth,
        free: &mut Mut<FreeDye>,
        bound: &mut Mut<BoundDye>,
        ledger: &mut Ledger,
    ) {
        while self.begins[self.begun] <= step {
            let before = self.begun.checked_sub(1).and_then(|i| self.actions.get(i));
            if let Some(Action::Dye(_, rinse)) = before {
                self.fix(*rinse, cloth, free, bound, ledger);
            }
            match self.actions.get(self.begun) {
                None => {}
                Some(Action::Wax(wax)) => {
                    self.wax = Some(wax.clone());
                    let look = WaxLook::default();
                    let seed = self.seed.wrapping_add(self.begun as u64);
                    self.layer = Some(WaxLayer::new(&wax.drawing, look, seed));
                }
                Some(Action::Boil) => {
                    self.wax = None;
                    self.layer = None;
                }
                Some(Action::Dye(bath, _)) => {
                    let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
                    let open = || Raster::uniform(nx, ny, 1.0);
                    let p = self
                        .wax
                        .as_ref()
                        .map_or_else(open, |wax| wax.permeation.clone());
                    let none = Dye::none(nx, ny);
                    self.sweeps = self
                        .exchange
                        .as_ref()
                        .map(|exchange| PixelDiffusing::new(exchange, &p, bath, &none));
                    self.booked = 0.0;
                }
            }
            self.begun += 1;
            if self.begun == self.begins.len() {
                // Nothing more is due, ever.
                self.begins.push(u64::MAX);
            }
        }
    }

    /// Ends a bath: its dye is fixed in the cloth, all of it or, where it is rinsed, what was bound.
    fn fix(
        &mut self,
        rinse: bool,
        cloth: &Cloth,
        free: &mut Mut<FreeDye>,
        bound: &mut Mut<BoundDye>,
        ledger: &mut Ledger,
    ) {
        self.book(ledger);
        let (loose, mut fixed, washed) = match self.sweeps.take() {
            Some(sweeps) => {
                let Dye { free, bound } = sweeps.dye();
                let washed = free.iter().map(|f| f64::from(*f)).sum();
                (free, bound, washed)
            }
            None => {
                let capacity = |i: usize| {
                    let (layer, y, x) = cloth.grid.place(i);
                    cloth.capacity_free(layer, y, x)
                };
                let amounts = free.concentration.iter().enumerate();
                let loose = amounts.map(|(i, c)| c * capacity(i)).collect();
                let mut fixed = bound.amount.clone();
                fixed.resize(cloth.grid.len(), 0.0);
                (loose, fixed, free.total(cloth))
            }
        };
        if rinse {
            ledger.book(-washed);
        } else {
            let both = fixed.iter_mut().zip(&loose);
            both.for_each(|(fixed, loose)| *fixed += loose);
        }
        free.wash();
        bound.amount.fill(0.0);
        bound.carry.fill(0.0);
        self.settled.push(fixed);
    }

    /// What is bound of earlier dyes, in all.
    fn settled(&self) -> f64 {
        let sum = |field: &Vec<f32>| field.iter().map(|v| f64::from(*v)).sum::<f64>();
        self.settled.iter().map(sum).sum()
    }
}

fn turn(
    mut batik: ResMut<Batik>,
    clock: Res<ProcessClock>,
    cloth: Res<Cloth>,
    mut free: ResMut<FreeDye>,
    mut bound: ResMut<BoundDye>,
    mut ledger: ResMut<Ledger>,
) {
    if batik.begins[batik.begun] <= clock.step {
        let (mut free, mut bound) = (free.reborrow(), bound.reborrow());
        batik.turn(clock.step, &cloth, &mut free, &mut bound, &mut ledger);
    }
}

/// One scan.
fn scan(mut batik: ResMut<Batik>) {
    if let Some(sweeps) = &mut batik.sweeps {
        sweeps.scan();
    }
}

/// Shows the dye of the sweeps.
fn gather(
    mut batik: ResMut<Batik>,
    mut free: ResMut<FreeDye>,
    mut bound: ResMut<BoundDye>,
    mut ledger: ResMut<Ledger>,
) {
    batik.book(&mut ledger);
    if let Some(sweeps) = &batik.sweeps {
        let dye = sweeps.dye();
        free.concentration = dye.free;
        bound.amount = dye.bound;
    }
}

/// Takes stock where amounts are not those of paper D's cells, and of earlier dyes.
fn measure(
    batik: Res<Batik>,
    free: Res<FreeDye>,
    bound: Res<BoundDye>,
    mut ledger: ResMut<Ledger>,
) {
    if batik.exchange.is_some() {
        ledger.free = free.concentration.iter().map(|f| f64::from(*f)).sum();
        ledger.bound = bound.total();
    }
    ledger.bound += batik.settled();
}

/// Draws all dyes on the cloth, and the wax.
fn draw(
    batik: Res<Batik>,
    texture: Res<Texture>,
    cloth: Res<Cloth>,
    free: Res<FreeDye>,
    bound: Res<BoundDye>,
    mut picture: ResMut<Picture>,
) {
    let map = |wax: &Wax| match batik.show {
        BatikShow::Cloth => None,
        BatikShow::Drawing => Some(wax.drawing.clone()),
        BatikShow::Permeation => Some(wax.permeation.clone()),
    };
    if let Some(map) = batik.wax.as_ref().and_then(map) {
        // The same grey in both layers, without any cloth.
        let layer = map.values.len();
        let scale = texture.scale;
        let width = picture.width.max(1);
        let grey = |i: usize| {
            let (y, x) = (i / width / scale, i % width / scale);
            (255.0 * map.values[(y * map.nx + x) % layer] + 0.5) as u8
        };
        let pixels = picture.rgb.as_chunks_mut::<3>().0;
        pixels
            .iter_mut()
            .enumerate()
            .for_each(|(i, p)| *p = [grey(i); 3]);
        return;
    }
    let now = match batik.exchange {
        Some(_) => {
            let mut all = free.concentration.clone();
            let both = all.iter_mut().zip(&bound.amount);
            both.for_each(|(all, bound)| *all += bound);
            all
        }
        None => texture.amounts(&cloth, &free, &bound),
    };
    let colour = |i: usize| {
        let mut amounts: Vec<f32> = batik.settled.iter().map(|settled| settled[i]).collect();
        amounts.push(now[i]);
        batik.mixture.colour(&amounts)
    };
    texture.draw_colours(&cloth, colour, &mut picture);
    if let (true, Some(layer)) = (batik.show_wax, &batik.layer) {
        let Picture { width, height, rgb } = &mut *picture;
        let pixels = rgb.as_chunks::<3>().0;
        let cloth = Colours::of(*width, *height, |y, x| {
            pixels[y * *width + x].map(|channel| f32::from(channel) / 255.0)
        });
        *rgb = layer.over(&cloth).bytes();
    }
}
