//! The colours of dyed cloth, measured on a photograph (paper D §4.3.1: the lightest and the darkest
//! part of really dyed cloth, and one between).
//!
//! Cloth is not one colour even where it is dyed evenly: yarns are round, gaps are dark, fibres shine.
//! What counts is the colour of yarns where light falls on them. So the photograph is cut into small
//! squares of several yarns; of each the brighter pixels are taken, but not the very brightest, and
//! their mean is one sample. The lightest and the darkest stop are the means of the samples at both ends
//! of the range of lightness, a few aside for stains and highlights; the middle one is the mean of those
//! half-way between. Means are taken in linear light.

use image::{Rgb, RgbImage};

use super::photograph::ToOklab;
use super::{Photo, PhotoError};
use crate::scenario::{ColourPath, Colours};
use crate::texture::oklab::{Oklab, displayed};
use crate::texture::{Hsv, Ramp, to_hsv, to_rgb};

/// A part of a photograph: left, top, width and height in pixels.
pub type Region = [usize; 4];

/// One of the three stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Hue in degrees, saturation and value.
    pub hsv: Hsv,
    /// Pixels that it rests on.
    pub pixels: usize,
}

/// The three stops of dyed cloth, lightest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palette {
    /// Undyed, half dyed and fully dyed cloth.
    pub stops: [Stop; 3],
}

/// Squares along the shorter side.
const SQUARES: usize = 48;
/// The least side of a square, pixels.
const LEAST_SQUARE: usize = 12;
/// The squares without which nothing can be said.
const LEAST_SQUARES: usize = 12;
/// The pixels of a square that count, as shares in the order of lightness.
const LIT: (f64, f64) = (0.85, 0.98);
/// The squares at either end that count for a stop, as shares in that order.
const ENDS: (f64, f64) = (0.01, 0.06);
/// How far from half-way the squares of the middle stop are, as a share of the range.
const HALF_WAY: f64 = 0.10;

/// Where lightness differs by less, cloth is dyed evenly.
const EVEN: f64 = 0.01;

/// A small square of cloth.
#[derive(Clone, Copy)]
struct Sample {
    lab: Oklab,
    light: [f64; 3],
    pixels: usize,
}

/// Measures the stops.
///
/// # Errors
/// [`PhotoError::Region`] for a part that is not within the photograph, [`PhotoError::NoColours`]
/// where too little is seen.
pub fn measure(photo: &Photo, region: Option<Region>) -> Result<Palette, PhotoError> {
    let [left, top, width, height] = region.unwrap_or([0, 0, photo.nx, photo.ny]);
    let inside = |from: usize, length: usize, all: usize| {
        length > 0 && from.checked_add(length).is_some_and(|end| end <= all)
    };
    if !inside(left, width, photo.nx) || !inside(top, height, photo.ny) {
        return Err(PhotoError::Region {
            text: format!("{left},{top},{width},{height}"),
            why: format!(
                "it is left, top, width and height within {}×{} pixels",
                photo.nx, photo.ny
            ),
        });
    }
    let mut samples = samples(photo, [left, top, width, height]);
    if samples.len() < LEAST_SQUARES {
        return Err(PhotoError::NoColours {
            why: format!(
                "only {} squares of {LEAST_SQUARE} pixels a side or more are seen, and {LEAST_SQUARES} are needed; \
                 take a larger part or a larger photograph",
                samples.len()
            ),
        });
    }
    samples.sort_by(|a, b| b.lab.lightness.total_cmp(&a.lab.lightness));
    let n = samples.len() as f64;
    let (skip, take) = (
        (ENDS.0 * n) as usize,
        ((ENDS.1 * n) as usize).max((ENDS.0 * n) as usize + 1),
    );
    let lightest = &samples[skip..take];
    let darkest = &samples[samples.len() - take..samples.len() - skip];
    let mean =
        |of: &[Sample]| of.iter().map(|sample| sample.lab.lightness).sum::<f64>() / of.len() as f64;
    let (light, dark) = (mean(lightest), mean(darkest));
    let middle: Vec<Sample> = samples
        .iter()
        .filter(|sample| {
            let half = 0.5 * (light + dark);
            (sample.lab.lightness - half).abs() <= HALF_WAY * (light - dark).max(EVEN)
        })
        .copied()
        .collect();
    let ends = [stop(lightest), stop(darkest)];
    // Where nothing is half dyed, half-way between both ends is the best that can be said.
    let middle = if middle.is_empty() {
        Stop {
            hsv: crate::texture::between(ends[0].hsv, ends[1].hsv, 0.5),
            pixels: 0,
        }
    } else {
        stop(&middle)
    };
    Ok(Palette {
        stops: [ends[0], middle, ends[1]],
    })
}

