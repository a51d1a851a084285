//! OKLab and OKLCH: colours by lightness, chroma and hue as they are perceived.
//!
//! B. Ottosson, *A perceptual color space for image processing* (2020): sRGB made linear, turned by a
//! matrix into the responses of three cones, their cube roots, and a second matrix. Equal steps of
//! lightness L (0 black to 1 white) look equal, and so do distances in (L, a, b). The matrices are
//! those of CSS Color 4. All in double precision with `libm`: the same bits everywhere.

use std::f64::consts::PI;

use libm::{atan2, cbrt, cos, pow, sin, sqrt};

/// A colour in OKLab.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Oklab {
    /// Lightness, 0 black to 1 white.
    pub lightness: f64,
    /// From green (negative) to red.
    pub a: f64,
    /// From blue (negative) to yellow.
    pub b: f64,
}

/// A colour in OKLCH: OKLab in polar coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Oklch {
    /// Lightness, 0 black to 1 white.
    pub lightness: f64,
    /// Distance from grey; the most colourful of sRGB has 0.32.
    pub chroma: f64,
    /// Hue in degrees, 0 to 360.
    pub hue: f64,
}

/// What less chroma than this is has no hue that can be told.
pub const ACHROMATIC: f64 = 1e-4;

const TO_CONES: [[f64; 3]; 3] = [
    [
        0.412_221_469_470_763,
        0.536_332_537_261_734_8,
        0.051_445_993_267_502_2,
    ],
    [
        0.211_903_495_816_473_6,
        0.680_699_550_645_234_2,
        0.107_396_953_538_292_2,
    ],
    [
        0.088_302_459_158_008_6,
        0.281_718_839_136_121_5,
        0.629_978_701_705_870_1,
    ],
];
const FROM_CONES: [[f64; 3]; 3] = [
    [
        4.076_741_636_075_959,
        -3.307_711_539_258_062,
        0.230_969_903_182_102_9,
    ],
    [
        -1.268_437_973_285_036_3,
        2.609_757_349_287_688_7,
        -0.341_319_376_002_650_7,
    ],
    [
        -0.004_196_076_138_675_4,
        -0.703_418_617_935_936,
        1.707_614_694_074_611_8,
    ],
];
const TO_LAB: [[f64; 3]; 3] = [
    [
        0.210_454_268_309_314,
        0.793_617_774_703_009_5,
        -0.004_072_043_012_323_5,
    ],
    [
        1.977_998_532_431_168_4,
        -2.428_592_242_048_58,
        0.450_593_709_617_411_1,
    ],
    [
        0.025_904_042_465_547_8,
        0.782_771_712_457_529_6,
        -0.808_675_754_923_077_4,
    ],
];
const FROM_LAB: [[f64; 3]; 3] = [
    [1.0, 0.396_337_777_376_174_9, 0.215_803_757_309_913_6],
    [1.0, -0.105_561_345_815_658_6, -0.063_854_172_825_813_3],
    [1.0, -0.089_484_177_529_811_9, -1.291_485_548_019_409_2],
];

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// A channel as it is displayed (sRGB, 0 to 1) in linear light.
pub fn linear(channel: f64) -> f64 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        pow((channel + 0.055) / 1.055, 2.4)
    }
}

/// A channel of linear light as it is displayed.
pub fn displayed(light: f64) -> f64 {
    if light <= 0.003_130_8 {
        light * 12.92
    } else {
        1.055 * pow(light, 1.0 / 2.4) - 0.055
    }
}

impl Oklab {
    /// From displayed red, green and blue, 0 to 1.
    pub fn from_rgb(rgb: [f64; 3]) -> Self {
        Oklab::from_linear(rgb.map(linear))
    }

    /// From red, green and blue in linear light, 0 to 1.
    pub fn from_linear(light: [f64; 3]) -> Self {
        let [lightness, a, b] = times(&TO_LAB, times(&TO_CONES, light).map(cbrt));
        Oklab { lightness, a, b }
    }

    /// Red, green and blue in linear light; outside 0 to 1 where a screen cannot show it.
    pub fn to_linear(self) -> [f64; 3] {
        let cones = times(&FROM_LAB, [self.lightness, self.a, self.b]);
        times(&FROM_CONES, cones.map(|root| root * root * root))
    }

    /// How different two colours look: 0.02 is just seen.
    pub fn distance(self, other: Oklab) -> f64 {
        let (dl, da, db) = (
            self.lightness - other.lightness,
            self.a - other.a,
            self.b - other.b,
        );
        sqrt(dl * dl + da * da + db * db)
    }
}

impl From<Oklab> for Oklch {
    fn from(lab: Oklab) -> Self {
        let turn = atan2(lab.b, lab.a) * (180.0 / PI);
        Oklch {
            lightness: lab.lightness,
            chroma: sqrt(lab.a * lab.a + lab.b * lab.b),
            hue: turn.rem_euclid(360.0),
        }
    }
}

impl From<Oklch> for Oklab {
    fn from(lch: Oklch) -> Self {
        let angle = lch.hue * (PI / 180.0);
        Oklab {
            lightness: lch.lightness,
            a: lch.chroma * cos(angle),
            b: lch.chroma * sin(angle),
        }
    }
}

