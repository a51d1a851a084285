//! How single yarns lie aside and swell: by which the relief of the whole cloth fits each crossing.
//!
//! Shift and width are found for every crossing of every yarn by Gauss–Newton steps on the difference
//! between photograph and shaded relief, gathered along the yarn, with a prior that keeps them small.

use rayon::prelude::*;

use super::contrast::Contrast;
use super::crossings::Crossings;
use super::relief::{Fit, Light, Place, REGRESSORS, Relief, fit};
use super::yarns::Yarns;
use crate::photo::plane::{Plane, gaussian};

/// Gauss–Newton steps.
const STEPS: usize = 2;
/// Crossings along a yarn over which it lies much the same: the standard deviation of a window.
const ALONG: f32 = 1.0;
/// How far yarns commonly lie aside and swell, in pitches.
const PRIOR: f64 = 0.06;
/// How much of what neighbouring pixels say is news.
const NEWS: f64 = 0.75;
/// The longest step.
const LONGEST: f64 = 0.08;
/// The farthest aside, and the most that a yarn may swell and shrink.
const ASIDE: f64 = 0.2;
const SWELL: (f64, f64) = (-0.25, 0.15);
/// The change of a number by which derivatives are taken.
const CHANGE: f32 = 0.06;

/// What the cloth of a photograph is made of, as far as it is known.
pub struct Weaving<'a> {
    /// The photograph.
    pub contrast: &'a Contrast,
    /// Warp and weft.
    pub yarns: [&'a Yarns; 2],
    /// Where they cross.
    pub crossings: &'a Crossings<'a>,
    /// For every crossing, evidence that the warp is on top.
    pub crossed: &'a [f32],
    /// The shape of the cloth on the whole.
    pub relief: Relief,
    /// What the camera blurs: a standard deviation in pixels.
    pub blur: f32,
}

/// Shift and width of single yarns beyond those of the relief, at each crossing.
#[derive(Debug, Clone)]
pub struct Bends {
    /// In the order of [`Relief::numbers`]: shift of warp and weft, width of warp and weft.
    of: [Vec<f32>; 4],
}

