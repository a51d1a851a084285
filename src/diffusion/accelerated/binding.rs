//! Binding of dye within a leap (model section 4).
//!
//! Dye that moves and dye that binds are followed together: the total U = φ + A of a cell changes by
//! diffusion alone, so no stage can lose dye, and at every stage U is divided into free and bound.
//! Bound dye grows at its own rate, k·φ a step, until it meets its limit A = min(V_d, A_d(φ)); from
//! there on it goes with the limit: A is then the solution of A = A_d(U − A). It never falls below
//! what was bound when the leap began. So neither limit is ever passed, and however eagerly
//! fibre binds, the step need not be short.

use pulp::Simd;

use super::work::without_nothing;
use crate::cloth::Cloth;
use crate::diffusion::held::HeldCell;
use crate::diffusion::lanes::{Cells, LANES, Lanes};
use crate::scenario::Isotherm;

/// How dye binds on a cloth.
#[derive(Debug, Clone)]
pub struct Binding {
    /// A_d(φ).
    pub isotherm: Isotherm,
    settled: Settled,
    /// k, the share of its free dye that a cell binds in a step; or α_d.
    pub share: f32,
    /// In a step dye binds after it has moved, so what binds is a share of c and of how c changes in a
    /// step: 1; or 0 where a step is so long that explicit ones would be split.
    pub moved: f32,
    /// V_u of every cell.
    pub capacity: Vec<Cells>,
    /// V_d of every cell.
    pub fibre: Vec<Cells>,
}

/// How the isotherm divides a total U = φ + A: the solution of A = A_d(U − A).
#[derive(Debug, Clone)]
enum Settled {
    /// A share of the total.
    Share(f32),
    /// A = k·√φ, with k².
    Root(f32),
    /// Another power: the settled amounts at (i / [`ENTRIES`])²·[`LARGEST`].
    Table(Vec<f32>),
    /// A = V_d·K·φ/(1 + K·φ), with K.
    Langmuir(f32),
    /// After paper B: no equilibrium, but a most, a_d.
    Most(f32),
}

impl Settled {
    fn of(isotherm: Isotherm) -> Self {
        match isotherm {
            Isotherm::Partition { k } | Isotherm::Freundlich { k, b: 1.0 } => {
                Settled::Share((k / (1.0 + k)) as f32)
            }
            Isotherm::Freundlich { k, b: 0.5 } => Settled::Root((k * k) as f32),
            Isotherm::Freundlich { k, b } => Settled::Table(table(k, b)),
            Isotherm::Langmuir { kl } => Settled::Langmuir(kl as f32),
            Isotherm::Saturating { most, .. } => Settled::Most(most as f32),
        }
    }
}

/// Entries of the table of settled amounts.
const ENTRIES: usize = 1 << 14;
/// The largest total that a cell can hold: V_u + V_d ≤ 1, and rounding.
const LARGEST: f32 = 1.01;

/// What a stage of the solver makes of the last stages.
#[derive(Debug, Clone, Copy)]
pub struct Mix {
    /// Of the last stage.
    pub mu: f32,
    /// Of the one before.
    pub nu: f32,
    /// Of the rate at the last stage, times the steps of the leap.
    pub rate: f32,
    /// Of the rate at the beginning, times the steps of the leap.
    pub first: f32,
}

impl Mix {
    /// The mixture of the last stage, the one before, the rate at the last and the first rate.
    #[inline(always)]
    pub fn of<S: Simd>(self, simd: S, [last, before, rate, first]: [S::f32s; 4]) -> S::f32s {
        let times = |share: f32, value| simd.mul_f32s(simd.splat_f32s(share), value);
        simd.add_f32s(
            simd.add_f32s(times(self.mu, last), times(self.nu, before)),
            simd.add_f32s(times(self.rate, rate), times(self.first, first)),
        )
    }
}

