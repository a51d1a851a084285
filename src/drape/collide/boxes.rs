//! Boxes along the axes.

use bevy::math::DVec3;

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    /// The least coordinates.
    pub low: DVec3,
    /// The greatest coordinates.
    pub high: DVec3,
}

impl Box3 {
    /// A box that holds nothing, and to which anything may be added.
    pub const EMPTY: Box3 = Box3 {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    /// The box that also holds `point`.
    pub fn with(self, point: DVec3) -> Self {
        Box3 {
            low: self.low.min(point),
            high: self.high.max(point),
        }
    }

    /// The box that holds both.
    pub fn join(self, other: Box3) -> Self {
        Box3 {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The box, larger by `by` on every side.
    pub fn grown(self, by: f64) -> Self {
        Box3 {
            low: self.low - DVec3::splat(by),
            high: self.high + DVec3::splat(by),
        }
    }

    /// Whether the two share a point.
    pub fn meets(&self, other: &Box3) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
            && self.low.z <= other.high.z
            && other.low.z <= self.high.z
    }

    /// The middle.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }
}
