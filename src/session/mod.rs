//! What lies beneath the window, and needs none: a cloth that is dyed, changed, gone back to and saved.
//!
//! | where | what it does |
//! |---|---|
//! | [`snapshot`] | keeps a moment of the process, and puts it back |
//! | [`timeline`] | moments within a budget of memory; any step, there and back |
//! | [`history`] | undo and redo of scenarios |
//! | [`effect`](mod@effect) | what a change of the scenario needs |
//! | [`paint`] | strokes of a brush as changes of the scenario |
//! | [`save`] | a scenario as a file with comments |
//! | [`section`] | what lies below a line |
//! | [`overlay`] | fields as pictures, with a scale |
//! | [`course`] | the ledger over time |
//!
//! **Every edit is another scenario**, and the cloth that is seen is always the cloth that a recording of
//! the present scenario shows at that step, to the last bit. [`Session`] sees to that: it keeps of the
//! moments so far those that the edit leaves alone, and lets the rest be computed again.
//!
//! A session works on a world with [`DyeingPlugins`](crate::DyeingPlugins), and never takes longer
//! than one run of the process after it has been told to stop; where it has not arrived yet the same
//! call goes on. [`Session::show`] is when the picture is drawn: what is put back or computed on the way is
//! seen only then.

pub mod course;
pub mod effect;
pub mod history;
pub mod overlay;
pub mod paint;
pub mod save;
pub mod section;
pub mod snapshot;
pub mod timeline;

use std::sync::Arc;

use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;

use crate::adsorption::Capacities;
use crate::batik::stage::Batik;
use crate::diffusion::{Conductances, Leap, Steps};
use crate::look;
use crate::memory::{self, Use};
use crate::pattern::Stroke;
use crate::scenario::{Beside, Experiment, Images, Origin, Scenario, ScenarioError};
use crate::schedule::{Prepare, ProcessClock, TheExperiment};
use crate::supply;
use crate::texture::{OtherSide, change_look, darkest_at, see_both_sides};
use course::Course;
use effect::{Effect, effect, only_adds_doses_at};
use history::History;
use paint::{Paint, painted};
use snapshot::Snapshot;
use timeline::Timeline;

/// A cloth that is dyed and changed.
#[derive(Debug)]
pub struct Session {
    experiment: Arc<Experiment>,
    history: History,
    timeline: Timeline,
    course: Course,
    target: u64,
}

impl Session {
    /// Opens an experiment in a world with [`DyeingPlugins`](crate::DyeingPlugins): it is prepared and at
    /// its first moment. Moments are kept within `budget` bytes.
    pub fn open(world: &mut World, experiment: Experiment, budget: usize) -> Self {
        let mut session = Session {
            history: History::new(experiment.scenario.clone()),
            experiment: Arc::new(experiment),
            timeline: Timeline::new(budget),
            course: Course::default(),
            target: 0,
        };
        session.begin(world);
        session.show(world);
        session
    }

    /// The scenario as it is now.
    pub fn scenario(&self) -> &Scenario {
        &self.experiment.scenario
    }

    /// The experiment as it is now, ready to be saved and recorded.
    pub fn experiment(&self) -> Experiment {
        Experiment {
            text: save::save(self.scenario()),
            ..Experiment::clone(&self.experiment)
        }
    }

