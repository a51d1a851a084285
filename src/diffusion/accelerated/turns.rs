//! How dye binds between the ends of a leap.
//!
//! Dye that binds at its own rate, and dye that goes with its limit, change smoothly, and so a cubic
//! tells their moments. Where a cell meets its limit within a leap it turns sharply: it bound share·φ a
//! step before, and next to nothing after. The cubic rounds that off and misses A by a share of what the
//! cell would have bound in the whole leap, [`ROUNDED_OFF`] at most.

use std::ops::Range;

use pulp::{Arch, Scalar, Simd, WithSimd};

use super::binding::Binding;
use super::moments::Cubic;
use crate::diffusion::kernel::At;
use crate::diffusion::lanes::{Cells, LANES};
use crate::scenario::Isotherm;

/// By how much the cubic misses a turn: most where the turn is at one end.
const ROUNDED_OFF: f64 = 4.0 / 27.0;

/// A cell: its block, layer and lane.
pub type Place = (usize, usize, usize);

/// How fast a cell binds.
#[derive(Debug, Clone, Copy)]
pub struct Growth {
    /// dA/dt, a step.
    pub rate: f32,
    /// Whether that is what the limit leaves, and not the cell's own rate.
    pub at_limit: bool,
}

impl Growth {
    /// What a cell with c and A binds in a step, where c changes at a rate by what flows; `kept` where
    /// it is kept at c.
    pub fn of(binding: &Binding, place: Place, [c, rate, a]: [f32; 3], kept: bool) -> Self {
        let (block, layer, lane) = place;
        let at = |cells: &[Cells]| cells[block].0[layer][lane];
        let (v_u, v_d) = (at(&binding.capacity), at(&binding.fibre));
        let moved = v_u * (c + binding.moved * rate).max(0.0);
        let own = binding.share * moved;
        let limit = match binding.isotherm {
            Isotherm::Saturating { most, .. } => {
                return Growth {
                    rate: own * (v_d.min(most as f32) - a).max(0.0),
                    at_limit: false,
                };
            }
            isotherm if kept => isotherm.limit(moved, v_d),
            _ => binding.settled(Scalar, (v_u * (c + rate) + a).max(0.0), v_d),
        };
        let room = (limit.min(v_d) - a).max(0.0);
        Growth {
            rate: own.min(room),
            at_limit: room < own,
        }
    }
}

/// What a cell has bound at the share `t` of a leap of `h` steps in which it binds `all`; `turns` where
/// it is known to turn sharply.
pub fn between(t: f64, h: f64, all: f64, [early, late]: [f32; 2], turns: bool) -> f64 {
    let [early, late] = [early, late].map(f64::from);
    let grown = if turns {
        let (begin, end) = (early * h * t, all - late * h * (1.0 - t));
        if early > late {
            begin.min(end)
        } else {
            begin.max(end)
        }
    } else {
        // As steep at its ends as it may be without turning back.
        let steepest = 3.0 * all / h;
        Cubic::new(t, h).at(all, early.min(steepest), late.min(steepest))
    };
    grown.clamp(0.0, all)
}

/// For how many steps the cubic misses concentrations by at most `error` wherever a cell turns.
pub fn smooth_for(binding: &Binding, error: f64) -> u64 {
    match binding.isotherm {
        Isotherm::Saturating { .. } => u64::MAX,
        _ => (error / (ROUNDED_OFF * f64::from(binding.share))) as u64,
    }
}

/// By how much the cubic misses the concentrations of a row of cells that turn within a leap.
pub struct Turns<'a> {
    /// How dye binds.
    pub binding: &'a Binding,
    /// A of the whole cloth at the beginning and at the end.
    pub a: [&'a [Cells]; 2],
    /// The steps of the leap.
    pub steps: f64,
}

impl Turns<'_> {
    /// The errors of a row of blocks with these concentrations at the beginning and at the end.
    pub fn row(&self, row: Range<usize>, c: [&[Cells]; 2]) -> Vec<Cells> {
        let mut errors = vec![Cells::ZERO; row.len()];
        if let Isotherm::Saturating { .. } = self.binding.isotherm {
            return errors;
        }
        Arch::new().dispatch(TurnsOfRow {
            binding: self.binding,
            c,
            a: self.a.map(|a| &a[row.clone()]),
            v_u: &self.binding.capacity[row.clone()],
            v_d: &self.binding.fibre[row],
            most: (ROUNDED_OFF * self.steps) as f32 * self.binding.share,
            errors: &mut errors,
        });
        errors
    }
}

struct TurnsOfRow<'a> {
    binding: &'a Binding,
    c: [&'a [Cells]; 2],
    a: [&'a [Cells]; 2],
    v_u: &'a [Cells],
    v_d: &'a [Cells],
    /// The error where c is 1.
    most: f32,
    errors: &'a mut [Cells],
}

impl WithSimd for TurnsOfRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let [zero, one] = [0.0, 1.0].map(|value| simd.splat_f32s(value));
        let share = simd.splat_f32s(self.binding.share);
        for block in 0..self.errors.len() {
            for layer in 0..2 {
                for part in 0..LANES / S::F32_LANES {
                    let at = At { block, layer, part };
                    let (v_u, v_d) = (at.of::<S>(self.v_u), at.of::<S>(self.v_d));
                    let c = self.c.map(|c| at.of::<S>(c));
                    let at_limit = |end: usize| {
                        let (phi, a) = (simd.mul_f32s(v_u, c[end]), at.of::<S>(self.a[end]));
                        let settled = self.binding.settled(simd, simd.add_f32s(phi, a), v_d);
                        let room = simd.sub_f32s(simd.min_f32s(settled, v_d), a);
                        let is = simd.less_than_f32s(room, simd.mul_f32s(share, phi));
                        simd.select_f32s(is, one, zero)
                    };
                    let turns = simd.abs_f32s(simd.sub_f32s(at_limit(0), at_limit(1)));
                    let most = simd.mul_f32s(simd.splat_f32s(self.most), simd.max_f32s(c[0], c[1]));
                    *at.of_mut::<S>(self.errors) = simd.mul_f32s(turns, most);
                }
            }
        }
    }
}