/// Some cells in one stage. Pairs are of free and bound dye: changes of c and of A since the
/// beginning of the leap.
#[derive(Clone, Copy)]
pub struct Pores<S: Simd> {
    /// c at the beginning.
    pub c: S::f32s,
    /// A at the beginning.
    pub a: S::f32s,
    /// V_u.
    pub v_u: S::f32s,
    /// V_d.
    pub v_d: S::f32s,
    /// The last stage.
    pub last: [S::f32s; 2],
    /// The stage before the last.
    pub before: [S::f32s; 2],
    /// The rate dc/dt by diffusion at the last stage.
    pub rate: S::f32s,
    /// The same at the beginning.
    pub first_rate: S::f32s,
}

impl Binding {
    /// Binding on a cloth; `share` is what [`share_a_step`](crate::adsorption::share_a_step) says.
    pub fn new(isotherm: Isotherm, share: f64, cloth: &Cloth, lanes: Lanes) -> Self {
        Binding {
            isotherm,
            settled: Settled::of(isotherm),
            share: share as f32,
            moved: 1.0,
            capacity: lanes.field(|l, y, x| f64::from(cloth.capacity_free(l, y, x))),
            fibre: lanes.field(|l, y, x| f64::from(cloth.capacity_bound(l, y, x))),
        }
    }

    /// How much the rate of binding adds to the stiffness of the process, per step.
    pub fn stiffness(&self) -> f64 {
        f64::from(self.share)
    }

    /// Divides what some cells hold after a stage into free and bound.
    #[inline(always)]
    pub fn stage<S: Simd>(&self, simd: S, mix: Mix, pores: Pores<S>) -> [S::f32s; 2] {
        let Pores {
            c,
            a,
            v_u,
            v_d,
            last: [free, bound],
            before: [free_before, bound_before],
            rate,
            first_rate,
        } = pores;
        let zero = simd.splat_f32s(0.0);
        let add = |a, b| simd.add_f32s(a, b);
        let sub = |a, b| simd.sub_f32s(a, b);
        let mul = |a, b| simd.mul_f32s(a, b);
        let min = |a, b| simd.min_f32s(a, b);
        let max = |a, b| simd.max_f32s(a, b);
        let splat = |value: f32| simd.splat_f32s(value);

        // The total changes by diffusion alone.
        let all = add(mul(v_u, free), bound);
        let all_before = add(mul(v_u, free_before), bound_before);
        let flows = [mul(v_u, rate), mul(v_u, first_rate)];
        let change = mix.of(simd, [all, all_before, flows[0], flows[1]]);
        let total = max(add(add(mul(v_u, c), a), change), zero);

        // Binding at its own rate.
        let moved = add(add(c, free), mul(splat(self.moved), rate));
        let moved_first = add(c, mul(splat(self.moved), first_rate));
        let speed = mul(splat(self.share), v_u);
        let speeds = match self.settled {
            Settled::Most(most) => {
                let room = max(sub(min(splat(most), v_d), a), zero);
                let left = max(sub(room, bound), zero);
                [mul(speed, left), mul(speed, room)]
            }
            _ => [speed, speed],
        };
        let speeds = [mul(speeds[0], moved), mul(speeds[1], moved_first)];
        let grown = mix.of(simd, [bound, bound_before, speeds[0], speeds[1]]);

        // But never beyond the limit.
        let limit = min(self.settled(simd, total, v_d), v_d);
        let grown = max(min(grown, sub(limit, a)), zero);
        // Divided, for V_u·(1/V_u) is not quite 1, always to the same side; where there is no room at
        // all nothing stays.
        let stays = simd.div_f32s(sub(change, grown), max(v_u, splat(1e-30)));
        [stays, grown].map(|change| without_nothing(simd, change))
    }

