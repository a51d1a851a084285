//! What several test files need.
#![allow(dead_code)] // Not every file needs all of it.

use bevy::app::App;
use dyelapse::prelude::*;

/// An experiment from RON text.
pub fn experiment(text: &str) -> Experiment {
    let origin = dyelapse::scenario::Origin::Memory;
    Experiment::parse("test", origin, text.to_owned()).unwrap_or_else(|why| panic!("{why}"))
}

/// An app of an experiment after `steps` steps, looked at.
pub fn dyed(experiment: Experiment, steps: u64) -> App {
    let mut app = dyeing_app(experiment);
    go_on(&mut app, steps);
    app
}

/// Advances an app to a step and looks at it.
pub fn go_on(app: &mut App, step: u64) {
    assert!(advance_to(app.world_mut(), step, |_| true));
    look(app.world_mut());
}

pub fn ledger(app: &App) -> Ledger {
    *app.world().resource::<Ledger>()
}

pub fn concentration(app: &App) -> &[f32] {
    &app.world().resource::<FreeDye>().concentration
}

pub fn bound(app: &App) -> &[f32] {
    &app.world().resource::<BoundDye>().amount
}
