//! Where the camera stands: from what a scenario says to a place in the studio.

use bevy::math::{DVec3, Vec3};
use bevy::prelude::Transform;

use crate::scenario::{CameraSpec, Standing, ViewSpec};

/// What is to be seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    /// Places of it, m.
    pub places: Vec<DVec3>,
    /// The middle of the box around it, m.
    pub centre: DVec3,
    /// Half the diagonal of that box, m.
    pub radius: f64,
}

/// A picture's opening: half its width and height at distance one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opening {
    /// Half its width.
    pub across: f64,
    /// Half its height.
    pub up: f64,
}

impl Opening {
    /// Of a picture so many pixels wide and high, with an angle (degrees) between its upper and lower
    /// edge.
    pub fn new(field_of_view: f64, (width, height): (u32, u32)) -> Self {
        let up = libm::tan(0.5 * field_of_view.to_radians());
        Opening {
            across: up * f64::from(width) / f64::from(height),
            up,
        }
    }
}

/// The share of a picture that is left free around a subject that just fits.
const MARGIN: f64 = 0.12;

/// Moments on its way at which a camera must see the whole subject.
const MOMENTS: usize = 12;

impl Subject {
    /// Places that are to be seen.
    pub fn new(places: Vec<DVec3>) -> Self {
        let least = places.iter().copied().reduce(DVec3::min);
        let most = places.iter().copied().reduce(DVec3::max);
        let (least, most) = (least.unwrap_or_default(), most.unwrap_or_default());
        Subject {
            places,
            centre: 0.5 * (least + most),
            radius: (0.5 * (most - least).length()).max(1e-3),
        }
    }

    /// How far away a camera that looks at `at` from the direction `out` just sees the whole of it, m.
    pub fn fitting_distance(&self, at: DVec3, out: DVec3, opening: Opening) -> f64 {
        let right = DVec3::Y.cross(out).normalize_or(DVec3::X);
        let up = out.cross(right);
        let free = 1.0 - MARGIN;
        let needed = self.places.iter().map(|place| {
            let from = *place - at;
            let (x, y) = (from.dot(right).abs(), from.dot(up).abs());
            from.dot(out) + (x / opening.across).max(y / opening.up) / free
        });
        needed.fold(0.1 * self.radius, f64::max)
    }
}

/// The way out to a camera.
fn direction(standing: Standing) -> DVec3 {
    let (turn, elevation) = (standing.turn.to_radians(), standing.elevation.to_radians());
    DVec3::new(
        libm::sin(turn) * libm::cos(elevation),
        libm::sin(elevation),
        libm::cos(turn) * libm::cos(elevation),
    )
}

/// The way of a camera around a subject.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    camera: CameraSpec,
    centre: DVec3,
    /// The distance that counts as one, m: the same all the way, so that the camera does not jerk.
    unit: f64,
}

impl Way {
    /// The way that a scenario's camera goes.
    pub fn new(view: &ViewSpec, subject: &Subject) -> Self {
        let opening = Opening::new(view.field_of_view, view.pixels);
        let unit = (0..=MOMENTS).map(|i| {
            let standing = view.camera.at(i as f64 / MOMENTS as f64);
            let at = looked_at(standing, subject.centre);
            subject.fitting_distance(at, direction(standing), opening)
        });
        Way {
            camera: view.camera,
            centre: subject.centre,
            unit: unit.fold(0.0, f64::max),
        }
    }

    /// Where the camera stands, and how it is turned, when a share (0 to 1) of the process is done.
    pub fn at(&self, share: f64) -> Transform {
        let standing = self.camera.at(share);
        let at = looked_at(standing, self.centre);
        let eye = at + standing.distance * self.unit * direction(standing);
        Transform::from_translation(eye.as_vec3()).looking_at(at.as_vec3(), Vec3::Y)
    }
}

fn looked_at(standing: Standing, centre: DVec3) -> DVec3 {
    standing
        .at_m
        .map_or(centre, |(x, y, z)| DVec3::new(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn subject() -> Subject {
        let place = |i: usize| {
            let corner = |bit: usize| (i >> bit & 1) as f64;
            DVec3::new(
                1.0 + corner(0),
                2.0 + 0.6 * corner(1),
                3.0 + 0.3 * corner(2),
            )
        };
        Subject::new((0..8).map(place).collect())
    }

    fn view(camera: CameraSpec, pixels: (u32, u32)) -> ViewSpec {
        ViewSpec {
            camera,
            pixels,
            ..ViewSpec::default()
        }
    }

    fn still(turn: f64, elevation: f64) -> CameraSpec {
        CameraSpec::Still {
            turn,
            elevation,
            distance: 1.0,
            at_m: None,
        }
    }

    /// How far out on the picture the outermost place is: 1 is its edge.
    fn outermost(camera: Transform, view: &ViewSpec) -> f32 {
        let opening = Opening::new(view.field_of_view, view.pixels);
        let out = subject().places.into_iter().map(|place| {
            let seen = camera
                .to_matrix()
                .inverse()
                .transform_point3(place.as_vec3());
            assert!(seen.z < 0.0, "behind the camera");
            let (x, y) = (seen.x / -seen.z, seen.y / -seen.z);
            (x.abs() / opening.across as f32).max(y.abs() / opening.up as f32)
        });
        out.fold(0.0, f32::max)
    }

    #[test]
    fn a_camera_at_distance_one_just_sees_the_whole_subject_from_everywhere() {
        for pixels in [(960, 720), (400, 900), (1920, 300)] {
            for (turn, elevation) in [(0.0, 0.0), (33.0, 60.0), (180.0, -20.0), (300.0, 85.0)] {
                let view = view(still(turn, elevation), pixels);
                let out = outermost(Way::new(&view, &subject()).at(0.5), &view);
                assert!((0.8..0.89).contains(&out), "{out} at {turn}, {elevation}");
            }
        }
    }

    #[test]
    fn a_camera_that_goes_around_keeps_its_distance_and_the_subject_in_sight() {
        let camera = CameraSpec::Orbit {
            from: -90.0,
            to: 200.0,
            elevation: 20.0,
            distance: 1.0,
            at_m: None,
        };
        let view = view(camera, (800, 600));
        let way = Way::new(&view, &subject());
        let distance = |share| {
            way.at(share)
                .translation
                .distance(subject().centre.as_vec3())
        };
        for share in [0.0, 0.21, 0.5, 0.83, 1.0] {
            assert!(outermost(way.at(share), &view) < 0.95);
            assert!((distance(share) - distance(0.0)).abs() < 1e-4);
        }
    }

    #[test]
    fn turns_go_from_the_front_to_the_right() {
        let at = |turn| {
            let view = view(still(turn, 0.0), (800, 600));
            Way::new(&view, &subject()).at(0.0).translation - subject().centre.as_vec3()
        };
        assert!(at(0.0).z > 1.0 && at(0.0).x.abs() < 1e-5);
        assert!(at(90.0).x > 1.0 && at(90.0).z.abs() < 1e-5);
    }

    #[test]
    fn a_dolly_goes_straight_from_its_first_distance_to_its_last() {
        let camera = CameraSpec::Dolly {
            from: 2.0,
            to: 1.0,
            turn: 20.0,
            elevation: 10.0,
            at_m: None,
        };
        let way = Way::new(&view(camera, (800, 600)), &subject());
        let distance = |share| {
            way.at(share)
                .translation
                .distance(subject().centre.as_vec3())
        };
        assert!((distance(0.0) / distance(1.0) - 2.0).abs() < 1e-4);
        assert!((distance(0.5) / distance(1.0) - 1.5).abs() < 1e-4);
    }
}
