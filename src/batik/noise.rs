//! Noise that depends on the place alone: the same at a place whatever is computed first, and on
//! any number of threads.
//!
//! A place is hashed (the finaliser of MurmurHash3, public domain); the bits are a uniform number,
//! or pick a quantile of the normal distribution.

use std::sync::LazyLock;

/// Scrambled bits of two numbers under a seed.
#[inline]
pub(super) fn hash(seed: u32, x: u32, y: u32) -> u32 {
    let mut h = seed ^ x.wrapping_mul(0xcc9e_2d51) ^ y.wrapping_mul(0x1b87_3593).rotate_left(15);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    h = h.wrapping_add(y).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

/// A seed of 32 bits for one use, of a seed of 64.
pub(super) fn fold_seed(seed: u64, channel: u32) -> u32 {
    hash(channel, seed as u32, (seed >> 32) as u32)
}

/// Uniform in 0…1 at a place, 1 excluded.
#[inline]
pub(super) fn uniform(seed: u32, x: u32, y: u32) -> f32 {
    // 24 bits: every value is exact.
    (hash(seed, x, y) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Smooth noise along a line, −1 to 1: hashed values at whole numbers, joined by cubics.
pub(super) fn along(seed: u32, line: u32, t: f32) -> f32 {
    let before = t.floor();
    let i = before as i32 as u32;
    let u = t - before;
    let (a, b) = (
        uniform(seed, i, line),
        uniform(seed, i.wrapping_add(1), line),
    );
    2.0 * (a + (b - a) * u * u * (3.0 - 2.0 * u)) - 1.0
}

const QUANTILES: usize = 4096;

/// The middles of equally likely slices of the standard normal distribution.
static NORMAL: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let mut z = -3.5_f64;
    (0..QUANTILES)
        .map(|i| {
            let share = (i as f64 + 0.5) / QUANTILES as f64;
            // Newton from the quantile before: the distribution is smooth and its density is known.
            for _ in 0..20 {
                let below = 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
                let density = libm::exp(-0.5 * z * z) / (2.0 * std::f64::consts::PI).sqrt();
                z -= ((below - share) / density).clamp(-0.5, 0.5);
            }
            z as f32
        })
        .collect()
});

/// Standard normal at a place: mean 0, variance 1.
#[inline]
pub(super) fn normal(seed: u32, x: u32, y: u32) -> f32 {
    NORMAL[hash(seed, x, y) as usize >> 20]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_noise_has_mean_0_and_variance_1_and_neighbours_are_strangers() {
        let n = 512_u32;
        let at = |x, y| f64::from(normal(9, x, y));
        let places = || (0..n).flat_map(move |y| (0..n).map(move |x| (x, y)));
        let count = f64::from(n * n);
        let mean = places().map(|(x, y)| at(x, y)).sum::<f64>() / count;
        let variance = places().map(|(x, y)| at(x, y) * at(x, y)).sum::<f64>() / count;
        let beside = places().map(|(x, y)| at(x, y) * at(x + 1, y)).sum::<f64>() / count;
        let below = places().map(|(x, y)| at(x, y) * at(x, y + 1)).sum::<f64>() / count;
        // Four standard errors of 512² draws are 0.008.
        assert!(mean.abs() < 0.01, "{mean}");
        assert!((variance - 1.0).abs() < 0.015, "{variance}");
        assert!(
            beside.abs() < 0.01 && below.abs() < 0.01,
            "{beside} {below}"
        );
    }

    #[test]
    fn noise_along_a_line_is_smooth_and_differs_from_line_to_line() {
        let step = 1.0 / 64.0;
        for i in -640..640 {
            let t = i as f32 * step;
            let jump = (along(3, 5, t + step) - along(3, 5, t)).abs();
            assert!(jump < 0.05, "{jump} at {t}");
        }
        assert_ne!(along(3, 5, 0.3), along(3, 6, 0.3));
        assert_ne!(along(3, 5, 0.3), along(4, 5, 0.3));
    }
}