    /// What is bound of a total once the isotherm is met.
    #[inline(always)]
    pub fn settled<S: Simd>(&self, simd: S, u: S::f32s, v_d: S::f32s) -> S::f32s {
        let add = |a, b| simd.add_f32s(a, b);
        let sub = |a, b| simd.sub_f32s(a, b);
        let mul = |a, b| simd.mul_f32s(a, b);
        let splat = |value: f32| simd.splat_f32s(value);
        match &self.settled {
            Settled::Share(share) => mul(splat(*share), u),
            Settled::Root(square) => {
                // A² + k²·A − k²·U = 0; this form loses no digits where U is small beside k².
                let k2 = splat(*square);
                let root = add(splat(square * square), mul(splat(4.0 * square), u));
                let double = mul(splat(2.0 * square), u);
                simd.div_f32s(double, add(k2, simd.sqrt_f32s(root)))
            }
            Settled::Langmuir(kl) => {
                // K·φ² + (1 + K·V_d − K·U)·φ − U = 0.
                let (one, k) = (splat(1.0), splat(*kl));
                let p = add(one, mul(k, sub(v_d, u)));
                let root = simd.sqrt_f32s(add(mul(p, p), mul(splat(4.0 * kl), u)));
                let positive = simd.less_than_f32s(splat(0.0), p);
                // Each form where it loses no digits.
                let over = simd.select_f32s(positive, mul(splat(2.0), u), sub(root, p));
                let under = simd.select_f32s(positive, add(p, root), splat(2.0 * kl));
                let filled = mul(k, simd.div_f32s(over, under));
                simd.div_f32s(mul(v_d, filled), add(one, filled))
            }
            Settled::Most(most) => simd.min_f32s(u, splat(*most)),
            Settled::Table(table) => {
                let mut lanes = [0.0; LANES];
                S::as_mut_simd_f32s(&mut lanes).0[0] = u;
                for u in &mut lanes[..S::F32_LANES] {
                    *u = look_up(table, *u);
                }
                S::as_simd_f32s(&lanes).0[0]
            }
        }
    }

    /// The growth of bound dye in a kept cell since the beginning.
    pub fn stage_in_kept(&self, mix: Mix, cell: &HeldCell, kept: KeptPore) -> f32 {
        let KeptPore {
            c,
            a,
            rates,
            last,
            before,
        } = kept;
        let v_u = cell.capacity as f32;
        let v_d = self.fibre[cell.block].0[cell.layer][cell.lane];
        // φ when dye has moved, before supply tops it up.
        let [moved, moved_first] = rates.map(|rate| (v_u * (c + self.moved * rate)).max(0.0));
        let limit = self.isotherm.limit(moved, v_d).min(v_d);
        let room = limit - a;
        let rate = |free: f32, grown: f32| match self.isotherm {
            Isotherm::Saturating { .. } => self.share * (room - grown).max(0.0) * free,
            _ => self.share * free,
        };
        let drive = mix.rate * rate(moved, last) + mix.first * rate(moved_first, 0.0);
        let grown = mix.mu * last + mix.nu * before + drive;
        grown.min(room).max(0.0)
    }
}

/// A kept cell in one stage.
#[derive(Debug, Clone, Copy)]
pub struct KeptPore {
    /// The concentration that is kept.
    pub c: f32,
    /// A at the beginning.
    pub a: f32,
    /// The rates at which its neighbours would fill it: at the last stage, and at the beginning.
    pub rates: [f32; 2],
    /// The growth of A at the last stage.
    pub last: f32,
    /// And at the stage before.
    pub before: f32,
}

fn look_up(table: &[f32], total: f32) -> f32 {
    let place = (total / LARGEST).sqrt() * ENTRIES as f32;
    let entry = (place as usize).min(ENTRIES - 1);
    let (low, high) = (table[entry], table[entry + 1]);
    low + (high - low) * (place - entry as f32)
}

/// The settled amounts A = k·(U − A)ᵇ, by bisection.
fn table(k: f64, b: f64) -> Vec<f32> {
    let settled = |u: f64| {
        let (mut low, mut high) = (0.0, u);
        for _ in 0..60 {
            let a = 0.5 * (low + high);
            if a < k * libm::pow(u - a, b) {
                low = a
            } else {
                high = a
            }
        }
        low
    };
    let total = |i: usize| {
        let share = i as f64 / ENTRIES as f64;
        share * share * f64::from(LARGEST)
    };
    (0..=ENTRIES).map(|i| settled(total(i)) as f32).collect()
}
