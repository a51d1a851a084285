//! What each crossing says for itself, beside what its class says: where a weave is not regular, or a
//! yarn has jumped another, it has the last word.

use super::classes::Classes;
use super::crossings::{Crossings, FEATURES};
use super::sides::Sides;

/// Evidence of a class is cut off here.
const MOST_OF_CLASS: f32 = 8.0;
/// Evidence of a single crossing is cut off here.
const MOST_OF_ONE: f32 = 6.0;
/// How much the evidence of a single crossing counts: features are not quite what is assumed of them.
const SINGLE: f32 = 0.7;

/// For every crossing, evidence that the warp is on top: the logarithm of its odds.
pub fn evidence(
    crossings: &Crossings,
    features: &[[f32; FEATURES]],
    classes: &Classes,
    sides: &Sides,
) -> Vec<f32> {
    let of = |i: usize| usize::from(sides.warp_up[classes.of[i]]);
    let whole = || (0..crossings.len()).filter(|i| crossings.whole[*i]);
    let (mut sums, mut counts) = ([[0.0_f64; FEATURES]; 2], [0.0_f64; 2]);
    for i in whole() {
        counts[of(i)] += 1.0;
        for (sum, value) in sums[of(i)].iter_mut().zip(features[i]) {
            *sum += f64::from(value);
        }
    }
    let mean = |side: usize, k: usize| sums[side][k] / counts[side].max(1.0);
    let mut spread = [1e-9_f64; FEATURES];
    for i in whole() {
        for (k, spread) in spread.iter_mut().enumerate() {
            let apart = f64::from(features[i][k]) - mean(of(i), k);
            *spread += apart * apart / (counts[0] + counts[1]);
        }
    }
    // The direction in which warp and weft differ, each feature by how much it varies.
    let direction: [f64; FEATURES] = std::array::from_fn(|k| (mean(1, k) - mean(0, k)) / spread[k]);
    let along = |values: &dyn Fn(usize) -> f64| -> f64 {
        (0..FEATURES).map(|k| direction[k] * values(k)).sum()
    };
    let means = [0, 1].map(|side| along(&|k| mean(side, k)));
    let place = |i: usize| along(&|k| f64::from(features[i][k]));
    let variance: f64 = whole()
        .map(|i| {
            let apart = place(i) - means[of(i)];
            apart * apart / (counts[0] + counts[1])
        })
        .sum();
    let by_class = classes.evidence(&sides.warp_up);
    (0..crossings.len())
        .map(|i| {
            let class = by_class[i].clamp(-MOST_OF_CLASS, MOST_OF_CLASS);
            if !crossings.whole[i] {
                return class;
            }
            let single = (place(i) - 0.5 * (means[0] + means[1])) * (means[1] - means[0])
                / (variance + 1e-9);
            class + SINGLE * (single as f32).clamp(-MOST_OF_ONE, MOST_OF_ONE)
        })
        .collect()
}
