//! A stage that is not in the library: light bleaches the dye that has not bound yet.
//!
//! A stage is a plugin. It adds a resource, a system, and its place in the order of a step; no
//! other stage changes for it.
//!
//! `cargo run --release --example a_stage_of_your_own`

use bevy::prelude::*;
use dyelapse::prelude::*;

/// Bleaching by light, first order: dc/dt = −rate · c.
struct BleachingPlugin {
    /// Share of the free dye that is bleached in an hour.
    per_hour: f64,
}

#[derive(Resource)]
struct Bleaching {
    per_hour: f64,
}

impl Plugin for BleachingPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Bleaching {
            per_hour: self.per_hour,
        })
        .add_systems(
            DyeStep,
            bleach.after(DyeSet::Adsorption).before(DyeSet::Tick),
        );
    }
}

fn bleach(
    bleaching: Res<Bleaching>,
    clock: Res<ProcessClock>,
    cloth: Res<Cloth>,
    mut dye: ResMut<FreeDye>,
    mut ledger: ResMut<Ledger>,
) {
    // One run of this may cover a part of a step. Since it changes the dye, never more than one.
    let stays = (1.0 - bleaching.per_hour * clock.stride_hours()) as f32;
    for i in 0..dye.concentration.len() {
        let faded = dye.concentration[i] * stays;
        let grown = dye.bring(i, faded);
        let (layer, y, x) = cloth.grid.place(i);
        ledger.book(grown * f64::from(cloth.capacity_free(layer, y, x)));
    }
}

fn main() -> Result<(), ScenarioError> {
    let mut app = App::new();
    app.add_plugins((DyeingPlugins, BleachingPlugin { per_hour: 0.5 }));
    prepare(&mut app, Experiment::load("one_drop")?);
    for step in [0, 500, 1000, 2000] {
        advance_to(app.world_mut(), step, |_| true);
        look(app.world_mut());
        let ledger = app.world().resource::<Ledger>();
        println!(
            "step {step}: {:.1} of {:.1} cell volumes of dye left, {:.1} bleached",
            ledger.free, ledger.supplied, ledger.removed
        );
    }
    Ok(())
}
