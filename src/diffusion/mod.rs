//! Dye moves: Fick's second law on the layered grid (paper D §4.2a, eqs 1–5; model section 2).
//!
//! Owns the free dye ([`FreeDye`]) and what the faces let through ([`Conductances`]).

mod accelerated;
mod explicit;
mod faces;
mod held;
mod kernel;
mod lanes;
mod passage;
mod peer;
mod steps;
mod tiles;

use bevy::ecs::change_detection::Tick;
use bevy::ecs::system::{SystemChangeTick, SystemParam};
use bevy::prelude::*;
use rayon::prelude::*;

pub use accelerated::{Chemistry, KeptLeap, Leap};
pub(crate) use explicit::add;
pub use explicit::step;
pub use faces::Faces;
pub use peer::Peer;
pub use steps::Steps;

use crate::adsorption::BoundDye;
use crate::cloth::{Cloth, Grid, Layer};
use crate::ledger::Ledger;
use crate::scenario::Solver;
use crate::schedule::{DyeSet, DyeStep, Prepare, PrepareSet, ProcessClock, TheExperiment};
use crate::supply::Supplies;

/// Diffusion of free dye through the pores.
pub struct DiffusionPlugin;

impl Plugin for DiffusionPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Stages))
            .add_systems(
                DyeStep,
                (
                    steps::many_steps.run_if(resource_exists::<Steps>),
                    one_step.run_if(resource_exists::<Conductances>),
                    leap.run_if(resource_exists::<Leap>),
                )
                    .chain()
                    .in_set(DyeSet::Diffusion),
            );
    }
}

/// Cells that are summed in one go.
pub(crate) const CELLS_A_SUM: usize = 1 << 14;

/// Free dye: the concentration c = φ/V_u of the liquid in every cell, 0 to 1, as `(layer, y, x)`.
#[derive(Resource, Debug, Clone, PartialEq)]
pub struct FreeDye {
    /// The concentration at this moment.
    pub concentration: Vec<f32>,
    /// What rounding has left over in each cell: it holds `concentration + carry`. Only the explicit
    /// solver, whose changes are smaller than the last bit, keeps it; else it is empty.
    pub carry: Vec<f32>,
    /// Where the explicit solver computes the next step.
    next: Vec<f32>,
}

impl FreeDye {
    /// Clean water in every cell, for a solver.
    pub fn clean(grid: Grid, solver: Solver) -> Self {
        let kept = match solver {
            Solver::Explicit => grid.len(),
            Solver::Accelerated => 0,
        };
        FreeDye {
            concentration: vec![0.0; grid.len()],
            carry: vec![0.0; kept],
            next: vec![0.0; kept],
        }
    }

    /// φ = c·V_u of every cell, `(layer, y, x)`.
    pub fn amounts(&self, cloth: &Cloth) -> Vec<f32> {
        let amount = |(i, c): (usize, &f32)| {
            let (layer, y, x) = cloth.grid.place(i);
            c * cloth.capacity_free(layer, y, x)
        };
        self.concentration.iter().enumerate().map(amount).collect()
    }

    /// Washes all free dye out of the cloth.
    pub fn wash(&mut self) {
        self.concentration.fill(0.0);
        self.carry.fill(0.0);
    }

    /// What a cell holds, to the last bit.
    fn exactly(&self, i: usize) -> f64 {
        let carry = self.carry.get(i).copied().unwrap_or(0.0);
        f64::from(self.concentration[i]) + f64::from(carry)
    }

    /// The free dye in the whole cloth: Σ φ = Σ c·V_u, in cell volumes.
    pub fn total(&self, cloth: &Cloth) -> f64 {
        let Grid { nx, ny } = cloth.grid;
        let amounts = |of: &[f32]| {
            let row = |(row, cells): (usize, &[f32])| -> f64 {
                let (layer, y) = (Layer::BOTH[row / ny], row % ny);
                let amount = |(x, c): (usize, &f32)| {
                    f64::from(*c) * f64::from(cloth.capacity_free(layer, y, x))
                };
                cells.iter().enumerate().map(amount).sum()
            };
            // Collected in order, so that no number of threads changes the sum.
            let sums: Vec<f64> = of.par_chunks(nx.max(1)).enumerate().map(row).collect();
            sums.iter().sum::<f64>()
        };
        amounts(&self.concentration) + amounts(&self.carry)
    }

    /// Brings a cell to a concentration; returns by how much it grew, to be booked in the ledger.
    pub fn bring(&mut self, i: usize, concentration: f32) -> f64 {
        let before = self.exactly(i);
        self.concentration[i] = concentration;
        if let Some(carry) = self.carry.get_mut(i) {
            *carry = 0.0;
        }
        f64::from(concentration) - before
    }

