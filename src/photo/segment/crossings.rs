//! The places where a warp yarn crosses a weft yarn, each looked at as a small square patch along its
//! own yarns, and what is measured of it.

use rayon::prelude::*;

use super::contrast::Contrast;
use super::yarns::Yarns;
use crate::photo::plane::Plane;

/// Samples along a side of a patch.
pub const SIDE: usize = 8;
/// Samples of a patch.
pub const SAMPLES: usize = SIDE * SIDE;
/// Numbers measured of a crossing: lightness in 4 × 4 parts; by quarters, how much more it changes
/// across the warp than across the weft, how oblique it is, and its tint.
pub const FEATURES: usize = 16 + 4 + 4 + 4;

/// Features by the parts they are measured in: the first of each group, how many, and how much they
/// count. What tells warp from weft in every cloth is the way in which they change.
const GROUPS: [(usize, usize, f32); 4] = [(0, 16, 1.0), (16, 4, 3.0), (20, 4, 1.0), (24, 4, 1.0)];
/// How much the difference of opposite parts of a patch counts beside their sum. Where yarns are followed
/// a little wrongly, it comes and goes; the sum stays.
const ODD: f32 = 0.4;

/// One channel of a patch, `[weft direction][warp direction]`: rows go down along the warp.
pub type Patch = [f32; SAMPLES];

/// All crossings of a photograph, row by row of picks.
pub struct Crossings<'a> {
    contrast: &'a Contrast,
    warp: &'a Yarns,
    weft: &'a Yarns,
    /// Number of the first warp yarn.
    pub first_end: i64,
    /// Number of the first weft yarn.
    pub first_pick: i64,
    /// Warp yarns.
    pub ends: usize,
    /// Weft yarns.
    pub picks: usize,
    /// The middle of every crossing in pixels, and how far one goes for a yarn in either direction.
    frames: Vec<Frame>,
    /// Whether a crossing lies wholly in the photograph.
    pub whole: Vec<bool>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Frame {
    middle: [f32; 2],
    /// Pixels across and down from one warp yarn to the next, along the weft.
    end: [f32; 2],
    /// The same from one weft yarn to the next.
    pick: [f32; 2],
}

