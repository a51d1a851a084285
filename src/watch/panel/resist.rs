//! The resist: where the cloth is tied, clamped or pasted.

use bevy_egui::egui::Ui;

use super::pattern;
use super::presets;
use super::row::{Pass, row};
use crate::scenario::Scenario;

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Resist", |p, ui| {
        if scenario.sweeps() {
            p.say(
                ui,
                "Sweeps of batik know no resist but wax, which its steps lay on (process, batik). Take the \
                 solver “diffusion” to tie or paste as well.",
            );
            return;
        }
        p.heading("resist");
        let technique = row(
            "technique",
            "Takes the resist of a bundled scenario, and the dye that goes with it: paste, knots, clamps, \
             pleats.",
        );
        let chosen = p.variant(ui, &technique, usize::MAX, &presets::RESISTS);
        if let Some(found) = chosen.and_then(|i| presets::scenario(presets::RESISTS[i])) {
            scenario.resist = found.resist;
            scenario.supply = found.supply;
        }
        p.say(ui, "The volume ratio B: 0 free, 1 shut.");
        pattern::show(p, ui, &mut scenario.resist, "resist");
    });
}