    /// The scenario lies somewhere else from now on, and its pictures beside it.
    pub fn lies_at(&mut self, origin: Origin) {
        Arc::make_mut(&mut self.experiment).origin = origin;
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The moments that are kept.
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// The ledger over time.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// The step that is gone to: that of the world, once it has arrived.
    pub fn target(&self) -> u64 {
        self.target
    }

    /// Whether the world is where it is going to.
    pub fn has_arrived(&self, world: &World) -> bool {
        let clock = world.resource::<ProcessClock>();
        clock.step == self.target && clock.part == 0
    }

    /// Goes on to where the session is going; see [`Session::go_to`].
    pub fn go_on(&mut self, world: &mut World, go_on: impl FnMut(u64) -> bool) -> bool {
        if !self.timeline.go_to(world, self.target, go_on) {
            return false;
        }
        self.show(world);
        true
    }

    /// Goes to a step, forwards or backwards, at most to the end of the process. `go_on` is asked before
    /// every run of the process; where it says no, [`Session::go_on`] goes on later. Once there, ledger
    /// and picture are brought up to this moment.
    ///
    /// Returns whether it has arrived.
    pub fn go_to(&mut self, world: &mut World, step: u64, go_on: impl FnMut(u64) -> bool) -> bool {
        self.target = step.min(self.scenario().process.steps());
        self.go_on(world, go_on)
    }

    /// Goes on by some steps, or, where it has not arrived yet, to where it was going before: the
    /// process never runs ahead of what is seen.
    pub fn advance(
        &mut self,
        world: &mut World,
        steps: u64,
        go_on: impl FnMut(u64) -> bool,
    ) -> bool {
        let by = if self.has_arrived(world) { steps } else { 0 };
        self.go_to(world, self.target.saturating_add(by), go_on)
    }

    /// Changes the scenario. While an edit is `held` those that follow with the same label are one edit
    /// for undo. The world may be at an earlier step afterwards, and goes on to where it was.
    ///
    /// # Errors
    /// A [`ScenarioError`] where the new scenario is not possible; nothing has changed then.
    pub fn edit(
        &mut self,
        world: &mut World,
        scenario: Scenario,
        label: &str,
        held: bool,
    ) -> Result<Effect, ScenarioError> {
        let experiment = self.with(scenario.clone())?;
        self.history.edit(scenario, label, held);
        Ok(self.apply(world, experiment))
    }

    /// Ends an edit that was held.
    pub fn release(&mut self) {
        self.history.release();
    }

    /// Undoes the last edit; nothing if there is none.
    ///
    /// # Errors
    /// A [`ScenarioError`] where a picture that is needed again has gone; nothing has changed then.
    pub fn undo(&mut self, world: &mut World) -> Result<Effect, ScenarioError> {
        let Some((_, scenario)) = self.history.undoable() else {
            return Ok(Effect::Nothing);
        };
        let experiment = self.with(Scenario::clone(scenario))?;
        self.history.undo();
        Ok(self.apply(world, experiment))
    }

    /// Does again what was undone last; nothing if there is none.
    ///
    /// # Errors
    /// As [`Session::undo`].
    pub fn redo(&mut self, world: &mut World) -> Result<Effect, ScenarioError> {
        let Some((_, scenario)) = self.history.redoable() else {
            return Ok(Effect::Nothing);
        };
        let experiment = self.with(Scenario::clone(scenario))?;
        self.history.redo();
        Ok(self.apply(world, experiment))
    }

    /// Paints a whole stroke, at the step where the session is or is going to. (While the brush is still
    /// down a window shows the stroke over the picture: every call is an edit of its own.)
    ///
    /// # Errors
    /// A [`ScenarioError`] where that is not possible, such as dye or resist on a batik by sweeps; nothing
    /// has changed then.
    pub fn paint(
        &mut self,
        world: &mut World,
        paint: Paint,
        stroke: Stroke,
    ) -> Result<Effect, ScenarioError> {
        self.release();
        let scenario = painted(self.scenario(), paint, stroke, self.target);
        self.edit(world, scenario, paint.label(), false)
    }

    /// Looks at the world as it is, on the way as well.
    pub fn show(&mut self, world: &mut World) {
        look(world);
        self.course.note(world);
    }

    /// The present experiment with another scenario.
    fn with(&self, scenario: Scenario) -> Result<Experiment, ScenarioError> {
        scenario.check()?;
        memory::check(&scenario, Use::of(&scenario))?;
        let old = &self.experiment;
        let same_pictures = |scenario: &Scenario| {
            let pictures = scenario.pictures().into_iter();
            let pictures = pictures.map(|(file, wanted, _)| (file.to_owned(), wanted));
            (pictures.collect::<Vec<_>>(), scenario.cloth.cells())
        };
        let images = match same_pictures(&scenario) == same_pictures(&old.scenario) {
            true => old.images.clone(),
            false => Images::load(&scenario, &Beside::of(&old.origin))?,
        };
        Ok(Experiment {
            name: old.name.clone(),
            origin: old.origin.clone(),
            text: ron::to_string(&scenario).unwrap_or_default(),
            scenario,
            images,
        })
    }

    /// Goes on with another experiment of the same kind.
    fn apply(&mut self, world: &mut World, experiment: Experiment) -> Effect {
        let old = std::mem::replace(&mut self.experiment, Arc::new(experiment));
        let needed = effect(&old.scenario, self.scenario());
        if needed == Effect::Restart {
            self.timeline.forget_all();
            self.course = Course::default();
            self.begin(world);
        } else {
            world.insert_resource(TheExperiment(self.experiment.clone()));
            if let Effect::FromStep(step) = needed {
                self.change_from(world, step, &old.scenario);
            }
            let darkest = darkest_at(&old.scenario) != darkest_at(self.scenario());
            if old.scenario.look != self.scenario().look || darkest {
                change_look(world, self.scenario().look.clone());
            }
            if let Some(mut batik) = world.get_resource_mut::<Batik>() {
                batik.look_as(self.scenario());
            }
        }
        self.target = self.target.min(self.scenario().process.steps());
        if self.has_arrived(world) {
            self.show(world);
        }
        needed
    }

    /// Takes over what is supplied from `step` on, and keeps what is true still.
    fn change_from(&mut self, world: &mut World, step: u64, old: &Scenario) {
        self.timeline.forget_after(step);
        self.course.forget_from(step);
        let here = Snapshot::take(world);
        let now = here.clock();
        let stays = here.depends() <= step
            || (now.step == step
                && now.part == 0
                && here.looks_ahead_to() <= step
                && only_adds_doses_at(step, old, self.scenario()));
        if world.run_system_once(supply::prepare).is_err() {
            // It asks for nothing that a prepared world has not.
            self.timeline.forget_all();
            return self.begin(world);
        }
        match self.timeline.nearest_before(now.step) {
            _ if stays => here.restore(world),
            Some(kept) => kept.restore(world),
            None => self.begin(world),
        }
    }

    /// Prepares the world for the present experiment, and keeps its first moment.
    fn begin(&mut self, world: &mut World) {
        // Stages ask which of these is there.
        world.remove_resource::<Leap>();
        world.remove_resource::<Steps>();
        world.remove_resource::<Conductances>();
        world.remove_resource::<Capacities>();
        world.remove_resource::<Batik>();
        world.insert_resource(TheExperiment(self.experiment.clone()));
        world.run_schedule(Prepare);
        if world.contains_resource::<OtherSide>() {
            // The cloth may be larger than the one whose back was drawn.
            see_both_sides(world);
        }
        self.timeline.note(world);
    }
}
