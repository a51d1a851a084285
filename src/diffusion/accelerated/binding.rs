//! Binding of dye within a leap (model section 4).
//!
//! Dye that moves and dye that binds are followed together: the total U = φ + A of a cell changes by
//! diffusion alone, so no stage can lose dye, and at every stage U is divided into free and bound.
//! Bound dye grows at its own rate, k·φ a step, until it meets its limit A = min(V_d, A_d(φ)); from
//! there on it goes with the limit: A is then the solution of A = A_d(U − A). It never falls below
//! what was bound when the leap began. So neither limit is ever passed, and however eagerly
//! fibre binds, the step need not be short.

use crate::cloth::{Cloth, Grid};
use crate::scenario::Isotherm;

use super::work::NOTHING;
use crate::diffusion::lanes::{Cells, LANES, Lanes};

/// How dye binds on a cloth.
#[derive(Debug, Clone)]
pub struct Binding {
    isotherm: Isotherm,
    /// k, the share of its free dye that a cell binds in a step; or α_d.
    share: f32,
    /// In a step dye binds after it has moved, so what binds is a share of c and of how c changes in a
    /// step: 1; or 0 where a step is so long that explicit ones would be split.
    pub moved: f32,
    /// For a power law without a formula: the settled amount at (i / [`ENTRIES`])²·[`LARGEST`].
    table: Vec<f32>,
    /// V_u of every cell.
    pub capacity: Vec<Cells>,
    /// V_d of every cell.
    fibre: Vec<Cells>,
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

/// Neighbouring blocks in one stage. Pairs are of free and bound dye; those of stages are changes of
/// c and of A since the beginning of the leap.
pub struct Blocks<'a> {
    /// Number of the first block.
    pub first: usize,
    /// c and A at the beginning.
    pub begin: (&'a [Cells], &'a [Cells]),
    /// The last stage.
    pub last: (&'a [Cells], &'a [Cells]),
    /// The rate dc/dt by diffusion at the last stage, and at the beginning.
    pub rate: (&'a [Cells], &'a [Cells]),
    /// The stage before the last, to be replaced by the new one.
    pub into: (&'a mut [Cells], &'a mut [Cells]),
}

/// One of them.
struct Block<'a> {
    number: usize,
    c: &'a Cells,
    a: &'a Cells,
    last: (&'a Cells, &'a Cells),
    rate: (&'a Cells, &'a Cells),
    into: (&'a mut Cells, &'a mut Cells),
}

/// Divides what blocks hold after a stage into free and bound.
#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub fn stage(binding: &Binding, mix: Mix, blocks: Blocks) {
    for i in 0..blocks.into.0.len() {
        let block = Block {
            number: blocks.first + i,
            c: &blocks.begin.0[i],
            a: &blocks.begin.1[i],
            last: (&blocks.last.0[i], &blocks.last.1[i]),
            rate: (&blocks.rate.0[i], &blocks.rate.1[i]),
            into: (&mut blocks.into.0[i], &mut blocks.into.1[i]),
        };
        binding.stage(mix, block);
    }
}

impl Binding {
    /// Binding on a cloth; `share` is what [`share_a_step`](crate::adsorption::share_a_step) says.
    pub fn new(isotherm: Isotherm, share: f64, cloth: &Cloth, lanes: Lanes) -> Self {
        let grid: Grid = lanes.grid;
        let field = |of: &[f32]| lanes.field(|l, y, x| f64::from(of[grid.index(l, y, x)]));
        Binding {
            isotherm,
            share: share as f32,
            moved: 1.0,
            table: match isotherm {
                Isotherm::Freundlich { k, b } if b != 0.5 && b != 1.0 => table(k, b),
                _ => Vec::new(),
            },
            capacity: field(&cloth.capacity_free),
            fibre: field(&cloth.capacity_bound),
        }
    }

    /// How much the rate of binding adds to the stiffness of the process, per step.
    pub fn stiffness(&self) -> f64 {
        f64::from(self.share)
    }

    /// Divides what a block holds after a stage into free and bound.
    #[inline(always)]
    fn stage(&self, mix: Mix, block: Block) {
        let (v_u, v_d) = (&self.capacity[block.number], &self.fibre[block.number]);
        match self.isotherm {
            Isotherm::Partition { k } => {
                let k = k as f32;
                divide(self, mix, block, (v_u, v_d), |u, _| k * u / (1.0 + k));
            }
            Isotherm::Freundlich { k, b: 1.0 } => {
                let k = k as f32;
                divide(self, mix, block, (v_u, v_d), |u, _| k * u / (1.0 + k));
            }
            Isotherm::Freundlich { k, b: 0.5 } => {
                // A² + k²·A − k²·U = 0.
                let square = (k * k) as f32;
                divide(self, mix, block, (v_u, v_d), |u, _| {
                    // This form loses no digits where U is small beside k².
                    2.0 * square * u / (square + (square * square + 4.0 * square * u).sqrt())
                });
            }
            Isotherm::Freundlich { .. } => {
                divide(self, mix, block, (v_u, v_d), |u, _| self.look_up(u));
            }
            Isotherm::Langmuir { kl } => {
                let kl = kl as f32;
                divide(self, mix, block, (v_u, v_d), |u, v_d| {
                    // K·φ² + (1 + K·V_d − K·U)·φ − U = 0.
                    let p = 1.0 + kl * (v_d - u);
                    let root = (p * p + 4.0 * kl * u).sqrt();
                    let free = if p > 0.0 {
                        2.0 * u / (p + root)
                    } else {
                        (root - p) / (2.0 * kl)
                    };
                    v_d * kl * free / (1.0 + kl * free)
                });
            }
            Isotherm::Saturating { most, .. } => {
                saturate(self, mix, block, (v_u, v_d), most as f32);
            }
        }
    }

