//! Dye enters: once as a dose, held at a concentration while it lasts, or from a bath through the
//! cover of the cloth (model section 3).
//!
//! Supply brings the cloth to what is demanded **at this moment**: what is given once is given
//! once, and what is kept is kept at one concentration, the later hold's where two overlap. Run
//! twice at the same moment, it supplies nothing the second time. So it runs at the beginning of
//! every (split) step, and again before a frame is taken, and neither the frames nor their number
//! change the process. Only a bath takes time, and runs with the steps alone.

use std::borrow::Cow;

use bevy::prelude::*;

use crate::batik::stage::Batik;
use crate::cloth::Cloth;
use crate::diffusion::{Conductances, FreeDye};
use crate::ledger::Ledger;
use crate::pattern::{Canvas, Raster};
use crate::scenario::SupplySpec;
use crate::schedule::{
    DyeFrame, DyeSet, DyeStep, FrameSet, Prepare, PrepareSet, ProcessClock, TheExperiment,
};

/// Supply of dye to the cloth.
pub struct SupplyPlugin;

impl Plugin for SupplyPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Stages))
            .add_systems(
                DyeStep,
                (
                    bring,
                    // Where a run covers many steps the solver itself lets the baths act.
                    soak.run_if(there_are_baths.and_then(resource_exists::<Conductances>)),
                )
                    .chain()
                    .in_set(SupplySystems)
                    .in_set(DyeSet::Supply),
            )
            .add_systems(
                DyeFrame,
                bring.in_set(SupplySystems).in_set(FrameSet::Supply),
            );
    }
}

/// The systems that bring dye, for what comes before or after them in their sets.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SupplySystems;

/// Everything that is supplied to the cloth.
#[derive(Resource, Debug, Clone, Default)]
pub struct Supplies {
    /// What is given once, in order of time; at one moment ending holds come before doses.
    events: Vec<Event>,
    /// Events that are done.
    done: usize,
    holds: Vec<Hold>,
    baths: Vec<Bath>,
    /// What is kept now, in the order of the cells, and the step until which that holds and baths stay.
    kept: Vec<Cell>,
    kept_until: u64,
    /// The step at which that was found; none before the first.
    kept_from: Option<u64>,
    /// What the baths do now, once someone has asked.
    soaked: Option<Vec<Soaked>>,
}

/// How far supply has come: what else it keeps follows from the scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SupplyProgress {
    /// Events that are done.
    done: usize,
    /// The step at which was found what is kept.
    kept_from: Option<u64>,
}

impl SupplyProgress {
    /// Whether supply has acted already at `step`, or later.
    pub fn has_acted(&self, supplies: &Supplies, step: u64) -> bool {
        let last = self
            .done
            .checked_sub(1)
            .and_then(|i| supplies.events.get(i));
        self.kept_from.is_some_and(|from| from >= step) || last.is_some_and(|last| last.at >= step)
    }
}

/// A cell's index in a field, and the concentration that is brought to it.
pub type Cell = (u32, f32);

/// What all baths together do to a cell in (a part of) a step: they make up the share β of what its
/// concentration lacks of M.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soaked {
    /// The cell's index in a field.
    pub cell: u32,
    /// β, above 0 and at most [`MOST_SOAKED`].
    pub share: f32,
    /// M.
    pub concentration: f32,
}

/// The most that baths make up of what is missing, however many there are (β of one is at most a
/// half): what is left of a concentration must not drown in rounding.
pub const MOST_SOAKED: f32 = 1.0 - 1.0 / 4096.0;

impl Soaked {
    /// This, and then another bath on the same cell.
    fn and_then(self, next: Soaked) -> Self {
        let [first, second] = [self.share, next.share].map(f64::from);
        let [from, to] = [self.concentration, next.concentration].map(f64::from);
        let stays = first * (1.0 - second);
        let share = stays + second;
        Soaked {
            cell: self.cell,
            share: (share as f32).min(MOST_SOAKED),
            concentration: ((stays * from + second * to) / share) as f32,
        }
    }
}

