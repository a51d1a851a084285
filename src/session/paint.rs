//! Painting: a stroke of the brush as a change of the scenario.
//!
//! Dye is given where and when it is painted. Resist joins what is tied or pasted already; wax joins the
//! wax that was laid on last, or is resist where there is no batik.

use crate::batik::crackle::CrackleSpec;
use crate::batik::permeation::PermeationSpec;
use crate::pattern::{Pattern, Stroke};
use crate::scenario::{BatikSpec, BatikStep, Scenario, SupplySpec, Time};

/// What is on the brush.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// Dye of a concentration, 0 to 1.
    Dye(f64),
    /// Something that squeezes the cloth shut.
    Resist,
    /// Wax.
    Wax,
}

impl Paint {
    /// What an undo list calls a stroke with it.
    pub fn label(self) -> &'static str {
        match self {
            Paint::Dye(_) => "paint dye",
            Paint::Resist => "paint resist",
            Paint::Wax => "paint wax",
        }
    }
}

/// A scenario in which a stroke was painted at a step.
pub fn painted(scenario: &Scenario, paint: Paint, stroke: Stroke, step: u64) -> Scenario {
    let mut scenario = scenario.clone();
    match (paint, &mut scenario.batik) {
        (Paint::Dye(dose), _) => scenario.supply.push(SupplySpec::Dose {
            shape: Pattern::Strokes(vec![stroke]),
            dose,
            at: Time::Steps(step),
        }),
        (Paint::Wax, Some(batik)) => {
            let step_h = scenario.process.step_h;
            if wax(batik, stroke) {
                let all = batik.begins(step_h).last().copied().unwrap_or(0);
                scenario.process.duration = Time::Steps(all);
            }
        }
        (Paint::Resist | Paint::Wax, _) => {
            let resist = std::mem::take(&mut scenario.resist);
            scenario.resist = resist.painted(stroke);
        }
    }
    scenario
}

/// Paints wax; whether that took a step of its own, beside wax that comes from a drawing.
fn wax(batik: &mut BatikSpec, stroke: Stroke) -> bool {
    let is_wax = |step: &BatikStep| matches!(step, BatikStep::Wax { .. });
    let last = batik.steps.iter().rposition(is_wax);
    let mut like = (CrackleSpec::default(), PermeationSpec::default());
    if let Some(BatikStep::Wax {
        pattern,
        crackle,
        edge,
        ..
    }) = last.map(|i| &mut batik.steps[i])
    {
        if let Some(before) = pattern.take() {
            *pattern = Some(before.painted(stroke));
            return false;
        }
        like = (*crackle, *edge);
    }
    let step = BatikStep::Wax {
        drawing: None,
        ground: Default::default(),
        waxed: Default::default(),
        pattern: Some(Pattern::Strokes(vec![stroke])),
        crackle: like.0,
        edge: like.1,
    };
    batik.steps.insert(last.map_or(0, |i| i + 1), step);
    true
}
