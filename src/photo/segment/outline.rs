//! The relief that fits the mean picture of a weave's repeat best.

use rayon::prelude::*;

use super::classes::Classes;
use super::contrast::Contrast;
use super::crossings::Crossings;
use super::relief::{Fit, Place, REGRESSORS, Relief, fit};
use super::repeat::Lattice;
use super::sides::Sides;
use super::yarns::Yarns;
use crate::photo::plane::Plane;

/// Bins along a side of a crossing, of small and of large repeats.
const BINS: usize = 16;
const FEWER_BINS: usize = 10;
/// The largest repeat that is laid out with many bins, in crossings.
const SMALL_REPEAT: usize = 16;
/// More than so many pixels in a bin do not make it more certain.
const MOST_PIXELS: f32 = 8.0;
/// What makes yarns of another width than the pitch a little less likely.
const WIDTH_PRIOR: f64 = 0.01;
/// Where the five numbers of a relief, and the blur of the camera in pixels, may lie.
const RANGE: [(f32, f32); 6] = [
    (-0.25, 0.25),
    (-0.25, 0.25),
    (0.6, 1.0),
    (0.6, 1.0),
    (0.1, 1.1),
    (0.3, 2.0),
];
/// The first steps of the search.
const STEPS: [f32; 6] = [0.08, 0.08, 0.08, 0.08, 0.15, 0.3];
/// Times that steps are halved.
const HALVINGS: usize = 4;
const ROUGHLY: usize = 2;
/// Rounds over all numbers before steps are halved.
const ROUNDS: usize = 2;

/// The mean picture of one repeat of the weave.
struct Repeat {
    light: Plane,
    tint: Plane,
    weight: Plane,
    bins: usize,
    aspect: [f32; 2],
    /// Bins to a pixel.
    fineness: f32,
    ends: usize,
    picks: usize,
}

/// The shape of a cloth as a camera sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// The shape.
    pub relief: Relief,
    /// What the camera blurs: a standard deviation in pixels.
    pub blur: f32,
}

/// The sides and the outline that explain the photograph's mean repeat best, and the share of its
/// variance that they leave. The search begins at `begin`, too, if
/// that is known.
pub fn find(
    contrast: &Contrast,
    yarns: [&Yarns; 2],
    crossings: &Crossings,
    classes: &Classes,
    likely: &[Sides],
    begin: Option<Outline>,
) -> Option<(Sides, Outline, f64)> {
    let repeat = Repeat::of(contrast, yarns, crossings, classes);
    let mut starts: Vec<Numbers> = (0..8)
        .map(|i| {
            let one = |bit: usize| i >> bit & 1 == 1;
            let shift = |bit: usize| if one(bit) { 0.12 } else { -0.12 };
            [
                shift(0),
                shift(1),
                0.9,
                0.9,
                if one(2) { 0.7 } else { 0.3 },
                0.6,
            ]
        })
        .collect();
    starts.extend(begin.map(Outline::numbers));
    // Which sides they are is plain after a few steps.
    let roughly: Vec<Numbers> = starts[..4].to_vec();
    let sides = match likely {
        [one] => one,
        _ => repeat.best(classes.lattice, likely, &roughly, ROUGHLY)?.0,
    };
    let sides = std::slice::from_ref(sides);
    let (sides, cost, numbers) = repeat.best(classes.lattice, sides, &starts, HALVINGS)?;
    Some((sides.clone(), Outline::from_numbers(numbers), cost))
}

/// The numbers of a relief, and the blur.
type Numbers = [f32; 6];

impl Outline {
    fn numbers(self) -> Numbers {
        let [u, v, warp, weft, crimp] = self.relief.numbers();
        [u, v, warp, weft, crimp, self.blur]
    }

    fn from_numbers([u, v, warp, weft, crimp, blur]: Numbers) -> Self {
        Outline {
            relief: Relief::from_numbers([u, v, warp, weft, crimp]),
            blur,
        }
    }
}

