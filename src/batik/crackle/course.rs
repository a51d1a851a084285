//! How a crack finds its way.

use super::Point;
use super::field::{dot, unit};
use crate::chance::Sequence;

/// Cells from one point of a crack to the next.
pub(super) const STEP: f32 = 1.0;
/// The most that a crack turns for what is around it, radians.
const MOST_TURN: f32 = 1.3;

/// The tip of a crack on its way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub at: Point,
    /// Unit vector.
    pub heading: Point,
    /// Radians a cell, straying.
    bend: f32,
    /// Radians that it may still turn for what is around it.
    turns_left: f32,
}

impl Course {
    pub fn new(at: Point, heading: Point) -> Self {
        Course {
            at,
            heading,
            bend: 0.0,
            turns_left: MOST_TURN,
        }
    }

    /// Turns towards where the distance is greatest while it grows, and across to what is near when
    /// it falls: the nearer, the more, so that it is met at a right angle. `uphill` is where the
    /// distance grows fastest.
    pub fn steer(&mut self, uphill: Point, distance: f32) {
        let rising = dot(self.heading, uphill);
        let (towards, turn) = if rising >= 0.0 {
            (uphill, 0.2 / (distance + 6.0))
        } else {
            ([-uphill[0], -uphill[1]], 0.9 / (distance + 2.0))
        };
        let aside = [-self.heading[1], self.heading[0]];
        let angle = dot(aside, towards) * turn * STEP;
        let angle = angle.clamp(-self.turns_left, self.turns_left);
        self.turns_left -= angle.abs();
        self.heading = turned(self.heading, angle.clamp(-0.15, 0.15));
    }

    /// Chance on the way: slow bends, and now and then a kink.
    pub fn stray(&mut self, jitter: f32, chance: &mut Sequence) {
        if jitter <= 0.0 {
            return;
        }
        self.bend = 0.9 * self.bend + 0.012 * jitter * about_normal(chance);
        let mut turn = self.bend * STEP;
        if between(chance, 0.0, 1.0) < 0.06 * STEP {
            turn += 0.6 * jitter * about_normal(chance);
        }
        self.heading = turned(self.heading, turn);
    }
}

/// A unit vector turned by a small angle, radians.
pub(super) fn turned(a: Point, angle: f32) -> Point {
    // tan instead of sin and cos: the same to first order, and the length is mended.
    unit([a[0] - a[1] * angle, a[1] + a[0] * angle])
}

/// A number of U(least, most).
pub(super) fn between(chance: &mut Sequence, least: f64, most: f64) -> f32 {
    chance.between((least, most)) as f32
}

/// A number of about the standard normal distribution.
pub(super) fn about_normal(chance: &mut Sequence) -> f32 {
    // Three of U(−1, 1) have variance 1.
    (0..3).map(|_| between(chance, -1.0, 1.0)).sum()
}