/// Something that is given at one moment.
#[derive(Debug, Clone)]
struct Event {
    at: u64,
    cells: Vec<Cell>,
    gift: Gift,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Gift {
    /// A hold ends: it tops up a last time, so that its last moment shows it whole.
    LastOfHold,
    /// A dose is poured on: it never takes away what is there.
    Dose,
}

/// A concentration that is kept from one step on, up to but not at another.
#[derive(Debug, Clone)]
struct Hold {
    from: u64,
    until: u64,
    cells: Vec<Cell>,
}

/// A bath that reaches the cloth through its cover, from one step on, up to but not at another.
#[derive(Debug, Clone)]
struct Bath {
    from: u64,
    until: u64,
    concentration: f32,
    /// A cell's index, and the share of the difference α·p that one step makes up there.
    cells: Vec<Cell>,
}

impl Supplies {
    /// The concentration kept in each cell from a step on; NaN where none is.
    pub fn held(&self, step: u64, cells: usize) -> Vec<f32> {
        let mut held = vec![f32::NAN; cells];
        for (i, concentration) in self.kept_at(step).iter() {
            held[*i as usize] = *concentration;
        }
        held
    }

    /// Whether something is still to be done at `step`: dye to be given, or cells to be kept, or a bath
    /// to act, from here on or no longer.
    pub fn changes_at(&self, step: u64) -> bool {
        let is_due = |event: &Event| event.at <= step;
        step >= self.kept_until || self.events.get(self.done).is_some_and(is_due)
    }

    /// The next step after `step` where dye is given, something else is kept, or a bath begins or ends.
    pub fn next_change(&self, step: u64) -> u64 {
        let events = self.events[self.done..].iter().map(|event| event.at);
        let later = events.chain([self.kept_until]).filter(|at| *at > step);
        later.min().unwrap_or(u64::MAX)
    }

    /// What the baths do to each cell in one of `splits` parts of a step, from `step` on, in the order
    /// of the cells. Where something is kept they do nothing; several act one after the other.
    pub fn soaked_at(&self, step: u64, splits: u32) -> Vec<Soaked> {
        let part = 1.0 / splits as f32;
        let is_on = |bath: &&Bath| bath.from <= step && step < bath.until;
        let mut soaked = Vec::new();
        for bath in self.baths.iter().filter(is_on) {
            let cells = bath.cells.iter().map(|(cell, share)| Soaked {
                cell: *cell,
                share: part * share,
                concentration: bath.concentration,
            });
            soaked.extend(cells.filter(|soaked| soaked.share > 0.0));
        }
        // The sort leaves equals in their order.
        soaked.sort_by_key(|soaked| soaked.cell);
        soaked.dedup_by(|next, first| {
            let same = next.cell == first.cell;
            if same {
                *first = first.and_then(*next);
            }
            same
        });
        let kept = self.kept_at(step);
        let is_kept = |cell: u32| kept.binary_search_by_key(&cell, |(kept, _)| *kept).is_ok();
        soaked.retain(|soaked| !is_kept(soaked.cell));
        soaked
    }

    /// The cells that are kept from `step` on, and the concentrations.
    pub fn kept_at(&self, step: u64) -> Cow<'_, [Cell]> {
        if step < self.kept_until {
            return Cow::Borrowed(&self.kept);
        }
        let is_on = |hold: &Hold| hold.from <= step && step < hold.until;
        Cow::Owned(
            effective(&self.holds, is_on)
                .map(|(cell, _)| cell)
                .collect(),
        )
    }

