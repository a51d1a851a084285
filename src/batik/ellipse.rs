//! The ellipse weave: a cloth look in HSV (paper B §3.5, eq 8, Fig 6).
//!
//! Where yarns cross, the upper one stands out: an ellipse E in every cloth cell, as long as the
//! yarn lies on top and narrower across it. With n the distance to E, truncated and normalised (0 on
//! the ellipse, 1 far from it), a colour of saturation S_a and value V_a becomes
//!
//! ```text
//! S = S_a·(1 − R_S·(1 − n)) + noise      V = V_a·(1 − shade·n)·(1 + R_V·(1 − n)) + noise
//! ```
//!
//! paler and lighter where it stands out. The printed formula for V is damaged; the sign follows the
//! text, and so does `shade`, the shadow around the ellipse (0 gives eq 8 alone). Noise is Gaussian,
//! one draw a cloth cell and one a pixel.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::crossings::Crossings;
use super::noise::{fold_seed, normal};
use super::picture::Colours;
use crate::texture::Rgb;

/// How the ellipse weave looks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EllipseSpec {
    /// R_S: how much paler the raised part is, 0 to 1.
    pub paler: f64,
    /// R_V: how much lighter the raised part is, 0 to 1.
    pub lighter: f64,
    /// How much darker the rest is, 0 to 1.
    pub shade: f64,
    /// Length and width of the ellipse as shares of the cloth cell, along the upper yarn and across.
    pub size: (f64, f64),
    /// How far from the ellipse it is darkest, in radii of the ellipse.
    pub reach: f64,
    /// Standard deviation of the noise of a whole cloth cell, in S and V.
    pub cell_noise: f64,
    /// Standard deviation of the noise of a pixel, in S and V.
    pub pixel_noise: f64,
    /// Standard deviation of the final blur, pixels.
    pub blur: f64,
}

impl Default for EllipseSpec {
    fn default() -> Self {
        EllipseSpec {
            paler: 0.16,
            lighter: 0.14,
            shade: 0.12,
            size: (0.78, 0.5),
            reach: 1.0,
            cell_noise: 0.018,
            pixel_noise: 0.022,
            blur: 0.6,
        }
    }
}

/// The ellipse weave of one cloth, at a number of pixels a cell.
pub struct EllipseWeave {
    spec: EllipseSpec,
    scale: usize,
    seed: u32,
    width: usize,
    height: usize,
    columns: Vec<u32>,
    rows: Vec<u32>,
    /// n of every pixel.
    distance: Vec<f32>,
}

impl EllipseWeave {
    /// Prepares the look of a cloth with `scale` pixels along one side of a cell. `warp_up` says
    /// whether the warp is on top at `(y, x)`; `seed` is that of the noise.
    pub fn new(
        crossings: &Crossings,
        warp_up: impl Fn(usize, usize) -> bool + Sync,
        spec: EllipseSpec,
        scale: usize,
        seed: u64,
    ) -> Self {
        let columns = Crossings::numbers(&crossings.columns);
        let rows = Crossings::numbers(&crossings.rows);
        let (width, height) = (columns.len() * scale, rows.len() * scale);
        let reach = spec.reach.max(1e-3) as f32;
        let mut distance = vec![1.0; width * height];
        distance
            .par_chunks_mut(width.max(1))
            .enumerate()
            .for_each(|(py, line)| {
                let y = py / scale;
                let row = &crossings.rows[rows[y] as usize];
                let v = (py as f32 + 0.5) / scale as f32;
                for (px, n) in line.iter_mut().enumerate() {
                    let x = px / scale;
                    let column = &crossings.columns[columns[x] as usize];
                    let u = (px as f32 + 0.5) / scale as f32;
                    let (along, across) = (spec.size.0 as f32, spec.size.1 as f32);
                    let (a, b) = if warp_up(y, x) {
                        (across, along)
                    } else {
                        (along, across)
                    };
                    let radii = |range: &std::ops::Range<usize>, place: f32, share: f32| {
                        let middle = 0.5 * (range.start + range.end) as f32;
                        (place - middle) / (0.5 * share * range.len() as f32).max(1e-3)
                    };
                    let (dx, dy) = (radii(column, u, a), radii(row, v, b));
                    *n = (((dx * dx + dy * dy).sqrt() - 1.0) / reach).clamp(0.0, 1.0);
                }
            });
        EllipseWeave {
            spec,
            scale,
            seed: fold_seed(seed, 0xe111),
            width,
            height,
            columns,
            rows,
            distance,
        }
    }

