//! The colour of cloth that holds several dyes: subtractive mixing after Kubelka and Munk.
//!
//! In every band of light, cloth of reflectance R absorbs and scatters as
//!
//! ```text
//! K/S = (1 − R)² / 2R        R = 1 / (1 + K/S + √(K/S·(K/S + 2)))
//! ```
//!
//! Dye hardly scatters, so the K/S of dyed cloth is that of the cloth plus those of its dyes: the
//! single-constant theory, on which the matching of textile dyes rests (Kubelka and Munk, Z. Tech.
//! Phys. 12, 1931; Nobbs, Rev. Prog. Coloration 15, 1985). Multiplying reflectances would let two
//! dark dyes go black too fast, and lets a thin layer and a thick one differ by a power only.
//!
//! The bands are the three of a screen, in linear light: dyes here are known by colours on a screen,
//! not by spectra, and more bands would have to be invented. K/S of a dye is read off its measured
//! colours from undyed to fully dyed cloth, so one dye alone looks exactly as measured.
//!
//! Sums do not depend on the order of dyes but for rounding; no dye leaves the cloth as it is; more
//! dye is never lighter in any band.

use crate::texture::Rgb;

/// K/S of each band.
type Absorption = [f32; 3];

/// The darkest reflectance that is told from black: one step of an 8-bit picture, in linear light.
const DARKEST: f32 = 1.0 / 255.0 / 12.92;
/// Entries of a table over amounts.
const ENTRIES: usize = 1024;
/// Entries of the table from linear light to display.
const DISPLAY: usize = 4096;

/// A dye, by what each amount of it absorbs.
#[derive(Debug, Clone, PartialEq)]
pub struct Dyestuff {
    /// Over amounts from 0 to `full`, evenly; never falling.
    absorption: Vec<Absorption>,
    /// Entries per amount.
    per_amount: f32,
}

impl Dyestuff {
    /// A dye measured on cloth: `colour(share)` is the colour (sRGB, 0 to 1) of cloth with that
    /// share, 0 to 1, of the amount `full`. What it absorbs is what cloth with it absorbs more than
    /// cloth without; where that would fall as dye is added it stays level.
    pub fn measured(colour: impl Fn(f32) -> Rgb, full: f32) -> Self {
        let undyed = absorption(colour(0.0));
        let mut highest = [0.0_f32; 3];
        let absorption = (0..ENTRIES)
            .map(|i| {
                let dyed = absorption(colour(i as f32 / (ENTRIES - 1) as f32));
                for band in 0..3 {
                    highest[band] = highest[band].max(dyed[band] - undyed[band]);
                }
                highest
            })
            .collect();
        Dyestuff {
            absorption,
            per_amount: (ENTRIES - 1) as f32 / full.max(f32::MIN_POSITIVE),
        }
    }

    /// A dye that absorbs in proportion to its amount: the amount `full` of it gives `cloth` the
    /// colour `dyed` (sRGB, 0 to 1).
    pub fn of_colour(dyed: Rgb, cloth: Rgb, full: f32) -> Self {
        let (dyed, cloth) = (absorption(dyed), absorption(cloth));
        let absorption = (0..ENTRIES)
            .map(|i| {
                let share = i as f32 / (ENTRIES - 1) as f32;
                [0, 1, 2].map(|band| share * (dyed[band] - cloth[band]).max(0.0))
            })
            .collect();
        Dyestuff {
            absorption,
            per_amount: (ENTRIES - 1) as f32 / full.max(f32::MIN_POSITIVE),
        }
    }

    #[inline]
    fn absorption(&self, amount: f32) -> Absorption {
        let place = (amount * self.per_amount).clamp(0.0, (ENTRIES - 1) as f32);
        let entry = (place as usize).min(ENTRIES - 2);
        let t = place - entry as f32;
        let (a, b) = (self.absorption[entry], self.absorption[entry + 1]);
        [0, 1, 2].map(|band| a[band] + t * (b[band] - a[band]))
    }
}

/// Dyes on a cloth.
#[derive(Debug, Clone)]
pub struct Mixture {
    cloth: Absorption,
    undyed: Rgb,
    dyes: Vec<Dyestuff>,
    /// Linear light to display, over the square root of light.
    display: Vec<f32>,
}

impl Mixture {
    /// Dyes on cloth of a colour (sRGB, 0 to 1).
    pub fn new(cloth: Rgb, dyes: Vec<Dyestuff>) -> Self {
        let display = |i: usize| {
            let root = i as f64 / (DISPLAY - 1) as f64;
            to_display(root * root) as f32
        };
        Mixture {
            cloth: absorption(cloth),
            undyed: cloth,
            dyes,
            display: (0..DISPLAY).map(display).collect(),
        }
    }

