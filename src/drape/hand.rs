//! A hand that draws a particle of the cloth to a place, and the ray that finds which.
//!
//! A held particle is drawn by a spring that brings it to the target in a few hundredths of a second
//! whatever its mass, but with no more than [`STRONGEST`]: cloth caught behind something is not torn through
//! it, and yarns do not lengthen.

use bevy::math::{DVec2, DVec3};

use super::drape::Drape;

/// The frequency of the spring, rad/s.
pub const QUICKNESS: f64 = 60.0;

/// The mass that is drawn, as a multiple of the particle's: what hangs from it comes along.
pub const COMES_ALONG: f64 = 30.0;

/// The largest acceleration that a hand gives to what it draws, m/s².
pub const STRONGEST: f64 = 200.0;

/// A hand that holds a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hand {
    /// The particle, by number.
    pub particle: usize,
    /// Where it is drawn, m.
    pub target: DVec3,
}

impl Hand {
    /// The force on the particle, N, and how stiff and how damped it is, N/m and N·s/m.
    pub fn pull(&self, x: DVec3, v: DVec3, mass: f64) -> (DVec3, f64, f64) {
        let drawn = COMES_ALONG * mass;
        let stiffness = drawn * QUICKNESS * QUICKNESS;
        let damping = 2.0 * drawn * QUICKNESS;
        let off = self.target - x;
        let most = STRONGEST * drawn;
        let share = (most / (stiffness * off.length()).max(1e-300)).min(1.0);
        (
            share * stiffness * off - damping * v,
            share * stiffness,
            damping,
        )
    }
}

/// Where a ray meets the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The triangle, by its number in the [surface](super::surface::Surface).
    pub triangle: usize,
    /// The corner of it that is nearest: a particle, by number.
    pub particle: usize,
    /// Where on the cloth: shares of its width and height.
    pub uv: DVec2,
    /// Where in space, m.
    pub point: DVec3,
    /// How far along the ray, in lengths of its direction.
    pub distance: f64,
}

/// Where a ray first meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstHit {
    /// The triangle, by number.
    pub triangle: usize,
    /// The shares of its corners in the place.
    pub shares: [f64; 3],
    /// How far along the ray, in lengths of its direction.
    pub distance: f64,
    /// Whether the ray comes from the back: the side from which the corners run clockwise.
    pub from_back: bool,
}

/// The first meeting of a ray with triangles, from either side (Möller and Trumbore, *Fast, Minimum Storage
/// Ray/Triangle Intersection*, 1997).
pub fn first_hit(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    origin: DVec3,
    direction: DVec3,
) -> Option<FirstHit> {
    let mut first: Option<FirstHit> = None;
    for (triangle, t) in triangles.iter().enumerate() {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let (ab, ac) = (b - a, c - a);
        let p = direction.cross(ac);
        let determinant = ab.dot(p);
        if determinant == 0.0 {
            continue;
        }
        let from = origin - a;
        let of_b = from.dot(p) / determinant;
        let q = from.cross(ab);
        let of_c = direction.dot(q) / determinant;
        let distance = ac.dot(q) / determinant;
        let is_inside = of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0;
        if !is_inside || distance < 0.0 || first.is_some_and(|hit| hit.distance <= distance) {
            continue;
        }
        first = Some(FirstHit {
            triangle,
            shares: [1.0 - of_b - of_c, of_b, of_c],
            distance,
            from_back: determinant < 0.0,
        });
    }
    first
}

/// The first meeting of a ray with a cloth, from either side.
pub fn hit(drape: &Drape, origin: DVec3, direction: DVec3) -> Option<Hit> {
    let x = drape.positions();
    let (nx, ny) = drape.sheet().links.particles;
    let uv = |i: u32| {
        let (column, row) = (i as usize % nx, i as usize / nx);
        DVec2::new(
            column as f64 / (nx - 1) as f64,
            row as f64 / (ny - 1) as f64,
        )
    };
    let first = first_hit(x, drape.triangles(), origin, direction)?;
    let (t, shares) = (drape.triangles()[first.triangle], first.shares);
    let nearest = (0..3).fold(0, |best, i| if shares[i] > shares[best] { i } else { best });
    Some(Hit {
        triangle: first.triangle,
        particle: t[nearest] as usize,
        uv: shares[0] * uv(t[0]) + shares[1] * uv(t[1]) + shares[2] * uv(t[2]),
        point: origin + first.distance * direction,
        distance: first.distance,
    })
}
