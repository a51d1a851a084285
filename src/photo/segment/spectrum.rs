//! The power spectrum of a photograph: means over overlapping, windowed tiles (P. D. Welch, *The use of
//! fast Fourier transform for the estimation of power spectra*, 1967), so that yarns that wave a little
//! still make peaks.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::photo::plane::Plane;

/// The largest tile, pixels along a side.
pub const LARGEST_TILE: usize = 256;
/// The smallest.
pub const SMALLEST_TILE: usize = 32;
/// Groups of tiles that are summed apart; their number is fixed so that sums never depend on threads.
const GROUPS: usize = 16;

/// A fast Fourier transform of a power of two. Its sines come from `libm`, so that a photograph gives
/// the same mask on every machine; those of common libraries are the platform's.
struct Fourier {
    size: usize,
    /// cos and −sin of each part of a turn.
    turns: Vec<(f64, f64)>,
}

impl Fourier {
    fn new(size: usize) -> Self {
        let turn = |i: usize| {
            let angle = TAU * i as f64 / size as f64;
            (libm::cos(angle), -libm::sin(angle))
        };
        Fourier {
            size,
            turns: (0..size / 2).map(turn).collect(),
        }
    }

    /// Transforms in place (Cooley and Tukey, radix 2).
    fn forward(&self, data: &mut [(f64, f64)]) {
        let bits = self.size.trailing_zeros();
        for i in 0..self.size {
            let j = i.reverse_bits() >> (usize::BITS - bits);
            if i < j {
                data.swap(i, j);
            }
        }
        let mut half = 1;
        while half < self.size {
            let stride = self.size / (2 * half);
            for block in data.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                    let (c, s) = self.turns[k * stride];
                    let turned = (b.0 * c - b.1 * s, b.0 * s + b.1 * c);
                    *b = (a.0 - turned.0, a.1 - turned.1);
                    *a = (a.0 + turned.0, a.1 + turned.1);
                }
            }
            half *= 2;
        }
    }
}

/// Power by frequency.
pub struct Spectrum {
    /// Frequencies along a side: as many as a tile has pixels.
    pub size: usize,
    power: Vec<f64>,
    /// The median power of every ring of frequencies: what chance alone makes.
    background: Vec<f64>,
}

impl Spectrum {
    /// The spectrum of two planes of the same size together, or nothing if they are too small.
    pub fn of(one: &Plane, other: &Plane) -> Option<Self> {
        let side = one.nx.min(one.ny).min(LARGEST_TILE);
        if side < SMALLEST_TILE {
            return None;
        }
        let size = 1 << side.ilog2();
        let fourier = Fourier::new(size);
        let window: Vec<f64> = (0..size)
            .map(|i| 0.5 - 0.5 * libm::cos(TAU * (i as f64 + 0.5) / size as f64))
            .collect();
        let places = |n: usize| {
            let count = (n - size).div_ceil(size / 2) + 1;
            (0..count).map(move |i| (i * size / 2).min(n - size))
        };
        let tiles: Vec<_> = places(one.ny)
            .flat_map(|y| places(one.nx).map(move |x| (x, y)))
            .collect();
        let group = tiles.len().div_ceil(GROUPS);
        let sums: Vec<Vec<f64>> = tiles
            .par_chunks(group)
            .map(|tiles| {
                let mut sum = vec![0.0; size * size];
                for tile in tiles {
                    add_power(&fourier, &window, one, other, *tile, &mut sum);
                }
                sum
            })
            .collect();
        let mut power = vec![0.0; size * size];
        for sum in sums {
            for (power, part) in power.iter_mut().zip(sum) {
                *power += part / tiles.len() as f64;
            }
        }
        // Two real planes went in as one complex: their power is the mean of both signs.
        let opposite = |i: usize| {
            let (x, y) = (i % size, i / size);
            (size - y) % size * size + (size - x) % size
        };
        let power: Vec<f64> = (0..size * size)
            .map(|i| 0.5 * (power[i] + power[opposite(i)]))
            .collect();
        let background = background(&power, size);
        Some(Spectrum {
            size,
            power,
            background,
        })
    }

    /// The power at so many waves across and down a tile.
    pub fn power(&self, fx: i32, fy: i32) -> f64 {
        let wrap = |f: i32| f.rem_euclid(self.size as i32) as usize;
        self.power[wrap(fy) * self.size + wrap(fx)]
    }

    /// How many times the power of chance that is.
    pub fn prominence(&self, fx: i32, fy: i32) -> f64 {
        let ring = libm::sqrt(f64::from(fx * fx + fy * fy)) as usize;
        self.power(fx, fy) / self.background[ring.min(self.size / 2)]
    }

