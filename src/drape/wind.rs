//! Air that moves: a breeze with gusts, and the drag that it (or still air) has on the cloth.
//!
//! A particle stands for a piece of cloth with the area vector N (m², along the normal n). Air that moves
//! past at w = wind − v presses on it with ½·ρ·C_n·|w·n|·(w·N), and rubs along it with
//! ½·ρ·C_t·|w|·|N|·w. The gusts are a few travelling waves of the speed, with lengths and phases drawn from
//! the seed; nothing depends on when or how often it is asked.

use bevy::math::DVec3;

use super::contact::block;
use super::response::BLOCK;
use crate::chance::{Chance, Purpose};

/// Of air at 20 °C, kg/m³.
pub const AIR_DENSITY: f64 = 1.204;

/// C_n: drag of a flat plate across the wind (Hoerner, *Fluid-Dynamic Drag*, 1965, has 1.17).
const ACROSS: f64 = 1.17;

/// C_t: rubbing along a rough plate.
const ALONG: f64 = 0.02;

/// Waves that make up the gusts.
const WAVES: usize = 6;

/// The wind at every place and moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Wind {
    mean: DVec3,
    /// Of each wave: how strong it is, rad/m, rad/s, rad.
    waves: Vec<(f64, DVec3, f64, f64)>,
}

impl Wind {
    /// Still air.
    pub fn still() -> Self {
        Wind {
            mean: DVec3::ZERO,
            waves: Vec::new(),
        }
    }

    /// A wind of mean velocity `mean` (m/s) whose speed varies by `gusts` (a share of it, root mean square).
    pub fn new(mean: DVec3, gusts: f64, seed: u64) -> Self {
        let mut draw = Chance(seed).sequence(Purpose::Wind);
        let speed = mean.length();
        let along = mean.normalize_or_zero();
        let strength = gusts * (2.0 / WAVES as f64).sqrt();
        let waves = (0..WAVES).map(|i| {
            // From half a metre to ten metres, each longer by the same factor.
            let length = 0.5 * libm::pow(20.0, (i as f64 + draw.unit()) / WAVES as f64);
            let turn = draw.between((-0.6, 0.6));
            let side = along.any_orthonormal_vector();
            let way = along * libm::cos(turn) + side * libm::sin(turn);
            let number = std::f64::consts::TAU / length;
            let phase = std::f64::consts::TAU * draw.unit();
            (strength, way * number, number * speed, phase)
        });
        Wind {
            mean,
            waves: if speed > 0.0 {
                waves.collect()
            } else {
                Vec::new()
            },
        }
    }

    /// The velocity of the air, m/s.
    pub fn at(&self, place: DVec3, time: f64) -> DVec3 {
        let gust: f64 = self
            .waves
            .iter()
            .map(|(strength, number, speed, phase)| {
                strength * libm::sin(number.dot(place) - speed * time + phase)
            })
            .sum();
        self.mean * (1.0 + gust).max(0.0)
    }
}

/// The force (N) of air that moves past a piece of cloth of area vector `area`, and what the force loses by
/// a m/s of its own, as a matrix (N·s/m).
pub fn drag(past: DVec3, area: DVec3, density: f64) -> (DVec3, [f64; BLOCK]) {
    let size = area.length();
    let normal = area.normalize_or_zero();
    let through = past.dot(normal);
    let across = 0.5 * density * ACROSS * through.abs() * size;
    let along = 0.5 * density * ALONG * past.length() * size;
    let force = across * through * normal + along * past;
    (force, block(normal, across + along, along))
}
