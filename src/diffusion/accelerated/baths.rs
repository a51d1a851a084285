//! Baths during a leap (paper B; model section 3).
//!
//! A part of an explicit step first lets the bath make up a share β of what the liquid lacks of M,
//! then dye flows:
//!
//! s = (1 − β)·c + β·M,   c' = s + L·s
//!
//! with L the flows between neighbours. So c changes at the rate L·s + β·(M − c), and what flows is
//! decided by s. All that a leap keeps (states, rates, what binds) is said of c; only the stages, whose
//! neighbours are compared, hold the change of s, which is (1 − β) times that of c. Flows cross each
//! face both ways as ever, and what the bath brings, Σ V_u·β·(M − c), is followed on its own through
//! the stages, what it gives and what it takes apart: so the ledger compares two accounts.

use std::ops::Range;

use pulp::Simd;
use rayon::prelude::*;

use super::binding::Mix;
use crate::diffusion::kernel::At;
use crate::diffusion::lanes::{Cells, LANES, Lanes, Ways};
use crate::supply::Soaked;

/// What baths give, and what they take.
pub type Given = [f64; 2];

/// The baths of a leap.
#[derive(Debug, Clone)]
pub struct Baths {
    lanes: Lanes,
    /// Into how many parts an explicit step is split.
    parts: f32,
    /// β, for one part; 0 where no bath reaches.
    share: Vec<Cells>,
    /// M.
    towards: Vec<Cells>,
    /// V_u·β/(1 − β), a step: how much less the bath brings when s is higher by 1.
    weight: Vec<Cells>,
    /// V_u·β·(M − c) a step, as last looked at.
    drive: Vec<Cells>,
    /// What the baths give and take in a step, block by block, as last looked at.
    rates: Vec<Given>,
    /// The same in the whole cloth, at the beginning of the leap and at its end.
    pub rate: [Given; 2],
    /// What rounding has left over of c, at the beginning of the leap and at its end. A bath that feeds
    /// fibre changes cells by the same small amount in leap after leap.
    carry: [Vec<Cells>; 2],
}

impl Baths {
    /// The baths that reach these cells; none if there are none.
    pub fn new(lanes: Lanes, ways: &[Ways], parts: u32, cells: &[Soaked]) -> Option<Self> {
        if cells.is_empty() {
            return None;
        }
        let fresh = || vec![Cells::ZERO; lanes.len()];
        let parts = parts as f32;
        let (mut share, mut towards, mut weight) = (fresh(), fresh(), fresh());
        for cell in cells {
            let (block, layer, lane) = lanes.place(cell.cell as usize);
            let per_capacity = ways[block].per_capacity[layer][lane];
            share[block].0[layer][lane] = cell.share;
            towards[block].0[layer][lane] = cell.concentration;
            let speed = parts * cell.share;
            weight[block].0[layer][lane] = speed / (1.0 - cell.share) / per_capacity;
        }
        Some(Baths {
            lanes,
            parts,
            share,
            towards,
            weight,
            drive: fresh(),
            rates: vec![[0.0; 2]; lanes.len()],
            rate: [[0.0; 2]; 2],
            carry: [fresh(), fresh()],
        })
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        let fields = [&self.share, &self.towards, &self.weight, &self.drive];
        let fields = fields.into_iter().chain(&self.carry);
        fields
            .map(|field| size_of_val(field.as_slice()))
            .sum::<usize>()
            + size_of_val(self.rates.as_slice())
    }

    /// Lets the next leap begin.
    pub fn go_on(&mut self) {
        self.rate[0] = self.rate[1];
        self.carry.swap(0, 1);
    }

