//! What a change of the scenario means for the cloth that is being dyed.
//!
//! | changed | effect |
//! |---|---|
//! | `title`, `record` | nothing |
//! | `look`; a batik's colours and what it shows | it is drawn anew |
//! | `drape`, `view` | it is draped anew |
//! | `supply`, the end of `process` | the process is the same up to a step |
//! | anything else, or anything that is not known for certain | the process begins anew |
//!
//! Each effect includes those before it: where the process begins anew the cloth is drawn and draped
//! anew as well.

use super::save::tree;
use crate::scenario::{BatikSpec, BatikStep, Scenario, SupplySpec};

/// What a change needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// Nothing that is seen changes.
    Nothing,
    /// The cloth is drawn in another way.
    LookOnly,
    /// The cloth hangs or is seen in another way.
    DrapeOnly,
    /// The process is another one from this step on.
    FromStep(u64),
    /// The process begins anew.
    Restart,
}

/// What it needs to go on with `new` instead of `old`.
pub fn effect(old: &Scenario, new: &Scenario) -> Effect {
    if old == new {
        return Effect::Nothing;
    }
    let (Some(from), Some(to)) = (tree(old), tree(new)) else {
        return Effect::Restart;
    };
    let mut worst = Effect::Nothing;
    for name in names(&from).chain(names(&to)) {
        if from.field(name) == to.field(name) {
            continue;
        }
        let effect = match name {
            "title" | "record" => Effect::Nothing,
            "look" => Effect::LookOnly,
            "drape" | "view" => Effect::DrapeOnly,
            "supply" => of_supply(old, new),
            "process" => of_process(old, new),
            "batik" => of_batik(old, new),
            _ => Effect::Restart,
        };
        worst = match (worst, effect) {
            (Effect::FromStep(a), Effect::FromStep(b)) => Effect::FromStep(a.min(b)),
            (a, b) => a.max(b),
        };
    }
    worst
}

fn names(node: &super::save::Node) -> impl Iterator<Item = &str> {
    let fields = match node {
        super::save::Node::Fields(_, fields) => fields.as_slice(),
        _ => &[],
    };
    fields.iter().map(|(name, _)| name.as_str())
}

fn of_process(old: &Scenario, new: &Scenario) -> Effect {
    let mut only_longer = old.process;
    only_longer.duration = new.process.duration;
    // A recipe says itself how long it takes.
    if only_longer != new.process || old.batik.is_some() || new.batik.is_some() {
        return Effect::Restart;
    }
    match (old.process.steps(), new.process.steps()) {
        (a, b) if a == b => Effect::Nothing,
        (a, b) => Effect::FromStep(a.min(b)),
    }
}

fn of_supply(old: &Scenario, new: &Scenario) -> Effect {
    // Whether there are baths at any time decides how errors are measured at every time.
    if old.has_baths() != new.has_baths() || old.process.step_h != new.process.step_h {
        return Effect::Restart;
    }
    let step_h = old.process.step_h;
    let (old, new) = (old.supply.as_slice(), new.supply.as_slice());
    let same = |pair: &(&SupplySpec, &SupplySpec)| pair.0 == pair.1;
    let first = old.iter().zip(new).take_while(same).count();
    let (old, new) = (&old[first..], &new[first..]);
    let last = old.iter().rev().zip(new.iter().rev()).take_while(same);
    let last = last.count();
    let (old, new) = (&old[..old.len() - last], &new[..new.len() - last]);
    if let ([old], [new]) = (old, new)
        && let Some(step) = only_ends_otherwise(old, new, step_h)
    {
        return Effect::FromStep(step);
    }
    let begins = old.iter().chain(new).map(|spec| begin(spec, step_h));
    begins.min().map_or(Effect::Nothing, Effect::FromStep)
}

/// The step from which on a supply acts.
fn begin(spec: &SupplySpec, step_h: f64) -> u64 {
    match spec {
        SupplySpec::Dose { at, .. } => at.steps(step_h),
        SupplySpec::Hold { from, .. } | SupplySpec::Bath { from, .. } => from.steps(step_h),
    }
}

/// The earlier of two ends, where nothing else differs.
fn only_ends_otherwise(old: &SupplySpec, new: &SupplySpec, step_h: f64) -> Option<u64> {
    let mut changed = old.clone();
    let (SupplySpec::Hold { until, .. } | SupplySpec::Bath { until, .. }) = &mut changed else {
        return None;
    };
    let (SupplySpec::Hold { until: other, .. } | SupplySpec::Bath { until: other, .. }) = new
    else {
        return None;
    };
    let ends = [*until, *other].map(|end| end.map_or(u64::MAX, |end| end.steps(step_h)));
    *until = *other;
    // What ends where it begins does not last at all.
    (changed == *new).then(|| ends[0].min(ends[1]).max(begin(new, step_h)))
}

fn of_batik(old: &Scenario, new: &Scenario) -> Effect {
    let (Some(old), Some(new)) = (&old.batik, &new.batik) else {
        return Effect::Restart;
    };
    match unseen(old) == unseen(new) {
        true => Effect::LookOnly,
        false => Effect::Restart,
    }
}

/// A recipe without what only decides how it looks.
fn unseen(spec: &BatikSpec) -> BatikSpec {
    let mut spec = spec.clone();
    spec.cloth = (0.0, 0.0, 0.0);
    spec.show = Default::default();
    spec.show_wax = true;
    for step in &mut spec.steps {
        if let BatikStep::Dye { colour, .. } = step {
            *colour = (0.0, 0.0, 0.0);
        }
    }
    spec
}

/// Whether `new` is `old` with doses at `step` added behind everything else: then what supply has done at
/// that step already stays done.
pub(super) fn only_adds_doses_at(step: u64, old: &Scenario, new: &Scenario) -> bool {
    let added = new.supply.get(old.supply.len()..).unwrap_or_default();
    let step_h = new.process.step_h;
    let is_dose =
        |spec: &SupplySpec| matches!(spec, SupplySpec::Dose { .. }) && begin(spec, step_h) == step;
    let mut before = new.clone();
    before.supply.truncate(old.supply.len());
    before == *old && added.iter().all(is_dose)
}