    /// Brings free dye to what is demanded at `step`, and books what that took.
    pub fn bring(&mut self, step: u64, cloth: &Cloth, dye: &mut FreeDye, ledger: &mut Ledger) {
        self.find_kept(step);
        while let Some(event) = self.events.get(self.done).filter(|event| event.at <= step) {
            for (i, concentration) in &event.cells {
                let is_kept = self.kept.binary_search_by_key(i, |(kept, _)| *kept).is_ok();
                let i = *i as usize;
                let has_more = event.gift == Gift::Dose && dye.concentration[i] >= *concentration;
                if !is_kept && !has_more {
                    ledger.book(dye.bring(i, *concentration) * capacity(cloth, i));
                }
            }
            self.done += 1;
        }
        for (i, concentration) in &self.kept {
            let i = *i as usize;
            ledger.book(dye.bring(i, *concentration) * capacity(cloth, i));
        }
    }

    /// Lets dye in (or out) from the baths during one of `splits` parts of a step, where nothing is
    /// kept. Unlike [`Supplies::bring`] this takes time: it must run once for each part, after it.
    pub fn soak(
        &mut self,
        step: u64,
        splits: u32,
        cloth: &Cloth,
        dye: &mut FreeDye,
        ledger: &mut Ledger,
    ) {
        let soaked = self.soaked.take();
        let soaked = soaked.unwrap_or_else(|| self.soaked_at(step, splits));
        for bath in &soaked {
            let i = bath.cell as usize;
            let missing = bath.concentration - dye.concentration[i];
            let grown = dye.grow(i, bath.share * missing);
            ledger.book(grown * capacity(cloth, i));
        }
        self.soaked = Some(soaked);
    }

    /// Finds what is kept at a step, and forgets what baths did before it.
    fn find_kept(&mut self, step: u64) {
        if step < self.kept_until {
            return;
        }
        self.kept = self.kept_at(step).into_owned();
        self.kept_from = Some(step);
        self.soaked = None;
        self.kept_until = self.stays_until(step);
    }

    /// The next step after `step` at which a hold or a bath begins or ends.
    fn stays_until(&self, step: u64) -> u64 {
        let holds = self.holds.iter().flat_map(|hold| [hold.from, hold.until]);
        let baths = self.baths.iter().flat_map(|bath| [bath.from, bath.until]);
        let changes = holds.chain(baths).filter(|change| *change > step);
        changes.min().unwrap_or(u64::MAX)
    }

    /// How far supply has come.
    pub fn progress(&self) -> SupplyProgress {
        SupplyProgress {
            done: self.done,
            kept_from: self.kept_from,
        }
    }

    /// Goes on from where supply had come once.
    pub fn resume(&mut self, progress: SupplyProgress) {
        self.done = progress.done.min(self.events.len());
        self.kept_until = 0;
        self.kept_from = progress.kept_from;
        self.soaked = None;
        self.kept = Vec::new();
        if let Some(from) = progress.kept_from {
            self.kept = self.kept_at(from).into_owned();
            self.kept_until = self.stays_until(from);
        }
    }

    /// Adds what the holds do at their ends.
    fn end_holds(&mut self) {
        let mut ends: Vec<u64> = self.holds.iter().map(|hold| hold.until).collect();
        ends.retain(|end| *end != u64::MAX);
        ends.sort_unstable();
        ends.dedup();
        for at in ends {
            // Up to its end a hold counts where it counted before.
            let was_on = |hold: &Hold| {
                (hold.from < at && at <= hold.until) || (hold.from == at && hold.until == at)
            };
            let ending = effective(&self.holds, was_on).filter(|(_, hold)| hold.until == at);
            let cells = ending.map(|(cell, _)| cell).collect();
            let gift = Gift::LastOfHold;
            self.events.push(Event { at, cells, gift });
        }
    }
}

/// The cells that those of the holds which are `on` keep, in order, each with its hold. Where they
/// overlap, the later one of the scenario counts.
fn effective(holds: &[Hold], on: impl Fn(&Hold) -> bool) -> impl Iterator<Item = (Cell, &Hold)> {
    let mut cells: Vec<(Cell, &Hold)> = Vec::new();
    for hold in holds.iter().filter(|hold| on(hold)) {
        cells.extend(hold.cells.iter().map(|cell| (*cell, hold)));
    }
    // The sort leaves equals in their order: the last one of each counts.
    cells.sort_by_key(|((i, _), _)| *i);
    cells.reverse();
    cells.dedup_by_key(|((i, _), _)| *i);
    cells.into_iter().rev()
}