impl<'a> Crossings<'a> {
    /// The crossings of two sets of yarns; nothing if there are too few, or their numbers make no
    /// sense.
    pub fn of(contrast: &'a Contrast, warp: &'a Yarns, weft: &'a Yarns) -> Option<Self> {
        let (nx, ny) = warp.size();
        let ((least_end, most_end), (least_pick, most_pick)) = (warp.range(), weft.range());
        let (first_end, first_pick) = (least_end.floor() as i64, least_pick.floor() as i64);
        let ends = (most_end.floor() as i64 - first_end + 1) as usize;
        let picks = (most_pick.floor() as i64 - first_pick + 1) as usize;
        // Numbers that ran wild would make a grid far larger than the photograph.
        if ends < 4 || picks < 4 || ends * picks > nx * ny {
            return None;
        }
        let start = straight(warp, weft)?;
        let mut frames = vec![Frame::default(); ends * picks];
        frames
            .par_chunks_mut(ends)
            .enumerate()
            .for_each(|(p, row)| {
                for (e, frame) in row.iter_mut().enumerate() {
                    let number = [
                        (first_end + e as i64) as f64 + 0.5,
                        (first_pick + p as i64) as f64 + 0.5,
                    ];
                    *frame = find(warp, weft, &start, number);
                }
            });
        let inside = |[x, y]: [f32; 2]| {
            (-0.5..=nx as f32 - 0.5).contains(&x) && (-0.5..=ny as f32 - 0.5).contains(&y)
        };
        let whole = frames
            .iter()
            .map(|frame| {
                [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)]
                    .into_iter()
                    .all(|(u, v)| inside(frame.place(u, v)))
            })
            .collect();
        Some(Crossings {
            contrast,
            warp,
            weft,
            first_end,
            first_pick,
            ends,
            picks,
            frames,
            whole,
        })
    }

    /// Crossings in all.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// The crossing that a pixel lies in.
    #[inline]
    pub fn at_pixel(&self, x: usize, y: usize) -> usize {
        let e = self.warp.number_at(x, y).floor() as i64 - self.first_end;
        let p = self.weft.number_at(x, y).floor() as i64 - self.first_pick;
        let e = e.clamp(0, self.ends as i64 - 1) as usize;
        let p = p.clamp(0, self.picks as i64 - 1) as usize;
        p * self.ends + e
    }

    /// The lightness of a crossing.
    pub fn light(&self, crossing: usize) -> Patch {
        self.patch(&self.contrast.light, crossing)
    }

    /// The tint of a crossing.
    pub fn tint(&self, crossing: usize) -> Patch {
        self.patch(&self.contrast.tint, crossing)
    }

    fn patch(&self, plane: &Plane, crossing: usize) -> Patch {
        let frame = self.frames[crossing];
        std::array::from_fn(|i| {
            let place = |i: usize| (i as f32 + 0.5) / SIDE as f32 - 0.5;
            let [x, y] = frame.place(place(i % SIDE), place(i / SIDE));
            plane.at(x, y)
        })
    }

    /// The features of every crossing, standardised over the whole ones; 0 at those that are not.
    ///
    /// What all crossings of a yarn have in common, its own brightness or colour, is taken out: it says
    /// nothing about the weave.
    pub fn features(&self) -> Vec<[f32; FEATURES]> {
        let mean = self.mean_patch();
        let mut features: Vec<[f32; FEATURES]> = (0..self.len())
            .into_par_iter()
            .map(|i| {
                if self.whole[i] {
                    measure(&self.light(i), &self.tint(i), &mean)
                } else {
                    [0.0; FEATURES]
                }
            })
            .collect();
        for _ in 0..3 {
            self.centre(&mut features, self.picks, self.ends, |line, i| {
                line * self.ends + i
            });
            self.centre(&mut features, self.ends, self.picks, |line, i| {
                i * self.ends + line
            });
        }
        let count = self.whole.iter().filter(|whole| **whole).count().max(1) as f64;
        let mut power = [0.0; FEATURES];
        for feature in &features {
            for (power, value) in power.iter_mut().zip(feature) {
                *power += f64::from(value * value);
            }
        }
        let weights = weights();
        let scale: [f32; FEATURES] =
            std::array::from_fn(|k| weights[k] / (libm::sqrt(power[k] / count) + 1e-9) as f32);
        features.par_iter_mut().for_each(|feature| {
            for (value, scale) in feature.iter_mut().zip(scale) {
                *value *= scale;
            }
        });
        features
    }

    /// Takes out the mean of every line of crossings.
    fn centre(
        &self,
        features: &mut [[f32; FEATURES]],
        lines: usize,
        length: usize,
        place: impl Fn(usize, usize) -> usize,
    ) {
        for line in 0..lines {
            let whole = || {
                (0..length)
                    .map(|i| place(line, i))
                    .filter(|i| self.whole[*i])
            };
            let count = whole().count().max(1) as f32;
            let mut mean = [0.0; FEATURES];
            for i in whole() {
                for (mean, value) in mean.iter_mut().zip(features[i]) {
                    *mean += value / count;
                }
            }
            for i in whole() {
                for (value, mean) in features[i].iter_mut().zip(mean) {
                    *value -= mean;
                }
            }
        }
    }

    fn mean_patch(&self) -> Patch {
        let mut sum = [0.0_f64; SAMPLES];
        let mut count = 0.0;
        for i in (0..self.len()).filter(|i| self.whole[*i]) {
            for (sum, value) in sum.iter_mut().zip(self.light(i)) {
                *sum += f64::from(value);
            }
            count += 1.0;
        }
        sum.map(|sum| (sum / f64::max(count, 1.0)) as f32)
    }
}

impl Frame {
    /// The pixel at `u` warp yarns and `v` weft yarns from the middle.
    fn place(&self, u: f32, v: f32) -> [f32; 2] {
        [0, 1].map(|k| self.middle[k] + u * self.end[k] + v * self.pick[k])
    }
}

/// Where straight yarns would lie: from numbers to pixels.
struct Straight {
    place: [f64; 2],
    number: [f64; 2],
    /// Pixels (across, down) for one warp yarn and for one weft yarn.
    step: [[f64; 2]; 2],
}

/// Pixels for one yarn of either direction, from how the two numbers grow.
fn inverted(warp: [f64; 2], weft: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let det = warp[0] * weft[1] - warp[1] * weft[0];
    (det.abs() > 1e-9).then(|| {
        [
            [weft[1] / det, -weft[0] / det],
            [-warp[1] / det, warp[0] / det],
        ]
    })
}

