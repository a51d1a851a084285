//! Dye binds: one way, in fibre only, up to what the isotherm and the fibre allow (paper D §4.2b,
//! eqs 6–8; model section 4).
//!
//! Each step binds ΔA = clamp( (D_ab·Δt/Δd²)·φ, 0, A_lim − A ) with A_lim = min(V_d, A_d(φ)), or
//! after paper B ΔA = α_d·(a_d − A)·φ.

use bevy::prelude::*;
use rayon::prelude::*;

use crate::cloth::Cloth;
use crate::diffusion::{CELLS_A_SUM, Conductances, FreeDye, add};
use crate::kasuri;
use crate::ledger::Ledger;
use crate::pattern::Canvas;
use crate::scenario::{AdsorptionSpec, Isotherm, Scenario, Solver};
use crate::schedule::{DyeSet, DyeStep, Prepare, PrepareSet, ProcessClock, TheExperiment};

/// Adsorption of dye by fibre.
pub struct AdsorptionPlugin;

impl Plugin for AdsorptionPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Stages))
            .add_systems(
                DyeStep,
                adsorption
                    .in_set(DyeSet::Adsorption)
                    .run_if(|experiment: Res<TheExperiment>| {
                        let scenario = &experiment.scenario;
                        scenario.adsorption.is_some() && scenario.process.solver == Solver::Explicit
                    }),
            );
    }
}

/// Bound dye A in every cell, as a share of its volume, `(layer, y, x)`. Empty in a cloth that
/// has none and binds none.
#[derive(Resource, Debug, Clone, PartialEq, Default)]
pub struct BoundDye {
    /// The amounts.
    pub amount: Vec<f32>,
    /// What rounding has left over in each cell: it holds `amount + carry`. Empty where the
    /// accelerated solver needs none.
    pub carry: Vec<f32>,
}

impl BoundDye {
    /// The bound dye in the whole cloth, in cell volumes.
    pub fn total(&self) -> f64 {
        let part = |of: &[f32]| of.iter().map(|a| f64::from(*a)).sum::<f64>();
        // In order, so that no number of threads changes the sum. Not `sum`: that of nothing is −0.
        let sum = |of: &[f32]| {
            let parts: Vec<f64> = of.par_chunks(CELLS_A_SUM).map(part).collect();
            parts.iter().fold(0.0, |sum, part| sum + part)
        };
        sum(&self.amount) + sum(&self.carry)
    }

    /// The bound dye of one cell.
    pub fn at(&self, i: usize) -> f32 {
        self.amount.get(i).copied().unwrap_or(0.0)
    }
}

/// D_ab·Δt/Δd², or α_d: the most of its free dye that a cell may bind in one whole step.
pub(crate) fn share_a_step(spec: &AdsorptionSpec, scenario: &Scenario) -> f64 {
    if let Isotherm::Saturating { speed, .. } = spec.isotherm {
        return speed;
    }
    let d_ab = spec.rate * scenario.dye.diffusivity.in_water();
    d_ab * scenario.process.step_h / (scenario.cloth.cell_mm * scenario.cloth.cell_mm)
}

impl Isotherm {
    /// A_d(φ): the most that fibre with bound capacity `v_d` binds beside φ of free dye.
    #[inline(always)]
    pub fn limit(self, phi: f32, v_d: f32) -> f32 {
        match self {
            Isotherm::Partition { k } => k as f32 * phi,
            // √ is exact and many times faster than a power.
            Isotherm::Freundlich { k, b: 0.5 } => k as f32 * phi.sqrt(),
            Isotherm::Freundlich { k, b } => k as f32 * libm::powf(phi, b as f32),
            Isotherm::Langmuir { kl } => {
                let filled = kl as f32 * phi;
                v_d * filled / (1.0 + filled)
            }
            Isotherm::Saturating { most, .. } => most as f32,
        }
    }
}

/// What one cell holds for adsorption.
#[derive(Debug, Clone, Copy)]
struct Pore {
    /// c, the concentration of its liquid, and what rounding has left over of it.
    c: f32,
    c_carry: f32,
    /// A, its bound dye, and what rounding has left over of it.
    a: f32,
    a_carry: f32,
    /// V_u and V_d, its capacities.
    v_u: f32,
    v_d: f32,
    /// 1/V_u, or 0.
    per_v_u: f32,
}