impl Oklch {
    /// A grey has no hue.
    pub fn is_achromatic(self) -> bool {
        self.chroma < ACHROMATIC
    }

    /// Between two colours: lightness and chroma evenly, hue the short way round. A grey takes the
    /// hue of the other.
    pub fn between(a: Oklch, b: Oklch, t: f64) -> Self {
        let hue = match (a.is_achromatic(), b.is_achromatic()) {
            (true, _) => b.hue,
            (_, true) => a.hue,
            _ => {
                let turn = (b.hue - a.hue + 180.0).rem_euclid(360.0) - 180.0;
                (a.hue + turn * t).rem_euclid(360.0)
            }
        };
        Oklch {
            lightness: a.lightness + (b.lightness - a.lightness) * t,
            chroma: a.chroma + (b.chroma - a.chroma) * t,
            hue,
        }
    }

    /// Displayed red, green and blue, 0 to 1.
    ///
    /// What a screen cannot show is cut off channel by channel in linear light, and grey is added or
    /// taken until the lightness is right again. Making it greyer in OKLCH instead would keep the
    /// hue, but jump: the blue edge of sRGB is hollow there.
    pub fn to_rgb(self) -> [f64; 3] {
        let light = Oklab::from(self).to_linear();
        let with_grey = |grey: f64| light.map(|c| (c + grey).clamp(0.0, 1.0));
        let fits = light.iter().all(|c| (0.0..=1.0).contains(c));
        if fits {
            return light.map(displayed);
        }
        // More grey is lighter: from black to white.
        let least = light.iter().fold(1.0, |least: f64, c| least.min(*c));
        let most = light.iter().fold(0.0, |most: f64, c| most.max(*c));
        let (mut darker, mut lighter) = (-most, 1.0 - least);
        for _ in 0..60 {
            let grey = 0.5 * (darker + lighter);
            if Oklab::from_linear(with_grey(grey)).lightness < self.lightness {
                darker = grey;
            } else {
                lighter = grey;
            }
        }
        with_grey(0.5 * (darker + lighter)).map(displayed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some_colours() -> impl Iterator<Item = [f64; 3]> {
        (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| f64::from(c) / 9.0))
    }

    #[test]
    fn there_and_back_is_the_same_colour() {
        for rgb in some_colours() {
            let back = Oklch::from(Oklab::from_rgb(rgb)).to_rgb();
            assert!(
                (0..3).all(|i| (rgb[i] - back[i]).abs() < 1e-5),
                "{rgb:?} {back:?}"
            );
        }
    }

    #[test]
    fn white_has_lightness_one_and_greys_have_no_hue() {
        let white = Oklab::from_rgb([1.0; 3]);
        assert!((white.lightness - 1.0).abs() < 1e-7);
        for i in 0..=10 {
            assert!(Oklch::from(Oklab::from_rgb([f64::from(i) / 10.0; 3])).is_achromatic());
        }
    }

    #[test]
    fn the_published_examples_come_out() {
        // Ottosson's table gives XYZ; these are its sRGB primaries as CSS Color 4 quotes them.
        let near = |rgb, l: f64, c: f64, h: f64| {
            let found = Oklch::from(Oklab::from_rgb(rgb));
            (found.lightness - l).abs() < 1e-3
                && (found.chroma - c).abs() < 1e-3
                && (found.hue - h).abs() < 0.1
        };
        assert!(near([1.0, 0.0, 0.0], 0.6280, 0.2577, 29.23));
        assert!(near([0.0, 1.0, 0.0], 0.8664, 0.2948, 142.50));
        assert!(near([0.0, 0.0, 1.0], 0.4520, 0.3132, 264.05));
    }

    #[test]
    fn what_a_screen_cannot_show_keeps_its_lightness() {
        for hue in (0..360).step_by(15) {
            for lightness in [0.2, 0.5, 0.8] {
                let wanted = Oklch {
                    lightness,
                    chroma: 0.4,
                    hue: f64::from(hue),
                };
                let shown = Oklch::from(Oklab::from_rgb(wanted.to_rgb()));
                assert!((shown.lightness - lightness).abs() < 1e-6);
                assert!(shown.chroma < 0.4);
            }
        }
    }

    #[test]
    fn what_is_little_outside_changes_little() {
        for rgb in some_colours() {
            let edge = Oklch::from(Oklab::from_rgb(rgb));
            let wanted = Oklch {
                chroma: edge.chroma + 0.01,
                ..edge
            };
            let shown = Oklab::from_rgb(wanted.to_rgb());
            assert!(shown.distance(Oklab::from(wanted)) < 0.025, "{rgb:?}");
        }
    }

    #[test]
    fn hue_takes_the_short_way_round_and_a_grey_takes_the_others() {
        let colour = |chroma, hue| Oklch {
            lightness: 0.5,
            chroma,
            hue,
        };
        let middle = Oklch::between(colour(0.1, 350.0), colour(0.1, 30.0), 0.5);
        assert!((middle.hue - 10.0).abs() < 1e-9);
        assert_eq!(
            Oklch::between(colour(0.0, 0.0), colour(0.1, 200.0), 0.1).hue,
            200.0
        );
        assert_eq!(
            Oklch::between(colour(0.1, 200.0), colour(0.0, 0.0), 0.9).hue,
            200.0
        );
    }
}