fn straight(warp: &Yarns, weft: &Yarns) -> Option<Straight> {
    let (nx, ny) = warp.size();
    let (x, y) = (nx as f32 / 2.0, ny as f32 / 2.0);
    Some(Straight {
        place: [f64::from(x), f64::from(y)],
        number: [warp.number(x, y), weft.number(x, y)],
        step: inverted(warp.wave.frequency, weft.wave.frequency)?,
    })
}

/// The frame of the crossing whose middle has these numbers.
fn find(warp: &Yarns, weft: &Yarns, straight: &Straight, number: [f64; 2]) -> Frame {
    let step = &straight.step;
    let move_by = |[x, y]: [f64; 2], [u, v]: [f64; 2]| {
        [
            x + u * step[0][0] + v * step[1][0],
            y + u * step[0][1] + v * step[1][1],
        ]
    };
    let off = |place: [f64; 2]| {
        let (x, y) = (place[0] as f32, place[1] as f32);
        [number[0] - warp.number(x, y), number[1] - weft.number(x, y)]
    };
    let first = [
        number[0] - straight.number[0],
        number[1] - straight.number[1],
    ];
    let mut place = move_by(straight.place, first);
    for _ in 0..5 {
        place = move_by(place, off(place));
    }
    let (x, y) = (place[0] as f32, place[1] as f32);
    let local = inverted(warp.slope(x, y), weft.slope(x, y)).unwrap_or(*step);
    // Yarns never lie much nearer or farther than they do on the whole; a slip of the phase would
    // say so.
    let sane = (0..2).all(|k| {
        let length = |v: [f64; 2]| libm::sqrt(v[0] * v[0] + v[1] * v[1]);
        (0.6..1.7).contains(&(length(local[k]) / length(step[k])))
    });
    let [end, pick] = if sane { local } else { *step };
    Frame {
        middle: [x, y],
        end: end.map(|v| v as f32),
        pick: pick.map(|v| v as f32),
    }
}

/// How much a patch changes across the warp, squared, and across the weft, at each inner sample.
pub fn changes(patch: &Patch) -> impl Iterator<Item = (usize, f32, f32)> + '_ {
    (0..SAMPLES).map(move |i| {
        let (x, y) = (i % SIDE, i / SIDE);
        let difference = |before: usize, after: usize, apart: usize| {
            (patch[after] - patch[before]) / apart as f32
        };
        let (left, right) = (x.saturating_sub(1), (x + 1).min(SIDE - 1));
        let (up, down) = (y.saturating_sub(1), (y + 1).min(SIDE - 1));
        (
            i,
            difference(y * SIDE + left, y * SIDE + right, right - left),
            difference(up * SIDE + x, down * SIDE + x, down - up),
        )
    })
}

fn measure(light: &Patch, tint: &Patch, mean: &Patch) -> [f32; FEATURES] {
    let rest: Patch = std::array::from_fn(|i| light[i] - mean[i]);
    let mut features = [0.0; FEATURES];
    let part = |i: usize, parts: usize| {
        let (x, y) = (i % SIDE * parts / SIDE, i / SIDE * parts / SIDE);
        y * parts + x
    };
    let (sixteenth, quarter) = (16.0 / SAMPLES as f32, 4.0 / SAMPLES as f32);
    let power: f32 = changes(&rest).map(|(_, x, y)| x * x + y * y).sum();
    let scale = 1.0 / ((power / SAMPLES as f32).sqrt() + 1e-6);
    for (i, x, y) in changes(&rest) {
        features[part(i, 4)] += light[i] * sixteenth;
        features[16 + part(i, 2)] += (x * x - y * y) * scale * quarter;
        features[20 + part(i, 2)] += 2.0 * x * y * scale * quarter;
        features[24 + part(i, 2)] += tint[i] * quarter;
    }
    // Opposite parts: their sums first, then their differences.
    for (first, count, _) in GROUPS {
        let group = &mut features[first..first + count];
        for i in 0..count / 2 {
            let (one, other) = (group[i], group[count - 1 - i]);
            group[i] = one + other;
            group[count - 1 - i] = one - other;
        }
    }
    features
}

/// How much each feature counts.
pub fn weights() -> [f32; FEATURES] {
    let mut weights = [1.0; FEATURES];
    for (first, count, weight) in GROUPS {
        weights[first..first + count].fill(weight);
        weights[first + count / 2..first + count].fill(weight * ODD);
    }
    weights
}
