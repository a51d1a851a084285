//! A picture in numbers of 32 bits, softened and made into bytes.

use rayon::prelude::*;

use crate::texture::Rgb;

/// Colours of all pixels, row by row, 0 to 1 as they are displayed (sRGB).
#[derive(Debug, Clone, PartialEq)]
pub struct Colours {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// The pixels.
    pub pixels: Vec<Rgb>,
}

impl Colours {
    /// A picture of a rule for the pixel in row `y` and column `x`.
    pub fn of(width: usize, height: usize, rule: impl Fn(usize, usize) -> Rgb + Sync) -> Self {
        let mut pixels = vec![[0.0; 3]; width * height];
        pixels
            .par_chunks_mut(width.max(1))
            .enumerate()
            .for_each(|(y, row)| {
                for (x, pixel) in row.iter_mut().enumerate() {
                    *pixel = rule(y, x);
                }
            });
        Colours {
            width,
            height,
            pixels,
        }
    }

    /// Blurs with a Gaussian of standard deviation `sigma` pixels (paper B §3.5: the softness of
    /// fibres). Beyond its edges the picture goes on as it is there.
    pub fn blurred(&self, sigma: f64) -> Self {
        // Out to three standard deviations: beyond lies 0.3 % of a Gaussian.
        let reach = (3.0 * sigma).ceil() as usize;
        if sigma <= 0.0 || reach == 0 || self.pixels.is_empty() {
            return self.clone();
        }
        let bell = |i: usize| {
            let z = (i as f64 - reach as f64) / sigma;
            libm::exp(-0.5 * z * z)
        };
        let sum: f64 = (0..=2 * reach).map(bell).sum();
        let kernel: Vec<f32> = (0..=2 * reach).map(|i| (bell(i) / sum) as f32).collect();
        let (width, height) = (self.width, self.height);
        // Down first, then across: each row is made of whole rows.
        let mut result = vec![[0.0; 3]; width * height];
        result
            .par_chunks_mut(width)
            .enumerate()
            .for_each(|(y, row)| {
                let mut padded = vec![[0.0; 3]; width + 2 * reach];
                for (i, weight) in kernel.iter().enumerate() {
                    let from = (y + i).saturating_sub(reach).min(height - 1);
                    let source = &self.pixels[from * width..][..width];
                    for (sum, pixel) in padded[reach..].iter_mut().zip(source) {
                        for (sum, channel) in sum.iter_mut().zip(pixel) {
                            *sum += weight * channel;
                        }
                    }
                }
                let (first, last) = (padded[reach], padded[reach + width - 1]);
                padded[..reach].fill(first);
                padded[reach + width..].fill(last);
                for (i, weight) in kernel.iter().enumerate() {
                    for (sum, pixel) in row.iter_mut().zip(&padded[i..]) {
                        for (sum, channel) in sum.iter_mut().zip(pixel) {
                            *sum += weight * channel;
                        }
                    }
                }
            });
        Colours {
            width,
            height,
            pixels: result,
        }
    }

    /// Red, green and blue of every pixel, 0 to 255.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = vec![0; 3 * self.pixels.len()];
        bytes
            .par_chunks_mut(3 * self.width.max(1))
            .zip(self.pixels.par_chunks(self.width.max(1)))
            .for_each(|(bytes, pixels)| {
                for (byte, channel) in bytes.iter_mut().zip(pixels.as_flattened()) {
                    // Casting rounds down and saturates.
                    *byte = (255.0 * channel + 0.5) as u8;
                }
            });
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speck() -> Colours {
        Colours::of(31, 25, |y, x| {
            if (y, x) == (12, 15) {
                [1.0, 0.5, 0.0]
            } else {
                [0.0; 3]
            }
        })
    }

    #[test]
    fn a_blur_keeps_the_light_and_spreads_it_by_sigma() {
        let blurred = speck().blurred(1.5);
        let light: f32 = blurred.pixels.iter().map(|p| p[0]).sum();
        assert!((light - 1.0).abs() < 1e-5);
        let variance: f32 = (0..31)
            .map(|x| {
                let column: f32 = (0..25).map(|y| blurred.pixels[y * 31 + x][0]).sum();
                column * (x as f32 - 15.0) * (x as f32 - 15.0)
            })
            .sum();
        assert!((variance - 2.25).abs() < 0.15, "{variance}");
    }

    #[test]
    fn a_blur_of_one_colour_is_that_colour() {
        let plain = Colours::of(9, 7, |_, _| [0.2, 0.5, 0.9]);
        for pixel in plain.blurred(2.0).pixels {
            for (a, b) in pixel.into_iter().zip([0.2, 0.5, 0.9]) {
                assert!((a - b).abs() < 1e-6);
            }
        }
        assert_eq!(plain.blurred(0.0), plain);
    }
}
