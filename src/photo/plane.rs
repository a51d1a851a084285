//! One number a pixel, and the few operations on it that finding yarns needs.

use rayon::prelude::*;

/// A picture of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Pixels across.
    pub nx: usize,
    /// Pixels down.
    pub ny: usize,
    /// Row by row.
    pub values: Vec<f32>,
}

impl Plane {
    /// A plane whose values are told by their place, across and down.
    pub fn new(nx: usize, ny: usize, value: impl Fn(usize, usize) -> f32 + Sync) -> Self {
        let mut values = vec![0.0; nx * ny];
        values
            .par_chunks_mut(nx.max(1))
            .enumerate()
            .for_each(|(y, row)| {
                for (x, cell) in row.iter_mut().enumerate() {
                    *cell = value(x, y);
                }
            });
        Plane { nx, ny, values }
    }

    /// The value at a whole place.
    #[inline]
    pub fn get(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.nx + x]
    }

    /// The value between pixels, straight from one to the next; beyond the edge, that of the edge.
    #[inline]
    pub fn at(&self, x: f32, y: f32) -> f32 {
        let x = x.clamp(0.0, (self.nx - 1) as f32);
        let y = y.clamp(0.0, (self.ny - 1) as f32);
        let (left, top) = (x as usize, y as usize);
        let (right, bottom) = ((left + 1).min(self.nx - 1), (top + 1).min(self.ny - 1));
        let (tx, ty) = (x - left as f32, y - top as f32);
        let upper = self.get(left, top) * (1.0 - tx) + self.get(right, top) * tx;
        let lower = self.get(left, bottom) * (1.0 - tx) + self.get(right, bottom) * tx;
        upper * (1.0 - ty) + lower * ty
    }

    /// The means of squares of `factor` × `factor` pixels; what is left over at the edges is cut.
    pub fn reduced(&self, factor: usize) -> Plane {
        if factor <= 1 {
            return self.clone();
        }
        let count = (factor * factor) as f32;
        Plane::new(self.nx / factor, self.ny / factor, |x, y| {
            let mut sum = 0.0;
            for j in 0..factor {
                let row = &self.values[(y * factor + j) * self.nx + x * factor..][..factor];
                sum += row.iter().sum::<f32>();
            }
            sum / count
        })
    }

    /// The part that begins at `(x, y)`.
    pub fn cut(&self, (x0, y0): (usize, usize), (nx, ny): (usize, usize)) -> Plane {
        Plane::new(nx, ny, |x, y| self.get(x0 + x, y0 + y))
    }

    /// Blurred with a Gaussian of standard deviation `sigma` pixels, mirrored at the edges.
    pub fn blurred(&self, sigma: f32) -> Plane {
        self.blurred_with(sigma, |i, n| Some(mirrored(i, n)))
    }

    /// Blurred, where what leaves one edge comes back at the other.
    pub fn blurred_around(&self, sigma: f32) -> Plane {
        self.blurred_with(sigma, |i, n| Some(i.rem_euclid(n as isize) as usize))
    }

    /// Blurred, where nothing lies beyond the edges.
    pub fn blurred_alone(&self, sigma: f32) -> Plane {
        self.blurred_with(sigma, |i, n| {
            (0..n as isize).contains(&i).then_some(i as usize)
        })
    }

    fn blurred_with(
        &self,
        sigma: f32,
        place: impl Fn(isize, usize) -> Option<usize> + Sync,
    ) -> Plane {
        let kernel = gaussian(sigma);
        let reach = (kernel.len() / 2) as isize;
        let (nx, ny) = (self.nx, self.ny);
        let mut down = vec![0.0; nx * ny];
        down.par_chunks_mut(nx.max(1))
            .enumerate()
            .for_each(|(y, row)| {
                for (k, weight) in kernel.iter().enumerate() {
                    let Some(from) = place(y as isize + k as isize - reach, ny) else {
                        continue;
                    };
                    let source = &self.values[from * nx..][..nx];
                    for (sum, value) in row.iter_mut().zip(source) {
                        *sum += weight * value;
                    }
                }
            });
        let mut values = vec![0.0; nx * ny];
        values
            .par_chunks_mut(nx.max(1))
            .zip(down.par_chunks(nx.max(1)))
            .for_each(|(row, source)| {
                let padded: Vec<f32> = (-reach..nx as isize + reach)
                    .map(|x| place(x, nx).map_or(0.0, |x| source[x]))
                    .collect();
                for (x, sum) in row.iter_mut().enumerate() {
                    let around = &padded[x..][..kernel.len()];
                    *sum = around.iter().zip(&kernel).map(|(v, w)| v * w).sum();
                }
            });
        Plane { nx, ny, values }
    }
}

/// The place inside that lies as far from the edge as `i` does outside.
fn mirrored(i: isize, n: usize) -> usize {
    let round = i.rem_euclid(2 * n as isize) as usize;
    round.min(2 * n - 1 - round)
}

/// The weights of a Gaussian, out to three standard deviations; they sum to 1.
pub fn gaussian(sigma: f32) -> Vec<f32> {
    if sigma <= 0.0 {
        return vec![1.0];
    }
    let reach = (3.0 * sigma).ceil() as i32;
    let weight = |i: i32| {
        libm::exp(-0.5 * (f64::from(i) / f64::from(sigma)) * (f64::from(i) / f64::from(sigma)))
    };
    let weights: Vec<f64> = (-reach..=reach).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| (w / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_plane_stays_even_when_blurred() {
        let even = Plane::new(13, 9, |_, _| 0.7);
        for sigma in [0.3, 2.0, 11.0] {
            assert!(
                even.blurred(sigma)
                    .values
                    .iter()
                    .all(|v| (v - 0.7).abs() < 1e-5)
            );
        }
    }

    #[test]
    fn blur_keeps_the_sum_and_commutes_with_a_flip() {
        let plane = Plane::new(17, 12, |x, y| ((x * 7 + y * 13) % 11) as f32);
        let flipped = Plane::new(17, 12, |x, y| plane.get(16 - x, y));
        let (one, other) = (plane.blurred(1.7), flipped.blurred(1.7));
        let sum = |plane: &Plane| plane.values.iter().sum::<f32>();
        assert!((sum(&one) - sum(&plane)).abs() < 1e-3 * sum(&plane));
        for y in 0..12 {
            for x in 0..17 {
                assert!((one.get(x, y) - other.get(16 - x, y)).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn between_pixels_lies_what_is_between_their_values() {
        let plane = Plane::new(5, 4, |x, y| (2 * x + 3 * y) as f32);
        assert!((plane.at(1.25, 2.5) - 10.0).abs() < 1e-6);
        assert_eq!(plane.at(-3.0, -1.0), 0.0);
        assert_eq!(plane.at(30.0, 30.0), plane.get(4, 3));
    }
}