impl Repeat {
    fn of(
        contrast: &Contrast,
        yarns: [&Yarns; 2],
        crossings: &Crossings,
        classes: &Classes,
    ) -> Self {
        let lattice = classes.lattice;
        let (ends, picks) = lattice.repeat();
        let bins = if ends * picks <= SMALL_REPEAT {
            BINS
        } else {
            FEWER_BINS
        };
        // Means by class first, then laid out.
        let per_class = bins * bins;
        let mut sums = vec![[0.0_f64; 2]; lattice.classes() * per_class];
        let mut counts = vec![0.0_f32; sums.len()];
        let (nx, ny) = yarns[0].size();
        for y in 0..ny {
            for x in 0..nx {
                let class = classes.of[crossings.at_pixel(x, y)];
                let bin = |yarns: &Yarns| {
                    let number = yarns.number_at(x, y);
                    (((number - number.floor()) * bins as f64) as usize).min(bins - 1)
                };
                let i = class * per_class + bin(yarns[1]) * bins + bin(yarns[0]);
                sums[i][0] += f64::from(contrast.light.get(x, y));
                sums[i][1] += f64::from(contrast.tint.get(x, y));
                counts[i] += 1.0;
            }
        }
        let index = |x: usize, y: usize| {
            let class = lattice.class(x / bins, y / bins);
            class * per_class + y % bins * bins + x % bins
        };
        let (nx, ny) = (ends * bins, picks * bins);
        let mean = |k: usize| {
            Plane::new(nx, ny, |x, y| {
                let i = index(x, y);
                (sums[i][k] / f64::from(counts[i].max(1.0))) as f32
            })
        };
        let pitches = yarns.map(|yarns| yarns.wave.pitch());
        let middle = 0.5 * (pitches[0] + pitches[1]);
        Repeat {
            light: mean(0),
            tint: mean(1),
            weight: Plane::new(nx, ny, |x, y| counts[index(x, y)].min(MOST_PIXELS)),
            bins,
            aspect: pitches.map(|pitch| (pitch / middle) as f32),
            fineness: bins as f32 / middle as f32,
            ends,
            picks,
        }
    }

    /// The sides and the start that lead to the lowest cost, and where they lead to.
    fn best<'s>(
        &self,
        lattice: Lattice,
        sides: &'s [Sides],
        starts: &[Numbers],
        halvings: usize,
    ) -> Option<(&'s Sides, f64, Numbers)> {
        let of = |sides: &'s Sides| starts.iter().map(move |start| (sides, *start));
        let ways: Vec<(&Sides, Numbers)> = sides.iter().flat_map(of).collect();
        let found: Vec<_> = ways
            .into_par_iter()
            .map(|(sides, start)| {
                let (cost, numbers) = self.woven(lattice, sides).descend(start, halvings);
                (sides, cost, numbers)
            })
            .collect();
        found.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn woven(&self, lattice: Lattice, sides: &Sides) -> Woven<'_> {
        let crossings = (0..self.picks).flat_map(|p| (0..self.ends).map(move |e| (e, p)));
        let up = |(e, p)| {
            if sides.warp_up[lattice.class(e, p)] {
                1.0
            } else {
                -1.0
            }
        };
        Woven {
            repeat: self,
            up: crossings.map(up).collect(),
        }
    }
}

/// A repeat with its weave.
struct Woven<'a> {
    repeat: &'a Repeat,
    /// 1 where the warp is on top, else −1, by pick and end.
    up: Vec<f32>,
}

impl Woven<'_> {
    fn fit(&self, outline: Outline) -> Fit {
        let repeat = self.repeat;
        let (nx, ny) = (repeat.light.nx, repeat.light.ny);
        let up = |e: i64, p: i64| {
            let e = e.rem_euclid(repeat.ends as i64) as usize;
            let p = p.rem_euclid(repeat.picks as i64) as usize;
            self.up[p * repeat.ends + e]
        };
        let middle = |i: usize| (i as f64 + 0.5) / repeat.bins as f64;
        let mut regressors: Vec<Plane> = (0..REGRESSORS)
            .map(|_| Plane {
                nx,
                ny,
                values: vec![0.0; nx * ny],
            })
            .collect();
        for y in 0..ny {
            for x in 0..nx {
                let place = Place::new(&outline.relief, repeat.aspect, [middle(x), middle(y)], up);
                let values = place.regressors(place.lead() > 0.0);
                for (plane, value) in regressors.iter_mut().zip(values) {
                    plane.values[y * nx + x] = value;
                }
            }
        }
        let blurred: Vec<Plane> = regressors
            .iter()
            .map(|plane| plane.blurred_around(outline.blur * repeat.fineness))
            .collect();
        fit(
            [&repeat.light, &repeat.tint],
            Some(&repeat.weight),
            &blurred,
        )
    }

    fn cost(&self, numbers: Numbers) -> f64 {
        let width = |k: usize| f64::from((1.0 - numbers[k]) * (1.0 - numbers[k]));
        self.fit(Outline::from_numbers(numbers)).share + WIDTH_PRIOR * (width(2) + width(3))
    }

    /// Goes from a start to lower cost, one number at a time.
    fn descend(&self, start: Numbers, halvings: usize) -> (f64, Numbers) {
        let mut here = start;
        let mut cost = self.cost(here);
        let mut steps = STEPS;
        for _ in 0..halvings {
            for _ in 0..ROUNDS {
                for k in 0..start.len() {
                    for step in [-steps[k], steps[k]] {
                        let mut there = here;
                        there[k] += step;
                        if !(RANGE[k].0..=RANGE[k].1).contains(&there[k]) {
                            continue;
                        }
                        let next = self.cost(there);
                        if next < cost - 1e-6 {
                            (here, cost) = (there, next);
                        }
                    }
                }
            }
            steps = steps.map(|step| 0.5 * step);
        }
        (cost, here)
    }
}