    /// Finds s (`soaked`), and what the baths bring, for these concentrations.
    pub fn look(&mut self, c: &[Cells], soaked: &mut [Cells]) {
        let blocks = self.lanes.blocks;
        let rows = soaked.par_chunks_mut(blocks);
        let rows = rows.zip(self.drive.par_chunks_mut(blocks));
        let rows = rows.zip(self.rates.par_chunks_mut(blocks)).enumerate();
        let (share, towards, weight) = (&self.share, &self.towards, &self.weight);
        let sums: Vec<Given> = rows
            .map(|(y, ((soaked, drive), rates))| {
                let mut sum = [0.0; 2];
                for (b, (drive, rate)) in drive.iter_mut().zip(rates).enumerate() {
                    let at = y * blocks + b;
                    for l in 0..2 {
                        for i in 0..LANES {
                            let of = |cells: &[Cells]| cells[at].0[l][i];
                            let missing = of(towards) - of(c);
                            soaked[b].0[l][i] = of(c) + of(share) * missing;
                            drive.0[l][i] = of(weight) * (1.0 - of(share)) * missing;
                        }
                    }
                    *rate = given(drive, &Cells::ZERO, &Cells::ZERO);
                    sum = plus(sum, *rate);
                }
                sum
            })
            .collect();
        // In order, so that no number of threads changes the sum.
        self.rate[1] = sums.into_iter().fold([0.0; 2], plus);
    }

    /// Adds what the baths make up in a step to the rates of some neighbouring blocks, from the first
    /// of them on.
    pub fn add_rates(&self, first: usize, c: &[Cells], rates: &mut [Cells]) {
        for (b, (c, rate)) in c.iter().zip(rates).enumerate() {
            let (share, towards) = (&self.share[first + b], &self.towards[first + b]);
            for l in 0..2 {
                for i in 0..LANES {
                    let missing = towards.0[l][i] - c.0[l][i];
                    rate.0[l][i] += self.parts * share.0[l][i] * missing;
                }
            }
        }
    }

    /// The largest rate, per step, of diffusion and baths, where that of diffusion alone is `spreads`.
    ///
    /// With the bound of [`stiffness`](super::stiffness), a row of the sum is (1 − β) times one of
    /// diffusion and β more.
    pub fn stiffness(&self, spreads: f64) -> f64 {
        let share = self.shares().fold(0.0, f64::max);
        let soaked = (1.0 - share) * spreads + f64::from(self.parts) * share;
        spreads.max(soaked)
    }

    /// For how many steps the explicit solver's steps matter, if concentrations are to differ from
    /// its own by no more than `error`, where fibre binds a share `binds` of them in a step.
    ///
    /// Of what is missing (1 − β)ⁿ is left after n parts of steps, where the rate alone says e^(−βn).
    /// These differ by up to β/2e, and, if they begin to after n parts, by e^(−βn) times that: so n is
    /// the largest of ln(β/(2e·error))/β.
    pub fn soaking(&self, error: f64, binds: f64) -> u64 {
        let e = std::f64::consts::E;
        let parts = f64::from(self.parts);
        // Fibre binds at all rates up to its own, for it has ever less room.
        let none = if binds > 0.0 {
            (0.0, binds / parts)
        } else {
            (1.0, 0.0)
        };
        let (least, most) = self.shares().fold(none, |(least, most), share| {
            (f64::min(least, share), f64::max(most, share))
        });
        // The expression is largest at β = 2e²·error, and falls to both sides.
        let slowest = (2.0 * e * e * error).clamp(least, most);
        let needed = libm::log(slowest / (2.0 * e * error)) / slowest;
        (needed / parts).ceil().max(0.0) as u64
    }

    /// Whether the baths reach any cell of row `y`.
    pub fn reach(&self, y: usize) -> bool {
        let row = y * self.lanes.blocks..(y + 1) * self.lanes.blocks;
        self.share[row].iter().any(|share| *share != Cells::ZERO)
    }

    /// β of all cells that the baths reach.
    fn shares(&self) -> impl Iterator<Item = f64> {
        let all = self.share.iter().flat_map(|cells| cells.0.as_flattened());
        all.filter(|share| **share > 0.0)
            .map(|share| f64::from(*share))
    }

    /// Turns changes of c into changes of s.
    pub fn to_soaked(&self, changes: &mut [Cells]) {
        let blocks = changes.par_iter_mut().zip(&self.share);
        blocks.for_each(|(changes, share)| {
            let changes = changes.0.as_flattened_mut().iter_mut();
            for (change, share) in changes.zip(share.0.as_flattened()) {
                *change *= 1.0 - share;
            }
        });
    }

