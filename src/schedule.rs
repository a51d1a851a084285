//! The order of the process, and its clock.
//!
//! | schedule | runs | sets, in order |
//! |---|---|---|
//! | [`Prepare`] | once, before anything | [`PrepareSet::Cloth`], [`PrepareSet::Stages`] |
//! | [`DyeStep`] | once for every (split) step | [`DyeSet::Supply`], [`DyeSet::Diffusion`], [`DyeSet::Adsorption`], [`DyeSet::Tick`] |
//! | [`DyeFrame`] | whenever someone looks | [`FrameSet::Supply`], [`FrameSet::Measure`], [`FrameSet::Draw`], [`FrameSet::Keep`] |
//!
//! The clock belongs to the process: steps and hours, never wall time or frame rate.

use std::ops::Deref;
use std::sync::Arc;

use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor};
use bevy::prelude::*;

use crate::scenario::Experiment;

/// Builds the cloth and everything that the stages keep. Runs once.
#[derive(ScheduleLabel, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Prepare;

/// Advances the process by [`ProcessClock::stride`] steps, or by one part of a step where
/// [`ProcessClock::splits`] says so.
#[derive(ScheduleLabel, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DyeStep;

/// Shows the cloth as it is at this very moment. Changes nothing that a later step would not.
#[derive(ScheduleLabel, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DyeFrame;

/// What is prepared, in order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PrepareSet {
    /// Responsible for weaving the [`Cloth`](crate::cloth::Cloth).
    Cloth,
    /// Responsible for what each stage derives from the cloth.
    Stages,
}

/// The stages of one step, in order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DyeSet {
    /// Responsible for dye entering the cloth.
    Supply,
    /// Responsible for dye moving.
    Diffusion,
    /// Responsible for dye binding.
    Adsorption,
    /// Responsible for the clock.
    Tick,
}

/// What happens for one frame, in order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameSet {
    /// Responsible for the supply due at this moment, which the next step would otherwise bring.
    Supply,
    /// Responsible for taking stock of the dye.
    Measure,
    /// Responsible for the picture of the cloth.
    Draw,
    /// Responsible for keeping what was drawn: recorder, window.
    Keep,
}

/// The experiment that runs.
#[derive(Resource, Debug, Clone)]
pub struct TheExperiment(pub Arc<Experiment>);

impl Deref for TheExperiment {
    type Target = Experiment;

    fn deref(&self) -> &Experiment {
        &self.0
    }
}

/// The clock of the process.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct ProcessClock {
    /// Whole steps done.
    pub step: u64,
    /// Parts of the running step done; 0 between steps.
    pub part: u32,
    /// Into how many parts a step is split; 1 unless the explicit solver would be unstable.
    pub splits: u32,
    /// Into how many the explicit solver would have to split it, whichever solver runs.
    pub splits_if_explicit: u32,
    /// Steps that this run of [`DyeStep`] covers: 1, or as many as the accelerated solver can show
    /// at once.
    pub stride: u64,
    /// The step up to which the process is to go now. No run of [`DyeStep`] goes beyond.
    pub until: u64,
    /// Δt, the length of a step in hours.
    pub step_h: f64,
}

impl ProcessClock {
    /// Hours of dyeing done.
    pub fn hours(&self) -> f64 {
        self.step as f64 * self.step_h
    }

    /// Hours that this run of [`DyeStep`] covers.
    pub fn stride_hours(&self) -> f64 {
        self.stride as f64 * self.step_h / f64::from(self.splits)
    }
}

/// The schedules and the clock, which every other plugin hangs on.
pub struct SchedulePlugin;

impl Plugin for SchedulePlugin {
    fn build(&self, app: &mut App) {
        for schedule in [
            Schedule::new(Prepare),
            Schedule::new(DyeStep),
            Schedule::new(DyeFrame),
        ] {
            app.add_schedule(in_one_thread(schedule));
        }
        app.configure_sets(Prepare, (PrepareSet::Cloth, PrepareSet::Stages).chain())
            .configure_sets(
                DyeStep,
                (
                    DyeSet::Supply,
                    DyeSet::Diffusion,
                    DyeSet::Adsorption,
                    DyeSet::Tick,
                )
                    .chain(),
            )
            .configure_sets(
                DyeFrame,
                (
                    FrameSet::Supply,
                    FrameSet::Measure,
                    FrameSet::Draw,
                    FrameSet::Keep,
                )
                    .chain(),
            )
            .add_systems(Prepare, start_clock.in_set(PrepareSet::Cloth))
            .add_systems(DyeStep, tick.in_set(DyeSet::Tick));
    }
}

/// The loops inside a system use all cores; systems themselves run one after another, in an order
/// that is never left open.
fn in_one_thread(mut schedule: Schedule) -> Schedule {
    schedule
        .set_executor(SingleThreadedExecutor::new())
        .set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..default()
        });
    schedule
}

fn start_clock(mut commands: Commands, experiment: Res<TheExperiment>) {
    commands.insert_resource(ProcessClock {
        step: 0,
        part: 0,
        splits: 1,
        splits_if_explicit: 1,
        stride: 1,
        until: 0,
        step_h: experiment.scenario.process.step_h,
    });
}

fn tick(mut clock: ResMut<ProcessClock>) {
    clock.part += 1;
    if clock.part >= clock.splits {
        clock.part = 0;
        clock.step += clock.stride;
    }
}

/// Runs [`DyeStep`] until the clock shows `step`, or `go_on` says no. It is told the step and asked
/// before every run, so also between the parts of a step that is split.
///
/// Returns whether the step was reached.
pub fn advance_to(world: &mut World, step: u64, mut go_on: impl FnMut(u64) -> bool) -> bool {
    world.resource_mut::<ProcessClock>().until = step;
    let reached = world.try_schedule_scope(DyeStep, |world, schedule| {
        loop {
            let now = world.resource::<ProcessClock>().step;
            if now >= step {
                return true;
            }
            if !go_on(now) {
                return false;
            }
            schedule.run(world);
        }
    });
    reached.unwrap_or(false)
}
