//! Undo and redo, and what a change needs.

use dyelapse::scenario::{Scenario, Time};
use dyelapse::session::effect::{Effect, effect};
use dyelapse::session::history::{History, LONGEST};
use dyelapse::session::save::read;

fn scenario() -> Scenario {
    read(
        "(title: \"t\", cloth: (size: (Cells(60), Cells(40))), supply: [
            Hold(shape: Ramp(), from: Steps(3), until: Steps(500)),
            Dose(shape: Everywhere, dose: 0.4, at: Steps(700))],
          process: (duration: Steps(1000)))",
    )
    .unwrap()
}

/// What it needs to go on with a changed scenario.
fn after(change: impl Fn(&mut Scenario)) -> Effect {
    let mut changed = scenario();
    change(&mut changed);
    let there = effect(&scenario(), &changed);
    // It takes as much to go back.
    assert_eq!(effect(&changed, &scenario()), there);
    there
}

fn supply(text: &str) -> dyelapse::scenario::SupplySpec {
    let text = format!(
        "(title: \"t\", cloth: (size: (Cells(60), Cells(40))), supply: [{text}],
          process: (duration: Steps(1000)))"
    );
    read(&text).unwrap().supply.remove(0)
}

#[test]
fn what_is_not_seen_needs_nothing_and_a_look_only_a_look() {
    assert_eq!(after(|_| {}), Effect::Nothing);
    assert_eq!(after(|s| s.title = "another".into()), Effect::Nothing);
    assert_eq!(after(|s| s.record.frames = Some(3)), Effect::Nothing);
    assert_eq!(after(|s| s.look.pixels_per_cell = 3), Effect::LookOnly);
    let both = after(|s| {
        s.look.pixels_per_cell = 3;
        s.title = "another".into();
    });
    assert_eq!(both, Effect::LookOnly);
    let hung = dyelapse::scenario::Draping::Bundled("hanging".into());
    assert_eq!(after(|s| s.drape = Some(hung.clone())), Effect::DrapeOnly);
    assert_eq!(after(|s| s.view.field_of_view = 40.0), Effect::DrapeOnly);
}

#[test]
fn what_is_supplied_later_leaves_what_was_before() {
    let dose = supply("Dose(shape: Ramp(), at: Steps(600))");
    assert_eq!(
        after(|s| s.supply.push(dose.clone())),
        Effect::FromStep(600)
    );
    assert_eq!(
        after(|s| s.supply.insert(1, dose.clone())),
        Effect::FromStep(600)
    );
    assert_eq!(after(|s| drop(s.supply.remove(1))), Effect::FromStep(700));
    assert_eq!(after(|s| drop(s.supply.remove(0))), Effect::FromStep(3));
    assert_eq!(after(|s| s.supply.swap(0, 1)), Effect::FromStep(3));
    // A hold that only ends earlier or later is the same until then.
    let longer = supply("Hold(shape: Ramp(), from: Steps(3), until: Steps(800))");
    assert_eq!(
        after(|s| s.supply[0] = longer.clone()),
        Effect::FromStep(500)
    );
    let stronger = supply("Hold(shape: Ramp(), dose: 0.5, from: Steps(3), until: Steps(500))");
    assert_eq!(
        after(|s| s.supply[0] = stronger.clone()),
        Effect::FromStep(3)
    );
    let longer = after(|s| s.process.duration = Time::Steps(2000));
    assert_eq!(longer, Effect::FromStep(1000));
    let both = after(|s| {
        s.process.duration = Time::Steps(650);
        s.supply.push(dose.clone());
    });
    assert_eq!(both, Effect::FromStep(600));
}

#[test]
fn whatever_else_changes_begins_anew() {
    assert_eq!(after(|s| s.seed = 4), Effect::Restart);
    assert_eq!(after(|s| s.cloth.cell_mm = 0.06), Effect::Restart);
    assert_eq!(after(|s| s.dye.equilibrium = 0.5), Effect::Restart);
    assert_eq!(after(|s| s.process.tolerance = 0.01), Effect::Restart);
    assert_eq!(
        after(|s| s.resist = dyelapse::pattern::Pattern::Everywhere),
        Effect::Restart
    );
    // The first bath decides how errors are measured from the beginning on.
    let bath = supply("Bath(shape: Ramp(), from: Steps(900))");
    assert_eq!(after(|s| s.supply.push(bath.clone())), Effect::Restart);
}

#[test]
fn a_batik_s_colours_are_a_look_and_its_recipe_is_not() {
    let batik = read(
        "(title: \"t\", cloth: (size: (Cells(60), Cells(40))), supply: [],
          batik: (steps: [Wax(pattern: Ramp()), Dye(colour: (17, 0.8, 0.5), lasts: Steps(4))]),
          process: (duration: Steps(5)))",
    )
    .unwrap();
    let mut other = batik.clone();
    other.batik.as_mut().unwrap().show_wax = false;
    if let dyelapse::scenario::BatikStep::Dye { colour, .. } =
        &mut other.batik.as_mut().unwrap().steps[1]
    {
        *colour = (200.0, 0.5, 0.5);
    }
    assert_eq!(effect(&batik, &other), Effect::LookOnly);
    other.batik.as_mut().unwrap().steps.remove(0);
    assert_eq!(effect(&batik, &other), Effect::Restart);
}

fn with_seed(seed: u64) -> Scenario {
    Scenario { seed, ..scenario() }
}

#[test]
fn undo_and_redo_go_through_the_same_scenarios() {
    let mut history = History::new(with_seed(0));
    for seed in 1..=5 {
        history.edit(with_seed(seed), &format!("to {seed}"), false);
    }
    for seed in (0..5).rev() {
        assert_eq!(history.undoable().unwrap().0, format!("to {}", seed + 1));
        assert!(history.undo());
        assert_eq!(history.now().seed, seed);
    }
    assert!(!history.undo() && history.undoable().is_none());
    for seed in 1..=3 {
        assert_eq!(history.redoable().unwrap().1.seed, seed);
        assert!(history.redo());
        assert_eq!(history.now().seed, seed);
    }
    // Another edit from here leaves the way on behind.
    history.edit(with_seed(9), "to 9", false);
    assert!(!history.redo());
    assert!(history.undo());
    assert_eq!(history.now().seed, 3);
}

#[test]
fn a_slider_that_is_dragged_is_one_edit() {
    let mut history = History::new(with_seed(0));
    for seed in 1..=5 {
        history.edit(with_seed(seed), "seed", true);
    }
    assert_eq!(history.len(), 1);
    history.release();
    history.edit(with_seed(6), "seed", true);
    history.edit(with_seed(7), "another", true);
    assert_eq!(history.len(), 3);
    assert!(history.undo() && history.undo() && history.undo());
    assert_eq!(history.now().seed, 0);
    // Dragged back to where it began it is none at all, and what changes nothing is none either.
    history.edit(with_seed(1), "seed", true);
    history.edit(with_seed(0), "seed", true);
    history.edit(with_seed(0), "other", false);
    assert!(history.is_empty());
}

#[test]
fn a_history_has_a_bound() {
    let mut history = History::new(with_seed(0));
    for seed in 1..=2 * LONGEST as u64 {
        history.edit(with_seed(seed), "seed", false);
    }
    assert_eq!(history.len(), LONGEST);
    while history.undo() {}
    assert_eq!(history.now().seed, LONGEST as u64);
}
