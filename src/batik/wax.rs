//! Wax as it is seen on the cloth until it is boiled off.
//!
//! Light goes through a layer of thickness t, is reflected by the cloth R and comes back through the
//! wax, and the wax itself scatters some light:
//!
//! ```text
//! seen = (1 − σt)·T^2t·R + σt·W
//! ```
//!
//! T is what whole wax lets through, W its own colour and σ the share it scatters: beeswax is yellow,
//! paraffin nearly white. In cracks t is small and the dye below shows. The surface is rounded
//! towards its edges as melted wax is, and its slopes catch light from the upper left.

use rayon::prelude::*;

use super::noise::fold_seed;
use super::picture::Colours;
use crate::pattern::{Raster, clouds};
use crate::texture::Rgb;

/// How wax looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaxLook {
    /// T: what whole wax lets through once, in each channel, 0 to 1.
    pub lets_through: Rgb,
    /// W: its own colour, 0 to 1.
    pub colour: Rgb,
    /// σ: the share of light that whole wax scatters, 0 to 1.
    pub scatters: f64,
    /// How much its slopes shine, 0 to 1.
    pub shine: f64,
    /// How unevenly thick it is, 0 to 1.
    pub uneven: f64,
    /// Cells across its thick and thin places.
    pub grain: f64,
}

impl Default for WaxLook {
    /// Beeswax with paraffin.
    fn default() -> Self {
        WaxLook {
            lets_through: [0.97, 0.93, 0.82],
            colour: [0.95, 0.89, 0.72],
            scatters: 0.32,
            shine: 0.55,
            uneven: 0.45,
            grain: 60.0,
        }
    }
}

/// Wax on a cloth, ready to be seen.
pub struct WaxLayer {
    look: WaxLook,
    nx: usize,
    ny: usize,
    /// t of every cell, 0 to 1.
    thickness: Vec<f32>,
    /// The height of its surface, rounded.
    surface: Raster,
}

/// How far edges are rounded: standard deviation, cells.
const ROUND: f64 = 1.3;

impl WaxLayer {
    /// The wax of a drawing with its cracks (0 waxed, 1 open).
    pub fn new(drawing: &Raster, look: WaxLook, seed: u64) -> Self {
        let own = u64::from(fold_seed(seed, 0x3a8));
        let uneven = clouds(own, 1, 3);
        let grain = look.grain.max(1.0);
        let nx = drawing.nx;
        let mut thickness = vec![0.0; drawing.values.len()];
        thickness
            .par_chunks_mut(nx.max(1))
            .enumerate()
            .for_each(|(y, row)| {
                for (x, thickness) in row.iter_mut().enumerate() {
                    let open = drawing.at(y, x);
                    if open < 1.0 {
                        let thin = uneven(x as f64 / grain, y as f64 / grain);
                        *thickness = (1.0 - open) * (1.0 - look.uneven as f32 * thin);
                    }
                }
            });
        let surface = Raster {
            nx,
            ny: drawing.ny,
            values: thickness.clone(),
        };
        WaxLayer {
            look,
            nx,
            ny: drawing.ny,
            thickness,
            surface: surface.blurred(ROUND),
        }
    }

    /// A picture of the cloth, with a whole number of pixels a cell, seen through the wax.
    pub fn over(&self, cloth: &Colours) -> Colours {
        let (across, down) = (cloth.width / self.nx.max(1), cloth.height / self.ny.max(1));
        if across == 0 || down == 0 {
            return cloth.clone();
        }
        Colours::of(cloth.width, cloth.height, |py, px| {
            let below = cloth.pixels[py * cloth.width + px];
            let (y, x) = (py / down, px / across);
            if y >= self.ny || x >= self.nx {
                return below;
            }
            let t = self.thickness[y * self.nx + x];
            let shine = self.look.shine as f32 * self.slope(y, x) * t.min(1.0);
            self.seen(below, t)
                .map(|channel| (channel + shine).clamp(0.0, 1.0))
        })
    }

    fn seen(&self, cloth: Rgb, t: f32) -> Rgb {
        let scattered = self.look.scatters as f32 * t;
        [0, 1, 2].map(|i| {
            // T^2t by its tangent at 1 − T: exact for no wax, and T is near 1.
            let through = 1.0 - t * (1.0 - self.look.lets_through[i] * self.look.lets_through[i]);
            (1.0 - scattered) * through * cloth[i] + scattered * self.look.colour[i]
        })
    }

    /// How much thicker the wax is below and to the right than above and to the left, −1 to 1: what
    /// faces the light and what turns away from it.
    fn slope(&self, y: usize, x: usize) -> f32 {
        let t = |y: usize, x: usize| self.surface.at(y, x);
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.nx - 1));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(self.ny - 1));
        0.5 * (t(y, right) - t(y, left) + t(below, x) - t(above, x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look() -> WaxLook {
        WaxLook {
            shine: 0.0,
            ..WaxLook::default()
        }
    }

    fn cloth() -> Colours {
        Colours::of(24, 20, |_, _| [0.9, 0.9, 0.9])
    }

    #[test]
    fn without_wax_the_cloth_is_seen_as_it_is() {
        let layer = WaxLayer::new(&Raster::uniform(12, 10, 1.0), WaxLook::default(), 1);
        assert_eq!(layer.over(&cloth()), cloth());
    }

    #[test]
    fn wax_is_yellowish_and_the_thicker_the_more() {
        let drawing = Raster::from_rule(12, 10, |x, _| (x / 12.0) as f32);
        let layer = WaxLayer::new(
            &drawing,
            WaxLook {
                uneven: 0.0,
                ..look()
            },
            1,
        );
        let seen = layer.over(&cloth());
        let yellow = |x: usize| seen.pixels[x][0] - seen.pixels[x][2];
        assert!(yellow(0) > 0.1);
        assert!((0..22).step_by(2).all(|x| yellow(x + 2) < yellow(x)));
    }

    #[test]
    fn dye_below_wax_can_still_be_told() {
        let layer = WaxLayer::new(&Raster::uniform(12, 10, 0.0), look(), 1);
        let dyed = Colours::of(24, 20, |_, _| [0.1, 0.15, 0.4]);
        let (pale, dark) = (layer.over(&cloth()), layer.over(&dyed));
        for (pale, dark) in pale.pixels.iter().zip(&dark.pixels) {
            // A quarter of the contrast is left, and more.
            let contrast = [0.8, 0.75, 0.5];
            assert!((0..3).all(|i| pale[i] - dark[i] > 0.25 * contrast[i]));
        }
    }
}
