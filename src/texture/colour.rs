//! From an amount of dye to a colour: through three stops in HSV measured from dyed cloth
//! (paper D §4.3.1).

use crate::scenario::Colours;

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

/// Entries of a [`Ramp`]: so many that neighbours differ by less than one step of an 8-bit picture.
const ENTRIES: usize = 1024;

/// Colours by amount of dye, from undyed to fully dyed.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    colours: Vec<Rgb>,
    per_amount: f32,
}

impl Ramp {
    /// The colours of a scenario; `darkest_at` is the amount that has the darkest.
    pub fn new(colours: &Colours, darkest_at: f64) -> Self {
        let [lightest, middle, darkest] = colours.stops();
        let colour = |i: usize| {
            let t = 2.0 * i as f64 / (ENTRIES - 1) as f64;
            to_rgb(if t <= 1.0 {
                between(lightest, middle, t)
            } else {
                between(middle, darkest, t - 1.0)
            })
        };
        Ramp {
            colours: (0..ENTRIES).map(colour).collect(),
            per_amount: ((ENTRIES - 1) as f64 / darkest_at) as f32,
        }
    }

    /// The colour of an amount of dye.
    #[inline]
    pub fn colour(&self, amount: f32) -> Rgb {
        // Casting saturates: what is above the darkest has the darkest colour.
        let entry = (amount * self.per_amount + 0.5) as usize;
        self.colours[entry.min(ENTRIES - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn more_dye_is_never_lighter() {
        for colours in [Colours::Indigo, Colours::Madder, Colours::Walnut] {
            let ramp = Ramp::new(&colours, 0.5);
            let light = |i: i32| {
                let [r, g, b] = ramp.colour(i as f32 / 400.0);
                0.2126 * r + 0.7152 * g + 0.0722 * b
            };
            assert!((0..200).all(|i| light(i + 1) <= light(i) + 1e-6));
        }
    }

    #[test]
    fn neighbouring_colours_differ_by_less_than_a_step_of_the_picture() {
        let ramp = Ramp::new(&Colours::Indigo, 1.0);
        for pair in ramp.colours.windows(2) {
            assert!((0..3).all(|i| (pair[0][i] - pair[1][i]).abs() < 1.0 / 255.0));
        }
    }
}
