//! How a cloth is computed, what it is made of, and what a step came to.

use bevy::math::DVec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::super::collide::filter::Filtered;
use super::super::collide::topology::Topology;
use super::super::crease::CreaseLink;
use super::super::lattice::Links;
use super::super::limit::LOCKED;
use super::super::pcg::Solved;
use super::super::rows::Rows;
use super::super::wind::AIR_DENSITY;

/// How time is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// Forward Euler.
    Euler,
    /// The classic Runge–Kutta method of fourth order.
    RungeKutta,
    /// Backward Euler.
    BackwardEuler,
    /// The backward difference of second order.
    Bdf2,
}

/// How the cloth is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// How time is stepped.
    pub integrator: Integrator,
    /// The longest step, s.
    pub step: f64,
    /// By how much conjugate gradients bring the residual down (of less than thrice the weight, of that).
    pub tolerance: f64,
    /// The most iterations of conjugate gradients in a step.
    pub iterations: usize,
    /// Acceleration of everything, m/s².
    pub gravity: DVec3,
    /// The density of the air, kg/m³; 0 for none.
    pub air: f64,
    /// The distance that the cloth keeps from everything, m.
    pub thickness: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Whether the cloth collides with itself.
    pub itself: bool,
    /// The strain at which yarns lock; implicit steps do not go beyond it.
    pub locks_at: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            integrator: Integrator::Bdf2,
            step: 1.0 / 180.0,
            tolerance: 1e-3,
            iterations: 40,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            air: AIR_DENSITY,
            thickness: 1e-3,
            friction: 0.3,
            itself: true,
            locks_at: LOCKED,
        }
    }
}

/// What a cloth is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its links.
    pub links: Links,
    /// Its creases.
    pub creases: Vec<CreaseLink>,
    /// Plane 0: mass, kg; plane 1 is filled with whether the particle is free.
    pub mass: Rows,
    /// How its particles make a surface.
    pub topology: Topology,
    /// How much cloth there is in every cell, m², a row of `particles.0 − 1` at a time.
    pub area: Vec<f64>,
}

impl Sheet {
    /// The mass of the whole, kg.
    pub(in crate::drape) fn weighs(&self) -> f64 {
        let (nx, ny) = self.links.particles;
        let row = |y: usize| (0..nx).map(|x| self.mass.get(x, y, 0)).sum::<f64>();
        (0..ny).map(row).sum()
    }
}

/// Why a cloth cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DrapeError {
    /// A number is no longer finite.
    #[error(
        "the cloth flew apart after {time:.4} s: steps of {step} s are too long for it. \
         Shorter steps help, or an implicit integrator (BackwardEuler, Bdf2), softer cloth, more damping"
    )]
    FlewApart {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
    },
}

/// What a step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// How the system was solved.
    pub solved: Solved,
    /// Pairs that were near each other.
    pub pairs: usize,
    /// What the filter had to do.
    pub filtered: Filtered,
}