/// V_u of a cell of a field.
fn capacity(cloth: &Cloth, i: usize) -> f64 {
    let (layer, y, x) = cloth.grid.place(i);
    f64::from(cloth.capacity_free(layer, y, x))
}

fn bring(
    mut supplies: ResMut<Supplies>,
    clock: Res<ProcessClock>,
    cloth: Res<Cloth>,
    single_steps: Option<Res<Conductances>>,
    mut dye: ResMut<FreeDye>,
    mut ledger: ResMut<Ledger>,
) {
    // Where a run covers many steps the solver itself keeps what is kept, until something changes.
    if single_steps.is_none() && !supplies.changes_at(clock.step) {
        return;
    }
    supplies.bring(clock.step, &cloth, &mut dye, &mut ledger);
}

fn there_are_baths(supplies: Res<Supplies>) -> bool {
    !supplies.baths.is_empty()
}

fn soak(
    mut supplies: ResMut<Supplies>,
    clock: Res<ProcessClock>,
    cloth: Res<Cloth>,
    mut dye: ResMut<FreeDye>,
    mut ledger: ResMut<Ledger>,
) {
    supplies.soak(clock.step, clock.splits, &cloth, &mut dye, &mut ledger);
}

pub(crate) fn prepare(
    mut commands: Commands,
    cloth: Res<Cloth>,
    experiment: Res<TheExperiment>,
    batik: Option<Res<Batik>>,
) {
    let scenario = &experiment.scenario;
    let canvas = Canvas::of(&experiment);
    let step_h = scenario.process.step_h;
    let mut supplies = Supplies::default();
    for spec in &scenario.supply {
        let shape = canvas.draw(spec.shape());
        match spec {
            SupplySpec::Dose { dose, at, .. } => supplies.events.push(Event {
                at: at.steps(step_h),
                cells: reached(&shape, *dose as f32, &cloth),
                gift: Gift::Dose,
            }),
            SupplySpec::Hold {
                dose, from, until, ..
            } => {
                supplies.holds.push(Hold {
                    from: from.steps(step_h),
                    until: until.map_or(u64::MAX, |until| until.steps(step_h)),
                    cells: reached(&shape, *dose as f32, &cloth),
                });
            }
            SupplySpec::Bath {
                dose,
                speed,
                from,
                until,
                ..
            } => supplies.baths.push(Bath {
                from: from.steps(step_h),
                until: until.map_or(u64::MAX, |until| until.steps(step_h)),
                concentration: *dose as f32,
                cells: reached(&shape, *speed as f32, &cloth),
            }),
        }
    }
    for waxed in batik.iter().flat_map(|batik| batik.baths()) {
        let open = Raster::uniform(cloth.grid.nx, cloth.grid.ny, 1.0);
        let p = waxed.wax.map_or(&open, |wax| &wax.permeation);
        supplies.baths.push(Bath {
            from: waxed.from,
            until: waxed.until,
            concentration: waxed.bath.concentration as f32,
            cells: reached(p, waxed.bath.supply as f32, &cloth),
        });
    }
    supplies.end_holds();
    supplies.events.sort_by_key(|event| (event.at, event.gift));
    commands.insert_resource(supplies);
}

/// The cells of both layers that a shape reaches, each with `most` times the value of the shape.
/// Cells that hold no liquid take no part.
fn reached(shape: &Raster, most: f32, cloth: &Cloth) -> Vec<Cell> {
    let layer = shape.values.len();
    (0..2 * layer)
        .filter_map(|i| {
            let value = shape.values[i % layer];
            (value > 0.0 && capacity(cloth, i) > 0.0).then_some((i as u32, most * value))
        })
        .collect()
}
