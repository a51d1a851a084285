//! What holds the cloth: particles that are fixed, or led along a path, for some of the time.

use bevy::math::DVec3;

/// Particles held together.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// The particles, by number.
    pub particles: Vec<usize>,
    /// From when to when they are held, s.
    pub from: f64,
    /// Until when, s.
    pub until: f64,
    /// Where they are led, from where they are when they are first held: moments (s, from `from` on) and
    /// moves (m), in order of time. Between them they go straight, smoothly from stop to stop; after the
    /// last they stay.
    pub path: Vec<(f64, DVec3)>,
}

impl Pin {
    /// Whether it holds at a moment.
    pub fn holds(&self, time: f64) -> bool {
        (self.from..self.until).contains(&time)
    }

    /// The move from where it began, at a moment.
    pub fn moved(&self, time: f64) -> DVec3 {
        let since = time - self.from;
        let (mut before, mut at) = (0.0, DVec3::ZERO);
        for (moment, to) in &self.path {
            if since < *moment {
                let share = ((since - before) / (moment - before)).clamp(0.0, 1.0);
                let smooth = share * share * (3.0 - 2.0 * share);
                return at.lerp(*to, smooth);
            }
            (before, at) = (*moment, *to);
        }
        at
    }
}
