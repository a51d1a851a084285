//! How the face between two cells passes dye: ρ of paper D eq 4 (model section 2).
//!
//! A cell with concentration c gets G·ρ·(c' − c) from a neighbour with c', in whatever vectors the
//! solver computes in.

use pulp::Simd;

/// How faces pass dye, of a process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Fick's law. Rates are proportional to differences, so the rate at a stage is the rate at the
    /// beginning and that of the change since then.
    Fick,
    /// Fick's law, slowed down where there is much dye.
    Slowed(WeiszZollinger),
}

impl Law {
    /// The law for φ₀, as a share of the free capacity.
    pub fn of(equilibrium: f64) -> Self {
        if equilibrium < 1.0 {
            Law::Slowed(WeiszZollinger {
                equilibrium: equilibrium as f32,
            })
        } else {
            Law::Fick
        }
    }
}

/// How the face between two cells passes dye.
pub trait Passage: Copy + Sync {
    /// The amount that passes to a cell with concentration `here` from one with `there`.
    fn flow<S: Simd>(self, simd: S, g: S::f32s, here: S::f32s, there: S::f32s) -> S::f32s;
}

/// ρ = 1: Fick's law alone.
#[derive(Debug, Clone, Copy)]
pub struct Fick;

impl Passage for Fick {
    #[inline(always)]
    fn flow<S: Simd>(self, simd: S, g: S::f32s, here: S::f32s, there: S::f32s) -> S::f32s {
        simd.mul_f32s(g, simd.sub_f32s(there, here))
    }
}

/// ρ = min(1, φ₀/c̄) with c̄ the mean of both sides (Weisz–Zollinger, paper D eq 4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeiszZollinger {
    /// φ₀, as a share of the free capacity.
    equilibrium: f32,
}

impl Passage for WeiszZollinger {
    #[inline(always)]
    fn flow<S: Simd>(self, simd: S, g: S::f32s, here: S::f32s, there: S::f32s) -> S::f32s {
        let mean = simd.mul_f32s(simd.splat_f32s(0.5), simd.add_f32s(here, there));
        // Where there is no dye the quotient is huge and the minimum 1.
        let mean = simd.max_f32s(mean, simd.splat_f32s(1e-30));
        let rho = simd.div_f32s(simd.splat_f32s(self.equilibrium), mean);
        let rho = simd.min_f32s(rho, simd.splat_f32s(1.0));
        simd.mul_f32s(simd.mul_f32s(g, rho), simd.sub_f32s(there, here))
    }
}
