//! When two moving things first touch: additive continuous collision detection (Li, Kaufman, Jiang,
//! *Codimensional Incremental Potential Contact*, 2021, section 4.3).
//!
//! Nothing is solved for: time is advanced by steps so short that the distance, which shrinks no faster
//! than the fastest corners approach, cannot reach zero. So nothing can be missed, and rounding errors
//! of the distance matter only where it is a billion times smaller than the cloth.

use bevy::math::DVec3;

use super::distance::{Pair, combine};

/// The share of the distance at the beginning that stays.
const KEPT: f64 = 0.1;

/// Distances smaller than this shrink by no more than a tenth, m: pressed together step after step, things
/// would else come as close as rounding errors soon.
const CLOSE: f64 = 1e-5;

/// How much of a distance stays.
fn kept(distance: f64) -> f64 {
    (KEPT * distance).max(CLOSE).min(0.9 * distance)
}

/// Steps after which the time reached is taken for that of touching.
const MOST_STEPS: usize = 100;

/// The time, 0 to 1, up to which the corners `x` may move along `moves` and stay apart; `None` if they
/// never come close. At that time a tenth of the distance is left, and of a very small one most.
pub fn time_of_impact(pair: Pair, mut x: [DVec3; 4], moves: [DVec3; 4]) -> Option<f64> {
    let mean = 0.25 * ((moves[0] + moves[1]) + (moves[2] + moves[3]));
    let moves = [0, 1, 2, 3].map(|i| moves[i] - mean);
    let length = moves.map(DVec3::length);
    let speed = match pair {
        Pair::PointTriangle(_) => length[0] + length[1].max(length[2]).max(length[3]),
        Pair::EdgeEdge(_) => length[0].max(length[1]) + length[2].max(length[3]),
    };
    let mut distance = combine(pair.weights(x), x).length();
    let kept = kept(distance);
    if speed < distance - kept {
        return None;
    }
    let mut time = 0.0;
    for _ in 0..MOST_STEPS {
        // Nine tenths of what surely leaves `kept` over.
        let step = 0.9 * (distance - kept) / speed;
        if time > 0.0 && (distance - kept) < 1e-3 * kept {
            return Some(time);
        }
        if time + step >= 1.0 {
            return None;
        }
        time += step;
        for i in 0..4 {
            x[i] += step * moves[i];
        }
        distance = combine(pair.weights(x), x).length();
        if distance <= kept {
            return Some(time - step);
        }
    }
    Some(time)
}

/// The time, 0 to 1, up to which a triangle may move and stay off a ball that does not; `None` if it never
/// comes close.
pub fn time_to_ball(
    (centre, radius): (DVec3, f64),
    mut x: [DVec3; 3],
    moves: [DVec3; 3],
) -> Option<f64> {
    let speed = moves.into_iter().map(DVec3::length).fold(0.0, f64::max);
    let gap = |x: [DVec3; 3]| {
        let corners = [centre, x[0], x[1], x[2]];
        combine(Pair::PointTriangle([0; 4]).weights(corners), corners).length() - radius
    };
    let mut distance = gap(x);
    let kept = kept(distance);
    if speed < distance - kept {
        return None;
    }
    let mut time = 0.0;
    for _ in 0..MOST_STEPS {
        let step = 0.9 * (distance - kept).max(0.0) / speed;
        if time + step >= 1.0 {
            return None;
        }
        if distance - kept < 1e-3 * kept || step <= 0.0 {
            return Some(time);
        }
        time += step;
        for i in 0..3 {
            x[i] += step * moves[i];
        }
        distance = gap(x);
    }
    Some(time)
}
