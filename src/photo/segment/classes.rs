//! The class of every crossing, where the repeat may slip: a yarn that was lost on the way moves the
//! repeat on what lies behind it. Around every crossing the step that fits best is taken.

use rayon::prelude::*;

use super::crossings::{Crossings, FEATURES};
use super::repeat::Lattice;
use crate::photo::plane::Plane;

/// Crossings over which a step must fit: the standard deviation of the window.
const WINDOW: f32 = 2.5;
/// Times that classes and steps are found from each other.
const ROUNDS: usize = 5;
/// Crossings along a side of the block that the first means are taken from.
const SEED: usize = 12;

/// The classes of all crossings.
pub struct Classes {
    /// The lattice on which crossings look alike.
    pub lattice: Lattice,
    /// The class of every crossing.
    pub of: Vec<usize>,
    /// Every step of the repeat: for each class by place, the class it would be.
    moves: Vec<Vec<usize>>,
    /// The class of every crossing if nothing slips.
    by_place: Vec<usize>,
    /// How well each step fits around each crossing.
    fits: Vec<Plane>,
    /// How much of the photograph is around each crossing, 0 to 1.
    seen: Plane,
    means: Vec<[f32; FEATURES]>,
}

impl Classes {
    /// Finds the class of every crossing.
    pub fn find(crossings: &Crossings, features: &[[f32; FEATURES]], lattice: Lattice) -> Self {
        let (ends, picks) = (crossings.ends, crossings.picks);
        let by_place: Vec<usize> = (0..crossings.len())
            .map(|i| lattice.class(i % ends, i / ends))
            .collect();
        let moves: Vec<Vec<usize>> = (0..lattice.c)
            .flat_map(|dp| (0..lattice.a).map(move |de| (de, dp)))
            .map(|(de, dp)| lattice.moved(de, dp))
            .collect();
        let whole = |e: usize, p: usize| f32::from(u8::from(crossings.whole[p * ends + e]));
        let mut means = seed(crossings, features, &by_place, lattice.classes());
        let mut of = by_place.clone();
        let mut fits = Vec::new();
        for _ in 0..ROUNDS {
            fits = moves
                .par_iter()
                .map(|moved| {
                    Plane::new(ends, picks, |e, p| {
                        let i = p * ends + e;
                        dot(&features[i], &means[moved[by_place[i]]])
                    })
                    .blurred(WINDOW)
                })
                .collect::<Vec<Plane>>();
            for (i, class) in of.iter_mut().enumerate() {
                let fit = |k: &usize| fits[*k].values[i];
                let best = (0..moves.len())
                    .max_by(|a, b| fit(a).total_cmp(&fit(b)).then(b.cmp(a)))
                    .unwrap_or(0);
                *class = moves[best][by_place[i]];
            }
            means = class_means(crossings, features, &of, lattice.classes());
        }
        Classes {
            lattice,
            of,
            moves,
            by_place,
            fits,
            seen: Plane::new(ends, picks, whole).blurred(WINDOW),
            means,
        }
    }

    /// Evidence for every crossing that its class is one of those with the warp on top: how much better
    /// some step of the repeat fits that says so than any that says otherwise, in standard errors.
    pub fn evidence(&self, warp_up: &[bool]) -> Vec<f32> {
        let best = |i: usize, up: bool| {
            let says = |k: &usize| warp_up[self.moves[*k][self.by_place[i]]] == up;
            let fit = |k: &usize| self.fits[*k].values[i];
            (0..self.moves.len())
                .filter(says)
                .max_by(|a, b| fit(a).total_cmp(&fit(b)).then(b.cmp(a)))
        };
        (0..self.of.len())
            .into_par_iter()
            .map(|i| match (best(i, true), best(i, false)) {
                (Some(up), Some(down)) => {
                    let apart = self.fits[up].values[i] - self.fits[down].values[i];
                    let error = error(&self.means, &self.moves[up], &self.moves[down]);
                    apart / error / self.seen.values[i].max(0.1)
                }
                _ => 0.0,
            })
            .collect()
    }
}

fn dot(a: &[f32; FEATURES], b: &[f32; FEATURES]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The standard error of the difference of two fits: features have variance 1, and a window counts as
/// so many crossings; neighbouring features are alike, so it is taken twice.
fn error(means: &[[f32; FEATURES]], one: &[usize], other: &[usize]) -> f32 {
    let apart: f32 = one
        .iter()
        .zip(other)
        .map(|(a, b)| {
            let square = |k: usize| {
                let d = means[*a][k] - means[*b][k];
                d * d
            };
            (0..FEATURES).map(square).sum::<f32>()
        })
        .sum::<f32>()
        / one.len() as f32;
    let crossings = 4.0 * std::f32::consts::PI * WINDOW * WINDOW;
    2.0 * (apart / crossings).sqrt() + 1e-6
}

/// Means of the block in which classes differ most.
fn seed(
    crossings: &Crossings,
    features: &[[f32; FEATURES]],
    class: &[usize],
    classes: usize,
) -> Vec<[f32; FEATURES]> {
    let (ends, picks) = (crossings.ends, crossings.picks);
    let side = SEED.min(ends / 2).min(picks / 2).max(2);
    let mut best: Option<(f32, Vec<[f32; FEATURES]>)> = None;
    for p0 in (0..=picks - side).step_by(side) {
        for e0 in (0..=ends - side).step_by(side) {
            let block = || {
                (0..side * side)
                    .map(move |k| (p0 + k / side) * ends + e0 + k % side)
                    .filter(|i| crossings.whole[*i])
            };
            let Some(means) = means_of(block(), features, class, classes, 2) else {
                continue;
            };
            let power = means.iter().map(|mean| dot(mean, mean)).sum();
            if best.as_ref().is_none_or(|(most, _)| power > *most) {
                best = Some((power, means));
            }
        }
    }
    best.map_or_else(
        || class_means(crossings, features, class, classes),
        |(_, means)| means,
    )
}

fn class_means(
    crossings: &Crossings,
    features: &[[f32; FEATURES]],
    class: &[usize],
    classes: usize,
) -> Vec<[f32; FEATURES]> {
    let whole = (0..crossings.len()).filter(|i| crossings.whole[*i]);
    means_of(whole, features, class, classes, 0).unwrap_or_default()
}

/// The mean features of each class, less that of all; nothing if a class has fewer than `least`.
fn means_of(
    crossings: impl Iterator<Item = usize>,
    features: &[[f32; FEATURES]],
    class: &[usize],
    classes: usize,
    least: usize,
) -> Option<Vec<[f32; FEATURES]>> {
    let mut sums = vec![[0.0_f64; FEATURES]; classes];
    let mut counts = vec![0_usize; classes];
    for i in crossings {
        counts[class[i]] += 1;
        for (sum, value) in sums[class[i]].iter_mut().zip(features[i]) {
            *sum += f64::from(value);
        }
    }
    if counts.iter().any(|count| *count < least) {
        return None;
    }
    let mut middle = [0.0; FEATURES];
    for (sum, count) in sums.iter_mut().zip(counts) {
        for (sum, middle) in sum.iter_mut().zip(&mut middle) {
            *sum /= count.max(1) as f64;
            *middle += *sum / classes as f64;
        }
    }
    let centred = |sum: [f64; FEATURES]| std::array::from_fn(|k| (sum[k] - middle[k]) as f32);
    Some(sums.into_iter().map(centred).collect())
}