    fn look_up(&self, total: f32) -> f32 {
        let place = (total.max(0.0) / LARGEST).sqrt() * ENTRIES as f32;
        let entry = (place as usize).min(ENTRIES - 1);
        let (low, high) = (self.table[entry], self.table[entry + 1]);
        low + (high - low) * (place - entry as f32)
    }

    /// The growth of bound dye in a kept cell since the beginning.
    pub fn stage_in_kept(&self, mix: Mix, kept: Kept) -> f32 {
        let Kept {
            moved,
            moved_first,
            v_d,
            a,
            last,
            before,
        } = kept;
        let limit = self.isotherm.limit(moved, v_d).min(v_d);
        let rate = |free: f32, grown: f32| match self.isotherm {
            Isotherm::Saturating { .. } => self.share * (limit - a - grown).max(0.0) * free,
            _ => self.share * free,
        };
        let drive = mix.rate * rate(moved, last) + mix.first * rate(moved_first, 0.0);
        let grown = mix.mu * last + mix.nu * before + drive;
        grown.min(limit - a).max(0.0)
    }

    /// V_d of one cell.
    pub fn fibre(&self, block: usize, layer: usize, lane: usize) -> f32 {
        self.fibre[block].0[layer][lane]
    }
}

/// A kept cell in one stage.
#[derive(Debug, Clone, Copy)]
pub struct Kept {
    /// φ when dye has moved, before supply tops it up: at the last stage.
    pub moved: f32,
    /// The same at the beginning of the leap.
    pub moved_first: f32,
    /// V_d.
    pub v_d: f32,
    /// A at the beginning.
    pub a: f32,
    /// The growth at the last stage, and at the one before.
    pub last: f32,
    /// The growth at the stage before the last.
    pub before: f32,
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

#[inline(always)]
fn divide(
    binding: &Binding,
    mix: Mix,
    block: Block,
    (v_u, v_d): (&Cells, &Cells),
    settled: impl Fn(f32, f32) -> f32,
) {
    let share = binding.share;
    for l in 0..2 {
        for i in 0..LANES {
            let at = |cells: &Cells| cells.0[l][i];
            let (v_u, v_d, c, a) = (at(v_u), at(v_d), at(block.c), at(block.a));
            let (free, bound) = (at(block.last.0), at(block.last.1));
            let (free_before, bound_before) = (at(block.into.0), at(block.into.1));
            let flow = v_u * (mix.rate * at(block.rate.0) + mix.first * at(block.rate.1));
            let change =
                mix.mu * (v_u * free + bound) + mix.nu * (v_u * free_before + bound_before) + flow;
            let total = v_u * c + a + change;
            let moved = c + free + binding.moved * at(block.rate.0);
            let moved_first = c + binding.moved * at(block.rate.1);
            let drive = share * v_u * (mix.rate * moved + mix.first * moved_first);
            let grown = mix.mu * bound + mix.nu * bound_before + drive;
            let limit = settled(total.max(0.0), v_d).min(v_d);
            let grown = grown.min(limit - a).max(0.0);
            block.into.1.0[l][i] = if grown > NOTHING { grown } else { 0.0 };
            let stays = (change - grown) / v_u;
            block.into.0.0[l][i] = if stays.abs() > NOTHING { stays } else { 0.0 };
        }
    }
}

/// After paper B: ΔA = α_d·(a_d − A)·φ a step.
#[inline(always)]
fn saturate(binding: &Binding, mix: Mix, block: Block, (v_u, v_d): (&Cells, &Cells), most: f32) {
    let speed = binding.share;
    for l in 0..2 {
        for i in 0..LANES {
            let at = |cells: &Cells| cells.0[l][i];
            let (v_u, c, a) = (at(v_u), at(block.c), at(block.a));
            let room = (most.min(at(v_d)) - a).max(0.0);
            let (free, bound) = (at(block.last.0), at(block.last.1));
            let (free_before, bound_before) = (at(block.into.0), at(block.into.1));
            let flow = v_u * (mix.rate * at(block.rate.0) + mix.first * at(block.rate.1));
            let change =
                mix.mu * (v_u * free + bound) + mix.nu * (v_u * free_before + bound_before) + flow;
            let total = v_u * c + a + change;
            let rate = |c: f32, grown: f32| speed * (room - grown).max(0.0) * v_u * c;
            let moved = c + free + binding.moved * at(block.rate.0);
            let moved_first = c + binding.moved * at(block.rate.1);
            let drive = mix.rate * rate(moved, bound) + mix.first * rate(moved_first, 0.0);
            let grown = mix.mu * bound + mix.nu * bound_before + drive;
            let grown = grown.min(room).min(total - a).max(0.0);
            block.into.1.0[l][i] = if grown > NOTHING { grown } else { 0.0 };
            let stays = (change - grown) / v_u;
            block.into.0.0[l][i] = if stays.abs() > NOTHING { stays } else { 0.0 };
        }
    }
}
