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
    /// How much better a class fits than the next, in standard errors.
    pub certainty: Vec<f32>,
}

impl Classes {
    /// Finds the class of every crossing.
    pub fn find(crossings: &Crossings, features: &[[f32; FEATURES]], lattice: Lattice) -> Self {
        let ends = crossings.ends;
        let plain: Vec<usize> = (0..crossings.len())
            .map(|i| lattice.class(i % ends, i / ends))
            .collect();
        let moves: Vec<Vec<usize>> = (0..lattice.c)
            .flat_map(|dp| (0..lattice.a).map(move |de| (de, dp)))
            .map(|(de, dp)| lattice.moved(de, dp))
            .collect();
        let whole = Plane {
            nx: ends,
            ny: crossings.picks,
            values: crossings
                .whole
                .iter()
                .map(|w| f32::from(u8::from(*w)))
                .collect(),
        };
        let seen = whole.blurred(WINDOW);
        let mut means = seed(crossings, features, &plain, lattice.classes());
        let mut of = plain.clone();
        let mut certainty = vec![0.0; of.len()];
        for _ in 0..ROUNDS {
            let fits: Vec<Plane> = moves
                .par_iter()
                .map(|moved| {
                    Plane::new(ends, crossings.picks, |e, p| {
                        let i = p * ends + e;
                        dot(&features[i], &means[moved[plain[i]]])
                    })
                    .blurred(WINDOW)
                })
                .collect();
            for i in 0..of.len() {
                let (mut best, mut next) = (0, None);
                for k in 1..moves.len() {
                    if fits[k].values[i] > fits[best].values[i] {
                        next = Some(best);
                        best = k;
                    } else if next
                        .is_none_or(|next: usize| fits[k].values[i] > fits[next].values[i])
                    {
                        next = Some(k);
                    }
                }
                of[i] = moves[best][plain[i]];
                certainty[i] = next.map_or(0.0, |next| {
                    let apart = fits[best].values[i] - fits[next].values[i];
                    apart / error(&means, &moves[best], &moves[next]) / seen.values[i].max(0.1)
                });
            }
            means = class_means(crossings, features, &of, lattice.classes());
        }
        Classes {
            lattice,
            of,
            certainty,
        }
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