    /// Adds to the concentration of a cell; returns by how much it grew, to be booked in the ledger.
    pub fn grow(&mut self, i: usize, change: f32) -> f64 {
        let before = self.exactly(i);
        let carry = self.carry.get(i).copied().unwrap_or(0.0);
        let (concentration, carry) = add(self.concentration[i], carry, change);
        self.concentration[i] = concentration;
        if let Some(kept) = self.carry.get_mut(i) {
            *kept = carry;
        }
        self.exactly(i) - before
    }
}

/// What the faces of the cloth let through in one (split) step: G = Δt/Δd² · D_face · min(V_u),
/// and what the explicit solver needs to be stable.
#[derive(Resource, Debug, Clone)]
pub struct Conductances {
    /// The size of the fields.
    pub grid: Grid,
    /// Face between `x` and `x + 1`, `(layer, y, x)`; 0 in the last column.
    pub east: Vec<f32>,
    /// Face between `y` and `y + 1`, `(layer, y, x)`; 0 in the last row.
    pub south: Vec<f32>,
    /// Face between the layers, `(y, x)`.
    pub beside: Vec<f32>,
    /// 1/V_u, `(layer, y, x)`; 0 in a cell that holds no liquid.
    pub per_capacity: Vec<f32>,
    /// Into how many parts a step must be split to keep 0 ≤ c ≤ 1; 1 for paper D's parameters.
    pub splits: u32,
}

/// The most that a cell may exchange in one split step, as a share of itself: see
/// [`explicit`] for why the margin is there.
pub(crate) const MOST_EXCHANGE: f64 = 1.0 - 1.0 / 65536.0;

impl Conductances {
    /// The conductances of a cloth for steps of `step_h` hours.
    ///
    /// `most_bound_a_step` is the largest share of its free dye that a cell may bind in one step;
    /// the step is split for it as well.
    pub fn new(cloth: &Cloth, faces: &Faces, step_h: f64, most_bound_a_step: f64) -> Self {
        let grid = cloth.grid;
        let scale = step_h / (cloth.cell_mm * cloth.cell_mm);
        let capacity = |layer, y, x| f64::from(cloth.capacity_free(layer, y, x));
        let east = cloth.field(|layer, y, x| {
            if x + 1 == grid.nx {
                return 0.0;
            }
            let narrower = capacity(layer, y, x).min(capacity(layer, y, x + 1));
            scale * faces.x(layer, y, x) * narrower
        });
        let south = cloth.field(|layer, y, x| {
            if y + 1 == grid.ny {
                return 0.0;
            }
            let narrower = capacity(layer, y, x).min(capacity(layer, y + 1, x));
            scale * faces.y(layer, y, x) * narrower
        });
        let mut beside = vec![0.0; grid.layer_len()];
        beside
            .par_chunks_mut(grid.nx)
            .enumerate()
            .for_each(|(y, row)| {
                for (x, g) in row.iter_mut().enumerate() {
                    let narrower = capacity(Layer::Weft, y, x).min(capacity(Layer::Warp, y, x));
                    *g = (scale * faces.z(y, x) * narrower) as f32;
                }
            });
        let per_capacity = cloth.field(|layer, y, x| {
            let capacity = capacity(layer, y, x);
            if capacity > 0.0 { 1.0 / capacity } else { 0.0 }
        });
        let mut conductances = Conductances {
            grid,
            east,
            south,
            beside,
            per_capacity,
            splits: 1,
        };
        let exchange = conductances.largest_exchange().max(most_bound_a_step);
        conductances.split((exchange / MOST_EXCHANGE).ceil().max(1.0));
        conductances
    }

    /// The largest Σ_j a_ij: how much of itself a cell exchanges in one step.
    fn largest_exchange(&self) -> f64 {
        let Grid { nx, ny } = self.grid;
        (0..2 * ny)
            .into_par_iter()
            .map(|row| {
                let (y, at) = (row % ny, row * nx);
                let exchange = |x: usize| {
                    let i = at + x;
                    let west = if x > 0 { self.east[i - 1] } else { 0.0 };
                    let north = if y > 0 { self.south[i - nx] } else { 0.0 };
                    let around = [
                        self.east[i],
                        west,
                        self.south[i],
                        north,
                        self.beside[y * nx + x],
                    ];
                    let sum: f64 = around.iter().map(|g| f64::from(*g)).sum();
                    sum * f64::from(self.per_capacity[i])
                };
                (0..nx).map(exchange).fold(0.0, f64::max)
            })
            .reduce(|| 0.0, f64::max)
    }

    fn split(&mut self, splits: f64) {
        self.splits = splits.min(f64::from(u32::MAX)) as u32;
        if self.splits > 1 {
            let share = (1.0 / f64::from(self.splits)) as f32;
            for field in [&mut self.east, &mut self.south, &mut self.beside] {
                field.par_iter_mut().for_each(|g| *g *= share);
            }
        }
    }
}

