//! From an amount of dye to a colour: through three stops measured from dyed cloth, in HSV (paper D
//! §4.3.1) or, beyond the paper, in OKLCH, where equal steps of dye are equal steps to the eye.

use super::oklab::{Oklab, Oklch};
use crate::scenario::{ColourPath, Colours};

/// Linear-light is not used here: as in the papers, colours and the cloth's shade are multiplied as
/// they are displayed (sRGB values, 0 to 1).
pub type Rgb = [f32; 3];

/// A colour as (hue in degrees, saturation, value).
pub type Hsv = (f64, f64, f64);

/// Interpolates between two colours, hue the short way round the circle.
pub fn between(a: Hsv, b: Hsv, t: f64) -> Hsv {
    let turn = (b.0 - a.0 + 180.0).rem_euclid(360.0) - 180.0;
    // The hue of a grey means nothing: take the other's.
    let hue = match (a.1 == 0.0, b.1 == 0.0) {
        (true, false) => b.0,
        (false, true) => a.0,
        _ => (a.0 + turn * t).rem_euclid(360.0),
    };
    (hue, a.1 + (b.1 - a.1) * t, a.2 + (b.2 - a.2) * t)
}

/// An HSV colour in RGB.
pub fn to_rgb((hue, saturation, value): Hsv) -> Rgb {
    let channel = |n: f64| {
        let k = (n + hue / 60.0).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    [5.0, 3.0, 1.0].map(|n| channel(n) as f32)
}

/// The colour between two HSV colours along a straight way in OKLCH.
fn between_perceived(a: Hsv, b: Hsv, t: f64) -> Rgb {
    let [a, b] = [a, b].map(|hsv| Oklch::from(Oklab::from_rgb(to_rgb(hsv).map(f64::from))));
    Oklch::between(a, b, t)
        .to_rgb()
        .map(|channel| channel as f32)
}

/// An RGB colour (0 to 1) in HSV, the way back from [`to_rgb`]; a grey has hue 0.
pub fn to_hsv(rgb: [f64; 3]) -> Hsv {
    let [r, g, b] = rgb;
    let value = r.max(g).max(b);
    let range = value - r.min(g).min(b);
    if range <= 0.0 {
        return (0.0, 0.0, value);
    }
    let sixth = if value == r {
        (g - b) / range
    } else if value == g {
        (b - r) / range + 2.0
    } else {
        (r - g) / range + 4.0
    };
    ((60.0 * sixth).rem_euclid(360.0), range / value, value)
}

/// Entries of a [`Ramp`] at the least; it gets more until neighbours differ by less than one step of
/// an 8-bit picture, which only stops far apart in hue ever need.
const ENTRIES: usize = 1024;
const MOST_ENTRIES: usize = 1 << 16;

/// Colours by amount of dye, from undyed to fully dyed.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    colours: Vec<Rgb>,
    per_amount: f32,
}

impl Ramp {
    /// The colours of a scenario along a path; `darkest_at` is the amount that has the darkest.
    pub fn new(colours: &Colours, path: ColourPath, darkest_at: f64) -> Self {
        let [lightest, middle, darkest] = colours.stops();
        let leg = |a, b, t| match path {
            ColourPath::Hsv => to_rgb(between(a, b, t)),
            ColourPath::Oklch => between_perceived(a, b, t),
        };
        let colour = |i: usize, entries: usize| {
            let t = 2.0 * i as f64 / (entries - 1) as f64;
            if t <= 1.0 {
                leg(lightest, middle, t)
            } else {
                leg(middle, darkest, t - 1.0)
            }
        };
        let mut entries = ENTRIES;
        let colours = loop {
            let colours: Vec<Rgb> = (0..entries).map(|i| colour(i, entries)).collect();
            if entries >= MOST_ENTRIES || colours.windows(2).all(|pair| step(pair) < 1.0 / 255.0) {
                break colours;
            }
            entries *= 2;
        };
        Ramp {
            per_amount: ((colours.len() - 1) as f64 / darkest_at) as f32,
            colours,
        }
    }

    /// The colour of an amount of dye.
    #[inline]
    pub fn colour(&self, amount: f32) -> Rgb {
        // Casting saturates: what is above the darkest has the darkest colour.
        let entry = (amount * self.per_amount + 0.5) as usize;
        self.colours[entry.min(self.colours.len() - 1)]
    }
}

