//! Where the camera stands: from what a scenario says to a place in the studio.

use bevy::math::{DVec3, Vec3};
use bevy::prelude::Transform;

use crate::scenario::Standing;

/// The ball around everything that is to be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subject {
    /// Its middle, m.
    pub centre: DVec3,
    /// Its radius, m.
    pub radius: f64,
}

impl Subject {
    /// The ball around the box around places.
    pub fn around(places: &[DVec3]) -> Self {
        let least = places.iter().copied().reduce(DVec3::min);
        let most = places.iter().copied().reduce(DVec3::max);
        let (least, most) = (least.unwrap_or_default(), most.unwrap_or_default());
        Subject {
            centre: 0.5 * (least + most),
            radius: (0.5 * (most - least).length()).max(1e-3),
        }
    }

    /// How far away a camera sees the whole of it, m. `field_of_view` is the angle across the narrower
    /// side of the picture, radians.
    pub fn fitting_distance(&self, field_of_view: f64) -> f64 {
        self.radius / libm::sin(0.5 * field_of_view)
    }
}

/// The angle across the narrower side of a picture, from the one between its upper and lower edge;
/// radians. `aspect` is its width by its height.
pub fn narrower(field_of_view: f64, aspect: f64) -> f64 {
    2.0 * libm::atan(libm::tan(0.5 * field_of_view) * aspect.min(1.0))
}

/// Where the camera stands, and how it is turned. `field_of_view` as for
/// [`fitting_distance`](Subject::fitting_distance).
pub fn stand(standing: Standing, subject: Subject, field_of_view: f64) -> Transform {
    let at = standing
        .at_m
        .map_or(subject.centre, |(x, y, z)| DVec3::new(x, y, z));
    let (turn, elevation) = (standing.turn.to_radians(), standing.elevation.to_radians());
    let out = DVec3::new(
        libm::sin(turn) * libm::cos(elevation),
        libm::sin(elevation),
        libm::cos(turn) * libm::cos(elevation),
    );
    let distance = standing.distance * subject.fitting_distance(field_of_view);
    let eye = at + distance * out;
    Transform::from_translation(eye.as_vec3()).looking_at(at.as_vec3(), Vec3::Y)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const SUBJECT: Subject = Subject {
        centre: DVec3::new(1.0, 2.0, 3.0),
        radius: 0.5,
    };

    fn standing(turn: f64, elevation: f64) -> Standing {
        Standing {
            turn,
            elevation,
            distance: 1.0,
            at_m: None,
        }
    }

    #[test]
    fn a_camera_at_distance_one_just_sees_the_whole_subject() {
        let angle = narrower(PI / 6.0, 1.5);
        let eye = stand(standing(70.0, 20.0), SUBJECT, angle);
        let distance = f64::from(eye.translation.distance(SUBJECT.centre.as_vec3()));
        let seen = 2.0 * libm::asin(SUBJECT.radius / distance);
        assert!((seen - angle).abs() < 1e-5, "{seen} and {angle}");
    }

    #[test]
    fn turns_go_from_the_front_to_the_right() {
        let front = stand(standing(0.0, 0.0), SUBJECT, 0.5).translation;
        let right = stand(standing(90.0, 0.0), SUBJECT, 0.5).translation;
        assert!(front.z > 4.0 && (front.x - 1.0).abs() < 1e-5);
        assert!(right.x > 2.0 && (right.z - 3.0).abs() < 1e-5);
    }

    #[test]
    fn the_camera_looks_at_the_subject_from_everywhere() {
        for (turn, elevation) in [(0.0, 0.0), (33.0, 60.0), (180.0, -20.0), (300.0, 88.0)] {
            let camera = stand(standing(turn, elevation), SUBJECT, 0.5);
            let to = (SUBJECT.centre.as_vec3() - camera.translation).normalize();
            assert!(camera.forward().dot(to) > 0.999_99);
        }
    }

    #[test]
    fn a_tall_picture_needs_more_distance_than_a_wide_one() {
        let distance = |aspect| SUBJECT.fitting_distance(narrower(PI / 6.0, aspect));
        assert!(distance(0.5) > 1.5 * distance(1.0));
        assert_eq!(distance(2.0), distance(1.0));
    }
}