    /// Turns the changes of s in a leap into changes of c since `c`, with what rounding had left over,
    /// and carries on what it will leave over now. Where dye binds, `bound` are A at the beginning and
    /// its changes, whose own rounding c takes over, for it is less fine there.
    pub fn restore_liquid(
        &mut self,
        changes: &mut [Cells],
        c: &[Cells],
        bound: Option<[&[Cells]; 2]>,
        ways: &[Ways],
    ) {
        let [before, after] = &mut self.carry;
        let blocks = changes.par_iter_mut().zip(after).zip(&*before);
        let blocks = blocks.zip(&self.share).zip(c).zip(ways).enumerate();
        blocks.for_each(|(b, (((((change, after), before), share), c), way))| {
            for l in 0..2 {
                for i in 0..LANES {
                    let share = share.0[l][i];
                    if share == 0.0 {
                        continue;
                    }
                    let mut exactly = change.0[l][i] / (1.0 - share) + before.0[l][i];
                    if let Some([a, grown]) = bound {
                        let left_over = left_over(a[b].0[l][i], grown[b].0[l][i]);
                        exactly += left_over * way.per_capacity[l][i];
                    }
                    change.0[l][i] = exactly;
                    after.0[l][i] = left_over(c.0[l][i], exactly);
                }
            }
        });
    }

    /// What the baths bring to each block in so many steps if the rate stays what it was.
    pub fn bring(&self, steps: f32, brought: &mut [Given]) {
        for (brought, rate) in brought.iter_mut().zip(&self.rates) {
            *brought = rate.map(|rate| f64::from(steps) * rate);
        }
    }

    /// What they bring up to a stage, in some neighbouring blocks from the `first` of the cloth on,
    /// where s had changed by `change` at the stage before.
    pub fn follow(
        &self,
        mix: Mix,
        first: usize,
        change: &[Cells],
        brought: &[Given],
        into: &mut [Given],
    ) {
        let blocks = first..first + change.len();
        let row = Account {
            drive: &self.drive[blocks.clone()],
            weight: &self.weight[blocks.clone()],
            at_first: &self.rates[blocks],
        };
        follow(mix, row, change, brought, into);
    }

    /// A row of blocks, as the loop over its cells sees it; `c` at the beginning.
    pub fn row<'a>(&'a self, blocks: Range<usize>, c: &'a [Cells]) -> Bath<'a> {
        Bath {
            share: &self.share[blocks.clone()],
            towards: &self.towards[blocks],
            c,
            parts: self.parts,
        }
    }
}

/// What the accounts of neighbouring blocks are taken from.
struct Account<'a> {
    drive: &'a [Cells],
    weight: &'a [Cells],
    at_first: &'a [Given],
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn follow(mix: Mix, row: Account, change: &[Cells], brought: &[Given], into: &mut [Given]) {
    let [mu, nu, rate, first] = [mix.mu, mix.nu, mix.rate, mix.first].map(f64::from);
    let n = change.len();
    let (drive, weight, at_first) = (&row.drive[..n], &row.weight[..n], &row.at_first[..n]);
    let (brought, into) = (&brought[..n], &mut into[..n]);
    for b in 0..n {
        let now = given(&drive[b], &weight[b], &change[b]);
        for i in 0..2 {
            into[b][i] =
                mu * brought[b][i] + nu * into[b][i] + rate * now[i] + first * at_first[b][i];
        }
    }
}

/// What the baths give to a block and take from it in a step where s has changed by `change`.
#[inline(always)]
fn given(drive: &Cells, weight: &Cells, change: &Cells) -> Given {
    let (mut gives, mut takes) = ([0.0_f64; LANES], [0.0_f64; LANES]);
    for l in 0..2 {
        for i in 0..LANES {
            let brings = drive.0[l][i] - weight.0[l][i] * change.0[l][i];
            gives[i] += f64::from(brings.max(0.0));
            takes[i] += f64::from((-brings).max(0.0));
        }
    }
    [gives, takes].map(|lanes| lanes.iter().sum())
}

