//! When two moving things first touch: additive continuous collision detection (Li, Kaufman, Jiang,
//! *Codimensional Incremental Potential Contact*, 2021, section 4.3).
//!
//! Nothing is solved for: time is advanced by steps so short that the distance, which shrinks no faster
//! than the fastest corners approach, cannot reach zero. So nothing can be missed, and rounding errors
//! of the distance matter only where it is a billion times smaller than the cloth.

use bevy::math::DVec3;

use super::distance::{Pair, combine};

/// The share of the distance at the beginning that always stays.
const KEPT: f64 = 0.1;

/// Steps after which the time reached is taken for that of touching.
const MOST_STEPS: usize = 100;

/// The time, 0 to 1, up to which the corners `x` may move along `moves` and stay apart; `None` if they
/// never come close. At that time at least a tenth of the distance is left.
pub fn time_of_impact(pair: Pair, mut x: [DVec3; 4], moves: [DVec3; 4]) -> Option<f64> {
    let mean = 0.25 * ((moves[0] + moves[1]) + (moves[2] + moves[3]));
    let moves = [0, 1, 2, 3].map(|i| moves[i] - mean);
    let length = moves.map(DVec3::length);
    let speed = match pair {
        Pair::PointTriangle(_) => length[0] + length[1].max(length[2]).max(length[3]),
        Pair::EdgeEdge(_) => length[0].max(length[1]) + length[2].max(length[3]),
    };
    let mut distance = combine(pair.weights(x), x).length();
    if speed < distance * (1.0 - KEPT) {
        return None;
    }
    let kept = KEPT * distance;
    let mut time = 0.0;
    for _ in 0..MOST_STEPS {
        // Nine tenths of what surely leaves `kept` over.
        let step = 0.9 * (distance - kept) / speed;
        if time > 0.0 && (distance - kept) < 0.01 * kept {
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