    /// Whether none of the eight frequencies around has more power.
    pub fn is_peak(&self, fx: i32, fy: i32) -> bool {
        let here = self.power(fx, fy);
        (-1..=1).all(|j| (-1..=1).all(|i| self.power(fx + i, fy + j) <= here))
    }

    /// The top of a peak between frequencies, in waves a pixel: that of parabolas through the logarithms
    /// of its neighbours.
    pub fn top(&self, fx: i32, fy: i32) -> [f64; 2] {
        let log = |fx, fy| libm::log(self.power(fx, fy) + 1e-30);
        let offset = |before: f64, here: f64, after: f64| {
            let bend = before - 2.0 * here + after;
            if bend < 0.0 {
                (0.5 * (before - after) / bend).clamp(-0.5, 0.5)
            } else {
                0.0
            }
        };
        let here = log(fx, fy);
        let dx = offset(log(fx - 1, fy), here, log(fx + 1, fy));
        let dy = offset(log(fx, fy - 1), here, log(fx, fy + 1));
        [
            (f64::from(fx) + dx) / self.size as f64,
            (f64::from(fy) + dy) / self.size as f64,
        ]
    }
}

fn add_power(
    fourier: &Fourier,
    window: &[f64],
    one: &Plane,
    other: &Plane,
    (x0, y0): (usize, usize),
    sum: &mut [f64],
) {
    let size = fourier.size;
    let mut data = vec![(0.0, 0.0); size * size];
    for (y, row) in data.chunks_exact_mut(size).enumerate() {
        for (x, value) in row.iter_mut().enumerate() {
            let weight = window[x] * window[y];
            *value = (
                weight * f64::from(one.get(x0 + x, y0 + y)),
                weight * f64::from(other.get(x0 + x, y0 + y)),
            );
        }
        fourier.forward(row);
    }
    let mut column = vec![(0.0, 0.0); size];
    for x in 0..size {
        for (y, value) in column.iter_mut().enumerate() {
            *value = data[y * size + x];
        }
        fourier.forward(&mut column);
        for (y, (re, im)) in column.iter().enumerate() {
            sum[y * size + x] += re * re + im * im;
        }
    }
}

fn background(power: &[f64], size: usize) -> Vec<f64> {
    let half = size / 2;
    let mut rings = vec![Vec::new(); half + 1];
    for (i, power) in power.iter().enumerate() {
        let signed = |i: usize| {
            if i < half {
                i as f64
            } else {
                i as f64 - size as f64
            }
        };
        let (x, y) = (signed(i % size), signed(i / size));
        let ring = libm::sqrt(x * x + y * y) as usize;
        for ring in rings.iter_mut().take(ring + 3).skip(ring.saturating_sub(2)) {
            ring.push(*power);
        }
    }
    rings
        .into_iter()
        .map(|mut ring| {
            let middle = ring.len() / 2;
            let (_, median, _) = ring.select_nth_unstable_by(middle, f64::total_cmp);
            median.max(1e-12)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fast_transform_is_the_slow_one() {
        let size = 32;
        let value = |i: usize| (((i * 37) % 17) as f64 - 8.0, ((i * 11) % 7) as f64);
        let mut fast: Vec<_> = (0..size).map(value).collect();
        Fourier::new(size).forward(&mut fast);
        for (k, (re, im)) in fast.into_iter().enumerate() {
            let mut slow = (0.0, 0.0);
            for i in 0..size {
                let angle = -TAU * (k * i) as f64 / size as f64;
                let ((a, b), (c, s)) = (value(i), (libm::cos(angle), libm::sin(angle)));
                slow = (slow.0 + a * c - b * s, slow.1 + a * s + b * c);
            }
            assert!((re - slow.0).abs() < 1e-9 && (im - slow.1).abs() < 1e-9);
        }
    }

    #[test]
    fn stripes_make_a_peak_at_their_pitch() {
        let pitch = 7.3;
        let stripes = Plane::new(300, 280, |x, _| libm::sin(TAU * x as f64 / pitch) as f32);
        let none = Plane::new(300, 280, |_, _| 0.0);
        let spectrum = Spectrum::of(&stripes, &none).unwrap();
        let (fx, _) = (1..128)
            .map(|fx| (fx, spectrum.power(fx, 0)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(spectrum.is_peak(fx, 0));
        let found = 1.0 / spectrum.top(fx, 0)[0];
        assert!((found - pitch).abs() < 0.02, "{found}");
    }
}
