//! Super-time-stepping: the Runge–Kutta–Legendre method of second order (RKL2; Meyer, Balsara,
//! Aslam, J. Comput. Phys. 257, 2014).
//!
//! s evaluations of the rate F cover (s² + s − 2)/4 times the longest stable explicit step. With
//! D_j = Y_j − Y_0, the change so far, a stage of a leap of h steps is
//!
//! D_j = μ_j·D_{j−1} + ν_j·D_{j−2} + h·μ̃_j·F(Y_{j−1}) + h·γ̃_j·F(Y_0)
//!
//! (their eq 16; in changes, because small numbers round more finely). The method damps what is too
//! fast to be resolved to a half in every leap and never turns its sign, so sharp edges of dye do not
//! ring.

/// The coefficients of one stage, for a leap of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// μ_j, of the last stage.
    pub mu: f64,
    /// ν_j, of the last but one.
    pub nu: f64,
    /// μ̃_j, of the rate at the last stage.
    pub rate: f64,
    /// γ̃_j, of the rate at the beginning.
    pub first: f64,
}

/// How many stages a leap takes whose length times stiffness (the largest eigenvalue of the rate)
/// is `stiffness`. They are odd: even ones damp the fastest change less well.
pub fn stages(stiffness: f64) -> usize {
    let s = ((9.0 + 8.0 * stiffness).sqrt() - 1.0) / 2.0;
    // As a margin for rounding, not quite the most that the stages cover.
    let s = (s * (1.0 + 1e-6)).ceil().max(3.0) as usize;
    s | 1
}

/// b_j (their eq 15).
fn b(j: usize) -> f64 {
    let j = (j as f64).max(2.0);
    (j * j + j - 2.0) / (2.0 * j * (j + 1.0))
}

/// The stages of a leap.
pub fn coefficients(stages: usize) -> Vec<Stage> {
    let s = stages as f64;
    let w = 4.0 / (s * s + s - 2.0);
    let mut all = vec![Stage {
        mu: 1.0,
        nu: 0.0,
        rate: b(1) * w,
        first: 0.0,
    }];
    all.extend((2..=stages).map(|j| {
        let n = j as f64;
        let mu = (2.0 * n - 1.0) / n * b(j) / b(j - 1);
        let nu = -(n - 1.0) / n * b(j) / b(j - 2);
        let rate = mu * w;
        let first = -(1.0 - b(j - 1)) * rate;
        Stage {
            mu,
            nu,
            rate,
            first,
        }
    }));
    all
}

/// A plain step (Euler's), as a stage.
pub const EULER: Stage = Stage {
    mu: 1.0,
    nu: 0.0,
    rate: 1.0,
    first: 0.0,
};

/// The lengths of a few plain steps that calm the fastest changes: together they damp everything
/// between a tenth of the stiffness and all of it to less than a tenth (they are the inverses of
/// the roots of a Chebyshev polynomial there).
///
/// Single precision leaves noise of some 10⁻⁷ after hundreds of stages. It is harmless, but so fast
/// that it would drown the slow changes in the rates, by which a leap is judged.
pub fn calming(stiffness: f64) -> Vec<f64> {
    const STEPS: usize = 5;
    let root = |k: usize| {
        let angle = std::f64::consts::PI * (k as f64 + 0.5) / STEPS as f64;
        0.55 + 0.45 * libm::cos(angle)
    };
    // The longest come first: what rounding they leave is calmed by the others.
    (0..STEPS)
        .rev()
        .map(|k| 1.0 / (root(k) * stiffness))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a leap makes of 1 where the rate is z·y.
    fn leap(stages: usize, z: f64) -> f64 {
        let (mut now, mut before) = (0.0, 0.0);
        for stage in coefficients(stages) {
            let next =
                stage.mu * now + stage.nu * before + stage.rate * z * (1.0 + now) + stage.first * z;
            (before, now) = (now, next);
        }
        1.0 + now
    }

    #[test]
    fn a_leap_is_of_second_order() {
        for s in [3, 7, 25, 101] {
            let error = |z: f64| leap(s, -z) - libm::exp(-z);
            let order = libm::log2(error(0.02) / error(0.01));
            assert!((order - 3.0).abs() < 0.02, "local order {order}");
        }
    }

    #[test]
    fn a_few_plain_steps_calm_the_fastest_changes() {
        let steps = calming(1.9);
        for i in 10..=100 {
            let rate = 1.9 * f64::from(i) / 100.0;
            let rest: f64 = steps.iter().map(|h| 1.0 - h * rate).product();
            assert!(rest.abs() < 0.1, "{rest} is left of a rate of {rate}");
        }
    }

    #[test]
    fn a_leap_is_stable_and_keeps_the_sign_up_to_the_stiffness_it_has_stages_for() {
        for stiffness in [0.5, 2.0, 10.0, 333.3, 2e4] {
            let s = stages(stiffness);
            for i in 0..=1000 {
                let rest = leap(s, -stiffness * f64::from(i) / 1000.0);
                assert!((0.0..=1.0).contains(&rest), "s {s}: {rest}");
            }
        }
    }
}