fn prepare(
    mut commands: Commands,
    mut clock: ResMut<ProcessClock>,
    cloth: Res<Cloth>,
    experiment: Res<TheExperiment>,
) {
    let scenario = &experiment.scenario;
    if scenario.sweeps() {
        // Paper B's sweeps move the dye: see `batik`.
        commands.insert_resource(FreeDye::clean(cloth.grid, Solver::Accelerated));
        return;
    }
    let faces = Faces {
        cloth: &cloth,
        paths: &scenario.cloth.paths,
        in_water: scenario.dye.diffusivity.in_water(),
    };
    let binding = scenario.adsorption.map(|adsorption| {
        let share = crate::adsorption::share_a_step(&adsorption, scenario);
        (adsorption.isotherm, share)
    });
    let step_h = scenario.process.step_h;
    let solver = scenario.process.solver;
    match solver {
        Solver::Explicit => {
            let most = binding.map_or(0.0, |(_, share)| share);
            let conductances = Conductances::new(&cloth, &faces, step_h, most);
            clock.splits = conductances.splits;
            clock.splits_if_explicit = conductances.splits;
            // Where something else happens in every step, steps are taken one by one.
            let equilibrium = scenario.dye.equilibrium;
            if binding.is_none() && !scenario.has_baths() && conductances.splits == 1 {
                drop(conductances);
                commands.insert_resource(Steps::new(&cloth, &faces, step_h, equilibrium));
            } else {
                commands.insert_resource(conductances);
            }
        }
        Solver::Accelerated => {
            let chemistry = Chemistry {
                equilibrium: scenario.dye.equilibrium,
                binding,
                baths: scenario.has_baths(),
                tolerance: scenario.process.tolerance,
            };
            let leap = Leap::new(&cloth, &faces, step_h, chemistry);
            clock.splits_if_explicit = leap.splits();
            commands.insert_resource(leap);
        }
    }
    commands.insert_resource(FreeDye::clean(cloth.grid, solver));
}

/// Whether something was changed after a solver last did its work. Unlike Bevy's own `is_changed` this
/// does not ask when a system ran, so a state that is put back is no change.
pub(crate) fn changed_since(
    what: &impl DetectChanges,
    solver: &impl DetectChanges,
    now: Tick,
) -> bool {
    what.last_changed()
        .is_newer_than(solver.last_changed(), now)
}

/// One step of the explicit solver.
fn one_step(
    mut dye: ResMut<FreeDye>,
    conductances: Res<Conductances>,
    experiment: Res<TheExperiment>,
) {
    let FreeDye {
        concentration,
        carry,
        next,
    } = &mut *dye;
    let equilibrium = experiment.scenario.dye.equilibrium;
    explicit::step(&conductances, equilibrium, concentration, carry, next);
    std::mem::swap(concentration, next);
}

/// All dye in the cloth.
#[derive(SystemParam)]
struct Dyed<'w> {
    dye: ResMut<'w, FreeDye>,
    bound: ResMut<'w, BoundDye>,
}

/// As many steps as the clock asks for and one leap covers. What binds meanwhile binds here, for
/// it belongs to the same change.
fn leap(
    mut leap: ResMut<Leap>,
    mut clock: ResMut<ProcessClock>,
    dyed: Dyed,
    supplies: Res<Supplies>,
    mut ledger: ResMut<Ledger>,
    experiment: Res<TheExperiment>,
    ticks: SystemChangeTick,
) {
    let Dyed { mut dye, mut bound } = dyed;
    // Whoever else changed the dye (supply, a stage of one's own) began a new process.
    let now = ticks.this_run();
    let changed = changed_since(&dye, &leap, now)
        || changed_since(&bound, &leap, now)
        || changed_since(&supplies, &leap, now);
    if changed || !leap.covers(clock.step) {
        let kept = supplies.kept_at(clock.step);
        let soaked = supplies.soaked_at(clock.step, leap.splits());
        leap.begin(
            clock.step,
            &dye.concentration,
            &bound.amount,
            &kept,
            &soaked,
        );
    }
    if leap.span().end == clock.step {
        // The next change of supply ends a leap, and so does the end of the process.
        let end = experiment.scenario.process.steps();
        let end = if clock.step < end { end } else { u64::MAX };
        leap.leap(supplies.next_change(clock.step).min(end));
    }
    let shown = leap.span().end.min(clock.until);
    clock.stride = shown - clock.step;
    let dye = &mut *dye;
    let bound = &mut bound.amount;
    leap.show(shown, &mut dye.concentration, bound, &mut ledger);
}
