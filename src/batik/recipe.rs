//! A recipe as it is worked through: what every step does, and when.

use std::sync::Arc;

use super::crackle::Crackle;
use super::permeation::permeation;
use super::sweep::BathSpec;
use crate::chance::Chance;
use crate::pattern::{Canvas, Raster};
use crate::scenario::{BatikStep, Experiment};

/// The wax on the cloth.
#[derive(Debug, Clone)]
pub struct Wax {
    /// I: 0 waxed, 1 open, with its cracks.
    pub drawing: Raster,
    /// p: how well it lets dye through, 0 to 1.
    pub permeation: Raster,
}

/// What one step of a recipe does.
#[derive(Debug, Clone)]
pub enum Action {
    /// The wax is this from now on.
    Wax(Arc<Wax>),
    /// The cloth hangs in a bath.
    Dye {
        /// The bath.
        bath: BathSpec,
        /// Whether the cloth is rinsed afterwards.
        rinse: bool,
    },
    /// There is no wax any more.
    Boil,
}

/// A recipe, ready to be worked through.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// What is done, in order.
    pub actions: Vec<Action>,
    /// The step at which each action begins; one more for the end of the last.
    pub begins: Vec<u64>,
}

/// A bath between two steps of the process, and the wax that it goes through.
pub struct WaxedBath<'a> {
    /// From this step on.
    pub from: u64,
    /// Up to, but not at, this one.
    pub until: u64,
    /// The bath.
    pub bath: BathSpec,
    /// The wax, if there is any.
    pub wax: Option<&'a Wax>,
}

impl Recipe {
    /// The recipe of an experiment, with all its wax; none if it has none.
    pub fn of(experiment: &Experiment) -> Option<Self> {
        let scenario = &experiment.scenario;
        let spec = scenario.batik.as_ref()?;
        let canvas = Canvas::of(experiment);
        let mut wax: Option<Arc<Wax>> = None;
        let mut actions = Vec::with_capacity(spec.steps.len());
        for (i, step) in spec.steps.iter().enumerate() {
            actions.push(match step {
                BatikStep::Wax { crackle, edge, .. } => {
                    let open = open(step, &canvas, experiment);
                    // Every layer of wax breaks in its own way.
                    let chance = Chance(canvas.seed.wrapping_add(i as u64));
                    let mut drawing = Crackle::grow(&open, crackle, None, chance).over(&open);
                    if let Some(before) = &wax {
                        let both = drawing.values.iter_mut().zip(&before.drawing.values);
                        both.for_each(|(open, before)| *open = open.min(*before));
                    }
                    let permeation = permeation(&drawing, edge);
                    let new = Arc::new(Wax {
                        drawing,
                        permeation,
                    });
                    wax = Some(new.clone());
                    Action::Wax(new)
                }
                BatikStep::Dye { bath, rinse, .. } => Action::Dye {
                    bath: *bath,
                    rinse: *rinse,
                },
                BatikStep::Boil => {
                    wax = None;
                    Action::Boil
                }
            });
        }
        Some(Recipe {
            actions,
            begins: spec.begins(scenario.process.step_h),
        })
    }

    /// Every bath, with the wax that is on the cloth then.
    pub fn baths(&self) -> impl Iterator<Item = WaxedBath<'_>> {
        let mut wax = None;
        let spans = self.actions.iter().zip(self.begins.windows(2));
        spans.filter_map(move |(action, span)| match action {
            Action::Wax(new) => {
                wax = Some(&**new);
                None
            }
            Action::Boil => {
                wax = None;
                None
            }
            Action::Dye { bath, .. } => Some(WaxedBath {
                from: span[0],
                until: span[1],
                bath: *bath,
                wax,
            }),
        })
    }
}

/// Where a step of a recipe leaves the cloth open: 1 open, 0 waxed.
fn open(step: &BatikStep, canvas: &Canvas, experiment: &Experiment) -> Raster {
    let all = Raster::uniform(canvas.nx, canvas.ny, 1.0);
    match step {
        BatikStep::Wax {
            drawing: Some(file),
            ground,
            waxed,
            ..
        } => match experiment.images.drawing(file, *ground) {
            Some(drawing) => drawing.wax(canvas.nx, canvas.ny, *waxed),
            None => all,
        },
        BatikStep::Wax {
            pattern: Some(pattern),
            ..
        } => {
            let mut open = canvas.draw(pattern);
            open.values.iter_mut().for_each(|v| *v = 1.0 - *v);
            open
        }
        _ => all,
    }
}