impl Weaving<'_> {
    /// The pitch of warp and weft over their mean.
    fn aspect(&self) -> [f32; 2] {
        let pitches = self.yarns.map(|yarns| yarns.wave.pitch());
        pitches.map(|pitch| (2.0 * pitch / (pitches[0] + pitches[1])) as f32)
    }

    /// 1 where the warp is on top, else −1; beyond the photograph, as at its edge.
    #[inline]
    fn up(&self, end: i64, pick: i64) -> f32 {
        let inside = |i: i64, first: i64, n: usize| (i - first).clamp(0, n as i64 - 1) as usize;
        let e = inside(end, self.crossings.first_end, self.crossings.ends);
        let p = inside(pick, self.crossings.first_pick, self.crossings.picks);
        if self.crossed[p * self.crossings.ends + e] > 0.0 {
            1.0
        } else {
            -1.0
        }
    }

    /// The yarns at a place of the photograph.
    #[inline]
    pub fn place(&self, bends: &Bends, x: f32, y: f32) -> Place {
        let number = self.yarns.map(|yarns| yarns.number(x, y));
        self.place_of(bends, number, None)
    }

    fn place_of(&self, bends: &Bends, number: [f64; 2], change: Option<(usize, f32)>) -> Place {
        let mut numbers = self.relief.numbers();
        for (k, value) in numbers.iter_mut().take(4).enumerate() {
            *value += self.bend(bends, k, number);
        }
        if let Some((k, by)) = change {
            numbers[k] += by;
        }
        let relief = Relief::from_numbers(numbers);
        Place::new(&relief, self.aspect(), number, |e, p| self.up(e, p))
    }

    /// A bend between crossings: that of the yarn a place lies on, straight from crossing to crossing.
    #[inline]
    fn bend(&self, bends: &Bends, k: usize, number: [f64; 2]) -> f32 {
        let (ends, picks) = (self.crossings.ends, self.crossings.picks);
        let first = [self.crossings.first_end, self.crossings.first_pick];
        let own = k % 2;
        let other = 1 - own;
        let count = [ends, picks];
        let yarn = (number[own] - f64::from(self.relief.shift[own])).floor() as i64 - first[own];
        let yarn = yarn.clamp(0, count[own] as i64 - 1) as usize;
        let along = number[other] - f64::from(self.relief.shift[other]) - 0.5 - first[other] as f64;
        let before = (along.floor() as i64).clamp(0, count[other] as i64 - 2) as usize;
        let t = (along - before as f64).clamp(0.0, 1.0) as f32;
        let value = |along: usize| {
            let (e, p) = if own == 0 {
                (yarn, along)
            } else {
                (along, yarn)
            };
            bends.of[k][p * ends + e]
        };
        value(before) * (1.0 - t) + value(before + 1) * t
    }

    /// Finds how single yarns lie, and the light.
    pub fn bends(&self) -> (Bends, Fit) {
        let none = vec![0.0; self.crossings.len()];
        let mut bends = Bends {
            of: [none.clone(), none.clone(), none.clone(), none],
        };
        let mut light = self.light(&bends, None);
        for _ in 0..STEPS {
            self.step(&mut bends, &light);
            light = self.light(&bends, None);
        }
        (bends, light)
    }

    /// Fits the light, to the yarn that lies higher or to what `warp` says is seen at each pixel.
    pub fn light(&self, bends: &Bends, warp: Option<&[bool]>) -> Fit {
        let (nx, ny) = self.yarns[0].size();
        let values: Vec<[f32; REGRESSORS]> = (0..nx * ny)
            .into_par_iter()
            .map(|i| {
                let number = self.yarns.map(|yarns| yarns.number_at(i % nx, i / nx));
                let place = self.place_of(bends, number, None);
                place.regressors(warp.map_or(place.lead() > 0.0, |warp| warp[i]))
            })
            .collect();
        let regressors: Vec<Plane> = (0..REGRESSORS)
            .map(|k| Plane::new(nx, ny, |x, y| values[y * nx + x][k]).blurred(self.blur))
            .collect();
        fit(
            [&self.contrast.light, &self.contrast.tint],
            None,
            &regressors,
        )
    }

    /// The shaded relief as a camera sees it.
    fn rendered(&self, bends: &Bends, light: &Light, change: Option<(usize, f32)>) -> [Plane; 2] {
        let (nx, ny) = self.yarns[0].size();
        let shades: Vec<[f32; 2]> = (0..nx * ny)
            .into_par_iter()
            .map(|i| {
                let number = self.yarns.map(|yarns| yarns.number_at(i % nx, i / nx));
                let place = self.place_of(bends, number, change);
                light.shade(&place.regressors(place.lead() > 0.0))
            })
            .collect();
        [0, 1].map(|k| Plane::new(nx, ny, |x, y| shades[y * nx + x][k]).blurred(self.blur))
    }

    fn step(&self, bends: &mut Bends, light: &Fit) {
        let photograph = [&self.contrast.light, &self.contrast.tint];
        let now = self.rendered(bends, &light.light, None);
        let derivative = |bends: &Bends, k: usize| -> [Plane; 2] {
            let more = self.rendered(bends, &light.light, Some((k, CHANGE)));
            let less = self.rendered(bends, &light.light, Some((k, -CHANGE)));
            [0, 1].map(|c| {
                Plane::new(now[c].nx, now[c].ny, |x, y| {
                    (more[c].get(x, y) - less[c].get(x, y)) / (2.0 * CHANGE)
                })
            })
        };
        let noise = (light.left[0] + light.left[1]).max(1e-6);
        let nx = now[0].nx;
        for own in 0..2 {
            let (shift, width) = (own, own + 2);
            let slopes = [derivative(bends, shift), derivative(bends, width)];
            // Per crossing: the two squares and the product of the slopes, and their products with what
            // is left over.
            let mut sums = vec![[0.0_f64; 5]; self.crossings.len()];
            for i in 0..now[0].values.len() {
                let sum = &mut sums[self.crossings.at_pixel(i % nx, i / nx)];
                for c in 0..2 {
                    let left = f64::from(photograph[c].values[i] - now[c].values[i]);
                    let [a, b] = [0, 1].map(|k| f64::from(slopes[k][c].values[i]));
                    let terms = [a * a, a * b, b * b, a * left, b * left];
                    for (sum, term) in sum.iter_mut().zip(terms) {
                        *sum += term;
                    }
                }
            }
            let gathered = self.gathered(&sums, own);
            for (i, sums) in gathered.into_iter().enumerate() {
                let [aa, ab, bb, al, bl] = sums.map(|sum| sum * NEWS / noise);
                let prior = 1.0 / (PRIOR * PRIOR);
                let (s, w) = (f64::from(bends.of[shift][i]), f64::from(bends.of[width][i]));
                let (aa, bb) = (aa + prior, bb + prior);
                let (al, bl) = (al - s * prior, bl - w * prior);
                let det = aa * bb - ab * ab;
                let step = |value: f64| value.clamp(-LONGEST, LONGEST);
                let s = s + step((bb * al - ab * bl) / det);
                let w = w + step((aa * bl - ab * al) / det);
                bends.of[shift][i] = s.clamp(-ASIDE, ASIDE) as f32;
                bends.of[width][i] = w.clamp(SWELL.0, SWELL.1) as f32;
            }
        }
    }

    /// Sums of neighbouring crossings along each yarn of the warp (0) or the weft (1).
    fn gathered(&self, sums: &[[f64; 5]], own: usize) -> Vec<[f64; 5]> {
        let (ends, picks) = (self.crossings.ends as i64, self.crossings.picks as i64);
        let kernel = gaussian(ALONG);
        let middle = kernel[kernel.len() / 2];
        let reach = kernel.len() as i64 / 2;
        (0..ends * picks)
            .into_par_iter()
            .map(|i| {
                let (e, p) = (i % ends, i / ends);
                let mut gathered = [0.0; 5];
                for (k, weight) in kernel.iter().enumerate() {
                    let by = k as i64 - reach;
                    let (e, p) = if own == 0 { (e, p + by) } else { (e + by, p) };
                    if !(0..ends).contains(&e) || !(0..picks).contains(&p) {
                        continue;
                    }
                    let weight = f64::from(weight / middle);
                    for (gathered, sum) in gathered.iter_mut().zip(sums[(p * ends + e) as usize]) {
                        *gathered += weight * sum;
                    }
                }
                gathered
            })
            .collect()
    }
}