fn samples(photo: &Photo, [left, top, width, height]: Region) -> Vec<Sample> {
    let to_oklab = ToOklab::new();
    let side = (width.min(height) / SQUARES).max(LEAST_SQUARE);
    let mut all = Vec::new();
    for y in (0..height / side).map(|i| top + i * side) {
        for x in (0..width / side).map(|i| left + i * side) {
            let places = (0..side * side).map(|i| (y + i / side) * photo.nx + x + i % side);
            let mut pixels: Vec<(Oklab, [u8; 3])> = places
                .filter(|i| photo.is_opaque(*i))
                .map(|i| (to_oklab.of(photo.rgb[i]), photo.rgb[i]))
                .collect();
            if 2 * pixels.len() < side * side {
                continue;
            }
            pixels.sort_by(|a, b| a.0.lightness.total_cmp(&b.0.lightness));
            let place = |share: f64| (share * pixels.len() as f64) as usize;
            let lit = &pixels[place(LIT.0)..place(LIT.1).max(place(LIT.0) + 1)];
            let mut light = [0.0; 3];
            for (_, rgb) in lit {
                for (sum, channel) in light.iter_mut().zip(rgb) {
                    let channel = crate::texture::oklab::linear(f64::from(*channel) / 255.0);
                    *sum += channel / lit.len() as f64;
                }
            }
            all.push(Sample {
                lab: Oklab::from_linear(light),
                light,
                pixels: lit.len(),
            });
        }
    }
    all
}

/// The mean of some samples.
fn stop(samples: &[Sample]) -> Stop {
    let mean = |i: usize| {
        let sum: f64 = samples.iter().map(|sample| sample.light[i]).sum();
        displayed(sum / samples.len() as f64).clamp(0.0, 1.0)
    };
    Stop {
        hsv: to_hsv([0, 1, 2].map(mean)),
        pixels: samples.iter().map(|sample| sample.pixels).sum(),
    }
}

impl Palette {
    /// The stops as a scenario has them, ready to be pasted into its `look`.
    pub fn to_ron(&self) -> String {
        let number = |x: f64, digits: i32| {
            let scale = libm::pow(10.0, f64::from(digits));
            (x * scale).round() / scale
        };
        let stop = |name: &str, stop: Stop| {
            let (hue, saturation, value) = stop.hsv;
            format!(
                "{name}: ({:?}, {:?}, {:?})",
                number(hue, 1),
                number(saturation, 3),
                number(value, 3)
            )
        };
        let [light, middle, dark] = self.stops;
        format!(
            "colours: Stops({}, {}, {})",
            stop("lightest", light),
            stop("middle", middle),
            stop("darkest", dark)
        )
    }