/// What of a change is lost where it is added to a value.
fn left_over(value: f32, change: f32) -> f32 {
    change - ((value + change) - value)
}

/// What the baths brought to all blocks.
pub fn total(brought: &[Given]) -> Given {
    brought.iter().copied().fold([0.0; 2], plus)
}

/// Both together.
pub fn plus(a: Given, b: Given) -> Given {
    [a[0] + b[0], a[1] + b[1]]
}

/// What stands between the dye that flows in a row and the dye that its cells keep.
///
/// Stages hold how s has changed since the beginning of the leap.
pub trait Soak: Copy {
    /// How c has changed where s has changed by `change`.
    fn of_liquid<S: Simd>(self, simd: S, at: At, change: S::f32s) -> S::f32s;

    /// How s has changed where c has changed by `change`.
    fn of_soaked<S: Simd>(self, simd: S, at: At, change: S::f32s) -> S::f32s;

    /// A rate of c with what the bath made up at the beginning.
    fn driven<S: Simd>(self, simd: S, at: At, rate: S::f32s) -> S::f32s;

    /// A rate of c without what the bath makes up less since c has changed by `change`.
    fn eased<S: Simd>(self, simd: S, at: At, rate: S::f32s, change: S::f32s) -> S::f32s;
}

/// No bath: s is c.
#[derive(Debug, Clone, Copy)]
pub struct Dry;

impl Soak for Dry {
    #[inline(always)]
    fn of_liquid<S: Simd>(self, _: S, _: At, change: S::f32s) -> S::f32s {
        change
    }

    #[inline(always)]
    fn of_soaked<S: Simd>(self, _: S, _: At, change: S::f32s) -> S::f32s {
        change
    }

    #[inline(always)]
    fn driven<S: Simd>(self, _: S, _: At, rate: S::f32s) -> S::f32s {
        rate
    }

    #[inline(always)]
    fn eased<S: Simd>(self, _: S, _: At, rate: S::f32s, _: S::f32s) -> S::f32s {
        rate
    }
}

/// A row that baths reach.
#[derive(Debug, Clone, Copy)]
pub struct Bath<'a> {
    share: &'a [Cells],
    towards: &'a [Cells],
    c: &'a [Cells],
    parts: f32,
}

impl Bath<'_> {
    /// 1 − β.
    #[inline(always)]
    fn stays<S: Simd>(self, simd: S, at: At) -> S::f32s {
        simd.sub_f32s(simd.splat_f32s(1.0), at.of::<S>(self.share))
    }

    /// What the baths make up in a step of what is missing.
    #[inline(always)]
    fn made_up<S: Simd>(self, simd: S, at: At, missing: S::f32s) -> S::f32s {
        let speed = simd.mul_f32s(simd.splat_f32s(self.parts), at.of::<S>(self.share));
        simd.mul_f32s(speed, missing)
    }
}

impl Soak for Bath<'_> {
    #[inline(always)]
    fn of_liquid<S: Simd>(self, simd: S, at: At, change: S::f32s) -> S::f32s {
        simd.div_f32s(change, self.stays(simd, at))
    }

    #[inline(always)]
    fn of_soaked<S: Simd>(self, simd: S, at: At, change: S::f32s) -> S::f32s {
        simd.mul_f32s(change, self.stays(simd, at))
    }

    #[inline(always)]
    fn driven<S: Simd>(self, simd: S, at: At, rate: S::f32s) -> S::f32s {
        let missing = simd.sub_f32s(at.of::<S>(self.towards), at.of::<S>(self.c));
        simd.add_f32s(rate, self.made_up(simd, at, missing))
    }

    #[inline(always)]
    fn eased<S: Simd>(self, simd: S, at: At, rate: S::f32s, change: S::f32s) -> S::f32s {
        simd.sub_f32s(rate, self.made_up(simd, at, change))
    }
}