/// The largest change of a channel between two colours.
fn step(pair: &[Rgb]) -> f32 {
    (0..3)
        .map(|c| (pair[0][c] - pair[1][c]).abs())
        .fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::{Chance, Purpose};

    #[test]
    fn hue_takes_the_short_way_round() {
        let (hue, ..) = between((350.0, 1.0, 1.0), (30.0, 1.0, 1.0), 0.5);
        assert!((hue - 10.0).abs() < 1e-9);
        let (hue, ..) = between((30.0, 1.0, 1.0), (350.0, 1.0, 1.0), 0.75);
        assert!((hue - 0.0).abs() < 1e-9);
    }

    #[test]
    fn the_six_pure_hues_are_what_they_should_be() {
        let pure = |hue| to_rgb((hue, 1.0, 1.0));
        assert_eq!(pure(0.0), [1.0, 0.0, 0.0]);
        assert_eq!(pure(60.0), [1.0, 1.0, 0.0]);
        assert_eq!(pure(120.0), [0.0, 1.0, 0.0]);
        assert_eq!(pure(180.0), [0.0, 1.0, 1.0]);
        assert_eq!(pure(240.0), [0.0, 0.0, 1.0]);
        assert_eq!(pure(300.0), [1.0, 0.0, 1.0]);
    }

    #[test]
    fn hsv_there_and_back_is_the_same_colour() {
        for i in 0..343 {
            let rgb = [i % 7, i / 7 % 7, i / 49].map(|c| f64::from(c) / 6.0);
            let back = to_rgb(to_hsv(rgb));
            assert!((0..3).all(|c| (f64::from(back[c]) - rgb[c]).abs() < 1e-6));
        }
    }

    const PATHS: [ColourPath; 2] = [ColourPath::Hsv, ColourPath::Oklch];

    fn some_stops() -> impl Iterator<Item = Colours> {
        let mut chance = Chance(4).sequence(Purpose::WarpLook);
        let bundled = [Colours::Indigo, Colours::Madder, Colours::Walnut];
        bundled.into_iter().chain((0..200).map(move |_| {
            let mut colour = || (360.0 * chance.unit(), chance.unit(), chance.unit());
            Colours::Stops {
                lightest: colour(),
                middle: colour(),
                darkest: colour(),
            }
        }))
    }

    fn lightness(rgb: Rgb) -> f64 {
        Oklab::from_rgb(rgb.map(f64::from)).lightness
    }

    #[test]
    fn more_dye_is_never_lighter() {
        for colours in [Colours::Indigo, Colours::Madder, Colours::Walnut] {
            for path in PATHS {
                let ramp = Ramp::new(&colours, path, 0.5);
                let light = |i: i32| lightness(ramp.colour(i as f32 / 400.0));
                assert!((0..200).all(|i| light(i + 1) <= light(i) + 1e-6));
            }
        }
    }

    #[test]
    fn the_ends_are_the_stops() {
        for colours in some_stops() {
            let [lightest, _, darkest] = colours.stops().map(to_rgb);
            for path in PATHS {
                let ramp = Ramp::new(&colours, path, 1.0);
                for (stop, found) in [(lightest, ramp.colour(0.0)), (darkest, ramp.colour(1.0))] {
                    assert!((0..3).all(|c| (stop[c] - found[c]).abs() < 1e-4));
                }
            }
        }
    }

    #[test]
    fn perceived_lightness_changes_evenly_from_stop_to_stop() {
        for colours in some_stops() {
            let [lightest, middle, darkest] = colours.stops().map(|stop| lightness(to_rgb(stop)));
            let ramp = Ramp::new(&colours, ColourPath::Oklch, 1.0);
            for i in 0..=100 {
                let t = 2.0 * f64::from(i) / 100.0;
                let even = if t <= 1.0 {
                    lightest + (middle - lightest) * t
                } else {
                    middle + (darkest - middle) * (t - 1.0)
                };
                let found = lightness(ramp.colour(i as f32 / 100.0));
                // Half an entry to either side.
                assert!((found - even).abs() < 1e-3, "{colours:?} at {i} %");
            }
        }
    }

    #[test]
    fn neighbouring_colours_differ_by_less_than_a_step_of_the_picture() {
        for colours in some_stops() {
            for path in PATHS {
                let ramp = Ramp::new(&colours, path, 1.0);
                for pair in ramp.colours.windows(2) {
                    let apart = |c: usize| (pair[0][c] - pair[1][c]).abs();
                    assert!(
                        (0..3).all(|c| apart(c) < 1.0 / 255.0),
                        "{path:?} {colours:?}"
                    );
                }
            }
        }
    }
}
