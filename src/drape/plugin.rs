//! The cloth in a Bevy app: a clock that is told how far to go, and hands that hold the cloth.
//!
//! Works alone, without rendering and without the dye: see `examples/hanging_cloth.rs`. The time is that
//! of the cloth, in seconds; nothing here looks at a real clock, so the same requests always give the
//! same cloth.

use bevy::ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};
use bevy::math::{DVec2, DVec3};
use bevy::prelude::*;

use super::drape::{Drape, DrapeError, Snapshot};
use super::hand::{Hand, Hit};

/// What advances the cloth to where [`DrapeClock`] asks.
#[derive(ScheduleLabel, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DrapeStep;

/// How far the cloth is asked to be.
#[derive(Resource, Debug, Clone, Copy, PartialEq, Default)]
pub struct DrapeClock {
    /// Seconds since the cloth began. One in the past asks for nothing.
    pub asked_s: f64,
}

/// The cloth that is draped.
#[derive(Resource)]
pub struct Draped {
    /// The cloth.
    pub drape: Drape,
    /// Why it stopped, if it did; it does not go on then until it is [restored](Draped::restore).
    pub error: Option<DrapeError>,
}

impl Draped {
    /// A cloth at its beginning.
    pub fn new(drape: Drape) -> Self {
        Draped { drape, error: None }
    }

    /// Seconds since the cloth began.
    pub fn time(&self) -> f64 {
        self.drape.time
    }

    /// What it takes to come back to this moment.
    pub fn snapshot(&self) -> Snapshot {
        self.drape.snapshot()
    }

    /// Goes back, or on, to a moment.
    pub fn restore(&mut self, to: &Snapshot) {
        self.drape.restore(to);
        self.error = None;
    }

    /// Where a ray first meets the cloth.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        super::hand::hit(&self.drape, origin, direction)
    }

    /// Takes hold of a particle: a soft spring draws it to `target`. Taking hold of it again moves the
    /// hand.
    pub fn hold(&mut self, particle: usize, target: DVec3) {
        if particle >= self.drape.positions().len() {
            return;
        }
        let hands = &mut self.drape.hands;
        match hands.iter_mut().find(|hand| hand.particle == particle) {
            Some(hand) => hand.target = target,
            None => hands.push(Hand { particle, target }),
        }
    }

    /// Lets go of a particle.
    pub fn let_go(&mut self, particle: usize) {
        self.drape.hands.retain(|hand| hand.particle != particle);
    }

    /// Fixes a particle where it is.
    pub fn pin(&mut self, particle: usize) {
        self.drape.pin(particle);
    }

    /// Takes every pin off a particle.
    pub fn unpin(&mut self, particle: usize) {
        self.drape.unpin(particle);
    }

    /// Presses a crease between two places on the cloth (shares of its width and height), folding by
    /// `angle` radians, positive where the front is outside; `stiffness` in N·m/(m·rad). Returns how many
    /// links it crosses.
    pub fn add_crease(&mut self, from: DVec2, to: DVec2, angle: f64, stiffness: f64) -> usize {
        self.drape.add_crease(from, to, angle, stiffness)
    }
}

/// Draped cloth: insert [`Draped`] and it follows [`DrapeClock`] whenever [`DrapeStep`] runs.
pub struct DrapePlugin;

impl Plugin for DrapePlugin {
    fn build(&self, app: &mut App) {
        let mut schedule = Schedule::new(DrapeStep);
        schedule.set_executor(SingleThreadedExecutor::new());
        schedule.add_systems(follow_clock.run_if(resource_exists::<Draped>));
        app.init_resource::<DrapeClock>().add_schedule(schedule);
    }
}

fn follow_clock(clock: Res<DrapeClock>, mut draped: ResMut<Draped>) {
    if draped.error.is_some() {
        return;
    }
    let seconds = clock.asked_s - draped.time();
    // Less than this is what is left of adding up steps.
    if seconds.is_nan() || seconds <= 1e-9 {
        return;
    }
    if let Err(error) = draped.drape.advance(seconds) {
        draped.error = Some(error);
    }
}

/// Advances the cloth of a world to a moment.
///
/// # Errors
/// [`DrapeError`] if the cloth flew apart, now or before.
pub fn drape_to(world: &mut World, seconds: f64) -> Result<(), DrapeError> {
    world.resource_mut::<DrapeClock>().asked_s = seconds;
    world.run_schedule(DrapeStep);
    match world
        .get_resource::<Draped>()
        .and_then(|draped| draped.error.clone())
    {
        Some(error) => Err(error),
        None => Ok(()),
    }
}