    /// The colour (sRGB, 0 to 1) of cloth with an amount of each dye, in the order of the dyes.
    #[inline]
    pub fn colour(&self, amounts: &[f32]) -> Rgb {
        if amounts.iter().all(|amount| *amount <= 0.0) {
            return self.undyed;
        }
        let mut sum = self.cloth;
        for (dye, amount) in self.dyes.iter().zip(amounts) {
            let absorbed = dye.absorption(*amount);
            for band in 0..3 {
                sum[band] += absorbed[band];
            }
        }
        sum.map(|ks| {
            let light = 1.0 / (1.0 + ks + (ks * (ks + 2.0)).sqrt());
            let place = light.sqrt() * (DISPLAY - 1) as f32;
            let entry = (place as usize).min(DISPLAY - 2);
            let (a, b) = (self.display[entry], self.display[entry + 1]);
            a + (place - entry as f32) * (b - a)
        })
    }
}

/// K/S of a colour.
fn absorption(colour: Rgb) -> Absorption {
    colour.map(|channel| {
        let light = (to_linear(f64::from(channel)) as f32).clamp(DARKEST, 1.0);
        (1.0 - light) * (1.0 - light) / (2.0 * light)
    })
}

/// sRGB to linear light (IEC 61966-2-1).
fn to_linear(value: f64) -> f64 {
    if value <= 0.040_45 {
        value / 12.92
    } else {
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

/// Linear light to sRGB.
fn to_display(light: f64) -> f64 {
    if light <= 0.003_130_8 {
        light * 12.92
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{ColourPath, Colours};
    use crate::texture::Ramp;

    const CLOTH: Rgb = [0.96, 0.94, 0.88];

    fn dye(colours: &Colours) -> Dyestuff {
        let ramp = Ramp::new(colours, ColourPath::Hsv, 1.0);
        Dyestuff::measured(|share| ramp.colour(share), 1.0)
    }

    fn three() -> Mixture {
        let dyes = [Colours::Indigo, Colours::Madder, Colours::Walnut];
        Mixture::new(CLOTH, dyes.iter().map(dye).collect())
    }

    fn amounts() -> impl Iterator<Item = [f32; 3]> {
        (0..216).map(|i| [i % 6, i / 6 % 6, i / 36].map(|n| n as f32 / 5.0))
    }

    #[test]
    fn no_dye_leaves_the_cloth_as_it_is() {
        assert_eq!(three().colour(&[0.0; 3]), CLOTH);
        // And next to no dye next to so: nothing jumps.
        for (a, b) in three().colour(&[1e-6; 3]).into_iter().zip(CLOTH) {
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
    }

    #[test]
    fn one_dye_alone_looks_as_it_was_measured() {
        let ramp = Ramp::new(&Colours::Madder, ColourPath::Hsv, 1.0);
        let cloth = ramp.colour(0.0);
        let mixture = Mixture::new(cloth, vec![dye(&Colours::Madder)]);
        for i in 0..=100 {
            let amount = i as f32 / 100.0;
            for (a, b) in mixture
                .colour(&[amount])
                .into_iter()
                .zip(ramp.colour(amount))
            {
                assert!((a - b).abs() < 0.5 / 255.0, "{amount}: {a} {b}");
            }
        }
    }

    #[test]
    fn the_order_of_dyes_does_not_matter() {
        let turned = [Colours::Walnut, Colours::Indigo, Colours::Madder];
        let turned = Mixture::new(CLOTH, turned.iter().map(dye).collect());
        for [a, b, c] in amounts() {
            let (one, other) = (three().colour(&[a, b, c]), turned.colour(&[c, a, b]));
            assert!((0..3).all(|band| (one[band] - other[band]).abs() < 1e-5));
        }
    }

    #[test]
    fn more_dye_is_never_lighter_in_any_band() {
        let mixture = three();
        for amounts in amounts() {
            let before = mixture.colour(&amounts);
            for dye in 0..3 {
                let mut more = amounts;
                more[dye] += 0.07;
                let after = mixture.colour(&more);
                assert!((0..3).all(|band| after[band] <= before[band] + 1e-6));
            }
        }
    }

    #[test]
    fn blue_over_yellow_is_green() {
        let cloth = [1.0; 3];
        let dyes = [[0.1, 0.3, 0.6], [0.95, 0.8, 0.15]];
        let dyes = dyes.map(|colour| Dyestuff::of_colour(colour, cloth, 1.0));
        let [r, g, b] = Mixture::new(cloth, dyes.to_vec()).colour(&[1.0, 1.0]);
        assert!(g > r && g > b, "{r} {g} {b}");
    }

    #[test]
    fn display_and_linear_light_are_inverse() {
        for i in 0..=1000 {
            let value = f64::from(i) / 1000.0;
            assert!((to_display(to_linear(value)) - value).abs() < 1e-4);
        }
    }
}