/// One step of one cell. `limit` is A_d(φ) for a given V_d.
///
/// `share` is D_ab·Δt/Δd² and less than 1. Neither limit is ever passed: a cell that already has
/// more than the isotherm allows by now keeps it and binds no more.
#[inline(always)]
fn bind(limit: impl Fn(f32, f32) -> f32, share: f32, pore: Pore) -> Pore {
    let phi = pore.c * pore.v_u;
    let limit = limit(phi, pore.v_d).min(pore.v_d);
    let room = (limit - pore.a - pore.a_carry).max(0.0);
    take(pore, (share * phi).min(room), limit)
}

/// One step of one cell after paper B: ΔA = α_d·(a_d − A)·φ, with `speed` α_d and `most` a_d.
#[inline(always)]
fn saturate(most: f32, speed: f32, pore: Pore) -> Pore {
    let limit = most.min(pore.v_d);
    let room = (limit - pore.a - pore.a_carry).max(0.0);
    take(pore, speed * room * (pore.c * pore.v_u), limit)
}

/// Takes `gained` out of the liquid and binds it, up to `limit` or to what is bound already.
#[inline(always)]
fn take(pore: Pore, gained: f32, limit: f32) -> Pore {
    let (c, c_carry) = add(pore.c, pore.c_carry, -gained * pore.per_v_u);
    let change = gained + pore.a_carry;
    // The bounds only decide which way the last bit is rounded; the carry keeps the rest.
    let a = (pore.a + change).min(limit.max(pore.a)).max(pore.a);
    Pore {
        c,
        c_carry,
        a,
        a_carry: change - (a - pore.a),
        ..pore
    }
}

/// Cells that one task binds.
const CELLS_A_TASK: usize = 1 << 14;

/// The capacities of every cell, for steps that need them again and again.
#[derive(Resource, Debug, Clone)]
pub struct Capacities {
    /// V_u.
    pub free: Vec<f32>,
    /// V_d.
    pub bound: Vec<f32>,
}

impl Capacities {
    /// Those of a cloth.
    pub fn of(cloth: &Cloth) -> Self {
        Capacities {
            free: cloth.field(|l, y, x| f64::from(cloth.capacity_free(l, y, x))),
            bound: cloth.field(|l, y, x| f64::from(cloth.capacity_bound(l, y, x))),
        }
    }
}

/// One (split) step of every cell. `share` is D_ab·Δt/Δd², or α_d.
pub fn step(
    isotherm: Isotherm,
    share: f32,
    capacities: &Capacities,
    per_capacity: &[f32],
    free: &mut FreeDye,
    bound: &mut BoundDye,
) {
    let tasks = free
        .concentration
        .par_chunks_mut(CELLS_A_TASK)
        .zip(free.carry.par_chunks_mut(CELLS_A_TASK))
        .zip(bound.amount.par_chunks_mut(CELLS_A_TASK))
        .zip(bound.carry.par_chunks_mut(CELLS_A_TASK))
        .zip(capacities.free.par_chunks(CELLS_A_TASK))
        .zip(capacities.bound.par_chunks(CELLS_A_TASK))
        .zip(per_capacity.par_chunks(CELLS_A_TASK));
    tasks.for_each(|((((((c, c_carry), a), a_carry), v_u), v_d), per_v_u)| {
        let pores = Pores {
            c,
            c_carry,
            a,
            a_carry,
            v_u,
            v_d,
            per_v_u,
        };
        bind_all(isotherm, share, pores);
    });
}

/// The fields of neighbouring cells, all of one length.
struct Pores<'a> {
    c: &'a mut [f32],
    c_carry: &'a mut [f32],
    a: &'a mut [f32],
    a_carry: &'a mut [f32],
    v_u: &'a [f32],
    v_d: &'a [f32],
    per_v_u: &'a [f32],
}

/// Binds dye in neighbouring cells. Each isotherm gets a loop of its own, in whole vectors.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn bind_all(isotherm: Isotherm, share: f32, pores: Pores) {
    match isotherm {
        Isotherm::Partition { k } => pores.each(|pore| {
            let limit = |phi, v_d| Isotherm::Partition { k }.limit(phi, v_d);
            bind(limit, share, pore)
        }),
        Isotherm::Freundlich { k, b: 0.5 } => pores.each(|pore| {
            let limit = |phi, v_d| Isotherm::Freundlich { k, b: 0.5 }.limit(phi, v_d);
            bind(limit, share, pore)
        }),
        Isotherm::Freundlich { k, b } => pores.each(|pore| {
            let limit = |phi, v_d| Isotherm::Freundlich { k, b }.limit(phi, v_d);
            bind(limit, share, pore)
        }),
        Isotherm::Langmuir { kl } => pores.each(|pore| {
            let limit = |phi, v_d| Isotherm::Langmuir { kl }.limit(phi, v_d);
            bind(limit, share, pore)
        }),
        Isotherm::Saturating { most, .. } => {
            pores.each(|pore| saturate(most as f32, share, pore));
        }
    }
}

