//! Dye enters: once as a dose, or held at a concentration while it lasts (model section 3).
//!
//! Supply brings the cloth to what is demanded **at this moment**: run twice at the same moment, it
//! supplies nothing the second time. So it runs at the beginning of every step, and again before a
//! frame is taken, and neither the frames nor their number change the process.

use bevy::prelude::*;

use crate::cloth::Cloth;
use crate::diffusion::FreeDye;
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
            .add_systems(DyeStep, supply.in_set(DyeSet::Supply))
            .add_systems(DyeFrame, supply.in_set(FrameSet::Supply));
    }
}

/// Everything that is supplied to the cloth, in the order of the scenario.
#[derive(Resource, Debug, Clone, Default)]
pub struct Supplies {
    list: Vec<Supply>,
}

/// One supply: the cells that it reaches and the concentration it brings to each.
#[derive(Debug, Clone)]
struct Supply {
    /// Index of a cell in a field, and its concentration.
    cells: Vec<(u32, f32)>,
    course: Course,
}

/// When dye is supplied, in steps.
#[derive(Debug, Clone, Copy)]
enum Course {
    Once { at: u64, done: bool },
    Held { from: u64, until: Option<u64> },
}

impl Course {
    /// Whether a hold tops up at the moment of a step: from its beginning to its end, both included.
    fn tops_up(self, step: u64) -> bool {
        match self {
            Course::Once { .. } => false,
            Course::Held { from, until } => from <= step && until.is_none_or(|until| step <= until),
        }
    }

    /// Whether a hold goes on after the moment of a step.
    fn goes_on(self, step: u64) -> bool {
        let Course::Held { until, .. } = self else {
            return false;
        };
        self.tops_up(step) && until != Some(step)
    }
}

impl Supplies {
    /// The concentration kept in each cell from a step on; NaN where none is.
    ///
    /// Where two holds overlap, the later one of the scenario counts.
    pub fn held(&self, step: u64, cells: usize) -> Vec<f32> {
        let mut held = vec![f32::NAN; cells];
        for supply in self.list.iter().filter(|s| s.course.goes_on(step)) {
            for (i, concentration) in &supply.cells {
                held[*i as usize] = *concentration;
            }
        }
        held
    }
}

/// Brings free dye to what the supplies demand at `step`, and books what that took.
pub fn bring(
    supplies: &mut Supplies,
    step: u64,
    cloth: &Cloth,
    dye: &mut FreeDye,
    ledger: &mut Ledger,
) {
    for supply in &mut supplies.list {
        let pours = match &mut supply.course {
            Course::Once { at, done } if !*done && step >= *at => {
                *done = true;
                true
            }
            course if course.tops_up(step) => false,
            _ => continue,
        };
        for (i, concentration) in &supply.cells {
            let i = *i as usize;
            // A dose is poured on: it never takes away what is there. A hold does.
            if pours && dye.concentration[i] >= *concentration {
                continue;
            }
            let grown = dye.bring(i, *concentration);
            ledger.book(grown * f64::from(cloth.capacity_free[i]));
        }
    }
}

fn supply(
    mut supplies: ResMut<Supplies>,
    clock: Res<ProcessClock>,
    cloth: Res<Cloth>,
    mut dye: ResMut<FreeDye>,
    mut ledger: ResMut<Ledger>,
) {
    bring(&mut supplies, clock.step, &cloth, &mut dye, &mut ledger);
}

fn prepare(mut commands: Commands, cloth: Res<Cloth>, experiment: Res<TheExperiment>) {
    let scenario = &experiment.scenario;
    let canvas = Canvas::of(&experiment);
    let step_h = scenario.process.step_h;
    let list = scenario
        .supply
        .iter()
        .map(|spec| {
            let (dose, course) = match spec {
                SupplySpec::Dose { dose, at, .. } => {
                    let at = at.steps(step_h);
                    (*dose, Course::Once { at, done: false })
                }
                SupplySpec::Hold {
                    dose, from, until, ..
                } => {
                    let from = from.steps(step_h);
                    let until = until.map(|until| until.steps(step_h));
                    (*dose, Course::Held { from, until })
                }
            };
            let cells = reached(&canvas.draw(spec.shape()), dose as f32, &cloth);
            Supply { cells, course }
        })
        .collect();
    commands.insert_resource(Supplies { list });
}

/// The cells of both layers that a shape reaches, with their concentration: the dose times the
/// value of the shape. Cells that hold no liquid take no part.
fn reached(shape: &Raster, dose: f32, cloth: &Cloth) -> Vec<(u32, f32)> {
    let layer = shape.values.len();
    (0..2 * layer)
        .filter_map(|i| {
            let value = shape.values[i % layer];
            (value > 0.0 && cloth.capacity_free[i] > 0.0).then_some((i as u32, dose * value))
        })
        .collect()
}
