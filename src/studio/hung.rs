//! The cloth of an experiment as it hangs or lies, from the moment it has settled.

use bevy::math::DVec3;
use thiserror::Error;

use super::camera::Subject;
use super::fine::Fine;
use crate::drape::drape::{Drape, DrapeError};
use crate::drape::spec::{DrapeSpec, Start};
use crate::scenario::check::{Checker, Problem};
use crate::scenario::{Draping, Scenario, ViewSpec};

/// The bundled drape of a scenario that names none.
pub const DEFAULT_DRAPE: &str = "hanging";

/// Why a cloth cannot be draped.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HungError {
    /// The drape asks for something that cannot be.
    #[error(transparent)]
    Problem(#[from] Problem),
    /// The cloth flew apart.
    #[error(transparent)]
    Drape(#[from] DrapeError),
}

/// A draped cloth that moves with the process.
pub struct Hung {
    /// What the scenario says about it.
    pub spec: DrapeSpec,
    /// The cloth.
    pub drape: Drape,
    /// How it is seen.
    pub view: ViewSpec,
}

/// The drape of a scenario, or another one that is wanted instead.
///
/// # Errors
/// A [`Problem`] if there is no drape of that name.
pub fn spec_of(scenario: &Scenario, instead: Option<&Draping>) -> Result<DrapeSpec, Problem> {
    let default = Draping::Bundled(DEFAULT_DRAPE.into());
    let draping = instead.or(scenario.drape.as_ref()).unwrap_or(&default);
    let mut spec = draping.spec(&Checker::root().field("drape"))?;
    if let Draping::Bundled(_) = draping {
        fit(&mut spec, dyed_m(scenario));
    }
    Ok(spec)
}

/// Width and height of the dyed cloth, m.
pub fn dyed_m(scenario: &Scenario) -> (f64, f64) {
    let (nx, ny) = scenario.cloth.cells();
    let cell = 1e-3 * scenario.cloth.cell_mm;
    (cell * nx as f64, cell * ny as f64)
}

/// Gives a bundled drape the proportions of the cloth that is put on it: its longer side stays as long.
fn fit(spec: &mut DrapeSpec, (width, height): (f64, f64)) {
    let Some(size) = spec.size_m else {
        return;
    };
    let longer = size.0.max(size.1);
    let particles = spec.particles.0.max(spec.particles.1);
    let side = |length: f64| {
        let share = (length / width.max(height)).max(0.05);
        let cells = ((particles - 1) as f64 * share).round().max(1.0);
        (longer * share, cells as usize + 1)
    };
    let ((w, nx), (h, ny)) = (side(width), side(height));
    spec.size_m = Some((w, h));
    spec.particles = (nx, ny);
}

impl Hung {
    /// The cloth of a scenario in the beginning, before it has settled.
    ///
    /// # Errors
    /// [`HungError::Problem`] where the drape asks for something that cannot be.
    pub fn new(scenario: &Scenario, instead: Option<&Draping>) -> Result<Self, HungError> {
        let spec = spec_of(scenario, instead)?;
        let at = Checker::root().field("drape");
        let drape = spec.build(dyed_m(scenario), scenario.seed, &at)?;
        Ok(Hung {
            spec,
            drape,
            view: scenario.view.clone(),
        })
    }

    /// Lets the cloth move until it has settled and a share (0 to 1) of its later movement is done, as
    /// far as `go_on` says so between small pieces of time. Going back is not possible; then nothing
    /// happens.
    ///
    /// # Errors
    /// [`HungError::Drape`] if it flies apart.
    pub fn follow(
        &mut self,
        share: f64,
        mut go_on: impl FnMut(&Drape) -> bool,
    ) -> Result<bool, HungError> {
        // Pieces as long as a frame of a film, whatever the recording: so the cloth moves in the same
        // steps whoever looks at it, and how often.
        let to = self.spec.settle_s + share * self.view.moves_s;
        let whole = (to * PIECES_A_SECOND + 1e-6).floor();
        loop {
            let done = (self.drape.time * PIECES_A_SECOND + 1e-6).floor();
            if done >= whole {
                return Ok(true);
            }
            if !go_on(&self.drape) {
                return Ok(false);
            }
            let next = (done + 1.0) / PIECES_A_SECOND;
            self.drape.advance(next - self.drape.time)?;
        }
    }

    /// What is to be seen of it.
    pub fn subject(&self) -> Subject {
        let mut places = self.places();
        if let Start::Sphere { centre_m, radius_m } = self.spec.start {
            // The ball that the cloth is on.
            let centre = DVec3::new(centre_m.0, centre_m.1, centre_m.2);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                places.extend([centre + radius_m * axis, centre - radius_m * axis]);
            }
        }
        Subject::new(places)
    }

    /// Where its particles are, m; only those that are cloth.
    fn places(&self) -> Vec<DVec3> {
        let topology = &self.drape.sheet().topology;
        let nx = topology.particles.0;
        let all = self.drape.positions().iter().enumerate();
        all.filter(|(i, _)| topology.has_particle(i % nx, i / nx))
            .map(|(_, place)| *place)
            .collect()
    }

    /// Its front.
    pub fn front(&self) -> Fine {
        let topology = &self.drape.sheet().topology;
        Fine::new(self.drape.positions(), topology.particles, |x, y| {
            topology.is_cloth(x, y)
        })
    }
}

/// Pieces of time a second.
pub const PIECES_A_SECOND: f64 = 60.0;
