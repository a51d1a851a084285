//! The smallest use of the library: dye a cloth and look at it now and then.
//!
//! `cargo run --release --example one_drop`

use dyelapse::prelude::*;

fn main() -> Result<(), ScenarioError> {
    let experiment = Experiment::load("one_drop")?;
    let end = experiment.scenario.process.steps();
    let mut app = dyeing_app(experiment);
    for step in (0..=end).step_by(500) {
        advance_to(app.world_mut(), step, |_| true);
        look(app.world_mut());
        let hours = app.world().resource::<ProcessClock>().hours();
        let dye = &app.world().resource::<FreeDye>().concentration;
        let reached = dye.iter().filter(|c| **c > 0.01).count();
        println!("after {hours} h the drop has reached {reached} cells");
    }
    Ok(())
}