impl Pores<'_> {
    #[inline(always)]
    fn each(self, bind: impl Fn(Pore) -> Pore) {
        // Slices of one known length let the compiler drop every bounds check.
        let n = self.c.len();
        let (c, c_carry) = (&mut self.c[..n], &mut self.c_carry[..n]);
        let (a, a_carry) = (&mut self.a[..n], &mut self.a_carry[..n]);
        let (v_u, v_d, per_v_u) = (&self.v_u[..n], &self.v_d[..n], &self.per_v_u[..n]);
        for i in 0..n {
            let pore = bind(Pore {
                c: c[i],
                c_carry: c_carry[i],
                a: a[i],
                a_carry: a_carry[i],
                v_u: v_u[i],
                v_d: v_d[i],
                per_v_u: per_v_u[i],
            });
            (c[i], c_carry[i]) = (pore.c, pore.c_carry);
            (a[i], a_carry[i]) = (pore.a, pore.a_carry);
        }
    }
}

fn prepare(
    mut commands: Commands,
    cloth: Res<Cloth>,
    experiment: Res<TheExperiment>,
    mut ledger: ResMut<Ledger>,
) {
    let scenario = &experiment.scenario;
    let (binds, explicit) = (
        scenario.adsorption.is_some(),
        scenario.process.solver == Solver::Explicit,
    );
    if binds && explicit {
        commands.insert_resource(Capacities::of(&cloth));
    }
    // What yarns bring that were dyed before they were woven was supplied to them then.
    let brought = kasuri::bound(
        &cloth,
        &scenario.cloth.kasuri.layers(),
        &Canvas::of(&experiment),
    );
    let amount = brought.unwrap_or_else(|| vec![0.0; if binds { cloth.grid.len() } else { 0 }]);
    let carry = vec![0.0; if binds && explicit { amount.len() } else { 0 }];
    let bound = BoundDye { amount, carry };
    ledger.book(bound.total());
    commands.insert_resource(bound);
}

fn adsorption(
    mut free: ResMut<FreeDye>,
    mut bound: ResMut<BoundDye>,
    clock: Res<ProcessClock>,
    capacities: Res<Capacities>,
    conductances: Res<Conductances>,
    experiment: Res<TheExperiment>,
) {
    let Some(spec) = &experiment.scenario.adsorption else {
        return;
    };
    let share = share_a_step(spec, &experiment.scenario) / f64::from(clock.splits);
    step(
        spec.isotherm,
        share as f32,
        &capacities,
        &conductances.per_capacity,
        &mut free,
        &mut bound,
    );
}

#[cfg(test)]
#[allow(clippy::disallowed_methods)] // A test may use the platform's own functions.
mod tests {
    use super::*;

    fn limits(isotherm: Isotherm) -> impl Iterator<Item = (f32, f32)> {
        (1..=20).map(move |i| {
            let phi = i as f32 / 20.0;
            (phi, isotherm.limit(phi, 0.5))
        })
    }

    #[test]
    fn partition_is_a_straight_line() {
        for (phi, limit) in limits(Isotherm::Partition { k: 0.7 }) {
            assert!((limit - 0.7 * phi).abs() < 1e-6);
        }
    }

    #[test]
    fn freundlich_is_a_power_of_the_free_dye() {
        for b in [0.1, 0.3, 0.5, 0.9] {
            for (phi, limit) in limits(Isotherm::Freundlich { k: 0.6, b }) {
                let formula = 0.6 * f64::from(phi).powf(b);
                assert!((f64::from(limit) - formula).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn freundlich_with_b_1_is_partition() {
        let freundlich = limits(Isotherm::Freundlich { k: 0.6, b: 1.0 });
        for (one, other) in freundlich.zip(limits(Isotherm::Partition { k: 0.6 })) {
            assert!((one.1 - other.1).abs() < 1e-6);
        }
    }

    #[test]
    fn langmuir_begins_with_its_slope_and_ends_at_the_bound_capacity() {
        let langmuir = |kl, phi| Isotherm::Langmuir { kl }.limit(phi, 0.5);
        for (phi, limit) in limits(Isotherm::Langmuir { kl: 20.0 }) {
            assert!((limit - 0.5 * 20.0 * phi / (1.0 + 20.0 * phi)).abs() < 1e-6);
        }
        assert!((langmuir(20.0, 1e-6) / (0.5 * 20.0 * 1e-6) - 1.0).abs() < 1e-3);
        assert!((langmuir(1e6, 1.0) - 0.5).abs() < 1e-5);
    }
}