    /// Draws a cloth whose cell `(y, x)` has the colour `colour(y, x)`.
    pub fn draw(&self, colour: impl Fn(usize, usize) -> Rgb + Sync) -> Colours {
        let spec = &self.spec;
        let (cells, pixels) = (spec.cell_noise as f32, spec.pixel_noise as f32);
        let noise = |channel: u32, py: usize, px: usize| {
            let (row, column) = (self.rows[py / self.scale], self.columns[px / self.scale]);
            cells * normal(self.seed ^ channel, column, row)
                + pixels * normal(self.seed ^ (channel + 2), px as u32, py as u32)
        };
        let picture = Colours::of(self.width, self.height, |py, px| {
            let near = 1.0 - self.distance[py * self.width + px];
            let paler = 1.0 - spec.paler as f32 * near;
            let lighter =
                (1.0 - spec.shade as f32 * (1.0 - near)) * (1.0 + spec.lighter as f32 * near);
            change(
                colour(py / self.scale, px / self.scale),
                |s| s * paler + noise(1, py, px) * s.min(0.5) * 2.0,
                |v| v * lighter + noise(2, py, px),
            )
        });
        picture.blurred(spec.blur)
    }
}

/// Changes saturation and value of a colour and keeps its hue.
fn change(colour: Rgb, saturation: impl Fn(f32) -> f32, value: impl Fn(f32) -> f32) -> Rgb {
    let most = colour[0].max(colour[1]).max(colour[2]);
    let least = colour[0].min(colour[1]).min(colour[2]);
    let spread = most - least;
    let v = value(most).clamp(0.0, 1.0);
    if spread <= 0.0 {
        return [v; 3];
    }
    let s = saturation(spread / most).clamp(0.0, 1.0);
    // Hue is how far each channel is below the highest, in units of the lowest one's.
    colour.map(|channel| v * (1.0 - s * (most - channel) / spread))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batik::tests::woven;
    use crate::texture::to_rgb;

    fn quiet() -> EllipseSpec {
        EllipseSpec {
            cell_noise: 0.0,
            pixel_noise: 0.0,
            blur: 0.0,
            ..EllipseSpec::default()
        }
    }

    fn drawn(spec: EllipseSpec, seed: u64) -> Colours {
        let cloth = woven(60, 48, 5, 1);
        let crossings = Crossings::of(&cloth);
        let weave = EllipseWeave::new(&crossings, |y, x| cloth.warp_up(y, x), spec, 3, seed);
        weave.draw(|_, _| [0.2, 0.3, 0.6])
    }

    #[test]
    fn changing_saturation_and_value_is_what_hsv_says() {
        for hue in [0.0, 40.0, 75.0, 130.0, 200.0, 222.0, 281.0, 359.0] {
            let rgb = to_rgb((hue, 0.6, 0.5));
            let changed = change(rgb, |s| 0.5 * s, |v| 1.2 * v);
            for (a, b) in changed.into_iter().zip(to_rgb((hue, 0.3, 0.6))) {
                assert!((a - b).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_middle_of_a_crossing_is_the_lightest_and_palest_of_its_cell() {
        let picture = drawn(quiet(), 1);
        // The second cloth cell each way, 18 pixels wide.
        let at = |y: usize, x: usize| picture.pixels[(18 + y) * 180 + 18 + x];
        let value = |p: Rgb| p[2];
        let saturation = |p: Rgb| (p[2] - p[0]) / p[2];
        let middle = at(9, 9);
        for y in 0..18 {
            for x in 0..18 {
                assert!(value(at(y, x)) <= value(middle) + 1e-6);
                assert!(saturation(at(y, x)) >= saturation(middle) - 1e-6);
            }
        }
        assert!(value(at(0, 0)) < 0.9 * value(middle));
    }

    #[test]
    fn ellipses_lie_along_the_upper_yarn() {
        let cloth = woven(60, 48, 5, 1);
        let crossings = Crossings::of(&cloth);
        let weave = EllipseWeave::new(&crossings, |y, x| cloth.warp_up(y, x), quiet(), 3, 1);
        let n = |y: usize, x: usize| weave.distance[y * 180 + x];
        // From the middle of a cell, seven pixels down and seven across.
        let (warp_up, weft_up) = ((9, 9), (9, 27));
        assert!(cloth.warp_up(3, 3) && !cloth.warp_up(3, 9));
        assert!(n(warp_up.0 + 7, warp_up.1) < n(warp_up.0, warp_up.1 + 7));
        assert!(n(weft_up.0 + 7, weft_up.1) > n(weft_up.0, weft_up.1 + 7));
    }

    #[test]
    fn one_seed_is_one_picture_and_noise_does_not_change_the_average() {
        let spec = EllipseSpec::default();
        assert_eq!(drawn(spec, 4), drawn(spec, 4));
        assert_ne!(drawn(spec, 4), drawn(spec, 5));
        let mean = |p: &Colours| p.pixels.iter().map(|p| p[2]).sum::<f32>() / p.pixels.len() as f32;
        assert!((mean(&drawn(spec, 4)) - mean(&drawn(quiet(), 4))).abs() < 0.005);
    }
}