    /// The colours from undyed to fully dyed, above the three stops.
    pub fn swatch(&self) -> RgbImage {
        let [lightest, middle, darkest] = self.stops.map(|stop| stop.hsv);
        let colours = Colours::Stops {
            lightest,
            middle,
            darkest,
        };
        let ramp = Ramp::new(&colours, ColourPath::Hsv, 1.0);
        let byte = |channel: f32| (255.0 * channel + 0.5) as u8;
        RgbImage::from_fn(600, 240, |x, y| {
            let colour = if y < 120 {
                ramp.colour(x as f32 / 599.0)
            } else {
                to_rgb(self.stops[x as usize / 200].hsv)
            };
            Rgb(colour.map(byte))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::oklab::linear;

    const STOPS: [Hsv; 3] = [
        (205.0, 0.05, 0.95),
        (211.0, 0.60, 0.66),
        (226.0, 0.78, 0.30),
    ];

    /// Cloth that is dyed more and more from left to right, of round yarns 6 pixels wide.
    fn dyed() -> Photo {
        let [lightest, middle, darkest] = STOPS;
        let colours = Colours::Stops {
            lightest,
            middle,
            darkest,
        };
        let ramp = Ramp::new(&colours, ColourPath::Hsv, 1.0);
        let (nx, ny) = (480, 300);
        let pixel = |i: usize| {
            let (x, y) = (i % nx, i / nx);
            // A third undyed, a third in steps, a third full.
            let amount = ((x as f32 / nx as f32 - 0.3) / 0.4).clamp(0.0, 1.0);
            let round = 1.0
                - ((x % 6) as f32 - 2.5)
                    .abs()
                    .max(((y % 6) as f32 - 2.5).abs())
                    / 5.0;
            let shade = round.min(1.0) + 0.1;
            ramp.colour(amount)
                .map(|c| (255.0 * (c * shade).min(1.0) + 0.5) as u8)
        };
        Photo {
            nx,
            ny,
            rgb: (0..nx * ny).map(pixel).collect(),
            opacity: None,
        }
    }

    fn lab(hsv: Hsv) -> Oklab {
        Oklab::from_linear(to_rgb(hsv).map(|c| linear(f64::from(c))))
    }

    #[test]
    fn the_stops_of_dyed_cloth_are_found_under_its_shade() {
        let palette = measure(&dyed(), None).unwrap();
        for (found, known) in palette.stops.iter().zip(STOPS) {
            let distance = lab(found.hsv).distance(lab(known));
            // Yarns are a little darker than their colour even where they are lit; hue is not touched.
            assert!(distance < 0.09, "{found:?} for {known:?}: {distance}");
            assert!(
                (found.hsv.0 - known.0).abs() < 4.0,
                "{found:?} for {known:?}"
            );
            assert!(found.pixels > 100);
        }
    }

    #[test]
    fn the_darker_stop_is_never_lighter() {
        let lightness = measure(&dyed(), None)
            .unwrap()
            .stops
            .map(|stop| lab(stop.hsv).lightness);
        assert!(lightness[0] > lightness[1] && lightness[1] > lightness[2]);
    }

    #[test]
    fn a_photograph_turned_upside_down_has_the_same_colours() {
        let (photo, mut turned) = (dyed(), dyed());
        turned.rgb.reverse();
        let [a, b] = [photo, turned].map(|photo| measure(&photo, None).unwrap());
        for (a, b) in a.stops.iter().zip(b.stops) {
            assert!(lab(a.hsv).distance(lab(b.hsv)) < 1e-6);
        }
    }

    #[test]
    fn only_the_region_counts() {
        let left = measure(&dyed(), Some([0, 0, 120, 300])).unwrap();
        for stop in left.stops {
            assert!(lab(stop.hsv).distance(lab(STOPS[0])) < 0.09, "{stop:?}");
        }
        let outside = measure(&dyed(), Some([400, 0, 100, 300]));
        assert!(matches!(outside, Err(PhotoError::Region { .. })));
        let tiny = measure(&dyed(), Some([0, 0, 9, 9]));
        assert!(matches!(tiny, Err(PhotoError::NoColours { .. })));
    }

    #[test]
    fn what_is_printed_is_a_look_of_a_scenario() {
        let text = format!("({})", measure(&dyed(), None).unwrap().to_ron());
        let look: crate::scenario::LookSpec = ron::from_str(&text).unwrap();
        assert!(matches!(look.colours, Colours::Stops { .. }));
    }
}
