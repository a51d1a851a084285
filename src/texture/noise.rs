//! Smooth noise from hashed lattice points: the same on every machine, and quick enough for every
//! pixel of a yarn.

/// Noise along a line, −1 to 1, with about one bump a unit; another `seed` gives another line.
pub fn along(x: f32, seed: u32) -> f32 {
    let floor = x.floor();
    let (i, t) = (floor as i32, smooth(x - floor));
    let (a, b) = (lattice(i, 0, seed), lattice(i.wrapping_add(1), 0, seed));
    a + (b - a) * t
}

/// Noise over a plane, −1 to 1, with about one bump a unit each way.
pub fn over(x: f32, y: f32, seed: u32) -> f32 {
    let (fx, fy) = (x.floor(), y.floor());
    let (i, j) = (fx as i32, fy as i32);
    let (s, t) = (smooth(x - fx), smooth(y - fy));
    let row = |j: i32| {
        let (a, b) = (lattice(i, j, seed), lattice(i.wrapping_add(1), j, seed));
        a + (b - a) * s
    };
    let (a, b) = (row(j), row(j.wrapping_add(1)));
    a + (b - a) * t
}

/// A seed of its own for each number.
pub fn seed(seed: u64, number: u32) -> u32 {
    mix((seed as u32) ^ mix((seed >> 32) as u32 ^ mix(number)))
}

fn smooth(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// A number from −1 to 1 at a lattice point.
fn lattice(i: i32, j: i32, seed: u32) -> f32 {
    let key = (i as u32).wrapping_mul(0x9e37_79b1) ^ (j as u32).wrapping_mul(0x85eb_ca77) ^ seed;
    // 24 bits are exact in a float32.
    (mix(key) >> 8) as f32 * (2.0 / 16_777_215.0) - 1.0
}

/// Mixes the bits of a number (the finaliser of MurmurHash3, in the public domain).
fn mix(mut h: u32) -> u32 {
    h ^= h >> 16;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    h = h.wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_no_bias_and_stays_within_its_bounds() {
        let values: Vec<f32> = (0..40_000)
            .map(|i| over((i % 200) as f32 * 0.37, (i / 200) as f32 * 0.37, 7))
            .collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        assert!(mean.abs() < 0.03, "{mean}");
        assert!(values.iter().all(|v| (-1.0..=1.0).contains(v)));
    }

    #[test]
    fn noise_does_not_jump() {
        for i in 0..10_000 {
            let x = -50.0 + i as f32 * 0.01;
            assert!((along(x + 0.01, 3) - along(x, 3)).abs() < 0.04);
            assert!((over(x + 0.01, 0.3 * x, 3) - over(x, 0.3 * x, 3)).abs() < 0.04);
        }
    }

    #[test]
    fn another_seed_gives_other_noise() {
        let line = |seed| {
            (0..100)
                .map(|i| along(i as f32 * 0.5, seed))
                .collect::<Vec<_>>()
        };
        assert_ne!(line(seed(1, 0)), line(seed(2, 0)));
        assert_ne!(line(seed(1, 0)), line(seed(1 << 40, 0)));
        assert_ne!(line(seed(1, 0)), line(seed(1, 1)));
    }
}
